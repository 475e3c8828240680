//! The planner, its progress, how much of the task its plan achieves, and the objections to the plan.

use crate::model::{Cause, Pane};
use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::{confirm, text};
use mission::Phase;
use ratatui::Frame;
use ratatui::layout::Rect;

/// What takes the place of a plan in a survey.
const SURVEY: &str = "A survey has no plan: it drives from frontier to frontier until the floor is explored.";

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let keys = if look.run.is_survey() {
        [""; 2]
    } else {
        ["<planner> planner  <compare> compare", "<planner> <compare>"]
    };
    let keys = keys.map(|keys| look.keys(keys));
    let room = usize::from(area.width).saturating_sub(12);
    let block = look.pane(Pane::Plan, "Plan", &text::wording(keys, room));
    let columns = usize::from(block.inner(area).width).saturating_sub(1);
    if block.inner(area).height <= 1 {
        let line = look.line(one(in_a_line(look, columns)));
        return fill(frame, area, block, vec![line]);
    }
    let height = usize::from(block.inner(area).height);
    let ghost = ghost(look, columns);
    let wordings = Wording::ALL.map(|wording| about_plan(look, columns, wording));
    let fits = wordings.iter().position(|rows| rows.len() + ghost.len() <= height);
    let [.., shortest] = &wordings;
    let mut rows = fits.map_or_else(|| shortest.clone(), |fits| wordings[fits].clone());
    let room = usize::from(block.inner(area).height).saturating_sub(rows.len() + ghost.len());
    let why = text::first_lines(reasons(look, columns), room, columns);
    rows.extend(why.into_iter().map(|line| one((Role::Warn, line))));
    rows.extend(ghost);
    fill(frame, area, block, rows.into_iter().map(|parts| look.line(parts)).collect());
}

/// The rows that the pane needs in a given width, with its frame.
pub(super) fn rows(look: &Look, width: u16) -> u16 {
    let columns = usize::from(width).saturating_sub(3);
    let rows = [about_plan(look, columns, Wording::Full), ghost(look, columns)].concat().len();
    (rows + reasons(look, columns).len() + 2).min(usize::from(u16::MAX)) as u16
}

/// How much the pane says about the plan.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wording {
    /// Everything, with what a re-scan does not request.
    Full,
    /// What the plan achieves and where it begins.
    Short,
    /// Figures in place of the sentence.
    Brief,
}

impl Wording {
    /// The wordings, from the longest to the shortest.
    const ALL: [Self; 3] = [Self::Full, Self::Short, Self::Brief];
}

/// How far the plan is made or what it achieves, where it begins, its certificate and its planner.
fn about_plan(look: &Look, columns: usize, wording: Wording) -> Vec<Parts> {
    let (role, whole) = progress(look);
    let brief = in_figures(look).filter(|_| wording == Wording::Brief);
    let mut rows = wrapped((role, brief.unwrap_or(whole)), columns);
    let resumption = resumption(look, wording);
    rows.extend(resumption.into_iter().flat_map(|words| wrapped((Role::Text, words), columns)));
    rows.extend(certificate(look, columns).map(one));
    if !look.run.is_survey() {
        rows.push(one((Role::Text, text::wording(planner(look), columns))));
    }
    rows
}

/// The objections to the plan, in lines.
fn reasons(look: &Look, columns: usize) -> Vec<String> {
    objections(look).into_iter().flat_map(|why| text::wrap(&why, columns)).collect()
}

/// The state of the plan, and whether it is certified, in one line.
pub(super) fn in_a_line(look: &Look, columns: usize) -> (Role, String) {
    let (role, state) = progress(look);
    let certificate = certificate(look, columns).map_or_else(String::new, |(_, words)| format!(" {words}."));
    let short = in_short(look).unwrap_or_else(|| state.clone());
    let figures = in_figures(look).unwrap_or_else(|| short.clone());
    let wordings = [format!("{state}{certificate}"), short, figures, text::clauses(&state, columns)];
    (role, text::wording(wordings, columns))
}

fn one((role, words): (Role, String)) -> Parts {
    vec![(role, format!(" {words}"))]
}

fn wrapped((role, words): (Role, String), columns: usize) -> Vec<Parts> {
    text::wrap(&words, columns).into_iter().map(|line| one((role, line))).collect()
}

/// The planner, and when the plan was made, from the longest wording to the shortest.
fn planner(look: &Look) -> [String; 3] {
    let name = match (look.model.planner(), look.run.planner_id()) {
        (Some(info), _) => format!("{} {}", info.id, info.version),
        (None, id) => id.unwrap_or("-").to_owned(),
    };
    let plan = look.run.planning.plan.as_ref();
    let made = plan.map_or_else(String::new, |plan| format!(", plan made T+{}", text::clock(plan.t_s)));
    [format!("planner {name}{made}"), format!("planner {name}"), name]
}

