//! A journal, read once from beginning to end, with copies of the run for seeking.

use anyhow::Context;
use mission::Event;
use recording::{
    JournalPlace, JournalReader,
    ahead::{self, Giver, Taker},
    journal_of,
};
use std::{
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError, Weak},
    thread,
    time::{Duration, Instant},
};
use tui::model::{
    Run,
    replay::{Mark, MarkKind, Marker, Track},
};

/// The largest number of copies of a run.
pub(super) const MOST_FRAMES: usize = 128;
/// The smallest spacing of copies, in bytes of lines. Reading this many bytes takes a few milliseconds.
const LEAST_SPACING: u64 = 1 << 18;
/// The largest number of marks of a run.
const MOST_MARKS: usize = 100_000;
/// The interval at which the screen receives the progress of reading.
const NEWS: Duration = Duration::from_millis(100);
/// The largest number of events read in one batch. A batch also ends after [`BATCH_BYTES`] of lines.
const BATCH: usize = 512;
const BATCH_BYTES: u64 = 1 << 18;
/// The number of bytes of lines that are read ahead.
const AHEAD_BYTES: u64 = 1 << 20;

/// The state of the run at a moment, folded from its events.
pub(super) struct Frame {
    /// The mission time of the last tick included, in seconds.
    pub t_s: f64,
    /// Where the next tick begins.
    pub place: JournalPlace,
    pub run: Arc<Run>,
}

/// The part of a journal that has been read.
#[derive(Default)]
pub(super) struct Content {
    /// Copies of the run, ascending by time.
    pub frames: Vec<Frame>,
    pub track: Track,
    pub until_s: f64,
    /// The bytes of the journal that were read and understood.
    pub bytes: u64,
    pub is_whole: bool,
}

/// A journal that a separate thread reads until this handle is dropped.
pub(super) struct Reel {
    pub journal: PathBuf,
    content: Mutex<Content>,
}

impl Reel {
    /// Starts to read the journal in a folder. The reading thread calls `report` with its progress.
    ///
    /// # Errors
    /// There is no journal, or a thread cannot be started.
    pub(super) fn begin(
        folder: &Path,
        report: impl Fn(tui::model::replay::Reel) -> bool + Send + 'static,
    ) -> anyhow::Result<Arc<Self>> {
        Self::begin_spaced(folder, LEAST_SPACING, report)
    }

    /// [`Reel::begin`] with an initial spacing of copies, in bytes of lines.
    pub(super) fn begin_spaced(
        folder: &Path,
        spacing: u64,
        report: impl Fn(tui::model::replay::Reel) -> bool + Send + 'static,
    ) -> anyhow::Result<Arc<Self>> {
        let journal = journal_of(folder);
        let reader = JournalReader::open(&journal)?;
        let place = reader.place();
        let bytes = std::fs::metadata(&journal).map_or(0, |file| file.len());
        let reel = Arc::new(Self { journal, content: Mutex::default() });
        let loading = Loading {
            reel: Arc::downgrade(&reel),
            place,
            bytes,
            spacing,
            run: Run::default(),
            marker: Marker::default(),
            marks: Vec::new(),
            n_marks: 0,
            kept_at: None,
        };
        let (giver, batches) = ahead::queue(AHEAD_BYTES);
        thread::Builder::new()
            .name("replay reader".into())
            .spawn(move || read_ahead(reader, &giver))
            .and_then(|_| {
                let name = "replay loader".to_owned();
                thread::Builder::new().name(name).spawn(move || loading.take_all(batches, &report))
            })
            .context("starting the threads that read the journal")?;
        Ok(reel)
    }

