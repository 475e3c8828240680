//! Why the guard cannot rely on the scans, before the start and under way.

use super::super::known::Known;
use crate::event::EventKind;
use perception::{Perception, Trouble};
use std::fmt;

/// Maximum age, seconds, of a scan that the guard can use.
pub(super) const MAX_AGE_S: f64 = 0.5;
/// Longest time until the first scan, seconds; until then the robot stands still.
const FIRST_WITHIN_S: f64 = 2.0;

/// Why the guard cannot rely on the scans. Its text is a clause that ends with what to check.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::engine) enum ScanFault {
    /// The last scan cannot be right.
    Wrong(Trouble),
    /// The last scan is this old, seconds.
    Old(f64),
    /// No scan has arrived.
    Missing,
}

impl ScanFault {
    /// Whether another fault has the same cause; its figures may differ.
    fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Wrong(one), Self::Wrong(other)) => one.is_like(other),
            _ => std::mem::discriminant(self) == std::mem::discriminant(other),
        }
    }
}

impl fmt::Display for ScanFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Wrong(trouble) => trouble.fmt(f),
            Self::Old(age_s) => write!(
                f,
                "the last scan is {age_s:.1} s old, so the guard is blind; check the scanner and its connection"
            ),
            Self::Missing => write!(
                f,
                "the vehicle has not sent a scan yet, so the guard is blind; check the scanner and its connection"
            ),
        }
    }
}

impl Known {
    /// Why the guard cannot rely on the scans now; `None` without a guard.
    pub(super) fn scan_fault(&self) -> Option<ScanFault> {
        self.config.guard_reaction_s?;
        if let Some(trouble) = self.perception.as_ref().and_then(Perception::trouble) {
            return Some(ScanFault::Wrong(trouble));
        }
        let guard = &self.scan_guard;
        if guard.has_scan {
            return (guard.age_s > MAX_AGE_S).then_some(ScanFault::Old(guard.age_s));
        }
        (guard.age_s > FIRST_WITHIN_S).then_some(ScanFault::Missing)
    }

    /// Reports that the scans have become unusable, that the reason has changed, or that they can be used again.
    pub(in crate::engine) fn note_scan_fault(&mut self) -> Option<EventKind> {
        let fault = self.scan_fault();
        let before = std::mem::replace(&mut self.scan_guard.told_fault, fault);
        let is_news = match (before, fault) {
            (Some(before), Some(fault)) => !before.is_like(&fault),
            (before, fault) => before.is_some() != fault.is_some(),
        };
        is_news.then(|| EventKind::ScannerJudged { trouble: fault.map(|fault| fault.to_string()) })
    }
}
