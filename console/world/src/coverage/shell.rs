//! The critical zone along the shell, where the floor plate meets it. It is too narrow for the cells of a floor, so it is
//! recorded separately, in short stretches of the wall.

use super::tool::Tool;
use geometry::{Boundary, Point, Pose, Shape, Vector, polyline::edges, unit_vector};
use std::{collections::BTreeMap, f64::consts::TAU};

/// The length of a stretch, metres; it is longer if the wall would otherwise have too many stretches.
const SPACING_M: f64 = 0.025;
/// The largest number of stretches along a wall.
const MOST_STRETCHES: f64 = 20_000.0;
/// The number of layers into which the zone is divided, from the shell inwards.
const LAYERS: usize = 15;
/// The edge length of the squares that index the stretches, metres.
const BUCKET_M: f64 = 0.5;

/// The critical zone along the shell, and which part of it a tool has passed over.
///
/// A pass far from the wall costs two distance queries; any other pass costs one test for each nearby stretch.
///
/// ```
/// use world::{Boundary, Pose, ShellZone, Tool};
/// let mut zone = ShellZone::new(&Boundary::Circle { radius_m: 5.0 }, 0.075);
/// zone.pass(Tool::Bar { swath_m: 0.6 }, Pose::new(4.7, -0.1, 1.57), Pose::new(4.7, 0.1, 1.57));
/// assert!((zone.figures(|_| false).done_m - 0.2).abs() < 0.06);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ShellZone {
    boundary: Boundary,
    width_m: f64,
    stretches: Vec<Stretch>,
    /// The stretches in each square, by row and column from the south-west corner. Empty squares are left out, so the
    /// cost grows with the length of the shell, not with the area of the tank.
    squares: BTreeMap<(usize, usize), Vec<u32>>,
    origin: Point,
}

/// A short stretch of the wall, with the floor in front of it.
#[derive(Debug, Clone, PartialEq)]
struct Stretch {
    /// The middle of the stretch, on the wall, metres.
    at: Point,
    /// Vector inwards, one layer thick, metres.
    step: Vector,
    /// The length of the stretch, metres.
    length_m: f64,
    /// Layers that lie in the tank, one bit each.
    inside: u32,
    /// Layers that the tool has passed over, one bit each.
    passed: u32,
}

/// Figures on how much of the critical zone was scanned.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ShellFigures {
    /// Length of the shell beside free floor, metres.
    pub length_m: f64,
    /// Length along which the whole width of the zone was scanned, metres.
    pub done_m: f64,
    /// Scanned share of the zone's area, 0 to 1.
    pub scanned: f64,
    /// Distance from the shell to the scanned floor, metres: the median along the part of the shell where the zone is
    /// incomplete. Where nothing was scanned, it is the width of the zone; if the zone is complete, it is 0.
    pub gap_m: f64,
}

/// A short stretch of the shell beside free floor, and how much of the zone in front of it was scanned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShellStretch {
    /// The middle of the stretch, on the wall, metres.
    pub at: Point,
    /// Distance along the wall to the beginning of the stretch, metres: counter-clockwise from due east, or from the
    /// first corner.
    pub along_m: f64,
    /// The length of the stretch, metres.
    pub length_m: f64,
    /// Free share of the zone's width, 0 to 1.
    pub free: f64,
    /// Scanned share of the zone's width, 0 to 1.
    pub scanned: f64,
    /// Distance from the shell to the scanned floor, metres; `None` where the whole width was scanned.
    pub gap_m: Option<f64>,
}

impl ShellFigures {
    /// Returns the figures for some stretches.
    ///
    /// ```
    /// use world::{Boundary, ShellFigures, ShellZone};
    /// let zone = ShellZone::new(&Boundary::Circle { radius_m: 5.0 }, 0.075);
    /// assert_eq!(ShellFigures::of(&zone.profile(|_| false)), zone.figures(|_| false));
    /// ```
    pub fn of<'a>(stretches: impl IntoIterator<Item = &'a ShellStretch>) -> Self {
        let mut figures = Self::default();
        let (mut of_m, mut scanned_m) = (0.0, 0.0);
        let mut gaps: Vec<(f64, f64)> = Vec::new();
        for ShellStretch { length_m, free, scanned, gap_m, .. } in stretches {
            figures.length_m += length_m;
            of_m += length_m * free;
            scanned_m += length_m * scanned;
            match gap_m {
                None => figures.done_m += length_m,
                Some(gap_m) => gaps.push((*gap_m, *length_m)),
            }
        }
        figures.scanned = if of_m > 0.0 { scanned_m / of_m } else { 0.0 };
        figures.gap_m = median(gaps);
        figures
    }
}

