//! What a planner must do whatever it plans.

use crate::flown::{Flown, Pilot, with_planner};
use crate::tape::Player;
use flight::hosts;
use mission::{
    Cause, EventKind, Order, ParamInfo, ParamKind, ParamValue, Parameters, PlannerChoice, PlannerInfo, What,
};
use planner_host::{Host, HostConfig, PluginDirs};
use scenario::Scenario;
use serde::Serialize;
use std::time::Duration;

/// In the console a tick waits so long for a command, milliseconds: 60 % of a tick of 0.1 s.
const STEP_WITHIN_MS: f64 = 60.0;
/// Ticks at which the planner takes over from another.
const SWAPS_AT: [u64; 3] = [5, 40, 120];
/// A planner's memory is looked at after it has warmed up for so many steps, and again after so many more.
const WARM_UP: usize = 300;
const STEPS: usize = 3000;
/// It may grow by so much meanwhile, bytes: at 0.7 kB per step a mission of eight hours takes 200 MB.
const MAY_GROW: u64 = 2 << 20;
/// So many ticks a planner is looked at after something was done to it.
const LOOK_FOR: u64 = 30;

/// Something that a planner must do, and whether it does.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// What.
    pub what: &'static str,
    /// Why it failed; absent if it passed.
    pub failure: Option<String>,
    /// What is against the rules and does no harm that was seen; absent if there is nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub warning: Option<String>,
}

impl Check {
    /// Something that could not be checked.
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

/// A planner that is checked.
pub(crate) struct Subject<'a> {
    pub(crate) planner: &'a PlannerInfo,
    pub(crate) plugins: &'a PluginDirs,
    /// A tank to fly in.
    pub(crate) tank: &'a Scenario,
    /// Other planners that fly such missions soundly, the one to take over from first.
    pub(crate) beside: Vec<&'a str>,
}

/// The planner that was to be taken over from failed.
struct FailedBeside;

/// Every check, with the flights that were flown already, and the seed of the first tank.
pub(crate) fn all(subject: &Subject<'_>, flown: &[Flown], first_seed: u64) -> Vec<Check> {
    let check = |what, failure| Check { what, failure, warning: None };
    let mut checks = vec![
        check(
            "gives valid answers in every tank",
            named(flown, first_seed, |flown| flown.misbehaved.as_deref()),
        ),
        Check {
            what: "does not give up in every tank",
            failure: gives_up(flown, first_seed),
            warning: completes_none(flown),
        },
        check("answers steps in time", in_time(flown)),
        check("flies the same flight twice", subject.twice()),
        check("works at the limits of its parameters", subject.extremes()),
        check("stops planning when it is asked to", subject.stops()),
        check("takes over under way", subject.takes_over()),
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

/// The first sentence about a tank, with the tank.
fn named(flown: &[Flown], first_seed: u64, about: impl Fn(&Flown) -> Option<&str>) -> Option<String> {
    let mut tanks = (0..).zip(flown);
    tanks.find_map(|(n, flown)| {
        Some(format!("tank of seed {}: {}", first_seed.wrapping_add(n), about(flown)?))
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
    // The median, because a busy machine is not the planner's fault.
    let slowest = flown.iter().filter_map(|flown| flown.p50_ms).fold(0.0, f64::max);
    (slowest > STEP_WITHIN_MS)
        .then(|| format!("half of the steps took {slowest:.0} ms; the console waits {STEP_WITHIN_MS} ms"))
}

fn threads_left(flown: &[Flown]) -> Option<String> {
    let left = flown.iter().filter_map(|flown| flown.threads_left).max()?;
    let what = if left == 1 { "1 thread is".to_owned() } else { format!("{left} threads are") };
    Some(format!("{what} still there between its calls; end them within the call that starts them"))
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
                    "after {t_s:.1} s the second flight is another one; start every random choice from the site's seed, and \
                     use no clock"
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
            let which = if greatest { "greatest" } else { "least" };
            pilot.misbehaved().map(|why| format!("with the {which} ones: {why}"))
        })
    }

    /// What it is asked on its first flight.
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
            "it ignored the request for 0.1 s and was killed; call ctx.check()? in every loop".to_owned()
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
        (grown > MAY_GROW)
            .then(|| format!("{STEPS} steps took {:.1} MB that were not given back", grown as f64 / 1e6))
    }

    fn takes_over(&self) -> Option<String> {
        let own = std::iter::once(self.planner.id.as_str());
        // One that fails itself is nothing to take over from.
        let mut tried = self.beside.iter().copied().chain(own).map(|from| self.takes_over_from(from));
        tried.find_map(Result::ok).flatten()
    }

    /// Why it does not take over from a planner, if it does not.
    ///
    /// # Errors
    /// That planner failed.
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
            // The mission may end before.
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
        Ok((!has_taken_over).then(|| "it gave no plan to go on with".to_owned()))
    }

    fn restores(&self) -> Option<String> {
        let mut player = self.player(hosts::config(&self.tank.mission));
        let tape = self.tape();
        let half = tape.len() / 2;
        for what in &tape[..half] {
            player.ask(0, what.clone()).1.err().map_or(Ok(()), |fault| Err(fault.message)).err();
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
        tape[half..].iter().any(differs).then(|| {
            "an instance that was given the state of another answers otherwise than that one".to_owned()
        })
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
