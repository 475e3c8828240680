//! Moves between screens and opens what is listed on them: scenarios, past runs, background work.

use super::message::{Effect, Job};
use super::offer::{nothing_under_way, offered, refuse};
use super::{news, replay};
use crate::actions::ActionId;
use crate::model::home::HomeList;
use crate::model::log::clock;
use crate::model::ui::Arrangement;
use crate::model::{Cause, Live, Model, Overlay, Pane, RunId, ScenarioEntry, Screen, Source};
use crate::view::result;
use mission::{PlannerChoice, Severity};
use world::Point;

/// Goes to a screen.
pub(crate) fn go(model: &mut Model, screen: Screen) -> Vec<Effect> {
    model.ui.go(screen);
    looked(screen)
}

/// Returns to the previous screen, if there is one.
pub(crate) fn back(model: &mut Model) -> Option<Vec<Effect>> {
    let before = model.ui.back.pop().or((model.ui.screen != Screen::Home).then_some(Screen::Home))?;
    model.ui.screen = before;
    Some(looked(before))
}

/// Rescans the disk whenever a screen shows its contents.
fn looked(screen: Screen) -> Vec<Effect> {
    if screen.row().lists_runs { vec![Effect::Look] } else { Vec::new() }
}

/// The effect of Enter on the home screen, in a word or two; `None` if nothing is selected, or if it cannot be opened now.
pub(crate) fn opens_at_home(model: &Model) -> Option<&'static str> {
    let home = &model.home;
    let if_possible = |word| why_not_open(model).is_none().then_some(word);
    match home.list {
        HomeList::Scenarios => {
            let entry = home.selected_scenario()?;
            let is_shown = is_open_mission(model, entry) && model.live.is_under_way();
            if is_shown { Some("show") } else { if_possible("open") }
        }
        HomeList::Runs => {
            let is_open = selected_run(model)? == result_name(model).unwrap_or_default();
            if is_open { Some("result") } else { if_possible("replay") }
        }
        HomeList::Attention => {
            home.found.as_ref().filter(|found| !found.attention.is_empty())?;
            Some(if home.is_read { "close text" } else { "full text" })
        }
    }
}

/// Why the selected item on the home screen cannot be opened now; `None` if it can.
pub(super) fn why_not_open(model: &Model) -> Option<String> {
    match model.home.list {
        HomeList::Scenarios => match model.home.selected_scenario() {
            None => Some("no scenario is listed".into()),
            Some(entry) => match entry.briefly() {
                Some(why) => Some(format!("{} cannot be opened: {why}", entry.name)),
                None => nothing_under_way(model).err(),
            },
        },
        HomeList::Runs => offered(model, ActionId::Replay).err(),
        HomeList::Attention => None,
    }
}

/// Puts the selection of the home screen on the open scenario.
pub(super) fn select_open(model: &mut Model) {
    let listed = model.home.scenarios();
    let open = listed.iter().position(|entry| model.live.source.as_ref() == Some(&entry.source));
    if let Some(index) = open {
        model.home.scenario = index;
    }
}

/// Opens the selected item on the home screen.
pub(crate) fn open_selected(model: &mut Model) -> Vec<Effect> {
    let home = &model.home;
    match home.list {
        HomeList::Scenarios => {}
        HomeList::Runs => return go_to_run(model),
        HomeList::Attention => {
            model.home.is_read = !model.home.is_read;
            return Vec::new();
        }
    }
    match home.selected_scenario() {
        Some(entry) if is_open_mission(model, entry) && model.live.is_under_way() => {
            go(model, Screen::Mission)
        }
        Some(entry) if why_not_open(model).is_none() => {
            let source = entry.source.clone();
            open(model, source, None)
        }
        _ => {
            let why = why_not_open(model).unwrap_or_default();
            refuse(model, why)
        }
    }
}

/// Whether a scenario is that of the open mission, which has not ended.
pub(crate) fn is_open_mission(model: &Model, entry: &ScenarioEntry) -> bool {
    let live = &model.live;
    live.source.as_ref() == Some(&entry.source) && !live.is_look_only() && !live.run.has_ended()
}

/// Closes the text of an attention item; returns whether one was open.
pub(super) fn close_text(model: &mut Model) -> bool {
    let is_shown = model.ui.overlay == Overlay::None && model.ui.screen == Screen::Home;
    is_shown && std::mem::take(&mut model.home.is_read)
}

