//! The mission as text: the document beside the map, and the properties of the recording.

use super::tables;
use crate::rr;
use account::Account;
use mission::{Outcome, PlannerChoice, PlannerInfo, TaskConfig, event::RunOpened};
use std::{fmt::Write, sync::Arc};
use world::Boundary;

/// A planner that was active in this run.
pub(crate) struct Driver {
    pub choice: PlannerChoice,
    pub info: PlannerInfo,
}

/// The content of the document.
pub(crate) struct Document {
    run: RunOpened,
    drivers: Vec<Driver>,
    end: Option<(Outcome, String)>,
    floor: Option<Account>,
}

impl Document {
    pub(crate) fn new(run: RunOpened) -> Self {
        Self { run, drivers: Vec::new(), end: None, floor: None }
    }

    pub(crate) fn planner_chosen(&mut self, choice: &PlannerChoice, info: &PlannerInfo) {
        self.drivers.push(Driver { choice: choice.clone(), info: info.clone() });
    }

    pub(crate) fn parameters_changed(&mut self, choice: &PlannerChoice) {
        if let Some(driver) = self.drivers.last_mut() {
            driver.choice = choice.clone();
        }
    }

    pub(crate) fn ended(&mut self, outcome: Outcome, reason: &str) {
        self.end = Some((outcome, reason.to_owned()));
    }

    pub(crate) fn accounted(&mut self, floor: Option<Account>) {
        self.floor = floor;
    }

    /// Properties that are known from the start.
    pub(crate) fn run_properties(&self) -> rr::AnyValues {
        let run = &self.run;
        rr::AnyValues::default()
            .with_component::<rr::Text>("scenario", [run.scenario.as_str()])
            .with_component_from_data("seed", Arc::new(rr::UInt64Array::from(vec![run.seed])) as rr::ArrayRef)
            .with_component::<rr::Text>("tankops_version", [run.tankops_version.as_str()])
            .with_component::<rr::Text>("journal_version", [run.journal_version.to_string()])
    }

    /// Properties of the planners so far, in the order in which they were active.
    pub(crate) fn planner_properties(&self) -> rr::AnyValues {
        let texts = |text: fn(&Driver) -> String| self.drivers.iter().map(text).collect::<Vec<_>>();
        rr::AnyValues::default()
            .with_component::<rr::Text>("planner", texts(|driver| driver.info.id.clone()))
            .with_component::<rr::Text>("version", texts(|driver| driver.info.version.clone()))
            .with_component::<rr::Text>("plugin", texts(|driver| driver.info.plugin.clone()))
            .with_component::<rr::Text>("plugin_sha256", texts(|driver| driver.info.sha256.clone()))
            .with_component::<rr::Text>("parameters", texts(|driver| parameters(&driver.choice)))
    }

    /// Properties of the end; absent if the run did not end normally.
    pub(crate) fn end_properties(&self) -> Option<rr::AnyValues> {
        let (outcome, reason) = self.end.as_ref()?;
        let values = rr::AnyValues::default()
            .with_component::<rr::Text>("outcome", [outcome.word()])
            .with_component::<rr::Text>("reason", [reason.as_str()]);
        Some(values)
    }

    /// The document beside the map.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("# {}\n\n", self.run.scenario);
        if let Some((outcome, reason)) = &self.end {
            let _ = writeln!(text, "**{}**: {reason}\n", outcome.word());
        }
        self.table(&mut text);
        if let Some(floor) = &self.floor {
            text.push_str(&tables::floor(floor, self.end.is_some()));
        }
        for driver in &self.drivers {
            driver.describe(&mut text);
        }
        text.push_str(LEGEND);
        text
    }

    fn table(&self, text: &mut String) {
        let (run, mission) = (&self.run, &self.run.mission);
        let hidden = run.world.obstacles.iter().filter(|obstacle| !obstacle.known).count();
        let rows = [
            ("seed", run.seed.to_string()),
            ("tank", tank(&run.world.boundary)),
            ("obstacles", format!("{}, {hidden} of them not on the drawing", run.world.obstacles.len())),
            ("stations", run.world.stations.len().to_string()),
            ("task", task(&mission.task)),
            ("tick", format!("{} s", mission.tick_s)),
            ("swath", format!("{} m", mission.swath_m)),
            ("required clearance", format!("{} m", mission.clearance_m)),
            ("position error limit (95 %)", format!("{} m", mission.position_limit_m)),
            ("tankops", run.tankops_version.clone()),
        ];
        text.push_str("| item | value |\n|---|---|\n");
        for (name, value) in rows {
            let _ = writeln!(text, "| {name} | {value} |");
        }
    }
}

impl Driver {
    fn describe(&self, text: &mut String) {
        let info = &self.info;
        let _ = writeln!(text, "\n## {}\n\n`{}` {}: {}\n", info.name, info.id, info.version, info.about);
        let _ = writeln!(text, "Plugin `{}`, sha256 `{}`, ABI {}.\n", info.plugin, info.sha256, info.abi);
        if !self.choice.parameters.is_empty() {
            text.push_str("| parameter | value |\n|---|---|\n");
        }
        for (key, value) in &self.choice.parameters {
            let unit = info
                .parameters
                .iter()
                .find(|parameter| parameter.key == *key)
                .map_or("", |found| &found.unit);
            let _ = writeln!(text, "| {key} | {value} {unit} |");
        }
    }
}

const LEGEND: &str = "
## How to read the map

Green is the true position of the robot, pink its estimated position, with the ellipse that should contain the true
position in 95 of 100 cases. The bar across the robot is its tool; the key below the tank explains the colours of the
floor. Red outlines are obstacles on the drawing; dark red outlines are obstacles still to be found; orange outlines are
obstacles that were found, drawn where the robot estimates them to be. Yellow lines are acoustic-emission ranges; red
lines are ranges that were left out of the fix. Arrows are the planner's forces; their length grows with the logarithm of
the force.

## How to read the plots

Error: pink is the true error, blue the 95 % error. Speed: green is the true speed, blue the speed sent. Tether: pink is
the length paid out, green the true length out, blue the return path, with gaps where the hull does not fit through it. Wraps:
orange is the largest, blue the total. Forces have the colours of their arrows. On the timeline `utc`, a run starts at
the time in its name and continues in mission time.
";

fn parameters(choice: &PlannerChoice) -> String {
    choice.parameters.iter().map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join(", ")
}

fn tank(boundary: &Boundary) -> String {
    match boundary {
        Boundary::Circle { radius_m } => format!("round, radius {radius_m} m"),
        Boundary::Polygon { vertices } => format!("{} walls, {:.1} m²", vertices.len(), boundary.area_m2()),
    }
}

fn task(task: &TaskConfig) -> String {
    match task {
        TaskConfig::Goto { goal, .. } => format!("go to {:.2}, {:.2} m", goal.x, goal.y),
        TaskConfig::Follow { path, .. } => {
            format!("follow {} points over {:.1} m", path.len(), world::polyline::length_m(path))
        }
        TaskConfig::Survey { .. } => "make a map of the floor".into(),
        TaskConfig::Cover { regions, .. } if regions.is_empty() => "scan the floor".into(),
        TaskConfig::Cover { regions, .. } if regions.len() == 1 => "scan 1 area of the floor".into(),
        TaskConfig::Cover { regions, .. } => format!("scan {} areas of the floor", regions.len()),
    }
}
