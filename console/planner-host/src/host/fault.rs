//! Describes failures in sentences for the operator. The sentences are written to the journal, so they contain no
//! times, process ids or addresses.

use crate::supervisor::{Failure, overweight};
use crate::wire::answer::{BAD_OUTPUT, Refusal};
use mission::planner::{Cause, During, Fault};
use nalgebra::Point2;
use planner_api::Code;
use std::fmt;

/// The call that a planner was executing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Phase {
    Load,
    Configure,
    Reconfigure,
    Plan,
    /// Saving or restoring private state.
    State,
    /// Nothing: the planner waits for a request.
    Idle,
    /// A step with this tick number.
    Step(u64),
}

impl Phase {
    pub(super) fn during(self) -> During {
        match self {
            Self::Load => During::Load,
            Self::Configure => During::Configure,
            Self::Reconfigure => During::Reconfigure,
            Self::Plan => During::Plan,
            Self::State | Self::Idle | Self::Step(_) => During::Step,
        }
    }
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Load => f.write_str("load"),
            Self::Configure => f.write_str("configure"),
            Self::Reconfigure => f.write_str("the change of its parameters"),
            Self::Plan => f.write_str("plan"),
            Self::State => f.write_str("saving its state"),
            Self::Idle => f.write_str("a pause between two requests"),
            Self::Step(tick) => write!(f, "step {tick}"),
        }
    }
}

/// Creates a fault with this message.
pub(super) fn new(planner: &str, during: During, cause: Cause, message: String) -> Fault {
    Fault { planner: planner.to_owned(), during, cause, message, partial: Vec::new(), plugin_sha256: None }
}

/// Creates the fault for parameter values that a planner does not accept in this phase.
pub(super) fn of_parameters(planner: &str, phase: Phase, message: String) -> Fault {
    new(planner, phase.during(), Cause::Refused, message + kept(phase))
}

/// Creates the fault for an answer that no robot can follow; `what` completes a sentence that begins with the planner's
/// name.
pub(super) fn bad_output(planner: &str, phase: Phase, what: &str) -> Fault {
    new(planner, phase.during(), Cause::BadOutput, format!("planner {planner} {what} during {phase}"))
}

/// Converts a failure into a fault of a planner.
pub(crate) fn of(failure: Failure, planner: &str, phase: Phase) -> Fault {
    let fault = |cause, message| new(planner, phase.during(), cause, message);
    match failure {
        Failure::Planner(refusal) => of_refusal(refusal, planner, phase),
        Failure::Refused(why) => fault(Cause::Refused, format!("planner {planner} is refused: {why}")),
        Failure::Console(why) => fault(Cause::Refused, format!("planner {planner} {why}")),
        Failure::Died { how, last_output } => {
            fault(Cause::Died, format!("planner {planner} {how} during {phase}{}", last_words(&last_output)))
        }
        Failure::Forbidden { call, last_output } => fault(
            Cause::Forbidden,
            format!(
                "planner {planner} tried a forbidden system call ({call}) during {phase}; its process was killed{}",
                last_words(&last_output)
            ),
        ),
        Failure::Hung => fault(
            Cause::Hung,
            format!(
                "planner {planner} did not finish {phase} in time and ignored the request to stop; its process was killed"
            ),
        ),
        Failure::Late => {
            fault(Cause::Late, format!("planner {planner} was too slow: it missed the deadline for {phase}"))
        }
        Failure::Starved => fault(
            Cause::Starved,
            format!(
                "planner {planner} was starved of CPU time and did not finish {phase}; its process was killed"
            ),
        ),
        Failure::Overweight(limit) => fault(
            Cause::Died,
            format!("planner {planner} {} during {phase}; its process was killed", overweight(limit)),
        ),
        Failure::Protocol => fault(
            Cause::Protocol,
            format!("planner {planner} sent an invalid reply during {phase}; its process was killed"),
        ),
        Failure::Gone => {
            let who =
                if planner.is_empty() { "the planner".to_owned() } else { format!("planner {planner}") };
            let why = "its process has ended; choose the planner again";
            fault(Cause::Died, format!("{who} is not available for {phase}: {why}"))
        }
    }
}

