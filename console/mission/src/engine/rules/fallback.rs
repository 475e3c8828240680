//! After a fault of the active planner, the fallback planner takes over, but only once.

use crate::{config::MissionConfig, phase::Resumes, planner::PlannerChoice};

/// Whether the fallback has already been used.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct FallbackRule {
    used: bool,
}

impl FallbackRule {
    fn available<'a>(&self, config: &'a MissionConfig, active: &str) -> Option<&'a PlannerChoice> {
        config.fallback.as_ref().filter(|choice| !self.used && choice.id != active)
    }

    /// Whether a hold caused by this planner ends automatically.
    pub(crate) fn resumes(&self, config: &MissionConfig, active: &str) -> Resumes {
        match self.available(config, active) {
            Some(_) => Resumes::ByFallback,
            None => Resumes::Never,
        }
    }

    /// The planner that takes over from this one; returned at most once.
    pub(crate) fn update(&mut self, config: &MissionConfig, active: &str) -> Option<PlannerChoice> {
        let choice = self.available(config, active)?.clone();
        self.used = true;
        Some(choice)
    }
}
