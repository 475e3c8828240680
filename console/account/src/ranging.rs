//! What a run found out about the errors of its ranges: the speed of sound, wrong stations, clocks, and pulse tests.

use crate::clock;
use mission::{
    ClockOffset, EventKind,
    event::{PulsePhase, bias_text, change_text, clocks_changed_text, pulse_failure_text, pulse_text},
};
use positioning::{Estimated, Integrity, PulseError, PulseTest, SoundSpeed};
use serde::{Deserialize, Serialize};
use world::{Station, StationId};

/// The largest 95 % error at which the speed of sound counts as known, as a share.
const KNOWN: f64 = 0.01;

/// An estimate of the share by which all ranges are too long.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Calibrated {
    /// Mission time, seconds.
    pub t_s: f64,
    /// The share with its standard deviation.
    pub scale: Estimated,
}

impl Calibrated {
    /// The share as text, with its 95 % error.
    fn words(&self) -> String {
        format!(
            "{:+.2} ± {:.2} % at T+{}",
            100.0 * self.scale.value,
            200.0 * self.scale.sigma,
            clock(self.t_s)
        )
    }
}

/// A station whose ranges were found wrong by a constant length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Biased {
    /// Name of the station.
    pub station: String,
    /// Length by which its ranges were too long, metres, according to the estimate that raised the alarm.
    pub bias_m: Estimated,
    /// Mission time at which the bias may have begun, seconds.
    pub since_s: f64,
    /// Mission time at which the bias was detected, seconds.
    pub found_s: f64,
    /// Mission time at which the bias was over, seconds; absent for a bias that lasted to the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until_s: Option<f64>,
    /// Whether the bias was subtracted; if not, the station was not used.
    pub is_corrected: bool,
}

impl Biased {
    fn words(&self) -> String {
        let Self { station, bias_m, since_s, found_s, until_s, is_corrected } = self;
        let end = until_s.map_or_else(|| "to the end".to_owned(), |t_s| format!("to T+{}", clock(t_s)));
        let deed = if *is_corrected { "corrected" } else { "not used" };
        format!(
            "ranges of station {station} wrong by {}, possibly since T+{}; {deed} from T+{} {end}",
            bias_text(bias_m),
            clock(*since_s),
            clock(*found_s)
        )
    }
}

/// The result of the session calibration of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// How the speed of sound may change during the fixes that are kept.
    pub sound_speed: SoundSpeed,
    /// The first estimate that is known within 1 %; absent if none was.
    pub first: Option<Calibrated>,
    /// The last estimate.
    pub last: Calibrated,
    /// The stations that were found wrong, in order of time.
    pub biased: Vec<Biased>,
}

impl Calibration {
    /// The result as sentences without a full stop: first the speed of sound, then one for each wrong station.
    pub fn sentences(&self) -> Vec<String> {
        let model = match self.sound_speed {
            SoundSpeed::Constant => "constant",
            SoundSpeed::Linear => "linear in time",
        };
        let last = self.last.words();
        let first = match self.first {
            Some(first) if first != self.last => format!("{}, {last} (last)", first.words()),
            Some(_) => last,
            None => format!("{last}: never known within 1 %"),
        };
        let sound = format!("speed of sound taken as {model}: ranges too long by {first}");
        std::iter::once(sound).chain(self.biased.iter().map(Biased::words)).collect()
    }
}

/// The last estimate of a station's clock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StationClock {
    /// Name of the station.
    pub station: String,
    /// Offset relative to the mean of all stations, as a length that sound travels, metres.
    pub offset_m: Estimated,
}

impl std::fmt::Display for StationClock {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.station, bias_text(&self.offset_m))
    }
}

/// A pulse test of the stations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PulseRecord {
    /// The result as a sentence.
    pub found: String,
    /// Whether the pulses agree with the survey of the stations.
    pub agrees: bool,
    /// Whether the pulses contradict the survey. A test without a result does neither.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub contradicts: bool,
    /// Mission time of the test, seconds; absent in reports of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub t_s: Option<f64>,
}

/// States for which part of a run the stations may not have been as surveyed, as a sentence without a full stop: around
/// each pulse test that contradicts the survey, from the test before it that agreed, or from the start, until the next one
/// that agrees. `None` if no test contradicts the survey.
pub fn not_as_surveyed(tests: &[PulseRecord]) -> Option<String> {
    let mut spans: Vec<(f64, Option<f64>)> = Vec::new();
    let mut agreed_s = 0.0;
    for test in tests {
        let t_s = test.t_s.unwrap_or(0.0);
        match spans.last_mut() {
            Some((_, until_s @ None)) if test.agrees => *until_s = Some(t_s),
            Some((_, None)) => {}
            _ if test.contradicts => spans.push((agreed_s, None)),
            _ => {}
        }
        if test.agrees {
            agreed_s = t_s;
        }
    }
    let words = |(from_s, until_s): &(f64, Option<f64>)| {
        let end = until_s.map_or_else(|| "to the end".to_owned(), |t_s| format!("to T+{}", clock(t_s)));
        format!("from T+{} {end}", clock(*from_s))
    };
    let spans: Vec<String> = spans.iter().map(words).collect();
    (!spans.is_empty()).then(|| {
        format!(
            "the stations may not have been as surveyed {}: the stated position errors, protection levels and guaranteed floor of \
             this time do not count; survey the stations, then rescan this floor",
            spans.join(" and ")
        )
    })
}

