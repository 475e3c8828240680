//! The points of a grid: all combinations of its values, or a Latin hypercube over their ranges.

use crate::value::Value;
use rand::{SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;

/// The values of a key.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Axis {
    /// A list of values.
    List(Vec<Value>),
    /// Numbers between two ends; a range without `steps` can only be sampled.
    Range { from: f64, to: f64, steps: Option<usize>, log: bool },
}

impl Axis {
    /// The value at a given share of the axis, from 0 to 1.
    fn at(&self, share: f64) -> Value {
        match self {
            Self::List(values) => {
                values[((share * values.len() as f64) as usize).min(values.len() - 1)].clone()
            }
            Self::Range { from, to, log: false, .. } => Value::Number(rounded(from + (to - from) * share)),
            Self::Range { from, to, log: true, .. } => Value::Number(rounded(from * (to / from).powf(share))),
        }
    }

    /// All values of the axis.
    pub(crate) fn values(&self) -> Vec<Value> {
        match self {
            Self::List(values) => values.clone(),
            Self::Range { steps, .. } => {
                let steps = steps.unwrap_or(2);
                let last = steps.saturating_sub(1).max(1) as f64;
                (0..steps).map(|step| self.at(step as f64 / last)).collect()
            }
        }
    }
}

/// Rounds to six digits: more digits are of no use, and the command line that repeats a mission stays short.
fn rounded(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

/// All combinations of values; the last axis varies fastest.
pub(crate) fn product(axes: &[(String, Axis)]) -> Vec<Vec<Value>> {
    axes.iter().fold(vec![Vec::new()], |points, (_, axis)| {
        let values = axis.values();
        let with = |point: &Vec<Value>, value: &Value| [&point[..], std::slice::from_ref(value)].concat();
        points.iter().flat_map(|point| values.iter().map(move |value| with(point, value))).collect()
    })
}

/// A Latin hypercube of `count` points: each axis is cut into that many equal parts, and each part is used once. Each
/// value is the middle of its part. How the parts are combined depends only on the seed.
pub(crate) fn latin_hypercube(axes: &[(String, Axis)], samples: usize, seed: u64) -> Vec<Vec<Value>> {
    let mut chance = Pcg64Mcg::seed_from_u64(seed);
    let columns: Vec<Vec<Value>> = axes
        .iter()
        .map(|(_, axis)| {
            let mut parts: Vec<usize> = (0..samples).collect();
            parts.shuffle(&mut chance);
            parts.iter().map(|part| axis.at((*part as f64 + 0.5) / samples as f64)).collect()
        })
        .collect();
    (0..samples).map(|row| columns.iter().map(|column| column[row].clone()).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn axes() -> Vec<(String, Axis)> {
        let range = Axis::Range { from: 0.01, to: 1.0, steps: Some(3), log: true };
        let words = ["a", "b"].map(|word| Value::Word(word.into())).to_vec();
        vec![("x".into(), range), ("mode".into(), Axis::List(words))]
    }

    #[test]
    fn a_product_has_every_combination_with_the_last_axis_fastest() {
        let shown: Vec<String> =
            product(&axes()).iter().map(|point| format!("{} {}", point[0], point[1])).collect();
        assert_eq!(shown, ["0.01 a", "0.01 b", "0.1 a", "0.1 b", "1.0 a", "1.0 b"]);
        assert_eq!(product(&[]), [Vec::new()]);
    }

    proptest! {
        #[test]
        fn a_hypercube_uses_every_part_of_every_axis_once(samples in 1_usize..60, seed: u64) {
            let range = Axis::Range { from: -2.0, to: 6.0, steps: None, log: false };
            let axes = [("x".to_owned(), range.clone()), ("y".to_owned(), range)];
            let points = latin_hypercube(&axes, samples, seed);
            for axis in 0..2 {
                let part = |point: &Vec<Value>| (point[axis].number().unwrap() + 2.0) / 8.0 * samples as f64;
                let mut parts: Vec<usize> = points.iter().map(|point| part(point) as usize).collect();
                parts.sort_unstable();
                prop_assert_eq!(parts, (0..samples).collect::<Vec<_>>());
            }
        }
    }
}
