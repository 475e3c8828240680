//! The desk: a thread that opens runs one after another and starts background work.
//!
//! The engine of the open run is closed before the next run is opened, so the journal of a run is complete before the
//! next run begins.

use super::{
    checking, combining,
    comparing::Comparing,
    engine::Engine,
    forecasting::Forecasting,
    glimpsing::Glimpsing,
    handover,
    inbox::{Outbox, RunOutbox},
    jobs,
    line::Current,
    look::Disk,
    replaying::Player,
};
use crate::{
    Drill,
    config::{Config, presets},
    history,
};
use flight::{
    Flight,
    planners::{Found, check_choices, found},
    scenarios,
};
use mission::{PlannerChoice, Severity};
use planner_host::PluginDirs;
use review::rescan_of;
use runs::Closed;
use scenario::{Scenario, Settings};
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{self, Receiver, Sender},
    },
    thread::{self, JoinHandle},
};
use tui::{Job, Msg, RunId, RunMsg, Source, Speed, Transport, model::glimpse::RunKey};

/// A request to the desk.
pub(super) enum Request {
    /// Close the open run and open another; if the new run cannot be opened, the old run stays open.
    Open { id: RunId, source: Source, planner: Option<PlannerChoice>, speed: Speed },
    /// Close the open run and play back a past run.
    Replay { id: RunId, run: String },
    /// Control the open replay.
    Transport(Transport),
    /// Change the speed of the replay.
    Pace(Speed),
    /// Run the checks before the start.
    Check { needed_bytes: u64 },
    /// Have another planner plan the open mission, for comparison.
    Compare(PlannerChoice),
    /// Cancel the comparison plan.
    StopComparing,
    /// Forecast how the held mission would continue with each of these planners.
    Forecast(Vec<PlannerChoice>),
    /// Cancel the forecasts.
    StopForecasting,
    /// Save parameters as a named preset.
    SavePreset { name: String, choice: PlannerChoice },
    /// Save a command line in the history.
    Remember(String),
    /// Combine the coverage of the open run with the coverage of these earlier runs.
    Combine(Vec<String>),
    /// Survey the plugins again.
    Survey,
    /// Rescan the scenarios and runs on disk.
    Look,
    /// Read the details of a past run.
    Glimpse(RunKey),
    /// Abandon reading the details of a past run.
    StopGlimpsing,
    /// Run a job on a past run.
    Do(Job),
    /// Write a handover page.
    HandOver { file: String, page: String, overwrite: bool },
    /// Close the open run and stop; do so quickly after a signal (`hurry`).
    Leave { hurry: bool },
}

/// The planners and plugins found by the latest survey.
#[derive(Clone, Default)]
pub(super) struct Known(Arc<Mutex<Arc<Found>>>);

