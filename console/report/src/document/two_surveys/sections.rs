//! The texts and tables of the comparison.

use super::{FORMULA, NOTICE, Single, SurveyPart, TwoSurveys, basis, html::SurveysPage, landmark};
use crate::document::{
    page::{Block, Field, Section, Share, Table, Value, Verdict, picture, section},
    words::number,
};
use crate::human::text::counted;
use surveys::{Growth, Indication, SIGMAS_95, TOLERANCE_M};

/// The columns of a table of rates, after the plate or the places.
const MILLIMETRES_A_YEAR: &str = "mm a year";

/// Builds the page of a comparison.
pub(super) fn sections(comparison: &TwoSurveys) -> SurveysPage {
    let tank = tank(comparison);
    let (first, second) = (&comparison.first, &comparison.second);
    // A CSS string ends at a quote or at a line break of any kind.
    let is_end = |letter: char| letter.is_control() || matches!(letter, '\\' | '"');
    let css = |text: String| foreign::markup(&text).replace(is_end, " ");
    let sections = [
        section("Registration", registration(comparison)),
        section("Next inspection", next_inspection(comparison)),
        section("Rates of the plates", plates(comparison)),
        section("Indications in both surveys", matched(comparison)),
        section("New and gone indications", singles(comparison)),
        section("How the figures are computed", method()),
        section("Provenance", provenance(comparison)),
        // The map fills a sheet: before other sections, it would leave the sheet in front of it half empty.
        Section { is_new_sheet: true, ..section("Map", vec![Block::Wide(picture(&comparison.map))]) },
    ];
    SurveysPage {
        title: format!("Two surveys {tank}"),
        css: "",
        head: css(format!("Tank {tank}   |   {} and {}", first.inspected_on, second.inspected_on)),
        foot: css(comparison.made_by.clone()),
        is_simulation: comparison.is_simulation,
        fields: fields(comparison, tank),
        verdict: verdict(comparison),
        shares: shares(comparison),
        sections: (1..).zip(sections).map(|(number, section)| Section { number, ..section }).collect(),
    }
}

fn tank(comparison: &TwoSurveys) -> &str {
    let stated = comparison.second.tank_id.as_ref().or(comparison.first.tank_id.as_ref());
    stated.unwrap_or(&comparison.first.scenario)
}

fn fields(comparison: &TwoSurveys, tank: &str) -> Vec<Field> {
    let field = |class, label, value: String, note: String| Field { class, label, value: value.into(), note };
    let survey = |part: &SurveyPart| (part.inspected_on.clone(), part.run.clone());
    let ((first, first_run), (second, second_run)) = (survey(&comparison.first), survey(&comparison.second));
    let years = format!("{} years", number(comparison.years, 2));
    vec![
        field("w2 b", "Tank", tank.to_owned(), String::new()),
        field("w2 b", "First survey", first, first_run),
        field("w2 e b", "Second survey", second, format!("{second_run}; {years} later")),
    ]
}

fn grown(comparison: &TwoSurveys) -> usize {
    comparison.matched.iter().filter(|pair| pair.is_grown()).count()
}

fn verdict(comparison: &TwoSurveys) -> Verdict {
    let (grown, all) = (grown(comparison), comparison.matched.len());
    let whole = comparison.matched.iter().filter(|pair| !pair.is_cut);
    let fastest = whole.max_by(|a, b| a.growth.mm.total_cmp(&b.growth.mm));
    let fastest = fastest.map_or_else(String::new, |pair| {
        let [low, high] = pair.growth.rate_interval_mm_per_a;
        format!(
            "The fastest, number {} of the second survey, grew by {} mm a year (95 % interval {} to {}).",
            pair.second.number,
            number(pair.growth.rate_mm_per_a, 2),
            number(low, 2),
            number(high, 2)
        )
    });
    let cut_off = [("first", &comparison.first), ("second", &comparison.second)].into_iter();
    let cut_off = cut_off.filter_map(|(which, part)| {
        let why = part.cut_off.as_ref()?;
        Some(format!(
            "The {which} survey is not whole: {why}. Only floor that both surveys tested is compared."
        ))
    });
    let cause: Vec<String> = cut_off.chain((!fastest.is_empty()).then_some(fastest)).collect();
    let reached = comparison.due.as_ref().map(|due| due.outlook).filter(|outlook| outlook.reached > 0);
    let reached_text = reached.map_or_else(String::new, |outlook| {
        format!(
            "{} of the second survey {} reached the least thickness of {} mm. ",
            counted(outlook.reached as u64, "indication"),
            if outlook.reached == 1 { "has" } else { "have" },
            number(outlook.premises.minimum_mm, 1)
        )
    });
    let is_worse = grown > 0 || comparison.new.iter().any(Single::is_alone);
    Verdict {
        class: match (reached, is_worse) {
            (Some(_), _) => "bad",
            (None, true) => "part",
            (None, false) => "",
        },
        lead: format!(
            "{reached_text}{grown} of {all} indications that both surveys show grew by more than their 95 % error; {} are new.",
            comparison.new.iter().filter(|one| one.is_alone()).count()
        ),
        cause: cause.join(" "),
    }
}

