//! Reads the true loss of metal of a simulated floor: `[wear]`.

use super::{problem::Complaint, section::Section};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use world::{Boundary, FloorWear, LossProfile, MetalLoss, PlateSide, Point};

/// The largest number of losses that are listed one by one.
const MOST_LOSSES: usize = 10_000;
/// The number of positions tried for each random loss.
const TRIES_PER_LOSS: usize = 200;

/// Reads `[wear]`, if there is one; random losses depend on `seed` unless they have their own.
pub(crate) fn wear(root: &Section<'_>, boundary: Option<&Boundary>, seed: Option<u64>) -> Option<FloorWear> {
    if !root.has("wear") {
        return None;
    }
    let section = root.table("wear")?;
    let thickness_mm = section.number("thickness_mm");
    let listed = section.tables("losses");
    if listed.len() > MOST_LOSSES {
        section.complain("losses", Complaint::TooMany { have: listed.len(), most: MOST_LOSSES });
    }
    let thickness_mm = thickness_mm?;
    let read = |section: &Section<'_>| loss(section, boundary, thickness_mm);
    let mut losses: Vec<MetalLoss> = listed.iter().take(MOST_LOSSES).filter_map(read).collect();
    if section.has("random") {
        losses.extend(random(&section.table("random")?, boundary, thickness_mm, seed)?);
    }
    Some(FloorWear { thickness_mm, losses })
}

/// Reads one loss; its middle must be on the floor.
fn loss(section: &Section<'_>, boundary: Option<&Boundary>, thickness_mm: f64) -> Option<MetalLoss> {
    let (at, radius_m) = (section.point("at_m"), section.number("radius_m"));
    let (profile, side) = (section.word("profile"), side(section));
    let depth_mm = section.number("depth_mm");
    if let (Some(at), Some(boundary)) = (at, boundary)
        && !boundary.contains(at)
    {
        section.complain("at_m", Complaint::OutsideTank { by_m: -boundary.wall_distance_m(at) });
    }
    check_depth(section, depth_mm?, thickness_mm);
    let profile = if profile? == "pit" { LossProfile::Pit } else { LossProfile::Thinning };
    Some(MetalLoss { at: at?, radius_m: radius_m?, depth_mm: depth_mm?, profile, side: side? })
}

fn side(section: &Section<'_>) -> Option<PlateSide> {
    Some(if section.word("side")? == "top" { PlateSide::Top } else { PlateSide::Underside })
}

/// Complains about a loss that is deeper than the floor is thick.
fn check_depth(section: &Section<'_>, depth_mm: f64, thickness_mm: f64) {
    if depth_mm > thickness_mm {
        let wanted = format!("at most {thickness_mm} mm, the thickness in [wear]");
        section.complain("depth_mm", Complaint::OutOfRange(wanted));
    }
}

/// Pits at random places; the same seed gives the same pits.
fn random(
    section: &Section<'_>,
    boundary: Option<&Boundary>,
    thickness_mm: f64,
    scenario_seed: Option<u64>,
) -> Option<Vec<MetalLoss>> {
    let (count, side) = (section.whole("count"), side(section));
    let (radius_m, depth_mm) = (section.pair("radius_m")?, section.pair("depth_mm")?);
    for (key, [least, most]) in [("radius_m", radius_m), ("depth_mm", depth_mm)] {
        if least > most {
            section.complain(key, Complaint::OutOfRange("[smallest, largest]".into()));
        }
    }
    check_depth(section, depth_mm[1], thickness_mm);
    let own_seed = section.whole("seed").map(|seed| seed as u64);
    let seed = if section.has("seed") { own_seed } else { scenario_seed };
    let (boundary, side, mut chance) = (boundary?, side?, Pcg64Mcg::seed_from_u64(seed?));
    let (low, high) = boundary.bounds();
    let mut between = |[from, to]: [f64; 2]| from + (to - from) * chance.random::<f64>();
    let mut pit = || {
        let at = Point::new(between([low.x, high.x]), between([low.y, high.y]));
        let (radius_m, depth_mm) = (between(radius_m), between(depth_mm));
        MetalLoss { at, radius_m, depth_mm, profile: LossProfile::Pit, side }
    };
    let on_floor = |pit: &MetalLoss| boundary.contains(pit.at);
    Some((0..count?).filter_map(|_| (0..TRIES_PER_LOSS).map(|_| pit()).find(on_floor)).collect())
}
