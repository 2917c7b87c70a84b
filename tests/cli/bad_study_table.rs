//! The table of bad studies: one mistake each, and what the message must hold.

/// What is replaced in the good study, by what, and what the message must hold.
pub type Case = (&'static str, &'static str, &'static [&'static str]);

pub const CASES: &[Case] = &[
    // TOML itself, unknown keys and types.
    ("seed = 7", "seed 7", &["study.toml:5:"]),
    (
        "seed = 7",
        "sede = 7",
        &[
            "study.toml:5:",
            "unknown key study.sede",
            "did you mean seed?",
        ],
    ),
    (
        "[damping]",
        "[dampin]",
        &[
            "study.toml:27:",
            "unknown key dampin",
            "did you mean damping?",
        ],
    ),
    (
        "sectors = 6",
        "sector = 6",
        &[
            "study.toml:12:",
            "model.lumped.sector",
            "did you mean sectors?",
        ],
    ),
    (
        "seed = 7",
        "seed = 7.5",
        &["study.toml:5:", "study.seed = 7.5", "a whole number"],
    ),
    (
        "seed = 7",
        "seed = -1",
        &[
            "study.toml:5:",
            "study.seed = -1",
            "a whole number of at least 0",
        ],
    ),
    (
        "0.25",
        "\"light\"",
        &[
            "study.toml:13:",
            "model.lumped.blade_mass_kg = \"light\"",
            "a number",
        ],
    ),
    (
        "[1, 3]",
        "3",
        &[
            "study.toml:42:",
            "solver.harmonics = 3",
            "\"auto\" or a list",
        ],
    ),
    // What must be there.
    ("schema = 1\n", "", &["schema is missing", "accepted: 1"]),
    (
        "schema = 1",
        "schema = 2",
        &["study.toml:1:", "schema = 2", "accepted: 1"],
    ),
    (
        "seed = 7\n",
        "",
        &["study.seed is missing", "there is no default"],
    ),
    ("patterns = 10\n", "", &["study.patterns is missing"]),
    ("name = \"small\"\n", "", &["study.name is missing"]),
    (
        "source = \"lumped\"\n",
        "",
        &[
            "model.source is missing",
            "\"parametric\", \"lumped\" or \"bundle\"",
        ],
    ),
    (
        "engine_orders = [2]\n",
        "",
        &["excitation.engine_orders is missing"],
    ),
    (
        "friction_coefficient = 0.3\n",
        "",
        &["contact.friction_coefficient is missing"],
    ),
    (
        "tangential_stiffness_n_per_m = 8.0e5\n",
        "",
        &["contact.tangential_stiffness_n_per_m is missing"],
    ),
    (
        "structural_loss_factor = 0.002\n",
        "",
        &["damping is missing", "exactly one of"],
    ),
    (
        "normal_load_n = [\"slide\", 50, \"stuck\"]\n",
        "",
        &["sweep.normal_load_n is missing"],
    ),
    (
        "standard_deviation = [0.03]\n",
        "",
        &["sweep.standard_deviation is missing"],
    ),
    (
        "distribution = { kind = \"normal\" }\n",
        "",
        &["mistuning.distribution is missing", "file ="],
    ),
    // Ranges.
    (
        "\"small\"",
        "\"../up\"",
        &["study.toml:4:", "study.name = \"../up\"", "letters"],
    ),
    (
        "patterns = 10",
        "patterns = 0",
        &["study.toml:6:", "study.patterns = 0", "from 1"],
    ),
    ("patterns = 10", "patterns = 3000000000", &["2147483647"]),
    (
        "\"lumped\"",
        "\"lumpd\"",
        &["study.toml:9:", "did you mean \"lumped\"?"],
    ),
    (
        "sectors = 6",
        "sectors = 0",
        &["study.toml:12:", "model.lumped.sectors"],
    ),
    (
        "0.25",
        "-0.25",
        &["study.toml:13:", "model.lumped.blade_mass_kg", "-0.25"],
    ),
    (
        "0.25",
        "nan",
        &["study.toml:13:", "model.lumped.blade_mass_kg", "NaN"],
    ),
    (
        "= 0.3\n",
        "= -0.3\n",
        &[
            "study.toml:24:",
            "contact.friction_coefficient = -0.3",
            "0 to 10",
        ],
    ),
    (
        "= 0.3\n",
        "= nan\n",
        &["contact.friction_coefficient = nan"],
    ),
    (
        "8.0e5\n\n",
        "0\n\n",
        &["contact.tangential_stiffness_n_per_m = 0", "N/m"],
    ),
    (
        "8.0e5\n\n",
        "inf\n\n",
        &["contact.tangential_stiffness_n_per_m = inf"],
    ),
    (
        "8.0e5\n\n",
        "8.0e5\nring = \"creeping\"\n\n",
        &["contact.ring = \"creeping\"", "locked"],
    ),
    (
        "8.0e5\n\n",
        "8.0e5\nring = \"free\"\n\n",
        &["contact.ring", "creeping"],
    ),
    (
        "\"macro_slip_1d\"",
        "\"coulomb_3d\"",
        &["contact.normal_stiffness_n_per_m is missing"],
    ),
    (
        "\"macro_slip_1d\"",
        "\"simplified_3d\"",
        &["contact.normal_stiffness_n_per_m is missing"],
    ),
    (
        "\"macro_slip_1d\"",
        "\"macro\"",
        &["contact.law = \"macro\"", "did you mean \"macro_slip_1d\"?"],
    ),
    (
        "0.002",
        "0",
        &[
            "study.toml:28:",
            "damping.structural_loss_factor = 0",
            "no bounded resonance",
        ],
    ),
    (
        "structural_loss_factor = 0.002",
        "modal_ratio = 1.5",
        &["damping.modal_ratio = 1.5"],
    ),
    (
        "structural_loss_factor = 0.002",
        "rayleigh = { mass_per_s = 0, stiffness_s = 0 }",
        &["damping.rayleigh"],
    ),
    (
        "structural_loss_factor = 0.002",
        "rayleigh = { mass_per_s = 1 }",
        &["damping.rayleigh.stiffness_s is missing"],
    ),
    (
        "structural_loss_factor = 0.002",
        "structural_loss_factor = 0.002\nmodal_ratio = 0.1",
        &["several models of damping"],
    ),
    (
        "[2]",
        "[]",
        &["excitation.engine_orders = []", "at least one"],
    ),
    (
        "[2]",
        "[2, 2]",
        &["excitation.engine_orders = [2, 2]", "different"],
    ),
    ("[2]", "[-1]", &["excitation.engine_orders[0] = -1"]),
    (
        "amplitude_n = 10.0",
        "amplitude_n = 0",
        &["excitation.amplitude_n = 0", "in N"],
    ),
    // Powers of the response would vanish or overflow.
    (
        "amplitude_n = 10.0",
        "amplitude_n = 9.9e-31",
        &[
            "excitation.amplitude_n = 9.9e-31",
            "from 1e-30 to 1e30, in N",
        ],
    ),
    (
        "amplitude_n = 10.0",
        "amplitude_n = 1.1e30",
        &[
            "excitation.amplitude_n = 1.1e30",
            "from 1e-30 to 1e30, in N",
        ],
    ),
    (
        "amplitude_n = 10.0",
        "amplitude_n = [1e-80]",
        &[
            "excitation.amplitude_n = [1e-80]",
            "from 1e-30 to 1e30, in N",
        ],
    ),
    (
        "\"stuck\"",
        "1.1e30",
        &["sweep.normal_load_n[", "= 1.1e30", "from 0 to 1e30 in N"],
    ),
    (
        "\"stuck\"",
        "\"stock\"",
        &[
            "study.toml:38:",
            "sweep.normal_load_n[2] = \"stock\"",
            "\"stuck\"",
        ],
    ),
    (
        ", 50,",
        ", -50,",
        &["sweep.normal_load_n[1] = -50", "from 0 to 1e30 in N"],
    ),
    (
        ", 50,",
        ", 50, 50.0,",
        &["sweep.normal_load_n[2] = 50.0", "different"],
    ),
    (
        ", 50,",
        ", true,",
        &["sweep.normal_load_n[1] = true", "\"free\""],
    ),
    (
        "[0.03]",
        "[0.03, 0.9]",
        &["sweep.standard_deviation[1] = 0.9", "0 to 0.5"],
    ),
    ("[0.03]", "[]", &["sweep.standard_deviation = []"]),
    (
        "[0.03]",
        "0.03",
        &["sweep.standard_deviation = 0.03", "a list"],
    ),
    ("[1, 3]", "[3]", &["solver.harmonics = [3]", "contains 1"]),
    (
        "[1, 3]",
        "[3, 1]",
        &["solver.harmonics = [3, 1]", "ascending"],
    ),
    (
        "[1, 3]",
        "\"automatic\"",
        &["solver.harmonics = \"automatic\""],
    ),
    (
        "[1, 3]",
        "[1, 101]",
        &["solver.harmonics = [1, 101]", "0 to 100"],
    ),
    (
        "[1, 3]",
        "[1, 3]\nsamples_per_period = 8",
        &["study.toml:43:", "samples_per_period = 8", "from 16"],
    ),
    (
        "[1, 3]",
        "[1, 30]\nsamples_per_period = 64",
        &["samples_per_period = 64", "from 120"],
    ),
    (
        "[1, 3]",
        "[1]\nsearch_harmonics = [3]",
        &["solver.search_harmonics = [3]", "\"all\"", "contains 1"],
    ),
    (
        "[1, 3]",
        "[1, 3]\nhigher_harmonics = \"tuned\"",
        &[
            "solver.higher_harmonics",
            "replaced by basis = \"tuned_receptances\"",
        ],
    ),
    (
        "[1, 3]",
        "[1]\nharmonic_tolerance = 2",
        &["solver.harmonic_tolerance = 2", "1e-6"],
    ),
    (
        "[1, 3]",
        "[1]\nrows_beyond_tolerance = \"drop\"",
        &["rows_beyond_tolerance", "resolve"],
    ),
    (
        "[1, 3]",
        "[1]\nresidual_tolerance = 0",
        &["solver.residual_tolerance = 0", "1e-13"],
    ),
    (
        "[1, 3]",
        "[1]\npeak_tolerance = 1",
        &["solver.peak_tolerance = 1", "0.1"],
    ),
    (
        "[1, 3]",
        "[1]\ntime_samples = 3",
        &["solver.time_samples = 3"],
    ),
    (
        "[1, 3]",
        "[1]\namplitude = \"rms\"",
        &[
            "solver.amplitude = \"rms\"",
            "\"fundamental\", \"time_maximum\"",
        ],
    ),
    (
        "[1, 3]",
        "[1]\nfrequency_band_hz = [580, 540]",
        &["solver.frequency_band_hz = [580, 540]", "ascending"],
    ),
    (
        "[1, 3]",
        "[1]\nfrequency_band_hz = \"wide\"",
        &["solver.frequency_band_hz = \"wide\""],
    ),
    (
        "[1, 3]",
        "[1]\n[output]\ncompression = \"gzip\"",
        &["output.compression = \"gzip\"", "\"zstd\", \"snappy\""],
    ),
    (
        "[1, 3]",
        "[1]\n[output]\npatterns = 1",
        &["output.patterns = 1", "true or false"],
    ),
    (
        "[1, 3]",
        "[1]\n[reduction]\nerror = 0",
        &["reduction.error = 0"],
    ),
    (
        "[1, 3]",
        "[1]\n[reduction]\ncraig_bampton_modes = 0",
        &["reduction.craig_bampton_modes = 0"],
    ),
    (
        "[1, 3]",
        "[1]\n[reduction]\nsensitivity_vectors = -1",
        &["reduction.sensitivity_vectors = -1"],
    ),
    (
        "[1, 3]",
        "[1]\n[reduction]\nbasis = \"rigid\"",
        &["reduction.basis = \"rigid\"", "\"auto\""],
    ),
    (
        "[1, 3]",
        "[1, 101]\nsamples_per_period = 512\n[reduction]\nbasis = \"tuned_receptances\"",
        &["solver.harmonics", "from 0 to 100"],
    ),
    (
        "[1, 3]",
        "[1]\n[reduction]\nbasis = \"tuned_receptances\"\nstick_modes = 4",
        &["reduction.stick_modes", "neither stick_modes nor"],
    ),
    // Normal loads by rotation, damping by nodal diameter, stress.
    (
        "0.3\n",
        "0.3\nnormal_load = { from = \"rotation\", speed_rpm = 3000 }\n",
        &[
            "contact.normal_load.ring_radius_m is missing",
            "no radial degree of freedom",
            "sweep.normal_load_n",
        ],
    ),
    (
        "0.3\n",
        "0.3\nnormal_load = { from = \"thrust\", speed_rpm = 3000 }\n",
        &["contact.normal_load.from = \"thrust\"", "\"rotation\""],
    ),
    (
        "0.3\n",
        "0.3\nnormal_load = { speed_rpm = 3000, ring_radius_m = 0.2 }\n",
        &["contact.normal_load.from is missing"],
    ),
    (
        "0.3\n",
        "0.3\nnormal_load = { from = \"rotation\", ring_radius_m = 0.2 }\n",
        &["contact.normal_load.speed_rpm is missing", "per minute"],
    ),
    (
        "0.3\n",
        "0.3\nnormal_load = { from = \"rotation\", speed_rpm = [3000, 3000], ring_radius_m = 0.2 }\n",
        &["contact.normal_load.speed_rpm = [3000, 3000]", "different"],
    ),
    (
        "0.3\n",
        "0.3\nnormal_load = { from = \"rotation\", speed_rpm = -1, ring_radius_m = 0.2 }\n",
        &["contact.normal_load.speed_rpm = -1", "above 0"],
    ),
    (
        "0.3\n",
        "0.3\nnormal_load = { from = \"rotation\", speed_rpm = 3000, ring_radius_m = 0 }\n",
        &["contact.normal_load.ring_radius_m = 0", "above 0"],
    ),
    (
        "0.3\n",
        "0.3\nnormal_load = { from = \"rotation\", speed_rpm = 3000, ring_radius_m = 0.2, hoop = \"split\" }\n",
        &["contact.normal_load.hoop", "m r Omega^2"],
    ),
    (
        "0.3\n",
        "0.3\nnormal_load = { from = \"rotation\", speed_rpm = 3000, ring_radius_m = 0.2, ring_mass_factor = 0 }\n",
        &["contact.normal_load.ring_mass_factor = 0", "1e-3 to 1e3"],
    ),
    (
        "[excitation]",
        "[nodal_diameter_damping]\n[excitation]",
        &[
            "nodal_diameter_damping.damping_ratios is missing",
            "[[3, 0.0012]",
        ],
    ),
    (
        "[excitation]",
        "[nodal_diameter_damping]\ndamping_ratios = [[1, 0.001], [4, 0.001]]\n[excitation]",
        &[
            "nodal_diameter_damping.damping_ratios[1] = [4, 0.001]",
            "from 0 to 3",
            "6 sectors",
        ],
    ),
    (
        "[excitation]",
        "[nodal_diameter_damping]\ndamping_ratios = [[1, 0.001], [1, 0.002]]\n[excitation]",
        &["damping_ratios[1] = [1, 0.002]", "each once"],
    ),
    (
        "[excitation]",
        "[nodal_diameter_damping]\ndamping_ratios = [[1, -0.001]]\n[excitation]",
        &["damping_ratios[0] = [1, -0.001]", "at least 0 and below 1"],
    ),
    (
        "amplitude_n = 10.0",
        "amplitude_n = [10.0, 20.0]",
        &["excitation.amplitude_n = [10.0, 20.0]", "a list of 1"],
    ),
    (
        "[1, 3]",
        "[1]\n[output]\nstress_pa_per_m = 0",
        &["output.stress_pa_per_m = 0", "Pa/m"],
    ),
    (
        "[1, 3]",
        "[1]\n[output]\nstability = 1001",
        &["output.stability = 1001", "0 to 1000"],
    ),
    // What does not go together.
    (
        "[1, 3]",
        "[1]\n[reduction]\nstick_modes = 4",
        &["reduction.stick_modes", "basis = \"auto\""],
    ),
    (
        "[1, 3]",
        "[1]\n[reduction]\nbasis = \"stick_slide\"\nstick_modes = 4",
        &["reduction.slide_modes is missing"],
    ),
    (
        "[1, 3]",
        "[1]\n[reduction]\nbasis = \"stick_partial_slide\"",
        &[
            "reduction.basis",
            "replaced by \"tuned_receptances\"",
            "\"auto\"",
        ],
    ),
    (
        "[1, 3]",
        "[1]\n[reduction]\npartial_modes = 2",
        &[
            "reduction.partial_modes",
            "replaced by basis = \"tuned_receptances\"",
        ],
    ),
    (
        "[1, 3]",
        "[1]\n[reduction]\nbasis = \"stick_attachment\"\nslide_modes = 4",
        &["reduction.slide_modes"],
    ),
    (
        "source = \"lumped\"",
        "source = \"parametric\"",
        &["study.toml:11:", "model.lumped", "not used"],
    ),
    (
        "source = \"lumped\"",
        "source = \"parametric\"\n[model.parametric]\ndamper = \"underplatform\"\ndamper_shape = \"sphere\"",
        &[
            "study.toml:12: model.parametric.damper_shape = \"sphere\" is not accepted; accepted: \"wedge\", \"cylinder\"",
        ],
    ),
    (
        "source = \"lumped\"",
        "source = \"parametric\"\n[model.parametric]\ndamper_shape = \"cylinder\"",
        &[
            "study.toml:11: model.parametric.damper_shape",
            "not used with damper = \"ring\"; accepted: damper = \"underplatform\", or no damper_shape",
        ],
    ),
    (
        "source = \"lumped\"",
        "source = \"parametric\"\n[model.parametric]\ndamper = \"shroud\"\ndamper_body = \"rigid\"",
        &[
            "study.toml:12: model.parametric.damper_body",
            "not used with damper = \"shroud\"; accepted: damper = \"underplatform\", or no damper_body",
        ],
    ),
    (
        "kind = \"normal\"",
        "kind = \"normal\", standard_deviation = 0.1",
        &["gives it already"],
    ),
    (
        "kind = \"normal\"",
        "kind = \"normal\", truncation = 2",
        &["truncation", "truncated_normal"],
    ),
    (
        "kind = \"normal\"",
        "kind = \"truncated_normal\"",
        &["mistuning.distribution.truncation is missing"],
    ),
    (
        "kind = \"normal\"",
        "kind = \"truncated_normal\", truncation = 0.01",
        &["truncation = 0.01", "0.1 to 10"],
    ),
    (
        "kind = \"normal\"",
        "kind = \"gaussian\"",
        &["mistuning.distribution.kind = \"gaussian\"", "\"normal\""],
    ),
    (
        "kind = \"normal\" }",
        "kind = \"normal\" }\nfile = \"p.csv\"",
        &["mistuning.file gives the patterns"],
    ),
    (
        "distribution = { kind = \"normal\" }",
        "file = \"p.csv\"",
        &["sweep.standard_deviation", "no standard deviation"],
    ),
    (
        "kind = \"normal\" }",
        "kind = \"normal\" }\ncantilever_mode_count = 4",
        &["cantilever_mode_count", "exact"],
    ),
    (
        "kind = \"normal\" }",
        "kind = \"normal\" }\nprojection = \"cmm\"",
        &["mistuning.projection = \"cmm\"", "\"cantilever_modes\""],
    ),
    (
        "kind = \"normal\" }",
        "kind = \"normal\" }\nquantity = \"mass\"",
        &["mistuning.quantity = \"mass\"", "\"blade_stiffness\""],
    ),
    (
        "ring_mass_kg = 0.03\n",
        "",
        &["model.lumped.ring_coupling_stiffness_n_per_m"],
    ),
    (
        "[mistuning]",
        "[stop]\npercentile = 95\n[mistuning]",
        &["stop.relative_width is missing"],
    ),
    (
        "[mistuning]",
        "[stop]\npercentile = 100\nrelative_width = 0.1\n[mistuning]",
        &["stop.percentile = 100", "below 100"],
    ),
    (
        "[mistuning]",
        "[stop]\npercentile = 50\nrelative_width = 0\n[mistuning]",
        &["stop.relative_width = 0", "above 0 and at most 1"],
    ),
    (
        "[mistuning]",
        "[stop]\npercentile = 95\nrelative_width = 0.1\n[mistuning]",
        &[
            "P95 of 10 patterns has no interval",
            "study.patterns from 72 on",
        ],
    ),
    (
        "[mistuning]",
        "[stop]\npercentile = 50\nrelative_width = 0.1\nquantity = \"peak\"\n[mistuning]",
        &["stop.quantity = \"peak\"", "amplification_factor"],
    ),
    (
        "[mistuning]",
        "[stop]\npercentil = 50\n[mistuning]",
        &["unknown key stop.percentil", "did you mean percentile?"],
    ),
    // [accuracy] and the keys of a basis.
    (
        "[solver]\nharmonics = [1, 3]",
        "[reduction]\nbasis = \"stick_slide\"\nslide_modes = 4\nstick_modes = 4\n[accuracy]",
        &[
            "reduction.basis",
            "reduction.slide_modes",
            "accuracy.amplitude_error chooses it",
        ],
    ),
    (
        "[solver]\nharmonics = [1, 3]",
        "[accuracy]\nsimpler_contact_law = true",
        &["accuracy.simpler_contact_law", "as contact.law"],
    ),
    (
        "[solver]\nharmonics = [1, 3]",
        "[accuracy]\namplitude_error = 0.5",
        &[
            "study.toml:42:",
            "accuracy.amplitude_error = 0.5",
            "a number from 0.001 to 0.2",
        ],
    ),
];
