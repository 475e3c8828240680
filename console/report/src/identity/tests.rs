#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{document::Files, record::Record, samples::round_tank};
use account::{Fold, Logs};
use mission::{Event, EventKind};
use proptest::prelude::*;
use std::sync::LazyLock;
use world::{Point, ZoneKind};

const FACTS: &str = r#"
[inspection]
tank_id = "T-09"
site = "Basel"
drawing = "D-4711, revision C"
nominal_thickness_mm = 8
datum_crs = "EPSG:25832"
datum_m = [691608.2, 5334760.4]
datum_north_deg = 12.5
"#;

/// A run of a tank with all the facts that identify a tank.
fn run() -> RunOpened {
    static TANK: LazyLock<RunOpened> = LazyLock::new(|| round_tank(0.25));
    let mut run = TANK.clone();
    run.scenario_toml = FACTS.to_owned();
    let vertices = world::shape::rectangle(Point::new(1.0, 1.0), Point::new(2.0, 2.0));
    run.world.zones =
        vec![Zone { name: "sump".into(), kind: ZoneKind::NoGo, shape: Shape::Polygon { vertices } }];
    run
}

fn past(name: &str, run: RunOpened) -> PastRun {
    let mut fold = Fold::new();
    fold.apply(&Event { tick: 0, t_s: 0.0, kind: EventKind::RunOpened(Box::new(run)) });
    let logs = Logs { journal: None, recording: None, error: None, is_open: false };
    let files = Files { journal_sha256: Some(digest_of(name)), ..Files::default() };
    // The summary does not affect the identity of the floor.
    let (summary, record) = (Fold::new().summary(), Record::new());
    PastRun { name: name.into(), logs, began: None, files, fold, summary, record, imported: None }
}

/// The digest that the tests use for the journal of a run.
fn digest_of(name: &str) -> String {
    name.repeat(64)
}

fn together(runs: [RunOpened; 2]) -> Result<(), String> {
    let [a, b] = runs;
    require_one_floor(&[past("a", a), past("b", b)])
}

/// A re-scan of the runs with these names; its scenario has another name.
fn rescan_of(names: &[&str]) -> RunOpened {
    let mut run = run();
    let digests: Vec<String> = names.iter().map(|name| format!("\"{}\"", digest_of(name))).collect();
    run.scenario_toml = format!("continues_sha256 = [{}]\n{FACTS}", digests.join(", "));
    run.scenario = "tiny-rescan".into();
    run
}

/// Changes one of the fields that identify a floor; returns the key that the message must name.
fn change(run: &mut RunOpened, which: usize, by: f64, word: &str) -> &'static str {
    let mut fact = |from: &str, to: String| {
        assert!(run.scenario_toml.contains(from));
        run.scenario_toml = run.scenario_toml.replace(from, &to);
    };
    let column = |run: &mut RunOpened, by: f64| match &mut run.world.obstacles[0].shape {
        Shape::Disc { center, .. } => center.x += by,
        _ => unreachable!("a column is a disc"),
    };
    match which {
        0 => fact("T-09", word.to_owned()),
        1 => fact("Basel", word.to_owned()),
        2 => fact("D-4711, revision C", word.to_owned()),
        3 => fact("= 8", format!("= {}", 8.0 + by)),
        4 => fact("EPSG:25832", word.to_owned()),
        5 => fact("691608.2", format!("{}", 691_608.2 + by)),
        6 => fact("12.5", format!("{}", 12.5 + by)),
        7 => fact("tank_id = \"T-09\"\n", String::new()),
        8 => run.world.boundary = Boundary::Circle { radius_m: 5.0 + by },
        9 => {
            run.world.boundary = Boundary::Polygon {
                vertices: world::shape::rectangle(Point::new(-5.0, -5.0), Point::new(5.0, 5.0)),
            }
        }
        10 => column(run, by),
        11 => run.world.obstacles[0].name = word.to_owned(),
        12 => run.world.obstacles.clear(),
        13 => run.world.zones[0].name = word.to_owned(),
        14 => run.world.zones.clear(),
        15 => run.plates = None,
        16 => {
            run.plates = Some(PlateLayout::Regular(world::RegularPlates {
                annular_m: 0.6 + by,
                n_annular: 6,
                length_m: 3.0,
                width_m: 1.5,
            }));
        }
        17 => run.floor.cell_m += by,
        18 => run.mission.swath_m += by,
        19 => run.mission.limits.radius_m += by,
        _ => run.mission.clearance_m += by,
    }
    KEYS[which]
}

