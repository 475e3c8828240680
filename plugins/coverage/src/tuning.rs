//! The parameters that shape plans, grouped by step, with their sources. Rounding tolerances are defined where they are
//! used.
//!
//! *Method* is the specification that the planners implement (Pan 2025 and the slit domain). Its values were measured
//! on round tanks of radius 10 m with 14 and 28 columns and on a square of 18 m with 18 columns.
//! `console/docs/tuning.md` gives the reasons for the more important choices. Values without a source were set by hand
//! on the same tanks.

/// Placement of cuts.
pub(crate) mod cuts {
    /// Distance of a cut from other obstacles, in addition to the distance that the hull keeps, metres (method).
    pub(crate) const BERTH_M: f64 = 0.05;
    /// Number of rays tried on either side of the ray from the anchor.
    pub(crate) const RAYS: usize = 18;
    /// Cost of a metre of cut and of a metre of excess cable, in broken lanes; every broken lane costs a turn.
    pub(crate) const COST_PER_M: f64 = 0.08;
    pub(crate) const EXCESS_COST_PER_M: f64 = 1e3;
    /// Maximum number of times that cuts are recomputed while they seal off more than a sliver of floor, and the size
    /// of a sliver, square metres.
    pub(crate) const TRIES: usize = 12;
    pub(crate) const SLIVER_M2: f64 = 0.02;
    /// Shares of the cable's slack by which a cut may lengthen the path to its far end: for patterns in which cuts run
    /// across the lanes, and for patterns in which cuts may run along the lanes. The shares are tried in this order
    /// until the cable stays within its limits. They may exceed 1 because the cable is rarely as long as a single cut
    /// suggests.
    pub(crate) const SLACKS_ACROSS: [f64; 4] = [1.0, 0.7, 0.4, 0.2];
    pub(crate) const SLACKS_ALONG: [f64; 7] = [3.0, 2.2, 1.7, 1.3, 1.0, 0.8, 0.5];
    /// Allowance for the hull, which passes columns farther out than the cable does, metres; the same for every size of
    /// tank.
    pub(crate) const AROUND_M: f64 = 0.25;
}

/// Placement of lanes; distances are shares of the swath.
pub(crate) mod lanes {
    /// Distance from a cut to contours, which end there, and to straight lanes, which may run alongside.
    pub(crate) const CONTOUR_TO_CUT: f64 = 0.33;
    pub(crate) const STRAIGHT_TO_CUT: f64 = 0.08;
    /// Distance from a corridor to its own cut (method), to other cuts, to other corridors and to lanes.
    pub(crate) const CORRIDOR: f64 = 0.5;
    pub(crate) const CORRIDOR_TO_CUT: f64 = 0.45;
    pub(crate) const CORRIDOR_TO_CORRIDOR: f64 = 0.25;
    pub(crate) const CORRIDOR_TO_LANE: f64 = 0.5;
    /// Overlap of straight lanes with the innermost lap along the wall.
    pub(crate) const INTO_LAP: f64 = 0.5;
    /// Spacing of straight lanes in a round tank: slightly less than the swath, so that no row of cells is missed.
    pub(crate) const SPACING: f64 = 0.997;
    /// Lanes shorter than the swath divided by this are dropped: the first value applies if touch-ups follow, the
    /// second if not.
    pub(crate) const LEAST_IN_SWATH: f64 = 3.0;
    pub(crate) const LEAST_TO_AND_FRO_IN_SWATH: f64 = 12.0;
    /// The traditional and the published planner leave slivers, up to 12 % of the floor in tanks with many columns.
    /// Plans that scan less than this share of the floor are not complete.
    pub(crate) const COMPLETE_WITH_SLIVERS: f64 = 0.85;
    /// Sine of the smallest angle at which a cut is considered to cross straight lanes and needs a corridor.
    pub(crate) const ACROSS: f64 = 0.6;
}

/// The search for the order of lanes.
pub(crate) mod tour {
    /// Number of nearest ends for which connectors are computed, and how many of them form a neighbour list.
    pub(crate) const LOOKED_AT: usize = 18;
    pub(crate) const NEIGHBOURS: usize = 8;
    /// Longest run of lanes moved as one (method), and maximum number of lanes affected by a kick.
    pub(crate) const RUN: usize = 3;
    pub(crate) const KICK_REACH: usize = 30;
    /// Share of the search spent on a first tour.
    pub(crate) const DRAFT_SHARE: f64 = 0.3;
}

