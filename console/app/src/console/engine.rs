//! The thread that flies: takes orders, keeps the pace, hands every event to recorder, report and screen.
//!
//! It never waits in a planner or for the screen. Whatever it waits for (the next tick, an answer, room in the screen's
//! inbox), an order to hold or to end ends the wait at once.

use super::inbox::Outbox;
use crate::{
    answers::{Window, Windowed},
    cli::Drill,
    flight::Flight,
    headless::{self, CLOSE_TIMEOUT},
    plan_watch::{PlanWatch, Watched},
    run_folder::{Kept, RunFolder},
    scenario::Scenario,
};
use mission::{Awaits, Event, Order, Phase};
use planner_host::{Host, PluginDirs, Progress, Waker};
use recording::{Options, RunRecorder};
use report::{Fold, Logs, Stops, Summary};
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, Receiver, RecvTimeoutError, Sender},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};
use tui::{Msg, Speed};

/// How often the recorder's health is sent to the screen.
const HEALTH_PERIOD: Duration = Duration::from_millis(500);
/// A tick that is later than this is not made up for.
const MOST_LATE: Duration = Duration::from_millis(50);
/// Time limit for closing the recording when a signal has asked the process to exit.
const HURRY: Duration = Duration::from_millis(900);
/// With this many messages waiting for the screen, the simulation waits for it.
const MOST_BACKLOG: usize = 64;
/// How long it waits then before it looks again, unless an order comes.
const LOOK_AGAIN: Duration = Duration::from_millis(1);

/// A request to the engine thread.
enum Request {
    /// An order, and when it was received.
    Order(Order, Instant),
    Speed(Speed),
    /// End the run, close everything, stop.
    Close {
        within: Duration,
    },
}

/// The flying thread, seen from outside.
pub struct Engine {
    handle: EngineHandle,
    thread: JoinHandle<Option<Ended>>,
}

/// A handle to the engine, for every thread that may have to stop the robot.
#[derive(Clone)]
pub struct EngineHandle {
    requests: Sender<Request>,
    waker: Waker,
    /// Whether the robot moves or may begin to, as the screen knows it.
    may_move: Arc<AtomicBool>,
}

impl EngineHandle {
    /// Hands an order to the mission; it enters with the next tick. What stops the robot makes that tick begin now.
    pub fn order(&self, order: Order) {
        let is_urgent = matches!(order, Order::Hold | Order::Abort);
        self.request(Request::Order(order, Instant::now()), is_urgent);
    }

    /// Whether the robot moves or may begin to, as the screen knows it.
    pub fn may_move(&self) -> bool {
        self.may_move.load(Ordering::Relaxed)
    }

    /// The screen reports whether the robot may move.
    pub fn set_may_move(&self, may_move: bool) {
        self.may_move.store(may_move, Ordering::Relaxed);
    }

    /// Changes the pace.
    pub fn speed(&self, speed: Speed) {
        self.request(Request::Speed(speed), false);
    }

    fn request(&self, request: Request, is_urgent: bool) {
        // An engine that has ended has already sent the reason to the screen.
        let _ = self.requests.send(request);
        if is_urgent {
            self.waker.wake();
        }
    }
}

/// A run that was flown.
pub struct Ended {
    /// Its report.
    pub summary: Summary,
    /// Whether it is on disk.
    pub kept: Kept,
}

impl Engine {
    /// Starts the thread; nothing moves and nothing is written before the operator starts the mission.
    pub fn start(
        scenario: &Scenario,
        logs: &Path,
        plugins: &PluginDirs,
        screen: Outbox,
        drill: Option<Drill>,
    ) -> anyhow::Result<Self> {
        let (requests, asked) = mpsc::channel();
        let mut host = headless::host(scenario, plugins);
        let handle = EngineHandle { requests, waker: host.waker(), may_move: Arc::default() };
        let progress = screen.clone();
        host.set_on_progress(Arc::new(move |_, Progress { share, what }| {
            progress.send(Msg::BusyAt { share: *share, what: what.clone() });
        }));
        let engine = EngineThread {
            scenario: scenario.clone(),
            logs: logs.to_path_buf(),
            flight: Flight::prepare(scenario, true),
            host,
            watch: PlanWatch::default(),
            shown_work: None,
            asked,
            screen,
            speed: super::START_SPEED,
            early: Vec::new(),
            stop_asked: None,
            stops_ms: Vec::new(),
            log: None,
            drill,
        };
        let thread = thread::Builder::new().name("engine".into()).spawn(move || engine.fly())?;
        Ok(Self { handle, thread })
    }

    /// A handle to the engine.
    pub fn handle(&self) -> EngineHandle {
        self.handle.clone()
    }

