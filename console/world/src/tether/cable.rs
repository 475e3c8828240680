//! The exact taut cable, dragged move by move.

use super::{
    cable_obstacles::{Bearing, CableObstacles, tangent_point},
    homotopy::HomotopySignature,
    pull::Stretch,
    sweep::{Base, Event, SLACK_M, next_event},
};
use geometry::{Boundary, Point, Shape};
use serde::{Deserialize, Serialize};
use std::{ops::ControlFlow, sync::Arc};

/// Wrap below which a contact does not count, radians.
const LEAST_WRAP_RAD: f64 = 1e-7;
/// Angle between the points of an arc when the cable is drawn as a line, radians.
const ARC_STEP_RAD: f64 = 0.1;

/// A contact of the cable with an obstacle.
///
/// ```
/// use world::{Boundary, Point, Shape, tether::Cable};
/// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
/// # let wall = Boundary::Circle { radius_m: 10.0 };
/// // Around a column of radius 0.5 m at (4, 0), on its north side.
/// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
/// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
/// let contact = cable.contacts()[0];
/// assert_eq!(contact.on, world::tether::Bearing::Obstacle(0));
/// assert!((contact.wrap_rad + 0.2507).abs() < 1e-4, "clockwise");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// The object that the cable bears on.
    pub on: Bearing,
    /// The angle by which the cable turns there, radians, positive counter-clockwise; more than a full turn for
    /// loops.
    pub wrap_rad: f64,
    /// The first point of contact, counted from the anchor, tank frame.
    pub first: Point,
    /// The last point of contact, tank frame.
    pub last: Point,
}

/// The reason why a cable cannot be created.
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

/// A post around which the cable bends.
#[derive(Debug, Clone, Copy)]
struct Bend {
    post: usize,
    /// 1 if the cable turns counter-clockwise there, -1 otherwise.
    side: f64,
    /// Bearing of the cable before and after the post, radians; accumulated, so a loop adds a full turn.
    into_rad: f64,
    out_rad: f64,
    /// The length of cable between the anchor and the first point of contact, metres.
    before_m: f64,
}

impl Bend {
    fn wrap_rad(&self) -> f64 {
        self.side * (self.out_rad - self.into_rad)
    }
}

/// The taut cable from an anchor to a robot that has been dragging it.
///
/// The update is event-driven: while the robot moves in a straight line, the free span of the cable sweeps over the
/// floor. Where it becomes tangent to a post, it bends there (push); where a wrap falls to zero, the bend ends (pop).
/// Angles are accumulated and never derived from the last pose alone, so any number of loops is preserved. A move costs
/// one query for nearby posts per event.
///
/// ```
/// use world::{Boundary, Point, Shape, tether::Cable};
/// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
/// # let wall = Boundary::Circle { radius_m: 10.0 };
/// // Around a column of radius 0.5 m at (4, 0), on its north side.
/// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
/// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
/// assert!((cable.length_m() - 8.0626).abs() < 1e-4);
/// ```
#[derive(Debug, Clone)]
pub struct Cable {
    obstacles: Arc<CableObstacles>,
    anchor: Point,
    tip: Point,
    /// Bearing at the anchor, radians.
    start_rad: f64,
    bends: Vec<Bend>,
    signature: HomotopySignature,
}

impl Cable {
    /// Creates a cable of length 0, with the robot at the anchor, in the tank frame.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// let wall = Boundary::Circle { radius_m: 10.0 };
    /// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// assert_eq!(Cable::new(Point::origin(), &wall, &[column.clone()]).unwrap().length_m(), 0.0);
    /// assert!(Cable::new(Point::new(4.1, 0.0), &wall, &[column]).is_err());
    /// ```
    ///
    /// # Errors
    /// [`TetherError`]: the anchor lies outside the wall or inside an obstacle, or has a coordinate that is not finite.
    pub fn new(anchor: Point, boundary: &Boundary, shapes: &[Shape]) -> Result<Self, TetherError> {
        if boundary.wall_distance_m(anchor) < -1e-6 {
            return Err(TetherError::AnchorOutside { x: anchor.x, y: anchor.y });
        }
        Self::on(anchor, Arc::new(CableObstacles::new(boundary, shapes)))
    }

    /// Creates a cable among obstacles that are shared with other cables.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use world::{Boundary, Point, tether::{Cable, CableObstacles}};
    /// let obstacles = Arc::new(CableObstacles::new(&Boundary::Circle { radius_m: 10.0 }, &[]));
    /// let mut cable = Cable::on(Point::origin(), obstacles).unwrap();
    /// cable.drag_to(Point::new(3.0, 4.0));
    /// assert_eq!(cable.length_m(), 5.0);
    /// ```
    ///
    /// # Errors
    /// [`TetherError`]: the anchor lies inside an obstacle, or has a coordinate that is not finite.
    pub fn on(anchor: Point, obstacles: Arc<CableObstacles>) -> Result<Self, TetherError> {
        if !(anchor.x.is_finite() && anchor.y.is_finite()) {
            return Err(TetherError::AnchorNotFinite);
        }
        if obstacles.sidestep.holds(anchor) {
            return Err(TetherError::AnchorInside { x: anchor.x, y: anchor.y });
        }
        let signature = HomotopySignature::default();
        Ok(Self { obstacles, anchor, tip: anchor, start_rad: 0.0, bends: Vec::new(), signature })
    }

