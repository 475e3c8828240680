//! The additions of a real vehicle to each tick: the readings, the link and the stops as events.

use mission::{Event, EventKind};
use vehicle::port::{LEASE_S, LinkSeen, Live, Stood};
use world::Readings;

/// The state of a real vehicle, computed from the events of its run alone.
#[derive(Debug, Clone, Default)]
pub(crate) struct LiveWatch {
    link: LinkSeen,
    /// Whether the last command was to stand still.
    must_stand: bool,
    /// Whether readings have confirmed or disproved a standstill since the last motion was commanded.
    is_decided: bool,
}

impl LiveWatch {
    /// The reason why the vehicle must not be driven now.
    pub(crate) fn trouble(&self) -> Option<String> {
        self.link.trouble()
    }

    /// Whether a commanded stop is still open: odometry has neither confirmed nor disproved it yet.
    pub(crate) fn awaits_stop(&self) -> bool {
        self.must_stand && !self.is_decided
    }

    /// Takes the readings of a tick; returns its events.
    pub(crate) fn sensed(&mut self, readings: &Readings, live: &Live) -> Vec<EventKind> {
        let mut events = Vec::new();
        if let Some(stamps) = live.stamps {
            events.push(EventKind::Sensed {
                source_t_s: stamps.source_t_s,
                arrival_t_s: stamps.arrival_t_s,
                readings: Box::new(readings.clone()),
            });
        }
        if let Some(link) = &live.link {
            self.link = link.clone();
            events.push(EventKind::Link(link.clone()));
        }
        if let Some(Stood { confirmed, after_s }) = live.stood {
            self.is_decided = true;
            events.push(EventKind::Stood { confirmed, after_s });
        }
        events
    }

    /// Takes the command of a tick; returns its event, if it is reported.
    pub(crate) fn sent(&mut self, drive: Option<geometry::Drive>) -> Option<EventKind> {
        let must_stand = drive.is_none();
        let is_told = must_stand && self.must_stand;
        (self.must_stand, self.is_decided) = (must_stand, self.is_decided && must_stand);
        (!is_told).then_some(EventKind::Sent { drive, lease_s: LEASE_S })
    }
}

/// Puts an event before the end of the mission, which is always the last event.
pub(crate) fn before_end(events: &mut Vec<Event>, event: Event) {
    let has_end = matches!(events.last(), Some(Event { kind: EventKind::Ended { .. }, .. }));
    events.insert(events.len() - usize::from(has_end), event);
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Drive;

    #[test]
    fn a_stop_is_awaited_until_readings_decide_it() {
        let mut watch = LiveWatch::default();
        let decided = Live { stood: Some(Stood { confirmed: true, after_s: 0.2 }), ..Live::default() };
        assert!(matches!(watch.sent(None), Some(EventKind::Sent { drive: None, .. })));
        assert!(watch.awaits_stop());
        watch.sensed(&Readings::default(), &Live::default());
        assert_eq!((watch.sent(None), watch.awaits_stop()), (None, true));
        let events = watch.sensed(&Readings::default(), &decided);
        assert!(matches!(events[..], [EventKind::Stood { confirmed: true, .. }]) && !watch.awaits_stop());
        assert!(watch.sent(Some(Drive::STILL)).is_some() && !watch.awaits_stop());
        // The brake was pulled between two ticks, and the stop is confirmed before the tick that commands it.
        watch.sensed(&Readings::default(), &decided);
        assert!(watch.sent(None).is_some() && !watch.awaits_stop());
    }
}
