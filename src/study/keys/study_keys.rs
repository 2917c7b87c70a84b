//! The keys of a study file except those of its model and its contact.

use super::Value::{
    Ascending, Either, Flag, List, Name, Number, Numbers, Pairs, Table, Tables, Text, Whole,
};
use super::{Range, Value};
use crate::input::{Entry, REQUIRED, entry};

pub(super) const ABOVE_ZERO: Value = Number(Range::above(0.0));
/// Factor on a force vector, N: the solver was tested over this range, and its square, since the vector itself has the
/// same. Beyond, powers of the response vanish or overflow and peaks are read a few percent off.
pub(in crate::study) const EXCITATION_N: Range = Range::from_to(1e-30, 1e30);
/// Normal load per sector, N.
pub(in crate::study) const NORMAL_LOAD_N: Range = Range::from_to(0.0, 1e30);
const SHARE: Value = Number(Range::above(0.0).below(1.0));
const MODES: Value = Whole(1, 1000);
pub(super) const TRUNCATION: Value = Number(Range::from_to(0.1, 10.0));
const DEVIATION: Value = Number(Range::from_to(0.0, 0.5));

/// What stands before the model.
pub(super) const LEADING_KEYS: &[Entry] = &[
    entry("schema", Whole(1, 1), REQUIRED, "version of the study file"),
    entry("study", Table, REQUIRED, "what the study is"),
    entry(
        "study.name",
        Text("letters, digits, `-`, `_`, the first a letter or digit, at most 100"),
        REQUIRED,
        "names the results folder",
    ),
    entry(
        "study.seed",
        Whole(0, i64::MAX),
        REQUIRED,
        "patterns follow from it and their id alone",
    ),
    entry(
        "study.patterns",
        Whole(1, i32::MAX as i64),
        "required with a distribution; the number in the file with `mistuning.file`",
        "a total: raise it and run again, and only the new patterns are solved",
    ),
];

/// What stands between the model and the contact.
pub(super) const REDUCTION_KEYS: &[Entry] = &[
    entry("reduction", Table, "", "the reduced model"),
    entry(
        "reduction.basis",
        Name(&[
            "auto",
            "stick_slide",
            "stick_attachment",
            "tuned_receptances",
        ]),
        "`\"auto\"`",
        "family of the basis ([formulation.md](formulation.md)). `auto` is `tuned_receptances`, which has none, where the contact has pairs, the ring is locked, and either the sector has more than 12 dofs or harmonics are automatic without `[accuracy]`; else a basis is chosen by `error`. `stick_attachment` means `auto`, and warns where the basis taken has no modes to choose",
    ),
    entry(
        "reduction.error",
        Number(Range::above(0.0).up_to(0.5)),
        "0.001",
        "wanted relative error of the judged peaks by the modes left out, by which their number is chosen where it is not fixed",
    ),
    entry(
        "reduction.stick_modes",
        MODES,
        "chosen",
        "with `stick_slide`, beside `slide_modes`",
    ),
    entry(
        "reduction.slide_modes",
        MODES,
        "chosen",
        "with `stick_slide`, beside `stick_modes`",
    ),
    entry(
        "reduction.craig_bampton_modes",
        MODES,
        "chosen: 25 or more",
        "fixed-interface modes per nodal diameter; without it so many that half as many more change no tuned peak by more than `error`; with `tuned_receptances` 60 or more, so many that half of them change no judged peak by more than that",
    ),
    entry(
        "reduction.sensitivity_vectors",
        Whole(0, 1000),
        "2 where a standard deviation (or the root mean square of the file) reaches 0.05, else 0",
        "per nodal diameter",
    ),
];

