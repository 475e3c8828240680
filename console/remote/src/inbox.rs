//! The messages of a vehicle, folded into what a tick needs. It holds one tick of readings, however many arrive.

mod figures;
mod motion;

use figures::{Ages, ClockOffset};
use motion::Motion;
use std::collections::BTreeMap;
use vehicle::{
    port::{LinkSeen, LinkState, Live, Sensed, Stamps},
    wire::{
        FromVehicle, Heard, Misfit,
        message::{Commander, Hello, Mode, Outline, Readings, State},
    },
};
use world::{ObstacleId, RangeSet, Sighting, StationId};

/// The link counts as lost after this many periods of the readings without one, but not before [`LOST_LEAST_S`].
const LOST_PERIODS: f64 = 5.0;
const LOST_LEAST_S: f64 = 0.5;
/// Ranges that are older than this are dropped: the robot has moved on since then.
const RANGES_MAX_AGE_S: f64 = 0.5;
/// The figures of the link are reported at this interval, seconds.
const FIGURES_EVERY_S: f64 = 10.0;
/// Stamps are rounded to this many steps a second.
const STAMP_STEPS: f64 = 1e4;

/// What arrived.
pub(crate) struct Inbox {
    stations: BTreeMap<String, StationId>,
    hello: Option<Box<Hello>>,
    state: Option<State>,
    motion: Motion,
    /// The readings since the last tick, and their stamps.
    readings: world::Readings,
    stamps: Option<Stamps>,
    last_seq: Option<u64>,
    /// When the last readings arrived, seconds of the console's clock.
    heard_s: Option<f64>,
    heard: u64,
    missed: u64,
    faulty: u64,
    /// The last faults in a row.
    faults_in_row: u32,
    fault: String,
    closed: Option<String>,
    offset: ClockOffset,
    ages: Ages,
    /// What was reported last, and when.
    told: Option<(LinkState, String, f64)>,
}

impl Inbox {
    pub(crate) fn new(stations: BTreeMap<String, StationId>) -> Self {
        Self {
            stations,
            hello: None,
            state: None,
            motion: Motion::default(),
            readings: world::Readings::default(),
            stamps: None,
            last_seq: None,
            heard_s: None,
            heard: 0,
            missed: 0,
            faulty: 0,
            faults_in_row: 0,
            fault: String::new(),
            closed: None,
            offset: ClockOffset::default(),
            ages: Ages::default(),
            told: None,
        }
    }

    /// The introduction of the vehicle, once it has arrived.
    pub(crate) fn hello(&self) -> Option<&Hello> {
        self.hello.as_deref()
    }

    /// Why the stream ended, if it did.
    pub(crate) fn closed(&self) -> Option<&str> {
        self.closed.as_deref()
    }

    /// The last faulty line; empty without one.
    pub(crate) fn fault(&self) -> &str {
        &self.fault
    }

    /// The number of readings so far.
    pub(crate) fn heard(&self) -> u64 {
        self.heard
    }

    pub(crate) fn close(&mut self, why: String) {
        self.closed.get_or_insert(why);
    }

    pub(crate) fn take(&mut self, heard: Heard<FromVehicle>, now_s: f64) {
        match heard {
            Heard::Message(message) => {
                self.faults_in_row = 0;
                match message {
                    FromVehicle::Hello(hello) => self.hello = Some(hello),
                    FromVehicle::Readings(readings) => self.read(&readings, now_s),
                    FromVehicle::State(state) => self.state = Some(state),
                    FromVehicle::Pong(pong) => self.offset.pong(pong, now_s),
                }
            }
            Heard::Malformed(misfit) => self.misfit(&misfit),
            // Keys and messages of newer protocols have no effect.
            Heard::Unknown(_) => {}
        }
    }

    fn misfit(&mut self, misfit: &Misfit) {
        self.faulty += 1;
        self.faults_in_row = self.faults_in_row.saturating_add(1);
        self.fault = foreign::plain(&misfit.to_string()).into_owned();
    }

