//! What each alarm means and what the operator can do about it.

mod console;
mod drawing;
mod position;
mod remedy;
mod tether;
mod vehicle;

pub use remedy::{Guide, Remedy, When};

use crate::actions::ActionId;
use crate::model::{Alarm, Cause, Run};
use crate::screens::Screen;
use crate::view::text;
use mission::Phase;
use positioning::Exclusion;
use remedy::{END, OTHER_PLANNER, PARAMETERS, PLAN_AGAIN, RESUME, SHOW, check, run};

/// The name of an alarm in a table, short enough for one row.
pub fn name(cause: &Cause, of: &Run) -> String {
    match cause {
        Cause::PositionLost => "position lost".into(),
        Cause::Contradiction => "AE ranges contradict each other".into(),
        Cause::NotProtected => "position not protected".into(),
        Cause::Bias(id) => format!("station {} biased", of.station_name(*id).trim_start_matches("station ")),
        Cause::NotSeparable => "station bias not separable".into(),
        Cause::Pulses => "pulse test not passed".into(),
        Cause::NoFix => "no position fix".into(),
        Cause::DeadChannel => "channel dead".into(),
        Cause::Station(id) => {
            let is_by_order = of.position.exclusion(*id) == Some(&Exclusion::ByOrder);
            let what = if is_by_order { "excluded" } else { "rejected" };
            format!("station {} {what}", of.station_name(*id).trim_start_matches("station "))
        }
        Cause::Map if of.finds_only_moving() => "moving obstacle".into(),
        Cause::Map => "new obstacle, not on drawing".into(),
        Cause::NotThere(name) => format!("{} not found", text::fit(name, 18)),
        Cause::Tether(word) => tether::name(word),
        Cause::Certificate => "plan not certified for tether".into(),
        Cause::Zone(zone) => format!("hull in zone {}", text::fit(zone, 18)),
        Cause::Link => "link to vehicle lost".into(),
        Cause::Vehicle => "vehicle cannot be driven".into(),
        Cause::FaultyMessages => "faulty messages from vehicle".into(),
        Cause::VehicleClock => "vehicle clock runs wrong".into(),
        Cause::ConsoleStopped => "console was stopped".into(),
        Cause::Guard => "guard stopped the robot".into(),
        Cause::StopNotConfirmed => "STOP NOT CONFIRMED".into(),
        Cause::Planner => "planner failed".into(),
        Cause::Stuck => "robot stuck".into(),
        Cause::Ended => "mission ended early".into(),
        Cause::Recording => "recording FAILED".into(),
        Cause::Writer => "console of this run was killed".into(),
        Cause::Console => "part of the console failed".into(),
        Cause::Response => "console responds slowly".into(),
        Cause::Frames => "screen skips frames".into(),
        Cause::RecorderLag => "recorder is behind".into(),
        Cause::Disk => "little disk space left".into(),
    }
}

/// The meaning of an alarm now. A station that the fix does not use has several possible causes; the last fix states which
/// one applies.
pub fn meaning(cause: &Cause, of: &Run) -> Guide {
    match cause {
        Cause::Station(id) => of.position.exclusion(*id).map_or(position::STATION, position::excluded),
        Cause::Tether(word) if word == "reel" && of.is_survey() => tether::REEL_OF_SURVEY,
        Cause::Map if of.finds_only_moving() => drawing::MOVING,
        cause => guide(cause),
    }
}

