//! Requests. What a planner is asked to plan or to decide is [`planner_api::message`]: written as it is lent, read as it is owned.

use super::VERSION;
use super::body::{Body, Read, Writer, whole};
use crate::checks::limits;
use serde::{Deserialize, Serialize};
use std::ffi::OsStr;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::path::Path;

/// To load a library, and to keep the planner of this id, or to describe all planners for an empty id.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Load {
    pub(crate) memory_limit_bytes: u64,
    pub(crate) requires_sandbox: bool,
    /// As the system has it, which need not be UTF-8.
    path: Vec<u8>,
    #[serde(deserialize_with = "limits::text")]
    pub(crate) id: String,
}

impl Load {
    /// Of the library at this path.
    pub(crate) fn of(path: &Path, id: &str, memory_limit_bytes: u64, requires_sandbox: bool) -> Self {
        // What is recorded of it is replayed from anywhere.
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let path = path.into_os_string().into_vec();
        Self { memory_limit_bytes, requires_sandbox, path, id: id.to_owned() }
    }

    /// Where the library is.
    pub(crate) fn path(&self) -> &Path {
        Path::new(OsStr::from_bytes(&self.path))
    }

    /// Writes it behind the version, which is read by every build.
    pub(crate) fn write(&self, w: &mut Writer) {
        w.put(&VERSION).put(self);
    }

    /// Reads it; none if another build has written it.
    pub(crate) fn read(mut body: Body<'_>) -> Read<Option<Self>> {
        if body.take::<u32>()? != VERSION {
            return Ok(None);
        }
        whole(body).map(Some)
    }
}

/// Values of parameters, as numbers.
pub(crate) type Values = Vec<(String, f64)>;

/// To plan or to decide.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Call<T> {
    /// Whether drawings are shown.
    pub(crate) watched: bool,
    pub(crate) asked: T,
}

#[cfg(test)]
mod tests;
