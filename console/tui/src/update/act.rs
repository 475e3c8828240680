//! Actions into changes and effects.

use super::go::{self, back, go};
use super::map;
use super::message::Effect;
use super::offer::{offered, refuse};
use super::overlay::{self, ask, open};
use super::send::{hold_now, send};
use super::{alarms, events, palette, preflight, replay, review, typing, what_if};
use crate::actions::ActionId;
use crate::model::home::HomeList;
use crate::model::plugins::plugins;
use crate::model::ui::{Ask, MapView, Purpose};
use crate::model::{Model, Overlay, Palette, Pane, Screen, Speed};
use mission::{Order, Severity, StepTo};
use world::Vector;

/// Seconds within which a second Ctrl-C asks to leave.
const INTERRUPT_TWICE_S: f64 = 2.0;
/// Lines of a page.
const PAGE: isize = 10;

/// Carries out an action, or shows the operator why it is not available.
pub fn act(model: &mut Model, id: ActionId) -> Vec<Effect> {
    // Who stops the robot has not agreed to move it: a later Enter must not do so.
    let stops = matches!(id, ActionId::Hold | ActionId::Interrupt | ActionId::Suspend);
    if stops && overlay::withdraw_motion(model) && id == ActionId::Hold && !model.live.may_move() {
        return Vec::new();
    }
    if let Err(why) = offered(model, id) {
        return refuse(model, why);
    }
    match id {
        ActionId::Hold if model.live.is_replay() => replay::act(model, id),
        ActionId::Hold => hold(model),
        ActionId::Cancel if model.ui.overlay == Overlay::Stepping => end_steps(model),
        ActionId::Interrupt => interrupt(model),
        ActionId::Redraw => vec![Effect::Redraw],
        ActionId::Suspend => [hold_now(model), vec![Effect::Suspend]].concat(),
        ActionId::GoHome => go(model, Screen::Home),
        ActionId::GoPlan => go(model, Screen::Plan),
        ActionId::GoMission => go(model, Screen::Mission),
        ActionId::GoAlarms => go(model, Screen::Alarms),
        ActionId::GoEvents => go(model, Screen::Events),
        ActionId::GoReview => go(model, Screen::Review),
        ActionId::GoResult => go(model, Screen::Result),
        ActionId::GoPlugins => go(model, Screen::Plugins),
        ActionId::Play
        | ActionId::Jump(_)
        | ActionId::Bookmark
        | ActionId::Unmark
        | ActionId::CompareRun
        | ActionId::Difference
        | ActionId::Align => replay::act(model, id),
        ActionId::Sort => review::sort(model),
        ActionId::Reload => vec![Effect::Survey],
        ActionId::Again => go::again(model),
        ActionId::Replay | ActionId::Rescan | ActionId::Verify | ActionId::Report | ActionId::View => {
            go::begin(model, id)
        }
        ActionId::Back => back(model).unwrap_or_else(|| leave(model)),
        ActionId::Leave => leave(model),
        ActionId::Abort => [hold_now(model), ask(model, Ask::Abort)].concat(),
        ActionId::Start => ask(model, Ask::Start(model.live.run.standing.ready_plan())),
        ActionId::Resume => ask(model, Ask::Resume),
        ActionId::FlyUncertified => ask(model, Ask::FlyUncertified),
        ActionId::Step => step(model, Order::Step),
        ActionId::StepLane => step(model, Order::StepTo(StepTo::LaneEnd)),
        ActionId::StepEvent => step(model, Order::StepTo(StepTo::Event)),
        ActionId::Slower => change_speed(model, false),
        ActionId::Faster => change_speed(model, true),
        ActionId::Mouse => toggle_mouse(model),
        ActionId::Acknowledge => alarms::acknowledge(model),
        ActionId::AcknowledgeAll => alarms::acknowledge_all(model),
        ActionId::Shelve => alarms::shelve(model),
        ActionId::Remedy(number) => run_remedy(model, number),
        ActionId::ShowPlace if model.ui.screen == Screen::Events => events::show_place(model),
        ActionId::ShowPlace => alarms::show_place(model),
        ActionId::NextLike => events::next_like(model, false),
        ActionId::PreviousLike => events::next_like(model, true),
        ActionId::Copy => events::copy(model),
        ActionId::Accept if model.ui.overlay == Overlay::None => go::enter(model),
        ActionId::Accept => overlay::accept(model),
        ActionId::Edit => overlay::edit(model),
        ActionId::ChoosePlanner => choose(model, Purpose::Drive),
        ActionId::Shadow => choose(model, Purpose::Shadow),
        ActionId::Promote => ask(model, Ask::Promote),
        ActionId::TakePlan => ask(model, Ask::TakePlan),
        ActionId::DropShadow => send(model, Order::DropShadow),
        ActionId::Compare => choose(model, Purpose::Compare),
        ActionId::WhatIf => what_if::open(model),
        ActionId::AddCandidate => choose(model, Purpose::WhatIf),
        ActionId::Preflight => preflight::open(model),
        ActionId::PlanAgain => vec![Effect::Order(Order::Plan)],
        ActionId::CancelPlan => overlay::cancel_plan(model),
        ActionId::Parameters => {
            what_if::take_draft(model);
            open(model, Overlay::Parameters { selected: 0, edit: None })
        }
        ActionId::TryParameters => what_if::draft(model),
        ActionId::ForecastDraft => what_if::forecast_draft(model),
        ActionId::Layers => open(model, Overlay::Layers { selected: 0 }),
        ActionId::Filter => events::open_filter(model),
        ActionId::Commands => open(model, Overlay::Commands(Palette::default())),
        ActionId::Help => open(model, Overlay::Commands(Palette { help: true, ..Palette::default() })),
        ActionId::SetSpeed
        | ActionId::SetParameter
        | ActionId::Open
        | ActionId::GoTo
        | ActionId::Theme
        | ActionId::Inject
        | ActionId::Exclude
        | ActionId::DrawZone
        | ActionId::Include
        | ActionId::PresetSave
        | ActionId::PresetLoad
        | ActionId::Seek
        | ActionId::Remark
        | ActionId::Centre => palette::begin(model, id),
        other => look(model, other),
    }
}

