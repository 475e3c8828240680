//! The inbox folds the messages of a vehicle into the input of a tick. Its memory does not grow with the number of
//! messages.

mod ages;
mod notices;
mod outlines;

use crate::taking::info;
use ages::Ages;
use notices::Notices;
use outlines::Outlines;
use std::collections::{BTreeMap, BTreeSet};
use vehicle::{
    link::{Hold, Link, Motions, Sequence, State as Reached},
    port::{LinkSeen, LinkState, Live, Notice, Sensed, Stamps, Stood},
    wire::{
        FromVehicle, Heard, ToVehicle,
        message::{Commander, Hello, Mode, Odometry, Readings, Scan, State},
    },
};
use world::{
    PulseSet, RangeSet, StationId,
    scan::{LONGEST_M, RangesMm},
};

/// Longest time from `hello` until the first `readings`, `state` and `pong`, seconds.
const FIRST_WITHIN_S: f64 = 10.0;
/// Age of the last `state` above which the link counts as lost, seconds. A vehicle sends one a second, and several in a
/// row may get lost.
const STATE_WITHIN_S: f64 = 6.0;
/// Longest time, seconds, for which all readings may be ignored because their numbers are not new.
const UNREAD_S: f64 = 0.8;
/// Readings that are not new still arrive if the last ones are not older than this, seconds and periods.
const ARRIVED_S: f64 = 0.4;
const ARRIVED_PERIODS: f64 = 2.0;
/// The reason for a loss if the numbers of readings are not new.
const REPEATED: &str = "its readings repeat the numbers of earlier ones";
/// Ranges that are older than this are dropped: the robot has moved on since then.
const RANGES_MAX_AGE_S: f64 = 0.5;
/// Interval at which the figures of the link are reported, seconds.
const FIGURES_EVERY_S: f64 = 10.0;
/// Time without a tick and without a message to the vehicle, seconds, after which the console itself counts as having been
/// stopped. A running console sends a ping every 0.2 s, even if its ticks are late.
const STOPPED_S: f64 = 0.8;
/// Readings whose stamps are older than this although they have just arrived, seconds, count as old by their stamps.
const JUST_NOW_S: f64 = 0.4;
/// Stamps are rounded to this many steps per second.
const STAMP_STEPS: f64 = 1e4;

/// The messages that arrived.
pub(crate) struct Inbox {
    stations: BTreeMap<String, StationId>,
    /// The address of the adapter.
    at: String,
    /// The first introduction: that of the vehicle of this run.
    first: Option<Box<Hello>>,
    /// The last introduction, and its differences from the first one; empty for the same vehicle.
    hello: Option<Box<Hello>>,
    differs: Vec<String>,
    /// The last time at which the console itself was running, seconds.
    awake_s: Option<f64>,
    /// Length of the last time for which the console itself was stopped, until it is reported, and of all such times,
    /// seconds.
    stopped_s: Option<f64>,
    stopped_sum_s: f64,
    /// Whether the vehicle has started again since the last tick.
    has_restarted: bool,
    state: Option<State>,
    /// Arrival of `hello` and of the last `state`, seconds.
    greeted_s: f64,
    state_s: f64,
    /// Whether the vehicle has answered a ping.
    has_answered: bool,
    link: Link,
    motions: Motions,
    sequence: Sequence,
    /// The time since which no readings have had new numbers, and the arrival of the last such readings, seconds.
    unread: Option<(f64, f64)>,
    /// The stamp of the last readings with a new number, and the arrival of the last readings whose stamp was not later
    /// than the one before it, seconds; `None` once a stamp is later again.
    stamp_s: Option<f64>,
    standing_stamp_s: Option<f64>,
    /// The readings since the last tick, and their stamps.
    readings: world::Readings,
    stamps: Option<Stamps>,
    notices: Notices,
    /// The place at which the stream has stopped within a line.
    unfinished: Option<String>,
    /// The fault of a `hello`; after it, no message can be trusted.
    bad_hello: Option<String>,
    closed: Option<String>,
    /// Time for which the motion is unknown so far, seconds.
    unmeasured_s: f64,
    ages: Ages,
    outlines: Outlines,
    /// The last report and its time.
    told: Option<(LinkState, String, f64)>,
    /// Whether the last command was a motion.
    drives: bool,
    /// Whether the last report about a commanded stop was that it is confirmed; `None` without such a report.
    told_stood: Option<bool>,
}

