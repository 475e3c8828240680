//! The meaning of alarms about a real vehicle.

use super::remedy::{END, Guide, HOLD, Remedy, When, check, run, wait};
use crate::actions::ActionId;

const RESUME: Remedy =
    run("Resume when the vehicle can be driven. Asks first.", ActionId::Resume).when(When::Held);

pub(super) const LINK: Guide = Guide {
    cause: "The vehicle sends nothing, or only faulty messages: its adapter has ended, the network is cut, or the \
    robot is switched off.",
    holds: "The robot is held at once.",
    effect: "The vehicle stops when its lease lapses; the console cannot confirm this. The robot's position is unknown.",
    remedies: &[
        check("Look at the robot, and use its emergency stop if it moves."),
        check("Check adapter, cable and network; a closed link needs a new run."),
        RESUME,
        END,
    ],
};

pub(super) const VEHICLE: Guide = Guide {
    cause: "The vehicle cannot be driven: a person is driving it by hand, its emergency stop is pressed, it reports a \
    fault, or another vehicle answers in its place.",
    holds: "The robot is held at once.",
    effect: "Position, coverage and tether are still updated.",
    remedies: &[check("Ask the person at the robot what is wrong, and clear the cause there."), RESUME, END],
};

pub(super) const FAULTY_MESSAGES: Guide = Guide {
    cause: "Some lines of the vehicle are not valid messages; the alarm names the field of the first and of the last one.",
    holds: "If three lines in a row are faulty, the robot is held.",
    effect: "Faulty messages are ignored, so their motion and their ranges are missing.",
    remedies: &[
        wait("Correct the adapter before the next mission; `tankops check --vehicle` tests it."),
        HOLD,
    ],
};

pub(super) const CLOCK: Guide = Guide {
    cause: "The stamps of the vehicle run faster or slower than the console's clock by more than 1 %.",
    holds: "",
    effect: "The ages of readings are wrong: old ones may count as new, and the link may seem lost.",
    remedies: &[
        wait("Stamp with a clock that runs in seconds, such as the monotonic clock of the computer."),
        HOLD,
    ],
};

pub(super) const CONSOLE_STOPPED: Guide = Guide {
    cause: "The computer of the console was suspended, or its process was stopped or got no time to run.",
    holds: "The robot is held at once.",
    effect: "The console sent no commands in this time, so the vehicle stopped when its lease lapsed.",
    remedies: &[
        check("Keep the computer awake during a mission: lid open, power connected, no other heavy work."),
        RESUME,
        END,
    ],
};

pub(super) const GUARD: Guide = Guide {
    cause: "The scan of the vehicle shows something in the way of the hull that the plan does not avoid, or the scan is \
    missing or too old.",
    holds: "If the robot cannot go on, it is held.",
    effect: "The guard continues to limit the robot.",
    remedies: &[
        wait("Look at the place, and remove the object, or draw a no-go zone around it."),
        RESUME,
        run("Drive back to the anchor or the start. Asks first.", ActionId::DriveBack),
        END,
    ],
};

pub(super) const STOP_NOT_CONFIRMED: Guide = Guide {
    cause: "The vehicle was commanded to stop, but after twice its stop time, odometry still shows motion or is \
    missing.",
    holds: "",
    effect: "The robot may still move. The console repeats the command in every tick.",
    remedies: &[check("Use the emergency stop of the robot."), HOLD, END],
};

pub(super) const DEAD_CHANNEL: Guide = Guide {
    cause: "A channel of the instrument has failed: its sensor, its cable or its amplifier.",
    holds: "",
    effect: "The floor under the channel does not count as scanned. It is missed floor with the reason \
    \"dead channel\".",
    remedies: &[
        HOLD,
        check("Check the cable and the sensor of the channel, and test the tool on the reference plate."),
        check("After the mission, scan the missed floor again: <rescan> on the screen Result."),
    ],
};