fn last_words(last_output: &str) -> String {
    if last_output.is_empty() { String::new() } else { format!("; last output: {last_output}") }
}

fn of_refusal(refusal: Refusal, planner: &str, phase: Phase) -> Fault {
    let Refusal { code, message, partial } = refusal;
    let fault = |cause, message| new(planner, phase.during(), cause, message);
    match Code::from_number(code) {
        Some(Code::Timeout | Code::Cancelled) => of(Failure::Late, planner, phase),
        Some(Code::Panic) => {
            let (place, text) = message.split_once(": ").unwrap_or(("an unknown location", &message));
            fault(Cause::Panic, format!("planner {planner} panicked at {place} during {phase}: {text}"))
        }
        Some(Code::Poisoned) => {
            fault(Cause::Panic, format!("planner {planner} cannot continue during {phase}: {message}"))
        }
        Some(code) => {
            let is_finite = |point: &Point2<f64>| point.x.is_finite() && point.y.is_finite();
            let partial = if partial.iter().all(is_finite) { partial } else { Vec::new() };
            let message = format!("planner {planner} {}: {message}{}", gave_up(phase), kept(phase));
            Fault { partial, ..fault(Cause::Planner(code), message) }
        }
        None if code == BAD_OUTPUT => bad_output(planner, phase, &message),
        None => bad_output(planner, phase, &format!("failed with unknown code {code} ({message})")),
    }
}

/// Returns the end of the message about a refusal. If the planner refused changed parameters, it states that the old
/// values stay in effect; otherwise it is empty.
fn kept(phase: Phase) -> &'static str {
    if phase == Phase::Reconfigure { "; its old values stay in effect" } else { "" }
}

fn gave_up(phase: Phase) -> String {
    match phase {
        Phase::Step(tick) => format!("gave up at step {tick}"),
        Phase::Reconfigure => "refused the changed parameters".to_owned(),
        other => format!("gave up during {other}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(code: i32, message: &str) -> Fault {
        let partial = vec![Point2::new(1.0, 2.0)];
        of(Failure::Planner(Refusal { code, message: message.into(), partial }), "apf", Phase::Step(12))
    }

    #[test]
    fn a_panic_names_place_step_and_text() {
        let fault = refused(Code::Panic as i32, "plugins/apf/src/lib.rs:31: index 7: out of bounds");
        let sentence =
            "planner apf panicked at plugins/apf/src/lib.rs:31 during step 12: index 7: out of bounds";
        assert_eq!((fault.message.as_str(), fault.cause), (sentence, Cause::Panic));
    }

    #[test]
    fn a_refusal_keeps_code_and_part_of_the_way() {
        let fault = refused(Code::NoPath as i32, "walled in");
        assert_eq!(fault.message, "planner apf gave up at step 12: walled in");
        assert_eq!((fault.cause, fault.partial.len()), (Cause::Planner(Code::NoPath), 1));
    }

    #[test]
    fn a_planner_that_refuses_new_values_has_not_given_up() {
        let refusal = Refusal { code: Code::Unsupported as i32, message: "too late".into(), partial: vec![] };
        let fault = of(Failure::Planner(refusal), "apf", Phase::Reconfigure);
        assert_eq!(
            fault.message,
            "planner apf refused the changed parameters: too late; its old values stay in effect"
        );
        assert!(fault.refuses_change());
    }

    #[test]
    fn a_planner_that_noticed_its_own_deadline_is_late_all_the_same() {
        for code in [Code::Timeout, Code::Cancelled] {
            let fault = refused(code as i32, "whatever it says");
            assert_eq!(fault, of(Failure::Late, "apf", Phase::Step(12)));
        }
    }

    #[test]
    fn codes_that_do_not_exist_are_bad_output() {
        assert_eq!(refused(4711, "?").cause, Cause::BadOutput);
        assert_eq!(
            refused(BAD_OUTPUT, "gave no command").message,
            "planner apf gave no command during step 12"
        );
    }
}
