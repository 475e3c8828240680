//! What goes into the model, and what has to be done outside in answer.

use crate::actions::ActionId;
use crate::keys::KeyPress;
use crate::model::{
    Forecast, GhostPlan, Health, Measured, Preset, Run, RunId, RunResult, Source, Speed, Times,
    home::Found,
    replay::{Align, Reel, Side},
};
use account::{Account, Estimate, Notes, Summary};
use mission::{AskId, Check, Event, Order, PlannerChoice, PlannerInfo, RefusedPlugin, Severity};
use serde::{Deserialize, Serialize};
use world::Point;

/// What reaches the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Msg {
    /// A key went down.
    Key(KeyPress),
    /// A key that might have been held down was pressed: no other press has followed.
    Settled,
    /// Text was pasted.
    Paste(String),
    /// A command line that was not typed into the screen: from a script or from stdin.
    Line(String),
    /// The mouse did something.
    Mouse(Mouse),
    /// The terminal has this size now.
    Resize {
        /// Columns.
        width: u16,
        /// Rows.
        height: u16,
    },
    /// The time.
    Time(Times),
    /// What the console measured of itself.
    Measured(Measured),
    /// News of a run; of one that is not open any more it is dropped.
    Run(RunId, RunMsg),
    /// What was found on the disk.
    Found(Box<Found>),
    /// Which parameters are kept under names.
    Presets(Vec<Preset>),
    /// A job is done, or why it failed, as a sentence.
    Done(Job, Result<String, String>),
    /// Which planners were found, and which plugins were not accepted.
    Planners {
        /// Planners to choose from.
        found: Vec<PlannerInfo>,
        /// Plugins that cannot be chosen.
        refused: Vec<RefusedPlugin>,
    },
    /// News of the console itself; a CRIT one becomes an alarm.
    Notice {
        /// How much it asks of the operator.
        severity: Severity,
        /// What, as a sentence.
        text: String,
    },
    /// The process was sent a signal.
    Signal(Signal),
    /// A thread of the console panicked.
    ThreadPanicked {
        /// Its name.
        thread: String,
        /// What it said.
        message: String,
    },
}

/// What the mouse did.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Mouse {
    /// A button was pressed and came up at the same place.
    Click(Target),
    /// It was dragged on the map, from one place in the tank to another.
    Drag {
        /// Place where it was, metres.
        from: Point,
        /// Place where it is, metres.
        to: Point,
    },
    /// The wheel was turned.
    Wheel {
        /// Away from the operator.
        up: bool,
        /// What it was on.
        on: Target,
    },
}

/// What the mouse is on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// A place on the map, metres, tank frame.
    Map(Point),
    /// The name of a key.
    Key(ActionId),
    /// A line of a list, by its place in it.
    Row(Rows, usize),
    /// Something else.
    Else,
}

/// A list of a screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rows {
    /// Scenarios on the home screen.
    Scenarios,
    /// Past runs on the home screen.
    Runs,
    /// The table of alarms.
    Alarms,
    /// The events, the newest first.
    Events,
    /// Plugin files.
    Plugins,
    /// Missed areas of the result.
    Missed,
    /// Past runs on the review screen.
    Past,
}

/// News of a run that is open.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum RunMsg {
    /// The scenario could not be opened, with file, line and key.
    OpenFailed(String),
    /// Events of the mission.
    Events(Vec<Event>),
    /// The console that flies the run is gone without having closed it; only who looks on hears that.
    WriterGone,
    /// How the engine does.
    Health(Health),
    /// An order did not reach the mission.
    OrderFailed {
        /// Which.
        order: Order,
        /// Why, as a sentence.
        why: String,
    },
    /// What a planner is doing that takes its time (`Planning (rpf)`), and how long that may take, seconds; `None` when
    /// it is done.
    Busy(Option<(String, Option<f64>)>),
    /// How far that is.
    BusyAt {
        /// Share done, 0 to 1.
        share: f64,
        /// What is being done, a few words; may be empty.
        what: String,
    },
    /// What was found before the start: disk, recorder, engine, clock.
    Checked(Vec<Check>),
    /// What a plan promises, and the ask that it answers.
    Estimated(Option<AskId>, Box<Estimate>),
    /// How far the plan is that is made for comparison: the share done, and what is being done.
    CompareAt(f64, String),
    /// A plan was made for comparison, or why not, as a sentence.
    Compared(PlannerChoice, Result<Box<GhostPlan>, String>),
    /// How far the forecast of a planner is: the share of the task done.
    ForecastAt(PlannerChoice, f64),
    /// How the mission would go on with a planner, or why that is not known, as a sentence.
    Forecast(PlannerChoice, Result<Box<Forecast>, String>),
    /// The run has ended and its files are closed.
    Closed(Box<RunResult>),
    /// What a re-scan and the runs before it scanned together, or why that is not known, as a sentence.
    Combined(Result<Box<Account>, String>),
    /// News of a past run that is played back.
    Replay(ReplayMsg),
}

