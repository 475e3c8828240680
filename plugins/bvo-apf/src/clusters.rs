//! Which solids leave no passage between them: the semi-closed obstacles of Xu et al. 2022.

use std::collections::BTreeSet;
use steering::{KnownMap, Solid};

/// Sets of solids that the robot cannot pass between.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Clusters {
    of: Vec<usize>,
}

impl Clusters {
    /// Joins solids whose gap is narrower than the hull and a margin on both sides; costs `n^2` once per map.
    pub fn new(map: &KnownMap, margin_m: f64) -> Self {
        let n_solids = map.solids.len();
        let passage_m = 2.0 * (map.hull_m + margin_m);
        let mut of: Vec<usize> = (0..n_solids).collect();
        for i in 0..n_solids {
            for j in i + 1..n_solids {
                let (a, b) = (&map.solids[i], &map.solids[j]);
                if a.id == b.id || gap_m(a, b, passage_m) < passage_m {
                    let (from, to) = (root(&of, i).max(root(&of, j)), root(&of, i).min(root(&of, j)));
                    of[from] = to;
                }
            }
        }
        let of = (0..n_solids).map(|index| root(&of, index)).collect();
        Self { of }
    }

    /// Every solid in the cluster of a solid.
    pub fn members(&self, index: usize) -> Vec<usize> {
        (0..self.of.len()).filter(|other| self.of[*other] == self.of[index]).collect()
    }

    /// Every solid in the clusters of the obstacles with these ids.
    pub fn closure(&self, map: &KnownMap, ids: &BTreeSet<u32>) -> Vec<usize> {
        let named = (0..self.of.len()).filter(|index| ids.contains(&map.solids[*index].id));
        let roots: BTreeSet<usize> = named.map(|index| self.of[index]).collect();
        (0..self.of.len()).filter(|index| roots.contains(&self.of[*index])).collect()
    }

    /// Whether two solids belong together.
    pub fn are_joined(&self, a: usize, b: usize) -> bool {
        self.of[a] == self.of[b]
    }
}

fn root(of: &[usize], mut index: usize) -> usize {
    while of[index] != index {
        index = of[index];
    }
    index
}

/// Gap between two outlines, metres; exact only below `enough_m`.
pub fn gap_m(a: &Solid, b: &Solid, enough_m: f64) -> f64 {
    let around_m = (a.center - b.center).norm() - a.radius_m - b.radius_m;
    let are_discs = a.corners().len() == 1 && b.corners().len() == 1;
    if are_discs || around_m >= enough_m { around_m } else { a.part.gap(&b.part).width_m }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, Point};

    #[test]
    fn discs_without_a_passage_between_them_belong_together() {
        let disc = |id: u32, x: f64| Solid::disc(id, Point::new(x, 0.0), 0.5);
        let solids = vec![disc(1, 0.0), disc(2, 5.0), disc(3, 1.5), disc(4, 2.9)];
        let map = KnownMap { solids, wall: Boundary::Circle { radius_m: 20.0 }, hull_m: 0.3 };
        let clusters = Clusters::new(&map, 0.2);
        assert_eq!(clusters.members(3), [0, 2, 3]);
        assert_eq!(clusters.members(1), [1]);
        assert_eq!(clusters.closure(&map, &BTreeSet::from([4, 2])), [0, 1, 2, 3]);
    }
}
