//! Two surveys of one floor, three years apart.

use crate::bench::{Bench, scenario};
use serde_json::Value;
use std::{fs, path::Path};

/// Flies both surveys; the names of the runs, the earlier one first.
fn surveyed(bench: &Bench) -> [String; 2] {
    ["inspect-circle.toml", "inspect-circle-later.toml"].map(|file| flown(bench, &scenario(file)))
}

/// Flies a mission and returns the name of its run.
fn flown(bench: &Bench, file: &Path) -> String {
    let before = bench.runs();
    let flown = bench.fly(file, &[]);
    assert_eq!(flown.code, Some(0), "{flown:?}");
    let run = bench.runs().into_iter().find(|run| !before.contains(run)).unwrap();
    run.file_name().unwrap().to_string_lossy().into_owned()
}

/// The growth of a random pit of the scenarios from its depth in the second survey, millimetres.
fn true_growth_mm(depth_mm: f64) -> f64 {
    0.3 + 0.6 * (depth_mm - 1.3) / 6.6
}

#[test]
fn growth_new_and_gone_indications_agree_with_the_true_floor_in_every_format() {
    let bench = Bench::new();
    let [first, second] = surveyed(&bench);
    for file in ["c.json", "c.html", "c.csv"] {
        let compared =
            bench.tankops(&["compare-surveys", &first, &second, "--minimum-mm", "1.0", "-o", file]);
        assert_eq!(compared.code, Some(0), "{compared:?}");
    }
    let read = |file: &str| fs::read_to_string(bench.path().join(file)).unwrap();
    let found: Value = serde_json::from_str(&read("c.json")).unwrap();
    let list = |key: &str| found[key].as_array().unwrap().clone();
    let (matched, new, gone) = (list("matched"), list("new"), list("gone"));
    assert!((found["years"].as_f64().unwrap() - 3.0).abs() < 0.01);
    assert!(matched.len() >= 15, "{} matched", matched.len());
    for residual in found["registration"]["residuals"].as_array().unwrap() {
        assert!(residual["max_m"].as_f64().unwrap() < 1e-9, "{residual}");
    }
    let at = |one: &Value| [0, 1].map(|axis| one["at"][axis].as_f64().unwrap());
    let is_at = |one: &Value, place: [f64; 2]| {
        let [x, y] = at(one);
        (x - place[0]).hypot(y - place[1]) < 0.1
    };
    // The listed pit has lost another 1.2 mm, and the listed new pits are new where they were tested.
    let pit = matched.iter().find(|pair| is_at(&pair["second"], [-1.1, 0.9])).unwrap();
    let interval = |pair: &Value| [0, 1].map(|end| pair["growth"]["interval_mm"][end].as_f64().unwrap());
    let [low, high] = interval(pit);
    assert!((low..=high).contains(&1.2), "{pit}");
    let listed = [[-0.6, -1.1], [-2.6, 0.4], [0.9, -1.9], [0.5, 0.9], [-1.0, 2.4]];
    let is_new = |place: &&[f64; 2]| new.iter().any(|one| is_at(&one["indication"], **place));
    let is_old = |place: &&[f64; 2]| matched.iter().any(|pair| is_at(&pair["second"], **place));
    assert!(listed.iter().filter(is_new).count() >= 3, "{new:?}");
    assert_eq!(listed.iter().filter(is_old).count(), 0);
    // Losses in the thin area were joined: none is gone from tested floor, and the joined ones are not called new.
    let is_alone = |one: &Value| one["is_tested"] == true && one["part_of"].is_null();
    assert!(!gone.iter().any(is_alone), "{gone:?}");
    assert!(!new.iter().any(|one| is_at(&one["indication"], [1.41, 1.88])), "{new:?}");
    // Nine of ten intervals of the random pits contain their true growth.
    let is_random = |pair: &&Value| pair["is_cut"] == false && !is_at(&pair["second"], [-1.1, 0.9]);
    let random: Vec<&Value> = matched.iter().filter(is_random).collect();
    assert!(random.len() >= 15, "{} matches", random.len());
    let is_covered = |pair: &&&Value| {
        let [low, high] = interval(pair);
        (low..=high).contains(&true_growth_mm(pair["second"]["depth_mm"].as_f64().unwrap()))
    };
    let covered = random.iter().filter(is_covered).count();
    assert!(10 * covered >= 9 * random.len(), "{covered} of {}", random.len());
    // All formats have the same indications and rates, and the page says what the date is.
    let (html, csv, plates) = (read("c.html"), read("c.csv"), read("c-plates.csv"));
    assert_eq!(csv.lines().count(), 1 + matched.len() + new.len() + gone.len());
    assert_eq!(plates.lines().count(), 1 + list("plates").len());
    for pair in &matched {
        let numbers = ["first", "second"].map(|side| pair[side]["number"].to_string());
        let rate = pair["growth"]["rate_mm_per_a"].as_f64().unwrap();
        let row = csv.lines().find(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            cells[0] == "both" && [cells[2], cells[7]] == numbers
        });
        assert!(row.unwrap().contains(&format!(",{rate:.3},")), "{row:?}");
    }
    // The deepest pit has already reached the least thickness, so the date is that of the second survey.
    let (due, outlook) = (&found["due"], &found["due"]["outlook"]);
    let of = |key: &str| outlook[key].as_f64().unwrap();
    assert!(8.0 - of("depth_mm") - of("depth_error_mm") - 1.0 < 0.0, "{outlook}");
    assert_eq!((due["date"].as_str(), of("years")), (Some("2029-11-24"), 0.0));
    assert!(html.contains("Calculated date") && html.contains("2029-11-24"));
    assert!(html.contains("judgement. It claims no conformity with any standard"));
    assert!(html.contains(&format!("{} are new.", new.iter().filter(|one| is_alone(one)).count())));
}

