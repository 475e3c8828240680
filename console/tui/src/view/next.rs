//! The line that states what happens next and whether the operator must act.

mod held;

use super::{confirm, events, home, text};
use crate::actions::{context::contexts, find};
use crate::guide;
use crate::model::planning::Lead;
use crate::model::{Alarm, Busy, Model, Offer, Overlay, Progress, Replay, Run, Screen, ui::Ask};
use crate::theme::Role;
use crate::update::offered;
use held::Head;
use mission::{Outcome, Phase, Readiness, Severity};

const ACKNOWLEDGE: &str = "<acknowledge>: acknowledge.";

/// The role of the line, and its clauses, most important first.
pub(super) type Clauses = (Role, Vec<String>);

/// What comes next, with the operator's keys.
pub(super) fn clauses(model: &Model) -> Clauses {
    let (role, mut clauses) = by_phase(model);
    // A list that lies over the screen takes the key of the start.
    if let Some(first) = clauses.first_mut().filter(|first| first.contains("<start>") && !works(model, first))
    {
        *first = "Ready.".into();
    }
    clauses.retain(|clause| works(model, clause));
    // While a question is open, other keys do not do what they usually do.
    if model.ui.overlay.is_question() || matches!(model.ui.overlay, Overlay::ZoneDraft(_)) {
        clauses.retain(|clause| !clause.contains(['<', '>']));
        clauses.truncate(1);
    }
    // The question contains the figures of the plan.
    if matches!(model.ui.overlay, Overlay::Confirm(Ask::Start(_))) {
        clauses = vec!["Ready. The robot does not move yet.".into()];
    }
    // If the console that runs the mission has exited, no console can give orders.
    if model.live.is_look_only() && !model.live.is_cut_off {
        clauses.retain(|clause| !clause.contains(['<', '>']));
        clauses.push(match &model.live.replay {
            Some(replay) => played(model, replay),
            None => "VIEW: orders are given on the console that runs the mission.".into(),
        });
    }
    (role, clauses.iter().map(|clause| model.console.keys.spelled(clause)).collect())
}

/// The line for a replay, with the key that plays or pauses.
fn played(model: &Model, replay: &Replay) -> String {
    let next = match (model.live.is_opening, replay.is_playing) {
        (true, _) => "Reading the run...",
        (false, true) => "<play>: pause.",
        (false, false) => "<play>: play.",
    };
    format!("Replay, no robot connected. {next}")
}

fn by_phase(model: &Model) -> Clauses {
    if model.live.is_cut_off {
        let lost = ["CONSOLE LOST: the run was not closed.", "Last known values."].map(str::to_owned);
        return (Role::Crit, lost.into());
    }
    if let Some(silent_s) = model.silent_s() {
        let news = format!("◌ No data from the mission for {} s: values are stale.", silent_s as u64);
        return (Role::Stale, vec![news, "<hold>: HOLD.".into()]);
    }
    if model.live.hold_asked && model.live.may_move() {
        return (Role::Hold, vec!["HOLD requested...".into()]);
    }
    let work = model.live.busy.as_ref().map(|busy| work(model, busy));
    match (&model.live.asked, model.live.run.phase()) {
        (Some(order), _) if order.is_start() => (Role::Title, vec!["Starting...".into()]),
        (Some(_), _) => (Role::Title, vec!["Order sent...".into()]),
        (None, Phase::Held(hold)) => {
            let mut clauses = held::clauses(model, hold);
            // Warnings that the robot may or will move come before the work of a planner.
            let at = held::leading(model, hold).min(clauses.len());
            clauses.splice(at..at, work.into_iter().flatten());
            (Role::Hold, clauses)
        }
        (None, Phase::Waiting) if model.ui.screen == Screen::Home => (Role::Title, home::next(model)),
        (None, Phase::Waiting) if model.live.replay.is_some() => {
            (Role::Title, vec!["Before the start of the mission.".into()])
        }
        (None, Phase::Waiting) => {
            let (role, start) = idle(model);
            (role, work.into_iter().flatten().chain(start).collect())
        }
        (None, Phase::Running(_)) => match work {
            Some(work) => {
                let stop = ["<hold>: HOLD.", "<end>: end mission."].map(str::to_owned);
                (Role::Watch, work.into_iter().chain(stop).collect())
            }
            None => running(model),
        },
        (None, Phase::Ended(outcome)) => ended(model, *outcome),
    }
}

