//! Cuts: lines from every obstacle outward, so that wall, obstacles and cuts hang together and the rest of the floor
//! is simply connected.
//!
//! A robot that never crosses a cut can take its tether back from anywhere by the way it came or by any other: they
//! are the same to the tether. The cuts form a forest that is rooted at the wall.

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

/// The domain between the cuts of a workspace; `None` where there is no room at home.
///
/// Where cuts seal floor off, the last one made of those around the sealed region has to end somewhere else.
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

/// The domain of a floor between inner walls: every island is cut where the shortest ways from home on either side of it
/// meet, so no cable is much longer than it has to be. `None` where there is no room at home.
pub(crate) fn domain_between_walls(workspace: &Workspace) -> Option<SlitDomain<'_>> {
    let mut domain = SlitDomain::new(workspace, Vec::new())?;
    domain.close_up();
    Some(domain)
}

/// How many lanes the cuts of a workspace would break, about: what a pattern costs, before anything is laid.
pub(crate) fn broken_lanes(workspace: &Workspace, pattern: &Pattern, rule: &CutRule) -> f64 {
    let broken = |side: &[Point]| pattern.broken_lanes(&workspace.wall, side[0], side[1], workspace.swath_m);
    let cuts = cuts(workspace, pattern, rule, &[]);
    cuts.iter().flat_map(|cut| cut.windows(2)).map(broken).sum()
}

/// The last cut made of those that keep the robot out of sealed floor.
fn last_at_rim<'a>(cuts: &'a [Vec<Point>], sealed: &SealedRegion) -> Option<&'a [Point]> {
    let is_at_rim = |cut: &&[Point]| sealed.rim.iter().any(|p| polyline::distance_m(cut, *p) < SNAPPED_M);
    cuts.iter().map(Vec::as_slice).rev().find(is_at_rim)
}
