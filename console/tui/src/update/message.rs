//! The messages that go into the model, and the effects that come out.

use crate::actions::ActionId;
use crate::keys::KeyPress;
use crate::model::{
    Combination, Continued, Forecast, GhostPlan, Glimpse, Health, Measured, Preset, Promise, Run, RunId,
    RunResult, Source, Speed, Times,
    glimpse::RunKey,
    home::Found,
    replay::{Align, Reel, Side},
};
use account::{Estimate, InDoubt, LeftOut, Notes, Summary};
use mission::{
    AskId, Check, Event, Order, PlannerChoice, PlannerInfo, RefusedPlugin, Severity, WayBack, ZoneCost,
};
use serde::{Deserialize, Serialize};
use std::fmt;
use world::Point;

/// A message to the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Msg {
    /// A key went down.
    Key(KeyPress),
    /// A space arrived that is not a key: part of a paste or of an answer of the terminal. It stops the robot.
    Stop,
    /// The screen shows the model as it is now, in the frame with this number.
    Drawn(u64),
    /// A key that might have been held down was really pressed, because no other press has followed.
    Settled,
    /// Text was pasted.
    Paste(String),
    /// A command line that comes from a script or from stdin and was not typed on the screen.
    Line(String),
    /// Mouse input.
    Mouse(Mouse),
    /// The terminal has changed size.
    Resize {
        /// The width, columns.
        width: u16,
        /// The height, rows.
        height: u16,
    },
    /// The current time.
    Time(Times),
    /// A measurement of the console itself.
    Measured(Measured),
    /// A message about a run; dropped if the run is no longer open.
    Run(RunId, RunMsg),
    /// The contents of the disk.
    Found(Box<Found>),
    /// The details of a past run, or the reason why it cannot be read, as a sentence.
    Glimpsed(RunKey, Result<Box<Glimpse>, String>),
    /// The saved presets.
    Presets(Vec<Preset>),
    /// A job has finished: its result, or why it failed, as a sentence.
    Done(Job, Result<String, String>),
    /// The result of a survey of the plugins.
    Planners {
        /// The planners to choose from.
        found: Vec<PlannerInfo>,
        /// The refused plugins.
        refused: Vec<RefusedPlugin>,
    },
    /// A message about the console itself; a CRIT one becomes an alarm.
    Notice {
        /// The severity.
        severity: Severity,
        /// The message, as a sentence.
        text: String,
    },
    /// The process received a signal.
    Signal(Signal),
    /// A thread of the console panicked.
    ThreadPanicked {
        /// The name of the thread.
        thread: String,
        /// The panic message.
        message: String,
    },
}

/// Mouse input.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Mouse {
    /// A button was pressed and released at the same place.
    Click(Target),
    /// The mouse was dragged on the map, from one point of the tank to another.
    Drag {
        /// The point where the drag step began, metres.
        from: Point,
        /// The current point, metres.
        to: Point,
    },
    /// The wheel was turned.
    Wheel {
        /// Whether the wheel was turned away from the user.
        up: bool,
        /// The target under the mouse.
        on: Target,
    },
}

/// The screen element under the mouse.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// A point on the map, metres, tank frame.
    Map(Point),
    /// A key name.
    Key(ActionId),
    /// A line in a list, by its index.
    Row(Rows, usize),
    /// Anything else.
    Else,
}

/// A list on a screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rows {
    /// Scenarios on the home screen.
    Scenarios,
    /// Past runs on the home screen.
    Runs,
    /// Problems on the home screen.
    Attention,
    /// The table of alarms.
    Alarms,
    /// The events, newest first.
    Events,
    /// The plugin files.
    Plugins,
    /// The missed areas on the result screen.
    Missed,
    /// The areas that the plan leaves out, on the plan screen.
    LeftOut,
    /// Past runs on the review screen.
    Past,
}

