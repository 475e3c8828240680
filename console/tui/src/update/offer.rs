//! What can be done now, and why not otherwise. Footer and keys ask the same question.

use super::go::named_run;
use super::look_only::{allowed, no_orders};
use super::message::Effect;
use super::{alarms, preset, replay, shadow, stations, typing, zones};
use crate::actions::ActionId;
use crate::model::{
    Alarm, Model, Overlay, Pane, Screen,
    ui::{Ask, MAX_ZOOM},
};
use mission::{Order, Phase, PlannerChoice, Refusal, Severity};

/// Whether an action can be done now.
///
/// # Errors
/// Why not, and what would be right, as a sentence.
pub fn offered(model: &Model, id: ActionId) -> Result<(), String> {
    allowed(model, id).and_then(|()| can(model, id)).map_err(|why| model.console.keys.spelled(&why))
}

fn can(model: &Model, id: ActionId) -> Result<(), String> {
    match id {
        ActionId::Hold => hold(model),
        ActionId::Start => start(model),
        ActionId::Resume => accepted(model, &Order::Resume),
        ActionId::FlyUncertified => accepted(model, &Order::FlyUncertified),
        ActionId::Step | ActionId::StepLane | ActionId::StepEvent => accepted(model, &Order::Step),
        ActionId::Abort => abort(model),
        ActionId::ChoosePlanner => swap(model),
        ActionId::Shadow | ActionId::Promote | ActionId::DropShadow => of_shadow(model, id),
        ActionId::TakePlan => accepted(model, &Order::TakePlan),
        ActionId::Accept => accept(model),
        ActionId::WhatIf => accepted(model, &Order::NoteOutlooks(Vec::new())),
        ActionId::Preflight | ActionId::Compare | ActionId::PlanAgain | ActionId::CancelPlan => {
            before_start(model, id)
        }
        ActionId::Parameters | ActionId::SetParameter | ActionId::PresetSave => parameters(model),
        ActionId::PresetLoad => preset::can_load(model),
        ActionId::SetSpeed => simulating(model),
        ActionId::DrawZone => zones::can(model),
        ActionId::Inject | ActionId::Exclude | ActionId::Include => stations::can(model, id),
        ActionId::Open => nothing_under_way(model),
        ActionId::Acknowledge
        | ActionId::AcknowledgeAll
        | ActionId::Shelve
        | ActionId::ShowPlace
        | ActionId::NextLike
        | ActionId::PreviousLike
        | ActionId::Copy => of_line(model, id),
        ActionId::Slower => speed(model, false),
        ActionId::Faster => speed(model, true),
        ActionId::ZoomIn
        | ActionId::ZoomOut
        | ActionId::WholeTank
        | ActionId::Layers
        | ActionId::Centre
        | ActionId::Inspect
        | ActionId::Follow
        | ActionId::PanLeft
        | ActionId::PanRight
        | ActionId::PanUp
        | ActionId::PanDown => map(model).and_then(|()| on_map(model, id)),
        ActionId::Severity => demand(
            model.ui.shows(Pane::Events),
            "the events are not shown; <next-pane>: next pane (needs 60x16)",
        ),
        ActionId::GoPlan
        | ActionId::GoMission
        | ActionId::GoResult
        | ActionId::Reload
        | ActionId::NextMissed
        | ActionId::PreviousMissed
        | ActionId::Again
        | ActionId::Rescan
        | ActionId::Verify
        | ActionId::Report
        | ActionId::View => around(model, id),
        ActionId::NextPane | ActionId::PreviousPane => other_pane(model),
        ActionId::Complete => demand(typing::completes(model), "nothing to complete here"),
        ActionId::Replay
        | ActionId::Play
        | ActionId::Jump(_)
        | ActionId::Seek
        | ActionId::Bookmark
        | ActionId::Unmark
        | ActionId::Remark
        | ActionId::CompareRun
        | ActionId::Difference
        | ActionId::Align => replay::can(model, id),
        ActionId::Sort => on_screen(model, Screen::Review),
        ActionId::Interrupt
        | ActionId::Redraw
        | ActionId::Suspend
        | ActionId::Commands
        | ActionId::Help
        | ActionId::GoHome
        | ActionId::GoPlugins
        | ActionId::GoAlarms
        | ActionId::GoEvents
        | ActionId::GoReview
        | ActionId::Remedy(_)
        | ActionId::Back
        | ActionId::Leave
        | ActionId::Filter
        | ActionId::GoTo
        | ActionId::Theme
        | ActionId::Mouse
        | ActionId::Cancel
        | ActionId::AddCandidate
        | ActionId::TryParameters
        | ActionId::ForecastDraft
        | ActionId::NextCandidate
        | ActionId::PreviousCandidate
        | ActionId::Up
        | ActionId::Down
        | ActionId::PageUp
        | ActionId::PageDown
        | ActionId::First
        | ActionId::Last
        | ActionId::Edit => Ok(()),
    }
}

