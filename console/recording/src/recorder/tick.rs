//! What happens every tick: poses, covariance, figures.

use super::{
    lane::{Ellipse, Flat, Lane, Number, Placed, Spot, Strip, flat},
    paths,
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};
use mission::{EventKind, event::RunOpened};
use planner_api::{Drawing, Drive, PoseEstimate};
use positioning::{Fix, Ranging, fix::ellipse_95};
use std::collections::BTreeMap;
use world::{Point, Pose, Station};

type Done = Result<(), RecordingError>;

/// Points of a piece of the way that is sent as one line.
const WAY_POINTS: usize = 32;

/// Everything that one tick has reported so far.
pub(crate) struct Tick {
    pub at: At,
    pub drawings: Vec<Drawing>,
    truth: Option<(Pose, f64)>,
    estimate: Option<PoseEstimate>,
    speed_sent: Option<f64>,
    covered: Option<f64>,
    cross_track_m: Option<f64>,
    ranges: Option<Vec<Ranging>>,
    fix: Option<Fix>,
    scalars: Vec<(String, f64, String)>,
}

impl Tick {
    pub(crate) fn new(at: At) -> Self {
        Self {
            at,
            drawings: Vec::new(),
            truth: None,
            estimate: None,
            speed_sent: None,
            covered: None,
            cross_track_m: None,
            ranges: None,
            fix: None,
            scalars: Vec::new(),
        }
    }

    pub(crate) fn apply(&mut self, event: &EventKind) {
        match event {
            EventKind::Truth { pose, clearance_m, .. } => self.truth = Some((*pose, *clearance_m)),
            EventKind::Estimated { pose } => self.estimate = Some(*pose),
            EventKind::Commanded { command, .. } => self.speed_sent = Some(speed(&command.drive)),
            EventKind::Drawn { drawings } => self.drawings.extend(drawings),
            EventKind::Ranged { ranges } => self.ranges = Some(ranges.clone()),
            EventKind::Fixed { fix } => self.fix = Some(fix.clone()),
            EventKind::Scalars { scalars } => self.scalars.extend_from_slice(scalars),
            EventKind::Progressed { covered_reachable, cross_track_m, .. } => {
                self.covered = Some(*covered_reachable);
                self.cross_track_m = *cross_track_m;
            }
            _ => {}
        }
    }
}

fn speed(drive: &Drive) -> f64 {
    match drive {
        Drive::Twist { v_m_per_s, .. } => v_m_per_s.abs(),
        Drive::Velocity(velocity) => velocity.norm(),
    }
}

/// Waiting rows of all ticks.
pub(crate) struct Ticks {
    truth: Lane<Spot>,
    body: Lane<Placed>,
    estimate: Lane<Spot>,
    covariance: Lane<Ellipse>,
    way_true: Way,
    way_estimate: Way,
    error: Lane<Number>,
    error_95: Lane<Number>,
    covered: Lane<Number>,
    speed: Lane<Number>,
    speed_sent: Lane<Number>,
    clearance: Lane<Number>,
    cross_track: Lane<Number>,
    planner: BTreeMap<String, Lane<Number>>,
    stations: Vec<Station>,
    believed: Point,
    before: Option<(At, Point)>,
}

