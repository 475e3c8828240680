//! The map of a past survey.

use exploration::{SurveyMap, column_numbers};
use flight::{failure::bad_input, planners::COVERAGE_PLANNER};
use mission::{EventKind, RunOpened};
use recording::{Ticks, journal_of};
use runs::{Standing, standing};
use scenario::{Scenario, cover_of_map};
use std::{collections::BTreeMap, path::Path};

/// A past survey.
pub struct PastSurvey {
    /// The first event of its run.
    pub opened: RunOpened,
    /// The map that it made.
    pub map: SurveyMap,
    /// The numbers of its columns, as in the log and on the screen.
    pub numbers: Vec<usize>,
}

/// The survey of the run in a folder.
///
/// # Errors
/// The journal cannot be read or is not as its report states, the run is in progress or was not a survey, or it ended
/// without a map.
pub fn past_survey(folder: &Path) -> anyhow::Result<PastSurvey> {
    let mut ticks = Ticks::open(&journal_of(folder))?;
    let opened = ticks.opened()?.clone();
    let (mut map, mut found) = (None, BTreeMap::new());
    while let Some(tick) = ticks.next_tick()? {
        for event in tick.events() {
            match event {
                EventKind::Mapped { map: made } => map = Some(SurveyMap::clone(made)),
                EventKind::ObstacleFound { obstacle } => {
                    found.insert(obstacle.id, (obstacle.name.clone(), obstacle.shape.center()));
                }
                EventKind::ObstacleMoved { id, obstacle } => {
                    found.entry(*id).and_modify(|(_, at)| *at = obstacle.shape.center());
                }
                _ => {}
            }
        }
    }
    let name = folder.display();
    let refused = |why: &str| bad_input(format!("{name}: {why}"));
    if !opened.mission.task.is_survey() {
        let why = "the run made no map; choose a run of a scenario with mission.kind = \"survey\"";
        return Err(refused(why));
    }
    match standing(folder) {
        Standing::Running if map.is_none() => {
            return Err(refused("the survey is in progress; end it, or wait until it has ended"));
        }
        // A robot must not drive by a map that a person may have changed.
        Standing::JournalOnly { doubt: Some(doubt), .. } => {
            return Err(refused(&format!("{doubt}; restore the files of the run, or survey again")));
        }
        _ => {}
    }
    let map = map.ok_or_else(|| {
        let why = ticks.no_end().unwrap_or_else(|| "the survey ended without a map".into());
        refused(&format!("the journal contains no map: {why}; survey again"))
    })?;
    if map.states().is_none() {
        return Err(refused("the map in the journal is damaged; survey again"));
    }
    let numbers = column_numbers(&map.columns, found.values().map(|(name, at)| (name.as_str(), *at)));
    Ok(PastSurvey { opened, map, numbers })
}

/// The scenario that scans the floor that a survey has mapped, for the console; `None` for a run that was not a survey.
///
/// # Errors
/// The run or its journal cannot be read, or the survey ended without a map.
pub(crate) fn scan_of_map(folder: &Path) -> anyhow::Result<Option<Scenario>> {
    if !Ticks::open(&journal_of(folder))?.opened()?.mission.task.is_survey() {
        return Ok(None);
    }
    let survey = past_survey(folder)?;
    let run = folder.file_name().unwrap_or_default().to_string_lossy();
    let text = cover_of_map(&survey.opened, &run, (&survey.map, &survey.numbers), COVERAGE_PLANNER)
        .map_err(|error| bad_input(format!("{run}: {error}")))?;
    let scenario = Scenario::parse(&text, &format!("the scan of the map of {run}"));
    scenario.map(Some).map_err(|errors| bad_input(errors.render()))
}
