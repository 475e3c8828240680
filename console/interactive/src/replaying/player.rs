//! The thread that plays back a run.

use super::{
    deck::{Deck, Moved},
    reel::Reel,
};
use crate::{inbox::RunOutbox, promise};
use anyhow::Context;
use recording::JournalError;
use runs::{Past, Standing, find, read_notes, standing, write_notes};
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        mpsc::{self, Receiver, RecvTimeoutError, Sender},
    },
    thread,
    time::{Duration, Instant},
};
use tui::{
    ReplayMsg, RunMsg, Speed, Transport,
    model::replay::{Align, Side},
};

/// The interval at which a playing run advances.
const FRAME: Duration = Duration::from_millis(33);
/// If more messages than this are waiting for the screen, playback pauses.
const MOST_BACKLOG: usize = 8;
/// The longest delay that is made up after a late frame.
const MOST_LATE: Duration = Duration::from_millis(250);
/// The factor used for the speed `max`.
const FASTEST: f64 = 1024.0;

enum Request {
    Transport(Transport),
    Speed(Speed),
    /// More of the run is loaded.
    Loaded,
    /// The replay was closed.
    End,
}

impl Drop for Player {
    fn drop(&mut self) {
        let _ = self.0.send(Request::End);
    }
}

/// A handle to a replay; dropping it ends the replay.
pub(in super::super) struct Player(Sender<Request>);

impl Player {
    /// Starts to play back a run, paused at its first moment.
    ///
    /// # Errors
    /// The thread cannot be started.
    pub(in super::super) fn begin(run: String, logs: &Path, screen: RunOutbox) -> anyhow::Result<Self> {
        let (requests, asked) = mpsc::channel();
        let wake = requests.clone();
        let logs = logs.to_owned();
        let began = thread::Builder::new().name("replay".into()).spawn(move || {
            match Playing::open(&run, logs, screen.clone(), wake) {
                Ok(playing) => playing.play(&asked),
                Err(error) => drop(send(&screen, ReplayMsg::Failed(Side::A, format!("{error:#}")))),
            }
        });
        began.map(|_| Self(requests)).context("starting the replay thread")
    }

    /// Sends a request to the replay.
    pub(in super::super) fn transport(&self, transport: Transport) {
        let _ = self.0.send(Request::Transport(transport));
    }

    /// Changes the speed.
    pub(in super::super) fn speed(&self, speed: Speed) {
        let _ = self.0.send(Request::Speed(speed));
    }
}

fn send(screen: &RunOutbox, msg: ReplayMsg) -> bool {
    screen.send(RunMsg::Replay(msg))
}

struct Playing {
    folder: PathBuf,
    logs: PathBuf,
    screen: RunOutbox,
    wake: Sender<Request>,
    deck: Deck,
    other: Option<Deck>,
    align: Align,
    speed: f64,
    /// When the run last advanced; `None` while paused.
    moved: Option<Instant>,
    /// The mission time shown, in seconds.
    t_s: f64,
    /// Whether the requested moment has not been loaded yet.
    waits: bool,
}

impl Playing {
    fn open(run: &str, logs: PathBuf, screen: RunOutbox, wake: Sender<Request>) -> anyhow::Result<Self> {
        let folder = find(run.as_ref(), &logs)?;
        send(&screen, ReplayMsg::Noted(read_notes(&folder)));
        let deck = Deck::new(load(&folder, Side::A, &screen, &wake)?);
        Ok(Self {
            folder,
            logs,
            screen,
            wake,
            deck,
            other: None,
            align: Align::default(),
            speed: 1.0,
            moved: None,
            t_s: 0.0,
            waits: true,
        })
    }

    fn play(mut self, asked: &Receiver<Request>) {
        loop {
            let request = match self.moved {
                Some(moved) => asked.recv_timeout((moved + FRAME).saturating_duration_since(Instant::now())),
                None => asked.recv().map_err(|_| RecvTimeoutError::Disconnected),
            };
            let done = match request {
                Ok(Request::End) | Err(RecvTimeoutError::Disconnected) => return,
                Ok(request) => self.obey(request),
                Err(RecvTimeoutError::Timeout) => self.go_on(),
            };
            if let Err(error) = done {
                self.moved = None;
                send(&self.screen, ReplayMsg::Stopped);
                send(&self.screen, ReplayMsg::Failed(Side::A, error.to_string()));
            }
        }
    }

