//! The lines that pass a filter, kept up to date as lines arrive and the filter changes. Consecutive messages of a
//! planner about its own work form one group. A planner's warning that it gave before, with other figures, is listed once,
//! at its last occurrence.

use super::alike::{are_alike, is_warning};
use super::entry::Entry;
use super::filter::Filter;
use super::lines::Log;
use mission::{EventKind, Severity};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The lines that pass a filter.
///
/// Each new line is tested once, and the newest one again when it is repeated. All lines are tested again only when the
/// filter changes, which takes 2 to 6 ms for 100,000 lines (bench `events`).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Matches {
    text: String,
    filter: Filter,
    /// The lines that pass, ascending.
    found: VecDeque<Group>,
    /// The number of the first line that has not been tested yet.
    seen: u64,
    /// How often the last of these lines had been repeated when it was tested, and its time.
    #[serde(default)]
    newest: Option<(u32, f64)>,
}

/// Lines that are listed as one: a single line, or messages of one planner about its own work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
struct Group {
    first: u64,
    last: u64,
    lines: u32,
    /// How often a planner gave the warning of the line before.
    #[serde(default)]
    again: u32,
}

/// The number of listed lines among which the earlier occurrence of a warning is looked for: the lines of a few plans.
const NEAR: usize = 64;

/// A listed line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Listed<'a> {
    /// The number of the line in the log.
    pub number: u64,
    /// The line.
    pub entry: &'a Entry,
    /// The number of earlier lines that are listed with this one.
    pub more: u32,
    /// How often the line occurred.
    pub times: u32,
}

impl Matches {
    /// Updates the matches to a filter and a log.
    pub fn refresh(&mut self, text: &str, log: &Log) {
        if self.text != text {
            *self = Self { text: text.to_owned(), filter: Filter::parse(text), ..Self::default() };
        }
        // A new run begins with fewer lines.
        if self.seen > log.end() {
            (self.seen, self.newest) = (0, None);
            self.found.clear();
        }
        let repeated = self.seen.checked_sub(1).filter(|number| stamp(log, *number) != self.newest);
        if repeated.is_none() && self.seen == log.end() {
            return;
        }
        let retested = repeated.filter(|number| !self.stays(log, *number));
        let mut from = retested.unwrap_or(self.seen).max(log.oldest());
        let mut popped = Vec::new();
        while let Some(group) = self.found.pop_back_if(|group| group.last >= from) {
            from = from.min(group.first.max(log.oldest()));
            popped.push(group);
        }
        while self.found.pop_front_if(|group| group.last < log.oldest()).is_some() {}
        if let Some(cut) = self.found.pop_front_if(|group| group.first < log.oldest()) {
            self.restore(log, cut.last);
        }
        for number in log.passing(&self.filter, from) {
            Self::add(&mut self.found, log, number);
            // The earlier occurrences of a warning have left the list.
            let before = popped.iter().find(|group| group.first == number).map_or(0, |group| group.again);
            if let Some(group) = self.found.back_mut().filter(|group| group.first == number) {
                group.again = group.again.max(before);
            }
        }
        self.seen = log.end();
        self.newest = log.newest().and_then(|number| stamp(log, number));
    }

    /// Whether a line that was repeated is listed, or not listed, as before.
    fn stays(&self, log: &Log, number: u64) -> bool {
        let passes = log.passing(&self.filter, number).next() == Some(number);
        match self.found.back().filter(|group| group.last == number) {
            // A single line may join the group before it.
            Some(group) => passes && group.first < number && belongs(log, group.first, number),
            None => !passes,
        }
    }

    /// Adds a passing line to a list.
    fn add(found: &mut VecDeque<Group>, log: &Log, number: u64) {
        match found.back_mut() {
            Some(group) if belongs(log, group.last, number) => {
                (group.last, group.lines) = (number, group.lines + 1);
            }
            _ => {
                let again = Self::take_alike(found, log, number).unwrap_or_default();
                found.push_back(Group { first: number, last: number, lines: 1, again });
            }
        }
    }

