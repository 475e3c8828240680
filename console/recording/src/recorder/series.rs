//! Rows that are added to an entity at each tick.

use super::{
    lane::{Flat, Lane, Row, Strip, flat},
    stream::{At, Stream},
    tick::Tick,
};
use crate::error::RecordingError;
use world::Point;

/// Number of points of a piece of path that is sent as one line.
const WAY_POINTS: usize = 12;

/// One entity, filled tick by tick.
pub(crate) trait Series: Send {
    /// Adds a completed tick.
    fn push(&mut self, tick: &Tick);

    /// Closes everything that is open at the end of the run.
    fn finish(&mut self) {}

    /// Sends the waiting rows.
    fn send(&mut self, stream: &Stream) -> Result<(), RecordingError>;
}

/// A row for each tick that has a value.
struct Rows<T> {
    lane: Lane<T>,
    of: fn(&Tick) -> Option<T>,
}

/// A series with a row for each tick that has a value.
pub(crate) fn rows<T: Row + Send + 'static>(path: &str, of: fn(&Tick) -> Option<T>) -> Box<dyn Series> {
    Box::new(Rows { lane: Lane::new(path), of })
}

impl<T: Row + Send> Series for Rows<T> {
    fn push(&mut self, tick: &Tick) {
        if let Some(row) = (self.of)(tick) {
            self.lane.push(tick.at, row);
        }
    }

    fn send(&mut self, stream: &Stream) -> Result<(), RecordingError> {
        self.lane.send(stream)
    }
}

/// A series that keeps only the first and the last of equal consecutive rows; this does not change the curve.
struct Changes<T> {
    lane: Lane<T>,
    of: fn(&Tick) -> Option<T>,
    last: Option<T>,
    /// Time at which the last row was last repeated.
    again: Option<At>,
}

/// A series that omits the ticks between equal values.
pub(crate) fn changes<T>(path: &str, of: fn(&Tick) -> Option<T>) -> Box<dyn Series>
where
    T: Row + Clone + PartialEq + Send + 'static,
{
    Box::new(Changes { lane: Lane::new(path), of, last: None, again: None })
}

impl<T: Row + Clone + PartialEq + Send> Series for Changes<T> {
    fn push(&mut self, tick: &Tick) {
        let row = (self.of)(tick);
        if row == self.last {
            self.again = row.map(|_| tick.at);
            return;
        }
        self.finish();
        self.last.clone_from(&row);
        if let Some(row) = row {
            self.lane.push(tick.at, row);
        }
    }

    fn finish(&mut self) {
        if let Some((at, row)) = self.again.take().zip(self.last.clone()) {
            self.lane.push(at, row);
        }
    }

    fn send(&mut self, stream: &Stream) -> Result<(), RecordingError> {
        self.lane.send(stream)
    }
}

/// A path that grows piece by piece, so that all of it can be drawn at every moment.
pub(crate) struct Way {
    lane: Lane<Strip>,
    of: fn(&Tick) -> Option<Point>,
    spacing_m: f32,
    points: Vec<Flat>,
    last: Option<At>,
}

impl Way {
    /// The path of a position, with points at this distance.
    pub(crate) fn new(path: &str, spacing_m: f64, of: fn(&Tick) -> Option<Point>) -> Self {
        Self { lane: Lane::new(path), of, spacing_m: spacing_m as f32, points: Vec::new(), last: None }
    }
}

impl Series for Way {
    fn push(&mut self, tick: &Tick) {
        let Some(place) = (self.of)(tick).map(flat) else { return };
        let near = |last: &Flat| (place[0] - last[0]).hypot(place[1] - last[1]) < self.spacing_m;
        if self.points.last().is_some_and(near) {
            return;
        }
        self.points.push(place);
        self.last = Some(tick.at);
        if self.points.len() >= WAY_POINTS {
            self.finish();
        }
    }

    fn finish(&mut self) {
        if let (Some(at), true) = (self.last, self.points.len() > 1) {
            // The next piece starts where this one ends.
            let next = self.points[self.points.len() - 1..].to_vec();
            self.lane.push(at, Strip(std::mem::replace(&mut self.points, next)));
        }
    }

    fn send(&mut self, stream: &Stream) -> Result<(), RecordingError> {
        self.lane.send(stream)
    }
}
