//! Runs blocks of a campaign on several threads. Each thread takes one mission at a time, so no thread waits for
//! another thread's block.

use super::{folder::Folder, pilot::Pilot};
use crate::stop_signal::StopSignal;
use anyhow::anyhow;
use campaign::{Campaign, Row, Watch, part};
use flight::planners::Found;
use planner_host::PluginDirs;
use std::{
    collections::{BTreeMap, VecDeque},
    ops::Range,
    sync::{
        Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

/// The blocks to run, and the settings for running them.
pub(crate) struct Work<'a> {
    pub campaign: &'a Campaign,
    pub folder: &'a Folder,
    pub plugins: &'a PluginDirs,
    pub found: &'a Found,
    /// The blocks, in order; a block that already has a part is skipped.
    pub blocks: Vec<u64>,
    pub threads: usize,
    /// Whether other workers take blocks from the same folder, so that each block must be claimed first.
    pub pulls: bool,
    /// The limit in core seconds; once it is reached, no further block is started.
    pub budget_s: Option<f64>,
    pub stop: &'a StopSignal,
    /// Called after each mission.
    pub on_row: &'a (dyn Fn(&Row) + Sync),
}

/// The blocks in progress.
#[derive(Default)]
struct Queue<'a> {
    blocks: VecDeque<u64>,
    /// The block whose missions are being handed out, and its remaining missions.
    current: Option<(u64, Range<u64>)>,
    open: BTreeMap<u64, Vec<(Row, String)>>,
    spent_s: f64,
    until: Option<(Watch<'a>, u64)>,
    failure: Option<anyhow::Error>,
}

/// A block whose missions are all finished.
type Whole = (u64, Vec<(Row, String)>);

impl Work<'_> {
    /// Runs until no blocks remain or there is a reason to stop early. Nothing is written for an incomplete block.
    pub(crate) fn fly(&self) -> anyhow::Result<()> {
        let queue = Mutex::new(Queue {
            blocks: self.blocks.iter().copied().collect(),
            spent_s: self.budget_s.map_or(0.0, |_| self.folder.core_seconds()),
            until: Watch::new(self.campaign).map(|watch| (watch, 0)),
            ..Queue::default()
        });
        let is_enough = AtomicBool::new(false);
        self.look(&queue, &is_enough)?;
        std::thread::scope(|scope| {
            for _ in 0..self.threads {
                scope.spawn(|| self.take_turns(&queue, &is_enough));
            }
        });
        let queue = queue.into_inner().unwrap_or_else(PoisonError::into_inner);
        if self.pulls {
            queue.open.keys().for_each(|block| self.folder.release(*block));
        }
        queue.failure.map_or(Ok(()), Err)
    }

    fn take_turns<'q>(&'q self, queue: &Mutex<Queue<'q>>, is_enough: &AtomicBool) {
        let mut pilot = Pilot::new(self.campaign, self.plugins, self.found);
        let is_stopped = || self.stop.requested() || is_enough.load(Ordering::Relaxed);
        while !is_stopped() {
            let Some((block, n)) = self.next(&mut lock(queue)) else { return };
            let began = Instant::now();
            let Some((row, tries)) = pilot.fly(&self.campaign.case(n), is_stopped) else { return };
            (self.on_row)(&row);
            let wall_s = began.elapsed().as_secs_f64();
            let cost = serde_json::json!({ "case": n, "wall_s": wall_s, "tries": tries }).to_string();
            let whole = self.keep(&mut lock(queue), block, (row, cost), wall_s);
            let kept =
                whole.map_or(Ok(()), |whole| self.publish(whole).and_then(|()| self.look(queue, is_enough)));
            if let Err(error) = kept {
                lock(queue).failure.get_or_insert(error);
                is_enough.store(true, Ordering::Relaxed);
            }
        }
    }

    /// Takes the next mission and its block.
    fn next(&self, queue: &mut Queue<'_>) -> Option<(u64, u64)> {
        loop {
            if let Some((block, cases)) = &mut queue.current
                && let Some(n) = cases.next()
            {
                return Some((*block, n));
            }
            if self.budget_s.is_some_and(|budget_s| queue.spent_s >= budget_s) {
                return None;
            }
            let block = queue.blocks.pop_front()?;
            if !self.folder.has_part(self.campaign, block) && (!self.pulls || self.folder.claim(block)) {
                queue.open.insert(block, Vec::new());
                queue.current = Some((block, self.campaign.block(block)));
            }
        }
    }

    /// Stores a row; returns the block with all its rows if this row completes it.
    fn keep(&self, queue: &mut Queue<'_>, block: u64, row: (Row, String), wall_s: f64) -> Option<Whole> {
        queue.spent_s += wall_s;
        let rows = queue.open.get_mut(&block)?;
        rows.push(row);
        if self.pulls {
            self.folder.keep_claim(block);
        }
        let cases = self.campaign.block(block);
        if (rows.len() as u64) < cases.end - cases.start {
            return None;
        }
        Some((block, queue.open.remove(&block)?))
    }

    fn publish(&self, (block, mut rows): Whole) -> anyhow::Result<()> {
        rows.sort_by_key(|(row, _)| row.case);
        let (rows, costs): (Vec<Row>, Vec<String>) = rows.into_iter().unzip();
        let part =
            part::write(self.campaign, block, &rows).map_err(|error| anyhow!("block {block}: {error}"))?;
        self.folder.publish_part(block, &part, &(costs.join("\n") + "\n"))?;
        if self.pulls {
            self.folder.release(block);
        }
        Ok(())
    }

    /// Checks whether the blocks before the first missing block already meet the stopping rule.
    fn look(&self, queue: &Mutex<Queue<'_>>, is_enough: &AtomicBool) -> anyhow::Result<()> {
        let mut queue = lock(queue);
        let Some((watch, next)) = &mut queue.until else { return Ok(()) };
        while *next < self.campaign.blocks() && self.folder.has_part(self.campaign, *next) {
            let part = self.folder.read_part(self.campaign, *next)?;
            *next += 1;
            if watch.take(&part).is_some() {
                is_enough.store(true, Ordering::Relaxed);
                return Ok(());
            }
        }
        Ok(())
    }
}

fn lock<'q, 'a>(queue: &'q Mutex<Queue<'a>>) -> MutexGuard<'q, Queue<'a>> {
    queue.lock().unwrap_or_else(PoisonError::into_inner)
}
