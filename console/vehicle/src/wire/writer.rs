//! Turns messages into bytes.

use super::{check::Misfit, reader::Incoming};
use serde::Serialize;

/// Writes one direction of the wire. A message must pass the checks of the other side.
#[derive(Debug, Clone)]
pub struct Writer<M: Incoming> {
    session: M::Session,
}

impl<M: Incoming + Serialize> Writer<M> {
    /// A writer for a new connection.
    pub fn new(session: M::Session) -> Self {
        Self { session }
    }

    /// Appends the line of a message, with its line feed.
    ///
    /// # Errors
    /// If a value is out of bounds; nothing is appended then.
    pub fn write(&mut self, message: &M, line: &mut Vec<u8>) -> Result<(), Misfit> {
        message.check(&mut self.session)?;
        serde_json::to_writer(&mut *line, message).expect("plain structs, into memory");
        line.push(b'\n');
        Ok(())
    }
}
