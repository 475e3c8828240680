//! The folder of a campaign: its frozen plan, its parts and their cost, and the claims of its workers.

use anyhow::Context;
use campaign::{Campaign, Table, TableError, part};
use command::shared_folder::SharedFolder;
use flight::failure::bad_input;
use foreign::{open_regular, read_regular};
use std::{
    fs,
    path::{Path, PathBuf},
};

const FROZEN: &str = "campaign.json";

/// The folder of a campaign; several machines can work in it at the same time.
#[derive(Debug, Clone)]
pub(crate) struct Folder(SharedFolder);

impl Folder {
    pub(crate) fn new(path: &Path) -> Self {
        Self(SharedFolder::new(path))
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    /// The frozen campaign in this folder.
    pub(crate) fn campaign(&self) -> anyhow::Result<Campaign> {
        let file = self.path().join(FROZEN);
        let refused = |why: &str| bad_input(format!("{}: {why}", file.display()));
        let json = self.0.read(Path::new(FROZEN)).map_err(|error| refused(&error.to_string()))?;
        let missing = || refused("does not exist; create it with `tankops campaign prepare PLAN --out DIR`");
        let json = json.ok_or_else(missing)?;
        Campaign::thaw(&json).map_err(|why| bad_input(format!("{} {why}", file.display())))
    }

    /// Freezes a campaign, unless the same campaign is already frozen here. Returns the campaign in the folder.
    pub(crate) fn freeze(&self, campaign: Campaign) -> anyhow::Result<Campaign> {
        self.0.make(&["parts", "cost"]).map_err(|error| bad_input(format!("{error:#}")))?;
        if self.0.has(Path::new(FROZEN)) {
            let there = self.campaign()?;
            if !there.is_same(&campaign) {
                let what = "contains a different campaign: its plan, scenarios, program or plugins differ";
                return Err(bad_input(format!("{} {what}; choose another --out", self.path().display())));
            }
            return Ok(there);
        }
        self.publish(Path::new(FROZEN), &campaign.to_json()?)?;
        Ok(campaign)
    }

    fn part(block: u64) -> PathBuf {
        Path::new("parts").join(format!("part-{block:05}.parquet"))
    }

    /// Whether the part of a block exists and is intact, byte for byte.
    pub(crate) fn has_part(&self, campaign: &Campaign, block: u64) -> bool {
        matches!(self.check_part(campaign, block), Ok(true))
    }

    /// Whether a block has a part.
    ///
    /// # Errors
    /// The part is damaged, or belongs to a different block or campaign.
    fn check_part(&self, campaign: &Campaign, block: u64) -> anyhow::Result<bool> {
        if !self.0.has(&Self::part(block)) {
            return Ok(false);
        }
        self.with_part(block, |file| part::check(campaign, block, file)).map(|()| true)
    }

    /// Reads the part of a block.
    pub(crate) fn read_part(&self, campaign: &Campaign, block: u64) -> anyhow::Result<Table> {
        self.with_part(block, |file| part::read(campaign, block, file))
    }

    fn with_part<T>(
        &self,
        block: u64,
        read: impl FnOnce(fs::File) -> Result<T, TableError>,
    ) -> anyhow::Result<T> {
        let file = self.path().join(Self::part(block));
        let open = open_regular(&file).with_context(|| file.display().to_string())?;
        read(open).map_err(|why| bad_input(format!("{} {why}; run block {block} again", file.display())))
    }

    /// Publishes the cost of a block, then its rows.
    pub(crate) fn publish_part(&self, block: u64, part: &[u8], cost: &str) -> anyhow::Result<()> {
        self.publish(&Path::new("cost").join(format!("part-{block:05}.jsonl")), cost.as_bytes())?;
        self.publish(&Self::part(block), part)
    }

    /// The blocks without an intact part, and a description of each damaged part.
    pub(crate) fn missing(&self, campaign: &Campaign) -> (Vec<u64>, Vec<String>) {
        let (mut missing, mut damaged) = (Vec::new(), Vec::new());
        for block in 0..campaign.blocks() {
            match self.check_part(campaign, block) {
                Ok(true) => continue,
                Ok(false) => {}
                Err(why) => damaged.push(format!("{why:#}")),
            }
            missing.push(block);
        }
        (missing, damaged)
    }

    /// The core seconds spent on all parts so far.
    pub(crate) fn core_seconds(&self) -> f64 {
        let files = fs::read_dir(self.path().join("cost")).into_iter().flatten().flatten();
        let texts = files.filter_map(|file| read_regular(&file.path()).ok());
        let seconds = |line: &str| serde_json::from_str::<serde_json::Value>(line).ok()?["wall_s"].as_f64();
        texts.map(|text| text.lines().filter_map(seconds).sum::<f64>()).sum()
    }

    /// Writes a file completely or not at all.
    pub(crate) fn publish(&self, name: &Path, bytes: &[u8]) -> anyhow::Result<()> {
        self.0.publish(name, bytes)
    }

    /// Removes temporary files that killed workers left behind.
    pub(crate) fn tidy(&self) {
        self.0.tidy(&["parts", "cost", "."]);
    }

    /// Claims a block for this worker; returns `false` if another worker holds the block.
    pub(crate) fn claim(&self, block: u64) -> bool {
        self.0.claim(&claim_of(block))
    }

    /// Refreshes a claim, so other workers see that its holder is alive.
    pub(crate) fn keep_claim(&self, block: u64) {
        self.0.keep_claim(&claim_of(block));
    }

    /// Releases a block.
    pub(crate) fn release(&self, block: u64) {
        self.0.release(&claim_of(block));
    }
}

fn claim_of(block: u64) -> String {
    format!("{block:05}")
}