impl Inbox {
    pub(crate) fn new(stations: BTreeMap<String, StationId>, at: String) -> Self {
        Self {
            stations,
            at,
            first: None,
            hello: None,
            differs: Vec::new(),
            awake_s: None,
            stopped_s: None,
            stopped_sum_s: 0.0,
            has_restarted: false,
            state: None,
            greeted_s: 0.0,
            state_s: 0.0,
            has_answered: false,
            link: Link::default(),
            motions: Motions::default(),
            sequence: Sequence::default(),
            unread: None,
            stamp_s: None,
            standing_stamp_s: None,
            readings: world::Readings::default(),
            stamps: None,
            notices: Notices::default(),
            unfinished: None,
            bad_hello: None,
            closed: None,
            unmeasured_s: 0.0,
            ages: Ages::default(),
            outlines: Outlines::default(),
            told: None,
            drives: false,
            told_stood: None,
        }
    }

    /// The introduction of the vehicle, once it has arrived.
    pub(crate) fn hello(&self) -> Option<&Hello> {
        self.hello.as_deref()
    }

    /// The reason for the end of the stream, once it has ended.
    pub(crate) fn closed(&self) -> Option<&str> {
        self.closed.as_deref()
    }

    /// The fault of the `hello`, if it is malformed.
    pub(crate) fn bad_hello(&self) -> Option<&str> {
        self.bad_hello.as_deref()
    }

    /// The last faulty line; empty without one.
    pub(crate) fn fault(&self) -> &str {
        self.notices.last_fault()
    }

    /// Notes the place at which the stream has stopped within a line.
    pub(crate) fn stopped_in(&mut self, unfinished: Option<String>) {
        self.unfinished = unfinished.map(|field| foreign::plain(&field).into_owned());
    }

    /// Whether readings have shown that the vehicle stands still, or that it does not.
    pub(crate) fn is_standstill_known(&self) -> bool {
        self.told_stood.is_some()
    }

    /// The number of readings so far.
    pub(crate) fn heard(&self) -> u64 {
        self.sequence.counts().received
    }

    /// The stream has ended. A reason that the vehicle gave earlier is added.
    pub(crate) fn close(&mut self, mut why: String) {
        let last = self.state.as_ref().filter(|state| state.mode == Mode::Fault);
        if let Some(text) = last.and_then(|state| state.text.as_deref()) {
            why = format!("{why}; it had reported: {}", foreign::plain(text));
        }
        if let Some(field) = &self.unfinished {
            why = format!("{why}; its last line is incomplete: {field}");
        }
        self.closed.get_or_insert(why);
        self.link.closed();
    }

    /// A command was given; it will be sent as soon as the stream takes it.
    pub(crate) fn commanded(&mut self, drives: bool, now_s: f64) {
        self.drives = drives;
        if drives {
            self.told_stood = None;
        } else {
            self.link.must_stand(now_s);
        }
    }

    /// The console is running: a tick begins, or a message leaves. After a long time without either, the silence of the
    /// vehicle begins now.
    pub(crate) fn awake(&mut self, now_s: f64) {
        let slept_s = self.awake_s.replace(now_s).map_or(0.0, |awake_s| now_s - awake_s);
        if slept_s <= STOPPED_S {
            return;
        }
        self.stopped_s = Some(slept_s);
        self.stopped_sum_s += slept_s;
        self.link.resumed(now_s);
        (self.greeted_s, self.state_s, self.unread) = (now_s, now_s, None);
    }