fn shares(comparison: &TwoSurveys) -> Vec<Share> {
    let count = |all: &[Single], is: fn(&Single) -> bool| all.iter().filter(|one| is(one)).count();
    let share = |count: usize, of, about: String| Share { value: count.to_string(), unit: "", of, about };
    let not_alone = |all: &[Single], which: &str| {
        let parts = match count(all, |one| one.part_of.is_some()) {
            0 => String::new(),
            parts => format!("; {parts} more are parts of larger indications of the {which} survey"),
        };
        match count(all, |one| one.part_of.is_none() && !one.is_tested) {
            0 => format!("all of them on floor that the {which} survey tested{parts}"),
            untested => format!("{untested} of them on floor that the {which} survey did not test{parts}"),
        }
    };
    let whole = |all: &[Single]| count(all, |one| one.part_of.is_none());
    vec![
        share(
            comparison.matched.len(),
            "in both surveys",
            format!("{} grown by more than the 95 % error", grown(comparison)),
        ),
        share(whole(&comparison.new), "only in the second survey", not_alone(&comparison.new, "first")),
        share(whole(&comparison.gone), "only in the first survey", not_alone(&comparison.gone, "second")),
    ]
}

fn registration(comparison: &TwoSurveys) -> Vec<Block> {
    let found = &comparison.registration;
    let mut table = Table::new(
        "Landmarks of the second survey after it was placed in the frame of the first one: distance to their \
         counterparts in the first survey",
        &[("Landmark", "", ""), ("Number", "", "r"), ("RMS", "m", "r"), ("Greatest", "m", "r")],
    );
    for residual in &found.residuals {
        table.row(vec![
            landmark(residual.of).into(),
            residual.count.to_string().into(),
            number(residual.rms_m, 3).into(),
            number(residual.max_m, 3).into(),
        ]);
    }
    let is_same = found.turn_rad.abs() < 1e-9 && found.shift_m.iter().all(|m| m.abs() < 1e-9);
    let motion = if is_same {
        "Both surveys are drawn in the same frame.".to_owned()
    } else {
        format!(
            "The frame of the second survey was turned by {}° and shifted by ({}, {}) m.",
            number(found.turn_rad.to_degrees(), 2),
            number(found.shift_m[0], 3),
            number(found.shift_m[1], 3)
        )
    };
    let turn = (!found.is_turn_fixed).then(|| {
        Block::Note(
            "Neither columns nor corners nor plates fix the turn of a round tank: both frames were taken to have the \
             same north."
                .into(),
        )
    });
    let note = format!("A landmark without a counterpart within {TOLERANCE_M} m stops the comparison.");
    [Block::Text(motion), Block::Table(table), Block::Note(note)].into_iter().chain(turn).collect()
}

/// Rate and its 95 % interval; a dash without a growth.
fn rate(growth: Option<&Growth>) -> [String; 2] {
    growth.map_or_else(
        || [(); 2].map(|()| "\u{2013}".to_owned()),
        |growth| [number(growth.rate_mm_per_a, 2), interval(growth.rate_interval_mm_per_a)],
    )
}

fn interval([low, high]: [f64; 2]) -> String {
    format!("{} to {}", number(low, 2), number(high, 2))
}

