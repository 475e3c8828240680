//! Applies messages to the model and returns the effects for the caller to carry out.

pub(crate) mod act;
pub(crate) mod alarms;
mod command;
pub(crate) mod events;
pub(crate) mod finish;
pub(crate) mod go;
mod health;
mod hear;
mod held_keys;
mod judging;
mod look_only;
pub(crate) mod map;
mod message;
mod mouse;
pub(crate) mod offer;
pub(crate) mod overlay;
mod palette;
pub(crate) mod place;
pub(crate) mod preflight;
pub(crate) mod preset;
mod redraw;
pub(crate) mod remedies;
pub(crate) mod replay;
pub(crate) mod review;
pub(crate) mod send;
pub(crate) mod setting;
pub(crate) mod shadow;
pub(crate) mod stations;
pub(crate) mod typing;
mod unseen;
pub(crate) mod what_if;
pub(crate) mod zones;

pub use act::act;
pub use command::check_line;
pub use message::{Effect, Job, Mouse, Msg, Query, ReplayMsg, Rows, RunMsg, Signal, Target, Transport};
pub use offer::offered;
pub use palette::{Choice, Group, choices, group, values};
pub use redraw::{Redraw, redraw};
pub use typing::is_typing;

use crate::actions::{ActionId, context::contexts, find};
use crate::keys::{Key, KeyPress};
use crate::model::console::{Bell, Notice};
use crate::model::plugins::differences;
use crate::model::{Cause, Model, Overlay, Screen, ui::Arrangement};
use mission::{Hold, Phase, PlannerInfo, RefusedPlugin, Severity};
use send::hold_now;

/// Applies one message and returns the effects for the caller to carry out.
///
/// Pure: the same model and message give the same model and effects.
pub fn update(model: &mut Model, msg: Msg) -> Vec<Effect> {
    let alarms_before = ringing(model);
    let said_before = model.console.notice.clone().map(|notice| (notice, Pressing::of(model)));
    let question_before = unseen::question(model).cloned();
    let judges_before = judging::is_open(model);
    let estimates_before = setting::is_open(model);
    let mut effects = Vec::new();
    match msg {
        Msg::Key(press) => effects = press_key(model, press),
        Msg::Stop => effects = stop(model),
        Msg::Drawn(frame) => unseen::drawn(model, frame),
        Msg::Settled => effects = held_keys::settled(model),
        Msg::Signal(signal) => effects = obey_signal(model, signal),
        Msg::ThreadPanicked { thread, message } => {
            overlay::withdraw_motion(model);
            effects = hold_now(model);
            let text = format!("console thread {thread} failed: {message}");
            news(model, &Cause::Console, Severity::Crit, text);
        }
        Msg::Paste(text) => typing::paste(model, &text),
        Msg::Line(line) => effects = palette::obey(model, line.trim()),
        Msg::Mouse(mouse) => effects = mouse::take(model, mouse),
        Msg::Resize { width, height } => resize(model, width, height),
        Msg::Time(now) => model.console.now = now,
        Msg::Measured(measured) => health::take(model, measured),
        Msg::Run(id, msg) => effects = hear::hear(model, id, msg),
        Msg::Presets(presets) => model.console.presets = presets,
        Msg::Found(found) => {
            let is_first = model.home.found.replace(*found).is_none();
            if is_first {
                go::select_open(model);
            }
        }
        Msg::Glimpsed(key, found) => model.home.glimpses.take(key, found),
        Msg::Done(job, result) => effects = go::done(model, &job, result),
        Msg::Planners { found, refused } => take_planners(model, found, refused),
        Msg::Notice { severity, text } => news(model, &Cause::Console, severity, text),
    }
    model.ui.parts.without_scan = model.live.is_without_scan();
    model.ui.parts.survey = model.live.run.is_survey();
    model.ui.parts.tether = model.live.run.tether.is_some();
    events::refresh(model);
    unseen::note(model, question_before.as_ref());
    effects.extend(setting::follow(model, estimates_before));
    effects.extend(go::glimpse(model));
    if let Some((notice, before)) = said_before
        && model.console.notice.as_ref() == Some(&notice)
        && Pressing::of(model).is_more_than(&before, &notice)
    {
        model.console.notice = None;
    }
    effects.extend(judging::follow(model, judges_before));
    if ringing(model) > alarms_before {
        effects.push(Effect::Bell);
    }
    effects
}

/// The conditions that take precedence over an earlier message to the operator.
struct Pressing {
    hold_asked: bool,
    hold: Option<Hold>,
    critical: usize,
}

impl Pressing {
    fn of(model: &Model) -> Self {
        let run = &model.live.run;
        let hold = match run.phase() {
            Phase::Held(hold) => Some(hold.clone()),
            _ => None,
        };
        Self { hold_asked: model.live.hold_asked, hold, critical: run.alarms.unacknowledged(Severity::Crit) }
    }

    fn is_more_than(&self, before: &Self, notice: &Notice) -> bool {
        // The hold that answers HOLD does not remove the answer to a later key.
        let is_expected = notice.is_answer && before.hold_asked;
        let is_held_anew = self.hold.is_some() && self.hold != before.hold && !is_expected;
        self.hold_asked && !before.hold_asked || is_held_anew || self.critical > before.critical
    }
}

/// The number of unacknowledged alarms that ring the bell.
fn ringing(model: &Model) -> usize {
    let Bell(Some(least)) = model.console.preferences.bell else { return 0 };
    // Alarms are acknowledged on the console that gives the orders.
    if model.live.is_look_only() {
        return 0;
    }
    let alarms = model.live.run.alarms.list().iter();
    alarms.filter(|alarm| alarm.is_unacknowledged() && alarm.severity >= least).count()
}

