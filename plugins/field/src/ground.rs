//! The known map in flat form, for laws that are walked in thousands of small steps.

use crate::{
    body::Body,
    scene::solids,
    tangents::{self, Side, Tangent},
};
use geometry::convex::{Part, parts_of};
use planner_api::Site;
use world::{Point, Vector};

/// What is near is looked up again after this distance, metres.
const SLACK_M: f64 = 1.0;

/// A convex thing that the robot must not touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// The obstacle that it is a part of.
    pub id: u32,
    /// Its outline.
    pub part: Part,
    /// Middle of a disc around it.
    pub center: Point,
    /// Radius of that disc, metres.
    pub radius_m: f64,
    corners: Vec<(Point, f64)>,
}

impl Solid {
    /// A part of an obstacle.
    pub fn new(id: u32, part: Part) -> Self {
        let corners = part.corners();
        let (center, radius_m) = disc_around(&corners);
        let corners = if corners.iter().all(|c| *c == corners[0]) { vec![corners[0]] } else { corners };
        Self { id, part, center, radius_m, corners }
    }

    /// A disc.
    pub fn disc(id: u32, center: Point, radius_m: f64) -> Self {
        Self::new(id, Part::Capsule { a: center, b: center, half_width_m: radius_m })
    }

    /// Discs whose hull it is.
    pub fn corners(&self) -> &[(Point, f64)] {
        &self.corners
    }

    /// Whether a point is certainly further than this from the outline; costs next to nothing.
    pub fn is_beyond(&self, at: Point, distance_m: f64) -> bool {
        let reach_m = self.radius_m + distance_m;
        (at - self.center).norm_squared() > reach_m * reach_m
    }

    /// Signed distance from a point to the outline, metres, and the way out.
    pub fn distance(&self, at: Point) -> (f64, Vector) {
        if self.corners.len() > 1 {
            return self.part.distance(at);
        }
        let from = at - self.center;
        let length_m = from.norm();
        let away = if length_m > 1e-9 { from / length_m } else { Vector::x() };
        (length_m - self.radius_m, away)
    }

    /// Distance from a segment to the outline, metres; not above zero when they touch, and exact only below
    /// `enough_m`.
    pub fn segment_distance_m(&self, a: Point, b: Point, enough_m: f64) -> f64 {
        let nearest = world::polyline::nearest_on_segment(a, b, self.center);
        let around_m = (nearest - self.center).norm() - self.radius_m;
        let is_disc = self.corners.len() == 1;
        if is_disc || around_m > enough_m { around_m } else { self.part.segment_distance_m(a, b) }
    }

    /// The tangent from a point to the outline grown by a margin.
    pub fn tangent(&self, at: Point, margin_m: f64, side: Side) -> Tangent {
        let grown = self.corners.iter().map(|(corner, radius_m)| (*corner, radius_m + margin_m));
        tangents::outermost(at, grown, side).expect("a solid has a corner")
    }
}

/// Everything solid, and the wall.
#[derive(Debug, Clone)]
pub struct Ground {
    /// Convex parts of obstacles and no-go zones.
    pub solids: Vec<Solid>,
    /// The wall.
    pub wall: world::Boundary,
    /// Radius of the robot, metres.
    pub hull_m: f64,
}

impl Ground {
    /// The ground of a site.
    pub fn new(site: &Site<'_>) -> Self {
        let parts =
            solids(site).flat_map(|(id, outline)| parts_of(&outline).into_iter().map(move |p| (id, p)));
        Self {
            solids: parts.map(|(id, part)| Solid::new(id, part)).collect(),
            wall: site.boundary.to_owned(),
            hull_m: site.limits.radius_m,
        }
    }

    /// Takes what is sensed instead of what was known of the same obstacles; true if that changed anything.
    pub fn learn(&mut self, bodies: &[Body]) -> bool {
        let mut changed = false;
        for body in bodies {
            let known = self.solids.iter().filter(|s| s.id == body.id).map(|s| &s.part);
            if known.eq(body.parts.iter()) {
                continue;
            }
            changed = true;
            self.solids.retain(|s| s.id != body.id);
            self.solids.extend(body.parts.iter().map(|part| Solid::new(body.id, part.clone())));
        }
        changed
    }

