//! The thickness of the floor according to the readings of the instrument.

use super::{
    indications::Indication,
    layers::Layers,
    maps::{Figure, filled, legend},
};
use crate::{
    drawing::sheet::{Sheet, colour},
    past_run::{ImportedReadings, PastRun},
};
use account::{Detections, Finding, Judge, LOSS_CLASSES, PlateThickness};
use mission::{InstrumentKind, Sampling};
use serde::Serialize;

/// The class of a cell without readings.
const NO_CLASS: u8 = u8::MAX;

/// What the readings of the instrument show.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Thickness {
    /// The method of the instrument.
    pub kind: InstrumentKind,
    /// How the instrument reads.
    pub sampling: Sampling,
    /// Number of readings.
    pub readings: u64,
    /// Number of readings beside welds, which are not judged.
    pub untestable: u64,
    /// The tested floor, square metres.
    pub tested_m2: f64,
    /// The thickness of each plate with readings.
    pub plates: Vec<PlateThickness>,
    /// The losses of metal, in order of run and time.
    pub losses: Vec<Finding>,
    /// Scanned floor that the instrument can test but gave no reading of, square metres.
    pub unread_m2: f64,
    /// How the losses compare with the true ones; absent if these are not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub detections: Option<Detections>,
    /// The files from which readings were imported; empty for simulated readings.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub imported: Vec<ImportedReadings>,
}

/// The thickness over all runs, and the readings by cell; `None` if a run has no readings.
pub(super) fn thickness(past: &[PastRun], layers: &Layers<'_>) -> Option<(Thickness, Judge)> {
    let read: Vec<_> = past.iter().map(PastRun::readings).collect::<Option<_>>()?;
    let counts: Vec<_> = past.iter().filter_map(|past| past.summary.readings.as_ref()).collect();
    let ((first, sampling), floor) = (*read.first()?, layers.floor());
    let mut judge = first.clone();
    for (run, (other, _)) in read.iter().enumerate().skip(1) {
        judge.join(other, run);
    }
    let losses = judge.findings(floor);
    let is_tested = |at| floor.cell_at(at).is_some_and(|cell| judge.count(cell) > 0);
    let cells_m2 = |is_in: &dyn Fn(usize) -> bool| {
        (0..floor.len()).filter(|cell| is_in(*cell)).count() as f64 * floor.cell_m2()
    };
    let survey = past.first().and_then(|past| past.fold.survey());
    let thickness = Thickness {
        kind: layers.run.mission.instrument.as_ref()?.kind,
        sampling,
        readings: counts.iter().map(|counts| counts.count).sum(),
        untestable: counts.iter().map(|counts| counts.untestable).sum(),
        tested_m2: cells_m2(&|cell| judge.count(cell) > 0),
        unread_m2: cells_m2(&|cell| layers.is_unread(cell, &judge)),
        plates: layers.plate_map().map_or_else(Vec::new, |map| judge.plates(map, floor.len())),
        detections: survey.map(|survey| survey.detections(&losses, is_tested)),
        imported: past.iter().filter_map(|past| Some(past.imported.as_ref()?.0.clone())).collect(),
        losses,
    };
    Some((thickness, judge))
}

/// The losses as indications, numbered from `first`.
pub(super) fn indications(
    thickness: &Thickness,
    past: &[PastRun],
    layers: &Layers<'_>,
    first: usize,
) -> Vec<Indication> {
    let nominal_mm = thickness.sampling.thickness_mm;
    let indication = |(number, loss): (usize, &Finding)| Indication {
        number,
        run: past.get(loss.run).map(|past| past.name.clone()),
        t_s: Some(loss.t_s),
        at: loss.at,
        error_m: Some(loss.error_m),
        plate: layers.plate_at(loss.at),
        kind: "metal loss".into(),
        size_mm: Some(tenth(1000.0 * (loss.high - loss.low).max())),
        depth_mm: Some(tenth(loss.depth_mm)),
        note: format!(
            "depth ±{:.1} mm; {:.1} of {nominal_mm} mm left; {} readings",
            loss.depth_error_mm,
            (nominal_mm - loss.depth_mm).max(0.0),
            loss.readings
        ),
    };
    (first..).zip(&thickness.losses).map(indication).collect()
}

/// Rounds millimetres to tenths: a reading is less accurate.
fn tenth(mm: f64) -> f64 {
    (10.0 * mm).round() / 10.0
}

/// Draws the loss of metal on the tested floor.
pub(super) fn map(layers: &Layers<'_>, judge: &Judge, thickness: &Thickness) -> Figure {
    let (floor, fixtures) = (layers.floor(), layers.fixtures());
    let nominal_mm = thickness.sampling.thickness_mm;
    let classes: Vec<u8> = (0..floor.len()).map(|cell| judge.loss_class(cell).unwrap_or(NO_CLASS)).collect();
    let mut sheet = Sheet::new(fixtures.boundary, "m", super::maps::FULL_MM, 8.0);
    sheet.define_patterns(floor.cell_m);
    sheet.wall(fixtures.boundary, r##"fill="#fff""##);
    for (class, colour) in (0_u8..).zip(colour::LOSS) {
        let is_in = |cell: usize| classes[cell] != NO_CLASS && classes[cell] >= class;
        sheet.cells(floor, is_in, 0.0, &format!(r#"fill="{colour}""#));
    }
    sheet.plates(layers.plates.as_ref());
    sheet.obstacles(&fixtures);
    sheet.frame(&fixtures, 2.4);
    let mut counts = [0_usize; LOSS_CLASSES.len() + 1];
    for class in classes.iter().filter(|class| **class != NO_CLASS) {
        counts[usize::from(*class)] += 1;
    }
    let tested = counts.iter().sum::<usize>().max(1) as f64;
    let shares = world::coverage::percents(counts.map(|count| count as f64 / tested));
    let mm = |share: f64| format!("{:.1}", share * nominal_mm);
    let text = |class: usize| match class {
        0 => format!("up to {} mm lost", mm(LOSS_CLASSES[0])),
        4 => format!("more than {} mm lost", mm(LOSS_CLASSES[3])),
        _ => format!("{} to {} mm lost", mm(LOSS_CLASSES[class - 1]), mm(LOSS_CLASSES[class])),
    };
    let entry = |(class, colour): (usize, &str)| {
        legend(filled(colour), &text(class), format!("{:.1} %", shares[class]))
    };
    Figure {
        caption: format!(
            "Loss of metal, from the mean of the readings in each cell of {:.0} mm and the nominal thickness of \
             {nominal_mm} mm. Percentages are of the tested floor; white floor was not tested.",
            1000.0 * floor.cell_m
        ),
        svg: sheet.svg("Corrosion map", "full"),
        legend: colour::LOSS.into_iter().enumerate().map(entry).collect(),
    }
}
