//! When the rotating force acts, and in which direction.

use crate::trap::Gate;
use geometry::Vector;
use std::collections::BTreeMap;
use steering::{Contact, Side, Source};

/// Number of moves for which a gate stays open after the detector has fired.
const HOLD_MOVES: usize = 10;

/// The interpretation of the rotating force of Wang et al. 2023.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// No rotating force.
    Off,
    /// As printed: around every obstacle in range, always.
    Literal,
    /// Only while the gate is open. Of all interpretations tried, only those with a gate come close to the printed
    /// figures.
    Gated,
}

/// How the direction of rotation is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SenseRule {
    /// Always counter-clockwise, as printed. The force helps the robot past obstacles on its left, and pushes it back
    /// at obstacles on its right.
    CounterClockwise,
    /// The direction that points more towards the target when the force begins to act; kept while the obstacle is in
    /// range.
    SideAware,
}

/// The gate of the rotating force and its side at each obstacle, updated along a walk.
#[derive(Debug, Clone)]
pub struct Turning {
    reading: Reading,
    rule: SenseRule,
    hold: usize,
    open_for: usize,
    kept: BTreeMap<Source, Side>,
}

impl Turning {
    /// Creates the state with a closed gate and no side chosen.
    pub fn new(reading: Reading, rule: SenseRule, gate: Gate) -> Self {
        let hold = if gate == Gate::Detected { HOLD_MOVES } else { 1 };
        Self { reading, rule, hold, open_for: 0, kept: BTreeMap::new() }
    }

    /// Processes the state before the next move: whether the law is trapped, and the nearby contacts.
    pub fn update(&mut self, is_trapped: bool, contacts: &[Contact], to_goal: Vector) {
        self.open_for = if is_trapped { self.hold } else { self.open_for.saturating_sub(1) };
        self.kept.retain(|source, _| contacts.iter().any(|c| c.source == *source));
        if self.is_on() && self.rule == SenseRule::SideAware {
            for contact in contacts {
                self.kept.entry(contact.source).or_insert_with(|| toward(to_goal, contact.away));
            }
        }
    }

    /// Whether the force acts now.
    pub fn is_on(&self) -> bool {
        match self.reading {
            Reading::Off => false,
            Reading::Literal => true,
            Reading::Gated => self.open_for > 0,
        }
    }

    /// The side on which to pass a contact, if the force acts.
    pub fn side(&self, contact: &Contact) -> Option<Side> {
        if !self.is_on() || contact.source == Source::Wall {
            return None;
        }
        Some(self.kept.get(&contact.source).copied().unwrap_or(Side::Right))
    }
}

/// The side whose tangent points more towards the goal.
fn toward(to_goal: Vector, away: Vector) -> Side {
    if Side::Right.along(away).dot(&to_goal) >= 0.0 { Side::Right } else { Side::Left }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EAST_OF_IT: Contact =
        Contact { source: Source::Obstacle(4), distance_m: 0.3, away: Vector::new(1.0, 0.0) };

    #[test]
    fn a_gate_opens_in_a_trap_and_closes_ten_moves_later() {
        let mut turning = Turning::new(Reading::Gated, SenseRule::CounterClockwise, Gate::Detected);
        turning.update(false, &[EAST_OF_IT], Vector::y());
        assert_eq!(turning.side(&EAST_OF_IT), None);
        turning.update(true, &[EAST_OF_IT], Vector::y());
        for _ in 0..9 {
            turning.update(false, &[EAST_OF_IT], Vector::y());
        }
        assert_eq!(turning.side(&EAST_OF_IT), Some(Side::Right));
        turning.update(false, &[EAST_OF_IT], Vector::y());
        assert_eq!(turning.side(&EAST_OF_IT), None);
    }

    #[test]
    fn a_gate_by_force_is_not_held_open() {
        let mut turning = Turning::new(Reading::Gated, SenseRule::CounterClockwise, Gate::Backward);
        turning.update(true, &[EAST_OF_IT], Vector::y());
        assert!(turning.is_on());
        turning.update(false, &[EAST_OF_IT], Vector::y());
        assert!(!turning.is_on());
    }

    #[test]
    fn a_side_once_chosen_is_kept_while_the_obstacle_is_near() {
        let mut turning = Turning::new(Reading::Literal, SenseRule::SideAware, Gate::Detected);
        turning.update(false, &[EAST_OF_IT], -Vector::y());
        assert_eq!(turning.side(&EAST_OF_IT), Some(Side::Left));
        turning.update(false, &[EAST_OF_IT], Vector::y());
        assert_eq!(turning.side(&EAST_OF_IT), Some(Side::Left));
        turning.update(false, &[], Vector::y());
        turning.update(false, &[EAST_OF_IT], Vector::y());
        assert_eq!(turning.side(&EAST_OF_IT), Some(Side::Right));
    }
}
