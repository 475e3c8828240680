//! The order of the lanes: a closed tour from home over every lane, either way round, by local search.
//!
//! Ways between lanes are shortest paths of the slit domain, worked out when first asked for; turns cost as well as
//! metres. Greedy joining first, then 2-opt and Or-opt over neighbour lists, then small kicks that are kept when they
//! help. Any order is safe for the tether; only length and turns depend on it.

use crate::{lanes::Lane, side_by_side::Stop, slit::Slit};
use planner_api::Result;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::{cell::RefCell, collections::HashMap};
use world::{Point, Vector};

mod costs;
pub use costs::Costs;

/// Nearest ends whose way is worked out for the lists.
const LOOKED_AT: usize = 18;
/// Ends in a neighbour list.
const NEIGHBOURS: usize = 8;
/// Longest run of lanes that is moved as one.
const RUN: usize = 3;
/// Share of a cost that rounding may take away.
const ROUNDING: f64 = 1e-6;

/// How far a tour is when the lists of neighbours are made, and when the first tour is as good as it gets, as shares of its time,
/// about.
const LISTED: f64 = 0.3;
const DESCENDED: f64 = 0.4;

/// How hard to try, and what turns cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Price of turning, metres per radian.
    pub turn_m_per_rad: f64,
    /// Kicks per lane.
    pub kicks_per_lane: f64,
    /// Start of the random choices.
    pub seed: u64,
}

/// Ends of lanes: `2 * lane` is its first point, `2 * lane + 1` its last; behind the last lane come home, where the tour
/// ends, and the start.
pub type End = usize;

/// Costs of the ways between ends.
pub struct Ways<'a> {
    slit: &'a Slit,
    at: Vec<Point>,
    triangle: Vec<Option<usize>>,
    out: Vec<Option<Vector>>,
    turn_m_per_rad: f64,
    costs: RefCell<Costs>,
}

impl<'a> Ways<'a> {
    /// Ways between the ends of some lanes, home and start; what is known of them may come from ways between the first of
    /// these lanes, home and start.
    pub fn new(
        slit: &'a Slit,
        lanes: &[Lane],
        (home, start): (Point, Point),
        turn_m_per_rad: f64,
        known: Costs,
    ) -> Self {
        let (mut at, mut out) = (Vec::new(), Vec::new());
        for lane in lanes {
            let (p, n) = (&lane.points, lane.points.len());
            at.extend([p[0], p[n - 1]]);
            out.extend([(p[0] - p[1]).try_normalize(1e-9), (p[n - 1] - p[n - 2]).try_normalize(1e-9)]);
        }
        at.extend([home, start]);
        out.extend([None, None]);
        let triangle = at.iter().map(|p| slit.locate(*p)).collect();
        let costs = RefCell::new(known.with_ends(at.len()));
        Self { slit, at, triangle, out, turn_m_per_rad, costs }
    }

    /// What is known by now.
    pub fn into_costs(self) -> Costs {
        self.costs.into_inner()
    }

    fn len(&self) -> usize {
        self.at.len()
    }

    /// The way from one end to another.
    pub fn path(&self, u: End, v: End) -> Vec<Point> {
        let ends = (self.at[u], self.at[v]);
        match (self.triangle[u], self.triangle[v]) {
            (Some(from), Some(to)) => self.slit.path_between((ends.0, from), (ends.1, to)),
            _ => vec![ends.0, ends.1],
        }
    }

    /// No way is cheaper than this.
    fn least(&self, u: End, v: End) -> f64 {
        (self.at[u] - self.at[v]).norm()
    }

    /// What leaving a lane at `u` and entering another at `v` costs; the same in both directions.
    pub fn cost(&self, u: End, v: End) -> f64 {
        let (u, v) = (u.min(v), u.max(v));
        let known = self.costs.borrow().get(u, v);
        f64::from(known.unwrap_or_else(|| {
            let cost = self.worked_out(u, v) as f32;
            self.costs.borrow_mut().set(u, v, cost);
            cost
        }))
    }

    fn worked_out(&self, u: End, v: End) -> f64 {
        let path = self.path(u, v);
        let mut length_m = 0.0;
        let mut turn_rad = 0.0;
        let mut before = self.out[u];
        let legs = path.windows(2).map(|w| w[1] - w[0]);
        for leg in legs {
            length_m += leg.norm();
            let Some(ahead) = leg.try_normalize(1e-6) else { continue };
            turn_rad += before.map_or(0.0, |before| angle_rad(before, ahead));
            before = Some(ahead);
        }
        if let (Some(before), Some(out)) = (before, self.out[v]) {
            turn_rad += angle_rad(before, -out);
        }
        length_m + self.turn_m_per_rad * turn_rad
    }
}

