//! Checks whether the inspector's certificate was valid on the day of the inspection.

use super::model::Document;
use account::Date;

/// Words that mark a certificate as no longer valid.
const ENDED: [&str; 7] = ["expired", "lapsed", "invalid", "revoked", "suspended", "withdrawn", "abgelaufen"];

/// Returns the faults of the certificate: its expiry date is missing or has passed, or its text states that it is no
/// longer valid.
pub(super) fn doubts(document: &Document) -> Vec<String> {
    let facts = &document.inspection;
    let mut doubts = Vec::new();
    let inspected = inspected(document);
    let is_past = |end: Date| inspected.filter(|day| *day > end);
    match facts.inspector_certificate_expires.as_ref().map(|text| (text, Date::read(text))) {
        None => doubts.push("inspection.inspector_certificate_expires".to_owned()),
        Some((text, None)) => {
            doubts.push(format!(
                "inspection.inspector_certificate_expires is not a date such as 2027-03-31: `{text}`"
            ));
        }
        Some((_, Some(end))) => doubts.extend(is_past(end).map(|day| {
            format!(
                "inspection.inspector_certificate_expires: the certificate expired on {end}, before the \
                inspection on {day}"
            )
        })),
    }
    if inspected.is_none() {
        let is_located = document.located.is_some();
        let lack = if is_located {
            "inspection.inspected_on"
        } else {
            "the day of the inspection, which the run's folder name does not contain"
        };
        doubts.push(lack.to_owned());
    }
    let Some(text) = &facts.inspector_certificate else { return doubts };
    let lower = text.to_lowercase();
    let words = || lower.split(|letter: char| !letter.is_alphabetic());
    if let Some(word) = ENDED.into_iter().find(|ended| words().any(|word| word == *ended)) {
        doubts.push(format!(
            "inspection.inspector_certificate states that the certificate is {word}: `{}`",
            text.trim()
        ));
    } else if let Some(day) = Date::until(text).and_then(is_past) {
        doubts.push(format!(
            "inspection.inspector_certificate states that the certificate's validity ends before the \
             inspection on {day}: `{}`",
            text.trim()
        ));
    }
    doubts
}

/// The day of the inspection: the stated day or, for missions, the start date of the last run.
fn inspected(document: &Document) -> Option<Date> {
    let stated = document.inspection.inspected_on.as_ref();
    if document.located.is_some() || stated.is_some() {
        return Date::read(stated?);
    }
    let began = document.runs.iter().filter_map(|run| run.began.as_deref());
    began.filter_map(|began| Date::read(began.get(..10)?)).max()
}
