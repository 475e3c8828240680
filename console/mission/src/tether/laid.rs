//! Where the cable lies on the floor, from the path driven, the map and the length off the reel.
//!
//! A chain of short links from the anchor to the robot. A link moves only if it is pulled: the robot draws the chain behind
//! itself, each link toward the one ahead of it, and a reel that takes cable up does the same from the anchor. The length of
//! the chain is the length off the reel, so a cable without slack lies along the taut line, and one whose reel has stopped
//! lags behind a robot that moves sideways. Weight and friction do not count: they decide how hard the cable pulls, and little
//! where it lies. Nothing here is known only to a simulator.

use world::{Point, Shape, Vector, World, tether::Cable};

/// Length of a link, metres; a little more or less, so that whole links make up the length off the reel.
const LINK_M: f64 = 0.1;
/// How often the ends of the chain are drawn in one step.
const ROUNDS: usize = 20;
/// Distance for the slope of the distance to a shape, metres.
const SLOPE_M: f64 = 1e-4;
/// Length of cable next to the robot that leads away from it, in radii of the hull.
const LEADS_AWAY: f64 = 3.0;
/// Distance between the places of a way at which the chain is judged, metres.
const STEP_M: f64 = 0.05;
/// Length that a reel takes up between two looks at the chain, metres.
const TAKEN_UP_M: f64 = 0.1;
/// Change of a distance to the chain above which the robot counts as coming nearer, metres.
const NEARER_M: f64 = 0.005;
/// Distance from its line within which points are left out of it, metres.
const DRAWN_M: f64 = 0.03;

/// A chain of links on the floor.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Laid {
    /// The ends of the links, from the anchor to the robot; at least two.
    nodes: Vec<Point>,
    /// Length of each link, metres.
    link_m: f64,
    /// Whether the first node is a loose end: the rest of a torn cable, which only the robot draws.
    is_loose: bool,
}

impl Laid {
    /// Lays the chain along a taut cable.
    pub(super) fn along(taut: &Cable) -> Self {
        let mut nodes = world::polyline::resampled(&taut.taut_line(), LINK_M);
        if nodes.len() < 2 {
            nodes = vec![taut.tip(); 2];
        }
        Self { nodes, link_m: LINK_M, is_loose: false }
    }

    /// Moves the robot, with a given length off the reel, metres. A chain much longer than this has no meaning.
    pub(super) fn step(&mut self, here: Point, out_m: f64, world: &World) {
        if !self.is_loose {
            self.lengthen(out_m);
        }
        let last = self.nodes.len() - 1;
        self.nodes[last] = here;
        if self.is_loose {
            (0..last).rev().for_each(|node| self.draw(node, node + 1, world));
            return;
        }
        for _ in 0..ROUNDS {
            (1..last).rev().for_each(|node| self.draw(node, node + 1, world));
            (1..last).for_each(|node| self.draw(node, node - 1, world));
        }
    }

    /// The cable is torn, and only its last metres are still at the robot; they lie where they lay.
    pub(super) fn tear(&mut self, rest_m: f64) {
        self.is_loose = true;
        let links = (rest_m.max(0.0) / self.link_m.max(1e-3)).ceil() as usize;
        let drawn_in = self.nodes.len().saturating_sub(links.max(1) + 1);
        self.nodes.drain(..drawn_in);
    }

    /// Gives the chain a length, metres, by links beside the anchor.
    fn lengthen(&mut self, out_m: f64) {
        let links = ((out_m / LINK_M).round().clamp(1.0, 1e4)) as usize;
        self.link_m = (out_m / links as f64).max(0.0);
        while self.nodes.len() > links + 1 {
            self.nodes.remove(1);
        }
        while self.nodes.len() < links + 1 {
            let beside_anchor = self.nodes[0] + (self.nodes[1] - self.nodes[0]) * 0.5;
            self.nodes.insert(1, beside_anchor);
        }
    }

