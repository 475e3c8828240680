//! Pulse tests of the stations during a mission, and the corrections that they give.

use crate::{
    config::Locating,
    event::{ClockOffset, EventKind, PulsePhase},
};
use positioning::{
    CommonError, Doubt, Pulse, PulseError, PulseSeries, PulseTest, RangeNoise, Repetitions, Timing,
    longest_pulse_m, repetitions::variance_m2,
};
use world::{PulseSet, RangeSet, Station, StationId};

/// The pulse tests so far.
#[derive(Clone)]
pub(super) struct PulseTests {
    stations: Vec<Station>,
    noise: RangeNoise,
    timing: Timing,
    /// Whether ranges are corrected by the last test. A calibration from the ranges of the robot takes precedence.
    corrects: bool,
    /// Whether the clocks of the stations are estimated: then a test only corrects the speed of sound.
    has_clocks: bool,
    /// The part of the run that a test belongs to now.
    phase: PulsePhase,
    /// The last test that agreed with the survey, as the correction of ranges.
    last: PulseSeries,
    /// The same, to compare clocks with.
    before: Option<PulseTest>,
}

impl PulseTests {
    /// Creates the tests of surveyed stations; `noise` is the scatter of single ranges.
    pub(super) fn new(locating: &Locating, noise: RangeNoise, stations: &[Station]) -> Self {
        Self {
            stations: stations.to_vec(),
            noise,
            timing: locating.timing,
            corrects: locating.session.is_none() && !locating.calibrate_sound_speed,
            has_clocks: locating.clocks.is_some(),
            phase: PulsePhase::Before,
            last: PulseSeries::default(),
            before: None,
        }
    }

    /// Notes that ranges of the robot have come.
    pub(super) fn note_ranges(&mut self) {
        if self.phase == PulsePhase::Before {
            self.phase = PulsePhase::Held;
        }
    }

    /// Notes that the task is done: the next test is the one after the run. A robot that goes on takes this back.
    pub(super) fn note_end(&mut self, has_ended: bool) {
        self.phase = if has_ended { PulsePhase::After } else { PulsePhase::Held };
    }

    /// Evaluates an exchange of pulses; returns its event, and the test if it agrees with the survey.
    pub(super) fn take(&mut self, sets: &[PulseSet]) -> Option<(EventKind, Option<PulseTest>)> {
        if sets.is_empty() {
            return None;
        }
        let sets = &by_pair(sets);
        let phase = self.phase;
        let are_copies = self.are_copies(sets);
        let pulses: Vec<Pulse> = sets.iter().filter_map(|set| self.pulse(set, are_copies)).collect();
        let test = self.possible(&pulses).and_then(|()| PulseTest::new(&pulses, &self.stations));
        let test = match test {
            Ok(test) => test,
            Err(why) => return Some((EventKind::PulsesFailed { phase, why }, None)),
        };
        let agrees = test.is_usable();
        if agrees && self.corrects {
            self.last = PulseSeries { tests: vec![(0.0, self.to_correct(&test))] };
        }
        let agreeing = agrees.then(|| test.clone());
        Some((EventKind::PulsesTested { phase, test }, agreeing))
    }

    /// Returns the clocks that have changed between the last agreeing test and this one, which takes its place. Clocks of
    /// their own change all the time.
    pub(super) fn clock_changes(&mut self, agreeing: &PulseTest) -> Vec<ClockOffset> {
        let before = self.before.replace(agreeing.clone()).filter(|_| !self.has_clocks);
        let changes = before.map(|before| agreeing.clock_changes_since(&before)).unwrap_or_default();
        changes.into_iter().map(|(station, offset_m)| ClockOffset { station, offset_m }).collect()
    }

    /// The part of a test that corrects ranges.
    fn to_correct(&self, test: &PulseTest) -> PulseTest {
        let mut test = test.clone();
        if self.has_clocks {
            test.offsets_m.clear();
        }
        test
    }

    /// Removes the errors that the last test has measured from ranges.
    /// Ranges of a station that took no part in the test are left out: its clock is unknown.
    pub(super) fn correct(&self, sets: &mut Vec<RangeSet>) {
        self.last.correct(0.0, sets);
    }

