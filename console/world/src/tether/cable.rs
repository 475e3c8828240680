//! The exact taut cable, dragged move by move.

use super::{
    ground::Ground,
    sweep::{Base, Event, next_event},
    word::Word,
};
use crate::{
    Boundary,
    geometry::{Point, Vector},
    shape::Shape,
};
use serde::{Deserialize, Serialize};
use std::{ops::ControlFlow, sync::Arc};

/// Lateral slack of a contact, metres: it ends once the robot is this far on its free side, and begins half of this
/// early. So rounding never lets a cable slip through a corner that it has just touched.
pub(super) const SLACK_M: f64 = 1e-8;
/// Wraps below this do not count as contacts, radians.
const LEAST_WRAP_RAD: f64 = 1e-7;
/// Angle between the points that stand for an arc in a drawn line, radians.
const ARC_STEP_RAD: f64 = 0.1;

/// What a cable bears on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bearing {
    /// The obstacle with this index in the list that the ground was made of.
    Obstacle(usize),
    /// An inward corner of the wall.
    Wall,
}

/// Where a cable bears on one obstacle, from its first to its last point there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// What it bears on.
    pub on: Bearing,
    /// Angle by which the cable turns there, radians, counter-clockwise; more than a turn for loops.
    pub wrap_rad: f64,
    /// First point of contact, seen from the anchor.
    pub first: Point,
    /// Last point of contact.
    pub last: Point,
}

/// Why there can be no cable.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TetherError {
    /// The anchor is not on the floor.
    #[error("the tether's anchor at {x:.2}, {y:.2} m lies outside the wall; put it on the floor")]
    AnchorOutside {
        /// East, metres.
        x: f64,
        /// North, metres.
        y: f64,
    },
    /// The anchor is inside an obstacle.
    #[error("the tether's anchor at {x:.2}, {y:.2} m lies inside an obstacle; put it on free floor")]
    AnchorInside {
        /// East, metres.
        x: f64,
        /// North, metres.
        y: f64,
    },
    /// A coordinate is not a number.
    #[error("the tether's anchor has a coordinate that is not a finite number")]
    AnchorNotFinite,
}

/// One post that the cable goes round.
#[derive(Debug, Clone, Copy)]
struct Bend {
    post: usize,
    /// 1 when the cable turns counter-clockwise there, -1 otherwise.
    side: f64,
    /// Bearing of the cable before and after, radians; accumulated, so a loop is a whole turn.
    into_rad: f64,
    out_rad: f64,
    /// Cable between anchor and the first point of contact, metres.
    before_m: f64,
}

impl Bend {
    fn wrap_rad(&self) -> f64 {
        self.side * (self.out_rad - self.into_rad)
    }
}

/// The taut cable from an anchor to a robot that has been dragging it.
///
/// Event-driven: the free piece of cable sweeps over the floor while the robot moves in a straight line; where it
/// becomes tangent to a post it bends there (push), where a wrap falls to nothing the bend ends (pop). Angles are
/// accumulated, never read off the last pose, so any number of loops is kept. One move costs one look at every post
/// per event.
#[derive(Debug, Clone)]
pub struct Cable {
    ground: Arc<Ground>,
    anchor: Point,
    tip: Point,
    /// Bearing at the anchor, radians.
    start_rad: f64,
    bends: Vec<Bend>,
    word: Word,
}

impl Cable {
    /// A cable of length 0: the robot stands at the anchor.
    ///
    /// # Errors
    /// The anchor lies outside the wall, inside an obstacle, or nowhere.
    pub fn new(anchor: Point, boundary: &Boundary, shapes: &[Shape]) -> Result<Self, TetherError> {
        if !boundary.contains(anchor) && boundary.wall_distance_m(anchor) < -1e-6 {
            return Err(TetherError::AnchorOutside { x: anchor.x, y: anchor.y });
        }
        Self::on(anchor, Arc::new(Ground::new(boundary, shapes)))
    }

    /// The same on a ground that is shared with other cables.
    ///
    /// # Errors
    /// The anchor lies inside an obstacle, or nowhere.
    pub fn on(anchor: Point, ground: Arc<Ground>) -> Result<Self, TetherError> {
        let Point { coords } = anchor;
        if !(coords.x.is_finite() && coords.y.is_finite()) {
            return Err(TetherError::AnchorNotFinite);
        }
        if ground.sidestep.holds(anchor) {
            return Err(TetherError::AnchorInside { x: anchor.x, y: anchor.y });
        }
        Ok(Self { ground, anchor, tip: anchor, start_rad: 0.0, bends: Vec::new(), word: Word::default() })
    }