/// Collects the errors of the ranges from the events of a run.
#[derive(Debug, Default)]
pub struct Ranging {
    stations: Vec<Station>,
    sound_speed: SoundSpeed,
    estimates: Option<(Option<Calibrated>, Calibrated)>,
    biased: Vec<(StationId, Biased)>,
    /// Mission time since which a bias and an error of the speed of sound cannot be told apart, seconds.
    not_separable_since_s: Option<f64>,
    clocks: Vec<ClockOffset>,
    pulse_tests: Vec<PulseRecord>,
    /// The last test that corrects ranges.
    usable: Option<PulseTest>,
}

impl Ranging {
    /// Nothing is known about the ranges of these stations yet.
    pub fn new(stations: &[Station], sound_speed: SoundSpeed) -> Self {
        Self { stations: stations.to_vec(), sound_speed, ..Self::default() }
    }

    /// Adds an event at a mission time, seconds.
    pub fn apply(&mut self, t_s: f64, kind: &EventKind) {
        match kind {
            EventKind::SessionCalibrated { scale, .. } => {
                let last = Calibrated { t_s, scale: *scale };
                let first = self.estimates.and_then(|(first, _)| first);
                let is_known = 2.0 * scale.sigma <= KNOWN;
                self.estimates = Some((first.or(is_known.then_some(last)), last));
            }
            EventKind::StationBiased { station, bias_m, since_s, is_corrected } => {
                self.end_bias(*station, t_s);
                let biased = Biased {
                    station: self.name(*station),
                    bias_m: *bias_m,
                    since_s: *since_s,
                    found_s: t_s,
                    until_s: None,
                    is_corrected: *is_corrected,
                };
                self.biased.push((*station, biased));
            }
            EventKind::StationUnbiased { station } => self.end_bias(*station, t_s),
            EventKind::NotSeparable { .. } => self.not_separable_since_s = Some(t_s),
            EventKind::Separable => self.not_separable_since_s = None,
            EventKind::ClocksEstimated { offsets } => self.clocks.clone_from(offsets),
            EventKind::PulsesTested { phase, test } => self.test(t_s, *phase, Ok(test)),
            EventKind::ClocksChanged { changes } => self.clocks_changed(changes),
            EventKind::PulsesFailed { phase, why } => self.test(t_s, *phase, Err(*why)),
            _ => {}
        }
    }

    fn end_bias(&mut self, station: StationId, t_s: f64) {
        let open = self.biased.iter_mut().filter(|(id, biased)| *id == station && biased.until_s.is_none());
        open.for_each(|(_, biased)| biased.until_s = Some(t_s));
    }

    /// Adds a test as a sentence, with the change of the speed of sound since the usable test before it.
    fn test(&mut self, t_s: f64, phase: PulsePhase, test: Result<&PulseTest, PulseError>) {
        let t_s = Some(t_s);
        let record = match test {
            Err(why) => {
                let found = pulse_failure_text(phase, why, &self.stations);
                PulseRecord { found, agrees: false, contradicts: false, t_s }
            }
            Ok(test) => {
                let change = test.is_usable().then(|| self.usable.replace(test.clone())).flatten();
                let change = change.and_then(|before| change_text(&before, test));
                let found = std::iter::once(pulse_text(phase, test, &self.stations)).chain(change);
                PulseRecord {
                    found: found.collect::<Vec<_>>().join("; "),
                    agrees: matches!(test.integrity, Integrity::Ok | Integrity::Suspect),
                    contradicts: test.integrity == Integrity::Alarm,
                    t_s,
                }
            }
        };
        self.pulse_tests.push(record);
    }

    /// Adds changed clocks to the test that shows them: the ranges since the test before were wrong.
    fn clocks_changed(&mut self, changes: &[ClockOffset]) {
        let found = clocks_changed_text(changes, &self.stations);
        if let Some(test) = self.pulse_tests.last_mut() {
            test.found = format!("{}; {found}", test.found);
            (test.agrees, test.contradicts) = (false, true);
        }
    }

    fn name(&self, id: StationId) -> String {
        let found = self.stations.iter().find(|station| station.id == id);
        found.map_or_else(|| id.0.to_string(), |station| station.name.clone())
    }

    /// The session calibration; `None` if the mission makes none.
    pub fn calibration(&self) -> Option<Calibration> {
        let biased = self.biased.iter().map(|(_, biased)| biased.clone()).collect();
        let (first, last) = self.estimates?;
        Some(Calibration { sound_speed: self.sound_speed, first, last, biased })
    }

    /// Mission time since which a bias and an error of the speed of sound cannot be told apart, seconds; `None` if they
    /// can.
    pub fn not_separable_since_s(&self) -> Option<f64> {
        self.not_separable_since_s
    }

