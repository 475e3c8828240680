//! The stages of opening a planner: load, configure, restore.

use super::{Loaded, Opening, Stage};
use crate::host::find::Candidate;
use crate::host::planner::{Asked, Doing, Planner, Ready, unless_refused};
use crate::host::spare::Spare;
use crate::host::{Host, fault, fault::Phase};
use crate::parameters;
use crate::remains::BadEnd;
use crate::supervisor::{Failure, Worker};
use crate::wire::answer::{Answered, Described, Said, Sealed};
use crate::wire::body::{Writer, whole};
use crate::wire::kind;
use crate::wire::request::Load;
use mission::planner::{Cause, During};
use mission::{AskId, Fault, Given};
use std::time::Instant;

impl Host {
    /// Begins to open a planner and closes any planner that has the same worker id. If the planner cannot be opened,
    /// the ask is answered immediately.
    pub(crate) fn open(&mut self, id: AskId, opening: Opening) {
        self.close(id.worker);
        self.planners.push(Planner::new(id.worker));
        let begun = match self.spares.take(&opening.planner) {
            Some(Spare { worker, loaded }) => {
                self.create(id, worker, opening, Loaded { is_reused: true, ..loaded })
            }
            None => self.load_next(id, opening),
        };
        self.close_unless(begun, id);
    }

    /// If opening the planner failed, closes it and answers with the fault.
    fn close_unless(&mut self, begun: Result<(), Fault>, id: AskId) {
        if let Err(fault) = begun {
            self.close(id.worker);
            self.answer(id, Err(fault));
        }
    }

    /// Asks a new worker to load the next file that may contain the planner.
    fn load_next(&mut self, id: AskId, mut opening: Opening) -> Result<(), Fault> {
        loop {
            let Some(candidate) = opening.candidates.pop_front() else {
                self.search_on(&mut opening)?;
                continue;
            };
            match self.load(&candidate, &opening.planner) {
                Ok(worker) => {
                    let doing = Doing::Open(Box::new(opening), Box::new(Stage::Load(candidate)));
                    self.wait_for(id, worker, doing);
                    return Ok(());
                }
                Err(failure) => opening.note(failure, &candidate),
            }
        }
    }

    /// Finds more files to try.
    ///
    /// # Errors
    /// No files are left.
    fn search_on(&mut self, opening: &mut Opening) -> Result<(), Fault> {
        let Opening { planner, search, first_fault, candidates, .. } = opening;
        if let Some(files) = self.catalog.search_on(planner, search, first_fault.is_none()) {
            *candidates = files;
            return Ok(());
        }
        let not_found = || fault::new(planner, During::Load, Cause::Refused, self.catalog.not_found(planner));
        Err(first_fault.take().unwrap_or_else(not_found))
    }

    /// Starts a worker and asks it to load a file.
    fn load(&self, candidate: &Candidate, planner: &str) -> Result<Worker, Failure> {
        let (memory_limit_bytes, requires_sandbox) =
            (self.config.memory_limit_bytes, self.catalog.requires_sandbox());
        let mut worker = Worker::spawn(&self.config.worker_command, memory_limit_bytes)?;
        let load = Load::of(&candidate.path, planner, memory_limit_bytes, requires_sandbox);
        worker.ask(kind::LOAD, self.config.load_deadline, |w| load.write(w))?;
        Ok(worker)
    }

    /// Keeps an ask open until its worker has answered.
    fn wait_for(&mut self, id: AskId, worker: Worker, doing: Doing) {
        if let Some(planner) = self.planners.iter_mut().find(|planner| planner.id == id.worker) {
            planner.worker = Some(worker);
            planner.asked = Some(Asked { id, at: Instant::now(), doing });
        }
    }

    /// Processes the outcome of a stage and begins the next one.
    pub(in crate::host) fn go_on_opening(
        &mut self,
        id: AskId,
        opening: Opening,
        stage: Stage,
        outcome: Result<(), Failure>,
    ) {
        let planner = self.planners.iter_mut().find(|planner| planner.id == id.worker);
        let Some(mut worker) = planner.and_then(|planner| planner.worker.take()) else { return };
        let begun = match stage {
            Stage::Load(candidate) => {
                let answer = outcome.and_then(|()| worker.take_planners());
                self.configure(id, worker, opening, candidate, answer)
            }
            Stage::Configure(loaded) => {
                let answer = outcome.and_then(|()| worker.take_answer(whole::<Answered<()>>));
                let answer = answer.map(|answered| answered.said);
                self.restore(id, worker, opening, loaded, answer)
            }
            Stage::Restore(loaded, said) => {
                let answer = outcome.and_then(|()| worker.take_answer(whole::<()>));
                match unless_refused(answer.map_err(|failure| loaded.fault(failure, Phase::State))) {
                    Ok(_) => {
                        self.opened(id, worker, opening, loaded, said);
                        Ok(())
                    }
                    Err(fault) => self.part(worker, fault),
                }
            }
        };
        self.close_unless(begun, id);
    }

