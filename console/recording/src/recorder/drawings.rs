//! The drawings with which planners explain their plans, layer by layer.
//!
//! A drawing is shown for the tick in which it is made; a layer without new drawings is cleared.

use super::{
    lane::{Arrows, Circles, Lane, Lines, Numbers, Row, flat},
    paths, scene,
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};
use planner_api::{Drawing, Layer};
use world::Vector;

/// Force below which an arrow is hardly visible, newton.
const WEAK_N: f64 = 0.01;
/// Force whose arrow is drawn at full length, newton.
const STRONG_N: f64 = 100.0;
/// Full length of an arrow as a share of the tank's shorter side.
const LONGEST_SHARE: f64 = 0.1;
/// Layers whose arrows are forces; their magnitudes are recorded in this order.
const FORCES: [Layer; 4] = [Layer::Attraction, Layer::Repulsion, Layer::Rotation, Layer::Resultant];

/// The drawn length of the arrow of a force, metres.
///
/// A planner's forces span many powers of ten near an obstacle. The length grows with their logarithm, so that weak
/// forces stay visible and strong ones stay in the tank. The direction is preserved, and a stronger force never has a
/// shorter arrow. The true magnitudes are recorded as figures.
fn drawn_length_m(force_n: f64, longest_m: f64) -> f64 {
    longest_m * ((force_n / WEAK_N).ln_1p() / (STRONG_N / WEAK_N).ln_1p()).min(1.0)
}

/// Rows of one kind of drawing on one layer.
struct Shown<T> {
    lane: Lane<T>,
    /// Style of the drawings, until the first of them is drawn.
    style: Option<Box<dyn rr::AsComponents + Send>>,
    visible: bool,
}

impl<T: Row> Shown<T> {
    fn new(path: String, style: impl rr::AsComponents + Send + 'static) -> Self {
        Self { lane: Lane::new(path), style: Some(Box::new(style)), visible: false }
    }

    /// Shows the drawings of this tick, or clears the earlier ones.
    fn show(&mut self, stream: &Stream, at: At, is_empty: bool, row: T) -> Done {
        if is_empty && !self.visible {
            return Ok(());
        }
        if let Some(style) = self.style.take() {
            stream.always(self.lane.path(), style.as_ref())?;
        }
        self.visible = !is_empty;
        self.lane.push(at, row);
        Ok(())
    }
}

type Done = Result<(), RecordingError>;

/// One layer.
struct Sheet {
    layer: Layer,
    arrows: Shown<Arrows>,
    circles: Shown<Circles>,
    lines: Shown<Lines>,
}

/// All layers.
pub(crate) struct Drawings {
    sheets: Vec<Sheet>,
    sizes: Lane<Numbers<4>>,
    longest_m: f64,
    forces_seen: bool,
}

impl Drawings {
    /// Creates the layers for a tank whose shorter side has this length; nothing is drawn yet.
    pub(crate) fn new(smaller_side_m: f64) -> Self {
        Self {
            sheets: Layer::ALL.into_iter().map(Sheet::new).collect(),
            sizes: Lane::new(paths::FORCE_SIZES),
            longest_m: LONGEST_SHARE * smaller_side_m,
            forces_seen: false,
        }
    }

    /// Adds all drawings of one tick.
    pub(crate) fn show(&mut self, stream: &Stream, at: At, drawings: &[Drawing]) -> Done {
        let longest_m = self.longest_m;
        for sheet in &mut self.sheets {
            sheet.show(stream, at, drawings, longest_m)?;
        }
        self.record_sizes(stream, at, drawings)
    }

    /// Sends the waiting rows.
    pub(crate) fn send(&mut self, stream: &Stream) -> Done {
        for sheet in &mut self.sheets {
            sheet.arrows.lane.send(stream)?;
            sheet.circles.lane.send(stream)?;
            sheet.lines.lane.send(stream)?;
        }
        self.sizes.send(stream)
    }

    fn record_sizes(&mut self, stream: &Stream, at: At, drawings: &[Drawing]) -> Done {
        let sizes = FORCES.map(|layer| force_on(layer, drawings).norm());
        if !self.forces_seen && sizes.iter().all(|size| *size == 0.0) {
            return Ok(());
        }
        if !self.forces_seen {
            self.forces_seen = true;
            let names = FORCES.map(|layer| format!("{} [N]", name(layer)));
            let lines = rr::SeriesLines::new().with_names(names).with_widths([1.5; 4]);
            stream.always(
                self.sizes.path(),
                &lines.with_colors(FORCES.map(|layer| style::color(ink(layer)))),
            )?;
        }
        self.sizes.push(at, Numbers(sizes));
        Ok(())
    }
}

