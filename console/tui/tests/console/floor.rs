//! Floor that was not requested, and floor that was not reached, on the Result and the Review screen.

use crate::fixture::{RICH, Screen};
use crate::overviews::found;
use crate::panes::missed_summary;
use crate::screens::{drawn, roles, text};
use account::{Area, MissReason};
use mission::{Outcome, TaskConfig};
use tui::model::{Glimpse, Log, Run, RunResult};
use tui::{Msg, RunMsg};
use world::Point;

/// The sizes at which a map of the floor is shown on both screens.
const SIZES: [(u16, u16); 2] = [(120, 36), (200, 60)];

/// A mission that had to scan the eastern half of the tank, and was ended early.
fn half_requested(regions: Vec<Vec<Point>>) -> Screen {
    let mut screen = Screen::running();
    let about = screen.model.live.run.about.as_mut().unwrap();
    about.mission.task = TaskConfig::Cover { anchor: Point::origin(), regions, tolerance_m: 0.2 };
    let ended = screen.mission.ended(Outcome::Aborted, "ended by the operator");
    screen.hear(RunMsg::Events(vec![ended]));
    let mut summary = missed_summary();
    let floor = summary.floor.as_mut().unwrap();
    let area = |reason, x| Area { reason, at: Point::new(x, 0.0), area_m2: 90.0, ..floor.missed[0].clone() };
    let added = [area(MissReason::NotAsked, -5.0), area(MissReason::NotReached, 6.0)];
    floor.missed.splice(0..0, added);
    let result = RunResult {
        summary: Box::new(summary),
        name: Some(found().runs[0].name.clone()),
        kept: "run kept".into(),
        is_kept: true,
    };
    screen.hear(RunMsg::Closed(Box::new(result)));
    screen
}

/// The boundary of the eastern half.
fn east() -> Vec<Vec<Point>> {
    let corner = |x, y| Point::new(x, y);
    vec![vec![corner(0.0, -20.0), corner(20.0, -20.0), corner(20.0, 20.0), corner(0.0, 20.0)]]
}

/// Shows the same run on the Review screen.
fn reviewed(mut screen: Screen, size: (u16, u16)) -> Screen {
    let summary = screen.model.live.result.as_ref().map(|result| result.summary.clone());
    let run = Run { log: Log::default(), ..screen.model.live.run.clone() };
    screen.send(Msg::Found(Box::new(found())));
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    screen.type_text("6");
    let selected = screen.model.review.run(&screen.model.home).unwrap();
    let key = (selected.name.clone(), selected.end.clone());
    screen.send(Msg::Glimpsed(key, Ok(Box::new(Glimpse { run, summary, ..Glimpse::default() }))));
    screen
}

fn resulted(mut screen: Screen, size: (u16, u16)) -> Screen {
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    screen.type_text("7");
    screen
}

/// The number of cells drawn in a role.
fn count(screen: &Screen, size: (u16, u16), letter: char) -> usize {
    roles(&screen.model, RICH, size).matches(letter).count()
}

#[test]
fn floor_that_was_not_requested_is_quiet_and_in_the_legend_of_both_screens() {
    for size in SIZES {
        for show in [resulted, reviewed] {
            let [half, whole] = [east(), vec![]].map(|regions| {
                let mut screen = half_requested(regions);
                // Without a plan, all floor that was requested and not scanned is missed.
                screen.model.live.run.planning.plan = None;
                show(screen, size)
            });
            let shown = text(&drawn(&half.model, RICH, size));
            assert!(shown.contains("⋅⋅  not requested") && shown.contains("missed"), "{shown}");
            let without = text(&drawn(&whole.model, RICH, size));
            assert!(!without.contains("⋅⋅  not requested"), "{without}");
            let [red, all_red] = [&half, &whole].map(|screen| count(screen, size, 'm'));
            assert!(red < all_red, "{size:?}: {red} and {all_red} missed cells\n{shown}");
        }
    }
}

#[test]
fn both_screens_number_the_areas_alike_and_list_what_was_not_requested_on_neither() {
    let screen = half_requested(east());
    let listed = screen.model.live.missed();
    let reasons: Vec<MissReason> = listed.iter().map(|area| area.reason).collect();
    assert!(!reasons.contains(&MissReason::NotAsked), "{reasons:?}");
    assert_eq!(reasons.last(), Some(&MissReason::NotReached), "after the areas that were missed");
    let last = listed.len().to_string();
    for size in SIZES {
        for show in [resulted, reviewed] {
            let screen = show(screen.clone(), size);
            let buffer = drawn(&screen.model, RICH, size);
            let letters = roles(&screen.model, RICH, size);
            let is_dim_number = text(&buffer).lines().zip(letters.lines()).any(|(line, roles)| {
                let cells = line.chars().zip(roles.chars()).collect::<Vec<_>>();
                cells.windows(3).any(|cells| {
                    cells[1].0.to_string() == last
                        && cells[1].1 == 'd'
                        && cells[0].0 != ' '
                        && !cells[0].0.is_alphanumeric()
                        && !cells[2].0.is_alphanumeric()
                })
            });
            assert!(is_dim_number, "the area that was not reached has number {last}\n{}", text(&buffer));
        }
    }
}