    /// Adds readings. Readings that arrive twice, or after later ones, are left out: their motion would count twice.
    fn read(&mut self, readings: &Readings, now_s: f64) {
        self.heard_s = Some(now_s);
        let is_late = self.last_seq.is_some_and(|last| readings.seq <= last);
        if is_late {
            return;
        }
        let gap = self.last_seq.map_or(0, |last| readings.seq - last - 1);
        self.last_seq = Some(readings.seq);
        self.heard += 1;
        self.missed += gap;
        let source_t_s = readings.stamp_s;
        self.stamps = Some(Stamps { source_t_s, arrival_t_s: now_s });
        let age_s = self.offset.age_s(source_t_s, now_s);
        self.ages.add(age_s.unwrap_or(0.0));
        self.motion.add(&mut self.readings.odometry, readings);
        self.readings.contact |= readings.contact.unwrap_or(false);
        if let Some(tether) = readings.tether {
            self.readings.paid_out_m = Some(tether.paid_out_m);
        }
        self.readings.pressure_pa = readings.pressure_pa.or(self.readings.pressure_pa);
        self.readings.sightings = readings.outlines.iter().map(sighting).collect();
        if let Some(ae) = readings.ae.as_ref().filter(|_| age_s.is_none_or(|age_s| age_s <= RANGES_MAX_AGE_S))
        {
            self.readings.ranging_cycle = true;
            let heard = ae.ranges.iter().filter_map(|of| {
                Some(RangeSet { station: *self.stations.get(&of.station)?, ranges_m: of.ranges_m.clone() })
            });
            self.readings.ranges = heard.filter(|set| !set.ranges_m.is_empty()).collect();
        }
    }

    /// Hands over what has arrived since the last tick.
    pub(crate) fn sense(&mut self, now_s: f64) -> Sensed {
        let stamps = self.stamps.take().map(|Stamps { source_t_s, arrival_t_s }| Stamps {
            source_t_s: rounded(source_t_s),
            arrival_t_s: rounded(arrival_t_s),
        });
        let readings = std::mem::take(&mut self.readings);
        Sensed { readings, live: Some(Live { stamps, link: self.due_link(now_s) }) }
    }

    fn due_link(&mut self, now_s: f64) -> Option<LinkSeen> {
        let link = self.link(now_s);
        let is_due = self.told.as_ref().is_none_or(|(state, why, told_s)| {
            (*state, why) != (link.state, &link.why) || now_s - told_s >= FIGURES_EVERY_S
        });
        if is_due {
            self.told = Some((link.state, link.why.clone(), now_s));
        }
        is_due.then_some(link)
    }

    /// The state of the link now.
    pub(crate) fn link(&self, now_s: f64) -> LinkSeen {
        let age_s = self.heard_s.map(|heard_s| now_s - heard_s);
        let (state, why) = self.state(age_s);
        LinkSeen {
            state,
            why,
            age_s: age_s.map(rounded),
            offset_s: self.offset.offset_s().map(rounded),
            offset_bound_s: self.offset.bound_s().map(rounded),
            age_p99_s: self.ages.p99_s().map(rounded),
            heard: self.heard,
            missed: self.missed,
            faulty: self.faulty,
        }
    }

    fn state(&self, age_s: Option<f64>) -> (LinkState, String) {
        if let Some(why) = &self.closed {
            return (LinkState::Closed, why.clone());
        }
        let period_s = self.hello.as_ref().map_or(0.0, |hello| hello.period_s);
        let lost_s = (LOST_PERIODS * period_s).max(LOST_LEAST_S);
        if age_s.is_some_and(|age_s| age_s > lost_s) {
            return (LinkState::Lost, format!("no readings for {lost_s:.1} s"));
        }
        if self.faults_in_row >= vehicle::wire::FAULT_AFTER {
            return (LinkState::Faulty, self.fault.clone());
        }
        let Some(state) = &self.state else { return (LinkState::Up, String::new()) };
        let text = foreign::plain(state.text.as_deref().unwrap_or_default()).into_owned();
        match (state.mode, state.commander) {
            (Mode::Ready, Commander::You) => (LinkState::Up, String::new()),
            (Mode::Ready, Commander::OtherConsole) => {
                (LinkState::VehicleFault, "it obeys another console; this one only looks on".into())
            }
            (Mode::Ready, Commander::OtherProgram) => {
                (LinkState::VehicleFault, "another program sends commands to it".into())
            }
            (Mode::Manual, _) => (LinkState::Manual, text),
            (Mode::EmergencyStop, _) => (LinkState::EmergencyStop, text),
            (Mode::Fault, _) => (LinkState::VehicleFault, text),
        }
    }
}

fn rounded(s: f64) -> f64 {
    (s * STAMP_STEPS).round() / STAMP_STEPS + 0.0
}

fn sighting(outline: &Outline) -> Sighting {
    let Outline { id, points_m, radius_m, closed } = outline;
    let points: Vec<world::Point> = points_m.iter().map(|[x, y]| world::Point::new(*x, *y)).collect();
    let shape_in_robot = match (points.as_slice(), closed) {
        ([center], _) => world::Shape::Disc { center: *center, radius_m: *radius_m },
        (_, true) => world::Shape::Polygon { vertices: points },
        (_, false) => world::Shape::Polyline { points, half_width_m: *radius_m },
    };
    Sighting { id: ObstacleId(*id), shape_in_robot }
}

#[cfg(test)]
mod tests;
