//! The run that is open, and what is between the operator and its mission.

use super::{Health, Plans, Preflight, Replay, Run, Speed, WhatIf};
use account::{Account, Area, Estimate, MissReason, Summary};
use mission::{Order, Phase};
use serde::{Deserialize, Serialize};

/// Names a run that was opened since the console was started; 0 is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
pub struct RunId(pub u32);

/// What the console may do with the run that is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Access {
    /// Give orders.
    #[default]
    Control,
    /// Read the journal that another console writes, or has written.
    LookOnly,
    /// Play back a past run.
    Replay,
}

/// Where a scenario comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Source {
    /// The demo that is built in, with what the command line changes in it.
    Demo,
    /// A file.
    File(String),
    /// What past runs missed: names of their folders.
    Rescan(Vec<String>),
}

/// A planner's work that takes time; ticks and HOLD continue meanwhile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Busy {
    /// What it is, such as `Planning (rpf)`.
    pub work: String,
    /// How long it may take, seconds; not known for what is short.
    pub limit_s: Option<f64>,
    /// When it began, on the console's own clock, seconds.
    pub since_mono_s: f64,
    /// How far it is: the share done, 0 to 1, and what is being done; `None` if it is not reported.
    #[serde(default)]
    pub at: Option<(f64, String)>,
}

impl Busy {
    /// What it is and how far: `Planning (rpf) 23 %`.
    pub fn how_far(&self) -> String {
        // Only the end makes it whole.
        let percent = |share: f64| format!(" {} %", (100.0 * share).floor().clamp(0.0, 99.0));
        let share = self.at.as_ref().map_or_else(String::new, |(share, _)| percent(*share));
        format!("{}{share}", self.work)
    }
}

/// What a run that was flown leaves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// Its report.
    pub summary: Box<Summary>,
    /// Name of its folder; `None` if it was not written down.
    pub name: Option<String>,
    /// The line about where it is kept, or why it is not.
    pub kept: String,
    /// Whether it is kept.
    pub is_kept: bool,
}

/// The run that is open.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Live {
    /// Which.
    pub id: RunId,
    /// Whether orders can be given.
    #[serde(default)]
    pub access: Access,
    /// Where its scenario comes from; `None` as long as none was opened.
    pub source: Option<Source>,
    /// Whether the scenario is being read and its floor being laid out.
    pub is_opening: bool,
    /// Why it could not be opened, with file, line and key.
    pub failure: Option<String>,
    /// The run that was open before, while this one is being opened: it stays open if this one cannot be.
    #[serde(default)]
    pub before: Option<Box<Live>>,
    /// What its events say.
    pub run: Run,
    /// What is known of it before it moves.
    pub plans: Plans,
    /// What was checked before its start.
    pub preflight: Preflight,
    /// How it would go on from where it is held; `None` as long as nobody asked.
    pub what_if: Option<WhatIf>,
    /// Whether the console that flies the run is gone: nothing more is known of it.
    #[serde(default)]
    pub is_cut_off: bool,
    /// How fast the mission shall go.
    pub speed: Speed,
    /// How its engine does.
    pub health: Health,
    /// What a planner is working on.
    pub busy: Option<Busy>,
    /// An order that makes the robot move and was not answered yet.
    pub asked: Option<Order>,
    /// Whether HOLD was sent and not answered yet.
    pub hold_asked: bool,
    /// When the last events arrived, on the console's own clock, seconds.
    pub heard_mono_s: f64,
    /// What the run leaves, when it has ended and its files are closed.
    pub result: Option<RunResult>,
    /// What it and the runs before it have scanned together, if it is a re-scan and that is known; or why it is not.
    #[serde(default)]
    pub combined: Option<Result<Box<Account>, String>>,
    /// How the run is played back, if it is.
    #[serde(default)]
    pub replay: Option<Box<Replay>>,
}

impl Live {
    /// Whether there is no mission here to give orders to: this console only looks on, or plays a past run back.
    pub fn is_look_only(&self) -> bool {
        self.access != Access::Control
    }

    /// Whether a past run is played back.
    pub fn is_replay(&self) -> bool {
        self.access == Access::Replay
    }

    /// Whether the robot of this console moves, or may begin to move without an order, or because of one that was agreed to
    /// or sent and not answered yet.
    pub fn may_move(&self) -> bool {
        let may_move = self.run.phase().may_move() || self.asked.is_some() || self.preflight.is_starting;
        may_move && !self.is_look_only()
    }

    /// What the plan that would be flown now promises; `None` while that is not known.
    pub fn estimate(&self) -> Option<&Estimate> {
        let (ask, estimate) = self.plans.estimate.as_ref()?;
        (self.run.planning.plan.as_ref()?.ask == *ask).then_some(estimate)
    }

    /// Reachable floor that the run was to scan and missed, the largest area first.
    pub fn missed(&self) -> Vec<&Area<MissReason>> {
        self.areas().filter(|area| area.reason != MissReason::NotAsked).collect()
    }

    /// Reachable floor that the run was not to scan and did not, square metres.
    pub fn not_requested_m2(&self) -> f64 {
        self.areas().filter(|area| area.reason == MissReason::NotAsked).map(|area| area.area_m2).sum()
    }

    /// The account of the floor: over all runs if this one is a re-scan, as soon as that is known.
    pub fn floor(&self) -> Option<&Account> {
        let combined = self.combined.iter().flatten().map(|floor| &**floor).next();
        combined.or_else(|| self.result.as_ref()?.summary.floor.as_ref())
    }

    /// This run, after those of which it re-scans what they missed; `None` if another run is named or it is not a re-scan.
    pub fn with_earlier(&self, run: &str) -> Option<Vec<String>> {
        let is_open = self.result.as_ref().is_none_or(|result| result.name.as_deref() == Some(run));
        let Some(Source::Rescan(earlier)) = self.source.as_ref().filter(|_| is_open) else { return None };
        Some(earlier.iter().cloned().chain([run.to_owned()]).collect())
    }

    fn areas(&self) -> impl Iterator<Item = &Area<MissReason>> {
        self.floor().into_iter().flat_map(|floor| &floor.missed)
    }

    /// Whether the mission waits for its start.
    pub fn waits(&self) -> bool {
        self.run.about.is_some() && *self.run.phase() == Phase::Waiting && !self.is_look_only()
    }

    /// Whether leaving would abort a mission: one that was started and has not ended, or whose start was requested.
    pub fn is_under_way(&self) -> bool {
        let is_open = *self.run.phase() != Phase::Waiting || self.may_move();
        is_open && !self.run.has_ended() && !self.is_look_only()
    }

    /// Notes that the mission accepted or refused an order. Nothing else ends the wait for it: an event of the tick before
    /// says nothing about an order that comes after it.
    pub(crate) fn answered(&mut self, order: &Order) {
        if self.asked.as_ref() == Some(order) {
            self.asked = None;
        }
        if *order == Order::Hold {
            self.hold_asked = false;
        }
    }
}
