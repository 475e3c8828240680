//! The parameters that shape plans, grouped by step, with their sources. Rounding tolerances stand where they are
//! used.
//!
//! *Method* is the specification from which the planners were made (Pan 2025 and the slit domain), measured on round
//! tanks of radius 10 m with 14 and 28 columns and on a square of 18 m with 18. `console/docs/tuning.md` gives the
//! reasons for the larger choices. Values without a source were set by hand on the same tanks.

/// Placement of cuts.
pub(crate) mod cuts {
    /// Clearance of a cut from other obstacles, beyond that of the hull, metres (method).
    pub(crate) const BERTH_M: f64 = 0.05;
    /// Rays tried on either side of the ray from the anchor.
    pub(crate) const RAYS: usize = 18;
    /// Cost of a metre of cut and of a metre of excess cable, in broken lanes; every broken lane costs a turn.
    pub(crate) const COST_PER_M: f64 = 0.08;
    pub(crate) const EXCESS_COST_PER_M: f64 = 1e3;
    /// Cuts are recomputed at most this often while they seal off more than a sliver of floor, square metres.
    pub(crate) const TRIES: usize = 12;
    pub(crate) const SLIVER_M2: f64 = 0.02;
    /// Shares of the cable's slack by which a cut across the lanes, or along them, may lengthen the path to its far
    /// end, tried in this order until the cable keeps its limits. The cable is seldom as long as a single cut
    /// suggests.
    pub(crate) const SLACKS_ACROSS: [f64; 4] = [1.0, 0.7, 0.4, 0.2];
    pub(crate) const SLACKS_ALONG: [f64; 7] = [3.0, 2.2, 1.7, 1.3, 1.0, 0.8, 0.5];
    /// The hull passes columns further out than the cable does: allowance, metres, whatever the size of the tank.
    pub(crate) const AROUND_M: f64 = 0.25;
}

/// Placement of lanes; distances are shares of the swath.
pub(crate) mod lanes {
    /// From a cut to contours, which end there, and to straight lanes, which may run alongside.
    pub(crate) const CONTOUR_TO_CUT: f64 = 0.33;
    pub(crate) const STRAIGHT_TO_CUT: f64 = 0.08;
    /// From a corridor to its own cut (method), to other cuts, to other corridors and to lanes.
    pub(crate) const CORRIDOR: f64 = 0.5;
    pub(crate) const CORRIDOR_TO_CUT: f64 = 0.45;
    pub(crate) const CORRIDOR_TO_CORRIDOR: f64 = 0.25;
    pub(crate) const CORRIDOR_TO_LANE: f64 = 0.5;
    /// How far straight lanes extend into the innermost lap along the wall.
    pub(crate) const INTO_LAP: f64 = 0.5;
    /// Spacing of straight lanes in a round tank: slightly less than the swath, so that no row of cells is missed.
    pub(crate) const SPACING: f64 = 0.997;
    /// Lanes shorter than the swath divided by this are dropped: with touch-ups to follow, and without.
    pub(crate) const LEAST_IN_SWATH: f64 = 3.0;
    pub(crate) const LEAST_TO_AND_FRO_IN_SWATH: f64 = 12.0;
    /// The traditional and the published planner leave slivers, up to 12 % in tanks of many columns; below this share of the
    /// floor their plans are not complete.
    pub(crate) const COMPLETE_WITH_SLIVERS: f64 = 0.85;
    /// Sine of the least angle at which a cut lies across straight lanes and needs a corridor.
    pub(crate) const ACROSS: f64 = 0.6;
}

/// The search for the order of lanes.
pub(crate) mod tour {
    /// Nearest ends whose connectors are computed, and how many of them form a neighbour list.
    pub(crate) const LOOKED_AT: usize = 18;
    pub(crate) const NEIGHBOURS: usize = 8;
    /// Longest run of lanes moved as one (method), and most lanes affected by a kick.
    pub(crate) const RUN: usize = 3;
    pub(crate) const KICK_REACH: usize = 30;
    /// Share of the search spent on a first tour.
    pub(crate) const DRAFT_SHARE: f64 = 0.3;
}

