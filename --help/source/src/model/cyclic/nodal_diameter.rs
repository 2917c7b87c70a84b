//! Nodal diameters and the nodal diameter that a temporal harmonic of an engine order excites.

use crate::linalg::Complex64;

/// A cyclic index h in `0..=N/2` together with the direction in which a wave of it travels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NodalDiameter {
    /// Number of nodal diameters, `0..=N/2`.
    pub index: usize,
    /// Whether the wave is that of `N - index`, whose quantities are the complex conjugates.
    pub conjugate: bool,
}

/// Nodal diameter `h = k EO mod N` that temporal harmonic k of an engine order lives in, in a
/// tuned wheel of N sectors; `h > N/2` is the conjugate wave of `N - h`.
#[must_use]
pub fn nodal_diameter_of(harmonic: u32, engine_order: u32, sectors: usize) -> NodalDiameter {
    let h = (u64::from(harmonic) * u64::from(engine_order) % sectors as u64) as usize;
    if 2 * h <= sectors {
        NodalDiameter {
            index: h,
            conjugate: false,
        }
    } else {
        NodalDiameter {
            index: sectors - h,
            conjugate: true,
        }
    }
}

/// Phase `e^{i h n alpha}`; exactly real where the angle is a multiple of a half turn.
#[must_use]
pub fn phase(h: usize, n: usize, sectors: usize) -> Complex64 {
    let steps = h * n % sectors;
    if steps == 0 {
        Complex64::new(1.0, 0.0)
    } else if 2 * steps == sectors {
        Complex64::new(-1.0, 0.0)
    } else {
        Complex64::from_polar(1.0, std::f64::consts::TAU * steps as f64 / sectors as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn engine_orders_alias_onto_nodal_diameters_and_conjugate_waves() {
        let nd = |index, conjugate| NodalDiameter { index, conjugate };
        assert_eq!(nodal_diameter_of(1, 3, 24), nd(3, false));
        assert_eq!(nodal_diameter_of(3, 3, 24), nd(9, false));
        assert_eq!(nodal_diameter_of(5, 3, 24), nd(9, true));
        assert_eq!(nodal_diameter_of(1, 12, 24), nd(12, false));
        assert_eq!(nodal_diameter_of(1, 27, 24), nd(3, false));
        assert_eq!(nodal_diameter_of(2, 3, 8), nd(2, true));
        assert_eq!(nodal_diameter_of(0, 3, 8), nd(0, false));
    }

    #[test]
    fn phases_of_half_turns_are_exactly_real() {
        assert_eq!(phase(12, 3, 24), Complex64::new(-1.0, 0.0));
        assert_eq!(phase(5, 0, 24), Complex64::new(1.0, 0.0));
        assert!((phase(1, 6, 24) - Complex64::new(0.0, 1.0)).norm() < 1e-15);
    }
}
