//! Rows of one entity that are collected and sent together.
//!
//! 500 rows in one chunk take a fifteenth of the bytes that they take in chunks of two rows, so rows that are added in
//! every tick are collected.

use super::{
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};

/// A point in the format of the recording, metres.
pub(crate) type Flat = [f32; 2];

/// A point or vector in the format of the recording.
pub(crate) fn flat<T: Into<[f64; 2]>>(point: T) -> Flat {
    let [x, y] = point.into();
    [x as f32, y as f32]
}

/// A value that can be sent in columns.
pub(crate) trait Row: Sized {
    /// The columns of many rows, one row per moment.
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError>;
}

/// Waiting rows of one entity.
pub(crate) struct Lane<T> {
    path: String,
    at: Vec<At>,
    rows: Vec<T>,
}

impl<T: Row> Lane<T> {
    pub(crate) fn new(path: impl Into<String>) -> Self {
        Self { path: path.into(), at: Vec::new(), rows: Vec::new() }
    }

    pub(crate) fn path(&self) -> &str {
        &self.path
    }

    pub(crate) fn push(&mut self, at: At, row: T) {
        self.at.push(at);
        self.rows.push(row);
    }

    pub(crate) fn send(&mut self, stream: &Stream) -> Result<(), RecordingError> {
        if self.rows.is_empty() {
            return Ok(());
        }
        let columns = T::columns(&self.rows).map_err(|error| RecordingError::sdk(&error))?;
        stream.columns(&self.path, &self.at, columns)?;
        self.at.clear();
        self.rows.clear();
        Ok(())
    }
}

/// The pose of a rigid body; everything below its entity moves with it.
pub(crate) struct Placed {
    pub at: Flat,
    pub angle_rad: f32,
}

fn placing<'a>(rows: impl Iterator<Item = &'a Placed> + Clone) -> rr::Transform3D {
    let turn =
        |row: &Placed| rr::RotationAxisAngle::new([0.0, 0.0, 1.0], rr::Angle::from_radians(row.angle_rad));
    rr::Transform3D::update_fields()
        .with_many_translation(rows.clone().map(|row| [row.at[0], row.at[1], 0.0]))
        .with_many_rotation_axis_angle(rows.map(turn))
}

impl Row for Placed {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        Ok(placing(rows.iter()).columns_of_unit_batches()?.collect())
    }
}

/// An ellipse in any direction.
pub(crate) struct Ellipse {
    pub placed: Placed,
    pub half_axes_m: (f32, f32),
}

impl Row for Ellipse {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        let transforms = placing(rows.iter().map(|row| &row.placed)).columns_of_unit_batches()?;
        let sizes = rr::Ellipses2D::update_fields().with_half_sizes(rows.iter().map(|row| row.half_axes_m));
        Ok(transforms.chain(sizes.columns_of_unit_batches()?).collect())
    }
}

/// A number.
impl Row for f64 {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        Ok(rr::Scalars::new(rows.iter().copied()).columns_of_unit_batches()?.collect())
    }
}

/// A fixed number of values that belong together.
pub(crate) struct Numbers<const N: usize>(pub [f64; N]);

impl<const N: usize> Row for Numbers<N> {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        let values = rr::Scalars::new(rows.iter().flat_map(|row| row.0));
        Ok(values.columns(std::iter::repeat_n(N, rows.len()))?.collect())
    }
}

/// Arrows: start and vector.
pub(crate) struct Arrows(pub Vec<(Flat, Flat)>);

impl Row for Arrows {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        let all = || rows.iter().flat_map(|row| &row.0);
        let arrows = rr::Arrows2D::update_fields()
            .with_origins(all().map(|arrow| arrow.0))
            .with_vectors(all().map(|arrow| arrow.1));
        Ok(arrows.columns(rows.iter().map(|row| row.0.len()))?.collect())
    }
}

/// Circles: centre and radius.
pub(crate) struct Circles(pub Vec<(Flat, f32)>);

impl Row for Circles {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        let all = || rows.iter().flat_map(|row| &row.0);
        let circles = rr::Ellipses2D::update_fields()
            .with_centers(all().map(|circle| circle.0))
            .with_half_sizes(all().map(|circle| (circle.1, circle.1)));
        Ok(circles.columns(rows.iter().map(|row| row.0.len()))?.collect())
    }
}

/// Straight lines: start and end.
pub(crate) struct Lines(pub Vec<[Flat; 2]>);

impl Row for Lines {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        let strips = rows.iter().flat_map(|row| &row.0).map(|line| rr::LineStrip2D::from_iter(*line));
        let lines = rr::LineStrips2D::update_fields().with_strips(strips);
        Ok(lines.columns(rows.iter().map(|row| row.0.len()))?.collect())
    }
}

/// Straight lines, each with its own colour.
pub(crate) struct InkedLines(pub Vec<([Flat; 2], [u8; 4])>);

impl Row for InkedLines {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        let all = || rows.iter().flat_map(|row| &row.0);
        let lines = rr::LineStrips2D::update_fields()
            .with_strips(all().map(|(line, _)| rr::LineStrip2D::from_iter(*line)))
            .with_colors(all().map(|(_, ink)| style::color(*ink)));
        Ok(lines.columns(rows.iter().map(|row| row.0.len()))?.collect())
    }
}

/// A point.
impl Row for Flat {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        let points = rr::Points2D::update_fields().with_positions(rows.iter().copied());
        Ok(points.columns_of_unit_batches()?.collect())
    }
}

/// Points, any number of them.
#[derive(Clone, PartialEq)]
pub(crate) struct Spots(pub Vec<Flat>);

impl Row for Spots {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        let positions = rows.iter().flat_map(|row| row.0.iter().copied());
        let points = rr::Points2D::update_fields().with_positions(positions);
        Ok(points.columns(rows.iter().map(|row| row.0.len()))?.collect())
    }
}

/// A path.
pub(crate) struct Strip(pub Vec<Flat>);

impl Row for Strip {
    fn columns(rows: &[Self]) -> Result<Vec<rr::SerializedComponentColumn>, rr::SerializationError> {
        let strips = rows.iter().map(|row| rr::LineStrip2D::from_iter(row.0.iter().copied()));
        Ok(rr::LineStrips2D::update_fields().with_strips(strips).columns_of_unit_batches()?.collect())
    }
}
