//! The console's clock towards a vehicle.

use rustix::time::{ClockId, Timespec, clock_gettime};

/// The clock that goes on while the computer is suspended; on other systems than Linux, it is the monotonic one.
#[cfg(target_os = "linux")]
const CLOCK: ClockId = ClockId::Boottime;
#[cfg(not(target_os = "linux"))]
const CLOCK: ClockId = ClockId::Monotonic;

/// The beginning of a connection. The clock goes on while the computer is suspended, for example behind a closed lid:
/// otherwise, all stamps would be wrong by that time afterwards, and the time in which no command was sent would be
/// unknown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Began(f64);

impl Began {
    pub(crate) fn now() -> Self {
        Self(now_s())
    }

    /// Time since then, seconds.
    pub(crate) fn elapsed_s(self) -> f64 {
        now_s() - self.0
    }
}

fn now_s() -> f64 {
    let Timespec { tv_sec, tv_nsec } = clock_gettime(CLOCK);
    tv_sec as f64 + tv_nsec as f64 * 1e-9
}