    /// Drags the cable to where the robot is now, straight from where it was.
    ///
    /// A move through an obstacle goes round it the shorter way, and a place inside one counts as the nearest place
    /// outside: see the module `sidestep`. Places that are not finite are passed over.
    pub fn drag_to(&mut self, robot: Point) {
        if !(robot.x.is_finite() && robot.y.is_finite()) {
            return;
        }
        let ground = Arc::clone(&self.ground);
        ground.sidestep.along(self.tip, robot, |next| self.sweep_to(next));
    }

    /// Drags the cable along a way.
    pub fn drag_along(&mut self, way: &[Point]) {
        for point in way {
            self.drag_to(*point);
        }
    }

    /// The cable as it lies when it is longest on a way.
    ///
    /// Along a straight move its length is convex, so it is longest at a corner of the way.
    #[must_use]
    pub fn at_longest(mut self, way: &[Point]) -> Self {
        let mut longest = self.clone();
        for point in way {
            self.drag_to(*point);
            if self.length_m() > longest.length_m() {
                longest.clone_from(&self);
            }
        }
        longest
    }

    /// Where the cable begins.
    pub fn anchor(&self) -> Point {
        self.anchor
    }

    /// Where the cable ends: the robot, or the nearest free place to it.
    pub fn tip(&self) -> Point {
        self.tip
    }

    /// The ground that it lies on.
    pub fn ground(&self) -> &Arc<Ground> {
        &self.ground
    }

    /// Length of cable between anchor and robot, metres.
    pub fn length_m(&self) -> f64 {
        let base = self.base();
        self.up_to_base_m() + (self.tip - base.leaves_at(base.out_rad)).norm()
    }

    /// Where the cable bears, from the anchor on; several posts of one obstacle in a row are one contact.
    pub fn contacts(&self) -> Vec<Contact> {
        let mut contacts: Vec<Contact> = Vec::new();
        for bend in self.bends.iter().filter(|bend| bend.wrap_rad() > LEAST_WRAP_RAD) {
            let (first, last) = self.touches(bend);
            let (on, wrap_rad) = (self.ground.posts[bend.post].of, bend.side * bend.wrap_rad());
            match contacts.last_mut() {
                Some(before) if before.on == on && before.wrap_rad * wrap_rad > 0.0 => {
                    before.wrap_rad += wrap_rad;
                    before.last = last;
                }
                _ => contacts.push(Contact { on, wrap_rad, first, last }),
            }
        }
        contacts
    }

    /// Largest wrap on one obstacle, radians, without sign; loops count in full.
    pub fn wrap_max_rad(&self) -> f64 {
        let (mut most, mut current, mut before) = (0.0_f64, 0.0, None);
        for bend in &self.bends {
            let here = (self.ground.posts[bend.post].of, bend.side > 0.0);
            current = if before == Some(here) { current + bend.wrap_rad() } else { bend.wrap_rad() };
            before = Some(here);
            most = most.max(current);
        }
        most
    }

    /// Sum of all wraps, radians, without signs.
    pub fn wrap_total_rad(&self) -> f64 {
        self.bends.iter().map(|bend| bend.wrap_rad().max(0.0)).sum()
    }

    /// Whether no obstacle holds the cable: it runs straight from the anchor to the robot.
    pub fn is_straight(&self) -> bool {
        self.bends.iter().all(|bend| bend.wrap_rad() <= LEAST_WRAP_RAD)
    }

    /// The reduced crossing word of the way driven; empty at the anchor exactly if the cable can be reeled in.
    pub fn word(&self) -> &Word {
        &self.word
    }

