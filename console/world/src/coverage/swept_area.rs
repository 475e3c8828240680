//! Computes the area that a tool has swept, as a check on the coverage counted in cells.

use super::{
    floor_maker::FloorMaker,
    span::{Capsule, Span, crossings, polygon_span},
    tool::Tool,
};
use geometry::{
    Boundary, Point, Pose, Shape,
    convex::{Part, parts_of},
};
use nalgebra::{Isometry2, Rotation2};

/// Direction of the rows, radians from east; oblique, so that neither walls nor lanes are parallel to them.
const ASKEW_RAD: f64 = 0.345;
/// Distance between rows, metres; it is larger if a floor would otherwise have too many rows.
const ROW_M: f64 = 0.02;
/// The largest number of rows on a floor.
const MOST_ROWS: f64 = 5_000.0;
/// The accuracy to which the border of the reachable floor is found along a row, metres.
const EDGE_M: f64 = 1e-5;
/// Gap between spans in a row below which they are joined, metres.
const SEAM_M: f64 = 1e-9;

/// The area that a tool has swept, as spans of rows across a floor; it is exact along each row.
///
/// ```
/// use world::{Boundary, Pose, SweptArea, Tool};
/// let mut area = SweptArea::new(&Boundary::Circle { radius_m: 5.0 });
/// area.pass(Tool::Bar { swath_m: 0.6 }, Pose::new(-2.0, 0.0, 0.0), Pose::new(2.0, 0.0, 0.0));
/// assert!((area.swept_m2() - 2.4).abs() < 1e-3);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SweptArea {
    /// The rotation from the tank frame to the frame of the rows.
    askew: Rotation2<f64>,
    first_m: f64,
    row_m: f64,
    /// The swept spans of every row, ordered and disjoint.
    rows: Vec<Vec<Span>>,
}

