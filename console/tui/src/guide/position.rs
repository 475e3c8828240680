//! The meaning of position alarms.

use super::remedy::{END, Guide, HOLD, SHOW, STAY, When, check, run, wait};
use crate::actions::ActionId;
use positioning::Exclusion;

pub(super) const POSITION_LOST: Guide = Guide {
    cause: "The 95 % position error is above the mission's limit: too few stations are heard, their \
    geometry is poor here, or echoes corrupt their ranges.",
    holds: "If this lasts, the robot is held automatically (scenario: position_lost_hold_s).",
    effect: "Floor covered meanwhile does not count as scanned.",
    remedies: &[
        wait("Wait: the mission resumes automatically when the position is recovered.").when(When::Resuming),
        STAY,
        run("Show where a good fix is expected (map layers).", ActionId::Layers),
        END,
    ],
};

pub(super) const CONTRADICTION: Guide = Guide {
    cause: "Several stations report wrong ranges at the same time: columns block the sound, there are \
    echoes, or station data are wrong. The faulty stations cannot be identified.",
    holds: "If this lasts, the robot is held automatically (scenario: position_lost_hold_s).",
    effect: "Floor does not count as scanned until the ranges agree.",
    remedies: &[
        wait("Wait: the mission resumes automatically when the ranges agree again.").when(When::Resuming),
        STAY,
        check("Check the residuals. A station that is always wrong has wrong survey data."),
        END,
    ],
};

pub(super) const NOT_PROTECTED: Guide = Guide {
    cause: "The stations do not check each other: too few are heard, or their ranges fit no single wrong station. \
    A wrong station could move the position without an alarm.",
    holds: "",
    effect: "Floor scanned meanwhile is not guaranteed if the scenario requires the protection level.",
    remedies: &[
        wait("Wait for the next ranging cycles."),
        check("Check the residuals: two stations may be wrong at the same time."),
        HOLD,
    ],
};

pub(super) const BIAS: Guide = Guide {
    cause: "All ranges of the station are too long or too short by the same length: its clock, its survey data or its \
    coupling to the shell changed.",
    holds: "",
    effect: "Floor scanned since the bias may have begun is in doubt: its guarantee is taken back. The station is not \
    used, or corrected (scenario: biased_station).",
    remedies: &[
        check("Check the clock and the coupling of the station."),
        check("After the mission, scan the floor in doubt again: <rescan> on the screen Result."),
        SHOW,
        HOLD,
    ],
};

pub(super) const NOT_SEPARABLE: Guide = Guide {
    cause: "At the places of the last fixes, a station with a bias looks like a wrong speed of sound, or like another \
    station with a bias: too few stations are heard, or the robot moved too little.",
    holds: "",
    effect: "A station with a bias is not excluded meanwhile. Once it is found, floor scanned since then loses its guarantee.",
    remedies: &[
        wait("Wait until the robot has moved on: a hold would keep the stations from being told apart."),
        check("Check the stations that the log names, if it names any."),
    ],
};

pub(super) const PULSES: Guide = Guide {
    cause: "The log says which: the pulses do not fit the surveyed places of the stations (a station, its sensor or its \
    channel is faulty), the clock of a station has changed, or too few pulses came.",
    holds: "",
    effect: "If the pulses contradict the survey or a clock has changed, position errors, protection levels and guaranteed \
    floor do not count, from the last test that agreed until one agrees again. If none came, this time is unchecked.",
    remedies: &[
        check("Check the place and the sensor of the station that the log names."),
        check("Exclude this station: `:exclude` and its name."),
        HOLD,
    ],
};

pub(super) const NO_FIX: Guide = Guide {
    cause: "No position can be computed from the ranges of this cycle: too few stations were heard, or they \
    are all on one line.",
    holds: "",
    effect: "The position is dead-reckoned; its error grows until the next fix.",
    remedies: &[wait("Wait for the next ranging cycle."), HOLD],
};

pub(super) const STATION: Guide = Guide {
    cause: "The station's range disagrees with the others by more than its gate, or the station was not \
    heard: echo, blocked sound path, or wrong station data.",
    holds: "",
    effect: LESS_ACCURATE,
    remedies: &[wait("Wait: the station is used again as soon as its range agrees."), SHOW, HOLD],
};

/// The meaning of the alarm about a station that the last fix did not use for this reason.
pub(super) const fn excluded(why: &Exclusion) -> Guide {
    match why {
        Exclusion::ByOrder => BY_ORDER,
        Exclusion::Silent => SILENT,
        Exclusion::Impossible { .. } => IMPOSSIBLE,
        Exclusion::Biased { .. } => LEFT_OUT,
        Exclusion::Residual { .. } => DISAGREES,
    }
}

/// Every guide of a station that a fix does not use, for tests.
#[cfg(test)]
pub(super) const EXCLUDED: [Guide; 5] = [BY_ORDER, SILENT, IMPOSSIBLE, LEFT_OUT, DISAGREES];

const LESS_ACCURATE: &str = "The position is computed without this station and is less accurate.";

const BY_ORDER: Guide = Guide {
    cause: "An operator excluded the station.",
    holds: "",
    effect: LESS_ACCURATE,
    remedies: &[
        check("The station stays excluded until you include it: `:include` and its name."),
        SHOW,
        HOLD,
    ],
};

const SILENT: Guide = Guide {
    cause: "The station was not heard: its sound path is blocked, or it has no power or no connection.",
    holds: "",
    effect: LESS_ACCURATE,
    remedies: &[
        wait("Wait: the station is used again as soon as it is heard."),
        check("If it stays silent, check its power, its cable and its coupling."),
        SHOW,
        HOLD,
    ],
};

const IMPOSSIBLE: Guide = Guide {
    cause: "The station reports a range that is not possible in this tank: echo, or wrong station data.",
    holds: "",
    effect: LESS_ACCURATE,
    remedies: &[wait("Wait: the station is used again as soon as its range is possible."), SHOW, HOLD],
};

const LEFT_OUT: Guide = Guide {
    cause: "All ranges of the station are wrong by the same length.",
    holds: "",
    effect: LESS_ACCURATE,
    remedies: &[
        check("Check the clock, the survey data and the coupling of the station."),
        wait("Wait: the station is used again as soon as its ranges are right."),
        SHOW,
        HOLD,
    ],
};

const DISAGREES: Guide = Guide {
    cause: "The station's range disagrees with the others by more than its gate: echo, blocked sound path, or wrong \
    station data.",
    holds: "",
    effect: LESS_ACCURATE,
    remedies: &[wait("Wait: the station is used again as soon as its range agrees."), SHOW, HOLD],
};
