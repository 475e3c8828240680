//! The engine: a thread that runs the mission. It receives orders, paces the ticks, and sends every event to the
//! recorder, the report and the screen.
//!
//! The engine never blocks in a planner, on the screen or on the disk. An order to hold or end the mission immediately
//! interrupts any wait: for the next tick, for an answer, or for space in the screen's inbox or the recorder's queue.

mod estimating;
mod keeping;
mod newest;
mod querying;
mod waiting;

use super::{
    inbox::RunOutbox,
    line::{Current, EngineHandle, Request, line},
    pace::{Pace, Reached, window},
    watch::GRACE,
};
use crate::Drill;
use account::DoubtWatch;
use flight::{
    Flight,
    answers::{Window, Windowed},
    hosts::host,
    plan_watch::{PlanWatch, Watched, Work},
    remains,
};
use mission::{AskId, Awaits, Event, Hold, HoldReason, Order, Phase};
use newest::Newest;
use planner_host::{Host, PluginDirs, Progress};
use runs::{CLOSE_TIMEOUT, Closed, RunLog};
use scenario::Scenario;
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        mpsc::{self, Receiver, Sender},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};
use tui::{Query, RunMsg, Speed};

/// While a real vehicle only waits for its start, one tick in this many is run. A movement of the vehicle must be
/// noticed, but the events of a long wait must not fill the memory.
const IDLE: u32 = 10;

/// Time limit for closing the recording after a signal has asked the process to exit. On a busy machine, the writer may
/// have to catch up; a run must not be lost for that.
const HURRY: Duration = GRACE.saturating_sub(Duration::from_secs(1));

/// A handle to the engine's thread.
pub(super) struct Engine {
    handle: EngineHandle,
    thread: JoinHandle<Option<Closed>>,
}

impl Engine {
    /// Starts the thread. The robot does not move, and nothing is written, until the operator starts the mission.
    pub(super) fn start(
        (scenario, flight): (&Scenario, Flight),
        (logs, plugins): (&Path, &PluginDirs),
        (current, screen): (&Current, RunOutbox),
        speed: Speed,
        drill: Option<Drill>,
    ) -> anyhow::Result<Self> {
        let mut host = host(scenario, plugins);
        let (handle, asked) = line(host.waker(), flight.brake());
        // A mission of a real vehicle cannot run faster than real time.
        let speed = if flight.is_live() { Speed::Times(1.0) } else { speed };
        let (progress, reported) = mpsc::channel();
        host.set_on_progress(Arc::new(move |ask, at| {
            // The receiver lives as long as the host.
            let _ = progress.send((ask, at.clone()));
        }));
        // Set this before the screen receives the run, so that the screen's first order finds an engine.
        current.set(Some(handle.clone()));
        // Send this before the thread runs, so that the first frame shows the scenario and every key takes effect.
        let opened = flight.opened();
        screen.send(RunMsg::Events(vec![opened.clone()]));
        let now = Instant::now();
        let engine = EngineThread {
            scenario: scenario.clone(),
            logs: logs.to_path_buf(),
            flight,
            watch: PlanWatch::new(host.plan_budget(), None),
            host,
            reported,
            shown_work: None,
            has_estimated: false,
            estimates: Newest::default(),
            queries: Newest::default(),
            deferred: None,
            asked,
            screen,
            speed,
            early: Vec::new(),
            stop_asked: None,
            stops_ms: Vec::new(),
            log: None,
            printed: Vec::new(),
            now: (0, 0.0),
            closed: None,
            health_sent_at: now,
            reached: Reached::since(now),
            doubt: DoubtWatch::opening(&opened),
            settling: None,
            drill,
        };
        let thread = thread::Builder::new().name("engine".into()).spawn(move || engine.fly())?;
        Ok(Self { handle, thread })
    }

    /// Ends the run, closes its files and waits for completion. After a signal (`hurry`), the time limit is shorter.
    pub(super) fn close(self, hurry: bool) -> anyhow::Result<Option<Closed>> {
        self.handle.close(hurry);
        self.thread.join().map_err(|panic| anyhow::anyhow!("the engine panicked: {}", words(&*panic)))
    }
}

fn words(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(ToString::to_string);
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".into())
}