/// A message about an open run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum RunMsg {
    /// The scenario could not be opened; the reason, with file, line and key.
    OpenFailed(String),
    /// Events of the mission.
    Events(Vec<Event>),
    /// The console that runs the mission has exited without closing the run; sent only to a view-only console.
    WriterGone,
    /// The health of the engine.
    Health(Health),
    /// An order did not reach the mission.
    OrderFailed {
        /// The order.
        order: Order,
        /// The reason, as a sentence.
        why: String,
    },
    /// Long work by a planner (`Planning (rpf)`) and its time limit, seconds; `None` when the work is done.
    Busy(Option<(String, Option<f64>)>),
    /// The progress of that work.
    BusyAt {
        /// The share done, 0 to 1.
        share: f64,
        /// The current activity in a few words; may be empty.
        what: String,
    },
    /// The results of the checks before the start: disk, recorder, engine, clock.
    Checked(Vec<Check>),
    /// The estimate for a plan, and the ask that the plan answers.
    Estimated(Option<AskId>, Box<Estimate>),
    /// The figures that the plan of the start promised, computed again from the journal of a run.
    Promised(Box<Promise>),
    /// The way back of the held robot, or the reason why there is none, as a sentence.
    WayBack(Result<WayBack, String>),
    /// The cost of a no-go zone with these corners, or the reason why it would be refused, as a sentence.
    ZoneCost(Vec<Point>, Result<ZoneCost, String>),
    /// The floor whose guarantee was taken back so far, oldest first.
    InDoubt(Vec<InDoubt>),
    /// The floor that a plan leaves out, for the plan that answers the given ask.
    LeftOut(Option<AskId>, Box<LeftOut>),
    /// The progress of the plan for comparison: the share done, and the current activity.
    CompareAt(f64, String),
    /// The plan for comparison, or why there is none, as a sentence.
    Compared(PlannerChoice, Result<Box<GhostPlan>, String>),
    /// The progress of a planner's forecast: the share of the task done.
    ForecastAt(PlannerChoice, f64),
    /// The forecast for a planner, or why there is none, as a sentence.
    Forecast(PlannerChoice, Result<Box<Forecast>, String>),
    /// The run has ended and its files are closed.
    Closed(Box<RunResult>),
    /// The floor scanned by the runs before a re-scan, or why that is unknown, as a sentence.
    ScannedBefore(Result<Box<Combination>, String>),
    /// The floor scanned by a re-scan and by the runs before it together, or why that is unknown, as a sentence.
    Combined(Result<Box<Combination>, String>),
    /// The run is a re-scan of these runs, oldest first, or why they cannot be found, as a sentence.
    Continues(Result<Continued, String>),
    /// A message about a replay.
    Replay(ReplayMsg),
}

/// A message about a replay.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum ReplayMsg {
    /// More of a run has been loaded; contains only the new marks.
    Loaded(Side, Reel),
    /// The run at another moment.
    At(Side, Box<Run>),
    /// The events between the previous moment and a later one.
    Moved(Side, Vec<Event>),
    /// Playback has stopped at the end of the run.
    Stopped,
    /// The report of a run; for the replayed run, also where it is stored.
    Reported(Side, Box<Summary>, String),
    /// A run cannot be read; the reason, as a sentence.
    Failed(Side, String),
    /// The notes about the replayed run, or why they cannot be read or written.
    Noted(Result<Notes, String>),
}

/// A request to the replay.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Transport {
    /// Play or pause.
    Play(bool),
    /// Seek to a moment: mission time, seconds.
    Seek(f64),
    /// Change how moments of the two runs are matched.
    Align(Align),
    /// Load a second run for comparison, by the name of its folder; `None` removes it.
    Compare(Option<String>),
    /// Save the notes.
    Keep(Notes),
}

/// A signal to the process.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(strum::EnumCount))]
pub enum Signal {
    /// SIGINT: same as Ctrl-C.
    Interrupt,
    /// SIGTERM: hold and quit.
    Terminate,
    /// SIGHUP, or the terminal was closed: hold and quit.
    Hangup,
    /// Any other signal that would end the process, by number: hold and quit.
    End(i32),
    /// SIGTSTP: hold, then suspend and restore the terminal.
    Stop,
    /// SIGCONT: redraw.
    Continue,
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Interrupt => "SIGINT",
            Self::Terminate => "SIGTERM",
            Self::Hangup => "SIGHUP",
            Self::End(number) => return write!(f, "signal {number}"),
            Self::Stop => "SIGTSTP",
            Self::Continue => "SIGCONT",
        })
    }
}

