//! The table of a campaign: one row for each mission, as Parquet.

use crate::{
    columns::explained,
    digest::{self, Seal},
    frozen::Campaign,
    row::{Row, Status},
    value::Value,
};
use arrow::{
    array::{Array, AsArray},
    array::{ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray, UInt64Array},
    compute::{BatchCoalescer, cast, concat_batches},
    datatypes::{DataType, Field, Float64Type, Schema, SchemaRef},
    error::ArrowError,
};
use parquet::{
    arrow::{
        ArrowWriter,
        arrow_reader::{ArrowReaderOptions, ParquetRecordBatchReaderBuilder},
    },
    basic::{Compression, ZstdLevel},
    errors::ParquetError,
    file::{metadata::KeyValue, properties::WriterProperties, reader::ChunkReader},
};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use thiserror::Error;

/// Number of rows written at a time, regardless of blocks. Pages end only at these boundaries.
const ROWS_AT_ONCE: usize = 8192;
/// The origin of a file, as stored in it. A part stores its hash and the missions of its block; the table of results
/// stores everything.
const SOURCE: &str = "tankops.campaign";

/// Type of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Count,
    Number,
    Text,
    Flag,
}

use Kind::{Count, Flag, Number, Text};

/// Columns that contain figures from the report, with the paths of these figures in the report.
const FIGURES: [(&str, Kind); 50] = [
    ("outcome", Text),
    ("reason", Text),
    ("violations", Text),
    ("planner_version", Text),
    ("parameters", Text),
    ("ticks", Count),
    ("mission_time_s", Number),
    ("path_length_m", Number),
    ("turns", Count),
    ("rotation_turns", Number),
    ("clearance_min_m", Number),
    ("collisions", Count),
    ("obstacles_found", Count),
    ("holds", Count),
    ("planner_faults", Count),
    ("coverage.reachable", Number),
    ("coverage.whole", Number),
    ("coverage.overlap", Number),
    ("coverage.missed_area_m2", Number),
    ("coverage.by_truth.reachable", Number),
    ("coverage.by_truth.whole", Number),
    ("coverage.by_truth.scanned_truly", Number),
    ("coverage.by_truth.guaranteed_truly", Number),
    ("tracking.precision", Number),
    ("tracking.recall", Number),
    ("tracking.rmse_m", Number),
    ("tracking.cross_track_rmse_m", Number),
    ("accuracy.mean_m", Number),
    ("accuracy.p95_m", Number),
    ("accuracy.max_m", Number),
    ("accuracy.over_limit", Number),
    ("accuracy.fixes", Count),
    ("accuracy.stations_mean", Number),
    ("accuracy.stations_min", Count),
    ("positioning.mean_error_m", Number),
    ("positioning.p50_m", Number),
    ("positioning.p95_m", Number),
    ("positioning.max_m", Number),
    ("positioning.in_95_ellipse", Number),
    ("positioning.position_lost_s", Number),
    ("tether.tether_length_max_m", Number),
    ("tether.wrap_max_rad", Number),
    ("tether.wrap_total_max_rad", Number),
    ("tether.loops", Count),
    ("tether.end_length_m", Number),
    ("tether.entangled", Flag),
    ("tether.snags", Count),
    ("tether.snagged", Flag),
    ("readings.detected", Number),
    ("readings.false_calls", Count),
];

/// Figures for which a larger value is better; for all other figures, a smaller value is better.
const MORE_IS_BETTER: [&str; 13] = [
    "clearance_min_m",
    "coverage.reachable",
    "coverage.whole",
    "coverage.by_truth.reachable",
    "coverage.by_truth.whole",
    "coverage.by_truth.scanned_truly",
    "coverage.by_truth.guaranteed_truly",
    "tracking.precision",
    "tracking.recall",
    "accuracy.stations_mean",
    "accuracy.stations_min",
    "positioning.in_95_ellipse",
    "readings.detected",
];

/// Names of the columns that contain figures from the report.
pub(crate) fn metrics() -> impl Iterator<Item = &'static str> {
    FIGURES.iter().filter(|(_, kind)| matches!(kind, Count | Number)).map(|(name, _)| *name)
}

/// Whether a table has such a column.
pub(crate) fn is_metric(name: &str) -> bool {
    metrics().any(|metric| metric == name)
}

/// Whether a larger value of a figure is better.
pub(crate) fn more_is_better(metric: &str) -> bool {
    MORE_IS_BETTER.contains(&metric)
}