impl Sheet {
    fn new(layer: Layer) -> Self {
        let (name, color) = (name(layer), style::color(ink(layer)));
        let arrows = rr::Arrows2D::update_fields().with_colors([color]).with_radii([style::on_screen(1.5)]);
        let circles =
            rr::Ellipses2D::update_fields().with_colors([color]).with_line_radii([style::on_screen(1.0)]);
        let lines = scene::line_style(ink(layer), 1.0);
        Self {
            layer,
            arrows: Shown::new(format!("{}/{name}", paths::FORCES), arrows),
            circles: Shown::new(format!("{}/{name}/circles", paths::DRAWN), circles),
            lines: Shown::new(format!("{}/{name}/lines", paths::DRAWN), lines),
        }
    }

    fn show(&mut self, stream: &Stream, at: At, drawings: &[Drawing], longest_m: f64) -> Done {
        let (mut arrows, mut circles, mut lines) = (Vec::new(), Vec::new(), Vec::new());
        for drawing in drawings {
            match *drawing {
                Drawing::Arrow { layer, at, vector } if layer == self.layer => {
                    arrows.push((flat(at), flat(shown_vector(layer, vector, longest_m))));
                }
                Drawing::Circle { layer, center, radius_m } if layer == self.layer => {
                    circles.push((flat(center), radius_m as f32));
                }
                Drawing::Line { layer, from, to } if layer == self.layer => {
                    lines.push([flat(from), flat(to)]);
                }
                _ => {}
            }
        }
        self.arrows.show(stream, at, arrows.is_empty(), Arrows(arrows))?;
        self.circles.show(stream, at, circles.is_empty(), Circles(circles))?;
        self.lines.show(stream, at, lines.is_empty(), Lines(lines))
    }
}

fn shown_vector(layer: Layer, vector: Vector, longest_m: f64) -> Vector {
    let size = vector.norm();
    if !FORCES.contains(&layer) || size == 0.0 {
        return vector;
    }
    vector * (drawn_length_m(size, longest_m) / size)
}

fn force_on(layer: Layer, drawings: &[Drawing]) -> Vector {
    let force = |drawing: &Drawing| match *drawing {
        Drawing::Arrow { layer: on, vector, .. } if on == layer => Some(vector),
        _ => None,
    };
    drawings.iter().filter_map(force).sum()
}

/// The entity name of a layer in the recording.
pub(crate) fn name(layer: Layer) -> &'static str {
    match layer {
        Layer::Attraction => "attraction",
        Layer::Repulsion => "repulsion",
        Layer::Rotation => "rotation",
        Layer::Resultant => "resultant",
        Layer::Virtual => "virtual",
        Layer::Path => "path",
        Layer::Tether => "tether",
        Layer::Other => "other",
    }
}

fn ink(layer: Layer) -> [u8; 4] {
    match layer {
        Layer::Attraction => style::rgb(80, 200, 255),
        Layer::Repulsion => style::rgb(255, 90, 80),
        Layer::Rotation => style::rgb(200, 130, 255),
        Layer::Resultant => style::rgb(255, 255, 255),
        Layer::Virtual => style::rgb(255, 220, 120),
        Layer::Path => style::rgb(120, 160, 200),
        Layer::Tether => style::rgb(255, 160, 60),
        Layer::Other => style::rgb(160, 170, 180),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stronger_forces_are_drawn_longer_and_none_is_longer_than_the_longest() {
        let lengths = [0.0, 0.01, 0.1, 1.0, 10.0, 100.0, 1e6].map(|force| drawn_length_m(force, 2.0));
        assert!(lengths.windows(2).all(|pair| pair[0] <= pair[1]), "{lengths:?}");
        assert!(lengths[1] > 0.1, "a weak force can be seen: {}", lengths[1]);
        assert!((lengths[6] - 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_drawn_force_keeps_its_direction_and_other_arrows_keep_their_length() {
        let force = Vector::new(-30.0, 40.0);
        let drawn = shown_vector(Layer::Repulsion, force, 2.0);
        assert!((drawn.normalize() - force.normalize()).norm() < 1e-12);
        assert!(drawn.norm() < 2.0);
        assert_eq!(shown_vector(Layer::Path, force, 2.0), force);
    }
}