/// The end of a mission. It is not good as long as the vehicle may still move.
fn ended(model: &Model, outcome: Outcome) -> Clauses {
    let run = &model.live.run;
    let (role, end) = match outcome {
        Outcome::Complete => (Role::Good, "DONE".to_owned()),
        outcome => (Role::Warn, format!("ENDED ({})", outcome.word())),
    };
    let (role, state) = match model.live.doubt() {
        Some((area_m2, _)) => {
            let area_m2 = text::number(area_m2, 1);
            (Role::Warn, format!("{end}, {area_m2} m² IN DOUBT: {}.", run.end_reason))
        }
        None => (role, format!("{end}: {}.", run.end_reason)),
    };
    let (role, warning) = match held::head(run) {
        Head::Held => (role, None),
        Head::Stopping => (Role::Warn, Some("The stop is not confirmed yet.")),
        Head::NotConfirmed => (Role::Crit, Some("STOP NOT CONFIRMED: go to the vehicle.")),
    };
    let warning = warning.map(str::to_owned);
    (role, std::iter::once(state).chain(warning).chain(more(model)).collect())
}

/// What comes next, as the state and then what the operator can do, with commands instead of keys.
pub(crate) fn by_command(model: &Model) -> Vec<String> {
    let mut keys = model.console.keys.clone();
    keys.spells_commands = true;
    let clauses = by_phase(model).1;
    let can = |clause: &&String| find::named_in(clause).all(|action| offered(model, action.id).is_ok());
    clauses.iter().filter(can).map(|clause| keys.spelled(clause)).collect()
}

/// Whether every key that a clause names, such as `<planner>`, does something now on this screen. The footer and the keys
/// use the same table.
fn works(model: &Model, clause: &str) -> bool {
    let contexts = contexts(model);
    find::named_in(clause).all(|action| {
        let key = model.console.keys.key_of(action);
        let has_key = key.is_none_or(|key| find::action_for(&model.console.keys, key, &contexts).is_some());
        has_key && offered(model, action.id).is_ok()
    })
}

/// What happens next, in sentences, without the figures that keep changing.
pub(crate) fn standing(model: &Model) -> Vec<String> {
    if let (Phase::Held(hold), None, false) =
        (model.live.run.phase(), &model.live.asked, model.live.is_cut_off || model.live.is_look_only())
    {
        let work = model.live.busy.as_ref().map(|busy| format!("{}.", busy.work));
        let mut clauses: Vec<String> = held::clauses(model, hold).into_iter().chain(work).collect();
        clauses.retain(|clause| works(model, clause));
        return clauses.iter().map(|clause| model.console.keys.spelled(clause)).collect();
    }
    if let Some(busy) = &model.live.busy {
        return vec![format!("{}.", busy.work)];
    }
    if model.live.run.is_running() {
        return vec!["Mission running.".into()];
    }
    clauses(model).1
}

/// The keys for what can be done after a mission has ended.
fn more(model: &Model) -> impl Iterator<Item = String> {
    let keys: &[&str] = match model.ui.screen {
        Screen::Result if model.live.run.is_survey() => {
            &["<rescan>: plan a scan of this map.", "<home>: home."]
        }
        Screen::Result if model.live.missed().is_empty() && model.live.doubt().is_none() => {
            &["<again>: new run.", "<home>: home."]
        }
        Screen::Result => &["<again>: new run.", "<rescan>: re-scan.", "<home>: home."],
        Screen::Home => &["<result>: result."],
        _ => &["<result>: result.", "<home>: home."],
    };
    keys.iter().map(|key| (*key).to_owned())
}

/// A planner's work: its progress, elapsed time, limit and current activity.
fn work(model: &Model, busy: &Busy) -> Vec<String> {
    let passed_s = (model.console.now.mono_s - busy.since_mono_s).max(0.0) as u64;
    let time = |limit_s: f64| format!(", {passed_s} s (limit {} s)", limit_s as u64);
    let first = format!("{}{}.", busy.how_far(), busy.limit_s.map_or_else(String::new, time));
    let what = busy
        .at
        .iter()
        .filter(|(_, what)| !what.is_empty())
        .map(|(_, what)| format!("{}.", text::capitalized(what)));
    std::iter::once(first).chain(what).collect()
}

/// As many clauses as fit into a given width; the first one is shortened if necessary.
pub(super) fn joined(clauses: &[String], columns: usize) -> String {
    fitting(clauses, columns).join(" ")
}

/// The clauses that fit; the first one is shortened if necessary.
fn fitting(clauses: &[String], columns: usize) -> Vec<String> {
    let mut kept: Vec<String> = clauses.first().map(|first| shortened(first, columns)).into_iter().collect();
    let mut used = kept.first().map_or(0, |first| text::width(first));
    for clause in clauses.iter().skip(1) {
        let more = 1 + text::width(clause);
        if used + more <= columns {
            kept.push(clause.clone());
            used += more;
        }
    }
    kept
}

