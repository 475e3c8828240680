//! The result of several runs on one floor: a scan and the re-scans of what it missed.

use crate::{
    account::{Account, Evidence, account},
    fold::Fold,
    human::floor_lines,
    scanned::Scanned,
    summary::{Coverage, Logs, Summary},
};
use mission::event::RunOpened;
use serde::Serialize;
use std::{collections::BTreeSet, fmt::Write};
use world::{Floor, FloorMaker, Obstacle, ObstacleId, Shape};

/// What several runs scanned together. Every run keeps its own recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Merged {
    /// The runs, in the order given.
    pub runs: Vec<MergedRun>,
    /// What was scanned by all of them.
    pub coverage: Coverage,
    /// The account of the floor over all of them.
    pub floor: Account,
}

/// One of several runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MergedRun {
    /// Name of its folder.
    pub run: String,
    /// SHA-256 of its journal, hexadecimal; absent if it has none.
    pub journal_sha256: Option<String>,
    /// SHA-256 of its recording, hexadecimal; absent if it has none.
    pub recording_sha256: Option<String>,
    /// Width of floor that it scanned in one pass, metres.
    pub swath_m: f64,
    /// Half width of the 95 % position error above which nothing counted in it, metres.
    pub position_limit_m: f64,
    /// Its own figures, without the account of the floor.
    pub summary: Summary,
}

/// A past run: its name, its files and what is known of it.
#[derive(Debug)]
pub struct PastRun {
    /// Name of its folder.
    pub name: String,
    /// Its files.
    pub logs: Logs,
    /// SHA-256 of its journal, hexadecimal.
    pub journal_sha256: Option<String>,
    /// SHA-256 of its recording, hexadecimal.
    pub recording_sha256: Option<String>,
    /// Its events, folded.
    pub fold: Fold,
}

/// What several runs on one floor scanned together.
pub(crate) struct Joined<'a> {
    /// The last of the runs, as it was opened.
    pub(crate) run: &'a RunOpened,
    pub(crate) scanned: Scanned,
    pub(crate) evidence: Evidence,
}

/// Takes several runs together.
///
/// # Errors
/// No run, a run given twice, a mission that scans no floor, other cells, or another tank.
pub fn merged(runs: &[PastRun]) -> Result<Merged, String> {
    let Joined { run, scanned, evidence } = joined(runs)?;
    let opened = |past: &PastRun| past.fold.run.as_ref().map(|run| run.mission.clone());
    let listed = runs.iter().filter_map(|past| {
        let mission = opened(past)?;
        Some(MergedRun {
            run: past.name.clone(),
            journal_sha256: past.journal_sha256.clone(),
            recording_sha256: past.recording_sha256.clone(),
            swath_m: mission.swath_m,
            position_limit_m: mission.scan_limit_m(),
            summary: Summary { floor: None, logs: Some(past.logs.clone()), ..past.fold.summary() },
        })
    });
    let listed: Vec<MergedRun> = listed.collect();
    // What counted in any of the runs counts: the loosest limit is the one that holds for all of it.
    let position_limit_m = listed.iter().map(|run| run.position_limit_m).fold(0.0, f64::max);
    Ok(Merged {
        coverage: scanned.coverage(),
        floor: Account { position_limit_m, ..account(run, scanned.believed(), &evidence) },
        runs: listed,
    })
}

/// What several runs scanned together, on the floor as all of them found it.
pub(crate) fn joined(runs: &[PastRun]) -> Result<Joined<'_>, String> {
    let (last, before) = runs.split_last().ok_or("there is no run to report")?;
    let Parts { run, mut scanned, mut evidence } = parts(last)?;
    let known: BTreeSet<ObstacleId> = evidence
        .found()
        .map(|(id, _)| *id)
        .chain(run.world.obstacles.iter().filter(|o| o.known).map(|o| o.id))
        .collect();
    for (index, past) in before.iter().enumerate() {
        if let Some(other) = runs[index + 1..].iter().find(|other| other.name == past.name) {
            return Err(format!("run {} is given twice", other.name));
        }
        let other = parts(past)?;
        fit_together((&past.name, &other), (&last.name, run, &scanned))?;
        scanned.join(&other.scanned);
        evidence.join(&other.evidence);
    }
    let more: Vec<Shape> =
        evidence.found().filter(|(id, _)| !known.contains(id)).map(|(_, shape)| shape.clone()).collect();
    if !more.is_empty() {
        // What only the other runs found is no floor either.
        scanned
            .change(&updated_floor(run, scanned.believed().floor(), &evidence, run.mission.swath_m).kinds());
    }
    Ok(Joined { run, scanned, evidence })
}

/// What is known of one run.
struct Parts<'a> {
    run: &'a RunOpened,
    scanned: Scanned,
    evidence: Evidence,
}

fn parts(past: &PastRun) -> Result<Parts<'_>, String> {
    let PastRun { name, fold, .. } = past;
    let found = fold.scanned.clone().zip(fold.evidence.clone()).zip(fold.run.as_deref());
    let ((scanned, evidence), run) =
        found.ok_or_else(|| format!("run {name} did not scan a floor: its mission leads to a point"))?;
    Ok(Parts { run, scanned, evidence })
}