fn plates(comparison: &TwoSurveys) -> Vec<Block> {
    let mut table = Table::new(
        "Plates with indications: the mean rate of the indications in both surveys, weighted by the inverse variances, \
         and the greatest rate",
        &[
            ("Plate", "", "nw"),
            ("In both", "", "r"),
            ("New", "", "r"),
            ("Gone", "", "r"),
            ("Mean rate", MILLIMETRES_A_YEAR, "r"),
            ("95 % interval", MILLIMETRES_A_YEAR, "r nw"),
            ("Greatest rate", MILLIMETRES_A_YEAR, "r"),
            ("95 % interval", MILLIMETRES_A_YEAR, "r nw"),
        ],
    );
    for plate in &comparison.plates {
        let name = if plate.plate.is_empty() { "no plate" } else { &plate.plate };
        let counts = [plate.matched, plate.new, plate.gone].map(|count| count.to_string());
        let rates = [&plate.mean, &plate.greatest].into_iter().flat_map(|growth| rate(growth.as_ref()));
        let cells = std::iter::once(name.to_owned()).chain(counts).chain(rates);
        table.row(cells.map(Value::from).collect());
    }
    let note = "Indications that are cut by untested floor count for no rate. New and gone count only on floor that both surveys tested. The interval of the mean holds the errors of \
                the two surveys, not the differences between the indications of the plate.";
    vec![Block::Table(table), Block::Note(note.into())]
}

fn next_inspection(comparison: &TwoSurveys) -> Vec<Block> {
    let label = Block::Barred(format!("use this as a decision. {NOTICE}"));
    let Some(minimum_mm) = comparison.minimum_mm else {
        let why = "No date was calculated: the least thickness that the inspector accepts is not known. Give it with \
                   --minimum-mm.";
        return vec![Block::Text(why.into())];
    };
    let Some(due) = &comparison.due else {
        let why =
            format!("No date was calculated: no indication grows towards {} mm.", number(minimum_mm, 1));
        return vec![Block::Text(why), label];
    };
    let (outlook, mm) = (&due.outlook, |value: f64| format!("{} mm", number(value, 2)));
    let date = due.date.clone().unwrap_or_else(|| "more than 100 years later".into());
    let facts: Vec<(&'static str, Value)> = vec![
        ("Formula", FORMULA.into()),
        ("Governing indication", format!("number {} of the second survey", due.number).into()),
        ("t, nominal thickness", mm(outlook.premises.thickness_mm).into()),
        ("d, its depth in the second survey", mm(outlook.depth_mm).into()),
        ("e, 95 % error of d", mm(outlook.depth_error_mm).into()),
        ("t_min, least thickness accepted", mm(outlook.premises.minimum_mm).into()),
        (
            "r, rate",
            format!("{} mm a year; {}", number(outlook.rate_mm_per_a, 3), basis(outlook.basis)).into(),
        ),
        ("Date of the second survey", comparison.second.inspected_on.clone().into()),
        ("Years after the second survey", number(outlook.years, 2).into()),
        ("Calculated date", date.into()),
    ];
    let reached = (outlook.reached > 0).then(|| {
        let (count, mm) = (counted(outlook.reached as u64, "indication"), number(minimum_mm, 2));
        let have = if outlook.reached == 1 { "has" } else { "have" };
        let text = format!(
            "By the second survey, {count} {have} already reached the least thickness of {mm} mm, with the 95 % error of \
             the depth. Governing is the deepest one."
        );
        Block::Text(text)
    });
    reached.into_iter().chain([Block::Facts(facts), label]).collect()
}

fn error_mm(one: &Indication) -> String {
    number(SIGMAS_95 * one.depth_sigma_mm, 1)
}

fn matched(comparison: &TwoSurveys) -> Vec<Block> {
    let mut table = Table::new(
        "Depths and growth. The numbers are those of the reports on the two surveys; x and y are in the frame of the \
         first one. Rivals: other indications that could be the same loss by place",
        &[
            ("First", "no.", "r"),
            ("Second", "no.", "r"),
            ("Plate", "", "nw"),
            ("x", "m", "r nw"),
            ("y", "m", "r nw"),
            ("Apart", "cm", "r"),
            ("Rivals", "", "r"),
            ("First depth", "mm", "r nw"),
            ("Second depth", "mm", "r nw"),
            ("Growth", "mm", "r"),
            ("Rate", MILLIMETRES_A_YEAR, "r"),
            ("95 % interval", MILLIMETRES_A_YEAR, "r nw"),
        ],
    );
    for pair in &comparison.matched {
        let depth = |one: &Indication| format!("{} ±{}", number(one.depth_mm, 1), error_mm(one));
        let known = Some(&pair.growth).filter(|_| !pair.is_cut);
        let [rate, interval] = rate(known);
        let growth = known.map_or_else(|| "not known".to_owned(), |growth| number(growth.mm, 2));
        table.row(vec![
            pair.first.number.to_string().into(),
            pair.second.number.to_string().into(),
            pair.second.plate.clone().unwrap_or_default().into(),
            number(pair.first.at.x, 2).into(),
            number(pair.first.at.y, 2).into(),
            number(100.0 * pair.apart_m, 1).into(),
            pair.rivals.to_string().into(),
            depth(&pair.first).into(),
            depth(&pair.second).into(),
            growth.into(),
            rate.into(),
            interval.into(),
        ]);
    }
    if comparison.matched.is_empty() {
        return vec![Block::Text("None.".into())];
    }
    let note = "The growth is not known if untested floor lies beside one of the two: the deepest place of the loss may be \
                there. Such an indication counts for no rate, and with its whole depth for the next inspection.";
    vec![Block::Table(table), Block::Note(note.into())]
}

