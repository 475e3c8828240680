//! The folder of a campaign: what is frozen, the parts, what they cost, and who works on what.

use anyhow::Context;
use campaign::{Campaign, Table, table};
use flight::failure::bad_input;
use runs::write_by_draft;
use std::{
    fs::{self, File},
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

const FROZEN: &str = "campaign.json";
/// A claim whose holder has not said anything for so long is void.
const CLAIM_LASTS: Duration = Duration::from_mins(10);

/// The folder of a campaign; several machines may work in it at once.
#[derive(Debug, Clone)]
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(path: &Path) -> Self {
        Self(path.to_owned())
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// The campaign that was frozen here.
    pub(crate) fn campaign(&self) -> anyhow::Result<Campaign> {
        let file = self.0.join(FROZEN);
        let json = fs::read(&file).map_err(|error| {
            bad_input(format!(
                "{}: {error}; `tankops campaign prepare PLAN --out DIR` makes one",
                file.display()
            ))
        })?;
        Campaign::thaw(&json).map_err(|why| bad_input(format!("{} {why}", file.display())))
    }

    /// Freezes a campaign, unless the same one is here already; gives the one that is here now.
    pub(crate) fn freeze(&self, campaign: Campaign) -> anyhow::Result<Campaign> {
        for inner in ["parts", "cost", "claims"] {
            let folder = self.0.join(inner);
            fs::create_dir_all(&folder)
                .map_err(|error| bad_input(format!("{}: {error}", folder.display())))?;
        }
        if self.0.join(FROZEN).exists() {
            let there = self.campaign()?;
            if !there.is_same(&campaign) {
                let what = "holds another campaign: plan, scenarios, program or plugins differ";
                return Err(bad_input(format!("{} {what}; choose another --out", self.0.display())));
            }
            return Ok(there);
        }
        self.publish(Path::new(FROZEN), &serde_json::to_vec_pretty(&campaign)?)?;
        Ok(campaign)
    }

    fn part(block: u64) -> PathBuf {
        Path::new("parts").join(format!("part-{block:05}.parquet"))
    }

    pub(crate) fn has_part(&self, block: u64) -> bool {
        self.0.join(Self::part(block)).exists()
    }

    /// Reads a part.
    pub(crate) fn read_part(&self, campaign: &Campaign, block: u64) -> anyhow::Result<Table> {
        let file = self.0.join(Self::part(block));
        let read = File::open(&file).with_context(|| file.display().to_string())?;
        let remedy = "delete it, then fly the block again";
        table::read_part(campaign, read)
            .map_err(|why| bad_input(format!("{}: {why}; {remedy}", file.display())))
    }

    /// Publishes the rows of a block, after what they cost.
    pub(crate) fn publish_part(&self, block: u64, part: &[u8], cost: &str) -> anyhow::Result<()> {
        self.publish(&Path::new("cost").join(format!("part-{block:05}.jsonl")), cost.as_bytes())?;
        self.publish(&Self::part(block), part)
    }

    /// Blocks without a part.
    pub(crate) fn missing(&self, campaign: &Campaign) -> Vec<u64> {
        (0..campaign.blocks()).filter(|block| !self.has_part(*block)).collect()
    }

    /// Seconds that one core took for all parts so far.
    pub(crate) fn core_seconds(&self) -> f64 {
        let files = fs::read_dir(self.0.join("cost")).into_iter().flatten().flatten();
        let texts = files.filter_map(|file| fs::read_to_string(file.path()).ok());
        let seconds = |line: &str| serde_json::from_str::<serde_json::Value>(line).ok()?["wall_s"].as_f64();
        texts.map(|text| text.lines().filter_map(seconds).sum::<f64>()).sum()
    }

    /// Writes a file whole or not at all: under another name, to the disk, then renamed.
    pub(crate) fn publish(&self, name: &Path, bytes: &[u8]) -> anyhow::Result<()> {
        let file = self.0.join(name);
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_nanos();
        let draft = file.with_extension(format!("draft-{}-{now}", std::process::id()));
        write_by_draft(&file, &draft, bytes).with_context(|| format!("writing {}", file.display()))
    }

    /// Removes what killed workers have left.
    pub(crate) fn tidy(&self) {
        for inner in ["parts", "cost", "."] {
            let files = fs::read_dir(self.0.join(inner)).into_iter().flatten().flatten();
            let is_draft = |file: &PathBuf| {
                file.extension().is_some_and(|extension| extension.to_string_lossy().starts_with("draft-"))
            };
            // A draft that stays behind harms nobody.
            files.map(|file| file.path()).filter(is_draft).for_each(|file| drop(fs::remove_file(file)));
        }
    }

    fn claim_file(&self, block: u64) -> PathBuf {
        self.0.join("claims").join(format!("{block:05}"))
    }

    /// Takes a block for this worker alone; false if another one has it.
    pub(crate) fn claim(&self, block: u64) -> bool {
        let claim = self.claim_file(block);
        let age = fs::metadata(&claim)
            .and_then(|claim| claim.modified())
            .map(|at| at.elapsed().unwrap_or_default());
        if age.is_ok_and(|age| age > CLAIM_LASTS) {
            // Two that find it void make at worst the same part twice.
            let _ = fs::remove_file(&claim);
        }
        File::create_new(&claim).is_ok()
    }

    /// Says that the holder of a claim is alive.
    pub(crate) fn keep_claim(&self, block: u64) {
        let touched = File::options().write(true).open(self.claim_file(block));
        // Without it the block is at worst flown twice.
        drop(touched.and_then(|claim| claim.set_modified(SystemTime::now())));
    }

    /// Gives a block back.
    pub(crate) fn release(&self, block: u64) {
        // A claim that stays is void after a while.
        let _ = fs::remove_file(self.claim_file(block));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_taken_once_and_void_when_its_holder_is_silent() {
        let here = tempfile::tempdir().expect("a folder");
        fs::create_dir(here.path().join("claims")).expect("a folder");
        let folder = Folder::new(here.path());
        assert!(folder.claim(3) && !folder.claim(3) && folder.claim(4));
        let silent = File::options().write(true).open(here.path().join("claims/00003")).expect("a claim");
        silent.set_modified(SystemTime::now() - CLAIM_LASTS - Duration::from_secs(1)).expect("set");
        assert!(folder.claim(3) && !folder.claim(3));
        folder.release(3);
        assert!(folder.claim(3));
    }

    #[test]
    fn a_file_is_published_whole_and_drafts_are_tidied() {
        let here = tempfile::tempdir().expect("a folder");
        let folder = Folder::new(here.path());
        folder.publish(Path::new("a.json"), b"{}").expect("written");
        fs::write(here.path().join("a.draft-1-2"), "half").expect("written");
        folder.tidy();
        let names: Vec<_> =
            fs::read_dir(here.path()).expect("read").flatten().map(|file| file.file_name()).collect();
        assert_eq!(names, ["a.json"]);
    }
}