/// News of a past run that is played back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum ReplayMsg {
    /// More of a run is loaded; the marks are those that are new.
    Loaded(Side, Reel),
    /// The run at another moment.
    At(Side, Box<Run>),
    /// Events between the moment before and a later one.
    Moved(Side, Vec<Event>),
    /// The time of the run goes on no more: its end is reached.
    Stopped,
    /// The report of a run; for the one that is played with where it is kept.
    Reported(Side, Box<Summary>, String),
    /// A run cannot be read, with the reason as a sentence.
    Failed(Side, String),
    /// What people noted about the run that is played, or why that cannot be read or written.
    Noted(Result<Notes, String>),
}

/// What a replay is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Transport {
    /// Let time go on, or stop it.
    Play(bool),
    /// Go to a moment: mission time, seconds.
    Seek(f64),
    /// Which moments of the two runs correspond.
    Align(Align),
    /// Read another run beside it, by the name of its folder, or none.
    Compare(Option<String>),
    /// Keep what people noted.
    Keep(Notes),
}

/// A signal to the process.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Signal {
    /// SIGINT: as Ctrl-C.
    Interrupt,
    /// SIGTERM: hold and leave.
    Terminate,
    /// SIGHUP, or the terminal was closed: hold and leave.
    Hangup,
    /// Any other signal that would end the process, by its number: hold and leave.
    End(i32),
    /// SIGTSTP: hold and give the terminal back for a while.
    Stop,
    /// SIGCONT: redraw.
    Continue,
}

/// Work on past runs that is done beside the screen.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Job {
    /// Compute a run again and compare it with its journal.
    Verify(String),
    /// Write the report of a run beside its journal.
    Report(String),
    /// Open the recording of a run in the viewer.
    View(String),
    /// The same while the run is played back, with the moment that is shown, such as `T+00:12:30`.
    ViewAt(String, String),
}

/// What the caller has to do, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Effect {
    /// Close the run that is open, if one is, and open a scenario.
    Open {
        /// What the new run is called.
        id: RunId,
        /// The scenario.
        source: Source,
        /// The planner to use instead of the scenario's.
        planner: Option<PlannerChoice>,
        /// How fast it shall go.
        speed: Speed,
    },
    /// Close the run that is open, if one is, and play a past one back.
    Replay {
        /// What the new run is called.
        id: RunId,
        /// Name of its folder.
        run: String,
    },
    /// Something for the replay that is open.
    Transport(Transport),
    /// Look at everything outside the screen that the start depends on.
    Check {
        /// Space that the recording of the mission is expected to take, bytes.
        needed_bytes: u64,
    },
    /// Have another planner plan the mission that waits, for comparison; one that is being made is given up.
    Compare(PlannerChoice),
    /// Forecast how the held mission would go on with some planners; forecasts that are being made are given up.
    Forecast(Vec<PlannerChoice>),
    /// Give up the forecasts that are being made.
    StopForecasting,
    /// Give up the plan that is being made for comparison.
    StopComparing,
    /// Keep parameters of a planner under a name.
    SavePreset {
        /// The name.
        name: String,
        /// The planner with the value of every parameter.
        choice: PlannerChoice,
    },
    /// Take together what runs on one floor have scanned: the last one is a re-scan of what the others missed.
    Combine(Vec<String>),
    /// Look at the plugins again.
    Survey,
    /// Look at scenarios, past runs and the disk again.
    Look,
    /// Do something beside the screen.
    Do(Job),
    /// Give the mission an order.
    Order(Order),
    /// Change the pace of the simulation.
    Speed(Speed),
    /// Redraw every cell.
    Redraw,
    /// Give the terminal back and stop the process until SIGCONT.
    Suspend,
    /// Ring the terminal's bell.
    Bell,
    /// Take the mouse from the terminal, or give it back.
    Mouse(bool),
    /// Put a line into the clipboard of the terminal.
    Copy(String),
    /// Close the recording and leave. Orders before it in the list are to be obeyed first.
    Quit {
        /// The signal that asked for it, if one did.
        signal: Option<Signal>,
    },
}
