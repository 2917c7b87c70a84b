"""Small studies of every source of models, contact law and method."""

from studies import DATA, Case, built_in, bundle, import_files, measured, of_bundle, small, study

RECEPTANCES = "[reduction]\nbasis = 'tuned_receptances'"
BASIS = "[reduction]\nbasis = 'stick_slide'\nstick_modes = 3\nslide_modes = 3"
# Fixed-interface modes that are chosen take longer; some cases leave them to the program.
FEW_MODES = "[reduction]\ncraig_bampton_modes = 20"
HARMONIC_1 = "[solver]\nharmonics = [1]"
WHEEL = (DATA / "calculix_wheel").as_posix()

MODELS = [
    Case(
        "lumped",
        small(),
        "run study.toml",
        "model study.toml",
        "model study.toml --json",
        "model study.toml --export bundle",
        "campbell study.toml --engine-orders 1:4 --speed-rpm 0:60000 --plot speed.svg --plot-safe safe.svg",
        "campbell study.toml --json",
    ),
    Case(
        "lumped-named-masses",
        {
            "ring.toml": study("studies/laxalde-2007.toml", "patterns = 6", "normal_load_n = [2, 20]"),
            "blades.toml": study(
                "studies/laxalde-2007.toml",
                "patterns = 2",
                "normal_load_n = [20]",
                "contact = [{ between = ['root', 'next.root'] }, { between = ['tip', 'ground'], weight = 2.0 }]",
            ),
        },
        "run ring.toml --out ring",
        "run blades.toml --out blades",
        "model blades.toml --export bundle",
    ),
    Case(
        "lumped-without-contact",
        study("studies/one-dof.toml", "patterns = 80", "standard_deviation = [0.03, 0.1]"),
        "run study.toml",
        "response study.toml --pattern 3 --standard-deviation 0.1 --load free --frequencies 900:1100:5 --out curve.csv",
    ),
    Case(
        "ring",
        built_in("studies/quickstart.toml", 6, "['free', 'slide', 480, 'stuck']"),
        "run study.toml",
        "campbell study.toml --json",
        "report results/quickstart",
        "plot results/quickstart sector",
        "response study.toml --pattern 0 --load 480 --frequencies 700:760:4 --out curve.csv",
    ),
    Case(
        "underplatform-wedge",
        built_in("studies/underplatform.toml", 4, "[200]", FEW_MODES, HARMONIC_1),
        "run study.toml",
        "plot results/underplatform sector",
    ),
    Case(
        "underplatform-rigid-cylinder",
        built_in(
            "studies/underplatform.toml",
            4,
            "[200]",
            FEW_MODES,
            HARMONIC_1,
            "[model.parametric]\ndamper_body = 'rigid'\ndamper_shape = 'cylinder'",
        ),
        "run study.toml",
        "plot results/underplatform sector",
    ),
    Case(
        "shroud-that-opens",
        built_in("studies/shroud.toml", 4, "[200]", FEW_MODES),
        "run study.toml",
        "plot results/shroud sector",
    ),
    Case(
        "blade-to-ground",
        built_in("studies/blade-to-ground.toml", 6, "[400]", FEW_MODES, HARMONIC_1),
        "run study.toml",
        "plot results/blade-to-ground sector",
    ),
    Case(
        "bundle-of-a-model",
        {
            "study.toml": small(),
            "of-bundle.toml": of_bundle("bundle", "law = 'macro_slip_1d'", "normal_stiffness_n_per_m ="),
        },
        "model study.toml --export bundle",
        "check of-bundle.toml",
        "run of-bundle.toml",
    ),
    Case(
        "import-of-calculix",
        of_bundle("rest", "normal_load_n = [30]", "harmonics = [1]"),
        f"import {WHEEL}/wheel_rest.toml --out rest --frequencies 3",
        f"import {WHEEL}/wheel_speed.toml --out speed --json",
        f"import {WHEEL}/wheel_speed.toml --equations ring",
        "run study.toml",
        "campbell study.toml --at 0=rest --at 6000=speed --plot speed.svg",
    ),
    Case(
        "import-of-matrices",
        import_files(),
        "import mm.toml --out mm",
        "import hb.toml --out hb",
        "import dmig.toml --out dmig",
        "import dense.toml --out dense",
        "import bigmat.toml --out bigmat",
        "import nonbigmat.toml --out nonbigmat",
    ),
]