/// Prices and limits of polishing; floor is priced in multiples of the path that sweeps it.
pub(crate) mod polish {
    /// Value of floor to shortcuts. What they drop is covered more cheaply by bends: together these shorten paths by
    /// 2 to 3 % (tuning.md).
    pub(crate) const FLOOR: f64 = 11.0;
    /// Most that floor may cost by a bend, turns included.
    pub(crate) const BENT_FLOOR: f64 = 28.0;
    /// How many times that, one after another, where at last more than this share of the floor is missing of what is enough
    /// (tuning.md).
    pub(crate) const DEARER: [f64; 3] = [2.0, 4.0, 8.0];
    pub(crate) const LEFT: f64 = 0.0008;
    /// Value of floor once the path was bent to it, metres of path per square metre: nothing may be lost again.
    pub(crate) const CAREFUL_M_PER_M2: f64 = 1e6;
    /// Cells of the first round, as a multiple of those of the second: finer ones decide between candidates no better.
    pub(crate) const ROUGH: f64 = 1.6;
    /// Prices at which floor beyond what is enough is given away, as multiples of the price before, dear floor last.
    pub(crate) const PRICES: [f64; 3] = [3.0, 1.0, 0.4];
    /// Share of the scanned floor that shortcuts must leave if only some floor is asked for.
    pub(crate) const KEPT: f64 = 0.9;
    /// Rounds of bends and of ties, early rounds of ties, and by how much less coverage is enough after these.
    pub(crate) const BENDS: usize = 5;
    /// Rounds of bends of a path that has changed in places: somebody waits for it, and ties gain as much in a tenth of the time.
    pub(crate) const BENDS_AGAIN: usize = 1;
    pub(crate) const TIES: usize = 8;
    pub(crate) const EARLY_TIES: usize = 3;
    pub(crate) const LATE_SHARE: f64 = 0.0001;
    /// Fewest missed cells that are worth a bend, a tie in an early round, and a tie later.
    pub(crate) const BENT_CELLS: usize = 3;
    pub(crate) const TIED_CELLS: usize = 8;
    pub(crate) const LATE_CELLS: usize = 4;
}

/// Shortcuts of a path.
pub(crate) mod shortcuts {
    /// Least saving, metres.
    pub(crate) const LEAST_SAVING_M: f64 = 0.04;
    /// Longest path that a shortcut may replace, metres: anywhere, and where the path turns by more than this,
    /// radians.
    pub(crate) const SHORT_M: f64 = 2.7;
    pub(crate) const LONG_M: f64 = 9.0;
    pub(crate) const MUCH_TURN_RAD: f64 = 3.0;
    /// What a metre along the shell is worth, metres: the critical zone must be scanned.
    pub(crate) const SHELL: f64 = 2.0;
    /// Number of sides beyond which not every end of a shortcut is tried.
    pub(crate) const FINE: usize = 8;
    /// Sample positions across a side for a quick check, as shares of half the bar. It rules out a shortcut only if
    /// that seems to lose this many times what it may.
    pub(crate) const SAMPLES: [f64; 4] = [-0.75, -0.25, 0.25, 0.75];
    pub(crate) const QUICK_MARGIN: f64 = 1.3;
}

/// Bends of a path to missed floor.
pub(crate) mod bends {
    /// Path points are tried within this distance of missed floor, metres, at most so many.
    pub(crate) const NEAR_M: f64 = 0.75;
    pub(crate) const PLACES: usize = 5;
    /// Sides of the path that a bend replaces on either side of its point.
    pub(crate) const BASES: [usize; 3] = [1, 2, 4];
    /// Floor that a bend may gain, as a multiple of that which it is meant for.
    pub(crate) const AND_BESIDE: f64 = 2.0;
    /// Offsets of a bend, as shares of the swath.
    pub(crate) const ASIDE: [f64; 4] = [0.1, 0.2, 0.35, 0.55];
}

/// Short lanes over missed floor.
pub(crate) mod touch_ups {
    /// Smallest missed place that gets a lane before the tour, as a multiple of the swath squared; bends and ties
    /// reach smaller ones more cheaply. Without those, 0.012 m2 instead of 0.06 m2 made paths 2 to 10 % longer
    /// (method).
    pub(crate) const LEAST: f64 = 0.55;
    /// Expected length of touch-ups over missed floor, as a multiple of its area by the swath.
    pub(crate) const MISSED: f64 = 2.5;
    /// Clearance from cuts, and least length, metres.
    pub(crate) const CUT_M: f64 = 0.03;
    pub(crate) const LEAST_LANE_M: f64 = 0.06;
    /// Sides of a finished path are tried for a tie within this distance, metres, at most so many.
    pub(crate) const TIE_M: f64 = 2.0;
    pub(crate) const SIDES: usize = 10;
    /// Most that a tie may cost beyond the length of its lane, metres, and least floor that it must gain, square
    /// metres.
    pub(crate) const MOST_EXTRA_M: f64 = 8.0;
    pub(crate) const LEAST_GAIN_M2: f64 = 0.01;
}

