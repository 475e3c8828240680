//! A host for the planners of a scenario, and what it measured.

use account::PlannerCalls;
use mission::{MissionConfig, TaskConfig};
use planner_host::{Host, HostConfig, PluginDirs};
use scenario::Scenario;
use std::time::Duration;

/// Time that a planner may take for a plan of the whole floor.
const COVER_WITHIN: Duration = Duration::from_mins(1);
/// Memory that it may use for it: large floors have many cells.
const COVER_MEMORY_BYTES: u64 = 1 << 30;

/// A host for the planners of a scenario.
pub fn host(scenario: &Scenario, plugins: &PluginDirs) -> Host {
    Host::new(plugins, config(&scenario.mission))
}

/// What planners are given for a mission: a plan for a whole floor takes longer than a way to a point, and more memory.
pub fn config(mission: &MissionConfig) -> HostConfig {
    let config = HostConfig::default();
    match mission.task {
        TaskConfig::Cover { .. } => {
            HostConfig { plan_deadline: COVER_WITHIN, memory_limit_bytes: COVER_MEMORY_BYTES, ..config }
        }
        TaskConfig::Goto { .. } | TaskConfig::Follow { .. } => config,
    }
}

/// Figures about the planners' calls, by the wall clock.
pub fn calls(host: &Host) -> PlannerCalls {
    let stats = host.stats();
    PlannerCalls {
        plan: stats.plan.calls,
        step: stats.step.calls,
        p50_us: stats.step.p50_us,
        p99_us: stats.step.p99_us,
        faults: stats.faults,
    }
}
