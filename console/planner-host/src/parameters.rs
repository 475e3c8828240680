//! Checks parameter values against their declarations: unknown keys, wrong types, ranges.

use mission::{ParamInfo, ParamKind, ParamValue, Parameters, PlannerInfo, spelling::nearest};

/// Checks values set by the user against a planner's parameters.
///
/// # Errors
/// One sentence that states what is wrong and what would be right.
pub fn check_parameters(planner: &PlannerInfo, parameters: &Parameters) -> Result<(), String> {
    parameter_problems(planner, parameters).into_iter().next().map_or(Ok(()), |(_, problem)| Err(problem))
}

/// Returns everything that is wrong with values set by the user: each key, and one sentence that states what is wrong
/// and what would be right.
pub fn parameter_problems(planner: &PlannerInfo, parameters: &Parameters) -> Vec<(String, String)> {
    let problem = |key: &String, value: &ParamValue| {
        find(planner, key).and_then(|param| number(&planner.id, param, value)).err()
    };
    parameters.iter().filter_map(|(key, value)| Some((key.clone(), problem(key, value)?))).collect()
}

/// Checks a planner's declaration of its parameters: keys, ranges, defaults.
pub(crate) fn check(parameters: &[ParamInfo]) -> Result<(), String> {
    for (index, param) in parameters.iter().enumerate() {
        let key = &param.key;
        if key.is_empty() || parameters[..index].iter().any(|earlier| earlier.key == *key) {
            return Err(format!(
                "parameter number {index} has the key `{key}`, which is empty or a duplicate"
            ));
        }
        let is_sound = match &param.kind {
            ParamKind::Float { min, max, default } => {
                min <= default && default <= max && (max - min).is_finite()
            }
            ParamKind::Int { min, max, default } => min <= default && default <= max,
            ParamKind::Flag { .. } => true,
            ParamKind::Choice { options, default } => options.contains(default),
        };
        if !is_sound {
            return Err(format!("the default of parameter `{key}` is outside its range"));
        }
    }
    Ok(())
}

/// Returns all parameters of a planner as numbers: the values set by the user, and the defaults of the others.
pub(crate) fn numbers(planner: &PlannerInfo, parameters: &Parameters) -> Result<Vec<(String, f64)>, String> {
    for key in parameters.keys() {
        find(planner, key)?;
    }
    planner
        .parameters
        .iter()
        .map(|param| {
            let set = parameters.get(&param.key).map(|value| number(&planner.id, param, value));
            Ok((param.key.clone(), set.unwrap_or_else(|| Ok(default_number(&param.kind)))?))
        })
        .collect()
}

/// Finds the parameter with this key.
pub(crate) fn find<'a>(planner: &'a PlannerInfo, key: &str) -> Result<&'a ParamInfo, String> {
    planner.parameters.iter().find(|param| param.key == key).ok_or_else(|| {
        let keys = planner.parameters.iter().map(|param| param.key.as_str());
        let hint = nearest(key, keys).map(|known| format!("; did you mean `{known}`?"));
        let all = || match planner.parameters.as_slice() {
            [] => "; it has no parameters".to_owned(),
            some => {
                format!("; it has {}", some.iter().map(|p| p.key.as_str()).collect::<Vec<_>>().join(", "))
            }
        };
        format!("planner {} has no parameter `{key}`{}", planner.id, hint.unwrap_or_else(all))
    })
}

fn default_number(kind: &ParamKind) -> f64 {
    match kind {
        ParamKind::Float { default, .. } => *default,
        ParamKind::Int { default, .. } => *default as f64,
        ParamKind::Flag { default } => f64::from(u8::from(*default)),
        ParamKind::Choice { options, default } => {
            options.iter().position(|word| word == default).unwrap_or(0) as f64
        }
    }
}

fn number(planner: &str, param: &ParamInfo, value: &ParamValue) -> Result<f64, String> {
    let wrong = |takes: String| Err(format!("parameter `{}` of planner {planner} takes {takes}", param.key));
    match (&param.kind, value) {
        (ParamKind::Float { min, max, .. }, ParamValue::Float(x)) => in_range(planner, param, *x, *min, *max),
        (ParamKind::Float { min, max, .. }, ParamValue::Int(n)) => {
            in_range(planner, param, *n as f64, *min, *max)
        }
        (ParamKind::Int { min, max, .. }, ParamValue::Int(n)) => {
            in_range(planner, param, *n as f64, *min as f64, *max as f64)
        }
        (ParamKind::Flag { .. }, ParamValue::Flag(on)) => Ok(f64::from(u8::from(*on))),
        // A word may look like a value of a different type: `true`, `1`.
        (ParamKind::Choice { options, .. }, value) => {
            let word = &value.to_string();
            if let Some(index) = options.iter().position(|known| known == word) {
                return Ok(index as f64);
            }
            let hint = nearest(word, options.iter().map(String::as_str));
            let hint = hint.map(|known| format!("; did you mean `{known}`?")).unwrap_or_default();
            wrong(format!("one of {}, not `{word}`{hint}", options.join(", ")))
        }
        (ParamKind::Float { .. }, other) => wrong(format!("a number, not `{other}`")),
        (ParamKind::Int { .. }, other) => wrong(format!("a whole number, not `{other}`")),
        (ParamKind::Flag { .. }, other) => wrong(format!("true or false, not `{other}`")),
    }
}

