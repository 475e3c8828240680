//! The identity of the floor of a run, so that no report mixes two floors.

use crate::{difference::first_difference, past_run::PastRun};
use account::Inspection;
use mission::RunOpened;
use planner_api::Motion;
use serde::{Deserialize, Serialize};
use world::{Boundary, PlateLayout, Shape, Zone};

/// The parts of a scenario outside the mission.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Stated {
    /// The facts that only people know.
    pub(crate) inspection: Inspection,
    /// SHA-256 of the journals of the runs that this re-scan continues, hexadecimal; empty for any other run.
    pub(crate) continues_sha256: Vec<String>,
}

impl Stated {
    /// Reads these parts from the scenario of a run.
    ///
    /// # Errors
    /// The scenario is not valid TOML: the journal was changed.
    pub(crate) fn by(run: &RunOpened) -> Result<Self, String> {
        Self::read(&run.scenario_toml)
    }

    fn read(scenario_toml: &str) -> Result<Self, String> {
        toml::from_str(scenario_toml)
            .map_err(|error| format!("the scenario in its journal cannot be read: {}", error.message()))
    }
}

/// The SHA-256 of the journals of the runs that a re-scan continues, hexadecimal; empty for any other run.
///
/// # Errors
/// The scenario is not valid TOML: the journal was changed.
pub fn continued(scenario_toml: &str) -> Result<Vec<String>, String> {
    Ok(Stated::read(scenario_toml)?.continues_sha256)
}

/// The facts that identify the floor; any difference counts.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub(crate) struct FloorFacts {
    tank_id: Option<String>,
    site: Option<String>,
    drawing: Option<String>,
    nominal_thickness_mm: Option<f64>,
    datum_crs: Option<String>,
    datum_m: Option<[f64; 2]>,
    datum_north_deg: Option<f64>,
}

impl FloorFacts {
    pub(crate) fn of(facts: &Inspection) -> Self {
        let text = |fact: &Option<String>| fact.as_deref().map(str::trim).map(str::to_owned);
        Self {
            tank_id: text(&facts.tank_id),
            site: text(&facts.site),
            drawing: text(&facts.drawing),
            nominal_thickness_mm: facts.nominal_thickness_mm,
            datum_crs: text(&facts.datum_crs),
            datum_m: facts.datum_m,
            datum_north_deg: facts.datum_north_deg,
        }
    }

    /// The facts; a fact that is missing is taken from `others`.
    fn or(self, others: &Self) -> Self {
        let others = others.clone();
        Self {
            tank_id: self.tank_id.or(others.tank_id),
            site: self.site.or(others.site),
            drawing: self.drawing.or(others.drawing),
            nominal_thickness_mm: self.nominal_thickness_mm.or(others.nominal_thickness_mm),
            datum_crs: self.datum_crs.or(others.datum_crs),
            datum_m: self.datum_m.or(others.datum_m),
            datum_north_deg: self.datum_north_deg.or(others.datum_north_deg),
        }
    }
}

/// Compares an inspector's facts with the scenario of the run; returns a sentence for the first contradiction about
/// the floor. A fact that is missing on one side is not a contradiction. `sampled_mm` is the thickness of the plates that
/// the instrument of the run was set to, millimetres.
pub(crate) fn contradiction(
    facts: &Inspection,
    flown: &Inspection,
    sampled_mm: Option<f64>,
) -> Option<String> {
    of_floor(facts, flown).or_else(|| {
        let (stated_mm, sampled_mm) = (facts.nominal_thickness_mm?, sampled_mm?);
        ((stated_mm - sampled_mm).abs() > 1e-9).then(|| {
            format!(
                "nominal_thickness_mm is {stated_mm}, but instrument.thickness_mm, from which every loss was computed, \
                 is {sampled_mm} in the scenario of the run"
            )
        })
    })
}

fn of_floor(facts: &Inspection, flown: &Inspection) -> Option<String> {
    let (facts, flown) = (FloorFacts::of(facts), FloorFacts::of(flown));
    let flown = flown.or(&facts);
    let [facts, flown] = [facts.or(&flown), flown].map(|side| serde_json::to_value(side).ok());
    let found = first_difference(&facts?, &flown?)?;
    Some(format!("{} is {}, but {} in the scenario of the run", found.key, found.one, found.other))
}

/// Everything that identifies a floor or determines what counts as scanned on it, with the names used in messages.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Identity {
    inspection: FloorFacts,
    tank: Boundary,
    obstacles: Vec<Outline>,
    zones: Vec<Zone>,
    plates: Option<PlateLayout>,
    #[serde(rename = "mission.cell_m")]
    cell_m: f64,
    // The facts that a page states once for all of its runs.
    #[serde(rename = "mission.swath_m")]
    swath_m: f64,
    #[serde(rename = "robot.motion")]
    motion: Motion,
    #[serde(rename = "robot.radius_m")]
    radius_m: f64,
    #[serde(rename = "mission.clearance_m")]
    clearance_m: f64,
}

/// An obstacle, whether drawn or still to be found.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Outline {
    name: String,
    shape: Shape,
}

