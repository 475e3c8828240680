//! Two surveys of one tank floor, compared: one model, written as HTML, JSON and CSV.

mod html;
mod map;
mod sections;
mod side;
mod tables;

pub use html::two_surveys_html;
pub use tables::{TWO_SURVEYS_SUFFIXES, two_surveys_tables};

use super::{layers::Layers, maps::Figure};
use crate::{joined::joined_or_located, past_run::PastRun};
use account::Inspection;
use jiff::{ToSpan, civil};
use serde::Serialize;
use side::{Side, contradiction};
use surveys::{Basis, Growth, Indication, Landmark, Outlook, PlateRate, Refusal, Registration, compare};

/// Version of the comparison as JSON.
const VERSION: u32 = 1;
/// Days of a year, for rates.
const DAYS_PER_YEAR: f64 = 365.25;
/// The most years for which a date is stated.
const MOST_YEARS: f64 = 100.0;
/// The label of the calculated date.
const NOTICE: &str =
    "A calculation for the inspector's judgement. It claims no conformity with any standard.";

/// A run with the survey of a floor.
#[derive(Debug)]
pub struct Surveyed<'a> {
    /// The run.
    pub past: &'a PastRun,
    /// The facts that only people know; `inspected_on` is the day of the survey.
    pub inspection: Inspection,
}

/// A survey in a comparison.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SurveyPart {
    /// Name of the run's folder.
    pub run: String,
    /// Day of the survey.
    pub inspected_on: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Number of the tank.
    pub tank_id: Option<String>,
    /// Method and model of the instrument.
    pub instrument: String,
    /// Number of readings.
    pub readings: u64,
    /// The tested floor, square metres.
    pub tested_m2: f64,
    /// Number of indications.
    pub indications: usize,
    /// SHA-256 of the journal, hexadecimal.
    pub journal_sha256: Option<String>,
    /// SHA-256 of the readings, hexadecimal.
    pub readings_sha256: Option<String>,
    /// The problems found with the files of the run.
    pub doubts: Vec<String>,
    /// Where the survey was cut off, and who closed the run; absent for a run that reached its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut_off: Option<String>,
}

/// A loss of metal that both surveys show.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Grown {
    /// The indication in the first survey, in its own frame.
    pub first: Indication,
    /// The indication in the second survey, in its own frame.
    pub second: Indication,
    /// Distance between the two places after the registration, metres.
    pub apart_m: f64,
    /// Number of other indications that could be the same loss by place alone.
    pub rivals: usize,
    /// Whether one of the two is cut by untested floor, so that the growth is not known.
    pub is_cut: bool,
    /// The growth.
    pub growth: Growth,
}

impl Grown {
    /// Whether it grew by more than the 95 % error.
    fn is_grown(&self) -> bool {
        !self.is_cut && self.growth.interval_mm[0] > 0.0
    }
}

/// An indication that only one survey shows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Single {
    /// The indication, in the frame of its survey.
    pub indication: Indication,
    /// Whether the other survey tested its place.
    pub is_tested: bool,
    /// Number of the larger indication of the other survey of which it is a part; absent if it is not a part.
    pub part_of: Option<usize>,
}

impl Single {
    /// Whether the other survey tested its place and shows no loss there: the indication is new, or gone.
    fn is_alone(&self) -> bool {
        self.is_tested && self.part_of.is_none()
    }
}

/// The calculated date.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Due {
    /// What the number is, and what it is not.
    pub notice: &'static str,
    /// The formula.
    pub formula: &'static str,
    /// Number of the governing indication in the second survey.
    pub number: usize,
    /// The inputs and the result.
    pub outlook: Outlook,
    /// The date; absent if it is more than 100 years away.
    pub date: Option<String>,
}

/// Two surveys of one floor, compared.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TwoSurveys {
    /// Version of this format.
    pub comparison_version: u32,
    /// Name and version of the program that compared the surveys.
    pub made_by: String,
    /// Whether a survey was simulated.
    pub is_simulation: bool,
    /// The earlier survey.
    pub first: SurveyPart,
    /// The later survey.
    pub second: SurveyPart,
    /// Years between the surveys, of 365.25 days.
    pub years: f64,
    /// How the second survey lies in the frame of the first one.
    pub registration: Registration,
    /// The losses that both surveys show.
    pub matched: Vec<Grown>,
    /// The indications that only the second survey shows.
    pub new: Vec<Single>,
    /// The indications that only the first survey shows.
    pub gone: Vec<Single>,
    /// The plates with indications.
    pub plates: Vec<PlateRate>,
    /// The calculated date of the next inspection; absent without a least thickness, or if no indication grows.
    pub due: Option<Due>,
    /// The least thickness for that date, millimetres, if one was given.
    pub minimum_mm: Option<f64>,
    #[serde(skip)]
    map: Figure,
}

/// The formula of the calculated date.
const FORMULA: &str = "date = date of the second survey + (t − d − e − t_min) / r";