    /// The error that corrected ranges probably still have; `None` if they are not corrected.
    pub(super) fn doubt(&self) -> Option<Doubt> {
        let (share, likely_m) = self.last.sigmas()?;
        let errors = [CommonError::Share(share), CommonError::default()];
        Some(Doubt { likely_errors: errors, likely_m, ..Doubt::default() })
    }

    /// Whether the repetitions of pulses scatter too little to be independent: then they count as one.
    fn are_copies(&self, sets: &[PulseSet]) -> bool {
        let mut repetitions = Repetitions::default();
        for set in sets {
            let lengths: Vec<(f64, u32)> = set.lengths_m.iter().map(|length_m| (*length_m, 1)).collect();
            let distance_m = self.distance_m(set.sender, set.receiver);
            repetitions.take(&lengths, variance_m2(&self.noise, self.timing, distance_m));
        }
        repetitions.are_narrow()
    }

    /// # Errors
    /// A length is impossible, although the stations share a clock.
    fn possible(&self, pulses: &[Pulse]) -> Result<(), PulseError> {
        let impossible = |pulse: &&Pulse| {
            let most_m = longest_pulse_m(self.distance_m(pulse.sender, pulse.receiver));
            !(0.0..=most_m).contains(&pulse.length_m)
        };
        match pulses.iter().find(impossible).filter(|_| !self.has_clocks) {
            Some(&Pulse { sender, receiver, length_m, .. }) => Err(PulseError::Impossible {
                sender,
                receiver,
                length_m,
                most_m: longest_pulse_m(self.distance_m(sender, receiver)),
            }),
            None => Ok(()),
        }
    }

    /// Distance between two stations, metres; 0 if one is not surveyed.
    fn distance_m(&self, sender: StationId, receiver: StationId) -> f64 {
        let at = |id| self.stations.iter().find(|station| station.id == id).map(|station| station.position);
        at(sender).zip(at(receiver)).map_or(0.0, |(from, to)| (from - to).norm())
    }

    /// The mean of repeated pulses; `None` without any.
    fn pulse(&self, set: &PulseSet, are_copies: bool) -> Option<Pulse> {
        let n = set.lengths_m.len() as f64;
        let length_m = set.lengths_m.iter().sum::<f64>() / n;
        let n = if are_copies { n.min(1.0) } else { n };
        let share_m = self.noise.sigma_ratio() * self.distance_m(set.sender, set.receiver);
        let sigma_m = (share_m / n.sqrt()).hypot(self.timing.mean_sigma_m(share_m, n));
        (n > 0.0).then_some(Pulse { sender: set.sender, receiver: set.receiver, length_m, sigma_m })
    }
}

