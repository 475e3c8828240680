//! The combined result of several runs on one floor: a scan and its re-scans.

pub use crate::past_run::PastRun;
use crate::{
    guarantee::Rule,
    human::{
        floor,
        text::{Text, overlap, percent},
    },
    joined::{joined, require_scans},
};
use account::{Account, Calibration, Coverage, Summary, not_as_surveyed};
use serde::Serialize;
use world::{CellRun, KindRun, coverage::runs_of};

/// The combined scan of several runs. Every run keeps its own recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Merged {
    /// The runs, in the order given.
    pub runs: Vec<MergedRun>,
    /// The coverage of all runs together.
    pub coverage: Coverage,
    /// The account of the floor over all runs together.
    pub floor: Account,
    /// The cells that count as scanned, in the order of the floor's cells; not part of the file.
    #[serde(skip)]
    pub scanned: Vec<CellRun>,
    /// The cells that none of the runs had to scan, in the order of the floor's cells; not part of the file.
    #[serde(skip)]
    pub not_requested: Vec<CellRun>,
    /// The kinds of the cells of the joined floor: obstacles found and zones drawn in any run are applied; not part of the
    /// file.
    #[serde(skip)]
    pub kinds: Vec<KindRun>,
}

/// One of several runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MergedRun {
    /// Name of the run's folder.
    pub run: String,
    /// SHA-256 of the run's journal, hexadecimal; absent if there is no journal.
    pub journal_sha256: Option<String>,
    /// SHA-256 of the run's recording, hexadecimal; absent if there is no recording.
    pub recording_sha256: Option<String>,
    /// Width of floor scanned in one pass, metres.
    pub swath_m: f64,
    /// Limit of the 95 % position error above which nothing counted as scanned, metres.
    pub position_limit_m: f64,
    /// The figures of this run alone, without the account of the floor.
    pub summary: Summary,
}

/// Combines several runs.
///
/// # Errors
/// There is no run, a run is given twice or was not a scan, or the cells or tanks differ.
pub fn merged(runs: &[PastRun]) -> Result<Merged, String> {
    require_scans(runs)?;
    let all = joined(runs)?;
    let opened = |past: &PastRun| past.fold.run().map(|run| run.mission.clone());
    let listed = runs.iter().filter_map(|past| {
        let mission = opened(past)?;
        Some(MergedRun {
            run: past.name.clone(),
            journal_sha256: past.files.journal_sha256.clone(),
            recording_sha256: past.files.recording_sha256.clone(),
            swath_m: mission.swath_m,
            position_limit_m: mission.scan_limit_m(),
            summary: Summary { floor: None, logs: Some(past.logs.clone()), ..past.summary.clone() },
        })
    });
    let listed: Vec<MergedRun> = listed.collect();
    let grid = all.scanned.believed();
    let scanned = runs_of((0..grid.floor().len()).filter(|index| grid.is_covered(*index)));
    let kinds = grid.floor().kinds();
    let not_requested = runs_of((0..grid.floor().len()).filter(|index| !all.evidence.is_asked(*index)));
    Ok(Merged {
        coverage: all.scanned.coverage(true),
        floor: all.account(runs),
        scanned,
        not_requested,
        kinds,
        runs: listed,
    })
}

impl Merged {
    /// The result as text for people.
    pub fn human(&self) -> String {
        let mut text = Text::new("combined result of several runs on one floor");
        for run in &self.runs {
            run.write(&mut text);
        }
        text.some(
            "true position",
            self.coverage.by_truth.map(|truth| {
                let (reachable, whole) = (percent(truth.reachable), percent(truth.whole));
                format!("{reachable} of reachable floor, {whole} of whole floor")
            }),
        );
        text.some("overlap", self.coverage.overlap.map(overlap));
        text.some("in doubt", self.coverage.taken_back.map(|floor| floor.to_string()));
        let rule = Rule::of(self.runs.iter().map(|run| run.summary.accuracy.as_ref()));
        text.lines(floor::lines(&self.floor, rule));
        text.0
    }
}

