//! The last sections: equipment, limitations, gate, signatures, provenance.

use super::super::{
    model::Document,
    packed,
    page::{Block, SignatureBlock, Table, Value},
    readings::Readings,
    run_part::{RunPart, calibrations, is_pulse_tested, is_sound_known, pulse_tests, rule, survey_warnings},
    words::{cm, number},
};

/// Equipment, calibration, and the fixes of each run, station by station.
pub(in crate::document) fn equipment(document: &Document) -> Vec<Block> {
    let facts = &document.inspection;
    let floor = &document.floor;
    let thickness = facts.nominal_thickness_mm.map(|mm| format!("{mm} mm"));
    let of_instrument = [
        (
            "Instrument",
            Value::with_fact(format!("swath {} m", floor.swath_m), facts.instrument.as_ref(), "instrument"),
        ),
        ("Calibration before", Value::fact(facts.calibration_before.as_ref(), "calibration_before")),
        ("Calibration after", Value::fact(facts.calibration_after.as_ref(), "calibration_after")),
        ("Nominal thickness of the floor", Value::fact(thickness.as_ref(), "nominal_thickness_mm")),
    ];
    let mut equipment = vec![("Robot", Value::fact(facts.robot.as_ref(), "robot"))];
    // A fact that was given is shown, even if it is not required.
    let is_shown = |(_, value): &(&str, Value)| document.uses_instrument() || value.missing.is_none();
    equipment.extend(of_instrument.into_iter().filter(is_shown));
    equipment.extend([
        ("Stations: survey and pulse test", station_check(document)),
        ("Speed of sound", sound_speed(document)),
        ("Procedure", Value::fact(facts.procedure.as_ref(), "procedure")),
        ("Operator", Value::fact(facts.operator.as_ref(), "operator")),
    ]);
    let mut blocks = vec![Block::Facts(equipment)];
    for run in document.runs.iter().filter(|run| !run.stations.is_empty()) {
        let of = if document.runs.len() > 1 { format!(" ({})", run.run) } else { String::new() };
        let has_clocks = run.stations.iter().any(|station| station.clock_offset_m.is_some());
        let mut columns = vec![
            ("Station", "", ""),
            ("x", "m", "r nw"),
            ("y", "m", "r nw"),
            ("Used", "fixes", "r"),
            ("Rejected", "fixes", "r"),
            ("Residual, mean", "cm", "r"),
            ("Residual, rms", "cm", "r"),
        ];
        columns.extend(has_clocks.then_some(("Clock offset, 95 %", "cm of sound", "r")));
        let mut table = Table::new(format!("Stations and their use in the run{of}"), &columns);
        let residual = |m: Option<f64>| m.map_or_else(|| "\u{2013}".to_owned(), cm);
        for station in &run.stations {
            let mut cells = vec![
                station.name.clone().into(),
                number(station.at.x, 2).into(),
                number(station.at.y, 2).into(),
                station.used.to_string().into(),
                station.rejected.to_string().into(),
                residual(station.residual_mean_m).into(),
                residual(station.residual_rms_m).into(),
            ];
            if has_clocks {
                let clock = station.clock_offset_m;
                let words = clock.map(|clock| format!("{} ± {}", cm(clock.value), cm(2.0 * clock.sigma)));
                cells.push(words.unwrap_or_else(|| "\u{2013}".to_owned()).into());
            }
            table.row(cells);
        }
        blocks.push(Block::Table(table));
    }
    blocks
}

/// Survey and pulse test of the stations: as stated, and as measured by pulses during the runs.
fn station_check(document: &Document) -> Value {
    let stated = document.inspection.station_check.as_ref();
    let measured: Vec<&str> = pulse_tests(document).map(|test| test.found.as_str()).collect();
    if measured.is_empty() {
        return Value::fact(stated, "station_check");
    }
    stated.map(String::as_str).into_iter().chain(measured).collect::<Vec<_>>().join(". ").into()
}

/// The speed of sound: as stated, and as the runs found it from their ranges.
fn sound_speed(document: &Document) -> Value {
    let stated = document.inspection.sound_speed.as_ref();
    let by_pulses = is_pulse_tested(document)
        .then(|| "Measured by the pulse tests above; the ranges are corrected accordingly.".to_owned());
    let measured = by_pulses.into_iter().chain(calibrations(document)).collect::<Vec<_>>().join(" ");
    match stated {
        _ if measured.is_empty() => Value::fact(stated, "sound_speed"),
        Some(stated) => format!("{stated}. {measured}").into(),
        None => Value { text: Some(measured), ..Value::fact(None, "sound_speed") },
    }
}

