//! The checks that every planner must pass, whatever it plans.

use crate::flown::{Flown, Pilot, with_planner};
use crate::tape::Player;
use flight::hosts;
use mission::{
    Cause, EventKind, Order, ParamInfo, ParamKind, ParamValue, Parameters, PlannerChoice, PlannerInfo, What,
};
use planner_api::Code;
use planner_host::{Host, HostConfig, PluginDirs};
use scenario::Scenario;
use serde::Serialize;
use std::time::Duration;

/// Time for which a tick of the console waits for a command, milliseconds: 60 % of a tick of 0.1 s.
const STEP_WITHIN_MS: f64 = 60.0;
/// The ticks at which the planner takes over from a different planner.
const SWAPS_AT: [u64; 3] = [5, 40, 120];
/// A planner's memory is measured after `WARM_UP` steps, and again after `STEPS` more.
const WARM_UP: usize = 300;
const STEPS: usize = 3000;
/// Maximum growth of the memory between the two measurements, bytes. At this rate, 0.7 kB per step, a
/// mission of eight hours takes 200 MB.
const MAY_GROW: u64 = 2 << 20;
/// The number of ticks for which a planner is watched after an intervention.
const LOOK_FOR: u64 = 30;

/// One check and its result.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// The check.
    pub what: &'static str,
    /// The reason why it failed; absent if it passed.
    pub failure: Option<String>,
    /// A breach of the rules that did no visible harm; absent if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub warning: Option<String>,
}

impl Check {
    /// Reports a check that could not be carried out.
    pub(crate) fn not_made(what: &'static str, why: &str) -> Self {
        Self { what, failure: None, warning: Some(why.to_owned()) }
    }

    pub(crate) fn line(&self) -> String {
        match (&self.failure, &self.warning) {
            (None, None) => format!("ok    {}\n", self.what),
            (None, Some(why)) => format!("warn  {}: {why}\n", self.what),
            (Some(why), _) => format!("FAIL  {}: {why}\n", self.what),
        }
    }
}

/// A planner under test.
pub(crate) struct Subject<'a> {
    pub(crate) planner: &'a PlannerInfo,
    pub(crate) plugins: &'a PluginDirs,
    /// The tank for the checks.
    pub(crate) tank: &'a Scenario,
    /// Other planners that run such missions without a fault; the planner under test takes over from the first.
    pub(crate) beside: Vec<&'a str>,
}

/// The other planner failed, so there was nothing to take over from.
struct FailedBeside;

/// Runs all checks, given the missions already run and the seed of the first tank.
pub(crate) fn all(subject: &Subject<'_>, flown: &[Flown], first_seed: u64) -> Vec<Check> {
    let check = |what, failure| Check { what, failure, warning: None };
    let mut checks = vec![
        check(
            "gives valid answers in every tank",
            named(flown, first_seed, |flown| flown.misbehaved.as_deref()),
        ),
        Check {
            what: "does not always give up",
            failure: gives_up(flown, first_seed),
            warning: completes_none(flown),
        },
        check("answers steps in time", in_time(flown)),
        check("repeats its mission exactly", subject.twice()),
        check("works at the limits of its parameters", subject.extremes()),
        check("accepts changes to its live parameters", subject.changes()),
        check("stops planning when it is asked to", subject.stops()),
        check("takes over during a mission", subject.takes_over()),
    ];
    if subject.planner.snapshots {
        checks.push(check("continues from its saved state", subject.restores()));
    }
    checks.extend([
        check("does not leak memory", subject.hoards()),
        check("ends when told to", named(flown, first_seed, |flown| flown.bad_end.as_deref())),
        Check { what: "leaves no thread behind", failure: None, warning: threads_left(flown) },
    ]);
    checks
}

/// Returns the first sentence that `about` gives for a tank, preceded by the seed of the tank.
fn named(flown: &[Flown], first_seed: u64, about: impl Fn(&Flown) -> Option<&str>) -> Option<String> {
    let mut tanks = (0..).zip(flown);
    tanks.find_map(|(n, flown)| {
        Some(format!("tank with seed {}: {}", first_seed.wrapping_add(n), about(flown)?))
    })
}

fn gives_up(flown: &[Flown], first_seed: u64) -> Option<String> {
    let has = |flown: &Flown| flown.gave_up.is_some() && !flown.is_complete() && !flown.unsupported;
    let everywhere = !flown.is_empty() && flown.iter().all(has);
    everywhere.then(|| named(flown, first_seed, |flown| flown.gave_up.as_deref()))?
}