    /// Whether a hull of a given radius, metres, at the robot's place stands on a part of the chain that does not lead straight
    /// away from it. The simulated cable counts in the same way.
    pub(super) fn is_under(&self, hull_m: f64) -> bool {
        self.gap_m(hull_m) < hull_m
    }

    /// Distance from the robot's place to the nearest part of the chain that does not lead straight away from a hull of a given
    /// radius, metres; infinite if all of the chain does.
    fn gap_m(&self, hull_m: f64) -> f64 {
        let beyond = self.without_end(LEADS_AWAY * hull_m);
        if beyond.len() > 1 { world::polyline::distance_m(beyond, self.tip()) } else { f64::INFINITY }
    }

    /// Whether the robot's place comes nearer than `hull_m + spare_m` metres to a part of the chain that does not lead straight
    /// away from the hull, and nearer than it is now, when the robot drives straight on to a place; `out_m` metres stay off the
    /// reel. A robot that stands, or drives away from a near part, approaches nothing.
    pub(super) fn is_approached(
        &self,
        to: Point,
        out_m: f64,
        (hull_m, spare_m): (f64, f64),
        world: &World,
    ) -> bool {
        let near_m = (hull_m + spare_m).min(self.gap_m(hull_m) - NEARER_M);
        let mut laid = self.clone();
        world::polyline::resampled(&[self.tip(), to], STEP_M).into_iter().any(|at| {
            laid.step(at, out_m, world);
            laid.gap_m(hull_m) < near_m
        })
    }

    /// Whether a hull of a given radius, metres, that drives along a way comes onto no part of the chain; `out_m` metres stay
    /// off the reel. `at_place` judges the chain at each place as well.
    pub(super) fn is_clear_along(
        &self,
        way: &[Point],
        out_m: f64,
        hull_m: f64,
        world: &World,
        mut at_place: impl FnMut(&Self) -> bool,
    ) -> bool {
        let mut laid = self.clone();
        world::polyline::resampled(way, STEP_M).into_iter().all(|at| {
            laid.step(at, out_m, world);
            !laid.is_under(hull_m) && at_place(&laid)
        })
    }

    /// Whether a hull that stands still comes onto no part of the chain while the reel takes it up to a length, metres.
    pub(super) fn is_clear_while_taken_up(&self, to_m: f64, hull_m: f64, world: &World) -> bool {
        let mut laid = self.clone();
        let here = self.tip();
        while laid.length_m() > to_m + TAKEN_UP_M {
            laid.step(here, laid.length_m() - TAKEN_UP_M, world);
            if laid.is_under(hull_m) {
                return false;
            }
        }
        true
    }

    /// Draws a node toward another one that is more than a link away, and out of the objects in its way.
    fn draw(&mut self, node: usize, ahead: usize, world: &World) {
        let apart = self.nodes[node] - self.nodes[ahead];
        let apart_m = apart.norm();
        if apart_m > self.link_m {
            let drawn = self.nodes[ahead] + apart * (self.link_m / apart_m);
            self.nodes[node] =
                world.obstacles.iter().fold(drawn, |at, obstacle| outside(at, &obstacle.shape));
        }
    }

    /// The robot's end of the chain.
    pub(super) fn tip(&self) -> Point {
        self.nodes[self.nodes.len() - 1]
    }

    /// The length of the chain, metres.
    pub(super) fn length_m(&self) -> f64 {
        self.link_m * (self.nodes.len() - 1) as f64
    }

    /// The line of the chain from the anchor to the robot, without points that lie almost on it.
    pub(super) fn line(&self) -> Vec<Point> {
        let mut line = vec![self.nodes[0]];
        let mut from = 0;
        for to in 2..self.nodes.len() {
            let between = &self.nodes[from + 1..to];
            let ends = [self.nodes[from], self.nodes[to]];
            if between.iter().any(|at| world::polyline::distance_m(&ends, *at) > DRAWN_M) {
                from = to - 1;
                line.push(self.nodes[from]);
            }
        }
        line.push(self.nodes[self.nodes.len() - 1]);
        line
    }