LAWS = [
    case
    for law in ("macro_slip_1d", "macro_slip_2d", "simplified_3d", "coulomb_3d")
    for case in (
        Case(f"{law}-on-receptances", bundle(law, RECEPTANCES, FEW_MODES), "run study.toml"),
        Case(f"{law}-on-a-basis", bundle(law, BASIS, FEW_MODES), "run study.toml"),
    )
]

RANDOM_CONTACT = """[contact.variation]
friction_coefficient = { kind = 'truncated_normal', standard_deviation = 0.1, truncation = 2.5 }
tangential_stiffness = { kind = 'lognormal', standard_deviation = 0.4, per = 'sector' }
normal_stiffness = { kind = 'normal', standard_deviation = 0.1, per = 'pair' }
normal_load = { kind = 'uniform', standard_deviation = 0.05, per = 'pair' }"""

LOAD_CASES = """[[excitation.load_case]]
name = "disk"
force = "disk.csv"
engine_orders = [1, 2]
amplitude_n = [20.0, 40.0]

[[excitation.load_case]]
name = "tip"
node = "blade"
direction = [0.0, 1.0, 0.0]"""

METHODS = [
    Case(
        "basis-of-chosen-size",
        bundle("simplified_3d", "[reduction]\nbasis = 'stick_slide'\nerror = 0.01"),
        "run study.toml",
    ),
    Case("stick-attachment", small("[reduction]\nbasis = 'stick_attachment'"), "run study.toml"),
    Case(
        "sensitivity-vectors",
        bundle("simplified_3d", BASIS, FEW_MODES, "[reduction]\nsensitivity_vectors = 2"),
        "run study.toml",
    ),
    Case(
        "automatic-harmonics-on-a-basis",
        bundle(
            "simplified_3d",
            "harmonics = 'auto'",
            BASIS,
            "[solver]\nrows_beyond_tolerance = 'resolve'\nharmonic_tolerance = 0.005",
        ),
        "run study.toml",
    ),
    Case(
        "receptances-of-masses",
        study("studies/lumped24.toml", RECEPTANCES),
        "run study.toml",
    ),
    Case(
        "time-maximum",
        study("studies/lumped24.toml", "[solver]\nsearch_harmonics = 'all'\ntime_samples = 512"),
        "run study.toml",
        "response study.toml --pattern 0 --load 50 --frequencies 340:370:7 --out curve.csv",
    ),
    Case(
        "separation",
        bundle("simplified_3d", FEW_MODES, "normal_load_n = [20]", "harmonics = [0, 1, 2, 3]"),
        "run study.toml",
    ),
    Case(
        "separation-with-automatic-harmonics",
        bundle("simplified_3d", FEW_MODES, "normal_load_n = [100]", "harmonics = 'auto'"),
        "run study.toml",
    ),
    Case("creeping-ring", small("ring_disk_stiffness_n_per_m =", "[contact]\nring = 'creeping'"), "run study.toml"),
    Case(
        "creeping-ring-of-a-bundle",
        bundle("simplified_3d", FEW_MODES, "[contact]\nring = 'creeping'", "[reduction]\nerror = 0.01"),
        "run study.toml",
    ),
    Case(
        "cantilever-modes",
        small("[mistuning]\nprojection = 'cantilever_modes'\ncantilever_mode_count = 1"),
        "run study.toml",
    ),
    Case(
        "deviations-of-cantilever-modes",
        {
            "study.toml": bundle(
                "simplified_3d",
                "file = 'wheels.csv'",
                "[mistuning]\nprojection = 'cantilever_modes'\ncantilever_mode_count = 2",
            ),
            "wheels.csv": "pattern,blade,mode,deviation\n"
            + "".join(
                f"4,{blade},{mode},{(3 * blade + mode) % 7 / 100 - 0.03}\n" for blade in range(8) for mode in range(2)
            ),
        },
        "run study.toml",
    ),
    Case(
        "measured-wheels",
        {
            "study.toml": small(*measured()),
            "wheels.csv": "pattern,blade,deviation\n"
            + "".join(
                f"{wheel},{blade},{(wheel + 101 * blade) % 41 / 800 - 0.025}\n"
                for wheel in (0, 10, 25)
                for blade in range(6)
            ),
        },
        "check study.toml",
        "run study.toml",
        "report results/small --no-curves",
    ),
    Case(
        "distributions",
        {
            "uniform.toml": small("distribution = { kind = 'uniform' }"),
            "cut.toml": small("distribution = { kind = 'truncated_normal', truncation = 2.0 }"),
        },
        "run uniform.toml --out uniform",
        "run cut.toml --out cut",
    ),
    Case("random-contact", bundle("coulomb_3d", FEW_MODES, RANDOM_CONTACT), "run study.toml"),
    Case(
        "effects-of-random-contact",
        study("studies/contact-uncertainty.toml", "patterns = 20", "normal_load_n = [75]"),
        "run study.toml",
    ),
    Case(
        "load-cases",
        {"study.toml": small(LOAD_CASES), "disk.csv": "dof,re,im\n1,1.0,0.5\n"},
        "run study.toml",
        "compare results/small --percentile 50",
        "report results/small --no-curves",
        "plot results/small amplitude --load-case disk --engine-order 2",
        "response study.toml --pattern 1 --load 50 --load-case tip --frequencies 340:370:5 --out curve.csv",
        "optimum study.toml --between 40:60 --percentile 50 --resolution 0.3",
        "2 plot results/small amplitude --load-case disk",
    ),
    Case(
        "rotation",
        small(
            "normal_load_n = ['slide']",
            "[nodal_diameter_damping]\ndamping_ratios = [[2, 0.002], [3, 0.001]]",
            "[contact]\nnormal_load = { from = 'rotation', speed_rpm = [800, 1000], ring_radius_m = 0.2 }",
            "[output]\nstress_pa_per_m = 2.0e11",
        ),
        "run study.toml",
        "report results/small --no-curves",
    ),
    Case(
        "rotation-of-a-solid-ring",
        built_in(
            "studies/quickstart.toml",
            6,
            "['slide']",
            HARMONIC_1,
            "[contact.normal_load]\nfrom = 'rotation'\nspeed_rpm = 4000\nhoop = 'split'\nshare = 'equilibrium'\n"
            "ring_mass_factor = 1.5",
        ),
        "run study.toml",
    ),
    Case(
        "damping",
        {
            "modal.toml": small("structural_loss_factor =", "[damping]\nmodal_ratio = 0.001"),
            "rayleigh.toml": small(
                "structural_loss_factor =",
                "[damping]\nrayleigh = { mass_per_s = 1.0, stiffness_s = 9e-7 }",
                "[nodal_diameter_damping]\ndamping_ratios = [[2, 0.001]]\nmodes = 'all'",
            ),
        },
        "run modal.toml --out modal",
        "run rayleigh.toml --out rayleigh",
    ),
    Case(
        "stability",
        small("normal_load_n = [50]", "[output]\nstability = 1\ncompression = 'snappy'\npatterns = false"),
        "run study.toml",
    ),
    Case(
        "accuracy",
        study("tests/report/accuracy.toml", "patterns = 8"),
        "run study.toml",
        "report results/accuracy --no-curves",
        "plot results/accuracy accuracy",
    ),
]

PHYSICS = MODELS + LAWS + METHODS
