//! Mode pre: a way that begins its detours before it enters a trap, walked in thought and pulled taut.
//!
//! Where the walk is trapped, the simpler modes try in turn, and at last the outlines are followed from the start; on maps of many parts
//! the outlines come before the simpler modes.

use crate::{
    machine::{Machine, News},
    settings::{MachineSettings, Mode},
    taut,
    thought::{COARSE_M, Walked, walk},
};
use std::fmt;
use world::{Point, polyline};

/// How a way is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// A walk in thought, in coarse steps.
    Thought,
    /// A walk in steps of the length that is set, in another mode.
    Mode(Mode),
    /// With a hand on the outlines from the start.
    Outlines,
}

/// What is tried, in this order.
const ATTEMPTS: [By; 5] =
    [By::Thought, By::Mode(Mode::Rollout), By::Mode(Mode::Hull), By::Mode(Mode::Literal), By::Outlines];

/// The order on a map of many parts, where each of the simpler modes takes a long time to find out that a room holds it.
const ATTEMPTS_IN_ROOMS: [By; 5] =
    [By::Thought, By::Outlines, By::Mode(Mode::Rollout), By::Mode(Mode::Hull), By::Mode(Mode::Literal)];
/// A map of more parts than this has many.
const MANY_PARTS: usize = 200;

/// Where the outlines were followed on a map of up to so many parts, the paper's own result is shown beside.
const SHOWN_PARTS: usize = 1000;

/// How an attempt came out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// What was tried.
    pub by: By,
    /// Whether the goal was reached.
    pub arrived: bool,
    /// Length of the walk, metres.
    pub length_m: f64,
    /// Where it ended.
    pub end: Point,
}

/// The way, and how it was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Ahead {
    /// The way that arrives, pulled taut; if none does, the first walk.
    pub walked: Walked,
    /// Every attempt.
    pub tried: Vec<Tried>,
    /// What happened in the one that is taken.
    pub news: Vec<News>,
}

/// Looks for a way on the map of a machine that has not moved yet; `check` ends it early.
///
/// # Errors
/// What `check` says.
pub fn of_traps<E>(
    machine: &Machine,
    start: Point,
    goal: Point,
    tolerance_m: f64,
    mut check: impl FnMut() -> Result<(), E>,
) -> Result<Ahead, E> {
    let mut tried = Vec::new();
    let mut first = None;
    // All attempts share the steps that may be walked in thought for a choice of side.
    let mut thought_left = machine.thought_left;
    let attempts = if machine.map.solids.len() > MANY_PARTS { ATTEMPTS_IN_ROOMS } else { ATTEMPTS };
    for by in attempts {
        let (outcome, mut walked, news) =
            attempt(by, machine, start, goal, tolerance_m, &mut thought_left, &mut check)?;
        tried.push(outcome);
        if !walked.arrived {
            first.get_or_insert((walked, news));
            continue;
        }
        if follows(&news) && by == By::Thought && machine.map.solids.len() <= SHOWN_PARTS {
            let paper = By::Mode(Mode::Literal);
            tried.push(attempt(paper, machine, start, goal, tolerance_m, &mut thought_left, &mut check)?.0);
        }
        // A goal too near to something is reached within its tolerance.
        let end = walked.path[walked.path.len() - 1];
        walked.path.extend(Some(goal).filter(|goal| machine.map.is_free(end, *goal, 0.0)));
        walked.path = taut::pulled(&walked.path, &machine.map, machine.settings.taut_margin_m);
        return Ok(Ahead { walked, tried, news });
    }
    let (walked, news) = first.expect("something was tried");
    Ok(Ahead { walked, tried, news })
}

fn follows(news: &[News]) -> bool {
    news.iter().any(|item| matches!(item, News::Follows { .. }))
}

fn attempt<E>(
    by: By,
    machine: &Machine,
    start: Point,
    goal: Point,
    tolerance_m: f64,
    thought_left: &mut usize,
    check: impl FnMut() -> Result<(), E>,
) -> Result<(Tried, Walked, Vec<News>), E> {
    let settings = by.settings(&machine.settings);
    let mut thought = machine.set_to(settings);
    thought.thought_left = *thought_left;
    if by == By::Outlines {
        thought.follow_outlines(start, goal);
    }
    let walked = walk(&mut thought, start, goal, tolerance_m.max(settings.step_m / 2.0), check)?;
    *thought_left = thought.thought_left;
    let (length_m, end) = (polyline::length_m(&walked.path), walked.path[walked.path.len() - 1]);
    Ok((Tried { by, arrived: walked.arrived, length_m, end }, walked, thought.news))
}

impl By {
    fn settings(self, set: &MachineSettings) -> MachineSettings {
        match self {
            Self::Thought => MachineSettings { step_m: set.step_m.max(COARSE_M), ..*set },
            Self::Mode(mode) => MachineSettings { mode, ..*set },
            Self::Outlines => *set,
        }
    }
}

impl fmt::Display for Tried {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.by {
            By::Thought => write!(f, "the walk in thought ")?,
            By::Mode(mode) => write!(f, "mode {} ", mode.name())?,
            By::Outlines => write!(f, "a hand on the outlines ")?,
        }
        let Self { length_m, end, .. } = self;
        if self.arrived {
            return write!(f, "arrives after {length_m:.2} m");
        }
        write!(f, "ends at ({:.2}, {:.2}) after {length_m:.2} m", end.x, end.y)
    }
}

#[cfg(test)]
mod tests;
