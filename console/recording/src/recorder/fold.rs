//! Folds events into entities.

use super::{
    corrosion,
    document::Document,
    drawings::Drawings,
    figures::Accounting,
    layout, paths, ranging,
    raster::Raster,
    scene,
    states::States,
    stream::{At, Stream},
    style,
    survey::Survey,
    table::Table,
    tick::Tick,
};
use crate::{error::RecordingError, rr};
use account::Summary;
use mission::{Event, EventKind, Severity, TaskConfig, event::RunOpened};
use ranging::{Rangings, Residuals};
use world::{Obstacle, Point, Station};

type Done = Result<(), RecordingError>;

/// The state of a recording.
#[derive(Default)]
pub(crate) struct Fold {
    opened: Option<Box<Opened>>,
}

/// The state of a recording with a known world.
struct Opened {
    tick: Tick,
    table: Table,
    stations: Vec<Station>,
    rangings: Rangings,
    residuals: Residuals,
    drawings: Drawings,
    /// `None` if scanning is not the task of the mission.
    raster: Option<Raster>,
    /// `None` unless the mission makes a map.
    survey: Option<Survey>,
    accounting: Accounting,
    /// Width and height of the floor in cells.
    size: (usize, usize),
    states: States,
    document: Document,
    /// Whether the previous plan had cuts.
    has_cuts: bool,
    /// Whether a way back is shown.
    has_way_back: bool,
}

impl Fold {
    /// Adds an event and returns the number of ticks that it closed: none or one. `account` is the account of the
    /// earlier events.
    pub(crate) fn apply(
        &mut self,
        event: &Event,
        account: &account::Fold,
        stream: &Stream,
    ) -> Result<u32, RecordingError> {
        let at = At::of(event);
        match (&mut self.opened, &event.kind) {
            (None, EventKind::RunOpened(run)) => {
                self.opened = Some(Box::new(Opened::new(run, at, stream)?));
                log(stream, event, &[], at)?;
                Ok(0)
            }
            (None, _) => Err(RecordingError::NotOpened { got: name_of(event) }),
            (Some(opened), _) => {
                let closes = at.tick != opened.tick.at.tick;
                if closes {
                    opened.close_tick(account, stream, at)?;
                }
                log(stream, event, &opened.stations, at)?;
                opened.apply(event, at, stream)?;
                if let EventKind::Ended { .. } = event.kind {
                    opened.corrode(account, stream, at)?;
                }
                Ok(u32::from(closes))
            }
        }
    }

    /// Closes everything that is open at the end of the run, with the given summary.
    pub(crate) fn finish(&mut self, summary: &Summary, stream: &Stream) -> Done {
        let Some(opened) = &mut self.opened else { return Ok(()) };
        let at = opened.tick.at;
        opened.show_tick(stream, at)?;
        opened.table.finish();
        if let Some(raster) = &mut opened.raster {
            if summary.outcome.is_some() && summary.floor.is_some() {
                raster.end();
            }
            raster.picture(stream, at)?;
        }
        opened.account(summary, stream, at)
    }

    /// Sends waiting rows.
    pub(crate) fn send(&mut self, stream: &Stream) -> Done {
        let Some(opened) = &mut self.opened else { return Ok(()) };
        opened.table.send(stream)?;
        opened.rangings.send(stream)?;
        opened.residuals.send(stream)?;
        opened.drawings.send(stream)
    }
}

impl Opened {
    fn new(run: &RunOpened, at: At, stream: &Stream) -> Result<Self, RecordingError> {
        stream.layout(layout::messages(run)?);
        scene::draw(stream, run)?;
        let document = Document::new(run.clone());
        stream.property("run", &document.run_properties())?;
        stream.always(
            paths::SCENARIO,
            &rr::TextDocument::new(format!("```toml\n{}\n```\n", run.scenario_toml))
                .with_media_type(rr::MediaType::markdown()),
        )?;
        let sampling = run.mission.instrument.as_ref().and_then(|instrument| instrument.sampling);
        if let Some(sampling) = sampling.filter(|_| run.wear.is_some()) {
            corrosion::open(stream, run, sampling)?;
        }
        let (low, high) = run.world.boundary.bounds();
        let scans = matches!(run.mission.task, TaskConfig::Follow { .. } | TaskConfig::Cover { .. });
        let opened = Self {
            tick: Tick::first(
                at,
                run.mission.start.position,
                run.mission.tether.as_ref().map(|tether| tether.anchor),
            ),
            table: Table::open(stream, run)?,
            stations: run.world.stations.clone(),
            drawings: Drawings::new((high.x - low.x).min(high.y - low.y)),
            rangings: Rangings::new(),
            residuals: Residuals::open(stream, &run.world.stations)?,
            survey: Survey::open(stream, run)?,
            raster: scans.then(|| Raster::open(stream, run)).transpose()?,
            accounting: Accounting::open(run, at),
            size: (run.floor.width, run.floor.height),
            states: States::open(stream, at)?,
            document,
            has_cuts: false,
            has_way_back: false,
        };
        opened.write_document(stream, at)?;
        Ok(opened)
    }

