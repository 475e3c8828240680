//! Reads `config.toml`.

use super::{
    Config,
    fault::{Fault, document, each},
};
use mission::Severity;
use toml_edit::Item;
use tui::{Colours, Speed, ThemeName, model::console::Bell};

/// The longest time for which an alarm can be shelved, in minutes.
const SHELVE_MAX_MIN: i64 = 24 * 60;

/// Reads the settings; for a faulty line, the default stays in effect.
pub(super) fn read(config: &mut Config, text: &str) -> Vec<Fault> {
    let mut faults = Vec::new();
    let Some(document) = document(text, &mut faults) else { return faults };
    each(
        document.as_table(),
        &["operator", "screen", "start", "alarms"],
        &mut faults,
        |key, item, faults| {
            match key {
                "operator" => config.preferences.operator = Some(string(item)?.to_owned()),
                "screen" => section(item, &["theme", "colours", "mouse"], faults, |key, item| {
                    screen(config, key, item)
                })?,
                "start" => {
                    section(item, &["scenarios", "speed"], faults, |key, item| begin(config, key, item))?;
                }
                _ => {
                    section(item, &["bell", "shelve_max_min"], faults, |key, item| {
                        alarms(config, key, item)
                    })?;
                }
            }
            Ok(())
        },
    );
    faults
}

fn section(
    item: &Item,
    known: &[&str],
    faults: &mut Vec<Fault>,
    mut take: impl FnMut(&str, &Item) -> Result<(), String>,
) -> Result<(), String> {
    let table = item.as_table_like().ok_or("must be a section")?;
    each(table, known, faults, |key, item, _| take(key, item));
    Ok(())
}

fn screen(config: &mut Config, key: &str, item: &Item) -> Result<(), String> {
    match key {
        "theme" => {
            config.theme = match string(item)? {
                "auto" => None,
                name => Some(ThemeName::named(name).ok_or("must be auto, dark, light or contrast")?),
            };
        }
        "colours" => {
            config.colours = match string(item)? {
                "auto" => None,
                name => Some(colours(name).map_err(|_| "must be auto, none, 16, 256 or true")?),
            };
        }
        _ => config.preferences.mouse = item.as_bool().ok_or("must be true or false")?,
    }
    Ok(())
}

fn begin(config: &mut Config, key: &str, item: &Item) -> Result<(), String> {
    if key == "speed" {
        let text = item.as_str().map(str::to_owned);
        let number = item.as_float().map(|number| number.to_string());
        let number = number.or_else(|| item.as_integer().map(|number| number.to_string()));
        config.speed = Speed::parse(&text.or(number).unwrap_or_default())?;
        return Ok(());
    }
    let folders = item.as_array().ok_or("must be a list of folders")?;
    let folders: Option<Vec<_>> = folders.iter().map(|folder| folder.as_str().map(Into::into)).collect();
    config.scenarios = folders.ok_or("must be a list of folders")?;
    Ok(())
}

fn alarms(config: &mut Config, key: &str, item: &Item) -> Result<(), String> {
    if key == "bell" {
        config.preferences.bell = Bell(match string(item)? {
            "none" => None,
            "watch" => Some(Severity::Watch),
            "warn" => Some(Severity::Warn),
            "crit" => Some(Severity::Crit),
            _ => return Err("must be crit, warn, watch or none".into()),
        });
        return Ok(());
    }
    let minutes = item.as_integer().filter(|minutes| (1..=SHELVE_MAX_MIN).contains(minutes));
    let minutes = minutes.ok_or_else(|| format!("must be 1 to {SHELVE_MAX_MIN} minutes"))?;
    config.preferences.shelve_max_min = minutes as u32;
    Ok(())
}

fn string(item: &Item) -> Result<&str, String> {
    item.as_str().ok_or_else(|| "must be text in quotes".into())
}

/// Parses a number of colours.
///
/// # Errors
/// The allowed values.
pub fn colours(name: &str) -> Result<Colours, &'static str> {
    match name {
        "none" => Ok(Colours::None),
        "16" => Ok(Colours::Sixteen),
        "256" => Ok(Colours::Indexed),
        "true" => Ok(Colours::True),
        _ => Err("must be none, 16, 256 or true"),
    }
}
