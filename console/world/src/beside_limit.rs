//! Figures beside their limits.

/// The most decimals with which a figure is told from its limit.
const MOST_DECIMALS: usize = 9;

/// A figure and its limit as text, with the given number of decimals, or with as many more as show on which side of the
/// limit the figure is. Both have the same number of decimals.
///
/// ```
/// use world::beside_limit;
/// assert_eq!(beside_limit(0.31, 0.25, 2), ["0.31", "0.25"]);
/// assert_eq!(beside_limit(0.2504, 0.25, 2), ["0.2504", "0.2500"]);
/// assert_eq!(beside_limit(0.25, 0.25, 2), ["0.25", "0.25"]);
/// ```
pub fn beside_limit(figure: f64, limit: f64, decimals: usize) -> [String; 2] {
    let written = |decimals: usize| [figure, limit].map(|value| format!("{value:.decimals$}"));
    let tells = |[figure, limit]: &[String; 2]| figure != limit;
    let is_apart = figure.is_finite() && limit.is_finite() && (figure - limit).abs() > 0.0;
    let more = (decimals..=MOST_DECIMALS).filter(|_| is_apart).map(written).find(tells);
    more.unwrap_or_else(|| written(decimals))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn values_that_are_equal_or_not_finite_keep_their_decimals() {
        assert_eq!(beside_limit(120.0, 120.0, 0), ["120", "120"]);
        assert_eq!(beside_limit(f64::NAN, 0.25, 2), ["NaN", "0.25"]);
        assert_eq!(beside_limit(f64::INFINITY, f64::INFINITY, 1), ["inf", "inf"]);
        assert_eq!(beside_limit(0.25, 0.25 + 1e-14, 2), ["0.25", "0.25"], "rounding");
    }

    proptest! {
        #[test]
        fn a_figure_beyond_its_limit_never_reads_like_its_limit(
            limit in 0.01..500.0_f64,
            by in prop_oneof![-1.0..-1e-8_f64, 1e-8..1.0_f64],
            decimals in 0..4_usize,
        ) {
            let [figure, written] = beside_limit(limit + by, limit, decimals);
            prop_assert_ne!(&figure, &written);
            let [read, read_limit]: [f64; 2] = [figure.parse().unwrap(), written.parse().unwrap()];
            prop_assert_eq!(read > read_limit, by > 0.0);
            let decimals_of = |text: &str| text.split_once('.').map_or(0, |(_, after)| after.len());
            prop_assert_eq!(decimals_of(&figure), decimals_of(&written));
            prop_assert!(decimals_of(&figure) >= decimals);
            // Never more decimals than are needed.
            let fewer = decimals_of(&figure).saturating_sub(1);
            if fewer >= decimals && decimals_of(&figure) > decimals {
                prop_assert_eq!(format!("{:.fewer$}", limit + by), format!("{limit:.fewer$}"));
            }
        }
    }
}
