//! Planner parameters as the operator reads and types them.

use mission::{ParamInfo, ParamKind, ParamValue, PlannerChoice, PlannerInfo};

/// The value of a planner parameter: the value set by hand or, if none is set, the default.
pub fn value(choice: Option<&PlannerChoice>, info: &ParamInfo) -> ParamValue {
    let by_hand = choice.and_then(|choice| choice.parameters.get(&info.key));
    by_hand.cloned().unwrap_or_else(|| default(&info.kind))
}

/// The default value.
pub fn default(kind: &ParamKind) -> ParamValue {
    match kind {
        ParamKind::Float { default, .. } => ParamValue::Float(*default),
        ParamKind::Int { default, .. } => ParamValue::Int(*default),
        ParamKind::Flag { default } => ParamValue::Flag(*default),
        ParamKind::Choice { default, .. } => ParamValue::Word(default.clone()),
    }
}

/// A change of a parameter: `rho_0_m 0.6 → 1.1 m`.
pub fn change(
    planner: Option<&PlannerInfo>,
    choice: Option<&PlannerChoice>,
    key: &str,
    then: &ParamValue,
) -> String {
    let shown = with_unit(planner, key, then);
    match find(planner, key) {
        Some(info) => format!("{key} {} → {shown}", value(choice, info)),
        None => format!("{key} to {shown}"),
    }
}

/// A value of a parameter with its unit, if it has one.
pub fn with_unit(planner: Option<&PlannerInfo>, key: &str, value: &ParamValue) -> String {
    match find(planner, key) {
        Some(info) if !info.unit.is_empty() => format!("{value} {}", info.unit),
        _ => value.to_string(),
    }
}

/// The number of parameters whose values differ from their defaults.
pub fn changed(planner: &PlannerInfo, choice: Option<&PlannerChoice>) -> usize {
    planner.parameters.iter().filter(|info| value(choice, info) != default(&info.kind)).count()
}

/// The parameter of a planner with this key.
pub fn find<'a>(planner: Option<&'a PlannerInfo>, key: &str) -> Option<&'a ParamInfo> {
    planner?.parameters.iter().find(|info| info.key == key)
}

/// The permitted values, in words.
pub fn range(info: &ParamInfo) -> String {
    let unit = if info.unit.is_empty() { String::new() } else { format!(" {}", info.unit) };
    match &info.kind {
        ParamKind::Float { min, max, .. } => format!("{min} to {max}{unit}"),
        ParamKind::Int { min, max, .. } => format!("integer, {min} to {max}{unit}"),
        ParamKind::Flag { .. } => "true or false".into(),
        ParamKind::Choice { options, .. } => options.join(", "),
    }
}

/// The unit, as shown in a table column.
pub fn unit(info: &ParamInfo) -> &str {
    if info.unit.is_empty() { "-" } else { &info.unit }
}

/// Parses a typed value.
///
/// # Errors
/// Returns what is wrong and how to correct it, as a sentence.
pub fn parse(info: &ParamInfo, text: &str) -> Result<ParamValue, String> {
    let text = text.trim();
    let wrong = |what: &str| Err(format!("{what}; allowed: {}", range(info)));
    let beyond = || wrong(&format!("{text} is out of range"));
    match &info.kind {
        _ if text.is_empty() => wrong("no value entered"),
        ParamKind::Float { min, max, .. } => match text.parse::<f64>() {
            Ok(number) if (*min..=*max).contains(&number) => Ok(ParamValue::Float(number)),
            Ok(_) => beyond(),
            Err(_) => wrong(&format!("`{text}` is not a number")),
        },
        ParamKind::Int { min, max, .. } => match text.parse::<i64>() {
            Ok(number) if (*min..=*max).contains(&number) => Ok(ParamValue::Int(number)),
            Ok(_) => beyond(),
            Err(_) => wrong(&format!("`{text}` is not an integer")),
        },
        ParamKind::Flag { .. } => match text {
            "true" | "on" | "yes" => Ok(ParamValue::Flag(true)),
            "false" | "off" | "no" => Ok(ParamValue::Flag(false)),
            _ => wrong(&format!("`{text}` is not true or false")),
        },
        ParamKind::Choice { options, .. } => match options.iter().find(|option| *option == text) {
            Some(word) => Ok(ParamValue::Word(word.clone())),
            None => wrong(&format!("`{text}` is not an option")),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info(kind: ParamKind) -> ParamInfo {
        ParamInfo {
            key: "k_rep".into(),
            label: "Repulsion gain".into(),
            unit: "m3/s".into(),
            help: String::new(),
            group: String::new(),
            kind,
            live: true,
        }
    }

    #[test]
    fn a_value_out_of_range_is_refused_with_the_range() {
        let gain = info(ParamKind::Float { min: 0.0, max: 10.0, default: 0.4 });
        assert_eq!(parse(&gain, "1.2"), Ok(ParamValue::Float(1.2)));
        assert_eq!(parse(&gain, "12"), Err("12 is out of range; allowed: 0 to 10 m3/s".into()));
        assert_eq!(parse(&gain, "NaN"), Err("NaN is out of range; allowed: 0 to 10 m3/s".into()));
        assert_eq!(parse(&gain, "much"), Err("`much` is not a number; allowed: 0 to 10 m3/s".into()));
    }

    #[test]
    fn words_and_flags_are_read_by_name() {
        let mode = info(ParamKind::Choice {
            options: vec!["literal".into(), "gated".into()],
            default: "gated".into(),
        });
        assert_eq!(parse(&mode, "literal"), Ok(ParamValue::Word("literal".into())));
        assert!(parse(&mode, "other").is_err_and(|why| why.contains("literal, gated")));
        assert_eq!(parse(&info(ParamKind::Flag { default: true }), "off"), Ok(ParamValue::Flag(false)));
        assert!(parse(&info(ParamKind::Int { min: 0, max: 4, default: 2 }), "2.5").is_err());
    }
}