/// Prices and limits of polishing. Floor is priced in multiples of the length of path needed to sweep it.
pub(crate) mod polish {
    /// Value of floor for shortcuts. Bends then scan the floor that shortcuts lose more cheaply: together, the two
    /// shorten paths by 2 to 3 % (tuning.md).
    pub(crate) const FLOOR: f64 = 11.0;
    /// Maximum price of floor gained by a bend, turns included.
    pub(crate) const BENT_FLOOR: f64 = 28.0;
    /// Multiples of that price, tried one after another if more than `LEFT` of the required floor is still missing at
    /// the end (tuning.md).
    pub(crate) const DEARER: [f64; 3] = [2.0, 4.0, 8.0];
    pub(crate) const LEFT: f64 = 0.0008;
    /// Value of floor once the path has been bent to it, metres of path per square metre: none of it may be lost again.
    pub(crate) const CAREFUL_M_PER_M2: f64 = 1e6;
    /// Cell size in the first round, as a multiple of the cell size in the second: finer cells do not help to choose
    /// between candidates.
    pub(crate) const ROUGH: f64 = 1.6;
    /// Prices at which floor beyond the required coverage is given up, as multiples of the usual price; expensive floor
    /// first.
    pub(crate) const PRICES: [f64; 3] = [3.0, 1.0, 0.4];
    /// Share of the scanned floor that must remain after shortcuts if only part of the floor is requested.
    pub(crate) const KEPT: f64 = 0.9;
    /// Number of bend rounds, tie rounds and early tie rounds, and the coverage that late tie rounds may miss.
    pub(crate) const BENDS: usize = 5;
    /// Bend rounds for a path that has changed in places: the mission is waiting, and ties gain as much in a tenth of
    /// the time.
    pub(crate) const BENDS_AGAIN: usize = 1;
    pub(crate) const TIES: usize = 8;
    pub(crate) const EARLY_TIES: usize = 3;
    pub(crate) const LATE_SHARE: f64 = 0.0001;
    /// Minimum number of missed cells that are worth a bend, a tie in an early round, and a tie later.
    pub(crate) const BENT_CELLS: usize = 3;
    pub(crate) const TIED_CELLS: usize = 8;
    pub(crate) const LATE_CELLS: usize = 4;
}

/// Shortcuts of a path.
pub(crate) mod shortcuts {
    /// Minimum saving, metres.
    pub(crate) const LEAST_SAVING_M: f64 = 0.04;
    /// Longest stretch that a shortcut may replace, metres: anywhere, and where the path turns by more than the given
    /// angle, radians.
    pub(crate) const SHORT_M: f64 = 2.7;
    pub(crate) const LONG_M: f64 = 9.0;
    pub(crate) const MUCH_TURN_RAD: f64 = 3.0;
    /// Value of a metre of path along the shell, metres: the critical zone must be scanned.
    pub(crate) const SHELL: f64 = 2.0;
    /// Number of sides beyond which not every end of a shortcut is tried.
    pub(crate) const FINE: usize = 8;
    /// Sample positions across a side for a quick check, as shares of half the bar. The check rules out a shortcut only
    /// if the apparent loss is this many times the allowed loss.
    pub(crate) const SAMPLES: [f64; 4] = [-0.75, -0.25, 0.25, 0.75];
    pub(crate) const QUICK_MARGIN: f64 = 1.3;
}

/// Bends of a path to missed floor.
pub(crate) mod bends {
    /// Path points within this distance of missed floor are tried, metres, and at most this many of them.
    pub(crate) const NEAR_M: f64 = 0.75;
    pub(crate) const PLACES: usize = 5;
    /// Numbers of sides that a bend may replace, both before its point and after it.
    pub(crate) const BASES: [usize; 3] = [1, 2, 4];
    /// Largest gain of floor considered for a bend, as a multiple of the missed floor for which it is made.
    pub(crate) const AND_BESIDE: f64 = 2.0;
    /// Offsets of a bend, as shares of the swath.
    pub(crate) const ASIDE: [f64; 4] = [0.1, 0.2, 0.35, 0.55];
}

/// Short lanes over missed floor.
pub(crate) mod touch_ups {
    /// Smallest missed area that gets a lane before the tour, as a multiple of the squared swath; bends and ties reach
    /// smaller areas more cheaply. Without bends and ties, 0.012 m2 instead of 0.06 m2 made paths 2 to 10 % longer
    /// (method).
    pub(crate) const LEAST: f64 = 0.55;
    /// Expected length of touch-ups over missed floor, as a multiple of its area divided by the swath.
    pub(crate) const MISSED: f64 = 2.5;
    /// Distance of touch-ups from cuts, and their minimum length, metres.
    pub(crate) const CUT_M: f64 = 0.03;
    pub(crate) const LEAST_LANE_M: f64 = 0.06;
    /// Sides of a finished path within this distance are tried for a tie, metres, and at most this many of them.
    pub(crate) const TIE_M: f64 = 2.0;
    pub(crate) const SIDES: usize = 10;
    /// Maximum cost of a tie in addition to the length of its lane, metres, and minimum floor that it must gain, square
    /// metres.
    pub(crate) const MOST_EXTRA_M: f64 = 8.0;
    pub(crate) const LEAST_GAIN_M2: f64 = 0.01;
}

