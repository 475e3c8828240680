//! Xu et al. 2022.

use super::{
    Item, Paper,
    State::{Absent, Fitted, Missed, Ours, Read, Reproduced},
    item,
};

pub(super) const PAPER: Paper = Paper { name: "Xu et al. 2022", items: ITEMS };

const TABLE1: &str = "tankops reproduce xu-table1";
const TRAPS: &str = "tankops reproduce xu-traps";
const TABLE2: &str = "tankops reproduce xu-table2";
const BVO: &str = "tankops reproduce xu-traps --method bvo-apf/literal";

const ITEMS: &[Item] = &[
    item(
        "Eq. 1 to 3",
        "classical field",
        Read,
        "tankops reproduce xu-table1 --method apf",
        "distances to the outline instead of the centre",
    ),
    item(
        "Drawback 1",
        "a distant goal pulls the robot into an obstacle",
        Absent,
        "",
        "the guard and the cap on steps prevent this for every robot; no study switches both off",
    ),
    item(
        "Drawback 2, Fig. 2",
        "robot, obstacle and goal in a line",
        Reproduced,
        "tankops reproduce xu-traps --case line",
        "",
    ),
    item("Drawback 3", "a goal near an obstacle", Reproduced, TABLE1, ""),
    item(
        "Eq. 4",
        "logarithmic pull",
        Read,
        "tankops reproduce xu-table1 --method bvo-apf",
        "k and n are not printed (parameters k, n); near the goal, eq. 4 is interpreted as log2(1/rho + \
         1), or used as printed with n of 16 or more",
    ),
    item(
        "Eq. 5, 8, 9",
        "a second repulsion, mu over the distance",
        Read,
        "tankops planners",
        "it has no range limit and, by eq. 9, points towards the obstacle; eq. 2 is used instead, and eq. \
         8 with its direction reversed is available as push_form = hyperbola",
    ),
    item(
        "Eq. 6",
        "circle about an obstacle",
        Read,
        BVO,
        "the printed centre misses the obstacle; the centre of its bounding box is used",
    ),
    item("Eq. 7", "angle of a vector", Read, BVO, "the third row is wrong as printed; we use vectors"),
    item(
        "Eq. 10 to 13",
        "tangent force",
        Read,
        TRAPS,
        "eq. 10 is singular at vertical tangents; its plus root is the left tangent. The text leaves open \
         when the force acts",
    ),
    item(
        "Sec. 3.4, Fig. 4",
        "retreat out of the trap, and sealing of its mouth",
        Read,
        BVO,
        "the side, the distance in front of the seal and the oscillation rule are open: an independent \
         implementation differs by 3 to 13 % in length",
    ),
    item(
        "Eq. 14 to 17, Figs 5, 6",
        "angle at the mouth",
        Read,
        BVO,
        "as printed, they contain the cotangent of a cosine and a condition that is never true; we \
         interpret them as an angle at the mouth",
    ),
    item("Fig. 7", "flow chart of the method", Absent, "", "a picture that our copy does not contain"),
    item(
        "Table 1, APF",
        "stop (44.3, 55.4)",
        Fitted,
        "tankops reproduce xu-table1 --method apf",
        "radius and gain are not printed; we fitted them to this stopping point",
    ),
    item(
        "Table 1, TAPF",
        "stop (44.3, 55.3)",
        Fitted,
        "tankops reproduce xu-table1 --method tapf",
        "a weight of 0.02 with a radius of 1 m and a weight of 1 with a radius of 3.2 to 3.55 m both give \
         this point",
    ),
    item(
        "Table 1, BVO-APF",
        "reaches (44, 55)",
        Reproduced,
        "tankops reproduce xu-table1 --method bvo-apf",
        "",
    ),
    item("Figs 8 to 10", "paths of Table 1", Reproduced, "tankops reproduce xu-table1 --svg plans", ""),
    item(
        "Fig. 11",
        "triangle",
        Read,
        "tankops reproduce xu-traps --case triangle --svg plans",
        "layout reconstructed; path length 86.7 m with our implementation, 89.1 m with an independent one",
    ),
    item(
        "Fig. 12",
        "U",
        Read,
        "tankops reproduce xu-traps --case u --svg plans",
        "layout reconstructed; path length 88.4 m with our implementation, 98.4 m with an independent one",
    ),
    item(
        "Fig. 13, Table 2",
        "stopping points of APF and TAPF",
        Fitted,
        TABLE2,
        "the trap was placed to match them; no interpretation reproduces the printed shift from APF to TAPF",
    ),
    item(
        "Table 2",
        "61,934 and 33,119 steps of APF and TAPF",
        Missed,
        TABLE2,
        "our runs come to rest after 7,100 steps; the paper's runs were stopped by hand",
    ),
    item(
        "Table 2",
        "15,104 steps of BVO-APF",
        Fitted,
        TABLE2,
        "the step size of 0.0071 m was chosen to match this; an independent implementation takes 17,030 \
         steps",
    ),
    item(
        "Table 2",
        "1.17 s",
        Reproduced,
        TABLE2,
        "our plans take milliseconds, on a different machine and in a different language",
    ),
    item(
        "Figs 14 to 16",
        "pull and push along the path",
        Read,
        "tankops reproduce xu-forces --svg forces",
        "in our copy, the figures have no numbers",
    ),
    item(
        "Claim",
        "success with any shape of trap",
        Read,
        "tankops reproduce trap-suite --first-seed 9000",
        "true for free-standing traps; for a trap attached to the wall, the outline must be treated as an \
         obstacle, which the paper does not discuss",
    ),
    item(
        "Sec. 4.4",
        "ROS navigation, odometry, AMCL",
        Absent,
        "",
        "no ROS node; instead, there are recorded runs, MCAP export and positioning by ranges",
    ),
    item(
        "Sec. 4.5, Figs 18 to 21",
        "maps by gmapping",
        Ours,
        "tankops run scenarios/laboratory.toml",
        "no mapping; ROS map files can be imported, and two of the floors are reconstructed (also \
         corridor.toml)",
    ),
    item(
        "Sec. 4.6, Figs 22 to 25",
        "runs of a vehicle",
        Absent,
        "",
        "no recorded runs; the same floors are simulated instead",
    ),
    item(
        "Future work",
        "moving obstacles",
        Ours,
        "tankops run scenarios/crossing-carts.toml --planner bvo-apf",
        "avoided by using their velocities",
    ),
    item(
        "Future work",
        "avoiding the trap; shorter and smoother paths",
        Ours,
        "tankops reproduce trap-suite --method bvo-apf/pre",
        "mode pre; only the length is measured, not the smoothness",
    ),
    item(
        "Scenario",
        "Table 2 with the paper's method, and with ours",
        Read,
        "tankops run scenarios/papers/xu-table2.toml",
        "xu-table2-ours.toml uses mode pre",
    ),
];