    pub(super) fn content(&self) -> MutexGuard<'_, Content> {
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Events of a journal, each with its starting position.
struct Batch {
    events: Vec<(JournalPlace, Event)>,
    /// Where the next event begins.
    next: JournalPlace,
    end: Option<End>,
}

/// The end of a journal, and the problem if the journal could not be read completely.
struct End(Option<String>);

/// Reads a journal until its end, or until the receiver is dropped.
fn read_ahead(mut reader: JournalReader, batches: &Giver<Batch>) {
    loop {
        let mut batch = Batch { events: Vec::with_capacity(BATCH), next: reader.place(), end: None };
        let begin = reader.bytes();
        let is_full = |batch: &Batch, reader: &JournalReader| {
            batch.events.len() == BATCH || reader.bytes() >= begin + BATCH_BYTES
        };
        while batch.end.is_none() && !is_full(&batch, &reader) {
            match reader.next() {
                Some(Ok(event)) => {
                    batch.events.push((batch.next, event));
                    batch.next = reader.place();
                }
                Some(Err(error)) => batch.end = Some(End(Some(error.to_string()))),
                None => batch.end = Some(End(reader.truncated().map(str::to_owned))),
            }
        }
        let is_last = batch.end.is_some();
        if !batches.give(batch, reader.bytes() - begin) || is_last {
            return;
        }
    }
}

struct Loading {
    reel: Weak<Reel>,
    /// Where the next event begins.
    place: JournalPlace,
    /// The size of the file in bytes.
    bytes: u64,
    /// The spacing of copies in bytes of lines; doubled whenever there are too many copies.
    spacing: u64,
    run: Run,
    marker: Marker,
    /// The marks that have not been sent to the screen.
    marks: Vec<Mark>,
    n_marks: usize,
    /// Where the last copy was made.
    kept_at: Option<u64>,
}

impl Loading {
    fn take_all(mut self, batches: Taker<Batch>, report: &impl Fn(tui::model::replay::Reel) -> bool) {
        let mut reported: Option<Instant> = None;
        for batch in batches {
            let Some(reel) = self.reel.upgrade() else { return };
            for (place, event) in batch.events {
                self.place = place;
                self.take(&reel, &event);
            }
            self.place = batch.next;
            if let Some(End(problem)) = batch.end {
                self.tell(report, true, problem);
                return;
            }
            if reported.is_none_or(|reported| reported.elapsed() >= NEWS) {
                reported = Some(Instant::now());
                if !self.tell(report, false, None) {
                    return;
                }
            }
        }
    }

    fn take(&mut self, reel: &Reel, event: &Event) {
        let begins = self.run.about.is_some() && event.tick != self.run.clock.tick;
        if begins {
            self.end_tick(reel);
        }
        let Some(mark) = self.marker.fold(&mut self.run, event) else { return };
        // Limit the event marks, so that a planner that logs a lot leaves room for more important marks.
        let most = if mark.kind == MarkKind::Event { MOST_MARKS / 2 } else { MOST_MARKS };
        if self.n_marks < most {
            self.n_marks += 1;
            self.marks.push(mark);
        }
    }

    /// Handles the end of a tick.
    fn end_tick(&mut self, reel: &Reel) {
        let (t_s, place) = (self.run.clock.t_s, self.place);
        let mut content = reel.content();
        content.track.add(&self.run);
        (content.until_s, content.bytes) = (t_s, place.bytes);
        if self.kept_at.is_none_or(|at| place.bytes - at >= self.spacing) {
            self.kept_at = Some(place.bytes);
            if content.frames.len() >= MOST_FRAMES {
                let mut index = 0..;
                content.frames.retain(|_| index.next().is_some_and(|index| index % 2 == 0));
                self.spacing *= 2;
            }
            content.frames.push(Frame { t_s, place, run: Arc::new(self.run.clone()) });
        }
    }

    /// Reports the progress; returns `false` if the receiver is gone.
    fn tell(
        &mut self,
        report: &impl Fn(tui::model::replay::Reel) -> bool,
        is_whole: bool,
        problem: Option<String>,
    ) -> bool {
        let Some(reel) = self.reel.upgrade() else { return false };
        let place = self.place;
        let mut content = reel.content();
        if is_whole {
            // The end of the journal also ends the last tick.
            (content.until_s, content.bytes) = (self.run.clock.t_s, place.bytes);
            content.is_whole = true;
            content.track.add(&self.run);
            if content.frames.is_empty() && self.run.about.is_some() {
                let run = Arc::new(self.run.clone());
                content.frames.push(Frame { t_s: self.run.clock.t_s, place, run });
            }
        }
        let until_s = content.until_s;
        drop(content);
        let share = match self.bytes {
            bytes if bytes > 0 && !is_whole => place.file_bytes() as f64 / bytes as f64,
            _ => 1.0,
        };
        let marks = std::mem::take(&mut self.marks);
        report(tui::model::replay::Reel { until_s, share: share.min(1.0), is_whole, problem, marks })
    }
}
