//! Everything the operator can do, in one table: keys, footer, help, commands, their reference and `keys.toml` come from it.

mod action;
mod argument;
pub mod context;
pub mod find;
pub mod keymap;
#[cfg(test)]
mod tests;

pub use action::{Action, Risk};
pub use argument::{Arg, Kind, duration_s, moment_s};

use crate::keys::Key;
use crate::model::replay::Jump;
use action::action;
use argument::{may, must};
use context::Context;
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
    /// Show a screen.
    GoTo,
    /// Choose the colours.
    Theme,
    /// Show what there is to open.
    GoHome,
    /// Show the mission before it moves.
    GoPlan,
    /// Show the mission under way.
    GoMission,
    /// Show what is wrong.
    GoAlarms,
    /// Show what happened.
    GoEvents,
    /// Show the past runs.
    GoReview,
    /// Show what the mission has achieved.
    GoResult,
    /// Show the plugins.
    GoPlugins,
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
#[rustfmt::skip]
pub const ACTIONS: &[Action] = &[
    action(ActionId::Hold, "hold", "HOLD now; if held, ask to resume", &[Key::Char(' ')], &[Context::Anywhere]).label("HOLD").also(&["stop", "pause", "halt"]),
    action(ActionId::Interrupt, "interrupt", "HOLD now; twice: ask to quit", &[Key::Ctrl('c')], &[Context::Anywhere]),
    action(ActionId::Start, "start", "Start the mission", &[Key::Char('S')], &[Context::Plan, Context::Mission]).label("start").risk(Risk::Moves),
    action(ActionId::Resume, "resume", "Resume after a hold", &[], &[Context::Screen]).risk(Risk::Moves).also(&["continue"]),
    action(ActionId::FlyUncertified, "fly-uncertified", "Run a plan refused because of the tether", &[], &[Context::Screen]).risk(Risk::Moves),
    action(ActionId::Step, "step", "Move for one tick (while held)", &[Key::Char('.')], &[Context::Mission]).label("step").risk(Risk::Moves),
    action(ActionId::Slower, "slower", "Slower simulation", &[Key::Char('<')], &[Context::Screen]).label("speed").repeats(),
    action(ActionId::Faster, "faster", "Faster simulation", &[Key::Char('>')], &[Context::Screen]).label("speed").repeats(),
    action(ActionId::SetSpeed, "speed", "Set the speed of the simulation", &[], &[Context::Screen]).args(&[must("factor", Kind::Speed)]).also(&["rate", "pace"]),
    action(ActionId::Abort, "end", "HOLD, then ask to end the mission", &[Key::Char('X')], &[Context::Screen]).label("end").risk(Risk::Destroys).also(&["abort", "finish"]),
    action(ActionId::ChoosePlanner, "planner", "Change the planner (while held)", &[Key::Char('P')], &[Context::Plan, Context::Mission]).label("planner").risk(Risk::Moves).args(&[may("planner", Kind::Planner)]),
    action(ActionId::Shadow, "shadow", "Fly a planner in shadow", &[], &[Context::Screen]).args(&[may("planner", Kind::Planner)]),
    action(ActionId::Promote, "promote", "Let the planner in shadow take over", &[], &[Context::Screen]).risk(Risk::Moves),
    action(ActionId::DropShadow, "shadow-off", "End the shadow", &[], &[Context::Screen]),
    action(ActionId::TakePlan, "take-plan", "Take the better plan that is offered", &[Key::Char('T')], &[Context::Mission]).risk(Risk::Moves),
    action(ActionId::Parameters, "parameters", "View and change planner parameters", &[Key::Char('p')], &[Context::Plan, Context::Mission]).label("parameters"),
    action(ActionId::SetParameter, "set", "Change a planner parameter", &[], &[Context::Screen]).args(&[must("parameter", Kind::Parameter)]),
    action(ActionId::WhatIf, "what-if", "Forecast with other planners (held)", &[Key::Char('w')], &[Context::Mission]).label("what-if"),
    action(ActionId::NextCandidate, "next-candidate", "Look at the next forecast", &[Key::Right, Key::Char('l')], &[Context::WhatIf]).label("select").repeats(),
    action(ActionId::PreviousCandidate, "previous-candidate", "Look at the forecast before", &[Key::Left, Key::Char('h')], &[Context::WhatIf]).label("select").repeats(),
    action(ActionId::AddCandidate, "add-candidate", "Forecast another planner", &[Key::Char('+')], &[Context::WhatIf]).label("add"),
    action(ActionId::TryParameters, "try-parameters", "Change parameters for a further forecast", &[Key::Char('p')], &[Context::WhatIf]).label("parameters"),
    action(ActionId::ForecastDraft, "forecast-draft", "Forecast with these parameters", &[Key::Char('w')], &[Context::Draft]).label("forecast"),
    action(ActionId::PresetLoad, "preset-load", "Show what a parameter preset changes", &[], &[Context::Screen]).args(&[must("preset", Kind::Preset)]),
    action(ActionId::PresetSave, "preset-save", "Keep the parameters as a preset", &[], &[Context::Screen]).args(&[must("name", Kind::Text)]),
    action(ActionId::Preflight, "preflight", "Check what the start depends on", &[Key::Char('A')], &[Context::Plan, Context::Mission]).label("pre-flight"),
    action(ActionId::Compare, "compare", "Plan with another planner, side by side", &[Key::Char('c')], &[Context::Plan]).label("compare").args(&[may("planner", Kind::Planner)]),
    action(ActionId::Preflight, "check-again", "Check once more", &[Key::Char('r')], &[Context::Preflight]).label("check again"),
    action(ActionId::PlanAgain, "plan-again", "Make the plan once more", &[], &[Context::Plan]),
    action(ActionId::CancelPlan, "cancel-plan", "Cancel planning or comparing", &[Key::Esc], &[Context::Plan]).label("cancel"),
    action(ActionId::Acknowledge, "acknowledge", "Acknowledge the most severe alarm", &[Key::Char('a')], &[Context::Home, Context::Plan, Context::Mission, Context::Alarms, Context::Events, Context::Review, Context::Result, Context::Plugins]).label("ack").also(&["silence"]),
    action(ActionId::AcknowledgeAll, "acknowledge-all", "Acknowledge every alarm", &[Key::Char('*')], &[Context::Alarms]).label("ack all"),
    action(ActionId::Open, "open", "Open a scenario", &[], &[Context::Screen]).args(&[must("scenario", Kind::Scenario), may("planner", Kind::Planner)]),
    action(ActionId::NextMissed, "next-missed", "Show the next missed area", &[Key::Char('n')], &[Context::Result]).label("missed").repeats(),
    action(ActionId::PreviousMissed, "previous-missed", "Show the missed area before", &[Key::Char('N')], &[Context::Result]).label("missed").repeats(),
    action(ActionId::Again, "again", "Plan the same scenario again", &[Key::Char('p')], &[Context::Result]).label("plan again"),
    action(ActionId::Shelve, "shelve", "Shelve the alarm, or take it back", &[Key::Char('d')], &[Context::Alarms]).label("shelve").args(&[may("time", Kind::Duration), may("reason", Kind::Text), may("alarm", Kind::Alarm)]),
    action(ActionId::Inject, "inject", "Make a simulated station fail (training)", &[], &[Context::Screen]).args(&[must("station", Kind::Station), must("fault", Kind::Fault), must("time", Kind::Duration)]),
    action(ActionId::DrawZone, "no-go", "Draw a no-go zone between two corners", &[], &[Context::Screen]).args(&[must("corner", Kind::Corner), must("opposite", Kind::Corner)]),
    action(ActionId::Exclude, "exclude", "Locate the robot without a station", &[], &[Context::Screen]).args(&[must("station", Kind::Station)]),
    action(ActionId::Include, "include", "Use an excluded station again", &[], &[Context::Screen]).args(&[must("station", Kind::Station)]),
    action(ActionId::ShowPlace, "show-place", "Show the place on the map", &[Key::Char('m')], &[Context::Alarms, Context::Events]).label("map"),
    action(ActionId::NextLike, "next-like", "Next event of the same kind", &[Key::Char('n')], &[Context::Events]).label("same kind"),
    action(ActionId::PreviousLike, "previous-like", "Previous event of the same kind", &[Key::Char('N')], &[Context::Events]).label("same kind"),
    action(ActionId::Copy, "copy", "Copy the line of the event", &[Key::Char('y')], &[Context::Events]).label("copy"),
    action(ActionId::Play, "play", "Play the run, or pause it (<hold>)", &[], &[Context::Replay]),
    action(ActionId::Jump(Jump::TickBack), "tick-back", "Go back by one tick", &[Key::Char(',')], &[Context::Replay]).label("tick").repeats(),
    action(ActionId::Jump(Jump::Tick), "tick-on", "Go on by one tick", &[Key::Char('.')], &[Context::Replay]).label("tick").repeats(),
    action(ActionId::Jump(Jump::EventBack), "event-back", "Go to the event before", &[Key::Char('[')], &[Context::Replay]).label("event").repeats(),
    action(ActionId::Jump(Jump::Event), "event-on", "Go to the next event", &[Key::Char(']')], &[Context::Replay]).label("event").repeats(),
    action(ActionId::Jump(Jump::AlarmBack), "alarm-back", "Go to the alarm before", &[Key::Char('{')], &[Context::Replay]).label("alarm").repeats(),
    action(ActionId::Jump(Jump::Alarm), "alarm-on", "Go to the next alarm", &[Key::Char('}')], &[Context::Replay]).label("alarm").repeats(),
    action(ActionId::Jump(Jump::MinuteBack), "minute-back", "Go back by one minute", &[Key::Char('(')], &[Context::Replay]).label("minute").repeats(),
    action(ActionId::Jump(Jump::Minute), "minute-on", "Go on by one minute", &[Key::Char(')')], &[Context::Replay]).label("minute").repeats(),
    action(ActionId::Jump(Jump::Start), "to-start", "Go to the beginning of the run", &[Key::Char('^')], &[Context::Replay]),
    action(ActionId::Jump(Jump::End), "to-end", "Go to the end of the run", &[Key::Char('$')], &[Context::Replay]),
    action(ActionId::Seek, "seek", "Go to a moment of the run", &[], &[Context::Replay]).args(&[must("moment", Kind::Moment)]),
    action(ActionId::Bookmark, "bookmark", "Set a bookmark, or change its text", &[Key::Char('b')], &[Context::Replay]).label("bookmark").args(&[may("text", Kind::Text)]),
    action(ActionId::Unmark, "remove-bookmark", "Remove the bookmark at this moment", &[Key::Char('B')], &[Context::Replay]),
    action(ActionId::Jump(Jump::Bookmark), "next-bookmark", "Go to the next bookmark", &[Key::Char('n')], &[Context::Replay]).repeats(),
    action(ActionId::Jump(Jump::BookmarkBack), "previous-bookmark", "Go to the bookmark before", &[Key::Char('N')], &[Context::Replay]).repeats(),
    action(ActionId::Remark, "remark", "Note a remark about the whole run", &[], &[Context::Replay]).args(&[must("text", Kind::Text)]),
    action(ActionId::Difference, "difference", "Show floor that only one run scanned", &[Key::Char('D')], &[Context::Replay]).label("difference"),
    action(ActionId::Align, "align", "Align two runs by time, path or place", &[Key::Char('T')], &[Context::Replay]).label("align"),
    action(ActionId::Replay, "replay", "Play a past run back", &[], &[Context::Screen]).args(&[may("run", Kind::Run)]),
    action(ActionId::CompareRun, "compare-run", "Compare a run with the one played back", &[Key::Char('c')], &[Context::Review]).label("compare").args(&[may("run", Kind::Run)]),
    action(ActionId::Sort, "sort", "Sort the list by something else", &[Key::Char('s')], &[Context::Review]).label("sort"),
    action(ActionId::Rescan, "rescan", "Scan what a run has missed", &[Key::Char('r')], &[Context::Home, Context::Review, Context::Result]).label("re-scan").args(&[may("run", Kind::Run)]),
    action(ActionId::Verify, "verify", "Recompute a run, compare its journal", &[Key::Char('v')], &[Context::Home, Context::Review, Context::Result]).label("verify").args(&[may("run", Kind::Run)]),
    action(ActionId::Report, "report", "Write the report of a run", &[Key::Char('w')], &[Context::Home, Context::Review, Context::Result]).label("report").args(&[may("run", Kind::Run)]),
    action(ActionId::View, "view", "Open the recording of a run in rerun", &[Key::Char('o')], &[Context::Home, Context::Review, Context::Replay, Context::Result]).label("rerun").args(&[may("run", Kind::Run)]),
    action(ActionId::Commands, "commands", "Find a command by name", &[Key::Char(':'), Key::Ctrl('p')], &[Context::Screen]).label("command"),
    action(ActionId::Help, "help", "Show keys and commands", &[Key::Char('?'), Key::F(1)], &[Context::Screen]).label("keys"),
    action(ActionId::NextPane, "next-pane", "Go to the next pane", &[Key::Tab], &[Context::Screen]).label("pane").repeats(),
    action(ActionId::PreviousPane, "previous-pane", "Go to the previous pane", &[Key::BackTab], &[Context::Screen]).repeats(),
    action(ActionId::GoTo, "goto", "Show a screen", &[], &[Context::Screen]).args(&[must("screen", Kind::Screen)]),
    action(ActionId::GoHome, "home", "Screen 1: scenarios and past runs", &[Key::Char('1')], &[Context::Screen]),
    action(ActionId::GoPlan, "plan", "Screen 2: the plan before it moves", &[Key::Char('2')], &[Context::Screen]),
    action(ActionId::GoMission, "mission", "Screen 3: the mission", &[Key::Char('3')], &[Context::Screen]),
    action(ActionId::GoAlarms, "alarms", "Screen 4: what is wrong, what to do", &[Key::Char('4')], &[Context::Screen]),
    action(ActionId::GoEvents, "events", "Screen 5: what happened", &[Key::Char('5')], &[Context::Screen]),
    action(ActionId::GoReview, "review", "Screen 6: past runs: replay, compare", &[Key::Char('6')], &[Context::Screen]),
    action(ActionId::GoResult, "result", "Screen 7: what was achieved", &[Key::Char('7')], &[Context::Screen]),
    action(ActionId::GoPlugins, "plugins", "Screen 8: plugins and their planners", &[Key::Char('8')], &[Context::Screen]),
    action(ActionId::Reload, "reload", "Look at the plugins again", &[Key::Char('r')], &[Context::Plugins]).label("reload"),
    action(ActionId::Back, "back", "Go back; the mission goes on", &[Key::Char('q')], &[Context::Screen]).label("back"),
    action(ActionId::Leave, "leave", "Quit; a running mission is held first", &[], &[Context::Screen]).also(&["quit", "exit"]),
    action(ActionId::Theme, "theme", "Choose the colours", &[], &[Context::Screen]).args(&[must("theme", Kind::Theme)]),
    action(ActionId::ZoomIn, "zoom-in", "Zoom in", &[Key::Char('z')], &[Context::Map]).repeats(),
    action(ActionId::ZoomOut, "zoom-out", "Zoom out", &[Key::Char('Z')], &[Context::Map]).repeats(),
    action(ActionId::WholeTank, "whole-tank", "Show the whole tank", &[Key::Char('0')], &[Context::Map]),
    action(ActionId::Follow, "follow", "Keep the map centred on the robot", &[Key::Char('f')], &[Context::Map]),
    action(ActionId::Layers, "layers", "Show or hide map layers", &[Key::Char('L')], &[Context::Map]).args(&[may("layer", Kind::Layer)]),
    action(ActionId::Centre, "centre", "Centre the map on a named object", &[], &[Context::Map]).args(&[must("place", Kind::Place)]),
    action(ActionId::Inspect, "inspect", "Read the map at a cursor (<cancel>: end)", &[Key::Char('i')], &[Context::Map]),
    action(ActionId::Mouse, "mouse", "Use the mouse in the console, or not", &[], &[Context::Screen]),
    action(ActionId::Severity, "severity", "Minimum severity of the events shown", &[Key::Char('m')], &[Context::Mission, Context::Replay]).args(&[may("severity", Kind::Severity)]),
    action(ActionId::Filter, "filter", "Filter the list", &[Key::Char('/')], &[Context::Home, Context::Mission, Context::Replay, Context::Events, Context::Review]).args(&[may("text", Kind::Text)]),
    action(ActionId::PanLeft, "pan-west", "Pan the map west", &[Key::Left, Key::Char('h')], &[Context::Pan]).repeats(),
    action(ActionId::PanRight, "pan-east", "Pan the map east", &[Key::Right, Key::Char('l')], &[Context::Pan]).repeats(),
    action(ActionId::PanUp, "pan-north", "Pan the map north", &[Key::Up, Key::Char('k')], &[Context::Pan]).repeats(),
    action(ActionId::PanDown, "pan-south", "Pan the map south", &[Key::Down, Key::Char('j')], &[Context::Pan]).repeats(),
    action(ActionId::Redraw, "redraw", "Redraw the screen", &[Key::Ctrl('l')], &[Context::Anywhere]),
    action(ActionId::Suspend, "suspend", "HOLD, then suspend to the shell (fg)", &[Key::Ctrl('z')], &[Context::Anywhere]),
    action(ActionId::Edit, "edit", "Edit the value", &[Key::Char('e')], &[Context::Parameters]).label("edit"),
    action(ActionId::Complete, "complete", "Complete the word", &[Key::Tab], &[Context::Text]).label("complete"),
    action(ActionId::Remedy(1), "first-action", "Run action 1 of the alarm", &[Key::Char('1')], &[Context::Remedies]),
    action(ActionId::Remedy(2), "second-action", "Run action 2 of the alarm", &[Key::Char('2')], &[Context::Remedies]),
    action(ActionId::Remedy(3), "third-action", "Run action 3 of the alarm", &[Key::Char('3')], &[Context::Remedies]),
    action(ActionId::Remedy(4), "fourth-action", "Run action 4 of the alarm", &[Key::Char('4')], &[Context::Remedies]),
    action(ActionId::Accept, "accept", "Confirm, or select the line", &[Key::Enter], &[Context::Rows, Context::Text, Context::Confirm, Context::Stepping, Context::WhatIf]).label("yes"),
    action(ActionId::Step, "step", "Move for one more tick", &[Key::Char('.')], &[Context::Stepping]).label("step").risk(Risk::Moves),
    action(ActionId::StepLane, "step-lane", "Move to the end of the lane", &[Key::Char('}')], &[Context::Stepping]).label("lane").risk(Risk::Moves),
    action(ActionId::StepEvent, "step-event", "Move to the next event", &[Key::Char(']')], &[Context::Stepping]).label("event").risk(Risk::Moves),
    action(ActionId::Cancel, "cancel", "Cancel", &[Key::Esc], &[Context::Text, Context::Stepping, Context::Cursor]).label("cancel"),
    action(ActionId::Cancel, "cancel", "Cancel", &[Key::Esc, Key::Char('q')], &[Context::List, Context::Confirm, Context::WhatIf]).label("cancel"),
    action(ActionId::Up, "up", "Select the line above", &[Key::Up, Key::Char('k')], &[Context::Rows]).repeats(),
    action(ActionId::Down, "down", "Select the line below", &[Key::Down, Key::Char('j')], &[Context::Rows]).repeats(),
    action(ActionId::PageUp, "page-up", "Ten lines up", &[Key::PageUp, Key::Ctrl('u')], &[Context::Rows]).repeats(),
    action(ActionId::PageDown, "page-down", "Ten lines down", &[Key::PageDown, Key::Ctrl('d')], &[Context::Rows]).repeats(),
    action(ActionId::First, "first", "Go to the first line", &[Key::Home, Key::Char('g')], &[Context::Rows]),
    action(ActionId::Last, "last", "Go to the last line", &[Key::End, Key::Char('G')], &[Context::Rows]),
    action(ActionId::Up, "up", "Select the line above", &[Key::Up], &[Context::Commands]).repeats(),
    action(ActionId::Down, "down", "Select the line below", &[Key::Down], &[Context::Commands]).repeats(),
];
