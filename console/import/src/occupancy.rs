//! Occupancy maps in the format of the ROS map server: a YAML file that names an image and states its scale.
//!
//! Values are interpreted as in the ROS 2 `nav2_map_server`. Cells that are not known to be free count as solid, as
//! they do for the robots in the papers. Cells of grey 205, which map savers write for unseen cells, also count as
//! solid, even if the thresholds would make them floor.

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

/// A map: whether each cell is free, row by row from the lower left.
#[derive(Debug, Clone, PartialEq)]
pub struct OccupancyMap {
    /// The number of cells along x.
    pub columns: usize,
    /// Whether a cell is known to be free.
    pub is_free: Vec<bool>,
    /// The edge of a cell in metres.
    pub cell_m: f64,
    /// The transformation from lattice points, in metres, to the tank frame.
    pub tank_from_map: Isometry2<f64>,
    /// Unseen cells that count as solid although `free_thresh` would make them floor.
    pub unseen: Option<Unseen>,
}

/// Cells that have the grey of unseen cells, but that the map's thresholds would make floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unseen {
    /// The number of cells.
    pub n_cells: usize,
    /// The grey of the cells.
    pub grey: u8,
    /// The threshold that would make these cells floor.
    pub free_thresh: f64,
}

impl fmt::Display for Unseen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { n_cells, grey, free_thresh } = self;
        write!(
            f,
            "cells of grey {grey} count as solid ({n_cells}): map savers write this grey for unseen cells, \
             although free_thresh {free_thresh} would make it floor"
        )
    }
}

impl OccupancyMap {
    /// Reads a map from its YAML file; the path of the image is relative to its folder.
    ///
    /// # Errors
    /// The problem, with file, line and key.
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
                        "file {} does not exist; paths are relative to the folder of this file",
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

    /// The number of cells along y.
    pub fn rows(&self) -> usize {
        self.is_free.len() / self.columns
    }

    /// The cell (column, row) that contains a point, if the point is on the map.
    pub fn cell_at(&self, place: Point) -> Option<(usize, usize)> {
        let at = self.tank_from_map.inverse_transform_point(&place) / self.cell_m;
        let fits = |v: f64, n: usize| (v >= 0.0 && v < n as f64).then_some(v as usize);
        Some((fits(at.x, self.columns)?, fits(at.y, self.rows())?))
    }

    /// Whether a point is on a free cell.
    pub fn is_free_at(&self, place: Point) -> bool {
        self.cell_at(place).is_some_and(|(x, y)| self.is_free[y * self.columns + x])
    }

    /// Converts a lattice point to the tank frame.
    pub(crate) fn to_tank(&self, x: f64, y: f64) -> Point {
        self.tank_from_map * (Point::new(x, y) * self.cell_m)
    }
}

#[cfg(test)]
mod tests;