    /// Ends the run, closes its files and waits for that; less time is allowed after a signal (`hurry`).
    pub fn close(self, hurry: bool) -> anyhow::Result<Option<Ended>> {
        let within = if hurry { HURRY } else { CLOSE_TIMEOUT };
        self.handle.request(Request::Close { within }, true);
        self.thread.join().map_err(|panic| anyhow::anyhow!("the engine panicked: {}", words(&*panic)))
    }
}

fn words(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(ToString::to_string);
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without a word".into())
}

/// Everything the thread owns.
struct EngineThread {
    scenario: Scenario,
    logs: PathBuf,
    flight: Flight,
    host: Host,
    watch: PlanWatch,
    /// The planners' work that the screen shows.
    shown_work: Option<String>,
    asked: Receiver<Request>,
    screen: Outbox,
    speed: Speed,
    /// What happened before the mission was started; it is written down when it is.
    early: Vec<Event>,
    /// When the stop was asked for that the next tick brings.
    stop_asked: Option<Instant>,
    /// How long each stop took, milliseconds.
    stops_ms: Vec<f64>,
    log: Option<RunLog>,
    drill: Option<Drill>,
}

/// What is written about the run.
struct RunLog {
    folder: RunFolder,
    recorder: Option<RunRecorder>,
    fold: Fold,
    began: Instant,
    health_sent_at: Instant,
    ended: Option<Ended>,
}

impl EngineThread {
    fn fly(mut self) -> Option<Ended> {
        self.send_events(&[self.flight.opened()]);
        let mut due = Instant::now();
        loop {
            let (orders, close) = self.wait_until(due);
            if !orders.is_empty() || self.is_under_way() {
                due = self.next_due(due);
                self.tick(&orders);
            }
            if let Some(within) = close {
                return self.close(within);
            }
        }
    }

    /// Whether ticks pass by themselves: the mission is under way, or a planner is being prepared for it.
    fn is_under_way(&self) -> bool {
        match self.flight.phase() {
            Phase::Waiting => self.flight.mission().awaits() != Awaits::Nothing,
            Phase::Running(_) | Phase::Held(_) => true,
            Phase::Ended(_) => false,
        }
    }

    /// Waits for the next tick, or, while no ticks pass, for a request; gives the orders that came and whether to
    /// close.
    fn wait_until(&mut self, due: Instant) -> (Vec<Order>, Option<Duration>) {
        // A wake-up from here on belongs to a request that has not been taken yet.
        self.host.clear_wake_ups();
        let mut orders = Vec::new();
        loop {
            let is_behind = self.screen.backlog() > MOST_BACKLOG;
            let due = if is_behind { due.max(Instant::now() + LOOK_AGAIN) } else { due };
            let wait = due.saturating_duration_since(Instant::now());
            let request = if self.is_under_way() {
                self.asked.recv_timeout(wait)
            } else if orders.is_empty() {
                self.asked.recv().map_err(|_| RecvTimeoutError::Disconnected)
            } else {
                return (orders, None);
            };
            match request {
                // What stops the robot does not wait for the tick that is due: the tick comes now.
                Ok(Request::Order(order @ (Order::Hold | Order::Abort), at)) => {
                    if self.flight.phase().may_move() {
                        self.stop_asked.get_or_insert(at);
                    }
                    orders.push(order);
                    return (orders, None);
                }
                Ok(Request::Order(order, _)) => orders.push(order),
                Ok(Request::Speed(speed)) => self.speed = speed,
                Ok(Request::Close { within }) => return (orders, Some(within)),
                Err(RecvTimeoutError::Timeout) if is_behind => {}
                Err(RecvTimeoutError::Timeout) => return (orders, None),
                Err(RecvTimeoutError::Disconnected) => return (orders, Some(CLOSE_TIMEOUT)),
            }
        }
    }

    /// When the tick after this one is due; time that was lost is not made up for by rushing. While a planner is at work, and
    /// while only an order can let the robot move, mission time passes no faster than the clock.
    fn next_due(&self, due: Instant) -> Instant {
        let now = Instant::now();
        let tick = self.flight.tick_length();
        let is_still = matches!(self.flight.phase(), Phase::Held(hold) if hold.resumes.is_never());
        let waits = is_still || self.flight.mission().is_preparing();
        let pace = match self.speed {
            Speed::Times(factor) if waits => tick.div_f64(factor.min(1.0)),
            Speed::Times(factor) => tick.div_f64(factor),
            Speed::Max if waits => tick,
            Speed::Max => return now,
        };
        if now.saturating_duration_since(due) < MOST_LATE { due + pace } else { now + pace }
    }

    /// How long a tick waits for answers at this pace.
    fn window(&self) -> Window {
        let tick = self.flight.tick_length();
        match self.speed {
            Speed::Times(factor) if factor <= 1.0 => Window::real_time(tick),
            Speed::Times(_) => Window::faster(tick),
            Speed::Max => Window::unbounded(tick),
        }
    }

