//! Local search: 2-opt and Or-opt over neighbour lists, then small kicks that are kept if they help.

use crate::jobs::Job;
use crate::tour::connectors::Connectors;
use crate::tour::costs::{End, ROUNDING, Tour};
use crate::tour::greedy::{LISTED, Neighbour};
use crate::tuning::tour::{KICK_REACH, RUN};
use planner_api::Result;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::collections::VecDeque;

/// Smallest change that counts as a gain, metres.
const LEAST_GAIN_M: f64 = 1e-6;

/// The effort of the search, and the price of turns.
#[derive(Clone, Copy)]
pub(crate) struct Effort {
    pub turn_m_per_rad: f64,
    pub kicks_per_lane: f64,
    pub seed: u64,
}

/// A tour being improved.
struct Search<'a> {
    connectors: &'a Connectors<'a>,
    near: &'a [Vec<Neighbour>],
    entries: Tour,
    /// The position of each lane in the tour.
    place: Vec<usize>,
}

/// Two ends that may be joined, their partners, and the known costs of the connectors, metres.
struct Join {
    u: End,
    pu: End,
    v: End,
    pv: End,
    /// From `u` to its partner, and from `v` to its partner.
    left_m: f64,
    opened_m: f64,
    /// From `u` to `v`.
    joined_m: f64,
}

/// A change to the tour.
struct Change {
    gain_m: f64,
    /// The ends that are now joined differently.
    touched: Vec<End>,
}

/// Improves a tour as far as the effort allows.
pub(super) fn improved(
    connectors: &Connectors<'_>,
    near: &[Vec<Neighbour>],
    entries: Tour,
    effort: &Effort,
    job: &Job,
) -> Result<Tour> {
    let n = entries.len();
    let mut search = Search { connectors, near, place: vec![0; n], entries };
    search.number(0, n);
    job.reached(LISTED);
    search.descend((0..connectors.len()).collect(), job)?;
    job.reached(0.4);
    if n < 8 {
        return Ok(search.into_tour());
    }
    let mut random = Pcg64Mcg::seed_from_u64(effort.seed);
    let kicks = (effort.kicks_per_lane * n as f64) as usize;
    for kick in 0..kicks {
        if kick % 32 == 0 {
            job.check()?;
            job.reached(0.4 + 0.6 * kick as f64 / kicks as f64);
        }
        let before = search.entries.clone();
        let Change { gain_m, touched } = search.kick(&mut random);
        if gain_m + search.descend(touched.into(), job)? < -1e-9 {
            search.entries = before;
            search.number(0, n);
        }
    }
    Ok(search.into_tour())
}