    /// Distance from a hull at a place to anything solid, the wall included, metres.
    pub fn clearance_m(&self, at: Point) -> f64 {
        let solids = self.solids.iter().map(|s| s.distance(at).0);
        solids.fold(self.wall.wall_distance_m(at), f64::min) - self.hull_m
    }

    /// Whether the hull finds a margin along a straight way.
    pub fn is_free(&self, a: Point, b: Point, margin_m: f64) -> bool {
        let keep_m = self.hull_m + margin_m;
        self.solids.iter().all(|s| s.segment_distance_m(a, b, keep_m) >= keep_m)
            && self.wall_distance_m(a, b, keep_m) >= keep_m
    }

    /// The least distance between hull and anything solid along a path, metres; of a distance that is larger than
    /// `enough_m` only that it is.
    pub fn path_clearance_m(&self, path: &[Point], enough_m: f64) -> f64 {
        let reach_m = enough_m + self.hull_m;
        let mut nearby = Nearby::new(reach_m);
        let mut least_m = path.first().map_or(reach_m, |start| self.clearance_m(*start) + self.hull_m);
        for pair in path.windows(2) {
            let long_m = (pair[1] - pair[0]).norm();
            if long_m > SLACK_M {
                // Things near its middle may not be near its beginning.
                nearby.forget();
                let free = self.solids.iter().map(|s| s.segment_distance_m(pair[0], pair[1], least_m));
                least_m = free.fold(least_m, f64::min);
            }
            for &index in nearby.update(self, pair[0]) {
                let solid = &self.solids[index];
                if !solid.is_beyond(pair[0], least_m + long_m) {
                    least_m = least_m.min(solid.segment_distance_m(pair[0], pair[1], least_m));
                }
            }
            if nearby.sees_wall() || long_m > SLACK_M {
                least_m = least_m.min(self.wall_distance_m(pair[0], pair[1], least_m));
            }
        }
        least_m - self.hull_m
    }

    /// Distance from the wall to a segment, metres; negative outside, and exact only below `enough_m`.
    fn wall_distance_m(&self, a: Point, b: Point, enough_m: f64) -> f64 {
        let ends_m = self.wall.wall_distance_m(a).min(self.wall.wall_distance_m(b));
        let world::Boundary::Polygon { vertices } = &self.wall else { return ends_m };
        // No place between is nearer to the wall than this.
        if ends_m - (b - a).norm() / 2.0 >= enough_m {
            return ends_m;
        }
        let edges = vertices.iter().zip(vertices.iter().cycle().skip(1));
        let edge = |(c, d): (&Point, &Point)| Part::Capsule { a: *c, b: *d, half_width_m: 0.0 };
        edges.map(|ends| edge(ends).segment_distance_m(a, b)).fold(ends_m, f64::min)
    }
}

/// The solids near a moving robot.
#[derive(Debug, Clone)]
pub struct Nearby {
    reach_m: f64,
    looked_from: Option<Point>,
    indices: Vec<usize>,
    wall_m: f64,
}

impl Nearby {
    /// Those whose outline is within a distance of the robot's middle.
    pub fn new(reach_m: f64) -> Self {
        Self { reach_m, looked_from: None, indices: Vec::new(), wall_m: f64::INFINITY }
    }

    /// Looks again next time: the ground has changed.
    pub fn forget(&mut self) {
        self.looked_from = None;
    }

    /// Indices of all solids in reach, and perhaps some more.
    pub fn update(&mut self, ground: &Ground, at: Point) -> &[usize] {
        if self.looked_from.is_none_or(|from| (from - at).norm_squared() > SLACK_M * SLACK_M) {
            self.looked_from = Some(at);
            let is_near = |s: &Solid| s.distance(at).0 < self.reach_m + SLACK_M;
            self.indices.clear();
            self.indices.extend((0..ground.solids.len()).filter(|index| is_near(&ground.solids[*index])));
            self.wall_m = ground.wall.wall_distance_m(at);
        }
        &self.indices
    }

    /// Those found by the last update.
    pub fn indices(&self) -> &[usize] {
        &self.indices
    }