fn singles(comparison: &TwoSurveys) -> Vec<Block> {
    let list = |caption: &str, all: &[Single], no: &str| {
        let mut table = Table::new(
            caption,
            &[
                ("No.", "", "r"),
                ("Plate", "", "nw"),
                ("x", "m", "r nw"),
                ("y", "m", "r nw"),
                ("Depth", "mm", "r nw"),
                ("The other survey", "", ""),
            ],
        );
        for Single { indication: one, is_tested, part_of } in all {
            table.row(vec![
                one.number.to_string().into(),
                one.plate.clone().unwrap_or_default().into(),
                number(one.at.x, 2).into(),
                number(one.at.y, 2).into(),
                format!("{} ±{}", number(one.depth_mm, 1), error_mm(one)).into(),
                match (part_of, is_tested) {
                    (Some(number), _) => format!("shows number {number}, of which this is a part").into(),
                    (None, true) => "tested this place".into(),
                    (None, false) => "did not test this place".into(),
                },
            ]);
        }
        if all.is_empty() { Block::Text(no.into()) } else { Block::Table(table) }
    };
    vec![
        list("Indications of the second survey without one in the first", &comparison.new, "No indication is new."),
        list("Indications of the first survey without one in the second", &comparison.gone, "No indication is gone."),
        Block::Note(
            "An indication can be gone because its depth is near the threshold, because the surveys place or combine \
             readings differently, or because the floor was repaired."
                .into(),
        ),
    ]
}

fn method() -> Vec<Block> {
    let items = [
        "Match: two indications can be one loss if the squared distance of their places, in units of both covariances and \
         of the residual, is at most 13.8 (99.9 % of the distances of one loss), and the second depth is not less than \
         the first one by more than four standard deviations.",
        "Of all ways to pair them one to one, the one with the greatest likelihood counts; its alternative is that \
         indications are unrelated and spread evenly over the tested floor.",
        "Part: an indication without a partner is a part of a larger one of the other survey if the squared distance of its \
         middle from the extent of that one, in units of both covariances and of the residual, is at most 5.99 (95 %). It \
         counts neither as new nor as gone. For the next inspection, it counts with its whole depth.",
        "Place: covariance of the position, of the middle of the readings within the extent, and \
         of the grid of the readings.",
        "Depth: the greatest loss of a reading. Its standard deviation is that of a reading, combined with that of \
         missing the deepest place between two channels.",
        "Growth: second depth − first depth; 95 % interval ± 1.96 √(s1² + s2²) with the standard deviations s1 and s2 of \
         the depths. Rate: growth divided by the years between the surveys, of 365.25 days.",
        "A calibration error of an instrument is not in these intervals. It shifts all depths of a survey alike.",
    ];
    vec![Block::List(items.map(str::to_owned).to_vec())]
}

fn provenance(comparison: &TwoSurveys) -> Vec<Block> {
    let hash = |digest: &Option<String>| digest.clone().unwrap_or_else(|| "no file".into());
    let of = |which: &str, part: &SurveyPart| {
        vec![
            (format!("{which} run"), part.run.clone()),
            (format!("{which} instrument"), part.instrument.clone()),
            (
                format!("{which} readings"),
                format!(
                    "{} on {} m²; {} indications",
                    part.readings,
                    number(part.tested_m2, 2),
                    part.indications
                ),
            ),
            (format!("{which} journal, SHA-256"), hash(&part.journal_sha256)),
            (format!("{which} readings, SHA-256"), hash(&part.readings_sha256)),
        ]
    };
    let mut facts = of("First", &comparison.first);
    facts.extend(of("Second", &comparison.second));
    facts.push(("Made by".into(), comparison.made_by.clone()));
    let doubts = [&comparison.first, &comparison.second].into_iter();
    let doubts = doubts.flat_map(|part| part.doubts.iter().map(|doubt| format!("{}: {doubt}", part.run)));
    let barred = doubts.map(|doubt| Block::Barred(format!("trust this comparison: run {doubt}")));
    barred.chain([Block::Hashes(facts)]).collect()
}
