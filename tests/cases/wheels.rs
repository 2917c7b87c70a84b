use super::support::*;
use blisk::model::reduction::BasisChoice;
use blisk::response::forced_response::ContactCondition;

#[test]
fn explore() {
    for (name, case) in [("wheel8", Case::wheel8()), ("wheel24", Case::wheel24())] {
        let t0 = std::time::Instant::now();
        let choice = match std::env::var("BASIS").as_deref() {
            Ok("ss") => {
                let n: usize = std::env::var("M").unwrap().parse().unwrap();
                BasisChoice::StickSlide { stick: n, slide: n }
            }
            _ => BasisChoice::StickAttachment { stick: 4 },
        };
        let model = case.reduce(choice);
        eprintln!(
            "{name} reduce {:?} size {} cond {:?}",
            t0.elapsed(),
            model.wheel_size(),
            model.report.iter().map(|r| r.condition).fold(0.0, f64::max)
        );
        for row in &case.peaks.rows {
            let contact = case.peaks.text(row, "contact");
            let load = case.peaks.number(row, "load");
            let harmonics: Vec<u32> = case
                .peaks
                .text(row, "harmonics")
                .split('-')
                .map(|k| k.parse().unwrap())
                .collect();
            if harmonics.contains(&0) || harmonics.len() > 2 {
                continue;
            }
            let condition = match contact {
                "free" => ContactCondition::Free,
                "slide" => ContactCondition::Slide,
                "stuck" => ContactCondition::Stuck,
                _ => ContactCondition::Full {
                    normal_load_n: load,
                },
            };
            let dev =
                (case.peaks.text(row, "pattern") == "1").then_some(case.deviations.as_slice());
            let t0 = std::time::Instant::now();
            let p = solve(&case, &model, dev, condition, &harmonics);
            let a = case.peaks.number(row, "amplitude");
            let f = case.peaks.number(row, "frequency_hz");
            let pt = p.point.as_ref();
            eprintln!(
                "{name} {} {contact} {load} {:?}: {:?} amp err {:+.4}% f err {:+.4}% blade {} vs {} work {:?} {:?}",
                case.peaks.text(row, "pattern"),
                harmonics,
                p.status,
                100.0 * (pt.map_or(0.0, |x| x.amplitudes_m[p.blade]) / a - 1.0),
                100.0 * (pt.map_or(0.0, |x| x.frequency_hz) / f - 1.0),
                p.blade,
                case.peaks.text(row, "blade"),
                p.work,
                t0.elapsed()
            );
        }
    }
}
