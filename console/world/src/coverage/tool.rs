//! The scanning tool and the floor that it passes.

use geometry::{Point, Pose, Vector, polyline::nearest_on_segment, shape::bounds_of};
use serde::{Deserialize, Serialize};

/// What the robot scans with.
///
/// ```
/// assert_eq!(world::Tool::Bar { swath_m: 0.6 }.swath_m(), 0.6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tool {
    /// A bar across the heading, through the robot's centre, as inspection robots have.
    Bar {
        /// Its length, metres.
        swath_m: f64,
    },
    /// A disc about the robot's centre, for robots without a heading.
    Disc {
        /// Its diameter, metres.
        swath_m: f64,
    },
}

impl Tool {
    /// Width of the strip that is scanned in one pass, metres.
    ///
    /// ```
    /// assert_eq!(world::Tool::Disc { swath_m: 0.6 }.swath_m(), 0.6);
    /// ```
    pub fn swath_m(self) -> f64 {
        match self {
            Self::Bar { swath_m } | Self::Disc { swath_m } => swath_m,
        }
    }

    /// The same tool, narrower by so much on each side, metres; `None` if nothing of it is left.
    ///
    /// ```
    /// use world::Tool;
    /// assert_eq!(Tool::Bar { swath_m: 0.5 }.narrowed(0.125), Some(Tool::Bar { swath_m: 0.25 }));
    /// assert_eq!(Tool::Disc { swath_m: 0.5 }.narrowed(0.25), None);
    /// ```
    #[must_use]
    pub fn narrowed(self, by_m: f64) -> Option<Self> {
        let swath_m = self.swath_m() - 2.0 * by_m;
        (swath_m > 0.0).then_some(match self {
            Self::Bar { .. } => Self::Bar { swath_m },
            Self::Disc { .. } => Self::Disc { swath_m },
        })
    }

    /// The area that it sweeps between two poses that are close together.
    pub(super) fn passage(self, from: Pose, to: Pose) -> Passage {
        match self {
            Self::Bar { swath_m } => Passage::Bar(Swept::new(swath_m, from, to)),
            Self::Disc { swath_m } => {
                Passage::Disc { from: from.position, to: to.position, reach_m: swath_m / 2.0 }
            }
        }
    }
}

/// The area that a tool sweeps.
pub(super) enum Passage {
    Bar(Swept),
    Disc { from: Point, to: Point, reach_m: f64 },
}

impl Passage {
    /// South-west and north-east corners of the box around it.
    pub(super) fn bounds(&self) -> (Point, Point) {
        match self {
            Self::Bar(swept) => swept.bounds(),
            Self::Disc { from, to, reach_m } => {
                let reach = Vector::new(*reach_m, *reach_m);
                (from.inf(to) - reach, from.sup(to) + reach)
            }
        }
    }

    pub(super) fn contains(&self, point: Point) -> bool {
        match self {
            Self::Bar(swept) => swept.contains(point),
            Self::Disc { from, to, reach_m } => {
                (point - nearest_on_segment(*from, *to, point)).norm() <= *reach_m
            }
        }
    }
}

/// The area that a bar sweeps between two poses that are close together: two triangles for each half.
pub(super) struct Swept {
    triangles: [[Point; 3]; 4],
    /// Those with an area: corners with the edges that leave them, and the sign of their turn.
    sides: Vec<([(Point, Vector); 3], f64)>,
}

/// A point this far outside a triangle still counts, metres: neighbouring triangles leave no seam.
const SEAM_M: f64 = 1e-9;

impl Swept {
    fn new(swath_m: f64, from: Pose, to: Pose) -> Self {
        let half =
            |pose: Pose| Vector::new(-pose.heading_rad.sin(), pose.heading_rad.cos()) * (swath_m / 2.0);
        let (a, b) = (from.position, to.position);
        let (a_left, a_right, b_left, b_right) = (a + half(from), a - half(from), b + half(to), b - half(to));
        let triangles = [[a, a_left, b_left], [a, b_left, b], [a, a_right, b_right], [a, b_right, b]];
        Self { triangles, sides: triangles.iter().filter_map(sides_of).collect() }
    }

