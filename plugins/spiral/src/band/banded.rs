//! Linear systems in which each unknown depends only on its neighbours.

use world::Vector;

/// A symmetric positive definite matrix with few diagonals; its Cholesky factor replaces it in place.
pub(super) struct Banded {
    width: usize,
    /// The elements of each row in turn, from the diagonal backwards.
    cells: Vec<f64>,
}

impl Banded {
    /// Creates a zero matrix with this many rows and this many diagonals, including the main one.
    pub(super) fn new(size: usize, width: usize) -> Self {
        Self { width, cells: vec![0.0; size * width] }
    }

    /// Adds the square of a linear combination of neighbouring unknowns.
    pub(super) fn add(&mut self, first: usize, factors: &[f64], weight: f64) {
        for (i, a) in factors.iter().enumerate() {
            for (j, b) in factors[..=i].iter().enumerate() {
                self.cells[(first + i) * self.width + i - j] += weight * a * b;
            }
        }
    }

    /// Replaces the matrix by its Cholesky factor.
    pub(super) fn factorise(&mut self) {
        let (n, width) = (self.cells.len() / self.width, self.width);
        for row in 0..n {
            for back in (0..width.min(row + 1)).rev() {
                let column = row - back;
                let mut sum = self.cells[row * width + back];
                for k in back + 1..width.min(row + 1) {
                    if k - back < width {
                        sum -= self.cells[row * width + k] * self.cells[column * width + k - back];
                    }
                }
                self.cells[row * width + back] =
                    if back == 0 { sum.max(1e-12).sqrt() } else { sum / self.cells[column * width] };
            }
        }
    }

    /// Solves for both coordinates together, in place, with the Cholesky factor.
    pub(super) fn solve(&self, values: &mut [Vector]) {
        let (n, width) = (values.len(), self.width);
        for row in 0..n {
            let mut sum = values[row];
            for back in 1..width.min(row + 1) {
                sum -= values[row - back] * self.cells[row * width + back];
            }
            values[row] = sum / self.cells[row * width];
        }
        for row in (0..n).rev() {
            let value = values[row] / self.cells[row * width];
            values[row] = value;
            for back in 1..width.min(row + 1) {
                values[row - back] -= value * self.cells[row * width + back];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solution_satisfies_the_system() {
        let rows = [
            (0, vec![1.0]),
            (1, vec![2.0]),
            (2, vec![1.5]),
            (3, vec![0.5]),
            (0, vec![1.0, -2.0, 1.0]),
            (1, vec![-1.0, 0.3, 2.0]),
        ];
        let mut matrix = Banded::new(4, 3);
        for (first, factors) in &rows {
            matrix.add(*first, factors, 1.5);
        }
        matrix.factorise();
        let right =
            [Vector::new(1.0, 0.0), Vector::new(-2.0, 1.0), Vector::new(0.5, 3.0), Vector::new(0.0, -1.0)];
        let mut solution = right.to_vec();
        matrix.solve(&mut solution);
        let mut back = [Vector::zeros(); 4];
        for (first, factors) in &rows {
            let value: Vector =
                factors.iter().enumerate().map(|(k, factor)| solution[first + k] * *factor).sum();
            for (k, factor) in factors.iter().enumerate() {
                back[first + k] += value * (factor * 1.5);
            }
        }
        assert!(back.iter().zip(&right).all(|(a, b)| (a - b).norm() < 1e-9), "{back:?}");
    }
}
