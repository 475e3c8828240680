//! The console's services, called through the C ABI.

use crate::abi::{self, Host, Str};
use crate::{Drawing, Leg, LogLevel, Services, StopReason};
use nalgebra::Point2;
use std::time::Duration;

/// A copy of the console's table of services; functions that an older console lacks are not called.
pub(super) struct HostServices(Host);

/// The maximum number of drawings passed in one call.
const BATCH: usize = 32;

impl HostServices {
    /// Copies the console's table.
    ///
    /// # Safety
    /// `host` points to a table that remains valid while `self` is used.
    pub(super) unsafe fn read(host: *const Host) -> Self {
        // SAFETY: promised by the caller.
        Self(unsafe { abi::copy_sized(host) })
    }

    /// Reports the sentence of a refusal.
    pub(super) fn error(&self, message: &str) {
        if let Some(error) = self.0.error {
            // SAFETY: the console copies the text before it returns, as everywhere below.
            unsafe { error(self.0.ctx, message.as_ptr(), message.len()) }
        }
    }

    /// Declares a parameter.
    pub(super) fn param(&self, param: &abi::Param) {
        if let Some(take) = self.0.param {
            // SAFETY: copied before it returns.
            unsafe { take(self.0.ctx, param) }
        }
    }

    /// Passes points of a path.
    pub(super) fn points(&self, points: &[Point2<f64>]) {
        if let (Some(take), false) = (self.0.points, points.is_empty()) {
            // SAFETY: copied before it returns; a point is two doubles, as `abi` asserts.
            unsafe { take(self.0.ctx, points.as_ptr().cast(), points.len()) }
        }
    }

    /// Passes the purpose of each stretch of the path.
    pub(super) fn legs(&self, legs: &[Leg]) {
        if let (Some(take), false) = (self.0.legs, legs.is_empty()) {
            let raw: Vec<abi::Leg> = legs.iter().map(abi::Leg::from).collect();
            // SAFETY: copied before it returns.
            unsafe { take(self.0.ctx, raw.as_ptr(), raw.len()) }
        }
    }

    /// Passes one cut, a line that the robot must never cross.
    pub(super) fn cut(&self, line: &[Point2<f64>]) {
        if let Some(take) = self.0.cut {
            // SAFETY: copied before it returns; a point is two doubles, as `abi` asserts.
            unsafe { take(self.0.ctx, line.as_ptr().cast(), line.len()) }
        }
    }

    /// Passes private state.
    pub(super) fn bytes(&self, bytes: &[u8]) {
        if let Some(take) = self.0.bytes {
            // SAFETY: copied before it returns.
            unsafe { take(self.0.ctx, bytes.as_ptr(), bytes.len()) }
        }
    }
}

impl Services for HostServices {
    fn stop(&self) -> Option<StopReason> {
        // SAFETY: calls the console's own function with the console's own pointer, as everywhere below.
        match self.0.should_stop.map_or(0, |ask| unsafe { ask(self.0.ctx) }) {
            0 => None,
            2 => Some(StopReason::Timeout),
            _ => Some(StopReason::Cancelled),
        }
    }

    fn time_left(&self) -> Duration {
        // SAFETY: as above.
        let seconds = self.0.time_left_s.map_or(f64::INFINITY, |ask| unsafe { ask(self.0.ctx) });
        Duration::try_from_secs_f64(seconds.max(0.0)).unwrap_or(Duration::MAX)
    }

    fn wants_drawing(&self) -> bool {
        // SAFETY: as above.
        self.0.wants_drawing.is_some_and(|ask| unsafe { ask(self.0.ctx) } != 0)
    }

    fn draw(&self, drawings: &[Drawing]) {
        let Some(take) = self.0.draw else { return };
        for batch in drawings.chunks(BATCH) {
            let mut raw = [const { UNDRAWN }; BATCH];
            raw.iter_mut().zip(batch).for_each(|(raw, drawing)| *raw = drawing.into());
            // SAFETY: copied before it returns.
            unsafe { take(self.0.ctx, raw.as_ptr(), batch.len()) }
        }
    }

    fn scalar(&self, name: &str, value: f64, unit: &str) {
        if let Some(take) = self.0.scalar {
            // SAFETY: copied before it returns.
            unsafe { take(self.0.ctx, Str::of(name), value, Str::of(unit)) }
        }
    }

    fn progress(&self, share: f64, what: &str) {
        if let Some(take) = self.0.progress {
            // SAFETY: copied before it returns.
            unsafe { take(self.0.ctx, share, what.as_ptr(), what.len()) }
        }
    }

    fn log(&self, level: LogLevel, message: &str) {
        if let Some(take) = self.0.log {
            // SAFETY: copied before it returns.
            unsafe { take(self.0.ctx, level as u32, message.as_ptr(), message.len()) }
        }
    }
}

const UNDRAWN: abi::Draw = {
    let zero = abi::Vec2 { x: 0.0, y: 0.0 };
    abi::Draw { kind: 0, layer: 0, a: zero, b: zero, value: 0.0 }
};
