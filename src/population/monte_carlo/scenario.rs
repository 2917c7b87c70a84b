//! One cell of a study: engine order, standard deviation, contact condition.

use crate::response::forced_response::ContactCondition;

/// One scenario; `index` is its place in the product order of the study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scenario {
    /// Index in the order engine order, standard deviation, normal load, each as written.
    pub index: usize,
    /// Engine order of the excitation.
    pub engine_order: u32,
    /// Standard deviation of the blades' relative deviation; none for patterns from a file.
    pub standard_deviation: Option<f64>,
    /// Contact condition.
    pub contact: ContactCondition,
}
