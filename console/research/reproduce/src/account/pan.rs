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
        Ours,
        "tankops reproduce pan-own-map",
        "a survey with positions from acoustic emission instead of Cartographer; maps and drawings can also be imported",
    ),
    item(
        "Sec. III.A, Figs 1, 2",
        "partition by convex hulls (Graham)",
        Read,
        MAPS,
        "the text does not define which partitions are merged",
    ),
    item(
        "Eq. 1",
        "order of the partitions, found by a genetic algorithm",
        Ours,
        MAPS,
        "an exact or local search minimizes the same sum; the tether is reeled in between partitions",
    ),
    item(
        "Sec. III.B",
        "back and forth within a partition",
        Read,
        MAPS,
        "start and density as in the text; their values are not printed",
    ),
    item(
        "Figs 3 to 5",
        "two round floors and a square floor, with both methods",
        Read,
        "tankops reproduce pan-maps --svg plans",
        "neither coordinates nor figures are printed; we place 14, 28 and 18 columns at random",
    ),
    item(
        "Claim",
        "lower risk of entanglement at full coverage",
        Read,
        "tankops reproduce pan-maps",
        "no figure is printed; our study gives the turns of the tether and its minimum length",
    ),
    item(
        "Sec. IV",
        "simulation in Gazebo, ROS navigation",
        Absent,
        "",
        "no Gazebo and no ROS node; we use our own simulator, and runs can be exported as MCAP",
    ),
    item(
        "Beyond",
        "other tanks, more columns, certified tether",
        Ours,
        "tankops reproduce coverage-suite",
        "not in the paper",
    ),
];
