//! The part of a block: a file with the rows of the block's missions. It is accepted only if it is unchanged.

use crate::{
    digest::{self, Seal},
    frozen::Campaign,
    row::Row,
    table::{Table, TableError, batch, finished, opened, source, writer},
};
use parquet::{arrow::arrow_reader::ParquetRecordBatchReaderBuilder, file::reader::ChunkReader};
use sha2::{Digest, Sha256};

/// The origin of a part, as stored in it.
fn part_source(campaign: &Campaign, block: u64) -> String {
    let cases = campaign.block(block);
    let hash = hex::encode(Sha256::digest(campaign.provenance()));
    format!("{hash} missions {} to {}", cases.start, cases.end - 1)
}

/// Writes the rows of a block, in the order of their missions, as a file.
///
/// # Errors
/// The rows do not match the columns.
pub fn write(campaign: &Campaign, block: u64, rows: &[Row]) -> Result<Vec<u8>, TableError> {
    let mut writer = writer(campaign, part_source(campaign, block))?;
    writer.write(&batch(campaign, rows)?)?;
    finished(writer)
}

/// Checks that a file is the part of this block and is byte for byte as it was written.
///
/// # Errors
/// The file is damaged, or is not the part of this block.
pub fn check(campaign: &Campaign, block: u64, file: impl ChunkReader + 'static) -> Result<(), TableError> {
    checked(campaign, block, file).map(|_| ())
}

/// Reads the part of a block.
///
/// # Errors
/// As for [`check`].
pub fn read(campaign: &Campaign, block: u64, file: impl ChunkReader + 'static) -> Result<Table, TableError> {
    Table::from_reader(checked(campaign, block, file)?)
}

fn checked<T: ChunkReader + 'static>(
    campaign: &Campaign,
    block: u64,
    file: T,
) -> Result<ParquetRecordBatchReaderBuilder<T>, TableError> {
    match digest::check(&file)? {
        Seal::Whole => {}
        Seal::Damaged => return Err(TableError::Damaged),
        Seal::None => return Err(TableError::NoDigest),
    }
    let builder = opened(file)?;
    let cases = campaign.block(block);
    let rows = builder.metadata().file_metadata().num_rows();
    let is_of_block = source(&builder) == Some(&part_source(campaign, block))
        && u64::try_from(rows) == Ok(cases.end - cases.start);
    if is_of_block { Ok(builder) } else { Err(TableError::Foreign) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        frozen::tests::campaign,
        table::tests::{PLAN, file, row},
    };

    #[test]
    fn a_part_of_another_campaign_is_refused() {
        let plan = |k: &str| campaign(&format!("block = 4\n{}", PLAN.replace("2.0", k)));
        let (one, other) = (plan("2.0"), plan("3.0"));
        let bytes = write(&one, 1, &one.block(1).map(row).collect::<Vec<_>>()).expect("written");
        assert!(check(&one, 1, file(&bytes)).is_ok());
        assert!(matches!(read(&other, 1, file(&bytes)), Err(TableError::Foreign)));
        assert!(matches!(read(&one, 2, file(&bytes)), Err(TableError::Foreign)), "another block");
        assert!(matches!(read(&one, 1, file(&bytes[..100])), Err(TableError::NoDigest)));
        assert!(matches!(read(&one, 1, file(&[])), Err(TableError::NoDigest)));
    }
}
