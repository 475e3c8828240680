//! Planner plugins: discovery, checks before loading, loader, worker process, supervisor.
