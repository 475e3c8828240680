//! The printed values of Wang et al. 2023.

/// Precision, recall and root mean square error of one method on one distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Printed {
    /// P, 0 to 1.
    pub precision: f64,
    /// R, 0 to 1.
    pub recall: f64,
    /// Root mean square error, metres.
    pub rmse_m: f64,
}

const fn printed(precision_pct: f64, recall_pct: f64, rmse_e2: f64) -> Printed {
    Printed { precision: precision_pct / 100.0, recall: recall_pct / 100.0, rmse_m: rmse_e2 / 100.0 }
}

/// Table 1, VT, IAPF and RPF; the error is printed multiplied by one hundred, contrary to the heading of the table.
pub(super) const TABLE1_CLASSIC: [[Printed; 3]; 3] = [
    [printed(71.07, 66.94, 34.79), printed(84.07, 80.30, 26.38), printed(91.68, 88.09, 14.23)],
    [printed(77.28, 72.79, 30.23), printed(86.02, 81.51, 16.19), printed(92.78, 89.79, 14.17)],
    [printed(77.53, 72.99, 26.64), printed(86.55, 82.12, 15.63), printed(92.55, 90.27, 13.08)],
];

/// Table 1, VT, IAPF and RPF with improved repulsion.
pub(super) const TABLE1_IMPROVED: [[Printed; 3]; 3] = [
    [printed(83.33, 75.66, 33.53), printed(90.25, 85.91, 22.21), printed(94.08, 91.16, 13.70)],
    [printed(85.78, 77.96, 29.48), printed(91.94, 87.08, 13.97), printed(94.54, 91.64, 12.17)],
    [printed(86.04, 78.16, 28.63), printed(92.11, 87.20, 13.65), printed(95.06, 91.76, 11.39)],
];

/// The values of Table 1 for a method, given its id such as `rpf/K1+ir`, and a column.
pub(super) fn table1(id: &str, column: usize) -> Option<Printed> {
    let rows = if id.ends_with("+ir") { TABLE1_IMPROVED } else { TABLE1_CLASSIC };
    let planner = id.trim_end_matches("+ir").split('/').next()?;
    let row = ["vt", "iapf", "rpf"].iter().position(|known| *known == planner)?;
    Some(rows[row][column])
}

/// Sec. 3.2: time of a plan of RPF and of IAPF with improved repulsion in MATLAB, milliseconds.
pub(super) const PLAN_TIME_MS: [(&str, f64); 2] = [("rpf/gated+ir", 400.0), ("iapf+ir", 380.0)];

/// Table 2: attraction gain, equal to the rotation gain; the repulsion gain is 100.
pub(super) const TABLE2_K_ATT: [f64; 7] = [100.0, 150.0, 200.0, 225.0, 250.0, 275.0, 300.0];
/// Table 2: range of obstacles, metres.
pub(super) const TABLE2_RHO_0_M: [f64; 4] = [1.5, 2.0, 2.5, 3.0];

/// Table 2, by range and gain; `None` where planning failed.
pub(super) const TABLE2: [[Option<Printed>; 7]; 4] = [
    [
        None,
        None,
        Some(printed(86.91, 78.81, 28.58)),
        Some(printed(86.39, 78.44, 28.45)),
        Some(printed(85.96, 78.36, 28.81)),
        Some(printed(86.22, 78.32, 28.18)),
        Some(printed(86.26, 78.32, 27.39)),
    ],
    [
        None,
        None,
        Some(printed(86.97, 79.25, 28.16)),
        Some(printed(87.18, 79.05, 26.38)),
        Some(printed(87.19, 79.17, 26.27)),
        Some(printed(87.40, 79.25, 25.88)),
        Some(printed(87.12, 79.17, 26.28)),
    ],
    [
        None,
        Some(printed(86.60, 78.52, 28.78)),
        Some(printed(88.07, 79.85, 26.50)),
        Some(printed(87.38, 79.41, 26.26)),
        Some(printed(87.24, 79.49, 26.51)),
        Some(printed(87.46, 79.41, 25.51)),
        Some(printed(87.35, 79.45, 26.11)),
    ],
    [
        None,
        Some(printed(87.45, 79.33, 29.28)),
        Some(printed(87.78, 79.77, 25.98)),
        Some(printed(87.35, 79.45, 26.05)),
        Some(printed(87.25, 79.57, 26.78)),
        Some(printed(87.56, 79.57, 25.62)),
        Some(printed(87.31, 79.41, 25.61)),
    ],
];

/// Thresholds of Fig. 8, metres.
pub(super) const FIG8_T0_M: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];

/// Fig. 8 has no numbers; the text's differences at T0 = 0 and the point counts of Table 1 give these precisions on
/// the first distribution.
pub(super) const FIG8_IMPLIED: [(&str, f64); 2] = [("vt", 0.321), ("vt+ir", 0.515)];

#[cfg(test)]
mod tests {
    use super::*;

    fn mean_rmse_m(row: [Printed; 3]) -> f64 {
        row.iter().map(|cell| cell.rmse_m).sum::<f64>() / 3.0
    }

    #[test]
    fn the_claimed_reduction_of_the_error_divides_by_the_wrong_value() {
        let (iapf, rpf) = (mean_rmse_m(TABLE1_CLASSIC[1]), mean_rmse_m(TABLE1_CLASSIC[2]));
        assert!((1.0 - rpf / iapf - 0.0865).abs() < 5e-4, "of the old value");
        assert!((iapf / rpf - 1.0 - 0.0949).abs() < 5e-4, "as printed, of the new value");
    }

    #[test]
    fn a_method_has_the_line_of_its_planner_whatever_its_reading() {
        assert_eq!(table1("rpf/K1+ir", 1), Some(TABLE1_IMPROVED[2][1]));
        assert_eq!(table1("vt", 0), Some(TABLE1_CLASSIC[0][0]));
        assert_eq!(table1("apf", 0), None);
    }

    #[test]
    fn every_printed_recall_is_a_count_of_2477_points() {
        let cells = TABLE1_CLASSIC.iter().chain(&TABLE1_IMPROVED).flatten().copied();
        for cell in cells.chain(TABLE2.iter().flatten().flatten().copied()) {
            let correct = (cell.recall * 2477.0).round();
            assert!((correct / 2477.0 - cell.recall).abs() < 0.6e-4, "{cell:?}");
        }
    }
}