    fn tick(&mut self, orders: &[Order]) {
        let starts = self.log.is_none() && orders.contains(&Order::Start);
        if starts && let Err(error) = self.open_log() {
            // Nothing moves without being recorded.
            let why = format!("cannot start: {error:#}");
            self.screen.send_urgent(Msg::OrderFailed { order: Order::Start, why });
            let others: Vec<Order> = orders.iter().filter(|order| **order != Order::Start).cloned().collect();
            return self.tick_with(&others);
        }
        self.tick_with(orders);
    }

    fn tick_with(&mut self, orders: &[Order]) {
        let window = self.window();
        let mut answers = Windowed::new(&mut self.host, window);
        let events = self.flight.tick(orders, &mut Watched::new(&mut answers, &mut self.watch));
        if let Some(asked) = self.stop_asked.take() {
            self.stops_ms.push(asked.elapsed().as_secs_f64() * 1e3);
        }
        let failing = self.drill == Some(Drill::PanicEngine) && events.iter().any(|event| event.tick > 5);
        assert!(!failing, "drill: the engine fails on purpose");
        self.keep(&events);
        self.send_work();
        self.send_events(&events);
        self.send_health();
        if matches!(self.flight.phase(), Phase::Ended(_)) {
            self.close_log(CLOSE_TIMEOUT);
        }
    }

    /// Sends to the screen what planners are doing beyond this tick.
    fn send_work(&mut self) {
        let work = self.watch.current().map(str::to_owned);
        if work != self.shown_work {
            let within_s = self.host.plan_budget().as_secs_f64();
            self.send(Msg::Busy(work.clone().map(|work| (work, Some(within_s)))));
            self.shown_work = work;
        }
    }

    fn open_log(&mut self) -> anyhow::Result<()> {
        let planner = self.flight.mission().planner_id();
        let folder = RunFolder::create(&self.logs, &self.scenario.name, planner, self.scenario.seed)?;
        let recorder = RunRecorder::start(folder.path(), Options::default())?;
        let now = Instant::now();
        self.log = Some(RunLog {
            folder,
            recorder: Some(recorder),
            fold: Fold::new(),
            began: now,
            health_sent_at: now,
            ended: None,
        });
        self.keep(&[self.flight.opened()]);
        let early = std::mem::take(&mut self.early);
        self.keep(&early);
        Ok(())
    }

    fn keep(&mut self, events: &[Event]) {
        let Some(log) = &mut self.log else { return self.early.extend_from_slice(events) };
        for event in events {
            log.fold.apply(event);
        }
        if let Some(recorder) = &log.recorder {
            recorder.send(events);
        }
    }

    fn send_health(&mut self) {
        let Some(log) = &mut self.log else { return };
        let Some(recorder) = &log.recorder else { return };
        if log.health_sent_at.elapsed() < HEALTH_PERIOD {
            return;
        }
        log.health_sent_at = Instant::now();
        let health = super::screen::health(&recorder.health(), None);
        self.send(Msg::Health(health));
    }

    /// Closes journal and recording and writes the report.
    fn close_log(&mut self, within: Duration) {
        let Some(log) = &mut self.log else { return };
        let Some(recorder) = log.recorder.take() else { return };
        let finished = recorder.finish(within);
        let logs = Logs {
            journal: finished.journal.as_ref().map(|path| path.display().to_string()),
            recording: finished.recording.as_ref().map(|path| path.display().to_string()),
            error: finished.error.clone(),
        };
        let summary = Summary {
            wall_time_s: Some(log.began.elapsed().as_secs_f64()),
            events_sha256: finished.events_sha256.clone(),
            planner_calls: Some(headless::planner_calls(&self.host)),
            stops: Stops::of(&self.stops_ms),
            logs: Some(logs),
            ..log.fold.summary()
        };
        let summary = self.scenario.expect.evaluated(summary);
        let report = log.folder.write_report(&summary);
        let kept = Kept::new(&log.folder, &finished, &report);
        let problem = kept.problem();
        log.ended = Some(Ended { summary, kept });
        self.send(Msg::Health(super::screen::closed(problem)));
    }

    fn close(mut self, within: Duration) -> Option<Ended> {
        if matches!(self.flight.phase(), Phase::Running(_) | Phase::Held(_)) {
            let mut answers = Windowed::new(&mut self.host, Window::real_time(Duration::ZERO));
            let events = self.flight.tick(&[Order::Abort], &mut Watched::new(&mut answers, &mut self.watch));
            self.keep(&events);
        }
        self.close_log(within);
        self.log.and_then(|log| log.ended)
    }

    fn send_events(&self, events: &[Event]) {
        self.send(Msg::Events(events.to_vec()));
    }

    fn send(&self, message: Msg) {
        // Once the screen is closed, messages are discarded.
        self.screen.send(message);
    }
}
