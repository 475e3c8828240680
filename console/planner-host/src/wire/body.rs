//! Writes frames and reads their bodies. Bodies are encoded with `postcard`: the fields in order, without names.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// A frame under construction.
#[derive(Debug, Default)]
pub(crate) struct Writer(Vec<u8>);

impl Writer {
    /// Begins a frame and discards the previous one.
    pub(crate) fn begin(&mut self, kind: u8, sequence: u32, soft_deadline_us: u32) -> &mut Self {
        self.0.clear();
        self.written(&0_u32.to_le_bytes()).written(&[kind]);
        self.written(&sequence.to_le_bytes()).written(&soft_deadline_us.to_le_bytes())
    }

    /// Returns the finished frame, or its length if that exceeds the limit.
    pub(crate) fn finish(&mut self) -> Result<&[u8], usize> {
        let length = self.0.len() - size_of::<u32>();
        if length > super::LONGEST {
            return Err(length);
        }
        self.0[..size_of::<u32>()].copy_from_slice(&(length as u32).to_le_bytes());
        Ok(&self.0)
    }

    /// Returns the frame that was finished last.
    pub(crate) fn frame(&self) -> &[u8] {
        &self.0
    }

    /// Returns what was written, without a frame around it.
    pub(crate) fn into_bytes(self) -> Vec<u8> {
        self.0
    }

    /// Appends raw bytes; the other side reads them as the rest of the body.
    pub(crate) fn written(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.extend_from_slice(bytes);
        self
    }

    /// Appends a value.
    pub(crate) fn put(&mut self, value: &(impl Serialize + ?Sized)) -> &mut Self {
        let so_far = std::mem::take(&mut self.0);
        self.0 = postcard::to_extend(value, so_far).expect("every array in a message has a known length");
        self
    }
}

/// The body does not match its kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Malformed;

/// The rest of a body that is being read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Body<'a>(pub(crate) &'a [u8]);

/// The result of reading from the body of a frame.
pub(crate) type Read<T> = Result<T, Malformed>;

impl<'a> Body<'a> {
    /// Reads a value and advances past it.
    pub(crate) fn take<T: Deserialize<'a>>(&mut self) -> Read<T> {
        let (value, rest) = postcard::take_from_bytes(self.0).map_err(|_| Malformed)?;
        self.0 = rest;
        Ok(value)
    }
}

/// Reads the entire body as one value.
pub(crate) fn whole<T: DeserializeOwned>(mut body: Body<'_>) -> Read<T> {
    let value = body.take()?;
    if body.0.is_empty() { Ok(value) } else { Err(Malformed) }
}