impl SweptArea {
    /// Creates the floor within a wall, with nothing swept.
    ///
    /// ```
    /// use world::{Boundary, SweptArea};
    /// assert_eq!(SweptArea::new(&Boundary::Circle { radius_m: 5.0 }).swept_m2(), 0.0);
    /// ```
    pub fn new(boundary: &Boundary) -> Self {
        let askew = Rotation2::new(-ASKEW_RAD);
        let (low, high) = match boundary {
            Boundary::Circle { radius_m } => (-radius_m, *radius_m),
            Boundary::Polygon { vertices } => vertices
                .iter()
                .map(|vertex| (askew * vertex).y)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y))),
        };
        let across_m = (high - low).max(0.0);
        let row_m = ROW_M.max(across_m / MOST_ROWS);
        let count = if across_m.is_finite() { (across_m / row_m).ceil() as usize } else { 0 };
        Self { askew, first_m: low, row_m, rows: vec![Vec::new(); count] }
    }

    /// Adds the area that a tool passes over between two poses that are close together.
    ///
    /// ```
    /// use world::{Boundary, Pose, SweptArea, Tool};
    /// let mut area = SweptArea::new(&Boundary::Circle { radius_m: 5.0 });
    /// let (a, b) = (Pose::new(0.0, 0.0, 0.0), Pose::new(1.0, 0.0, 0.0));
    /// area.pass(Tool::Disc { swath_m: 0.6 }, a, b);
    /// assert!((area.swept_m2() - 0.6 - 0.09 * std::f64::consts::PI).abs() < 1e-3);
    /// ```
    pub fn pass(&mut self, tool: Tool, a: Pose, b: Pose) {
        match tool {
            Tool::Bar { swath_m } => {
                for triangle in tool_triangles(swath_m, a, b) {
                    let corners = triangle.map(|corner| self.askew * corner);
                    self.add(&corners, 0.0, |y| polygon_span(&corners, y));
                }
            }
            Tool::Disc { swath_m } => {
                let ends = [a.position, b.position].map(|end| self.askew * end);
                let capsule = Capsule::new(ends, swath_m / 2.0);
                self.add(&ends, swath_m / 2.0, |y| capsule.span(y));
            }
        }
    }

    /// Adds the swept area from another record of the same floor.
    ///
    /// ```
    /// use world::{Boundary, Pose, SweptArea, Tool};
    /// let mut area = SweptArea::new(&Boundary::Circle { radius_m: 5.0 });
    /// let mut other = area.clone();
    /// other.pass(Tool::Bar { swath_m: 0.6 }, Pose::new(-2.0, 0.0, 0.0), Pose::new(2.0, 0.0, 0.0));
    /// area.join(&other);
    /// assert_eq!(area, other);
    /// ```
    pub fn join(&mut self, other: &Self) {
        for (row, others) in self.rows.iter_mut().zip(&other.rows) {
            for span in others {
                insert(row, *span);
            }
        }
    }

    /// Returns the total swept area, including parts that are not floor, square metres.
    ///
    /// ```
    /// use world::{Boundary, SweptArea};
    /// assert_eq!(SweptArea::new(&Boundary::Circle { radius_m: 5.0 }).swept_m2(), 0.0);
    /// ```
    pub fn swept_m2(&self) -> f64 {
        self.rows.iter().flatten().map(|(from, to)| to - from).sum::<f64>() * self.row_m
    }

    /// Returns the swept share, 0 to 1, of the floor that the tool can reach within a wall, excluding the given solids;
    /// `None` if there is no such floor.
    ///
    /// ```
    /// use world::{Boundary, FloorMaker, Point, Pose, SweptArea, Tool, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary: boundary.clone(), obstacles: vec![], stations: vec![], zones: vec![] };
    /// let floor = FloorMaker::new(&tank, 0.1, 0.3, 0.6, Point::origin());
    /// let mut area = SweptArea::new(&boundary);
    /// area.pass(Tool::Bar { swath_m: 0.6 }, Pose::new(-2.0, 0.0, 0.0), Pose::new(2.0, 0.0, 0.0));
    /// let share = area.share_of(&floor, &boundary, &[]).unwrap();
    /// assert!((share - 2.4 / 78.54).abs() < 1e-3);
    /// ```
    pub fn share_of(&self, floor: &FloorMaker, boundary: &Boundary, solids: &[Shape]) -> Option<f64> {
        let turn = Isometry2::from_parts(nalgebra::Translation2::identity(), self.askew.into());
        let solids: Vec<(Span, Part)> = solids
            .iter()
            .flat_map(|solid| parts_of(&solid.transformed(&turn)))
            .map(|part| (extent(&part), part))
            .collect();
        let (mut swept_m, mut reachable_m) = (0.0, 0.0);
        for (index, row) in self.rows.iter().enumerate() {
            let y = self.height_m(index);
            let mut free = self.wall_spans(boundary, y);
            let beside = solids.iter().filter(|((low, high), _)| (*low..=*high).contains(&y));
            for span in beside.filter_map(|(_, part)| part_span(part, y)) {
                free = without(&free, span);
            }
            let reachable = self.reachable(&free, floor, y);
            reachable_m += length_m(&reachable);
            swept_m += common_m(row, &reachable);
        }
        (reachable_m > 0.0).then(|| swept_m / reachable_m)
    }

    fn height_m(&self, row: usize) -> f64 {
        self.first_m + (row as f64 + 0.5) * self.row_m
    }

    /// Adds a convex shape, given by its corners, to the rows that it crosses.
    fn add(&mut self, corners: &[Point], around_m: f64, span: impl Fn(f64) -> Option<Span>) {
        let (low, high) = corners
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.y), high.max(p.y)));
        let row = |y: f64| ((y - self.first_m) / self.row_m - 0.5).max(0.0);
        let first = row(low - around_m).ceil() as usize;
        let past = ((row(high + around_m).floor() + 1.0) as usize).min(self.rows.len());
        for index in first..past {
            if let Some(span) = span(self.height_m(index)) {
                insert(&mut self.rows[index], span);
            }
        }
    }

    /// Returns the spans of a row within the wall.
    fn wall_spans(&self, boundary: &Boundary, y: f64) -> Vec<Span> {
        match boundary {
            Boundary::Circle { radius_m } => {
                let half_m = (radius_m * radius_m - y * y).max(0.0).sqrt();
                vec![(-half_m, half_m)]
            }
            Boundary::Polygon { vertices } => {
                let corners: Vec<Point> = vertices.iter().map(|vertex| self.askew * vertex).collect();
                let mut crossed: Vec<f64> = crossings(&corners, y).collect();
                crossed.sort_by(f64::total_cmp);
                crossed.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
            }
        }
    }

    /// Returns the parts of some spans in which the tool can reach the floor.
    fn reachable(&self, spans: &[Span], floor: &FloorMaker, y: f64) -> Vec<Span> {
        let is_reached = |x: f64| floor.reaches(self.askew.inverse() * Point::new(x, y));
        let mut reachable: Vec<Span> = Vec::new();
        for (from, to) in spans {
            let count = ((to - from) / self.row_m).ceil().max(1.0);
            let at = |k: usize| from + (to - from) * (k as f64 / count);
            let (mut before_m, mut was_reached) = (*from, false);
            for k in 0..=count as usize {
                // The very end of a span lies on a wall or obstacle.
                let here_m = at(k).clamp(from + EDGE_M, (to - EDGE_M).max(from + EDGE_M));
                let now_reached = is_reached(here_m);
                let edge_m = || if k == 0 { *from } else { border_m(before_m, here_m, is_reached) };
                match (was_reached, now_reached, reachable.last_mut()) {
                    (false, true, _) => reachable.push((edge_m(), *to)),
                    (true, false, Some(last)) => last.1 = edge_m(),
                    _ => {}
                }
                (before_m, was_reached) = (here_m, now_reached);
            }
        }
        reachable
    }
}

