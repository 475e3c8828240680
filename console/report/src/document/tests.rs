//! Reports on a small round tank.

#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::samples::round_tank;
use crate::{
    past_run::PastRun,
    record::{Record, TrackPoint},
};
use account::{Fold, Inspection, Logs};
use mission::{Event, EventKind, Guarantee, Outcome, RunOpened, TaskConfig, event::PulsePhase};
use planner_api::{PoseEstimate, Reason};
use positioning::{PulseTest, Risk};
use world::{Floor, Obstacle, ObstacleId, Point, Shape};

/// Positions of two cells in the middle of the tank.
const MISSED: [Point; 2] = [Point::new(1.0, -1.0), Point::new(1.1, -1.0)];

/// A run that scanned all floor except two cells in the middle of the tank.
fn past() -> PastRun {
    past_without(&MISSED)
}

/// A run that scanned all floor except the cells at some positions, to which its plan does not lead.
fn past_without(missed: &[Point]) -> PastRun {
    let mut past = past_of(round_tank(0.1), missed);
    plan(&mut past, vec![]);
    past
}

/// Gives a run a plan that does not lead to the missed cells, with these cuts.
fn plan(past: &mut PastRun, cuts: Vec<Vec<Point>>) {
    let path = [Point::new(-1.75, 0.0), Point::new(-2.5, 0.0)];
    let kind = EventKind::Planned {
        ask: None,
        return_path: 0,
        planner: String::new(),
        reason: Reason::Start,
        path: path.to_vec(),
        length_m: 0.75,
        complete: true,
        legs: vec![],
        cuts,
    };
    past.fold.apply(&Event { tick: 0, t_s: 0.0, kind });
    past.summary = past.fold.summary();
}

/// A run that scanned all floor except the cells at some positions, without a plan.
fn past_of(run: RunOpened, missed: &[Point]) -> PastRun {
    let missed: Vec<usize> = missed.iter().map(|place| run.floor.cell_at(*place).unwrap()).collect();
    let runs = world::coverage::runs_of((0..run.floor.len()).filter(|cell| !missed.contains(cell)));
    let covered = EventKind::Covered { runs };
    let (mut fold, mut record) = (Fold::new(), Record::new());
    for kind in [EventKind::RunOpened(Box::new(run)), covered] {
        let event = Event { tick: 0, t_s: 0.0, kind };
        fold.apply(&event);
        record.apply(&event);
    }
    let logs = Logs { journal: None, recording: None, error: None, is_open: false };
    let (name, files, summary) = ("20261122T040132Z-tiny".to_owned(), Files::default(), fold.summary());
    PastRun { name, logs, began: None, files, fold, summary, record, imported: None }
}

fn document(inspection: Inspection) -> Document {
    Document::new(&[past()], Context { inspection, version: "1", ..Context::default() }).unwrap()
}

fn open(document: &Document) -> Vec<usize> {
    document.open_items().map(|item| item.number).collect()
}