/// The pass along the shell.
pub(crate) mod shell {
    /// Width of the zone that is looked at, metres, and by how much less of it is scanned than could be where that does not
    /// matter: lanes keep a little slack, and a robot does not drive to the millimetre.
    pub(crate) const ZONE_M: f64 = 0.075;
    pub(crate) const NEAR_M: f64 = 0.0101;
    /// Path that is farther from the shell than it need be by less than this is put right, metres.
    pub(crate) const PRESSED_M: f64 = 0.03;
    /// Floor that may be lost for that, metres: square metres for each metre of path.
    pub(crate) const MOST_LOST_M: f64 = 0.02;
    /// Step along the shell, and the shortest lane that is worth its turns, metres.
    pub(crate) const STEP_M: f64 = 0.15;
    pub(crate) const LEAST_M: f64 = 0.1;
}

/// The choice among candidates.
pub(crate) mod choice {
    /// Shares of the largest cut angle, tried until a candidate meets the preferences for the cable: the first suffices in
    /// about half of all tanks (tuning.md).
    pub(crate) const ANGLES: [f64; 3] = [1.0, 0.5, 0.0];
    /// Directions of straight lanes that are looked at in a round tank before any lanes are laid, and places across each.
    pub(crate) const LOOKED_AT: usize = 24;
    pub(crate) const PLACES: usize = 6;
    /// What a lane that an obstacle breaks counts, and a metre of a sliver along the wall, in lanes that a cut breaks. An
    /// obstacle counts less: the way round it is short.
    pub(crate) const BY_OBSTACLE: f64 = 0.5;
    pub(crate) const SLIVER_PER_M: f64 = 0.5;
    /// Angle from a lane to the side of an obstacle in its way, radians, from which on the lane is broken there rather than
    /// bent round it: the way round takes four such turns, and half a turn is what it takes to turn back.
    pub(crate) const BENT_RAD: f64 = std::f64::consts::FRAC_PI_4;
    /// Length of all lanes that get a first tour, metres: so many candidates, but two at least. More take longer, and what is
    /// gained by another one is least in large tanks.
    pub(crate) const TOURED_M: f64 = 14_000.0;
    pub(crate) const LEAST_TOURED: usize = 2;
    /// The same between straight walls: along the longest, and across it. Cuts are tried up to several angles there, as multiples
    /// of the largest, and at most so far, radians: other cuts break other lanes (tuning.md).
    pub(crate) const BETWEEN_WALLS: usize = 2;
    pub(crate) const ANGLES_BETWEEN_WALLS: [f64; 4] = [1.0, 1.2, 1.4, 1.6];
    pub(crate) const MOST_ANGLE_RAD: f64 = 80.0 * std::f64::consts::PI / 180.0;
    /// A tank with more obstacles than this is crowded: only the best direction is tried, with straight cuts. With oblique ones the
    /// tether was not as straight as is preferred there, and all would be planned in vain (tuning.md).
    pub(crate) const CROWDED: usize = 800;
    /// Most candidates that are roughed, and most of these that are finished: the order of first tours is nearly that of finished
    /// paths (tuning.md).
    pub(crate) const MOST_ROUGHED: usize = 2;
    pub(crate) const MOST_FINISHED: usize = 2;
    /// How far the tether of a first tour may exceed what is preferred, as multiples of its length and of its wraps:
    /// polishing changes them by less.
    pub(crate) const DRAFT_CABLE: f64 = 1.015;
    pub(crate) const DRAFT_WRAP: f64 = 1.1;
    /// First tours that cost more than the best by this share never win.
    pub(crate) const HOPELESS: f64 = 0.02;
    /// The same of what was roughed.
    pub(crate) const CLOSE: f64 = 0.01;
    /// Within this many swaths of home no cable lies across a cut.
    pub(crate) const FAR: f64 = 4.0;
    /// A plan is complete with this share of the floor in reach even if more is asked for; with a short reel it may
    /// miss this share of what is asked for.
    pub(crate) const COMPLETE: f64 = 0.99;
    pub(crate) const BY_REEL: f64 = 0.001;
    /// Most cells of a floor: more cost memory and time, and in a large tank the edges, where cells matter, are a
    /// smaller share of the floor (tuning.md).
    pub(crate) const MOST_CELLS: f64 = 4e6;
}