/// The pass along the shell.
pub(crate) mod shell {
    /// Width of the zone examined, metres, and the unscanned width that is tolerated, metres: lanes keep a little
    /// slack, and no robot drives to the millimetre.
    pub(crate) const ZONE_M: f64 = 0.075;
    pub(crate) const NEAR_M: f64 = 0.0101;
    /// A path that exceeds its minimum distance from the shell by less than this is moved to that distance, metres.
    pub(crate) const PRESSED_M: f64 = 0.03;
    /// Floor that this move may lose, in square metres per metre of path.
    pub(crate) const MOST_LOST_M: f64 = 0.02;
    /// Step along the shell, and the shortest lane that is worth its turns, metres.
    pub(crate) const STEP_M: f64 = 0.15;
    pub(crate) const LEAST_M: f64 = 0.1;
}

/// The choice among candidates.
pub(crate) mod choice {
    /// Shares of the largest cut angle, tried until a candidate meets the preferences for the cable. The first is
    /// sufficient in about half of all tanks (tuning.md).
    pub(crate) const ANGLES: [f64; 3] = [1.0, 0.5, 0.0];
    /// Number of directions of straight lanes examined in a round tank before any lanes are laid, and number of offsets
    /// for each direction.
    pub(crate) const LOOKED_AT: usize = 24;
    pub(crate) const PLACES: usize = 6;
    /// Cost of a lane broken by an obstacle, and of a metre of sliver along the wall, in lanes broken by a cut. An
    /// obstacle costs less because the way around it is short.
    pub(crate) const BY_OBSTACLE: f64 = 0.5;
    pub(crate) const SLIVER_PER_M: f64 = 0.5;
    /// If the angle between a lane and the side of an obstacle in its way exceeds this, radians, the lane is broken
    /// rather than bent around the obstacle. Going around takes four such turns; turning back takes half a turn.
    pub(crate) const BENT_RAD: f64 = std::f64::consts::FRAC_PI_4;
    /// Total length of lanes that get a first tour, metres; it determines the number of candidates, with a minimum of
    /// two. More candidates take longer, and an additional one gains least in large tanks.
    pub(crate) const TOURED_M: f64 = 14_000.0;
    pub(crate) const LEAST_TOURED: usize = 2;
    /// Number of directions between straight walls: along the longest wall, and across it. There, cuts are tried up to
    /// several angles, given as multiples of the largest cut angle, with an upper limit in radians: different cuts
    /// break different lanes (tuning.md).
    pub(crate) const BETWEEN_WALLS: usize = 2;
    pub(crate) const ANGLES_BETWEEN_WALLS: [f64; 4] = [1.0, 1.2, 1.4, 1.6];
    pub(crate) const MOST_ANGLE_RAD: f64 = 80.0 * std::f64::consts::PI / 180.0;
    /// A tank with more obstacles than this is crowded: only the best direction is tried, with straight cuts. Oblique
    /// cuts did not meet the preferences for the tether there, so planning with them would waste time (tuning.md).
    pub(crate) const CROWDED: usize = 800;
    /// Maximum number of candidates polished in coarse cells, and of those finished in fine cells: first tours rank
    /// almost like finished paths (tuning.md).
    pub(crate) const MOST_ROUGHED: usize = 2;
    pub(crate) const MOST_FINISHED: usize = 2;
    /// Factors by which the tether of a first tour may exceed the preferred length and wraps: polishing changes them by
    /// less.
    pub(crate) const DRAFT_CABLE: f64 = 1.015;
    pub(crate) const DRAFT_WRAP: f64 = 1.1;
    /// First tours that cost more than the best by at least this share never lead to the chosen candidate.
    pub(crate) const HOPELESS: f64 = 0.02;
    /// The same after polishing in coarse cells.
    pub(crate) const CLOSE: f64 = 0.01;
    /// Within this many swaths of home, no cable lies across a cut.
    pub(crate) const FAR: f64 = 4.0;
    /// Without a limit on the reel, a plan is complete with the share `COMPLETE` of the reachable floor, even if more
    /// is requested. With such a limit, the coverage may fall short of the request by `BY_REEL`.
    pub(crate) const COMPLETE: f64 = 0.99;
    pub(crate) const BY_REEL: f64 = 0.001;
    /// Maximum number of cells of a floor. More cells cost memory and time, and in a large tank the edges, where cell
    /// size matters, are a smaller share of the floor (tuning.md).
    pub(crate) const MOST_CELLS: f64 = 4e6;
}

