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
    /// Cost of a metre of cut, in broken lanes; every broken lane costs a turn.
    pub(crate) const COST_PER_M: f64 = 0.08;
    /// Cost of a metre of excess cable, in broken lanes.
    pub(crate) const EXCESS_COST_PER_M: f64 = 1e3;
    /// Maximum number of times that cuts are recomputed while they seal off more than a sliver of floor.
    pub(crate) const TRIES: usize = 12;
    /// Area of a sliver of floor, square metres.
    pub(crate) const SLIVER_M2: f64 = 0.02;
    /// Limits on the estimated tether length that a cut may cause, for contours, which cuts cross. A limit is a share
    /// of the cable's slack, which is the preferred maximum length less the minimum length; 0 is the minimum length.
    /// The limits are tried in this order until the cable stays within its own limits.
    pub(crate) const SLACKS_ACROSS: [f64; 4] = [1.0, 0.7, 0.4, 0.2];
    /// The same limits for straight lanes, beside which cuts may run. They may exceed 1, because the cable is rarely as
    /// long as a single cut suggests.
    pub(crate) const SLACKS_ALONG: [f64; 7] = [3.0, 2.2, 1.7, 1.3, 1.0, 0.8, 0.5];
    /// Allowance for the hull, which passes columns at a greater distance than the cable does, metres; the same for
    /// every size of tank.
    pub(crate) const AROUND_M: f64 = 0.25;
}

/// Placement of lanes; distances are shares of the swath.
pub(crate) mod lanes {
    /// Distance from a cut to contours, which end there.
    pub(crate) const CONTOUR_TO_CUT: f64 = 0.33;
    /// Distance from a cut to straight lanes, which may run alongside.
    pub(crate) const STRAIGHT_TO_CUT: f64 = 0.08;
    /// Distance from a corridor to its own cut (method).
    pub(crate) const CORRIDOR: f64 = 0.5;
    /// Distance from a corridor to other cuts.
    pub(crate) const CORRIDOR_TO_CUT: f64 = 0.45;
    /// Distance from a corridor to other corridors.
    pub(crate) const CORRIDOR_TO_CORRIDOR: f64 = 0.25;
    /// Distance from a corridor to lanes.
    pub(crate) const CORRIDOR_TO_LANE: f64 = 0.5;
    /// Overlap of straight lanes with the innermost lap along the wall.
    pub(crate) const INTO_LAP: f64 = 0.5;
    /// Spacing of straight lanes in a round tank: slightly less than the swath, so that no row of cells is missed.
    pub(crate) const SPACING: f64 = 0.997;
    /// The minimum length of a lane is the swath divided by this number, if touch-ups follow. Shorter lanes are
    /// dropped.
    pub(crate) const LEAST_IN_SWATH: f64 = 3.0;
    /// The same number if no touch-ups follow.
    pub(crate) const LEAST_TO_AND_FRO_IN_SWATH: f64 = 12.0;
    /// Minimum scanned share of the floor for a complete plan of the traditional and the published planner. They leave
    /// slivers, up to 12 % of the floor in tanks with many columns.
    pub(crate) const COMPLETE_WITH_SLIVERS: f64 = 0.85;
    /// Sine of the smallest angle at which a cut is considered to cross straight lanes and needs a corridor.
    pub(crate) const ACROSS: f64 = 0.6;
}

/// The search for the order of lanes.
pub(crate) mod tour {
    /// Number of nearest ends for which connectors are computed.
    pub(crate) const LOOKED_AT: usize = 18;
    /// Number of these ends that form a neighbour list: those with the cheapest connectors.
    pub(crate) const NEIGHBOURS: usize = 8;
    /// Maximum number of consecutive lanes that are moved together (method).
    pub(crate) const RUN: usize = 3;
    /// Maximum number of lanes affected by a kick.
    pub(crate) const KICK_REACH: usize = 30;
    /// Share of the search spent on a first tour.
    pub(crate) const DRAFT_SHARE: f64 = 0.3;
}