/// Opens the list of planners, on the one that drives.
fn choose(model: &mut Model, purpose: Purpose) -> Vec<Effect> {
    let driving = driving(model);
    // Beside the planner that drives another one is wanted.
    let others = (1..model.console.planners.len()).map(|by| (driving + by) % model.console.planners.len());
    let other = others
        .filter(|_| purpose != Purpose::Drive)
        .find(|index| model.live.run.cannot_fly(&model.console.planners[*index]).is_none());
    open(model, Overlay::Planners { purpose, selected: other.unwrap_or(driving) })
}

/// Changes what the operator looks at, and nothing else.
fn look(model: &mut Model, id: ActionId) -> Vec<Effect> {
    match id {
        ActionId::Cancel if model.ui.overlay == Overlay::None => model.ui.cursor = None,
        ActionId::Cancel => overlay::cancel(model),
        ActionId::Complete => typing::complete(model),
        ActionId::Up | ActionId::PreviousMissed => select(model, -1),
        ActionId::Down | ActionId::NextMissed => select(model, 1),
        ActionId::PageUp => select(model, -PAGE),
        ActionId::PageDown => select(model, PAGE),
        ActionId::First => select(model, isize::MIN),
        ActionId::Last => select(model, isize::MAX),
        ActionId::NextPane => turn_to(model, 1),
        ActionId::PreviousPane => turn_to(model, -1),
        ActionId::NextCandidate => what_if::select(model, 1),
        ActionId::PreviousCandidate => what_if::select(model, -1),
        ActionId::ZoomIn => map::zoom(model, 1),
        ActionId::ZoomOut => map::zoom(model, -1),
        ActionId::Inspect => map::inspect(model),
        ActionId::WholeTank => model.ui.map = MapView::default(),
        ActionId::Follow => model.ui.map.follow = !model.ui.map.follow,
        ActionId::PanLeft => map::pan(model, Vector::new(-1.0, 0.0)),
        ActionId::PanRight => map::pan(model, Vector::new(1.0, 0.0)),
        ActionId::PanUp => map::pan(model, Vector::new(0.0, 1.0)),
        ActionId::PanDown => map::pan(model, Vector::new(0.0, -1.0)),
        ActionId::Severity => events::next_severity(model),
        _ => {}
    }
    Vec::new()
}

fn hold(model: &mut Model) -> Vec<Effect> {
    if model.live.may_move() {
        return hold_now(model);
    }
    if model.ui.overlay == Overlay::None {
        return ask(model, Ask::Resume);
    }
    model.say(Severity::Info, "already held");
    Vec::new()
}