/// Refuses runs of which one contains nothing about the floor of the other.
fn fit_together(
    (name, other): (&str, &Parts<'_>),
    (last_name, last, scanned): (&str, &RunOpened, &Scanned),
) -> Result<(), String> {
    let names = format!("run {name} and run {last_name} have no floor in common");
    if other.run.world.boundary != last.world.boundary {
        return Err(format!("{names}: the walls of their tanks differ"));
    }
    let (a, b) = (other.run.floor.cell_m, last.floor.cell_m);
    if !scanned.believed().floor().is_aligned_with(other.scanned.believed().floor()) {
        return Err(format!(
            "{names}: their cells are {a} m and {b} m wide; fly both with the same mission.cell_m"
        ));
    }
    let outlines = |run: &RunOpened| -> Vec<Shape> {
        run.world.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect()
    };
    if outlines(other.run) != outlines(last) {
        return Err(format!("{names}: other obstacles stand in their tanks"));
    }
    if other.run.world.zones != last.world.zones {
        return Err(format!("{names}: their zones differ"));
    }
    Ok(())
}

/// The floor with everything that any of the runs found.
pub(crate) fn updated_floor(run: &RunOpened, grid: &Floor, evidence: &Evidence, swath_m: f64) -> Floor {
    let mut world = run.world.as_drawn();
    let drawn: BTreeSet<ObstacleId> = world.obstacles.iter().map(|obstacle| obstacle.id).collect();
    for (id, shape) in evidence.found().filter(|(id, _)| !drawn.contains(id)) {
        world.obstacles.push(Obstacle { id: *id, name: String::new(), shape: shape.clone(), known: true });
    }
    let mission = &run.mission;
    FloorMaker::of(grid, &world, mission.room_m(), swath_m, mission.start.position).into_floor()
}

impl Merged {
    /// The result as text for people.
    pub fn human(&self) -> String {
        let mut text = String::from("result of several runs on one floor\n\n");
        let mut line = |label: &str, what: String| {
            writeln!(text, "{label:<15}{what}").expect("writing to a string");
        };
        for run in &self.runs {
            for (label, what) in run_lines(run) {
                line(label, what);
            }
        }
        if let Some(truth) = self.coverage.by_truth {
            let (reachable, whole) = (100.0 * truth.reachable, 100.0 * truth.whole);
            line(
                "by truth",
                format!("{reachable:.1} % of the reachable floor, {whole:.1} % of the whole floor"),
            );
        }
        if let Some(overlap) = self.coverage.overlap {
            line("overlap", format!("{:.1} % of the scanned floor scanned again", 100.0 * overlap));
        }
        let mut before = "";
        for (label, what) in floor_lines(&self.floor) {
            line(if label == before { "" } else { label }, what);
            before = label;
        }
        text
    }
}

fn run_lines(run: &MergedRun) -> Vec<(&'static str, String)> {
    let word = run.summary.outcome.map_or("cut off", mission::Outcome::word);
    let share = run.summary.coverage.as_ref().map_or(0.0, |coverage| 100.0 * coverage.reachable);
    let mut lines =
        vec![("run", format!("{}: {word}, {share:.1} % of the reachable floor by itself", run.run))];
    let files = run.summary.logs.as_ref();
    let file = |kind: &str, path: Option<&String>, sha256: Option<&String>| {
        let sha256 = sha256.map(|sha256| format!(", sha256 {sha256}")).unwrap_or_default();
        ("", path.map_or_else(|| format!("{kind} none"), |path| format!("{kind} {path}{sha256}")))
    };
    lines.push(file(
        "recording",
        files.and_then(|logs| logs.recording.as_ref()),
        run.recording_sha256.as_ref(),
    ));
    lines.push(file("journal", files.and_then(|logs| logs.journal.as_ref()), run.journal_sha256.as_ref()));
    lines.extend(files.and_then(|logs| logs.error.clone()).map(|error| ("WARNING", error)));
    lines
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::fold::tests::round_tank;
    use mission::{Event, EventKind};
    use world::CellRun;

    fn opened(name: &str, run: RunOpened, events: Vec<EventKind>) -> PastRun {
        let mut fold = Fold::new();
        for kind in [EventKind::RunOpened(Box::new(run))].into_iter().chain(events) {
            fold.apply(&Event { tick: 0, t_s: 0.0, kind });
        }
        let recording = Some(format!("logs/{name}/recording.rrd"));
        PastRun {
            name: name.into(),
            logs: Logs { journal: None, recording, error: None },
            journal_sha256: None,
            recording_sha256: Some(format!("5a{name}")),
            fold,
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
        assert!(coarse.contains("their cells are 0.1 m and 0.2 m wide"), "{coarse}");
        let mut other = round_tank(0.1);
        other.world.boundary = world::Boundary::Circle { radius_m: 5.01 };
        let walls = refused(round_tank(0.1), other.clone());
        assert!(walls.contains("run a and run b have no floor in common: the walls"), "{walls}");
        (other.world.boundary, other.world.obstacles) = (round_tank(0.1).world.boundary, vec![]);
        let columns = refused(round_tank(0.1), other);
        assert!(columns.contains("other obstacles stand in their tanks"), "{columns}");
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
