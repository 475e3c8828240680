//! A planner that is being opened, and the data that it takes from stage to stage.

mod stages;

use super::find::{Candidate, Search};
use super::saved::Saved;
use super::{fault, fault::Phase};
use crate::supervisor::Failure;
use crate::survey::info;
use crate::wire::answer::{self, Said};
use crate::wire::body::Writer;
use mission::{AskId, Fault, Parameters, PlannerInfo};
use planner_api::{Limits, Site};
use std::collections::VecDeque;

/// A planner that is being opened.
pub(crate) struct Opening {
    planner: String,
    parameters: Parameters,
    site: WrittenSite,
    restore: Option<AskId>,
    /// Plugin files that have not been tried yet.
    candidates: VecDeque<Candidate>,
    search: Search,
    /// The fault to report if no file contains the planner.
    first_fault: Option<Fault>,
}

/// The last request to a planner that is being opened.
pub(super) enum Stage {
    /// Load this file.
    Load(Candidate),
    /// Create the planner.
    Configure(Loaded),
    /// Restore an earlier state; the value is what the planner logged and drew when it was created.
    Restore(Loaded, Said),
}

impl Stage {
    pub(super) fn phase(&self) -> Phase {
        match self {
            Self::Load(_) => Phase::Load,
            Self::Configure(_) => Phase::Configure,
            Self::Restore(..) => Phase::State,
        }
    }
}

/// A planner whose plugin is loaded.
pub(super) struct Loaded {
    pub(super) info: PlannerInfo,
    state_version: u32,
    /// Whether its process has already served an earlier mission.
    is_reused: bool,
}

/// The site, serialised for the worker.
struct WrittenSite {
    bytes: Vec<u8>,
    limits: Limits,
}

impl WrittenSite {
    fn of(site: &Site<'_>) -> Self {
        let mut writer = Writer::default();
        writer.put(site);
        Self { bytes: writer.into_bytes(), limits: site.limits }
    }
}

impl Opening {
    /// Creates the state in which no file has been tried yet.
    pub(crate) fn new(
        planner: &str,
        parameters: &Parameters,
        site: &Site<'_>,
        restore: Option<AskId>,
    ) -> Self {
        Self {
            planner: planner.to_owned(),
            parameters: parameters.clone(),
            site: WrittenSite::of(site),
            restore,
            candidates: VecDeque::new(),
            search: Search::default(),
            first_fault: None,
        }
    }

    /// Notes that a file could not be loaded. The remaining files are still tried; the fault is reported if none
    /// contains the planner.
    fn note(&mut self, failure: Failure, candidate: &Candidate) {
        let fault = fault::of(failure, &self.planner, Phase::Load);
        // While a library is loading, the plugin is to blame rather than one of its planners.
        let (planner, plugin) = (format!("planner {} ", self.planner), format!("plugin {} ", candidate.name));
        let message = fault.message.replacen(&planner, &plugin, 1);
        let plugin_sha256 = Some(candidate.sha256.clone());
        self.first_fault.get_or_insert(Fault { message, plugin_sha256, ..fault });
    }
}

impl Loaded {
    fn new(planner: &answer::Described, sealed: &answer::Sealed, plugin: &str) -> Self {
        Self { info: info(planner, sealed, plugin), state_version: planner.state_version, is_reused: false }
    }

    /// Packs the planner's private state with the ask for which it was saved.
    pub(super) fn saved(&self, ask: AskId, state: Vec<u8>) -> Saved {
        let (planner, sha256) = (self.info.id.clone(), self.info.sha256.clone());
        Saved { ask, planner, sha256, version: self.state_version, state }
    }

    fn fault(&self, failure: Failure, phase: Phase) -> Fault {
        self.blamed(fault::of(failure, &self.info.id, phase))
    }

    fn blamed(&self, fault: Fault) -> Fault {
        Fault { plugin_sha256: Some(self.info.sha256.clone()), ..fault }
    }
}
