//! A parameter as a number from 0 to 1.

use mission::{ParamKind, ParamValue, Parameters, PlannerInfo};

/// Ratio of the ends of a range above which the range is searched by orders of magnitude.
const WIDE: f64 = 100.0;

/// The range of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scale {
    /// The key of the parameter.
    pub key: String,
    low: f64,
    high: f64,
    default: f64,
    is_wide: bool,
}

impl Scale {
    /// The range of a planner's parameter.
    ///
    /// # Errors
    /// No parameter has this name, or it is not a real number.
    pub(super) fn of(planner: &PlannerInfo, key: &str) -> Result<Self, String> {
        let floats = || planner.parameters.iter().filter(|p| matches!(p.kind, ParamKind::Float { .. }));
        let Some(info) = planner.parameters.iter().find(|info| info.key == key) else {
            let known: Vec<&str> = floats().map(|info| info.key.as_str()).collect();
            return Err(format!(
                "planner {} has no parameter `{key}`; it has {}",
                planner.id,
                known.join(", ")
            ));
        };
        let ParamKind::Float { min, max, default } = info.kind else {
            return Err(format!(
                "parameter `{key}` is not a real number and cannot be tuned; set it with --set"
            ));
        };
        let is_wide = min > 0.0 && max / min > WIDE;
        Ok(Self { key: key.to_owned(), low: min, high: max, default, is_wide })
    }

    /// Returns the value at a share of the range, 0 to 1.
    pub(super) fn value(&self, share: f64) -> f64 {
        let value = if self.is_wide {
            self.low * (self.high / self.low).powf(share)
        } else {
            self.low + (self.high - self.low) * share
        };
        value.clamp(self.low, self.high)
    }

    /// Returns the position of a value in the range, as a share.
    pub(super) fn share(&self, parameters: &Parameters) -> f64 {
        let value = match parameters.get(&self.key) {
            Some(ParamValue::Float(value)) => *value,
            Some(ParamValue::Int(value)) => *value as f64,
            _ => self.default,
        };
        let share = if self.is_wide {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        share.clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::ParamInfo;

    fn planner() -> PlannerInfo {
        let info = |key: &str, kind| ParamInfo {
            key: key.into(),
            label: String::new(),
            unit: String::new(),
            help: String::new(),
            group: String::new(),
            kind,
            live: true,
        };
        PlannerInfo {
            id: "p".into(),
            name: String::new(),
            version: String::new(),
            about: String::new(),
            plugin: String::new(),
            sha256: String::new(),
            abi: String::new(),
            covers: false,
            snapshots: false,
            sandbox: None,
            parameters: vec![
                info("gain", ParamKind::Float { min: 0.001, max: 1000.0, default: 1.0 }),
                info("range_m", ParamKind::Float { min: 0.0, max: 4.0, default: 1.0 }),
                info("fast", ParamKind::Flag { default: false }),
            ],
        }
    }

    #[test]
    fn wide_ranges_are_searched_by_orders_of_magnitude() {
        let gain = Scale::of(&planner(), "gain").expect("a real number");
        assert!(
            (gain.share(&Parameters::new()) - 0.5).abs() < 1e-12 && (gain.value(0.5) - 1.0).abs() < 1e-12
        );
        let range = Scale::of(&planner(), "range_m").expect("a real number");
        assert!(
            (range.share(&Parameters::new()) - 0.25).abs() < 1e-12 && (range.value(0.25) - 1.0).abs() < 1e-12
        );
    }

    #[test]
    fn what_cannot_be_tuned_is_refused_with_what_can() {
        let unknown = Scale::of(&planner(), "gian").expect_err("no such parameter");
        assert!(unknown.contains("gain, range_m"), "{unknown}");
        assert!(Scale::of(&planner(), "fast").expect_err("a flag").contains("--set"));
    }
}
