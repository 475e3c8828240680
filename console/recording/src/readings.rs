//! The readings of an instrument as a Parquet file.

mod reader;

use crate::{error::RecordingError, journal::JournalReader};
use account::{Fold, Reading};
use arrow::{
    array::{ArrayRef, BooleanArray, Float32Array, Float64Array, RecordBatch, UInt16Array},
    datatypes::{DataType, Field, Schema},
};
use mission::EventKind;
use parquet::{
    arrow::ArrowWriter,
    basic::{Compression, ZstdLevel},
    file::{metadata::KeyValue, properties::WriterProperties},
};
pub use reader::each_reading;
use sha2::{Digest, Sha256};
use std::{
    fs::{File, OpenOptions},
    io::{self, BufWriter, Write},
    path::{Path, PathBuf},
    sync::Arc,
};

/// Name of the file with the readings in the folder of a run.
pub const READINGS_FILE: &str = "readings.parquet";
/// Number of readings that are handed to the writer at a time.
const ROWS_AT_ONCE: usize = 8192;
/// Number of readings in a row group. One group at a time is in memory.
const ROWS_IN_GROUP: usize = 1 << 18;

/// The columns: name, type, unit and meaning.
const COLUMNS: [(&str, DataType, &str, &str); 9] = [
    ("t_s", DataType::Float64, "s", "mission time"),
    ("channel", DataType::UInt16, "", "channel of the instrument; 0 is on the right"),
    ("x_m", DataType::Float32, "m", "east, tank frame, according to the estimated track"),
    ("y_m", DataType::Float32, "m", "north, tank frame, according to the estimated track"),
    ("cov_xx_m2", DataType::Float32, "m2", "variance of x"),
    ("cov_xy_m2", DataType::Float32, "m2", "covariance of x and y"),
    ("cov_yy_m2", DataType::Float32, "m2", "variance of y"),
    ("thickness_mm", DataType::Float32, "mm", "thickness of the floor"),
    (
        "testable",
        DataType::Boolean,
        "",
        "false where the reading is not judged: beside welds, or where floor does not count as scanned",
    ),
];

/// Writes readings; the file is complete only after [`ReadingsWriter::finish`].
pub struct ReadingsWriter {
    path: PathBuf,
    waiting: Vec<Reading>,
    schema: Arc<Schema>,
    writer: ArrowWriter<Hashed<BufWriter<File>>>,
}

impl ReadingsWriter {
    /// Creates the file, which must not exist.
    ///
    /// # Errors
    /// The file exists or cannot be created.
    pub fn create(path: &Path) -> Result<Self, RecordingError> {
        let create = |why: String| RecordingError::Create { why, path: path.to_owned() };
        let file = OpenOptions::new().write(true).create_new(true).open(path);
        let file = BufWriter::new(file.map_err(|error| create(error.to_string()))?);
        let field = |(name, kind, unit, meaning): &(&str, DataType, &str, &str)| {
            let about = [("unit", *unit), ("meaning", *meaning)];
            let about = about.map(|(key, value)| (key.to_owned(), value.to_owned()));
            Field::new(*name, kind.clone(), false).with_metadata(about.into())
        };
        let schema = Arc::new(Schema::new(COLUMNS.iter().map(field).collect::<Vec<_>>()));
        let units = COLUMNS.iter().map(|(name, _, unit, meaning)| format!("{name} [{unit}]: {meaning}"));
        let units = KeyValue::new("tankops.readings".to_owned(), units.collect::<Vec<_>>().join("\n"));
        let properties = WriterProperties::builder()
            .set_compression(Compression::ZSTD(ZstdLevel::try_new(3).map_err(|e| create(e.to_string()))?))
            .set_max_row_group_row_count(Some(ROWS_IN_GROUP))
            .set_key_value_metadata(Some(vec![units]))
            .build();
        let hashed = Hashed { inner: file, hasher: Sha256::new() };
        let writer = ArrowWriter::try_new(hashed, Arc::clone(&schema), Some(properties))
            .map_err(|error| create(error.to_string()))?;
        Ok(Self { path: path.to_owned(), waiting: Vec::new(), schema, writer })
    }

    /// Adds readings.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, readings: &[Reading]) -> Result<(), RecordingError> {
        self.waiting.extend_from_slice(readings);
        if self.waiting.len() >= ROWS_AT_ONCE { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), RecordingError> {
        let readings = std::mem::take(&mut self.waiting);
        // Digits below the resolution of an instrument would multiply the length of the file.
        let rounded = |of: fn(&Reading) -> f64, digits: f64| -> ArrayRef {
            let value = |reading: &Reading| ((of(reading) * digits).round() / digits) as f32;
            Arc::new(Float32Array::from_iter_values(readings.iter().map(value)))
        };
        let t_s = readings.iter().map(|reading| (1e3 * reading.t_s).round() / 1e3);
        let columns: Vec<ArrayRef> = vec![
            Arc::new(Float64Array::from_iter_values(t_s)),
            Arc::new(UInt16Array::from_iter_values(readings.iter().map(|reading| reading.channel))),
            rounded(|reading| reading.at.x, 1e4),
            rounded(|reading| reading.at.y, 1e4),
            rounded(|reading| reading.covariance[(0, 0)], 1e7),
            rounded(|reading| reading.covariance[(0, 1)], 1e7),
            rounded(|reading| reading.covariance[(1, 1)], 1e7),
            rounded(|reading| reading.thickness_mm, 1e2),
            Arc::new(readings.iter().map(|reading| Some(reading.is_testable)).collect::<BooleanArray>()),
        ];
        let batch = RecordBatch::try_new(Arc::clone(&self.schema), columns);
        let batch = batch.map_err(|error| self.failed(&error))?;
        self.writer.write(&batch).map_err(|error| self.failed(&error))
    }

