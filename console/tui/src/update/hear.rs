//! Handles messages about the open run.

use super::send::slow_if_held;
use super::{Effect, RunMsg, finish, go, health, news, preflight, raise, replay, what_if, zones};
use crate::model::{
    Busy, Cause, Change, Continued, Health, Live, Model, Overlay, Recording, RunId, RunResult, Screen,
    Together, Withdrawn,
    alarms::limit::Watch,
    ui::{Ask, MapView},
};
use mission::{Event, EventKind, Order, PlanId, Severity};

/// Handles a message about a run. A message about a run that is no longer open has come too late and is dropped. A
/// message about the previous run, which may stay open if the next one cannot be opened, is folded in but has no
/// other effect.
pub(super) fn hear(model: &mut Model, id: RunId, msg: RunMsg) -> Vec<Effect> {
    if let Some(before) = model.live.before.take_if(|before| before.id == id) {
        let next = std::mem::replace(&mut model.live, *before);
        hear(model, id, msg);
        model.live = Live { before: Some(Box::new(std::mem::take(&mut model.live))), ..next };
        return Vec::new();
    }
    if id != model.live.id {
        return Vec::new();
    }
    match msg {
        RunMsg::OpenFailed(why) => go::not_opened(model, why),
        RunMsg::Events(events) => {
            model.live.heard_mono_s = model.console.now.mono_s;
            for event in &events {
                take(model, event);
            }
            let goes_on = |event: &Event| {
                matches!(
                    event.kind,
                    EventKind::Resumed | EventKind::ObstacleFound { .. } | EventKind::Ended { .. }
                )
            };
            if events.iter().any(|event| event.kind == EventKind::Resumed) {
                model.live.way_back = None;
            }
            if events.iter().any(goes_on) {
                return what_if::forget(model);
            }
            if let Some(slower) = slow_if_held(model, &events) {
                return vec![slower];
            }
            let has_opened = events.iter().any(|event| matches!(event.kind, EventKind::RunOpened(_)));
            // The operator must see the plan before anything moves; a survey has none.
            if !has_opened || !model.live.waits() || model.live.run.is_survey() {
                return Vec::new();
            }
            model.live.plans.is_asked = true;
            return vec![Effect::Order(Order::Plan)];
        }
        RunMsg::Checked(found) => return preflight::checked(model, found),
        RunMsg::Estimated(ask, estimate) => model.live.promises(ask, *estimate),
        RunMsg::Promised(promise) => model.live.plans.promised_at_start(*promise),
        RunMsg::WayBack(way) => finish::found(model, way),
        RunMsg::ZoneCost(corners, cost) => zones::priced(model, &corners, cost),
        RunMsg::InDoubt(floor) => model.live.in_doubt = floor,
        RunMsg::LeftOut(ask, left_out) => model.live.leaves_out(ask, *left_out),
        RunMsg::CompareAt(share, what) => {
            if let Some(ghost) = &mut model.live.plans.ghost {
                ghost.at = Some((share, what));
            }
        }
        RunMsg::Compared(choice, made) => {
            if let Some(ghost) = model.live.plans.ghost.as_mut().filter(|ghost| ghost.choice == choice) {
                ghost.made = Some(made.map(|made| *made));
            }
        }
        RunMsg::WriterGone => {
            model.live.is_cut_off = true;
            // The state line reports this, too.
            raise(model, &Cause::Writer, "CONSOLE LOST: the run was not closed".into());
        }
        RunMsg::Health(health) => take_health(model, health),
        RunMsg::OrderFailed { order, why } => {
            model.live.answered(&order);
            news(model, &Cause::Console, Severity::Crit, why);
        }
        RunMsg::Busy(work) => {
            let since_mono_s = model.console.now.mono_s;
            model.live.busy = work.map(|(work, limit_s)| Busy { work, limit_s, since_mono_s, at: None });
        }
        RunMsg::BusyAt { share, what } => {
            // Progress reported after the end of the work is ignored.
            if let Some(busy) = &mut model.live.busy {
                busy.at = Some((share, what));
            }
        }
        RunMsg::ForecastAt(choice, share) => what_if::at(model, &choice, share),
        RunMsg::Forecast(choice, forecast) => {
            what_if::made(model, &choice, forecast.map(|forecast| *forecast));
        }
        RunMsg::Closed(result) => return closed(model, *result),
        RunMsg::Continues(Ok(Continued { runs, left_at })) => {
            (model.live.earlier, model.live.left_at) = (runs, left_at);
            return combine(model).into_iter().collect();
        }
        RunMsg::Continues(Err(why)) | RunMsg::ScannedBefore(Err(why)) => {
            model.live.combined = Some(Err(why));
        }
        RunMsg::ScannedBefore(Ok(read)) => {
            model.live.read_before = Some(read);
            model.live.lay_before();
        }
        RunMsg::Combined(combined) => {
            let own = model.live.run.coverage.as_ref();
            let combined = combined.map(|found| Box::new(Together::new(*found, own)));
            model.live.combined = Some(combined);
        }
        RunMsg::Replay(msg) => {
            replay::hear(model, msg);
            model.live.lay_before();
        }
    }
    Vec::new()
}

