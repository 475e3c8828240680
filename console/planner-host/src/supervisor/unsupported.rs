//! Systems without Unix sockets have no workers.

use super::{Failure, WorkerCommand};
use crate::Progress;
use crate::wire::body::{Body, Read, Writer};
use std::time::{Duration, Instant};

/// Never made.
pub(crate) enum Worker {}

impl Worker {
    pub(crate) fn spawn(_: &WorkerCommand) -> Result<Self, Failure> {
        Err(Failure::Console("planners run on Linux and macOS only so far".to_owned()))
    }

    pub(crate) fn is_gone(&self) -> bool {
        match *self {}
    }

    pub(crate) fn is_idle(&self) -> bool {
        match *self {}
    }

    pub(crate) fn ask(&mut self, _: u8, _: Duration, _: impl FnOnce(&mut Writer)) -> Result<(), Failure> {
        match *self {}
    }

    pub(crate) fn advance(
        &mut self,
        _: Ready,
        _: Instant,
        _: &mut dyn FnMut(&Progress),
    ) -> Option<Result<(), Failure>> {
        match *self {}
    }

    pub(crate) fn take_answer<T>(&mut self, _: impl FnOnce(&mut Body<'_>) -> Read<T>) -> Result<T, Failure> {
        match *self {}
    }

    pub(crate) fn shut_down(&mut self) {
        match *self {}
    }

    pub(crate) fn kill(&mut self) {
        match *self {}
    }
}

/// Nothing ever happens.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Ready;

/// Without workers nobody waits.
pub(crate) fn wait<'a>(
    _: Option<&WakeReceiver>,
    _: impl Iterator<Item = &'a Worker> + Clone,
    _: Option<Instant>,
    _: &mut Vec<Ready>,
) -> bool {
    false
}

/// There is no worker to wait for.
pub(crate) fn wait_for_one(worker: &Worker, _: Option<Instant>) -> Ready {
    match *worker {}
}

/// Has nobody to wake.
#[derive(Debug, Clone)]
pub struct Waker;

impl Waker {
    /// Does nothing.
    pub fn wake(&self) {}
}

/// The receiving end of a [`Waker`].
pub(crate) struct WakeReceiver;

impl WakeReceiver {
    pub(crate) fn new() -> Self {
        Self
    }

    pub(crate) fn waker(&self) -> Waker {
        Waker
    }

    pub(crate) fn take(&self) -> bool {
        false
    }
}