/// The meaning of an alarm, and what the operator can do about it, as far as they do not depend on the run.
pub fn guide(cause: &Cause) -> Guide {
    match cause {
        Cause::PositionLost => position::POSITION_LOST,
        Cause::Contradiction => position::CONTRADICTION,
        Cause::NotProtected => position::NOT_PROTECTED,
        Cause::Bias(_) => position::BIAS,
        Cause::NotSeparable => position::NOT_SEPARABLE,
        Cause::Pulses => position::PULSES,
        Cause::NoFix => position::NO_FIX,
        Cause::Station(_) => position::STATION,
        Cause::DeadChannel => vehicle::DEAD_CHANNEL,
        Cause::Recording => console::RECORDING,
        Cause::Writer => console::WRITER,
        Cause::Console => console::CONSOLE,
        Cause::Response => console::RESPONSE,
        Cause::Frames => console::FRAMES,
        Cause::RecorderLag => console::RECORDER_LAG,
        Cause::Disk => console::DISK,
        Cause::Map => drawing::UNKNOWN,
        Cause::NotThere(_) => drawing::NOT_THERE,
        Cause::Tether(word) => tether::guide(word),
        Cause::Link => vehicle::LINK,
        Cause::Vehicle => vehicle::VEHICLE,
        Cause::FaultyMessages => vehicle::FAULTY_MESSAGES,
        Cause::VehicleClock => vehicle::CLOCK,
        Cause::ConsoleStopped => vehicle::CONSOLE_STOPPED,
        Cause::Guard => vehicle::GUARD,
        Cause::StopNotConfirmed => vehicle::STOP_NOT_CONFIRMED,
        Cause::Certificate => Guide {
            cause: "If run to its end, the plan would exceed a tether limit, touch something, or finish \
            with the tether still out.",
            holds: "The planner makes another plan; if that is refused, too, the robot is held.",
            effect: "A refused plan is not run. An uncertified plan is run only on the operator's order.",
            remedies: const {
                &[
                    OTHER_PLANNER,
                    PARAMETERS,
                    run("Run the plan uncertified. Asks first.", ActionId::FlyUncertified),
                    END,
                ]
            },
        },
        Cause::Zone(_) => Guide {
            cause: "The hull is in a no-go zone: the zone was drawn across its path, or the position was wrong.",
            holds: "The robot is held at once.",
            effect: "",
            remedies: const {
                &[
                    SHOW,
                    run("Drive back to the anchor or the start. Asks first.", ActionId::DriveBack),
                    check("To go on: drive back, HOLD outside the zone, then resume."),
                    run(
                        "Resume: replans from here; may get stuck in the zone. Asks first.",
                        ActionId::Resume,
                    ),
                ]
            },
        },
        Cause::Planner => Guide {
            cause: "The planner crashed, hung, or sent an invalid answer; its process has ended.",
            holds: "The robot is held at once.",
            effect: "If the scenario names a fallback planner, it takes over automatically.",
            remedies: const { &[RESUME, PLAN_AGAIN, OTHER_PLANNER, PARAMETERS, END] },
        },
        Cause::Stuck => Guide {
            cause: "The robot has made no progress for longer than the mission allows (scenario: stuck_s).",
            holds: "The robot is held at once.",
            effect: "",
            remedies: const { &[RESUME, OTHER_PLANNER, PARAMETERS, END] },
        },
        Cause::Ended => Guide {
            cause: "The mission ended before its task was complete.",
            holds: "",
            effect: "Everything scanned and recorded is kept.",
            remedies: const {
                &[
                    run("Show the result (<result>).", ActionId::Go(Screen::Result)),
                    run("Scan what was missed: opens a new mission.", ActionId::Rescan),
                    run("Write the report.", ActionId::Report),
                ]
            },
        },
    }
}

/// The consequence of an alarm now, in sentences. A hold is stated only while the robot is held.
pub fn effect(alarm: &Alarm, of: &Run) -> String {
    let guide = meaning(&alarm.cause, of);
    if !alarm.is_active() {
        return remains(&alarm.cause, of.covers()).into();
    }
    let hold = match of.phase() {
        _ if guide.holds.is_empty() => "",
        Phase::Waiting => "The robot does not move before the start.",
        Phase::Running(_) => guide.holds,
        Phase::Held(_) if of.is_stopping() => "The robot has been commanded to stop.",
        Phase::Held(hold) if hold.resumes.is_never() => "The robot is held until the operator decides.",
        Phase::Held(_) => "The robot is held; it resumes automatically.",
        Phase::Ended(_) => "The mission has ended.",
    };
    let sentences = [hold, guide.effect].into_iter().filter(|sentence| !sentence.is_empty());
    sentences.collect::<Vec<_>>().join(" ")
}

