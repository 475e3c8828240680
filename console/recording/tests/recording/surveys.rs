//! The map of a survey in a recording.

use crate::{content::Content, recorder::recorded, recorder::rows, synthetic};
use exploration::{Column, Grid, SurveyMap};
use mission::{
    Event, EventKind, Outcome, TaskConfig,
    event::{Explored, SurveyGoal, SurveyWay},
};
use world::Point;

/// A survey of the made-up tank with two reports, the second of which adds half of the floor, and a map.
fn survey() -> (Vec<Event>, Grid) {
    let mut opened = synthetic::opened();
    opened.mission.task = TaskConfig::Survey { anchor: Point::origin(), tolerance_m: 0.2 };
    let grid = Grid::of(&opened.world.boundary);
    let column =
        Column { center: Point::new(2.0, 1.0), radius_m: 0.3, center_sigma_m: 0.01, radius_sigma_m: 0.01 };
    let report = |share: f64, cells: String, columns: Vec<Column>| {
        let frontiers = vec![Point::new(0.0, 2.0), Point::new(1.0, -2.0)];
        EventKind::Explored(Explored { share, frontiers, columns, cells })
    };
    let half = grid.len() / 2;
    let map = SurveyMap {
        grid: grid.clone(),
        cells: format!("{half}f{}u", grid.len() - half),
        columns: vec![column],
        others: Vec::new(),
        explored: 0.5,
    };
    let way = SurveyWay {
        to: SurveyGoal::Frontier,
        path: vec![Point::origin(), Point::new(0.0, 2.0)],
        length_m: 2.0,
        beyond_tether: 0,
    };
    let kinds = [
        EventKind::RunOpened(Box::new(opened)),
        EventKind::SurveyWay(way),
        report(0.1, "5f".into(), Vec::new()),
        report(0.5, format!("5={}f", half - 5), vec![column]),
        report(0.5, String::new(), vec![column]),
        EventKind::Mapped { map: Box::new(map) },
        EventKind::Ended { outcome: Outcome::Complete, reason: "back at the start".into() },
    ];
    let event = |(tick, kind)| Event { tick, t_s: tick as f64 * 0.1, kind };
    ((0..).zip(kinds).map(event).collect(), grid)
}

fn values(content: &Content, entity: &str, component: &str) -> Vec<String> {
    rows(content, entity, component).iter().map(|(_, value)| value.clone()).collect()
}

#[test]
fn the_map_its_columns_and_its_frontiers_are_recorded() {
    let (events, grid) = survey();
    let content = recorded(&events);
    let shares = values(&content, "scalars/explored", "Scalars:scalars");
    assert_eq!(shares, ["10.0", "50.0", "50.0", "50.0"]);
    let images = values(&content, "map/world/explored", "SegmentationImage:buffer");
    // A report without changes needs no image.
    assert_eq!(images.len(), 3, "{}", images.len());
    let free = |image: &String| {
        let cells = image.trim_start_matches('[').trim_end_matches(']').split(", ");
        cells.filter(|cell| *cell == "1").count()
    };
    assert_eq!(images.iter().map(free).collect::<Vec<_>>(), [5, grid.len() / 2, grid.len() / 2]);
    let columns = values(&content, "map/world/explored_columns", "LineStrips2D:labels");
    assert!(columns[1].contains("radius 0.30 ±0.02 m"), "{columns:?}");
    let frontiers = values(&content, "map/world/frontiers", "Points2D:positions");
    assert_eq!(frontiers.len(), 4, "{frontiers:?}");
    assert!(frontiers[3].is_empty(), "none is left at the end: {frontiers:?}");
    assert_eq!(values(&content, "map/world/path/planned", "LineStrips2D:strips").len(), 1);
    assert!(!content.keys().any(|(entity, _)| entity == "map/world/coverage"), "a survey scans nothing");
}
