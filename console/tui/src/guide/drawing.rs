//! The meaning of alarms about the drawing.

use super::remedy::{Guide, HOLD, SHOW, check};

pub(super) const UNKNOWN: Guide = Guide {
    cause: "Unknown obstacle: the robot detects something that is not on the drawing.",
    holds: "",
    effect: "Planners avoid it. In a scan, the floor under it is not counted, and floor that it blocks becomes \
    unreachable.",
    remedies: const { &[SHOW, check("Check what it is: nozzle, sump, debris."), HOLD] },
};

pub(super) const MOVING: Guide = Guide {
    cause: "The robot detects an obstacle that moves, such as a cart or a person.",
    holds: "",
    effect: "Planners avoid it where it is now. In a scan, the floor that it stands on is not counted.",
    remedies: const { &[SHOW, check("Check who or what moves in the tank."), HOLD] },
};

pub(super) const NOT_THERE: Guide = Guide {
    cause: "The scanner sees through the place of an obstacle: it was removed, has moved, or is drawn in the \
    wrong place; or the robot's position is wrong.",
    holds: "",
    effect: "Planners still avoid its place, so the floor around it may stay unscanned.",
    remedies: const {
        &[
            SHOW,
            check("Check on site that the obstacle was removed or moved."),
            check("If other obstacles are displaced too, check the position of the robot."),
            check("Correct the drawing before the next mission."),
        ]
    },
};
