//! Groups solids that leave no passage between them: the semi-closed obstacles of Xu et al. 2022.

use std::collections::BTreeSet;
use steering::{KnownMap, Solid};

/// Sets of solids; the robot cannot pass between the solids of one set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Clusters {
    of: Vec<usize>,
}

impl Clusters {
    /// Joins solids whose gap is narrower than the hull plus a margin on both sides. Costs `n^2` once per map.
    pub fn new(map: &KnownMap, margin_m: f64) -> Self {
        let mut clusters = Self { of: Vec::new() };
        clusters.take_in(map, margin_m);
        clusters
    }

    /// Joins the solids added at the end of the map since the last call. Costs the number of new solids times the
    /// number of all solids.
    pub fn take_in(&mut self, map: &KnownMap, margin_m: f64) {
        let passage_m = 2.0 * (map.hull_m + margin_m);
        for new in self.of.len()..map.solids.len() {
            self.of.push(new);
            let solid = &map.solids[new];
            for (known, other) in map.solids[..new].iter().enumerate() {
                let (a, b) = (root(&self.of, known), root(&self.of, new));
                if a != b && (solid.id == other.id || gap_m(other, solid, passage_m) < passage_m) {
                    self.of[a.max(b)] = a.min(b);
                }
            }
        }
        // The index of a root is never larger than the indices of its members.
        for index in 0..self.of.len() {
            self.of[index] = self.of[self.of[index]];
        }
    }

    /// All solids in the cluster of a solid.
    pub fn members(&self, index: usize) -> Vec<usize> {
        (0..self.of.len()).filter(|other| self.of[*other] == self.of[index]).collect()
    }

    /// All solids in the clusters of the obstacles with these ids.
    pub fn closure(&self, map: &KnownMap, ids: &BTreeSet<u32>) -> Vec<usize> {
        let named = (0..self.of.len()).filter(|index| ids.contains(&map.solids[*index].id));
        let roots: BTreeSet<usize> = named.map(|index| self.of[index]).collect();
        (0..self.of.len()).filter(|index| roots.contains(&self.of[*index])).collect()
    }

    /// Whether two solids belong to the same cluster.
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

/// The gap between two outlines, metres; exact only below `enough_m`.
pub fn gap_m(a: &Solid, b: &Solid, enough_m: f64) -> f64 {
    let around_m = (a.center - b.center).norm() - a.radius_m - b.radius_m;
    let are_discs = a.corners().len() == 1 && b.corners().len() == 1;
    if are_discs || around_m >= enough_m { around_m } else { a.part.gap(&b.part).width_m }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
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

    proptest! {
        #[test]
        fn what_is_added_later_is_joined_as_if_it_had_been_there(
            discs in prop::collection::vec((0_u32..30, -5.0..5.0_f64, -5.0..5.0_f64), 1..30),
            first in 0_usize..30,
        ) {
            let solids: Vec<Solid> =
                discs.iter().map(|(id, x, y)| Solid::disc(*id, Point::new(*x, *y), 0.3)).collect();
            let map = |solids: &[Solid]| KnownMap {
                solids: solids.to_vec(),
                wall: Boundary::Circle { radius_m: 20.0 },
                hull_m: 0.1,
            };
            let mut grown = Clusters::new(&map(&solids[..first.min(solids.len())]), 0.2);
            grown.take_in(&map(&solids), 0.2);
            prop_assert_eq!(grown, Clusters::new(&map(&solids), 0.2));
        }
    }
}
