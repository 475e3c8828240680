//! Graded measures of the entanglement of the tether along a path, and the cable at its longest.
//!
//! Measures after the survey of Battocletti et al. 2024: contact (E0), detour (E1), hook (E2). They are shares of the
//! path's length, sampled every 0.2 m. The length still out on return and the wraps are in the certificate.

use crate::tanks::Tank;
use serde::{Deserialize, Serialize};
use std::{f64::consts::PI, sync::Arc};
use world::{
    Point, Vector, polyline,
    tether::{Cable, CableObstacles, Contact, Geodesic, TetherError},
};

/// Distance between the places at which the cable is evaluated, metres.
const STEP_M: f64 = 0.2;
/// Length of cable beyond the minimum that counts as a detour, metres.
const DETOUR_M: f64 = 0.05;
/// Angle, radians, between the robot's direction and its own cable within which it may drive over the cable.
const AHEAD_RAD: f64 = PI / 6.0;

/// The state of a taut cable along a path.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Entanglement {
    /// Largest length of cable out beyond the minimum, metres.
    pub max_excess_m: f64,
    /// Largest number of contacts at one time.
    pub max_contacts: usize,
    /// Share of the path with at least one contact.
    pub contact_share: f64,
    /// Share of the path on which the cable was more than 5 cm longer than the minimum.
    pub detour_share: f64,
    /// Share of the path on which the cable doubled back round an obstacle, by half a turn or more.
    pub hook_share: f64,
    /// Share of the path driven within 30 degrees of the direction to the cable.
    pub own_cable_share: f64,
    /// The cable at its longest, from the anchor to the robot.
    pub longest: Vec<Point>,
}

impl Tank {
    /// Drags a taut cable from the anchor along a path.
    ///
    /// # Errors
    /// The tether has no anchor.
    pub fn entanglement(&self, path: &[Point]) -> Result<Entanglement, TetherError> {
        let shapes: Vec<_> = self.world().obstacles.into_iter().map(|obstacle| obstacle.shape).collect();
        let obstacles = Arc::new(CableObstacles::new(&self.boundary, &shapes));
        let mut cable = Cable::on(self.anchor, Arc::clone(&obstacles))?;
        let least = Geodesic::new(self.anchor, obstacles);
        let longest = cable.clone().at_longest(path).taut_line();
        let mut measured = Entanglement { longest, ..Entanglement::default() };
        let mut way_m = 0.0;
        let fine = polyline::resampled(path, STEP_M);
        cable.drag_along(&fine[..fine.len().min(1)]);
        for pair in fine.windows(2) {
            let (piece_m, before) = ((pair[1] - pair[0]).norm(), cable.contacts());
            way_m += piece_m;
            if is_ahead(&cable, &before, pair[1] - pair[0]) {
                measured.own_cable_share += piece_m;
            }
            cable.drag_to(pair[1]);
            let (contacts, length_m) = (cable.contacts(), cable.length_m());
            measured.add(&contacts, piece_m);
            let excess_m = excess_m(&cable, length_m, &least);
            measured.max_excess_m = measured.max_excess_m.max(excess_m);
            measured.detour_share += if excess_m > DETOUR_M { piece_m } else { 0.0 };
        }
        measured.in_shares_of(way_m);
        Ok(measured)
    }
}

impl Entanglement {
    fn add(&mut self, contacts: &[Contact], piece_m: f64) {
        self.max_contacts = self.max_contacts.max(contacts.len());
        self.contact_share += if contacts.is_empty() { 0.0 } else { piece_m };
        let is_hooked = contacts.iter().any(|contact| contact.wrap_rad.abs() >= PI);
        self.hook_share += if is_hooked { piece_m } else { 0.0 };
    }

    fn in_shares_of(&mut self, way_m: f64) {
        if way_m > 0.0 {
            let Self { contact_share, detour_share, hook_share, own_cable_share, .. } = self;
            for share in [contact_share, detour_share, hook_share, own_cable_share] {
                *share /= way_m;
            }
        }
    }
}

/// Length of cable beyond the minimum; 0 if it is known without a search to be less than 5 cm.
fn excess_m(cable: &Cable, length_m: f64, least: &Geodesic) -> f64 {
    let most_m = length_m - (cable.tip() - cable.anchor()).norm();
    if most_m <= DETOUR_M { 0.0 } else { (length_m - least.distance_m(cable.tip())).max(0.0) }
}

/// Whether a move heads for the cable in front of the robot.
fn is_ahead(cable: &Cable, contacts: &[Contact], move_m: Vector) -> bool {
    let from = contacts.last().map_or(cable.anchor(), |contact| contact.last);
    let back = from - cable.tip();
    // If the next contact is only centimetres away, the cable is too short to drive over.
    back.norm() > DETOUR_M && back.perp(&move_m).atan2(back.dot(&move_m)).abs() <= AHEAD_RAD
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tanks::Known;

    fn tank() -> Tank {
        Tank { columns: vec![(Point::new(4.0, 0.0), 0.3)], ..Known::E1.tank(0) }
    }

    fn points(of: &[(f64, f64)]) -> Vec<Point> {
        of.iter().map(|(x, y)| Point::new(*x, *y)).collect()
    }

    #[test]
    fn out_and_back_on_one_line_the_way_back_leads_along_the_cable() {
        let measured = tank().entanglement(&points(&[(0.0, 0.0), (0.0, 8.0), (0.0, 0.0)])).unwrap();
        assert!((measured.own_cable_share - 0.5).abs() < 0.02, "{measured:?}");
        assert_eq!((measured.max_contacts, measured.contact_share, measured.detour_share), (0, 0.0, 0.0));
        assert!((polyline::length_m(&measured.longest) - 8.0).abs() < 1e-9);
    }

    #[test]
    fn round_a_column_the_cable_bears_then_is_too_long_then_hooked() {
        let round = points(&[(0.0, 0.0), (4.0, 2.0), (8.0, 0.0), (4.0, -2.0), (2.0, 0.0)]);
        let measured = tank().entanglement(&round).unwrap();
        assert_eq!(measured.max_contacts, 1);
        assert!(
            measured.contact_share > measured.detour_share && measured.detour_share > measured.hook_share,
            "{measured:?}"
        );
        assert!(measured.hook_share > 0.03, "{measured:?}");
        // Out to the column, round it and back to two metres from the anchor.
        assert!((measured.max_excess_m - 4.8).abs() < 0.3, "{measured:?}");
    }

    #[test]
    fn no_path_does_nothing() {
        for path in [&points(&[])[..], &points(&[(0.0, 0.0)])] {
            let measured = Entanglement { longest: Vec::new(), ..tank().entanglement(path).unwrap() };
            assert_eq!(measured, Entanglement::default());
        }
    }
}
