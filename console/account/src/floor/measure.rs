//! The values behind reasons.

use super::areas::around;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};
use world::Floor;

/// The value behind a reason: the amount, its limit, and the object concerned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measure {
    /// The distance or error, metres.
    pub value_m: f64,
    /// The largest distance, if there is a range, metres.
    #[serde(default)]
    pub to_m: Option<f64>,
    /// The limit for comparison, metres; absent if there is none.
    pub limit_m: Option<f64>,
    /// The nearest solid object, if it is the cause.
    pub near: Option<String>,
}

impl Measure {
    /// A value without a limit.
    pub(crate) fn of(value_m: f64) -> Self {
        Self { value_m, to_m: None, limit_m: None, near: None }
    }

    /// A value with a limit.
    pub(crate) fn against(self, limit_m: f64) -> Self {
        Self { limit_m: Some(limit_m), ..self }
    }

    /// The distances of some cells from solid objects, with the name of the nearest object.
    pub(crate) fn off<'a>(distances: impl Iterator<Item = (&'a str, f64)> + Clone) -> Option<Self> {
        let (name, least_m) = distances.clone().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let most_m = distances.map(|(_, m)| m.max(0.0)).fold(0.0, f64::max);
        Some(Self { to_m: Some(most_m), ..Self::of(least_m.max(0.0)).beside(name) })
    }

    /// The distance, or its range, metres.
    pub fn range(&self) -> String {
        let to_m = self.to_m.filter(|to_m| format!("{to_m:.2}") != format!("{:.2}", self.value_m));
        to_m.map_or_else(
            || format!("{:.2} m", self.value_m),
            |to_m| format!("{:.2} to {to_m:.2} m", self.value_m),
        )
    }

    /// This value with the name of an object.
    pub(crate) fn beside(self, near: &str) -> Self {
        Self { near: Some(near.to_owned()), ..self }
    }
}

/// The largest distance of some cells from the edge of the reference cells around them, metres. The distance is at
/// least one cell; `None` without reference cells.
pub(crate) fn depth_m(floor: &Floor, cells: &[usize], is_other: impl Fn(usize) -> bool) -> Option<f64> {
    // Each cell adopts the nearest reference cell of a neighbour that is closer to one. The result is almost exact, and
    // the time is linear.
    let mut nearest: BTreeMap<usize, Option<usize>> = cells.iter().map(|cell| (*cell, None)).collect();
    let distance_m = |a: usize, b: usize| (floor.center(a) - floor.center(b)).norm();
    let closest = |cell: usize, candidates: &mut dyn Iterator<Item = usize>| {
        candidates.min_by(|a, b| distance_m(cell, *a).total_cmp(&distance_m(cell, *b)))
    };
    let mut queue = VecDeque::new();
    for cell in cells {
        let found = closest(*cell, &mut around(floor, *cell).filter(|other| is_other(*other)));
        if found.is_some() {
            nearest.insert(*cell, found);
            queue.push_back(*cell);
        }
    }
    while let Some(cell) = queue.pop_front() {
        let Some(source) = nearest[&cell] else { continue };
        for next in around(floor, cell) {
            let is_nearer = |old: usize| distance_m(next, source) < distance_m(next, old) - 1e-9;
            if let Some(slot) = nearest.get_mut(&next).filter(|slot| slot.is_none_or(is_nearer)) {
                *slot = Some(source);
                queue.push_back(next);
            }
        }
    }
    let edges_m = nearest.iter().filter_map(|(cell, source)| Some(distance_m(*cell, (*source)?)));
    edges_m.reduce(f64::max)
}

/// The largest distance of some cells from the nearest reference cell, metres, wherever it is; `None` without reference
/// cells. Takes the time of cells times edge cells, so [`depth_m`] is preferred for cells beside reference cells.
pub(crate) fn apart_m(floor: &Floor, cells: &[usize], is_other: impl Fn(usize) -> bool) -> Option<f64> {
    let is_edge = |cell: &usize| is_other(*cell) && around(floor, *cell).any(|next| !is_other(next));
    let edge: Vec<usize> = (0..floor.len()).filter(is_edge).collect();
    let nearest_m = |cell: usize| {
        let distances_m = edge.iter().map(|other| (floor.center(cell) - floor.center(*other)).norm());
        distances_m.reduce(f64::min)
    };
    cells.iter().filter_map(|cell| nearest_m(*cell)).reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, Point, World};

    #[test]
    fn a_strip_is_as_deep_as_it_is_wide() {
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| Point::new(x, y));
        let boundary = Boundary::Polygon { vertices: corners.to_vec() };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        let floor = Floor::new(&world, 0.1, 0.0, 0.5, Point::new(2.0, 2.0));
        let strip = |rows: usize| -> Vec<usize> { (0..rows * floor.width).collect() };
        let depth = |rows: usize| depth_m(&floor, &strip(rows), |cell| cell >= rows * floor.width);
        assert!((depth(1).unwrap_or(0.0) - 0.1).abs() < 1e-9 && (depth(3).unwrap_or(0.0) - 0.3).abs() < 1e-9);
        assert_eq!(depth_m(&floor, &strip(2), |_| false), None);
        // A row that the reference cells do not touch.
        let row = 5 * floor.width;
        let is_other = |cell: usize| cell >= row && cell < row + floor.width;
        assert_eq!(depth_m(&floor, &strip(1), is_other), None);
        assert!((apart_m(&floor, &strip(1), is_other).unwrap_or(0.0) - 0.5).abs() < 1e-9);
        assert_eq!(apart_m(&floor, &strip(1), |_| false), None);
    }
}
