//! Everything the operator can do, in one table: keys, footer, help, commands, their reference and `keys.toml` come from it.

mod action;
mod argument;
pub mod context;
pub mod find;
pub mod keymap;
mod rows;
#[cfg(test)]
mod tests;

pub use action::{Action, Risk};
pub(crate) use action::{Deed, Reach, action};
pub use argument::{Arg, Kind, duration_s, moment_s};

use crate::model::replay::Jump;
use crate::screens::Screen;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// Names an action; what each does is said in its row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the row of each says what it does")]
pub enum ActionId {
    Hold,
    Interrupt,
    Redraw,
    Suspend,
    Start,
    Resume,
    FlyUncertified,
    Step,
    StepLane,
    StepEvent,
    Abort,
    ChoosePlanner,
    Shadow,
    Promote,
    DropShadow,
    TakePlan,
    WhatIf,
    AddCandidate,
    TryParameters,
    ForecastDraft,
    PresetSave,
    PresetLoad,
    NextCandidate,
    PreviousCandidate,
    Preflight,
    Compare,
    PlanAgain,
    CancelPlan,
    Parameters,
    SetParameter,
    Slower,
    Faster,
    SetSpeed,
    Acknowledge,
    AcknowledgeAll,
    Shelve,
    Inject,
    Exclude,
    DrawZone,
    Include,
    /// An action of the alarm that is selected, by its number from 1.
    Remedy(u8),
    ShowPlace,
    NextLike,
    PreviousLike,
    Copy,
    ZoomIn,
    ZoomOut,
    WholeTank,
    Follow,
    Layers,
    Centre,
    Inspect,
    Mouse,
    PanLeft,
    PanRight,
    PanUp,
    PanDown,
    Severity,
    Filter,
    NextPane,
    PreviousPane,
    Commands,
    Help,
    Open,
    GoTo,
    Theme,
    /// To a screen.
    Go(Screen),
    Reload,
    NextMissed,
    PreviousMissed,
    Again,
    Rescan,
    Verify,
    Report,
    View,
    Replay,
    Play,
    /// To another moment of a run that is played back.
    Jump(Jump),
    Seek,
    Bookmark,
    Unmark,
    Remark,
    CompareRun,
    Difference,
    Align,
    Sort,
    Back,
    Leave,
    Complete,
    Accept,
    Cancel,
    Up,
    Down,
    PageUp,
    PageDown,
    First,
    Last,
    Edit,
}

/// Every action, in the order of the footer and of help.
pub static ACTIONS: LazyLock<Vec<Action>> = LazyLock::new(rows::all);
