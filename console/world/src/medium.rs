//! Dry and flooded floor, and a robot that moves differently in each.

use crate::{
    geometry::Point,
    tank::{Zone, ZoneKind},
};
use serde::{Deserialize, Serialize};

/// What the floor is covered with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Medium {
    /// Nothing: the robot walks.
    Land,
    /// Water: it swims.
    Underwater,
}

/// How fast a robot may move.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pace {
    /// Largest speed, metres per second.
    pub v_max_m_per_s: f64,
    /// Largest turn rate, radians per second.
    pub w_max_rad_per_s: f64,
}

/// The two ways an amphibious robot moves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Amphibious {
    /// On dry floor.
    pub land: Pace,
    /// Under water.
    pub underwater: Pace,
    /// Steps in which one becomes the other; 0 is at once.
    pub transition_steps: u32,
}

/// How far a robot has changed from walking (0) to swimming (1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    weight: f64,
}

impl Medium {
    /// The medium at a place; the last zone of either kind counts, and dry floor where there is none.
    pub fn at(zones: &[Zone], place: Point) -> Self {
        let here = zones.iter().rev().filter(|zone| zone.kind != ZoneKind::NoGo);
        let kind = here.filter(|zone| zone.shape.distance_m(place) <= 0.0).map(|zone| zone.kind).next();
        if kind == Some(ZoneKind::Underwater) { Self::Underwater } else { Self::Land }
    }
}

impl Amphibious {
    /// The limits of Yang et al. 2021, Table 1, and their 20 steps of transition.
    pub const YANG_2021: Self = Self {
        land: Pace { v_max_m_per_s: 0.13, w_max_rad_per_s: 0.12 },
        underwater: Pace { v_max_m_per_s: 0.23, w_max_rad_per_s: 0.31 },
        transition_steps: 20,
    };

    /// What the robot may do in a mode: between both paces, in proportion.
    pub fn pace(&self, mode: Mode) -> Pace {
        let between = |land: f64, underwater: f64| land + (underwater - land) * mode.weight;
        Pace {
            v_max_m_per_s: between(self.land.v_max_m_per_s, self.underwater.v_max_m_per_s),
            w_max_rad_per_s: between(self.land.w_max_rad_per_s, self.underwater.w_max_rad_per_s),
        }
    }

    /// The faster of both paces.
    pub fn fastest(&self) -> Pace {
        Pace {
            v_max_m_per_s: self.land.v_max_m_per_s.max(self.underwater.v_max_m_per_s),
            w_max_rad_per_s: self.land.w_max_rad_per_s.max(self.underwater.w_max_rad_per_s),
        }
    }
}

impl Mode {
    /// All of one.
    pub fn of(medium: Medium) -> Self {
        Self { weight: if medium == Medium::Underwater { 1.0 } else { 0.0 } }
    }

    /// One step toward what a medium asks for.
    #[must_use]
    pub fn toward(self, medium: Medium, transition_steps: u32) -> Self {
        let wanted = Self::of(medium);
        if transition_steps == 0 {
            return wanted;
        }
        let step = 1.0 / f64::from(transition_steps);
        Self { weight: self.weight + (wanted.weight - self.weight).clamp(-step, step) }
    }

    /// Share of swimming, 0 to 1.
    pub fn weight(self) -> f64 {
        self.weight
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::shape::Shape;

    fn zone(kind: ZoneKind, radius_m: f64) -> Zone {
        Zone { name: String::new(), kind, shape: Shape::Disc { center: Point::origin(), radius_m } }
    }

    #[test]
    fn the_later_zone_counts_and_floor_without_one_is_dry() {
        let zones = [zone(ZoneKind::Underwater, 5.0), zone(ZoneKind::Land, 2.0), zone(ZoneKind::NoGo, 9.0)];
        let at = |x: f64| Medium::at(&zones, Point::new(x, 0.0));
        assert_eq!((at(1.0), at(3.0), at(6.0)), (Medium::Land, Medium::Underwater, Medium::Land));
    }

    #[test]
    fn a_transition_takes_its_steps_and_none_is_at_once() {
        let robot = Amphibious::YANG_2021;
        let mut mode = Mode::of(Medium::Underwater);
        for _ in 0..10 {
            mode = mode.toward(Medium::Land, robot.transition_steps);
        }
        assert!((robot.pace(mode).v_max_m_per_s - 0.18).abs() < 1e-12);
        for _ in 0..10 {
            mode = mode.toward(Medium::Land, robot.transition_steps);
        }
        assert!(mode.weight().abs() < 1e-12);
        assert_eq!(mode.toward(Medium::Underwater, 0), Mode::of(Medium::Underwater));
    }
}
