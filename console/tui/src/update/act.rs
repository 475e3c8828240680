//! Carries out actions.

use super::go;
use super::message::Effect;
use super::offer::{accepted, offered, refuse};
use super::overlay::{self, ask, open};
use super::send::{hold_now, send};
use super::{alarms, palette, remedies, replay};
use crate::actions::{ActionId, Deed, find};
use crate::model::home::HomeList;
use crate::model::planner_list::PlannerLine;
use crate::model::plugins::plugins;
use crate::model::ui::{Ask, Purpose};
use crate::model::{Model, Overlay, Pane, Screen, Speed};
use crate::view;
use mission::{Order, Severity};

/// Seconds within which a second Ctrl-C asks whether to quit the console.
const INTERRUPT_TWICE_S: f64 = 2.0;
/// Lines per page.
pub(crate) const PAGE: isize = 10;

/// Carries out an action, or shows the operator why it is not available.
pub fn act(model: &mut Model, id: ActionId) -> Vec<Effect> {
    // An operator who stops the robot has not agreed to move it: a later Enter must not do so.
    let stops = matches!(id, ActionId::Hold | ActionId::Interrupt | ActionId::Suspend);
    if stops && overlay::withdraw_motion(model) && id == ActionId::Hold && !model.live.may_move() {
        return Vec::new();
    }
    if let Err(why) = offered(model, id) {
        if id == ActionId::Shelve && alarms::refuse_on_line(model, &why) {
            return Vec::new();
        }
        return refuse(model, why);
    }
    match (id, find::row(id).map(|action| action.deed)) {
        (ActionId::Go(screen), _) => go::go(model, screen),
        (ActionId::Jump(jump), _) => replay::go_to(model, jump),
        (ActionId::Remedy(number), _) => remedies::run(model, number.into()),
        (_, Some(Deed::Act(act))) => act(model),
        (_, Some(Deed::Look(look))) => {
            look(model);
            Vec::new()
        }
        (_, Some(Deed::Begin)) => palette::begin(model, id),
        (_, None) => Vec::new(),
    }
}

/// Opens the list of planners, with one that suits the purpose selected.
pub(crate) fn choose(model: &mut Model, purpose: Purpose) -> Vec<Effect> {
    let active = model.live.run.planner_id();
    let lines = model.planner_lines(false);
    let is_active = |line: &PlannerLine| matches!(line, PlannerLine::Planner(planner) if Some(planner.id.as_str()) == active);
    let at = lines.iter().position(is_active).unwrap_or(0);
    // For any other purpose, the operator wants a planner other than the active one.
    let mut others = (1..lines.len()).map(|by| (at + by) % lines.len());
    let other = others.find(|index| {
        let can = matches!(lines[*index], PlannerLine::Planner(planner) if model.live.run.cannot_fly(planner).is_none());
        purpose != Purpose::Drive && can
    });
    let selected = other.unwrap_or(at);
    open(model, Overlay::Planners { purpose, selected, is_unfolded: false })
}

/// Stops the robot, or asks whether to resume if it is held. In a replay, plays or pauses.
pub(crate) fn hold(model: &mut Model) -> Vec<Effect> {
    if model.live.is_replay() {
        return replay::toggle(model);
    }
    if model.live.may_move() {
        return hold_now(model);
    }
    if model.ui.overlay == Overlay::None {
        return match accepted(model, &Order::Resume) {
            Ok(()) => ask(model, Ask::Resume),
            Err(why) => refuse(model, why),
        };
    }
    model.say(Severity::Info, "already held");
    Vec::new()
}

/// Stops the robot; a second press within two seconds asks whether to quit.
pub(crate) fn interrupt(model: &mut Model) -> Vec<Effect> {
    let now_s = model.console.now.mono_s;
    let twice =
        model.console.interrupted_mono_s.is_some_and(|before_s| now_s - before_s <= INTERRUPT_TWICE_S);
    model.console.interrupted_mono_s = Some(now_s);
    let effects = hold_now(model);
    if twice {
        model.ui.overlay = Overlay::Quit;
    } else {
        let text = format!("press <interrupt> again within {INTERRUPT_TWICE_S} s to quit");
        model.hint(model.console.keys.spelled(&text));
    }
    effects
}

/// Closes the step line, the list or the map cursor, whichever is open.
pub(crate) fn cancel(model: &mut Model) -> Vec<Effect> {
    match model.ui.overlay {
        Overlay::Stepping => return end_steps(model),
        Overlay::None => model.ui.cursor = None,
        _ => overlay::cancel(model),
    }
    Vec::new()
}

/// Holds, then asks; quits immediately if no mission is under way.
pub(crate) fn leave(model: &mut Model) -> Vec<Effect> {
    let mut effects = hold_now(model);
    if model.live.is_under_way() {
        model.ui.overlay = Overlay::Quit;
    } else {
        effects.push(Effect::Quit { signal: None });
    }
    effects
}

