//! Combines the parts of a campaign into its table and summary.

use super::folder::Folder;
use anyhow::anyhow;
use campaign::{Campaign, Findings, Table, Watch, findings, page, table};
use flight::failure::bad_input;
use report::print::warn_line;
use sha2::{Digest, Sha256};
use std::path::Path;

/// The results of a merge.
pub(crate) struct Results {
    pub findings: Findings,
    /// The SHA-256 of the table in hexadecimal.
    pub sha256: String,
}

/// The blocks that still have to run. There are none if the blocks before the first missing block already meet the
/// stopping rule. Warns about damaged parts.
pub(crate) fn missing(folder: &Folder, campaign: &Campaign) -> anyhow::Result<Vec<u64>> {
    let (missing, damaged) = folder.missing(campaign);
    let whole = missing.first().copied().unwrap_or(campaign.blocks());
    let enough = enough(campaign, (0..whole).map(|block| folder.read_part(campaign, block)))?;
    if enough.is_some() {
        return Ok(Vec::new());
    }
    for why in &damaged {
        warn_line(why);
    }
    Ok(missing)
}

/// The number of seeds after which the stopping rule is met, with the parts taken in order.
fn enough(
    campaign: &Campaign,
    parts: impl Iterator<Item = anyhow::Result<Table>>,
) -> anyhow::Result<Option<u64>> {
    let Some(mut watch) = Watch::new(campaign) else { return Ok(None) };
    for part in parts {
        if let Some(seeds) = watch.take(&part?) {
            return Ok(Some(seeds));
        }
    }
    Ok(None)
}

/// Combines the parts and writes the table, summary and page; with `partial`, even if parts are missing.
pub(crate) fn merge(folder: &Folder, campaign: &Campaign, partial: bool) -> anyhow::Result<Results> {
    let missing = missing(folder, campaign)?;
    if !missing.is_empty() && !partial {
        let list = list(&missing);
        return Err(bad_input(format!(
            "blocks are missing: {list}; run them, or merge the existing ones with --partial"
        )));
    }
    let there = (0..campaign.blocks()).filter(|block| folder.has_part(campaign, *block));
    let parts: Vec<Table> = there.map(|block| folder.read_part(campaign, block)).collect::<Result<_, _>>()?;
    let failed = |error: table::TableError| anyhow!("merging: {error}");
    let parts = match enough(campaign, parts.iter().cloned().map(Ok))?.filter(|_| missing.is_empty()) {
        Some(seeds) => {
            let rows = (seeds * campaign.per_seed()) as usize;
            vec![Table::joined(&parts).map_err(failed)?.first(rows)]
        }
        None => parts,
    };
    let bytes = table::merged(campaign, &parts).map_err(failed)?;
    let findings = findings(campaign, &Table::joined(&parts).map_err(failed)?);
    folder.publish(Path::new("results.parquet"), &bytes)?;
    folder.publish(Path::new("summary.json"), &serde_json::to_vec_pretty(&findings)?)?;
    folder.publish(
        Path::new("summary.html"),
        page(campaign, &findings).map_err(|why| anyhow!(why))?.as_bytes(),
    )?;
    if missing.is_empty() {
        folder.tidy();
    }
    Ok(Results { findings, sha256: hex::encode(Sha256::digest(&bytes)) })
}

/// Reads a campaign's table, given its folder or the file itself.
pub(crate) fn read(path: &Path) -> anyhow::Result<Table> {
    let file = if path.is_dir() { path.join("results.parquet") } else { path.to_owned() };
    let shown = file.display();
    let open = foreign::open_regular(&file)
        .map_err(|error| bad_input(format!("{shown}: {error}; create it with `tankops campaign merge`")))?;
    let (table, is_proven) = Table::read(open).map_err(|error| bad_input(format!("{shown} {error}")))?;
    if !is_proven {
        let why =
            "it was written by an older tankops or by another program, so damage to it cannot be detected";
        warn_line(&format!("{shown} has no digest: {why}"));
    }
    Ok(table)
}

/// Numbers, with consecutive ones as ranges, as Slurm writes them: `3,7-9`.
pub(crate) fn list(numbers: &[u64]) -> String {
    let runs = numbers.chunk_by(|a, b| *b == a + 1);
    let run = |run: &[u64]| match run {
        [only] => only.to_string(),
        run => format!("{}-{}", run[0], run[run.len() - 1]),
    };
    runs.map(run).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    #[test]
    fn runs_of_numbers_are_ranges() {
        assert_eq!(super::list(&[3, 7, 8, 9, 11]), "3,7-9,11");
        assert_eq!(super::list(&[]), "");
    }
}