fn take(model: &mut Model, event: &Event) {
    let Change { withdrawn, notice, answered } = model.live.run.fold(event);
    match &event.kind {
        EventKind::RunOpened(_) => {
            (model.live.is_opening, model.live.before) = (false, None);
            model.live.lay_before();
        }
        EventKind::Ended { .. } => {
            (model.live.asked, model.live.hold_asked) = (None, false);
            // A zone that is being drawn ends with its mission.
            if matches!(model.ui.overlay, Overlay::ZoneDraft(_)) {
                model.ui.overlay = Overlay::None;
            }
        }
        _ => {}
    }
    if let Some(order) = answered {
        model.live.answered(&order);
    }
    if let Some((severity, text)) = notice {
        let text = model.console.keys.spelled(&text);
        model.say(severity, text);
    }
    withdraw(model, withdrawn);
    withdraw_start(model);
    withdraw_offer(model);
}

/// Withdraws the question about a better plan whose offer has ended.
fn withdraw_offer(model: &mut Model) {
    if matches!(model.ui.overlay, Overlay::Confirm(Ask::TakePlan)) && model.live.run.planning.offer.is_none()
    {
        model.ui.overlay = Overlay::None;
    }
}

/// Withdraws a start that was requested with a plan that has been replaced since.
fn withdraw_start(model: &mut Model) {
    let ready = model.live.run.standing.ready_plan();
    let is_other = |seen: Option<PlanId>| seen.is_some() && seen != ready;
    if matches!(model.ui.overlay, Overlay::Confirm(Ask::Start(seen)) if is_other(seen)) {
        model.ui.overlay = Overlay::None;
        model.say(Severity::Warn, "question cancelled: a new plan is being made");
    }
    if model.live.preflight.is_starting && is_other(model.live.preflight.seen) {
        model.live.preflight.is_starting = false;
        model.say(Severity::Warn, "start cancelled: a new plan is being made");
    }
}

/// Withdraws a question that was asked under conditions that have changed.
fn withdraw(model: &mut Model, withdrawn: Withdrawn) {
    let is_withdrawn = match (withdrawn, &model.ui.overlay) {
        (Withdrawn::Nothing, _) => false,
        (
            _,
            Overlay::Confirm(Ask::Resume | Ask::DriveBack | Ask::FlyUncertified) | Overlay::Finish { .. },
        )
        | (Withdrawn::All, Overlay::Confirm(_) | Overlay::Stepping) => true,
        _ => false,
    };
    if is_withdrawn {
        model.ui.overlay = Overlay::None;
        model.say(Severity::Warn, "question cancelled: conditions have changed");
    }
}

fn take_health(model: &mut Model, health: Health) {
    match &health.recording {
        Recording::Failed(why) if health.recording != model.live.health.recording => {
            news(model, &Cause::Recording, Severity::Crit, format!("recording failed: {why}"));
        }
        Recording::Failed(_) => {}
        Recording::On | Recording::Off => {
            let t_s = model.live.run.clock.t_s;
            model.live.run.alarms.clear(&Cause::Recording, t_s);
        }
    }
    health::take_lag(model, health.recorder_lag);
    model.live.health = health;
}

/// The run is over: an operator who was watching it is shown the result.
fn closed(model: &mut Model, result: RunResult) -> Vec<Effect> {
    rest(model, result.is_kept);
    model.live.result = Some(result);
    // The result is about the whole tank.
    model.ui.map = MapView::default();
    if model.ui.screen == Screen::Mission && model.ui.overlay == Overlay::None {
        model.ui.go(Screen::Result);
    }
    combine(model).into_iter().chain([Effect::Look]).collect()
}

/// Nothing is recorded any more, so the alarms about the recorder end. The alarm about a run that was not kept
/// stays.
fn rest(model: &mut Model, is_kept: bool) {
    let run = &mut model.live.run;
    model.console.watches.recorder_lag = Watch::default();
    run.alarms.clear(&Cause::RecorderLag, run.clock.t_s);
    if is_kept {
        run.alarms.clear(&Cause::Recording, run.clock.t_s);
    }
}

/// Requests the combined scan of a re-scan that has ended and the runs before it.
fn combine(model: &Model) -> Option<Effect> {
    let result = model.live.result.as_ref().filter(|result| result.is_kept)?;
    model.live.with_earlier(result.name.as_ref()?).map(Effect::Combine)
}
