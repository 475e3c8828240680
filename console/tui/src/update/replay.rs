//! Replays: keys and messages.

use super::go;
use super::message::{Effect, ReplayMsg, Transport};
use super::offer::{self, demand, nothing_under_way, refuse};
use crate::model::log::clock;
use crate::model::replay::{Jump, Other, Side};
use crate::model::{LineEdit, Model, Overlay, Replay, RunId, RunResult, Screen};
use account::Notes;
use mission::{Event, Severity};

/// Checks that a run that can be replayed is selected.
pub(crate) fn can_open(model: &Model) -> Result<(), String> {
    nothing_under_way(model)?;
    offer::run(model)
}

fn replay(model: &Model) -> Result<&Replay, String> {
    let why = match model.ui.screen {
        Screen::Review => "no run is being replayed; <replay>: play one first",
        _ => "no run is being replayed; <review>: choose one",
    };
    model.live.replay.as_deref().ok_or_else(|| why.into())
}

/// Checks that enough of a replay is loaded to show it.
pub(crate) fn is_loaded(model: &Model) -> Result<(), String> {
    replay(model)?;
    demand(model.live.run.about.is_some(), "the run is still loading")
}

/// Checks that a different run is selected for comparison.
pub(crate) fn can_compare(model: &Model) -> Result<(), String> {
    let played = &replay(model)?.name;
    let is_other = go::named_run(model).is_some_and(|run| run != *played);
    demand(is_other, "select a run other than the one being replayed")
}

/// Checks that two runs are being compared.
pub(crate) fn has_second(model: &Model) -> Result<(), String> {
    let is_second = replay(model)?.other.is_some();
    demand(is_second, "no second run; <compare-run> on screen 6 (Review) selects one")
}

/// Checks that notes can be written about the run.
pub(crate) fn can_note(model: &Model) -> Result<(), String> {
    replay(model)?.unreadable.clone().map_or(Ok(()), Err)
}

/// Checks that there is a bookmark to remove.
pub(crate) fn can_unmark(model: &Model) -> Result<(), String> {
    can_note(model)?;
    let is_marked = replay(model)?.notes.bookmark(model.live.run.clock.t_s).is_some();
    demand(is_marked, "no bookmark here; <next-bookmark> <previous-bookmark>: go to one")
}

/// Replaces the open run with a replay of a past run.
pub(super) fn open(model: &mut Model, run: String) -> Vec<Effect> {
    if let Err(why) = nothing_under_way(model) {
        return refuse(model, why);
    }
    let id = RunId(model.live.id.0 + 1);
    model.replay(id, run.clone());
    vec![Effect::Replay { id, run }]
}

/// Shows or hides the floor that only one of the two runs scanned.
pub(crate) fn toggle_difference(model: &mut Model) {
    with(model, |replay| replay.shows_difference = !replay.shows_difference);
}

/// Changes how moments of the two runs are matched.
pub(crate) fn align(model: &mut Model) -> Vec<Effect> {
    let align = with(model, |replay| {
        replay.align = replay.align.next();
        replay.align
    });
    let Some(align) = align else { return Vec::new() };
    model.say(Severity::Info, format!("aligned by {}", align.word()));
    vec![Effect::Transport(Transport::Align(align))]
}

/// Pauses and opens the input line for a bookmark's text.
pub(crate) fn open_bookmark(model: &mut Model) -> Vec<Effect> {
    let t_s = model.live.run.clock.t_s;
    let notes = model.live.replay.as_ref().map(|replay| &replay.notes);
    let text = notes.and_then(|notes| notes.bookmark(t_s)).map(|mark| mark.text.clone());
    model.ui.overlay = Overlay::Bookmark(text.unwrap_or_default().as_str().into());
    pause(model)
}

/// Removes the bookmark at this moment.
pub(crate) fn unmark(model: &mut Model) -> Vec<Effect> {
    let t_s = model.live.run.clock.t_s;
    keep(model, "bookmark removed", |notes| {
        notes.unmark(t_s);
        Ok(())
    })
}