/// Whether there is something that Enter opens.
fn accept(model: &Model) -> Result<(), String> {
    let opens = match model.ui.screen {
        Screen::Home | Screen::Alarms | Screen::Events | Screen::Review => true,
        Screen::Mission => model.ui.pane == Pane::Events,
        Screen::Plan | Screen::Result | Screen::Plugins => false,
    };
    if matches!(model.ui.overlay, Overlay::Preflight { .. }) {
        return demand(model.n_by_hand() > 0, "nothing is ticked by hand in this scenario");
    }
    demand(model.ui.overlay != Overlay::None || opens, "nothing to open here")
}

/// Whether there is another pane to go to.
fn other_pane(model: &Model) -> Result<(), String> {
    let turns = model.ui.screen == Screen::Home || !model.ui.panes().is_empty();
    demand(turns, "there is one pane only")
}

/// Whether the map that is shown can be looked at in another way.
fn on_map(model: &Model, id: ActionId) -> Result<(), String> {
    let zoom = model.ui.map.zoom;
    match id {
        ActionId::ZoomIn => demand(zoom < MAX_ZOOM, "already at maximum zoom"),
        ActionId::ZoomOut => demand(zoom > 0, "the whole tank is already shown"),
        ActionId::Inspect => demand(model.live.run.about.is_some(), "no tank loaded yet"),
        ActionId::Follow => demand(model.live.run.position.pose.is_some(), "no position estimate yet"),
        ActionId::PanLeft | ActionId::PanRight | ActionId::PanUp | ActionId::PanDown => {
            let moves = zoom > 0 || model.ui.cursor.is_some();
            demand(moves, "the whole tank is shown; <zoom-in>: zoom in first")
        }
        _ => Ok(()),
    }
}

/// Whether there is something to go to, or to begin, around a mission.
fn around(model: &Model, id: ActionId) -> Result<(), String> {
    let live = &model.live;
    match id {
        ActionId::GoPlan | ActionId::GoMission => {
            demand(live.source.is_some(), "no mission is open; choose one on screen 1 (Home)")
        }
        ActionId::GoResult => demand(live.result.is_some(), "no run has ended yet"),
        ActionId::Reload => {
            let why = "plugins are rescanned only while the robot is held; <hold>: HOLD";
            demand(!live.run.is_running(), why)
        }
        ActionId::NextMissed | ActionId::PreviousMissed => {
            demand(!live.missed().is_empty(), "no area was missed")
        }
        ActionId::Again => demand(live.source.is_some() && !live.is_under_way(), "a mission is in progress"),
        ActionId::Rescan if model.ui.screen == Screen::Result => rescan(model),
        _ => demand(named_run(model).is_some(), "no run is selected"),
    }
}