    /// A command was sent.
    pub(crate) fn sent(&mut self, message: &ToVehicle, now_s: f64) {
        self.awake(now_s);
        match message {
            ToVehicle::Drive(drive) => self.link.drove(drive),
            ToVehicle::Stop(stop) => self.link.stopped(stop),
            ToVehicle::Ping(_) => self.link.pinged(),
            ToVehicle::Bye(_) => {}
        }
    }

    pub(crate) fn take(&mut self, heard: Heard<FromVehicle>, now_s: f64) {
        self.link.heard(&heard, now_s);
        match heard {
            Heard::Message(FromVehicle::Hello(hello)) => self.greet(hello, now_s),
            // The motion of another vehicle is not that of the robot.
            Heard::Message(FromVehicle::Readings(_)) if !self.differs.is_empty() => {}
            Heard::Message(FromVehicle::Readings(readings)) => self.read(&readings, now_s),
            Heard::Message(FromVehicle::State(state)) => (self.state, self.state_s) = (Some(state), now_s),
            Heard::Malformed(misfit) => {
                let fault = foreign::plain(&misfit.to_string()).into_owned();
                self.notices.faulty(&fault);
                if misfit.field.starts_with("hello") {
                    self.bad_hello = Some(fault);
                }
            }
            // The link has taken the answer to a ping.
            Heard::Message(FromVehicle::Pong(_)) => self.has_answered = true,
            // Keys and messages of newer protocols have no effect.
            Heard::Unknown(_) => {}
        }
    }

    /// A vehicle that introduces itself again has started again: its poses are in a new frame, its numbers begin again. If
    /// its description is new, too, it is another vehicle.
    fn greet(&mut self, hello: Box<Hello>, now_s: f64) {
        let first = self.first.get_or_insert_with(|| hello.clone());
        let differs = first.differences(&hello);
        self.differs = differs.iter().map(|text| foreign::plain(text).into_owned()).collect();
        if !differs.is_empty() {
            self.notices.other_vehicle(info(&hello, &self.at), self.differs.clone());
        }
        self.has_restarted |= self.hello.is_some();
        (self.motions, self.state, self.unread) = (Motions::default(), None, None);
        (self.stamp_s, self.standing_stamp_s) = (None, None);
        (self.told_stood, self.has_answered, self.greeted_s, self.bad_hello) = (None, false, now_s, None);
        self.sequence.restart();
        self.outlines.greet(hello.has.drawn_ids);
        self.hello = Some(hello);
    }

    /// Whether a motion may be sent: not before the first readings, not to another vehicle, not to one that has just
    /// started again and has not been held yet, and not before a stop of the console itself has been reported.
    pub(crate) fn may_drive(&self) -> bool {
        self.heard() > 0 && !self.has_restarted && self.differs.is_empty() && self.stopped_s.is_none()
    }