fn interrupt(model: &mut Model) -> Vec<Effect> {
    let now_s = model.console.now.mono_s;
    let twice =
        model.console.interrupted_mono_s.is_some_and(|before_s| now_s - before_s <= INTERRUPT_TWICE_S);
    model.console.interrupted_mono_s = Some(now_s);
    let effects = hold_now(model);
    if twice {
        model.ui.overlay = Overlay::Quit;
    } else {
        let text = format!("press <interrupt> again within {INTERRUPT_TWICE_S} s to quit");
        model.say_for(INTERRUPT_TWICE_S, Severity::Info, model.console.keys.spelled(&text));
    }
    effects
}

/// Holds, then asks; with nothing under way it leaves at once.
fn leave(model: &mut Model) -> Vec<Effect> {
    let mut effects = hold_now(model);
    if model.live.is_under_way() {
        model.ui.overlay = Overlay::Quit;
    } else {
        effects.push(Effect::Quit { signal: None });
    }
    effects
}

/// HOLD for who cannot see whether the robot moves: it never asks to resume.
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

/// Closes the line for steps; a step that is under way ends.
pub(super) fn end_steps(model: &mut Model) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    if model.live.may_move() { hold_now(model) } else { Vec::new() }
}

/// The first step opens the line for steps; in it each key is a step.
fn step(model: &mut Model, order: Order) -> Vec<Effect> {
    if model.ui.overlay != Overlay::Stepping {
        return open(model, Overlay::Stepping);
    }
    if model.live.asked.is_some() {
        return Vec::new();
    }
    send(model, order)
}

fn change_speed(model: &mut Model, faster: bool) -> Vec<Effect> {
    let Some(speed) = model.live.speed.stepped(faster) else { return Vec::new() };
    set_speed(model, speed)
}

/// Sets the pace of the simulation.
pub(super) fn set_speed(model: &mut Model, speed: Speed) -> Vec<Effect> {
    model.live.speed = speed;
    vec![Effect::Speed(speed)]
}

fn toggle_mouse(model: &mut Model) -> Vec<Effect> {
    model.ui.mouse = !model.ui.mouse;
    let news = if model.ui.mouse {
        "mouse on: click, wheel, drag; hold Shift to select text"
    } else {
        "mouse off: the terminal has it"
    };
    model.say(Severity::Info, news);
    vec![Effect::Mouse(model.ui.mouse)]
}

/// Runs an action of the alarm whose actions are open.
fn run_remedy(model: &mut Model, number: u8) -> Vec<Effect> {
    match alarms::chosen_remedy(model, number.into()) {
        Ok(ActionId::Hold) => hold_only(model),
        Ok(action) => act(model, action),
        Err(why) => refuse(model, why),
    }
}

fn driving(model: &Model) -> usize {
    let id = model.live.run.planner_id();
    model.console.planners.iter().position(|planner| Some(planner.id.as_str()) == id).unwrap_or(0)
}

fn turn_to(model: &mut Model, by: isize) {
    if model.ui.screen == Screen::Home {
        model.home.list = match model.home.list {
            HomeList::Scenarios => HomeList::Runs,
            HomeList::Runs => HomeList::Scenarios,
        };
        return;
    }
    let panes = model.ui.panes();
    let at = panes.iter().position(|pane| *pane == model.ui.pane).unwrap_or(0);
    let next = (at as isize + by).rem_euclid(panes.len().max(1) as isize) as usize;
    model.ui.pane = panes.get(next).copied().unwrap_or(Pane::Map);
}

/// Selects another line of whatever takes the arrow keys, so many further down.
pub(super) fn select(model: &mut Model, by: isize) {
    if palette::recalls(model, by) {
        return;
    }
    match (&model.ui.overlay, model.ui.screen) {
        (Overlay::None, Screen::Home) => model.home.select(by),
        (Overlay::None, Screen::Review) => model.review.select(&model.home, by),
        (Overlay::None, Screen::Mission | Screen::Events) => model.ui.events.select(by),
        (Overlay::None, Screen::Alarms) => alarms::select(model, by),
        (Overlay::None, Screen::Result) => go::select_missed(model, by),
        (Overlay::None, Screen::Plugins) => {
            let last = plugins(&model.console, &model.live.run).len().saturating_sub(1);
            model.ui.plugin = model.ui.plugin.saturating_add_signed(by).min(last);
        }
        (Overlay::None, Screen::Plan) => {}
        _ => overlay::select(model, by),
    }
}
