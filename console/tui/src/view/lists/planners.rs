//! The list of planners and of refused plugins.

use super::list::{List, hint, paragraph};
use crate::model::planner_list::PlannerLine;
use crate::model::ui::Purpose;
use crate::theme::Role;
use crate::view::look::{Look, Parts as Row};
use crate::view::text::{self, wrap};

pub(super) fn list(
    look: &Look,
    purpose: Purpose,
    (selected, is_unfolded): (usize, bool),
    columns: u16,
) -> List {
    let (title, enter) = match purpose {
        Purpose::Drive => ("Planners", " <accept>: change planner (asks first); coverage is kept."),
        Purpose::Compare => ("Compare with", " <accept>: have it plan alongside the active planner."),
        Purpose::Shadow => ("Run in shadow", " <accept>: run it in shadow; it does not move the robot."),
        Purpose::WhatIf => ("Forecast with", " <accept>: add it to the forecasts."),
    };
    let lines = look.model.planner_lines(is_unfolded);
    let (about, enter) = match lines.get(selected) {
        Some(PlannerLine::Planner(planner)) => (planner.about.as_str(), enter),
        Some(PlannerLine::Others(_)) => {
            ("They do not support the task of this mission.", " <accept>: list them with the reasons.")
        }
        None => ("No planner was found.", ""),
    };
    let room = usize::from(columns).saturating_sub(2 + 1);
    let about = paragraph(Role::Text, about, room);
    let refused = look.model.console.refused.iter().flat_map(|plugin| {
        let name = vec![(Role::Warn, text::fit(&format!(" REFUSED {}", plugin.plugin), room))];
        let why = wrap(&plugin.reason, room.saturating_sub(2));
        [name].into_iter().chain(why.into_iter().map(|line| vec![(Role::Text, format!("   {line}"))]))
    });
    List {
        title: title.into(),
        rows: lines.iter().map(|line| row(look, line)).collect(),
        selected,
        below: [Row::new()]
            .into_iter()
            .chain(about)
            .chain(refused)
            .chain([hint(&look.keys(enter))])
            .collect(),
        ..List::default()
    }
}

fn row(look: &Look, line: &PlannerLine) -> Row {
    let planner = match line {
        PlannerLine::Planner(planner) => planner,
        PlannerLine::Others(n) => {
            let plural = if *n == 1 { "" } else { "s" };
            return vec![(Role::Dim, format!("+ {n} planner{plural} that cannot run this mission"))];
        }
    };
    let drives = Some(planner.id.as_str()) == look.run.planner_id();
    let name = (Role::Title, text::column(&planner.id, 18));
    // The reason takes the place of the version.
    if let Some(why) = look.run.cannot_fly(planner).filter(|_| !drives) {
        return vec![name, (Role::Dim, why.into())];
    }
    let version = (Role::Text, text::column(&planner.version, 8));
    vec![name, version, (Role::Good, if drives { "active" } else { "" }.into())]
}