    /// The cable as a line from the anchor to the robot; arcs become chords of a tenth of a radian.
    pub fn taut_line(&self) -> Vec<Point> {
        let mut line = vec![self.anchor];
        for bend in &self.bends {
            let post = self.ground.posts[bend.post];
            let steps =
                if post.radius_m > 0.0 { (bend.wrap_rad() / ARC_STEP_RAD).ceil().max(1.0) } else { 0.0 };
            line.extend((0..=steps as usize).map(|k| {
                let share = if steps > 0.0 { k as f64 / steps } else { 0.0 };
                let bearing_rad = bend.into_rad + (bend.out_rad - bend.into_rad) * share;
                tangent_point(post.center, post.radius_m, bend.side, bearing_rad)
            }));
        }
        line.push(self.tip);
        line
    }

    fn touches(&self, bend: &Bend) -> (Point, Point) {
        let post = self.ground.posts[bend.post];
        let at = |bearing_rad| tangent_point(post.center, post.radius_m, bend.side, bearing_rad);
        (at(bend.into_rad), at(bend.out_rad))
    }

    fn base(&self) -> Base {
        match self.bends.last() {
            None => Base {
                center: self.anchor,
                radius_m: 0.0,
                side: 0.0,
                out_rad: self.start_rad,
                wrap_rad: f64::INFINITY,
                post: None,
            },
            Some(bend) => {
                let post = self.ground.posts[bend.post];
                Base {
                    center: post.center,
                    radius_m: post.radius_m,
                    side: bend.side,
                    out_rad: bend.out_rad,
                    wrap_rad: bend.wrap_rad(),
                    post: Some(bend.post),
                }
            }
        }
    }

    fn up_to_base_m(&self) -> f64 {
        self.bends.last().map_or(0.0, |bend| {
            bend.before_m + self.ground.posts[bend.post].radius_m * bend.wrap_rad().max(0.0)
        })
    }

    fn turn_base_to(&mut self, bearing_rad: f64) {
        match self.bends.last_mut() {
            Some(bend) => bend.out_rad = bearing_rad,
            None => self.start_rad = bearing_rad,
        }
    }

    /// One straight move that enters no solid.
    fn sweep_to(&mut self, to: Point) {
        let from = self.tip;
        if from == to {
            return;
        }
        self.word.go(from, to, &self.ground.rays);
        if self.bends.is_empty() && (from - self.anchor).norm() <= SLACK_M {
            // Without length the cable has no bearing: it takes the one of the move.
            self.start_rad = self.base().bearing_to(to).unwrap_or(self.start_rad);
        } else {
            self.turn(from, to);
        }
        self.tip = to;
    }

    fn turn(&mut self, from: Point, to: Point) {
        let mut let_go: Vec<usize> = Vec::new();
        // More events than posts and bends cannot come of one straight move; rounding must not loop for ever.
        let most = 2 * (self.bends.len() + self.ground.posts.len()) + 8;
        for _ in 0..most {
            if self.advance(from, to, &mut let_go).is_break() {
                return;
            }
        }
        let base = self.base();
        self.turn_base_to(base.out_rad + base.turn_to(from, to));
    }

    fn advance(&mut self, from: Point, to: Point, let_go: &mut Vec<usize>) -> ControlFlow<()> {
        let base = self.base();
        let turn_rad = base.turn_to(from, to);
        match next_event(&self.ground, &base, from, to, turn_rad, let_go) {
            Event::Arrive => {
                self.turn_base_to(base.out_rad + turn_rad);
                return ControlFlow::Break(());
            }
            Event::LetGo => {
                let bend = self.bends.pop().expect("only a bend can be let go");
                let_go.push(bend.post);
            }
            Event::Touch { post, side, bearing_rad, at } => {
                self.turn_base_to(bearing_rad);
                let before_m = self.up_to_base_m() + (at - base.leaves_at(bearing_rad)).norm();
                self.bends.push(Bend { post, side, into_rad: bearing_rad, out_rad: bearing_rad, before_m });
            }
        }
        ControlFlow::Continue(())
    }
}

/// Where a line of some bearing touches a disc; `side` 1 has the disc on its left, -1 on its right.
pub(super) fn tangent_point(center: Point, radius_m: f64, side: f64, bearing_rad: f64) -> Point {
    let left = Vector::new(-bearing_rad.sin(), bearing_rad.cos());
    center - left * (side * radius_m)
}

/// How many times harder a cable must be pulled for all its wraps: e to the (friction times sum of wraps).
pub fn capstan_factor(friction: f64, wrap_total_rad: f64) -> f64 {
    (friction * wrap_total_rad).exp()
}
