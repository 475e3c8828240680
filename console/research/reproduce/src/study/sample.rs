//! Statistics of many values.

/// Values of one figure over many layouts or draws.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Sample {
    sorted: Vec<f64>,
}

impl FromIterator<f64> for Sample {
    /// Values that are not finite are ignored; [`Sample::len`] gives the number of values used.
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut sorted: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        Self { sorted }
    }
}

impl Sample {
    /// Number of values.
    pub(crate) fn len(&self) -> usize {
        self.sorted.len()
    }

    /// Whether there are no values.
    pub(crate) fn is_empty(&self) -> bool {
        self.sorted.is_empty()
    }

    /// Mean; summed in order of size, so that the order of the values does not matter.
    pub(crate) fn mean(&self) -> Option<f64> {
        (!self.is_empty()).then(|| self.sorted.iter().sum::<f64>() / self.len() as f64)
    }

    /// Median.
    pub(crate) fn median(&self) -> Option<f64> {
        self.quantile(0.5)
    }

    /// The quantile at a share, 0 to 1, interpolated.
    pub(crate) fn quantile(&self, share: f64) -> Option<f64> {
        let at = share.clamp(0.0, 1.0) * self.len().checked_sub(1)? as f64;
        let (low, high) = (self.sorted[at.floor() as usize], self.sorted[at.ceil() as usize]);
        Some(low + (high - low) * at.fract())
    }

    /// Least value.
    pub(crate) fn min(&self) -> Option<f64> {
        self.sorted.first().copied()
    }

    /// Largest value.
    pub(crate) fn max(&self) -> Option<f64> {
        self.sorted.last().copied()
    }

    /// Standard deviation of the values, with n - 1.
    pub(crate) fn standard_deviation(&self) -> Option<f64> {
        let mean = self.mean().filter(|_| self.len() > 1)?;
        let squares: f64 = self.sorted.iter().map(|value| (value - mean).powi(2)).sum();
        Some((squares / (self.len() - 1) as f64).sqrt())
    }

    /// 95 % confidence interval of the mean, by the normal distribution.
    pub(crate) fn mean_interval_95(&self) -> Option<[f64; 2]> {
        let (mean, margin) = self.mean().zip(self.mean_margin_95())?;
        Some([mean - margin, mean + margin])
    }

    /// The range that contains 95 % of the values; `None` for fewer than forty.
    pub(crate) fn range_95(&self) -> Option<[f64; 2]> {
        const FEWEST: usize = 40;
        let range = || Some([self.quantile(0.025)?, self.quantile(0.975)?]);
        (self.len() >= FEWEST).then(range)?
    }

    /// 95 % confidence interval of the median, by the ranks of the values; `None` for fewer than six.
    pub(crate) fn median_interval_95(&self) -> Option<[f64; 2]> {
        const FEWEST: usize = 6;
        let n = self.len();
        let (middle, half) = (n as f64 / 2.0, 0.98 * (n as f64).sqrt());
        let (low, high) = ((middle - half).floor().max(0.0) as usize, (middle + half).ceil() as usize);
        (n >= FEWEST).then(|| [self.sorted[low], self.sorted[high.min(n - 1)]])
    }

    /// Half width of the 95 % confidence interval of the mean, by the normal distribution.
    pub(crate) fn mean_margin_95(&self) -> Option<f64> {
        Some(1.96 * self.standard_deviation()? / (self.len() as f64).sqrt())
    }
}

/// 95 % jackknife interval of a figure of `n` draws, from the values of the figure when each draw in turn is left out.
pub(crate) fn jackknife_95(
    figure: f64,
    n: usize,
    without: impl Fn(Option<usize>) -> Option<f64>,
) -> Option<[f64; 2]> {
    let others: Vec<f64> = (0..n).filter_map(|index| without(Some(index))).collect();
    let mean = others.iter().copied().collect::<Sample>().mean().filter(|_| n > 1 && others.len() == n)?;
    let squares: f64 = others.iter().map(|other| (other - mean).powi(2)).sum();
    let half = 1.96 * (squares * (n - 1) as f64 / n as f64).sqrt();
    Some([figure - half, figure + half])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_figures_of_four_values_are_known() {
        let sample: Sample = [4.0, 1.0, 3.0, 2.0, f64::NAN].into_iter().collect();
        assert_eq!(sample.len(), 4);
        assert_eq!((sample.mean(), sample.median()), (Some(2.5), Some(2.5)));
        assert_eq!((sample.min(), sample.max()), (Some(1.0), Some(4.0)));
        assert_eq!(sample.quantile(1.0 / 3.0), Some(2.0));
        let deviation = sample.standard_deviation().expect("four values");
        assert!((deviation - (5.0_f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn intervals_hold_what_they_are_of() {
        let sample: Sample = (0..100).map(f64::from).collect();
        let [low, high] = sample.mean_interval_95().expect("many values");
        assert!((low - 43.8).abs() < 0.1 && (high - 55.2).abs() < 0.1, "{low} {high}");
        assert_eq!(sample.median_interval_95(), Some([40.0, 60.0]));
        assert_eq!([1.0; 5].into_iter().collect::<Sample>().median_interval_95(), None);
    }

    #[test]
    fn nothing_has_no_figures() {
        let sample = Sample::default();
        assert!(sample.is_empty());
        assert_eq!([sample.mean(), sample.median(), sample.max(), sample.mean_margin_95()], [None; 4]);
    }

    #[test]
    fn the_interval_of_a_mean_without_each_value_is_that_of_the_mean() {
        let values = [1.0, 2.0, 4.0, 9.0];
        let mean = |without: Option<usize>| {
            let kept = values.iter().enumerate().filter(|(index, _)| Some(*index) != without);
            kept.map(|(_, value)| *value).collect::<Sample>().mean()
        };
        let margin = values.into_iter().collect::<Sample>().mean_margin_95().expect("four values");
        let [low, high] = jackknife_95(4.0, 4, mean).expect("four values");
        assert!((low - 4.0 + margin).abs() < 1e-9 && (high - 4.0 - margin).abs() < 1e-9, "{low} {high}");
        assert_eq!(jackknife_95(4.0, 1, |_| Some(4.0)), None);
    }
}