fn in_range(planner: &str, param: &ParamInfo, x: f64, min: f64, max: f64) -> Result<f64, String> {
    if min <= x && x <= max {
        return Ok(x);
    }
    let unit = if param.unit.is_empty() { String::new() } else { format!(" {}", param.unit) };
    Err(format!("parameter `{}` of planner {planner} takes {min} to {max}{unit}, not {x}", param.key))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::info;

    fn param(key: &str, unit: &str, kind: ParamKind) -> ParamInfo {
        let [key, unit] = [key, unit].map(str::to_owned);
        ParamInfo {
            key,
            label: String::new(),
            unit,
            help: String::new(),
            group: String::new(),
            kind,
            live: false,
        }
    }

    fn planner() -> PlannerInfo {
        let words = ["literal", "gated"].map(str::to_owned);
        PlannerInfo {
            parameters: vec![
                param("k_rep", "m3/s", ParamKind::Float { min: 0.0, max: 10.0, default: 0.4 }),
                param("n", "", ParamKind::Int { min: 0, max: 4, default: 2 }),
                param("improved", "", ParamKind::Flag { default: true }),
                param("mode", "", ParamKind::Choice { options: words.into(), default: "gated".into() }),
            ],
            ..info()
        }
    }

    fn refused(key: &str, value: ParamValue) -> String {
        check_parameters(&planner(), &Parameters::from([(key.to_owned(), value)])).expect_err("refused")
    }

    #[test]
    fn what_is_not_set_takes_its_default() {
        let set = Parameters::from([
            ("k_rep".to_owned(), ParamValue::Int(3)),
            ("mode".to_owned(), ParamValue::Word("literal".into())),
        ]);
        let numbers = numbers(&planner(), &set).expect("valid");
        let expected = [("k_rep", 3.0), ("n", 2.0), ("improved", 1.0), ("mode", 0.0)];
        assert_eq!(numbers, expected.map(|(key, number)| (key.to_owned(), number)));
    }

    #[test]
    fn a_misspelt_key_names_the_nearest_one() {
        let message = refused("k_rpe", ParamValue::Int(1));
        assert_eq!(message, "planner apf has no parameter `k_rpe`; did you mean `k_rep`?");
        let message = refused("colour", ParamValue::Int(1));
        assert_eq!(message, "planner apf has no parameter `colour`; it has k_rep, n, improved, mode");
    }

    #[test]
    fn a_value_out_of_range_names_range_and_unit() {
        let message = refused("k_rep", ParamValue::Float(12.5));
        assert_eq!(message, "parameter `k_rep` of planner apf takes 0 to 10 m3/s, not 12.5");
        assert!(refused("k_rep", ParamValue::Float(f64::NAN)).ends_with("not NaN"));
        assert_eq!(refused("n", ParamValue::Int(-1)), "parameter `n` of planner apf takes 0 to 4, not -1");
    }

    #[test]
    fn a_word_may_look_like_a_flag_or_a_number() {
        let options = ["off", "true", "1", "nan"].map(str::to_owned);
        let kind = ParamKind::Choice { options: options.into(), default: "off".into() };
        let planner = PlannerInfo { parameters: vec![param("mode", "", kind)], ..info() };
        let index = |value| {
            let set = Parameters::from([("mode".to_owned(), value)]);
            numbers(&planner, &set).map(|values| values[0].1)
        };
        assert_eq!(index(ParamValue::Flag(true)), Ok(1.0));
        assert_eq!(index(ParamValue::Int(1)), Ok(2.0));
        assert_eq!(index(ParamValue::Word("nan".into())), Ok(3.0));
        assert!(index(ParamValue::Flag(false)).expect_err("no word").contains("not `false`"));
    }

    #[test]
    fn a_value_of_the_wrong_type_names_the_right_one() {
        let takes = |key, value| refused(key, value).split_once(" takes ").expect("takes").1.to_owned();
        assert_eq!(takes("n", ParamValue::Float(2.5)), "a whole number, not `2.5`");
        assert_eq!(takes("k_rep", ParamValue::Word("much".into())), "a number, not `much`");
        assert_eq!(takes("improved", ParamValue::Int(1)), "true or false, not `1`");
        let misspelt = takes("mode", ParamValue::Word("gatet".into()));
        assert_eq!(misspelt, "one of literal, gated, not `gatet`; did you mean `gated`?");
    }
}