/// Finds where the reachable floor begins or ends, in metres along a row, between two places of which exactly one is
/// reachable.
fn border_m(mut low_m: f64, mut high_m: f64, is_reached: impl Fn(f64) -> bool) -> f64 {
    let at_low = is_reached(low_m);
    while high_m - low_m > EDGE_M {
        let middle_m = f64::midpoint(low_m, high_m);
        if is_reached(middle_m) == at_low { low_m = middle_m } else { high_m = middle_m }
    }
    f64::midpoint(low_m, high_m)
}

/// Returns the four triangles that a bar sweeps between two poses that are close together.
fn tool_triangles(swath_m: f64, from: Pose, to: Pose) -> [[Point; 3]; 4] {
    let half = |pose: Pose| {
        let (sin, cos) = pose.heading_rad.sin_cos();
        nalgebra::vector![-sin, cos] * (swath_m / 2.0)
    };
    let (a, b, from, to) = (from.position, to.position, half(from), half(to));
    [[a, a + from, b + to], [a, b + to, b], [a, a - from, b - to], [a, b - to, b]]
}

/// Inserts a span into a row, and joins it with the spans that it touches.
fn insert(row: &mut Vec<Span>, (from, to): Span) {
    if to - from <= SEAM_M {
        return;
    }
    // A row has few spans, so a linear search is faster than a binary search.
    let is_before = |span: &&Span| span.1 < from - SEAM_M;
    let is_met = |span: &&Span| span.0 <= to + SEAM_M;
    let first = row.iter().take_while(is_before).count();
    let past = first + row[first..].iter().take_while(is_met).count();
    match &row[first..past] {
        [] => row.insert(first, (from, to)),
        [one] => row[first] = (one.0.min(from), one.1.max(to)),
        [one, .., last] => {
            row[first] = (one.0.min(from), last.1.max(to));
            row.drain(first + 1..past);
        }
    }
}

/// Returns the parts of some spans that another span does not cover.
fn without(spans: &[Span], (from, to): Span) -> Vec<Span> {
    let both = |(a, b): &Span| [(*a, b.min(from)), (a.max(to), *b)];
    spans.iter().flat_map(both).filter(|(a, b)| b > a).collect()
}

fn length_m(spans: &[Span]) -> f64 {
    spans.iter().map(|(from, to)| to - from).sum()
}

/// Returns the length over which the spans of two rows overlap, metres.
fn common_m(one: &[Span], other: &[Span]) -> f64 {
    let (mut common_m, mut rest) = (0.0, other);
    for (from, to) in one {
        while let [(a, b), behind @ ..] = rest {
            common_m += (b.min(*to) - a.max(*from)).max(0.0);
            if b > to {
                break;
            }
            rest = behind;
        }
    }
    common_m
}

/// Returns the lowest and highest `y` of a part.
fn extent(part: &Part) -> Span {
    let corners = part.corners().into_iter();
    corners.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (at, round_m)| {
        (low.min(at.y - round_m), high.max(at.y + round_m))
    })
}