    /// Whether the wall may be in reach.
    pub fn sees_wall(&self) -> bool {
        self.wall_m < self.reach_m + SLACK_M
    }
}

/// A disc around several discs: round their box, as Xu et al. 2022, eq. 6, mean it.
pub fn disc_around(discs: &[(Point, f64)]) -> (Point, f64) {
    if let [(center, radius_m)] = discs {
        return (*center, *radius_m);
    }
    let far = f64::INFINITY;
    let (mut low, mut high) = (Point::new(far, far), Point::new(-far, -far));
    for (center, radius_m) in discs {
        let grow = Vector::new(*radius_m, *radius_m);
        low = low.inf(&(center - grow));
        high = high.sup(&(center + grow));
    }
    if discs.iter().all(|disc| disc == &discs[0]) {
        return discs[0];
    }
    (nalgebra::center(&low, &high), (high - low).norm() / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ground() -> Ground {
        let corners = [(2.0, -1.0), (4.0, -1.0), (4.0, 1.0), (2.0, 1.0)];
        let square = Part::Polygon { vertices: corners.iter().map(|(x, y)| Point::new(*x, *y)).collect() };
        Ground {
            solids: vec![Solid::disc(1, Point::new(-3.0, 0.0), 1.0), Solid::new(2, square)],
            wall: world::Boundary::Circle { radius_m: 10.0 },
            hull_m: 0.5,
        }
    }

    #[test]
    fn clearances_are_those_of_the_hull() {
        let ground = ground();
        assert!((ground.clearance_m(Point::new(-1.0, 0.0)) - 0.5).abs() < 1e-12);
        assert!((ground.clearance_m(Point::new(1.0, 0.0)) - 0.5).abs() < 1e-12);
        assert!(ground.is_free(Point::new(0.0, -5.0), Point::new(0.0, 5.0), 1.4));
        assert!(!ground.is_free(Point::new(0.0, -5.0), Point::new(0.0, 5.0), 1.6));
        assert!(!ground.is_free(Point::new(9.6, -1.0), Point::new(9.6, 1.0), 0.0));
    }

    #[test]
    fn what_is_sensed_takes_the_place_of_what_was_known() {
        let mut ground = ground();
        let moved = Body { id: 1, parts: vec![Solid::disc(1, Point::new(-4.0, 0.0), 1.0).part] };
        assert!(ground.learn(std::slice::from_ref(&moved)));
        assert!(!ground.learn(&[moved]));
        assert!((ground.clearance_m(Point::new(-1.0, 0.0)) - 1.5).abs() < 1e-12);
    }

    #[test]
    fn the_clearance_of_a_path_is_that_of_its_nearest_place_however_long_its_pieces() {
        let ground = ground();
        let long = [Point::new(0.0, -6.0), Point::new(0.0, 6.0), Point::new(-9.0, 3.0)];
        let fine = world::polyline::resampled(&long, 0.01);
        let truth = fine.iter().map(|p| ground.clearance_m(*p)).fold(f64::INFINITY, f64::min);
        for path in [&long[..], &fine] {
            assert!((ground.path_clearance_m(path, 5.0) - truth).abs() < 1e-3, "{truth}");
        }
        assert!(ground.path_clearance_m(&long[..2], 1.0) >= 1.0);
    }

    #[test]
    fn what_is_nearby_is_found_again_on_the_way() {
        let ground = ground();
        let mut nearby = Nearby::new(0.5);
        assert_eq!(nearby.update(&ground, Point::new(-1.6, 0.0)), [0]);
        assert_eq!(nearby.update(&ground, Point::new(0.9, 0.0)), [1]);
        assert!(!nearby.sees_wall());
    }

    #[test]
    fn the_disc_around_a_box_has_half_its_diagonal() {
        let (center, radius_m) = disc_around(&[(Point::new(0.0, 0.0), 1.0), (Point::new(4.0, 2.0), 1.0)]);
        assert!((center - Point::new(2.0, 1.0)).norm() < 1e-12);
        assert!((radius_m - 13.0_f64.sqrt()).abs() < 1e-12);
    }
}
