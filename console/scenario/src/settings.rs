//! Applies settings from the command line to the text of a scenario.

use super::problem::Complaint;
use std::fmt;
use toml_edit::{DocumentMut, InlineTable, Item, Table, Value};

/// Top-level keys that `--set` accepts by their bare names; other bare names are planner parameters.
const TOP_KEYS: [&str; 3] = ["name", "about", "seed"];

/// Changes to a scenario from the command line.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Settings {
    /// `--set KEY=VALUE`, in order; a bare key is a planner parameter.
    pub set: Vec<String>,
    /// `--planner ID`; if the file names a different planner, its parameters are dropped.
    pub planner: Option<String>,
    /// `--seed N`.
    pub seed: Option<u64>,
}

impl fmt::Display for Settings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let planner = self.planner.iter().map(|id| format!("--planner {id}"));
        let seed = self.seed.iter().map(|seed| format!("--seed {seed}"));
        let set = self.set.iter().map(|setting| format!("--set {setting}"));
        f.write_str(&planner.chain(seed).chain(set).collect::<Vec<_>>().join(" "))
    }
}

impl Settings {
    /// Whether there are no changes.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The text with the settings applied: first the planner, then the seed, then every `--set` in order.
    ///
    /// # Errors
    /// A setting is not a `KEY=VALUE`, or its key passes through a value that is not a table.
    pub fn put_into(&self, text: &str) -> Result<String, Complaint> {
        let bad = |error: toml_edit::TomlError| Complaint::NotToml(error.message().to_owned());
        let mut document: DocumentMut = text.parse().map_err(bad)?;
        if let Some(id) = &self.planner {
            put_planner(&mut document, id)?;
        }
        if let Some(seed) = self.seed {
            let seed = i64::try_from(seed)
                .map_err(|_| Complaint::BadSetting(format!("--seed {seed}: must be at most {}", i64::MAX)))?;
            put(document.as_item_mut(), &["seed"], &seed.into())
                .map_err(|why| Complaint::BadSetting(format!("--seed {seed}: {why}")))?;
        }
        for setting in &self.set {
            put_setting(&mut document, setting)
                .map_err(|why| Complaint::BadSetting(format!("--set {setting}: {why}")))?;
        }
        Ok(document.to_string())
    }
}

fn put_planner(document: &mut DocumentMut, id: &str) -> Result<(), Complaint> {
    if let Some(planner) = document.get_mut("planner").and_then(Item::as_table_like_mut)
        && planner.get("id").and_then(Item::as_str) != Some(id)
    {
        planner.remove("parameters");
    }
    put(document.as_item_mut(), &["planner", "id"], &id.into())
        .map_err(|why| Complaint::BadSetting(format!("--planner {id}: {why}")))
}

fn put_setting(document: &mut DocumentMut, setting: &str) -> Result<(), String> {
    let (key, written) = setting.split_once('=').ok_or("must be KEY=VALUE")?;
    let (key, written) = (key.trim(), written.trim());
    if key.is_empty() || written.is_empty() || key.split('.').any(str::is_empty) {
        return Err("must be KEY=VALUE, with dots between the parts of the key".into());
    }
    // A value that is not valid TOML is a word: --set mode=literal needs no quotes.
    let mut value: Value = written.parse().unwrap_or_else(|_| written.into());
    let path: Vec<&str> = match key.split('.').collect::<Vec<_>>()[..] {
        [only] if !TOP_KEYS.contains(&only) => vec!["planner", "parameters", only],
        ref path => path.to_vec(),
    };
    // No parameter accepts an infinite number or NaN, but a parameter may accept the word.
    if path.starts_with(&["planner", "parameters"]) && value.as_float().is_some_and(|x| !x.is_finite()) {
        value = written.into();
    }
    put(document.as_item_mut(), &path, &value)
}

/// Writes a value at the end of a path, creating missing tables; a number in the path is an index into a list.
fn put(item: &mut Item, path: &[&str], value: &Value) -> Result<(), String> {
    let [first, rest @ ..] = path else {
        *item = Item::Value(in_place_of(item, value));
        return Ok(());
    };
    if let Item::ArrayOfTables(list) = item {
        let count = list.len();
        let table = index(first).and_then(|at| list.get_mut(at)).ok_or_else(|| no_entry(first, count))?;
        return put_in_table(table, rest, value);
    }
    if let Item::Value(inline) = item {
        return put_in_value(inline, path, value);
    }
    let table = item
        .as_table_mut()
        .ok_or_else(|| format!("`{first}` would be inside a value that is not a table"))?;
    put_in_table(table, path, value)
}