/// The limitations of the report.
pub(in crate::document) fn limitations(document: &Document) -> Vec<Block> {
    let floor = &document.floor;
    let mut items = Vec::new();
    if document.is_simulation {
        items.push(
            "This report describes a simulation. It shows the form of the record, not the state of any floor."
                .to_owned(),
        );
    }
    let of_scans = [
        "\u{201c}Scanned\u{201d} means that the tool passed over the place while the position was known. It \
         does not mean that a defect would have been detected; that depends on the instrument, its \
         calibration and the surface."
            .to_owned(),
        format!(
            "All figures depend on the cell size of {} cm and the swath of {} m. Areas are sums of cells.",
            number(100.0 * floor.cell_m, 1),
            floor.swath_m
        ),
        rule(document).limitation(is_sound_known(document)),
        "The critical zone is evaluated every 25 mm along the shell as drawn, in 15 layers of 5 mm."
            .to_owned(),
    ];
    items.extend(survey_warnings(document));
    items.extend(of_scans.into_iter().filter(|_| document.is_to_scan));
    items.extend([
        "Found obstacles are shown where the robot estimated them to be; obstacles that it did not sense \
         are missing from this report."
            .to_owned(),
        "Nothing here replaces the inspector's own assessment of completeness under the applicable code."
            .to_owned(),
    ]);
    let code = Value::fact(document.inspection.code.as_ref(), "code");
    vec![Block::List(items), Block::Facts(vec![("Code and edition", code)])]
}

/// The thirteen items.
pub(in crate::document) fn gate(document: &Document) -> Vec<Block> {
    let mut table = Table::new(
        "The gate: the report can be signed once every item is answered",
        &[("", "", "r"), ("State", "", "nw"), ("Item", "", ""), ("Answer", "", "")],
    );
    for item in &document.gate {
        let state = if item.is_answered { "\u{2713} answered" } else { "\u{25a1} open" };
        let answer = Value {
            text: Some(item.answer.clone()).filter(|answer| !answer.is_empty()),
            missing: Some(item.missing.join(", ")).filter(|missing| !missing.is_empty()),
        };
        let row = table.row(vec![item.number.to_string().into(), state.into(), item.what.into(), answer]);
        row.cells[1].class = if item.is_answered { "mk ok" } else { "mk open" };
    }
    vec![Block::Table(table)]
}

/// Signature blocks, and earlier signatures.
pub(in crate::document) fn signatures(document: &Document) -> Vec<Block> {
    let facts = &document.inspection;
    let open: Vec<String> = document.open_items().map(|item| item.number.to_string()).collect();
    let mut blocks = Vec::new();
    if !open.is_empty() {
        blocks.push(Block::Barred(format!(
            "{} of {} items {} open ({}). A signed report is a separate revision and is never changed.",
            open.len(),
            document.gate.len(),
            if open.len() == 1 { "is" } else { "are" },
            open.join(", ")
        )));
    }
    let signed = document.signature.as_ref().map(|s| format!("signed {} UTC", s.at)).unwrap_or_default();
    let none = || Value::default();
    let block =
        |who, what, name, certificate, signed| SignatureBlock { who, what, name, certificate, signed };
    blocks.push(Block::Signatures(vec![
        block(
            "Operator",
            "operated the robot",
            Value::fact(facts.operator.as_ref(), "operator"),
            none(),
            String::new(),
        ),
        block(
            "Inspector",
            "is responsible for completeness",
            match &document.signature {
                Some(signature) => signature.by.clone().into(),
                None => Value::fact(facts.inspector.as_ref(), "inspector"),
            },
            Value::fact(facts.inspector_certificate.as_ref(), "inspector_certificate"),
            signed,
        ),
        block(
            "Owner",
            "accepts the inspection record",
            Value::fact(facts.approver.as_ref(), "approver"),
            none(),
            String::new(),
        ),
    ]));
    let remarks = Value::fact(facts.remarks.as_ref(), "remarks");
    blocks.push(Block::Facts(vec![("Remarks of the inspector", remarks)]));
    let mut table = Table::new(
        "Revisions",
        &[
            ("Rev.", "", ""),
            ("Date", "UTC", "nw"),
            ("What", "", ""),
            ("SHA-256 of the signed file", "", "hash"),
        ],
    );
    for revision in &document.revisions {
        let what = format!(
            "document {}, signed by {}, file {}",
            revision.number, revision.signature.by, revision.file
        );
        table.row(vec![
            revision.revision.clone().into(),
            revision.signature.at.clone().into(),
            what.into(),
            grouped(&revision.sha256).into(),
        ]);
    }
    let (at, what, hash) = match &document.signature {
        Some(signature) => {
            (signature.at.as_str(), format!("signed by {}", signature.by), "in the run's list of signatures")
        }
        None => ("", "draft, not signed".to_owned(), ""),
    };
    table.row(vec![document.revision.clone().into(), at.into(), what.into(), hash.into()]);
    blocks.push(Block::Table(table));
    blocks
}