impl MergedRun {
    fn write(&self, text: &mut Text) {
        let word = self.summary.outcome.map_or("cut off", mission::Outcome::word);
        let share = percent(self.summary.coverage.as_ref().map_or(0.0, |coverage| coverage.reachable));
        text.line("run", format!("{}: {word}, {share} of reachable floor on its own", self.run));
        let files = self.summary.logs.as_ref();
        let mut file = |kind: &str, path: Option<&String>, sha256: &Option<String>| {
            let sha256 = sha256.as_ref().map(|sha256| format!(", sha256 {sha256}")).unwrap_or_default();
            text.line(
                "",
                path.map_or_else(|| format!("{kind} none"), |path| format!("{kind} {path}{sha256}")),
            );
        };
        file("recording", files.and_then(|logs| logs.recording.as_ref()), &self.recording_sha256);
        file("journal", files.and_then(|logs| logs.journal.as_ref()), &self.journal_sha256);
        text.some("WARNING", files.and_then(|logs| logs.error.as_ref()));
        text.some("WARNING", not_as_surveyed(&self.summary.pulse_tests));
        text.lines(self.summary.calibration.iter().flat_map(Calibration::sentences).map(|line| ("", line)));
        text.lines(self.summary.taken_back.iter().map(|floor| ("", format!("in doubt {floor}"))));
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::{document::Files, record::Record, samples::round_tank};
    use account::{Fold, Logs};
    use mission::{Event, EventKind, RunOpened};
    use world::{CellRun, FloorMaker, Obstacle, ObstacleId, Shape};

    fn opened(name: &str, run: RunOpened, events: Vec<EventKind>) -> PastRun {
        let mut fold = Fold::new();
        for kind in [EventKind::RunOpened(Box::new(run))].into_iter().chain(events) {
            fold.apply(&Event { tick: 0, t_s: 0.0, kind });
        }
        let recording = Some(format!("logs/{name}/recording.rrd"));
        PastRun {
            name: name.into(),
            logs: Logs { journal: None, recording, error: None, is_open: false },
            began: None,
            files: Files { recording_sha256: Some(format!("5a{name}")), ..Files::default() },
            summary: fold.summary(),
            fold,
            record: Record::new(),
            imported: None,
        }
    }

    fn run(name: &str, cell_m: f64, first: u32, count: u32) -> PastRun {
        opened(name, round_tank(cell_m), vec![EventKind::Covered { runs: vec![CellRun(first, count)] }])
    }

    #[test]
    fn two_halves_make_a_whole_and_both_recordings_are_kept_by_name_and_digest() {
        let half = 100 * 50;
        let (south, north) = (run("a", 0.1, 0, half), run("b", 0.1, half, half));
        let alone = merged(std::slice::from_ref(&south)).unwrap();
        let both = merged(&[south, north]).unwrap();
        assert!((alone.floor.reachable.scanned - 0.5).abs() < 0.01, "{:?}", alone.floor.reachable);
        assert!((both.floor.reachable.scanned - 1.0).abs() < 1e-12 && both.floor.missed.is_empty());
        assert_eq!(
            (&alone.scanned[..], &both.scanned[..]),
            (&[CellRun(0, half)][..], &[CellRun(0, 2 * half)][..])
        );
        let text = both.human();
        for wanted in ["logs/a/recording.rrd, sha256 5aa", "logs/b/recording.rrd, sha256 5ab"] {
            assert!(text.contains(wanted), "{text}");
        }
    }

    #[test]
    fn runs_of_different_floors_are_not_taken_together() {
        let refused = |a: RunOpened, b: RunOpened| {
            merged(&[opened("a", a, vec![]), opened("b", b, vec![])]).unwrap_err()
        };
        let coarse = refused(round_tank(0.1), round_tank(0.2));
        assert!(coarse.ends_with("mission.cell_m is 0.1 in a and 0.2 in b"), "{coarse}");
        let mut other = round_tank(0.1);
        other.world.boundary = world::Boundary::Circle { radius_m: 5.01 };
        let walls = refused(round_tank(0.1), other.clone());
        assert_eq!(
            walls,
            "runs a and b are not on the same floor: tank.circle.radius_m is 5.0 in a and 5.01 in b"
        );
        (other.world.boundary, other.world.obstacles) = (round_tank(0.1).world.boundary, vec![]);
        let columns = refused(round_tank(0.1), other);
        assert!(
            columns.ends_with("obstacles is a list of length 1 in a and one of length 0 in b"),
            "{columns}"
        );
        let twice = merged(&[run("a", 0.1, 0, 1), run("a", 0.1, 0, 1)]).unwrap_err();
        assert_eq!(twice, "run a is given twice");
    }

    #[test]
    fn what_only_the_first_run_found_is_no_floor_of_the_whole() {
        let valve = Obstacle {
            id: ObstacleId(2),
            name: "valve".into(),
            shape: Shape::Disc { center: world::Point::new(-2.0, -2.0), radius_m: 0.3 },
            known: false,
        };
        let mut tank = round_tank(0.1);
        tank.world.obstacles.push(valve.clone());
        let world = world::World { obstacles: tank.world.obstacles.clone(), ..tank.world.clone() };
        let found = FloorMaker::of(&tank.floor, &world, 0.45, 0.6, world::Point::origin()).into_floor();
        let events = vec![
            EventKind::ObstacleFound { obstacle: valve },
            EventKind::FloorChanged { changes: found.kinds() },
        ];
        let first = || opened("a", tank.clone(), events.clone());
        let second = || opened("b", tank.clone(), vec![]);
        let (forth, back) = (merged(&[first(), second()]).unwrap(), merged(&[second(), first()]).unwrap());
        assert!(forth.floor.whole.area_m2 < tank.floor.cell_m2() * 7853.0, "{:?}", forth.floor.whole);
        assert_eq!((forth.floor.whole, forth.floor.reachable), (back.floor.whole, back.floor.reachable));
    }

    #[test]
    fn obstacles_that_two_runs_found_under_one_id_are_both_no_floor() {
        let tank = round_tank(0.1);
        let found = |x: f64| {
            let shape = Shape::Disc { center: world::Point::new(x, 2.0), radius_m: 0.3 };
            let found = Obstacle { id: ObstacleId(2_000_000), name: "object 1".into(), shape, known: false };
            let obstacles = [tank.world.obstacles.clone(), vec![found.clone()]].concat();
            let world = world::World { obstacles, ..tank.world.clone() };
            let floor = FloorMaker::of(&tank.floor, &world, 0.45, 0.6, world::Point::origin()).into_floor();
            vec![
                EventKind::ObstacleFound { obstacle: found },
                EventKind::FloorChanged { changes: floor.kinds() },
            ]
        };
        let area_m2 = |runs: &[(&str, f64)]| {
            let runs: Vec<_> = runs.iter().map(|(name, x)| opened(name, tank.clone(), found(*x))).collect();
            merged(&runs).unwrap().floor.whole.area_m2
        };
        let (alone, both) = (area_m2(&[("b", 2.0)]), area_m2(&[("a", -2.0), ("b", 2.0)]));
        assert!((alone - both - std::f64::consts::PI * 0.09).abs() < 0.05, "{alone} {both}");
    }

    #[test]
    fn a_zone_that_was_drawn_in_one_of_the_runs_closes_the_floor_of_both() {
        let tank = round_tank(0.1);
        let zone = world::Zone {
            name: "no-go 1".into(),
            kind: world::ZoneKind::NoGo,
            shape: Shape::Polygon {
                vertices: world::shape::rectangle(world::Point::new(-3.0, 0.0), world::Point::new(-2.0, 1.0)),
            },
        };
        let world = world::World { zones: vec![zone.clone()], ..tank.world.clone() };
        let closed = FloorMaker::of(&tank.floor, &world, 0.45, 0.6, world::Point::origin()).into_floor();
        let events = vec![EventKind::ZoneDrawn { zone }, EventKind::FloorChanged { changes: closed.kinds() }];
        let drawn = || opened("a", tank.clone(), events.clone());
        let free = || opened("b", tank.clone(), vec![]);
        let (forth, back) = (merged(&[drawn(), free()]).unwrap(), merged(&[free(), drawn()]).unwrap());
        assert!(forth.floor.reachable.area_m2 < merged(&[free()]).unwrap().floor.reachable.area_m2 - 1.0);
        assert_eq!(forth.kinds, closed.kinds(), "the map shows the same floor as the account");
        assert_eq!((forth.floor.whole, forth.floor.reachable), (back.floor.whole, back.floor.reachable));
    }

    #[test]
    fn what_counted_under_a_looser_limit_is_reported_with_that_limit() {
        let mut tight = round_tank(0.1);
        tight.mission.scan.position_limit_m = Some(0.1);
        let (loose_m, runs) =
            (round_tank(0.1).mission.scan_limit_m(), [run("a", 0.1, 0, 10), opened("b", tight, vec![])]);
        let merged = merged(&runs).unwrap();
        assert!((merged.floor.position_limit_m - loose_m).abs() < 1e-12);
        assert!((merged.runs[1].position_limit_m - 0.1).abs() < 1e-12);
    }
}