/// Floors between inner walls.
pub(crate) mod rooms {
    /// Longest lanes and most convex obstacles that are planned well within a minute on one core: 5,000 m took 16 s.
    pub(crate) const MOST_LANES_M: f64 = 8_000.0;
    pub(crate) const MOST_PARTS: usize = 3_000;
    /// A plan between inner walls is complete with this share of the floor in reach. It is counted by the width of the lanes, which
    /// is that of the tool less the overlap; what lies in corners beyond that, the overlap scans: maps with 98.3 to 98.9 % have
    /// 99.8 to 99.9 % by the tool's width (decisions.md).
    pub(crate) const COMPLETE: f64 = 0.98;
    /// With more convex obstacles than this, a floor with straight walls counts as cut up by inner walls.
    pub(crate) const FEW_PARTS: usize = 200;
}

/// Repair of a plan under way.
pub(crate) mod repair {
    use std::f64::consts::FRAC_PI_2;

    /// Rays tried on either side of the ray from the anchor for the cut of a new obstacle.
    pub(crate) const RAYS: i32 = 16;
    /// Cost of a metre of such a cut, in broken lanes.
    pub(crate) const COST_PER_M: f64 = 0.1;
    /// Largest angles between these cuts and that ray, tried one after another: an oblique cut breaks fewer lanes, a
    /// straight one bends the tether less.
    pub(crate) const ANGLES_RAD: [f64; 3] = [FRAC_PI_2, 0.8, 0.2];
    /// How far a certified repair may exceed what is preferred of the tether, as multiples: of its length and of its wraps.
    pub(crate) const LONGER_CABLE: f64 = 1.1;
    pub(crate) const MORE_WRAP: f64 = 1.5;
    /// Lanes within so many swaths of what has changed are reordered.
    pub(crate) const NEAR: f64 = 5.0;
    /// Changes tried per lane of these.
    pub(crate) const KICKS: f64 = 30.0;
    /// Lanes are broken to pieces of this length where they cannot be driven any more, metres.
    pub(crate) const BIT_M: f64 = 0.1;
    /// A robot that is blocked is helped by a path that within so many metres leaves the old one by so much: more than a
    /// bend does.
    pub(crate) const AHEAD_M: f64 = 1.0;
    pub(crate) const AS_BEFORE_M: f64 = 0.35;
    /// Share of all floor that a repaired path may leave beyond what the plan before it might.
    pub(crate) const MORE_LEFT: f64 = 0.0005;
    /// A repaired path that is longer than the rest of the old one by this share, and by so many metres, gives way
    /// to a new plan.
    pub(crate) const LONGER: f64 = 0.06;
    pub(crate) const LONGER_M: f64 = 12.0;
}

/// The published partition and its genetic algorithm (Pan 2025, with the figures of the method where the paper has none).
pub(crate) mod hull_partition {
    /// Sides of the polygon that approximates a round wall.
    pub(crate) const WALL_SIDES: usize = 96;
    /// Least width of a gate, metres.
    pub(crate) const LEAST_GATE_M: f64 = 0.1;
    /// Cells smaller than the square of this many swaths are merged if the result is this convex and no column stands
    /// deeper inside than this, metres.
    pub(crate) const SMALL_SWATHS: f64 = 4.0;
    pub(crate) const CONVEX_ENOUGH: f64 = 0.95;
    pub(crate) const DEEP_M: f64 = 0.05;
    /// Cuts extend this far beyond the corners of cells, and outermost lanes stay this far inside them, metres.
    pub(crate) const SEAM_M: f64 = 0.02;
    pub(crate) const INSIDE_M: f64 = 3e-3;
    /// Most convex obstacles of a floor between inner walls: with more, walls are taken for columns everywhere.
    pub(crate) const MOST_COLUMNS: usize = 40;
    /// Sealed floor that is worth another gate or a warning, square metres.
    pub(crate) const SEALED_M2: f64 = 0.05;
    /// The genetic algorithm.
    pub(crate) const POPULATION: usize = 120;
    pub(crate) const TOURNAMENT: usize = 3;
    pub(crate) const MUTATION: f64 = 0.2;
    pub(crate) const ELITE: usize = 2;
    pub(crate) const GENERATIONS: usize = 400;
    pub(crate) const PATIENCE: usize = 80;
    /// Most cells that are ordered exactly: time and memory double with every cell.
    pub(crate) const MOST_EXACT: usize = 13;
}
