//! The folder of a campaign: what is frozen, the parts, what they cost, and who works on what.

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

/// The folder of a campaign; several machines may work in it at once.
#[derive(Debug, Clone)]
pub(crate) struct Folder(SharedFolder);

impl Folder {
    pub(crate) fn new(path: &Path) -> Self {
        Self(SharedFolder::new(path))
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    /// The campaign that was frozen here.
    pub(crate) fn campaign(&self) -> anyhow::Result<Campaign> {
        let file = self.path().join(FROZEN);
        let refused = |why: &str| bad_input(format!("{}: {why}", file.display()));
        let json = self.0.read(Path::new(FROZEN)).map_err(|error| refused(&error.to_string()))?;
        let missing = || refused("there is none; `tankops campaign prepare PLAN --out DIR` makes one");
        let json = json.ok_or_else(missing)?;
        Campaign::thaw(&json).map_err(|why| bad_input(format!("{} {why}", file.display())))
    }

    /// Freezes a campaign, unless the same one is here already; gives the one that is here now.
    pub(crate) fn freeze(&self, campaign: Campaign) -> anyhow::Result<Campaign> {
        self.0.make(&["parts", "cost"]).map_err(|error| bad_input(format!("{error:#}")))?;
        if self.0.has(Path::new(FROZEN)) {
            let there = self.campaign()?;
            if !there.is_same(&campaign) {
                let what = "holds another campaign: plan, scenarios, program or plugins differ";
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

    /// Whether the part of a block is there, byte for byte as it was written.
    pub(crate) fn has_part(&self, campaign: &Campaign, block: u64) -> bool {
        matches!(self.check_part(campaign, block), Ok(true))
    }

    /// Whether there is a part of a block.
    ///
    /// # Errors
    /// It is damaged, or not the part of this block.
    fn check_part(&self, campaign: &Campaign, block: u64) -> anyhow::Result<bool> {
        if !self.0.has(&Self::part(block)) {
            return Ok(false);
        }
        self.with_part(block, |file| part::check(campaign, block, file)).map(|()| true)
    }

    /// Reads a part.
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
        read(open).map_err(|why| bad_input(format!("{} {why}; fly block {block} again", file.display())))
    }

    /// Publishes the rows of a block, after what they cost.
    pub(crate) fn publish_part(&self, block: u64, part: &[u8], cost: &str) -> anyhow::Result<()> {
        self.publish(&Path::new("cost").join(format!("part-{block:05}.jsonl")), cost.as_bytes())?;
        self.publish(&Self::part(block), part)
    }

    /// Blocks without a whole part, and what is wrong with the parts that are there and not whole.
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

    /// Seconds that one core took for all parts so far.
    pub(crate) fn core_seconds(&self) -> f64 {
        let files = fs::read_dir(self.path().join("cost")).into_iter().flatten().flatten();
        let texts = files.filter_map(|file| read_regular(&file.path()).ok());
        let seconds = |line: &str| serde_json::from_str::<serde_json::Value>(line).ok()?["wall_s"].as_f64();
        texts.map(|text| text.lines().filter_map(seconds).sum::<f64>()).sum()
    }

    /// Writes a file whole or not at all.
    pub(crate) fn publish(&self, name: &Path, bytes: &[u8]) -> anyhow::Result<()> {
        self.0.publish(name, bytes)
    }

    /// Removes what killed workers have left.
    pub(crate) fn tidy(&self) {
        self.0.tidy(&["parts", "cost", "."]);
    }

    /// Takes a block for this worker alone; false if another one has it.
    pub(crate) fn claim(&self, block: u64) -> bool {
        self.0.claim(&claim_of(block))
    }

    /// Says that the holder of a claim is alive.
    pub(crate) fn keep_claim(&self, block: u64) {
        self.0.keep_claim(&claim_of(block));
    }

    /// Gives a block back.
    pub(crate) fn release(&self, block: u64) {
        self.0.release(&claim_of(block));
    }
}

fn claim_of(block: u64) -> String {
    format!("{block:05}")
}
