//! The solution of a point by way of softer contact.
//!
//! What sticks or slips changes within `mu N0 / kt`, so that in stiff contact a solution is hard to find from one that is not near. Over
//! `1 / kt` the solution tends to that of rigid contact along a line. So each stage begins at the extrapolation of the two before it in
//! `1 / kt`.

/// Softest contact: this power of [`RATIO`] below the wanted one.
const STAGES: f64 = 6.0;
const RATIO: f64 = 4.0;
/// Smallest step of its exponent.
const SMALLEST_STEP: f64 = 1.0 / 8.0;

/// Motions of the wanted contact, from the softest one on; none where a stage on the way is not found. `solved` gives the motions under
/// a share of the wanted stiffness, from the best of several motions, or from the linear response without any.
pub(super) fn from_softer_contact(
    mut solved: impl FnMut(f64, &[Vec<f64>]) -> Option<Vec<f64>>,
) -> Option<Vec<f64>> {
    let (mut exponent, mut step) = (STAGES, 1.0);
    let mut solved_with =
        |exponent: f64, starts: &[Vec<f64>]| solved(RATIO.powf(-exponent), starts);
    let compliance = |exponent: f64| RATIO.powf(exponent);
    let mut current = solved_with(exponent, &[])?;
    let mut previous: Option<(f64, Vec<f64>)> = None;
    loop {
        let next = f64::max(exponent - step, 0.0);
        let start = match &previous {
            None => current.clone(),
            Some((before, motions)) => {
                let share = (compliance(next) - compliance(exponent))
                    / (compliance(exponent) - compliance(*before));
                let pairs = current.iter().zip(motions);
                pairs.map(|(now, old)| now + share * (now - old)).collect()
            }
        };
        match solved_with(next, &[start]) {
            Some(motions) if next <= 0.0 => return Some(motions),
            Some(motions) => {
                previous = Some((exponent, std::mem::replace(&mut current, motions)));
                exponent = next;
                step = f64::min(2.0 * step, 1.0);
            }
            None if step > SMALLEST_STEP => step *= 0.5,
            None => return None,
        }
    }
}