impl Search<'_> {
    fn number(&mut self, from: usize, to: usize) {
        for k in from..to {
            self.place[self.entries[k] / 2] = k;
        }
    }

    fn into_tour(mut self) -> Tour {
        let home = self.connectors.len() / 2 - 1;
        self.entries.rotate_left(self.place[home]);
        if self.entries[0] != 2 * home {
            // The same ring reversed: it leaves from the start and ends at home.
            self.entries.iter_mut().for_each(|e| *e ^= 1);
            self.entries[1..].reverse();
        }
        self.entries
    }

    fn is_exit(&self, u: End) -> bool {
        self.entries[self.place[u / 2]] != u
    }

    /// The end joined to this one.
    fn partner(&self, u: End) -> End {
        let (k, n) = (self.place[u / 2], self.entries.len());
        if self.is_exit(u) { self.entries[(k + 1) % n] } else { self.entries[(k + n - 1) % n] ^ 1 }
    }

    /// The cost of the connector after the lane at a position of the tour.
    fn cost_behind(&self, k: usize) -> f64 {
        self.connectors.cost(self.entries[k] ^ 1, self.entries[(k + 1) % self.entries.len()])
    }

    /// Improves the tour until no improvement remains near the given ends. Returns the gain, metres.
    fn descend(&mut self, mut queue: VecDeque<End>, job: &Job) -> Result<f64> {
        let mut waiting = vec![false; self.connectors.len()];
        for u in &queue {
            waiting[*u] = true;
        }
        let mut gained_m = 0.0;
        let mut rounds = 0_u32;
        while let Some(u) = queue.pop_front() {
            waiting[u] = false;
            rounds += 1;
            if rounds.is_multiple_of(256) {
                job.check()?;
            }
            if let Some(Change { gain_m, touched }) = self.improve(u) {
                gained_m += gain_m;
                for v in touched.into_iter().chain([u]) {
                    if !std::mem::replace(&mut waiting[v], true) {
                        queue.push_back(v);
                    }
                }
            }
        }
        Ok(gained_m)
    }

    /// Joins an end to the first of its neighbours that improves the tour, by either kind of move.
    fn improve(&mut self, u: End) -> Option<Change> {
        let (near, ways, pu) = (self.near, self.connectors, self.partner(u));
        let left_m = ways.cost(u, pu);
        near[u].iter().filter(|to| to.end != pu).find_map(|to| {
            let (v, pv) = (to.end, self.partner(to.end));
            let join = Join { u, pu, v, pv, left_m, opened_m: ways.cost(v, pv), joined_m: to.cost_m };
            self.reverse_between(&join).or_else(|| self.move_run(&join))
        })
    }

    /// 2-opt: joins `u` to `v`, both exits or both entries, and their partners to each other, if that is a gain.
    fn reverse_between(&mut self, join: &Join) -> Option<Change> {
        let (&Join { u, pu, v, pv, .. }, ways) = (join, self.connectors);
        if self.is_exit(u) != self.is_exit(v) {
            return None;
        }
        let most_m = join.left_m + join.opened_m - join.joined_m;
        // A lower bound for a connector's cost is known before the cost is computed.
        if most_m - ways.least(pu, pv) <= LEAST_GAIN_M {
            return None;
        }
        let gain_m = most_m - ways.cost(pu, pv);
        if gain_m <= LEAST_GAIN_M {
            return None;
        }
        let (i, j) = (self.place[u / 2].min(self.place[v / 2]), self.place[u / 2].max(self.place[v / 2]));
        if self.is_exit(u) {
            self.reverse(i + 1, j);
        } else {
            self.reverse(i, j - 1);
        }
        Some(Change { gain_m, touched: vec![u, v, pu, pv] })
    }

    /// Reverses the lanes from one position to another.
    fn reverse(&mut self, i: usize, j: usize) {
        let n = self.entries.len();
        if j + 1 - i > n / 2 + 1 {
            // Reversing the rest of the ring instead gives the same tour in fewer steps.
            let (from, count) = (j + 1, n - (j + 1 - i));
            for k in 0..count / 2 {
                self.entries.swap((from + k) % n, (from + count - 1 - k) % n);
            }
            for at in (from..from + count).map(|k| k % n) {
                self.entries[at] ^= 1;
                self.number(at, at + 1);
            }
            return;
        }
        self.entries[i..=j].reverse();
        self.entries[i..=j].iter_mut().for_each(|e| *e ^= 1);
        self.number(i, j + 1);
    }

    /// Or-opt: moves a run of lanes that ends in `u` to between `v` and its partner, if that is a gain.
    fn move_run(&mut self, join: &Join) -> Option<Change> {
        let (&Join { u, v, pv, .. }, ways) = (join, self.connectors);
        let (n, start, is_exit) = (self.entries.len(), self.place[u / 2], self.is_exit(u));
        for run in 1..=RUN.min(n.saturating_sub(3)) {
            // The run extends from `u` away from its partner.
            let far = if is_exit { (start + n + 1 - run) % n } else { (start + run - 1) % n };
            let (first, last) = if is_exit { (far, start) } else { (start, far) };
            let is_inside = |end: End| (self.place[end / 2] + n - first) % n < run;
            if is_inside(v) || is_inside(pv) {
                return None;
            }
            let tail = if is_exit { self.entries[far] } else { self.entries[far] ^ 1 };
            let (before, after) = (self.entries[(first + n - 1) % n] ^ 1, self.entries[(last + 1) % n]);
            let (before_m, behind_m) = if is_exit {
                (self.cost_behind((first + n - 1) % n), join.left_m)
            } else {
                (join.left_m, self.cost_behind(last))
            };
            let most_m = before_m + behind_m + join.opened_m - join.joined_m;
            if most_m - ways.least(tail, pv) - ways.least(before, after) <= LEAST_GAIN_M {
                continue;
            }
            let most_m = most_m - ways.cost(tail, pv);
            if most_m - ways.least(before, after) * (1.0 - ROUNDING) <= LEAST_GAIN_M {
                continue;
            }
            let gain_m = most_m - ways.cost(before, after);
            if gain_m > LEAST_GAIN_M {
                self.relink(first, run, u, v);
                return Some(Change { gain_m, touched: vec![u, v, pv, tail, before, after] });
            }
        }
        None
    }

    /// Takes a run out and reinserts it so that `u` meets `v`.
    fn relink(&mut self, first: usize, run: usize, u: End, v: End) {
        let n = self.entries.len();
        self.entries.rotate_left(first);
        let mut taken: Vec<End> = self.entries.drain(..run).collect();
        let at =
            self.entries.iter().position(|e| e / 2 == v / 2).expect("the run does not contain the position");
        let v_is_exit = self.entries[at] != v;
        // After an exit the run begins with `u`; before an entry it ends with it.
        if v_is_exit != (taken[0] == u) {
            taken.reverse();
            for entry in &mut taken {
                *entry ^= 1;
            }
        }
        let cut = if v_is_exit { at + 1 } else { at };
        self.entries.splice(cut..cut, taken);
        self.number(0, n);
    }

    /// Swaps two neighbouring runs at a random position: a double bridge that changes little.
    fn kick(&mut self, random: &mut Pcg64Mcg) -> Change {
        let n = self.entries.len();
        let reach = KICK_REACH.min(n - 3);
        let a = random.random_range(0..n - reach - 1);
        let steps = [(); 2].map(|()| 1 + random.random_range(0..reach / 2));
        let c = a + steps[0] + steps[1];
        let ends_behind = |k: usize| [self.entries[k] ^ 1, self.entries[(k + 1) % n]];
        let touched = [a, a + steps[0], c].map(ends_behind).concat();
        let cost_m = |search: &Self, middle: usize| -> f64 {
            [a, middle, c].map(|k| search.cost_behind(k)).iter().sum()
        };
        let before_m = cost_m(self, a + steps[0]);
        self.entries[a + 1..=c].rotate_left(steps[0]);
        self.number(a + 1, c + 1);
        Change { gain_m: before_m - cost_m(self, a + steps[1]), touched }
    }
}
