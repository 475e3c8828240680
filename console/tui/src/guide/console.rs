//! The meaning of alarms about the console itself.

use super::remedy::{END, Guide, HOLD, SLOWER, When, check, run, wait};
use crate::actions::ActionId;
use crate::screens::Screen;

pub(super) const RECORDING: Guide = Guide {
    cause: "The journal or recording cannot be written, or was deleted, moved, replaced or truncated.",
    holds: "",
    effect: "The mission continues. About 40 minutes of the journal are kept in memory; anything deleted is \
    lost.",
    remedies: &[
        wait("If the disk is full, free some space: queued data is then written."),
        wait("If the folder was moved, move it back."),
        run("HOLD the robot until recording works again.", ActionId::Hold).when(When::Moving),
        END,
    ],
};

pub(super) const WRITER: Guide = Guide {
    cause: "The console running this mission exited without closing the run: it was killed, or its machine \
    stopped.",
    holds: "",
    effect: "The state of the robot since the last event is unknown.",
    remedies: &[
        check("Check the robot on site."),
        run("Show the robot's last known position.", ActionId::Go(Screen::Mission)),
        run("Show the result of the run from its journal.", ActionId::Go(Screen::Result)),
    ],
};

pub(super) const CONSOLE: Guide = Guide {
    cause: "A thread of the console panicked, or an order did not reach the mission.",
    holds: "If a thread failed, the robot is held.",
    effect: "Orders may have no effect.",
    remedies: &[HOLD, END, run("Quit the console. Holds, then asks.", ActionId::Leave)],
};

pub(super) const RESPONSE: Guide = Guide {
    cause: "One key press in a hundred takes longer than 33 ms (while the robot stands still, 100 ms) to appear on \
    the screen: the machine or the terminal is too busy.",
    holds: "",
    effect: "Only the screen is slow. HOLD is always handled first.",
    remedies: &[SLOWER, check("Close other programs, or make the terminal smaller.")],
};

pub(super) const FRAMES: Guide = Guide {
    cause: "Drawing cannot keep up with the mission: the machine or the terminal is too busy.",
    holds: "",
    effect: "The screen skips some states. The journal loses nothing.",
    remedies: &[SLOWER, check("Close other programs, or make the terminal smaller.")],
};

pub(super) const RECORDER_LAG: Guide = Guide {
    cause: "The mission produces data faster than the disk can write it.",
    holds: "",
    effect: "Nothing is lost. When the queue is half full, the simulation waits for the disk.",
    remedies: &[SLOWER, wait("Wait until the recorder has caught up."), HOLD],
};

pub(super) const DISK: Guide = Guide {
    cause: "Less than 200 MB is left on the disk that holds the runs; a mission takes about 100 MB an hour.",
    holds: "",
    effect: "Once the disk is full, the latest 40 minutes of the journal are kept only in memory.",
    remedies: &[
        check("Free some space, or move old runs elsewhere."),
        run("HOLD the robot until there is space.", ActionId::Hold).when(When::Moving),
        END,
    ],
};