    fn apply(&mut self, event: &Event, at: At, stream: &Stream) -> Done {
        self.states.apply(stream, &event.kind, at)?;
        self.survey.iter_mut().try_for_each(|survey| survey.apply(&event.kind, stream, at))?;
        match &event.kind {
            EventKind::Covered { runs } => self.raster.iter_mut().for_each(|raster| raster.mark(runs)),
            EventKind::FloorChanged { changes } => {
                self.raster.iter_mut().for_each(|raster| raster.change(changes));
            }
            EventKind::Planned { path, cuts, .. } => {
                let strip = |points: &Vec<Point>| {
                    rr::LineStrip2D::from_iter(points.iter().map(|point| super::lane::flat(*point)))
                };
                let strips = |lines| rr::LineStrips2D::update_fields().with_strips(lines);
                stream.once(paths::PLANNED, at, &strips(vec![strip(path)]))?;
                if std::mem::take(&mut self.has_way_back) {
                    stream.once(paths::WAY_BACK, at, &strips(Vec::new()))?;
                }
                if !cuts.is_empty() || self.has_cuts {
                    self.has_cuts = !cuts.is_empty();
                    stream.once(paths::CUTS, at, &strips(cuts.iter().map(strip).collect()))?;
                }
            }
            EventKind::ReturnBegan { way } => {
                self.has_way_back = true;
                let line = way.path.iter().map(|point| super::lane::flat(*point)).collect();
                stream.once(paths::WAY_BACK, at, &scene::lines([line], style::PLAN, 2.0))?;
            }
            EventKind::ObstacleFound { obstacle } | EventKind::ObstacleMoved { obstacle, .. } => {
                draw_found(stream, at, obstacle)?;
            }
            EventKind::ZoneDrawn { zone } => scene::draw_zone(stream, at, zone)?,
            EventKind::PlannerChosen { choice, info, .. } => {
                self.document.planner_chosen(choice, info);
                stream.property("planners", &self.document.planner_properties())?;
                self.write_document(stream, at)?;
            }
            EventKind::ParametersChanged { choice, .. } => {
                self.document.parameters_changed(choice);
                stream.property("planners", &self.document.planner_properties())?;
                self.write_document(stream, at)?;
            }
            EventKind::Ended { outcome, reason } => {
                self.document.ended(*outcome, reason);
                if let Some(end) = self.document.end_properties() {
                    stream.property("end", &end)?;
                }
                self.write_document(stream, at)?;
            }
            _ => {}
        }
        self.tick.apply(&event.kind);
        Ok(())
    }

    fn close_tick(&mut self, account: &account::Fold, stream: &Stream, next: At) -> Done {
        let at = self.tick.at;
        self.show_tick(stream, next)?;
        if !self.accounting.is_due(at) {
            return Ok(());
        }
        self.corrode(account, stream, at)?;
        self.account(&account.summary(), stream, at)
    }

    /// Shows the loss of metal so far, if the instrument reads thickness.
    fn corrode(&self, account: &account::Fold, stream: &Stream, at: At) -> Done {
        account.survey().map_or(Ok(()), |survey| corrosion::picture(survey, self.size, stream, at))
    }

    fn show_tick(&mut self, stream: &Stream, next: At) -> Done {
        let next = self.tick.next(next);
        let tick = std::mem::replace(&mut self.tick, next);
        self.drawings.show(stream, tick.at, &tick.drawings)?;
        if let Some(points) = tick.scanned() {
            let points = rr::Points2D::new(points).with_colors([style::color(style::FOUND)]);
            stream.once(paths::SCAN, tick.at, &points)?;
        }
        self.raster.iter_mut().try_for_each(|raster| raster.picture_if_due(stream, tick.at))?;
        self.rangings.push(&self.stations, &tick);
        self.residuals.push(&tick);
        self.table.push(stream, &tick)
    }

    /// Writes an account, and shows it in the document beside the map.
    fn account(&mut self, summary: &Summary, stream: &Stream, at: At) -> Done {
        self.accounting.write(summary, stream, at)?;
        self.document.accounted(summary.floor.clone());
        self.write_document(stream, at)
    }

    fn write_document(&self, stream: &Stream, at: At) -> Done {
        let text = rr::TextDocument::from_markdown(self.document.text());
        stream.once(paths::SUMMARY, at, &text)
    }
}

fn draw_found(stream: &Stream, at: At, obstacle: &Obstacle) -> Done {
    let drawn = scene::lines([scene::outline(&obstacle.shape)], style::FOUND, 2.0)
        .with_radii([scene::thickness(&obstacle.shape, 2.0)])
        .with_labels([obstacle.name.as_str()]);
    stream.once(&format!("{}/{}", paths::OBSTACLES_FOUND, obstacle.id.0), at, &drawn)
}

fn log(stream: &Stream, event: &Event, stations: &[Station], at: At) -> Done {
    let Some(line) = event.log_line(stations) else { return Ok(()) };
    // The viewer has no level for WATCH; it shows an unknown level as plain text without a colour.
    let level = match line.severity {
        Severity::Debug => rr::TextLogLevel::DEBUG,
        Severity::Info => rr::TextLogLevel::INFO,
        Severity::Watch => "WATCH",
        Severity::Warn => rr::TextLogLevel::WARN,
        Severity::Crit => rr::TextLogLevel::CRITICAL,
    };
    let text = rr::TextLog::new(line.text).with_level(level);
    stream.once(&format!("{}/{}", paths::LOG, line.source), at, &text)
}

/// The name of an event in the journal.
fn name_of(event: &Event) -> String {
    let json = serde_json::to_value(event).unwrap_or_default();
    json["event"].as_str().unwrap_or("an unreadable event").to_owned()
}
