//! Making a path shorter and straighter without losing floor: what other parts of the path sweep as well need not be
//! swept here, and what was missed is worth a detour only if it is large enough.

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

/// How far a round of polish is when the path is shortened and when it is bent, as shares of its time, about.
const SHORTENED: f64 = 0.63;
const BENT: f64 = 0.92;

/// Shortens a path, bends it to floor that it misses, and ties in short lanes where that is not enough. A second round pays:
/// what was bent and tied in sweeps floor on its way that other parts need not sweep any more. `time` is the share of the
/// candidate's time that the round takes.
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
        // A little floor far away is not worth its way, but nothing else was asked for.
        *track = whole;
        track.shorten(&careful)?;
    }
    bend(track, terms, &careful, tuning::BENDS, &at)?;
    track.pass_along_shell(terms)?;
    tie(track, terms, &careful, &at)?;
    track.pass_along_shell(terms)
}

/// Brings the coverage, counted in other cells than the path was fitted to, to what is enough: by bends and ties, or by shortcuts as long as
/// it is more than that.
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

/// Where much is still missing, as in slivers around many columns that stand close together, the path is bent to dearer and dearer
/// floor.
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

/// The same for a path that was polished before and has changed in places: what it does along the shell stays, and what was
/// scanned there already is not scanned again.
pub(crate) fn polish_again(track: &mut Track<'_>, terms: &Terms<'_>) -> Result<()> {
    let careful = Terms { floor_m_per_m2: tuning::CAREFUL_M_PER_M2, ..*terms };
    let at = |share: f64| share;
    terms.job.stage(SHORTENED);
    track.shorten(terms)?;
    bend(track, terms, &careful, tuning::BENDS_AGAIN, &at)?;
    tie(track, terms, &careful, &at)
}

/// Bends the path, and shortens what is new, until nothing pays any more.
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

/// Ties in short lanes, and shortens what is new, until the coverage is reached. Late rounds are content with a little less,
/// but take smaller places; when nothing large is left they come at once.
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
