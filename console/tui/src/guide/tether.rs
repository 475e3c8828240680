//! The meaning of tether alarms.

use super::remedy::{END, Guide, OTHER_PLANNER, RESUME, Remedy, SHOW, STAY, When, run, wait};
use crate::actions::ActionId;

const PULL_HOLD: Remedy = run("HOLD, and check reel and tether.", ActionId::Hold);

/// The name of a tether alarm; `word` is the word used in its event.
pub(super) fn name(word: &str) -> String {
    match word {
        "reel" => "tether: reel nearly out".into(),
        "wrap" => "tether wraps an obstacle".into(),
        "total wrap" => "tether: total wrap".into(),
        "snag" => "tether SNAGGED".into(),
        "return path" => "return path BLOCKED".into(),
        "stray" => "robot crossed a cut of its plan".into(),
        "slack" => "tether SLACK".into(),
        "broken" => "tether BROKEN".into(),
        "reel pull" => "tether: reel too weak".into(),
        "robot pull" => "tether pulls robot too hard".into(),
        other => format!("tether: {other}"),
    }
}

/// The meaning of the alarm about the length in a survey, which has no certified plan.
pub(super) const REEL_OF_SURVEY: Guide = Guide {
    cause: "More than 80 % of the tether is out. A survey chooses its ways within the reel and leaves out the places beyond \
    it.",
    holds: "When the reel is empty, the robot is held.",
    effect: "",
    remedies: &[
        wait("Wait: the survey keeps its ways within the reel.").when(When::Moving),
        run("Resume: frees the tether, then chooses another way. Asks first.", ActionId::Resume)
            .when(When::Held),
        run("Drive back to the anchor or the start. Asks first.", ActionId::DriveBack).when(When::Held),
        END,
    ],
};

/// The meaning of a tether alarm, and what the operator can do about it.
pub(super) fn guide(word: &str) -> Guide {
    match word {
        "reel" => Guide {
            cause: "More than 80 % of the tether is out, and more than a certified plan promises.",
            holds: "When the reel is empty, the robot is held.",
            effect: "",
            remedies: const {
                &[
                    run("Resume: frees the tether, then replans from here. Asks first.", ActionId::Resume)
                        .when(When::Held),
                    OTHER_PLANNER,
                    END,
                ]
            },
        },
        "wrap" | "total wrap" => Guide {
            cause: "The tether bends round obstacles by more than 80 % of the limit.",
            holds: "At the limit, the robot is held.",
            effect: "Each wrap multiplies the pull.",
            remedies: const {
                &[
                    SHOW,
                    run("Resume: frees the tether, then continues. Asks first.", ActionId::Resume)
                        .when(When::Held),
                    OTHER_PLANNER,
                    END,
                ]
            },
        },
        "snag" => Guide {
            cause: "The reel has paid out more than the map explains: an unmapped object holds the tether. Without a sensor of the \
            pull, the tether may also be slack.",
            holds: "The robot is held at once.",
            effect: "The tether's position is unknown; the return path is UNKNOWN.",
            remedies: const {
                &[
                    run(
                        "Resume: frees the tether by driving back the way it came. Asks first.",
                        ActionId::Resume,
                    )
                    .when(When::Held),
                    SHOW,
                    run("Stay held (HOLD), and free the tether by hand.", ActionId::Hold),
                    END,
                ]
            },
        },
        "slack" => Guide {
            cause: "The tether does not pull, and the reel has not taken up what the robot has driven back: the reel has \
            stopped, or it is too weak for the tether.",
            holds: "At 0.2 m, the robot is held.",
            effect: "If the robot drives on, it may drive over its own tether.",
            remedies: const {
                &[
                    run("Stay held (HOLD), and check the reel.", ActionId::Hold),
                    run("Resume: takes the slack in by driving back the way it came, then replans. Asks first.", ActionId::Resume)
                        .when(When::Held),
                    run("Drive back beside the tether, if the reel does not work. Asks first.", ActionId::DriveBack)
                        .when(When::Held),
                    END,
                ]
            },
        },
        "broken" => broken(),
        "reel pull" => Guide {
            cause: "Taking up the tether from here needs more pull than the reel has.",
            holds: "",
            effect: "The reel stops taking up the tether, so slack lies on the floor.",
            remedies: const { &[SHOW, PULL_HOLD, OTHER_PLANNER, END] },
        },
        "robot pull" => Guide {
            cause: "The tether pulls the robot harder than the scenario permits (tether.robot_pull_n).",
            holds: "",
            effect: "The robot may slip, and its odometry with it.",
            remedies: const { &[PULL_HOLD, SHOW, OTHER_PLANNER, END] },
        },
        "return path" => Guide {
            cause: "The hull does not fit through the return path along the tether.",
            holds: "The robot is held at once.",
            effect: "",
            remedies: const {
                &[
                    wait("Wait: the mission resumes automatically as soon as the hull fits again.")
                        .when(When::Resuming),
                    STAY,
                    OTHER_PLANNER,
                    END,
                ]
            },
        },
        _ => Guide {
            cause: "The robot left its plan and crossed a cut, a line that keeps the tether from winding \
            round obstacles.",
            holds: "",
            effect: "The mission is replanned automatically.",
            remedies: const { &[wait("Wait for the new plan.").when(When::Moving), STAY, RESUME, END] },
        },
    }
}

fn broken() -> Guide {
    Guide {
        cause: "Less tether is off the reel than a tether to the robot needs, and nothing pulls: the tether is torn. Without a \
        sensor of the pull, the encoder of the reel may also be wrong.",
        holds: "The robot is held at once.",
        effect: "A loose end lies on the floor. A robot that gets power and orders by its tether cannot move.",
        remedies: const {
            &[
                run("Stay held (HOLD), and fetch robot and tether by hand.", ActionId::Hold),
                run("Drive back beside the tether that lies on the floor. Asks first.", ActionId::DriveBack)
                    .when(When::Held),
                run(
                    "Resume, if the robot has power and a link without its tether. Asks first.",
                    ActionId::Resume,
                )
                .when(When::Held),
                END,
            ]
        },
    }
}
