//! Wang et al. 2023.

use super::{
    Item, Paper,
    State::{Absent, Fitted, Missed, Ours, Read, Reproduced},
    item,
};

pub(super) const PAPER: Paper = Paper { name: "Wang et al. 2023", items: ITEMS };

const TABLE1: &str = "tankops reproduce wang-table1";
const TABLE3: &str = "tankops reproduce wang-table3";
const PAPER_RUN: &str = "tankops run scenarios/spiral-paper.toml";

const ITEMS: &[Item] = &[
    item(
        "Eq. 1",
        "points of the spiral, and the end of the list",
        Read,
        TABLE1,
        "2,477 points: every printed R is a whole number of 2,477ths",
    ),
    item(
        "Eq. 2, Fig. 1",
        "preset spiral",
        Read,
        PAPER_RUN,
        "as printed, the radius has no index, which gives a circle; interpreted as in section 3.3",
    ),
    item(
        "Sec. 2.1",
        "attraction and repulsion",
        Read,
        TABLE1,
        "neither formula is printed; we use k rho and Khatib's force. The form of the repulsion is open: \
         see Table 1",
    ),
    item(
        "Figs 2 to 4",
        "a local minimum on the spiral, and the failure of APF",
        Reproduced,
        "tankops reproduce wang-table1 --method apf",
        "",
    ),
    item(
        "Eq. 3, Fig. 5",
        "rotating force",
        Read,
        "tankops reproduce wang-table1 --method rpf",
        "if it is always on (literal), it cannot give the printed figures; the text does not say when it \
         acts",
    ),
    item("Fig. 6", "flow chart of the method", Absent, "", "a picture that our copy does not contain"),
    item("Eq. 4 to 9, Fig. 7", "three-point positioning by least squares", Reproduced, TABLE3, ""),
    item(
        "Eq. 10 to 12",
        "P, R and RMSE",
        Read,
        TABLE1,
        "points are paired by index, as in the formulas; NP counts wrong points, and n_max counts planned \
         points",
    ),
    item(
        "Table 1, APF",
        "APF and APF with improved repulsion fail",
        Reproduced,
        "tankops reproduce wang-table1 --method apf",
        "",
    ),
    item(
        "Table 1, IR",
        "improved repulsion",
        Read,
        "tankops reproduce wang-table1",
        "the exponent is not printed; we use 2 by default, as in Ge and Cui, and 0.5 in the \
         interpretations that come near the table",
    ),
    item(
        "Table 1, VT",
        "virtual target of Yang 2018",
        Ours,
        "tankops reproduce wang-table1 --method vt",
        "the source is not available: reconstructed from one sentence",
    ),
    item(
        "Table 1, IAPF",
        "sideways push of Zhao 2022",
        Ours,
        "tankops reproduce wang-table1 --method iapf",
        "the source is not available: reconstructed from one sentence",
    ),
    item(
        "Table 1, RPF",
        "the method as described in the text",
        Missed,
        "tankops reproduce wang-table1 --method rpf/literal",
        "our P is 29/55/80 % in the square as printed; the paper gives 77.5/86.6/92.6 %",
    ),
    item(
        "Table 1",
        "36 cells of IAPF and RPF, without and with IR",
        Fitted,
        "tankops reproduce wang-table1 --case d",
        "the interpretations K0, K1, J0 and J1, chosen to fit this table, differ from its cells by 8 to 10 \
         % on average: compatible, but not evidence",
    ),
    item(
        "Search",
        "random interpretations compared with Table 1, including VT",
        Ours,
        "tankops reproduce wang-search --layouts 100 --out search",
        "can be resumed in the same folder; different seeds (--first-seed) generate different \
         interpretations",
    ),
    item(
        "Claim",
        "RPF has 9.49 % less RMSE than IAPF",
        Missed,
        TABLE1,
        "the paper's own figures give 8.65 %. The sign depends on the side of IAPF's push and on the gate, \
         neither of which the paper states",
    ),
    item(
        "Claim",
        "IR improves all three indicators",
        Missed,
        TABLE1,
        "false in the printed table: RMSE of RPF on the first distribution rises from 0.2664 to 0.2863",
    ),
    item(
        "Fig. 8",
        "P and R as functions of T0",
        Read,
        "tankops reproduce wang-fig8",
        "only two differences are printed; no interpretation reproduces the jump at T0 = 0",
    ),
    item(
        "Figs 9 to 11",
        "paths on three layouts",
        Absent,
        "",
        "no layout is printed; we use random layouts of the same distributions",
    ),
    item(
        "Fig. 12",
        "a second obstacle in range before the first is passed",
        Reproduced,
        "tankops reproduce wang-table1 --method rpf",
        "",
    ),
    item(
        "Table 2",
        "gains and range of RPF",
        Read,
        "tankops reproduce wang-table2",
        "the caption says RPF, but the point counts are those of RPF with IR; equal gains fail here but \
         succeed in Table 1, which is impossible if only the direction of the force matters",
    ),
    item(
        "Sec. 3.2",
        "0.40 s and 0.38 s per plan",
        Reproduced,
        TABLE1,
        "our plans take milliseconds, on a different machine and in a different language",
    ),
    item("Eq. 13, 14", "disturbed ranges, error", Reproduced, TABLE3, ""),
    item(
        "Table 3",
        "error of 12 environments at 5 levels of noise",
        Missed,
        TABLE3,
        "the method as printed gives 1.25 times the printed errors; with E divided by the square root of 2 \
         and points drawn in the square, it agrees (rows parity)",
    ),
    item("Fig. 13", "errors as a picture", Absent, "", "the values are those of Table 3"),
    item(
        "Fig. 14, sec. 3.3",
        "error along the spiral, 0.0748 +- 0.0032",
        Missed,
        "tankops reproduce wang-spiral-fix",
        "the method as printed gives 0.105; dividing by the square root of 2, as in Table 3, gives the \
         printed value",
    ),
    item(
        "Future work",
        "choice of parameters by search",
        Ours,
        "tankops tune --planner rpf --on wang-d1-square",
        "CMA-ES on training layouts, evaluated on others; with --out, a search can be resumed",
    ),
    item(
        "Future work",
        "limits on the heading, flexible step",
        Ours,
        "tankops reproduce spiral-followers",
        "turn_limit_deg and flexible_step; spiral-lattice and spiral-tangent follow the path with a \
         clearance",
    ),
    item(
        "Beyond",
        "estimators with hidden stations, outliers and echoes",
        Ours,
        "tankops reproduce positioning-robust",
        "not in the paper",
    ),
    item(
        "Beyond",
        "the theoretical limit for the same ranges",
        Ours,
        "tankops reproduce positioning-limits",
        "not in the paper",
    ),
    item(
        "Beyond",
        "filters that combine ranges and odometry",
        Ours,
        "tankops reproduce positioning-filter",
        "not in the paper",
    ),
    item(
        "Beyond",
        "protection levels: a radius that covers one wrong station",
        Ours,
        "tankops reproduce integrity",
        "not in the paper",
    ),
    item(
        "Beyond",
        "a wrong speed of sound and a station that goes wrong under way, found by the session",
        Ours,
        "tankops reproduce session-calibration",
        "not in the paper",
    ),
    item(
        "Beyond",
        "the least detectable error of a station, forecast and measured",
        Ours,
        "tankops reproduce detectable",
        "not in the paper",
    ),
];