/// Returns the pulses with one set for each pair of sender and receiver: a vehicle may send a pulse in several sets.
fn by_pair(sets: &[PulseSet]) -> Vec<PulseSet> {
    let mut pairs: Vec<PulseSet> = Vec::with_capacity(sets.len());
    for set in sets {
        let known = pairs.iter_mut().find(|pair| pair.sender == set.sender && pair.receiver == set.receiver);
        match known {
            Some(pair) => pair.lengths_m.extend(&set.lengths_m),
            None => pairs.push(set.clone()),
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use positioning::SessionConfig;
    use world::{Point, StationId};

    fn stations() -> Vec<Station> {
        let places = [(10.0, 0.0), (0.0, 10.0), (-10.0, 0.0), (1.0, -10.0)];
        (1..)
            .zip(places)
            .map(|(id, (x, y))| Station {
                id: StationId(id),
                name: String::new(),
                position: Point::new(x, y),
            })
            .collect()
    }

    /// Pulses of stations whose clocks are late, metres, while the sound is 2 % slower than assumed.
    fn exchange(late_m: [f64; 4]) -> Vec<PulseSet> {
        let all = stations();
        let pairs = all.iter().zip(late_m).flat_map(|from| all.iter().zip(late_m).map(move |to| (from, to)));
        pairs
            .filter(|((from, _), (to, _))| from.id != to.id)
            .map(|((from, sent_m), (to, heard_m))| PulseSet {
                sender: from.id,
                receiver: to.id,
                lengths_m: vec![1.02 * (from.position - to.position).norm() + heard_m - sent_m; 3],
            })
            .collect()
    }

    fn tests(session: Option<SessionConfig>) -> PulseTests {
        let locating = Locating { session, ..Locating::default() };
        PulseTests::new(&locating, RangeNoise::Gaussian { sigma_ratio: 0.001 }, &stations())
    }

    fn range() -> Vec<RangeSet> {
        vec![RangeSet { station: StationId(1), ranges_m: vec![10.2 + 0.3] }]
    }

    #[test]
    fn the_last_exchange_corrects_speed_of_sound_and_clocks() {
        let mut tests = tests(None);
        assert!(tests.take(&[]).is_none() && tests.doubt().is_none());
        let (event, agreeing) = tests.take(&exchange([0.3, -0.1, 0.0, -0.2])).unwrap();
        assert!(matches!(event, EventKind::PulsesTested { phase: PulsePhase::Before, .. }), "{event:?}");
        assert!(agreeing.is_some() && tests.doubt().is_some());
        let mut ranges = range();
        tests.correct(&mut ranges);
        assert!((ranges[0].ranges_m[0] - 10.0).abs() < 1e-6, "{ranges:?}");
        tests.note_ranges();
        let (event, _) = tests.take(&exchange([0.0; 4])).unwrap();
        assert!(matches!(event, EventKind::PulsesTested { phase: PulsePhase::Held, .. }), "{event:?}");
    }

    #[test]
    fn beside_a_session_calibration_pulses_correct_nothing() {
        let mut tests = tests(Some(SessionConfig::default()));
        assert!(tests.take(&exchange([0.3, -0.1, 0.0, -0.2])).is_some());
        let mut ranges = range();
        tests.correct(&mut ranges);
        assert_eq!(ranges, range());
    }

    #[test]
    fn pulses_that_contradict_the_survey_or_show_too_little_correct_nothing() {
        let mut moved = exchange([0.0; 4]);
        let near = moved.iter_mut().filter(|set| set.sender == StationId(2) || set.receiver == StationId(2));
        near.for_each(|set| set.lengths_m.iter_mut().for_each(|length_m| *length_m += 1.0));
        let mut tests = tests(None);
        let (event, agreeing) = tests.take(&moved).unwrap();
        assert!(matches!(event, EventKind::PulsesTested { .. }) && agreeing.is_none(), "{event:?}");
        let (event, agreeing) = tests.take(&moved[..1]).unwrap();
        assert!(matches!(event, EventKind::PulsesFailed { .. }) && agreeing.is_none(), "{event:?}");
        let mut ranges = range();
        tests.correct(&mut ranges);
        assert_eq!(ranges, range());
    }

    fn sigma_of(sets: &[PulseSet]) -> f64 {
        match tests(None).take(sets).unwrap().0 {
            EventKind::PulsesTested { test, .. } => test.scale.sigma,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn copies_of_a_pulse_count_as_one() {
        let mut once = exchange([0.0; 4]);
        for set in &mut once {
            set.lengths_m.truncate(1);
        }
        let mut copied = once.clone();
        for set in &mut copied {
            set.lengths_m = vec![set.lengths_m[0]; 30];
        }
        assert!((sigma_of(&copied) / sigma_of(&once) - 1.0).abs() < 1e-9);
        let rows: Vec<PulseSet> = (0..30).flat_map(|_| once.clone()).collect();
        assert!((sigma_of(&rows) / sigma_of(&once) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn lengths_that_no_common_clock_allows_are_refused() {
        for late_m in [450.0, -450.0] {
            let (event, agreeing) = tests(None).take(&exchange([0.0, late_m, 0.0, 0.0])).unwrap();
            let is_impossible =
                matches!(event, EventKind::PulsesFailed { why: PulseError::Impossible { .. }, .. });
            assert!(is_impossible && agreeing.is_none(), "{event:?}");
        }
    }
}
