//! Walks a law over the known map, move by move.

use crate::{
    escape::Situation,
    response::TrapResponse,
    scene::Scene,
    settings::{FieldSettings, MoveLength},
};
use geometry::{Point, Vector};
use std::collections::VecDeque;
use steering::Contact;

/// Number of moves without headway after which a walk counts as trapped.
const TRAP_MOVES: usize = 25;

/// A walk in progress and its state.
pub struct Walker<'a> {
    scene: &'a Scene,
    settings: &'a FieldSettings,
    response: TrapResponse,
    lagging: VecDeque<Point>,
    heading: Option<Vector>,
    at: Point,
    path: Vec<Point>,
    trap: Option<Point>,
}

/// A move to make.
#[derive(Debug, Clone, Copy)]
pub struct Move {
    /// The target of the move.
    pub target: Point,
    /// Longest ordinary move, metres.
    pub step_m: f64,
    /// Longest move allowed now, metres.
    pub cap_m: f64,
    /// Distance that an unobstructed move would cover, metres.
    pub expected_m: f64,
}

impl<'a> Walker<'a> {
    /// Starts a walk.
    pub fn new(scene: &'a Scene, settings: &'a FieldSettings, start: Point) -> Self {
        Self {
            scene,
            settings,
            response: TrapResponse::new(settings),
            lagging: VecDeque::new(),
            heading: None,
            at: start,
            path: vec![start],
            trap: None,
        }
    }

    /// The current position.
    pub fn at(&self) -> Point {
        self.at
    }

    /// The position where the walk was first trapped. A walk is trapped if 25 moves led less than a step away, while
    /// the target was always more than one step away and, at the end, more than two.
    pub fn trap(&self) -> Option<Point> {
        self.trap
    }

    /// All points of the walk, starting with the start.
    pub fn into_path(self) -> Vec<Point> {
        self.path
    }

    /// Moves along the resultant, but no further than to the target or than the force allows. An unobstructed path ends
    /// exactly at the target.
    pub fn advance(&mut self, next: &Move) {
        let to_target = next.target - self.at;
        let (law, step_m) = (&self.settings.law, next.step_m);
        let contacts = self.scene.contacts(self.at, law);
        let now = Situation { at: self.at, goal: next.target, contacts: &contacts, law, step_m };
        self.response.update(&now, next.expected_m);
        let resultant = self.resultant(next.target, &contacts);
        if let Some(direction) = self.direction(resultant) {
            let length_m = match self.settings.walking.length {
                MoveLength::ToTarget => to_target.norm(),
                MoveLength::ByForce => resultant.norm() / law.k_att,
            };
            self.at += direction * next.cap_m.min(length_m);
            self.heading = Some(direction);
        }
        self.path.push(self.at);
        self.watch_for_trap((next.target - self.at).norm(), step_m);
    }

    fn resultant(&self, target: Point, contacts: &[Contact]) -> Vector {
        let forces = self.settings.law.forces(self.at, target, contacts, |c| self.response.turning.side(c));
        let escape = self.response.escape;
        self.settings.law.beside.left_of(forces, escape != Vector::zeros()).resultant() + escape
    }

    fn direction(&self, resultant: Vector) -> Option<Vector> {
        let wanted = resultant.try_normalize(1e-12)?;
        match (self.settings.walking.turn_limit_rad, self.heading) {
            (Some(limit_rad), Some(heading)) => Some(turned_at_most(heading, wanted, limit_rad)),
            _ => Some(wanted),
        }
    }

    fn watch_for_trap(&mut self, lag_m: f64, step_m: f64) {
        if lag_m <= step_m {
            self.lagging.clear();
            return;
        }
        self.lagging.push_back(self.at);
        if self.lagging.len() > TRAP_MOVES {
            let first = self.lagging.pop_front().expect("more than 25 positions are kept");
            let led_nowhere = (self.at - first).norm() < step_m && lag_m > 2.0 * step_m;
            self.trap = self.trap.or(led_nowhere.then_some(self.at));
        }
    }
}

/// Returns `wanted`, or the nearest direction within the turn limit. Both are unit vectors.
fn turned_at_most(heading: Vector, wanted: Vector, limit_rad: f64) -> Vector {
    let turn_rad = heading.perp(&wanted).atan2(heading.dot(&wanted));
    if turn_rad.abs() <= limit_rad {
        return wanted;
    }
    nalgebra::Rotation2::new(limit_rad.copysign(turn_rad)) * heading
}