impl ShellZone {
    /// Creates the zone of a given width, metres, along a wall; nothing in it has been scanned yet.
    ///
    /// ```
    /// use world::{Boundary, ShellZone};
    /// let zone = ShellZone::new(&Boundary::Circle { radius_m: 5.0 }, 0.075);
    /// assert!((zone.figures(|_| false).length_m - 31.416).abs() < 1e-3);
    /// ```
    pub fn new(boundary: &Boundary, width_m: f64) -> Self {
        let (origin, _) = boundary.bounds();
        let stretches = stretches(boundary, width_m);
        let mut squares: BTreeMap<(usize, usize), Vec<u32>> = BTreeMap::new();
        for (index, stretch) in (0..).zip(&stretches) {
            let square = (bucket(stretch.at.y - origin.y), bucket(stretch.at.x - origin.x));
            squares.entry(square).or_default().push(index);
        }
        Self { boundary: boundary.clone(), width_m, stretches, squares, origin }
    }

    /// Whether a shape may reach into the zone; a quick test that may also return true for a nearby shape.
    ///
    /// ```
    /// use world::{Boundary, ShellZone};
    /// let zone = ShellZone::new(&Boundary::Circle { radius_m: 5.0 }, 0.075);
    /// let column = |x| world::Shape::Disc { center: world::Point::new(x, 0.0), radius_m: 0.5 };
    /// assert!(zone.is_beside(&column(4.5)) && !zone.is_beside(&column(3.0)));
    /// ```
    pub fn is_beside(&self, shape: &Shape) -> bool {
        let (low, high) = shape.bounds();
        let reach_m = (high - low).norm() / 2.0 + self.width_m;
        self.boundary.wall_distance_m(nalgebra::center(&low, &high)) <= reach_m
    }

    /// Marks the parts that a tool passes over between two poses that are close together.
    ///
    /// ```
    /// use world::{Boundary, Pose, ShellZone, Tool};
    /// let mut zone = ShellZone::new(&Boundary::Circle { radius_m: 5.0 }, 0.075);
    /// zone.pass(Tool::Bar { swath_m: 0.6 }, Pose::new(4.7, 0.0, 1.57), Pose::new(4.7, 0.2, 1.57));
    /// assert!(zone.figures(|_| false).scanned > 0.0);
    /// ```
    pub fn pass(&mut self, tool: Tool, a: Pose, b: Pose) {
        let reach_m = tool.swath_m() / 2.0 + self.width_m;
        let wall_m = |pose: Pose| self.boundary.wall_distance_m(pose.position);
        if wall_m(a).min(wall_m(b)) > reach_m + (b.position - a.position).norm() {
            return;
        }
        let passage = tool.passage(a, b);
        let (low, high) = passage.bounds();
        let margin = Vector::new(self.width_m, self.width_m);
        let (first, last) = (low - margin - self.origin, high + margin - self.origin);
        let (west, east) = (bucket(first.x), bucket(last.x));
        let north = self.squares.last_key_value().map_or(0, |((row, _), _)| *row);
        for row in bucket(first.y)..=bucket(last.y).min(north) {
            for index in self.squares.range((row, west)..=(row, east)).flat_map(|(_, stretches)| stretches) {
                let stretch = &mut self.stretches[*index as usize];
                let passed = |layer: &usize| passage.contains(stretch.in_layer(*layer));
                stretch.passed |= (0..LAYERS).filter(passed).fold(0, |bits, layer| bits | 1 << layer);
            }
        }
    }

    /// Adds the passes from another record of the same zone.
    ///
    /// ```
    /// use world::{Boundary, Pose, ShellZone, Tool};
    /// let mut zone = ShellZone::new(&Boundary::Circle { radius_m: 5.0 }, 0.075);
    /// let mut other = zone.clone();
    /// other.pass(Tool::Bar { swath_m: 0.6 }, Pose::new(4.7, 0.0, 1.57), Pose::new(4.7, 0.2, 1.57));
    /// zone.join(&other);
    /// assert_eq!(zone, other);
    /// ```
    pub fn join(&mut self, other: &Self) {
        for (own, other) in self.stretches.iter_mut().zip(&other.stretches) {
            own.passed |= other.passed;
        }
    }

