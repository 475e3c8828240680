//! What is scanned again and what is left, for people.

use super::Rescan;
use account::Area;
use std::fmt::Write;

/// Areas that are listed one by one.
const MOST_LISTED: usize = 10;

impl Rescan {
    /// What is scanned again, and what is left, `min_area_m2` being the smallest area that was wanted.
    pub fn human(&self, min_area_m2: f64) -> String {
        let boxes_m2: f64 = self.boxes.iter().map(|[low, high]| (high.x - low.x) * (high.y - low.y)).sum();
        let mut text = format!(
            "{:.2} m² missed in {}, to be scanned again as {} ({boxes_m2:.2} m² with the surrounding floor)\n",
            total_m2(&self.areas),
            counted(self.areas.len(), "area", "areas"),
            counted(self.boxes.len(), "box", "boxes"),
        );
        text += &listed("again", &self.areas);
        text += &listed(&format!("left, smaller than {min_area_m2} m²"), &self.left);
        text += &listed("left, out of reach of every lane", &self.out_of_reach);
        if self.not_asked_m2 > 0.0 {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "left: {:.2} m² that no mission was to scan", self.not_asked_m2);
        }
        text
    }

    /// What no lane leads to.
    pub fn human_out_of_reach(&self) -> String {
        listed("out of reach of every lane", &self.out_of_reach)
    }

    /// Why nothing is scanned again, as a sentence.
    pub fn why_nothing(&self, min_area_m2: f64) -> String {
        format!(
            "nothing was missed that is worth another scan: {} smaller than {min_area_m2} m² left, {:.2} m² together, and {} out of reach of every lane",
            counted(self.left.len(), "place", "places"),
            total_m2(&self.left),
            counted(self.out_of_reach.len(), "place", "places"),
        )
    }
}

fn listed<R>(label: &str, areas: &[Area<R>]) -> String {
    let mut text = String::new();
    for area in areas.iter().take(MOST_LISTED) {
        let _ = writeln!(text, "{label}: {area}");
    }
    let rest = areas.get(MOST_LISTED..).unwrap_or_default();
    if !rest.is_empty() {
        let places = counted(rest.len(), "more place", "more places");
        let _ = writeln!(text, "{label}: {:.2} m² in {places}", total_m2(rest));
    }
    text
}

fn total_m2<R>(areas: &[Area<R>]) -> f64 {
    areas.iter().map(|area| area.area_m2).sum()
}

/// A number of things.
fn counted(number: usize, one: &str, more: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { more })
}
