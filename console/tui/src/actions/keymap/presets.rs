//! The preset key assignments.

use crate::keys::Key;

/// Keys that differ from those in the table, by action.
pub(super) type Changes = &'static [(&'static str, &'static [Key])];

/// Arrows and named keys only: no letter moves the robot.
const ARROWS: Changes = &[
    ("pan-west", &[Key::Left]),
    ("pan-east", &[Key::Right]),
    ("pan-north", &[Key::Up]),
    ("pan-south", &[Key::Down]),
    ("up", &[Key::Up]),
    ("down", &[Key::Down]),
    ("page-up", &[Key::PageUp]),
    ("page-down", &[Key::PageDown]),
    ("first", &[Key::Home]),
    ("last", &[Key::End]),
    ("zoom-in", &[Key::Char('=')]),
    ("zoom-out", &[Key::Char('-')]),
];

/// Letters instead of arrows, and the keys of a pager.
const VIM: Changes = &[
    ("pan-west", &[Key::Char('h'), Key::Left]),
    ("pan-east", &[Key::Char('l'), Key::Right]),
    ("pan-north", &[Key::Char('k'), Key::Up]),
    ("pan-south", &[Key::Char('j'), Key::Down]),
    ("up", &[Key::Char('k'), Key::Up, Key::Ctrl('p')]),
    ("down", &[Key::Char('j'), Key::Down, Key::Ctrl('n')]),
    ("page-up", &[Key::Ctrl('u'), Key::PageUp]),
    ("page-down", &[Key::Ctrl('d'), Key::Ctrl('f'), Key::PageDown]),
    ("commands", &[Key::Char(':')]),
    ("zoom-in", &[Key::Char('='), Key::Char('z')]),
    ("zoom-out", &[Key::Char('-'), Key::Char('Z')]),
];

/// The presets by name.
pub const PRESETS: [(&str, Changes); 3] = [("default", &[]), ("arrows", ARROWS), ("vim", VIM)];
