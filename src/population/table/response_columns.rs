//! The columns of `responses.parquet`.

use super::column::{ColumnKind, ColumnSpec, key};

use ColumnKind::{Boolean, Float64, Int32, Int64, String as Text};

/// Columns of `responses.parquet`.
pub const RESPONSE_COLUMNS: &[ColumnSpec] = &[
    key::SCENARIO,
    key::CONTACT,
    key::ENGINE_ORDER,
    key::NORMAL_LOAD,
    key::STANDARD_DEVIATION,
    key::PATTERN,
    ColumnSpec::new(
        "status",
        Text,
        "",
        "How the solution ended; every value but ok is a failure and has nulls",
    ),
    ColumnSpec::new(
        "peak_amplitude_m",
        Float64,
        "m",
        "Largest amplitude over blades and frequency",
    ),
    ColumnSpec::new(
        "peak_frequency_hz",
        Float64,
        "Hz",
        "Excitation frequency of the peak",
    ),
    ColumnSpec::new("peak_blade", Int32, "", "Blade of the peak, from 0"),
    ColumnSpec::new(
        "amplification_factor",
        Float64,
        "1",
        "Peak amplitude over the tuned peak of the same normal load, engine order and solver settings",
    ),
    ColumnSpec::new(
        "peak_bracketed",
        Boolean,
        "",
        "Lower amplitudes were seen on both sides of the peak",
    ),
    ColumnSpec::new(
        "harmonics",
        Text,
        "",
        "Temporal harmonics of the solution, for instance 1-3",
    ),
    ColumnSpec::new("nonlinear_solves", Int64, "1", "Nonlinear solves used"),
    ColumnSpec::new("newton_iterations", Int64, "1", "Newton iterations used"),
    ColumnSpec::new(
        "residual",
        Float64,
        "1",
        "Residual force relative to the excitation at the peak",
    ),
    ColumnSpec::new(
        "slipping_fraction",
        Float64,
        "1",
        "Share of contact pairs that slip in any direction at any instant, at the peak",
    ),
    ColumnSpec::new(
        "separated_fraction",
        Float64,
        "1",
        "Share of contact pairs without normal load at any instant, at the peak",
    ),
    ColumnSpec::new(
        "shortcut",
        Text,
        "",
        "What was left out: linear, stuck, or none; after the simplification of the contact law, if there is one",
    ),
    ColumnSpec::new(
        "retries",
        Int64,
        "1",
        "Nonlinear solves that needed more than the first attempt of the retry ladder",
    ),
    ColumnSpec::new(
        "factorisations",
        Int64,
        "1",
        "Jacobians assembled and factored, all attempts",
    ),
    ColumnSpec::new(
        "mean_friction_circumferential_n",
        Float64,
        "N",
        "Mean friction force on the ring along theta per sector (torque over the mean contact radius) at the peak, mean over the sectors; null for the linear limits",
    ),
    ColumnSpec::new(
        "mean_friction_axial_n",
        Float64,
        "N",
        "Mean friction force on the ring along z per sector at the peak, mean over the sectors; null for the linear limits",
    ),
    ColumnSpec::new(
        "sampling_error",
        Float64,
        "1",
        "Relative change of the peak amplitude by one Newton correction at 4 times the samples per period and under the law of the study",
    ),
    ColumnSpec::new(
        "harmonic_error",
        Float64,
        "1",
        "Relative change of the peak amplitude by the harmonics up to 15 outside of the set",
    ),
    ColumnSpec::new(
        "stated_error",
        Float64,
        "1",
        "Bound on the relative error of the peak amplitude: sampling, harmonics, basis and peak tolerance together",
    ),
    ColumnSpec::new(
        "error_within_tolerance",
        Boolean,
        "",
        "Sampling and harmonic error are within their tolerances",
    ),
    ColumnSpec::new(
        "basis",
        Text,
        "",
        "Basis of the reduced model that the row was solved on",
    ),
    ColumnSpec::new(
        "friction_coefficient_factor",
        Float64,
        "1",
        "Factor on the coefficient of friction of this wheel, mean over its pairs; null where the contact does not vary",
    ),
    ColumnSpec::new(
        "tangential_stiffness_factor",
        Float64,
        "1",
        "Factor on the tangential contact stiffness of this wheel, mean over its pairs; null where the contact does not vary",
    ),
    ColumnSpec::new(
        "normal_stiffness_factor",
        Float64,
        "1",
        "Factor on the normal contact stiffness of this wheel, mean over its pairs; null where the contact does not vary",
    ),
    ColumnSpec::new(
        "normal_load_factor",
        Float64,
        "1",
        "Factor on the normal load of this wheel, mean over its pairs; null where the contact does not vary",
    ),
    ColumnSpec::new(
        "stable",
        Boolean,
        "",
        "Small disturbances of the motion at the peak die out; null where that was not looked at, see output.stability, or is not settled",
    ),
];