/// What was missed is scanned by the planner of the run.
fn rescan(model: &Model) -> Result<(), String> {
    match model.planner().and_then(|planner| Some((planner, planner.why_no_coverage()?))) {
        Some((planner, why)) => {
            let other = "`tankops rescan RUN` writes a scenario for another planner";
            Err(format!("planner {} {why}; {other}", planner.id))
        }
        None => demand(named_run(model).is_some(), "no run is selected"),
    }
}

/// Shows the operator why something is not done.
pub(super) fn refuse(model: &mut Model, why: String) -> Vec<Effect> {
    model.say(Severity::Watch, why);
    Vec::new()
}

pub(super) fn demand(met: bool, otherwise: &str) -> Result<(), String> {
    if met { Ok(()) } else { Err(otherwise.to_owned()) }
}

/// Whether something can be done with an alarm or an event.
fn of_line(model: &Model, id: ActionId) -> Result<(), String> {
    match id {
        ActionId::Acknowledge => alarms::can_acknowledge(model),
        ActionId::AcknowledgeAll => {
            let waiting = model.live.run.alarms.open().any(Alarm::is_unacknowledged);
            demand(waiting, "no unacknowledged alarms")
        }
        ActionId::Shelve => on_screen(model, Screen::Alarms).and(match cannot_be_shelved(model) {
            Some(why) => Err(why),
            None => Ok(()),
        }),
        ActionId::ShowPlace => {
            let is_here = matches!(model.ui.screen, Screen::Alarms | Screen::Events);
            demand(is_here, "select an alarm (<alarms>) or an event (<events>) first")
        }
        _ => on_screen(model, Screen::Events)
            .and(demand(!model.ui.events.matches.is_empty(), "no event is selected")),
    }
}

/// Why the selected alarm can neither be put aside nor taken back, if it cannot.
fn cannot_be_shelved(model: &Model) -> Option<String> {
    match model.selected_alarm() {
        None => Some("no alarm is selected".into()),
        Some(alarm) => alarm.cannot_be_shelved().map(str::to_owned),
    }
}

fn on_screen(model: &Model, screen: Screen) -> Result<(), String> {
    demand(model.ui.screen == screen, &format!("only on screen {} ({})", screen.digit(), screen.name()))
}

/// Whether the mission would accept an order, by its own table.
pub(super) fn accepted(model: &Model, order: &Order) -> Result<(), String> {
    no_orders(model)?;
    model.live.run.standing.standing().allows(order).map_err(|why| {
        match remedy(&why, model.live.run.phase()) {
            Some(remedy) => model.console.keys.spelled(&format!("{why}; {remedy}")),
            None => why.to_string(),
        }
    })
}

fn hold(model: &Model) -> Result<(), String> {
    if model.live.is_replay() {
        return replay::can(model, ActionId::Play);
    }
    if model.live.may_move() { Ok(()) } else { accepted(model, &Order::Hold) }
}

fn start(model: &Model) -> Result<(), String> {
    demand(model.live.failure.is_none(), "the scenario could not be opened")?;
    demand(model.live.run.about.is_some(), "no mission loaded yet")?;
    demand(!model.live.preflight.is_starting, "already checking for the start; <cancel-plan>: cancel")?;
    demand(model.live.asked.is_none(), "start already requested; <hold>: HOLD")?;
    if let Some(busy) = model.live.busy.as_ref().filter(|_| model.live.waits()) {
        return Err(format!("{}: not started; start again when the plan is ready", busy.how_far()));
    }
    let plan = model.live.run.standing.ready_plan();
    accepted(model, &Ask::Start(plan).order())?;
    match model.start_is_blocked_here() {
        Some(why) => Err(format!("{why}; <preflight>: pre-flight check")),
        None => Ok(()),
    }
}

/// Ending a mission that was never started would leave a run of nothing.
fn abort(model: &Model) -> Result<(), String> {
    let is_waiting = *model.live.run.phase() == Phase::Waiting && !model.live.may_move();
    demand(!is_waiting, "the mission has not been started")?;
    accepted(model, &Order::Abort)
}

