//! The faults: one function for each fault that takes more than one line.

use nalgebra::Point2;
use planner_api::{Code, Ctx, Layer, PlannerError, Result};
use std::hint::{black_box, spin_loop};
use std::time::Duration;

/// All faults.
pub(crate) const FAULTS: &[&str] = &[
    "none",
    "panic",
    "panic_payload",
    "thread_panic",
    "drop_panic",
    "error",
    "segv",
    "abort",
    "exit",
    "kill",
    "stop",
    "stack",
    "alloc",
    "hang",
    "sleep",
    "slow",
    "nap",
    "dawdle",
    "nan",
    "huge",
    "draw_flood",
    "print_flood",
    "close_fds",
    "configure_panic",
    "configure_hang",
    "plan_panic",
    "plan_hang",
    "plan_nap",
    "plan_long",
    "plan_progress",
    "replan_hang",
    "replan_long",
];

/// A sleep that is longer than a tick of the usual length, but is not a fault.
const NAP: Duration = Duration::from_millis(150);
/// A delay that fits within a tick of the usual length, but adds up to seconds over a mission.
const DAWDLE: Duration = Duration::from_millis(50);
/// A delay that is long enough for an operator to act meanwhile.
const LONG: Duration = Duration::from_millis(2500);

/// Whether a fault happens only once; the other faults recur in every later step.
pub(crate) fn happens_once(kind: &str) -> bool {
    kind == "nap"
}

/// Commits the fault with this name. Returns only if the process survives the fault.
pub(crate) fn commit(kind: &str, ctx: &Ctx<'_>) -> Result<()> {
    match kind {
        "panic" => look_up_nothing(),
        "panic_payload" => std::panic::panic_any(42_u8),
        "thread_panic" => return panic_elsewhere(),
        "error" => return Err(PlannerError::new(Code::Stuck, "a local minimum, as ordered")),
        "segv" => process::write_to_nowhere(),
        "abort" => std::process::abort(),
        "exit" => std::process::exit(0),
        "kill" => process::raise_signal(process::SIGKILL),
        "stop" => process::raise_signal(process::SIGSTOP),
        "stack" => {
            black_box(deeper(0));
        }
        "alloc" => hoard(),
        "hang" => spin(),
        "sleep" => std::thread::sleep(Duration::from_hours(1)),
        "slow" => return work_politely(ctx),
        "nap" => std::thread::sleep(NAP),
        "dawdle" => std::thread::sleep(DAWDLE),
        "long" => std::thread::sleep(LONG),
        "draw_flood" => draw_flood(ctx),
        "print_flood" => print_flood(),
        "progress" => report_progress_endlessly(ctx),
        "close_fds" => process::close_everything(),
        _ => {}
    }
    Ok(())
}

fn look_up_nothing() {
    let nothing: Vec<f64> = black_box(Vec::new());
    black_box(nothing[7]);
}

fn panic_elsewhere() -> Result<()> {
    let thread = std::thread::spawn(|| panic!("a panic in a thread of the planner"));
    thread.join().map_err(|_| PlannerError::new(Code::Internal, "a thread of the planner panicked"))
}

#[expect(unconditional_recursion, reason = "using up the stack is the point")]
#[inline(never)]
fn deeper(depth: u64) -> u64 {
    let frame = black_box([depth; 64]);
    let below = deeper(depth + 1);
    black_box(&frame)[(depth % 64) as usize] + below
}

fn hoard() {
    let mut hoard: Vec<Vec<u8>> = Vec::new();
    loop {
        // Never written to, so the memory limit is reached before the deadline even on a slow machine.
        hoard.push(Vec::with_capacity(64 << 20));
        black_box(&hoard);
    }
}

fn spin() {
    while black_box(true) {
        spin_loop();
    }
}

fn work_politely(ctx: &Ctx<'_>) -> Result<()> {
    loop {
        ctx.check()?;
        std::thread::sleep(Duration::from_micros(200));
    }
}

fn draw_flood(ctx: &Ctx<'_>) {
    let line = vec![Point2::origin(); 1001];
    for _ in 0..100 {
        ctx.polyline(Layer::Other, &line);
    }
}

fn report_progress_endlessly(ctx: &Ctx<'_>) {
    for round in 0_u64.. {
        ctx.progress(0.999, &format!("almost done, round {round}"));
    }
}

#[expect(clippy::print_stdout, clippy::print_stderr, reason = "spamming the terminal is the point")]
fn print_flood() {
    for i in 0..5000 {
        println!("\x1b[2Jspam {i}");
        eprintln!("\x1b[31mmore spam {i}");
    }
}

#[cfg(unix)]
mod process {
    //! The faults that need unsafe code. The signal numbers are those of Linux; SIGSTOP has a different number on
    //! macOS.

    pub(super) const SIGKILL: i32 = 9;
    pub(super) const SIGSTOP: i32 = if cfg!(target_os = "macos") { 17 } else { 19 };

    unsafe extern "C" {
        fn raise(signal: i32) -> i32;
        fn close(fd: i32) -> i32;
    }

    pub(super) fn raise_signal(signal: i32) {
        // SAFETY: raising a signal touches no memory.
        unsafe { raise(signal) };
    }

    pub(super) fn write_to_nowhere() {
        // SAFETY: none; the invalid write is intended.
        unsafe { std::ptr::without_provenance_mut::<u32>(8).write_volatile(1) };
    }

    pub(super) fn close_everything() {
        for fd in 0..1024 {
            // SAFETY: none for the owners of these descriptors; this is intended.
            unsafe { close(fd) };
        }
    }
}

#[cfg(not(unix))]
mod process {
    //! On other systems these faults simply abort.

    pub(super) const SIGKILL: i32 = 9;
    pub(super) const SIGSTOP: i32 = 19;

    pub(super) fn raise_signal(_: i32) {
        std::process::abort()
    }

    pub(super) fn write_to_nowhere() {
        std::process::abort()
    }

    pub(super) fn close_everything() {
        std::process::abort()
    }
}
