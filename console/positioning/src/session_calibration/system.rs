//! The normal equations of a window: one position per fix, and the errors that all fixes share.
//!
//! A position is connected to the one before and to the one after it, so the positions are eliminated one after another
//! (a block-tridiagonal system). What is left is a small system for the shared errors.

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

/// Information about a position without any range, per square metre: it keeps the equations solvable.
const LEAST_INFORMATION: f64 = 1e-6;

/// The index of a shared error: the scale, its drift, the slip of the robot, and one bias per station.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Column(usize);

impl Column {
    pub(super) const SCALE: Self = Self(0);
    pub(super) const DRIFT: Self = Self(1);
    pub(super) const SLIP: Self = Self(2);

    pub(super) const fn bias(station: usize) -> Self {
        Self(3 + station)
    }
}

/// The equations of one position.
#[derive(Debug, Clone)]
struct Block {
    information: Matrix2<f64>,
    inverse: Matrix2<f64>,
    right: Vector2<f64>,
    /// Products with the shared errors, x and y.
    shared: Vec<[f64; 2]>,
    /// Weight of the motion to the next position.
    link: f64,
}

/// The equations of a window.
#[derive(Debug)]
pub(super) struct System {
    blocks: Vec<Block>,
    shared: DMatrix<f64>,
    right: DVector<f64>,
    /// The information about each shared error that does not come from the fixes.
    known: DVector<f64>,
}

/// The sums over the ranges of a fix that eliminate a length which all of them share.
#[derive(Debug)]
pub(super) struct Common {
    weight: f64,
    residual: f64,
    by_position: Vector2<f64>,
    shared: DVector<f64>,
}

/// A solution for some of the shared errors.
#[derive(Debug)]
pub(super) struct Solved {
    pub step: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl Common {
    /// Adds a range; the arguments are those of [`System::range`].
    pub(super) fn range(
        &mut self,
        (by_position, by, bias): (Vector2<f64>, [f64; 2], Option<Column>),
        residual: f64,
        weight: f64,
    ) {
        self.weight += weight;
        self.residual += weight * residual;
        self.by_position += by_position * weight;
        let own = bias.map(|Column(column)| (column, 1.0));
        for (column, by) in [(0, by[0]), (1, by[1])].into_iter().chain(own) {
            self.shared[column] += by * weight;
        }
    }
}

impl Solved {
    pub(super) fn sigma(&self, index: usize) -> f64 {
        self.covariance[(index, index)].max(0.0).sqrt()
    }
}

impl System {
    pub(super) fn new(n_fixes: usize, n_stations: usize) -> Self {
        let Column(n) = Column::bias(n_stations);
        let block = Block {
            information: Matrix2::identity() * LEAST_INFORMATION,
            inverse: Matrix2::zeros(),
            right: Vector2::zeros(),
            shared: vec![[0.0; 2]; n],
            link: 0.0,
        };
        let (shared, right, known) = (DMatrix::zeros(n, n), DVector::zeros(n), DVector::zeros(n));
        Self { blocks: vec![block; n_fixes], shared, right, known }
    }

    /// Adds what is known about a shared error beforehand: it is near 0.
    pub(super) fn prior(&mut self, Column(column): Column, now: f64, sigma: f64) {
        self.shared[(column, column)] += sigma.powi(-2);
        self.known[column] += sigma.powi(-2);
        self.right[column] -= now * sigma.powi(-2);
    }

    /// Adds a range of a fix: its derivatives by the position, by scale and drift, and the column of its bias if it has
    /// one.
    pub(super) fn range(
        &mut self,
        fix: usize,
        (by_position, by, bias): (Vector2<f64>, [f64; 2], Option<Column>),
        residual: f64,
        weight: f64,
    ) {
        let block = &mut self.blocks[fix];
        block.information += by_position * by_position.transpose() * weight;
        block.right += by_position * (residual * weight);
        let own = bias.map(|Column(column)| (column, 1.0));
        let shared = || [(0, by[0]), (1, by[1])].into_iter().chain(own);
        for (i, a) in shared() {
            block.shared[i][0] += by_position.x * (a * weight);
            block.shared[i][1] += by_position.y * (a * weight);
            self.right[i] += a * (residual * weight);
            for (j, b) in shared() {
                self.shared[(i, j)] += a * b * weight;
            }
        }
    }

    /// The sums for a fix without any range.
    pub(super) fn common(&self) -> Common {
        let shared = DVector::zeros(self.right.len());
        Common { weight: 0.0, residual: 0.0, by_position: Vector2::zeros(), shared }
    }

    /// Eliminates an unknown length that all ranges of a fix share, such as the time of emission.
    pub(super) fn free_length(&mut self, fix: usize, common: &Common) {
        let Common { weight, residual, by_position, shared } = common;
        // The comparison also holds for a fix without a range.
        if *weight <= 0.0 {
            return;
        }
        let block = &mut self.blocks[fix];
        block.information -= by_position * by_position.transpose() / *weight;
        block.right -= by_position * (residual / weight);
        for (own, shared) in block.shared.iter_mut().zip(shared.iter()) {
            *own = [own[0] - by_position.x * shared / weight, own[1] - by_position.y * shared / weight];
        }
        self.right -= shared * (residual / weight);
        self.shared -= shared * shared.transpose() / *weight;
    }

