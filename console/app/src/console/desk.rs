//! The thread that opens runs one after the other, and has work done beside the screen.
//!
//! The engine of a run that is open is closed before the next one is opened: the journal of a run is whole before the
//! next one begins.

use super::{
    engine::Engine,
    inbox::{Outbox, RunOutbox},
    jobs,
    line::Current,
    look::Disk,
};
use crate::{
    cli::{Changes, Drill},
    config::Config,
    planners::check_choices,
    rescan, scenarios,
};
use mission::{PlannerChoice, PlannerInfo};
use planner_host::PluginDirs;
use runs::Closed;
use scenario::Scenario;
use std::{
    path::PathBuf,
    sync::{
        Arc,
        mpsc::{self, Receiver, Sender},
    },
    thread::{self, JoinHandle},
};
use tui::{Job, Msg, RunId, RunMsg, Source, Speed};

/// What the desk is asked for.
pub(super) enum Request {
    /// Close the run that is open and open another one.
    Open { id: RunId, source: Source, planner: Option<PlannerChoice> },
    /// Look at the disk again.
    Look,
    /// Work on a past run.
    Do(Job),
    /// Close the run that is open, quickly after a signal, and stop.
    Leave { hurry: bool },
}

/// What everything at the desk needs.
#[derive(Clone)]
pub(super) struct Tools {
    pub logs: PathBuf,
    pub plugins: PluginDirs,
    pub planners: Arc<Vec<PlannerInfo>>,
    pub outbox: Outbox,
    pub config: Arc<Config>,
}

/// The desk.
pub(super) struct Desk {
    tools: Tools,
    disk: Arc<Disk>,
    /// What the command line changes in the scenario that it names.
    changes: Changes,
    speed: Speed,
    drill: Option<Drill>,
    current: Current,
    engine: Option<Engine>,
    /// The last run that was flown.
    flown: Option<Closed>,
}

/// The desk, seen from outside.
#[derive(Clone)]
pub(super) struct DeskHandle(Sender<Request>);

impl DeskHandle {
    /// Hands in a request; a desk that has stopped takes none.
    pub(super) fn request(&self, request: Request) {
        let _ = self.0.send(request);
    }
}

impl Desk {
    /// A desk without a run.
    pub(super) fn new(tools: Tools, changes: Changes, speed: Speed, drill: Option<Drill>) -> Self {
        let disk = Arc::new(Disk::new(tools.clone()));
        let current = Current::default();
        Self { tools, disk, changes, speed, drill, current, engine: None, flown: None }
    }

    /// The engine of the run that is open.
    pub(super) fn current(&self) -> Current {
        self.current.clone()
    }

    /// Opens a scenario that has been read.
    ///
    /// # Errors
    /// Its planners are not there or do not take their parameters; the system gives no thread.
    pub(super) fn open(&mut self, id: RunId, scenario: &Scenario) -> anyhow::Result<()> {
        check_choices(scenario, &self.tools.planners)?;
        let Tools { logs, plugins, outbox, .. } = &self.tools;
        let screen = RunOutbox { run: id, outbox: outbox.clone() };
        let engine = Engine::start(scenario, logs, plugins, screen, self.speed, self.drill)?;
        self.current.set(Some(engine.handle()));
        self.engine = Some(engine);
        Ok(())
    }

    /// Works in a thread of its own from now on.
    pub(super) fn start(self) -> anyhow::Result<(DeskHandle, JoinHandle<anyhow::Result<Option<Closed>>>)> {
        let (requests, asked) = mpsc::channel();
        let thread = thread::Builder::new().name("desk".into()).spawn(move || self.work(&asked))?;
        Ok((DeskHandle(requests), thread))
    }

    fn work(mut self, asked: &Receiver<Request>) -> anyhow::Result<Option<Closed>> {
        for request in asked {
            match request {
                Request::Open { id, source, planner } => self.replace(id, &source, planner)?,
                Request::Look => self.look(),
                Request::Do(job) => jobs::begin(job, &self.tools),
                Request::Leave { hurry } => {
                    self.close(hurry)?;
                    break;
                }
            }
        }
        Ok(self.flown)
    }

    fn replace(&mut self, id: RunId, source: &Source, planner: Option<PlannerChoice>) -> anyhow::Result<()> {
        self.close(false)?;
        let opened = self.read(source).and_then(|mut scenario| {
            if let Some(planner) = planner {
                scenario.mission.planner = planner;
            }
            self.open(id, &scenario)
        });
        if let Err(error) = opened {
            self.tools.outbox.send(Msg::Run(id, RunMsg::OpenFailed(format!("{error:#}"))));
        }
        Ok(())
    }

    fn read(&self, source: &Source) -> anyhow::Result<Scenario> {
        match source {
            Source::Demo => scenarios::demo_with(&self.changes),
            Source::File(path) => scenarios::read(path.as_ref(), &Changes::default()),
            Source::Rescan(runs) => rescan::scenario_for(runs, &self.tools.logs),
        }
    }

    /// Scenarios that are many or large take a while to read: the desk is not kept from opening one.
    fn look(&self) {
        let disk = Arc::clone(&self.disk);
        let began = thread::Builder::new().name("look".into()).spawn(move || disk.look());
        if let Err(error) = began {
            jobs::report(&self.tools.outbox, &format!("cannot look at the disk: {error}"));
        }
    }

    /// Closes the run that is open.
    fn close(&mut self, hurry: bool) -> anyhow::Result<()> {
        self.current.set(None);
        let Some(engine) = self.engine.take() else { return Ok(()) };
        if let Some(closed) = engine.close(hurry)? {
            self.flown = Some(closed);
        }
        Ok(())
    }
}