    /// The clocks of the stations; empty if they share one.
    pub(crate) fn clocks(&self) -> Vec<StationClock> {
        let clock = |clock: &ClockOffset| StationClock {
            station: self.name(clock.station),
            offset_m: clock.offset_m,
        };
        self.clocks.iter().map(clock).collect()
    }

    /// The pulse tests in order of time.
    pub(crate) fn pulse_tests(&self) -> &[PulseRecord] {
        &self.pulse_tests
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use world::Point;

    fn ranging() -> Ranging {
        let station =
            |id, name: &str| Station { id: StationId(id), name: name.into(), position: Point::new(1.0, 0.0) };
        Ranging::new(&[station(1, "A"), station(2, "B")], SoundSpeed::Constant)
    }

    fn calibrated(value: f64, sigma: f64) -> EventKind {
        EventKind::SessionCalibrated { scale: Estimated { value, sigma }, slip_correlation: None }
    }

    fn tested(phase: PulsePhase, value: f64, integrity: Integrity) -> EventKind {
        let scale = Estimated { value, sigma: 0.000_6 };
        let worst = (StationId(1), StationId(2), -0.37);
        let test = PulseTest { scale, offsets_m: Vec::new(), integrity, suspect: None, worst, pulses: 30 };
        EventKind::PulsesTested { phase, test }
    }

    #[test]
    fn the_calibration_states_its_first_and_last_estimate_and_each_bias_with_its_error() {
        let mut ranging = ranging();
        assert_eq!(ranging.calibration(), None);
        ranging.apply(1.0, &calibrated(0.001, 0.03));
        let early = ranging.calibration().unwrap().sentences();
        assert!(
            early[0].ends_with("too long by +0.10 ± 6.00 % at T+00:00:01: never known within 1 %"),
            "{early:?}"
        );
        ranging.apply(9.0, &calibrated(0.018, 0.004));
        let bias_m = Estimated { value: 0.15, sigma: 0.02 };
        let biased = |station| EventKind::StationBiased {
            station: StationId(station),
            bias_m,
            since_s: 20.0,
            is_corrected: false,
        };
        ranging.apply(30.0, &biased(2));
        ranging.apply(50.0, &EventKind::StationUnbiased { station: StationId(2) });
        ranging.apply(60.0, &biased(1));
        ranging.apply(70.0, &calibrated(0.0202, 0.000_3));
        assert_eq!(
            ranging.calibration().unwrap().sentences(),
            [
                "speed of sound taken as constant: ranges too long by +1.80 ± 0.80 % at T+00:00:09, +2.02 ± \
                 0.06 % at T+00:01:10 (last)",
                "ranges of station B wrong by +0.15 ± 0.04 m, possibly since T+00:00:20; not used from T+00:00:30 to \
                 T+00:00:50",
                "ranges of station A wrong by +0.15 ± 0.04 m, possibly since T+00:00:20; not used from T+00:01:00 to \
                 the end",
            ]
        );
    }

    #[test]
    fn stations_are_not_as_surveyed_from_a_contradiction_until_a_test_agrees() {
        let said = |tests: &[(f64, EventKind)]| {
            let mut ranging = ranging();
            for (t_s, kind) in tests {
                ranging.apply(*t_s, kind);
            }
            not_as_surveyed(ranging.pulse_tests())
        };
        let before = |integrity| (0.0, tested(PulsePhase::Before, 0.02, integrity));
        let failed =
            (5.0, EventKind::PulsesFailed { phase: PulsePhase::Held, why: PulseError::NotDetermined });
        let after = |integrity| (90.0, tested(PulsePhase::After, 0.02, integrity));
        assert_eq!(said(&[before(Integrity::Ok), failed.clone(), after(Integrity::Ok)]), None);
        let all = said(&[before(Integrity::Alarm), failed.clone()]).unwrap();
        assert!(
            all.starts_with("the stations may not have been as surveyed from T+00:00:00 to the end:"),
            "{all}"
        );
        let first = said(&[before(Integrity::Alarm), failed, after(Integrity::Ok)]).unwrap();
        assert!(first.contains("from T+00:00:00 to T+00:01:30:"), "{first}");
        let last = said(&[before(Integrity::Ok), after(Integrity::Alarm)]).unwrap();
        assert!(last.contains("from T+00:00:00 to the end:"), "{last}");
    }

    #[test]
    fn a_pulse_test_is_a_sentence_with_the_change_since_the_usable_test_before_it() {
        let mut ranging = ranging();
        ranging.apply(0.0, &tested(PulsePhase::Before, 0.02, Integrity::Ok));
        ranging.apply(40.0, &tested(PulsePhase::Held, 0.2, Integrity::Alarm));
        ranging.apply(90.0, &tested(PulsePhase::After, 0.05, Integrity::Untestable));
        let [before, held, after] = ranging.pulse_tests() else { panic!("three tests") };
        assert!(before.agrees && before.found.ends_with("; as surveyed"), "{before:?}");
        assert!(held.contradicts && held.found.ends_with("from A to B, 0.37 m too short"), "{held:?}");
        assert!(
            !after.agrees && !after.contradicts && after.found.contains("became 3.00 ± 0.17 % longer"),
            "{after:?}"
        );
    }
}
