//! The state of a worker between two requests, and how it executes them.

use super::Socket;
use super::confine::{close_off, die_with_the_console, limit_memory};
use super::deadline::Deadline;
use crate::loader::{File, Instance, NotRead, Sink, Table};
use crate::sandbox::close_files;
use crate::supervisor::no_worker;
use crate::wire::answer::{Answered, GivenPlan, Planners, Refusal};
use crate::wire::body::{Body, Malformed, Writer, whole};
use crate::wire::request::{Call, Load, Values};
use crate::wire::{frame::Incoming, kind};
use mission::Sandbox;
use mission::ask::{PlanAsk, Site, StepAsk};
use std::sync::Arc;

/// The reason why a request has no result.
pub(super) enum Trouble {
    /// The library is not a plugin, or failed to describe itself.
    Refused(String),
    /// This machine prevents the worker from running.
    Unable(String),
    /// The planner refused.
    Failed(Refusal),
    /// The request does not match its kind.
    Malformed,
}

impl From<Malformed> for Trouble {
    fn from(_: Malformed) -> Self {
        Self::Malformed
    }
}

impl From<Refusal> for Trouble {
    fn from(refusal: Refusal) -> Self {
        Self::Failed(refusal)
    }
}

impl From<NotRead> for Trouble {
    fn from(why: NotRead) -> Self {
        match why {
            NotRead::Refused(why) => Self::Refused(why),
            NotRead::Machine(why) => Self::Unable(why),
        }
    }
}

/// The library, and the planner created from it.
pub(super) struct Session<'a> {
    deadline: &'a Deadline,
    socket: &'a Socket,
    table: Option<Table>,
    instance: Option<Instance>,
}

impl<'a> Session<'a> {
    /// Creates a session with nothing loaded.
    pub(super) fn new(deadline: &'a Deadline, socket: &'a Socket) -> Self {
        Self { deadline, socket, table: None, instance: None }
    }

    /// Executes a request and writes the body of its answer.
    pub(super) fn obey(&mut self, request: &Incoming, out: &mut Writer) -> Result<(), Trouble> {
        let body = request.body();
        match request.kind() {
            kind::LOAD => self.load(body, request.sequence(), out),
            kind::CONFIGURE => self.configure(body, out),
            kind::RECONFIGURE => self.reconfigure(body, out),
            kind::PLAN => self.plan(body, out),
            kind::STEP => self.step(body, out),
            kind::SNAPSHOT => self.snapshot(body, out),
            kind::RESTORE => self.restore(body),
            _ => Err(Trouble::Malformed),
        }
    }

    fn sink(&self) -> Sink<'a> {
        Sink::new(self.deadline)
    }

    /// Loads a library; a worker does this only once. Describes one planner and keeps it, or describes all planners if
    /// no id is given.
    fn load(&mut self, body: Body<'_>, sequence: u32, out: &mut Writer) -> Result<(), Trouble> {
        let Some(load) = Load::read(body)? else {
            return Err(Trouble::Refused("worker and console are different builds; restart tankops".into()));
        };
        limit_memory(load.memory_limit_bytes);
        let file = File::read(load.path())?;
        let reads_libraries =
            self.close_off(sequence, &file, load.memory_limit_bytes, load.requires_sandbox)?;
        let library = file.load().map_err(Trouble::Refused)?;
        if reads_libraries {
            close_files()
                .map_err(|why| Trouble::Refused(format!("its access to files cannot be blocked: {why}")))?;
        }
        let mut tables = library.tables().map_err(Trouble::Refused)?;
        tables.retain(|table| load.id.is_empty() || table.id == load.id);
        let planners =
            tables.iter().map(|table| table.describe(&mut self.sink())).collect::<Result<Vec<_>, _>>();
        let planners = planners.map_err(Trouble::Refused)?;
        self.table = tables.into_iter().next();
        out.put(&Planners(planners));
        Ok(())
    }

    /// Enters the sandbox: from here on, the process can only compute. Returns whether access to files must still be
    /// removed.
    fn close_off(
        &self,
        sequence: u32,
        file: &File,
        memory_limit_bytes: u64,
        requires_sandbox: bool,
    ) -> Result<bool, Trouble> {
        let lost = |error| Trouble::Unable(no_worker("cannot be sandboxed", &error));
        let (sandbox, reads_libraries) =
            close_off(self.socket, sequence, file, memory_limit_bytes).map_err(lost)?;
        if requires_sandbox && sandbox != Sandbox::Full {
            return Err(Trouble::Refused(format!("--require-sandbox is set, but the sandbox is {sandbox}")));
        }
        // The sandbox would not cover a thread that was started earlier.
        die_with_the_console(Arc::clone(self.socket)).map_err(lost)?;
        Ok(reads_libraries)
    }

    fn configure(&mut self, body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        let (values, site): (Values, Site) = whole(body)?;
        let table = self.table.as_ref().ok_or(Trouble::Malformed)?;
        let mut sink = self.sink();
        // An instance from an earlier mission is dropped first.
        self.instance = None;
        self.instance = Some(site.lend(|site| table.create(site, &values, &mut sink))?);
        out.put(&Answered { given: (), said: sink.take_said() });
        Ok(())
    }

    fn instance(&mut self) -> Result<&mut Instance, Trouble> {
        self.instance.as_mut().ok_or(Trouble::Malformed)
    }

    fn reconfigure(&mut self, body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        let values: Values = whole(body)?;
        let mut sink = self.sink();
        self.instance()?.reconfigure(&values, &mut sink)?;
        out.put(&Answered { given: (), said: sink.take_said() });
        Ok(())
    }

    fn plan(&mut self, body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        let Call { watched, asked }: Call<PlanAsk> = whole(body)?;
        self.deadline.set_watched(watched);
        let mut sink = self.sink();
        let instance = self.instance()?;
        let plan = asked.lend(|request| instance.plan(request, &mut sink))?;
        out.put(&Answered { given: GivenPlan(plan), said: sink.take_said() });
        Ok(())
    }

    fn step(&mut self, body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        let Call { watched, asked }: Call<StepAsk> = whole(body)?;
        self.deadline.set_watched(watched);
        let mut sink = self.sink();
        let instance = self.instance()?;
        let given = asked.lend(|sensed| instance.step(sensed, &mut sink))?;
        out.put(&Answered { given, said: sink.take_said() });
        Ok(())
    }

    fn snapshot(&mut self, body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        whole::<()>(body)?;
        let mut sink = self.sink();
        out.written(&self.instance()?.snapshot(&mut sink)?);
        Ok(())
    }

    fn restore(&mut self, mut body: Body<'_>) -> Result<(), Trouble> {
        let version = body.take()?;
        let mut sink = self.sink();
        Ok(self.instance()?.restore(version, body.0, &mut sink)?)
    }
}
