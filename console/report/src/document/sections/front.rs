//! The first sheet: title block, verdict, large figures, decisions, scope and terms.

use super::{
    super::{
        decision::Decision,
        decisions::{decisions, is_complete},
        model::Document,
        page::{Block, Field, Page, Section, Share, Table, Todo, Value, Verdict},
        run_part::{RunPart, rule, survey_warnings},
        task::TaskPart,
        words::{number, number_of},
    },
    task,
};
use crate::human::{text::counted, vehicle};
use account::Shares;
use mission::Outcome;

/// Builds the page without its sections.
pub(super) fn page(document: &Document, sections: Vec<Section>) -> Page {
    let answered = document.gate.iter().filter(|item| item.is_answered).count();
    let status = match &document.signature {
        Some(signature) => format!("Signed by {}, {} UTC", signature.by, signature.at),
        None => "Draft, not signed".to_owned(),
    };
    let tank = document.inspection.tank_id.as_ref().unwrap_or(&document.scenario);
    let state = if document.signature.is_some() { "signed" } else { "draft, not signed" };
    let first = document.runs.first();
    let hash = first.and_then(|run| run.files.journal_sha256.as_ref());
    let hash = hash
        .map_or_else(String::new, |hash| format!("Journal SHA-256 {}...   ", &hash[..hash.len().min(16)]));
    // A CSS string ends at a quote or at a line break of any kind.
    let is_end = |letter: char| letter.is_control() || matches!(letter, '\\' | '"');
    let css = |text: String| foreign::markup(&text).replace(is_end, " ");
    Page {
        heading: heading(document),
        banner: document.live.as_ref().map_or_else(String::new, vehicle::sentences),
        title: format!("Inspection report {tank} revision {}", document.revision),
        css: "",
        head: css(format!(
            "Tank {tank}   |   Document {}   |   Revision {} ({state})",
            document.number, document.revision
        )),
        mark: mark(document),
        foot: css(format!("{hash}{}", document.made_by)),
        is_simulation: document.is_simulation,
        is_signed: document.signature.is_some(),
        status,
        answered,
        items: document.gate.len(),
        fields: fields(document),
        verdict: document
            .task
            .as_ref()
            .map_or_else(|| verdict(document), |task| task::verdict(document, task)),
        shares: document.task.as_ref().map_or_else(|| shares(document), |task| task::shares(document, task)),
        bases: document.is_to_scan.then(|| bases(document)),
        todo: todo(document),
        sections,
    }
}

/// The title of the page.
fn heading(document: &Document) -> &'static str {
    match (&document.task, &document.thickness) {
        (Some(TaskPart::Survey { .. }), _) => "Tank floor: map and position record",
        (Some(_), _) => "Tank floor: task and position record",
        (None, Some(_)) => "Tank floor inspection: thickness, coverage and position record",
        (None, None) => "Tank floor inspection: coverage and position record",
    }
}

/// The word at the head of every sheet.
fn mark(document: &Document) -> &'static str {
    match (document.is_simulation, &document.live) {
        (true, _) => "SIMULATION",
        (false, Some(_)) => "LIVE",
        (false, None) => "",
    }
}

fn fields(document: &Document) -> Vec<Field> {
    let facts = &document.inspection;
    let first = document.runs.first();
    let began = first.and_then(|run| run.began.clone());
    let inspected = facts.inspected_on.as_ref().filter(|_| document.located.is_none());
    let time_s: f64 = document.runs.iter().map(|run| run.mission_time_s).sum();
    let field = |class, label, value: Value| Field { class, label, value, note: String::new() };
    let joined = |facts: &[(Option<&String>, &str)]| {
        let known: Vec<&str> = facts.iter().filter_map(|(fact, _)| fact.map(String::as_str)).collect();
        let missing: Vec<String> = facts
            .iter()
            .filter(|(fact, _)| fact.is_none())
            .map(|(_, key)| format!("inspection.{key}"))
            .collect();
        let some = |text: String| Some(text).filter(|text| !text.is_empty());
        Value { text: some(known.join(", ")), missing: some(missing.join(", ")) }
    };
    let tank = Value {
        text: Some(facts.tank_id.clone().unwrap_or_else(|| document.scenario.clone())),
        missing: facts.tank_id.is_none().then(|| "inspection.tank_id".to_owned()),
    };
    vec![
        Field { class: "w2", label: "Tank", value: tank, note: document.size.clone() },
        field(
            "w2",
            "Owner and site",
            joined(&[(facts.client.as_ref(), "client"), (facts.site.as_ref(), "site")]),
        ),
        field("w2 e f", "Document number", document.number.clone().into()),
        Field {
            class: "",
            label: "Date of the run (UTC)",
            value: began.map_or_else(|| Value { text: None, missing: Some("date".into()) }, Value::from),
            note: inspected.map(|day| format!("inspected on {day}")).unwrap_or_default(),
        },
        field("", "Mission time", account::clock(time_s).into()),
        field("", "Revision", document.revision.clone().into()),
        field("", "Language", "en".into()),
        field("w2 e f", "Made by", document.made_by.clone().into()),
        field(
            "w2 b f",
            "Inspector",
            joined(&[
                (facts.inspector.as_ref(), "inspector"),
                (facts.inspector_certificate.as_ref(), "inspector_certificate"),
            ]),
        ),
        field("w2 b f", "Approved by", joined(&[(facts.approver.as_ref(), "approver")])),
        field(
            "w2 e b f",
            "Order and drawing",
            joined(&[(facts.order.as_ref(), "order"), (facts.drawing.as_ref(), "drawing")]),
        ),
    ]
}

