//! The items that must be answered before a report can be signed.

use super::{
    certificate,
    decision::{INDICATIONS, MISSED, SCOPE, TANK},
    decisions::{decisions, is_complete},
    located,
    model::{Document, GateItem},
    run_part::{RunPart, pulse_tests},
    words::number_of,
};
use crate::{human::text::counted, record::Incident};
use account::{clock, says_nothing};
use mission::RunOpened;
use world::Boundary;

/// The answer to an item, and the facts or actions that are still missing.
type Answered = (String, Vec<String>);

/// Returns the thirteen items of a document.
pub(super) fn gate(document: &Document) -> Vec<GateItem> {
    // Located readings have no planner and no missed floor.
    let [of_equipment, of_missed] = if document.located.is_some() {
        ["Equipment, version, readings", "Floor that the tool did not pass over"]
    } else {
        ["Equipment, planner, versions, seed, parameters", "Missed areas, each with a reason"]
    };
    let items: [(&'static str, Answered); 13] = [
        ("Tank: number, size, plates, nominal thickness, drawing", tank(document)),
        ("Scope of the inspection", scope(document)),
        (of_equipment, equipment(document)),
        ("Calibration before and after the run, stations, speed of sound", calibration(document)),
        ("Coverage of every plate", plates(document)),
        (of_missed, missed(document)),
        ("Unreachable floor, each area with a reason", unreachable(document)),
        ("Position accuracy", accuracy(document)),
        ("Indications", indications(document)),
        ("Tether record", tether(document)),
        ("Review of alarms, faults, holds and early ends", incidents(document)),
        ("Inspector, certificate, remarks", remarks(document)),
        ("Journal, recording and report.json bound to this report", hashes(document)),
    ];
    let numbered = items.into_iter().zip(1..);
    let item = |((what, (answer, missing)), number): ((&'static str, Answered), usize)| GateItem {
        number,
        what,
        is_answered: missing.is_empty(),
        answer,
        missing,
    };
    numbered.map(item).collect()
}

/// Returns the problems of required facts: missing keys, and facts without content.
fn asked(facts: &[(&str, &Option<String>)]) -> Vec<String> {
    let lack = |(key, fact): &(&str, &Option<String>)| match fact {
        Some(text) => empty(key, text),
        None => Some(format!("inspection.{key}")),
    };
    facts.iter().filter_map(lack).collect()
}

/// Returns the problems of facts about the scanning instrument, which are required if it was part of the work.
fn of_instrument(document: &Document, facts: &[(&str, &Option<String>)]) -> Vec<String> {
    if document.uses_instrument() { asked(facts) } else { given(facts) }
}

/// Returns the problems of optional facts: those without content.
fn given(facts: &[(&str, &Option<String>)]) -> Vec<String> {
    facts.iter().filter_map(|(key, fact)| empty(key, fact.as_ref()?)).collect()
}

/// The message about a fact without content.
fn empty(key: &str, text: &str) -> Option<String> {
    says_nothing(text).then(|| format!("inspection.{key} has no content: `{}`", text.trim()))
}

/// Adds the decisions that belong to an item. A decision that was made is added to the answer, any other decision to
/// the missing facts.
fn decided(document: &Document, item: usize, (answer, mut lacks): Answered) -> Answered {
    let mut answers = vec![answer];
    for decision in decisions(document).into_iter().filter(|decision| decision.item == item) {
        match decision.answer {
            Some(why) if says_nothing(&why) => lacks.extend(empty(decision.key, &why)),
            Some(why) => answers.push(format!("{}: {why}", decision.key.replace('_', " "))),
            None => lacks.push(format!("inspection.{}", decision.key)),
        }
    }
    (answers.join("; "), lacks)
}

/// The size of a tank.
pub(super) fn size(run: &RunOpened) -> String {
    match &run.world.boundary {
        Boundary::Circle { radius_m } => format!("round, inner radius {radius_m} m"),
        boundary @ Boundary::Polygon { vertices } => {
            let (low, high) = boundary.bounds();
            let (x, y) = (high.x - low.x, high.y - low.y);
            format!("{} straight walls, {x:.1} m by {y:.1} m", vertices.len())
        }
    }
}

fn tank(document: &Document) -> Answered {
    let facts = &document.inspection;
    let plates = match document.floor.plates.len() {
        0 => "plate layout not given".to_owned(),
        n => counted(n as u64, "plate"),
    };
    let mut lacks = asked(&[("tank_id", &facts.tank_id), ("drawing", &facts.drawing)]);
    let is_thickness_missing = document.uses_instrument() && facts.nominal_thickness_mm.is_none();
    lacks.extend(is_thickness_missing.then(|| "inspection.nominal_thickness_mm".to_owned()));
    lacks.extend(given(&[("client", &facts.client), ("site", &facts.site), ("datum_crs", &facts.datum_crs)]));
    decided(document, TANK, (format!("{}, {plates}", document.size), lacks))
}

fn scope(document: &Document) -> Answered {
    if let Some(located) = &document.located {
        let facts = &document.inspection;
        let lacks = asked(&[("order", &facts.order), ("procedure", &facts.procedure), ("code", &facts.code)]);
        return decided(document, SCOPE, (located::scope(located), lacks));
    }
    let what = if document.is_whole_floor { "whole floor" } else { "part of the floor" };
    let facts = &document.inspection;
    let lacks = asked(&[("order", &facts.order), ("procedure", &facts.procedure), ("code", &facts.code)]);
    let early = if is_complete(document) { "" } else { "; mission ended early" };
    let zone_mm = 1000.0 * document.floor.critical_zone.width_m;
    let answer = match &document.task {
        Some(task) => format!("{}{early}; scanning the floor was not part of the mission", task.words()),
        None => format!("{what} and the critical zone, {zone_mm:.0} mm along the shell{early}"),
    };
    decided(document, SCOPE, (answer, lacks))
}

fn equipment(document: &Document) -> Answered {
    let facts = &document.inspection;
    let mut lacks = asked(&[("robot", &facts.robot)]);
    lacks.extend(of_instrument(document, &[("instrument", &facts.instrument)]));
    lacks.extend(given(&[("operator", &facts.operator)]));
    if let Some(located) = &document.located {
        return (located::equipment(document, located), lacks);
    }
    let flown = |run: &RunPart| {
        let drivers: Vec<&str> = run.drivers.iter().map(|driver| driver.name.as_str()).collect();
        // A survey has no planner.
        let drivers = if drivers.is_empty() { "no planner".to_owned() } else { drivers.join(", ") };
        format!("tankops {}, {drivers}, seed {}", run.tankops_version, run.seed)
    };
    (document.runs.iter().map(flown).collect::<Vec<_>>().join("; "), lacks)
}

fn calibration(document: &Document) -> Answered {
    let facts = &document.inspection;
    let mut lacks = of_instrument(
        document,
        &[("calibration_before", &facts.calibration_before), ("calibration_after", &facts.calibration_after)],
    );
    // Pulses that the stations sent in the run are such a check, if all of them agree with the survey.
    let mut pulses = pulse_tests(document).peekable();
    if pulses.peek().is_none() || !pulses.all(|test| test.agrees) {
        lacks.extend(asked(&[("station_check", &facts.station_check)]));
    }
    lacks.extend(asked(&[("sound_speed", &facts.sound_speed)]));
    let sound = facts.sound_speed.as_ref().filter(|text| !says_nothing(text));
    lacks.extend(sound.filter(|text| !is_determined(text)).map(|text| {
        format!(
            "inspection.sound_speed must state both the speed in m/s and how it was determined: `{}`",
            text.trim()
        )
    }));
    let section = number_of(document.is_to_scan, 8);
    (if lacks.is_empty() { format!("stated in section {section}") } else { String::new() }, lacks)
}

/// The answer to gate items about scanning, for a run whose task was not to scan.
fn no_scan() -> Answered {
    ("scanning the floor was not part of the mission".to_owned(), Vec::new())
}

/// Whether a text contains a number and more than its unit.
fn is_determined(text: &str) -> bool {
    let has_number = text.contains(|letter: char| letter.is_ascii_digit());
    let words = text.split(|letter: char| !letter.is_alphabetic());
    has_number && words.into_iter().any(|word| word.chars().count() > 2)
}

fn plates(document: &Document) -> Answered {
    if !document.is_to_scan {
        return no_scan();
    }
    let plates = &document.floor.plates;
    if plates.is_empty() {
        let waiver = document.inspection.plates_waiver.clone();
        let lacks = asked(&[("plates_waiver", &waiver)]);
        let waived = waiver.map(|why| format!(": {why}")).unwrap_or_default();
        return (format!("plate layout not given{waived}"), lacks);
    }
    if document.located.as_ref().is_some_and(|located| located.tool_on_s.is_none()) {
        return located::plates(document);
    }
    // No accuracy is required for a plate of which no part could be scanned. Located readings have no scan task, so no
    // accuracy is required for any plate without scanned floor.
    let has_figure = |plate: &&account::PlateAccount| {
        let could_be_scanned = plate.shares.missed > 0.0 && document.located.is_none();
        plate.error_p95_m.is_some() || plate.shares.scanned <= 0.0 && !could_be_scanned
    };
    let without: Vec<&str> =
        plates.iter().filter(|plate| !has_figure(plate)).map(|plate| &*plate.name).collect();
    let lacks = without.iter().map(|name| format!("accuracy on plate {name}: none of its floor was scanned"));
    (format!("figures for {} of {} plates", plates.len() - without.len(), plates.len()), lacks.collect())
}

fn missed(document: &Document) -> Answered {
    if !document.is_to_scan {
        return no_scan();
    }
    let floor = &document.floor;
    if let Some(located) = &document.located {
        return decided(document, MISSED, located::missed(located));
    }
    let without = floor.missed.iter().filter(|area| area.causes.iter().any(|cause| cause.text.is_empty()));
    let lacks = without
        .map(|area| format!("reason for the missed area at {:.2}, {:.2} m", area.at.x, area.at.y))
        .collect();
    let text = format!(
        "{} with a reason, {} smaller ones, {:.2} m² in total",
        counted(floor.missed.len() as u64, "area"),
        floor.slivers.count,
        floor.slivers.area_m2
    );
    decided(document, MISSED, (text, lacks))
}

fn unreachable(document: &Document) -> Answered {
    if document.located.is_some() {
        return located::unreachable();
    }
    if !document.is_to_scan {
        return no_scan();
    }
    let (floor, slivers) = (&document.floor, &document.floor.unreachable_slivers);
    let listed = floor.unreachable.len();
    let text = format!(
        "{} with a reason, {} smaller ones, {:.2} m² in total",
        counted(listed as u64, "area"),
        slivers.count,
        slivers.area_m2
    );
    (text, Vec::new())
}

fn accuracy(document: &Document) -> Answered {
    let stated: Vec<_> = document.runs.iter().filter_map(|run| run.accuracy).collect();
    let text = |a: &account::Accuracy| {
        format!("95 % error: p95 {:.3} m, largest {:.3} m, limit {} m", a.p95_m, a.max_m, a.limit_m)
    };
    let lacks = if stated.len() < document.runs.len() {
        vec!["an estimated position in every run".to_owned()]
    } else {
        vec![]
    };
    (stated.iter().map(text).collect::<Vec<_>>().join("; "), lacks)
}

fn indications(document: &Document) -> Answered {
    let stated = document.inspection.indications.clone();
    let placed = document.indications.len();
    if placed == 0 && stated.is_none() && !document.uses_instrument() {
        return no_scan();
    }
    if placed == 0 && stated.is_none() {
        let lacks = vec!["inspection.indications, or an indications file (--indications)".to_owned()];
        return (String::new(), lacks);
    }
    let lacks = given(&[("indications", &stated)]);
    let placed = (placed > 0).then(|| format!("{placed} placed on the map"));
    decided(document, INDICATIONS, (placed.into_iter().chain(stated).collect::<Vec<_>>().join("; "), lacks))
}

fn tether(document: &Document) -> Answered {
    if document.located.is_some() {
        return located::tether();
    }
    let text = |run: &RunPart| {
        run.tether.as_ref().map_or_else(
            || "no tether".to_owned(),
            |tether| format!("up to {:.1} m of {:.1} m paid out", tether.length_max_m, tether.reel_length_m),
        )
    };
    (document.runs.iter().map(text).collect::<Vec<_>>().join("; "), Vec::new())
}

fn incidents(document: &Document) -> Answered {
    let all = document.runs.iter().flat_map(|run| &run.incidents);
    let count = all.filter(|incident| Incident::needs_review(incident)).count();
    let by = &document.inspection.events_reviewed_by;
    let reviewers = [("events_reviewed_by", by)];
    let lacks = if count == 0 { given(&reviewers) } else { asked(&reviewers) };
    let reviewed = by.as_ref().map(|name| format!(", reviewed by {name}")).unwrap_or_default();
    let early = |incident: &&Incident| incident.kind == "end" && incident.needs_review();
    let ends = document.runs.iter().flat_map(|run| &run.incidents).filter(early);
    let ends = ends.map(|end| format!("{}, at {}", end.text, clock(end.t_s)));
    let counted = format!("alarms, faults, holds and early ends: {count}{reviewed}");
    (std::iter::once(counted).chain(ends).collect::<Vec<_>>().join("; "), lacks)
}

fn remarks(document: &Document) -> Answered {
    let facts = &document.inspection;
    let remarks = facts.remarks.clone();
    let mut lacks = asked(&[
        ("remarks", &remarks),
        ("inspector", &facts.inspector),
        ("inspector_certificate", &facts.inspector_certificate),
    ]);
    lacks.extend(given(&[("approver", &facts.approver)]));
    lacks.extend(certificate::doubts(document));
    (remarks.unwrap_or_default(), lacks)
}

fn hashes(document: &Document) -> Answered {
    let mut lacks = Vec::new();
    for run in &document.runs {
        let files = &run.files;
        lacks.extend(files.doubts.iter().map(|doubt| format!("{}: {doubt}", run.run)));
        if let Some(then) = files.closed_as.as_ref().filter(|then| **then != run.run) {
            lacks.push(format!("{}: its folder was renamed; rename it back to {then}", run.run));
        }
        if files.are_as_reported.is_none() {
            lacks.push(format!(
                "{name}: its report.json is missing or states no digests, so the files cannot be checked; \
                 `tankops recover {name} --by NAME` closes the run",
                name = run.run
            ));
        }
        if files.recording_sha256.is_none() {
            lacks.push(format!("{}: the recording is missing", run.run));
        }
    }
    if !lacks.is_empty() {
        return (String::new(), lacks);
    }
    let recovered = |run: &RunPart| {
        let recovered = run.files.recovered.as_ref()?;
        Some(format!("{} was not closed when it ended, and was later closed {recovered}", run.run))
    };
    let bound = "SHA-256 of journal and recording unchanged since the run was closed; report.json agrees \
        with the journal";
    let recovered = document.runs.iter().filter_map(recovered);
    (std::iter::once(bound.to_owned()).chain(recovered).collect::<Vec<_>>().join("; "), lacks)
}
