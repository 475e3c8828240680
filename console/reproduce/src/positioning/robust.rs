//! Estimators when the ranges are not what they should be.

use super::{
    method::{self, Method},
    scene::{Layout, Scene, chance, on_disc},
    tally::{Outcome, rows},
};
use crate::{
    bench::Bench,
    row::Row,
    study::{Options, Problem, Study},
};
use positioning::{Calibration, Nls, PositionSolver, Unknowns};
use sim::{BehindColumns, Disturbances, NoiseModel, StationFault};
use std::time::Instant;
use world::{Point, RangeSet, StationId};

pub(super) const STUDY: Study = Study {
    name: "positioning-robust",
    about: "estimators on the same ranges with hidden stations, wild pings, echoes, bad surveys and slow sound",
    layouts: 10_000,
    run,
};

const METHODS: [Method; 6] = [
    method::LINEAR,
    method::NLS,
    method::NLS_TRIMMED,
    method::NLS_SCREENED,
    method::BOUNDED_OR_NLS,
    method::CONSENSUS,
];
/// Id of the method that finds the speed of sound from its session.
const CALIBRATED: &str = "nls/calibrated";
/// Truths of one piece of work, which also is one session.
const SESSION: usize = 250;

/// What goes wrong in a case.
#[derive(Clone, Copy)]
struct Trouble {
    id: &'static str,
    columns: bool,
    set: fn(&mut Disturbances),
}

const TROUBLES: [Trouble; 13] = [
    Trouble { id: "clean", columns: false, set: |_| {} },
    Trouble {
        id: "outliers-10",
        columns: false,
        set: |d| (d.outlier_probability, d.outlier_factor) = (0.1, 10.0),
    },
    Trouble { id: "late-pings-25", columns: false, set: |d| d.late_ping_probability = 0.25 },
    Trouble { id: "nlos-20", columns: false, set: |d| d.nlos_probability = 0.2 },
    Trouble { id: "bias-1", columns: false, set: |_| {} },
    Trouble { id: "columns-creeping", columns: true, set: |d| d.behind_columns = BehindColumns::Creeping },
    Trouble { id: "columns-late", columns: true, set: |d| d.behind_columns = BehindColumns::Late },
    Trouble { id: "columns-echo", columns: true, set: |d| d.behind_columns = BehindColumns::WallEcho },
    Trouble { id: "columns-silent", columns: true, set: |d| d.behind_columns = BehindColumns::Silent },
    Trouble { id: "dropout-30", columns: false, set: |d| d.ping_dropout_probability = 0.3 },
    Trouble { id: "survey-0.05", columns: false, set: |d| d.survey_sigma_m = 0.05 },
    Trouble { id: "sound+1", columns: false, set: |d| d.sound_speed_error_ratio = 0.01 },
    Trouble { id: "sound+2", columns: false, set: |d| d.sound_speed_error_ratio = 0.02 },
];

struct Case {
    id: String,
    scene: Scene,
    biased: bool,
}

fn cases() -> Vec<Case> {
    let layouts = [
        Layout::Paper,
        Layout::Ring(4, 7.5),
        Layout::Ring(6, 7.5),
        Layout::Ring(7, 7.5),
        Layout::Ring(8, 7.5),
    ];
    layouts
        .into_iter()
        .flat_map(|layout| TROUBLES.map(|trouble| (layout, trouble)))
        .map(|(layout, trouble)| {
            let mut disturbances = Disturbances { excess_range_mean_m: 1.0, ..Disturbances::default() };
            (trouble.set)(&mut disturbances);
            let scene = Scene::new(layout, NoiseModel::Uniform { ratio: 0.05 }, 20).disturbed(disturbances);
            Case {
                id: format!("disc/{}/{}", layout.id(), trouble.id),
                scene: Scene { columns: trouble.columns, ..scene },
                biased: trouble.id == "bias-1",
            }
        })
        .collect()
}