fn swap(model: &Model) -> Result<(), String> {
    let choice = PlannerChoice::default();
    // Orders are obeyed in order: after HOLD was sent the list may open without waiting for the answer.
    if !model.live.hold_asked {
        accepted(model, &Order::ChoosePlanner(choice))?;
    }
    demand(!model.console.planners.is_empty(), "no planners found yet")
}

/// Whether something that is done about a mission that waits can be done now.
fn before_start(model: &Model, id: ActionId) -> Result<(), String> {
    let live = &model.live;
    match id {
        ActionId::Preflight => demand(live.waits(), "checks are made before the start"),
        ActionId::PlanAgain => demand(live.waits(), "no mission waits for its start"),
        ActionId::Compare => {
            demand(live.waits(), "plans are compared before the start")?;
            demand(!model.console.planners.is_empty(), "no planners found yet")
        }
        _ => {
            let is_planning = live.waits() && live.busy.is_some();
            let is_open = is_planning || live.plans.ghost.is_some() || live.preflight.is_starting;
            demand(is_open, "nothing is being planned")
        }
    }
}

fn parameters(model: &Model) -> Result<(), String> {
    match model.planner() {
        None => Err("no planner loaded yet".into()),
        Some(info) => demand(!info.parameters.is_empty(), &format!("planner {} has no parameters", info.id)),
    }
}

fn simulating(model: &Model) -> Result<(), String> {
    if model.live.is_replay() {
        return Ok(());
    }
    demand(model.live.run.about.is_some() && !model.live.run.has_ended(), "no mission is open")
}

/// One mission at a time.
pub(super) fn nothing_under_way(model: &Model) -> Result<(), String> {
    if !model.live.is_replay() {
        no_orders(model)?;
    }
    let why = model.console.keys.spelled("a mission is in progress; <mission>: show it, <end>: end it");
    demand(!model.live.is_under_way(), &why)
}

fn speed(model: &Model, faster: bool) -> Result<(), String> {
    simulating(model)?;
    let end = if faster { "already at maximum speed" } else { "already at minimum speed" };
    demand(model.live.speed.stepped(faster).is_some(), end)
}

fn map(model: &Model) -> Result<(), String> {
    demand(model.ui.shows(Pane::Map), "the map is not shown; <next-pane>: next pane (needs 60x16)")
}

/// What would be right, in keys.
fn remedy(why: &Refusal, phase: &Phase) -> Option<&'static str> {
    match why {
        Refusal::NotStarted => Some("<start>: start"),
        Refusal::NoPlan => Some("<plan-again>: plan"),
        Refusal::PlanFailed { .. } => Some("<planner>: change planner"),
        // Space asks to resume then.
        Refusal::AlreadyStarted if matches!(phase, Phase::Held(_)) => None,
        Refusal::AlreadyStarted
        | Refusal::AlreadyMoving
        | Refusal::StepNeedsHold
        | Refusal::SwapNeedsHold => Some("<hold>: HOLD"),
        Refusal::Ended(_) => Some("<home> opens another one"),
        Refusal::NoShadow => Some(":shadow NAME flies one"),
        // These say themselves what would be right, as far as there is anything.
        Refusal::Planning
        | Refusal::OtherPlan { .. }
        | Refusal::NotLive { .. }
        | Refusal::PositionLost { .. }
        | Refusal::RangesInconsistent
        | Refusal::NoPlanRefused
        | Refusal::NoOffer
        | Refusal::ShadowNotReady { .. } => None,
    }
}

fn of_shadow(model: &Model, id: ActionId) -> Result<(), String> {
    match id {
        ActionId::Promote => accepted(model, &Order::Promote),
        ActionId::DropShadow => accepted(model, &Order::DropShadow),
        _ => shadow::can_begin(model),
    }
}