/// The consequence of an alarm after its cause is gone, with the next step. Only a mission that scans can have missed floor.
fn remains(cause: &Cause, scans: bool) -> &'static str {
    match cause {
        _ if !scans => "None any more: the cause is gone.",
        Cause::DeadChannel => {
            "The cause is gone. Floor that the channel passed while it was dead stays missed floor until it is rescanned. \
             After the mission, press <rescan> on the screen Result: it makes a mission for the missed floor."
        }
        Cause::PositionLost | Cause::Contradiction => {
            "The cause is gone. Floor that the tool passed meanwhile did not count as scanned: the missed floor is on the \
             screen Result."
        }
        Cause::Bias(_) => {
            "The cause is gone. Floor whose guarantee was taken back stays in doubt until it is rescanned. After the \
             mission, press <rescan> on the screen Result."
        }
        _ => "None any more: the cause is gone.",
    }
}

/// The remedies that apply to an alarm now.
pub fn remedies<'a>(cause: &Cause, of: &'a Run) -> impl Iterator<Item = &'static Remedy> + use<'a> {
    let is_active = of.alarms.get(cause).is_none_or(Alarm::is_active);
    // A cleared alarm needs neither patience nor a hold, nor the end of the mission.
    let stays = |remedy: &Remedy| {
        remedy.action.is_some_and(|action| !matches!(action, ActionId::Abort | ActionId::Hold))
    };
    let applies = move |remedy: &&Remedy| remedy.when.holds(of) && (is_active || stays(remedy));
    meaning(cause, of).remedies.iter().filter(applies)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actions::ACTIONS;
    use world::StationId;

    #[test]
    fn every_alarm_has_cause_effect_and_one_to_four_remedies() {
        let of_stations = position::EXCLUDED.map(|guide| (Cause::Station(StationId(1)), guide));
        let of_survey = (Cause::Tether("reel".into()), tether::REEL_OF_SURVEY);
        let all = Cause::every().into_iter().map(|cause| (cause.clone(), guide(&cause)));
        for (cause, guide) in all.chain(of_stations).chain([of_survey]) {
            let texts = guide.remedies.iter().map(|remedy| remedy.text);
            let effects = [guide.holds, guide.effect].into_iter().filter(|text| !text.is_empty());
            assert!(effects.clone().next().is_some(), "{cause:?} has an effect");
            for text in std::iter::once(guide.cause).chain(effects).chain(texts) {
                assert!(text.ends_with('.') && text.starts_with(char::is_uppercase), "{cause:?}: {text}");
            }
            // Planning again and resuming exclude each other.
            let at_once = guide.remedies.iter().filter(|remedy| remedy.when != When::Waiting).count();
            assert!((1..=4).contains(&at_once), "{cause:?}");
            let name = name(&cause, &Run::default());
            assert!(!name.is_empty() && name.len() <= 31, "{name} fits into a table of 80 columns");
        }
    }

    #[test]
    fn an_alarm_that_cost_floor_says_so_after_its_cause_is_gone() {
        for cause in [Cause::DeadChannel, Cause::Bias(StationId(1))] {
            let words = remains(&cause, true);
            assert!(
                words.contains("until it is rescanned") && words.contains("<rescan> on the screen Result"),
                "{words}"
            );
            assert!(!words.contains("None any more"), "{words}");
        }
        for (cause, scans) in [(Cause::Disk, true), (Cause::PositionLost, false)] {
            assert_eq!(remains(&cause, scans), "None any more: the cause is gone.");
        }
    }

    #[test]
    fn every_remedy_that_is_run_is_an_action() {
        for remedy in Cause::every().iter().flat_map(|cause| guide(cause).remedies) {
            let known = |id| ACTIONS.iter().any(|action| action.id == id);
            assert!(remedy.action.is_none_or(known), "{}", remedy.text);
        }
    }
}
