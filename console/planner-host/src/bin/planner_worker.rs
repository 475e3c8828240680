//! The worker as a separate program, for this crate's tests; the console runs a copy of itself instead.

fn main() -> std::process::ExitCode {
    planner_host::worker_main()
}
