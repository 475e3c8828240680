//! The worker as a program of its own, for this crate's tests; the console re-executes itself instead.

fn main() -> std::process::ExitCode {
    planner_host::worker_main()
}
