//! The home screen: scenarios, past runs and problems.

mod about;
mod attention;
mod pane;
mod runs;
mod scenarios;
mod setup;

use super::look::{Look, fill};
use super::{run_details, text};
use crate::model::home::{Found, HomeList};
use crate::model::ui::Arrangement;
use crate::model::{Glimpse, Model};
use crate::theme::Role;
use crate::update::Rows;
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Minimum and maximum width of the lists on a wide screen, columns.
const LISTS: (u16, u16) = (80, 96);
/// Rows of the plugins pane.
const PLUGINS: u16 = 5;
/// The fewest rows of a pane of events, including the frame.
const EVENTS: u16 = 8;

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let Some(found) = &look.model.home.found else {
        let block = look.block(Role::Border, "Home", "");
        let line = look.line([(Role::Dim, " Looking for scenarios and runs...".into())]);
        return fill(frame, area, block, vec![line]);
    };
    let list = look.model.home.list;
    match arrangement {
        Arrangement::Paged | Arrangement::Strip => {
            let rows = fitting(area.height, list, wanted(look, area.width, (found, true)));
            stack(look, frame, area, (found, true, rows));
        }
        Arrangement::Narrow => {
            let mut rows = shares(area.height, list, wanted(look, area.width, (found, true)));
            // The whole text of an item takes the rows that the other lists can spare.
            if list == HomeList::Attention && look.model.home.is_read {
                rows = reading(area.height, wanted(look, area.width, (found, true)));
            }
            stack(look, frame, area, (found, true, rows));
        }
        Arrangement::Wide => {
            let width = (area.width * 58 / 100).clamp(LISTS.0, LISTS.1);
            let [lists, beside] =
                Layout::horizontal([Constraint::Length(width), Constraint::Fill(1)]).areas(area);
            let [about, plugins] =
                Layout::vertical([Constraint::Fill(1), Constraint::Length(PLUGINS)]).areas(beside);
            let wanted = wanted(look, lists.width, (found, false));
            let mut rows = shares(lists.height, list, wanted);
            // Rows that no list needs show the events of the run that is described beside the lists.
            let spare = rows[HomeList::Runs as usize].saturating_sub(wanted[HomeList::Runs as usize]);
            let glimpse = described(look).filter(|glimpse| !glimpse.events.is_empty() && spare >= EVENTS);
            let spare = if glimpse.is_some() { spare } else { 0 };
            rows[HomeList::Runs as usize] -= spare;
            let [lists, events] =
                Layout::vertical([Constraint::Fill(1), Constraint::Length(spare)]).areas(lists);
            stack(look, frame, lists, (found, false, rows));
            if let Some(glimpse) = glimpse {
                run_details::events(look, frame, events, glimpse);
            }
            about::draw(look, frame, about);
            about::plugins(look, frame, plugins);
        }
    }
}

/// The details of the run that a large screen describes beside the lists: of the selected run, or of the last run of the
/// selected scenario.
fn described<'a>(look: &Look<'a>) -> Option<&'a Glimpse> {
    let home = &look.model.home;
    let run = match home.list {
        HomeList::Scenarios => home.last_end(&home.selected_scenario()?.name),
        HomeList::Runs => home.selected_run(),
        HomeList::Attention => None,
    };
    let glimpse = home.glimpses.of(&run?.name)?.as_ref().ok();
    glimpse.filter(|_| look.model.ui.is_large()).map(|glimpse| &**glimpse)
}

/// The rows that each list needs, given whether the selected row is described below its list.
fn wanted(look: &Look, width: u16, (found, about): (&Found, bool)) -> [u16; 3] {
    let home = &look.model.home;
    let more = u16::from(about) * (pane::ABOUT + 1);
    let room = usize::from(width).saturating_sub(2);
    let invalid = home.selected_scenario().filter(|entry| about && entry.problem.is_some());
    let text = invalid.map_or(more, |entry| scenarios::about_lines(entry, room).len() as u16 + 1);
    [
        // A pane with a text has a minimum height.
        (home.scenarios().len().max(1) as u16).saturating_add(3 + text).max(u16::from(about) * pane::LEAST),
        (home.runs().len().max(1) as u16).saturating_add(3 + more),
        (found.attention.len().max(1) as u16).saturating_add(2 + attention::text_rows(look, width, about)),
    ]
}