/// Angle between two unit vectors, radians.
pub fn angle_rad(a: Vector, b: Vector) -> f64 {
    a.perp(&b).atan2(a.dot(&b)).abs()
}

/// A tour: the end at which each lane is entered, home first.
pub type Tour = Vec<End>;

/// Finds a good tour.
///
/// # Errors
/// When the console wants an end.
pub fn tour(ways: &Ways<'_>, effort: &Effort, stop: &Stop) -> Result<Tour> {
    let near = neighbours(ways, stop)?;
    let entries = greedy(ways, &near);
    improved(ways, &near, entries, effort, stop)
}

fn neighbours(ways: &Ways<'_>, stop: &Stop) -> Result<Vec<Vec<End>>> {
    let n = ways.len();
    let cell_m = 1.0;
    let key = |p: Point| ((p.x / cell_m).floor() as i64, (p.y / cell_m).floor() as i64);
    let mut cells: HashMap<(i64, i64), Vec<End>> = HashMap::new();
    for u in 0..n {
        cells.entry(key(ways.at[u])).or_default().push(u);
    }
    let mut all = Vec::with_capacity(n);
    for u in 0..n {
        if u % 64 == 0 {
            stop.check()?;
            stop.reached(LISTED * u as f64 / n as f64);
        }
        let (x, y) = key(ways.at[u]);
        let mut found: Vec<End> = Vec::new();
        let mut ring = 1;
        while found.len() < LOOKED_AT.min(n - 2) && ring < 200 {
            found.clear();
            for dx in -ring..=ring {
                for dy in -ring..=ring {
                    found.extend(
                        cells.get(&(x + dx, y + dy)).into_iter().flatten().filter(|v| **v / 2 != u / 2),
                    );
                }
            }
            ring += 1;
        }
        found.sort_by(|a, b| ways.least(u, *a).total_cmp(&ways.least(u, *b)).then(a.cmp(b)));
        found.truncate(LOOKED_AT);
        let mut priced: Vec<(f64, End)> = Vec::with_capacity(NEIGHBOURS + 1);
        for v in found {
            // The rest are further away than the last in the list, and no way is shorter than the straight one.
            if priced.len() == NEIGHBOURS && priced[NEIGHBOURS - 1].0 < ways.least(u, v) * (1.0 - ROUNDING) {
                break;
            }
            let cost = ways.cost(u, v);
            let is_before = |other: &(f64, End)| other.0.total_cmp(&cost).then(other.1.cmp(&v)).is_lt();
            priced.insert(priced.partition_point(is_before), (cost, v));
            priced.truncate(NEIGHBOURS);
        }
        all.push(priced.into_iter().map(|(_, v)| v).collect());
    }
    Ok(all)
}

/// The chain that a lane belongs to.
fn root(chain: &mut [usize], mut k: usize) -> usize {
    while chain[k] != k {
        chain[k] = chain[chain[k]];
        k = chain[k];
    }
    k
}

/// Joins the cheapest pairs of ends first.
fn greedy(ways: &Ways<'_>, near: &[Vec<End>]) -> Tour {
    let n = ways.len();
    let mut pairs: Vec<(f64, End, End)> = Vec::new();
    for (u, list) in near.iter().enumerate() {
        pairs.extend(
            list.iter().filter(|v| u < **v || !near[**v].contains(&u)).map(|v| (ways.cost(u, *v), u, *v)),
        );
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut joined: Vec<Option<End>> = vec![None; n];
    let mut chain: Vec<usize> = (0..n / 2).collect();
    let mut join = |u: End, v: End, joined: &mut Vec<Option<End>>| {
        let (a, b) = (root(&mut chain, u / 2), root(&mut chain, v / 2));
        if joined[u].is_none() && joined[v].is_none() && a != b {
            chain[a] = b;
            (joined[u], joined[v]) = (Some(v), Some(u));
            return true;
        }
        false
    };
    for (_, u, v) in pairs {
        join(u, v, &mut joined);
    }
    // What is left are a few chains: join the nearest loose ends.
    loop {
        let loose: Vec<End> = (0..n).filter(|u| joined[*u].is_none()).collect();
        if loose.len() <= 2 {
            break;
        }
        let mut best: Vec<(f64, End, End)> = Vec::new();
        for (k, u) in loose.iter().enumerate() {
            best.extend(loose[..k].iter().map(|v| (ways.least(*u, *v), *u, *v)));
        }
        best.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, u, v) in best {
            join(u, v, &mut joined);
        }
    }
    if let [u, v] = (0..n).filter(|u| joined[*u].is_none()).collect::<Vec<_>>()[..] {
        (joined[u], joined[v]) = (Some(v), Some(u));
    }
    let home = n - 2;
    let mut entries = vec![home];
    let mut at = home;
    while let Some(next) = joined[at ^ 1].filter(|next| next / 2 != home / 2) {
        entries.push(next);
        at = next;
    }
    entries
}

