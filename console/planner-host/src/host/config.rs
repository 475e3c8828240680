//! Budgets and limits of planners.

use crate::supervisor::WorkerCommand;
use crate::survey::{LOAD_WITHIN, MEMORY_LIMIT};
use std::time::Duration;

/// Budgets and limits of planners.
///
/// Budgets are charged by a fair clock: a planner that computes pays for the processor time that it gets, one that waits
/// pays for the time that passes.
#[derive(Debug, Clone, PartialEq)]
pub struct HostConfig {
    /// How workers are started.
    pub worker_command: WorkerCommand,
    /// For loading a library.
    pub load_deadline: Duration,
    /// For making a planner, or giving it new values.
    pub configure_deadline: Duration,
    /// For a plan.
    pub plan_deadline: Duration,
    /// For a command.
    pub step_deadline: Duration,
    /// For saving or restoring a planner's private state.
    pub state_deadline: Duration,
    /// Address space of a worker, bytes.
    pub memory_limit_bytes: u64,
    /// Whether drawings are shown.
    pub wants_drawing: bool,
}

impl HostConfig {
    /// The usual budgets, with this one for a command.
    pub fn new(step_deadline: Duration) -> Self {
        Self {
            worker_command: WorkerCommand::default(),
            load_deadline: LOAD_WITHIN,
            configure_deadline: Duration::from_secs(1),
            plan_deadline: Duration::from_secs(5),
            step_deadline,
            state_deadline: Duration::from_millis(100),
            memory_limit_bytes: MEMORY_LIMIT,
            wants_drawing: true,
        }
    }
}

impl Default for HostConfig {
    /// With two seconds for a command: a planner that takes longer is not late but hangs.
    fn default() -> Self {
        Self::new(Duration::from_secs(2))
    }
}
