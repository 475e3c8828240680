//! The worker alone, for the tests of this crate; the console re-executes itself instead.

fn main() -> std::process::ExitCode {
    planner_host::worker_main()
}