impl Known {
    /// Replaces the result of the survey.
    pub(super) fn set(&self, found: Found) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Arc::new(found);
    }

    /// The result of the latest survey.
    pub(super) fn get(&self) -> Arc<Found> {
        Arc::clone(&self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// The resources that all work of the desk shares.
#[derive(Clone)]
pub(super) struct Tools {
    pub logs: PathBuf,
    pub plugins: PluginDirs,
    pub planners: Known,
    pub outbox: Outbox,
    pub config: Arc<Config>,
    /// The real vehicle that missions drive; `None` for the simulator.
    pub vehicle: Option<remote::Wanted>,
}

/// The desk's thread.
pub(super) struct Desk {
    tools: Tools,
    disk: Arc<Disk>,
    glimpsing: Glimpsing,
    /// Changes from the command line, for the scenario named there.
    settings: Settings,
    /// The speed of newly opened runs.
    speed: Speed,
    drill: Option<Drill>,
    current: Current,
    engine: Option<Engine>,
    /// The replay of a past run; while it is open, there is no engine.
    player: Option<Player>,
    /// The open mission.
    opened: Option<(RunId, Arc<Scenario>)>,
    comparing: Option<Comparing>,
    forecasting: Option<Forecasting>,
    /// The last mission that was run, if any.
    flown: Option<Closed>,
}

/// A handle that sends requests to the desk.
#[derive(Clone)]
pub(super) struct DeskHandle(Sender<Request>);

impl DeskHandle {
    /// Sends a request; ignored if the desk has stopped.
    pub(super) fn request(&self, request: Request) {
        let _ = self.0.send(request);
    }
}

impl Desk {
    /// Creates a desk without a run.
    pub(super) fn new(tools: Tools, settings: Settings, speed: Speed, drill: Option<Drill>) -> Self {
        let disk = Arc::new(Disk::new(tools.clone()));
        let glimpsing = Glimpsing::new(tools.logs.clone(), tools.outbox.clone());
        let current = Current::default();
        Self {
            tools,
            disk,
            glimpsing,
            settings,
            speed,
            drill,
            current,
            engine: None,
            player: None,
            opened: None,
            comparing: None,
            forecasting: None,
            flown: None,
        }
    }

    /// Lists a scenario on the home screen, even if its file is in none of the scenario folders.
    pub(super) fn list(&self, source: &Source) {
        self.disk.list(source);
    }

    /// The engine of the open run.
    pub(super) fn current(&self) -> Current {
        self.current.clone()
    }

    /// Opens a scenario that has already been read, with the flight prepared for it.
    ///
    /// # Errors
    /// A planner is not available or does not accept its parameters, the vehicle is refused, or the thread cannot be
    /// started.
    pub(super) fn open(&mut self, id: RunId, scenario: &Scenario, flight: Flight) -> anyhow::Result<()> {
        check_choices(scenario, &self.tools.planners.get())?;
        self.launch(id, scenario, flight)
    }

    fn launch(&mut self, id: RunId, scenario: &Scenario, flight: Flight) -> anyhow::Result<()> {
        let Tools { logs, plugins, outbox, vehicle, .. } = &self.tools;
        let flight = remote::connected(flight, scenario, vehicle.as_ref())?;
        let screen = RunOutbox { run: id, outbox: outbox.clone() };
        let screen = (&self.current, screen);
        let started = Engine::start((scenario, flight), (logs, plugins), screen, self.speed, self.drill);
        self.engine = Some(started.inspect_err(|_| self.current.set(None))?);
        self.opened = Some((id, Arc::new(scenario.clone())));
        self.look_back(id, scenario.text.clone());
        Ok(())
    }

    /// Finds the runs that a re-scan continues. This runs on a separate thread, because reading the journals of runs
    /// without a report takes time.
    fn look_back(&self, id: RunId, scenario_toml: String) {
        self.begin_look_back(id, move |logs, screen| {
            combining::look_back(&scenario_toml, logs, |msg| screen.send(msg));
        });
    }

    fn begin_look_back(&self, id: RunId, look: impl FnOnce(&Path, &RunOutbox) + Send + 'static) {
        let screen = RunOutbox { run: id, outbox: self.tools.outbox.clone() };
        let logs = self.tools.logs.clone();
        let began = thread::Builder::new().name("look-back".into()).spawn(move || look(&logs, &screen));
        if let Err(error) = began {
            jobs::report(&self.tools.outbox, &format!("the runs before this one cannot be found: {error}"));
        }
    }

    /// Starts the desk's thread.
    pub(super) fn start(self) -> anyhow::Result<(DeskHandle, JoinHandle<anyhow::Result<Option<Closed>>>)> {
        let (requests, asked) = mpsc::channel();
        let thread = thread::Builder::new().name("desk".into()).spawn(move || self.work(&asked))?;
        Ok((DeskHandle(requests), thread))
    }

    fn work(mut self, asked: &Receiver<Request>) -> anyhow::Result<Option<Closed>> {
        for request in asked {
            match request {
                Request::Open { id, source, planner, speed } => {
                    self.speed = speed;
                    self.replace(id, &source, planner)?;
                }
                Request::Replay { id, run } => self.replay(id, run)?,
                Request::Transport(transport) => self.transport(&transport),
                Request::Pace(speed) => self.pace(speed),
                Request::Check { needed_bytes } => self.check(needed_bytes),
                Request::Compare(choice) => self.compare(choice),
                Request::StopComparing => self.comparing = None,
                Request::Forecast(choices) => self.forecast(choices),
                Request::StopForecasting => self.forecasting = None,
                Request::SavePreset { name, choice } => self.save_preset(&name, &choice),
                Request::Remember(line) => history::append(&line),
                Request::Survey => self.survey(),
                Request::Look => self.look(),
                Request::Combine(runs) => self.combine(runs),
                Request::Glimpse(key) => self.glimpsing.ask(key),
                Request::StopGlimpsing => self.glimpsing.stop(),
                Request::Do(job) => jobs::begin(job, &self.tools),
                Request::HandOver { file, page, overwrite } => {
                    handover::begin(&file, page, overwrite, &self.tools.outbox);
                }
                Request::Leave { hurry } => {
                    self.close(hurry)?;
                    break;
                }
            }
        }
        Ok(self.flown)
    }

    /// Finds every problem in the new scenario before closing the open run.
    fn replace(&mut self, id: RunId, source: &Source, planner: Option<PlannerChoice>) -> anyhow::Result<()> {
        let opened = match self.prepare(source, planner) {
            Ok((scenario, flight)) => {
                self.list(source);
                self.close(false)?;
                self.launch(id, &scenario, flight)
            }
            Err(error) => Err(error),
        };
        if let Err(error) = opened {
            self.tools.outbox.send(Msg::Run(id, RunMsg::OpenFailed(format!("{error:#}"))));
        }
        Ok(())
    }

    fn prepare(&self, source: &Source, planner: Option<PlannerChoice>) -> anyhow::Result<(Scenario, Flight)> {
        let mut scenario = self.read(source)?;
        if let Some(planner) = planner {
            scenario.mission.planner = planner;
        }
        check_choices(&scenario, &self.tools.planners.get())?;
        let flight = Flight::for_operator(&scenario);
        Ok((scenario, flight))
    }

    /// Closes the open run and plays back a past run.
    ///
    /// # Errors
    /// The open run cannot be closed.
    pub(super) fn replay(&mut self, id: RunId, run: String) -> anyhow::Result<()> {
        self.close(false)?;
        let Tools { logs, outbox, .. } = &self.tools;
        let screen = RunOutbox { run: id, outbox: outbox.clone() };
        let past = run.clone();
        match Player::begin(run, logs, screen.clone()) {
            Ok(player) => {
                self.player = Some(player);
                self.begin_look_back(id, move |logs, screen| {
                    combining::look_back_from(&past, logs, |msg| screen.send(msg));
                });
            }
            Err(error) => drop(screen.send(RunMsg::OpenFailed(format!("{error:#}")))),
        }
        Ok(())
    }

    /// Passes a playback control to the open replay.
    pub(super) fn transport(&self, transport: &Transport) {
        self.player.iter().for_each(|player| player.transport(transport.clone()));
    }

    /// Changes the speed of the replay.
    pub(super) fn pace(&self, speed: Speed) {
        self.player.iter().for_each(|player| player.speed(speed));
    }

    fn read(&self, source: &Source) -> anyhow::Result<Scenario> {
        match source {
            Source::Demo => scenarios::demo(&self.settings),
            Source::File(path) => scenarios::read(path.as_ref(), &Settings::default()),
            Source::Rescan(runs) => rescan_of(runs, &self.tools.logs),
        }
    }

    fn check(&self, needed_bytes: u64) {
        let Some((run, _)) = &self.opened else { return };
        let screen = RunOutbox { run: *run, outbox: self.tools.outbox.clone() };
        checking::begin(&self.tools, self.current.get(), screen, needed_bytes);
    }

    fn compare(&mut self, choice: PlannerChoice) {
        self.comparing = None;
        let Some((run, scenario)) = &self.opened else { return };
        let screen = RunOutbox { run: *run, outbox: self.tools.outbox.clone() };
        match Comparing::begin(Arc::clone(scenario), choice, &self.tools.plugins, screen) {
            Ok(comparing) => self.comparing = Some(comparing),
            Err(error) => jobs::report(&self.tools.outbox, &format!("comparison failed to start: {error}")),
        }
    }

    /// This runs on a separate thread, because reading the journals of long runs takes seconds.
    fn combine(&self, runs: Vec<String>) {
        let Some((run, _)) = &self.opened else { return };
        let screen = RunOutbox { run: *run, outbox: self.tools.outbox.clone() };
        let logs = self.tools.logs.clone();
        let began = thread::Builder::new().name("combine".into()).spawn(move || {
            if let Some(found) = combining::combined(&runs, &logs, || true).transpose() {
                let _ = screen.send(RunMsg::Combined(found.map(Box::new)));
            }
        });
        if let Err(error) = began {
            jobs::report(&self.tools.outbox, &format!("failed to combine the runs: {error}"));
        }
    }

    fn forecast(&mut self, choices: Vec<PlannerChoice>) {
        self.forecasting = None;
        let (Some((run, scenario)), Some(engine)) = (&self.opened, self.current.get()) else { return };
        let screen = RunOutbox { run: *run, outbox: self.tools.outbox.clone() };
        let plugins = self.tools.plugins.clone();
        match Forecasting::begin(Arc::clone(scenario), choices, engine, plugins, screen) {
            Ok(forecasting) => self.forecasting = Some(forecasting),
            Err(error) => jobs::report(&self.tools.outbox, &format!("forecast failed to start: {error}")),
        }
    }

    fn save_preset(&self, name: &str, choice: &PlannerChoice) {
        let Tools { outbox, planners, .. } = &self.tools;
        let (severity, text) = match presets::save(name, choice) {
            Ok(file) => (Severity::Info, format!("preset {name} saved: {}", file.display())),
            Err(error) => (Severity::Warn, format!("preset {name} not saved: {error:#}")),
        };
        outbox.send(Msg::Presets(presets::load(&planners.get().planners)));
        outbox.send(Msg::Notice { severity, text });
    }

    /// This runs on a separate thread, because a worker is started for each plugin.
    fn survey(&self) {
        let Tools { plugins, planners, outbox, .. } = self.tools.clone();
        let began = thread::Builder::new().name("survey".into()).spawn(move || {
            let found = found(&plugins);
            planners.set(found.clone());
            outbox.send(Msg::Planners { found: found.planners, refused: found.refused });
        });
        if let Err(error) = began {
            jobs::report(&self.tools.outbox, &format!("failed to survey the plugins: {error}"));
        }
    }

    /// This runs on a separate thread, because reading many or large scenarios takes time.
    fn look(&self) {
        let disk = Arc::clone(&self.disk);
        let began = thread::Builder::new().name("look".into()).spawn(move || disk.look());
        if let Err(error) = began {
            jobs::report(&self.tools.outbox, &format!("failed to rescan the disk: {error}"));
        }
    }

    /// Closes the open run.
    fn close(&mut self, hurry: bool) -> anyhow::Result<()> {
        self.current.set(None);
        self.player = None;
        (self.opened, self.comparing, self.forecasting) = (None, None, None);
        let Some(engine) = self.engine.take() else { return Ok(()) };
        if let Some(closed) = engine.close(hurry)? {
            self.flown = Some(closed);
        }
        Ok(())
    }
}