fn put_in_table(table: &mut Table, path: &[&str], value: &Value) -> Result<(), String> {
    let [first, rest @ ..] = path else { return Err("refers to a whole table; name one of its keys".into()) };
    let item = table
        .entry(first)
        .or_insert_with(|| if rest.is_empty() { Item::None } else { Item::Table(Table::new()) });
    put(item, rest, value)
}

fn put_in_value(item: &mut Value, path: &[&str], value: &Value) -> Result<(), String> {
    let [first, rest @ ..] = path else {
        *item = in_place_of_value(item, value);
        return Ok(());
    };
    match item {
        Value::InlineTable(table) => {
            let empty = || Value::InlineTable(InlineTable::new());
            let missing = if rest.is_empty() { value.clone() } else { empty() };
            put_in_value(table.get_or_insert(*first, missing), rest, value)
        }
        Value::Array(list) => {
            let count = list.len();
            let entry = index(first).and_then(|at| list.get_mut(at)).ok_or_else(|| no_entry(first, count))?;
            put_in_value(entry, rest, value)
        }
        _ => Err(format!("`{first}` would be inside a simple value")),
    }
}

fn index(part: &str) -> Option<usize> {
    part.parse().ok()
}

fn no_entry(part: &str, count: usize) -> String {
    format!("no entry `{part}`; the list has length {count}, and its entries are counted from 0")
}

/// The new value, with the spacing and the comment of the old value.
fn in_place_of(item: &Item, value: &Value) -> Value {
    item.as_value().map_or_else(|| value.clone(), |old| in_place_of_value(old, value))
}

fn in_place_of_value(old: &Value, value: &Value) -> Value {
    let mut new = value.clone();
    *new.decor_mut() = old.decor().clone();
    new
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "name = \"x\"\n\n[planner] # drives\nid = \"rpf\" # the planner\nparameters = { k_rep = 1 }\n\n\
                        [[obstacles]]\nkind = \"circle\"\ncenter_m = [1, 2]\n";

    fn put_all(set: &[&str]) -> Result<String, String> {
        let set = set.iter().map(|&setting| setting.to_owned()).collect();
        Settings { set, ..Settings::default() }.put_into(TEXT).map_err(|error| error.to_string())
    }

    #[test]
    fn a_bare_key_is_a_planner_parameter() {
        let text = put_all(&["k_rep=2", "mode=literal"]).expect("fits");
        assert!(text.contains("k_rep = 2") && text.contains("mode = \"literal\""), "{text}");
    }

    #[test]
    fn a_seed_goes_to_the_top_and_comments_stay() {
        let settings = Settings { seed: Some(7), planner: Some("apf".into()), ..Settings::default() };
        let text = settings.put_into(TEXT).expect("fits");
        assert!(text.starts_with("name = \"x\"\nseed = 7\n"), "{text}");
        assert!(text.contains("id = \"apf\" # the planner"), "{text}");
        assert!(!text.contains("k_rep"), "parameters of rpf mean nothing to apf: {text}");
    }

    #[test]
    fn the_same_planner_keeps_its_parameters() {
        let settings = Settings { planner: Some("rpf".into()), ..Settings::default() };
        assert_eq!(settings.put_into(TEXT).expect("fits"), TEXT);
    }

    #[test]
    fn a_number_counts_along_a_list() {
        let text = put_all(&["obstacles.0.center_m=[3, 4]", "obstacles.0.center_m.1=5"]).expect("fits");
        assert!(text.contains("center_m = [3, 5]"), "{text}");
        assert!(
            put_all(&["obstacles.1.known=false"])
                .expect_err("only one")
                .contains("no entry `1`; the list has length 1")
        );
    }

    #[test]
    fn missing_sections_are_made() {
        let text = put_all(&["robot.radius_m=0.3"]).expect("fits");
        assert!(text.contains("[robot]\nradius_m = 0.3"), "{text}");
    }

    #[test]
    fn what_is_no_setting_is_refused_with_the_setting_in_the_message() {
        for (setting, why) in
            [("k_rep", "must be KEY=VALUE"), ("=3", "KEY=VALUE"), ("name.x=3", "inside a simple value")]
        {
            let error = put_all(&[setting]).expect_err(setting);
            assert!(error.starts_with(&format!("--set {setting}: ")) && error.contains(why), "{error}");
        }
    }

    #[test]
    fn a_seed_beyond_toml_is_refused() {
        let settings = Settings { seed: Some(u64::MAX), ..Settings::default() };
        assert!(
            settings
                .put_into(TEXT)
                .expect_err("too large")
                .to_string()
                .contains("at most 9223372036854775807")
        );
    }
}
