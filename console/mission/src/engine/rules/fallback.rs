//! After a fault of the planner another one may take over, once.

use crate::{config::MissionConfig, phase::Resumes, planner::PlannerChoice};

/// Whether the automatic replacement after a fault has been used.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct FallbackRule {
    used: bool,
}

impl FallbackRule {
    fn available<'a>(&self, config: &'a MissionConfig, active: &str) -> Option<&'a PlannerChoice> {
        config.fallback.as_ref().filter(|choice| !self.used && choice.id != active)
    }

    /// Whether a hold because of this planner ends by itself.
    pub(crate) fn resumes(&self, config: &MissionConfig, active: &str) -> Resumes {
        match self.available(config, active) {
            Some(_) => Resumes::ByFallback,
            None => Resumes::Never,
        }
    }

    /// The planner that takes over from this one; it does so once.
    pub(crate) fn update(&mut self, config: &MissionConfig, active: &str) -> Option<PlannerChoice> {
        let choice = self.available(config, active)?.clone();
        self.used = true;
        Some(choice)
    }
}