/// HOLD for callers that cannot see whether the robot is moving: it never asks whether to resume.
pub(super) fn hold_only(model: &mut Model) -> Vec<Effect> {
    if model.live.is_replay() {
        return replay::pause(model);
    }
    let withdrawn = overlay::withdraw_motion(model);
    match offered(model, ActionId::Hold) {
        _ if model.live.may_move() => hold_now(model),
        _ if withdrawn => Vec::new(),
        Ok(()) => refuse(model, "already held".into()),
        Err(why) => refuse(model, why),
    }
}

/// Closes the step line and ends a step in progress.
pub(super) fn end_steps(model: &mut Model) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    if model.live.may_move() { hold_now(model) } else { Vec::new() }
}

/// The first step opens the step line, where each key press is one step.
pub(crate) fn step(model: &mut Model, order: Order) -> Vec<Effect> {
    if model.ui.overlay != Overlay::Stepping {
        return open(model, Overlay::Stepping);
    }
    if model.live.asked.is_some() {
        return Vec::new();
    }
    send(model, order)
}

/// Changes to the next higher or lower speed.
pub(crate) fn change_speed(model: &mut Model, faster: bool) -> Vec<Effect> {
    let Some(speed) = model.live.speed.stepped(faster) else { return Vec::new() };
    set_speed(model, speed)
}

/// Sets the simulation speed.
pub(super) fn set_speed(model: &mut Model, speed: Speed) -> Vec<Effect> {
    // The operator's choice stays when an offered plan has been decided.
    (model.live.speed, model.live.slowed_from) = (speed, None);
    vec![Effect::Speed(speed)]
}

/// Turns mouse capture on or off.
pub(crate) fn toggle_mouse(model: &mut Model) -> Vec<Effect> {
    model.ui.mouse = !model.ui.mouse;
    let news = if model.ui.mouse {
        "mouse on: click, wheel, drag; hold Shift to select text"
    } else {
        "mouse off: the terminal handles it"
    };
    model.say(Severity::Info, news);
    vec![Effect::Mouse(model.ui.mouse)]
}

/// Moves the focus by `by` panes; on the home screen, switches between the lists.
pub(crate) fn turn_to(model: &mut Model, by: isize) {
    if model.ui.screen == Screen::Home {
        model.home.list = model.home.list.turned(by);
        return;
    }
    let (panes, focus) = (model.ui.panes(), model.ui.focus());
    let at = panes.iter().position(|pane| *pane == focus).unwrap_or(0);
    let next = (at as isize + by).rem_euclid(panes.len().max(1) as isize) as usize;
    turn_to_pane(model, panes.get(next).copied().unwrap_or(Pane::Map));
}

/// Shows the pane with the focus alone on the mission screen, or all panes again.
pub(crate) fn show_alone(model: &mut Model) {
    model.ui.is_alone = !model.ui.is_alone;
    if !model.ui.panes().contains(&model.ui.pane) {
        model.ui.pane = Pane::Map;
    }
    if model.ui.is_alone {
        let keys = model.console.keys.spelled("<next-pane>: next pane and charts; <full-pane>: all panes");
        model.hint(keys);
    }
}

/// Goes to the pane with a number, from 1.
pub(crate) fn turn_to_number(model: &mut Model, number: u8) {
    if model.ui.screen == Screen::Home {
        model.home.list = HomeList::ALL[usize::from(number).clamp(1, HomeList::ALL.len()) - 1];
        return;
    }
    let panes = model.ui.numbered_panes();
    if let Some(pane) = usize::from(number).checked_sub(1).and_then(|index| panes.get(index)) {
        turn_to_pane(model, *pane);
    }
}

/// Moves the focus to a pane; a pane of text begins at its top.
pub(super) fn turn_to_pane(model: &mut Model, pane: Pane) {
    model.ui.scrolled = 0;
    match pane {
        Pane::List | Pane::Detail => model.ui.in_detail = pane == Pane::Detail,
        pane => model.ui.pane = pane,
    }
}

/// Moves the selection down by `by` lines in the list that responds to the arrow keys.
pub(crate) fn select(model: &mut Model, by: isize) {
    if palette::recalls(model, by) {
        return;
    }
    match model.ui.overlay {
        Overlay::None if model.ui.focus() == Pane::Detail => scroll(model, by),
        Overlay::None => (model.ui.screen.row().select)(model, by),
        _ => overlay::select(model, by),
    }
}

/// Scrolls the details of the selected row down by `by` rows.
fn scroll(model: &mut Model, by: isize) {
    let most = view::most_scrolled(model);
    model.ui.scrolled = model.ui.scrolled.min(most).saturating_add_signed(by).min(most);
}

/// Whether any plugin is listed.
pub(crate) fn has_plugin(model: &Model) -> bool {
    !plugins(&model.console, &model.live.run).is_empty()
}

/// Moves the selection down by `by` plugins.
pub(crate) fn select_plugin(model: &mut Model, by: isize) {
    let last = plugins(&model.console, &model.live.run).len().saturating_sub(1);
    model.ui.plugin = model.ui.plugin.saturating_add_signed(by).min(last);
}