fn completes_none(flown: &[Flown]) -> Option<String> {
    let none = !flown.iter().any(Flown::is_complete);
    (none && gives_up(flown, 0).is_none()).then(|| format!("it completed none of {} missions", flown.len()))
}

fn in_time(flown: &[Flown]) -> Option<String> {
    // The median is used because a busy machine is not the planner's fault.
    let slowest = flown.iter().filter_map(|flown| flown.p50_ms).fold(0.0, f64::max);
    (slowest > STEP_WITHIN_MS)
        .then(|| format!("the median step took {slowest:.0} ms; the console waits {STEP_WITHIN_MS} ms"))
}

fn threads_left(flown: &[Flown]) -> Option<String> {
    let left = flown.iter().filter_map(|flown| flown.threads_left).max()?;
    let what = if left == 1 { "1 thread is".to_owned() } else { format!("{left} threads are") };
    Some(format!("{what} still running between its calls; end them within the call that starts them"))
}

impl Subject<'_> {
    fn pilot(&self, id: &str, parameters: Parameters, attended: bool) -> Pilot {
        Pilot::new(&self.planner.id, &with_planner(self.tank, id, parameters), self.plugins, attended)
    }

    fn twice(&self) -> Option<String> {
        let mut pilots = [0, 1].map(|_| self.pilot(&self.planner.id, Parameters::new(), false));
        loop {
            let [first, second] = pilots.each_mut().map(|pilot| pilot.tick(&[]));
            let written = |events| serde_json::to_string(events).unwrap_or_default();
            if written(&first) != written(&second) {
                let t_s = first.and_then(|events| Some(events.first()?.t_s)).unwrap_or_default();
                return Some(format!(
                    "after {t_s:.1} s the second run differs from the first; derive every random choice \
                     from the site's seed, and use no clock"
                ));
            }
            first?;
        }
    }

    fn extremes(&self) -> Option<String> {
        [false, true].into_iter().find_map(|greatest| {
            let values =
                self.planner.parameters.iter().map(|info| (info.key.clone(), extreme(info, greatest)));
            let mut pilot = self.pilot(&self.planner.id, values.collect(), false);
            let _ = (0..LOOK_FOR).try_for_each(|_| pilot.tick(&[]).map(|_| ()));
            let which = if greatest { "maximum" } else { "minimum" };
            pilot.misbehaved().map(|why| format!("with all parameters at the {which}: {why}"))
        })
    }

    /// Sends every live parameter's extremes to a planner in use; it may refuse a value, but not every change.
    fn changes(&self) -> Option<String> {
        let mut player = self.player(hosts::config(&self.tank.mission));
        let open = self.tape().into_iter().next().filter(|what| matches!(what, What::Open { .. }))?;
        player.ask(0, open).1.ok()?;
        self.planner.parameters.iter().filter(|info| info.live).find_map(|info| {
            [false, true].into_iter().find_map(|greatest| {
                let values = Parameters::from([(info.key.clone(), extreme(info, greatest))]);
                let choice = PlannerChoice { id: self.planner.id.clone(), parameters: values };
                let fault = player.ask(0, What::Reconfigure(choice.parameters)).1.err()?;
                Some(match fault.cause {
                    Cause::Planner(Code::Unsupported) => format!(
                        "parameter `{}` is declared live, but `reconfigure` refuses every change: implement it, \
                         or do not declare the parameter live",
                        info.key
                    ),
                    Cause::Planner(_) => return None,
                    _ => fault.message,
                })
            })
        })
    }

    /// Returns the requests that the planner receives at the start of its first mission.
    fn tape(&self) -> Vec<What> {
        let mut pilot = self.pilot(&self.planner.id, Parameters::new(), true);
        let _ = (0..LOOK_FOR).try_for_each(|_| pilot.tick(&[]).map(|_| ()));
        pilot.into_tape()
    }

    fn player(&self, config: HostConfig) -> Player {
        Player::new(Host::new(self.plugins, config))
    }

    fn stops(&self) -> Option<String> {
        let hurry = Duration::from_millis(1);
        let config = HostConfig { plan_deadline: hurry, ..hosts::config(&self.tank.mission) };
        let mut player = self.player(config);
        let until_plan = self.tape().into_iter().take(2);
        let hung = until_plan
            .filter_map(|what| player.ask(0, what).1.err())
            .find(|fault| fault.cause == Cause::Hung);
        hung.map(|_| {
            "it was still running 0.1 s after the request to stop, and was killed; call ctx.check()? in every loop"
                .to_owned()
        })
    }

    fn hoards(&self) -> Option<String> {
        let mut player = self.player(hosts::config(&self.tank.mission));
        let (steps, others): (Vec<What>, Vec<What>) =
            self.tape().into_iter().partition(|what| matches!(what, What::Step(_)));
        if others.into_iter().any(|what| player.ask(0, what).1.is_err()) {
            return None;
        }
        let mut after = |n| {
            let mut asked = steps.iter().cycle().take(n);
            asked.all(|step| player.ask(0, step.clone()).1.is_ok()).then(|| player.memory_bytes(0))?
        };
        let (before, after) = (after(WARM_UP)?, after(STEPS)?);
        let grown = after.saturating_sub(before);
        (grown > MAY_GROW).then(|| {
            format!("{STEPS} steps took {:.1} MB of memory without releasing it", grown as f64 / 1e6)
        })
    }

    fn takes_over(&self) -> Option<String> {
        let own = std::iter::once(self.planner.id.as_str());
        // If a planner fails on its own, taking over from it proves nothing, so the next planner is tried.
        let mut tried = self.beside.iter().copied().chain(own).map(|from| self.takes_over_from(from));
        tried.find_map(Result::ok).flatten()
    }

    /// Returns why the planner does not take over from a different planner; `None` if it does.
    ///
    /// # Errors
    /// The other planner failed, so there was nothing to take over from.
    fn takes_over_from(&self, from: &str) -> Result<Option<String>, FailedBeside> {
        for at in SWAPS_AT {
            let failure = self.takes_over_at(from, at)?;
            if let Some(why) = failure {
                return Ok(Some(format!("from {from} at tick {at}: {why}")));
            }
        }
        Ok(None)
    }

    fn takes_over_at(&self, from: &str, at: u64) -> Result<Option<String>, FailedBeside> {
        let mut pilot = self.pilot(from, Parameters::new(), true);
        let choice = PlannerChoice { id: self.planner.id.clone(), parameters: Parameters::new() };
        let mut has_taken_over = false;
        for tick in 0..at + LOOK_FOR {
            let orders = match tick.checked_sub(at) {
                Some(0) => vec![Order::Hold],
                Some(1) => vec![Order::ChoosePlanner(choice.clone())],
                Some(3) => vec![Order::Resume],
                _ => Vec::new(),
            };
            // The mission may end before the last of these ticks.
            let Some(events) = pilot.tick(&orders) else { return Ok(None) };
            has_taken_over |= events.iter().any(|event| {
                matches!(&event.kind, EventKind::PlannerChosen { choice, .. } if tick > at && choice.id == self.planner.id)
            });
            if let Some(why) = pilot.misbehaved() {
                return Ok(Some(why.to_owned()));
            }
            if pilot.failed_beside() {
                return Err(FailedBeside);
            }
        }
        Ok((!has_taken_over).then(|| "it provided no plan to continue with".to_owned()))
    }

    fn restores(&self) -> Option<String> {
        let mut player = self.player(hosts::config(&self.tank.mission));
        let tape = self.tape();
        let half = tape.len() / 2;
        for what in &tape[..half] {
            // Other checks judge faults; here it only matters whether both instances give the same answers.
            let _ = player.ask(0, what.clone());
        }
        let (state, saved) = player.ask(0, What::Snapshot);
        if let Err(fault) = saved {
            return Some(fault.message);
        }
        let Some(What::Open { choice, site, .. }) = tape.first().cloned() else { return None };
        if let Err(fault) = player.ask(1, What::Open { choice, site, restore: Some(state) }).1 {
            return Some(fault.message);
        }
        let differs = |what: &What| player.ask(0, what.clone()).1 != player.ask(1, what.clone()).1;
        tape[half..]
            .iter()
            .any(differs)
            .then(|| "a restored instance answers differently from the original".to_owned())
    }
}

