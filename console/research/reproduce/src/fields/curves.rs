//! The figures that the papers plot along the path: forces (Xu et al. 2022, Figs 14 to 16), distances (Yang et al.
//! 2021, Figs 12 to 15).

use super::{
    flown::{Flown, Trip, fly},
    xu,
};
use crate::study::{Block, Job, Method, Result, Row, Sample};
use report::drawing::curves::{Curve, Curves};
use std::f64::consts::FRAC_PI_4;
use trials::amphibious::{AmphibiousLayout, Group};
use world::Pose;

const NO_NUMBERS: &str = "recorded during a drive; in our copy, the paper's figure has no numbers";
const DISTANCES: &str = "recorded during a drive, with virtual goals on a square round the goal as \
                         published; the paper shows one layout per group, without coordinates, and ours \
                         are random";

/// Time limit of a drive over the floor of Table 2, seconds, at one metre per second.
const FORCES_S: f64 = 250.0;
/// Time limit of a drive over a floor of Figs 12 to 15, seconds.
const DISTANCES_S: f64 = 300.0;
/// The names of the figures that the planners report.
const PULL: &str = "F_att";
const PUSH: &str = "F_rep";
const NEAREST: &str = "obstacle_distance";
const SAFE: &str = "safe_distance";

/// Figs 14 to 16 of Xu et al. 2022: pull and push of the three methods over the floor of Table 2.
pub(super) fn forces(job: &Job<'_>) -> Result<Vec<Row>> {
    let layout = xu::holistic();
    let layouts = job.cases([&layout], |layout| layout.id.into())?;
    let methods = job.methods(xu::methods_of_forces(NO_NUMBERS), |method| method.id.clone())?;
    let runs: Vec<_> = layouts.iter().flat_map(|l| methods.iter().map(move |method| (*l, method))).collect();
    let flown = job.runner.map(&runs, |planners, (layout, method)| {
        let flown = layout.fly(planners, method, FORCES_S)?;
        draw(job, (layout.id, 0, &method.id), "force, N", &flown, &[PULL, PUSH]);
        Ok(flown)
    })?;
    let rows = runs.iter().zip(&flown).flat_map(|((layout, method), flown)| {
        let block = job.block(layout.id, &method.id, method.note);
        let arrives = method.id.starts_with("bvo-apf");
        let arrived = block.row("success_rate", share(flown.arrived), "", 1).printed(share(arrives));
        [vec![arrived], figures(&block, flown, PULL), figures(&block, flown, PUSH)].concat()
    });
    Ok(rows.collect())
}

/// Figs 12 to 15 (b) of Yang et al. 2021: distances to the nearest obstacles over the steps.
pub(super) fn distances(job: &Job<'_>) -> Result<Vec<Row>> {
    let groups = job.cases(Group::ALL, |group| group.id().into())?;
    let method = |steps: i64| {
        let method = Method::new(format!("apf-dwa/square/steps-{steps}"), "apf-dwa", DISTANCES);
        method.word("guide", "square").int("transition_steps", steps).number("guard_m", 0.1)
    };
    let methods = job.methods([0, 20].map(method), |method| method.id.clone())?;
    let runs: Vec<(Group, &Method)> =
        groups.iter().flat_map(|group| methods.iter().map(move |method| (*group, method))).collect();
    let seeds = job.seeds();
    let flown = job.runner.grid(&runs, &seeds, |planners, (group, method), seed| {
        let layout = AmphibiousLayout::random(*group, *seed);
        let (corners, obstacles) = (AmphibiousLayout::corners(), layout.obstacles());
        let water = AmphibiousLayout::water();
        let zones = AmphibiousLayout::zones(&water);
        let site = AmphibiousLayout::site(&corners, &obstacles, &zones);
        let start = Pose { position: layout.start, heading_rad: FRAC_PI_4 };
        let trip = Trip { start, goal: layout.goal, tolerance_m: 0.15, most_s: DISTANCES_S };
        let flown = fly(planners, method, &site, &trip)?;
        let names: Vec<&str> = flown.figures.keys().map(String::as_str).collect();
        let mut shown: Vec<&str> =
            names.into_iter().filter(|name| name.starts_with(NEAREST) || *name == SAFE).collect();
        // Sorts number 2 before number 10.
        shown.sort_by_key(|name| (*name == SAFE, name.len()));
        draw(job, (group.id(), *seed, &method.id), "distance, m", &flown, &shown);
        Ok(flown)
    })?;
    let of_run = |((group, method), flown): (&(Group, &Method), &Vec<Flown>)| {
        of_group(&job.block(group.id(), &method.id, method.note), flown)
    };
    Ok(runs.iter().zip(&flown).flat_map(of_run).collect())
}

fn of_group(block: &Block<'_>, flown: &[Flown]) -> Vec<Row> {
    let n = flown.len();
    let arrived = flown.iter().filter(|flown| flown.arrived).count() as f64 / n as f64;
    let least = |flown: &Flown| values(flown, NEAREST).fold(f64::INFINITY, f64::min);
    let below = |flown: &Flown| {
        let safe = values(flown, SAFE).next().unwrap_or(0.0);
        let distances: Vec<f64> = values(flown, NEAREST).collect();
        distances.iter().filter(|distance| **distance < safe).count() as f64 / distances.len().max(1) as f64
    };
    vec![
        block.row("success_rate", arrived, "", n).printed(1.0),
        block.row("least_distance", flown.iter().map(least).collect::<Sample>().min(), "m", n),
        block.row("steps_below_safe_distance", flown.iter().map(below).collect::<Sample>().mean(), "", n),
    ]
}

fn figures(block: &Block<'_>, flown: &Flown, name: &str) -> Vec<Row> {
    let all: Sample = values(flown, name).collect();
    vec![
        block.row(&format!("{name}_median"), all.median(), "N", all.len()),
        block.row(&format!("{name}_max"), all.max(), "N", all.len()),
        block.row(&format!("{name}_end"), values(flown, name).last(), "N", all.len()),
    ]
}

fn values<'a>(flown: &'a Flown, name: &str) -> impl Iterator<Item = f64> + use<'a> {
    flown.figures.get(name).into_iter().flatten().map(|(_, value)| *value)
}

fn share(is: bool) -> f64 {
    f64::from(u8::from(is))
}

/// Draws some of the figures of a drive, if pictures are requested.
fn draw(job: &Job<'_>, name: (&str, u64, &str), unit: &str, flown: &Flown, shown: &[&str]) {
    let Some(gallery) = job.runner.gallery() else { return };
    let figures = shown.iter().filter_map(|name| flown.figures.get_key_value(*name));
    let figures: Vec<_> = figures.map(|(name, points)| (name.replace('_', " "), points)).collect();
    let curves: Vec<Curve<'_>> = figures.iter().map(|(name, points)| Curve { name, points }).collect();
    let title = format!("{}, {}", name.0, name.2);
    let drawn = Curves { title: &title, along: "time, s", values: unit, curves: &curves };
    gallery.add_curves(name, &drawn);
}
