//! Checks that need no motion: introduction, messages, rates, clock, state, standstill.

use super::{Figure, Row, stops::Sample};
use crate::{
    link::{Offset, RATE_OFF, Rates, Sequence},
    port::LEASE_S,
    wire::message::{Commander, Hello, Mode, Readings, State},
};

/// The interval between readings may differ from `period_s` by this factor.
const RATE_FACTOR: f64 = 1.25;
/// Share of readings that may be missing.
const LOST_SHARE: f64 = 0.1;
/// Jitter up to which a mission still runs, seconds. It changes events, but never a safety reaction.
const JITTER_S: f64 = 0.2;
/// Greatest error of the clock's offset, seconds.
const OFFSET_BOUND_S: f64 = 0.1;
/// Largest motion that a standing vehicle may report while the trial listens: metres, radians.
const STILL_M: f64 = 0.01;
const STILL_RAD: f64 = 0.02;

/// The messages that arrived while the vehicle was only listened to.
#[derive(Debug, Clone, Default)]
pub struct Listened {
    /// The readings with the times of their arrival, seconds of the console's clock.
    pub readings: Vec<(f64, Readings)>,
    /// The motion between the readings.
    pub samples: Vec<Sample>,
    /// The last state.
    pub state: Option<State>,
    /// The lines that do not conform to the protocol.
    pub lines: Lines,
    /// Number of pings sent.
    pub pings: u32,
    /// Round trips of the pings that were answered, seconds.
    pub trips_s: Vec<f64>,
    /// The offset of the vehicle's clock at the end.
    pub offset: Option<Offset>,
    /// The rates of the vehicle's clock.
    pub rates: Rates,
}

/// Lines that do not conform to the protocol, and parts of messages that this version does not know.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Lines {
    /// Number of lines that are not valid messages.
    pub malformed: u64,
    /// The fault of the first malformed line.
    pub fault: Option<String>,
    /// Unknown keys and kinds of messages.
    pub unknown: Vec<String>,
}

impl Lines {
    /// Adds later lines.
    pub fn extend(&mut self, later: Self) {
        self.malformed += later.malformed;
        self.fault = self.fault.take().or(later.fault);
        let new = later.unknown.into_iter().filter(|name| !self.unknown.contains(name));
        self.unknown.extend(new.collect::<Vec<_>>());
    }
}

/// Checks the introduction of the vehicle.
pub fn introduction(hello: &Hello) -> Row {
    let check = "introduction";
    let Hello { name, limits, period_s, stop_time_s, lease_max_s, has, .. } = hello;
    let figures = vec![
        Figure::new("speed", limits.speed_m_per_s, "m/s"),
        Figure::new("turn rate", limits.turn_rad_per_s, "rad/s"),
        Figure::new("acceleration", limits.acceleration_m_per_s2, "m/s2"),
        Figure::new("radius", limits.radius_m, "m"),
        Figure::new("period", *period_s, "s").at_most(LEASE_S),
        Figure::new("stop time", *stop_time_s, "s"),
        Figure::new("lease", *lease_max_s, "s"),
    ];
    if !has.odometry && !has.pose {
        return Row::fail(check, figures, "`hello.has` names neither `odometry` nor `pose`; one is needed");
    }
    if *lease_max_s < LEASE_S {
        let says = format!("`lease_max_s` is {lease_max_s}; the console needs leases of {LEASE_S} s");
        return Row::fail(check, figures, says);
    }
    let says = format!("{name} has {}", has.parts().join(", "));
    let failed = format!("`period_s` is {period_s}; the console needs readings at least every {LEASE_S} s");
    Row::judged(check, figures, &says, &failed)
}

/// Whether all lines were valid messages.
pub fn messages(lines: &Lines) -> Row {
    let figures = vec![Figure::new("malformed", lines.malformed as f64, "").at_most(0.0)];
    let unknown = match lines.unknown.as_slice() {
        [] => String::new(),
        unknown => format!("; unknown and ignored: {}", unknown.join(", ")),
    };
    let first = lines.fault.as_deref().unwrap_or_default();
    let failed = format!("the first malformed line: {first}{unknown}");
    Row::judged("messages", figures, &format!("all lines are valid messages{unknown}"), &failed)
}

