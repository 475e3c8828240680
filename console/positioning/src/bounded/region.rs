//! The overlap of annuli: mean and covariance of the possible positions.

use nalgebra::Matrix2;
use world::{Point, Vector};

/// The number of cell centres in the region that is sufficient; until then, cells are subdivided.
const ENOUGH: usize = 128;
/// The number of cells at which subdivision stops: the region is then narrower than the cells.
const MOST_CELLS: usize = 4096;
/// The cell size, metres, at which subdivision stops.
const SMALLEST_M: f64 = 1e-7;

/// The distances from a station that its ranges allow.
#[derive(Debug, Clone, Copy)]
pub(super) struct Annulus {
    pub at: Point,
    pub inner_m: f64,
    pub outer_m: f64,
    pub repetitions: i32,
}

impl Annulus {
    pub(super) fn middle_m(&self) -> f64 {
        f64::midpoint(self.inner_m, self.outer_m)
    }

    pub(super) fn width_m(&self) -> f64 {
        self.outer_m - self.inner_m
    }

    /// Whether the annulus contains any position in a cell.
    fn reaches(&self, cell: &Cell) -> bool {
        let away = (cell.middle - self.at).abs();
        let (nearest, farthest) = ((away - cell.half).sup(&Vector::zeros()), away + cell.half);
        nearest.norm() <= self.outer_m && farthest.norm() >= self.inner_m
    }
}

/// The possible positions, as a distribution.
#[derive(Debug, Clone, Copy)]
pub(super) struct Region {
    pub mean: Point,
    pub covariance: Matrix2<f64>,
}

impl Region {
    /// Returns the overlap of the annuli; `None` if it is empty. If there are two pieces, around a place and its
    /// mirror image, only the first one counts.
    ///
    /// A box that contains the whole region is divided into smaller and smaller cells. Cells that lie outside an
    /// annulus are dropped, so no part of the region is lost, whatever its shape (set inversion, Jaulin and Walter
    /// 1993).
    pub(super) fn of(annuli: &[Annulus], sides: Option<(Point, Point)>) -> Option<Self> {
        // A region that extends across the line between the two sides is one piece.
        let sides = sides.filter(|(near, mirror)| weight_at(annuli, nalgebra::center(near, mirror)) == 0.0);
        let is_meant = |cell: &Cell| {
            sides.is_none_or(|(near, mirror)| {
                (cell.middle - near).norm() - (cell.middle - mirror).norm() <= 2.0 * cell.half.norm()
            })
        };
        let mut cells = vec![Cell::around(annuli)?];
        loop {
            cells = cells.iter().flat_map(Cell::quarters).collect();
            cells.retain(|cell| is_meant(cell) && annuli.iter().all(|annulus| annulus.reaches(cell)));
            let half = cells.first()?.half;
            let weights: Vec<f64> = cells.iter().map(|cell| weight_at(annuli, cell.middle)).collect();
            let within = weights.iter().filter(|weight| **weight > 0.0).count();
            if within >= ENOUGH || cells.len() >= MOST_CELLS || half.max() < SMALLEST_M {
                // If no centre is in the region, the region may be anywhere in the cells.
                let even = if within == 0 { 1.0 } else { 0.0 };
                return Self::summed(cells.iter().zip(weights.iter().map(|weight| weight + even)));
            }
        }
    }

    /// Returns the weighted mean and covariance of cells of equal size.
    fn summed<'a>(cells: impl Iterator<Item = (&'a Cell, f64)>) -> Option<Self> {
        let mut cells = cells.peekable();
        let Cell { middle, half } = *cells.peek()?.0;
        let (mut mass, mut first, mut second) = (0.0, Vector::zeros(), Matrix2::zeros());
        for (cell, weight) in cells {
            let offset = cell.middle - middle;
            mass += weight;
            first += offset * weight;
            second += offset * offset.transpose() * weight;
        }
        let mean = first / mass;
        // Within its cell, the position is uniformly distributed.
        let within = Matrix2::from_diagonal(&half.map(|half| half * half / 3.0));
        let region =
            Self { mean: middle + mean, covariance: second / mass - mean * mean.transpose() + within };
        let is_sound = region.mean.iter().chain(region.covariance.iter()).all(|n| n.is_finite());
        is_sound.then_some(region)
    }
}

/// An axis-aligned rectangle.
#[derive(Debug, Clone, Copy)]
struct Cell {
    middle: Point,
    half: Vector,
}

impl Cell {
    /// Returns a cell that contains the overlap of all annuli.
    fn around(annuli: &[Annulus]) -> Option<Self> {
        let corner = |sign: f64| annuli.iter().map(move |a| a.at + Vector::repeat(sign * a.outer_m));
        let low = corner(-1.0).reduce(|a, b| a.sup(&b))?;
        let high = corner(1.0).reduce(|a, b| a.inf(&b))?;
        let half = (high - low) / 2.0;
        (half.min() > 0.0).then(|| Self { middle: low + half, half })
    }

    fn quarters(&self) -> [Self; 4] {
        let half = self.half / 2.0;
        let quarter =
            |x: f64, y: f64| Self { middle: self.middle + half.component_mul(&Vector::new(x, y)), half };
        [quarter(-1.0, -1.0), quarter(1.0, -1.0), quarter(-1.0, 1.0), quarter(1.0, 1.0)]
    }
}

/// Returns the likelihood of a position up to a factor near 1; 0 outside any annulus.
pub(super) fn weight_at(annuli: &[Annulus], position: Point) -> f64 {
    let mut weight = 1.0;
    for annulus in annuli {
        let distance_m = (position - annulus.at).norm();
        if !(annulus.inner_m..=annulus.outer_m).contains(&distance_m) {
            return 0.0;
        }
        weight *= (annulus.inner_m / distance_m).powi(annulus.repetitions);
    }
    weight
}
