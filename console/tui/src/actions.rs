//! Everything the operator can do, in one table. The keys, the footer, the help, the commands with their reference,
//! and `keys.toml` are all derived from this table.

mod action;
mod argument;
pub mod context;
pub mod find;
pub mod keymap;
mod rows;
#[cfg(test)]
mod tests;

pub use action::{Action, Risk, Topic};
pub(crate) use action::{Deed, Reach, action};
pub use argument::{Arg, Kind, duration_s, moment_s};

use crate::model::replay::Jump;
use crate::screens::Screen;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// The id of an action; the action is described by its row in the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "each variant is described by its row in the table")]
pub enum ActionId {
    Hold,
    Interrupt,
    Redraw,
    Suspend,
    Start,
    Resume,
    DriveBack,
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
    TickValue,
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
    Draw,
    DrawnForm,
    DrawnUndo,
    DrawnClose,
    Include,
    /// The action with this number (from 1) in the selected alarm's list.
    Remedy(u8),
    ShowPlace,
    NextLike,
    PreviousLike,
    Copy,
    PlannerMessages,
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
    FullPane,
    PreviousPane,
    /// The pane with this number (from 1) on a screen that shows several panes.
    Pane(u8),
    Commands,
    Help,
    Messages,
    Open,
    GoTo,
    Theme,
    /// Go to a screen.
    Go(Screen),
    Reload,
    NextMissed,
    PreviousMissed,
    Again,
    Rescan,
    Verify,
    Report,
    HandOver,
    View,
    Replay,
    Play,
    /// Jump to another moment of the replayed run.
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

/// Every action, in the order of the footer and the help.
pub static ACTIONS: LazyLock<Vec<Action>> = LazyLock::new(rows::all);