fn progress(look: &Look) -> (Role, String) {
    let planning = &look.run.planning;
    if let Some(fault) = &planning.fault {
        return (Role::Crit, format!("FAILED: {}", fault.message));
    }
    match (&look.model.live.busy, &planning.plan) {
        (Some(busy), _) => {
            let what = busy.at.as_ref().map_or_else(String::new, |(_, what)| format!(", {what}"));
            (Role::Watch, format!("{}{what}", busy.how_far()))
        }
        (None, Some(plan)) => ready(look, plan.complete),
        (None, None) if look.run.is_survey() => (Role::Text, SURVEY.into()),
        (None, None) if look.model.live.is_loading() => (Role::Watch, "Loading; the plan follows.".into()),
        (None, None) if look.model.live.awaits_plan() => (Role::Watch, "The plan follows.".into()),
        (None, None) => (Role::Dim, "No plan.".into()),
    }
}

/// Whether the mission has started, and whether its plan can be: a plan that is not certified is never called ready alone.
fn readiness(look: &Look) -> &'static str {
    let is_refused = look.run.tether.as_ref().is_some_and(|tether| tether.certified == Some(false));
    match (*look.run.phase() == Phase::Waiting, is_refused) {
        (true, true) if is_blocked(look) => "NOT certified, start blocked",
        (true, true) => "Ready, NOT certified",
        (true, false) => "Ready",
        (false, true) => "Started, NOT certified",
        (false, false) => "Started",
    }
}

/// Whether the missing certificate of the plan blocks the start.
fn is_blocked(look: &Look) -> bool {
    let is_refused = look.run.tether.as_ref().is_some_and(|tether| tether.certified == Some(false));
    let tether = look.run.about.as_ref().and_then(|about| about.mission.tether.as_ref());
    let waits = *look.run.phase() == Phase::Waiting;
    waits && is_refused && tether.is_some_and(|tether| !tether.allow_uncertified)
}

/// The state of a plan for a scan in a short line: its certificate, what it scans, and how many areas it leaves out.
fn in_short(look: &Look) -> Option<String> {
    look.run.planning.plan.as_ref().filter(|_| look.model.live.busy.is_none())?;
    let left_out = look.model.live.left_out()?;
    let is_certified = look.run.tether.as_ref().is_some_and(|tether| tether.certified == Some(true));
    let certified = match is_certified {
        _ if look.run.is_tether_broken() => ", tether TORN",
        true => ", certified",
        false => "",
    };
    let areas = match left_out.areas.len() {
        0 => String::new(),
        n => format!(", {} left out", text::counted(n, "area")),
    };
    let scanned = text::percent(left_out.scanned());
    let of = match () {
        () if !look.model.live.is_plan_of_the_way() => "",
        () if look.model.live.left_out_by_plan().is_some() => "now ",
        () => "at the start ",
    };
    Some(format!("{}{certified}: {of}{scanned} % of requested{areas}.", readiness(look)))
}

/// The share that the plan scans, in the fewest words.
fn in_figures(look: &Look) -> Option<String> {
    look.run.planning.plan.as_ref().filter(|_| look.model.live.busy.is_none())?;
    let scanned = text::percent(look.model.live.left_out()?.scanned());
    let live = &look.model.live;
    let first = live.left_out_at_start().filter(|_| live.left_out_by_plan().is_some());
    let promised =
        first.map_or_else(String::new, |first| format!(" (promised {} %)", text::percent(first.scanned())));
    Some(format!("{}: {scanned} % of requested{promised}.", readiness(look)))
}