    /// Removes the earlier occurrence of a planner's warning from a list; returns how often the warning has been given.
    fn take_alike(found: &mut VecDeque<Group>, log: &Log, number: u64) -> Option<u32> {
        let warning = log.get(number).filter(|entry| is_warning(entry))?;
        let is_alike = |group: &Group| log.get(group.last).is_some_and(|before| are_alike(before, warning));
        let back = found.iter().rev().take(NEAR).position(is_alike)?;
        let group = found.remove(found.len() - 1 - back)?;
        Some(group.again.saturating_add(log.get(group.last)?.count))
    }

    /// Replaces the group up to `last`, of which the first lines have been dropped from the log.
    fn restore(&mut self, log: &Log, last: u64) {
        let mut kept = VecDeque::new();
        for number in log.passing(&self.filter, log.oldest()).take_while(|number| *number <= last) {
            Self::add(&mut kept, log, number);
        }
        kept.into_iter().rev().for_each(|group| self.found.push_front(group));
    }

    /// The parsed filter.
    pub fn filter(&self) -> &Filter {
        &self.filter
    }

    /// The number of lines that pass.
    pub fn len(&self) -> usize {
        self.found.len()
    }

    /// Whether no line passes.
    pub fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// The number of passing lines that are newer than the given one.
    pub fn newer_than(&self, number: u64) -> usize {
        self.found.len() - self.found.partition_point(|group| group.first <= number)
    }

    /// The number of the passing line that is followed by `newer` newer ones; the oldest line if there are fewer.
    pub fn number(&self, newer: usize) -> Option<u64> {
        let index = self.found.len().checked_sub(1)?.saturating_sub(newer);
        self.found.get(index).map(|group| group.last)
    }

    /// The listed lines, newest first, skipping the first `skip`.
    pub fn newest<'a>(&'a self, log: &'a Log, skip: usize) -> impl Iterator<Item = Listed<'a>> {
        self.found.iter().rev().skip(skip).filter_map(|group| {
            let entry = log.get(group.last)?;
            let times = entry.count.saturating_add(group.again);
            Some(Listed { number: group.last, entry, more: group.lines - 1, times })
        })
    }

    /// The earlier lines that are listed with a line, newest first.
    pub fn grouped<'a>(&self, log: &'a Log, number: u64) -> impl Iterator<Item = &'a Entry> {
        let group = self.found.iter().rev().find(|group| (group.first..=group.last).contains(&number));
        let again = group.is_some_and(|group| group.again > 0);
        let before =
            group.map_or(number..number, |group| if again { 0..group.last } else { group.first..group.last });
        let of = log.get(number).filter(|_| again);
        let is_with = move |entry: &&Entry| match of {
            Some(warning) => are_alike(entry, warning),
            None => entry.severity == Severity::Debug,
        };
        before.rev().map_while(|number| log.get(number)).filter(is_with)
    }

    /// The next line of the same kind within the next `among` lines, or within the preceding ones if `back` is set.
    pub fn next_like(&self, log: &Log, number: u64, back: bool, among: usize) -> Option<u64> {
        let what = &log.get(number)?.what;
        let at = self.found.partition_point(|group| group.last < number);
        let is_like = |other: &u64| log.get(*other).is_some_and(|other| other.what.is_like(what));
        if back {
            self.found.range(..at).rev().map(|group| group.last).take(among).find(is_like)
        } else {
            let after = self.found.range(at..).skip_while(|group| group.first <= number);
            after.map(|group| group.last).take(among).find(is_like)
        }
    }
}

/// How often a line has been repeated, and its time.
fn stamp(log: &Log, number: u64) -> Option<(u32, f64)> {
    log.get(number).map(|entry| (entry.count, entry.t_s))
}

/// Whether two passing lines are listed as one.
fn belongs(log: &Log, one: u64, next: u64) -> bool {
    let planner = |number| {
        let entry = log.get(number).filter(|entry| entry.severity == Severity::Debug)?;
        match &entry.what.event()?.kind {
            EventKind::PlannerLogged { planner, .. } => Some(planner),
            _ => None,
        }
    };
    planner(one).is_some_and(|planner_of_one| Some(planner_of_one) == planner(next))
}

#[cfg(test)]
mod tests;