    /// Completes the file; returns its SHA-256, hexadecimal.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(mut self) -> Result<String, RecordingError> {
        self.flush()?;
        let path = self.path.clone();
        let failed = |why: String| failed(&path, why);
        let mut hashed = self.writer.into_inner().map_err(|error| failed(error.to_string()))?;
        hashed.flush().map_err(|error| failed(error.to_string()))?;
        Ok(hex::encode(hashed.hasher.finalize()))
    }

    fn failed(&self, error: &impl std::fmt::Display) -> RecordingError {
        failed(&self.path, error.to_string())
    }
}

/// Writes the readings of a run, computed from its journal. If the journal is cut off, the readings extend to that
/// point, and the returned text states what is missing.
///
/// # Errors
/// The journal is missing or damaged, the instrument of the run does not read thickness, or the file cannot be written.
/// An existing file is never overwritten.
pub fn export_readings(journal: &Path, file: &Path) -> Result<Option<String>, RecordingError> {
    let mut reader = JournalReader::open(journal)?;
    let mut account = Fold::new();
    // The first event describes the run. A run without readings leaves no file.
    let mut writer = None;
    for event in reader.by_ref() {
        let event = event?;
        account.apply(&event);
        let survey = account.survey().ok_or(RecordingError::NoReadings)?;
        let writer = match &mut writer {
            Some(writer) => writer,
            None => writer.insert(ReadingsWriter::create(file)?),
        };
        if let EventKind::Estimated { .. } = event.kind {
            writer.write(survey.latest())?;
        }
    }
    writer.ok_or(RecordingError::NoReadings)?.finish()?;
    Ok(reader.truncated().map(str::to_owned))
}

fn failed(path: &Path, why: String) -> RecordingError {
    RecordingError::Readings { why, path: path.to_owned() }
}

/// A file whose digest is computed while it is written.
struct Hashed<W> {
    inner: W,
    hasher: Sha256,
}

impl<W: Write> Write for Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arrow::{array::AsArray, datatypes::Float32Type};
    use nalgebra::Matrix2;
    use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
    use world::Point;

    #[test]
    fn the_file_has_every_reading_its_units_and_the_digest_that_is_returned() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(READINGS_FILE);
        let reading = |k: u32| Reading {
            t_s: f64::from(k) * 0.01,
            channel: (k % 20) as u16,
            at: Point::new(1.0, 2.0),
            covariance: Matrix2::new(4e-4, 1e-4, 1e-4, 9e-4),
            thickness_mm: f64::from(k % 80) / 10.0,
            is_testable: !k.is_multiple_of(7),
        };
        let readings: Vec<Reading> = (0..20_000).map(reading).collect();
        let mut writer = ReadingsWriter::create(&path).unwrap();
        readings.chunks(333).for_each(|chunk| writer.write(chunk).unwrap());
        let sha256 = writer.finish().unwrap();
        assert_eq!(crate::sha256(&path).unwrap(), sha256);
        let mut again = Vec::new();
        each_reading(&path, |reading| again.push(reading)).unwrap();
        let is_close = |(read, written): (&Reading, &Reading)| {
            read.channel == written.channel
                && read.is_testable == written.is_testable
                && (read.t_s - written.t_s).abs() < 0.0006
                && (read.at - written.at).norm() < 1e-4
                && (read.covariance - written.covariance).norm() < 1e-6
        };
        assert!(again.len() == readings.len() && again.iter().zip(&readings).all(is_close));
        std::fs::write(folder.path().join("other"), "text").unwrap();
        assert!(each_reading(&folder.path().join("other"), |_| {}).is_err(), "it is no Parquet file");
        let file = ParquetRecordBatchReaderBuilder::try_new(File::open(&path).unwrap()).unwrap();
        assert_eq!(file.schema().field_with_name("thickness_mm").unwrap().metadata()["unit"], "mm");
        let read: Vec<f32> = file
            .build()
            .unwrap()
            .flat_map(|batch| {
                let batch = batch.unwrap();
                let column = batch.column_by_name("thickness_mm").unwrap();
                column.as_primitive::<Float32Type>().values().to_vec()
            })
            .collect();
        let is_same =
            |(read, written): (&f32, &Reading)| (f64::from(*read) - written.thickness_mm).abs() < 0.0051;
        assert!(read.len() == readings.len() && read.iter().zip(&readings).all(is_same));
        assert!(ReadingsWriter::create(&path).is_err(), "it exists");
    }
}