/// Prices and limits of polishing. Floor is priced in multiples of the length of path needed to sweep it.
pub(crate) mod polish {
    /// Value of floor for shortcuts. Bends can scan the floor lost by shortcuts more cheaply: together, shortcuts and
    /// bends shorten paths by 2 to 3 % (tuning.md).
    pub(crate) const FLOOR: f64 = 11.0;
    /// Maximum price of floor gained by a bend, turns included.
    pub(crate) const BENT_FLOOR: f64 = 28.0;
    /// Multiples of that price, tried one after another while more than `LEFT` of the required floor is still missing
    /// at the end (tuning.md).
    pub(crate) const DEARER: [f64; 3] = [2.0, 4.0, 8.0];
    /// Missing share of the required floor above which higher prices are tried.
    pub(crate) const LEFT: f64 = 0.0008;
    /// Value of floor once the path has been bent to it, metres of path per square metre: none of it may be lost again.
    pub(crate) const CAREFUL_M_PER_M2: f64 = 1e6;
    /// Cell size in the first round, as a multiple of the cell size in the second: finer cells do not improve the
    /// choice between candidates.
    pub(crate) const ROUGH: f64 = 1.6;
    /// Prices at which floor beyond the required coverage is given up, as multiples of the usual price; the most
    /// expensive floor first.
    pub(crate) const PRICES: [f64; 3] = [3.0, 1.0, 0.4];
    /// Share of the scanned floor that must remain after shortcuts if only part of the floor is requested.
    pub(crate) const KEPT: f64 = 0.9;
    /// Maximum number of bend rounds.
    pub(crate) const BENDS: usize = 5;
    /// Maximum number of bend rounds for a path that has changed in places: the mission is waiting, and ties gain as
    /// much in a tenth of the time.
    pub(crate) const BENDS_AGAIN: usize = 1;
    /// Maximum number of tie rounds.
    pub(crate) const TIES: usize = 8;
    /// Maximum number of tie rounds that count as early.
    pub(crate) const EARLY_TIES: usize = 3;
    /// Coverage that late tie rounds may leave missing, as a share.
    pub(crate) const LATE_SHARE: f64 = 0.0001;
    /// Minimum number of missed cells that are worth a bend.
    pub(crate) const BENT_CELLS: usize = 3;
    /// Minimum number of missed cells that are worth a tie in an early round.
    pub(crate) const TIED_CELLS: usize = 8;
    /// Minimum number of missed cells that are worth a tie in a late round.
    pub(crate) const LATE_CELLS: usize = 4;
}

/// Shortcuts of a path.
pub(crate) mod shortcuts {
    /// Minimum saving, metres.
    pub(crate) const LEAST_SAVING_M: f64 = 0.04;
    /// Longest stretch that a shortcut may replace anywhere, metres.
    pub(crate) const SHORT_M: f64 = 2.7;
    /// Longest stretch that a shortcut may replace where the path turns by more than `MUCH_TURN_RAD`, metres.
    pub(crate) const LONG_M: f64 = 9.0;
    /// Sum of the turns of a stretch above which a longer shortcut may replace it, radians.
    pub(crate) const MUCH_TURN_RAD: f64 = 3.0;
    /// Value of a metre of path along the shell, metres: the critical zone must be scanned.
    pub(crate) const SHELL: f64 = 2.0;
    /// Number of sides beyond which only some ends of a shortcut are tried.
    pub(crate) const FINE: usize = 8;
    /// Sample positions across a side for a quick check, as shares of half the bar.
    pub(crate) const SAMPLES: [f64; 4] = [-0.75, -0.25, 0.25, 0.75];
    /// Ratio of the apparent to the allowed loss above which the quick check rules out a shortcut.
    pub(crate) const QUICK_MARGIN: f64 = 1.3;
}

/// Bends of a path to missed floor.
pub(crate) mod bends {
    /// Distance from missed floor within which points of the path are tried, metres.
    pub(crate) const NEAR_M: f64 = 0.75;
    /// Maximum number of points of the path that are tried for a group of missed cells.
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
    /// Smallest missed area that gets a lane before the tour, as a multiple of the squared swath. Bends and ties reach
    /// smaller areas more cheaply. Without bends and ties, a value of 0.012 m2 instead of 0.06 m2 made paths 2 to 10 %
    /// longer (method).
    pub(crate) const LEAST: f64 = 0.55;
    /// Expected length of touch-ups over missed floor, as a multiple of its area divided by the swath.
    pub(crate) const MISSED: f64 = 2.5;
    /// Distance of touch-ups from cuts, metres.
    pub(crate) const CUT_M: f64 = 0.03;
    /// Minimum length of touch-ups, metres.
    pub(crate) const LEAST_LANE_M: f64 = 0.06;
    /// Distance within which the sides of a finished path are tried for a tie, metres.
    pub(crate) const TIE_M: f64 = 2.0;
    /// Maximum number of sides that are tried for a tie.
    pub(crate) const SIDES: usize = 10;
    /// Maximum cost of a tie in addition to the length of its lane, metres.
    pub(crate) const MOST_EXTRA_M: f64 = 8.0;
    /// Minimum floor that a tie must gain, square metres.
    pub(crate) const LEAST_GAIN_M2: f64 = 0.01;
}