fn extreme(info: &ParamInfo, greatest: bool) -> ParamValue {
    match &info.kind {
        ParamKind::Float { min, max, .. } => ParamValue::Float(if greatest { *max } else { *min }),
        ParamKind::Int { min, max, .. } => ParamValue::Int(if greatest { *max } else { *min }),
        ParamKind::Flag { .. } => ParamValue::Flag(greatest),
        ParamKind::Choice { options, .. } => {
            let word = if greatest { options.last() } else { options.first() };
            ParamValue::Word(word.cloned().unwrap_or_default())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use account::Summary;
    use mission::Outcome;

    fn flown(outcome: Outcome) -> Flown {
        Flown {
            summary: Summary { outcome: Some(outcome), ..Summary::default() },
            p50_ms: Some(1.0),
            p99_ms: Some(2.0),
            memory_bytes: None,
            threads_left: None,
            bad_end: None,
            misbehaved: None,
            gave_up: None,
            unsupported: false,
        }
    }

    fn given_up() -> Flown {
        Flown { gave_up: Some("no path found".into()), ..flown(Outcome::Aborted) }
    }

    #[test]
    fn a_planner_may_give_up_in_a_tank_but_not_in_every_one() {
        let some = [given_up(), flown(Outcome::Complete)];
        assert_eq!((gives_up(&some, 5), completes_none(&some)), (None, None));
        let all = [given_up(), given_up()];
        assert_eq!(gives_up(&all, 5).as_deref(), Some("tank with seed 5: no path found"));
        assert_eq!(completes_none(&all), None, "one finding is enough");
        let unsupported = [Flown { unsupported: true, ..given_up() }];
        assert_eq!(gives_up(&unsupported, 5), None, "a mission that it does not fly is not given up");
        assert_eq!(gives_up(&[], 5), None);
    }

    #[test]
    fn a_planner_that_completes_nothing_is_warned_of() {
        let stuck = [flown(Outcome::Stuck), flown(Outcome::Stuck)];
        assert_eq!(completes_none(&stuck).as_deref(), Some("it completed none of 2 missions"));
    }

    #[test]
    fn the_slowest_median_counts_against_the_limit_of_a_tick() {
        let with = |ms| Flown { p50_ms: Some(ms), ..flown(Outcome::Complete) };
        assert_eq!(in_time(&[with(1.0), with(STEP_WITHIN_MS)]), None);
        assert!(in_time(&[with(1.0), with(61.0)]).is_some_and(|why| why.contains("61 ms")));
        assert_eq!(in_time(&[Flown { p50_ms: None, ..flown(Outcome::Stuck) }]), None);
    }

    #[test]
    fn a_finding_names_the_seed_of_its_tank_also_beyond_the_last_number() {
        let tanks = [flown(Outcome::Complete), Flown { bad_end: Some("hung".into()), ..given_up() }];
        let named = |first| named(&tanks, first, |flown| flown.bad_end.as_deref());
        assert_eq!(named(9).as_deref(), Some("tank with seed 10: hung"));
        assert_eq!(named(u64::MAX).as_deref(), Some("tank with seed 0: hung"));
    }

    #[test]
    fn threads_are_counted_in_words() {
        let with = |left| [Flown { threads_left: left, ..flown(Outcome::Complete) }];
        assert_eq!(threads_left(&with(None)), None);
        assert!(threads_left(&with(Some(1))).is_some_and(|why| why.starts_with("1 thread is ")));
        assert!(threads_left(&with(Some(3))).is_some_and(|why| why.starts_with("3 threads are ")));
    }

    #[test]
    fn a_failure_counts_more_than_a_warning() {
        let check = |failure: Option<&str>, warning: Option<&str>| {
            Check { what: "works", failure: failure.map(Into::into), warning: warning.map(Into::into) }.line()
        };
        assert_eq!(check(None, None), "ok    works\n");
        assert_eq!(check(None, Some("slowly")), "warn  works: slowly\n");
        assert_eq!(check(Some("no"), Some("slowly")), "FAIL  works: no\n");
    }

    #[test]
    fn extremes_are_the_ends_of_what_a_parameter_allows() {
        let info = |kind| ParamInfo {
            key: "k".into(),
            kind,
            unit: String::new(),
            group: String::new(),
            help: String::new(),
            label: String::new(),
            live: false,
        };
        let ends = |kind: ParamKind| [false, true].map(|greatest| extreme(&info(kind.clone()), greatest));
        let floats = ends(ParamKind::Float { min: -1.0, max: 2.0, default: 0.0 });
        assert_eq!(floats, [ParamValue::Float(-1.0), ParamValue::Float(2.0)]);
        assert_eq!(
            ends(ParamKind::Flag { default: true }),
            [ParamValue::Flag(false), ParamValue::Flag(true)]
        );
    }
}
