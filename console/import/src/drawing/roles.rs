//! The roles of layers in a drawing.

use super::entities::Drawn;
use std::{collections::BTreeMap, fmt};

/// The largest number of layers that a message lists.
const LISTED: usize = 20;

/// The content of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(test, derive(strum::EnumCount))]
pub enum Role {
    /// The inner side of the shell.
    Shell,
    /// Columns, or other objects on the floor.
    Columns,
    /// Pipes, drawn as lines.
    Pipes,
    /// Sumps, which become no-go zones.
    Sump,
    /// No-go zones.
    NoGo,
    /// Plates of the floor, or the seams between them.
    Plates,
    /// Nothing that belongs to the floor.
    Ignored,
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Shell => "SHELL",
            Self::Columns => "COLUMNS",
            Self::Pipes => "PIPES",
            Self::Sump => "SUMP",
            Self::NoGo => "NOGO",
            Self::Plates => "PLATES",
            Self::Ignored => "IGNORE",
        })
    }
}

impl Role {
    /// The role that a word names, in the singular or the plural.
    pub fn named(word: &str) -> Option<Self> {
        let upper = word.to_uppercase();
        match upper.strip_suffix('S').unwrap_or(&upper) {
            "SHELL" => Some(Self::Shell),
            "COLUMN" | "OBSTACLE" => Some(Self::Columns),
            "PIPE" => Some(Self::Pipes),
            "SUMP" => Some(Self::Sump),
            "NOGO" | "NOGOZONE" => Some(Self::NoGo),
            "PLATE" => Some(Self::Plates),
            "IGNORE" => Some(Self::Ignored),
            _ => None,
        }
    }
}

/// The roles of layers: the assigned roles or, for other layers, those named by a word in the layer's name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layers(Vec<(Role, String)>);

impl Layers {
    /// Creates assignments of roles to layers, in addition to those by name.
    pub fn new(named: Vec<(Role, String)>) -> Self {
        Self(named)
    }

    /// The roles of a layer.
    pub(super) fn roles(&self, layer: &str) -> Vec<Role> {
        let is_named = |(_, name): &&(Role, String)| is_same(name, layer);
        let named: Vec<Role> = self.0.iter().filter(is_named).map(|(role, _)| *role).collect();
        if named.is_empty() { by_name(layer).into_iter().collect() } else { named }
    }

    /// The layers assigned to this role.
    pub(super) fn stated(&self, role: Role) -> Vec<&str> {
        self.0.iter().filter(|(known, _)| *known == role).map(|(_, name)| name.as_str()).collect()
    }

    /// The first assigned layer that is empty or missing.
    pub(super) fn missing(&self, all: &[Drawn]) -> Option<&str> {
        let is_there = |name: &str| all.iter().any(|drawn| is_same(&drawn.layer, name));
        self.0.iter().map(|(_, name)| name.as_str()).find(|name| !is_there(name))
    }
}

fn is_same(one: &str, other: &str) -> bool {
    one.trim().to_uppercase() == other.trim().to_uppercase()
}

/// The role of a layer, according to a word in its name.
fn by_name(layer: &str) -> Option<Role> {
    let whole = layer.replace(['-', '_', ' '], "");
    let mut words = layer.split(|c: char| !c.is_alphanumeric()).chain([whole.as_str()]);
    words.find_map(Role::named).filter(|role| *role != Role::Ignored)
}

/// Lists the layers of a drawing with their contents, for messages.
pub(super) fn list(all: &[Drawn]) -> String {
    let mut layers: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
    for drawn in all {
        *layers.entry(&drawn.layer).or_default().entry(&drawn.kind).or_default() += 1;
    }
    let kinds = |kinds: &BTreeMap<&str, usize>| {
        kinds.iter().map(|(kind, n)| format!("{n} {kind}")).collect::<Vec<_>>().join(", ")
    };
    let mut lines: Vec<String> =
        layers.iter().take(LISTED).map(|(layer, all)| format!("`{layer}` ({})", kinds(all))).collect();
    let more = layers.len().saturating_sub(LISTED);
    lines.extend((more > 0).then(|| format!("and {more} more")));
    if lines.is_empty() { "none: the drawing is empty".into() } else { lines.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use strum::EnumCount;

    #[test]
    fn the_layers_that_reports_have_are_known() {
        for (layer, role) in [("NO_GO_ZONES", Role::NoGo), ("no-go", Role::NoGo), ("PLATES", Role::Plates)] {
            assert_eq!(Layers::default().roles(layer), [role], "{layer}");
        }
    }

    #[test]
    fn a_word_of_the_name_counts_unless_somebody_says_otherwise() {
        let layers = Layers::new(vec![
            (Role::Columns, "Stützen".into()),
            (Role::Ignored, "column-text".into()),
            (Role::Shell, "0".into()),
            (Role::Columns, "0".into()),
        ]);
        let roles = |layer: &str| layers.roles(layer);
        assert_eq!(roles("STÜTZEN"), [Role::Columns]);
        assert_eq!(roles("COLUMN-TEXT"), [Role::Ignored]);
        assert_eq!(roles("T-01 column"), [Role::Columns]);
        assert_eq!(roles("no go"), [Role::NoGo]);
        assert_eq!(roles("0"), [Role::Shell, Role::Columns]);
        assert_eq!(roles("ignore"), []);
    }

    #[test]
    fn every_role_has_a_word_of_its_own() {
        let all: [Role; Role::COUNT] =
            [Role::Shell, Role::Columns, Role::Pipes, Role::Sump, Role::NoGo, Role::Plates, Role::Ignored];
        let words: BTreeSet<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(words.len(), all.len(), "{words:?}");
        assert!(words.iter().all(|word| !word.is_empty() && !word.contains('_')), "{words:?}");
    }
}
