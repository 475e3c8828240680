//! The tether as shown on the screen.

use super::History;
use mission::{
    EventKind,
    event::{MeasuredPull, TetherContact, taut_line},
};
use serde::{Deserialize, Serialize};
use world::Point;

/// The geometry of the cable, and the last certificate of a plan.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Tether {
    /// The length of cable that is out, metres: as measured by the reel's encoder or, without an encoder, as computed
    /// from the map.
    pub length_m: f64,
    /// The length left on the reel, metres.
    pub free_m: f64,
    /// The contacts.
    pub contacts: Vec<TetherContact>,
    /// The total wrap, radians.
    pub wrap_total_rad: f64,
    /// The pull: the factor by which the wraps multiply the pulling force.
    pub pull_factor: f64,
    /// Pull at the reel that taking up the cable needs, newtons; `None` if the scenario does not describe the reel.
    #[serde(default)]
    pub pull_n: Option<f64>,
    /// The pull on the cable, as measured; `None` without a sensor.
    #[serde(default)]
    pub measured: Option<MeasuredPull>,
    /// The line of the true cable from the anchor to the robot, in a simulation whose cable can be slack; else empty.
    #[serde(default)]
    pub lies: Vec<Point>,
    /// Length of the return path along the cable, metres; `None` if there is none.
    pub return_length_m: Option<f64>,
    /// Whether more is paid out than the map explains; the geometry of the cable is then unknown.
    pub is_snagged: bool,
    /// Whether the cable is torn: it does not lead to the robot any more.
    #[serde(default)]
    pub is_broken: bool,
    /// The length off the reel when the mission noticed that the cable is torn, metres.
    #[serde(default)]
    pub broke_out_m: Option<f64>,
    /// The cable from the anchor to the robot.
    pub line: Vec<Point>,
    /// Whether the current plan, or the plan last refused, is certified; `None` without such a plan.
    pub certified: Option<bool>,
    /// The longest tether out that the certified current plan promises, metres; `None` without such a plan.
    #[serde(default)]
    pub promised_m: Option<f64>,
    /// The pull that this plan needs; `None` if it was not checked.
    #[serde(default)]
    pub promised_pull: Option<world::tether::Pull>,
    /// The warnings of this plan's certificate.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// Whether the mission has reported that most of the reel is out.
    #[serde(default)]
    pub is_near_end: bool,
    /// Mission time at which the geometry of the cable was last known, seconds; `None` if it has never been known.
    pub t_s: Option<f64>,
    /// The history of the length out, metres.
    pub length_history_m: History,
    /// The history of the largest wrap, degrees.
    pub wrap_history_deg: History,
    /// The history of the measured pull, newtons; empty without a sensor.
    #[serde(default)]
    pub pull_history_n: History,
}

impl Tether {
    /// The state of a cable that is torn or snagged, in capitals after a space; else empty.
    pub fn trouble(&self) -> &'static str {
        match self {
            Self { is_broken: true, .. } => " BROKEN",
            Self { is_snagged: true, .. } => " SNAGGED",
            _ => "",
        }
    }

    /// The contact with the largest wrap.
    pub fn largest(&self) -> Option<&TetherContact> {
        self.contacts.iter().max_by(|a, b| a.wrap_rad.abs().total_cmp(&b.wrap_rad.abs()))
    }

    /// The largest wrap, degrees; 0 without a contact.
    pub fn largest_deg(&self) -> f64 {
        self.largest().map_or(0.0, |contact| contact.wrap_rad.abs().to_degrees())
    }

    /// Records the geometry of the cable between the anchor and the robot.
    pub(crate) fn lie(&mut self, t_s: f64, event: &EventKind, ends: Option<(Point, Point)>) {
        if let EventKind::Tethered {
            length_m,
            paid_out_m,
            free_m,
            contacts,
            wrap_total_rad,
            pull_factor,
            pull_n,
            measured,
            return_length_m,
            bends,
            ..
        } = event
        {
            self.length_m = paid_out_m.unwrap_or(*length_m);
            (self.free_m, self.wrap_total_rad) = (*free_m, *wrap_total_rad);
            (self.pull_factor, self.return_length_m) = (*pull_factor, *return_length_m);
            (self.pull_n, self.measured) = (*pull_n, *measured);
            self.contacts.clone_from(contacts);
            self.line = ends.map_or_else(Vec::new, |(anchor, robot)| taut_line(anchor, bends, robot));
            self.t_s = Some(t_s);
            self.length_history_m.add(t_s, self.length_m);
            let wrap_rad = self.largest().map_or(0.0, |contact| contact.wrap_rad.abs());
            self.wrap_history_deg.add(t_s, wrap_rad.to_degrees());
            if let Some(MeasuredPull { pull_n, .. }) = measured {
                self.pull_history_n.add(t_s, *pull_n);
            }
        }
    }
}
