//! Mode pre: a path that begins its detours before the robot enters a trap, found by simulation and pulled taut.
//!
//! If the simulated walk is trapped, the simpler modes are tried in turn; as a last resort, the outlines are followed
//! from the start. On maps with many parts, the outlines come before the simpler modes.

use crate::{
    machine::{Machine, News},
    settings::{MachineSettings, Mode},
    taut,
    thought::{COARSE_M, Walked, walk},
};
use std::fmt;
use world::{Point, polyline};

/// A method of searching for a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// A simulated walk in coarse steps.
    Thought,
    /// A walk with the configured step length, in a different mode.
    Mode(Mode),
    /// Following the outlines from the start.
    Outlines,
}

/// The attempts, in the order in which they are made.
const ATTEMPTS: [By; 5] =
    [By::Thought, By::Mode(Mode::Rollout), By::Mode(Mode::Hull), By::Mode(Mode::Literal), By::Outlines];

/// The order on a map with many parts. On such a map, each simpler mode takes a long time before it gives up in a room
/// that traps it.
const ATTEMPTS_IN_ROOMS: [By; 5] =
    [By::Thought, By::Outlines, By::Mode(Mode::Rollout), By::Mode(Mode::Hull), By::Mode(Mode::Literal)];
/// Number of parts above which a map counts as a map with many parts.
const MANY_PARTS: usize = 200;

/// Maximum number of parts of a map on which the paper's own mode is also tried, to show its result, if the path
/// follows the outlines.
const SHOWN_PARTS: usize = 1000;

/// The outcome of an attempt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// The kind of attempt.
    pub by: By,
    /// Whether the goal was reached.
    pub arrived: bool,
    /// Length of the walk, metres.
    pub length_m: f64,
    /// The end of the walk.
    pub end: Point,
}

/// The path, and the attempts behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Ahead {
    /// The path that reaches the goal, pulled taut; if there is none, the first walk.
    pub walked: Walked,
    /// All attempts.
    pub tried: Vec<Tried>,
    /// The events of the chosen attempt.
    pub news: Vec<News>,
}

/// Searches for a path on the map of a machine that has not moved yet. `check` can end the search early.
///
/// # Errors
/// The error that `check` returns.
pub fn of_traps<E>(
    machine: &Machine,
    start: Point,
    goal: Point,
    tolerance_m: f64,
    mut check: impl FnMut() -> Result<(), E>,
) -> Result<Ahead, E> {
    let mut tried = Vec::new();
    let mut first = None;
    // All attempts share the step budget of the simulations that choose a side.
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
        // A goal too close to an obstacle is reached within its tolerance.
        let end = walked.path[walked.path.len() - 1];
        walked.path.extend(Some(goal).filter(|goal| machine.map.is_free(end, *goal, 0.0)));
        walked.path = taut::pulled(&walked.path, &machine.map, machine.settings.taut_margin_m);
        return Ok(Ahead { walked, tried, news });
    }
    let (walked, news) = first.expect("at least one attempt was made");
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
            By::Thought => write!(f, "simulated walk ")?,
            By::Mode(mode) => write!(f, "mode {} ", mode.name())?,
            By::Outlines => write!(f, "following the outlines ")?,
        }
        let Self { length_m, end, .. } = self;
        if self.arrived {
            return write!(f, "reaches the goal after {length_m:.2} m");
        }
        write!(f, "ends at ({:.2}, {:.2}) after {length_m:.2} m", end.x, end.y)
    }
}

#[cfg(test)]
mod tests;
