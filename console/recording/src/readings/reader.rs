//! Reads the file with the readings of an instrument.

use super::COLUMNS;
use crate::error::RecordingError;
use account::Reading;
use arrow::{
    array::{AsArray, RecordBatch},
    datatypes::{DataType, Float32Type, Float64Type, UInt16Type},
};
use nalgebra::Matrix2;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::{fs::File, path::Path};
use world::Point;

/// Number of readings in memory at a time.
const ROWS_AT_ONCE: usize = 1 << 16;

/// Passes every reading in a file to the caller, in the order of the file. Part of the file is in memory at a time.
///
/// # Errors
/// The file cannot be read, or has other columns.
pub fn each_reading(path: &Path, mut take: impl FnMut(Reading)) -> Result<(), RecordingError> {
    let read = |why: String| RecordingError::Read { why, path: path.to_owned() };
    let file = File::open(path).map_err(|error| read(error.to_string()))?;
    let file = ParquetRecordBatchReaderBuilder::try_new(file).map_err(|error| read(error.to_string()))?;
    for (name, kind, ..) in &COLUMNS {
        if file.schema().field_with_name(name).is_ok_and(|field| field.data_type() == kind) {
            continue;
        }
        return Err(read(format!("it has no column {name} of type {kind}")));
    }
    let batches = file.with_batch_size(ROWS_AT_ONCE).build().map_err(|error| read(error.to_string()))?;
    for batch in batches {
        let batch = batch.map_err(|error| read(error.to_string()))?;
        rows(&batch).ok_or_else(|| read("a column is missing or has gaps".to_owned()))?.for_each(&mut take);
    }
    Ok(())
}

/// The readings in a batch; `None` if a column is missing.
fn rows(batch: &RecordBatch) -> Option<impl Iterator<Item = Reading> + '_> {
    let column = |name: &str| batch.column_by_name(name).filter(|column| column.null_count() == 0);
    let single = |name: &str| Some(column(name)?.as_primitive_opt::<Float32Type>()?.values());
    let times = column("t_s")?.as_primitive_opt::<Float64Type>()?.values();
    let channels = column("channel")?.as_primitive_opt::<UInt16Type>()?.values();
    let [x, y] = [single("x_m")?, single("y_m")?];
    let [xx, xy, yy] = [single("cov_xx_m2")?, single("cov_xy_m2")?, single("cov_yy_m2")?];
    let thickness = single("thickness_mm")?;
    let testable = column("testable").filter(|column| *column.data_type() == DataType::Boolean)?;
    let testable = testable.as_boolean();
    let reading = move |row: usize| {
        let [xx, xy, yy] = [xx, xy, yy].map(|values| f64::from(values[row]));
        Reading {
            t_s: times[row],
            channel: channels[row],
            at: Point::new(f64::from(x[row]), f64::from(y[row])),
            covariance: Matrix2::new(xx, xy, xy, yy),
            thickness_mm: f64::from(thickness[row]),
            is_testable: testable.value(row),
        }
    };
    Some((0..batch.num_rows()).map(reading))
}