#[test]
fn what_is_missing_is_printed_with_its_key_and_what_is_given_is_escaped() {
    let tank_id = Some("T-07 <b>".to_owned());
    let html = html(&document(Inspection { tank_id, ..Inspection::default() }));
    assert!(html.contains("inspection.drawing]") && !html.contains("[inspection.tank_id"), "facts");
    assert!(!html.contains("T-07 <b>") && html.contains("T-07 &#60;b&#62;"), "escaped");
    for section in 1..=12 {
        assert!(html.contains(&format!(r#"<h2 id="s{section}">"#)), "section {section}");
    }
}

/// A complete report on a run whose floor is guaranteed by this rule.
fn guaranteed_by(guarantee: Guarantee) -> (Document, String) {
    let mut run = round_tank(0.1);
    run.mission.scan.guarantee = guarantee;
    run.mission.locating.risk = Some(Risk::default());
    let mut past = past_of(run, &MISSED);
    let covariance = nalgebra::Matrix3::from_diagonal_element(0.01);
    let pose = PoseEstimate { position: Point::origin(), heading_rad: 0.0, covariance };
    let events = [
        EventKind::Protected { level_m: Some(0.25) },
        EventKind::Estimated { pose },
        EventKind::Ended { outcome: Outcome::Complete, reason: "done".into() },
    ];
    apply(&mut past, 1, events);
    let document = Document::new(&[past], Context::default()).unwrap();
    let page = html(&document);
    (document, page)
}

fn apply(past: &mut PastRun, tick: u64, events: impl IntoIterator<Item = EventKind>) {
    for kind in events {
        let event = Event { tick, t_s: tick as f64, kind };
        past.fold.apply(&event);
        past.record.apply(&event);
    }
    past.summary = past.fold.summary();
}

/// The sentences of a page that contain a word, each once, in order.
fn sentences_with(page: &str, words: &[&str]) -> String {
    let text: String = page.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).fold(
        String::new(),
        |all, text| {
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
            if text.is_empty() { all } else { all + &text + "\n" }
        },
    );
    let mut found: Vec<&str> = Vec::new();
    for line in text.lines().filter(|line| words.iter().any(|word| line.contains(word))) {
        if !found.contains(&line) {
            found.push(line);
        }
    }
    found.join("\n")
}

#[test]
fn every_definition_of_guaranteed_states_the_rule_that_was_used() {
    let words = ["uaranteed", "rotection level", "one wrong station", "for every position"];
    for (name, guarantee) in [("ellipse", Guarantee::Ellipse), ("protection", Guarantee::Protection)] {
        let (_, page) = guaranteed_by(guarantee);
        insta::assert_snapshot!(name, sentences_with(&page, &words));
    }
}

#[test]
fn the_row_of_the_protection_level_has_its_median_under_its_own_heading() {
    let (document, _) = guaranteed_by(Guarantee::Ellipse);
    let table = sections::floor::accuracy_statement(&document);
    let heads: Vec<&str> = table.heads.iter().map(|head| head.text).collect();
    assert_eq!(heads, ["Position", "Mean", "Median", "p95", "Worst", "Method"]);
    let row: Vec<&str> = table.rows[1].cells.iter().filter_map(|cell| cell.value.text.as_deref()).collect();
    assert_eq!(
        row,
        [
            "Protection level",
            "\u{2013}",
            "25.0",
            "25.0",
            "25.0",
            "covers one wrong station; accepted risk 1e-5 for each position, assuming 1e-4 faults per station and hour that \
             last 1 h each; not protected in 0.0 % of the ticks"
        ]
    );
    let plain = Document::new(&[past()], Context::default()).unwrap();
    assert_eq!(
        sections::floor::accuracy_statement(&plain).heads.len(),
        5,
        "without levels, only the mean is known"
    );
}

#[test]
fn the_speed_of_sound_and_a_failed_pulse_test_are_stated_in_text_page_and_json() {
    let mut past = past_of(round_tank(0.1), &MISSED);
    let estimated = |value, sigma| positioning::Estimated { value, sigma };
    let test = PulseTest {
        scale: estimated(0.02, 0.000_6),
        offsets_m: Vec::new(),
        integrity: positioning::Integrity::Alarm,
        suspect: None,
        worst: (world::StationId(1), world::StationId(2), -0.37),
        pulses: 30,
    };
    let scale = estimated(0.0201, 0.000_3);
    apply(
        &mut past,
        5,
        [
            EventKind::PulsesTested { phase: PulsePhase::Before, test },
            EventKind::SessionCalibrated { scale, slip_correlation: None },
        ],
    );
    let sound = "speed of sound taken as constant: ranges too long by +2.01 ± 0.06 % at T+00:00:05";
    let warning =
        "the stations may not have been as surveyed from T+00:00:00 to the end: the stated position errors";
    let text = crate::human(&past.summary);
    assert!(text.contains(sound), "{text}");
    assert!(text.contains(&format!("WARNING        {warning}")), "{text}");
    assert!(text.contains("0.37 m too short"), "{text}");
    let document = Document::new(&[past], Context::default()).unwrap();
    let page = html(&document);
    assert!(page.contains(&format!("Session calibration: {sound}.")), "section 8 and the accuracy statement");
    assert!(
        page.matches(warning).count() >= 3,
        "first sheet, accuracy and limitations: {}",
        page.matches(warning).count()
    );
    let json = serde_json::to_value(&document).unwrap();
    assert_eq!(json["runs"][0]["calibration"]["last"]["scale"]["value"], 0.0201);
    assert_eq!(json["runs"][0]["pulse_tests"][0]["contradicts"], true);
}

#[test]
fn a_gap_without_a_reason_and_a_plate_without_a_figure_are_open_items() {
    let missed_accepted = Some("seen by eye".to_owned());
    let mut document = document(Inspection { missed_accepted, ..Inspection::default() });
    // The tool passed over nothing according to an estimated position, so no plate has an accuracy.
    assert!(open(&document).contains(&5) && !open(&document).contains(&6), "{:?}", document.gate);
    document.floor.plates.iter_mut().for_each(|plate| plate.error_p95_m = Some(0.05));
    document.floor.missed[0].causes[0].text.clear();
    document.gate = gate::gate(&document);
    assert!(!open(&document).contains(&5) && open(&document).contains(&6), "{:?}", document.gate);
    let lacks = &document.gate[5].missing;
    assert!(lacks.len() == 1 && lacks[0].starts_with("reason for the missed area at 1."), "{lacks:?}");
}

#[test]
fn files_that_are_not_those_of_the_end_of_the_run_are_an_open_item() {
    let mut past = past();
    past.files = Files {
        journal_sha256: Some("a1".repeat(32)),
        recording_sha256: Some("b2".repeat(32)),
        are_as_reported: Some(true),
        ..Files::default()
    };
    let gate = |past: PastRun| Document::new(&[past], Context::default()).unwrap().gate[12].clone();
    let (name, files) = (past.name.clone(), past.files.clone());
    assert!(gate(past).is_answered);
    let mut changed = self::past();
    changed.files =
        Files { are_as_reported: Some(false), doubts: vec!["the journal is another one".into()], ..files };
    assert_eq!(gate(changed).missing, [format!("{name}: the journal is another one")]);
}

#[test]
fn every_format_has_the_gap_and_the_letters_of_revisions_go_on_after_z() {
    let (runs, document) = ([past()], document(Inspection::default()));
    let [_, missed, ..] = csv::tables(&document, &runs);
    assert!(missed.lines().count() == 2 && missed.contains("not planned"), "{missed}");
    assert!(geojson::geojson(&document, &runs).contains(r#""layer":"missed""#));
    assert!(dxf::dxf(&document, &runs).contains("MISSED"));
    assert_eq!([0, 1, 25, 26, 51, 52].map(build::letter), ["A", "B", "Z", "AA", "AZ", "BA"]);
}

#[test]
fn a_datum_moves_and_turns_what_geojson_says() {
    let facts = Inspection {
        datum_m: Some([1000.0, 2000.0]),
        datum_north_deg: Some(90.0),
        datum_crs: Some("EPSG:25832".into()),
        ..Inspection::default()
    };
    let runs = [past()];
    let map: serde_json::Value = serde_json::from_str(&geojson::geojson(&document(facts), &runs)).unwrap();
    assert_eq!(map["crs"]["properties"]["name"], "EPSG:25832");
    let shell =
        map["features"].as_array().unwrap().iter().find(|f| f["properties"]["layer"] == "shell").unwrap();
    // In this coordinate system, east of the tank frame is south.
    assert_eq!(shell["geometry"]["coordinates"][0][0], serde_json::json!([1000.0, 1995.0]));
}

#[test]
fn seams_end_at_the_ring() {
    let run = round_tank(0.1);
    let layout = run.plates.unwrap();
    let floor: &Floor = &run.floor;
    let map = layout.map(&run.world.boundary, floor);
    for seam in layout.seams(&run.world.boundary) {
        for place in &seam {
            assert!(place.coords.norm() < 5.0 + 1e-6, "{seam:?} of {} plates", map.plates.len());
        }
    }
}

#[test]
fn a_run_that_was_cut_off_and_gaps_block_the_signature_until_they_are_decided() {
    let undecided = document(Inspection::default());
    assert!(
        undecided.gate[1].answer.starts_with("whole floor and the critical zone, "),
        "{:?}",
        undecided.gate[1]
    );
    let lacks =
        |item: usize, key: &str| undecided.gate[item - 1].missing.contains(&format!("inspection.{key}"));
    assert!(lacks(2, "partial_scope_accepted") && lacks(6, "missed_accepted"), "{:?}", undecided.gate);
    // No part of the shell was scanned, and the early end of the recording is an incident.
    assert!(lacks(2, "critical_zone_accepted") != undecided.floor.critical_zone.done);
    assert!(lacks(11, "events_reviewed_by"), "{:?}", undecided.gate[10]);
    let page = html(&undecided);
    assert!(page.contains("Not complete: the recording stops before the end of the mission."), "verdict");
    let facts = Inspection {
        partial_scope_accepted: Some("the rest by hand".into()),
        missed_accepted: Some("welds, seen by eye".into()),
        ..Inspection::default()
    };
    let decided = document(facts);
    let keys = ["inspection.partial_scope_accepted", "inspection.missed_accepted"].map(str::to_owned);
    assert!(decided.gate.iter().all(|item| !keys.iter().any(|key| item.missing.contains(key))));
    assert!(decided.gate[5].answer.ends_with("missed accepted: welds, seen by eye"), "{:?}", decided.gate[5]);
    assert!(html(&decided).contains("the rest by hand"), "printed");
}

#[test]
fn a_report_on_a_part_of_the_floor_states_its_share_and_does_not_call_the_rest_missed() {
    let mut run = round_tank(0.1);
    let square = |half_m: f64| vec![world::coverage::regions::square(Point::origin(), half_m)];
    let TaskConfig::Cover { regions, .. } = &mut run.mission.task else { panic!("the task is to scan") };
    *regions = square(2.0);
    let is_in = |floor: &Floor, cell: usize, half_m: f64| {
        let place = floor.center(cell);
        place.x.abs() < half_m && place.y.abs() < half_m
    };
    let floor = run.floor.clone();
    let missed = |half_m: f64| -> Vec<Point> {
        let others = (0..floor.len()).filter(|cell| !is_in(&floor, *cell, half_m));
        others.map(|cell| floor.center(cell)).collect()
    };
    // Everything that was requested, and nothing else.
    let all = Document::new(&[past_of(run.clone(), &missed(1.0))], Context::default()).unwrap();
    let requested = all.floor.requested.expect("a part was requested");
    assert!((requested.area_m2 - 4.0).abs() < 1e-9 && requested.percent.scanned >= 100.0, "{requested:?}");
    let page = html(&all);
    assert!(page.contains("of the requested floor") && page.contains("Requested floor"), "page");
    assert!(!page.contains("inspect by hand"), "nothing requested was missed");
    let json = serde_json::to_value(&all).unwrap();
    assert!((json["floor"]["requested"]["area_m2"].as_f64().unwrap() - 4.0).abs() < 1e-9, "{json}");
    let some = Document::new(&[past_of(run, &missed(0.5))], Context::default()).unwrap();
    let page = html(&some);
    assert!(page.contains("3.00 m² of the requested floor was missed: accept, re-scan, or inspect by hand."));
    assert!(page.contains("3.000 m² was requested. The other"), "page");
    let lacks = &some.gate[5].missing;
    assert!(lacks.contains(&"inspection.missed_accepted".to_owned()), "{lacks:?}");
}

#[test]
fn the_page_states_the_other_files_and_their_list_is_read_back() {
    let mut document = document(Inspection::default());
    assert!(stated_files(&html(&document)).is_empty());
    let files = [("report.json", "0123456789abcdef".repeat(4)), ("notes/a_b-1.json", "f".repeat(64))];
    document.packed = files.map(|(name, sha256)| (name.to_owned(), sha256)).to_vec();
    let stated: Vec<(String, String)> = stated_files(&html(&document)).into_iter().collect();
    let mut expected = document.packed.clone();
    expected.sort();
    assert_eq!(stated, expected);
}

/// Two runs, each with a found obstacle and a track.
fn two_runs() -> [PastRun; 2] {
    two_runs_of([round_tank(0.1), round_tank(0.1)])
}

/// Two runs that were opened in this way, each with a found obstacle and a track.
fn two_runs_of([first, second]: [RunOpened; 2]) -> [PastRun; 2] {
    // The obstacle of the second run is beside the cells that both runs missed.
    [("20261122T040132Z-a", 2.0, first), ("20261122T050132Z-b", -1.0, second)].map(|(name, y, opened)| {
        let mut run = past_of(opened, &MISSED);
        plan(&mut run, vec![]);
        run.name = name.into();
        let shape = Shape::Disc { center: Point::new(1.7, y), radius_m: 0.2 };
        let found = Obstacle { id: ObstacleId(7), name: "found 1".into(), shape, known: false };
        run.fold.apply(&Event { tick: 1, t_s: 0.1, kind: EventKind::ObstacleFound { obstacle: found } });
        let point = |k: u16| TrackPoint {
            t_s: f32::from(k),
            x_m: 0.1 * f32::from(k),
            y_m: y as f32,
            heading_rad: 0.0,
            error_m: 0.05,
            true_error_m: f32::NAN,
        };
        run.record.track = (0..10).map(point).collect();
        run
    })
}

const INDICATIONS: &str = "run,t_s,kind\n20261122T040132Z-a,3,pit\n20261122T050132Z-b,4,corrosion\n";

#[test]
fn indications_have_numbered_marks_on_the_map_that_do_not_cover_one_another() {
    let csv = "t_s,kind\n3,pit\n3,pit\n3.4,pit\n";
    let [run, _] = two_runs();
    let context = Context { indications_csv: Some(("found.csv", csv)), ..Context::default() };
    let map = Document::new(&[run], context).unwrap().pictures.coverage;
    let place_of = |name: &str| {
        let (before, _) = map.svg.split_once(&format!(">{name}</text>")).unwrap();
        let text = &before[before.rfind("<text").unwrap()..];
        ["x", "y"]
            .map(|key| text.split_once(&format!("{key}=\"")).unwrap().1.split('"').next().unwrap().to_owned())
    };
    let places = ["I1", "I2", "I3"].map(place_of);
    assert!(places[0] != places[1] && places[1] != places[2] && places[0] != places[2], "{places:?}");
    assert!(map.legend.iter().any(|entry| entry.text.starts_with("indication") && entry.value == "3"));
    // A mark without enough space has no number, so that numbers do not overlap, and the caption states how many marks
    // have none.
    let crowd: String = (0..300).fold("t_s\n".into(), |csv, k| csv + &format!("{}\n", 0.03 * f64::from(k)));
    let [run, _] = two_runs();
    let context = Context { indications_csv: Some(("found.csv", &crowd)), ..Context::default() };
    let map = Document::new(&[run], context).unwrap().pictures.coverage;
    let numbers = map.svg.matches(">I").count();
    assert!(
        (1..300).contains(&numbers)
            && map.caption.contains(&format!("Without a number on the map: {} indications", 300 - numbers))
    );
}

#[test]
fn what_was_found_in_several_runs_is_named_by_its_run_in_every_format() {
    let runs = two_runs();
    let context = Context { indications_csv: Some(("found.csv", INDICATIONS)), ..Context::default() };
    let document = Document::new(&runs, context).unwrap();
    let (map, drawing) = (geojson::geojson(&document, &runs), dxf::dxf(&document, &runs));
    for name in ["found 1 of run 1", "found 1 of run 2"] {
        assert!(map.contains(name) && drawing.contains(name), "{name}");
    }
    assert!(
        drawing.contains("I1 pit of run 1\n") && drawing.contains("I2 corrosion of run 2\n"),
        "{drawing}"
    );
    assert!(map.contains(r#""number":2,"plate""#) && map.contains(r#""run":"20261122T050132Z-b""#), "{map}");
    let reasons: String = document.floor.missed.iter().map(account::Area::why).collect();
    assert!(reasons.contains("from obstacle 1 of run 2, found on the way"), "{reasons}");
    // In a report on a single run, the names need no run number.
    let [run, _] = two_runs();
    let alone = Document::new(std::slice::from_ref(&run), Context::default()).unwrap();
    assert!(!dxf::dxf(&alone, &[run]).contains("of run"));
}

#[test]
fn of_many_missed_areas_the_small_ones_are_said_in_few_words_each_with_its_reason_and_value() {
    let places: Vec<Point> =
        (0..60).map(|k| Point::new(-2.0 + 0.4 * f64::from(k % 10), -1.0 + 0.4 * f64::from(k / 10))).collect();
    let many = Document::new(&[past_without(&places)], Context::default()).unwrap();
    assert_eq!(many.floor.missed.len(), 60);
    let page = html(&many);
    let key = page.split_once("of each reason. ").unwrap().1.split(" CSV and JSON").next().unwrap();
    for number in 1..=60 {
        let entry =
            page.split_once(&format!("<li id=\"m{number}\">")).unwrap().1.split("</li>").next().unwrap();
        let (letter, value) = entry.split_once("0.010\u{a0}m²; ").unwrap().1.split_once(' ').unwrap();
        let is_explained = key.contains(&format!("{letter}: "));
        assert!(
            is_explained && value.split([' ', '\u{a0}']).next().unwrap().parse::<f64>().is_ok(),
            "{entry}"
        );
    }
    let few = Document::new(&[past_without(&places[..40])], Context::default()).unwrap();
    assert!(html(&few).contains("<tr id=\"m40\"") && !html(&few).contains("<li id=\"m"), "rows");
}

#[test]
fn the_balance_of_the_floor_adds_up_to_its_last_digit() {
    let page = html(&document(Inspection::default()));
    let line = page
        .split_once("Whole floor minus reachable floor: ")
        .unwrap()
        .1
        .split(" scanned although")
        .next()
        .unwrap();
    let numbers: Vec<f64> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
    let [all, parts @ ..] = &numbers[..] else { panic!("{line}") };
    assert!(parts.len() == 3 && (all - parts.iter().sum::<f64>()).abs() < 1e-9, "{line}");
}

#[test]
fn a_report_of_a_scan_and_its_rescan_is_called_after_the_scan_and_a_copy_of_a_run_is_refused() {
    let digest = "a1".repeat(32);
    let (opened, mut again) = (round_tank(0.1), round_tank(0.1));
    again.scenario = "tiny-rescan".into();
    again.scenario_toml = format!("continues_sha256 = [\"{digest}\"]\n{}", again.scenario_toml);
    let scenario = opened.scenario.clone();
    let mut runs = two_runs_of([opened, again]);
    runs[0].files.journal_sha256 = Some(digest.clone());
    assert_eq!(Document::new(&runs, Context::default()).unwrap().scenario, scenario);
    for run in &mut runs {
        run.files.journal_sha256 = Some(digest.clone());
    }
    let refused = Document::new(&runs, Context::default()).unwrap_err();
    assert!(refused.contains("have the same journal"), "{refused}");
}

#[test]
fn a_renamed_folder_keeps_number_and_blocks_the_signature() {
    let mut past = past();
    past.name = "20300101T000000Z-tiny".into();
    past.files = Files {
        recording_sha256: Some("b2".repeat(32)),
        are_as_reported: Some(true),
        closed_as: Some("20261122T040132Z-tiny".into()),
        ..Files::default()
    };
    let document = Document::new(&[past], Context::default()).unwrap();
    assert!(document.number.starts_with("20261122T040132Z-"), "{}", document.number);
    assert_eq!(
        document.gate[12].missing,
        ["20300101T000000Z-tiny: its folder was renamed; rename it back to 20261122T040132Z-tiny"]
    );
}

#[test]
fn a_run_that_is_not_the_signed_one_any_more_is_named() {
    let run = |journal: &str| SignedRun {
        run: "a".into(),
        journal_sha256: Some(journal.into()),
        recording_sha256: Some("rec".into()),
    };
    let revision = Revision {
        number: "1-1".into(),
        revision: "B".into(),
        signature: Signature { by: "L. Kern".into(), at: "2026-11-22 04:01".into() },
        file: "a.html".into(),
        sha256: "00".into(),
        runs: vec![run("one")],
    };
    assert_eq!(
        (revision.doubt(&run("one")), revision.doubt(&SignedRun { run: "b".into(), ..run("other") })),
        (None, None)
    );
    let other = revision.doubt(&run("other"));
    assert_eq!(
        other.as_deref(),
        Some("signed revision B covers a different journal: expected SHA-256 one, found other")
    );
    let lost = revision.doubt(&SignedRun { recording_sha256: None, ..run("one") });
    assert_eq!(
        lost.as_deref(),
        Some("signed revision B covers a different recording: expected SHA-256 rec, found none")
    );
}

/// A ring of missed cells with an island of missed cells in it.
fn ring_with_island() -> Vec<Point> {
    let far = |k: i32| k.abs() == 3;
    let all = (-3..=3).flat_map(|x| (-3..=3).map(move |y| (x, y)));
    let is_missed = |(x, y): &(i32, i32)| far(*x) || far(*y) || (x.abs() <= 1 && y.abs() <= 1);
    all.filter(is_missed)
        .map(|(x, y)| Point::new(1.05 + 0.1 * f64::from(x), 0.55 + 0.1 * f64::from(y)))
        .collect()
}

fn area_m2(ring: &serde_json::Value) -> f64 {
    let at = |p: &serde_json::Value| (p[0].as_f64().unwrap(), p[1].as_f64().unwrap());
    let places: Vec<(f64, f64)> = ring.as_array().unwrap().iter().map(at).collect();
    places.windows(2).map(|pair| pair[0].0 * pair[1].1 - pair[1].0 * pair[0].1).sum::<f64>() / 2.0
}

#[test]
fn missed_areas_are_their_outlines_with_holes_in_geojson_and_dxf() {
    let runs = [past_without(&ring_with_island())];
    let document = Document::new(&runs, Context::default()).unwrap();
    let map: serde_json::Value = serde_json::from_str(&geojson::geojson(&document, &runs)).unwrap();
    let missed: Vec<&serde_json::Value> =
        map["features"].as_array().unwrap().iter().filter(|f| f["properties"]["layer"] == "missed").collect();
    assert_eq!(missed.len(), 2, "the ring and the island");
    for (area, feature) in document.floor.missed.iter().zip(&missed) {
        let rings = feature["geometry"]["coordinates"].as_array().unwrap();
        let outlined_m2: f64 = rings.iter().map(area_m2).sum();
        assert!((outlined_m2 - area.area_m2).abs() < 1e-6, "{outlined_m2} {feature}");
        assert!(area.area_m2 < 0.25, "less than the box around it");
    }
    assert_eq!(missed[0]["geometry"]["coordinates"].as_array().unwrap().len(), 2, "an outline and a hole");
    assert_eq!(missed[0]["properties"]["area_m2"].to_string(), "0.24");
    let drawing = dxf::dxf(&document, &runs);
    assert_eq!(drawing.matches("POLYLINE\n8\nMISSED\n").count(), 3, "two outlines and a hole");
}

#[test]
fn zones_stations_and_plates_are_in_the_files_for_other_programs() {
    let mut run = round_tank(0.1);
    let shape = Shape::Disc { center: Point::new(-2.0, 1.0), radius_m: 0.4 };
    run.world.zones.push(world::Zone { name: "sump".into(), kind: world::ZoneKind::NoGo, shape });
    let position = Point::new(4.9, 0.5);
    run.world.stations.push(world::Station { id: world::StationId(3), name: "S3".into(), position });
    let runs = [past_of(run, &[])];
    let document = Document::new(&runs, Context::default()).unwrap();
    let map: serde_json::Value = serde_json::from_str(&geojson::geojson(&document, &runs)).unwrap();
    let named = |layer: &str, name: &str| {
        let is_it =
            |f: &&serde_json::Value| f["properties"]["layer"] == layer && f["properties"]["name"] == name;
        map["features"].as_array().unwrap().iter().find(is_it).unwrap()["geometry"]["type"].clone()
    };
    let types = [named("no_go_zones", "sump"), named("stations", "S3"), named("plates", "A-01")];
    assert_eq!(types, ["Polygon", "Point", "Polygon"]);
    assert!(map["crs"]["properties"]["name"].as_str().unwrap().starts_with("LOCAL_CS[\"tank frame"));
    let drawing = dxf::dxf(&document, &runs);
    assert!(drawing.contains("CIRCLE\n8\nNO_GO_ZONES\n") && drawing.contains("POINT\n8\nSTATIONS\n"));
    assert!(drawing.contains("\n1\nsump\n") && drawing.contains("\n1\nS3\n"), "names");
}

#[test]
fn a_run_that_was_not_there_to_scan_missed_no_floor_in_any_format() {
    let path = vec![Point::new(-1.75, 0.0), Point::new(1.75, 0.0)];
    let follow = TaskConfig::Follow { path, tolerance_m: 0.2 };
    let goto = TaskConfig::Goto { goal: Point::new(1.0, 1.0), tolerance_m: 0.1 };
    for (task, figures) in [
        (follow, ["preset path of 2 points (3.5 m)", "preset_path_m,3.5"]),
        (goto, ["goal at 1.00, 1.00 m", "straight_to_goal_m,2.926"]),
    ] {
        let mut run = round_tank(0.1);
        run.mission.task = task;
        let missed: Vec<Point> = ring_with_island();
        let runs = [past_of(run, &missed)];
        let document = Document::new(&runs, Context::default()).unwrap();
        let page = html(&document);
        let json = serde_json::to_string(&document).unwrap();
        let tables = csv::tables(&document, &runs);
        let texts = [geojson::geojson(&document, &runs), dxf::dxf(&document, &runs), json.clone()];
        assert!(page.contains(figures[0]) && tables[0].contains(figures[1]), "{}", tables[0]);
        assert!(tables[1].lines().count() == 1 && tables[2].lines().count() == 1, "{tables:?}");
        assert!(
            texts.iter().all(|text| !text.contains("\"missed\"") && !text.contains("POLYLINE\n8\nMISSED"))
        );
        assert!(!json.contains("missed_area_m2\":0") && !json.contains("critical_zone\":"), "{json}");
        assert!(!page.contains("% of the reachable floor was scanned") && !page.contains(">missed<"), "page");
        let asked: Vec<&String> = document.gate.iter().flat_map(|item| &item.missing).collect();
        let unwanted =
            ["inspection.missed_accepted", "inspection.critical_zone_accepted", "inspection.plates_waiver"];
        assert!(asked.iter().all(|key| !unwanted.contains(&key.as_str())), "{asked:?}");
        // The scanning instrument was not part of the work.
        let of_instrument = ["instrument", "calibration_before", "calibration_after", "nominal_thickness_mm"];
        for key in of_instrument.map(|key| format!("inspection.{key}")) {
            assert!(!asked.contains(&&key) && !page.contains(&key), "{key}");
        }
        assert!(asked.iter().all(|key| !key.contains("indications")), "{asked:?}");
        for section in 1..=9 {
            assert!(page.contains(&format!(r#"<h2 id="s{section}">"#)), "section {section}");
        }
        assert!(!page.contains(r#"<h2 id="s10">"#) && !page.contains("href=\"#s10\""), "links");
    }
}

/// A survey of the round tank whose drawing shows three objects: one is found 5 cm to the east, one is not there, and one
/// has not been seen.
fn surveyed(has_map: bool) -> PastRun {
    let disc = |id: u32, x: f64, y: f64| Obstacle {
        id: ObstacleId(id),
        name: format!("C{id}"),
        shape: Shape::Disc { center: Point::new(x, y), radius_m: 0.2 },
        known: true,
    };
    let mut run = round_tank(0.1);
    run.mission.task = TaskConfig::Survey { anchor: Point::new(-1.75, 0.0), tolerance_m: 0.2 };
    run.world.obstacles = vec![disc(1, -1.0, 0.0), disc(2, -1.0, 1.0), disc(3, 1.0, 0.0)];
    let grid = exploration::Grid::of(&run.world.boundary);
    let column = |x: f64, y: f64| exploration::Column {
        center: Point::new(x, y),
        radius_m: 0.21,
        center_sigma_m: 0.01,
        radius_sigma_m: 0.005,
    };
    let cells: String =
        (0..grid.len()).map(|cell| if grid.center(cell).x < 0.0 { "1f" } else { "1u" }).collect();
    let columns = vec![column(-0.95, 0.0), column(-0.5, -1.0)];
    let corners = [[-1.6, -1.0], [-1.2, -1.0], [-1.2, -0.8], [-1.6, -0.8]];
    let pipe = Shape::Polygon { vertices: corners.map(|[x, y]| Point::new(x, y)).to_vec() };
    let map = Box::new(exploration::SurveyMap { grid, cells, columns, others: vec![pipe], explored: 0.5 });
    let mut past = past_of(run, &[]);
    if has_map {
        past.fold.apply(&Event { tick: 1, t_s: 0.1, kind: EventKind::Mapped { map } });
        past.summary = past.fold.summary();
    }
    past
}

#[test]
fn a_survey_is_reported_with_its_map_its_columns_and_the_difference_to_the_drawing() {
    let runs = [surveyed(true)];
    let document = Document::new(&runs, Context::default()).unwrap();
    let page = html(&document);
    for words in [
        "make a map of the floor",
        "3 objects on the drawing: 1 found as columns, 0 as other objects, 1 not there, 1 not seen. 1 column and 1 other \
         object on the map are not on the drawing.",
        "Objects on the map that are neither columns nor on the drawing",
        "C1: 5.0 cm from its drawn place (+5.0 cm east, 0.0 cm north), radius +1.0 cm",
        "free floor: the object is not there",
        "not seen: the drawing was not checked here",
        "on the drawing, but not there",
        "Map made by the survey",
    ] {
        assert!(page.contains(words), "{words}: {page}");
    }
    let json: serde_json::Value = serde_json::from_str(&serde_json::to_string(&document).unwrap()).unwrap();
    let map = &json["task"]["map"];
    assert_eq!((&json["task"]["kind"], &map["drawn"]), (&"survey".into(), &3.into()));
    assert_eq!(map["columns"][0]["drawn"]["name"], "C1");
    assert_eq!(map["columns"][1].get("drawn"), None);
    assert_eq!(map["not_found"][0]["instead"], "free_floor");
    assert_eq!(map["objects_not_drawn"][0]["low"], serde_json::json!([-1.6, -1.0]));
    let tables = csv::tables(&document, &runs);
    let figures = ["explored_percent,50", "columns_not_drawn,1", "objects_not_drawn,1", "drawn_not_found,1"];
    assert!(figures.iter().all(|figure| tables[0].contains(figure)), "{tables:?}");
    // The column, the other object and the drawn object that is not there count; a place that was not seen does not.
    assert!(page.contains(r#"<div class="big">3<small> </small></div><div class="t">differences</div>"#));
    // All files have the columns of the map under the numbers of the page, with their errors.
    assert!(tables[3].contains(",column 1,-0.950,0.000,0.420,0.420,0.020,0.010"), "{}", tables[3]);
    assert!(tables[3].contains(",object 1,"), "{}", tables[3]);
    let features: serde_json::Value = serde_json::from_str(&geojson::geojson(&document, &runs)).unwrap();
    let column = features["features"]
        .as_array()
        .unwrap()
        .iter()
        .find(|one| one["properties"]["source"] == "map" && one["properties"]["name"] == "column 1");
    assert!(column.unwrap()["properties"]["center_95_m"].as_f64().unwrap() > 0.0);
    assert!(dxf::dxf(&document, &runs).contains("column 1 "));
}

#[test]
fn losses_are_on_the_first_sheet_and_contradict_a_statement_that_there_are_none() {
    let mut document = Document::new(&[past()], Context::default()).unwrap();
    let loss = |depth_mm: f64, x: f64| account::Finding {
        t_s: 1.0,
        run: 0,
        at: Point::new(x, 0.5),
        low: Point::new(x, 0.5),
        high: Point::new(x + 0.02, 0.52),
        error_m: 0.02,
        covariance: nalgebra::Matrix2::identity() * 1e-4,
        depth_mm,
        depth_error_mm: 0.6,
        readings: 4,
    };
    let sampling =
        mission::Sampling { channels: 20, pitch_m: 0.005, thickness_mm: 8.0, sigma_mm: 0.3, threshold: 0.2 };
    let mut thickness = thickness::Thickness {
        kind: mission::InstrumentKind::Mfl,
        sampling,
        readings: 1000,
        untestable: 0,
        tested_m2: 9.0,
        plates: vec![],
        losses: vec![],
        unread_m2: 0.0,
        detections: None,
        imported: vec![],
    };
    let mut with = |losses: Vec<account::Finding>, text: Option<&str>| {
        thickness.losses = losses;
        document.thickness = Some(thickness.clone());
        document.inspection.indications = text.map(str::to_owned);
        document.gate = gate::gate(&document);
        (html(&document), document.gate[8].missing.join(" "))
    };
    let (page, missing) = with(vec![], Some("None above 20 % of the thickness"));
    assert!(page.contains("The readings show no loss of 1.6 mm or more (20 % of 8 mm)."), "{page}");
    assert_eq!(missing, "");
    let (page, missing) =
        with(vec![loss(2.0, 0.1), loss(7.2, 0.3)], Some("None above 20 % of the thickness"));
    assert!(page.contains("The readings show 2 indications; the deepest: 7.2 ±0.6 of 8 mm"), "{page}");
    assert!(
        page.contains("at 0.30, 0.50 m") && page.contains("say about indications: `None above"),
        "{page}"
    );
    assert_eq!(missing, "inspection.indications_explained");
    let (page, missing) = with(vec![loss(7.6, 0.3)], Some("Report NDT-7"));
    assert!(page.contains("1 indication can go through the floor"), "{page}");
    assert!(missing.contains("inspection.through_accepted"), "{missing}");
}

#[test]
fn the_stated_day_of_the_inspection_is_on_the_page_and_decides_about_the_certificate() {
    let day = |inspected_on: Option<&str>| {
        let inspection = Inspection {
            inspected_on: inspected_on.map(str::to_owned),
            inspector_certificate_expires: Some("2026-11-26".into()),
            ..Inspection::default()
        };
        let mut run = past();
        run.began = Some("2026-11-30 04:01".into());
        let document = Document::new(&[run], Context { inspection, ..Context::default() }).unwrap();
        (html(&document), document.gate[11].missing.join(" "))
    };
    assert!(day(None).1.contains("expired on 2026-11-26, before the inspection on 2026-11-30"));
    let (page, missing) = day(Some("2026-11-24"));
    assert!(page.contains("inspected on 2026-11-24") && !missing.contains("expired"), "{missing}");
}

#[test]
fn a_survey_that_made_no_map_says_so() {
    let page = html(&Document::new(&[surveyed(false)], Context::default()).unwrap());
    assert!(page.contains("The run ended before it had made a map."), "{page}");
}

#[test]
fn a_run_that_was_not_there_to_scan_is_reported_alone() {
    let mut run = round_tank(0.1);
    run.mission.task = TaskConfig::Goto { goal: Point::new(1.0, 1.0), tolerance_m: 0.1 };
    let mut goto = past_of(run, &[]);
    goto.name = "other".into();
    let refused = Document::new(&[past(), goto], Context::default()).unwrap_err();
    assert_eq!(refused, "run other was not a scan; make a separate report for it");
}

#[test]
fn a_run_without_a_plan_and_without_a_tether_speaks_of_neither() {
    let document =
        Document::new(&[past_of(round_tank(0.1), &ring_with_island())], Context::default()).unwrap();
    let reasons: String = document.floor.missed.iter().map(account::Area::why).collect();
    assert!(reasons.contains("the run had no plan") && !reasons.contains("lanes"), "{reasons}");
    let mut cut = past_without(&ring_with_island());
    plan(&mut cut, vec![vec![Point::new(1.0, 5.0), Point::new(1.0, -5.0)]]);
    let page = html(&Document::new(&[cut], Context::default()).unwrap());
    assert!(!page.contains("unwound") && !page.contains("start and anchor"), "no tether");
}
