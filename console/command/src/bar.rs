//! A progress bar on stderr for long computations.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// Shows a progress bar if stderr is a terminal. Rows on stdout, as text or as JSON, are not affected.
pub fn shown(bar: ProgressBar, name: &'static str, template: &str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    bar.with_prefix(name).with_style(style)
}
