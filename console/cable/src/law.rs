//! The properties of the cable and its reel.

use serde::{Deserialize, Serialize};

/// Largest force, newtons; larger settings count as this one, so that figures stay finite.
const MOST_N: f64 = 1e6;
/// Highest coefficient of friction; larger settings count as this one.
const MOST_FRICTION: f64 = 10.0;
/// Stretch of the cable at its largest force, as a share of its length. A real cable stretches about as much.
const STRETCH: f64 = 2e-3;

/// The properties of a cable and its reel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Law {
    /// Friction of the floor, newtons per metre of cable.
    pub floor_n_per_m: f64,
    /// Coefficient of friction on everything that the cable bears on.
    pub friction: f64,
    /// Pull with which the reel takes the cable up, newtons; 0 for a reel that only pays out.
    pub pull_n: f64,
    /// Pull that draws the cable off the reel, newtons. The reel keeps its own pull while it pays out, so that a smaller
    /// value has no effect.
    pub pay_out_n: f64,
    /// Speed with which the reel takes the cable up, metres per second.
    pub speed_m_per_s: f64,
    /// Length of the cable, metres.
    pub length_m: f64,
}

impl Law {
    /// The same properties within the bounds that can be computed; settings that are not finite count as 0.
    #[must_use]
    pub(crate) fn bounded(self) -> Self {
        let within = |value: f64, most: f64| if value.is_finite() { value.clamp(0.0, most) } else { 0.0 };
        Self {
            floor_n_per_m: within(self.floor_n_per_m, MOST_N),
            friction: within(self.friction, MOST_FRICTION),
            pull_n: within(self.pull_n, MOST_N),
            pay_out_n: within(self.pay_out_n, MOST_N),
            speed_m_per_s: within(self.speed_m_per_s, 100.0),
            length_m: within(self.length_m, 1e5),
        }
    }

    /// Stretch of a metre of cable under a newton.
    pub(crate) fn stretch_per_n(self) -> f64 {
        STRETCH / (self.pull_n + self.pay_out_n + self.floor_n_per_m * self.length_m).max(1.0)
    }
}