/// The pass along the shell.
pub(crate) mod shell {
    /// Width of the zone examined, metres.
    pub(crate) const ZONE_M: f64 = 0.075;
    /// Unscanned width that is tolerated, metres: lanes keep a little slack, and no robot drives with millimetre
    /// accuracy.
    pub(crate) const NEAR_M: f64 = 0.0101;
    /// Excess distance from the shell up to which a path is moved to its minimum distance, metres.
    pub(crate) const PRESSED_M: f64 = 0.03;
    /// Floor that this move may lose, in square metres per metre of path.
    pub(crate) const MOST_LOST_M: f64 = 0.02;
    /// Step along the shell, metres.
    pub(crate) const STEP_M: f64 = 0.15;
    /// Shortest lane that is worth its turns, metres.
    pub(crate) const LEAST_M: f64 = 0.1;
}

/// The choice among candidates.
pub(crate) mod choice {
    /// Shares of the largest cut angle, tried until a candidate meets the preferences for the cable. The first is
    /// sufficient in about half of all tanks (tuning.md).
    pub(crate) const ANGLES: [f64; 3] = [1.0, 0.5, 0.0];
    /// Number of directions of straight lanes examined in a round tank before any lanes are laid.
    pub(crate) const LOOKED_AT: usize = 24;
    /// Number of offsets examined for each direction.
    pub(crate) const PLACES: usize = 6;
    /// Cost of a lane broken by an obstacle, in lanes broken by a cut. An obstacle costs less because the way around it
    /// is short.
    pub(crate) const BY_OBSTACLE: f64 = 0.5;
    /// Cost of a metre of sliver along the wall, in lanes broken by a cut.
    pub(crate) const SLIVER_PER_M: f64 = 0.5;
    /// Angle between a lane and the side of an obstacle in its way above which the lane is broken rather than bent
    /// around the obstacle, radians. Going around takes four such turns; turning back takes half a turn.
    pub(crate) const BENT_RAD: f64 = std::f64::consts::FRAC_PI_4;
    /// Total length of lanes that get a first tour, metres. It determines the number of candidates, with a minimum of
    /// `LEAST_TOURED`. More candidates take longer, and an additional one gains least in large tanks.
    pub(crate) const TOURED_M: f64 = 14_000.0;
    /// Minimum number of candidates that get a first tour.
    pub(crate) const LEAST_TOURED: usize = 2;
    /// Number of directions between straight walls: along the longest wall, and across it.
    pub(crate) const BETWEEN_WALLS: usize = 2;
    /// Largest angles of cuts tried between straight walls, as multiples of the largest cut angle: different cuts break
    /// different lanes (tuning.md).
    pub(crate) const ANGLES_BETWEEN_WALLS: [f64; 4] = [1.0, 1.2, 1.4, 1.6];
    /// Upper limit for these angles, radians.
    pub(crate) const MOST_ANGLE_RAD: f64 = 80.0 * std::f64::consts::PI / 180.0;
    /// Number of obstacles above which a tank is crowded: only the best direction is tried, with straight cuts. Oblique
    /// cuts did not meet the preferences for the tether there, so planning with them would waste time (tuning.md).
    pub(crate) const CROWDED: usize = 800;
    /// Maximum number of candidates polished in coarse cells: first tours rank almost like finished paths (tuning.md).
    pub(crate) const MOST_ROUGHED: usize = 2;
    /// Maximum number of candidates finished in fine cells.
    pub(crate) const MOST_FINISHED: usize = 2;
    /// Factor by which the tether of a first tour may exceed the preferred length: polishing changes the length by
    /// less.
    pub(crate) const DRAFT_CABLE: f64 = 1.015;
    /// Factor by which the tether of a first tour may exceed the preferred wraps: polishing changes the wraps by less.
    pub(crate) const DRAFT_WRAP: f64 = 1.1;
    /// Share by which a first tour may cost more than the best one. More expensive first tours never lead to the chosen
    /// candidate.
    pub(crate) const HOPELESS: f64 = 0.02;
    /// The same share after polishing in coarse cells.
    pub(crate) const CLOSE: f64 = 0.01;
    /// Distance from home within which no cable lies across a cut, swaths.
    pub(crate) const FAR: f64 = 4.0;
    /// Share of the reachable floor that a plan must scan to be complete if the reel has no limit, even if more is
    /// requested.
    pub(crate) const COMPLETE: f64 = 0.99;
    /// Largest shortfall from the requested coverage with which a plan is still complete if the reel has a limit, as a
    /// share.
    pub(crate) const BY_REEL: f64 = 0.001;
    /// Length of path that is worth as much as the whole preferred pull on the tether, metres: two candidates that differ
    /// by less are chosen by the pull. It is small, because the pull is free as long as it is within its limit.
    pub(crate) const PULL_M: f64 = 5.0;
    /// Maximum number of cells of a floor. More cells cost memory and time. In a large tank, the edges, where cell size
    /// matters, are a smaller share of the floor (tuning.md).
    pub(crate) const MOST_CELLS: f64 = 4e6;
}

