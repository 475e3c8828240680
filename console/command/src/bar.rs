//! What a terminal on stderr shows while much is computed.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// Shows work on stderr, if that is a terminal: rows on stdout, for people or as JSON, do not suffer from it.
pub fn shown(bar: ProgressBar, name: &'static str, template: &str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    bar.with_prefix(name).with_style(style)
}