/// Floors between inner walls.
pub(crate) mod rooms {
    /// Maximum total lane length, and maximum number of convex obstacles, that can be planned well within a minute on
    /// one core: 5,000 m took 16 s.
    pub(crate) const MOST_LANES_M: f64 = 8_000.0;
    pub(crate) const MOST_PARTS: usize = 3_000;
    /// A plan between inner walls is complete with this share of the reachable floor. Coverage is counted with the lane
    /// width, which is the tool width less the overlap. The tool also scans corners beyond that width: maps with 98.3
    /// to 98.9 % by lane width have 99.8 to 99.9 % by tool width (decisions.md).
    pub(crate) const COMPLETE: f64 = 0.98;
    /// With more convex obstacles than this, a floor with straight walls is treated as divided by inner walls.
    pub(crate) const FEW_PARTS: usize = 200;
}

/// Repair of the current plan.
pub(crate) mod repair {
    use std::f64::consts::FRAC_PI_2;

    /// Number of rays tried on either side of the ray from the anchor for the cut of a new obstacle.
    pub(crate) const RAYS: i32 = 16;
    /// Cost of a metre of such a cut, in broken lanes.
    pub(crate) const COST_PER_M: f64 = 0.1;
    /// Largest angles between these cuts and the ray from the anchor, tried one after another: an oblique cut breaks
    /// fewer lanes, a straight cut bends the tether less.
    pub(crate) const ANGLES_RAD: [f64; 3] = [FRAC_PI_2, 0.8, 0.2];
    /// Factors by which a certified repair may exceed the preferred tether length and wraps.
    pub(crate) const LONGER_CABLE: f64 = 1.1;
    pub(crate) const MORE_WRAP: f64 = 1.5;
    /// Lanes within this many swaths of the change are reordered.
    pub(crate) const NEAR: f64 = 5.0;
    /// Number of changes tried for each of these lanes.
    pub(crate) const KICKS: f64 = 30.0;
    /// Lanes that can no longer be driven are divided into pieces of this length, metres.
    pub(crate) const BIT_M: f64 = 0.1;
    /// If the robot is blocked, a new path must be at least `AS_BEFORE_M` away from the old one somewhere in the first
    /// `AHEAD_M` of the old one (both in metres); a mere bend deviates by less.
    pub(crate) const AHEAD_M: f64 = 1.0;
    pub(crate) const AS_BEFORE_M: f64 = 0.35;
    /// Share of all floor that a repaired path may miss in addition to what the previous plan could miss.
    pub(crate) const MORE_LEFT: f64 = 0.0005;
    /// If a repaired path is longer than the rest of the old one by this share plus this many metres, a new plan is
    /// tried.
    pub(crate) const LONGER: f64 = 0.06;
    pub(crate) const LONGER_M: f64 = 12.0;
}

/// The published partition and its genetic algorithm (Pan 2025; values not given in the paper are from the method).
pub(crate) mod hull_partition {
    /// Number of sides of the polygon that approximates a round wall.
    pub(crate) const WALL_SIDES: usize = 96;
    /// Minimum width of a gate, metres.
    pub(crate) const LEAST_GATE_M: f64 = 0.1;
    /// Cells smaller than a square of `SMALL_SWATHS` swaths are merged if the result fills at least the share
    /// `CONVEX_ENOUGH` of its convex hull, and no column's centre lies more than `DEEP_M` metres inside that hull.
    pub(crate) const SMALL_SWATHS: f64 = 4.0;
    pub(crate) const CONVEX_ENOUGH: f64 = 0.95;
    pub(crate) const DEEP_M: f64 = 0.05;
    /// Cuts extend this far beyond the corners of cells, and outermost lanes stay this far inside cells, metres.
    pub(crate) const SEAM_M: f64 = 0.02;
    pub(crate) const INSIDE_M: f64 = 3e-3;
    /// Maximum number of convex obstacles on a floor between inner walls: with more, walls would be mistaken for
    /// columns.
    pub(crate) const MOST_COLUMNS: usize = 40;
    /// Sealed area that justifies another gate or a warning, square metres.
    pub(crate) const SEALED_M2: f64 = 0.05;
    /// The genetic algorithm.
    pub(crate) const POPULATION: usize = 120;
    pub(crate) const TOURNAMENT: usize = 3;
    pub(crate) const MUTATION: f64 = 0.2;
    pub(crate) const ELITE: usize = 2;
    pub(crate) const GENERATIONS: usize = 400;
    pub(crate) const PATIENCE: usize = 80;
    /// Maximum number of cells that are ordered exactly: time and memory double with every cell.
    pub(crate) const MOST_EXACT: usize = 13;
}
