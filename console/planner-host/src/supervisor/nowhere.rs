//! Systems without Unix sockets have no workers.

use super::{Failure, WorkerCommand};
use crate::OnProgress;
use crate::wire::body::{Body, Read, Writer};
use std::sync::{Arc, atomic::AtomicBool};
use std::time::Duration;

/// Never made.
pub(crate) enum Worker {}

impl Worker {
    pub(crate) fn spawn(_: &WorkerCommand) -> Result<Self, Failure> {
        Err(Failure::Console("planners run on Linux and macOS only so far".to_owned()))
    }

    pub(crate) fn is_gone(&self) -> bool {
        match *self {}
    }

    pub(crate) fn ask<T>(
        &mut self,
        _: u8,
        _: Duration,
        _: impl FnOnce(&mut Writer),
        _: impl FnOnce(&mut Body<'_>) -> Read<T>,
    ) -> Result<T, Failure> {
        match *self {}
    }

    pub(crate) fn stop_on(&mut self, _: Arc<AtomicBool>) {
        match *self {}
    }

    pub(crate) fn tell_progress(&mut self, _: OnProgress) {
        match *self {}
    }

    pub(crate) fn kill(&mut self) {
        match *self {}
    }
}