fn verdict(document: &Document) -> Verdict {
    let floor = &document.floor;
    let last = document.runs.last();
    let due = floor.due();
    let (scanned, sure) = (due.percent.scanned, due.percent.guaranteed.unwrap_or(0.0));
    let of = if floor.requested.is_some() { "requested" } else { "reachable" };
    let zone = if floor.critical_zone.done { "complete" } else { "not complete" };
    let missed_m2 = due.missed * due.area_m2;
    let cause = |cause: Option<String>| survey_warnings(document).chain(cause).collect::<Vec<_>>().join(" ");
    if is_complete(document) {
        let is_all = due.missed < 0.005 && floor.critical_zone.done;
        return Verdict {
            class: if is_all { "" } else { "part" },
            lead: format!(
                "{scanned:.1} % of the {of} floor was scanned; {sure:.1} % is guaranteed, allowing for \
                 {}. The critical zone along the shell is {zone}.",
                rule(document).allowance()
            ),
            cause: cause(None),
        };
    }
    let end = match last.and_then(|run| run.outcome) {
        None => "the recording stops before the end of the mission".to_owned(),
        Some(Outcome::Aborted) => "the mission was ended early".to_owned(),
        Some(other) => format!("the mission ended early ({})", other.word().replace('_', " ")),
    };
    let recovered = last.and_then(|run| run.files.recovered.as_ref());
    let recovered =
        recovered.map(|how| format!("the run was not closed when it ended, and was later closed {how}"));
    let reason = last.and_then(|run| run.reason.clone()).or(recovered);
    Verdict {
        class: "bad",
        lead: format!(
            "Not complete: {end}. {scanned:.1} % of the {of} floor was scanned; {missed_m2:.1} m² was \
             not."
        ),
        cause: cause(reason.map(|reason| format!("Cause: {reason}."))),
    }
}

fn shares(document: &Document) -> Vec<Share> {
    let (whole, reachable) = (&document.floor.whole, &document.floor.reachable);
    let m2 = |share: f64, of: &Shares| format!("{:.1}", share * of.area_m2);
    let sure = reachable.guaranteed.unwrap_or(0.0);
    // The table below has the whole floor too.
    let first = match &document.floor.requested {
        Some(requested) => Share {
            value: format!("{:.1}", requested.percent.scanned),
            unit: "%",
            of: "of the requested floor",
            about: format!(
                "{} of {:.1} m² of reachable floor that the mission had to scan",
                m2(requested.scanned, requested),
                requested.area_m2
            ),
        },
        None => Share {
            value: format!("{:.1}", whole.percent.scanned),
            unit: "%",
            of: "of the whole floor",
            about: format!(
                "{} of {:.1} m² of floor within the shell, excluding the footprint of obstacles",
                m2(whole.scanned, whole),
                whole.area_m2
            ),
        },
    };
    vec![
        first,
        Share {
            value: format!("{:.1}", reachable.percent.scanned),
            unit: "%",
            of: "of the reachable floor",
            about: format!(
                "{} of {:.1} m² that the tool can reach from where the hull fits with its clearance",
                m2(reachable.scanned, reachable),
                reachable.area_m2
            ),
        },
        Share {
            value: format!("{:.1}", reachable.percent.guaranteed.unwrap_or(0.0)),
            unit: "%",
            of: "of the reachable floor, guaranteed",
            about: format!(
                "{} m² {}; {:.1} % of the whole floor",
                m2(sure, reachable),
                rule(document).definition(),
                whole.percent.guaranteed.unwrap_or(0.0)
            ),
        },
    ]
}

