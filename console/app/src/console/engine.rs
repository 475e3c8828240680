//! The thread that flies: takes orders, keeps the pace, hands every event to recorder, report and screen.

use crate::{
    cli::Drill,
    flight::{Flight, Pace, PlanNews},
    headless::CLOSE_TIMEOUT,
    run_folder::RunFolder,
    scenario::Scenario,
};
use mission::{Event, Order, Phase};
use planner_host::{PluginDirs, Progress};
use recording::{Options, RunRecorder};
use report::{Fold, Logs, Summary};
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, Receiver, RecvTimeoutError, Sender, SyncSender},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};
use tui::{Msg, Signal, Speed};

/// How often the screen hears how the recorder is doing.
const HEALTH_PERIOD: Duration = Duration::from_millis(500);
/// A tick that is later than this is not made up for.
const MOST_LATE: Duration = Duration::from_millis(50);
/// How long a process that was told to end may take to close the recording.
const HURRY: Duration = Duration::from_millis(900);

/// What the engine is told.
enum Request {
    Order(Order),
    Speed(Speed),
    /// End the run, close everything, stop.
    Close {
        within: Duration,
    },
}

/// The flying thread, seen from outside.
pub struct Engine {
    requests: Sender<Request>,
    thread: JoinHandle<anyhow::Result<Option<Ended>>>,
    /// Set when no plan is wanted any more: the mission is to end.
    stop_planning: Arc<AtomicBool>,
}

/// A run that was flown.
pub struct Ended {
    /// Its report.
    pub summary: Summary,
    /// Its folder.
    pub folder: PathBuf,
}

impl Engine {
    /// Starts the thread; nothing moves and nothing is written before the operator starts the mission.
    pub fn start(
        scenario: &Scenario,
        logs: &Path,
        plugins: &PluginDirs,
        tell: SyncSender<Msg>,
        drill: Option<Drill>,
    ) -> anyhow::Result<Self> {
        let (requests, asked) = mpsc::channel();
        let mut flight = Flight::prepare(scenario, true, plugins, Pace::Live);
        let stop_planning = Arc::new(AtomicBool::new(false));
        flight.stop_planning_on(Arc::clone(&stop_planning));
        let screen = tell.clone();
        flight.tell_plans(Arc::new(move |news| tell_plan(&screen, news)));
        let cockpit = Cockpit {
            scenario: scenario.clone(),
            logs: logs.to_path_buf(),
            flight,
            asked,
            tell,
            speed: super::START_SPEED,
            log: None,
            drill,
        };
        let thread = thread::Builder::new().name("engine".into()).spawn(move || cockpit.fly())?;
        Ok(Self { requests, thread, stop_planning })
    }

    /// Hands an order to the mission; it enters with the next tick.
    pub fn order(&self, order: Order) {
        if order == Order::Abort {
            self.stop_planning.store(true, Ordering::Relaxed);
        }
        // An engine that has ended has told the screen why.
        let _ = self.requests.send(Request::Order(order));
    }

    /// Changes the pace.
    pub fn speed(&self, speed: Speed) {
        let _ = self.requests.send(Request::Speed(speed));
    }

    /// Ends the run, closes its files and waits for that; a process that was told to end by a signal hurries.
    pub fn close(self, signal: Option<Signal>) -> anyhow::Result<Option<Ended>> {
        self.stop_planning.store(true, Ordering::Relaxed);
        let within = if signal.is_some() { HURRY } else { CLOSE_TIMEOUT };
        let _ = self.requests.send(Request::Close { within });
        self.thread
            .join()
            .unwrap_or_else(|panic| Err(anyhow::anyhow!("the engine panicked: {}", words(&*panic))))
    }
}

fn words(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(ToString::to_string);
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without a word".into())
}

/// Everything the thread owns.
struct Cockpit {
    scenario: Scenario,
    logs: PathBuf,
    flight: Flight,
    asked: Receiver<Request>,
    tell: SyncSender<Msg>,
    speed: Speed,
    log: Option<RunLog>,
    drill: Option<Drill>,
}

/// What is written about the run.
struct RunLog {
    folder: RunFolder,
    recorder: Option<RunRecorder>,
    fold: Fold,
    began: Instant,
    health_told: Instant,
    ended: Option<Summary>,
}

impl Cockpit {
    fn fly(mut self) -> anyhow::Result<Option<Ended>> {
        self.tell_events(&[self.flight.opened()]);
        let mut due = Instant::now();
        loop {
            let (orders, close) = self.wait_until(due);
            if !orders.is_empty() || self.is_under_way() {
                due = self.next_due(due);
                self.tick(&orders)?;
            }
            if let Some(within) = close {
                return Ok(self.close(within));
            }
        }
    }

    /// Whether ticks pass by themselves.
    fn is_under_way(&self) -> bool {
        self.log.is_some() && !matches!(self.flight.phase(), Phase::Waiting | Phase::Ended(_))
    }

