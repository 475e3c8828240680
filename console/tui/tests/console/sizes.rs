//! Screens at the four sizes that the console is made for, with colours and without, and what holds for all of them.

use crate::fixture::{PLAIN, RICH, Screen};
use crate::screens::{drawn, roles, text};
use tui::Msg;

/// The sizes that the console is made for.
pub(crate) const SIZES: [(u16, u16); 4] = [(60, 16), (80, 24), (120, 36), (200, 60)];

/// Stores a screen at every size: the text, what each cell stands for, and the text without colours if it differs.
///
/// Texts that do not come from the console, such as names and reasons, may be cut; `is_free` recognises the lines
/// that contain them.
pub(crate) fn store(name: &str, screen: &mut Screen, is_free: fn(&str) -> bool) {
    let mut cuts = Vec::new();
    for size in SIZES {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let shown = text(&drawn(&screen.model, RICH, size));
        // `resume…` is the whole label of an action that asks first.
        let is_cut = |part: &str| part.replace("resume…", "").contains('…') && !is_free(part);
        let cut = shown.split(['│', '\n']).filter(|part| is_cut(part));
        cuts.extend(cut.filter(|_| size.0 >= 80).map(|part| format!("{size:?}: {part}")));
        let plain = text(&drawn(&screen.model, PLAIN, size));
        let plain = if plain == shown { String::new() } else { format!("\n{plain}") };
        let all = format!("{shown}\n{}{plain}", roles(&screen.model, RICH, size));
        insta::assert_snapshot!(format!("{name}_{}x{}", size.0, size.1), all);
    }
    assert_eq!(cuts, [""; 0], "{name}");
}

/// Text that others chose: log lines are cut at the end of their line, and Enter shows the whole of one.
pub(crate) fn is_log(part: &str) -> bool {
    part.contains("T+00:")
}
