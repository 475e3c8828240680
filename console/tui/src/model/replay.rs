//! A replay of a past run: the loaded part, the cursor, people's notes, and a second run for comparison.

mod align;
mod difference;
mod mark;

pub use align::{Align, Track};
pub use difference::{Scans, Shares};
pub use mark::{Mark, MarkKind, Marker};

use super::Run;
use account::{Notes, Summary};
use serde::{Deserialize, Serialize};

/// Times closer together than this are treated as equal, seconds.
const SAME_S: f64 = 1e-6;

/// One of the two compared runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// The run being replayed.
    A,
    /// The run with which it is compared.
    B,
}

/// The loaded part of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Reel {
    /// Mission time up to which the run is loaded, seconds.
    pub until_s: f64,
    /// The share of the journal that has been read.
    pub share: f64,
    /// Whether the whole journal has been read.
    pub is_whole: bool,
    /// Why the run stops early, as a sentence.
    pub problem: Option<String>,
    /// The moments to which the operator can jump, ascending by time.
    pub marks: Vec<Mark>,
}

impl Reel {
    /// Adds the part that has been loaded since the last report.
    pub fn grow(&mut self, news: Self) {
        let marks = std::mem::take(&mut self.marks);
        *self = news;
        self.marks.splice(0..0, marks);
    }
}

/// The run with which the replay is compared.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Other {
    /// The name of the run's folder.
    pub name: String,
    /// The loaded part of the run.
    pub reel: Reel,
    /// The run, folded up to the moment that corresponds to the cursor.
    pub run: Run,
    /// The run's report, once it has been read.
    pub summary: Option<Box<Summary>>,
}

/// A replay of a past run. It has no engine, so it takes no orders.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Replay {
    /// The name of the run's folder.
    pub name: String,
    /// The loaded part of the run.
    pub reel: Reel,
    /// Whether the replay is playing.
    pub is_playing: bool,
    /// Bookmarks and remarks.
    pub notes: Notes,
    /// Why the notes cannot be read, as a sentence.
    pub unreadable: Option<String>,
    /// The run for comparison.
    pub other: Option<Other>,
    /// How moments in the two runs are matched.
    pub align: Align,
    /// Whether the map shows the floor that only one of the runs scanned.
    pub shows_difference: bool,
}

/// Where a jump goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Jump {
    /// To the previous tick.
    TickBack,
    /// To the next tick.
    Tick,
    /// To the previous event.
    EventBack,
    /// To the next event.
    Event,
    /// To the previous alarm.
    AlarmBack,
    /// To the next alarm.
    Alarm,
    /// To the previous bookmark.
    BookmarkBack,
    /// To the next bookmark.
    Bookmark,
    /// One minute back.
    MinuteBack,
    /// One minute forward.
    Minute,
    /// To the beginning.
    Start,
    /// To the end.
    End,
}

impl Replay {
    /// Creates a replay of a run, with nothing loaded yet.
    pub fn of(name: String) -> Self {
        Self { name, ..Self::default() }
    }

    /// The times of the bookmarks, without those that cannot be read.
    pub fn bookmarks(&self) -> impl DoubleEndedIterator<Item = f64> + '_ {
        self.notes.bookmarks.iter().map(|bookmark| bookmark.t_s)
    }

    /// The mission time to which a jump from `from_s` goes, seconds; `None` if there is nothing to jump to.
    pub fn target_s(&self, jump: Jump, from_s: f64, tick_s: f64) -> Option<f64> {
        let marks = || self.reel.marks.iter();
        let times = |kinds: fn(&Mark) -> bool| marks().filter(move |mark| kinds(mark)).map(|mark| mark.t_s);
        let any = |_: &Mark| true;
        let alarm = |mark: &Mark| mark.kind == MarkKind::Alarm;
        let after = move |t_s: &f64| *t_s > from_s + SAME_S;
        let before = move |t_s: &f64| *t_s < from_s - SAME_S;
        let by = |way_s: f64| Some((from_s + way_s).clamp(0.0, self.reel.until_s));
        let target_s = match jump {
            Jump::Tick => by(tick_s),
            Jump::TickBack => by(-tick_s),
            Jump::Minute => by(60.0),
            Jump::MinuteBack => by(-60.0),
            Jump::Start => Some(0.0),
            Jump::End => Some(self.reel.until_s),
            Jump::Event => times(any).find(after),
            Jump::EventBack => times(any).rev().find(before),
            Jump::Alarm => times(alarm).find(after),
            Jump::AlarmBack => times(alarm).rev().find(before),
            Jump::Bookmark => self.bookmarks().find(after),
            Jump::BookmarkBack => self.bookmarks().rev().find(before),
        };
        target_s.filter(|t_s| (t_s - from_s).abs() > SAME_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::Severity;

    fn replay() -> Replay {
        let mark = |t_s, kind| Mark { t_s, severity: Severity::Info, kind };
        let marks = vec![mark(1.0, MarkKind::Event), mark(2.0, MarkKind::Alarm), mark(5.0, MarkKind::Hold)];
        let mut notes = Notes::default();
        notes.mark(4.0, "here").expect("room");
        let reel = Reel { until_s: 60.0, marks, ..Reel::default() };
        Replay { reel, notes, ..Replay::of("run".into()) }
    }

    #[test]
    fn jumps_lead_to_what_lies_before_and_behind_and_stay_within_the_run() {
        let replay = replay();
        let to = |jump, from_s| replay.target_s(jump, from_s, 0.1);
        assert_eq!((to(Jump::Event, 1.0), to(Jump::EventBack, 1.0)), (Some(2.0), None));
        assert_eq!((to(Jump::Alarm, 0.0), to(Jump::AlarmBack, 9.0)), (Some(2.0), Some(2.0)));
        assert_eq!((to(Jump::Bookmark, 1.0), to(Jump::BookmarkBack, 4.0)), (Some(4.0), None));
        assert_eq!((to(Jump::Minute, 30.0), to(Jump::MinuteBack, 30.0)), (Some(60.0), Some(0.0)));
        assert_eq!((to(Jump::Start, 0.0), to(Jump::End, 1.0)), (None, Some(60.0)));
        assert!(to(Jump::TickBack, 1.0).is_some_and(|t_s| (t_s - 0.9).abs() < 1e-9));
    }

    #[test]
    fn marks_that_are_loaded_later_come_after_the_others() {
        let mut reel = replay().reel;
        let late = Mark { t_s: 9.0, severity: Severity::Warn, kind: MarkKind::Alarm };
        reel.grow(Reel { until_s: 70.0, is_whole: true, marks: vec![late], ..Reel::default() });
        assert_eq!((reel.marks.len(), reel.marks.last(), reel.until_s), (4, Some(&late), 70.0));
    }
}