fn press_key(model: &mut Model, press: KeyPress) -> Vec<Effect> {
    model.console.settling = None;
    if press.key == Key::Char(' ')
        && !model.live.may_move()
        && matches!(model.ui.overlay, Overlay::Preflight { .. })
    {
        return if held_keys::is_pressed(model, press) { preflight::tick(model) } else { Vec::new() };
    }
    if press.key == Key::Char(' ') && typing::holds_by_space(model) {
        return if model.live.hold_asked { Vec::new() } else { hold_now(model) };
    }
    // In an input line, letters and the space are typed; there Ctrl-C holds.
    if typing::press(model, press.key) {
        return Vec::new();
    }
    if press.key == Key::Esc && (events::close(model) || go::close_text(model) || typing::clear_filter(model))
    {
        return Vec::new();
    }
    let of_list = find::action_for(&model.console.keys, press.key, &contexts(model));
    let of_list = of_list.filter(|action| !remedies::is_unused(model, action.id));
    let Some(action) = of_list.or_else(|| remedies::behind(model, press.key)) else {
        return unknown(model, press.key);
    };
    if of_list.is_none() && offered(model, action.id).is_ok() {
        model.ui.overlay = Overlay::None;
    }
    match action.id {
        // A repeat of a held key still stops the robot, but does nothing else.
        ActionId::Hold if press.repeat && model.live.may_move() && !model.live.hold_asked => hold_now(model),
        _ if press.repeat && !action.repeats => Vec::new(),
        id if held_keys::is_agreement(model, id) && unseen::is_too_early(model, press) => Vec::new(),
        id if held_keys::is_agreement(model, id) && !held_keys::is_pressed(model, press) => Vec::new(),
        id => act(model, id),
    }
}

/// Holds a moving robot; unlike the key, never asks a question.
fn stop(model: &mut Model) -> Vec<Effect> {
    if is_typing(model) || !model.live.may_move() || model.live.hold_asked {
        return Vec::new();
    }
    overlay::withdraw_motion(model);
    hold_now(model)
}

/// Reports a key that has no action here. The key also cancels a question: an operator who types anything but an
/// answer has not read the question, and a later Enter must not confirm it.
fn unknown(model: &mut Model, key: Key) -> Vec<Effect> {
    match model.ui.overlay {
        // Esc closes what is open. A second Esc closes nothing, but the operator needs no message about it.
        Overlay::None if key == Key::Esc => {}
        Overlay::None => {
            let accept = find::row(ActionId::Accept);
            let is_accept = accept.is_some_and(|row| model.console.keys.of(row).contains(&key));
            let why = offer::why_nothing_opens(model).filter(|_| is_accept);
            let why = why.unwrap_or_else(|| format!("key {key} does nothing here; <help>: keys"));
            let why = model.console.keys.spelled(&why);
            model.hint(why);
        }
        ref overlay if overlay.is_question() => {
            let was_stepping = model.ui.overlay == Overlay::Stepping;
            model.ui.overlay = Overlay::None;
            model.hint(format!("cancelled: key {key} is not an answer"));
            if was_stepping {
                return act::end_steps(model);
            }
        }
        _ => {}
    }
    Vec::new()
}

fn resize(model: &mut Model, width: u16, height: u16) {
    (model.ui.width, model.ui.height) = (width, height);
    let whole = matches!(model.ui.arrangement(), Arrangement::Wide | Arrangement::Narrow);
    let turns = whole || model.ui.screen == Screen::Plan;
    if turns && !model.ui.panes().is_empty() && !model.ui.panes().contains(&model.ui.focus()) {
        model.ui.pane = model.ui.first_pane();
    }
}

fn take_planners(model: &mut Model, found: Vec<PlannerInfo>, refused: Vec<RefusedPlugin>) {
    for plugin in refused.iter().filter(|plugin| !model.console.refused.contains(plugin)) {
        let text = format!("plugin {} refused: {}", plugin.plugin, plugin.reason);
        model.live.run.log.add(model.live.run.clock.t_s, Severity::Watch, "plan", text);
    }
    if !model.console.planners.is_empty() {
        let changes = differences(&model.console.planners, &found);
        model.say(Severity::Info, format!("plugins rescanned: {} changed", changes.len()));
        model.console.reloaded = Some(changes);
        shadow::tell_rebuilt(model, &found);
    }
    (model.console.planners, model.console.refused) = (found, refused);
}

/// Writes a message about the console to the log and to the line above the keys; a critical message becomes an alarm.
fn news(model: &mut Model, cause: &Cause, severity: Severity, text: String) {
    if severity == Severity::Crit {
        raise(model, cause, text.clone());
    } else {
        model.live.run.log.add(model.live.run.clock.t_s, severity, "console", text.clone());
    }
    model.say(severity, text);
}

/// Raises a critical alarm about the console, and writes its text to the log.
fn raise(model: &mut Model, cause: &Cause, text: String) {
    let run = &mut model.live.run;
    let t_s = run.clock.t_s;
    run.log.add(t_s, Severity::Crit, "console", text.clone());
    run.alarms.raise(cause.clone(), Severity::Crit, text, t_s);
    run.alarms.note(cause, run.log.newest().unwrap_or_default(), None);
}

fn obey_signal(model: &mut Model, signal: Signal) -> Vec<Effect> {
    match signal {
        Signal::Interrupt => act(model, ActionId::Interrupt),
        Signal::Stop => act(model, ActionId::Suspend),
        Signal::Continue => vec![Effect::Redraw],
        Signal::Terminate | Signal::Hangup | Signal::End(_) => {
            let mut effects = hold_now(model);
            effects.push(Effect::Quit { signal: Some(signal) });
            effects
        }
    }
}