impl Ticks {
    pub(crate) fn open(stream: &Stream, run: &RunOpened) -> Result<Self, RecordingError> {
        let series = [
            (paths::ERROR, "error", style::ESTIMATE),
            (paths::ERROR_95, "95 % bound", style::FIGURE),
            (paths::COVERED, "reachable floor", style::PLAN),
            (paths::SPEED, "speed", style::TRUE),
            (paths::SPEED_SENT, "speed sent", style::FIGURE),
            (paths::CLEARANCE, "clearance", style::WARNING),
            (paths::CROSS_TRACK, "cross-track", style::ESTIMATE),
        ];
        for (path, name, color) in series {
            stream.always(path, &line(name, color))?;
        }
        Ok(Self {
            truth: Lane::new(paths::TRUE),
            body: Lane::new(paths::BODY),
            estimate: Lane::new(paths::ESTIMATE),
            covariance: Lane::new(paths::COVARIANCE),
            way_true: Way::new(paths::WAY_TRUE, run.mission.cell_m),
            way_estimate: Way::new(paths::WAY_ESTIMATE, run.mission.cell_m),
            error: Lane::new(paths::ERROR),
            error_95: Lane::new(paths::ERROR_95),
            covered: Lane::new(paths::COVERED),
            speed: Lane::new(paths::SPEED),
            speed_sent: Lane::new(paths::SPEED_SENT),
            clearance: Lane::new(paths::CLEARANCE),
            cross_track: Lane::new(paths::CROSS_TRACK),
            planner: BTreeMap::new(),
            stations: run.world.stations.clone(),
            believed: run.mission.start.position,
            before: None,
        })
    }

    /// Takes in a tick that is over.
    pub(crate) fn push(&mut self, stream: &Stream, tick: &Tick) -> Done {
        let at = tick.at;
        if let Some((pose, clearance_m)) = tick.truth {
            self.push_truth(at, pose, clearance_m);
        }
        if let Some(pose) = tick.estimate {
            self.push_estimate(at, &pose);
        }
        if let (Some((truth, _)), Some(estimate)) = (tick.truth, tick.estimate) {
            self.error.push(at, Number((estimate.position - truth.position).norm()));
        }
        push_some(&mut self.speed_sent, at, tick.speed_sent);
        push_some(&mut self.covered, at, tick.covered.map(|share| 100.0 * share));
        push_some(&mut self.cross_track, at, tick.cross_track_m);
        for (name, value, unit) in &tick.scalars {
            self.push_scalar(stream, at, name, *value, unit)?;
        }
        self.draw_ranging(stream, tick)
    }

    /// Closes the last pieces of the way.
    pub(crate) fn finish(&mut self) {
        self.way_true.close();
        self.way_estimate.close();
    }

    /// Sends the waiting rows.
    pub(crate) fn send(&mut self, stream: &Stream) -> Done {
        self.truth.send(stream)?;
        self.body.send(stream)?;
        self.estimate.send(stream)?;
        self.covariance.send(stream)?;
        self.way_true.lane.send(stream)?;
        self.way_estimate.lane.send(stream)?;
        let figures = [
            &mut self.error,
            &mut self.error_95,
            &mut self.covered,
            &mut self.speed,
            &mut self.speed_sent,
            &mut self.clearance,
            &mut self.cross_track,
        ];
        figures.into_iter().chain(self.planner.values_mut()).try_for_each(|lane| lane.send(stream))
    }

    fn push_truth(&mut self, at: At, pose: Pose, clearance_m: f64) {
        let place = flat(pose.position);
        self.truth.push(at, Spot(place));
        self.body.push(at, Placed { at: place, angle_rad: pose.heading_rad as f32 });
        self.way_true.push(at, place);
        self.clearance.push(at, Number(clearance_m));
        if let Some((then, from)) = self.before.replace((at, pose.position))
            && at.sim_ns > then.sim_ns
        {
            let seconds = (at.sim_ns - then.sim_ns) as f64 * 1e-9;
            self.speed.push(at, Number((pose.position - from).norm() / seconds));
        }
    }

    fn push_estimate(&mut self, at: At, pose: &PoseEstimate) {
        let place = flat(pose.position);
        let (long_m, short_m, angle_rad) = ellipse_95(&pose.covariance.fixed_view::<2, 2>(0, 0).into_owned());
        self.believed = pose.position;
        self.estimate.push(at, Spot(place));
        self.way_estimate.push(at, place);
        let placed = Placed { at: place, angle_rad: angle_rad as f32 };
        self.covariance.push(at, Ellipse { placed, half_axes_m: (long_m as f32, short_m as f32) });
        self.error_95.push(at, Number(long_m));
    }

