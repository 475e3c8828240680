//! The floor plates on the map: their outlines, and their names where they fit.

use super::pen::DOTS;
use super::shapes::Window;
use crate::view::look::Look;
use ratatui::style::Color;
use ratatui::widgets::canvas::{Painter, Shape};
use std::collections::BTreeMap;
use std::rc::Rc;
use world::{Floor, PlateMap, Point, Vector};

/// The zoom from which plates are drawn: twice the scale of the whole tank.
const FROM_ZOOM: u8 = 1;

/// The inputs from which the plates are drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Key(world::PlateLayout, usize, Window, bool);

/// The plates in a window.
#[derive(Debug, PartialEq, Default)]
pub(crate) struct PlateDrawing {
    /// The dots of the outlines, from the north-west.
    dots: Vec<(u16, u16)>,
    /// The names, each with the centre of the plate's visible part.
    pub names: Vec<(Point, String)>,
}

/// The plates in a window, if they are known and the zoom is high enough.
pub(super) fn plates(look: &Look, window: Window) -> Option<Rc<PlateDrawing>> {
    if look.model.ui.map.zoom < FROM_ZOOM {
        return None;
    }
    let map = map(look)?;
    let (about, floor) = (look.run.about.as_ref()?, look.run.coverage.as_ref()?.floor());
    let has_dots = look.caps.glyphs.has_dots();
    let key = Key(about.plates.clone()?, floor.len(), window, has_dots);
    Some(look.cache.borrow_mut().plates(key, || Rc::new(drawing(&map, floor, window, has_dots))))
}

/// The plate of each cell.
fn map(look: &Look) -> Option<Rc<PlateMap>> {
    let (about, raster) = (look.run.about.as_ref()?, look.run.coverage.as_ref()?);
    let mut cache = look.cache.borrow_mut();
    Some(cache.plate_map(about.plates.as_ref()?, &about.world.boundary, raster.floor()))
}

/// The name of the plate under a point.
pub(super) fn name_at(look: &Look, at: Point) -> Option<String> {
    let cell = look.run.coverage.as_ref()?.floor().cell_at(at)?;
    let map = map(look)?;
    map.plate_of(cell).map(|plate| map.plates[plate].name.clone())
}

fn drawing(map: &PlateMap, floor: &Floor, window: Window, has_dots: bool) -> PlateDrawing {
    let per = if has_dots { DOTS } else { (1, 1) };
    let (columns, rows) = (window.size.0 * per.0, window.size.1 * per.1);
    let step = Vector::new(window.column_m / f64::from(per.0), -2.0 * window.column_m / f64::from(per.1));
    let corner = Point::new(window.x[0], window.y[1]);
    let center =
        |x: u16, y: u16| corner + step.component_mul(&Vector::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
    let plate = |x: u16, y: u16| map.plate_of(floor.cell_at(center(x, y))?);
    let mut dots = Vec::new();
    let mut seen: BTreeMap<usize, (u32, Vector)> = BTreeMap::new();
    for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
        let Some(here) = plate(x, y) else { continue };
        let (count, sum) = seen.entry(here).or_default();
        (*count, *sum) = (*count + 1, *sum + center(x, y).coords);
        // Every other dot distinguishes the outlines of plates from paths.
        let is_on = !has_dots || (x + y).is_multiple_of(2);
        if is_on && [plate(x + 1, y), plate(x, y + 1)].into_iter().flatten().any(|other| other != here) {
            dots.push((x, y));
        }
    }
    let least = u32::from(per.0 * per.1) * LEAST_CHARACTERS;
    let names = seen.into_iter().filter(|(_, (count, _))| *count >= least).map(|(plate, (count, sum))| {
        let name = map.plates[plate].name.clone();
        let half_m = name.len() as f64 / 2.0 * window.column_m;
        (Point::from(sum / f64::from(count)) - Vector::new(half_m, 0.0), name)
    });
    PlateDrawing { dots, names: names.collect() }
}

/// Minimum visible size at which a plate's name is drawn, characters.
const LEAST_CHARACTERS: u32 = 24;

/// The outlines as a canvas shape.
pub(super) struct Outlines<'a>(pub &'a PlateDrawing, pub Color);

impl Shape for Outlines<'_> {
    fn draw(&self, painter: &mut Painter) {
        for (x, y) in &self.0.dots {
            painter.paint(usize::from(*x), usize::from(*y), self.1);
        }
    }
}
