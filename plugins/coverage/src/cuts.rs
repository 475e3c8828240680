//! Cuts: lines that lead outward from every obstacle and connect all obstacles to the wall, so that the rest of the
//! floor is simply connected.
//!
//! A robot that never crosses a cut can return from anywhere by any path without winding its tether around anything:
//! for the tether, all paths are equivalent. The cuts form a forest rooted at the wall.

mod cluster;
mod extension;
mod forest;
#[cfg(test)]
mod tests;

use crate::pattern::Pattern;
use crate::slit_domain::SlitDomain;
use crate::triangulation::{SNAPPED_M, SealedRegion};
use crate::tuning::cuts::{SLIVER_M2, TRIES};
use crate::workspace::Workspace;
pub(crate) use extension::{Extension, cuts_up_to_found};
pub(crate) use forest::CutRule;
use forest::{Ban, cuts};
use world::{Point, polyline};

/// The domain between the cuts of a workspace; `None` if the hull does not fit at home.
///
/// If cuts seal off floor, the last cut made around the sealed region is banned, and the cuts are made again; the best
/// attempt is kept.
pub(crate) fn domain<'a>(
    workspace: &'a Workspace,
    pattern: &Pattern,
    rule: &CutRule,
) -> Option<SlitDomain<'a>> {
    let mut bans: Vec<Ban> = Vec::new();
    let mut best: Option<SlitDomain<'_>> = None;
    for _ in 0..TRIES {
        let domain = SlitDomain::new(workspace, cuts(workspace, pattern, rule, &bans))?;
        let ban = last_at_rim(&domain.cuts, &domain.sealed).map(Ban::of);
        if best.as_ref().is_none_or(|best| domain.sealed.area_m2 < best.sealed.area_m2) {
            best = Some(domain);
        }
        let is_sealed = best.as_ref().is_some_and(|best| best.sealed.area_m2 > SLIVER_M2);
        let Some(ban) = ban.filter(|_| is_sealed) else { break };
        bans.push(ban);
    }
    let mut domain = best?;
    domain.close_up();
    Some(domain)
}

/// The domain of a floor between inner walls. Every island gets a cut where the shortest paths from home around its two
/// sides meet, so the cable is never much longer than necessary. `None` if the hull does not fit at home.
pub(crate) fn domain_between_walls(workspace: &Workspace) -> Option<SlitDomain<'_>> {
    let mut domain = SlitDomain::new(workspace, Vec::new())?;
    domain.close_up();
    Some(domain)
}

/// Estimates how many lanes the cuts in a workspace would break: the cost of a pattern before any lanes are laid.
pub(crate) fn broken_lanes(workspace: &Workspace, pattern: &Pattern, rule: &CutRule) -> f64 {
    let broken = |side: &[Point]| pattern.broken_lanes(&workspace.wall, side[0], side[1], workspace.swath_m);
    let cuts = cuts(workspace, pattern, rule, &[]);
    cuts.iter().flat_map(|cut| cut.windows(2)).map(broken).sum()
}

/// The most recent of the cuts that keep the robot out of sealed floor.
fn last_at_rim<'a>(cuts: &'a [Vec<Point>], sealed: &SealedRegion) -> Option<&'a [Point]> {
    let is_at_rim = |cut: &&[Point]| sealed.rim.iter().any(|p| polyline::distance_m(cut, *p) < SNAPPED_M);
    cuts.iter().map(Vec::as_slice).rev().find(is_at_rim)
}