    /// Adds readings. Readings that arrive twice, or after later ones, are left out: their motion would count twice.
    fn read(&mut self, readings: &Readings, now_s: f64) {
        if !self.sequence.add(readings.seq) {
            self.unread = Some((self.unread.map_or(now_s, |(since_s, _)| since_s), now_s));
            return;
        }
        self.unread = None;
        let source_t_s = readings.stamp_s;
        let is_later = self.stamp_s.replace(source_t_s).is_none_or(|before_s| source_t_s > before_s);
        self.standing_stamp_s = (!is_later).then_some(now_s);
        self.stamps = Some(Stamps { source_t_s, arrival_t_s: now_s });
        let offset = self.link.clock().at(now_s);
        let age_s = offset.map(|offset| (now_s - (source_t_s - offset.offset_s)).max(0.0));
        self.ages.add(age_s.unwrap_or(0.0));
        let gap_s = self.motions.gap_s(readings);
        self.readings.unmeasured_s += gap_s;
        self.unmeasured_s += gap_s;
        if let Some(moved) = self.motions.take(readings) {
            add(&mut self.readings.odometry, moved);
            if let Some(scan) = &mut self.readings.scan {
                add(&mut scan.since, moved);
            }
        }
        if let Some(scan) = &readings.scan {
            self.readings.scan = Some(scanned(scan));
        }
        self.readings.contact |= readings.contact.unwrap_or(false);
        if let Some(tether) = readings.tether {
            self.readings.paid_out_m = Some(tether.paid_out_m);
            self.readings.reel_pull_n = tether.pull_n;
        }
        self.readings.pressure_pa = readings.pressure_pa.or(self.readings.pressure_pa);
        if let Some(dead) = &readings.dead_channels {
            self.readings.dead_channels = Some(ascending(dead));
        }
        self.readings.sightings = self.outlines.sightings(&readings.outlines);
        if let Some(ae) = readings.ae.as_ref().filter(|_| age_s.is_none_or(|age_s| age_s <= RANGES_MAX_AGE_S))
        {
            self.readings.ranging_cycle = true;
            let heard = ae.ranges.iter().filter_map(|of| {
                Some(RangeSet { station: *self.stations.get(&of.station)?, ranges_m: of.ranges_m.clone() })
            });
            self.readings.ranges = heard.filter(|set| !set.ranges_m.is_empty()).collect();
        }
        let of_pulses = readings.pulses.iter().flat_map(|of| [&of.sender, &of.receiver]);
        let of_ranges = readings.ae.iter().flat_map(|ae| ae.ranges.iter().map(|of| &of.station));
        if let Some(unknown) = of_ranges.chain(of_pulses).find(|name| !self.stations.contains_key(*name)) {
            let known = self.stations.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
            let what = format!(
                "readings: the scenario has no station `{unknown}`, only {known}; its readings are not used"
            );
            self.notices.faulty(&what);
        }
        let pulses = readings.pulses.iter().filter_map(|of| {
            let (sender, receiver) = (*self.stations.get(&of.sender)?, *self.stations.get(&of.receiver)?);
            Some(PulseSet { sender, receiver, lengths_m: of.lengths_m.clone() })
        });
        self.readings.pulses.extend(pulses.filter(|set| !set.lengths_m.is_empty()));
    }

    /// Returns the content of the messages that have arrived since the last tick.
    pub(crate) fn sense(&mut self, now_s: f64) -> Sensed {
        self.awake(now_s);
        let stamps = self.stamps.take().map(|Stamps { source_t_s, arrival_t_s }| Stamps {
            source_t_s: rounded(source_t_s),
            arrival_t_s: rounded(arrival_t_s),
        });
        let readings = std::mem::take(&mut self.readings);
        let notices = self.due_notices(now_s, false);
        let live = Live { stamps, link: self.due_link(now_s), stood: self.due_stood(now_s), notices };
        Sensed { readings, live: Some(live) }
    }

    /// Whether a commanded stop is neither confirmed nor overdue.
    pub(crate) fn is_stopping(&self, now_s: f64) -> bool {
        self.link.hold(now_s) == Hold::Stopping
    }

    /// The link, and the result of a commanded stop if it is new.
    pub(crate) fn settled(&mut self, now_s: f64) -> Live {
        self.awake(now_s);
        let notices = self.due_notices(now_s, true);
        Live { stamps: None, link: Some(self.link(now_s)), stood: self.due_stood(now_s), notices }
    }

    fn due_notices(&mut self, now_s: f64, is_last: bool) -> Vec<Notice> {
        self.notices.due(self.link.clock().rates().worst(), now_s, is_last)
    }

