//! The table of everything that is recorded in every tick: each series with its entity path and its value in a tick.

use super::{
    lane::{Ellipse, Lane, Placed, Spots, Strip, flat},
    paths,
    series::{Series, Way, changes, rows},
    stream::{At, Stream},
    style,
    tick::Tick,
};
use crate::{error::RecordingError, rr};
use account::FigureId;
use mission::event::RunOpened;
use std::collections::BTreeMap;

type Done = Result<(), RecordingError>;

/// A figure of the account's table: its entity path, its id, its colour in the plots, and its value in a tick. The
/// table provides the name.
type Figure = (&'static str, FigureId, [u8; 4], fn(&Tick) -> Option<f64>);

const FIGURES: [Figure; 7] = [
    (paths::ERROR, FigureId::TrueError, style::ESTIMATE, Tick::error_m),
    (paths::ERROR_95, FigureId::PositionError, style::FIGURE, |tick| Some(tick.estimate?.ellipse_95.0)),
    (paths::COVERED, FigureId::Covered, style::PLAN, |tick| Some(100.0 * tick.covered?)),
    (paths::SPEED, FigureId::TrueSpeed, style::TRUE, Tick::speed_m_per_s),
    (paths::SPEED_SENT, FigureId::SpeedSent, style::FIGURE, Tick::speed_sent_m_per_s),
    (paths::CLEARANCE, FigureId::TrueClearance, style::WARNING, |tick| Some(tick.truth?.clearance_m)),
    (paths::CROSS_TRACK, FigureId::CrossTrack, style::ESTIMATE, |tick| tick.cross_track_m),
];

const TETHER_FIGURES: [Figure; 5] = [
    (paths::TETHER_OUT, FigureId::TetherOut, style::ESTIMATE, |tick| Some(tick.tether.as_ref()?.length_m)),
    (paths::TETHER_OUT_TRUE, FigureId::TrueTetherOut, style::TRUE, |tick| tick.true_tether_m),
    // A gap in the curve means that the hull does not fit through the return path.
    (paths::TETHER_HOME, FigureId::ReturnPath, style::FIGURE, |tick| tick.tether.as_ref()?.return_length_m),
    (paths::TETHER_WRAP, FigureId::WrapLargest, style::WARNING, |tick| {
        Some(tick.tether.as_ref()?.wrap_max_deg)
    }),
    (paths::TETHER_SUM, FigureId::WrapTotal, style::FIGURE, |tick| {
        Some(tick.tether.as_ref()?.wrap_total_deg)
    }),
];

/// The figures of a run whose scenario describes the reel.
const PULL_FIGURES: [Figure; 3] = [
    (paths::TETHER_PULL, FigureId::Pull, style::WARNING, |tick| tick.tether.as_ref()?.pull_n),
    (paths::TETHER_PULL_MEASURED, FigureId::PullMeasured, style::ESTIMATE, |tick| {
        Some(tick.tether.as_ref()?.measured?.pull_n)
    }),
    (paths::TETHER_SLACK, FigureId::Slack, style::WARNING, |tick| {
        Some(tick.tether.as_ref()?.measured?.slack_m)
    }),
];

/// A gap in the curve means that the position is not protected.
const PROTECTION_FIGURES: [Figure; 1] =
    [(paths::PROTECTION, FigureId::Protection, style::WARNING, |tick| tick.protection_m)];

/// The moving entities of the map.
fn moving(run: &RunOpened) -> Vec<Box<dyn Series>> {
    let spacing_m = run.mission.cell_m;
    vec![
        rows(paths::TRUE, |tick| {
            let pose = tick.truth?.pose;
            Some(Placed { at: flat(pose.position), angle_rad: pose.heading_rad as f32 })
        }),
        rows(paths::ESTIMATE, |tick| {
            let (long_m, short_m, angle_rad) = tick.estimate?.ellipse_95;
            let placed = Placed { at: flat(tick.estimate?.position), angle_rad: angle_rad as f32 };
            Some(Ellipse { placed, half_axes_m: (long_m as f32, short_m as f32) })
        }),
        changes(paths::TARGET, |tick| tick.target.map(flat)),
        Box::new(Way::new(paths::WAY_TRUE, spacing_m, |tick| Some(tick.truth?.pose.position))),
        Box::new(Way::new(paths::WAY_ESTIMATE, spacing_m, |tick| Some(tick.estimate?.position))),
    ]
}

/// The tether on the map.
fn tether() -> Vec<Box<dyn Series>> {
    vec![
        rows(paths::TETHER, |tick| Some(Strip(tick.tether.as_ref()?.line.clone()))),
        rows(paths::TETHER_CABLE, |tick| tick.cable.clone().map(Strip)),
        changes(paths::TETHER_CONTACTS, |tick| Some(Spots(tick.tether.as_ref()?.contacts.clone()))),
    ]
}

/// The rows of a run that are waiting to be sent.
pub(crate) struct Table {
    series: Vec<Box<dyn Series>>,
    /// Figures reported by planners, by name.
    reported: BTreeMap<String, Lane<f64>>,
}

impl Table {
    /// Creates the series of a run, and the plot styles of their figures.
    pub(crate) fn open(stream: &Stream, run: &RunOpened) -> Result<Self, RecordingError> {
        let mut series = moving(run);
        let mut figures = FIGURES.to_vec();
        if run.mission.locating.risk.is_some() {
            figures.extend(PROTECTION_FIGURES);
        }
        if let Some(config) = &run.mission.tether {
            series.extend(tether());
            figures.extend(TETHER_FIGURES);
            figures.extend(config.reel.into_iter().flat_map(|_| PULL_FIGURES));
        }
        for (path, id, color, value) in figures {
            stream.always(path, &curve(id.name(), color))?;
            series.push(changes(path, value));
        }
        Ok(Self { series, reported: BTreeMap::new() })
    }

    /// Adds a completed tick.
    pub(crate) fn push(&mut self, stream: &Stream, tick: &Tick) -> Done {
        self.series.iter_mut().for_each(|series| series.push(tick));
        tick.scalars
            .iter()
            .try_for_each(|(name, value, unit)| self.push_reported(stream, tick.at, name, *value, unit))
    }

    /// Closes everything that is open at the end of the run.
    pub(crate) fn finish(&mut self) {
        self.series.iter_mut().for_each(|series| series.finish());
    }

    /// Sends the waiting rows.
    pub(crate) fn send(&mut self, stream: &Stream) -> Done {
        self.series.iter_mut().try_for_each(|series| series.send(stream))?;
        self.reported.values_mut().try_for_each(|lane| lane.send(stream))
    }

    fn push_reported(&mut self, stream: &Stream, at: At, name: &str, value: f64, unit: &str) -> Done {
        if !self.reported.contains_key(name) {
            let lane = Lane::new(format!("{}/{}", paths::PLANNER_SCALARS, entity_name(name)));
            let color = style::SERIES[self.reported.len() % style::SERIES.len()];
            let label = if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") };
            stream.always(lane.path(), &curve(&label, color))?;
            self.reported.insert(name.to_owned(), lane);
        }
        self.reported.get_mut(name).expect("a lane was created above").push(at, value);
        Ok(())
    }
}

/// The plot style of a figure.
pub(crate) fn curve(name: &str, color: [u8; 4]) -> rr::SeriesLines {
    rr::SeriesLines::new().with_names([name]).with_colors([style::color(color)]).with_widths([1.5])
}

/// Turns a name into one part of an entity path.
pub(crate) fn entity_name(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || matches!(c, '_' | '-' | '.') { c } else { '_' };
    name.chars().map(plain).collect()
}