/// Shows the result of the selected run if it is the open one; replays any other run.
fn go_to_run(model: &mut Model) -> Vec<Effect> {
    let is_open = selected_run(model).is_some() && selected_run(model) == result_name(model);
    if is_open { go(model, Screen::Result) } else { begin(model, ActionId::Replay) }
}

/// Opens a scenario: its mission is laid out and waits for its start; nothing moves.
pub(super) fn open(model: &mut Model, source: Source, planner: Option<PlannerChoice>) -> Vec<Effect> {
    if let Err(why) = nothing_under_way(model) {
        return refuse(model, why);
    }
    let id = RunId(model.live.id.0 + 1);
    // A speed set for one mission must not carry over: the next mission could be over before the operator sees it.
    let speed = model.first_speed;
    let before = std::mem::take(&mut model.live);
    // If several runs are opened in quick succession, the last one that was completely open is kept.
    let before =
        if before.is_opening { before.before } else { before.source.is_some().then(|| Box::new(before)) };
    model.live =
        Live { id, source: Some(source.clone()), is_opening: true, before, speed, ..Live::default() };
    (model.ui.map, model.ui.cursor) = (crate::model::ui::MapView::default(), None);
    (model.ui.missed, model.ui.plate, model.ui.scrolled) = (0, 0, 0);
    model.console.notice = None;
    model.ui.go(Screen::Plan);
    vec![Effect::Open { id, source, planner, speed }]
}

/// Reports that a scenario cannot be opened; the previously open run, if any, stays open.
pub(super) fn not_opened(model: &mut Model, why: String) {
    let Some(before) = model.live.before.take() else {
        model.live.is_opening = false;
        model.live.failure = Some(why);
        return;
    };
    model.live = *before;
    model.ui.screen = model.ui.back.pop().unwrap_or(Screen::Home);
    news(model, &Cause::Console, Severity::Warn, format!("not opened: {why}"));
    // The rest of the message is in the events.
    model.say(Severity::Warn, format!("not opened: {}", why.lines().next().unwrap_or_default()));
}

/// Reopens the scenario of the current run with the same planner.
pub(crate) fn again(model: &mut Model) -> Vec<Effect> {
    let Some(source) = model.live.source.clone() else { return Vec::new() };
    let planner = model.live.run.planning.choice.clone();
    open(model, source, planner)
}

/// Moves the selection down by `by` lines of the pane of the result screen that responds to the arrow keys; a pane of text
/// is scrolled.
pub(crate) fn select_in_result(model: &mut Model, by: isize) {
    match model.ui.pane {
        Pane::Figures | Pane::Coverage => {
            let most = result::most_scrolled(model, model.ui.pane);
            model.ui.scrolled = model.ui.scrolled.min(most).saturating_add_signed(by).min(most);
        }
        Pane::Plates => select_plate(model, by),
        _ => select_missed(model, by),
    }
}

/// Moves the selection down by `by` plates.
fn select_plate(model: &mut Model, by: isize) {
    let last = model.live.floor().map_or(0, |floor| floor.plates.len().saturating_sub(1));
    model.ui.plate = model.ui.plate.saturating_add_signed(by).min(last);
}

/// Moves the selection down by `by` missed areas and centres the map on the area.
pub(crate) fn select_missed(model: &mut Model, by: isize) {
    let places: Vec<Point> = model.live.missed().iter().map(|area| area.at).collect();
    model.ui.missed = model.ui.missed.saturating_add_signed(by).min(places.len().saturating_sub(1));
    let Some(bounds) = model.live.run.about.as_ref().map(|about| about.world.boundary.bounds()) else {
        return;
    };
    if let Some(at) = places.get(model.ui.missed).filter(|_| model.ui.map.zoom > 0) {
        model.ui.map.follow = false;
        model.ui.map.offset = at - nalgebra::center(&bounds.0, &bounds.1);
    }
}

/// The run to which a command applies, if there is one.
pub(super) fn named_run(model: &Model) -> Option<String> {
    (model.ui.screen.row().run)(model)
}

/// The run selected on the home screen: in the list of runs, or the one that the selected item of Attention is about.
pub(crate) fn run_at_home(model: &Model) -> Option<String> {
    match model.home.list {
        HomeList::Runs => selected_run(model),
        HomeList::Attention => model.home.selected_attention()?.run.clone(),
        HomeList::Scenarios => None,
    }
}

