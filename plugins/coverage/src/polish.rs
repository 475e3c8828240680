//! Makes a path shorter and straighter without losing floor. A part of the path need not sweep floor that other parts
//! also sweep, and missed floor is worth a detour only if its area is large enough.

mod bends;
pub(crate) mod shell;
mod shortcuts;
mod ties;
mod track;

use crate::floor::ReachableFloor;
use crate::tuning::polish as tuning;
use planner_api::Result;
use std::collections::BTreeSet;
use std::ops::Range;
pub(crate) use track::{Terms, Track};

/// Approximate progress of a round once the path has been shortened, as a share of the round's time.
const SHORTENED: f64 = 0.63;
/// Approximate progress of a round once the path has also been bent, as a share of the round's time.
const BENT: f64 = 0.92;

/// Shortens a path, bends it to floor that it misses, and ties in short lanes if that is not enough. A second round is
/// worthwhile: on their way, new bends and lanes sweep floor that other parts then need not sweep. `time` is the share
/// of the candidate's time that the round takes.
pub(crate) fn polish(
    track: &mut Track<'_>,
    terms: &Terms<'_>,
    is_all_floor: bool,
    time: Range<f64>,
) -> Result<()> {
    let careful = Terms { floor_m_per_m2: tuning::CAREFUL_M_PER_M2, ..*terms };
    let at = |share: f64| time.start + (time.end - time.start) * share;
    let whole = (!is_all_floor).then(|| track.clone());
    terms.job.stage(at(SHORTENED));
    track.reopen();
    track.shorten(terms)?;
    if let Some(whole) = whole.filter(|whole| track.coverage() < tuning::KEPT * whole.coverage()) {
        // A small area far away is not worth the trip, but here it is all that was requested.
        *track = whole;
        track.shorten(&careful)?;
    }
    bend(track, terms, &careful, tuning::BENDS, &at)?;
    track.pass_along_shell(terms)?;
    tie(track, terms, &careful, &at)?;
    track.pass_along_shell(terms)
}

/// Brings the coverage to the required value. It is counted in different cells from those to which the path was fitted.
/// Bends and ties raise it; shortcuts lower it while it is too high.
pub(crate) fn settle(track: &mut Track<'_>, terms: &Terms<'_>, other: &ReachableFloor) -> Result<()> {
    let enough = track.enough_here(terms.enough, other);
    let terms = Terms { enough, keep: enough, ..*terms };
    let careful = Terms { floor_m_per_m2: tuning::CAREFUL_M_PER_M2, ..terms };
    bend(track, &terms, &careful, tuning::BENDS, &|_| 1.0)?;
    tie(track, &terms, &careful, &|_| 1.0)?;
    scan_dear_floor(track, &terms, &careful)?;
    for price in tuning::PRICES {
        if track.coverage() > enough {
            track.reopen();
            track.shorten(&Terms { floor_m_per_m2: terms.floor_m_per_m2 * price, ..terms })?;
        }
    }
    track.pass_along_shell(&terms)
}

/// If much floor is still missing, for example in slivers around many columns close together, accepts higher and higher
/// prices for bending the path to it.
fn scan_dear_floor(track: &mut Track<'_>, terms: &Terms<'_>, careful: &Terms<'_>) -> Result<()> {
    let enough = terms.enough - tuning::LEFT;
    for times in tuning::DEARER {
        if track.coverage() >= enough {
            break;
        }
        let terms = Terms { enough, bend_m_per_m2: terms.bend_m_per_m2 * times, ..*terms };
        bend(track, &terms, careful, tuning::BENDS, &|_| 1.0)?;
        tie(track, &terms, careful, &|_| 1.0)?;
    }
    Ok(())
}

/// Polishes a path that was polished before and has changed in places. It gets no new pass along the shell, which would
/// scan floor there a second time.
pub(crate) fn polish_again(track: &mut Track<'_>, terms: &Terms<'_>) -> Result<()> {
    let careful = Terms { floor_m_per_m2: tuning::CAREFUL_M_PER_M2, ..*terms };
    let at = |share: f64| share;
    terms.job.stage(SHORTENED);
    track.shorten(terms)?;
    bend(track, terms, &careful, tuning::BENDS_AGAIN, &at)?;
    tie(track, terms, &careful, &at)
}

/// Bends the path and shortens the new parts, round by round, until no bend is worthwhile.
fn bend(
    track: &mut Track<'_>,
    terms: &Terms<'_>,
    careful: &Terms<'_>,
    rounds: usize,
    at: &dyn Fn(f64) -> f64,
) -> Result<()> {
    let (mut share, mut vain) = (SHORTENED, BTreeSet::new());
    let mut next_stage = || {
        share += (BENT - share) * 0.35;
        terms.job.stage(at(share));
    };
    for _ in 0..rounds {
        next_stage();
        if track.bend(terms, &mut vain)? == 0 {
            break;
        }
        next_stage();
        track.shorten(careful)?;
    }
    Ok(())
}

/// Ties in short lanes and shortens the new parts, until the required coverage is reached. Late rounds accept slightly
/// less coverage but fill smaller gaps. If no large gap is left, the late rounds start immediately.
fn tie(track: &mut Track<'_>, terms: &Terms<'_>, careful: &Terms<'_>, at: &dyn Fn(f64) -> f64) -> Result<()> {
    let late = Terms { enough: terms.enough - tuning::LATE_SHARE, ..*terms };
    let (mut share, mut is_late) = (BENT, false);
    for round in 0..tuning::TIES {
        is_late |= round >= tuning::EARLY_TIES;
        share += (1.0 - share) / 2.0;
        terms.job.stage(at(share));
        let (terms, least) = if is_late { (&late, tuning::LATE_CELLS) } else { (terms, tuning::TIED_CELLS) };
        if track.tie_in_lanes(terms, least)? > 0 {
            track.shorten(careful)?;
        } else if std::mem::replace(&mut is_late, true) {
            break;
        }
    }
    Ok(())
}