/// The reason why a table cannot be written or read.
#[derive(Debug, Error)]
pub enum TableError {
    /// The columns do not match.
    #[error("its columns do not match: {0}")]
    Arrow(#[from] ArrowError),
    /// Not a Parquet file, or damaged.
    #[error("is not a complete Parquet file: {0}")]
    Parquet(#[from] ParquetError),
    /// The digest of the file does not match.
    #[error("is damaged: its SHA-256 does not match")]
    Damaged,
    /// A part without a digest.
    #[error("is not a complete part: it has no digest")]
    NoDigest,
    /// The content cannot be interpreted by the reader.
    #[error("is damaged, or not a Parquet file that tankops can read")]
    Unreadable,
    /// The part belongs to a different campaign or block.
    #[error("comes from a different campaign or block, or from a different version of this campaign")]
    Foreign,
    /// A Parquet file that is not a table of results.
    #[error("was not written by `tankops campaign`: it has no column `{0}`")]
    NoColumn(&'static str),
}

fn schema(campaign: &Campaign) -> SchemaRef {
    let field = |name: &str, kind: DataType, nullable| explained(Field::new(name, kind, nullable));
    let mut fields = vec![
        field("case", DataType::UInt64, false),
        field("scenario", DataType::Utf8, false),
        field("planner", DataType::Utf8, true),
        field("seed", DataType::UInt64, false),
    ];
    fields.extend(
        (0..campaign.design.keys.len())
            .map(|key| field(&set_name(campaign, key), set_type(campaign, key), false)),
    );
    fields.extend([
        field("status", DataType::Utf8, false),
        field("error", DataType::Utf8, true),
        field("success", DataType::Boolean, false),
    ]);
    fields.extend(FIGURES.map(|(name, kind)| {
        let kind = match kind {
            Count => DataType::UInt64,
            Number => DataType::Float64,
            Text => DataType::Utf8,
            Flag => DataType::Boolean,
        };
        field(name, kind, true)
    }));
    fields.push(field("scenario_sha256", DataType::Utf8, false));
    Arc::new(Schema::new(fields))
}

fn set_name(campaign: &Campaign, key: usize) -> String {
    format!("set.{}", campaign.design.keys[key])
}

/// The narrowest type that can represent all values of a key.
fn set_type(campaign: &Campaign, key: usize) -> DataType {
    let all = |is: fn(&Value) -> bool| campaign.design.points.iter().all(|point| is(&point[key]));
    if all(|value| matches!(value, Value::Whole(_))) {
        DataType::Int64
    } else if all(|value| value.number().is_some()) {
        DataType::Float64
    } else if all(|value| matches!(value, Value::Flag(_))) {
        DataType::Boolean
    } else {
        DataType::Utf8
    }
}

fn set_column(campaign: &Campaign, key: usize, rows: &[Row]) -> ArrayRef {
    let values = rows.iter().map(|row| &campaign.case(row.case).point[key]);
    match set_type(campaign, key) {
        DataType::Int64 => Arc::new(
            values.map(|v| if let Value::Whole(n) = v { Some(*n) } else { None }).collect::<Int64Array>(),
        ),
        DataType::Float64 => Arc::new(values.map(Value::number).collect::<Float64Array>()),
        DataType::Boolean => {
            Arc::new(values.map(|v| Some(*v == Value::Flag(true))).collect::<BooleanArray>())
        }
        _ => Arc::new(values.map(|v| Some(v.to_string())).collect::<StringArray>()),
    }
}

fn figure_column(name: &str, kind: Kind, rows: &[Row]) -> ArrayRef {
    let values = rows.iter().map(|row| name.split('.').fold(&row.report, |value, key| &value[key]));
    match kind {
        Count => Arc::new(values.map(serde_json::Value::as_u64).collect::<UInt64Array>()),
        Number => Arc::new(values.map(serde_json::Value::as_f64).collect::<Float64Array>()),
        Text => Arc::new(values.map(text).collect::<StringArray>()),
        Flag => Arc::new(values.map(serde_json::Value::as_bool).collect::<BooleanArray>()),
    }
}

fn text(value: &serde_json::Value) -> Option<String> {
    match value {
        serde_json::Value::Null => None,
        serde_json::Value::String(text) => Some(text.clone()),
        serde_json::Value::Array(list) => Some(list.iter().filter_map(text).collect::<Vec<_>>().join("; ")),
        other => Some(other.to_string()),
    }
}

pub(crate) fn batch(campaign: &Campaign, rows: &[Row]) -> Result<RecordBatch, TableError> {
    let words = |of: &dyn Fn(&Row) -> Option<String>| -> ArrayRef {
        Arc::new(rows.iter().map(of).collect::<StringArray>())
    };
    let planner = |row: &Row| {
        let of_plan = campaign.case(row.case).planner.map(str::to_owned);
        of_plan.or_else(|| row.report["planner"].as_str().map(str::to_owned))
    };
    let mut columns: Vec<ArrayRef> = vec![
        Arc::new(rows.iter().map(|row| Some(row.case)).collect::<UInt64Array>()),
        words(&|row| Some(campaign.case(row.case).scenario.name.clone())),
        words(&planner),
        Arc::new(rows.iter().map(|row| Some(campaign.case(row.case).seed)).collect::<UInt64Array>()),
    ];
    columns.extend((0..campaign.design.keys.len()).map(|key| set_column(campaign, key, rows)));
    columns.push(words(&|row| Some(row.status.word().to_owned())));
    columns.push(words(&|row| row.error.clone()));
    columns.push(Arc::new(rows.iter().map(|row| Some(row.success)).collect::<BooleanArray>()));
    columns.extend(FIGURES.map(|(name, kind)| figure_column(name, kind, rows)));
    columns.push(words(&|row| Some(campaign.case(row.case).scenario.sha256.clone())));
    Ok(RecordBatch::try_new(schema(campaign), columns)?)
}

pub(crate) fn writer(campaign: &Campaign, source: String) -> Result<ArrowWriter<Vec<u8>>, TableError> {
    let properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(3)?))
        .set_max_row_group_row_count(Some(8 * ROWS_AT_ONCE))
        .set_created_by(digest::CREATED_BY.to_owned())
        .set_key_value_metadata(Some(vec![KeyValue::new(SOURCE.to_owned(), source), digest::place_holder()]))
        .build();
    Ok(ArrowWriter::try_new(Vec::new(), schema(campaign), Some(properties))?)
}

/// The bytes of a finished table, including their digest.
pub(crate) fn finished(writer: ArrowWriter<Vec<u8>>) -> Result<Vec<u8>, TableError> {
    let mut bytes = writer.into_inner()?;
    digest::seal(&mut bytes);
    Ok(bytes)
}

/// Creates a reader that uses the columns but ignores the Arrow schema in the metadata, which could contain anything if
/// the file is damaged.
pub(crate) fn opened<T: ChunkReader + 'static>(
    file: T,
) -> Result<ParquetRecordBatchReaderBuilder<T>, TableError> {
    let options = ArrowReaderOptions::new().with_skip_arrow_metadata(true);
    Ok(ParquetRecordBatchReaderBuilder::try_new_with_options(file, options)?)
}

