//! What the alarms of the position mean.

use super::remedy::{END, Guide, HOLD, SHOW, STAY, run, wait};
use crate::actions::ActionId;

pub(super) const POSITION_LOST: Guide = Guide {
    cause: "The 95 % position error is above the limit of the mission: too few stations are heard, they stand \
            badly for this place, or echoes spoil their ranges.",
    effect: "Robot is held automatically after a short delay (scenario: position_lost_hold_s). Floor passed \
             meanwhile does not count as scanned.",
    remedies: &[
        wait("Wait: the mission resumes automatically when the position is recovered."),
        STAY,
        run("Show where a good position is expected (map layers).", ActionId::Layers),
        END,
    ],
};

pub(super) const CONTRADICTION: Guide = Guide {
    cause: "Several stations report wrong ranges at the same time: sound path blocked by columns, echoes, or \
            wrong station data. Which ones cannot be identified.",
    effect: "Robot is held automatically. Floor does not count as scanned until the ranges agree.",
    remedies: &[
        wait("Wait: the mission resumes automatically when the ranges agree again."),
        STAY,
        wait("Check the residuals: a station that is wrong all the time has wrong data."),
        END,
    ],
};

pub(super) const NO_FIX: Guide = Guide {
    cause: "The ranges of this cycle give no position: too few stations were heard, or they stand on one line.",
    effect: "The position is dead reckoning; its error grows until the next fix.",
    remedies: &[wait("Wait for the next ranging cycle."), HOLD],
};

pub(super) const STATION: Guide = Guide {
    cause: "Its range disagrees with the others by more than its gate, or it was not heard: echo, blocked sound \
            path, or wrong station data.",
    effect: "The position is computed without it, and is less accurate.",
    remedies: &[wait("Wait: the station is used again as soon as its range fits."), SHOW, HOLD],
};
