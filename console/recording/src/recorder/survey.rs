//! The map that a survey makes, as an image: floor that is explored, solid, or not seen; its columns and frontiers.

use super::{
    lane::flat,
    paths, scene,
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};
use exploration::{CellState, Column, Grid};
use mission::{EventKind, event::RunOpened};
use world::Point;

type Done = Result<(), RecordingError>;

/// Value of a cell in each state.
fn id(state: CellState) -> u8 {
    match state {
        CellState::Unseen => 0,
        CellState::Free => 1,
        CellState::Solid => 2,
    }
}

/// The map so far.
pub(crate) struct Survey {
    grid: Grid,
    classes: Vec<u8>,
}

impl Survey {
    /// The map of a survey before the first scan, with the style of its parts; `None` for other missions.
    pub(crate) fn open(stream: &Stream, run: &RunOpened) -> Result<Option<Self>, RecordingError> {
        if !run.mission.task.is_survey() {
            return Ok(None);
        }
        let grid = Grid::of(&run.world.boundary);
        let (low, cell_m) = (flat(grid.low), grid.cell_m as f32);
        let place = rr::Transform3D::from_translation_scale([low[0], low[1], 0.0], [cell_m, cell_m, 1.0]);
        stream.always(paths::EXPLORED, &place)?;
        let class = |state, label: &str, [red, green, blue, alpha]: [u8; 4]| rr::AnnotationInfo {
            id: u16::from(id(state)),
            label: Some(label.into()),
            color: Some(rr::Rgba32::from_unmultiplied_rgba(red, green, blue, alpha)),
        };
        let classes = [
            class(CellState::Unseen, "not seen", [0, 0, 0, 0]),
            class(CellState::Free, "explored", style::SCANNED),
            class(CellState::Solid, "solid", style::WALL),
        ];
        stream.always(paths::EXPLORED, &rr::AnnotationContext::new(classes))?;
        let frontiers = rr::Points2D::update_fields()
            .with_colors([style::color(style::WARNING)])
            .with_radii([style::on_screen(5.0)]);
        stream.always(paths::FRONTIERS, &frontiers)?;
        stream.always(paths::PLANNED, &scene::line_style(style::PLAN, 1.0))?;
        Ok(Some(Self { classes: vec![id(CellState::Unseen); grid.len()], grid }))
    }

    /// Adds what an event says about the survey.
    pub(crate) fn apply(&mut self, kind: &EventKind, stream: &Stream, at: At) -> Done {
        match kind {
            EventKind::SurveyWay(way) => {
                let line = rr::LineStrip2D::from_iter(way.path.iter().map(|point| flat(*point)));
                stream.once(paths::PLANNED, at, &rr::LineStrips2D::update_fields().with_strips([line]))
            }
            EventKind::Explored(explored) => {
                stream.once(paths::EXPLORED_SHARE, at, &rr::Scalars::new([100.0 * explored.share]))?;
                self.show(stream, at, &explored.cells)?;
                draw_columns(stream, at, &explored.columns)?;
                draw_frontiers(stream, at, &explored.frontiers)
            }
            EventKind::Mapped { map } if map.grid.len() == self.grid.len() => {
                stream.once(paths::EXPLORED_SHARE, at, &rr::Scalars::new([100.0 * map.explored]))?;
                self.show(stream, at, &map.cells)?;
                draw_columns(stream, at, &map.columns)?;
                draw_frontiers(stream, at, &[])
            }
            _ => Ok(()),
        }
    }

    /// Changes the cells, and writes an image if any has changed; a damaged text changes none.
    fn show(&mut self, stream: &Stream, at: At, cells: &str) -> Done {
        let runs = exploration::runs(cells, self.grid.len()).unwrap_or_default();
        if runs.is_empty() {
            return Ok(());
        }
        for (cells, state) in runs {
            self.classes[cells].fill(id(state));
        }
        let size = [self.grid.columns as u32, self.grid.rows as u32];
        let format = rr::ImageFormat::segmentation(size, rr::ChannelDatatype::U8);
        let image = rr::SegmentationImage::new(self.classes.clone(), format);
        stream.once(paths::EXPLORED, at, &image.with_opacity(1.0).with_draw_order(-10.0))
    }
}

fn draw_columns(stream: &Stream, at: At, columns: &[Column]) -> Done {
    let strips = columns.iter().map(|column| scene::outline(&column.shape()));
    let label = |(index, column): (usize, &Column)| {
        let [center_m, radius_m] = column.errors_95_m();
        format!("{} (centre ±{center_m:.2} m, radius {:.2} ±{radius_m:.2} m)", index + 1, column.radius_m)
    };
    let drawn = scene::lines(strips, style::FOUND, 2.0)
        .with_labels(columns.iter().enumerate().map(label))
        .with_show_labels(false);
    stream.once(paths::COLUMNS, at, &drawn)
}

fn draw_frontiers(stream: &Stream, at: At, frontiers: &[Point]) -> Done {
    let points = frontiers.iter().map(|point| flat(*point));
    stream.once(paths::FRONTIERS, at, &rr::Points2D::update_fields().with_positions(points))
}
