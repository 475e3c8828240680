//! Percentages that sum to 100.

/// Returns shares as percentages with one decimal; they sum to 100.0 if the shares sum to 1 (largest remainder
/// method).
///
/// The first share is rounded to nearest, so that it is the same as when printed alone ([`percent`]), but never up to
/// 100.0 while any other share is above zero. The others are rounded down, and the missing tenths go to those with the
/// largest remainders.
///
/// ```
/// use world::coverage::percents;
/// assert_eq!(percents([1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]), [33.3, 33.4, 33.3]);
/// ```
pub fn percents<const N: usize>(shares: [f64; N]) -> [f64; N] {
    let exact = shares.map(|share| share * 1000.0);
    let mut parts = exact.map(|part| (part + 1e-9).floor());
    let Some(first) = parts.first_mut() else { return shares };
    *first = (exact[0] + 1e-9).round();
    let is_all = exact[1..].iter().all(|part| *part <= 1e-9);
    if *first >= 1000.0 && !is_all {
        *first = 999.0;
    }
    let lacking = (exact.iter().sum::<f64>().round() - parts.iter().sum::<f64>()).max(0.0) as usize;
    let mut order: Vec<usize> = (1..N).collect();
    order.sort_by(|a, b| (exact[*b] - parts[*b]).total_cmp(&(exact[*a] - parts[*a])));
    order.into_iter().take(lacking).for_each(|index| parts[index] += 1.0);
    parts.map(|part| part / 10.0)
}

/// Returns a share as it is printed on its own: in per cent with one decimal, and 100.0 only if the share is complete.
///
/// ```
/// use world::coverage::percent;
/// assert_eq!([0.5, 0.9999, 1.0].map(percent), [50.0, 99.9, 100.0]);
/// ```
pub fn percent(share: f64) -> f64 {
    percents([share, 1.0 - share])[0]
}

/// Formats a share in per cent with the given number of decimals, as 100 only if the share is complete.
///
/// ```
/// use world::coverage::percent_text;
/// assert_eq!(percent_text(0.999_96, 2), "99.99");
/// assert_eq!(percent_text(0.999_96, 1), "99.9");
/// assert_eq!([percent_text(0.996, 0), percent_text(1.0, 0), percent_text(0.125, 1)], ["99", "100", "12.5"]);
/// ```
pub fn percent_text(share: f64, decimals: usize) -> String {
    let rounded = format!("{:.decimals$}", 100.0 * share);
    let is_all = share >= 1.0 - 1e-12;
    if is_all || rounded.parse::<f64>().is_ok_and(|percent| percent < 100.0) {
        return rounded;
    }
    let finest = 10_f64.powi(-(decimals.min(12) as i32));
    format!("{:.decimals$}", 100.0 - finest)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_cmp, reason = "tenths are exact")]

    use super::*;
    use proptest::prelude::*;

    fn tenths(percents: &[f64]) -> u32 {
        percents
            .iter()
            .map(|percent| format!("{percent:.1}").replace('.', "").parse::<u32>().expect("a number"))
            .sum()
    }

    #[test]
    fn thirds_sum_to_a_hundred() {
        assert_eq!(tenths(&percents([1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0])), 1000);
        assert_eq!(percents([1.0, 0.0]).map(|percent| percent as u32), [100, 0]);
    }

    #[test]
    fn what_is_not_whole_never_reads_as_whole() {
        assert_eq!(percents([0.9997, 0.0003, 0.0, 0.0]), [99.9, 0.1, 0.0, 0.0]);
        assert_eq!(percents([1.0, 0.0]), [100.0, 0.0]);
    }

    proptest! {
        #[test]
        fn whatever_is_divided_sums_to_a_hundred_as_it_is_printed(
            parts in prop::array::uniform4(0_u32..50_000), many in 0_u32..5_000_000,
        ) {
            let parts = [parts[0] + many, parts[1], parts[2], parts[3]];
            let whole: u32 = parts.iter().sum();
            prop_assume!(whole > 0);
            let shares = parts.map(|part| f64::from(part) / f64::from(whole));
            let rounded = percents(shares);
            prop_assert_eq!(tenths(&rounded), 1000, "{:?}", rounded);
            prop_assert!((rounded[0] - 100.0 * shares[0]).abs() < 0.05 + 1e-6 || rounded[0] == 99.9);
            prop_assert!((rounded[0] >= 100.0) == (parts[1..] == [0, 0, 0]));
            prop_assert_eq!(rounded[0], percent(shares[0]));
            for (share, percent) in shares.iter().zip(&rounded) {
                prop_assert!(*percent >= 0.0 && (percent - 100.0 * share).abs() < 0.1 + 1e-6);
            }
        }

        #[test]
        fn scanned_and_missed_sum_to_a_hundred(part in 0_u32..1_000_001) {
            let share = f64::from(part) / 1e6;
            prop_assert_eq!(tenths(&percents([share, 1.0 - share])), 1000);
        }
    }
}