    /// Drags the cable straight from the robot's previous position to its new one.
    ///
    /// A move through an obstacle takes the shorter detour around it, and a point inside an obstacle counts as the
    /// nearest point outside; see the module `sidestep`. A position that is not finite is ignored.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// cable.drag_to(Point::new(8.0, 4.0));
    /// assert!((cable.length_m() - 80.0_f64.sqrt()).abs() < 1e-9);
    /// ```
    pub fn drag_to(&mut self, robot: Point) {
        if !(robot.x.is_finite() && robot.y.is_finite()) {
            return;
        }
        let obstacles = Arc::clone(&self.obstacles);
        obstacles.sidestep.along(self.tip, robot, |next| self.sweep_to(next));
    }

    /// Drags the cable along a path.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// assert_eq!(cable.tip(), Point::new(8.0, 0.0));
    /// ```
    pub fn drag_along(&mut self, path: &[Point]) {
        for point in path {
            self.drag_to(*point);
        }
    }

    /// Returns the cable as it is at the point of a path where it is longest.
    ///
    /// Along a straight move, the length of the cable is convex, so the cable is longest at one of the points that
    /// define the path.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// let further = [Point::new(9.0, 0.0), Point::new(8.0, 4.0)];
    /// assert_eq!(cable.at_longest(&further).tip(), further[0]);
    /// ```
    #[must_use]
    pub fn at_longest(mut self, path: &[Point]) -> Self {
        let mut longest = self.clone();
        for point in path {
            self.drag_to(*point);
            if self.length_m() > longest.length_m() {
                longest.clone_from(&self);
            }
        }
        longest
    }

    /// The start of the cable, tank frame.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// assert_eq!(cable.anchor(), Point::origin());
    /// ```
    pub fn anchor(&self) -> Point {
        self.anchor
    }

    /// The end of the cable, tank frame: the robot or, if the robot is inside an obstacle, the nearest free point.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// cable.drag_to(Point::new(4.4, 0.0));
    /// assert!((cable.tip() - Point::new(4.5, 0.0)).norm() < 1e-6, "the tip is outside the column");
    /// ```
    pub fn tip(&self) -> Point {
        self.tip
    }

    /// The obstacles around the cable.
    pub(super) fn obstacles(&self) -> &Arc<CableObstacles> {
        &self.obstacles
    }

    /// Returns the length of the cable between anchor and robot, metres.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// assert!((cable.length_m() - 8.0626).abs() < 1e-4);
    /// ```
    pub fn length_m(&self) -> f64 {
        self.up_to_base_m() + self.free_span_m()
    }