    fn bounds(&self) -> (Point, Point) {
        bounds_of(self.triangles.as_flattened())
    }

    fn contains(&self, point: Point) -> bool {
        self.sides.iter().any(|(sides, turned)| {
            sides.iter().all(|(from, along)| along.perp(&(point - from)) * turned >= -SEAM_M)
        })
    }
}

/// Corners and edges of a triangle with the sign of its turn; none for one without an area.
fn sides_of([a, b, c]: &[Point; 3]) -> Option<([(Point, Vector); 3], f64)> {
    let area = (b - a).perp(&(c - a));
    (area != 0.0).then(|| ([(*a, b - a), (*b, c - b), (*c, a - c)], area.signum()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boundary, CoverageGrid, Floor, World};

    fn grid(cell_m: f64) -> CoverageGrid {
        let boundary = Boundary::Circle { radius_m: 5.0 };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        CoverageGrid::new(Floor::new(&world, cell_m, 0.25, 0.6, Point::origin()))
    }

    fn area_m2(grid: &CoverageGrid) -> f64 {
        grid.counts().covered as f64 * grid.floor().cell_m2()
    }

    const BAR: Tool = Tool::Bar { swath_m: 0.6 };

    #[test]
    fn a_bar_scans_length_times_swath_and_nothing_before_or_behind() {
        let mut grid = grid(0.05);
        for step in 0..100 {
            let at = |k: i32| Pose::new(-2.0 + 0.04 * f64::from(k), 0.01, 0.0);
            grid.mark(BAR, at(step), at(step + 1));
        }
        assert!((area_m2(&grid) - 4.0 * 0.6).abs() < 0.02, "{}", area_m2(&grid));
    }

    #[test]
    fn a_bar_that_turns_on_the_spot_scans_a_disc() {
        let mut grid = grid(0.05);
        for step in 0..32 {
            let at = |k: i32| Pose::new(0.013, 0.007, 0.1 * f64::from(k));
            grid.mark(BAR, at(step), at(step + 1));
        }
        let disc_m2 = std::f64::consts::PI * 0.09;
        assert!((area_m2(&grid) - disc_m2).abs() < 0.02, "{} of {disc_m2}", area_m2(&grid));
    }

    #[test]
    fn lanes_one_swath_apart_leave_no_seam() {
        let mut grid = grid(0.05);
        for lane in -2..=2 {
            for step in 0..100 {
                let at = |k: i32| Pose::new(-2.0 + 0.04 * f64::from(k), 0.6 * f64::from(lane), 0.0);
                grid.mark(BAR, at(step), at(step + 1));
            }
        }
        assert!((area_m2(&grid) - 4.0 * 3.0).abs() < 1e-9, "{}", area_m2(&grid));
    }

    #[test]
    fn a_scanned_area_converges_as_the_cells_get_smaller() {
        let scanned_m2 = |cell_m: f64| {
            let mut grid = grid(cell_m);
            for step in 0..200 {
                let at = |k: i32| {
                    let angle = 0.02 * f64::from(k);
                    Pose::new(3.0 * angle.cos(), 3.0 * angle.sin(), angle + std::f64::consts::FRAC_PI_2)
                };
                grid.mark(BAR, at(step), at(step + 1));
            }
            area_m2(&grid)
        };
        let exact_m2 = 4.0 / 2.0 * (3.3_f64.powi(2) - 2.7_f64.powi(2));
        let errors = [0.2, 0.1, 0.05, 0.02].map(|cell_m| (scanned_m2(cell_m) - exact_m2).abs() / exact_m2);
        assert!(errors[3] < 0.002 && errors[2] < 0.01 && errors[1] < 0.02 && errors[0] < 0.04, "{errors:?}");
    }
}
