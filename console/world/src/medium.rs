//! Dry and flooded floor, and which way of moving each calls for.

use crate::tank::{Zone, ZoneKind};
use geometry::Point;
use serde::{Deserialize, Serialize};

/// What covers the floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Medium {
    /// Nothing: the robot walks.
    Land,
    /// Water: it swims.
    Underwater,
}

/// The mode of an amphibious robot, from walking (weight 0) to swimming (weight 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    weight: f64,
}

impl Medium {
    /// The medium at a point, tank frame: that of the last zone of either kind around it; dry floor without one.
    ///
    /// ```
    /// use world::{Medium, Point, Shape, Zone, ZoneKind};
    /// let shape = Shape::Disc { center: Point::origin(), radius_m: 3.0 };
    /// let sump = [Zone { name: "sump".into(), kind: ZoneKind::Underwater, shape }];
    /// assert_eq!(Medium::at(&sump, Point::new(1.0, 0.0)), Medium::Underwater);
    /// assert_eq!(Medium::at(&sump, Point::new(4.0, 0.0)), Medium::Land);
    /// ```
    pub fn at(zones: &[Zone], place: Point) -> Self {
        let here = zones.iter().rev().filter(|zone| zone.kind != ZoneKind::NoGo);
        let kind = here.filter(|zone| zone.shape.distance_m(place) <= 0.0).map(|zone| zone.kind).next();
        if kind == Some(ZoneKind::Underwater) { Self::Underwater } else { Self::Land }
    }
}

impl Mode {
    /// The mode that a medium calls for.
    ///
    /// ```
    /// use world::{Amphibious, Medium, Mode};
    /// assert_eq!(Amphibious::YANG_2021.pace(Mode::of(Medium::Land).weight()).v_max_m_per_s, 0.13);
    /// ```
    pub fn of(medium: Medium) -> Self {
        Self { weight: if medium == Medium::Underwater { 1.0 } else { 0.0 } }
    }

    /// The mode one tick later: one step of the transition toward the mode that a medium calls for.
    ///
    /// ```
    /// use world::{Amphibious, Medium, Mode};
    /// let mode = Mode::of(Medium::Land).toward(Medium::Underwater, 20);
    /// assert!((Amphibious::YANG_2021.pace(mode.weight()).v_max_m_per_s - 0.135).abs() < 1e-12);
    /// ```
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
    ///
    /// ```
    /// use world::{Medium, Mode};
    /// assert_eq!(Mode::of(Medium::Underwater).weight(), 1.0);
    /// ```
    pub fn weight(self) -> f64 {
        self.weight
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Amphibious, Shape};

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
        assert!((robot.pace(mode.weight()).v_max_m_per_s - 0.18).abs() < 1e-12);
        for _ in 0..10 {
            mode = mode.toward(Medium::Land, robot.transition_steps);
        }
        assert!(mode.weight.abs() < 1e-12);
        assert_eq!(mode.toward(Medium::Underwater, 0), Mode::of(Medium::Underwater));
    }
}
