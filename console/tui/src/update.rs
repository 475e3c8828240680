//! Messages into the model; what has to be done outside comes back as effects.

mod act;
mod offer;
mod overlay;

pub use act::act;
pub use offer::offered;

use crate::actions::{self, ActionId};
use crate::keys::{Key, KeyPress};
use crate::model::{
    Busy, Cause, Health, Model, Overlay, Pane, Recording, Refused, Speed, Times, ui::Arrangement,
};
use mission::{Event, Order, PlannerInfo, Severity};
use serde::{Deserialize, Serialize};

/// What reaches the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Msg {
    /// A key went down.
    Key(KeyPress),
    /// Text was pasted.
    Paste(String),
    /// The terminal has this size now.
    Resize {
        /// Columns.
        width: u16,
        /// Rows.
        height: u16,
    },
    /// Events of the mission.
    Events(Vec<Event>),
    /// The time.
    Time(Times),
    /// How the console does.
    Health(Health),
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

/// What the caller has to do, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Effect {
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

/// Takes in one message and answers what has to be done outside.
///
/// Pure: the same model and message give the same model and effects.
pub fn update(model: &mut Model, msg: Msg) -> Vec<Effect> {
    let alarms_before = model.alarms.unacknowledged(Severity::Crit);
    let mut effects = match msg {
        Msg::Key(press) => press_key(model, press),
        Msg::Paste(text) => overlay::paste(model, &text),
        Msg::Resize { width, height } => resize(model, width, height),
        Msg::Events(events) => {
            for event in &events {
                model.fold(event);
            }
            Vec::new()
        }
        Msg::Time(now) => {
            model.console.now = now;
            Vec::new()
        }
        Msg::Health(health) => take_health(model, health),
        Msg::Planners { found, refused } => take_planners(model, found, refused),
        Msg::Notice { severity, text } => news(model, Cause::Console, severity, text),
        Msg::OrderFailed { order, why } => {
            model.answered(&order);
            news(model, Cause::Console, Severity::Crit, why)
        }
        Msg::Busy(work) => {
            let since_mono_s = model.console.now.mono_s;
            model.console.busy = work.map(|(work, limit_s)| Busy { work, limit_s, since_mono_s, at: None });
            Vec::new()
        }
        Msg::BusyAt { share, what } => {
            // Progress that is reported after the work is done is ignored.
            if let Some(busy) = &mut model.console.busy {
                busy.at = Some((share, what));
            }
            Vec::new()
        }
        Msg::Signal(signal) => obey_signal(model, signal),
        Msg::ThreadPanicked { thread, message } => {
            let mut effects = hold_now(model);
            let text = format!("thread {thread} of the console failed: {message}");
            effects.extend(news(model, Cause::Console, Severity::Crit, text));
            effects
        }
    };
    if model.alarms.unacknowledged(Severity::Crit) > alarms_before {
        effects.push(Effect::Bell);
    }
    effects
}

fn press_key(model: &mut Model, press: KeyPress) -> Vec<Effect> {
    if press.key == Key::Char(' ') && !model.may_move() && overlay::is_typing(model) {
        // With nothing to stop, the stop key is a letter like any other.
        overlay::type_key(model, press.key);
        return Vec::new();
    }
    let Some(action) = actions::action_for(press.key, &actions::contexts(model)) else {
        return if overlay::type_key(model, press.key) { Vec::new() } else { unknown(model, press.key) };
    };
    match action.id {
        // A key that is held down stops the robot, too, and does nothing else.
        ActionId::Hold if press.repeat && model.may_move() && !model.console.hold_asked => hold_now(model),
        _ if press.repeat && !action.repeats => Vec::new(),
        id => act(model, id),
    }
}

/// Reports a key that has no action here. It cancels a question: who types something else than an answer has not read it, and
/// a later Enter must not agree to it.
fn unknown(model: &mut Model, key: Key) -> Vec<Effect> {
    match model.ui.overlay {
        Overlay::None => model.say(Severity::Info, format!("Key {key} is not assigned (?: show keys)")),
        Overlay::Confirm(_) | Overlay::Quit | Overlay::Stepping => {
            model.ui.overlay = Overlay::None;
            model.say(Severity::Info, format!("Cancelled: key {key} is not an answer"));
        }
        _ => {}
    }
    Vec::new()
}

/// Sends HOLD whenever the mission would accept it, and after an order that makes the robot move.
fn hold_now(model: &mut Model) -> Vec<Effect> {
    let is_accepted = model.standing.standing().allows(&Order::Hold).is_ok();
    if !is_accepted && model.console.asked.is_none() {
        return Vec::new();
    }
    model.console.hold_asked = true;
    vec![Effect::Order(Order::Hold)]
}

fn resize(model: &mut Model, width: u16, height: u16) -> Vec<Effect> {
    (model.ui.width, model.ui.height) = (width, height);
    let whole = matches!(model.ui.arrangement(), Arrangement::Wide | Arrangement::Narrow);
    if whole && !model.ui.panes().contains(&model.ui.pane) {
        model.ui.pane = Pane::Map;
    }
    Vec::new()
}

fn take_health(model: &mut Model, health: Health) -> Vec<Effect> {
    let effects = match (&health.recording, &model.console.health.recording) {
        (Recording::Failed(why), before) if *before != health.recording => {
            let text = format!("recording failed: {why}");
            news(model, Cause::Recording, Severity::Crit, text)
        }
        (Recording::Failed(_), _) => Vec::new(),
        _ => {
            model.alarms.clear(&Cause::Recording);
            Vec::new()
        }
    };
    model.console.health = health;
    effects
}

fn take_planners(model: &mut Model, found: Vec<PlannerInfo>, refused: Vec<Refused>) -> Vec<Effect> {
    for plugin in refused.iter().filter(|plugin| !model.console.refused.contains(plugin)) {
        let text = format!("plugin {} refused: {}", plugin.plugin, plugin.reason);
        model.log.add(model.clock.t_s, Severity::Watch, "plan", text);
    }
    (model.console.planners, model.console.refused) = (found, refused);
    Vec::new()
}

/// Writes news of the console into the log and the line above the keys; what is critical becomes an alarm.
fn news(model: &mut Model, cause: Cause, severity: Severity, text: String) -> Vec<Effect> {
    model.log.add(model.clock.t_s, severity, "console", text.clone());
    if severity == Severity::Crit {
        model.alarms.raise(cause, severity, text.clone(), model.clock.t_s);
    }
    model.say(severity, text);
    Vec::new()
}

fn obey_signal(model: &mut Model, signal: Signal) -> Vec<Effect> {
    match signal {
        Signal::Interrupt => act(model, ActionId::Interrupt),
        Signal::Stop => act(model, ActionId::Suspend),
        Signal::Continue => vec![Effect::Redraw],
        Signal::Terminate | Signal::Hangup => {
            let mut effects = hold_now(model);
            effects.push(Effect::Quit { signal: Some(signal) });
            effects
        }
    }
}