/// Rate, loss and jitter of the readings, and whether they contain what the introduction promises.
pub fn readings(hello: &Hello, listened: &Listened) -> Vec<Row> {
    let (rate, jitter) = ("readings: rate", "readings: jitter");
    let count = listened.readings.len();
    let mut intervals: Vec<f64> =
        listened.readings.windows(2).map(|pair| pair[1].1.stamp_s - pair[0].1.stamp_s).collect();
    intervals.sort_by(f64::total_cmp);
    let Some(median_s) = intervals.get(intervals.len() / 2).copied() else {
        let says = format!("too few readings arrived ({count}); send one every {} s", hello.period_s);
        return vec![
            Row::fail(rate, Vec::new(), says),
            Row::not_measured(jitter, "too few readings arrived"),
        ];
    };
    let mut sequence = Sequence::default();
    for (_, readings) in &listened.readings {
        sequence.add(readings.seq);
    }
    let (counts, period_s) = (sequence.counts(), hello.period_s);
    let lost = counts.lost as f64 / (counts.lost + counts.received).max(1) as f64;
    let figures = vec![
        Figure::new("interval", median_s, "s").at_most(RATE_FACTOR * period_s),
        Figure::new("lost", 100.0 * lost, "%").at_most(100.0 * LOST_SHARE),
    ];
    let missing: Vec<&str> =
        hello.has.parts().into_iter().filter(|part| !is_sent(part, &listened.readings)).collect();
    let says = format!("{count} readings, one every {median_s:.3} s");
    let failed = format!("{says}; `period_s` is {period_s}: correct it or the rate, and number all readings");
    let of_rate = if median_s * RATE_FACTOR < period_s {
        Row::fail(rate, figures, failed)
    } else if missing.is_empty() {
        Row::judged(rate, figures, &says, &failed)
    } else {
        let missing = missing.join(", ");
        Row::fail(rate, figures, format!("{says}, but without {missing}, although `hello.has` promises it"))
    };
    vec![of_rate, of_jitter(jitter, listened)]
}

/// Whether any reading contains a part. Ranges are not required, because a ranging cycle may be longer than the time of
/// listening.
fn is_sent(part: &str, readings: &[(f64, Readings)]) -> bool {
    readings.iter().any(|(_, readings)| match part {
        "odometry" => readings.odometry.is_some() || readings.pose.is_some(),
        "pose" => readings.pose.is_some(),
        "scan" => readings.scan.is_some(),
        "contact" => readings.contact.is_some(),
        "tether" => readings.tether.is_some(),
        "pressure" => readings.pressure_pa.is_some(),
        _ => true,
    })
}

/// Evaluates by how much the delay of each reading exceeds that of the quickest one.
fn of_jitter(check: &'static str, listened: &Listened) -> Row {
    let mut delays: Vec<f64> =
        listened.readings.iter().map(|(arrival_s, readings)| arrival_s - readings.stamp_s).collect();
    delays.sort_by(f64::total_cmp);
    let (Some(least), Some(most)) = (delays.first(), delays.last()) else {
        return Row::not_measured(check, "no readings arrived");
    };
    let share = |share: f64| delays[((delays.len() - 1) as f64 * share) as usize] - least;
    let figures = vec![
        Figure::new("p50", share(0.5), "s"),
        Figure::new("p99", share(0.99), "s").at_most(JITTER_S),
        Figure::new("max", most - least, "s"),
    ];
    let failed = "the readings arrive unevenly; send each one as soon as it is measured, on a faster link";
    Row::judged(check, figures, "delay beyond that of the quickest reading", failed)
}

/// The vehicle's clock and the round trips.
pub fn clock(listened: &Listened) -> Row {
    let check = "clock";
    let Some(offset) = listened.offset else {
        let says =
            format!("no valid answer to {} pings; answer each ping with `pong` immediately", listened.pings);
        return Row::fail(check, Vec::new(), says);
    };
    let mut trips = listened.trips_s.clone();
    trips.sort_by(f64::total_cmp);
    let figures = vec![
        Figure::new("offset", offset.offset_s, "s"),
        Figure::new("error", offset.bound_s, "s").at_most(OFFSET_BOUND_S),
        Figure::new("round trip", trips.get(trips.len() / 2).copied().unwrap_or_default(), "s"),
        Figure::new("longest", trips.last().copied().unwrap_or_default(), "s"),
    ];
    let says = format!("{} of {} pings answered", trips.len(), listened.pings);
    let failed = format!("{says}; answer each ping immediately");
    Row::judged(check, figures, &says, &failed)
}

/// Whether the vehicle's clock keeps the rate of the console's, by its answers to pings and by the stamps of its readings.
pub fn clock_rate(listened: &Listened) -> Row {
    let check = "clock rate";
    let (Some(pings), Some(stamps)) = (listened.rates.by_pings(), listened.rates.by_stamps()) else {
        return Row::not_measured(check, "needs readings and quick answers to pings for 10 s");
    };
    let off = |name, rate: f64| Figure::new(name, 100.0 * (rate - 1.0).abs(), "%").at_most(100.0 * RATE_OFF);
    let figures = vec![off("pongs", pings), off("readings", stamps)];
    let says = format!(
        "for each second of the console's clock, `pong.stamp_s` advances by {pings:.3} s, `readings.stamp_s` by {stamps:.3} s"
    );
    let failed = format!(
        "{says}; stamp with a clock that runs in seconds, such as the monotonic clock of the computer"
    );
    Row::judged(check, figures, &says, &failed)
}

