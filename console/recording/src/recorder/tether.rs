//! The tether: its line, its contacts, its figures.

use super::{
    lane::{Lane, Number, Spots, Strip, flat},
    paths,
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};
use mission::{EventKind, event::RunOpened};

type Done = Result<(), RecordingError>;

/// Waiting rows of the tether.
pub(crate) struct Tether {
    line: Lane<Strip>,
    contacts: Lane<Spots>,
    out: Lane<Number>,
    out_true: Lane<Number>,
    home: Lane<Number>,
    wrap: Lane<Number>,
    sum: Lane<Number>,
}

impl Tether {
    /// Styles for a run with a tether; `None` for one without.
    pub(crate) fn open(stream: &Stream, run: &RunOpened) -> Result<Option<Self>, RecordingError> {
        let Some(tether) = &run.mission.tether else { return Ok(None) };
        let line = rr::LineStrips2D::update_fields()
            .with_colors([style::color(style::TETHER)])
            .with_radii([style::on_screen(1.5)]);
        stream.always(paths::TETHER, &line)?;
        let dots = rr::Points2D::update_fields()
            .with_colors([style::color(style::WARNING)])
            .with_radii([style::on_screen(4.0)]);
        stream.always(paths::TETHER_CONTACTS, &dots)?;
        let anchor = rr::Points2D::new([flat(tether.anchor)])
            .with_colors([style::color(style::TETHER)])
            .with_radii([style::on_screen(5.0)]);
        stream.always(paths::TETHER_ANCHOR, &anchor)?;
        let series = [
            (paths::TETHER_OUT, "cable out", style::ESTIMATE),
            (paths::TETHER_OUT_TRUE, "cable out, truly", style::TRUE),
            (paths::TETHER_HOME, "way home", style::FIGURE),
            (paths::TETHER_WRAP, "largest wrap", style::WARNING),
            (paths::TETHER_SUM, "sum of wraps", style::FIGURE),
        ];
        for (path, name, color) in series {
            let line = rr::SeriesLines::new().with_names([name]).with_colors([style::color(color)]);
            stream.always(path, &line.with_widths([1.5]))?;
        }
        Ok(Some(Self {
            line: Lane::new(paths::TETHER),
            contacts: Lane::new(paths::TETHER_CONTACTS),
            out: Lane::new(paths::TETHER_OUT),
            out_true: Lane::new(paths::TETHER_OUT_TRUE),
            home: Lane::new(paths::TETHER_HOME),
            wrap: Lane::new(paths::TETHER_WRAP),
            sum: Lane::new(paths::TETHER_SUM),
        }))
    }

    /// Takes in an event.
    pub(crate) fn apply(&mut self, event: &EventKind, at: At) {
        match event {
            EventKind::TetherTruth { length_m, .. } => self.out_true.push(at, Number(*length_m)),
            EventKind::Tethered {
                length_m,
                contacts,
                wrap_max_rad,
                wrap_total_rad,
                return_length_m,
                line,
                ..
            } => {
                self.line.push(at, Strip(line.iter().map(|point| flat(*point)).collect()));
                self.contacts.push(at, Spots(contacts.iter().map(|contact| flat(contact.at)).collect()));
                self.out.push(at, Number(*length_m));
                // A gap in the curve: there is no way home.
                if let Some(way_m) = return_length_m {
                    self.home.push(at, Number(*way_m));
                }
                self.wrap.push(at, Number(wrap_max_rad.to_degrees()));
                self.sum.push(at, Number(wrap_total_rad.to_degrees()));
            }
            _ => {}
        }
    }

    /// Sends the waiting rows.
    pub(crate) fn send(&mut self, stream: &Stream) -> Done {
        self.line.send(stream)?;
        self.contacts.send(stream)?;
        let figures = [&mut self.out, &mut self.out_true, &mut self.home, &mut self.wrap, &mut self.sum];
        figures.into_iter().try_for_each(|lane| lane.send(stream))
    }
}