    /// Shuts down a worker whose planner cannot be opened.
    fn part(&mut self, mut worker: Worker, fault: Fault) -> Result<(), Fault> {
        self.remains = Some(worker.remains());
        self.dismiss(&fault.planner, worker);
        Err(fault)
    }

    /// Creates the planner if the worker has loaded it; otherwise tries the next file.
    fn configure(
        &mut self,
        id: AskId,
        mut worker: Worker,
        mut opening: Opening,
        candidate: Candidate,
        answer: Result<(Sealed, Vec<Described>), Failure>,
    ) -> Result<(), Fault> {
        let found = answer.map(|(sealed, planners)| {
            let planner = planners.iter().find(|planner| planner.id == opening.planner);
            planner.map(|planner| Loaded::new(planner, &sealed, &candidate.name))
        });
        let loaded = match found {
            Ok(Some(loaded)) => loaded,
            other => {
                self.remains = other.is_err().then(|| worker.remains());
                self.dismiss("", worker);
                if let Err(failure) = other {
                    opening.note(failure, &candidate);
                }
                return self.load_next(id, opening);
            }
        };
        // If an earlier file failed, it may work next time, so this file is not remembered as the first one.
        let first = opening.first_fault.is_none().then_some(candidate);
        self.catalog.learn(&loaded.info.id, first);
        self.create(id, worker, opening, loaded)
    }

    /// Creates the planner in a worker that has loaded it.
    fn create(
        &mut self,
        id: AskId,
        mut worker: Worker,
        opening: Opening,
        loaded: Loaded,
    ) -> Result<(), Fault> {
        let info = &loaded.info;
        let values = parameters::numbers(info, &opening.parameters);
        let values = values.map_err(|message| fault::of_parameters(&info.id, Phase::Configure, message));
        let values = match values {
            Ok(values) => values,
            Err(fault) => return self.part(worker, loaded.blamed(fault)),
        };
        let write = |w: &mut Writer| {
            w.put(&values).written(&opening.site.bytes);
        };
        match worker.ask(kind::CONFIGURE, self.config.configure_deadline, write) {
            Ok(()) => {
                let doing = Doing::Open(Box::new(opening), Box::new(Stage::Configure(loaded)));
                self.wait_for(id, worker, doing);
                Ok(())
            }
            Err(failure) => self.part_or_load_again(id, worker, opening, &loaded, failure),
        }
    }

    /// Handles a planner that could not be created. If the process has served an earlier mission, the cause may be an
    /// instance from that mission that did not end cleanly. The new mission must not suffer from that, so the planner
    /// is loaded again in a new process.
    fn part_or_load_again(
        &mut self,
        id: AskId,
        worker: Worker,
        opening: Opening,
        loaded: &Loaded,
        failure: Failure,
    ) -> Result<(), Fault> {
        if !loaded.is_reused || !failure.has_ended_the_process() {
            return self.part(worker, loaded.fault(failure, Phase::Configure));
        }
        self.dismiss(&loaded.info.id, worker);
        self.kept.note_bad_end(BadEnd { planner: loaded.info.id.clone(), how: failure.how() });
        self.load_next(id, opening)
    }

    /// Restores an earlier planner's state in a new planner, if there is a state that fits.
    fn restore(
        &mut self,
        id: AskId,
        mut worker: Worker,
        opening: Opening,
        loaded: Loaded,
        answer: Result<Said, Failure>,
    ) -> Result<(), Fault> {
        let said = match answer {
            Ok(said) => said,
            Err(failure) => return self.part_or_load_again(id, worker, opening, &loaded, failure),
        };
        let fitting = |ask| self.saved.fitting(ask, &loaded.info, loaded.state_version);
        let Some(state) = opening.restore.and_then(fitting) else {
            self.opened(id, worker, opening, loaded, said);
            return Ok(());
        };
        let write = |w: &mut Writer| {
            w.put(&loaded.state_version).written(state);
        };
        match worker.ask(kind::RESTORE, self.config.state_deadline, write) {
            Ok(()) => {
                let doing = Doing::Open(Box::new(opening), Box::new(Stage::Restore(loaded, said)));
                self.wait_for(id, worker, doing);
                Ok(())
            }
            Err(failure) => self.part(worker, loaded.fault(failure, Phase::State)),
        }
    }

    /// Marks the planner as ready and answers the ask.
    fn opened(&mut self, id: AskId, worker: Worker, opening: Opening, loaded: Loaded, said: Said) {
        let info = Box::new(loaded.info.clone());
        if let Some(planner) = self.planners.iter_mut().find(|planner| planner.id == id.worker) {
            planner.ready = Some(Ready::new(loaded, opening.parameters, opening.site.limits));
            planner.worker = Some(worker);
        }
        self.answer(id, Ok((Given::Opened(info), said)));
    }
}