/// The state of the engine's thread.
struct EngineThread {
    scenario: Scenario,
    logs: PathBuf,
    flight: Flight,
    host: Host,
    watch: PlanWatch,
    /// Progress reports of planners.
    reported: Receiver<(AskId, Progress)>,
    /// The planner's work that the screen currently shows.
    shown_work: Option<Work>,
    /// Whether an estimate for a plan was sent to the screen.
    has_estimated: bool,
    /// The estimates of plans that are being computed.
    estimates: Newest,
    /// The queries that are being answered.
    queries: Newest,
    /// A query that is answered once the robot stands.
    deferred: Option<Query>,
    asked: Receiver<Request>,
    screen: RunOutbox,
    speed: Speed,
    /// Events from before the start of the mission; they are written to the journal when the mission starts.
    early: Vec<Event>,
    /// The time at which a stop was requested that the next tick will carry out.
    stop_asked: Option<Instant>,
    /// The duration of each stop in milliseconds.
    stops_ms: Vec<f64>,
    log: Option<RunLog>,
    /// The number of the last tick, and the mission time then, in seconds.
    now: (u64, f64),
    /// The planners' output during this tick; only the screen receives this output.
    printed: Vec<Event>,
    closed: Option<Closed>,
    health_sent_at: Instant,
    reached: Reached,
    /// Finds the floor in doubt; `None` if no floor can be.
    doubt: Option<DoubtWatch>,
    /// The thread that waits until the next tick is in the journal.
    settling: Option<Sender<()>>,
    drill: Option<Drill>,
}

impl EngineThread {
    fn fly(mut self) -> Option<Closed> {
        let mut pace = Pace::from(Instant::now());
        loop {
            pace.rest(Instant::now(), self.rests(), self.flight.tick_length(), self.speed);
            let (mut orders, close) = self.wait_for(&pace);
            while pace.makes_up(Instant::now()) {
                self.tick(Vec::new());
            }
            if let Some(hurry) = close {
                return self.close(orders, hurry);
            }
            orders.extend(self.planner_check());
            if !orders.is_empty() || self.is_under_way() {
                let ticks = if self.is_idle() { IDLE } else { 1 };
                pace.tick_flown(Instant::now(), self.flight.tick_length() * ticks, self.speed, self.waits());
                self.tick(orders);
            }
            if let Some(answer) = self.settling.take() {
                self.settle(answer);
            }
        }
    }

    /// The order to check the planners, if the process of one has ended.
    fn planner_check(&mut self) -> Option<Order> {
        self.has_lost_planner().then_some(Order::CheckPlanner)
    }

    /// Whether the process of an idle planner has ended, before the start or while the robot is held. While the robot
    /// moves, this check is unnecessary, because the active planner is asked in every tick.
    fn has_lost_planner(&mut self) -> bool {
        let is_asked = !matches!(self.flight.phase(), Phase::Waiting | Phase::Held(_));
        let mut idle = self.flight.mission().idle_workers().filter(|_| !is_asked);
        idle.any(|worker| self.host.has_ended_idle(worker))
    }

    /// Whether ticks pass without orders: the mission is under way, a planner is being prepared, the first scan has not
    /// arrived, or a real vehicle is watched.
    fn is_under_way(&self) -> bool {
        match self.flight.phase() {
            Phase::Waiting => {
                let mission = self.flight.mission();
                mission.awaits() != Awaits::Nothing || mission.awaits_scan() || self.flight.is_live()
            }
            Phase::Running(_) | Phase::Held(_) => true,
            Phase::Ended(_) => false,
        }
    }

    /// Whether a real vehicle is known to stand still and waits for its start, and nothing else is under way.
    fn is_idle(&self) -> bool {
        let is_waiting = matches!(self.flight.phase(), Phase::Waiting) && self.flight.is_live();
        is_waiting && self.flight.mission().awaits() == Awaits::Nothing && !self.flight.awaits_stop()
    }

    /// Whether a planner is working or owes an answer, or only an order can make the robot move.
    fn waits(&self) -> bool {
        let is_silent =
            matches!(self.flight.phase(), Phase::Held(Hold { by: HoldReason::PlannerSilent { .. }, .. }));
        is_silent || self.is_held_for_good() || self.flight.mission().is_preparing()
    }

