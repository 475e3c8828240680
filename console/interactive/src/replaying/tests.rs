//! A seek to a moment shows the same state as playback up to that moment.

#![allow(clippy::unwrap_used, reason = "tests")]

use super::deck::{Deck, Moved};
use super::reel::{MOST_FRAMES, Reel};
use flight::{Flight, scenarios};
use mission::{Event, EventKind, Order, Severity};
use recording::PLAIN_JOURNAL_FILE;
use scenario::Settings;
use std::{path::Path, sync::mpsc::channel};
use tui::model::{Run, replay::MarkKind};
use world::{CellRun, StationId};

const TICKS: u64 = 9000;
const TICK_S: f64 = 0.1;

fn events() -> Vec<Event> {
    let opened = Flight::prepare(&scenarios::demo(&Settings::default()).unwrap(), true).opened();
    let event = |tick: u64, kind| Event { tick, t_s: tick as f64 * TICK_S, kind };
    let of_tick = |tick: u64| {
        let runs = vec![CellRun(tick as u32 * 7, 3), CellRun(tick as u32 * 5, 2)];
        let station = StationId(tick as u32 / 100 % 4);
        let noted = tick.is_multiple_of(100).then_some(EventKind::StationRestored { station });
        let held = tick.is_multiple_of(1000).then_some(EventKind::Ordered { order: Order::Hold });
        let scalars = vec![("share".to_owned(), tick as f64, "%".to_owned()); 4];
        [EventKind::Covered { runs }, EventKind::Scalars { scalars }]
            .into_iter()
            .chain(noted)
            .chain(held)
            .map(move |kind| event(tick, kind))
    };
    std::iter::once(opened).chain((1..TICKS).flat_map(of_tick)).collect()
}

fn written(folder: &Path, events: &[Event]) {
    let lines: Vec<String> =
        events.iter().map(|event| serde_json::to_string(event).unwrap() + "\n").collect();
    std::fs::write(folder.join(PLAIN_JOURNAL_FILE), lines.concat()).unwrap();
}

/// The run up to a moment, folded from the beginning.
fn folded(events: &[Event], t_s: f64) -> Run {
    let mut run = Run::default();
    for event in events.iter().take_while(|event| event.t_s <= t_s + 1e-6) {
        run.fold(event);
    }
    run
}

#[test]
fn every_moment_is_the_one_that_playing_leads_to() {
    every_moment_is_reached(1 << 18);
}

#[test]
fn with_too_many_copies_every_other_one_goes() {
    every_moment_is_reached(1 << 10);
}

fn every_moment_is_reached(spacing: u64) {
    let (folder, events) = (tempfile::tempdir().unwrap(), events());
    written(folder.path(), &events);
    let (send, heard) = channel();
    let reel = Reel::begin_spaced(folder.path(), spacing, move |news| send.send(news).is_ok()).unwrap();
    let news: Vec<_> = heard.iter().collect();
    let last = news.last().unwrap();
    assert!(last.is_whole && last.problem.is_none() && last.until_s > 899.0, "{last:?}");
    let marks: Vec<_> = news.iter().flat_map(|news| &news.marks).collect();
    assert!(marks.iter().any(|mark| mark.kind == MarkKind::Event && mark.severity == Severity::Info));
    let frames = reel.content().frames.len();
    assert!((3..=MOST_FRAMES).contains(&frames), "{frames} copies");

    let mut deck = Deck::new(reel);
    let mut run = Run::default();
    for t_s in [0.0, 0.1, 0.2, 450.0, 449.9, 450.3, 899.9, 1.0, 5000.0, 300.0, 480.0, 0.0] {
        match deck.go_to(t_s).unwrap().unwrap() {
            Moved::On(events) => events.iter().for_each(|event| drop(run.fold(event))),
            Moved::To(other) => run = *other,
        }
        assert!(run == folded(&events, t_s), "T+{t_s}");
    }
}

#[test]
fn a_damaged_journal_is_read_up_to_its_last_sound_event() {
    let (folder, events) = (tempfile::tempdir().unwrap(), events());
    written(folder.path(), &events[..200]);
    let journal = folder.path().join(PLAIN_JOURNAL_FILE);
    let text = std::fs::read_to_string(&journal).unwrap() + "{\"tick\": nonsense}\n";
    std::fs::write(&journal, text).unwrap();
    let (send, heard) = channel();
    let reel = Reel::begin(folder.path(), move |news| send.send(news).is_ok()).unwrap();
    let last = heard.iter().last().unwrap();
    assert!(last.is_whole && last.problem.as_ref().is_some_and(|why| why.contains("line 201")), "{last:?}");
    let moved = Deck::new(reel).go_to(9e9).unwrap().unwrap();
    assert!(matches!(moved, Moved::To(run) if *run == folded(&events[..200], 9e9)));
}
