//! Every estimator over the floor, on the same ranges, with the bounds beside it.

use super::{
    method::{self, Method},
    scene::{Layout, RADIUS_M, Scene, chance, on_disc},
    tally::{Outcome, cramer_rao_m, rows},
};
use crate::{
    bench::Bench,
    row::Row,
    sample::Sample,
    study::{Options, Problem, Study},
};
use sim::NoiseModel;
use std::time::Instant;
use world::Point;

pub(super) const STUDY: Study = Study {
    name: "positioning-limits",
    about: "every estimator over the floor on the same ranges, by stations, noise and repetitions, with the bounds",
    layouts: 10_000,
    run,
};

const METHODS: [Method; 7] = [
    method::LINEAR,
    method::WEIGHTED,
    method::NLS,
    method::NLS_MIDRANGE,
    method::NLS_POSTERIOR,
    method::BOUNDED,
    method::CONSENSUS,
];
/// Truths of one piece of work.
const PIECE: usize = 250;

/// A case: id and scene.
type Case = (String, Scene);

fn cases() -> Vec<Case> {
    let uniform = NoiseModel::Uniform { ratio: 0.05 };
    let sigma_ratio = 0.05 / 3.0_f64.sqrt();
    let others = [
        ("triangular-5", NoiseModel::Triangular { ratio: 0.05 }),
        ("gaussian-2.9", NoiseModel::Gaussian { sigma_ratio }),
        ("heavy-tailed-2.9", NoiseModel::HeavyTailed { sigma_ratio }),
    ];
    let case = |layout: Layout, name: &str, noise, repetitions| {
        (format!("disc/{}/{name}", layout.id()), Scene::new(layout, noise, repetitions))
    };
    let paper = Layout::Paper;
    let mut cases = vec![case(paper, "uniform-5", uniform, 20)];
    cases.extend([1, 5].map(|n| case(paper, &format!("uniform-5/n-{n}"), uniform, n)));
    cases.extend(others.map(|(name, noise)| case(paper, name, noise, 20)));
    cases.extend([4, 6, 8].map(|n| case(Layout::Ring(n, 7.5), "uniform-5", uniform, 20)));
    cases.extend([3, 4, 6, 8].map(|n| case(Layout::Ring(n, RADIUS_M), "uniform-5", uniform, 20)));
    cases
}

fn run(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let cases: Vec<Case> = cases().into_iter().filter(|(id, _)| options.has_case(id)).collect();
    let methods: Vec<Method> = METHODS.into_iter().filter(|m| options.has_method(m.id)).collect();
    let seeds: Vec<u64> = options.seeds(study.layouts).collect();
    let work: Vec<(usize, &[u64])> =
        (0..cases.len()).flat_map(|case| seeds.chunks(PIECE).map(move |piece| (case, piece))).collect();
    let done = bench.map(&work, |_, (case, piece)| Ok(one_piece(&cases[*case].1, piece, &methods)))?;
    let mut all = Vec::new();
    for (k, (id, scene)) in cases.iter().enumerate() {
        let of_case = || work.iter().zip(&done).filter(|((case, _), _)| *case == k).map(|(_, piece)| piece);
        for (m, method) in methods.iter().enumerate() {
            let outcomes: Vec<Outcome> =
                of_case().flat_map(|piece| piece.outcomes.iter().map(|of_truth| of_truth[m])).collect();
            if outcomes.iter().any(|o| o.error_m.is_some()) {
                all.extend(rows(study.name, id, method.id, &outcomes));
            }
        }
        let bounds: Sample = of_case().flat_map(|piece| piece.bounds_m.iter().copied()).collect();
        let note = format!("normal noise of the same variance, {} repetitions", scene.ae.repetitions);
        all.push(
            Row::new(study.name, id, "cramer-rao", "bound", bounds.mean(), "m").of(bounds.len()).note(note),
        );
    }
    Ok(all)
}

struct Piece {
    /// For each truth, one for each method.
    outcomes: Vec<Vec<Outcome>>,
    bounds_m: Vec<f64>,
}

fn one_piece(scene: &Scene, seeds: &[u64], methods: &[Method]) -> Piece {
    let noise = scene.noise();
    let mut piece = Piece { outcomes: Vec::with_capacity(seeds.len()), bounds_m: Vec::new() };
    for seed in seeds {
        let truth: Point = on_disc(&mut chance(*seed, 1));
        let sets = scene.sounder(*seed).cycle(0.0, truth);
        let outcome = |method: &Method| {
            let began = Instant::now();
            let fix = method.fix(&sets, &scene.stations, &noise);
            Outcome::of(&fix, truth, began.elapsed().as_secs_f64() * 1e6)
        };
        piece.outcomes.push(methods.iter().map(outcome).collect());
        let sigma_ratio = noise.sigma_ratio();
        piece.bounds_m.extend(cramer_rao_m(&scene.stations, truth, sigma_ratio, scene.ae.repetitions));
    }
    piece
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_better_the_method_the_smaller_the_error() {
        let (_, scene) = cases().swap_remove(0);
        let piece = one_piece(&scene, &(0..400).collect::<Vec<_>>(), &METHODS);
        let mean = |m: usize| {
            piece.outcomes.iter().filter_map(|of| of[m].error_m).collect::<Sample>().mean().expect("fixes")
        };
        let (linear, nls, bounded) = (mean(0), mean(2), mean(5));
        assert!(bounded < 0.5 * nls && nls < 0.7 * linear, "{bounded} {nls} {linear}");
        let bound = piece.bounds_m.iter().sum::<f64>() / 400.0;
        assert!((nls / bound - 1.0).abs() < 0.1, "{nls} {bound}");
    }
}