/// The provenance of the figures.
pub(in crate::document) fn provenance(document: &Document) -> Vec<Block> {
    let mut blocks = Vec::new();
    for run in &document.runs {
        let files = &run.files;
        let bytes =
            |bytes: Option<u64>| bytes.map(|n| format!("{:.1} MB", n as f64 / 1e6)).unwrap_or_default();
        let state = match files.are_as_reported {
            Some(true) if files.recovered.is_some() => {
                "both match the digests recorded when the run was recovered".to_owned()
            }
            Some(true) => "both match the digests written at the end of the run".to_owned(),
            Some(false) => format!("DIFFERENT: {}", files.doubts.join("; ")),
            None => "no digests were written at the end of the run".to_owned(),
        };
        if let Some(readings) = located_as(document, &run.run) {
            blocks.extend(of_readings(
                run,
                readings,
                format!("{}, {}; {state}", bytes(files.journal_bytes), bytes(files.recording_bytes)),
            ));
            continue;
        }
        let mut facts = vec![
            ("Run", run.run.clone().into()),
            (
                "Program",
                format!("tankops {}, journal version {}", run.tankops_version, run.journal_version).into(),
            ),
            ("Scenario and seed", format!("{}, seed {}", run.scenario, run.seed).into()),
        ];
        // A survey has no planner.
        if !run.drivers.is_empty() {
            let drivers: Vec<String> = run.drivers.iter().map(|driver| driver.name.clone()).collect();
            facts.push(("Parameters", run.parameters.join(", ").into()));
            facts.push(("Planner", drivers.join("; ").into()));
        }
        facts.extend([
            (
                "Journal, recording",
                format!("{}, {}; {state}", bytes(files.journal_bytes), bytes(files.recording_bytes)).into(),
            ),
            (
                "To repeat",
                format!("tankops verify {} recomputes the run and compares every event", run.run).into(),
            ),
        ]);
        facts.extend(files.recovered.as_ref().map(|how| ("Recovered", how.to_string().into())));
        blocks.push(Block::Facts(facts));
        let hashes = [
            ("Journal SHA-256", &files.journal_sha256),
            ("Recording SHA-256", &files.recording_sha256),
            ("Scenario SHA-256", &files.scenario_sha256),
        ];
        let stated =
            hashes.into_iter().filter_map(|(label, hash)| Some((label.to_owned(), grouped(hash.as_ref()?))));
        let planners =
            run.drivers.iter().map(|driver| ("Planner SHA-256".to_owned(), grouped(&driver.sha256)));
        blocks.push(Block::Hashes(stated.chain(planners).collect()));
    }
    blocks.extend(packed::blocks(&document.packed));
    blocks
}

/// The readings from which a run was located.
fn located_as<'a>(document: &'a Document, run: &str) -> Option<&'a Readings> {
    document.located.as_ref()?.readings.iter().find(|readings| readings.run == run)
}

/// The provenance of the figures of located readings.
fn of_readings(run: &RunPart, readings: &Readings, journal: String) -> [Block; 2] {
    let facts = Block::Facts(vec![
        ("Run", run.run.clone().into()),
        ("Readings", readings.file.clone().into()),
        (
            "Program",
            format!("tankops {}, journal version {}", run.tankops_version, run.journal_version).into(),
        ),
        ("Scenario", run.scenario.clone().into()),
        ("Journal, recording", journal.into()),
        ("To repeat", "tankops locate, with the same readings and scenario".into()),
    ]);
    let files = &run.files;
    let hashes = [
        ("Readings SHA-256", Some(&readings.sha256)),
        ("Journal SHA-256", files.journal_sha256.as_ref()),
        ("Recording SHA-256", files.recording_sha256.as_ref()),
        ("Scenario SHA-256", files.scenario_sha256.as_ref()),
    ];
    let stated = hashes.into_iter().filter_map(|(label, hash)| Some((label.to_owned(), grouped(hash?))));
    [facts, Block::Hashes(stated.collect())]
}

/// A digest in groups of eight characters.
pub(in crate::document) fn grouped(hash: &str) -> String {
    let chars: Vec<char> = hash.chars().collect();
    chars.chunks(8).map(|group| group.iter().collect::<String>()).collect::<Vec<_>>().join(" ")
}
