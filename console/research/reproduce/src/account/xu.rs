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
        "a far goal pulls the robot into an obstacle",
        Absent,
        "",
        "the guard and the cap of steps keep every robot here off; no study switches both off",
    ),
    item(
        "Drawback 2, Fig. 2",
        "robot, obstacle and goal on a line",
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
        "k and n are not printed (parameters k, n); near the goal read as log2(1/rho + 1), or as printed with n of 16 and more",
    ),
    item(
        "Eq. 5, 8, 9",
        "a second repulsion, mu over the distance",
        Read,
        "tankops planners",
        "without range and by eq. 9 toward the obstacle; eq. 2 is used, eq. 8 turned round is push_form = hyperbola",
    ),
    item(
        "Eq. 6",
        "circle about an obstacle",
        Read,
        BVO,
        "the printed centre misses the obstacle; that of its box is used",
    ),
    item("Eq. 7", "angle of a vector", Read, BVO, "the third row is wrong as printed; vectors are used"),
    item(
        "Eq. 10 to 13",
        "tangent force",
        Read,
        TRAPS,
        "eq. 10 is singular at vertical tangents; its plus root is the left tangent. When the force acts is open",
    ),
    item(
        "Sec. 3.4, Fig. 4",
        "retreat out of the trap and seal of its mouth",
        Read,
        BVO,
        "side, room before the seal and the rule of oscillation are open: an independent implementation differs by 3 to 13 % in length",
    ),
    item(
        "Eq. 14 to 17, Figs 5, 6",
        "angle at the mouth",
        Read,
        BVO,
        "as printed the cotangent of a cosine and a condition that is never true; read as an angle at the mouth",
    ),
    item("Fig. 7", "flow of the method", Absent, "", "a picture that our copy does not hold"),
    item(
        "Table 1, APF",
        "stop (44.3, 55.4)",
        Fitted,
        "tankops reproduce xu-table1 --method apf",
        "radius and gain are not printed and were fitted to this stop",
    ),
    item(
        "Table 1, TAPF",
        "stop (44.3, 55.3)",
        Fitted,
        "tankops reproduce xu-table1 --method tapf",
        "weight 0.02 at a radius of 1 m, or 1 at 3.2 to 3.55 m: both give it",
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
        "layout reconstructed; 86.7 m, an independent implementation 89.1 m",
    ),
    item(
        "Fig. 12",
        "U",
        Read,
        "tankops reproduce xu-traps --case u --svg plans",
        "layout reconstructed; 88.4 m, an independent implementation 98.4 m",
    ),
    item(
        "Fig. 13, Table 2",
        "stops of APF and TAPF",
        Fitted,
        TABLE2,
        "the trap is placed by them; the printed shift from APF to TAPF comes out in no reading",
    ),
    item(
        "Table 2",
        "61,934 and 33,119 steps of APF and TAPF",
        Missed,
        TABLE2,
        "ours rest after 7,100; the paper's runs were stopped by hand",
    ),
    item(
        "Table 2",
        "15,104 steps of BVO-APF",
        Fitted,
        TABLE2,
        "the step of 0.0071 m was chosen by it; an independent implementation takes 17,030",
    ),
    item("Table 2", "1.17 s", Reproduced, TABLE2, "ours take milliseconds; another machine and language"),
    item(
        "Figs 14 to 16",
        "pull and push along the way",
        Read,
        "tankops reproduce xu-forces --svg forces",
        "the figures have no numbers in our copy",
    ),
    item(
        "Claim",
        "success with any shape of trap",
        Read,
        "tankops reproduce trap-suite --first-seed 9000",
        "true of islands; a trap that hangs on the wall needs the outline as an obstacle, of which the paper does not speak",
    ),
    item(
        "Sec. 4.4",
        "ROS navigation, odometry, AMCL",
        Absent,
        "",
        "no ROS node; recorded runs and MCAP export, positioning by ranges",
    ),
    item(
        "Sec. 4.5, Figs 18 to 21",
        "maps by gmapping",
        Ours,
        "tankops run scenarios/laboratory.toml",
        "no mapping; ROS map files are imported, two of the floors are reconstructed (also corridor.toml)",
    ),
    item(
        "Sec. 4.6, Figs 22 to 25",
        "runs of a vehicle",
        Absent,
        "",
        "no recorded runs; the same floors are simulated",
    ),
    item(
        "Future work",
        "moving obstacles",
        Ours,
        "tankops run scenarios/crossing-carts.toml --planner bvo-apf",
        "evaded by their velocities",
    ),
    item(
        "Future work",
        "not to enter the trap, shorter and smoother",
        Ours,
        "tankops reproduce trap-suite --method bvo-apf/pre",
        "mode pre; length only, smoothness is not measured",
    ),
    item(
        "Scenario",
        "Table 2 by the paper's method, and by ours",
        Read,
        "tankops run scenarios/papers/xu-table2.toml",
        "xu-table2-ours.toml flies mode pre",
    ),
];