/// Background work on a past run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Job {
    /// Recompute a run and compare it with its journal.
    Verify(String),
    /// Write the report of a run next to its journal.
    Report(String),
    /// Open the recording of a run in the viewer.
    View(String),
    /// Open the recording at the current moment of the replay, such as `T+00:12:30`.
    ViewAt(String, String),
}

/// A query to the mission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Query {
    /// The way back from here.
    WayBack,
    /// The cost of a no-go zone with these corners, metres, tank frame.
    ZoneCost(Vec<Point>),
}

/// An effect that the caller carries out, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Effect {
    /// Close the open run, if any, and open a scenario.
    Open {
        /// The id of the new run.
        id: RunId,
        /// The scenario.
        source: Source,
        /// The planner to use instead of the scenario's.
        planner: Option<PlannerChoice>,
        /// The speed of the mission.
        speed: Speed,
    },
    /// Close the open run, if any, and replay a past one.
    Replay {
        /// The id of the new run.
        id: RunId,
        /// The name of the run's folder.
        run: String,
    },
    /// A request to the open replay.
    Transport(Transport),
    /// Run the start checks that need access outside the screen.
    Check {
        /// The expected size of the mission's recording, bytes.
        needed_bytes: u64,
    },
    /// Have a different planner plan the waiting mission, for comparison; cancels any such planning in progress.
    Compare(PlannerChoice),
    /// Forecast how the held mission would continue with the given planners; cancels any forecasts in progress.
    Forecast(Vec<PlannerChoice>),
    /// Cancel the forecasts in progress.
    StopForecasting,
    /// Cancel the plan for comparison that is being made.
    StopComparing,
    /// Save a planner's parameters as a preset.
    SavePreset {
        /// The name of the preset.
        name: String,
        /// The planner with the value of every parameter.
        choice: PlannerChoice,
    },
    /// Combine the scanned floor of several runs in one tank; the last run is a re-scan of what the others missed.
    Combine(Vec<String>),
    /// Rescan the plugins.
    Survey,
    /// Rescan the scenarios, past runs and disk space.
    Look,
    /// Read the details of a past run; replaces an earlier request that has not been answered.
    Glimpse(RunKey),
    /// Abandon reading the details of a past run.
    StopGlimpsing,
    /// Start a background job.
    Do(Job),
    /// Write a handover page.
    HandOver {
        /// The file.
        file: String,
        /// The text.
        page: String,
        /// Whether a handover page in that file is replaced.
        overwrite: bool,
    },
    /// Send a query to the mission; nothing changes.
    Ask(Query),
    /// Give the mission an order.
    Order(Order),
    /// Change the simulation speed.
    Speed(Speed),
    /// Redraw every cell.
    Redraw,
    /// Restore the terminal and stop the process until SIGCONT.
    Suspend,
    /// Ring the terminal's bell.
    Bell,
    /// Turn mouse capture on or off.
    Mouse(bool),
    /// Copy a line to the terminal's clipboard.
    Copy(String),
    /// Close the recording and quit. Orders earlier in the list must be carried out first.
    Quit {
        /// The signal that requested it, if any.
        signal: Option<Signal>,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use strum::EnumCount;

    #[test]
    fn every_signal_has_a_word_of_its_own() {
        let all: [Signal; Signal::COUNT] = [
            Signal::Interrupt,
            Signal::Terminate,
            Signal::Hangup,
            Signal::End(3),
            Signal::Stop,
            Signal::Continue,
        ];
        let words: BTreeSet<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(words.len(), all.len(), "{words:?}");
        assert!(words.iter().all(|word| !word.is_empty() && !word.contains('_')), "{words:?}");
    }
}