    /// Waits for the next tick, or, while no ticks pass, for a request; gives the orders that came and whether to
    /// close.
    fn wait_until(&mut self, due: Instant) -> (Vec<Order>, Option<Duration>) {
        let mut orders = Vec::new();
        loop {
            let wait = due.saturating_duration_since(Instant::now());
            let request = if self.is_under_way() {
                self.asked.recv_timeout(wait)
            } else if orders.is_empty() {
                self.asked.recv().map_err(|_| RecvTimeoutError::Disconnected)
            } else {
                return (orders, None);
            };
            match request {
                // A hold does not wait for the tick that is due: the tick comes now.
                Ok(Request::Order(Order::Hold)) => {
                    orders.push(Order::Hold);
                    return (orders, None);
                }
                Ok(Request::Order(order)) => orders.push(order),
                Ok(Request::Speed(speed)) => self.speed = speed,
                Ok(Request::Close { within }) => return (orders, Some(within)),
                Err(RecvTimeoutError::Timeout) => return (orders, None),
                Err(RecvTimeoutError::Disconnected) => return (orders, Some(CLOSE_TIMEOUT)),
            }
        }
    }

    /// When the tick after this one is due; time that was lost is not made up for by rushing.
    fn next_due(&self, due: Instant) -> Instant {
        let now = Instant::now();
        match self.speed {
            Speed::Times(factor) if now.saturating_duration_since(due) < MOST_LATE => {
                due + self.flight.tick_length().div_f64(factor)
            }
            Speed::Times(factor) => now + self.flight.tick_length().div_f64(factor),
            Speed::Max => now,
        }
    }

    fn tick(&mut self, orders: &[Order]) -> anyhow::Result<()> {
        if self.log.is_none() && orders.contains(&Order::Start) {
            self.open_log()?;
        }
        let slow = orders.iter().any(may_take_long);
        if slow {
            self.say(Msg::Busy(Some(("starting".into(), None))));
        }
        let events = self.flight.tick(orders);
        let failing = self.drill == Some(Drill::PanicEngine) && events.iter().any(|event| event.tick > 5);
        assert!(!failing, "drill: the engine fails on purpose");
        if slow {
            self.say(Msg::Busy(None));
        }
        self.keep(&events);
        self.tell_events(&events);
        self.tell_health();
        if matches!(self.flight.phase(), Phase::Ended(_)) {
            self.close_log(CLOSE_TIMEOUT);
        }
        Ok(())
    }

    fn open_log(&mut self) -> anyhow::Result<()> {
        let planner = &self.scenario.mission.planner.id;
        let folder = RunFolder::create(&self.logs, &self.scenario.name, planner, self.scenario.seed)?;
        let recorder = RunRecorder::start(folder.path(), Options::default())?;
        let now = Instant::now();
        self.log = Some(RunLog {
            folder,
            recorder: Some(recorder),
            fold: Fold::new(),
            began: now,
            health_told: now,
            ended: None,
        });
        self.keep(&[self.flight.opened()]);
        Ok(())
    }

    fn keep(&mut self, events: &[Event]) {
        let Some(log) = &mut self.log else { return };
        for event in events {
            log.fold.apply(event);
        }
        if let Some(recorder) = &log.recorder {
            recorder.send(events);
        }
    }

    fn tell_health(&mut self) {
        let Some(log) = &mut self.log else { return };
        let Some(recorder) = &log.recorder else { return };
        if log.health_told.elapsed() < HEALTH_PERIOD {
            return;
        }
        log.health_told = Instant::now();
        let health = super::screen::health(&recorder.health(), None);
        self.say(Msg::Health(health));
    }

    /// Closes journal and recording and writes the report.
    fn close_log(&mut self, within: Duration) {
        let Some(log) = &mut self.log else { return };
        let Some(recorder) = log.recorder.take() else { return };
        let finished = recorder.finish(within);
        let summary = Summary {
            wall_time_s: Some(log.began.elapsed().as_secs_f64()),
            events_sha256: finished.events_sha256,
            planner_calls: Some(self.flight.planner_calls()),
            logs: Some(Logs {
                journal: finished.journal.map(|path| path.display().to_string()),
                recording: finished.recording.map(|path| path.display().to_string()),
                error: finished.error.clone(),
            }),
            ..log.fold.summary()
        };
        let summary = self.scenario.expect.judged(summary);
        let report = log.folder.write_report(&summary);
        log.ended = Some(summary);
        let error = finished.error.or_else(|| report.err().map(|error| format!("{error:#}")));
        self.say(Msg::Health(super::screen::closed(error)));
    }

    fn close(mut self, within: Duration) -> Option<Ended> {
        if self.is_under_way() {
            let events = self.flight.tick(&[Order::Abort]);
            self.keep(&events);
        }
        self.close_log(within);
        self.log.and_then(|log| {
            let folder = log.folder.path().to_path_buf();
            log.ended.map(|summary| Ended { summary, folder })
        })
    }

    fn tell_events(&self, events: &[Event]) {
        self.say(Msg::Events(events.to_vec()));
    }

    fn say(&self, message: Msg) {
        // A screen that is gone needs no news.
        let _ = self.tell.send(message);
    }
}

/// Tells the screen of a plan that is being made.
fn tell_plan(screen: &SyncSender<Msg>, news: PlanNews) {
    // A screen that is gone needs no news, and one that is slow can do without some of the progress: the plan waits.
    let _ = match news {
        PlanNews::Begun(planning) => {
            screen.send(Msg::Busy(Some((planning.work, Some(planning.within.as_secs_f64()))))).is_ok()
        }
        PlanNews::Progress(Progress { share, what }) => screen.try_send(Msg::BusyAt { share, what }).is_ok(),
        PlanNews::Done => screen.send(Msg::Busy(None)).is_ok(),
    };
}

fn may_take_long(order: &Order) -> bool {
    matches!(order, Order::Start | Order::Resume | Order::ChoosePlanner(_) | Order::SetParameter { .. })
}