    /// Returns how much of the zone was scanned, ignoring points for which `is_solid` is true.
    ///
    /// ```
    /// use world::{Boundary, ShellZone};
    /// let zone = ShellZone::new(&Boundary::Circle { radius_m: 5.0 }, 0.075);
    /// let half = zone.figures(|point| point.y < 0.0);
    /// assert!((half.length_m - 15.71).abs() < 0.1 && half.gap_m == 0.075);
    /// ```
    pub fn figures(&self, is_solid: impl Fn(Point) -> bool) -> ShellFigures {
        ShellFigures::of(&self.profile(is_solid))
    }

    /// Returns the stretches beside free floor, in their order along the wall, ignoring points for which `is_solid` is
    /// true.
    ///
    /// ```
    /// use world::{Boundary, ShellZone};
    /// let zone = ShellZone::new(&Boundary::Circle { radius_m: 5.0 }, 0.075);
    /// assert!(zone.profile(|_| false).iter().all(|stretch| stretch.gap_m == Some(0.075)));
    /// ```
    pub fn profile(&self, is_solid: impl Fn(Point) -> bool) -> Vec<ShellStretch> {
        let mut along_m = 0.0;
        let profiled = self.stretches.iter().filter_map(|stretch| {
            let from_m = along_m;
            along_m += stretch.length_m;
            let is_free =
                |layer: &usize| stretch.inside & 1 << layer != 0 && !is_solid(stretch.in_layer(*layer));
            let free = (0..LAYERS).filter(is_free).fold(0_u32, |bits, layer| bits | 1 << layer);
            let passed = stretch.passed & free;
            let share = |bits: u32| f64::from(bits.count_ones()) / LAYERS as f64;
            let gap = || f64::from(passed.trailing_zeros().min(LAYERS as u32)) / LAYERS as f64 * self.width_m;
            (free != 0).then(|| ShellStretch {
                at: stretch.at,
                along_m: from_m,
                length_m: stretch.length_m,
                free: share(free),
                scanned: share(passed),
                gap_m: (passed != free).then(gap),
            })
        });
        profiled.collect()
    }
}

impl Stretch {
    /// Returns the middle of a layer; the first layer lies along the shell.
    fn in_layer(&self, layer: usize) -> Point {
        self.at + self.step * (layer as f64 + 0.5)
    }
}

/// Returns the column or row of the square at a given distance from the edge of the first square.
fn bucket(offset_m: f64) -> usize {
    (offset_m / BUCKET_M).max(0.0) as usize
}

fn stretches(boundary: &Boundary, width_m: f64) -> Vec<Stretch> {
    let stretch = |at: Point, inward: Vector, length_m: f64| {
        let step = inward * (width_m / LAYERS as f64);
        let mut stretch = Stretch { at, step, length_m, inside: 0, passed: 0 };
        let is_inside = |layer: &usize| boundary.contains(stretch.in_layer(*layer));
        stretch.inside = (0..LAYERS).filter(is_inside).fold(0, |bits, layer| bits | 1 << layer);
        stretch
    };
    match boundary {
        Boundary::Circle { radius_m } => {
            let length_m = TAU * radius_m;
            let count = (length_m / SPACING_M).min(MOST_STRETCHES).ceil().max(1.0);
            let outward = |k: usize| unit_vector(TAU * (k as f64 + 0.5) / count);
            let at = |k| Point::from(outward(k) * *radius_m);
            (0..count as usize).map(|k| stretch(at(k), -outward(k), length_m / count)).collect()
        }
        Boundary::Polygon { vertices } => {
            let length_m: f64 = edges(vertices).map(|(a, b)| (b - a).norm()).sum();
            let spacing_m = SPACING_M.max(length_m / MOST_STRETCHES);
            let along = |(a, b): (Point, Point)| {
                let side_m = (b - a).norm();
                let (count, way) = ((side_m / spacing_m).ceil(), b - a);
                let inward = Vector::new(-way.y, way.x) / side_m.max(f64::MIN_POSITIVE);
                (0..count as usize)
                    .map(move |k| (a + way * ((k as f64 + 0.5) / count), inward, side_m / count))
            };
            edges(vertices)
                .flat_map(along)
                .map(|(at, inward, length_m)| stretch(at, inward, length_m))
                .collect()
        }
    }
}