/// The leading clauses of a sentence that fit. They end as a sentence, because the name of a key may follow.
fn shortened(sentence: &str, columns: usize) -> String {
    if text::width(sentence) <= columns {
        return sentence.to_owned();
    }
    let short = text::clauses(sentence, columns.saturating_sub(1));
    if sentence.ends_with('.') && short.ends_with(char::is_alphanumeric) { short + "." } else { short }
}

/// The line in a given width. While the robot is held, the first clause also states where the robot is and how far the
/// mission has come, if no other clause has to be dropped for this.
pub(super) fn line(model: &Model, clauses: &[String], columns: usize) -> String {
    let short = fitting(clauses, columns);
    let state = short.first().map_or("", String::as_str);
    let whereabouts = held::whereabouts(model, state).into_iter();
    let longer = whereabouts.filter_map(|whereabouts| {
        let mut clauses = short.clone();
        let first = clauses.first_mut()?;
        *first = format!("{}{whereabouts}.", first.strip_suffix('.')?);
        Some(clauses.join(" ")).filter(|line| text::width(line) <= columns)
    });
    longer.into_iter().next().unwrap_or_else(|| short.join(" "))
}

fn idle(model: &Model) -> Clauses {
    if model.live.failure.is_some() {
        return (Role::Warn, vec!["The scenario cannot be opened.".into(), "<home>: choose another.".into()]);
    }
    if model.live.run.about.is_none() {
        return (Role::Title, vec!["Loading scenario...".into()]);
    }
    if model.live.preflight.is_starting {
        return (Role::Title, vec!["Checking before the start...".into()]);
    }
    let is_opened =
        model.live.run.is_survey() || model.planner().is_some() || model.live.run.planning.fault.is_some();
    let is_preparing = match model.live.run.standing.standing().readiness {
        Readiness::Preparing => true,
        Readiness::NoPlan => model.live.awaits_plan() || !is_opened,
        _ => false,
    };
    if model.live.busy.is_some() || is_preparing {
        return (Role::Title, vec!["Start when the plan is ready.".into()]);
    }
    let preflight = "<preflight>: pre-flight check.";
    if let Some(fault) = &model.live.run.planning.fault {
        let planner = text::fit(model.live.run.planner_id().unwrap_or("unknown"), 18);
        let clauses = [
            format!("Start blocked: planner {planner} failed ({}).", fault.cause),
            "<plan-again>: replan.".into(),
            "<planner>: change planner.".into(),
            format!("{}.", text::capitalized(&fault.message)),
            preflight.into(),
        ];
        return (Role::Warn, clauses.into());
    }
    // A planner that is still being opened does not block the start yet.
    if let Some(failed) = model.blocking_check().filter(|_| is_opened) {
        let (what, why) =
            (format!("Start blocked: {}.", failed.what), format!("{}.", text::capitalized(&failed.found)));
        return (Role::Warn, vec![what, why, preflight.into()]);
    }
    let plan = format!("{}.", text::capitalized(&confirm::promised(model)));
    (Role::Title, vec!["<press> <start> to start.".into(), plan, preflight.into()])
}

fn running(model: &Model) -> Clauses {
    if model.live.run.phase().is_return() && model.live.run.position.pulses_until_s.is_none() {
        return (Role::Run, driving_back(model));
    }
    if model.live.run.position.lost {
        let hold_s = model.live.run.about.as_ref().map_or(0.0, |run| run.mission.position_lost_hold_s);
        let text = format!("POSITION LOST: automatic HOLD after {} s.", text::number(hold_s, 1));
        return (Role::Crit, vec![text]);
    }
    let alarms = &model.live.run.alarms;
    let is_shown = |alarm: &&Alarm| alarm.severity >= Severity::Warn;
    let (role, doing) = doing(model);
    if let Some(alarm) = alarms.worst_active_unacknowledged().filter(is_shown) {
        let name = text::capitalized(&guide::name(&alarm.cause, &model.live.run));
        let details = format!("{}.", text::capitalized(&alarm.text));
        let clauses = [format!("{name}."), ACKNOWLEDGE.into(), details].into_iter().chain(doing);
        return (events::role(alarm.severity), clauses.collect());
    }
    let last = if let Some(alarm) = alarms.worst_returned() {
        let name = text::capitalized(&guide::name(&alarm.cause, &model.live.run));
        let figure = alarm.peak.as_ref().filter(|peak| !peak.limit.is_empty());
        // A console that gives no orders acknowledges nothing.
        let acknowledge = if model.live.is_look_only() { "" } else { ACKNOWLEDGE };
        let figure = figure.map(|peak| format!("It reached {}, limit {}.", peak.now, peak.limit));
        [Some(format!("{name} (cleared). {acknowledge}").trim_end().to_owned()), figure]
    } else {
        let new = alarms.open().filter(|alarm| alarm.is_unacknowledged()).count();
        let words = match new {
            1.. if !model.live.is_look_only() => format!("{} to acknowledge.", text::counted(new, "alarm")),
            _ => "No action required.".to_owned(),
        };
        [(role == Role::Title).then_some(words), None]
    };
    (role, doing.into_iter().chain(last.into_iter().flatten()).collect())
}