    /// Whether only an order can change what the robot does, and no planner owes an answer.
    fn rests(&self) -> bool {
        !self.flight.is_live()
            && self.is_held_for_good()
            && !self.flight.mission().is_preparing()
            && self.watch.current().is_none()
    }

    fn is_held_for_good(&self) -> bool {
        matches!(self.flight.phase(), Phase::Held(hold) if hold.resumes.is_never())
    }

    fn tick(&mut self, mut orders: Vec<Order>) {
        if let Some(start) = self.start_among(&orders)
            && let Err(error) = self.open_log()
        {
            // The robot must not move unrecorded.
            let why = format!("cannot start: {error:#}");
            self.screen.send_urgent(RunMsg::OrderFailed { order: start, why });
            orders.retain(|order| !order.is_start());
        }
        let events = self.fly_tick(&orders, window(self.flight.tick_length(), self.speed));
        let failing = self.drill == Some(Drill::PanicEngine) && events.iter().any(|event| event.tick > 5);
        assert!(!failing, "drill: the engine fails on purpose");
        self.send_work();
        self.outdate_queries(&events);
        self.answer_deferred();
        self.estimate(&events);
        let printed = std::mem::take(&mut self.printed);
        self.send(RunMsg::Events(events.into_iter().chain(printed).collect()));
        self.send_health();
        if matches!(self.flight.phase(), Phase::Ended(_)) {
            self.close_log(CLOSE_TIMEOUT);
        }
    }

    /// The start order, if the mission accepts it and nothing is recorded yet. A refused start order must not create a
    /// run.
    fn start_among(&self, orders: &[Order]) -> Option<Order> {
        let standing = self.flight.mission().standing();
        let mut starts = orders.iter().filter(|order| order.is_start() && standing.allows(order).is_ok());
        starts.next().filter(|_| self.log.is_none() && self.closed.is_none()).cloned()
    }

    /// Runs a tick and stores its events.
    fn fly_tick(&mut self, orders: &[Order], window: Window) -> Vec<Event> {
        let mut answers = Windowed::new(&mut self.host, window);
        let events = self.flight.tick(orders, &mut Watched::new(&mut answers, &mut self.watch));
        if let Some(asked) = self.stop_asked.take() {
            self.stops_ms.push(asked.elapsed().as_secs_f64() * 1e3);
        }
        self.reached.count();
        self.keep(&events);
        self.watch_doubt(&events);
        self.now = events.last().map_or((0, 0.0), |event| (event.tick, event.t_s));
        self.printed = remains::keep(&mut self.host, self.log.as_mut(), self.now);
        events
    }

    /// Reports floor that has come into doubt to the screen.
    fn watch_doubt(&mut self, events: &[Event]) {
        let Some(watch) = &mut self.doubt else { return };
        for event in events {
            if let Some(floor) = watch.apply(event) {
                self.screen.send(RunMsg::InDoubt(floor.to_vec()));
            }
        }
    }

    /// Reports planning work that takes longer than this tick, and its progress, to the screen.
    fn send_work(&mut self) {
        let work = self.watch.current();
        if work != self.shown_work.as_ref() {
            self.shown_work = work.cloned();
            let shown = work.map(|work| (work.what.clone(), work.limit.map(|limit| limit.as_secs_f64())));
            self.send(RunMsg::Busy(shown));
        }
        // Only the latest report counts, and only for the work that is shown.
        let shown = self.shown_work.as_ref().map(|work| work.ask);
        let last = self.reported.try_iter().filter(|(ask, _)| Some(*ask) == shown).last();
        if let Some((_, Progress { share, what })) = last {
            self.send(RunMsg::BusyAt { share, what });
        }
    }

    /// Ends the mission in a tick that does not wait for answers, and closes the files.
    fn close(mut self, mut orders: Vec<Order>, hurry: bool) -> Option<Closed> {
        if matches!(self.flight.phase(), Phase::Running(_) | Phase::Held(_)) {
            orders.push(if hurry { Order::Terminate } else { Order::Abort });
            self.fly_tick(&orders, Window::real_time(Duration::ZERO));
        }
        self.close_log(if hurry { HURRY } else { CLOSE_TIMEOUT });
        self.closed
    }

    fn send(&self, message: RunMsg) {
        // Once the screen is closed, messages are discarded.
        self.screen.send(message);
    }
}