    fn due_stood(&mut self, now_s: f64) -> Option<Stood> {
        // A motion that has not been sent yet ends the wait for the last stop, too.
        if self.drives {
            return None;
        }
        let asked_s = self.link.asked_to_stand_s()?;
        let hold = self.link.hold(now_s);
        let (confirmed, after_s) = match hold {
            Hold::Held { after_s } => (true, after_s),
            Hold::NotConfirmed | Hold::MovedAgain => (false, now_s - asked_s),
            Hold::NotAsked | Hold::Stopping => return None,
        };
        // A vehicle that has not sent everything yet may report an emergency stop or another commander later.
        if !self.missing().is_empty() {
            return None;
        }
        let is_new = self.told_stood.replace(confirmed) != Some(confirmed);
        is_new.then(|| Stood { confirmed, after_s: rounded(after_s), moved: hold == Hold::MovedAgain })
    }

    fn due_link(&mut self, now_s: f64) -> Option<LinkSeen> {
        let link = self.link(now_s);
        let is_due = self.told.as_ref().is_none_or(|(state, why, told_s)| {
            (*state, why) != (link.state, &link.why) || now_s - told_s >= FIGURES_EVERY_S
        });
        if is_due {
            self.told = Some((link.state, link.why.clone(), now_s));
        }
        // Each of the two is reported in a tick of its own.
        if self.stopped_s.take().is_none() {
            self.has_restarted = false;
        }
        is_due.then_some(link)
    }

    /// The state of the link now.
    pub(crate) fn link(&self, now_s: f64) -> LinkSeen {
        let (state, why) = self.state(now_s);
        let (counts, offset) = (self.sequence.counts(), self.link.clock().at(now_s));
        LinkSeen {
            state,
            why,
            age_s: self.link.age_s(now_s).map(rounded),
            offset_s: offset.map(|offset| rounded(offset.offset_s)),
            offset_bound_s: offset.map(|offset| rounded(offset.bound_s)),
            age_p99_s: self.ages.p99_s().map(rounded),
            heard: counts.received,
            missed: counts.lost,
            faulty: self.notices.faults(),
            unmeasured_s: rounded(self.unmeasured_s),
            console_stopped_s: rounded(self.stopped_sum_s),
        }
    }