fn part_span(part: &Part, y: f64) -> Option<Span> {
    match part {
        Part::Polygon { vertices } => polygon_span(vertices, y),
        Part::Capsule { a, b, half_width_m } => Capsule::new([*a, *b], *half_width_m).span(y),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CoverageGrid, Obstacle, ObstacleId, World};
    use std::f64::consts::{FRAC_PI_2, PI};

    const BAR: Tool = Tool::Bar { swath_m: 0.6 };

    fn column(x: f64, y: f64, radius_m: f64) -> Obstacle {
        let shape = Shape::Disc { center: Point::new(x, y), radius_m };
        Obstacle { id: ObstacleId(0), name: "column".into(), shape, known: true }
    }

    fn world(boundary: Boundary, obstacles: Vec<Obstacle>) -> World {
        World { boundary, obstacles, stations: vec![], zones: vec![] }
    }

    #[test]
    fn a_ring_and_a_turn_on_the_spot_are_as_large_as_they_are() {
        let mut ring = SweptArea::new(&Boundary::Circle { radius_m: 5.0 });
        let at = |k: u32| {
            let angle = f64::from(k) * PI / 1000.0;
            Pose::new(3.0 * angle.cos(), 3.0 * angle.sin(), angle + FRAC_PI_2)
        };
        (0..2000).for_each(|k| ring.pass(BAR, at(k), at(k + 1)));
        let exact_m2 = PI * (3.3_f64.powi(2) - 2.7_f64.powi(2));
        assert!((ring.swept_m2() / exact_m2 - 1.0).abs() < 1e-4, "{}", ring.swept_m2() / exact_m2);
        let mut disc = SweptArea::new(&Boundary::Circle { radius_m: 5.0 });
        let turned = |k: u32| Pose::new(0.3, 0.2, f64::from(k) * PI / 100.0);
        (0..100).for_each(|k| disc.pass(BAR, turned(k), turned(k + 1)));
        assert!((disc.swept_m2() / (PI * 0.09) - 1.0).abs() < 2e-3, "{}", disc.swept_m2());
    }

    #[test]
    fn a_seam_too_narrow_for_cells_is_seen() {
        let corners = [(0.0, 0.0), (6.0, 0.0), (6.0, 1.202), (0.0, 1.202)];
        let boundary = Boundary::Polygon { vertices: corners.map(|(x, y)| Point::new(x, y)).to_vec() };
        let floor = FloorMaker::new(&world(boundary.clone(), vec![]), 0.1, 0.1, 0.6, Point::new(1.0, 0.6));
        let (mut cells, mut area) =
            (CoverageGrid::new(floor.clone().into_floor()), SweptArea::new(&boundary));
        for y in [0.3, 0.902] {
            for (a, b) in [(0.0, 3.0), (3.0, 6.0)] {
                let (a, b) = (Pose::new(a, y, 0.0), Pose::new(b, y, 0.0));
                cells.mark(BAR, a, b);
                area.pass(BAR, a, b);
            }
        }
        let share = area.share_of(&floor, &boundary, &[]).unwrap();
        assert!((share - 1.2 / 1.202).abs() < 1e-4, "{share}");
        assert!((cells.fraction_reachable() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_stands_on_the_floor_is_none_of_it() {
        let boundary = Boundary::Circle { radius_m: 5.0 };
        let world = world(boundary.clone(), vec![column(1.0, 0.5, 1.2)]);
        let shapes: Vec<Shape> = world.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect();
        // Hull and clearance are small, so that everything is in reach.
        let floor = FloorMaker::new(&world, 0.05, 0.05, 0.6, Point::new(-3.0, 0.0));
        let mut area = SweptArea::new(&boundary);
        area.pass(Tool::Bar { swath_m: 12.0 }, Pose::new(-6.0, 0.0, 0.0), Pose::new(-0.5, 0.0, 0.0));
        let west_m2 = PI * 25.0 / 2.0 - (0.5 * (25.0_f64 - 0.25).sqrt() + 25.0 * 0.1_f64.asin());
        let share = area.share_of(&floor, &boundary, &shapes).unwrap();
        // The column lies east of x = -0.2.
        let expected = west_m2 / (PI * (25.0 - 1.44));
        assert!((share - expected).abs() < 2e-4, "{share} {expected}");
    }

    #[test]
    fn spans_that_touch_become_one_and_others_stay_apart() {
        let mut row = Vec::new();
        for span in [(0.0, 1.0), (2.0, 3.0), (4.0, 5.0), (1.0, 2.5), (3.5, 3.6), (9.0, 9.0)] {
            insert(&mut row, span);
        }
        assert_eq!(row, [(0.0, 3.0), (3.5, 3.6), (4.0, 5.0)]);
        assert!((common_m(&row, &[(-1.0, 0.5), (2.9, 4.5)]) - 1.2).abs() < 1e-12);
        assert_eq!(without(&row, (2.0, 4.5)), [(0.0, 2.0), (4.5, 5.0)]);
    }
}