/// A tour under improvement.
struct Search<'a> {
    ways: &'a Ways<'a>,
    near: &'a [Vec<End>],
    entries: Vec<End>,
    place: Vec<usize>,
}

fn improved(ways: &Ways<'_>, near: &[Vec<End>], entries: Tour, effort: &Effort, stop: &Stop) -> Result<Tour> {
    let mut search = Search { ways, near, place: vec![0; entries.len()], entries };
    search.number(0, search.entries.len());
    let all: Vec<End> = (0..ways.len()).collect();
    stop.reached(LISTED);
    search.descend(all, stop)?;
    stop.reached(DESCENDED);
    let n = search.entries.len();
    if n < 8 {
        return Ok(search.into_tour());
    }
    let mut random = Pcg64Mcg::seed_from_u64(effort.seed);
    let kicks = (effort.kicks_per_lane * n as f64) as usize;
    for kick in 0..kicks {
        if kick % 32 == 0 {
            stop.check()?;
            stop.reached(DESCENDED + (1.0 - DESCENDED) * kick as f64 / kicks as f64);
        }
        let before = search.entries.clone();
        let (gain, touched) = search.kick(&mut random);
        let total = gain + search.descend(touched, stop)?;
        if total < -1e-9 {
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
        let home = self.ways.len() / 2 - 1;
        let at = self.place[home];
        self.entries.rotate_left(at);
        if self.entries[0] != 2 * home {
            // The same ring the other way round: it leaves from the start and ends at home.
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

    /// Improves until nothing near the given ends gets better; returns what was gained.
    fn descend(&mut self, ends: Vec<End>, stop: &Stop) -> Result<f64> {
        let mut waiting = vec![false; self.ways.len()];
        let mut queue: std::collections::VecDeque<End> = ends.into();
        for u in &queue {
            waiting[*u] = true;
        }
        let mut gained = 0.0;
        let mut rounds = 0_u32;
        while let Some(u) = queue.pop_front() {
            waiting[u] = false;
            rounds += 1;
            if rounds.is_multiple_of(256) {
                stop.check()?;
            }
            if let Some((gain, touched)) = self.improve(u) {
                gained += gain;
                for v in touched.into_iter().chain([u]) {
                    if !std::mem::replace(&mut waiting[v], true) {
                        queue.push_back(v);
                    }
                }
            }
        }
        Ok(gained)
    }

    fn improve(&mut self, u: End) -> Option<(f64, Vec<End>)> {
        let pu = self.partner(u);
        let now = self.ways.cost(u, pu);
        let near = self.near;
        for &v in &near[u] {
            let new = self.ways.cost(u, v);
            if v == pu {
                continue;
            }
            let pv = self.partner(v);
            let other = self.ways.cost(v, pv);
            if self.is_exit(u) == self.is_exit(v) {
                let most = now + other - new;
                if most - self.ways.least(pu, pv) > 1e-6 {
                    let gain = most - self.ways.cost(pu, pv);
                    if gain > 1e-6 {
                        self.reverse_between(u, v);
                        return Some((gain, vec![u, v, pu, pv]));
                    }
                }
            }
            if let Some(found) = self.move_run(u, v, pv, new, other) {
                return Some(found);
            }
        }
        None
    }

    /// 2-opt: joins `u` to `v`, both exits or both entries.
    fn reverse_between(&mut self, u: End, v: End) {
        let (mut i, mut j) = (self.place[u / 2], self.place[v / 2]);
        if self.is_exit(u) {
            (i, j) = if i < j { (i + 1, j) } else { (j + 1, i) };
        } else {
            (i, j) = if i < j { (i, j - 1) } else { (j, i - 1) };
        }
        self.reverse(i, j);
    }

    fn reverse(&mut self, i: usize, j: usize) {
        let n = self.entries.len();
        if j + 1 - i > n / 2 + 1 {
            // The rest of the ring the other way round is the same tour, and shorter to turn.
            let (from, count) = (j + 1, n - (j + 1 - i));
            for k in 0..count / 2 {
                let (a, b) = ((from + k) % n, (from + count - 1 - k) % n);
                self.entries.swap(a, b);
            }
            for k in 0..count {
                let at = (from + k) % n;
                self.entries[at] ^= 1;
                self.place[self.entries[at] / 2] = at;
            }
            return;
        }
        self.entries[i..=j].reverse();
        self.entries[i..=j].iter_mut().for_each(|e| *e ^= 1);
        self.number(i, j + 1);
    }

    /// Or-opt: moves a run of lanes that ends in `u` to between `v` and its partner.
    fn move_run(&mut self, u: End, v: End, pv: End, new: f64, other: f64) -> Option<(f64, Vec<End>)> {
        let n = self.entries.len();
        let start = self.place[u / 2];
        let ways = self.ways;
        let is_exit = self.is_exit(u);
        for run in 1..=RUN.min(n.saturating_sub(3)) {
            // The run reaches from `u` away from its partner.
            let far = if is_exit { (start + n + 1 - run) % n } else { (start + run - 1) % n };
            let (first, last) = if is_exit { (far, start) } else { (start, far) };
            let inside = |lane: usize| (self.place[lane] + n - first) % n < run;
            if inside(v / 2) || inside(pv / 2) {
                return None;
            }
            let tail = if is_exit { self.entries[far] } else { self.entries[far] ^ 1 };
            let before = self.entries[(first + n - 1) % n] ^ 1;
            let after = self.entries[(last + 1) % n];
            let removed =
                ways.cost(before, self.entries[first]) + ways.cost(self.entries[last] ^ 1, after) + other;
            let most = removed - new;
            if most - ways.least(tail, pv) - ways.least(before, after) <= 1e-6 {
                continue;
            }
            let most = most - ways.cost(tail, pv);
            if most - ways.least(before, after) * (1.0 - ROUNDING) <= 1e-6 {
                continue;
            }
            let gain = most - ways.cost(before, after);
            if gain > 1e-6 {
                self.relink(first, run, u, v);
                return Some((gain, vec![u, v, pv, tail, before, after]));
            }
        }
        None
    }

    /// Takes a run out and puts it back so that `u` meets `v`.
    fn relink(&mut self, first: usize, run: usize, u: End, v: End) {
        let n = self.entries.len();
        let mut taken: Vec<End> = (0..run).map(|k| self.entries[(first + k) % n]).collect();
        let rest: Vec<End> = (run..n).map(|k| self.entries[(first + k) % n]).collect();
        let at = rest.iter().position(|e| e / 2 == v / 2).expect("the run does not hold it");
        let v_is_exit = rest[at] != v;
        let u_is_entry = taken[0] == u;
        // Behind an exit the run begins with `u`; before an entry it ends with it.
        if v_is_exit != u_is_entry {
            taken.reverse();
            for entry in &mut taken {
                *entry ^= 1;
            }
        }
        let cut = if v_is_exit { at + 1 } else { at };
        self.entries.clear();
        self.entries.extend(&rest[..cut]);
        self.entries.extend(&taken);
        self.entries.extend(&rest[cut..]);
        self.number(0, n);
    }

    /// Swaps two neighbouring runs somewhere: a double bridge that changes little.
    fn kick(&mut self, random: &mut Pcg64Mcg) -> (f64, Vec<End>) {
        let n = self.entries.len();
        let reach = 30.min(n - 3);
        let a = random.random_range(0..n - reach - 1);
        let mut steps = [0; 2];
        for step in &mut steps {
            *step = 1 + random.random_range(0..reach / 2);
        }
        let (b, c) = (a + steps[0], a + steps[0] + steps[1]);
        let ends: Vec<End> =
            [a, b, c].iter().flat_map(|k| [self.entries[*k] ^ 1, self.entries[(*k + 1) % n]]).collect();
        let before: f64 =
            [a, b, c].iter().map(|k| self.ways.cost(self.entries[*k] ^ 1, self.entries[(*k + 1) % n])).sum();
        self.entries[a + 1..=c].rotate_left(steps[0]);
        self.number(a + 1, c + 1);
        let middle = a + steps[1];
        let after: f64 = [a, middle, c]
            .iter()
            .map(|k| self.ways.cost(self.entries[*k] ^ 1, self.entries[(*k + 1) % n]))
            .sum();
        (before - after, ends)
    }
}