    fn obey(&mut self, request: Request) -> Result<(), JournalError> {
        match request {
            Request::Speed(Speed::Times(factor)) => self.speed = factor,
            Request::Speed(Speed::Max) => self.speed = FASTEST,
            Request::Transport(Transport::Play(plays)) => self.moved = plays.then(Instant::now),
            Request::Transport(Transport::Seek(t_s)) => {
                self.t_s = t_s;
                return self.show();
            }
            Request::Transport(Transport::Align(align)) => {
                self.align = align;
                return self.show_other();
            }
            Request::Transport(Transport::Compare(run)) => {
                self.other = None;
                if let Some(run) = run {
                    self.compare(&run);
                }
            }
            Request::Transport(Transport::Keep(notes)) => {
                if let Err(why) = write_notes(&self.folder, &notes) {
                    send(&self.screen, ReplayMsg::Noted(Err(why)));
                }
            }
            Request::Loaded if self.waits => return self.show(),
            // The compared run may have been loaded up to the moment.
            Request::Loaded | Request::End => return self.show_other(),
        }
        Ok(())
    }

    fn compare(&mut self, run: &str) {
        let found = find(run.as_ref(), &self.logs).map_err(anyhow::Error::from);
        match found.and_then(|folder| load(&folder, Side::B, &self.screen, &self.wake)) {
            Ok(reel) => self.other = Some(Deck::new(reel)),
            Err(error) => drop(send(&self.screen, ReplayMsg::Failed(Side::B, format!("{error:#}")))),
        }
    }

    /// Advances by the time that has passed since the last advance.
    fn go_on(&mut self) -> Result<(), JournalError> {
        let now = Instant::now();
        let Some(before) = self.moved.replace(now) else { return Ok(()) };
        if self.screen.backlog() > MOST_BACKLOG {
            return Ok(());
        }
        let passed = (now - before).min(MOST_LATE);
        let (until_s, is_whole) = {
            let content = self.deck.reel.content();
            (content.until_s, content.is_whole)
        };
        self.t_s = (self.t_s + passed.as_secs_f64() * self.speed).min(until_s);
        self.show()?;
        if is_whole && self.t_s >= until_s {
            self.moved = None;
            send(&self.screen, ReplayMsg::Stopped);
        }
        Ok(())
    }

    /// Shows the run, and the compared run, at the moment.
    fn show(&mut self) -> Result<(), JournalError> {
        let moved = self.deck.go_to(self.t_s)?;
        self.waits = moved.is_none();
        self.report(Side::A, moved);
        self.show_other()
    }

    fn show_other(&mut self) -> Result<(), JournalError> {
        let Some(other) = &mut self.other else { return Ok(()) };
        let t_s = {
            let (own, its) = (self.deck.reel.content(), other.reel.content());
            own.track.moment_of(&its.track, self.align, self.t_s)
        };
        let moved = other.go_to(t_s.max(0.0))?;
        self.report(Side::B, moved);
        Ok(())
    }

    fn report(&self, side: Side, moved: Option<Moved>) {
        match moved {
            None => {}
            Some(Moved::On(events)) if events.is_empty() => {}
            Some(Moved::On(events)) => drop(send(&self.screen, ReplayMsg::Moved(side, events))),
            Some(Moved::To(run)) => drop(send(&self.screen, ReplayMsg::At(side, run))),
        }
    }
}

/// Reads a run and its report, each on a separate thread.
fn load(folder: &Path, side: Side, screen: &RunOutbox, wake: &Sender<Request>) -> anyhow::Result<Arc<Reel>> {
    let (own, wake) = (screen.clone(), wake.clone());
    let reel = Reel::begin(folder, move |news| {
        send(&own, ReplayMsg::Loaded(side, news)) && wake.send(Request::Loaded).is_ok()
    })?;
    let (own, folder) = (screen.clone(), folder.to_owned());
    let began = thread::Builder::new().name("replay report".into()).spawn(move || {
        if side == Side::A {
            promise::read(&folder, &own);
        }
        // Without a trustworthy report, only the journal can be shown.
        let summary = match standing(&folder) {
            Standing::Ended(summary) | Standing::NotRecorded(summary, _) => summary,
            Standing::Running => return,
            Standing::JournalOnly { .. } => match Past::read(&folder).map_err(anyhow::Error::from) {
                Ok(past) => match review::summary(&past) {
                    Ok(summary) => Box::new(summary),
                    Err(_) => return,
                },
                // The loader reports the problem in the journal.
                Err(_) => return,
            },
        };
        send(&own, ReplayMsg::Reported(side, summary, format!("run kept in {}", folder.display())));
    });
    began.map(|_| reel).context("starting the thread that reads the report")
}