/// The lists below each other, with the given rows.
fn stack(look: &Look, frame: &mut Frame, area: Rect, (found, about, rows): (&Found, bool, [u16; 3])) {
    let areas: [Rect; 3] = Layout::vertical(rows.map(Constraint::Length)).areas(area);
    for (list, area) in HomeList::ALL.into_iter().zip(areas).filter(|(_, area)| area.height > 0) {
        one(look, frame, area, (found, list, about && list == look.model.home.list));
    }
}

fn one(look: &Look, frame: &mut Frame, area: Rect, (found, list, about): (&Found, HomeList, bool)) {
    match list {
        HomeList::Scenarios => scenarios::draw(look, frame, area, about),
        HomeList::Runs => runs::draw(look, frame, area, about),
        HomeList::Attention => attention::draw(look, frame, area, (found, about)),
    }
}

/// The number of rows that each list gets, given the number that it requests. Every list keeps a part of the screen;
/// the remaining rows go first to the list that responds to the arrow keys, then to the others in order.
fn shares(rows: u16, focus: HomeList, wanted: [u16; 3]) -> [u16; 3] {
    let least = [(rows / 3).max(6), (rows / 4).max(5), (rows / 6).max(4)];
    let mut given = [0, 1, 2].map(|list| wanted[list].min(least[list]));
    let mut left = rows.saturating_sub(given.iter().sum());
    let others = HomeList::ALL.into_iter().filter(|list| *list != focus);
    for list in std::iter::once(focus).chain(others) {
        let more = (wanted[list as usize] - given[list as usize]).min(left);
        given[list as usize] += more;
        left -= more;
    }
    given[HomeList::Runs as usize] += left;
    given
}

/// The rows of each list while the whole text of an attention item is read: the other lists keep their frames, headings
/// and a row.
fn reading(rows: u16, wanted: [u16; 3]) -> [u16; 3] {
    const OTHER: u16 = 4;
    let attention = wanted[HomeList::Attention as usize].min(rows.saturating_sub(2 * OTHER));
    let left = rows.saturating_sub(attention);
    let scenarios = (left / 2).max(OTHER.min(left));
    [scenarios, left - scenarios, attention]
}

/// The rows of each list where one list fills the screen: what this list does not need goes to the others, if it is
/// enough for them to be of use.
fn fitting(rows: u16, focus: HomeList, wanted: [u16; 3]) -> [u16; 3] {
    let mut given = [0; 3];
    let mut left = rows;
    let others = [HomeList::Attention, HomeList::Runs, HomeList::Scenarios];
    for list in std::iter::once(focus).chain(others.into_iter().filter(|list| *list != focus)) {
        let least = if list == HomeList::Attention { 3 } else { 4 };
        if left >= least || list == focus {
            given[list as usize] = wanted[list as usize].min(left);
            left -= given[list as usize];
        }
    }
    given[focus as usize] += left;
    given
}

fn border(look: &Look, list: HomeList) -> Role {
    if look.model.home.list == list { Role::Focus } else { Role::Border }
}

/// The key of a list on a wide screen, for its title.
fn key(look: &Look, list: Rows) -> String {
    let index = match list {
        Rows::Runs => HomeList::Runs,
        Rows::Attention => HomeList::Attention,
        _ => HomeList::Scenarios,
    };
    let is_wide = look.model.ui.arrangement() == Arrangement::Wide;
    if is_wide { look.nth_key(index as usize) } else { String::new() }
}

