//! The account of the run, as in every report: properties of the recording, tables, and missed areas on the map.

use super::{
    lane::flat,
    paths,
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};
use account::{Area, MissReason, Shares, Summary};
use mission::event::RunOpened;
use std::sync::Arc;
use world::shape::rectangle;

type Done = Result<(), RecordingError>;

/// Name of the property with the figures of the run.
pub(crate) const FIGURES: &str = "figures";
/// During the mission, at least a minute passes between two accounts. On a large floor the interval is longer: one tick
/// for each [`CELLS_PER_TICK`] cells of the floor.
const CELLS_PER_TICK: usize = 50;
const LEAST_PERIOD_S: f64 = 60.0;
/// Maximum number of missed areas with a label.
const LABELLED: usize = 12;

/// Time and interval of the last account.
pub(crate) struct Accounting {
    period_ticks: i64,
    written: i64,
}

impl Accounting {
    /// State before any event.
    pub(crate) fn open(run: &RunOpened, at: At) -> Self {
        let least = (LEAST_PERIOD_S / run.mission.tick_s).round() as i64;
        let period_ticks = least.max((run.floor.len() / CELLS_PER_TICK) as i64);
        Self { period_ticks, written: at.tick }
    }

    /// Whether the next account is due. Regular accounts ensure that a run that is killed has a recent one, too.
    pub(crate) fn is_due(&self, at: At) -> bool {
        at.tick - self.written >= self.period_ticks
    }

    /// Writes the account.
    pub(crate) fn write(&mut self, summary: &Summary, stream: &Stream, at: At) -> Done {
        self.written = at.tick;
        stream.property(FIGURES, &properties(summary))?;
        let Some(floor) = &summary.floor else { return Ok(()) };
        draw(stream, at, &missed(&floor.missed, summary.outcome.is_some()))
    }
}

/// Missed areas. During the mission, areas that the plan has yet to reach are left out.
pub(crate) fn missed(areas: &[Area<MissReason>], is_over: bool) -> Vec<&Area<MissReason>> {
    areas.iter().filter(|area| is_over || area.reason != MissReason::NotReached).collect()
}

fn draw(stream: &Stream, at: At, areas: &[&Area<MissReason>]) -> Done {
    let (labelled, more) = areas.split_at(areas.len().min(LABELLED));
    for (path, areas, first) in [(paths::MISSED, labelled, 1), (paths::MISSED_MORE, more, LABELLED + 1)] {
        let label = |(area, number): (&&Area<MissReason>, usize)| format!("{number}: {:.2} m²", area.area_m2);
        // No boxes: the viewer would place their labels as if the map were not flipped.
        let outline = |area: &&Area<MissReason>| {
            let corners = rectangle(area.low, area.high);
            rr::LineStrip2D::from_iter(corners.iter().chain(corners.first()).map(|corner| flat(*corner)))
        };
        let boxes = rr::LineStrips2D::update_fields()
            .with_strips(areas.iter().map(outline))
            .with_colors([style::color(style::MISSED_EDGE)])
            .with_radii([style::on_screen(1.0)])
            .with_labels(areas.iter().zip(first..).map(label))
            .with_show_labels(path == paths::MISSED);
        stream.once(path, at, &boxes)?;
    }
    Ok(())
}

/// The figures of a run as numbers; unknown ones are absent.
fn properties(summary: &Summary) -> rr::AnyValues {
    let values = numbers(summary).into_iter().fold(rr::AnyValues::default(), |values, (name, number)| {
        values.with_component_from_data(name, Arc::new(rr::Float64Array::from(vec![number])) as rr::ArrayRef)
    });
    counts(summary).into_iter().fold(values, |values, (name, count)| {
        values.with_component_from_data(name, Arc::new(rr::UInt64Array::from(vec![count])) as rr::ArrayRef)
    })
}

fn counts(summary: &Summary) -> Vec<(&'static str, u64)> {
    let counts = [
        ("collisions", summary.collisions),
        ("holds", Some(summary.holds)),
        ("planner_faults", Some(summary.planner_faults)),
        ("obstacles_found", Some(summary.obstacles_found)),
        ("missed_areas", summary.floor.as_ref().map(|floor| floor.missed.len() as u64)),
    ];
    counts.into_iter().filter_map(|(name, count)| Some((name, count?))).collect()
}

fn numbers(summary: &Summary) -> Vec<(&'static str, f64)> {
    let coverage = summary.coverage.as_ref().filter(|_| summary.floor.is_some());
    let by_truth = coverage.and_then(|coverage| coverage.by_truth);
    let floor = summary.floor.as_ref();
    let whole = floor.map(|floor| floor.whole);
    let reachable = floor.map(|floor| floor.reachable);
    let deepest = summary.readings.as_ref().and_then(|readings| readings.deepest.as_ref());
    let percent = |of: Option<Shares>| of.map(|shares| shares.percent);
    let numbers = [
        ("duration_s", summary.mission_time_s),
        ("path_length_m", summary.path_length_m),
        ("clearance_min_m", summary.clearance_min_m),
        ("whole_m2", whole.map(|shares| shares.area_m2)),
        ("whole_scanned_percent", coverage.map(|coverage| 100.0 * coverage.whole)),
        ("whole_guaranteed_percent", percent(whole).and_then(|p| p.guaranteed)),
        ("whole_missed_percent", percent(whole).map(|p| p.missed)),
        ("whole_unreachable_percent", percent(whole).map(|p| p.unreachable)),
        ("whole_margin_percent", percent(whole).map(|p| p.margin)),
        ("whole_untestable_percent", percent(whole).map(|p| p.untestable).filter(|percent| *percent > 0.0)),
        ("whole_scanned_true_percent", by_truth.map(|truth| 100.0 * truth.whole)),
        ("reachable_m2", reachable.map(|shares| shares.area_m2)),
        ("reachable_scanned_percent", coverage.map(|coverage| 100.0 * coverage.reachable)),
        ("reachable_guaranteed_percent", percent(reachable).and_then(|p| p.guaranteed)),
        ("reachable_missed_percent", percent(reachable).map(|p| p.missed)),
        ("reachable_scanned_true_percent", by_truth.map(|truth| 100.0 * truth.reachable)),
        ("missed_m2", coverage.and_then(|coverage| coverage.missed_area_m2)),
        ("error_95_p95_m", summary.accuracy.map(|accuracy| accuracy.p95_m)),
        ("error_p95_m", summary.positioning.map(|positioning| positioning.p95_m)),
        ("position_lost_s", summary.positioning.map(|positioning| positioning.position_lost_s)),
        ("readings", summary.readings.as_ref().map(|readings| readings.count as f64)),
        ("indications", summary.readings.as_ref().map(|readings| readings.indications as f64)),
        ("indication_depth_max_mm", deepest.map(|loss| loss.depth_mm)),
        ("tether_length_max_m", summary.tether.map(|tether| tether.tether_length_max_m)),
    ];
    numbers.into_iter().filter_map(|(name, number)| Some((name, number?))).collect()
}
