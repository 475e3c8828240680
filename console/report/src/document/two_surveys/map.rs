//! The map of the comparison.

use super::{Single, TwoSurveys};
use crate::{
    document::{
        layers::Layers,
        maps::{FULL_MM, Figure, legend, swatch},
        marks::beside,
    },
    drawing::sheet::{Sheet, colour},
};
use world::{Point, Vector};

/// Radius of a mark on paper, and the smaller radius for more than [`MANY`] marks, millimetres.
const RADIUS_MM: f64 = 1.1;
const SMALL_MM: f64 = 0.5;
const MANY: usize = 200;
/// Half the height of a number, and half the width of one of its characters, millimetres.
const HALF_MM: (f64, f64) = (1.2, 0.75);

/// What the comparison says about an indication.
#[derive(Clone, Copy, PartialEq)]
enum State {
    Grown,
    Same,
    Cut,
    New,
    Gone,
    Part,
}

impl State {
    const ALL: [Self; 6] = [Self::Grown, Self::Same, Self::Cut, Self::New, Self::Gone, Self::Part];

    fn words(self) -> &'static str {
        match self {
            Self::Grown => "in both, grown by more than the 95 % error",
            Self::Same => "in both, growth within the 95 % error",
            Self::Cut => "in both, cut by untested floor: growth not known",
            Self::New => "only in the second survey (N and its number there)",
            Self::Gone => "only in the first survey (G and its number there)",
            Self::Part => "part of a larger indication of the other survey",
        }
    }

    fn style(self) -> String {
        let (fill, stroke) = match self {
            Self::Grown => (colour::MISSED, colour::MISSED_LINE),
            Self::Same => (colour::TWICE, colour::TRACK),
            Self::Cut => ("#fff", colour::TRACK),
            Self::New => ("#fff", colour::TETHER),
            Self::Gone => ("none", colour::OUT),
            Self::Part => ("none", colour::TRACK),
        };
        let dashes = if self == Self::Gone { r#" stroke-dasharray=".6 .4""# } else { "" };
        format!(r#"fill="{fill}" stroke="{stroke}" stroke-width=".4"{dashes}"#)
    }

    fn ink(self) -> &'static str {
        match self {
            Self::Grown => colour::MISSED_LINE,
            Self::Same | Self::Cut | Self::Part => colour::TRACK,
            Self::New => colour::TETHER,
            Self::Gone => colour::SOFT,
        }
    }
}

/// Draws the indications of both surveys in the frame of the first one.
pub(super) fn map(comparison: &TwoSurveys, layers: &Layers<'_>) -> Figure {
    let fixtures = layers.fixtures();
    let mut sheet = Sheet::new(fixtures.boundary, "s", FULL_MM, 8.0);
    sheet.define_patterns(layers.floor().cell_m);
    sheet.wall(fixtures.boundary, r##"fill="#fff""##);
    sheet.plates(layers.plates.as_ref());
    sheet.obstacles(&fixtures);
    sheet.frame(&fixtures, 2.4);
    let names = sheet.plate_names(layers.plates.as_ref(), 2.1);
    let marks = marks(comparison);
    draw(&mut sheet, &marks, names);
    let entry = |state: State| {
        let count = marks.iter().filter(|(of, ..)| *of == state).count();
        let sample = swatch(&format!(r#"<circle cx="3.5" cy="2" r="1.3" {}/>"#, state.style()));
        legend(sample, state.words(), count.to_string())
    };
    Figure {
        caption: "Indications of both surveys, in the frame of the first one; numbers are those of the second survey \
                  unless a G precedes them. A number without room is left out."
            .into(),
        svg: sheet.svg("Map of the comparison", "full"),
        legend: State::ALL.into_iter().map(entry).collect(),
    }
}

/// Each indication with its state, place and label.
fn marks(comparison: &TwoSurveys) -> Vec<(State, Point, String)> {
    let registration = &comparison.registration;
    let single = |state, one: &Single| if one.part_of.is_some() { State::Part } else { state };
    let matched = comparison.matched.iter().map(|pair| {
        let grown = if pair.is_grown() { State::Grown } else { State::Same };
        let state = if pair.is_cut { State::Cut } else { grown };
        (state, registration.apply(pair.second.at), pair.second.number.to_string())
    });
    let new = comparison.new.iter().map(|one| {
        let label = format!("N{}", one.indication.number);
        (single(State::New, one), registration.apply(one.indication.at), label)
    });
    let gone = comparison
        .gone
        .iter()
        .map(|one| (single(State::Gone, one), one.indication.at, format!("G{}", one.indication.number)));
    // Marks that were drawn last lie on top.
    gone.chain(matched).chain(new).collect()
}

fn draw(sheet: &mut Sheet, marks: &[(State, Point, String)], names: Vec<[Point; 2]>) {
    let radius_mm = if marks.len() > MANY { SMALL_MM } else { RADIUS_MM };
    let half = Vector::repeat(radius_mm + 0.2);
    let mut boxes: Vec<[Point; 2]> =
        marks.iter().map(|(_, at, _)| sheet.at(*at)).map(|at| [at - half, at + half]).chain(names).collect();
    for (state, at, _) in marks {
        sheet.circle(*at, radius_mm, &state.style());
    }
    for (state, at, label) in marks {
        let half = Vector::new(HALF_MM.1 * label.len() as f64, HALF_MM.0);
        let Some(place) = beside(sheet.at(*at), radius_mm, half, &boxes) else { continue };
        boxes.push([place - half, place + half]);
        sheet.draw(format_args!(
            r#"<text class="st" x="{:.2}" y="{:.2}" dy=".35em" text-anchor="middle" font-size="2.3" font-weight="700" fill="{}">{label}</text>"#,
            place.x,
            place.y,
            state.ink()
        ));
    }
}
