//! The one-to-one assignment with the greatest total gain.

/// Assigns rows to columns one to one so that the sum of the gains is greatest; a row or column may stay free.
///
/// `gain(row, column)` is `None` for a pair that is not allowed; pairs without a positive gain are never made. Returns
/// the column of each row. The Hungarian method, with a column of gain 0 for each row that stays free; takes time
/// proportional to `rows² · (rows + columns)`.
pub(crate) fn assign(
    rows: usize,
    columns: usize,
    gain: impl Fn(usize, usize) -> Option<f64>,
) -> Vec<Option<usize>> {
    let width = columns + rows;
    let cost = |row: usize, column: usize| {
        if column >= columns { 0.0 } else { gain(row, column).map_or(FORBIDDEN, |gain| -gain) }
    };
    // Index 0 is a sentinel, so rows and columns count from 1.
    let (mut row_price, mut column_price) = (vec![0.0; rows + 1], vec![0.0; width + 1]);
    let mut row_of = vec![0_usize; width + 1];
    for row in 1..=rows {
        row_of[0] = row;
        let (mut least, mut seen, mut before) =
            (vec![f64::INFINITY; width + 1], vec![false; width + 1], vec![0_usize; width + 1]);
        let mut column = 0;
        while row_of[column] != 0 {
            seen[column] = true;
            let (here, mut step, mut next) = (row_of[column], f64::INFINITY, 0);
            for other in (1..=width).filter(|other| !seen[*other]) {
                let reduced = cost(here - 1, other - 1) - row_price[here] - column_price[other];
                if reduced < least[other] {
                    (least[other], before[other]) = (reduced, column);
                }
                if least[other] < step {
                    (step, next) = (least[other], other);
                }
            }
            for other in 0..=width {
                if seen[other] {
                    row_price[row_of[other]] += step;
                    column_price[other] -= step;
                } else {
                    least[other] -= step;
                }
            }
            column = next;
        }
        while column != 0 {
            row_of[column] = row_of[before[column]];
            column = before[column];
        }
    }
    let mut found = vec![None; rows];
    for column in (1..=columns).filter(|column| row_of[*column] != 0) {
        let row = row_of[column] - 1;
        found[row] = gain(row, column - 1).is_some_and(|gain| gain > 0.0).then_some(column - 1);
    }
    found
}

/// The cost of a pair that is not allowed: above any sum of gains, which are logarithms of likelihoods.
const FORBIDDEN: f64 = 1e9;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The greatest sum of gains, by trying everything.
    fn best(row: usize, rows: usize, columns: usize, used: u32, gains: &[Option<f64>]) -> f64 {
        if row == rows {
            return 0.0;
        }
        let free = best(row + 1, rows, columns, used, gains);
        let with = |column: usize| {
            let gain = gains[row * columns + column].filter(|_| used & (1 << column) == 0)?;
            Some(gain + best(row + 1, rows, columns, used | (1 << column), gains))
        };
        (0..columns).filter_map(with).fold(free, f64::max)
    }

    proptest! {
        #[test]
        fn no_assignment_has_a_greater_sum(
            (rows, columns, gains) in (1..6_usize, 1..6_usize).prop_flat_map(|(rows, columns)| {
                let gain = proptest::option::of(-3.0..8.0_f64);
                (Just(rows), Just(columns), proptest::collection::vec(gain, rows * columns))
            }),
        ) {
            let found = assign(rows, columns, |row, column| gains[row * columns + column]);
            let taken: Vec<usize> = found.iter().flatten().copied().collect();
            let mut distinct = taken.clone();
            distinct.sort_unstable();
            distinct.dedup();
            prop_assert_eq!(distinct.len(), taken.len());
            let of = |(row, column): (usize, &Option<usize>)| column.map(|column| gains[row * columns + column].unwrap());
            let sum: f64 = found.iter().enumerate().filter_map(of).sum();
            prop_assert!((sum - best(0, rows, columns, 0, &gains)).abs() < 1e-9);
        }
    }
}