    fn push_scalar(&mut self, stream: &Stream, at: At, name: &str, value: f64, unit: &str) -> Done {
        if !self.planner.contains_key(name) {
            let lane = Lane::new(format!("{}/{}", paths::PLANNER_SCALARS, entity_name(name)));
            let color = style::SERIES[self.planner.len() % style::SERIES.len()];
            let label = if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") };
            stream.always(lane.path(), &line(&label, color))?;
            self.planner.insert(name.to_owned(), lane);
        }
        push_some(self.planner.get_mut(name).expect("a lane was made above"), at, Some(value));
        Ok(())
    }

    /// Ranges from their stations towards the believed position: the gap between tip and robot is the residual.
    fn draw_ranging(&self, stream: &Stream, tick: &Tick) -> Done {
        if let Some(ranges) = &tick.ranges {
            let excluded = |range: &Ranging| {
                tick.fix
                    .as_ref()
                    .is_some_and(|fix| fix.excluded.iter().any(|(station, _)| *station == range.station))
            };
            let drawn: Vec<_> =
                ranges.iter().filter_map(|range| Some((self.range_line(range)?, excluded(range)))).collect();
            let ink = |excluded| if excluded { style::RANGE_EXCLUDED } else { style::RANGE };
            let lines = rr::LineStrips2D::update_fields()
                .with_strips(drawn.iter().map(|(line, _)| rr::LineStrip2D::from_iter(*line)))
                .with_colors(drawn.iter().map(|(_, excluded)| style::color(ink(*excluded))));
            stream.once(paths::RANGES, tick.at, &lines)?;
        }
        match &tick.fix {
            Some(fix) => {
                let dot = rr::Points2D::update_fields().with_positions([flat(fix.position)]);
                stream.once(paths::FIX, tick.at, &dot)
            }
            None => Ok(()),
        }
    }

    fn range_line(&self, range: &Ranging) -> Option<[Flat; 2]> {
        let station = self.stations.iter().find(|station| station.id == range.station)?;
        let towards = (self.believed - station.position).try_normalize(1e-9)?;
        Some([flat(station.position), flat(station.position + towards * range.range_m)])
    }
}

/// A way that grows piece by piece, so that all of it can be drawn at every moment.
struct Way {
    lane: Lane<Strip>,
    spacing_m: f32,
    points: Vec<Flat>,
    last: Option<At>,
}

impl Way {
    fn new(path: &str, spacing_m: f64) -> Self {
        Self { lane: Lane::new(path), spacing_m: spacing_m as f32, points: Vec::new(), last: None }
    }

    fn push(&mut self, at: At, place: Flat) {
        let near = |last: &Flat| (place[0] - last[0]).hypot(place[1] - last[1]) < self.spacing_m;
        if self.points.last().is_some_and(near) {
            return;
        }
        self.points.push(place);
        self.last = Some(at);
        if self.points.len() >= WAY_POINTS {
            self.close();
        }
    }

    fn close(&mut self) {
        if let (Some(at), true) = (self.last, self.points.len() > 1) {
            // The next piece begins where this one ends.
            let next = self.points[self.points.len() - 1..].to_vec();
            self.lane.push(at, Strip(std::mem::replace(&mut self.points, next)));
        }
    }
}

fn push_some(lane: &mut Lane<Number>, at: At, value: Option<f64>) {
    if let Some(value) = value {
        lane.push(at, Number(value));
    }
}

fn line(name: &str, color: [u8; 4]) -> rr::SeriesLines {
    rr::SeriesLines::new().with_names([name]).with_colors([style::color(color)]).with_widths([1.5])
}

/// A planner's name for a figure as one part of an entity path.
fn entity_name(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || matches!(c, '_' | '-' | '.') { c } else { '_' };
    name.chars().map(plain).collect()
}
