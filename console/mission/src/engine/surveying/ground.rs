//! The objects among which the cable lies during a survey.
//!
//! The chart and the map may show one column in several pieces, for example as two half discs seen from two sides. The
//! cable would then wrap each piece by less than the column, and the limit of the wrap would be missed. Pieces that
//! nearly touch are therefore one object here.

use geometry::{
    convex::{Part, parts_of},
    shape::{convex_hull, ring_contains},
    unit_vector,
};
use std::f64::consts::TAU;
use world::{Obstacle, ObstacleId, ObstacleMap, Point, Shape, World};

/// Maximum gap between pieces of one object, metres. The hull cannot pass through such a gap.
const GAP_M: f64 = 0.12;
/// Number of points on the outline of a disc that is joined with other pieces.
const CORNERS: u32 = 16;

/// The objects among which the cable lies.
#[derive(Clone)]
pub(in crate::engine) struct Ground {
    world: World,
    map: ObstacleMap,
}

impl Ground {
    pub(super) fn new(world: World) -> Self {
        Self { map: ObstacleMap::new(&world.boundary, &world.obstacles), world }
    }

    /// The objects of the chart together with those of the map, with pieces joined. No joined object contains any of the
    /// places where the robot has been.
    pub(super) fn of(chart: &World, mapped: &[Shape], been: &[Point]) -> Self {
        let known = chart.obstacles.iter().map(|obstacle| (Some(obstacle), &obstacle.shape));
        let all: Vec<(Option<&Obstacle>, &Shape)> =
            known.chain(mapped.iter().map(|shape| (None, shape))).collect();
        let parts: Vec<Vec<Part>> = all.iter().map(|(_, shape)| parts_of(shape)).collect();
        let joined = |group: Vec<usize>| {
            let named = group.iter().find_map(|k| all[*k].0);
            let pieces: Vec<&Shape> = group.iter().map(|k| all[*k].1).collect();
            joined(&pieces, been).into_iter().map(move |shape| (named, shape)).collect::<Vec<_>>()
        };
        let objects = groups(&parts).into_iter().flat_map(joined).enumerate();
        let obstacles = objects.map(|(n, (named, shape))| match named {
            Some(obstacle) => Obstacle { shape, ..obstacle.clone() },
            None => {
                Obstacle { id: ObstacleId(u32::MAX), name: format!("object {}", n + 1), shape, known: false }
            }
        });
        Self::new(World { obstacles: obstacles.collect(), ..chart.clone() })
    }

    pub(in crate::engine) fn world(&self) -> &World {
        &self.world
    }

    pub(in crate::engine) fn map(&self) -> &ObstacleMap {
        &self.map
    }
}

/// The groups of objects that nearly touch, by index, each in ascending order.
fn groups(parts: &[Vec<Part>]) -> Vec<Vec<usize>> {
    let touch =
        |a: usize, b: usize| parts[a].iter().any(|one| parts[b].iter().any(|other| is_near(one, other)));
    let mut left: Vec<usize> = (0..parts.len()).collect();
    let mut groups = Vec::new();
    while !left.is_empty() {
        let mut group = vec![left.remove(0)];
        let mut at = 0;
        while at < group.len() {
            let (near, far): (Vec<usize>, Vec<usize>) =
                left.into_iter().partition(|other| touch(group[at], *other));
            group.extend(near);
            left = far;
            at += 1;
        }
        group.sort_unstable();
        groups.push(group);
    }
    groups
}

fn is_near(one: &Part, other: &Part) -> bool {
    one.gap(other).width_m <= GAP_M
        || one.distance(other.middle()).0 <= 0.0
        || other.distance(one.middle()).0 <= 0.0
}

/// The pieces of one object as one convex shape; unchanged if that shape would contain a place where the robot has been.
fn joined(pieces: &[&Shape], been: &[Point]) -> Vec<Shape> {
    let apart = || pieces.iter().map(|shape| (*shape).clone()).collect();
    if pieces.len() < 2 {
        return apart();
    }
    let points: Vec<Point> = pieces.iter().flat_map(|shape| outline(shape)).collect();
    let vertices = convex_hull(&points);
    if vertices.len() < 3 || been.iter().any(|at| ring_contains(&vertices, *at)) {
        return apart();
    }
    vec![Shape::Polygon { vertices }]
}

fn outline(shape: &Shape) -> Vec<Point> {
    let around = |(center, radius_m): (Point, f64)| {
        let n = if radius_m > 0.0 { CORNERS } else { 1 };
        (0..n).map(move |k| center + unit_vector(TAU * f64::from(k) / f64::from(n)) * radius_m)
    };
    parts_of(shape).iter().flat_map(Part::corners).flat_map(around).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, tether::Cable};

    fn tank() -> World {
        let boundary = Boundary::Circle { radius_m: 6.0 };
        World { boundary, obstacles: Vec::new(), stations: Vec::new(), zones: Vec::new() }
    }

    /// The half of a disc of radius 0.5 m at the origin on one side, turned by an angle in radians.
    fn half(turn_rad: f64) -> Shape {
        let corner = |k: u32| Point::origin() + unit_vector(turn_rad + TAU * f64::from(k) / 24.0) * 0.5;
        Shape::Polygon { vertices: convex_hull(&(0..=12).map(corner).collect::<Vec<_>>()) }
    }

    #[test]
    fn a_column_in_two_pieces_is_wrapped_like_a_whole_one() {
        let ground = Ground::of(&tank(), &[half(0.0), half(0.5 * TAU)], &[]);
        let whole = Shape::Disc { center: Point::origin(), radius_m: 0.5 };
        let wrap = |shapes: &[Shape]| {
            let mut cable = Cable::new(Point::new(-4.0, 0.0), &tank().boundary, shapes).unwrap();
            cable.drag_along(
                &[(0.0, -2.0), (2.0, 0.0), (0.0, 2.0), (-2.0, 1.0)].map(|(x, y)| Point::new(x, y)),
            );
            cable.wrap_max_rad()
        };
        let shapes: Vec<Shape> = ground.world().obstacles.iter().map(|o| o.shape.clone()).collect();
        assert_eq!(shapes.len(), 1);
        let [joined, whole, apart] = [wrap(&shapes), wrap(&[whole]), wrap(&[half(0.0), half(0.5 * TAU)])];
        assert!((joined - whole).abs() < 0.1 && apart < whole - 0.3, "{joined} {whole} {apart}");
    }

    #[test]
    fn objects_apart_stay_apart_and_no_object_swallows_the_robot() {
        let disc = |x: f64| Shape::Disc { center: Point::new(x, 0.0), radius_m: 0.2 };
        let count =
            |mapped: &[Shape], been: &[Point]| Ground::of(&tank(), mapped, been).world().obstacles.len();
        assert_eq!(count(&[disc(0.0), disc(1.0)], &[]), 2);
        assert_eq!(count(&[disc(0.0), disc(0.45)], &[]), 1);
        assert_eq!(count(&[disc(0.0), disc(0.45)], &[Point::new(0.22, 0.1)]), 2);
    }
}
