//! Occupancy maps in the form of the ROS map server: a YAML file that names an image and gives its scale.
//!
//! Values are interpreted as the ROS 2 `nav2_map_server` does. Cells that are not known to be free count as solid, as the
//! robots of the papers treat them.

mod image;
mod settings;

use crate::{
    error::{ImportError, read_file},
    text::decoded,
};
use image::Image;
use nalgebra::Isometry2;
use settings::Settings;
use std::path::Path;
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
        // Images begin at the upper left.
        let upward = image.pixels.chunks(image.columns).rev().flatten();
        let [x, y, turn_rad] = settings.origin;
        Ok(Self {
            columns: image.columns,
            is_free: upward.map(|pixel| settings.is_free(*pixel)).collect(),
            cell_m: settings.resolution_m,
            tank_from_map: Isometry2::new(Vector::new(x, y), turn_rad),
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
