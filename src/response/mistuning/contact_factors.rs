//! What the contact of one wheel is, relative to the nominal one.

use serde::Serialize;

/// Factors on the nominal parameters of one contact pair.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PairFactors {
    /// On the coefficient of friction.
    pub friction_coefficient: f64,
    /// On the tangential contact stiffness.
    pub tangential_stiffness: f64,
    /// On the normal contact stiffness.
    pub normal_stiffness: f64,
    /// On the normal load.
    pub normal_load: f64,
}

impl Default for PairFactors {
    fn default() -> Self {
        Self {
            friction_coefficient: 1.0,
            tangential_stiffness: 1.0,
            normal_stiffness: 1.0,
            normal_load: 1.0,
        }
    }
}

impl PairFactors {
    fn each(self) -> [f64; 4] {
        [
            self.friction_coefficient,
            self.tangential_stiffness,
            self.normal_stiffness,
            self.normal_load,
        ]
    }
}

/// Factors of every pair of a wheel, sector after sector; without any, the contact is nominal.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ContactFactors {
    pairs: Vec<PairFactors>,
}

impl ContactFactors {
    /// Factors of `pairs`, sector after sector.
    #[must_use]
    pub fn new(pairs: Vec<PairFactors>) -> Self {
        Self { pairs }
    }

    /// Factors of every pair, sector after sector; empty for the nominal contact.
    #[must_use]
    pub fn pairs(&self) -> &[PairFactors] {
        &self.pairs
    }

    /// Whether the contact is the nominal one.
    #[must_use]
    pub fn is_nominal(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Whether every factor can be: finite and above zero.
    #[must_use]
    pub fn are_possible(&self) -> bool {
        let factors = self.pairs.iter().flat_map(|pair| pair.each());
        factors
            .into_iter()
            .all(|factor| factor.is_finite() && factor > 0.0)
    }

    /// Means over the pairs of the wheel; none for the nominal contact.
    #[must_use]
    pub fn means(&self) -> Option<PairFactors> {
        let count = self.pairs.len() as f64;
        let mean = |of: fn(&PairFactors) -> f64| self.pairs.iter().map(of).sum::<f64>() / count;
        (!self.is_nominal()).then(|| PairFactors {
            friction_coefficient: mean(|pair| pair.friction_coefficient),
            tangential_stiffness: mean(|pair| pair.tangential_stiffness),
            normal_stiffness: mean(|pair| pair.normal_stiffness),
            normal_load: mean(|pair| pair.normal_load),
        })
    }

    /// Contact springs of the wheel, N/m, from the nominal ones of a sector. `rows` are the rows of the
    /// normal, first and second tangential motion of each pair of a sector; the springs come sector
    /// after sector, or once for all sectors where the contact is nominal.
    #[must_use]
    pub fn springs(&self, sector: &[f64], rows: &[[Option<usize>; 3]]) -> Vec<f64> {
        if self.is_nominal() {
            return sector.to_vec();
        }
        let mut springs = Vec::new();
        for of_sector in self.pairs.chunks(rows.len().max(1)) {
            let first = springs.len();
            springs.extend_from_slice(sector);
            for (pair, places) in of_sector.iter().zip(rows) {
                let tangential = pair.tangential_stiffness;
                let factors = [pair.normal_stiffness, tangential, tangential];
                for (place, factor) in places.iter().zip(factors) {
                    if let Some(row) = *place {
                        springs[first + row] *= factor;
                    }
                }
            }
        }
        springs
    }
}