    /// The messages that the vehicle has not sent since its `hello`, although the console needs them.
    fn missing(&self) -> Vec<&'static str> {
        let sent = [
            (self.link.counts().received > 0, "`readings`"),
            (self.state.is_some(), "`state`"),
            (self.has_answered, "`pong`"),
        ];
        sent.into_iter().filter(|(is_sent, _)| !is_sent).map(|(_, kind)| kind).collect()
    }

    /// Why no readings count as new, although some may still arrive.
    fn why_lost(&self, now_s: f64) -> String {
        let what = self.what_lost(now_s);
        match &self.unfinished {
            Some(field) => format!("{what}, in the middle of a line: {field}"),
            None => what.into(),
        }
    }

    fn what_lost(&self, now_s: f64) -> &'static str {
        let recent_s =
            ARRIVED_S.max(ARRIVED_PERIODS * self.hello.as_ref().map_or(0.0, |hello| hello.period_s));
        let is_recent = |last_s: Option<f64>| last_s.is_some_and(|last_s| now_s - last_s <= recent_s);
        if is_recent(self.unread.map(|(_, last_s)| last_s)) {
            REPEATED
        } else if is_recent(self.standing_stamp_s) {
            "the stamps of its readings (`stamp_s`) stand still"
        } else if self.link.silent_s(now_s).is_some_and(|silent_s| silent_s <= JUST_NOW_S) {
            "its readings arrive, but are too old by their stamps (`stamp_s`)"
        } else {
            "its readings stopped"
        }
    }

    fn state(&self, now_s: f64) -> (LinkState, String) {
        if let Some(why) = &self.closed {
            return (LinkState::Closed, why.clone());
        }
        if let Some(stopped_s) = self.stopped_s {
            return (LinkState::ConsoleStopped, format!("it sent no commands for {stopped_s:.1} s"));
        }
        if !self.differs.is_empty() {
            return (LinkState::OtherVehicle, self.differs.join(", "));
        }
        if self.has_restarted {
            return (LinkState::Restarted, String::new());
        }
        match self.link.state(now_s) {
            Reached::Lost if self.link.is_deaf(now_s) => {
                return (LinkState::Lost, "it has stopped answering, so it may not receive commands".into());
            }
            Reached::Lost => return (LinkState::Lost, self.why_lost(now_s)),
            Reached::Late | Reached::Alive
                if self.unread.is_some_and(|(since_s, _)| now_s - since_s > UNREAD_S) =>
            {
                return (LinkState::Lost, REPEATED.into());
            }
            Reached::Fault => {
                let fault = self.link.fault().unwrap_or_default();
                return (LinkState::Faulty, foreign::plain(fault).into_owned());
            }
            Reached::Connecting | Reached::Late | Reached::Alive => {}
        }
        if let Some(fault) = &self.bad_hello {
            return (LinkState::Faulty, fault.clone());
        }
        let missing = self.missing();
        if !missing.is_empty() && now_s - self.greeted_s > FIRST_WITHIN_S {
            let missing = missing.join(" and no ");
            return (LinkState::Lost, format!("within {FIRST_WITHIN_S} s of `hello`, it sent no {missing}"));
        }
        if self.state.is_some() && now_s - self.state_s > STATE_WITHIN_S {
            let why = format!("it has sent no `state` for {STATE_WITHIN_S} s; one a second is required");
            return (LinkState::Lost, why);
        }
        if let Some(fault) = self.outlines.fault() {
            return (LinkState::Faulty, fault);
        }
        if let Some(finding) = self.link.finding() {
            return (LinkState::Faulty, finding.to_string());
        }
        let Some(state) = &self.state else { return (LinkState::Up, String::new()) };
        let text = foreign::plain(state.text.as_deref().unwrap_or_default()).into_owned();
        match (state.mode, state.commander) {
            (Mode::Ready, Commander::You) => (LinkState::Up, String::new()),
            (Mode::Ready, Commander::OtherConsole) => (
                LinkState::OtherCommander,
                "another console is driving it; this console can only watch until that one exits".into(),
            ),
            (Mode::Ready, Commander::OtherProgram) => {
                (LinkState::OtherCommander, "another program is sending commands to it".into())
            }
            (Mode::Manual, _) => (LinkState::Manual, text),
            (Mode::EmergencyStop, _) => (LinkState::EmergencyStop, text),
            (Mode::Fault, _) => (LinkState::VehicleFault, text),
        }
    }
}

/// Adds a motion to those before it in the same tick.
fn add(sum: &mut world::Odometry, moved: Odometry) {
    let Odometry { forward_m, sideways_m, turn_rad, .. } = moved;
    if *sum == world::Odometry::default() {
        *sum = world::Odometry { forward_m, sideways_m, turn_rad };
        return;
    }
    let (sin, cos) = sum.turn_rad.sin_cos();
    *sum = world::Odometry {
        forward_m: sum.forward_m + forward_m * cos - sideways_m * sin,
        sideways_m: sum.sideways_m + forward_m * sin + sideways_m * cos,
        turn_rad: sum.turn_rad + turn_rad,
    };
}

/// The channels in ascending order, each once.
fn ascending(channels: &[u16]) -> Vec<u16> {
    let each: BTreeSet<u16> = channels.iter().copied().collect();
    each.into_iter().collect()
}

fn scanned(scan: &Scan) -> world::Scan {
    let ranges_mm = scan.ranges_m.iter().map(|range_m| world::Scan::stored(*range_m)).collect();
    world::Scan {
        first_rad: scan.first_rad,
        step_rad: scan.step_rad,
        sensor_m: scan.sensor_m,
        range_max_m: Some(scan.range_max_m.min(LONGEST_M)),
        since: world::Odometry::default(),
        ranges_mm: RangesMm(ranges_mm),
    }
}

fn rounded(s: f64) -> f64 {
    (s * STAMP_STEPS).round() / STAMP_STEPS + 0.0
}

#[cfg(test)]
mod tests;
