//! The floor to re-scan and the floor that is left, as text.

use super::Rescan;
use account::Area;
use std::fmt::Write;

/// Maximum number of areas listed one by one.
const MOST_LISTED: usize = 10;

impl Rescan {
    /// The floor to re-scan, and the floor that is left; `min_area_m2` is the smallest area that is worth it.
    pub fn human(&self, min_area_m2: f64) -> String {
        let boxes_m2: f64 = self.boxes.iter().map(|[low, high]| (high.x - low.x) * (high.y - low.y)).sum();
        let mut text = format!(
            "{:.2} m² missed in {}, to be re-scanned as {} ({boxes_m2:.2} m² with the surrounding floor)\n",
            total_m2(&self.areas),
            counted(self.areas.len(), "area", "areas"),
            counted(self.boxes.len(), "box", "boxes"),
        );
        text += &listed("again", &self.areas);
        text += &listed(&format!("not re-scanned, smaller than {min_area_m2} m²"), &self.left);
        text += &listed("not re-scanned, not reached by any lane", &self.out_of_reach);
        if self.not_asked_m2 > 0.0 {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "not re-scanned: {:.2} m² that no mission had to scan", self.not_asked_m2);
        }
        text
    }

    /// The areas that no lane reaches.
    pub fn human_out_of_reach(&self) -> String {
        listed("not reached by any lane", &self.out_of_reach)
    }

    /// The reason why nothing is re-scanned, as a sentence.
    pub fn why_nothing(&self, min_area_m2: f64) -> String {
        format!(
            "no missed area is worth a re-scan: {} smaller than {min_area_m2} m², {:.2} m² in total, and {} \
             that no lane reaches",
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

/// A count with its noun.
fn counted(number: usize, one: &str, more: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { more })
}
