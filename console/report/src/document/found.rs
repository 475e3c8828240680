//! The losses of metal that the readings show, for the first sheet, the decisions and the gate.

use super::{
    decision::{Decision, INDICATIONS},
    model::Document,
    page::{Page, Share},
    thickness::Thickness,
    words::number,
};
use crate::human::text::counted;
use account::{Finding, says_nothing};

/// Section with the indications of a scan report, and the section with the gate, which every report has.
const PLATES: usize = 6;
const GATE: usize = 10;

/// The losses of a report with readings.
struct Found<'a> {
    thickness: &'a Thickness,
    deepest: Option<&'a Finding>,
    /// Number of the deepest loss in the list of indications, and its plate.
    listed: Option<(usize, Option<&'a str>)>,
}

impl<'a> Found<'a> {
    /// `None` for a report without readings.
    fn of(document: &'a Document) -> Option<Self> {
        let thickness = document.thickness.as_ref()?;
        let losses = thickness.losses.iter().enumerate();
        let deepest = losses.max_by(|(_, a), (_, b)| a.depth_mm.total_cmp(&b.depth_mm));
        // The losses follow the indications of a file.
        let given = document.indications.len().saturating_sub(thickness.losses.len());
        let listed = deepest.and_then(|(index, _)| document.indications.get(given + index));
        Some(Self {
            thickness,
            deepest: deepest.map(|(_, loss)| loss),
            listed: listed.map(|listed| (listed.number, listed.plate.as_deref())),
        })
    }

    fn nominal_mm(&self) -> f64 {
        self.thickness.sampling.thickness_mm
    }

    /// Number of losses that can go through the floor: depth and 95 % error reach the nominal thickness.
    fn through(&self) -> usize {
        let losses = self.thickness.losses.iter();
        losses.filter(|loss| loss.depth_mm + loss.depth_error_mm >= self.nominal_mm()).count()
    }

    /// The deepest loss: depth with its 95 % error, number, place and plate.
    fn deepest(&self) -> Option<String> {
        let loss = self.deepest?;
        let depth = format!(
            "{} ±{} of {} mm",
            number(loss.depth_mm, 1),
            number(loss.depth_error_mm, 1),
            self.nominal_mm()
        );
        let (no, plate) =
            self.listed.map_or((String::new(), None), |(no, plate)| (format!(", number {no}"), plate));
        let plate = plate.map(|plate| format!(", plate {plate}")).unwrap_or_default();
        let place = format!("{}, {} m", number(loss.at.x, 2), number(loss.at.y, 2));
        Some(format!("{depth}{no}, at {place}{plate}"))
    }

    /// What the readings show, as a sentence.
    fn sentence(&self) -> String {
        let count = counted(self.thickness.losses.len() as u64, "indication");
        let Some(deepest) = self.deepest() else {
            let sampling = &self.thickness.sampling;
            return format!(
                "The readings show no loss of {} mm or more ({} % of {} mm).",
                number(sampling.threshold_mm(), 1),
                number(100.0 * sampling.threshold, 0),
                sampling.thickness_mm
            );
        };
        let through = match self.through() {
            0 => String::new(),
            n => format!(" {n} of them can go through the floor."),
        };
        format!("The readings show {count}; the deepest: {deepest}.{through}")
    }
}

/// Adds the losses to the first sheet of a report with readings.
pub(super) fn on_first_sheet(document: &Document, mut page: Page) -> Page {
    let Some(found) = Found::of(document) else { return page };
    page.verdict.lead = format!("{} {}", page.verdict.lead, found.sentence());
    if found.through() > 0 {
        page.verdict.class = "bad";
    }
    let share = Share {
        value: found.thickness.losses.len().to_string(),
        unit: "",
        of: "indications of metal loss",
        about: found.deepest().map_or_else(String::new, |deepest| format!("deepest {deepest}")),
    };
    // The table of the floors has the share that gives way.
    match page.shares.first_mut().filter(|_| document.is_to_scan) {
        Some(first) => *first = share,
        None => page.shares.push(share),
    }
    page
}

/// The decisions about the losses.
pub(super) fn decisions(document: &Document) -> Vec<Decision> {
    let Some(found) = Found::of(document) else { return Vec::new() };
    let Some(deepest) = found.deepest() else { return Vec::new() };
    let section = if document.is_to_scan { PLATES } else { GATE };
    let facts = &document.inspection;
    let through = (found.through() > 0).then(|| Decision {
        what: format!(
            "{} can go through the floor: depth and 95 % error reach the nominal thickness. The deepest: {deepest}. \
             Repair, test with another method, or take the floor out of service.",
            counted(found.through() as u64, "indication")
        ),
        section,
        key: "through_accepted",
        item: INDICATIONS,
        answer: facts.through_accepted.clone(),
    });
    let stated = facts.indications.as_ref().filter(|text| !says_nothing(text));
    let beside = stated.map(|text| Decision {
        what: format!(
            "The facts say about indications: `{}`. The readings show {}; the deepest: {deepest}. Correct the fact, or \
             explain how both are true.",
            text.trim(),
            counted(found.thickness.losses.len() as u64, "indication")
        ),
        section,
        key: "indications_explained",
        item: INDICATIONS,
        answer: facts.indications_explained.clone(),
    });
    through.into_iter().chain(beside).collect()
}
