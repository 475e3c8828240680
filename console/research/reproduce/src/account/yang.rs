//! Yang et al. 2021.

use super::{
    Item, Paper,
    State::{Absent, Fitted, Missed, Ours, Read, Reproduced},
    item,
};

pub(super) const PAPER: Paper = Paper { name: "Yang et al. 2021", items: ITEMS };

const TABLE3: &str = "tankops reproduce yang-table3";
const TABLE4: &str = "tankops reproduce yang-table4";
const HYBRID: &str = "tankops reproduce yang-hybrid";

const ITEMS: &[Item] = &[
    item(
        "Eq. 1 to 4, Fig. 1",
        "kinetics on land: fins, friction",
        Absent,
        "",
        "coefficients of the fins and moments of inertia are not printed; we use the limits of Table 1 \
         instead",
    ),
    item(
        "Eq. 5 to 9, Fig. 2",
        "kinetics under water: five degrees of freedom, roll",
        Absent,
        "",
        "added mass, drag and moments of inertia are not printed; we use a unicycle with the limits of \
         Table 1 instead",
    ),
    item("Table 1", "mass, fin, wavelength, friction", Absent, "", "they are used only in the kinetics"),
    item(
        "Table 1",
        "speeds and turn rates in water and on land",
        Reproduced,
        "tankops run scenarios/papers/yang-hybrid-free.toml",
        "",
    ),
    item(
        "Eq. 10 to 16, Figs 3, 4",
        "traditional field",
        Read,
        "tankops reproduce yang-table3 --method apf-virtual-goals/traditional",
        "as printed, eq. 15 attracts; the missing sign is restored",
    ),
    item(
        "Eq. 17, Fig. 5",
        "virtual goals",
        Read,
        TABLE3,
        "the third case has no slope as printed; interpreted as a constant pull. \"F = 0\" is interpreted \
         as a small force",
    ),
    item(
        "Eq. 18",
        "choice of the virtual goal",
        Read,
        TABLE4,
        "as printed, the blocked direction scores best; the second vector is reversed. The size of the \
         square is not printed",
    ),
    item(
        "Eq. 19",
        "motion in space",
        Read,
        HYBRID,
        "in the plane, without depth and roll; y is incremented, not assigned",
    ),
    item(
        "Eq. 20 to 22",
        "windows of speeds",
        Read,
        HYBRID,
        "missing square roots are restored; accelerations are not printed; the angular V_d does not have \
         the unit of an angle and is left out",
    ),
    item(
        "Eq. 23, Table 2",
        "weights of the window",
        Read,
        HYBRID,
        "every term is divided by its sum over the window",
    ),
    item("Table 2", "gains, ranges, time step, iterations", Reproduced, TABLE3, ""),
    item(
        "Fig. 6",
        "a pressure sensor determines the medium, and the robot waits until the medium is known",
        Read,
        "tankops run scenarios/papers/yang-hybrid-free.toml",
        "pressure_sigma_pa and pressure_depth_m; the text gives neither noise nor threshold: a sequential \
         test decides",
    ),
    item("Fig. 6", "transition of 20 steps", Reproduced, HYBRID, ""),
    item(
        "Table 3, 7a, 7b",
        "14.1421 m",
        Reproduced,
        "tankops reproduce yang-table3 --case case1",
        "any free path from (0, 0) to (10, 10) has this length",
    ),
    item("Table 3, 8b, 9b", "9.7637 and 8.9057 m", Fitted, TABLE3, "the layouts were tuned to the lengths"),
    item(
        "Table 3, 8a, 9a",
        "11.0143 and 17.8513 m in runs that fail",
        Missed,
        TABLE3,
        "our runs are 9.57 and 8.71 m long; the printed values fit neither fixed nor proportional steps",
    ),
    item("Table 4, 10b, 11b", "4.1231 and 4.4283 m", Fitted, TABLE4, "the layouts were tuned to the lengths"),
    item(
        "Table 4, 10a, 11a",
        "2.6717 and 1.3853 m in runs that fail",
        Missed,
        TABLE4,
        "our runs oscillate over a length of 19.7 and 19.8 m",
    ),
    item(
        "Tables 3, 4",
        "0.54 to 0.82 s",
        Reproduced,
        TABLE3,
        "our plans take less than a millisecond; the claimed speed advantage of the improved field is \
         within noise",
    ),
    item(
        "Claim",
        "the improved field solves both problems",
        Read,
        "tankops reproduce trap-suite --method apf-virtual-goals",
        "true near single obstacles; it does not escape from a U, triangle or double trap",
    ),
    item(
        "Figs 12 to 15 (a)",
        "the robot reaches the goal in all four runs",
        Missed,
        "tankops reproduce yang-hybrid --method apf-dwa/square",
        "true in 97 % of random layouts, and in 82 % with a block across the way; true in all of them if \
         the virtual goals are the corners of the shortest path (ours)",
    ),
    item(
        "Claim",
        "the transition matters in a trap",
        Missed,
        HYBRID,
        "over 200 layouts the paper's virtual goals show no effect; ours show a small one (4 and 19 steps)",
    ),
    item(
        "Figs 12 to 15 (b)",
        "ten distances, safety limit",
        Read,
        "tankops reproduce yang-distances --svg distances",
        "the paper shows one layout per group, without coordinates; ours are random",
    ),
    item(
        "Fig. 12 (a)",
        "path over a floor with depth",
        Absent,
        "",
        "in the plane only; no numerical result uses the third dimension",
    ),
    item(
        "Sec. 4",
        "unknown floor, sensed on the way",
        Ours,
        "tankops reproduce trap-suite --case u --method shortest",
        "our corners of the shortest path are planned on the drawing; shortest and navfn plan on unknown \
         floors",
    ),
    item(
        "Scenarios",
        "the paper's method, and ours",
        Read,
        "tankops run scenarios/papers/yang-hybrid-block.toml",
        "yang-hybrid-block-ours.toml uses the corners of the shortest path",
    ),
];
