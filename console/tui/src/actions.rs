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

/// Names an action.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum ActionId {
    /// Stand still now; when held, ask whether to resume.
    Hold,
    /// Stand still now; twice asks to leave.
    Interrupt,
    /// Redraw the screen.
    Redraw,
    /// Stand still and give the terminal back to the shell for a while.
    Suspend,
    /// Start the mission.
    Start,
    /// Resume.
    Resume,
    /// Fly a plan that was refused because of the tether.
    FlyUncertified,
    /// Move for one tick.
    Step,
    /// Move to the end of the lane.
    StepLane,
    /// Move to the next event.
    StepEvent,
    /// End the mission.
    Abort,
    /// Let another planner drive.
    ChoosePlanner,
    /// Fly a planner in shadow.
    Shadow,
    /// Let the planner in shadow take over.
    Promote,
    /// End the shadow.
    DropShadow,
    /// Fly the better plan that is offered.
    TakePlan,
    /// Forecast how the mission would go on with one planner or another.
    WhatIf,
    /// Forecast another planner too.
    AddCandidate,
    /// Change parameters for a further forecast.
    TryParameters,
    /// Forecast with the parameters that were changed.
    ForecastDraft,
    /// Keep the parameters under a name.
    PresetSave,
    /// Take the parameters that are kept under a name.
    PresetLoad,
    /// Look at the next forecast.
    NextCandidate,
    /// Look at the forecast before.
    PreviousCandidate,
    /// Check everything that the start depends on.
    Preflight,
    /// Have another planner plan, for comparison.
    Compare,
    /// Plan once more.
    PlanAgain,
    /// Give up what is being planned.
    CancelPlan,
    /// Look at the planner's parameters and change them.
    Parameters,
    /// Change one parameter of the planner.
    SetParameter,
    /// Slower.
    Slower,
    /// Faster.
    Faster,
    /// Set the speed.
    SetSpeed,
    /// Acknowledge the selected alarm, or the worst one.
    Acknowledge,
    /// Acknowledge every alarm.
    AcknowledgeAll,
    /// Put an alarm aside for a while, or take it back.
    Shelve,
    /// Make a simulated station fail for a while.
    Inject,
    /// Locate the robot without a station.
    Exclude,
    /// Draws a no-go zone.
    DrawZone,
    /// Locate the robot with a station again.
    Include,
    /// Run an action of an alarm, by its number.
    Remedy(u8),
    /// Show the place of an alarm or an event on the map.
    ShowPlace,
    /// The next event of the same kind.
    NextLike,
    /// The previous event of the same kind.
    PreviousLike,
    /// Copy the line of an event.
    Copy,
    /// Enlarge the map.
    ZoomIn,
    /// Reduce the map.
    ZoomOut,
    /// Show the whole tank.
    WholeTank,
    /// Keep the robot in the middle.
    Follow,
    /// Choose what the map shows.
    Layers,
    /// Put a station or an obstacle in the middle of the map.
    Centre,
    /// Read the map at a cursor.
    Inspect,
    /// Take the mouse from the terminal, or give it back.
    Mouse,
    /// Move the map's window west.
    PanLeft,
    /// Move the map's window east.
    PanRight,
    /// Move the map's window north.
    PanUp,
    /// Move the map's window south.
    PanDown,
    /// Choose the least severity of the events shown.
    Severity,
    /// Filter the events by text.
    Filter,
    /// Go to the next pane.
    NextPane,
    /// Go to the previous pane.
    PreviousPane,
    /// Find a command by its name.
    Commands,
    /// Show keys and commands.
    Help,
    /// Open a scenario.
    Open,
    /// Show the screen of a name.
    GoTo,
    /// Choose the colours.
    Theme,
    /// Show a screen.
    Go(Screen),
    /// Look at the plugins again.
    Reload,
    /// The next missed area.
    NextMissed,
    /// The missed area before.
    PreviousMissed,
    /// Open the same scenario once more.
    Again,
    /// Scan what a run has missed.
    Rescan,
    /// Compute a run again and compare it with its journal.
    Verify,
    /// Write the report of a run.
    Report,
    /// Open the recording of a run in its viewer.
    View,
    /// Play a past run back.
    Replay,
    /// Let the time of the run that is played back go on, or stop it.
    Play,
    /// Go to another moment of the run.
    Jump(Jump),
    /// Go to a moment that is typed.
    Seek,
    /// Set a bookmark, or change its text.
    Bookmark,
    /// Remove a bookmark.
    Unmark,
    /// Note a remark about the whole run.
    Remark,
    /// Read another run beside the one that is played back.
    CompareRun,
    /// Show which floor only one of two runs scanned.
    Difference,
    /// Choose which moments of two runs correspond.
    Align,
    /// Sort the list by something else.
    Sort,
    /// Go back to the screen before; on the first one, leave.
    Back,
    /// Leave the console.
    Leave,
    /// Complete the word that is being typed.
    Complete,
    /// Agree, or take the selected line.
    Accept,
    /// Back without doing anything.
    Cancel,
    /// Select the line above.
    Up,
    /// Select the line below.
    Down,
    /// A page up.
    PageUp,
    /// A page down.
    PageDown,
    /// The first line.
    First,
    /// The last line.
    Last,
    /// Type a value.
    Edit,
}

/// Every action, in the order of the footer and of help.
pub const ACTIONS: &[Action] = &rows::ALL;