fn run(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let cases: Vec<Case> = cases().into_iter().filter(|case| options.has_case(&case.id)).collect();
    let methods: Vec<Method> = METHODS.into_iter().filter(|m| options.has_method(m.id)).collect();
    let seeds: Vec<u64> = options.seeds(study.layouts).collect();
    let work: Vec<(usize, &[u64])> =
        (0..cases.len()).flat_map(|case| seeds.chunks(SESSION).map(move |piece| (case, piece))).collect();
    let calibrates = options.has_method(CALIBRATED);
    let done =
        bench.map(&work, |_, (case, piece)| Ok(session(&cases[*case], piece, &methods, calibrates)))?;
    let mut all = Vec::new();
    let ids: Vec<&str> = methods.iter().map(|m| m.id).chain(calibrates.then_some(CALIBRATED)).collect();
    for (k, case) in cases.iter().enumerate() {
        for (m, id) in ids.iter().enumerate() {
            let of_case = work.iter().zip(&done).filter(|((of, _), _)| *of == k);
            let outcomes: Vec<Outcome> = of_case.flat_map(|(_, done)| done[m].iter().copied()).collect();
            if !outcomes.is_empty() {
                all.extend(rows(study.name, &case.id, id, &outcomes));
            }
        }
    }
    Ok(all)
}

/// The outcomes of each method.
fn session(case: &Case, seeds: &[u64], methods: &[Method], calibrates: bool) -> Vec<Vec<Outcome>> {
    let scene = &case.scene;
    let noise = scene.noise();
    let obstacles = scene.obstacles();
    let n = scene.stations.len() as u64;
    let cycles: Vec<(Point, Vec<RangeSet>)> = seeds
        .iter()
        .map(|seed| {
            let mut rng = chance(*seed, 1);
            let is_free = |at: &Point| obstacles.iter().all(|o| o.shape.distance_m(*at) > 0.25);
            let truth = std::iter::repeat_with(|| on_disc(&mut rng)).find(is_free).unwrap_or_default();
            let mut scene = scene.clone();
            if case.biased {
                let station = StationId((seed % n) as u32 + 1);
                let fault = StationFault { station, from_s: 0.0, to_s: 1.0, excess_range_m: Some(1.0) };
                scene.ae.disturbances.faults = vec![fault];
            }
            (truth, scene.sounder(*seed).cycle(0.0, truth))
        })
        .collect();
    let mut done: Vec<Vec<Outcome>> = methods
        .iter()
        .map(|method| {
            cycles
                .iter()
                .map(|(truth, sets)| {
                    let began = Instant::now();
                    let fix = method.fix(sets, &scene.stations, &noise);
                    Outcome::of(&fix, *truth, began.elapsed().as_secs_f64() * 1e6)
                })
                .collect()
        })
        .collect();
    if calibrates {
        done.push(calibrated(case, &cycles));
    }
    done
}

/// Nonlinear least squares after the speed of sound was estimated from the ranges of the whole session.
fn calibrated(case: &Case, cycles: &[(Point, Vec<RangeSet>)]) -> Vec<Outcome> {
    let (stations, noise) = (&case.scene.stations, case.scene.noise());
    if stations.len() < 4 {
        return Vec::new();
    }
    let mut calibration = Calibration::new(stations, Unknowns::default());
    for (_, sets) in cycles {
        if let Ok(ranges) = method::NLS.ranges(sets, &noise) {
            let _ = calibration.take(&ranges, None);
        }
    }
    cycles
        .iter()
        .map(|(truth, sets)| {
            let fix = method::NLS
                .ranges(sets, &noise)
                .and_then(|ranges| Nls.solve(&calibration.corrected(&ranges), stations, None));
            Outcome::of(&fix, *truth, 0.0)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::Sample;

    fn mean(id: &str, method: usize) -> f64 {
        let case = cases().into_iter().find(|case| case.id == id).expect("a case");
        let seeds: Vec<u64> = (0..400).collect();
        let done = session(&case, &seeds, &METHODS, true);
        done[method].iter().filter_map(|o| o.error_m).collect::<Sample>().mean().expect("fixes")
    }

    #[test]
    fn consensus_bears_hidden_stations_and_least_squares_do_not() {
        let (nls, consensus) = (mean("disc/8-stations/nlos-20", 1), mean("disc/8-stations/nlos-20", 5));
        assert!(consensus < 0.07 && consensus < 0.4 * nls, "{consensus} {nls}");
    }

    #[test]
    fn a_calibrated_session_does_not_mind_slow_sound() {
        let (slow, clean) = (mean("disc/6-stations/sound+2", 6), mean("disc/6-stations/clean", 1));
        assert!(slow < 1.08 * clean, "{slow} {clean}");
    }

    #[test]
    fn every_trouble_has_its_case_for_every_layout() {
        assert_eq!(cases().len(), 5 * TROUBLES.len());
    }
}
