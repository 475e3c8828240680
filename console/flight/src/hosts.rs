//! The host for the planners of a scenario, and its measurements.

use account::PlannerCalls;
use mission::{MissionConfig, TaskConfig};
use planner_host::{Host, HostConfig, PluginDirs};
use scenario::Scenario;
use std::time::Duration;

/// Time limit for a plan that covers the whole floor.
const COVER_WITHIN: Duration = Duration::from_mins(1);
/// Memory limit for such a plan: large floors have many cells.
const COVER_MEMORY_BYTES: u64 = 1 << 30;

/// Creates a host for the planners of a scenario.
pub fn host(scenario: &Scenario, plugins: &PluginDirs) -> Host {
    Host::new(plugins, config(&scenario.mission))
}

/// The limits of planners in a mission: a plan for a whole floor needs more time and memory than a path to a point.
pub fn config(mission: &MissionConfig) -> HostConfig {
    let config = HostConfig::default();
    match mission.task {
        TaskConfig::Cover { .. } => {
            HostConfig { plan_deadline: COVER_WITHIN, memory_limit_bytes: COVER_MEMORY_BYTES, ..config }
        }
        TaskConfig::Goto { .. } | TaskConfig::Follow { .. } | TaskConfig::Survey { .. } => config,
    }
}

/// Wall-clock figures about the calls to planners.
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
