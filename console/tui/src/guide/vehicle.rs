//! The meaning of alarms about a real vehicle.

use super::remedy::{END, Guide, HOLD, RESUME, wait};

pub(super) const LINK: Guide = Guide {
    cause: "The vehicle sends nothing, or only faulty messages: its adapter has ended, the network is cut, or the \
    robot is switched off.",
    effect: "The robot is held. The vehicle stops by its own lease; the console cannot confirm that. Where it is \
    now is unknown.",
    remedies: &[
        wait("Look at the robot, and use its emergency stop if it moves."),
        wait("Check adapter, cable and network; a closed link needs a new run."),
        RESUME,
        END,
    ],
};

pub(super) const VEHICLE: Guide = Guide {
    cause: "The vehicle refuses to be driven: someone drives it by hand, its emergency stop is pressed, or it \
    reports a fault.",
    effect: "The robot is held until the operator resumes. Position, coverage and tether go on counting.",
    remedies: &[wait("Ask the person at the robot, and clear the cause there."), RESUME, END],
};

pub(super) const STOP_NOT_CONFIRMED: Guide = Guide {
    cause: "The vehicle was commanded to stand, but its odometry shows motion, or does not arrive, after twice its \
    stop time.",
    effect: "The robot may still move. The console repeats the command in every tick.",
    remedies: &[wait("Use the emergency stop of the robot."), HOLD, END],
};
