//! What the alarms of the console itself mean.

use super::remedy::{END, Guide, HOLD, SLOWER, run, wait};
use crate::actions::ActionId;
use crate::screens::Screen;

pub(super) const RECORDING: Guide = Guide {
    cause: "Journal or recording cannot be written, or was deleted, replaced or truncated.",
    effect: "The mission goes on. About 40 minutes of the journal are kept in memory; what was deleted is lost.",
    remedies: &[
        wait("If the disk is full, free some space: what waits is written then."),
        wait("If the folder was moved, move it back."),
        run("HOLD the robot until it is recorded again.", ActionId::Hold),
        END,
    ],
};

pub(super) const WRITER: Guide = Guide {
    cause: "The console that flew this run ended without closing it: it was killed, or its machine stopped.",
    effect: "Nothing is known of the robot after the last event.",
    remedies: &[
        wait("Look after the robot where it is."),
        run("Show the last known place of the robot.", ActionId::Go(Screen::Mission)),
        run("Show what the journal says of the run.", ActionId::Go(Screen::Result)),
    ],
};

pub(super) const CONSOLE: Guide = Guide {
    cause: "A thread of the console panicked, or an order did not reach the mission.",
    effect: "The robot is held if a thread failed. Orders may not be obeyed.",
    remedies: &[HOLD, END, run("Quit the console: holds, then asks.", ActionId::Leave)],
};

pub(super) const RESPONSE: Guide = Guide {
    cause: "From a key to the frame that shows it takes longer than 33 ms for one key in a hundred: machine or \
            terminal are too busy.",
    effect: "The screen lags. HOLD does not: it goes to the mission before anything is drawn.",
    remedies: &[SLOWER, wait("Close other programs, or make the terminal smaller.")],
};

pub(super) const FRAMES: Guide = Guide {
    cause: "Drawing does not keep up with the mission: machine or terminal are too busy.",
    effect: "The screen shows fewer states. Nothing is lost in the journal.",
    remedies: &[SLOWER, wait("Close other programs, or make the terminal smaller.")],
};

pub(super) const RECORDER_LAG: Guide = Guide {
    cause: "The mission produces more than the disk takes.",
    effect: "Nothing is lost. When half of the queue is full, the simulation waits for the disk.",
    remedies: &[SLOWER, wait("Wait until it has caught up."), HOLD],
};

pub(super) const DISK: Guide = Guide {
    cause: "Less than 200 MB are left where runs are kept; a mission takes about 40 MB an hour.",
    effect: "When the disk is full, the last 40 minutes of a journal are kept in memory only.",
    remedies: &[
        wait("Free some space, or move old runs elsewhere."),
        run("HOLD the robot until there is space.", ActionId::Hold),
        END,
    ],
};
