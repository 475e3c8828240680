//! The part of a tick that only a real vehicle needs: events about its readings and its link, and the check that it
//! stands still when commanded to stop.

use mission::{Event, EventKind};
use vehicle::port::{LEASE_S, LinkSeen, Live, VehicleInfo};
use world::{Odometry, Readings};

/// Speeds, metres and radians per second, up to which a vehicle counts as standing.
const STANDS_M_PER_S: f64 = 0.005;
const STANDS_RAD_PER_S: f64 = 0.02;
/// Number of readings in a row that must show a standing vehicle.
const STANDS_READINGS: u32 = 2;
/// Maximum duration of a stop, as a multiple of the vehicle's own stop time.
const STOP_FACTOR: f64 = 2.0;
/// The least time after which a stop can be reported as not confirmed, seconds.
const STOP_LEAST_S: f64 = 0.5;

/// The state of a real vehicle, computed from the events of its run alone.
#[derive(Debug, Clone)]
pub(crate) struct LiveWatch {
    link: LinkSeen,
    stop: Stop,
    /// Time that the vehicle may take to stop, seconds.
    stop_s: f64,
    tick_s: f64,
}

/// The progress of a stop.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Stop {
    /// The vehicle may move.
    None,
    /// The vehicle was commanded to stand; odometry has not yet shown whether it does.
    Awaited { for_s: f64, standing: u32 },
    /// The vehicle moves although it should stand by now.
    Missed { for_s: f64, standing: u32 },
    /// The vehicle stands.
    Confirmed { for_s: f64, moving: u32 },
}

impl LiveWatch {
    pub(crate) fn new(info: &VehicleInfo, tick_s: f64) -> Self {
        let stop_s = (STOP_FACTOR * info.stop_s).max(STOP_LEAST_S);
        Self { link: LinkSeen::default(), stop: Stop::None, stop_s, tick_s }
    }

    /// The reason why the vehicle must not be driven now.
    pub(crate) fn trouble(&self) -> Option<String> {
        self.link.trouble()
    }

    /// Whether odometry has not yet shown whether the vehicle carried out a commanded stop.
    pub(crate) fn awaits_stop(&self) -> bool {
        matches!(self.stop, Stop::Awaited { .. })
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
        let odometry = live.stamps.map(|_| readings.odometry);
        let (stop, event) = self.stop.next(odometry, self.tick_s, self.stop_s);
        self.stop = stop;
        events.extend(event);
        events
    }

    /// Takes the command of a tick; returns its event, if it is reported.
    pub(crate) fn sent(&mut self, drive: Option<geometry::Drive>) -> Option<EventKind> {
        let was_stopping = self.stop != Stop::None;
        match drive {
            Some(_) => self.stop = Stop::None,
            None if !was_stopping => self.stop = Stop::Awaited { for_s: 0.0, standing: 0 },
            None => return None,
        }
        Some(EventKind::Sent { drive, lease_s: LEASE_S })
    }
}

impl Stop {
    /// The state after a tick with this odometry (`None` if no reading arrived), and the event if the odometry has
    /// decided whether the vehicle stopped.
    fn next(self, odometry: Option<Odometry>, tick_s: f64, stop_s: f64) -> (Self, Option<EventKind>) {
        let stands = odometry.map(|odometry| stands(odometry, tick_s));
        let count = |n: u32| match stands {
            Some(true) => n + 1,
            Some(false) => 0,
            None => n,
        };
        let stood = |confirmed, after_s| Some(EventKind::Stood { confirmed, after_s });
        match self {
            Self::None => (self, None),
            Self::Awaited { for_s, standing } | Self::Missed { for_s, standing } => {
                let (for_s, standing) = (for_s + tick_s, count(standing));
                if standing >= STANDS_READINGS {
                    return (Self::Confirmed { for_s, moving: 0 }, stood(true, for_s));
                }
                let is_missed = matches!(self, Self::Missed { .. });
                if is_missed || for_s <= stop_s {
                    let awaited = Self::Awaited { for_s, standing };
                    return (if is_missed { Self::Missed { for_s, standing } } else { awaited }, None);
                }
                (Self::Missed { for_s, standing }, stood(false, for_s))
            }
            Self::Confirmed { for_s, moving } => {
                let (for_s, moving) = (for_s + tick_s, if stands == Some(false) { moving + 1 } else { 0 });
                if moving < STANDS_READINGS {
                    return (Self::Confirmed { for_s, moving }, None);
                }
                (Self::Missed { for_s, standing: 0 }, stood(false, for_s))
            }
        }
    }
}

fn stands(Odometry { forward_m, sideways_m, turn_rad }: Odometry, tick_s: f64) -> bool {
    forward_m.hypot(sideways_m) <= STANDS_M_PER_S * tick_s && turn_rad.abs() <= STANDS_RAD_PER_S * tick_s
}

/// Puts an event before the end of the mission, which is always the last event.
pub(crate) fn before_end(events: &mut Vec<Event>, event: Event) {
    let has_end = matches!(events.last(), Some(Event { kind: EventKind::Ended { .. }, .. }));
    events.insert(events.len() - usize::from(has_end), event);
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK_S: f64 = 0.1;

    /// The events of a stop, from the speeds that the odometry shows in each tick; `None` if no reading arrives.
    fn decided(speeds: &[Option<f64>]) -> Vec<(usize, bool)> {
        let mut stop = Stop::Awaited { for_s: 0.0, standing: 0 };
        let mut found = Vec::new();
        for (tick, speed) in speeds.iter().enumerate() {
            let odometry =
                speed.map(|m_per_s| Odometry { forward_m: m_per_s * TICK_S, ..Odometry::default() });
            let (next, event) = stop.next(odometry, TICK_S, 0.5);
            stop = next;
            if let Some(EventKind::Stood { confirmed, .. }) = event {
                found.push((tick, confirmed));
            }
        }
        found
    }

    #[test]
    fn a_stop_is_confirmed_by_two_readings_that_show_a_standing_vehicle() {
        assert_eq!(decided(&[Some(0.3), Some(0.1), Some(0.0), None, Some(0.0)]), [(4, true)]);
        assert_eq!(decided(&[Some(0.0), Some(0.3), Some(0.0), Some(0.0)]), [(3, true)]);
    }

    #[test]
    fn a_vehicle_that_moves_on_or_is_silent_is_not_confirmed_until_it_stands() {
        assert_eq!(decided(&[Some(0.3); 9]), [(5, false)]);
        assert_eq!(decided(&[None; 9]), [(5, false)]);
        let late = [[Some(0.3); 7].as_slice(), &[Some(0.0); 2]].concat();
        assert_eq!(decided(&late), [(5, false), (8, true)]);
    }

    #[test]
    fn a_vehicle_that_moves_again_without_an_order_is_reported() {
        let moves = [[Some(0.0); 3].as_slice(), &[Some(0.1); 3], &[Some(0.0); 3]].concat();
        assert_eq!(decided(&moves), [(1, true), (4, false), (7, true)]);
    }
}