/// That the task is done and the robot waits for the last pulse test; `None` if it does not.
fn awaiting_pulses(run: &Run) -> Option<Vec<String>> {
    let until = text::clock(run.position.pulses_until_s?);
    let waits = format!("The robot stands still for the last pulse test, until T+{until} at most.");
    Some(vec!["Task done.".into(), waits])
}

/// What the robot does now: a better plan on offer, the way to the start of a new plan, or the next target.
fn doing(model: &Model) -> Clauses {
    let run = &model.live.run;
    if let Some(waits) = awaiting_pulses(run) {
        return (Role::Title, waits);
    }
    if let Some(offer) = &run.planning.offer {
        return (Role::Watch, better_plan(offer));
    }
    let Some(progress) = &run.progress else {
        return (Role::Title, vec!["Waiting for first command.".into()]);
    };
    let done = done(run, progress);
    if let Some(survey) = &run.survey {
        let next = survey.way.as_ref().map_or("looking for a way", |way| way.to.words());
        let explored = survey.share.map_or_else(|| "-".into(), text::percent);
        return (Role::Title, vec![format!("Next: {next}."), format!("{explored} % of the floor explored.")]);
    }
    let plan = run.planning.plan.as_ref();
    if let Some((lead, left_m)) = plan.and_then(|plan| plan.lead_left_m(progress)) {
        let why = match lead {
            Lead::Back => "Driving back along the tether to the start of the new plan",
            // Lanes were driven before a plan that was made on the way.
            Lead::ToLane if plan.is_some_and(|plan| plan.driven_m > 0.0) => "Driving to the next lane",
            Lead::ToLane => "Driving to the first lane of the plan",
        };
        let left = format!("{why}: {} m left.", text::number(left_m, 1));
        return (Role::Title, vec![left, format!("{}.", text::capitalized(&done))]);
    }
    (Role::Title, vec![format!("Next target: {}; {done}.", text::place(progress.target))])
}

/// How much of the path has been driven. A plan that was made on the way begins at 0 %, so the scanned floor is beside it.
fn done(run: &Run, progress: &Progress) -> String {
    let done = text::percent(progress.done);
    let is_new = run.planning.plan.as_ref().is_some_and(|plan| plan.driven_m > 0.0);
    if is_new && run.covers() {
        let floor = text::percent(progress.covered_reachable);
        return format!("{done} % of the new plan driven, {floor} % of the floor scanned");
    }
    format!("path {done} % done")
}

/// The drive back to the anchor or the start.
fn driving_back(model: &Model) -> Vec<String> {
    let stop = "<hold>: HOLD.".to_owned();
    let run = &model.live.run;
    let (Some(way), Some(left_m)) = (&run.way_back, run.way_left_m()) else {
        return vec!["Driving back.".into(), stop];
    };
    let left = format!("Driving back to the {}: {} m left.", way.to.word(), text::number(left_m, 1));
    vec![left, stop, format!("Clearance {} m.", text::number(way.clearance_m, 2))]
}

/// A better plan that is on offer or will be taken.
fn better_plan(offer: &Offer) -> Vec<String> {
    let begins = offer.begins.map_or_else(String::new, |at| format!(" at {}", text::place(at)));
    if offer.is_taken {
        let change = format!("Better plan accepted: change-over{begins}, without a hold.");
        return vec![change, format!("{}.", text::capitalized(&offer.better.saving(&offer.flown)))];
    }
    let (saves, take) = (format!("{}.", offer.sentence()), "<take-plan>: take.".to_owned());
    [saves, take].into_iter().chain(offer.scanned()).chain([format!("It begins{begins}.")]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clauses_that_do_not_fit_are_left_out_whole() {
        let clauses = ["HELD by operator.", "space: resume.", "P."].map(str::to_owned);
        assert_eq!(joined(&clauses, 40), "HELD by operator. space: resume. P.");
        assert_eq!(joined(&clauses, 20), "HELD by operator. P.");
        assert_eq!(joined(&clauses, 9), "HELD by…");
    }

    #[test]
    fn a_sentence_that_is_shortened_before_a_key_keeps_its_full_stop() {
        let clauses =
            ["DONE: back at the start, 26.8 % of the floor scanned.", "p: replan."].map(str::to_owned);
        assert_eq!(joined(&clauses, 40), "DONE: back at the start. p: replan.");
        assert_eq!(joined(&clauses, 24), "DONE: back at the start.");
        assert_eq!(joined(&clauses, 23), "DONE: back at the…");
    }
}