    /// The part of the chain that does not lead straight away from the robot: without its last metres.
    pub(super) fn without_end(&self, end_m: f64) -> &[Point] {
        let kept = self.nodes.len().saturating_sub((end_m / self.link_m.max(1e-3)).ceil() as usize);
        &self.nodes[..kept]
    }
}

/// The nearest place outside a shape.
fn outside(at: Point, shape: &Shape) -> Point {
    let inside_m = -shape.distance_m(at);
    if inside_m <= 0.0 {
        return at;
    }
    let slope = |by: Vector| (shape.distance_m(at + by) - shape.distance_m(at - by)) / (2.0 * SLOPE_M);
    let away = Vector::new(slope(Vector::new(SLOPE_M, 0.0)), slope(Vector::new(0.0, SLOPE_M)));
    away.try_normalize(1e-9).map_or(at, |away| at + away * inside_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, Obstacle, ObstacleId, polyline};

    fn tank(columns: &[Shape]) -> World {
        let obstacle = |shape: &Shape| Obstacle {
            id: ObstacleId(1),
            name: "C".into(),
            shape: shape.clone(),
            known: true,
        };
        World {
            boundary: Boundary::Circle { radius_m: 30.0 },
            obstacles: columns.iter().map(obstacle).collect(),
            stations: Vec::new(),
            zones: Vec::new(),
        }
    }

    /// The chain and the taut cable after a path from the anchor at the origin; `out_m` gives the length off the reel for the
    /// taut length and the length so far.
    fn driven(world: &World, path: &[Point], out_m: impl Fn(f64, f64) -> f64) -> (Laid, Cable) {
        let shapes: Vec<Shape> = world.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect();
        let mut taut = Cable::new(Point::origin(), &world.boundary, &shapes).unwrap();
        let mut laid = Laid::along(&taut);
        let mut out = 0.0;
        for at in polyline::resampled(path, 0.03) {
            taut.drag_to(at);
            out = out_m(taut.length_m(), out);
            laid.step(at, out, world);
        }
        (laid, taut)
    }

    #[test]
    fn with_a_good_reel_the_chain_lies_near_the_taut_line() {
        let world = tank(&[Shape::Disc { center: Point::new(3.0, 0.0), radius_m: 0.5 }]);
        let path = [(0.0, 0.0), (2.0, 3.0), (7.0, 1.0), (6.0, -3.0), (7.0, 1.0), (4.0, 4.0)];
        let path = path.map(|(x, y)| Point::new(x, y));
        for n in 2..=path.len() {
            let (laid, taut) = driven(&world, &path[..n], |taut_m, _| taut_m);
            let (line, taut_line) = (laid.line(), taut.taut_line());
            let far_m = line.iter().map(|at| polyline::distance_m(&taut_line, *at));
            // An excess of 0.1 m already lets 7 m of cable bow by 0.5 m, and a permitted reel leaves up to 0.3 m.
            assert!(far_m.fold(0.0, f64::max) < 0.5, "{n}: {line:?} {taut_line:?}");
        }
    }

    #[test]
    fn the_rest_of_a_torn_cable_lies_where_it_lay_and_only_the_robot_draws_it() {
        let world = tank(&[]);
        let (mut laid, _) = driven(&world, &[Point::origin(), Point::new(10.0, 0.0)], |taut_m, _| taut_m);
        laid.tear(4.0);
        laid.step(Point::new(9.5, 0.5), 0.0, &world);
        let line = laid.line();
        assert!((3.9..4.2).contains(&laid.length_m()), "{}", laid.length_m());
        assert!((line[0] - Point::new(6.0, 0.0)).norm() < 0.15, "{line:?}");
        for y in 0..60 {
            laid.step(Point::new(9.5, 0.5 + 0.1 * f64::from(y)), 0.0, &world);
        }
        assert!(laid.line()[0].y > 1.5, "drawn behind the robot: {:?}", laid.line());
        laid.tear(0.0);
        assert!(laid.length_m() < 0.11);
    }

    #[test]
    fn a_hull_on_the_chain_is_seen_on_a_way_and_while_the_reel_takes_the_chain_up() {
        let world = tank(&[]);
        let out = [Point::origin(), Point::new(8.0, 0.0)];
        let (laid, _) = driven(&world, &out, |taut_m, _| taut_m);
        let clear = |way: &[(f64, f64)]| {
            let way: Vec<Point> = way.iter().map(|(x, y)| Point::new(*x, *y)).collect();
            laid.is_clear_along(&way, 8.0, 0.2, &world, |_| true)
        };
        assert!(clear(&[(8.0, 0.0), (7.5, 0.6), (3.0, 0.6)]) && !clear(&[(8.0, 0.0), (3.0, 0.0)]));
        // Around its own cable: a reel that works again draws the cable across the hull.
        let round = [(8.0, 0.0), (7.5, 0.6), (2.0, 0.6)].map(|(x, y)| Point::new(x, y));
        let mut beside = laid.clone();
        for at in polyline::resampled(&round, 0.05) {
            beside.step(at, 8.0, &world);
        }
        assert!(!beside.is_under(0.2));
        assert!(beside.is_clear_while_taken_up(2.1, 0.2, &world), "the cable comes in beside the robot");
        let mut crossed = laid;
        for at in polyline::resampled(&[round[0], round[1], Point::new(4.0, -0.05)], 0.05) {
            crossed.step(at, 8.0, &world);
        }
        assert!(!crossed.is_clear_while_taken_up(4.0, 0.2, &world));
    }

    #[test]
    fn a_part_of_the_chain_is_approached_only_by_a_robot_that_drives_toward_it() {
        let world = tank(&[]);
        // Out along the x axis and back beside it: the far part still lies there.
        let path = [(0.0, 0.0), (9.0, 0.0), (8.5, 0.6), (5.0, 0.6)].map(|(x, y)| Point::new(x, y));
        let (laid, _) = driven(&world, &path, f64::max);
        let at = laid.tip();
        let is_approached =
            |x_m: f64, y_m: f64| laid.is_approached(at + Vector::new(x_m, y_m), 9.0, (0.2, 0.1), &world);
        assert!(is_approached(0.0, -0.4) && is_approached(-0.3, -0.4), "toward it");
        assert!(!is_approached(0.0, -0.1), "not near enough");
        assert!(!is_approached(-0.4, 0.0) && !is_approached(-0.2, 0.4) && !is_approached(0.0, 0.0));
        let mut near = laid.clone();
        near.step(at + Vector::new(0.0, -0.35), 9.0, &world);
        let from = near.tip();
        let leaves = |y_m: f64| near.is_approached(from + Vector::new(0.0, y_m), 9.0, (0.2, 0.1), &world);
        assert!(!leaves(0.0) && !leaves(0.3) && leaves(-0.1), "a robot that is near may drive away");
    }

    #[test]
    fn with_a_dead_reel_the_chain_lags_behind_a_robot_that_moves_across_and_lies_behind_one_that_returns() {
        let world = tank(&[]);
        let arc =
            (0..=30).map(|deg| Point::origin() + geometry::unit_vector(f64::from(deg).to_radians()) * 10.0);
        let mut path = vec![Point::origin()];
        path.extend(arc);
        let (laid, taut) = driven(&world, &path, f64::max);
        let middle = laid.nodes[laid.nodes.len() / 2];
        assert!(middle.y < 0.5 * taut.tip().y - 0.1, "{middle:?}");
        let back = [Point::origin(), Point::new(9.0, 0.0), Point::new(8.5, 0.8), Point::new(4.0, 0.8)];
        let (laid, _) = driven(&world, &back, f64::max);
        let line = laid.line();
        assert!(polyline::distance_m(&line, Point::new(3.0, 0.0)) < 0.1, "the far part still lies there");
        assert!(polyline::distance_m(&line, Point::new(3.0, 0.8)) > 0.5, "nothing lies ahead: {line:?}");
    }
}
