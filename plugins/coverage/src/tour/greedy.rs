//! The first tour: the cheapest pairs of neighbours are joined first. The neighbours of an end are the few ends that
//! are cheapest to reach from it.

use crate::jobs::Job;
use crate::tour::connectors::Connectors;
use crate::tour::costs::{End, ROUNDING, Tour};
use crate::tuning::tour::{LOOKED_AT, NEIGHBOURS};
use planner_api::Result;
use std::collections::HashMap;
use world::Point;

/// Approximate progress of a tour once the neighbours are listed, as a share of its time.
pub(super) const LISTED: f64 = 0.3;

/// An end and the cost of going there, metres.
#[derive(Clone, Copy)]
pub(super) struct Neighbour {
    pub end: End,
    pub cost_m: f64,
}

/// The cheapest neighbours of every end, cheapest first.
pub(super) fn neighbours(connectors: &Connectors<'_>, job: &Job) -> Result<Vec<Vec<Neighbour>>> {
    let n = connectors.len();
    let mut buckets: HashMap<(i64, i64), Vec<End>> = HashMap::new();
    for u in 0..n {
        buckets.entry(bucket(connectors.at(u))).or_default().push(u);
    }
    let list = |u: End| {
        if u.is_multiple_of(64) {
            job.check()?;
            job.reached(LISTED * u as f64 / n as f64);
        }
        Ok(cheapest(connectors, u, nearest(connectors, &buckets, u)))
    };
    (0..n).map(list).collect()
}

/// The cheapest neighbours of every end, if the ends are few enough to compare each of them with all others.
pub(super) fn neighbours_of_few(connectors: &Connectors<'_>) -> Vec<Vec<Neighbour>> {
    let list = |u: End| {
        let others = (0..connectors.len()).filter(|v| v / 2 != u / 2).collect();
        cheapest(connectors, u, nearest_of(connectors, u, others))
    };
    (0..connectors.len()).map(list).collect()
}

/// The square of one metre that contains a position.
fn bucket(at: Point) -> (i64, i64) {
    (at.x.floor() as i64, at.y.floor() as i64)
}

/// The nearest ends of other lanes, by straight-line distance.
fn nearest(connectors: &Connectors<'_>, buckets: &HashMap<(i64, i64), Vec<End>>, u: End) -> Vec<End> {
    let (x, y) = bucket(connectors.at(u));
    let mut found: Vec<End> = Vec::new();
    let mut rings = 1;
    while found.len() < LOOKED_AT.min(connectors.len() - 2) && rings < 200 {
        let around = (-rings..=rings).flat_map(|dx| (-rings..=rings).map(move |dy| (x + dx, y + dy)));
        let ends = around.filter_map(|bucket| buckets.get(&bucket)).flatten();
        found = ends.copied().filter(|v| v / 2 != u / 2).collect();
        rings += 1;
    }
    nearest_of(connectors, u, found)
}

/// The nearest of some ends, nearest first.
fn nearest_of(connectors: &Connectors<'_>, u: End, mut ends: Vec<End>) -> Vec<End> {
    ends.sort_by(|a, b| connectors.least(u, *a).total_cmp(&connectors.least(u, *b)).then(a.cmp(b)));
    ends.truncate(LOOKED_AT);
    ends
}

/// The cheapest of some ends, which are given nearest first.
fn cheapest(connectors: &Connectors<'_>, u: End, nearest: Vec<End>) -> Vec<Neighbour> {
    let mut priced: Vec<Neighbour> = Vec::with_capacity(NEIGHBOURS + 1);
    for end in nearest {
        // The remaining ends are further away than the highest cost in the list, and no path is shorter than a straight
        // line.
        let least_m = connectors.least(u, end) * (1.0 - ROUNDING);
        if priced.len() == NEIGHBOURS && priced[NEIGHBOURS - 1].cost_m < least_m {
            break;
        }
        let cost_m = connectors.cost(u, end);
        let is_before = |other: &Neighbour| other.cost_m.total_cmp(&cost_m).then(other.end.cmp(&end)).is_lt();
        priced.insert(priced.partition_point(is_before), Neighbour { end, cost_m });
        priced.truncate(NEIGHBOURS);
    }
    priced
}

/// Chains of lanes that grow together.
struct Chains {
    /// The end that each end is joined to.
    joined: Vec<Option<End>>,
    /// For every lane, another lane in its chain, or itself: a forest with one root per chain.
    above: Vec<usize>,
}

impl Chains {
    fn root(&mut self, mut lane: usize) -> usize {
        while self.above[lane] != lane {
            self.above[lane] = self.above[self.above[lane]];
            lane = self.above[lane];
        }
        lane
    }

    /// Joins two ends, unless one of them is already joined or both belong to the same chain.
    fn join(&mut self, u: End, v: End) {
        let (a, b) = (self.root(u / 2), self.root(v / 2));
        if self.joined[u].is_none() && self.joined[v].is_none() && a != b {
            self.above[a] = b;
            (self.joined[u], self.joined[v]) = (Some(v), Some(u));
        }
    }

    /// Joins the cheapest pairs first.
    fn join_all(&mut self, mut pairs: Vec<(f64, End, End)>) {
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, u, v) in pairs {
            self.join(u, v);
        }
    }

    fn loose(&self) -> Vec<End> {
        (0..self.joined.len()).filter(|u| self.joined[*u].is_none()).collect()
    }
}

/// Makes a tour from the cheapest pairs of neighbours.
pub(super) fn greedy(connectors: &Connectors<'_>, near: &[Vec<Neighbour>]) -> Tour {
    let n = connectors.len();
    let mut chains = Chains { joined: vec![None; n], above: (0..n / 2).collect() };
    let mut pairs: Vec<(f64, End, End)> = Vec::new();
    for (u, list) in near.iter().enumerate() {
        let is_fresh = |v: End| u < v || !near[v].iter().any(|back| back.end == u);
        let fresh = list.iter().filter(|to| is_fresh(to.end));
        pairs.extend(fresh.map(|to| (to.cost_m, u, to.end)));
    }
    chains.join_all(pairs);
    // A few chains are left: join the nearest loose ends.
    let mut loose = chains.loose();
    while loose.len() > 2 {
        let pairs = loose.iter().enumerate().flat_map(|(k, u)| loose[..k].iter().map(move |v| (*u, *v)));
        chains.join_all(pairs.map(|(u, v)| (connectors.least(u, v), u, v)).collect());
        loose = chains.loose();
    }
    if let [u, v] = loose[..] {
        (chains.joined[u], chains.joined[v]) = (Some(v), Some(u));
    }
    let home = n - 2;
    let mut entries = vec![home];
    let mut at = home;
    while let Some(next) = chains.joined[at ^ 1].filter(|next| next / 2 != home / 2) {
        entries.push(next);
        at = next;
    }
    entries
}
