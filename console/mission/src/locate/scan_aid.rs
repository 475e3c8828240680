//! Scans as an aid to the position: the pose that the last scan shows, and whether such poses are used.

use crate::event::EventKind;
use perception::Matched;
use positioning::Positioner;

/// Scans count as no aid after this number of scans in a row that were not used.
const UNUSED: u32 = 10;

/// The use of scans so far.
#[derive(Debug, Clone, Default)]
pub(super) struct ScanAid {
    /// Whether a scan has arrived since the last correction, and the pose that it showed.
    is_new: bool,
    next: Option<Matched>,
    unused: u32,
    /// Whether scans were used according to the last event.
    told: Option<bool>,
}

impl ScanAid {
    /// Keeps what a scan shows for the next tick.
    pub(super) fn keep(&mut self, matched: Option<Matched>) {
        (self.is_new, self.next) = (true, matched);
    }

    /// Corrects the estimate by the last scan; returns whether scans have begun to help, or have ceased to.
    pub(super) fn correct(&mut self, positioner: &mut Positioner) -> Option<EventKind> {
        if !std::mem::take(&mut self.is_new) {
            return None;
        }
        let trouble = match self.next {
            None => Some("too few of their points are on the wall or on drawn obstacles"),
            Some(Matched { pose, covariance }) => (!positioner.take_pose(&pose, &covariance))
                .then_some("they contradict the estimated position"),
        };
        self.unused = if trouble.is_some() { self.unused.saturating_add(1) } else { 0 };
        let helps = match trouble {
            None => true,
            Some(_) if self.unused >= UNUSED => false,
            Some(_) => return None,
        };
        let is_news = self.told.replace(helps) != Some(helps);
        is_news.then(|| EventKind::ScanAided { trouble: trouble.map(str::to_owned) })
    }
}
