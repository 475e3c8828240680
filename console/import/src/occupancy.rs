//! Occupancy maps in the form of the ROS map server: a YAML file that names an image and gives its scale.
//!
//! Values are interpreted as the ROS 2 `nav2_map_server` does. Cells that are not known to be free count as solid, as the
//! robots of the papers treat them. So do cells of the grey 205, which map savers write for what nobody has seen, whatever the
//! thresholds make of it.

mod image;
mod settings;

use crate::{
    error::{ImportError, read_file},
    text::decoded,
};
use image::Image;
use nalgebra::Isometry2;
use settings::Settings;
use std::{fmt, path::Path};
use world::{Point, Vector};

/// A map: which cells are free, row by row from the lower left.
#[derive(Debug, Clone, PartialEq)]
pub struct OccupancyMap {
    /// Cells along x.
    pub columns: usize,
    /// Whether a cell is known to be free.
    pub is_free: Vec<bool>,
    /// Edge of a cell, metres.
    pub cell_m: f64,
    /// Takes lattice points, in metres, to the tank frame.
    pub tank_from_map: Isometry2<f64>,
    /// Cells that nobody has seen and that `free_thresh` would make floor; they are not free.
    pub unseen: Option<Unseen>,
}

/// Cells of the grey that map savers write for what nobody has seen, where the thresholds of the map take it for floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unseen {
    /// How many there are.
    pub n_cells: usize,
    /// Their grey.
    pub grey: u8,
    /// The threshold that would make them floor.
    pub free_thresh: f64,
}

impl fmt::Display for Unseen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { n_cells, grey, free_thresh } = self;
        write!(
            f,
            "{n_cells} cells of grey {grey} count as solid: map savers write it for what nobody has seen, although \
             free_thresh {free_thresh} takes it for floor"
        )
    }
}

impl OccupancyMap {
    /// Reads a map by its YAML file; the image lies beside it unless its path is absolute.
    ///
    /// # Errors
    /// File, line and key of what is wrong.
    pub fn read(yaml: &Path) -> Result<Self, ImportError> {
        let settings = Settings::parse(yaml, &decoded(&read_file(yaml)?, None))?;
        let file = yaml.parent().unwrap_or(Path::new("")).join(&settings.image);
        if !file.exists() {
            return Err(ImportError {
                line: Some(settings.image_line),
                key: Some("image".into()),
                ..ImportError::of_file(
                    yaml,
                    format!(
                        "there is no file {}; a path counts from the folder of this file",
                        file.display()
                    ),
                )
            });
        }
        let image = Image::read(&file)?;
        let n_cells = image.pixels.iter().filter(|pixel| settings.is_unseen_but_bright(**pixel)).count();
        let unseen = settings.unseen_grey().filter(|_| n_cells > 0);
        let unseen = unseen.map(|grey| Unseen { n_cells, grey, free_thresh: settings.free });
        // Images begin at the upper left.
        let upward = image.pixels.chunks(image.columns).rev().flatten();
        let [x, y, turn_rad] = settings.origin;
        Ok(Self {
            columns: image.columns,
            is_free: upward.map(|pixel| settings.is_free(*pixel)).collect(),
            cell_m: settings.resolution_m,
            tank_from_map: Isometry2::new(Vector::new(x, y), turn_rad),
            unseen,
        })
    }

    /// Cells along y.
    pub fn rows(&self) -> usize {
        self.is_free.len() / self.columns
    }

    /// The cell (column, row) that holds a place, if the map extends to it.
    pub fn cell_at(&self, place: Point) -> Option<(usize, usize)> {
        let at = self.tank_from_map.inverse_transform_point(&place) / self.cell_m;
        let fits = |v: f64, n: usize| (v >= 0.0 && v < n as f64).then_some(v as usize);
        Some((fits(at.x, self.columns)?, fits(at.y, self.rows())?))
    }

    /// Whether a place lies on a free cell.
    pub fn is_free_at(&self, place: Point) -> bool {
        self.cell_at(place).is_some_and(|(x, y)| self.is_free[y * self.columns + x])
    }

    /// A lattice point in the tank frame.
    pub(crate) fn to_tank(&self, x: f64, y: f64) -> Point {
        self.tank_from_map * (Point::new(x, y) * self.cell_m)
    }
}

#[cfg(test)]
mod tests;
