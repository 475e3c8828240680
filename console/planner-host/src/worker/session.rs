//! What a worker holds between two requests, and how it obeys them.

use super::confine;
use super::deadline::Deadline;
use crate::loader::{self, Instance, Plugin, Sink, Table};
use crate::wire::answer::{Loaded, Refusal};
use crate::wire::body::{Body, Malformed, Writer};
use crate::wire::{self, kind};
use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;

/// Why there is no answer.
pub(super) enum Trouble {
    /// The library is no plugin, or does not describe itself.
    Refused(String),
    /// The planner said no.
    Failed(Refusal),
    /// The request is not what its kind says.
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

/// The library, and the planner that was made from it.
pub(super) struct Session<'a> {
    deadline: &'a Deadline,
    table: Option<Table>,
    instance: Option<Instance>,
}

impl<'a> Session<'a> {
    /// Nothing loaded yet.
    pub(super) fn new(deadline: &'a Deadline) -> Self {
        Self { deadline, table: None, instance: None }
    }

    /// Obeys a request and writes the body of its answer.
    pub(super) fn obey(&mut self, kind: u8, body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        match kind {
            kind::LOAD => self.load(body, out),
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

    /// Loads a library once; describes one planner of it and keeps that, or all of them when none is named.
    fn load(&mut self, mut body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        if body.u32()? != wire::VERSION {
            return Err(Trouble::Refused(
                "the worker is of another build than the console; restart tankops".into(),
            ));
        }
        confine::limit_memory(body.u64()?);
        let path = Path::new(OsStr::from_bytes(body.bytes()?));
        let wanted = body.text()?;
        body.end()?;
        let Plugin { sha256, abi, mut tables } = loader::open(path).map_err(Trouble::Refused)?;
        tables.retain(|table| wanted.is_empty() || table.id == wanted);
        let planners =
            tables.iter().map(|table| table.describe(&mut self.sink())).collect::<Result<Vec<_>, _>>();
        let planners = planners.map_err(Trouble::Refused)?;
        self.table = tables.into_iter().next();
        out.loaded(&Loaded { sha256, abi_major: abi.major, abi_minor: abi.minor, planners });
        Ok(())
    }

    fn configure(&mut self, mut body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        let (values, site) = (body.values()?, body.site()?);
        body.end()?;
        let table = self.table.as_ref().ok_or(Trouble::Malformed)?;
        let mut sink = self.sink();
        self.instance = Some(site.lend(|site| table.create(site, &values, &mut sink))?);
        out.said(&sink.take_said());
        Ok(())
    }

    fn instance(&mut self) -> Result<&mut Instance, Trouble> {
        self.instance.as_mut().ok_or(Trouble::Malformed)
    }

    fn reconfigure(&mut self, mut body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        let values = body.values()?;
        body.end()?;
        let mut sink = self.sink();
        self.instance()?.reconfigure(&values, &mut sink)?;
        out.said(&sink.take_said());
        Ok(())
    }

    fn plan(&mut self, mut body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        self.deadline.set_watched(body.flag()?);
        let request = body.request()?;
        body.end()?;
        let mut sink = self.sink();
        let instance = self.instance()?;
        let plan = request.lend(|request| instance.plan(request, &mut sink))?;
        out.plan(&plan).said(&sink.take_said());
        Ok(())
    }

    fn step(&mut self, mut body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        self.deadline.set_watched(body.flag()?);
        let sensed = body.sensed()?;
        body.end()?;
        let mut sink = self.sink();
        let instance = self.instance()?;
        let command = sensed.lend(|sensed| instance.step(sensed, &mut sink))?;
        out.command(command).said(&sink.take_said());
        Ok(())
    }

    fn snapshot(&mut self, body: Body<'_>, out: &mut Writer) -> Result<(), Trouble> {
        body.end()?;
        let mut sink = self.sink();
        out.bytes(&self.instance()?.snapshot(&mut sink)?);
        Ok(())
    }

    fn restore(&mut self, mut body: Body<'_>) -> Result<(), Trouble> {
        let (version, state) = (body.u32()?, body.bytes()?);
        body.end()?;
        let mut sink = self.sink();
        Ok(self.instance()?.restore(version, state, &mut sink)?)
    }
}
