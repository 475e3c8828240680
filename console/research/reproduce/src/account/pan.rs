//! Pan 2025.

use super::{
    Item, Paper,
    State::{Absent, Ours, Read},
    item,
};

pub(super) const PAPER: Paper = Paper { name: "Pan 2025", items: ITEMS };

const MAPS: &str = "tankops reproduce pan-maps --method hull-partition";

const ITEMS: &[Item] = &[
    item(
        "Sec. III, maps",
        "mapping by Cartographer",
        Absent,
        "",
        "no mapping; maps, drawings and lists of columns are imported",
    ),
    item(
        "Sec. III.A, Figs 1, 2",
        "partition by convex hulls (Graham)",
        Read,
        MAPS,
        "which partitions are merged is left open",
    ),
    item(
        "Eq. 1",
        "order of the partitions by a genetic algorithm",
        Ours,
        MAPS,
        "an exact or local search of the same sum; the tether is brought back between partitions",
    ),
    item(
        "Sec. III.B",
        "back and forth within a partition",
        Read,
        MAPS,
        "start and density as the text has them; their numbers are not printed",
    ),
    item(
        "Figs 3 to 5",
        "a round floor, another, a square one, with both methods",
        Read,
        "tankops reproduce pan-maps --svg plans",
        "no coordinates and no figures are printed; 14, 28 and 18 columns in random places",
    ),
    item(
        "Claim",
        "less risk of entanglement at full coverage",
        Read,
        "tankops reproduce pan-maps",
        "no figure is printed; ours counts turns of the tether and its least length",
    ),
    item(
        "Sec. IV",
        "simulation in Gazebo, ROS navigation",
        Absent,
        "",
        "no Gazebo and no ROS node; our simulator and MCAP export",
    ),
    item(
        "Beyond",
        "other tanks, more columns, certified tether",
        Ours,
        "tankops reproduce coverage-suite",
        "not in the paper",
    ),
];
