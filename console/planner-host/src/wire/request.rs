//! Requests. Those for a plan or a command contain messages from [`planner_api::message`], which are written in their
//! borrowed form and read in their owned form.

use super::VERSION;
use super::body::{Body, Read, Writer, whole};
use crate::checks::limits;
use serde::{Deserialize, Serialize};
use std::ffi::OsStr;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::path::Path;

/// A request to load a library and keep the planner with this id. If the id is empty, all planners are described.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Load {
    pub(crate) memory_limit_bytes: u64,
    pub(crate) requires_sandbox: bool,
    /// The raw bytes of the path, which need not be UTF-8.
    path: Vec<u8>,
    #[serde(deserialize_with = "limits::text")]
    pub(crate) id: String,
}

impl Load {
    /// Creates the request to load the library at this path.
    pub(crate) fn of(path: &Path, id: &str, memory_limit_bytes: u64, requires_sandbox: bool) -> Self {
        // The path is made absolute, because a recorded request may be replayed from a different folder.
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let path = path.into_os_string().into_vec();
        Self { memory_limit_bytes, requires_sandbox, path, id: id.to_owned() }
    }

    /// Returns the path of the library.
    pub(crate) fn path(&self) -> &Path {
        Path::new(OsStr::from_bytes(&self.path))
    }

    /// Writes the version, which every build can read, followed by the request.
    pub(crate) fn write(&self, w: &mut Writer) {
        w.put(&VERSION).put(self);
    }

    /// Reads the request; `None` if a different build wrote it.
    pub(crate) fn read(mut body: Body<'_>) -> Read<Option<Self>> {
        if body.take::<u32>()? != VERSION {
            return Ok(None);
        }
        whole(body).map(Some)
    }
}

/// Parameter values as numbers.
pub(crate) type Values = Vec<(String, f64)>;

/// A request for a plan or a command.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Call<T> {
    /// Whether drawings are shown.
    pub(crate) watched: bool,
    pub(crate) asked: T,
}

#[cfg(test)]
mod tests;
