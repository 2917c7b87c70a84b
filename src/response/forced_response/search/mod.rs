//! The search for the highest peak of curves over frequency: what is known beforehand, samples, summits between them.

mod envelope;
mod peak_search;
mod samples;
pub(super) mod summit;

pub(super) use envelope::VERTEX_SHARE;
pub use envelope::{Envelope, SearchSettings};
pub use peak_search::{SearchEnd, SearchResult, find_peak};
pub(super) use samples::Samples;
pub use samples::{Curve, Sample};

/// Points that fail beside a flank of a steep curve.
#[cfg(test)]
mod tests {
    use super::peak_search::tests::{ENVELOPE, SETTINGS, curves};
    use super::{Curve, Samples, SearchEnd, find_peak};

    /// A curve that can be steeper than the envelope allows for.
    struct Steep<F>(F);

    impl<F: FnMut(f64) -> Option<Vec<f64>>> Curve for Steep<F> {
        fn read(&mut self, frequency_hz: f64) -> Option<Vec<f64>> {
            (self.0)(frequency_hz)
        }

        fn is_steep(&self) -> bool {
            true
        }
    }

    /// A top far narrower than a linear resonance, as where contacts open, on the flank of a broad one.
    fn narrow_top_on_a_flank(f: f64) -> Vec<f64> {
        curves(&[(100.0, 2.0), (101.4, 0.15)], &[&[2.0, 0.12]], f)
    }

    #[test]
    fn a_top_beside_a_failed_point_is_found_from_nearer() {
        // Where single points fail beside the narrow top, the others read the broad one alone.
        let fails = |f: f64| [101.8, 102.2].iter().any(|lost| (f - lost).abs() < 0.06);
        let result = find_peak(
            (92.0, 108.0),
            &[98.0, 100.0, 101.8, 102.2, 104.0],
            ENVELOPE,
            SETTINGS,
            Steep(|f: f64| (!fails(f)).then(|| narrow_top_on_a_flank(f))),
        );
        let best = &result.samples[result.best.expect("evaluated")];
        let highest = (0..16_000)
            .map(|step| narrow_top_on_a_flank(92.0 + 1e-3 * f64::from(step))[0])
            .fold(0.0, f64::max);
        assert_eq!(result.end, SearchEnd::Found);
        assert!(best.largest > (1.0 - 1e-4) * highest, "{best:?} {highest}");
    }

    #[test]
    fn a_wide_gap_of_failed_points_beside_a_high_flank_is_a_hole_and_a_narrow_one_is_none() {
        for (half_gap, end) in [(0.4, SearchEnd::Incomplete), (0.1, SearchEnd::Found)] {
            let result = find_peak(
                (92.0, 108.0),
                &[98.0, 100.0, 101.4, 104.0],
                ENVELOPE,
                SETTINGS,
                Steep(|f: f64| {
                    let solved = (f - 101.4).abs() > half_gap;
                    solved.then(|| curves(&[(100.0, 2.0)], &[&[2.0]], f))
                }),
            );
            assert_eq!(result.end, end, "{half_gap}");
        }
    }

    #[test]
    fn the_top_of_a_blade_that_another_one_exceeds_beside_it_is_a_rival() {
        // Heights 1.3 at 100.4 Hz and 1.2 at 102.2 Hz: at 101 Hz the second blade is the higher one already.
        let mode =
            |top: f64, at: f64, half: f64, f: f64| top / (1.0 + ((f - at) / half).powi(2)).sqrt();
        let mut samples = Samples::default();
        for f in [99.0, 100.0, 101.0, 102.0, 103.0] {
            samples.insert(
                f,
                Some(vec![mode(1.3, 100.4, 0.8, f), mode(1.2, 102.2, 5.0, f)]),
            );
        }
        let best = samples.best().expect("five samples");
        assert!(
            samples
                .0
                .windows(2)
                .take(3)
                .all(|two| two[0].largest < two[1].largest)
        );
        assert_eq!(samples.0[best].blade, 1);
        let rival = samples
            .rival(best, SETTINGS)
            .expect("the first blade's top");
        assert!((rival - 100.4).abs() < 1e-9, "{rival}");
    }
}
