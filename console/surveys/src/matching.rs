//! Finds the indications of two surveys that are the same loss of metal, by place and covariance.

use crate::{Indication, Refusal, Survey, assign::assign, register::Registration};
use nalgebra::Matrix2;
use serde::Serialize;
use std::f64::consts::TAU;
use world::Vector;

/// The largest squared distance, in standard deviations, between the places of one loss in two surveys: 99.9 % of the
/// distances are smaller (chi-squared, two degrees of freedom).
pub const GATE: f64 = 13.816;
/// The number of standard deviations by which a loss may be shallower in the second survey: metal does not grow back.
const SHALLOWER_SIGMAS: f64 = 4.0;
/// The most indications of a survey that are decided together.
const MOST_TOGETHER: usize = 500;

/// A loss of metal that both surveys show.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Match {
    /// Its index among the indications of the first survey.
    pub first: usize,
    /// Its index among the indications of the second survey.
    pub second: usize,
    /// Distance between the two places after registration, metres.
    pub apart_m: f64,
    /// Number of other indications, of either survey, that could be the same loss by place alone.
    pub rivals: usize,
    /// Whether one of the two is cut by untested floor, so that the growth is not known.
    pub is_cut: bool,
}

/// A pair that may be one loss.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    first: usize,
    second: usize,
    apart_m: f64,
    /// Logarithm of how much more likely the pair is one loss than an unrelated indication.
    gain: f64,
}

/// Matches the indications of two surveys one to one, with the greatest total likelihood. The order in which
/// indications are given does not matter. Matches are in the order of the first survey.
pub(crate) fn matches(
    first: &Survey,
    second: &Survey,
    registration: &Registration,
) -> Result<Vec<Match>, Refusal> {
    let candidates = candidates(first, second, registration);
    let mut found: Vec<Match> = Vec::new();
    for group in groups(&candidates, first, second) {
        found.extend(decide(&group)?);
    }
    for pair in &mut found {
        pair.is_cut = first.indications[pair.first].is_cut || second.indications[pair.second].is_cut;
    }
    found.sort_by_key(|pair| pair.first);
    Ok(found)
}

/// Every pair within the gate.
fn candidates(first: &Survey, second: &Survey, registration: &Registration) -> Vec<Candidate> {
    let count = first.indications.len().max(second.indications.len()).max(1) as f64;
    let per_m2 = count / first.tested_m2.min(second.tested_m2).max(1.0);
    let moved =
        second.indications.iter().map(|other| (registration.apply(other.at), registration.turned(other)));
    let moved: Vec<_> = moved.collect();
    let mut order: Vec<usize> = (0..moved.len()).collect();
    order.sort_by(|a, b| moved[*a].0.x.total_cmp(&moved[*b].0.x));
    let reach_m = reach_m(first, second, registration);
    let mut found = Vec::new();
    for (index, one) in first.indications.iter().enumerate() {
        let from = order.partition_point(|other| moved[*other].0.x < one.at.x - reach_m);
        let near = order[from..].iter().take_while(|other| moved[**other].0.x <= one.at.x + reach_m);
        for other in near {
            let (at, covariance) = moved[*other];
            let covariance = one.covariance + covariance + registration.covariance();
            let off = at - one.at;
            if grows_back(one, &second.indications[*other]) {
                continue;
            }
            if let Some(gain) = gain(off, covariance, per_m2) {
                found.push(Candidate { first: index, second: *other, apart_m: off.norm(), gain });
            }
        }
    }
    found
}

/// The largest distance, metres, at which a pair can be within the gate.
fn reach_m(first: &Survey, second: &Survey, registration: &Registration) -> f64 {
    let widest =
        |survey: &Survey| survey.indications.iter().map(|one| one.covariance.trace()).fold(0.0, f64::max);
    (GATE * (widest(first) + widest(second) + registration.covariance().trace())).sqrt()
}

pub(crate) fn grows_back(one: &Indication, other: &Indication) -> bool {
    one.depth_mm - other.depth_mm > SHALLOWER_SIGMAS * one.depth_sigma_mm.hypot(other.depth_sigma_mm)
}

/// `None` outside the gate.
fn gain(off: Vector, covariance: Matrix2<f64>, per_m2: f64) -> Option<f64> {
    let distance2 = off.dot(&(covariance.try_inverse()? * off));
    let density = (-distance2 / 2.0).exp() / (TAU * covariance.determinant().sqrt());
    let gain = (density / per_m2).ln();
    (distance2 <= GATE && gain.is_finite()).then_some(gain)
}

/// The representative of the group of a node; `parent` leads to it.
fn root(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}

/// Divides the candidates into groups that do not share an indication; each in an order that depends only on places and
/// depths.
fn groups(candidates: &[Candidate], first: &Survey, second: &Survey) -> Vec<Vec<Candidate>> {
    let mut parent: Vec<usize> = (0..first.indications.len() + second.indications.len()).collect();
    let offset = first.indications.len();
    for pair in candidates {
        let (one, other) = (root(&mut parent, pair.first), root(&mut parent, offset + pair.second));
        parent[one.max(other)] = one.min(other);
    }
    let mut all: Vec<(usize, Candidate)> =
        candidates.iter().map(|pair| (root(&mut parent, pair.first), *pair)).collect();
    let key = |pair: &Candidate| {
        let of = |one: &Indication| [one.at.x, one.at.y, one.depth_mm];
        [of(&first.indications[pair.first]), of(&second.indications[pair.second])].concat()
    };
    let by_key = |a: &Candidate, b: &Candidate| {
        let pairs = key(a).into_iter().zip(key(b));
        pairs.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    };
    all.sort_by(|(one, a), (other, b)| one.cmp(other).then_with(|| by_key(a, b)));
    all.chunk_by(|(one, _), (other, _)| one == other)
        .map(|group| group.iter().map(|(_, pair)| *pair).collect())
        .collect()
}

/// The best matches of a group.
fn decide(group: &[Candidate]) -> Result<Vec<Match>, Refusal> {
    let (mut rows, mut columns): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
    let place = |list: &mut Vec<usize>, index: usize| {
        list.iter().position(|known| *known == index).unwrap_or_else(|| {
            list.push(index);
            list.len() - 1
        })
    };
    let placed: Vec<(usize, usize)> =
        group.iter().map(|pair| (place(&mut rows, pair.first), place(&mut columns, pair.second))).collect();
    if rows.len().max(columns.len()) > MOST_TOGETHER {
        return Err(Refusal::TooDense(rows.len().max(columns.len())));
    }
    let mut pairs: Vec<Option<&Candidate>> = vec![None; rows.len() * columns.len()];
    for ((row, column), pair) in placed.into_iter().zip(group) {
        pairs[row * columns.len() + column] = Some(pair);
    }
    let gain = |row: usize, column: usize| pairs[row * columns.len() + column].map(|pair| pair.gain);
    let matched = |(row, column): (usize, Option<usize>)| {
        let pair = pairs[row * columns.len() + column?]?;
        let shares = |other: &&Candidate| (other.first == pair.first) != (other.second == pair.second);
        let rivals = group.iter().filter(shares).count();
        Some(Match { first: pair.first, second: pair.second, apart_m: pair.apart_m, rivals, is_cut: false })
    };
    Ok(assign(rows.len(), columns.len(), gain).into_iter().enumerate().filter_map(matched).collect())
}
