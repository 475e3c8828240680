//! Compares a planner's answer with the recorded one.

use super::{Answer, Given};
use crate::planner::{Cause, Fault, PlannerInfo};
use planner_api::Command;
use std::borrow::Cow;

/// The result of comparing a planner's own answer with the recorded one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Comparison {
    /// Both answers are the same.
    Same,
    /// The recorded answer does not come from this planner.
    NotComparable,
    /// The answers differ; the text completes a sentence that begins with "it".
    Different(String),
}

impl Comparison {
    /// Compares two answers to one ask. `as_sent` converts a command to the form in which the robot receives it, because
    /// commands of the active planner are recorded in that form. Applying `as_sent` twice has the same effect as applying
    /// it once.
    pub fn of(own: &Answer, recorded: &Answer, as_sent: impl Fn(Command) -> Command) -> Self {
        let why = match (&own.result, &recorded.result) {
            (Ok(Given::Opened(_)), Err(Fault { cause: Cause::Quarantined | Cause::Refused, .. })) => {
                return Self::NotComparable;
            }
            // The plan is valid in itself, but the mission refused it for this tank, so it is not in the journal.
            (Ok(Given::Plan(_)), Err(Fault { cause: Cause::BadOutput, .. })) => return Self::NotComparable,
            (Ok(own_given), Ok(given)) => differs(own_given, given, as_sent)
                .or_else(|| {
                    (own.said.clone().rounded() != recorded.said)
                        .then_some(Cow::Borrowed("logs or draws something different"))
                })
                .map(Cow::into_owned),
            (Err(own), Err(fault)) => (own != fault)
                .then(|| format!("fails with \"{}\" instead of \"{}\"", own.message, fault.message)),
            (Ok(_), Err(fault)) => Some(format!("does not fail (recorded: \"{}\")", fault.message)),
            (Err(own), Ok(_)) => Some(format!("fails: {}", own.message)),
        };
        why.map_or(Self::Same, Self::Different)
    }
}

/// How an opened planner differs from the recorded one.
fn another_planner(own: &PlannerInfo, then: &PlannerInfo) -> String {
    if own.sha256 == then.sha256 {
        return "has different properties or parameters".to_owned();
    }
    let start = |info: &PlannerInfo| info.sha256.chars().take(12).collect::<String>();
    format!(
        "is a different build (SHA-256 {}... of {}, recorded: {}...)",
        start(own),
        own.plugin,
        start(then)
    )
}

fn differs(own: &Given, recorded: &Given, as_sent: impl Fn(Command) -> Command) -> Option<Cow<'static, str>> {
    let is = |differs: bool, how: &'static str| differs.then_some(Cow::Borrowed(how));
    match (own, recorded) {
        (Given::Opened(own), Given::Opened(then)) => {
            // The sandbox is a property of the machine, not of the planner.
            let own = PlannerInfo { sandbox: then.sandbox.clone(), ..(**own).clone() };
            (own != **then).then(|| another_planner(&own, then).into())
        }
        (Given::Command(own), Given::Command(then)) => {
            is(as_sent(*own) != as_sent(*then), "commands something different")
        }
        (Given::Plan(own), Given::Plan(then)) => {
            let is_same = own.path == then.path
                && own.complete == then.complete
                && own.legs == then.legs
                && own.cuts == then.cuts;
            is(!is_same, "plans a different path")
        }
        (own, then) => is(own != then, "answers with something different"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ask::{AskId, Said, WorkerId},
        planner::During,
    };
    use planner_api::{LogLevel, Plan, Status};

    fn answer(result: Result<Given, Fault>) -> Answer {
        Answer { ask: AskId { worker: WorkerId(1), n: 1 }, result, said: Said::default() }
    }

    fn fault(cause: Cause, message: &str) -> Fault {
        let (planner, message) = ("apf".into(), message.into());
        Fault { planner, during: During::Step, cause, message, partial: Vec::new(), plugin_sha256: None }
    }

    fn compared(own: Result<Given, Fault>, recorded: Result<Given, Fault>) -> Comparison {
        Comparison::of(&answer(own), &answer(recorded), |command| command)
    }

    fn is_different(comparison: &Comparison, how: &str) -> bool {
        matches!(comparison, Comparison::Different(why) if why == how)
    }

    #[test]
    fn a_command_is_the_same_when_it_is_sent_the_same() {
        let (waiting, stuck) = (Command::still(Status::Waiting), Command::still(Status::Stuck));
        let given = |command| answer(Ok(Given::Command(command)));
        assert_eq!(Comparison::of(&given(waiting), &given(stuck), |_| stuck), Comparison::Same);
        let other = Comparison::of(&given(waiting), &given(stuck), |command| command);
        assert!(is_different(&other, "commands something different"));
    }

    #[test]
    fn a_plan_is_compared_without_its_cost_which_is_not_recorded() {
        let plan = Plan { complete: true, ..Plan::default() };
        let dearer = Plan { cost: plan.cost + 1.0, ..plan.clone() };
        assert_eq!(compared(Ok(Given::Plan(dearer)), Ok(Given::Plan(plan.clone()))), Comparison::Same);
        let other = compared(Ok(Given::Plan(Plan::default())), Ok(Given::Plan(plan)));
        assert!(is_different(&other, "plans a different path"));
    }

    #[test]
    fn another_build_is_named_with_both_digests() {
        let opened = |sha256: &str, about: &str| PlannerInfo {
            id: "apf".into(),
            name: "APF".into(),
            version: "0.1.0".into(),
            about: about.into(),
            plugin: "libplanner_apf.so".into(),
            sha256: sha256.into(),
            abi: "1.2".into(),
            covers: false,
            snapshots: false,
            sandbox: None,
            parameters: Vec::new(),
        };
        let against = |own: PlannerInfo| {
            let then = Box::new(opened("0123456789abcdef", "fields"));
            compared(Ok(Given::Opened(Box::new(own))), Ok(Given::Opened(then)))
        };
        let other = against(opened("fedcba9876543210", "fields"));
        let text =
            "is a different build (SHA-256 fedcba987654... of libplanner_apf.so, recorded: 0123456789ab...)";
        assert!(is_different(&other, text), "{other:?}");
        assert!(is_different(
            &against(opened("0123456789abcdef", "others")),
            "has different properties or parameters"
        ));
    }

    #[test]
    fn the_same_answer_with_other_words_is_a_difference() {
        let (quiet, mut loud) = (answer(Ok(Given::Reconfigured)), answer(Ok(Given::Reconfigured)));
        loud.said.logs.push((LogLevel::Warn, "narrow".into()));
        let other = Comparison::of(&loud, &quiet, |command| command);
        assert!(is_different(&other, "logs or draws something different"));
    }

    #[test]
    fn faults_are_compared_and_what_the_mission_refused_is_not() {
        let (panic, other) = (fault(Cause::Panic, "it panicked"), fault(Cause::BadOutput, "it gave NaN"));
        assert_eq!(compared(Err(panic.clone()), Err(panic.clone())), Comparison::Same);
        let different = compared(Err(other), Err(panic.clone()));
        assert!(is_different(&different, "fails with \"it gave NaN\" instead of \"it panicked\""));
        let far = fault(Cause::BadOutput, "it gave a path far outside the tank");
        assert_eq!(compared(Ok(Given::Plan(Plan::default())), Err(far)), Comparison::NotComparable);
        let well = compared(Ok(Given::Reconfigured), Err(panic.clone()));
        assert!(is_different(&well, "does not fail (recorded: \"it panicked\")"));
        assert!(is_different(&compared(Err(panic), Ok(Given::Reconfigured)), "fails: it panicked"));
    }
}