/// How much of the task the plan achieves. The base is the floor that was requested.
fn ready(look: &Look, is_complete: bool) -> (Role, String) {
    let state = format!("{}.", readiness(look));
    let role = if is_complete { Role::Good } else { Role::Warn };
    let words = match look.model.live.left_out() {
        Some(left_out) => {
            let scanned = text::percent(left_out.scanned());
            let smaller = match left_out.slivers.count {
                0 => String::new(),
                n => format!(" (+ {n} smaller)"),
            };
            let areas = match left_out.areas.len() {
                0 => String::new(),
                n => format!("; {} left out{smaller}", text::counted(n, "area")),
            };
            let live = &look.model.live;
            let at_start = live.left_out_at_start().map(|left_out| text::percent(left_out.scanned()));
            match (live.is_plan_of_the_way(), live.left_out_by_plan(), at_start) {
                (true, Some(_), Some(first)) => format!(
                    "{state} With this plan, the run scans {scanned} % of the requested floor (promised {first} %){areas}."
                ),
                (true, None, _) => {
                    format!("{state} The plan at the start scans {scanned} % of the requested floor{areas}.")
                }
                _ if is_blocked(look) => {
                    format!("{state} Would scan {scanned} % of the requested floor{areas}.")
                }
                _ => format!("{state} Scans {scanned} % of the requested floor{areas}."),
            }
        }
        None if is_complete && is_blocked(look) => {
            format!("{state} The plan would achieve the whole task.")
        }
        None if is_complete => format!("{state} The plan achieves the whole task."),
        None => format!("{state} PARTIAL: the plan achieves only part of the task."),
    };
    (role, words)
}

/// Where a plan for a part of the floor begins to scan, beside its mark on the map.
fn resumption(look: &Look, wording: Wording) -> Option<String> {
    let begins = confirm::begins(look.model)?;
    let begins = match wording {
        Wording::Brief => format!("{}.", begins.split(';').next().unwrap_or_default()),
        _ => begins,
    };
    let of_rescan = wording == Wording::Full && look.model.live.is_rescan();
    let not_requested = " Missed areas that are small or out of reach are not requested.";
    Some(format!("R {begins}{}", if of_rescan { not_requested } else { "" }))
}

fn certificate(look: &Look, columns: usize) -> Option<(Role, String)> {
    look.run.about.as_ref()?.mission.tether.as_ref()?;
    if look.run.is_survey() {
        return Some((Role::Text, "tether limits checked before each way".into()));
    }
    let tether = look.run.tether.as_ref();
    if look.run.is_tether_broken() {
        let words = ["tether TORN: the certificate does not apply", "tether TORN"].map(str::to_owned);
        return Some((Role::Crit, text::wording(words, columns)));
    }
    if look.run.is_tether_slack() {
        let words = ["tether SLACK: the certificate assumes a reel that takes it up", "tether SLACK"];
        return Some((Role::Crit, text::wording(words.map(str::to_owned), columns)));
    }
    Some(match tether.and_then(|tether| tether.certified) {
        Some(true) => {
            let pull = pull(look);
            let words = [
                format!("tether certified: can always be reeled in; {pull}"),
                format!("tether certified; {pull}"),
                "tether certified".to_owned(),
            ];
            let has_warning = tether.is_some_and(|tether| !tether.warnings.is_empty());
            (if has_warning { Role::Warn } else { Role::Good }, text::wording(words, columns))
        }
        Some(false) => (Role::Crit, "tether NOT certified".into()),
        None => (Role::Dim, "tether not certified yet".into()),
    })
}

/// The pull that the plan needs.
fn pull(look: &Look) -> String {
    let pull = look.run.tether.as_ref().and_then(|tether| tether.promised_pull);
    pull.map_or_else(|| "pull not checked".into(), |pull| format!("reel needs {}", pull.text()))
}

/// The objections to the plan, and the warnings of its certificate.
fn objections(look: &Look) -> Vec<String> {
    let alarms = look.run.alarms.list().iter();
    let warnings = look.run.tether.iter().flat_map(|tether| &tether.warnings);
    let warnings = warnings.map(|warning| text::capitalized(warning));
    alarms
        .filter(|alarm| matches!(alarm.cause, Cause::Certificate | Cause::Planner))
        .map(|alarm| match alarm.text.split_once(": ") {
            // The line above already states that the plan is not certified.
            Some((_, why)) if alarm.cause == Cause::Certificate => text::capitalized(why),
            _ => alarm.text.clone(),
        })
        .chain(warnings)
        .collect()
}

/// The progress of the plan for comparison.
fn ghost(look: &Look, columns: usize) -> Vec<Parts> {
    let Some(ghost) = &look.model.live.plans.ghost else { return Vec::new() };
    let id = &ghost.choice.id;
    let words = match (&ghost.made, &ghost.at) {
        (Some(Err(why)), _) => (Role::Warn, format!("{id}: {why}")),
        (Some(Ok(_)), _) => (Role::Ghost, look.keys(&format!("compared with {id} (<cancel-plan>: remove)"))),
        (None, Some((share, _))) => {
            (Role::Watch, format!("Planning ({id}) {} %", (100.0 * share).floor().clamp(0.0, 99.0)))
        }
        (None, None) => (Role::Watch, format!("Planning ({id})")),
    };
    wrapped(words, columns)
}