/// What stands after the contact.
pub(super) const STUDY_KEYS: &[Entry] = &[
    entry(
        "damping",
        Table,
        REQUIRED,
        "exactly one model of damping of the structure",
    ),
    entry(
        "damping.structural_loss_factor",
        SHARE,
        "none",
        "`K (1 + i eta)`, mistuning included",
    ),
    entry(
        "damping.modal_ratio",
        SHARE,
        "none",
        "viscous, `2 zeta omega_r` on the tuned contact-free modes, unchanged by mistuning",
    ),
    entry(
        "damping.rayleigh",
        Table,
        "none",
        "`C = a M + b K` of the tuned wheel; one of a and b above 0",
    ),
    entry(
        "damping.rayleigh.mass_per_s",
        Number(Range::at_least(0.0)),
        REQUIRED,
        "a, 1/s",
    ),
    entry(
        "damping.rayleigh.stiffness_s",
        Number(Range::at_least(0.0)),
        REQUIRED,
        "b, s",
    ),
    entry(
        "nodal_diameter_damping",
        Table,
        "",
        "damping of the tuned modes by nodal diameter, besides",
    ),
    entry(
        "nodal_diameter_damping.damping_ratios",
        Pairs(
            ["nodal diameter", "damping ratio"],
            [0, 5000],
            Range::at_least(0.0).below(1.0),
        ),
        REQUIRED,
        "each nodal diameter once, up to N/2; those left out have none",
    ),
    entry(
        "nodal_diameter_damping.modes",
        Name(&["blade", "all"]),
        "`\"blade\"`",
        "`blade`: each mode by the share of its strain energy in the blade; `all`: every mode of the nodal diameter alike",
    ),
    entry("excitation", Table, REQUIRED, "the rotating force"),
    entry(
        "excitation.engine_orders",
        List(&Whole(0, 10_000)),
        "required unless every `load_case` has its own",
        "one scenario each, never simultaneous",
    ),
    entry(
        "excitation.amplitude_n",
        Either(&[Number(EXCITATION_N), Numbers(EXCITATION_N)]),
        "1.0",
        "multiplies the model's force vector; a list: one per engine order, in their order",
    ),
    entry(
        "excitation.load_case",
        Tables,
        "none",
        "load cases: force vectors with engine orders of their own",
    ),
    entry(
        "excitation.load_case.name",
        Text("letters, digits, `-`, `_`, the first a letter or digit, at most 40"),
        REQUIRED,
        "names the load case in every table and report; each has another",
    ),
    entry(
        "excitation.load_case.force",
        Text("a file"),
        "the model's force vector",
        "force vector as that of a bundle: CSV with the columns `dof`, `re`, `im`, in N",
    ),
    entry(
        "excitation.load_case.node",
        Text("name of an observed node"),
        "none",
        "instead of `force`: 1 N at this node of the model",
    ),
    entry(
        "excitation.load_case.direction",
        Numbers(Range::ANY),
        "required with `node`",
        "where that force points to: `[r, theta, z]`, of any length",
    ),
    entry(
        "excitation.load_case.engine_orders",
        List(&Whole(0, 10_000)),
        "those of `[excitation]`",
        "as above",
    ),
    entry(
        "excitation.load_case.amplitude_n",
        Either(&[Number(EXCITATION_N), Numbers(EXCITATION_N)]),
        "that of `[excitation]`",
        "multiplies the force vector of this load case",
    ),
    entry("mistuning", Table, REQUIRED, "the random blades"),
    entry(
        "mistuning.quantity",
        Name(&["blade_stiffness"]),
        "`\"blade_stiffness\"`",
        "a relative deviation delta of the blade's stiffness; the deviation in frequency is about delta/2",
    ),
    entry(
        "mistuning.projection",
        Name(&["exact", "cantilever_modes"]),
        "`\"exact\"`",
        "`cantilever_modes`: the classical component mode mistuning; required for deviations per mode",
    ),
    entry(
        "mistuning.cantilever_mode_count",
        MODES,
        "10",
        "only with `cantilever_modes`",
    ),
    entry(
        "mistuning.distribution",
        Table,
        "required without `mistuning.file`",
        "the law of the deviations",
    ),
    entry(
        "mistuning.distribution.kind",
        Name(&["normal", "uniform", "truncated_normal"]),
        REQUIRED,
        "",
    ),
    entry(
        "mistuning.distribution.truncation",
        TRUNCATION,
        "required for `truncated_normal`",
        "in standard deviations of the normal law before it is cut",
    ),
    entry(
        "mistuning.distribution.standard_deviation",
        DEVIATION,
        "in `[sweep]`",
        "of the law after truncation",
    ),
    entry(
        "mistuning.file",
        Text("`.parquet`, or anything else as CSV"),
        "none",
        "measured wheels instead of a distribution: columns `pattern`, `blade`, `deviation` and optionally `mode`",
    ),
    entry("sweep", Table, "", "the scenarios"),
    entry(
        "sweep.normal_load_n",
        List(&Either(&[
            Number(NORMAL_LOAD_N),
            Name(&["stuck", "slide", "free"]),
        ])),
        "required without `contact.normal_load`",
        "N per sector, and the linear limits; only `free` for a model without contact",
    ),
    entry(
        "sweep.standard_deviation",
        List(&DEVIATION),
        "in the distribution",
        "not with `mistuning.file`",
    ),
    entry("solver", Table, "", "the solution of a row"),
    entry(
        "solver.harmonics",
        Either(&[Name(&["auto"]), Ascending(&Whole(0, 100), None)]),
        "`\"auto\"`",
        "`auto`: 0 to 15, on a basis per engine order and load by the tuned full contact model ([formulation.md](formulation.md)); a list has 1 among them",
    ),
    entry(
        "solver.search_harmonics",
        Either(&[Name(&["auto", "all"]), Ascending(&Whole(0, 100), None)]),
        "`\"auto\"`",
        "local maxima of the response are located with these, then solved with `harmonics` ([formulation.md](formulation.md)); `auto`: where contact rows are few, 1 at points far below the peak; else 1 where the equation is large; `all`: located with `harmonics`",
    ),
    entry(
        "solver.harmonic_tolerance",
        Number(Range::from_to(1e-6, 1.0)),
        "0.02",
        "wanted relative error of the amplitude by the harmonics left out; on a basis `auto` chooses by it; rows beyond it are marked",
    ),
    entry(
        "solver.rows_beyond_tolerance",
        Name(&["flag", "resolve"]),
        "`\"flag\"`",
        "`resolve`: with automatic harmonics on a basis, such rows are solved again with the set of a quarter of the tolerance",
    ),
    entry(
        "solver.samples_per_period",
        Whole(16, 65_536),
        "128",
        "at least 4 times the highest harmonic; an automatic set takes at least 12 per period of its highest harmonic",
    ),
    entry(
        "solver.residual_tolerance",
        Number(Range::from_to(1e-13, 1e-2)),
        "1e-8",
        "residual force relative to the excitation; where nothing is said, peaks with automatic harmonics on tuned receptances are solved to half of `peak_tolerance`",
    ),
    entry(
        "solver.peak_tolerance",
        Number(Range::from_to(1e-10, 0.1)),
        "1e-3",
        "relative, of the peak amplitude",
    ),
    entry(
        "solver.amplitude",
        Name(&["fundamental", "time_maximum"]),
        "`\"fundamental\"`",
        "`fundamental`: norm over r, theta, z of the complex amplitude of harmonic 1; `time_maximum`: largest norm over a period, harmonic 0 left out",
    ),
    entry(
        "solver.time_samples",
        Whole(16, 65_536),
        "1024",
        "instants for `time_maximum`",
    ),
    entry(
        "solver.frequency_band_hz",
        Either(&[Name(&["auto"]), Ascending(&ABOVE_ZERO, Some(2))]),
        "`\"auto\"`",
        "where peaks are sought, Hz",
    ),
    entry(
        "accuracy",
        Table,
        "",
        "basis, harmonics and tolerances by a measured error",
    ),
    entry(
        "accuracy.amplitude_error",
        Number(Range::from_to(0.001, 0.2)),
        "0.01",
        "relative error of the peak amplitude that 95 % of the rows are to keep",
    ),
    entry(
        "accuracy.simpler_contact_law",
        Flag,
        "false",
        "whether `macro_slip_2d` or `simplified_3d` may take the place of the law of the study, where the error allows it",
    ),
    entry(
        "stop",
        Table,
        "",
        "when a study may end before all patterns",
    ),
    entry(
        "stop.percentile",
        Number(Range::above(0.0).below(100.0)),
        REQUIRED,
        "in percent; `study.patterns` must allow it an interval (72 for 95, 368 for 99)",
    ),
    entry(
        "stop.relative_width",
        Number(Range::above(0.0).up_to(1.0)),
        REQUIRED,
        "width of the interval over the percentile",
    ),
    entry(
        "stop.quantity",
        Name(&["peak_amplitude_m", "amplification_factor"]),
        "`\"peak_amplitude_m\"`",
        "",
    ),
    entry("output", Table, "", "what is written, and how"),
    entry(
        "output.patterns",
        Flag,
        "true up to 10,000 patterns",
        "whether `patterns.parquet` is written",
    ),
    entry(
        "output.compression",
        Name(&["zstd", "snappy"]),
        "`\"zstd\"`",
        "",
    ),
    entry(
        "output.stress_pa_per_m",
        ABOVE_ZERO,
        "none",
        "stress per amplitude of the observed node, Pa/m: amplitudes are told as stress too",
    ),
    entry(
        "output.stability",
        Whole(0, 1000),
        "0",
        "rows nearest to P5, P50, P95 and P99 of the amplitude of every scenario whose motions, and those of the tuned wheel, are looked at for their stability; seconds each ([formulation.md](formulation.md))",
    ),
];