/// Returns the weighted median of values, each with its weight; 0 without values.
fn median(mut values: Vec<(f64, f64)>) -> f64 {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = values.iter().map(|(_, weight)| weight).sum::<f64>() / 2.0;
    let mut before = 0.0;
    let middle = values.iter().find(|(_, weight)| {
        before += weight;
        before >= half
    });
    middle.map_or(0.0, |(value, _)| *value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    const BAR: Tool = Tool::Bar { swath_m: 0.6 };

    /// Drives once around a tank of 5 m, with the robot's centre at `distance_m` from the wall.
    fn round(distance_m: f64, share: f64) -> ShellZone {
        let mut zone = ShellZone::new(&Boundary::Circle { radius_m: 5.0 }, 0.075);
        let radius_m = 5.0 - distance_m;
        let pose = |k: i32| {
            let angle = share * TAU * f64::from(k) / 2000.0;
            Pose::new(radius_m * angle.cos(), radius_m * angle.sin(), angle + FRAC_PI_2)
        };
        (0..2000).for_each(|k| zone.pass(BAR, pose(k), pose(k + 1)));
        zone
    }

    fn near(value: f64, expected: f64, by: f64) -> bool {
        (value - expected).abs() <= by
    }

    #[test]
    fn a_tool_that_touches_the_shell_all_round_does_the_zone() {
        let figures = round(0.3, 1.0).figures(|_| false);
        assert!(near(figures.length_m, TAU * 5.0, 1e-9) && near(figures.done_m, figures.length_m, 1e-9));
        assert!(near(figures.scanned, 1.0, 1e-12) && near(figures.gap_m, 0.0, 1e-12), "{figures:?}");
    }

    #[test]
    fn a_tool_that_ends_before_the_shell_says_by_how_much() {
        let figures = round(0.32, 1.0).figures(|_| false);
        assert!(near(figures.done_m, 0.0, 1e-9) && near(figures.gap_m, 0.02, 1e-9), "{figures:?}");
        assert!(near(figures.scanned, 55.0 / 75.0, 0.01), "{figures:?}");
        assert!(near(round(0.5, 1.0).figures(|_| false).gap_m, 0.075, 1e-9));
    }

    #[test]
    fn half_way_round_is_half_the_length_and_two_halves_are_all_of_it() {
        let mut half = round(0.3, 0.5);
        let figures = half.figures(|_| false);
        assert!(near(figures.done_m / figures.length_m, 0.5, 0.003), "{figures:?}");
        half.join(&round(0.3, -0.5));
        let figures = half.figures(|_| false);
        assert!(near(figures.done_m, figures.length_m, 1e-9));
    }

    #[test]
    fn what_something_stands_on_is_no_zone() {
        let figures = round(0.3, 0.5).figures(|point| point.y < 0.0);
        assert!(near(figures.length_m, 5.0 * FRAC_PI_2 * 2.0, 0.03) && near(figures.scanned, 1.0, 0.01));
    }

    #[test]
    fn the_cost_of_a_huge_tank_grows_with_its_shell_and_not_with_its_area() {
        let radius_m = 1e5;
        let mut zone = ShellZone::new(&Boundary::Circle { radius_m }, 0.075);
        assert!(zone.squares.len() <= zone.stretches.len());
        let (stretch_m, east_m) = (zone.stretches[0].length_m, radius_m - 0.3);
        zone.pass(BAR, Pose::new(east_m, 0.0, FRAC_PI_2), Pose::new(east_m, stretch_m, FRAC_PI_2));
        let figures = zone.figures(|_| false);
        assert!(figures.scanned > 0.0 && near(figures.length_m, TAU * radius_m, 1e-3), "{figures:?}");
    }

    #[test]
    fn straight_walls_have_a_zone_too_and_corners_are_in_it_once() {
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)];
        let vertices = corners.map(|(x, y)| Point::new(x, y)).to_vec();
        let mut zone = ShellZone::new(&Boundary::Polygon { vertices }, 0.075);
        zone.pass(BAR, Pose::new(0.0, 0.3, 0.0), Pose::new(4.0, 0.3, 0.0));
        let figures = zone.figures(|_| false);
        assert!(near(figures.length_m, 12.0, 1e-9));
        // The south wall, and 0.6 m of the walls beside it.
        assert!(near(figures.done_m, 5.2, 0.06), "{figures:?}");
    }
}