fn with<T>(model: &mut Model, change: impl FnOnce(&mut Replay) -> T) -> Option<T> {
    model.live.replay.as_deref_mut().map(change)
}

/// Plays or pauses; at the end, plays from the beginning.
pub(crate) fn toggle(model: &mut Model) -> Vec<Effect> {
    let t_s = model.live.run.clock.t_s;
    let Some(replay) = &mut model.live.replay else { return Vec::new() };
    replay.is_playing = !replay.is_playing;
    let at_end = replay.reel.is_whole && t_s >= replay.reel.until_s;
    let rewind = (replay.is_playing && at_end).then_some(Effect::Transport(Transport::Seek(0.0)));
    let play = Effect::Transport(Transport::Play(replay.is_playing));
    rewind.into_iter().chain([play]).collect()
}

/// Pauses, if the replay is playing.
pub(super) fn pause(model: &mut Model) -> Vec<Effect> {
    let is_playing = model.live.replay.as_ref().is_some_and(|replay| replay.is_playing);
    if is_playing { toggle(model) } else { Vec::new() }
}

/// Jumps to a different moment of the run.
pub(super) fn go_to(model: &mut Model, jump: Jump) -> Vec<Effect> {
    let run = &model.live.run;
    let (from_s, tick_s) = (run.clock.t_s, run.about.as_ref().map_or(0.1, |about| about.mission.tick_s));
    let target_s = model.live.replay.as_ref().and_then(|replay| replay.target_s(jump, from_s, tick_s));
    let Some(t_s) = target_s else {
        return refuse(model, nothing_there(jump).into());
    };
    // An operator who looks for an event wants to see its line.
    let is_search = !matches!(jump, Jump::Minute | Jump::MinuteBack | Jump::Start);
    let paused = if is_search { pause(model) } else { Vec::new() };
    if let Some(text) = model.live.replay.as_ref().and_then(|replay| replay.notes.bookmark(t_s)) {
        let text = format!("bookmark T+{}: {}", clock(t_s), text.text);
        model.say(Severity::Info, text);
    }
    [paused, seek(t_s)].concat()
}

fn nothing_there(jump: Jump) -> &'static str {
    match jump {
        Jump::Event => "no later event",
        Jump::EventBack => "no earlier event",
        Jump::Alarm => "no later alarm",
        Jump::AlarmBack => "no earlier alarm",
        Jump::Bookmark => "no later bookmark",
        Jump::BookmarkBack => "no earlier bookmark",
        Jump::Tick | Jump::Minute | Jump::End => "already at the end of the run",
        Jump::TickBack | Jump::MinuteBack | Jump::Start => "already at the beginning of the run",
    }
}

fn seek(t_s: f64) -> Vec<Effect> {
    vec![Effect::Transport(Transport::Seek(t_s))]
}

/// Seeks to a typed time; for a time after the end, seeks to the end.
pub(super) fn seek_to(model: &mut Model, t_s: f64) -> Vec<Effect> {
    let until_s = model.live.replay.as_ref().map_or(0.0, |replay| replay.reel.until_s);
    if t_s > until_s {
        let (asked, end) = (clock(t_s), clock(until_s));
        model.say(Severity::Info, format!("{asked} is after the last event, {end}; showing the last event"));
    }
    seek(t_s.clamp(0.0, until_s))
}

/// Loads a second run for comparison; choosing the same run again removes it.
pub(super) fn compare(model: &mut Model, run: String) -> Vec<Effect> {
    let is_other = |replay: &Replay| replay.other.as_ref().is_some_and(|other| other.name == run);
    if model.live.replay.as_deref().is_some_and(is_other) {
        with(model, |replay| (replay.other, replay.shows_difference) = (None, false));
        return vec![Effect::Transport(Transport::Compare(None))];
    }
    model.say(Severity::Info, format!("reading {run}..."));
    with(model, |replay| replay.other = Some(Other { name: run.clone(), ..Other::default() }));
    vec![Effect::Transport(Transport::Compare(Some(run)))]
}

