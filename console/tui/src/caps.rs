//! The terminal's capabilities, taken from the environment without querying the terminal.

use serde::{Deserialize, Serialize};

/// How many colours the terminal has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Colours {
    /// No colours are available or wanted: bold and reverse video only.
    None,
    /// The terminal's own sixteen colours.
    Sixteen,
    /// The 256-colour palette.
    Indexed,
    /// 24-bit colour.
    True,
}

/// Which characters the terminal's font has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Glyphs {
    /// 7-bit characters only.
    Ascii,
    /// Lines, half blocks and dots, but no braille.
    Half,
    /// Braille as well.
    Braille,
    /// The octants of Unicode 16 as well: dots without gaps. No environment variable tells whether a terminal has
    /// them.
    Octant,
}

impl Glyphs {
    /// Whether one character can show eight dots, so that lines need no letters.
    pub fn has_dots(self) -> bool {
        matches!(self, Self::Braille | Self::Octant)
    }

    /// The unit of a turn rate; in 7-bit characters, a degree sign would become a letter.
    pub(crate) fn turn_unit(self) -> &'static str {
        if self == Self::Ascii { "deg/s" } else { "°/s" }
    }
}

/// The terminal's capabilities.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Caps {
    /// Colours of the terminal.
    pub colours: Colours,
    /// Characters of the terminal.
    pub glyphs: Glyphs,
    /// Whether the console runs over a slow connection and should therefore draw fewer frames.
    pub ssh: bool,
}

impl Caps {
    /// Derives the capabilities from the environment; `variable` looks up an environment variable.
    pub fn from_env(variable: impl Fn(&str) -> Option<String>) -> Self {
        let term = variable("TERM").unwrap_or_default();
        let says = |name: &str| variable(name).filter(|value| !value.is_empty());
        Self {
            colours: colours(&term, says("NO_COLOR").is_some(), &says("COLORTERM").unwrap_or_default()),
            glyphs: glyphs(&term, says("LC_ALL").or_else(|| says("LC_CTYPE")).or_else(|| says("LANG"))),
            ssh: says("SSH_CONNECTION").is_some() || says("SSH_TTY").is_some(),
        }
    }
}

fn colours(term: &str, unwanted: bool, colorterm: &str) -> Colours {
    if unwanted || term == "dumb" || term.is_empty() {
        Colours::None
    } else if matches!(colorterm, "truecolor" | "24bit") || term.ends_with("-direct") {
        Colours::True
    } else if term.contains("256color") {
        Colours::Indexed
    } else {
        Colours::Sixteen
    }
}

fn glyphs(term: &str, locale: Option<String>) -> Glyphs {
    let locale = locale.map(|name| name.to_lowercase().replace('-', ""));
    match (term, locale) {
        ("dumb" | "vt100" | "", _) => Glyphs::Ascii,
        // Containers use the plain C locale, which says nothing about the terminal; other character sets do.
        (_, Some(name)) if !name.contains("utf8") && name != "c" && name != "posix" => Glyphs::Ascii,
        ("linux", _) => Glyphs::Half,
        _ => Glyphs::Braille,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn caps(pairs: &[(&str, &str)]) -> Caps {
        Caps::from_env(|name| {
            pairs.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned())
        })
    }

    #[test]
    fn colours_are_never_more_than_the_environment_promises() {
        assert_eq!(caps(&[("TERM", "xterm")]).colours, Colours::Sixteen);
        assert_eq!(caps(&[("TERM", "tmux-256color")]).colours, Colours::Indexed);
        assert_eq!(caps(&[("TERM", "xterm"), ("COLORTERM", "truecolor")]).colours, Colours::True);
    }

    #[test]
    fn no_color_wins_but_only_when_it_has_a_value() {
        let both = [("TERM", "xterm-256color"), ("COLORTERM", "truecolor"), ("NO_COLOR", "1")];
        assert_eq!(caps(&both).colours, Colours::None);
        assert_eq!(caps(&[("TERM", "xterm"), ("NO_COLOR", "")]).colours, Colours::Sixteen);
    }

    #[test]
    fn poor_fonts_get_poorer_characters() {
        assert_eq!(caps(&[("TERM", "linux")]).glyphs, Glyphs::Half);
        assert_eq!(caps(&[("TERM", "xterm"), ("LANG", "de_DE.ISO-8859-1")]).glyphs, Glyphs::Ascii);
        assert_eq!(caps(&[("TERM", "xterm"), ("LANG", "en_GB.UTF-8")]).glyphs, Glyphs::Braille);
    }

    #[test]
    fn a_remote_line_is_noticed() {
        assert!(caps(&[("TERM", "xterm"), ("SSH_CONNECTION", "10.0.0.1 22 10.0.0.2 22")]).ssh);
    }
}
