//! Budgets and limits of planners.

use crate::supervisor::WorkerCommand;
use crate::survey::{LOAD_WITHIN, MEMORY_LIMIT};
use std::time::Duration;

/// Budgets and limits of planners.
///
/// Budgets are charged according to a fair clock: a planner that computes is charged the processor time that it gets,
/// and a planner that waits is charged the time that passes.
#[derive(Debug, Clone, PartialEq)]
pub struct HostConfig {
    /// The command that starts a worker.
    pub worker_command: WorkerCommand,
    /// Budget for loading a library.
    pub load_deadline: Duration,
    /// Budget for creating or reconfiguring a planner.
    pub configure_deadline: Duration,
    /// Budget for a plan.
    pub plan_deadline: Duration,
    /// Budget for a command.
    pub step_deadline: Duration,
    /// Budget for saving or restoring a planner's private state.
    pub state_deadline: Duration,
    /// Address space of a worker, bytes.
    pub memory_limit_bytes: u64,
    /// Whether drawings are shown.
    pub wants_drawing: bool,
}

impl HostConfig {
    /// Uses the default budgets, except that a command has this one.
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
    /// A command has two seconds: a planner that takes longer is regarded as hung rather than late.
    fn default() -> Self {
        Self::new(Duration::from_secs(2))
    }
}