/// Whether the vehicle obeys this console.
pub fn state(listened: &Listened) -> Row {
    let check = "state";
    let Some(State { mode, text, commander, battery, .. }) = &listened.state else {
        return Row::fail(check, Vec::new(), "no `state` arrived; send one at least once a second");
    };
    let figures = battery.map(|share| Figure::new("battery", 100.0 * share, "%")).into_iter().collect();
    let text = text.as_deref().filter(|text| !text.is_empty());
    let says = match (mode, commander) {
        (Mode::Ready, Commander::You) => return Row::pass(check, figures, "ready, obeys this console"),
        (Mode::Ready, Commander::OtherConsole) => "it obeys another console; close that console first",
        (Mode::Ready, Commander::OtherProgram) => "another program is commanding it; end that program first",
        (Mode::Manual, _) => "a person is driving it by hand; that person must hand over control first",
        (Mode::EmergencyStop, _) => "its emergency stop is pressed; release it first",
        (Mode::Fault, _) => "it reports a fault; repair it first",
    };
    let why = text.map(|text| format!(" ({text})")).unwrap_or_default();
    Row::fail(check, figures, format!("{says}{why}"))
}

/// Whether a vehicle that was not commanded stood still.
pub fn standstill(listened: &Listened) -> Row {
    let check = "standstill";
    if listened.samples.is_empty() {
        return Row::not_measured(check, "no motion was reported");
    }
    let way_m: f64 = listened.samples.iter().map(|sample| sample.way_m.abs()).sum();
    let turn_rad: f64 = listened.samples.iter().map(|sample| sample.turn_rad).sum();
    let figures = vec![
        Figure::new("distance", way_m, "m").at_most(STILL_M),
        Figure::new("turn", turn_rad.abs().to_degrees(), "deg").at_most(STILL_RAD.to_degrees()),
    ];
    let failed = "the vehicle moved, or reported motion, without a command";
    Row::judged(check, figures, "stood still without a command", failed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::message::Has;
    use crate::{
        trial::Verdict,
        wire::message::{Limits, MotionKind, Odometry, Pong},
    };

    fn hello() -> Hello {
        Hello {
            protocol: 1,
            name: "crawler".into(),
            motion: MotionKind::Unicycle,
            limits: Limits {
                speed_m_per_s: 0.4,
                turn_rad_per_s: 1.0,
                acceleration_m_per_s2: 0.5,
                radius_m: 0.2,
            },
            has: Has { odometry: true, ..Has::default() },
            period_s: 0.05,
            stop_time_s: 0.9,
            session: None,
            lease_max_s: 0.5,
        }
    }

    /// A hundred readings with these stamps and delays.
    fn listened(interval_s: f64, delay_s: impl Fn(u64) -> f64) -> Listened {
        let odometry = Odometry { over_s: interval_s, forward_m: 0.0, sideways_m: 0.0, turn_rad: 0.0 };
        let reading = |seq: u64| {
            let stamp_s = 500.0 + seq as f64 * interval_s;
            let readings = Readings { seq, stamp_s, odometry: Some(odometry), ..Readings::default() };
            (stamp_s - 490.0 + delay_s(seq), readings)
        };
        Listened { readings: (0..100).map(reading).collect(), ..Listened::default() }
    }

    fn verdicts(hello: &Hello, listened: &Listened) -> Vec<Verdict> {
        readings(hello, listened).iter().map(|row| row.verdict).collect()
    }

    #[test]
    fn readings_come_at_their_rate_and_evenly() {
        let (pass, fail) = (Verdict::Pass, Verdict::Fail);
        assert_eq!(verdicts(&hello(), &listened(0.05, |_| 0.01)), [pass, pass]);
        assert_eq!(verdicts(&hello(), &listened(0.1, |_| 0.01)), [fail, pass]);
        assert_eq!(verdicts(&hello(), &listened(0.02, |_| 0.01)), [fail, pass]);
        let uneven = listened(0.05, |seq| if seq % 10 == 0 { 0.3 } else { 0.0 });
        assert_eq!(verdicts(&hello(), &uneven), [pass, fail]);
        let mut lossy = listened(0.05, |_| 0.01);
        lossy.readings.retain(|(_, readings)| readings.seq % 4 != 1);
        assert_eq!(verdicts(&hello(), &lossy), [fail, pass]);
        assert_eq!(verdicts(&hello(), &Listened::default()), [fail, Verdict::NotMeasured]);
    }

    #[test]
    fn a_promise_that_is_not_kept_is_named() {
        let mut hello = hello();
        hello.has.scan = true;
        let row = &readings(&hello, &listened(0.05, |_| 0.01))[0];
        assert!(row.verdict == Verdict::Fail && row.says.contains("without scan"), "{row:?}");
        hello.has = Has::default();
        assert_eq!(introduction(&hello).verdict, Verdict::Fail);
        hello = Hello { lease_max_s: 0.1, ..hello };
        assert_eq!(introduction(&hello).verdict, Verdict::Fail);
    }

    #[test]
    fn only_a_ready_vehicle_that_obeys_passes() {
        let state_row = |state| super::state(&Listened { state, ..Listened::default() });
        let of = |mode, commander| {
            let text = Some("left track".into());
            state_row(Some(State { stamp_s: 0.0, mode, text, battery: None, commander }))
        };
        assert_eq!(of(Mode::Ready, Commander::You).verdict, Verdict::Pass);
        for row in [
            of(Mode::Fault, Commander::You),
            of(Mode::Manual, Commander::You),
            of(Mode::EmergencyStop, Commander::You),
            of(Mode::Ready, Commander::OtherConsole),
            of(Mode::Ready, Commander::OtherProgram),
        ] {
            assert!(row.verdict == Verdict::Fail && row.says.contains("(left track)"), "{row:?}");
        }
        assert_eq!(state_row(None).verdict, Verdict::Fail);
    }

    #[test]
    fn a_vehicle_that_moves_by_itself_fails() {
        let sample = |way_m, turn_rad| Sample { t_s: 1.0, over_s: 0.05, way_m, turn_rad };
        let of = |samples| standstill(&Listened { samples, ..Listened::default() }).verdict;
        assert_eq!(of(vec![sample(0.001, 0.001); 5]), Verdict::Pass);
        assert_eq!(of(vec![sample(0.01, 0.0); 5]), Verdict::Fail);
        assert_eq!(of(vec![sample(0.0, -0.01); 5]), Verdict::Fail);
        assert_eq!(of(Vec::new()), Verdict::NotMeasured);
    }

    #[test]
    fn a_clock_that_runs_at_a_wrong_rate_fails() {
        let of = |pong_rate: f64, stamp_rate: f64| {
            let mut clock = crate::link::Clock::default();
            for n in 0..=220_u32 {
                let now_s = 0.05 * f64::from(n);
                let pong = Pong { echo_s: now_s, stamp_s: 500.0 + pong_rate * now_s };
                clock.pong(&pong, now_s).expect("in order");
                clock.stamp(now_s, 500.0 + stamp_rate * now_s);
            }
            clock_rate(&Listened { rates: clock.rates().clone(), ..Listened::default() })
        };
        assert_eq!(of(1.0, 1.0).verdict, Verdict::Pass);
        for row in [of(0.8, 0.8), of(1.0, 1.2), of(1.02, 1.0)] {
            assert!(row.verdict == Verdict::Fail && row.says.contains("advances by"), "{row:?}");
        }
        assert_eq!(clock_rate(&Listened::default()).verdict, Verdict::NotMeasured);
    }

    #[test]
    fn clock_and_messages_are_judged() {
        let mut clock_of = crate::link::Clock::default();
        clock_of.pong(&Pong { echo_s: 1.0, stamp_s: 500.0 }, 1.01).expect("in order");
        let mut heard = Listened { pings: 2, trips_s: vec![0.01], ..Listened::default() };
        assert_eq!(clock(&heard).verdict, Verdict::Fail);
        heard.offset = clock_of.at(1.02);
        let row = clock(&heard);
        assert!(row.verdict == Verdict::Pass && row.says == "1 of 2 pings answered", "{row:?}");
        let mut lines = Lines::default();
        assert_eq!(messages(&lines).verdict, Verdict::Pass);
        let unknown = vec!["lights".to_owned()];
        lines.extend(Lines {
            malformed: 1,
            fault: Some("pong.stamp_s: NaN".into()),
            unknown: unknown.clone(),
        });
        lines.extend(Lines { malformed: 2, fault: Some("state.mode".into()), unknown });
        let row = messages(&lines);
        assert!(
            (row.figures[0].value - 3.0).abs() < 1e-12 && row.says.ends_with("unknown and ignored: lights"),
            "{row:?}"
        );
        assert!(row.verdict == Verdict::Fail && row.says.contains("pong.stamp_s: NaN"), "{row:?}");
    }
}