    /// Returns the contacts of the cable, from the anchor on; consecutive posts of one obstacle form one contact.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// assert_eq!(cable.contacts().len(), 1);
    /// ```
    pub fn contacts(&self) -> Vec<Contact> {
        let mut contacts: Vec<Contact> = Vec::new();
        for bend in self.bends.iter().filter(|bend| bend.wrap_rad() > LEAST_WRAP_RAD) {
            let (first, last) = self.touches(bend);
            let (on, wrap_rad) = (self.obstacles.posts[bend.post].of, bend.side * bend.wrap_rad());
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

    /// Returns the largest wrap on any one obstacle as an absolute value, radians; loops count in full.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// assert!((cable.wrap_max_rad() - 0.2507).abs() < 1e-4);
    /// ```
    pub fn wrap_max_rad(&self) -> f64 {
        let (mut most, mut current, mut before) = (0.0_f64, 0.0, None);
        for bend in &self.bends {
            let here = (self.obstacles.posts[bend.post].of, bend.side > 0.0);
            current = if before == Some(here) { current + bend.wrap_rad() } else { bend.wrap_rad() };
            before = Some(here);
            most = most.max(current);
        }
        most
    }

    /// Returns the total wrap: the sum of the absolute values of the wraps on all obstacles, radians.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// assert!((cable.wrap_total_rad() - 0.2507).abs() < 1e-4);
    /// ```
    pub fn wrap_total_rad(&self) -> f64 {
        self.bends.iter().map(|bend| bend.wrap_rad().max(0.0)).sum()
    }

    /// Whether the cable bears on nothing and runs straight from the anchor to the robot.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// assert!(!cable.is_straight());
    /// cable.drag_to(Point::new(8.0, 4.0));
    /// assert!(cable.is_straight());
    /// ```
    pub fn is_straight(&self) -> bool {
        self.bends.iter().all(|bend| bend.wrap_rad() <= LEAST_WRAP_RAD)
    }

    /// The homotopy signature of the path driven; when the robot is at the anchor, it is empty if, and only if, the
    /// cable can be reeled in.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// assert_eq!(cable.signature().crossings().len(), 1);
    /// ```
    pub fn signature(&self) -> &HomotopySignature {
        &self.signature
    }

    /// Returns the cable as a line from the anchor to the robot, tank frame; arcs become chords of at most 0.1 rad.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Cable};
    /// # let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let wall = Boundary::Circle { radius_m: 10.0 };
    /// // Around a column of radius 0.5 m at (4, 0), on its north side.
    /// let mut cable = Cable::new(Point::origin(), &wall, &[column]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// let line_m = world::polyline::length_m(&cable.taut_line());
    /// assert!((line_m - cable.length_m()).abs() < 1e-3);
    /// ```
    pub fn taut_line(&self) -> Vec<Point> {
        self.line_beside_posts(0.0)
    }

    /// Returns the cable as a line with a given distance from every post that it bears on, metres. The line has the
    /// same ends as the cable and passes the posts in the same order; between two posts, it may come closer to other
    /// obstacles.
    pub(super) fn line_beside_posts(&self, room_m: f64) -> Vec<Point> {
        let mut line = vec![self.anchor];
        for bend in &self.bends {
            let post = self.obstacles.posts[bend.post];
            let radius_m = post.radius_m + room_m;
            let steps = if radius_m > 0.0 { (bend.wrap_rad() / ARC_STEP_RAD).ceil().max(1.0) } else { 0.0 };
            line.extend((0..=steps as usize).map(|k| {
                let share = if steps > 0.0 { k as f64 / steps } else { 0.0 };
                let bearing_rad = bend.into_rad + (bend.out_rad - bend.into_rad) * share;
                tangent_point(post.center, radius_m, bend.side, bearing_rad)
            }));
        }
        line.push(self.tip);
        line
    }

    fn touches(&self, bend: &Bend) -> (Point, Point) {
        let post = self.obstacles.posts[bend.post];
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
                let post = self.obstacles.posts[bend.post];
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
        self.bends.last().map_or(0.0, |bend| self.up_to_bend_end_m(bend))
    }

    fn up_to_bend_end_m(&self, bend: &Bend) -> f64 {
        bend.before_m + self.obstacles.posts[bend.post].radius_m * bend.wrap_rad().max(0.0)
    }

    /// Length of the straight span that ends at the robot, metres.
    pub(super) fn free_span_m(&self) -> f64 {
        let base = self.base();
        (self.tip - base.leaves_at(base.out_rad)).norm()
    }

    /// The bends, each with the straight span before it, from the anchor on.
    pub(super) fn stretches(&self) -> impl DoubleEndedIterator<Item = Stretch> {
        self.bends.iter().enumerate().map(|(k, bend)| {
            let behind_m = k.checked_sub(1).map_or(0.0, |before| self.up_to_bend_end_m(&self.bends[before]));
            Stretch {
                span_m: (bend.before_m - behind_m).max(0.0),
                radius_m: self.obstacles.posts[bend.post].radius_m,
                wrap_rad: bend.wrap_rad().max(0.0),
            }
        })
    }

    fn turn_base_to(&mut self, bearing_rad: f64) {
        match self.bends.last_mut() {
            Some(bend) => bend.out_rad = bearing_rad,
            None => self.start_rad = bearing_rad,
        }
    }

    /// Drags the cable along a straight move that enters no obstacle.
    fn sweep_to(&mut self, to: Point) {
        let from = self.tip;
        if from == to {
            return;
        }
        self.signature.extend(from, to, &self.obstacles.rays);
        if self.bends.is_empty() && (from - self.anchor).norm() <= SLACK_M {
            // A cable of length zero has no bearing, so it takes the bearing of the move.
            self.start_rad = self.base().bearing_to(to).unwrap_or(self.start_rad);
        } else {
            self.turn(from, to);
        }
        self.tip = to;
    }

    fn turn(&mut self, from: Point, to: Point) {
        let mut released: Vec<usize> = Vec::new();
        // A straight move cannot cause more events than this; the limit prevents endless loops due to rounding.
        let most = 2 * (self.bends.len() + self.obstacles.posts.len()) + 8;
        for _ in 0..most {
            if self.advance(from, to, &mut released).is_break() {
                return;
            }
        }
        let base = self.base();
        self.turn_base_to(base.out_rad + base.turn_to(from, to));
    }

    fn advance(&mut self, from: Point, to: Point, released: &mut Vec<usize>) -> ControlFlow<()> {
        let base = self.base();
        let turn_rad = base.turn_to(from, to);
        match next_event(&self.obstacles, &base, from, to, turn_rad, released) {
            Event::Arrive => {
                self.turn_base_to(base.out_rad + turn_rad);
                return ControlFlow::Break(());
            }
            Event::Release => {
                let bend = self.bends.pop().expect("only a bend can be released");
                released.push(bend.post);
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

/// Returns the factor by which the total wrap multiplies the pulling force of the cable. By the capstan equation
/// (Euler-Eytelwein), the factor is e to the power of the friction coefficient times the total wrap in radians.
///
/// ```
/// let half_a_turn = std::f64::consts::PI;
/// assert!((world::tether::capstan_factor(0.3, half_a_turn) - 2.566).abs() < 1e-3);
/// ```
pub fn capstan_factor(friction: f64, wrap_total_rad: f64) -> f64 {
    (friction * wrap_total_rad).exp()
}