/// Combines parts, in order, into the bytes of the table of results.
///
/// # Errors
/// The parts do not fit together.
pub fn merged(campaign: &Campaign, parts: &[Table]) -> Result<Vec<u8>, TableError> {
    let mut writer = writer(campaign, campaign.provenance())?;
    let mut rows = BatchCoalescer::new(schema(campaign), ROWS_AT_ONCE);
    for part in parts {
        rows.push_batch(part.rows.clone())?;
        while let Some(batch) = rows.next_completed_batch() {
            writer.write(&batch)?;
        }
    }
    rows.finish_buffered_batch()?;
    while let Some(batch) = rows.next_completed_batch() {
        writer.write(&batch)?;
    }
    finished(writer)
}

pub(crate) fn source<T>(builder: &parquet::arrow::arrow_reader::ArrowReaderBuilder<T>) -> Option<&str> {
    let entries = builder.metadata().file_metadata().key_value_metadata()?;
    entries.iter().find(|entry| entry.key == SOURCE)?.value.as_deref()
}

/// Catches the panics of a third-party reader when it reads files from elsewhere.
fn unharmed<T>(read: impl FnOnce() -> Result<T, TableError>) -> Result<T, TableError> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or(Err(TableError::Unreadable))
}

/// The rows of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    rows: RecordBatch,
}