#[test]
fn surveys_that_cannot_be_compared_are_refused_with_the_reason() {
    let bench = Bench::new();
    let [first, second] = surveyed(&bench);
    let refused = |more: &[&str]| {
        let ended = bench.tankops(&[&["compare-surveys"], more, &["-o", "c.html"]].concat());
        assert_eq!(ended.code, Some(2), "{ended:?}");
        assert!(!bench.path().join("c.html").exists());
        ended.err
    };
    assert!(refused(&[&second, &first]).contains("the second survey must be later; swap the runs"));
    assert!(refused(&[&first, &first]).contains("the second survey must be later"));
    let facts =
        |text: &str| bench.file("facts.toml", format!("[inspection]\n{text}\n")).display().to_string();
    let other = facts("inspected_on = \"2020-01-01\"");
    let why = refused(&[&first, &second, "--inspection-second", &other]);
    assert!(why.contains("on 2026-11-24") && why.contains("on 2020-01-01"), "{why}");
    // One run twice, as if it were a later survey.
    let later = facts("inspected_on = \"2031-01-01\"");
    let why = refused(&[&first, &first, "--inspection-second", &later]);
    assert!(why.contains("both surveys are one run"), "{why}");
    let [tank, other_tank] = ["one.toml", "other.toml"].map(|name| {
        let text = format!("[inspection]\ntank_id = \"{name}\"\n");
        bench.file(name, text).display().to_string()
    });
    let why = refused(&[&first, &second, "--inspection-first", &tank, "--inspection-second", &other_tank]);
    assert!(
        why.contains("tank_id is one.toml in the first survey and other.toml in the second one"),
        "{why}"
    );
    // A scenario without a day, and a run without readings.
    let without = fs::read_to_string(scenario("inspect-circle.toml")).unwrap();
    let without =
        without.replace("inspected_on = \"2026-11-24\"\n", "").replace("\"inspect-circle\"", "\"dateless\"");
    let dateless = flown(&bench, &bench.file("dateless.toml", without));
    let why = refused(&[&dateless, &second]);
    assert!(why.contains("does not state the day of its inspection; write inspected_on ="), "{why}");
    let blind = fs::read_to_string(scenario("cover-circle.toml")).unwrap();
    let blind = flown(
        &bench,
        &bench.file("blind.toml", format!("{blind}\n[inspection]\ninspected_on = \"2020-01-01\"\n")),
    );
    let why = refused(&[&blind, &second]);
    assert!(why.contains("has no readings of thickness: its scenario needs [instrument]"), "{why}");
}

#[test]
fn surveys_with_changed_files_are_refused_and_a_missing_file_is_named() {
    let bench = Bench::new();
    let [first, second] = surveyed(&bench);
    let compare = |file: &str| bench.tankops(&["compare-surveys", &first, &second, "-o", file]);
    let readings = bench.path().join("logs").join(&first).join("readings.parquet");
    let whole = fs::read(&readings).unwrap();
    fs::remove_file(&readings).unwrap();
    let missing = compare("missing.html");
    let named = format!("readings.parquet of run {first} is missing");
    assert!(missing.code == Some(0) && missing.out.contains(&named), "{missing:?}");
    let mut changed = whole;
    let middle = changed.len() / 2;
    changed[middle] ^= 1;
    fs::write(&readings, changed).unwrap();
    let refused = compare("changed.html");
    assert!(
        refused.code == Some(2) && refused.err.contains("readings.parquet is not the file"),
        "{refused:?}"
    );
    fs::remove_file(&readings).unwrap();
    let run = bench.path().join("logs").join(&second);
    let text = crate::bench::journal_text(&run);
    let at = text.rfind("\"t_s\":").unwrap();
    crate::bench::change_journal(&run, &format!("{} {}", &text[..at], &text[at..]));
    let refused = compare("journal.html");
    assert!(refused.code == Some(2) && refused.err.contains("a different journal"), "{refused:?}");
    assert!(!bench.path().join("changed.html").exists() && !bench.path().join("journal.html").exists());
}

#[test]
fn a_survey_that_was_not_closed_is_refused_and_one_that_was_cut_off_is_named() {
    let bench = Bench::new();
    let [first, second] = surveyed(&bench);
    let run = bench.path().join("logs").join(&first);
    let compare = |file: &str| bench.tankops(&["compare-surveys", &first, &second, "-o", file]);
    fs::remove_file(run.join("report.json")).unwrap();
    let refused = compare("open.html");
    assert!(
        refused.code == Some(2) && refused.err.contains(&format!("`tankops recover {first} --by NAME`")),
        "{refused:?}"
    );
    assert!(!bench.path().join("open.html").exists());
    let text = crate::bench::journal_text(&run);
    let end = text[..text.len() / 2].rfind('\n').unwrap() + 1;
    crate::bench::change_journal(&run, &text[..end]);
    let closed = bench.tankops(&["recover", &first, "--by", "L. Kern"]);
    assert_eq!(closed.code, Some(0), "{closed:?}");
    let compared = compare("cut.html");
    assert!(
        compared.code == Some(0) && compared.err.contains("it was cut off, and later closed by L. Kern"),
        "{compared:?}"
    );
    let page = fs::read_to_string(bench.path().join("cut.html")).unwrap();
    assert!(page.contains("The first survey is not whole: it was cut off, and later closed by L. Kern"));
}
