//! Merges the chunks of a closed recording into a few large ones: the viewer then opens it several times as fast.
//!
//! During a run every event must be in the file within seconds, so the chunks are small. The recording of a killed
//! process keeps its small chunks; its content is the same.

use crate::{error::RecordingError, recorder::paths, rr};
use std::{
    collections::BTreeMap,
    fs::{self, File},
    io::{BufReader, BufWriter, Write},
    path::{Path, PathBuf},
    time::Instant,
};

/// The largest size of a merged chunk.
const MOST_ROWS: usize = 1 << 15;
const MOST_CHUNK_BYTES: usize = 4 << 20;
/// Extension of the file that, once complete, replaces the recording.
const ENDING: &str = "merging";

/// Merges the chunks of a recording, about 60 MB per second; gives up at the time `until`, if one is given.
///
/// # Errors
/// The recording cannot be read, its replacement cannot be written, or the time has run out; the recording stays as
/// it was.
pub(crate) fn merge(path: &Path, until: Option<Instant>) -> Result<(), RecordingError> {
    let successor = with_ending(path);
    let done = write(path, &successor, until)
        .and_then(|()| fs::rename(&successor, path).map_err(|error| error.to_string()));
    if done.is_err() {
        // If the file cannot be removed, nothing more can be done.
        let _ = fs::remove_file(&successor);
    }
    done.map_err(|why| RecordingError::Merge { why, path: path.to_owned() })
}

fn with_ending(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{ENDING}"));
    PathBuf::from(name)
}

fn write(from: &Path, to: &Path, until: Option<Instant>) -> Result<(), String> {
    let text = |error: &dyn std::fmt::Display| error.to_string();
    let file = File::open(from).map_err(|error| text(&error))?;
    let out = BufWriter::new(File::create(to).map_err(|error| text(&error))?);
    let options = rr::EncodingOptions::PROTOBUF_COMPRESSED;
    let mut encoder =
        rr::Encoder::new_eager(rr::CrateVersion::LOCAL, options, out).map_err(|error| text(&error))?;
    let mut merger = Merger::default();
    for message in rr::DecoderApp::decode_lazy(BufReader::with_capacity(1 << 18, file)) {
        if until.is_some_and(|until| Instant::now() >= until) {
            return Err("it is too large for the time left".into());
        }
        for message in merger.take(message.map_err(|error| text(&error))?)? {
            encoder.append(&message).map_err(|error| text(&error))?;
        }
    }
    for message in merger.rest()? {
        encoder.append(&message).map_err(|error| text(&error))?;
    }
    encoder.finish().map_err(|error| text(&error))?;
    let mut out = encoder.into_inner().map_err(|error| text(&error))?;
    out.flush().map_err(|error| text(&error))
}

/// Chunks of one kind, entity and set of columns.
type Key = (Kind, String, Vec<String>);

/// The order of writing: a recording that is cut off must not appear to be complete.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// Data for the whole recording; only the last value counts.
    Static,
    Temporal,
    End,
}

impl Kind {
    fn of(chunk: &rr::Chunk) -> Self {
        match chunk.entity_path().to_string().trim_start_matches('/') {
            paths::END => Self::End,
            _ if chunk.is_static() => Self::Static,
            _ => Self::Temporal,
        }
    }
}

/// Chunks that are waiting for others in the same group.
#[derive(Default)]
struct Merger {
    store: Option<rr::StoreId>,
    waiting: BTreeMap<Key, Vec<rr::Chunk>>,
}

impl Merger {
    /// Adds the next message of a recording; returns the messages to be written now.
    fn take(&mut self, message: rr::LogMsg) -> Result<Vec<rr::LogMsg>, String> {
        let rr::LogMsg::ArrowMsg(store, arrow) = &message else { return Ok(vec![message]) };
        if store.kind() != rr::StoreKind::Recording {
            return Ok(vec![message]);
        }
        self.store.get_or_insert_with(|| store.clone());
        let chunk = rr::Chunk::from_arrow_msg(arrow).map_err(|error| error.to_string())?;
        let kind = Kind::of(&chunk);
        let mut columns: Vec<String> = chunk.components_identifiers().map(|c| c.to_string()).collect();
        columns.sort();
        let is_last_only = kind != Kind::Temporal;
        let key = (kind, chunk.entity_path().to_string(), columns);
        let waiting = self.waiting.entry(key).or_default();
        if is_last_only {
            *waiting = vec![chunk];
            return Ok(Vec::new());
        }
        let full = if is_full(waiting, &chunk) { std::mem::take(waiting) } else { Vec::new() };
        waiting.push(chunk);
        shrink(waiting, |one, other| one.num_rows() <= 2 * other.num_rows())?;
        self.merged(full)
    }

    /// Returns all chunks that are still waiting.
    fn rest(&mut self) -> Result<Vec<rr::LogMsg>, String> {
        let waiting = std::mem::take(&mut self.waiting);
        waiting
            .into_values()
            .map(|chunks| self.merged(chunks))
            .collect::<Result<Vec<_>, _>>()
            .map(|m| m.concat())
    }

    fn merged(&self, mut chunks: Vec<rr::Chunk>) -> Result<Vec<rr::LogMsg>, String> {
        shrink(&mut chunks, |_, _| true)?;
        let message = |chunk: rr::Chunk| {
            let arrow = chunk.to_arrow_msg().map_err(|error| error.to_string())?;
            Ok(self.store.clone().map(|store| rr::LogMsg::ArrowMsg(store, arrow)))
        };
        chunks.into_iter().filter_map(|chunk| message(chunk).transpose()).collect()
    }
}

/// Whether the waiting chunks and another one would be too large for a single chunk.
fn is_full(waiting: &[rr::Chunk], next: &rr::Chunk) -> bool {
    let chunks = || waiting.iter().chain([next]);
    let bytes = |chunk: &rr::Chunk| {
        chunk.components().list_arrays().map(rr::Array::get_array_memory_size).sum::<usize>()
    };
    chunks().map(rr::Chunk::num_rows).sum::<usize>() > MOST_ROWS
        || chunks().map(bytes).sum::<usize>() > MOST_CHUNK_BYTES
}

/// Joins the last two chunks as long as they are of about the same size, so that each row is copied only a few times.
fn shrink(
    chunks: &mut Vec<rr::Chunk>,
    are_to_join: impl Fn(&rr::Chunk, &rr::Chunk) -> bool,
) -> Result<(), String> {
    while let [.., one, other] = &chunks[..] {
        if !are_to_join(one, other) || !one.concatenable(other) {
            break;
        }
        let joined = rr::Chunk::concat_and_sort(one, other).map_err(|error| error.to_string())?;
        chunks.truncate(chunks.len() - 2);
        chunks.push(joined);
    }
    Ok(())
}
