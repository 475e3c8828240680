//! The order of cells: the published genetic algorithm (Pan 2025), and an exact order for small numbers of cells.

use crate::tuning::hull_partition::{
    ELITE, GENERATIONS, MOST_EXACT, MUTATION, PATIENCE, POPULATION, TOURNAMENT,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// An order of cells and its length.
type Measured = (f64, Vec<usize>);

/// The length of the closed tour from cell 0.
pub(super) fn length(order: &[usize], distance: &[Vec<f64>]) -> f64 {
    let closed = order.iter().zip(order.iter().cycle().skip(1));
    closed.map(|(a, b)| distance[*a][*b]).sum()
}

/// Finds an order by selection, order crossover and mutation; cell 0 stays first. Reports its progress, 0 to 1.
pub(super) fn evolved(distance: &[Vec<f64>], seed: u64, report: &dyn Fn(f64)) -> Vec<usize> {
    let n = distance.len();
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    if n < 4 {
        return (0..n).collect();
    }
    let measured = |order: Vec<usize>| (length(&order, distance), order);
    let mut population: Vec<Measured> = (0..POPULATION).map(|_| measured(shuffled(n, &mut random))).collect();
    let mut since_gain = 0;
    for generation in 0..GENERATIONS {
        report(generation as f64 / GENERATIONS as f64);
        population.sort_by(|a, b| a.0.total_cmp(&b.0));
        let best = population[0].0;
        let mut next = population[..ELITE].to_vec();
        next.extend((ELITE..POPULATION).map(|_| measured(child(&population, &mut random))));
        population = next;
        let now = population.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
        since_gain = if now < best - 1e-9 { 0 } else { since_gain + 1 };
        if since_gain > PATIENCE {
            break;
        }
    }
    population.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map(|p| p.1).unwrap_or_default()
}

fn shuffled(n: usize, random: &mut Pcg64Mcg) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    (2..n).rev().for_each(|k| order.swap(k, random.random_range(1..=k)));
    order
}

fn child(population: &[Measured], random: &mut Pcg64Mcg) -> Vec<usize> {
    let (mother, father) = (picked(population, random), picked(population, random));
    let mut child = crossed(mother, father, random);
    if random.random_bool(MUTATION) {
        mutate(&mut child, random);
    }
    child
}

fn picked<'a>(population: &'a [Measured], random: &mut Pcg64Mcg) -> &'a [usize] {
    let best = (0..TOURNAMENT).map(|_| random.random_range(0..population.len()));
    let best = best.min_by(|a, b| population[*a].0.total_cmp(&population[*b].0)).unwrap_or_default();
    &population[best].1
}

/// Order crossover: keeps a stretch of one parent, and adds the remaining cells in the order of the other parent.
fn crossed(mother: &[usize], father: &[usize], random: &mut Pcg64Mcg) -> Vec<usize> {
    let n = mother.len();
    let (a, b) = (random.random_range(1..n), random.random_range(1..n));
    let (from, to) = (a.min(b), a.max(b));
    let stretch = &mother[from..=to];
    let mut rest = father.iter().copied().filter(|cell| !stretch.contains(cell));
    (0..n)
        .map(|k| if (from..=to).contains(&k) { mother[k] } else { rest.next().unwrap_or_default() })
        .collect()
}

fn mutate(order: &mut [usize], random: &mut Pcg64Mcg) {
    let n = order.len();
    let (a, b) = (random.random_range(1..n), random.random_range(1..n));
    if random.random() {
        order.swap(a, b);
    } else {
        order[a.min(b)..=a.max(b)].reverse();
    }
}

/// Finds the best order by dynamic programming over sets (Held and Karp 1962); uses the genetic algorithm for many
/// cells.
pub(super) fn exact(distance: &[Vec<f64>], seed: u64, report: &dyn Fn(f64)) -> Vec<usize> {
    let n = distance.len();
    if !(4..=MOST_EXACT).contains(&n) {
        return evolved(distance, seed, report);
    }
    let others = n - 1;
    let mut best = vec![vec![(f64::INFINITY, 0_usize); others]; 1 << others];
    for k in 0..others {
        best[1 << k][k] = (distance[0][k + 1], k);
    }
    for set in 1_usize..1 << others {
        for last in (0..others).filter(|k| set & (1 << k) != 0) {
            let (so_far, _) = best[set][last];
            for next in (0..others).filter(|k| set & (1 << k) == 0) {
                let length = so_far + distance[last + 1][next + 1];
                if length < best[set | (1 << next)][next].0 {
                    best[set | (1 << next)][next] = (length, last);
                }
            }
        }
    }
    let mut set = (1 << others) - 1;
    let closing = |k: &usize| best[set][*k].0 + distance[k + 1][0];
    let mut last = (0..others).min_by(|a, b| closing(a).total_cmp(&closing(b))).unwrap_or_default();
    let mut order = Vec::with_capacity(n);
    while set != 0 {
        order.push(last + 1);
        let before = best[set][last].1;
        set &= !(1 << last);
        last = before;
    }
    order.push(0);
    order.reverse();
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distances(seed: u64, n: usize) -> Vec<Vec<f64>> {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let points: Vec<(f64, f64)> =
            (0..n).map(|_| (random.random_range(0.0..10.0), random.random_range(0.0..10.0))).collect();
        let far = |a: &(f64, f64), b: &(f64, f64)| (a.0 - b.0).hypot(a.1 - b.1);
        points.iter().map(|a| points.iter().map(|b| far(a, b)).collect()).collect()
    }

    #[test]
    fn the_genetic_order_is_hardly_longer_than_the_best() {
        for seed in 0..5 {
            let distance = distances(seed, 11);
            let (found, best) = (evolved(&distance, 1, &|_| {}), exact(&distance, 1, &|_| {}));
            let mut sorted = best.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..11).collect::<Vec<_>>());
            assert!(found[0] == 0 && best[0] == 0);
            let (found, best) = (length(&found, &distance), length(&best, &distance));
            assert!(best <= found + 1e-9 && found <= 1.08 * best, "{found} of {best}");
        }
    }
}