/// Floors between inner walls.
pub(crate) mod rooms {
    /// Maximum total lane length that can be planned well within a minute on one core, metres: 5,000 m took 16 s.
    pub(crate) const MOST_LANES_M: f64 = 8_000.0;
    /// Maximum number of convex obstacles that can be planned well within a minute on one core.
    pub(crate) const MOST_PARTS: usize = 3_000;
    /// Share of the reachable floor that a plan between inner walls must scan to be complete. Coverage is counted with
    /// the lane width, which is the tool width less the overlap. The tool also scans corners beyond that width: a
    /// coverage of 98.3 to 98.9 % by lane width is 99.8 to 99.9 % by tool width (decisions.md).
    pub(crate) const COMPLETE: f64 = 0.98;
    /// Number of convex obstacles above which a floor with straight walls is treated as divided by inner walls.
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
    /// Factor by which a certified repair may exceed the preferred tether length.
    pub(crate) const LONGER_CABLE: f64 = 1.1;
    /// Factor by which a certified repair may exceed the preferred wraps.
    pub(crate) const MORE_WRAP: f64 = 1.5;
    /// Distance from the change within which lanes are reordered, swaths.
    pub(crate) const NEAR: f64 = 5.0;
    /// Number of changes tried for each of these lanes.
    pub(crate) const KICKS: f64 = 30.0;
    /// Length of the pieces into which lanes that cannot be driven as a whole are divided, metres.
    pub(crate) const BIT_M: f64 = 0.1;
    /// Length at the beginning of the old path, metres. If the robot is blocked, a new path must deviate from this part
    /// of the old path by at least `AS_BEFORE_M` at some point.
    pub(crate) const AHEAD_M: f64 = 1.0;
    /// Minimum distance of a new path from the old one, metres; a mere bend deviates by less.
    pub(crate) const AS_BEFORE_M: f64 = 0.35;
    /// Share of all floor that a repaired path may miss in addition to what the previous plan could miss.
    pub(crate) const MORE_LEFT: f64 = 0.0005;
    /// Share of the rest of the old path by which a repaired path may be longer. A new plan is tried if the repaired
    /// path is longer by more than this share and `LONGER_M` together.
    pub(crate) const LONGER: f64 = 0.06;
    /// Length by which a repaired path may be longer, in addition to `LONGER`, metres.
    pub(crate) const LONGER_M: f64 = 12.0;
}

/// The published partition and its genetic algorithm (Pan 2025; values not given in the paper are from the method).
pub(crate) mod hull_partition {
    /// Number of sides of the polygon that approximates a round wall.
    pub(crate) const WALL_SIDES: usize = 96;
    /// Minimum width of a gate, metres.
    pub(crate) const LEAST_GATE_M: f64 = 0.1;
    /// Edge of a square, in swaths. Cells smaller than this square are merged if the result meets `CONVEX_ENOUGH` and
    /// `DEEP_M`.
    pub(crate) const SMALL_SWATHS: f64 = 4.0;
    /// Minimum share of its convex hull that a merged cell must fill.
    pub(crate) const CONVEX_ENOUGH: f64 = 0.95;
    /// Maximum depth of a column's centre inside the convex hull of a merged cell, metres.
    pub(crate) const DEEP_M: f64 = 0.05;
    /// Distance by which cuts extend beyond the corners of cells, metres.
    pub(crate) const SEAM_M: f64 = 0.02;
    /// Distance of the outermost lanes from the border of their cell, metres.
    pub(crate) const INSIDE_M: f64 = 3e-3;
    /// Maximum number of convex obstacles on a floor between inner walls: with more, walls would be mistaken for
    /// columns.
    pub(crate) const MOST_COLUMNS: usize = 40;
    /// Sealed area that justifies another gate or a warning, square metres.
    pub(crate) const SEALED_M2: f64 = 0.05;
    /// Number of orders in a generation of the genetic algorithm.
    pub(crate) const POPULATION: usize = 120;
    /// Number of orders from which a parent is selected.
    pub(crate) const TOURNAMENT: usize = 3;
    /// Probability that a new order is mutated.
    pub(crate) const MUTATION: f64 = 0.2;
    /// Number of best orders that are kept unchanged.
    pub(crate) const ELITE: usize = 2;
    /// Maximum number of generations.
    pub(crate) const GENERATIONS: usize = 400;
    /// Number of generations without improvement after which the algorithm stops.
    pub(crate) const PATIENCE: usize = 80;
    /// Maximum number of cells that are ordered exactly: time and memory double with every cell.
    pub(crate) const MOST_EXACT: usize = 13;
}
