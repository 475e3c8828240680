//! Reads `keys.toml`.

use super::{
    Config,
    fault::{Fault, document, each, start},
};
use mission::spelling::nearest;
use std::collections::BTreeMap;
use toml_edit::{Item, TableLike};
use tui::{
    Key,
    actions::{
        find,
        keymap::{Binding, Keymap, Objection, PRESETS, taken_by},
    },
};

/// A binding and its position in the file.
struct Written {
    binding: Binding,
    name_at: usize,
    keys_at: Vec<usize>,
}

/// Reads the key bindings; for a faulty line, the preset's keys stay in effect.
pub(super) fn read(config: &mut Config, text: &str) -> Vec<Fault> {
    let mut faults = Vec::new();
    let Some(document) = document(text, &mut faults) else { return faults };
    let mut preset = PRESETS[0].1;
    let (mut written, mut aliases) = (Vec::new(), BTreeMap::new());
    each(document.as_table(), &["preset", "keys", "alias"], &mut faults, |key, item, faults| {
        match key {
            "preset" => {
                let found = PRESETS.iter().find(|(name, _)| item.as_str() == Some(*name));
                preset = found.ok_or("must be default, arrows or vim")?.1;
            }
            "keys" => written = bindings(item.as_table_like().ok_or("must be a section")?, faults),
            _ => aliases = read_aliases(item.as_table_like().ok_or("must be a section")?, faults),
        }
        Ok(())
    });
    let bindings: Vec<Binding> = written.iter().map(|written| written.binding.clone()).collect();
    let (keys, objections) = Keymap::new(preset, &bindings);
    faults.extend(objections.into_iter().map(|objection| fault_of(objection, &written)));
    faults.extend(written.iter().flat_map(warnings));
    faults.sort_by_key(|fault| fault.at);
    config.keys = keys;
    config.keys.aliases = aliases;
    faults
}

fn bindings(table: &dyn TableLike, faults: &mut Vec<Fault>) -> Vec<Written> {
    let mut all = Vec::new();
    for (action, item) in table.iter() {
        let name_at = table.key(action).and_then(toml_edit::Key::span).map_or(0, |span| span.start);
        match keys_of(item) {
            Ok((keys, keys_at)) => {
                let binding = Binding { action: action.to_owned(), keys };
                all.push(Written { binding, name_at, keys_at });
            }
            Err(fault) => faults.push(fault),
        }
    }
    all
}

fn keys_of(item: &Item) -> Result<(Vec<Key>, Vec<usize>), Fault> {
    let wrong = || Fault::new(start(item), "keys must be a list, such as [\"f\", \"F5\"]".into());
    let array = item.as_array().ok_or_else(wrong)?;
    let keys = array.iter().map(|value| {
        let at = value.span().map_or(0, |span| span.start);
        let name = value.as_str().ok_or_else(wrong)?;
        let unknown = || {
            let what = format!("unknown key {name:?}; write a character, space, enter, up, F5 or Ctrl-L");
            Fault::new(at, what)
        };
        Ok((Key::named(name).ok_or_else(unknown)?, at))
    });
    Ok(keys.collect::<Result<Vec<_>, Fault>>()?.into_iter().unzip())
}

fn fault_of(objection: Objection, written: &[Written]) -> Fault {
    let Objection { binding, key, what, other, instead } = objection;
    let place = |written: &Written, key: Option<usize>| {
        key.and_then(|key| written.keys_at.get(key)).copied().unwrap_or(written.name_at)
    };
    let at = written.get(binding).map_or(0, |written| place(written, key));
    let other = other.and_then(|other| written.get(other)).map(|written| written.name_at);
    Fault { at, what, other, instead, is_warning: false }
}

fn warnings(written: &Written) -> impl Iterator<Item = Fault> {
    let keys = written.binding.keys.iter().zip(&written.keys_at);
    keys.filter_map(|(key, at)| {
        let who = taken_by(*key)?;
        let what = format!("{:?} may never reach tankops: {who} intercepts it", key.name());
        Some(Fault { at: *at, what, other: None, instead: String::new(), is_warning: true })
    })
}

fn read_aliases(table: &dyn TableLike, faults: &mut Vec<Fault>) -> BTreeMap<String, String> {
    let mut aliases = BTreeMap::new();
    for (name, item) in table.iter() {
        match alias(name, item) {
            Ok(line) => drop(aliases.insert(name.to_owned(), line)),
            Err(what) => faults.push(Fault::new(start(item), what)),
        }
    }
    aliases
}

fn alias(name: &str, item: &Item) -> Result<String, String> {
    let line = item.as_str().ok_or("an alias must be a command line in quotes")?;
    let command = line.split_whitespace().next().unwrap_or_default();
    if let Some(action) = find::named(name) {
        return Err(format!("{name:?} is already the command {}", action.name));
    }
    if find::named(command).is_none() {
        let near = nearest(command, find::commands().map(|action| action.name));
        let near = near.map(|name| format!("; did you mean {name}?")).unwrap_or_default();
        return Err(format!("unknown command {command:?}{near}"));
    }
    Ok(line.to_owned())
}