impl Table {
    /// Reads a table of results; also returns whether its bytes were verified. A table written by an earlier version or
    /// by another program has no digest.
    ///
    /// # Errors
    /// The file is damaged or is not a table of results.
    pub fn read(file: impl ChunkReader + 'static) -> Result<(Self, bool), TableError> {
        let seal = digest::check(&file)?;
        if seal == Seal::Damaged {
            return Err(TableError::Damaged);
        }
        let table = unharmed(|| Self::from_reader(opened(file)?))?;
        match ["case", "scenario", "planner", "seed", "status", "success"]
            .iter()
            .find(|name| !table.has(name))
        {
            Some(missing) => Err(TableError::NoColumn(missing)),
            None => Ok((table, seal == Seal::Whole)),
        }
    }

    pub(crate) fn from_reader<T: ChunkReader + 'static>(
        builder: ParquetRecordBatchReaderBuilder<T>,
    ) -> Result<Self, TableError> {
        let schema = Arc::new(Schema::new(builder.schema().fields().clone()));
        let batches = builder.with_batch_size(ROWS_AT_ONCE).build()?.collect::<Result<Vec<_>, _>>()?;
        Ok(Self { rows: concat_batches(&schema, &batches)? })
    }

    /// Concatenates tables.
    ///
    /// # Errors
    /// Their columns differ.
    pub fn joined(parts: &[Self]) -> Result<Self, TableError> {
        let schema = parts.first().map_or_else(|| Arc::new(Schema::empty()), |part| part.rows.schema());
        Ok(Self { rows: concat_batches(&schema, parts.iter().map(|part| &part.rows))? })
    }

    /// The first rows.
    #[must_use]
    pub fn first(&self, rows: usize) -> Self {
        Self { rows: self.rows.slice(0, rows.min(self.len())) }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.num_rows()
    }

    /// Whether the table is empty.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the column exists.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.rows.column_by_name(name).is_some()
    }

    /// Names of the columns of the grid.
    pub(crate) fn keys(&self) -> Vec<String> {
        let schema = self.rows.schema();
        schema
            .fields()
            .iter()
            .map(|field| field.name().clone())
            .filter(|name| name.starts_with("set."))
            .collect()
    }

    /// A column as numbers; empty if it does not exist.
    pub(crate) fn numbers(&self, name: &str) -> Vec<Option<f64>> {
        let column = self.rows.column_by_name(name).and_then(|column| cast(column, &DataType::Float64).ok());
        column.map_or_else(Vec::new, |column| column.as_primitive::<Float64Type>().iter().collect())
    }

    /// A column as texts; empty if it does not exist.
    pub(crate) fn words(&self, name: &str) -> Vec<Option<String>> {
        let column = self.rows.column_by_name(name).and_then(|column| cast(column, &DataType::Utf8).ok());
        let owned =
            |column: ArrayRef| column.as_string::<i32>().iter().map(|word| word.map(str::to_owned)).collect();
        column.map_or_else(Vec::new, owned)
    }

    /// A column of flags; all false if it does not exist.
    pub(crate) fn flags(&self, name: &str) -> Vec<bool> {
        let column = self.rows.column_by_name(name).and_then(|column| column.as_boolean_opt());
        column.map_or_else(
            || vec![false; self.len()],
            |column| (0..column.len()).map(|row| column.is_valid(row) && column.value(row)).collect(),
        )
    }

    /// Number of rows with this status.
    pub fn count(&self, status: Status) -> u64 {
        self.words("status").iter().filter(|word| word.as_deref() == Some(status.word())).count() as u64
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{frozen::tests::campaign, part};
    use account::Summary;
    use mission::Outcome;
    use proptest::prelude::*;
    use std::io::Write;

    pub(crate) const PLAN: &str = "scenarios = [\"a.toml\", \"b.toml\"]\nplanners = [\"p\", \"q\"]\n\
                        metrics = [\"mission_time_s\", \"path_length_m\"]\n\
                        seeds = { first = 10, count = 20 }\n[grid]\nk = [0.5, 2.0]\n";

    /// The row for a mission number; most of these missions ran, some did not.
    pub(crate) fn row(case: u64) -> Row {
        let chance = (case * 7919) % 101;
        if chance < 4 {
            return Row::not_flown(case, Status::Refused, "no such parameter".into());
        }
        let outcome = if chance < 20 { Outcome::Stuck } else { Outcome::Complete };
        let mission_time_s = Some(100.0 + chance as f64 + (case % 4) as f64 * 10.0);
        let path_length_m = Some(30.0 - (case % 4) as f64 + chance as f64 / 50.0);
        Row::flown(
            case,
            Summary { outcome: Some(outcome), mission_time_s, path_length_m, ..Summary::default() },
        )
    }

    pub(crate) fn file(bytes: &[u8]) -> std::fs::File {
        let mut file = tempfile::tempfile().expect("a file");
        file.write_all(bytes).expect("written");
        file
    }

    fn table(plan: &str) -> Vec<u8> {
        let campaign = campaign(plan);
        let part = |block| {
            let rows: Vec<Row> = campaign.block(block).map(row).collect();
            part::read(&campaign, block, file(&part::write(&campaign, block, &rows).expect("written")))
                .expect("read")
        };
        let parts: Vec<Table> = (0..campaign.blocks()).map(part).collect();
        merged(&campaign, &parts).expect("merged")
    }

    #[test]
    fn a_table_reads_back_with_its_types() {
        let (table, is_proven) = Table::read(file(&table(PLAN))).expect("read");
        assert!(is_proven);
        assert_eq!(table.len(), 160);
        assert_eq!(table.count(Status::Refused), (0..160).filter(|n| n * 7919 % 101 < 4).count() as u64);
        assert_eq!(table.keys(), ["set.k"]);
        assert_eq!(table.numbers("set.k")[..2], [Some(0.5), Some(2.0)]);
        assert_eq!(table.words("planner")[2].as_deref(), Some("q"));
        assert_eq!((table.numbers("seed")[159], table.flags("success").len()), (Some(29.0), 160));
    }

    #[test]
    fn every_flipped_bit_is_found() {
        let one = campaign(&format!("block = 4\n{PLAN}"));
        let whole = part::write(&one, 0, &one.block(0).map(row).collect::<Vec<_>>()).expect("written");
        let of_part = |file| part::read(&one, 0, file).is_ok();
        assert_eq!(found_whole(&whole, of_part), [] as [usize; 0]);
        assert_eq!(found_whole(&table(PLAN), |file| Table::read(file).is_ok()), [] as [usize; 0]);
    }

    /// The bytes in which a flipped bit is not detected.
    fn found_whole(bytes: &[u8], is_whole: impl Fn(std::fs::File) -> bool) -> Vec<usize> {
        use std::os::unix::fs::FileExt;
        let shared = file(bytes);
        let again = || shared.try_clone().expect("the same file");
        assert!(is_whole(again()));
        let flipped = |at: &usize| {
            shared.write_all_at(&[bytes[*at] ^ 1 << (at % 8)], *at as u64).expect("written");
            let is_whole = is_whole(again());
            shared.write_all_at(&bytes[*at..=*at], *at as u64).expect("written");
            is_whole
        };
        (0..bytes.len()).filter(flipped).collect()
    }

    /// A table as an earlier version wrote it, without a digest.
    fn without_digest() -> Vec<u8> {
        let one = campaign(PLAN);
        let rows: Vec<Row> = one.block(0).map(row).collect();
        let mut writer = ArrowWriter::try_new(Vec::new(), schema(&one), None).expect("a writer");
        writer.write(&batch(&one, &rows).expect("rows")).expect("written");
        writer.into_inner().expect("finished")
    }

    #[test]
    fn a_table_without_a_digest_is_read_and_not_vouched_for() {
        let (table, is_proven) = Table::read(file(&without_digest())).expect("read");
        assert!(!table.is_empty() && !is_proven);
    }

    #[test]
    fn every_column_says_its_unit_and_meaning() {
        let read = ParquetRecordBatchReaderBuilder::try_new(file(&table(PLAN))).expect("read");
        for field in read.schema().fields() {
            let (unit, meaning) = (&field.metadata()["unit"], &field.metadata()["meaning"]);
            assert!(!meaning.is_empty(), "{field}");
            assert_eq!(unit.is_empty(), !field.data_type().is_numeric(), "{field}");
        }
        assert_eq!(
            read.schema().field_with_name("tether.entangled").expect("a column").data_type(),
            &DataType::Boolean
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]
        #[test]
        fn the_bytes_do_not_depend_on_the_blocks(block in 1_u64..200) {
            let blocks = format!("block = {block}\n{PLAN}");
            let whole = format!("block = 160\n{PLAN}");
            prop_assert!(table(&blocks) == table(&whole));
        }
    }

    proptest! {
        #[test]
        fn damage_that_no_digest_shows_is_refused_or_read_and_never_a_panic(damage in mutations::mutations()) {
            let bytes = mutations::mutated(&without_digest(), &damage);
            let _ = opened(file(&bytes)).and_then(Table::from_reader);
        }
    }
}