const KEYS: [&str; 21] = [
    "inspection.tank_id",
    "inspection.site",
    "inspection.drawing",
    "inspection.nominal_thickness_mm",
    "inspection.datum_crs",
    "inspection.datum_m.0",
    "inspection.datum_north_deg",
    "inspection.tank_id",
    "tank.circle.radius_m",
    "tank.circle",
    "obstacles.0.shape",
    "obstacles.0.name",
    "obstacles",
    "zones.0.name",
    "zones",
    "plates",
    "plates.annular_m",
    "mission.cell_m",
    "mission.swath_m",
    "robot.radius_m",
    "mission.clearance_m",
];

proptest! {
    /// If any single field differs, however little, the runs are never on one floor.
    #[test]
    fn any_one_field_that_differs_is_named_with_both_values(
        which in 0..KEYS.len(), by in 1e-6..3.0_f64, word in "[A-Z]{3}-[0-9]{2}", rescans in any::<bool>(),
    ) {
        let (one, mut other) = (run(), if rescans { rescan_of(&["a"]) } else { run() });
        prop_assert_eq!(together([one.clone(), other.clone()]), Ok(()));
        let key = change(&mut other, which, by, &word);
        for runs in [[one.clone(), other.clone()], [other, one]] {
            let refused = together(runs).unwrap_err();
            let says_where = refused.starts_with("runs a and b are not on the same floor: ") && refused.contains(key);
            prop_assert!(says_where && refused.contains(" in a and ") && refused.ends_with(" in b"), "{}", refused);
        }
    }
}

#[test]
fn a_run_of_another_scenario_is_a_rescan_only_by_the_digest_of_a_journal_that_is_given() {
    let of = |names: &[&str]| rescan_of(names);
    let fits = |runs: &[(&str, RunOpened)]| {
        let runs: Vec<PastRun> = runs.iter().map(|(name, run)| past(name, run.clone())).collect();
        require_one_floor(&runs)
    };
    assert_eq!(fits(&[("a", run()), ("b", of(&["a"]))]), Ok(()));
    assert_eq!(fits(&[("b", of(&["a"])), ("a", run())]), Ok(()), "the order does not matter");
    assert_eq!(fits(&[("a", run()), ("b", of(&["a"])), ("c", of(&["a", "b"]))]), Ok(()), "a chain");
    assert_eq!(fits(&[("c", of(&["a", "b"])), ("a", run())]), Ok(()), "the run in between may be missing");
    assert_eq!(fits(&[("b", of(&["a"])), ("d", of(&["a"]))]), Ok(()), "the re-scan was run twice");
    assert_eq!(fits(&[("c", of(&["a"]))]), Ok(()), "alone");
    let refused = fits(&[("a", run()), ("c", of(&["b"]))]).unwrap_err();
    assert!(
        refused.contains(&format!("continues_sha256 of c is {}", digest_of("b")))
            && refused.contains(&format!("the journal of a has the SHA-256 {}", digest_of("a"))),
        "{refused}"
    );
    assert!(fits(&[("c", of(&["x"])), ("d", of(&["y"]))]).is_err(), "the re-scans continue different runs");
    let named = RunOpened { scenario: "tiny-rescan".into(), ..run() };
    let refused = fits(&[("a", run()), ("b", named)]).unwrap_err();
    assert!(
        refused.contains("name is tiny in a and tiny-rescan in b, and neither run is a re-scan"),
        "{refused}"
    );
    let damaged = RunOpened { scenario_toml: "[".into(), ..run() };
    assert!(
        fits(&[("a", run()), ("b", damaged)]).unwrap_err().starts_with("run b: the scenario in its journal")
    );
}

#[test]
fn facts_that_contradict_the_scenario_that_was_flown_are_named_and_those_that_add_to_it_are_not() {
    let flown = Inspection { tank_id: Some("T-09".into()), ..Inspection::default() };
    let facts = |tank: &str| Inspection {
        tank_id: Some(tank.into()),
        site: Some("Basel".into()),
        ..Inspection::default()
    };
    assert_eq!(contradiction(&facts("T-09 "), &flown, None), None);
    assert_eq!(contradiction(&Inspection::default(), &flown, Some(8.0)), None);
    let said = contradiction(&facts("T-10"), &flown, None).unwrap();
    assert_eq!(said, r#"tank_id is "T-10", but "T-09" in the scenario of the run"#);
}

#[test]
fn a_nominal_thickness_other_than_that_of_the_instrument_is_a_contradiction() {
    let facts = |mm| Inspection { nominal_thickness_mm: Some(mm), ..Inspection::default() };
    let flown = Inspection::default();
    assert_eq!(contradiction(&facts(8.0), &flown, Some(8.0)), None);
    assert_eq!(contradiction(&facts(6.0), &flown, None), None);
    let said = contradiction(&facts(6.0), &flown, Some(8.0)).unwrap();
    assert!(said.contains("nominal_thickness_mm is 6, but instrument.thickness_mm"), "{said}");
    // The scenario may contradict itself, too.
    assert!(contradiction(&facts(6.0), &facts(6.0), Some(8.0)).is_some());
}