fn bases(document: &Document) -> Table {
    let has_untestable = document.floor.whole.untestable > 0.0;
    let mut columns = vec![
        ("Base", "", ""),
        ("Area", "m²", "r"),
        ("Scanned", "%", "r"),
        ("Missed", "%", "r"),
        ("Unreachable", "%", "r"),
        ("Shell margin", "%", "r"),
        ("Sum", "%", "r"),
        ("Guaranteed part", "%", "r"),
    ];
    if has_untestable {
        columns.insert(6, ("Not testable", "%", "r"));
    }
    let mut table = Table::new("", &columns);
    let requested = document.floor.requested.as_ref().map(|requested| ("Requested floor", requested));
    let floors = [("Whole floor", &document.floor.whole), ("Reachable floor", &document.floor.reachable)];
    for (name, shares) in floors.into_iter().chain(requested) {
        let p = &shares.percent;
        let tenth = |value: f64| Value::from(format!("{value:.1}"));
        let mut row = vec![
            name.into(),
            tenth(shares.area_m2),
            tenth(p.scanned),
            tenth(p.missed),
            tenth(p.unreachable),
            tenth(p.margin),
            tenth(p.scanned + p.missed + p.unreachable + p.margin + p.untestable),
            tenth(p.guaranteed.unwrap_or(0.0)),
        ];
        if has_untestable {
            row.insert(6, tenth(p.untestable));
        }
        table.row(row);
    }
    table
}

fn todo(document: &Document) -> Vec<Todo> {
    let decision = |decision: Decision| {
        let value = Value::fact(decision.answer.as_ref(), decision.key);
        Todo { text: decision.what, value, section: number_of(document.is_to_scan, decision.section) }
    };
    let mut todo: Vec<Todo> = decisions(document).into_iter().map(decision).collect();
    let open: Vec<String> = document.open_items().map(|item| item.number.to_string()).collect();
    if !open.is_empty() {
        let text = format!("Open gate items: {}.", open.join(", "));
        todo.push(Todo { text, value: Value::default(), section: number_of(document.is_to_scan, 10) });
    }
    todo
}

/// The scope of the mission and the terms of the report.
pub(super) fn scope(document: &Document) -> Vec<Block> {
    let floor = &document.floor;
    let zone_mm = 1000.0 * floor.critical_zone.width_m;
    let cell_cm = 100.0 * floor.cell_m;
    let name = |(number, run): (usize, &RunPart)| match document.runs.len() {
        1 => run.run.clone(),
        _ => format!("({number}) {}", run.run),
    };
    let runs: Vec<String> = (1..).zip(&document.runs).map(name).collect();
    let asked = &document.gate[1].answer;
    vec![
        Block::Text(format!(
            "Scenario {}: {asked}. Based on {}: {}. Tool: swath {} m. Cell size: {} cm; a cell counts as \
             scanned if the tool passed over its centre while the 95 % position error was at most {} m. \
             Every percentage states what it refers to.",
            document.scenario,
            counted(runs.len() as u64, "run"),
            runs.join(", "),
            floor.swath_m,
            number(cell_cm, 1),
            floor.position_limit_m
        )),
        Block::Heading("Definitions".into()),
        Block::Words(vec![
            ("Whole floor", "all floor within the shell, excluding the footprint of obstacles".into()),
            (
                "Reachable floor",
                "floor that the tool can reach from where the hull fits with its clearance".into(),
            ),
            (
                "Scanned",
                "the tool passed over the centre of the cell while the 95 % position error was \
                within the limit"
                    .into(),
            ),
            ("Guaranteed", rule(document).definition().into()),
            ("Missed", "reachable, but not scanned; each area has a number, a position and a reason".into()),
            ("Unreachable", "beside obstacles, in no-go zones, or closed off".into()),
            ("Shell margin", "unreachable because the robot keeps its distance from the shell".into()),
            (
                "Critical zone",
                format!("a strip of {zone_mm:.0} mm along the shell, evaluated separately in layers of 5 mm"),
            ),
        ]),
    ]
}
