//! What goes into the model, and what has to be done outside in answer.

use crate::keys::KeyPress;
use crate::model::{Health, Refused, RunId, RunResult, Source, Speed, Times, home::Found};
use mission::{Event, Order, PlannerChoice, PlannerInfo, Severity};
use serde::{Deserialize, Serialize};

/// What reaches the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Msg {
    /// A key went down.
    Key(KeyPress),
    /// Text was pasted.
    Paste(String),
    /// A command line that was not typed into the screen: from a script or from stdin.
    Line(String),
    /// The terminal has this size now.
    Resize {
        /// Columns.
        width: u16,
        /// Rows.
        height: u16,
    },
    /// The time.
    Time(Times),
    /// News of a run; of one that is not open any more it is dropped.
    Run(RunId, RunMsg),
    /// What was found on the disk.
    Found(Box<Found>),
    /// A job is done, or why it failed, as a sentence.
    Done(Job, Result<String, String>),
    /// Which planners were found, and which plugins were not accepted.
    Planners {
        /// Planners to choose from.
        found: Vec<PlannerInfo>,
        /// Plugins that cannot be chosen.
        refused: Vec<Refused>,
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

/// News of a run that is open.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum RunMsg {
    /// The scenario could not be opened, with file, line and key.
    OpenFailed(String),
    /// Events of the mission.
    Events(Vec<Event>),
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
    /// The run has ended and its files are closed.
    Closed(Box<RunResult>),
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
    },
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
    /// Close the recording and leave. Orders before it in the list are to be obeyed first.
    Quit {
        /// The signal that asked for it, if one did.
        signal: Option<Signal>,
    },
}