/// The filter of the lists, or the keys for filtering and for switching between them. Where only one list is shown, the
/// number of points that need attention.
fn note(look: &Look, list: HomeList) -> String {
    let found = look.model.home.found.iter().flat_map(|found| &found.attention);
    let open = found.filter(|point| point.severity > Severity::Info).count();
    let is_alone = look.model.ui.arrangement() == Arrangement::Paged;
    let is_focused = look.model.home.list == list;
    // A small screen has no room for the key beside the filter.
    let brief = |filter: &str| look.keys(&format!("`{}` <cancel>", text::fit(filter, 20)));
    match look.model.home.filter.as_str() {
        "" if is_focused && is_alone && open > 0 => look.keys(&format!("attention {open}, <next-pane> pane")),
        _ if !is_focused && look.model.ui.arrangement() == Arrangement::Wide => String::new(),
        _ if !is_focused => look.keys("<next-pane> pane"),
        "" => look.keys("<filter> filter"),
        filter if is_alone => brief(filter),
        filter => look.keys(&format!("filter `{}`  <cancel> clear", text::fit(filter, 20))),
    }
}

/// What the keys do with the selected row, for the state line; if no row is selected, why.
pub(super) fn next(model: &Model) -> Vec<String> {
    let home = &model.home;
    let is_filtered = !home.filter.is_empty();
    let none = |what: &str| {
        if is_filtered {
            format!("No {what} matches the filter `{}`.", home.filter)
        } else {
            format!("No {what} yet.")
        }
    };
    let first = match home.list {
        HomeList::Scenarios if home.selected_scenario().is_none() => none("scenario"),
        HomeList::Scenarios => "<open> opens a scenario and makes its plan.".into(),
        HomeList::Runs if home.selected_run().is_none() => none("run"),
        HomeList::Runs => "<open> replays the selected run.".into(),
        HomeList::Attention if home.selected_attention().is_none() => "Nothing needs attention.".into(),
        HomeList::Attention if home.is_read => "<open> closes the text.".into(),
        HomeList::Attention => "<open> shows the whole text.".into(),
    };
    let run = home.selected_attention().filter(|_| home.list == HomeList::Attention);
    let rescan = run.and_then(|point| point.run.as_ref()).map(|_| "<rescan>: re-scan the rest.".to_owned());
    std::iter::once(first).chain(rescan).chain(["The robot does not move.".to_owned()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_a_small_screen_the_focused_list_leaves_to_the_others_only_what_it_does_not_need() {
        assert_eq!(fitting(12, HomeList::Scenarios, [23, 5, 3]), [12, 0, 0]);
        assert_eq!(fitting(12, HomeList::Attention, [23, 25, 3]), [0, 9, 3], "the runs come next");
        assert_eq!(fitting(12, HomeList::Runs, [23, 7, 5]), [0, 7, 5]);
        assert_eq!(fitting(12, HomeList::Runs, [23, 10, 5]), [0, 12, 0], "two rows are of no use");
        assert_eq!(fitting(12, HomeList::Scenarios, [8, 4, 3]), [9, 0, 3]);
    }

    #[test]
    fn every_list_is_visible_and_the_focused_one_comes_first() {
        for focus in HomeList::ALL {
            for rows in 19..60 {
                let wanted = [24, 33, 24];
                let given = shares(rows, focus, wanted);
                assert_eq!(given.iter().sum::<u16>(), rows, "{given:?}");
                assert!(given.iter().all(|rows| *rows >= 4), "{given:?}");
                let (has, wants) = (given[focus as usize], wanted[focus as usize]);
                let most = given.iter().max().copied();
                assert!(has == wants || Some(has) == most, "{focus:?} of {rows}: {given:?}");
            }
        }
        assert_eq!(
            shares(30, HomeList::Attention, [7, 5, 4]),
            [7, 19, 4],
            "what nobody needs goes to the runs"
        );
    }
}