impl Identity {
    /// The identity of the floor of a run. Zones that an operator drew in any of the runs do not count: they say where a
    /// robot was allowed to drive, not on which floor.
    fn of(run: &RunOpened, stated: &Stated, drawn: &[&Zone]) -> Self {
        let is_drawn =
            |zone: &&Zone| drawn.iter().any(|drawn| drawn.kind == zone.kind && drawn.shape == zone.shape);
        let outline = |obstacle: &world::Obstacle| Outline {
            name: obstacle.name.clone(),
            shape: obstacle.shape.clone(),
        };
        Self {
            inspection: FloorFacts::of(&stated.inspection),
            tank: run.world.boundary.clone(),
            obstacles: run.world.obstacles.iter().map(outline).collect(),
            zones: run.world.zones.iter().filter(|zone| !is_drawn(zone)).cloned().collect(),
            plates: run.plates.clone(),
            cell_m: run.floor.cell_m,
            swath_m: run.mission.swath_m,
            motion: run.mission.limits.motion,
            radius_m: run.mission.limits.radius_m,
            clearance_m: run.mission.clearance_m,
        }
    }

    /// The first difference from another floor, as a sentence about the runs with these names.
    fn difference(&self, name: &str, other: &Self, other_name: &str) -> Option<String> {
        let [one, two] = [self, other].map(|side| serde_json::to_value(side).ok());
        let found = first_difference(&one?, &two?)?;
        Some(format!("{} is {} in {name} and {} in {other_name}", found.key, found.one, found.other))
    }
}

/// A run to be combined with others.
struct Candidate<'a> {
    name: &'a str,
    scenario: &'a str,
    journal_sha256: Option<&'a str>,
    stated: Stated,
    identity: Identity,
}

impl<'a> Candidate<'a> {
    fn of(past: &'a PastRun, drawn: &[&Zone]) -> Result<Option<Self>, String> {
        let Some(run) = past.fold.run() else { return Ok(None) };
        let stated = Stated::by(run).map_err(|why| format!("run {}: {why}", past.name))?;
        Ok(Some(Self {
            name: &past.name,
            scenario: &run.scenario,
            journal_sha256: past.files.journal_sha256.as_deref(),
            identity: Identity::of(run, &stated, drawn),
            stated,
        }))
    }

    fn continues(&self, other: &Self) -> bool {
        other.journal_sha256.is_some_and(|sha256| self.stated.continues_sha256.iter().any(|of| of == sha256))
    }

    /// Whether two runs are known to be on the same floor: one continues the other, or both have the same scenario.
    fn is_linked(&self, other: &Self) -> bool {
        let is_same =
            self.scenario == other.scenario && self.stated.continues_sha256 == other.stated.continues_sha256;
        is_same || self.continues(other) || other.continues(self)
    }
}

/// Refuses runs that are not all on one floor, or that differ in the conditions for scanned floor; the error names the
/// first difference and both values. A run with a different scenario must be a re-scan that names the journal of one of
/// the other runs.
pub(crate) fn require_one_floor(runs: &[PastRun]) -> Result<(), String> {
    let drawn: Vec<&Zone> = runs.iter().flat_map(zones_drawn).collect();
    let all = runs.iter().map(|past| Candidate::of(past, &drawn)).collect::<Result<Vec<_>, _>>()?;
    let all: Vec<Candidate<'_>> = all.into_iter().flatten().collect();
    let Some((first, others)) = all.split_first() else { return Ok(()) };
    let refused = |other: &Candidate<'_>, why: &str| {
        format!("runs {} and {} are not on the same floor: {why}", first.name, other.name)
    };
    for other in others {
        if let Some(why) = first.identity.difference(first.name, &other.identity, other.name) {
            return Err(refused(other, &why));
        }
    }
    match unlinked(&all) {
        Some(other) => Err(refused(other, &no_link(first, other))),
        None => Ok(()),
    }
}

/// The zones that were drawn after the scenario of a run was opened; they follow those of the scenario.
fn zones_drawn(past: &PastRun) -> &[Zone] {
    let zones = past.fold.run().map_or(&[][..], |run| &run.world.zones);
    &zones[zones.len().saturating_sub(past.summary.zones_drawn.len())..]
}

/// The first run that is not linked to the other runs.
fn unlinked<'a, 'b>(all: &'b [Candidate<'a>]) -> Option<&'b Candidate<'a>> {
    let (mut linked, mut rest): (Vec<&Candidate<'_>>, Vec<&Candidate<'_>>) =
        (all.iter().take(1).collect(), all.iter().skip(1).collect());
    loop {
        let is_linked = |run: &&Candidate<'_>| linked.iter().any(|other| run.is_linked(other));
        let (more, left): (Vec<_>, Vec<_>) = rest.into_iter().partition(is_linked);
        if more.is_empty() {
            return left.first().copied();
        }
        linked.extend(more);
        rest = left;
    }
}

/// The reason why two runs are not linked.
fn no_link(first: &Candidate<'_>, other: &Candidate<'_>) -> String {
    let digest = |run: &Candidate<'_>| run.journal_sha256.unwrap_or("no digest").to_owned();
    let continuing = [first, other].into_iter().find(|run| !run.stated.continues_sha256.is_empty());
    match continuing {
        Some(run) => {
            let beside = if std::ptr::eq(run, first) { other } else { first };
            format!(
                "continues_sha256 of {} is {}, but the journal of {} has the SHA-256 {}; also give the run \
                 that is continued",
                run.name,
                run.stated.continues_sha256.join(" and "),
                beside.name,
                digest(beside)
            )
        }
        None => format!(
            "name is {} in {} and {} in {}, and neither run is a re-scan of the other (`tankops rescan` \
             writes continues_sha256, which links a re-scan to the journal that it continues)",
            first.scenario, first.name, other.scenario, other.name
        ),
    }
}

#[cfg(test)]
mod tests;