/// Requests the details of the selected run, if there is room to show them. While the robot moves, the disk and the
/// processor are left to the mission: a run that is being read is given up.
pub(super) fn glimpse(model: &mut Model) -> Option<Effect> {
    if model.live.may_move() {
        return model.home.glimpses.give_up().then_some(Effect::StopGlimpsing);
    }
    if model.ui.arrangement() != Arrangement::Wide {
        return None;
    }
    let run = match model.ui.screen {
        Screen::Home if model.home.list == HomeList::Runs => model.home.selected_run(),
        Screen::Home if model.home.list == HomeList::Scenarios && model.ui.is_large() => {
            model.home.selected_scenario().and_then(|entry| model.home.last_end(&entry.name))
        }
        Screen::Review => model.review.run(&model.home),
        _ => None,
    }?;
    let key = (run.name.clone(), run.end.clone());
    model.home.glimpses.ask(key.clone()).then_some(Effect::Glimpse(key))
}

/// The open run, if it is a replay or has ended.
pub(crate) fn open_run(model: &Model) -> Option<String> {
    model.live.replay.as_ref().map(|replay| replay.name.clone()).or_else(|| result_name(model))
}

fn selected_run(model: &Model) -> Option<String> {
    model.home.selected_run().map(|run| run.name.clone())
}

fn result_name(model: &Model) -> Option<String> {
    model.live.result.as_ref()?.name.clone()
}

/// Starts work on the past run that is selected on the screen.
pub(crate) fn begin(model: &mut Model, id: ActionId) -> Vec<Effect> {
    match named_run(model) {
        Some(run) => begin_on(model, id, run),
        None => refuse(model, "no run is selected".into()),
    }
}

/// Starts work on a past run.
pub(super) fn begin_on(model: &mut Model, id: ActionId, run: String) -> Vec<Effect> {
    let (job, news) = match id {
        ActionId::Rescan => {
            let runs = model.live.with_earlier(&run).unwrap_or_else(|| vec![run]);
            return open(model, Source::Rescan(runs), None);
        }
        ActionId::Replay => return replay::open(model, run),
        ActionId::CompareRun => return replay::compare(model, run),
        ActionId::Verify => (Job::Verify(run), "verifying"),
        ActionId::Report => (Job::Report(run), "writing the report of"),
        _ => (view(model, run), "opening the recording of"),
    };
    let run = job.run().to_owned();
    model.say(Severity::Info, format!("{news} {run}..."));
    vec![Effect::Do(job)]
}

/// The job that opens the recording of a run; if the run is being replayed, the recording opens at the current
/// moment.
fn view(model: &Model, run: String) -> Job {
    match &model.live.replay {
        Some(replay) if replay.name == run => {
            Job::ViewAt(run, format!("T+{}", clock(model.live.run.clock.t_s)))
        }
        _ => Job::View(run),
    }
}

/// Reports that work on a past run has finished.
pub(super) fn done(model: &mut Model, job: &Job, result: Result<String, String>) -> Vec<Effect> {
    let (severity, text) = match result {
        Ok(text) if matches!(job, Job::Verify(_)) => {
            (Severity::Info, format!("{} {text}", briefly_named(model, job.run())))
        }
        Ok(text) => (Severity::Info, format!("{}: {text}", job.run())),
        Err(why) => (Severity::Warn, format!("{} {} failed: {why}", job.word(), job.run())),
    };
    model.live.run.log.add(model.live.run.clock.t_s, severity, "console", text.clone());
    model.say(severity, text);
    vec![Effect::Look]
}

/// A past run in a few words: its scenario and when it began, UTC; the name of its folder if it is not in the list.
fn briefly_named(model: &Model, run: &str) -> String {
    let listed = model.home.found.iter().flat_map(|found| &found.runs).find(|past| past.name == run);
    let named = listed.filter(|past| !past.scenario.is_empty() && !past.began.is_empty());
    named.map_or_else(|| run.to_owned(), |past| format!("{} {}", past.scenario, past.began))
}

impl Job {
    /// The name of the run that the job works on.
    pub fn run(&self) -> &str {
        match self {
            Self::Verify(run) | Self::Report(run) | Self::View(run) | Self::ViewAt(run, _) => run,
        }
    }

    fn word(&self) -> &'static str {
        match self {
            Self::Verify(_) => "verifying",
            Self::Report(_) => "writing the report of",
            Self::View(_) | Self::ViewAt(..) => "opening the recording of",
        }
    }
}
