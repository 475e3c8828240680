//! The additions of a real vehicle to each tick: the readings, the link and the stops as events.

use mission::{Event, EventKind};
use vehicle::port::{LEASE_S, LinkSeen, Live, Stamps, Stood};
use world::Readings;

/// The state of a real vehicle, computed from the events of its run alone.
#[derive(Debug, Clone, Default)]
pub(crate) struct LiveWatch {
    link: LinkSeen,
    /// Whether the last command was to stand still.
    must_stand: bool,
    /// Whether readings have confirmed or disproved a standstill since the last motion was commanded.
    is_decided: bool,
    /// The last result of a commanded stop.
    stood: Option<Stood>,
    /// Age of the newest readings, seconds.
    age_s: f64,
}

impl LiveWatch {
    /// The reason why the vehicle must not be driven now. Before the start, the vehicle must also stand still.
    pub(crate) fn trouble(&self, is_waiting: bool) -> Option<String> {
        let moves = || self.stood.filter(|_| is_waiting)?.trouble().map(str::to_owned);
        self.link.trouble().or_else(moves)
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
        events.extend(live.notices.iter().cloned().map(EventKind::Noticed));
        if let Some(link) = &live.link {
            self.link = link.clone();
            events.push(EventKind::Link(link.clone()));
        }
        if let Some(stood @ Stood { confirmed, after_s, moved }) = live.stood {
            (self.is_decided, self.stood) = (true, Some(stood));
            events.push(EventKind::Stood { confirmed, after_s, moved });
        }
        events
    }

    /// Age of the newest readings at the beginning of a tick of `tick_s`, seconds; until the clocks have been compared,
    /// readings count as new when they arrive.
    pub(crate) fn age_s(&mut self, stamps: Option<Stamps>, tick_s: f64) -> f64 {
        self.age_s = match stamps {
            Some(Stamps { source_t_s, arrival_t_s }) => {
                let taken_s = self.link.offset_s.map_or(arrival_t_s, |offset_s| source_t_s - offset_s);
                (arrival_t_s - taken_s).max(0.0)
            }
            None => self.age_s + tick_s,
        };
        self.age_s
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
        let stood = Stood { confirmed: true, after_s: 0.2, moved: false };
        let decided = Live { stood: Some(stood), ..Live::default() };
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

    #[test]
    fn readings_age_on_their_way_and_while_no_others_arrive() {
        let mut watch = LiveWatch::default();
        let stamps = Some(Stamps { source_t_s: 107.9, arrival_t_s: 8.15 });
        assert!(watch.age_s(stamps, 0.1) < 1e-9);
        let link = LinkSeen { offset_s: Some(100.0), ..LinkSeen::default() };
        watch.sensed(&Readings::default(), &Live { link: Some(link), ..Live::default() });
        let later = Some(Stamps { source_t_s: 108.3, arrival_t_s: 8.28 });
        let ages_ms = [stamps, None, later].map(|stamps| (watch.age_s(stamps, 0.1) * 1e3).round() as i64);
        assert_eq!(ages_ms, [250, 350, 0]);
    }

    #[test]
    fn a_vehicle_that_moves_without_an_order_is_in_trouble_before_the_start_only() {
        let mut watch = LiveWatch::default();
        let stood = |confirmed| Live {
            stood: Some(Stood { confirmed, after_s: 0.2, moved: !confirmed }),
            ..Live::default()
        };
        watch.sensed(&Readings::default(), &stood(false));
        assert!(watch.trouble(true).is_some_and(|why| why.contains("without an order")));
        assert_eq!(watch.trouble(false), None);
        watch.sensed(&Readings::default(), &stood(true));
        assert_eq!(watch.trouble(true), None);
    }
}
