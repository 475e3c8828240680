//! Joins the positions and the attitudes of the rover, which are messages of their own, to poses.

use tankops_adapter::{clock::is_newer, message::Pose, trail::Trail};

/// The newest positions and attitudes. Messages arrive late, in any order, and some never arrive.
#[derive(Debug, Clone, Default)]
pub(super) struct Joined {
    /// Positions; the heading is not used.
    positions: Trail,
    /// Headings; the position is not used.
    headings: Trail,
    /// Stamp of the last pose, seconds of the rover's clock.
    last_s: Option<f64>,
}

impl Joined {
    /// Adds the position at a time in seconds of the rover's clock.
    pub(super) fn position(&mut self, position: Pose, stamp_s: f64) {
        self.positions.add(position, stamp_s);
    }

    /// Adds the heading at a time in seconds of the rover's clock.
    pub(super) fn heading(&mut self, heading_rad: f64, stamp_s: f64) {
        self.headings.add(Pose { x_m: 0.0, y_m: 0.0, heading_rad }, stamp_s);
    }

    /// The pose at the latest time for which position and heading are both known, measured or between two measured ones,
    /// unless it was taken before.
    pub(super) fn take(&mut self) -> Option<(Pose, f64)> {
        let newest_s = self.positions.newest_s()?.min(self.headings.newest_s()?);
        if !is_newer(newest_s, self.last_s) {
            return None;
        }
        let position = self.positions.at(newest_s)?;
        let Pose { heading_rad, .. } = self.headings.at(newest_s)?;
        self.last_s = Some(newest_s);
        Some((Pose { heading_rad, ..position }, newest_s))
    }
}
