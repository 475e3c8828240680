//! Reads the content of a recording.

use crate::{
    error::RecordingError,
    recorder::{FIGURES, paths, stream::TICK},
    rr,
};
use std::{collections::BTreeMap, fs::File, io::BufReader, path::Path};

/// The readable content of a recording.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Summary {
    /// The application id under which the viewer stores the layout.
    pub application: String,
    /// The id that the viewer uses to keep recordings apart.
    pub recording_id: String,
    /// Human-readable name.
    pub name: Option<String>,
    /// Rows of each entity.
    pub entities: BTreeMap<String, u64>,
    /// Rows of all entities.
    pub rows: u64,
    /// First and last tick.
    pub ticks: Option<(i64, i64)>,
    /// Last recorded coverage of the reachable floor, per cent.
    pub last_coverage_percent: Option<f64>,
    /// Number of lines of the event log.
    pub log_lines: u64,
    /// How the run ended; absent if the run was killed or is still in progress.
    pub outcome: Option<String>,
    /// The figures of the run by name, in the units that the names state.
    pub figures: BTreeMap<String, f64>,
    /// Whether a layout is embedded.
    pub has_layout: bool,
    /// The error that stopped the reading; absent if there was none.
    pub damage: Option<String>,
}

impl Summary {
    /// Whether the recording contains the run to its end.
    pub fn is_complete(&self) -> bool {
        self.outcome.is_some() && self.damage.is_none()
    }
}

/// Reads the content of a recording; a recording that is cut off is read up to the point where it ends.
///
/// # Errors
/// [`RecordingError::Read`] if there is no such file.
pub fn inspect(path: &Path) -> Result<Summary, RecordingError> {
    let file = File::open(path);
    let file =
        file.map_err(|error| RecordingError::Read { why: error.to_string(), path: path.to_owned() })?;
    let mut summary = Summary::default();
    for message in rr::DecoderApp::decode_lazy(BufReader::with_capacity(1 << 20, file)) {
        match message {
            Ok(message) => summary.take(&message),
            Err(error) => {
                summary.damage = Some(error.to_string());
                break;
            }
        }
    }
    Ok(summary)
}

impl Summary {
    fn take(&mut self, message: &rr::LogMsg) {
        if message.store_id().kind() == rr::StoreKind::Blueprint {
            self.has_layout = true;
            return;
        }
        match message {
            rr::LogMsg::SetStoreInfo(info) => {
                let id = &info.info.store_id;
                self.application = id.application_id().to_string();
                self.recording_id = id.recording_id().to_string();
            }
            rr::LogMsg::ArrowMsg(_, arrow) => match rr::Chunk::from_arrow_msg(arrow) {
                Ok(chunk) => self.take_chunk(&chunk),
                Err(error) => self.damage = Some(error.to_string()),
            },
            rr::LogMsg::BlueprintActivationCommand(_) => {}
        }
    }

    fn take_chunk(&mut self, chunk: &rr::Chunk) {
        let rows = chunk.num_rows() as u64;
        let entity = chunk.entity_path().to_string();
        let entity = entity.trim_start_matches('/');
        self.rows += rows;
        *self.entities.entry(entity.to_owned()).or_default() += rows;
        if let Some(times) = chunk.timelines().get(&TICK.into()) {
            let range = times.time_range();
            let (first, last) = (range.min().as_i64(), range.max().as_i64());
            self.ticks = Some(self.ticks.map_or((first, last), |(a, b)| (a.min(first), b.max(last))));
        }
        match entity {
            paths::COVERED => self.last_coverage_percent = last_number(chunk).or(self.last_coverage_percent),
            "__properties" => self.name = text(chunk, rr::RecordingInfo::descriptor_name().component),
            _ if entity.strip_prefix("__properties/") == Some(FIGURES) => self.figures = numbers(chunk),
            paths::END => self.outcome = text(chunk, "outcome".into()),
            _ if entity.starts_with(paths::LOG) => self.log_lines += rows,
            _ => {}
        }
    }
}

fn last_number(chunk: &rr::Chunk) -> Option<f64> {
    let component = rr::Scalars::descriptor_scalars().component;
    chunk.iter_slices::<f64>(component).last().and_then(|row| row.first().copied())
}

/// The numbers in a chunk, by the names of its components.
fn numbers(chunk: &rr::Chunk) -> BTreeMap<String, f64> {
    let number = |component: rr::ComponentIdentifier| {
        let float = chunk.iter_slices::<f64>(component).last().and_then(|row| row.first().copied());
        let count = || chunk.iter_slices::<u64>(component).last().and_then(|row| row.first().copied());
        Some((component.to_string(), float.or_else(|| count().map(|count| count as f64))?))
    };
    chunk.components_identifiers().filter_map(number).collect()
}

fn text(chunk: &rr::Chunk, component: rr::ComponentIdentifier) -> Option<String> {
    chunk.iter_slices::<String>(component).flatten().next().map(|text| text.to_string())
}