/// Sets a bookmark with the typed text.
pub(super) fn take_bookmark(model: &mut Model, line: &LineEdit) -> Vec<Effect> {
    model.ui.overlay = Overlay::None;
    let t_s = model.live.run.clock.t_s;
    bookmark(model, t_s, line.text())
}

/// Sets a bookmark at the given moment.
pub(super) fn bookmark(model: &mut Model, t_s: f64, text: &str) -> Vec<Effect> {
    let said = format!("bookmark set at T+{}", clock(t_s));
    keep(model, &said, |notes| notes.mark(t_s, text))
}

/// Saves a remark about the whole run.
pub(super) fn remark(model: &mut Model, text: &str) -> Vec<Effect> {
    keep(model, "remark saved", |notes| notes.remark(text))
}

fn keep(model: &mut Model, said: &str, change: impl FnOnce(&mut Notes) -> Result<(), String>) -> Vec<Effect> {
    match with(model, |replay| change(&mut replay.notes).map(|()| replay.notes.clone())) {
        None => Vec::new(),
        Some(Err(why)) => refuse(model, why),
        Some(Ok(notes)) => {
            model.say(Severity::Info, said);
            vec![Effect::Transport(Transport::Keep(notes)), Effect::Look]
        }
    }
}

/// Handles a message about the replay.
pub(super) fn hear(model: &mut Model, msg: ReplayMsg) {
    let Some(replay) = &mut model.live.replay else { return };
    match msg {
        ReplayMsg::Loaded(side, news) => {
            let reel = match (side, &mut replay.other) {
                (Side::A, _) => Some(&mut replay.reel),
                (Side::B, other) => other.as_mut().map(|other| &mut other.reel),
            };
            let problem = news.problem.clone();
            if let Some(reel) = reel {
                reel.grow(news);
            }
            if let Some(problem) = problem {
                model.say(Severity::Warn, format!("the replay ends here: {problem}"));
            }
        }
        ReplayMsg::At(Side::A, run) => {
            (model.live.run, model.live.is_opening) = (*run, false);
            model.ui.events.at = None;
        }
        ReplayMsg::At(Side::B, run) => {
            if let Some(other) = &mut replay.other {
                other.run = *run;
            }
        }
        ReplayMsg::Moved(Side::A, events) => fold(&mut model.live.run, &events),
        ReplayMsg::Moved(Side::B, events) => {
            if let Some(other) = &mut replay.other {
                fold(&mut other.run, &events);
            }
        }
        ReplayMsg::Stopped => replay.is_playing = false,
        ReplayMsg::Reported(Side::A, summary, kept) => {
            let name = Some(replay.name.clone());
            model.live.result = Some(RunResult { summary, name, kept, is_kept: true });
        }
        ReplayMsg::Reported(Side::B, summary, _) => {
            if let Some(other) = &mut replay.other {
                other.summary = Some(summary);
            }
        }
        ReplayMsg::Failed(Side::A, why) => {
            (model.live.failure, model.live.is_opening) = (Some(why.clone()), false);
            model.say(Severity::Crit, why);
        }
        ReplayMsg::Failed(Side::B, why) => {
            replay.other = None;
            model.say(Severity::Warn, format!("cannot compare: {why}"));
        }
        ReplayMsg::Noted(Ok(notes)) => (replay.notes, replay.unreadable) = (notes, None),
        ReplayMsg::Noted(Err(why)) => {
            replay.unreadable = Some(why.clone());
            model.say(Severity::Warn, why);
        }
    }
}

/// Folds events into a run. The changes that they would make to a live screen are irrelevant here and are dropped.
fn fold(run: &mut crate::model::Run, events: &[Event]) {
    for event in events {
        run.fold(event);
    }
}

/// Shows the replayed run after it was selected in a list.
pub(super) fn show(model: &mut Model) -> Vec<Effect> {
    go::go(model, Screen::Mission)
}