    /// Adds the motion between a fix and the next one, by which the positions are `off`. The robot slips by a share of
    /// the measured motion.
    pub(super) fn link(&mut self, fix: usize, (moved, off): (Vector2<f64>, Vector2<f64>), weight: f64) {
        let Column(slip) = Column::SLIP;
        for (block, sign) in self.blocks[fix..=fix + 1].iter_mut().zip([1.0, -1.0]) {
            block.information += Matrix2::identity() * weight;
            block.right += off * (sign * weight);
            block.shared[slip][0] -= sign * weight * moved.x;
            block.shared[slip][1] -= sign * weight * moved.y;
        }
        self.blocks[fix].link = weight;
        self.shared[(slip, slip)] += weight * moved.norm_squared();
        self.right[slip] -= weight * moved.dot(&off);
    }

    /// Eliminates the positions.
    pub(super) fn eliminate(&mut self) {
        let n = self.right.len();
        for index in 0..self.blocks.len() {
            let block = &mut self.blocks[index];
            block.inverse = block.information.try_inverse().unwrap_or_else(Matrix2::zeros);
            let (inverse, right, link) = (block.inverse, block.right, block.link);
            let gain: Vec<Vector2<f64>> =
                block.shared.iter().map(|[x, y]| inverse * Vector2::new(*x, *y)).collect();
            for i in 0..n {
                let [x, y] = block.shared[i];
                self.right[i] -= gain[i].dot(&right);
                for (j, gain) in gain.iter().enumerate() {
                    self.shared[(i, j)] -= x * gain.x + y * gain.y;
                }
            }
            if let Some(next) = self.blocks.get_mut(index + 1) {
                next.information -= inverse * (link * link);
                next.right += inverse * right * link;
                for (shared, gain) in next.shared.iter_mut().zip(&gain) {
                    *shared = [shared[0] + link * gain.x, shared[1] + link * gain.y];
                }
            }
        }
    }

    /// Solves for some of the shared errors, while the others stay as they are.
    pub(super) fn solve(&self, columns: &[Column]) -> Option<Solved> {
        let n = columns.len();
        let information = DMatrix::from_fn(n, n, |i, j| self.shared[(columns[i].0, columns[j].0)]);
        let right = DVector::from_fn(n, |i, _| self.right[columns[i].0]);
        let covariance = information.cholesky()?.inverse();
        let step = &covariance * right;
        step.iter().all(|number| number.is_finite()).then_some(Solved { step, covariance })
    }

    /// Returns the steps of the positions that belong to a solution.
    pub(super) fn back(&self, columns: &[Column], solved: &Solved) -> Vec<Vector2<f64>> {
        let mut steps = vec![Vector2::zeros(); self.blocks.len()];
        let mut after = Vector2::zeros();
        for (block, step) in self.blocks.iter().zip(&mut steps).rev() {
            let shared: Vector2<f64> = columns
                .iter()
                .zip(solved.step.iter())
                .map(|(Column(column), value)| Vector2::from(block.shared[*column]) * *value)
                .sum();
            *step = block.inverse * (block.right - shared + after * block.link);
            after = *step;
        }
        steps
    }

    /// Correlation of two shared errors in the fixes, without what is known beforehand, 0 to 1. It is 0 if the fixes show
    /// nothing of one of them, as of the slip of a robot at rest.
    pub(super) fn correlation(&self, Column(one): Column, Column(other): Column) -> f64 {
        let own = |column: usize| self.shared[(column, column)] - self.known[column];
        let both = (own(one).max(0.0) * own(other).max(0.0)).sqrt();
        if both > 0.0 { (self.shared[(one, other)].abs() / both).min(1.0) } else { 0.0 }
    }

    /// Tests one more shared error: its value and standard deviation beside the free `columns`, and its correlation with
    /// the scale. `None` if the fixes show nothing of it.
    pub(super) fn test(&self, columns: &[Column], other: Column) -> Option<(f64, f64, f64)> {
        let n = columns.len();
        let free = DMatrix::from_fn(n, n, |i, j| self.shared[(columns[i].0, columns[j].0)]).cholesky()?;
        let both = DVector::from_fn(n, |i, _| self.shared[(columns[i].0, other.0)]);
        let right = DVector::from_fn(n, |i, _| self.right[columns[i].0]);
        let shares = free.solve(&both);
        let information = self.shared[(other.0, other.0)] - shares.dot(&both);
        let score = self.right[other.0] - shares.dot(&right);
        let (scale, own) = (self.shared[(0, 0)], self.shared[(other.0, other.0)]);
        let correlation = (self.shared[(0, other.0)].abs() / (scale * own).sqrt()).min(1.0);
        let is_known = information > 0.0 && (score / information).is_finite() && correlation.is_finite();
        is_known.then(|| (score / information, information.sqrt().recip(), correlation))
    }
}
