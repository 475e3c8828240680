//! Floor that loses its scan because imported readings lack channels: the mission, which knew nothing of this, counted it.

use crate::{Evidence, Scanned, passes::Margins};
use mission::Channels;
use serde::{Deserialize, Serialize};
use world::{CoverageGrid, Pose};

/// A time in which channels of the instrument gave no readings, although floor counted as scanned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Silence {
    /// The channels; channel 0 is on the right.
    pub channels: Vec<u16>,
    /// Mission time of the last reading before it, seconds.
    pub from_s: f64,
    /// Mission time of the first reading after it, seconds.
    pub to_s: f64,
}

impl Silence {
    /// Whether it touches the time from `since_s` to `t_s`, seconds.
    fn touches(&self, since_s: f64, t_s: f64) -> bool {
        self.from_s < t_s && since_s < self.to_s
    }
}

/// The way of the tool, kept to be judged again with what the readings show.
#[derive(Debug, Clone, Default)]
pub(crate) struct Way {
    steps: Vec<Step>,
    /// For each change of the channels declared dead, the number of steps before it.
    declared: Vec<(usize, Vec<u16>)>,
}

/// An estimated pose, and how the floor on the way to it counts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub(crate) t_s: f64,
    pub(crate) here: Pose,
    pub(crate) error_m: f64,
    /// `None` if the floor does not count as scanned.
    pub(crate) margins: Option<Margins>,
}

impl Way {
    pub(crate) fn push(&mut self, step: Step) {
        self.steps.push(step);
    }

    pub(crate) fn declare(&mut self, dead: &[u16]) {
        self.declared.push((self.steps.len(), dead.to_vec()));
    }

    /// Goes the way again with channels that are also dead while they are silent. Floor that one of them touches, and
    /// that no other pass tests, does not count as scanned any more. `channels` are those at the start; `taken_back`
    /// lists the times from which, and at which, guarantees were taken back, seconds.
    pub(crate) fn silence(
        &self,
        silences: &[Silence],
        (channels, start): (&mut Channels, Pose),
        (scanned, evidence): (&mut Scanned, &mut Evidence),
        taken_back: &[(f64, f64)],
    ) {
        let before = scanned.begin_again(start);
        evidence.begin_again(start);
        let rim_m = before.floor().rim_m();
        let (mut declared, mut declarations) = (Vec::new(), self.declared.iter().peekable());
        let (mut since_s, mut at) = (f64::NEG_INFINITY, start);
        let mut taken_back = taken_back.iter().peekable();
        for (index, step) in self.steps.iter().enumerate() {
            while let Some((_, dead)) = declarations.next_if(|(before, _)| *before <= index) {
                declared.clone_from(dead);
            }
            let silent = silences.iter().filter(|silence| silence.touches(since_s, step.t_s));
            let mut dead: Vec<u16> = silent
                .flat_map(|silence| &silence.channels)
                .copied()
                .chain(declared.iter().copied())
                .collect();
            dead.sort_unstable();
            dead.dedup();
            if channels.judge(Some(&dead)).is_some() {
                evidence.test_with(channels);
                scanned.test_with(channels.live(rim_m));
            }
            scanned.visit(step.here, step.margins);
            evidence.visit(step.here, step.error_m, step.margins.is_some());
            if step.margins.is_some() {
                scanned.scan(at, step.here);
            }
            while let Some((from_s, _)) = taken_back.next_if(|(_, until_s)| *until_s <= step.t_s) {
                scanned.take_back(*from_s);
            }
            (since_s, at) = (step.t_s, step.here);
        }
        scanned.keep_where(&before, |cell| evidence.dead_channel(cell).is_none());
    }
}

/// The cells that were scanned before, without those that a dead channel touched and that were not scanned again.
pub(crate) fn kept(
    before: &CoverageGrid,
    again: &CoverageGrid,
    is_kept: impl Fn(usize) -> bool,
) -> CoverageGrid {
    let mut grid = CoverageGrid::new(before.floor().clone());
    let runs: Vec<world::CellRun> = (0..before.floor().len())
        .filter(|cell| before.is_covered(*cell) && (again.is_covered(*cell) || is_kept(*cell)))
        .map(|cell| world::CellRun(cell as u32, 1))
        .collect();
    grid.apply(&runs);
    grid
}