impl TwoSurveys {
    /// Compares two surveys, the earlier one first. `minimum_mm` is the least thickness that the inspector accepts, from
    /// which the date of the next inspection is calculated.
    ///
    /// # Errors
    /// A run has no readings of an instrument or no date, the second survey is not later or is the same run, the tanks
    /// differ, or the least thickness is not below the nominal one.
    pub fn new(surveyed: &[Surveyed<'_>; 2], minimum_mm: Option<f64>, version: &str) -> Result<Self, String> {
        let [a, b] = surveyed.each_ref().map(|one| joined_or_located(std::slice::from_ref(one.past)));
        let (a, b) = (a?, b?);
        let layers = [&a, &b].map(|all| Layers::new(all.run, &all.scanned, &all.evidence, &[]));
        let [first, second] = [0, 1].map(|k| Side::read(&surveyed[k], &layers[k]));
        let (first, second) = (first?, second?);
        if let Some(why) = contradiction([&surveyed[0].inspection, &surveyed[1].inspection]) {
            return Err(format!("the tanks differ: {why}"));
        }
        let nominal_mm = second.survey.thickness_mm;
        if let Some(mm) = minimum_mm.filter(|mm| *mm >= nominal_mm) {
            return Err(format!(
                "the least thickness, {mm} mm, is not below the nominal thickness of the floor, {nominal_mm} mm \
                 (instrument.thickness_mm); give a smaller one"
            ));
        }
        let days = first.date.until(second.date).map_or(0, |span| span.get_days());
        let years = f64::from(days) / DAYS_PER_YEAR;
        let tested = |place| first.is_tested(place);
        let tested_again = |place| second.is_tested(place);
        let found = compare([&first.survey, &second.survey], years, [&tested, &tested_again])
            .map_err(|why| refused(&why, [&first.part, &second.part]))?;
        if first.part.journal_sha256.is_some() && first.part.journal_sha256 == second.part.journal_sha256 {
            return Err(format!(
                "both surveys are one run: {} and {} have the same journal; give the runs of two surveys",
                first.part.run, second.part.run
            ));
        }
        let outlook = minimum_mm.and_then(|mm| Outlook::of(&found, &second.survey, mm));
        let due = outlook.map(|outlook| due(outlook, &second));
        let (of_first, of_second) = (&first.survey.indications, &second.survey.indications);
        let single = |all: &[Indication], others: &[Indication], one: &surveys::Unmatched| Single {
            indication: all[one.index].clone(),
            is_tested: one.is_tested,
            part_of: one.part_of.map(|whole| others[whole].number),
        };
        let grown = |(pair, growth): &(surveys::Match, Growth)| Grown {
            first: of_first[pair.first].clone(),
            second: of_second[pair.second].clone(),
            apart_m: pair.apart_m,
            rivals: pair.rivals,
            is_cut: pair.is_cut,
            growth: *growth,
        };
        let mut comparison = Self {
            comparison_version: VERSION,
            made_by: format!("tankops {version}"),
            is_simulation: first.is_simulation || second.is_simulation,
            first: first.part,
            second: second.part,
            years,
            matched: found.matched.iter().map(grown).collect(),
            new: found.new.iter().map(|one| single(of_second, of_first, one)).collect(),
            gone: found.gone.iter().map(|one| single(of_first, of_second, one)).collect(),
            registration: found.registration,
            plates: found.plates,
            due,
            minimum_mm,
            map: Figure::default(),
        };
        comparison.map = map::map(&comparison, &layers[0]);
        Ok(comparison)
    }
}

/// The date of an outlook.
fn due(outlook: Outlook, second: &Side) -> Due {
    let days = (outlook.years * DAYS_PER_YEAR).floor();
    let date = (outlook.years <= MOST_YEARS).then(|| second.date.checked_add((days as i64).days()).ok());
    let number = second.survey.indications[outlook.second].number;
    let date = date.flatten().map(|date: civil::Date| date.to_string());
    Due { notice: NOTICE, formula: FORMULA, number, outlook, date }
}

fn refused(why: &Refusal, [first, second]: [&SurveyPart; 2]) -> String {
    match why {
        Refusal::NotLater => format!(
            "run {} was surveyed on {} and run {} on {}: the second survey must be later; swap the runs, or correct \
             inspection.inspected_on",
            first.run, first.inspected_on, second.run, second.inspected_on
        ),
        _ => format!("{why} (first: run {}, second: run {})", first.run, second.run),
    }
}

/// The name of a kind of landmark.
fn landmark(of: Landmark) -> &'static str {
    match of {
        Landmark::Shell => "Shell",
        Landmark::Columns => "Columns and other drawn obstacles",
        Landmark::Plates => "Plates",
    }
}

/// How the rate of the governing indication was found, in words.
fn basis(of: Basis) -> &'static str {
    match of {
        Basis::Matched => "upper end of the 95 % interval of its rate",
        Basis::WholeDepth => {
            "new, a part of a larger indication, or cut by untested floor: its depth and 95 % error, divided by the years between the surveys, as if \
             all of it had grown since the first survey"
        }
    }
}
