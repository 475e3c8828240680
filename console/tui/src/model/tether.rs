//! The tether as the screen knows it.

use super::History;
use mission::{
    EventKind,
    event::{TetherContact, taut_line},
};
use serde::{Deserialize, Serialize};
use world::Point;

/// How the cable lies, and the last certificate of a plan.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Tether {
    /// Cable that is out, metres: what the reel has paid out, without an encoder what the map explains.
    pub length_m: f64,
    /// What is left on the reel, metres.
    pub free_m: f64,
    /// Where it bears.
    pub contacts: Vec<TetherContact>,
    /// Sum of all wraps, radians.
    pub wrap_total_rad: f64,
    /// How many times harder the wraps make it to pull.
    pub pull_factor: f64,
    /// Length of the way back along the cable, metres; `None` if there is none.
    pub return_length_m: Option<f64>,
    /// Whether the reel has paid out more than the map explains: how the cable lies is not known then.
    pub is_snagged: bool,
    /// The cable from the anchor to the robot.
    pub line: Vec<Point>,
    /// Whether the plan that is flown, or was refused last, is certified; `None` without such a plan.
    pub certified: Option<bool>,
    /// Mission time of what is known of how it lies, seconds; `None` before the first.
    pub t_s: Option<f64>,
    /// What was out, metres.
    pub length_history_m: History,
    /// The largest wrap, degrees.
    pub wrap_history_deg: History,
}

impl Tether {
    /// The largest wrap, by its size.
    pub fn largest(&self) -> Option<&TetherContact> {
        self.contacts.iter().max_by(|a, b| a.wrap_rad.abs().total_cmp(&b.wrap_rad.abs()))
    }

    /// Takes in how the cable lies now between its anchor and the robot.
    pub(crate) fn lie(&mut self, t_s: f64, event: &EventKind, ends: Option<(Point, Point)>) {
        if let EventKind::Tethered {
            length_m,
            paid_out_m,
            free_m,
            contacts,
            wrap_total_rad,
            pull_factor,
            return_length_m,
            bends,
            ..
        } = event
        {
            self.length_m = paid_out_m.unwrap_or(*length_m);
            (self.free_m, self.wrap_total_rad) = (*free_m, *wrap_total_rad);
            (self.pull_factor, self.return_length_m) = (*pull_factor, *return_length_m);
            self.contacts.clone_from(contacts);
            self.line = ends.map_or_else(Vec::new, |(anchor, robot)| taut_line(anchor, bends, robot));
            self.t_s = Some(t_s);
            self.length_history_m.add(t_s, self.length_m);
            let wrap_rad = self.largest().map_or(0.0, |contact| contact.wrap_rad.abs());
            self.wrap_history_deg.add(t_s, wrap_rad.to_degrees());
        }
    }
}
