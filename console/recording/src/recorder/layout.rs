//! The layout in which the viewer opens a recording: map on the left, figures, states and log on the right.
//!
//! The layout is embedded in the recording. The SDK's builders lack some view properties (bounds, background, axes,
//! trails). We append these to the same blueprint store, under the paths from which the viewer reads them.

use super::{
    paths,
    stream::{APPLICATION, SIM_TIME, TICK},
    style,
};
use crate::{
    error::RecordingError,
    rr::{self, bp, datatypes, view, view_data, view_part},
};
use mission::{MissionConfig, TaskConfig, event::RunOpened};
use rr::AsComponents;

/// Margin around the tank as a share of its size.
const MARGIN: f64 = 0.06;

/// A property of a view that the SDK's builders lack.
struct Extra {
    path: String,
    what: Vec<rr::SerializedComponentBatch>,
}

/// Views, and the properties to append.
#[derive(Default)]
struct Sketch {
    extras: Vec<Extra>,
}

/// The layout of a run as messages for the recording.
pub(crate) fn messages(
    run: &RunOpened,
) -> Result<(Vec<rr::LogMsg>, rr::BlueprintActivationCommand), RecordingError> {
    let mut sketch = Sketch::default();
    let blueprint = sketch.blueprint(run);
    build(&blueprint, sketch.extras).map_err(|error| RecordingError::sdk(&error))
}

fn build(
    blueprint: &bp::Blueprint,
    extras: Vec<Extra>,
) -> Result<(Vec<rr::LogMsg>, rr::BlueprintActivationCommand), rr::RecordingStreamError> {
    let activation = bp::BlueprintActivation { make_active: true, make_default: true };
    let (scratch, store) =
        rr::RecordingStreamBuilder::new(APPLICATION).enabled(true).send_properties(false).memory()?;
    blueprint.send(&scratch, activation)?;
    let mut messages = store.take();
    let id =
        messages.iter().map(rr::LogMsg::store_id).find(|id| id.kind() == rr::StoreKind::Blueprint).cloned();
    let id = id.expect("a blueprint that was sent has a store");
    messages.retain(|m| *m.store_id() == id && !matches!(m, rr::LogMsg::BlueprintActivationCommand(_)));
    let (patch, store) =
        rr::RecordingStreamBuilder::from_store_id(&id).enabled(true).send_properties(false).memory()?;
    patch.set_time_sequence("blueprint", 0);
    for extra in extras {
        patch.log_serialized_batches(extra.path, false, extra.what)?;
    }
    messages.extend(store.take().into_iter().filter(|message| matches!(message, rr::LogMsg::ArrowMsg(..))));
    // A memory stream and its store keep each other alive; unless they are disconnected here, the threads of both
    // would outlive the run.
    scratch.disconnect();
    patch.disconnect();
    Ok((messages, rr::BlueprintActivationCommand { blueprint_id: id, make_active: true, make_default: true }))
}

impl Sketch {
    fn blueprint(&mut self, run: &RunOpened) -> bp::Blueprint {
        let map = self.map(run);
        let right = self.right(run);
        let root = bp::Horizontal::new([map, right]).with_column_shares(vec![1.15, 1.0]);
        bp::Blueprint::new(root)
            .with_auto_views(false)
            .with_auto_layout(false)
            .with_blueprint_panel(bp::BlueprintPanel::from_state(view_part::PanelState::Collapsed))
            .with_selection_panel(bp::SelectionPanel::from_state(view_part::PanelState::Collapsed))
            .with_time_panel(
                bp::TimePanel::new()
                    .with_state(view_part::PanelState::Collapsed)
                    .with_timeline(SIM_TIME)
                    .with_play_state(view_part::PlayState::Following),
            )
    }

    fn map(&mut self, run: &RunOpened) -> bp::ContainerLike {
        let map = bp::Spatial2DView::new("Map")
            .with_origin(format!("/{}", paths::MAP))
            .with_contents(["$origin/**"])
            .into();
        let path = view_path(&map);
        self.add(&path, "VisualBounds2D", &bounds(run));
        let background = view::Background::new(view_part::BackgroundKind::SolidColor);
        self.add(&path, "Background", &background.with_color(style::color(style::FLOOR)));
        let way = since_the_start();
        for entity in [paths::WAY_TRUE, paths::WAY_ESTIMATE] {
            self.add(&path, &format!("ViewContents/overrides/{entity}/visualizers"), &way);
        }
        map
    }

    fn right(&mut self, run: &RunOpened) -> bp::ContainerLike {
        let error = if run.mission.locating.risk.is_some() {
            let series = [paths::ERROR, paths::ERROR_95, paths::PROTECTION];
            self.plot("Error (pink), 95 % (blue), protection level (yellow) [m]", &series, None)
        } else {
            self.plot("Error (pink), 95 % (blue) [m]", &[paths::ERROR, paths::ERROR_95], None)
        };
        let share = match run.mission.task {
            TaskConfig::Goto { .. } => None,
            TaskConfig::Survey { .. } => Some(("Floor explored [%]", paths::EXPLORED_SHARE)),
            TaskConfig::Follow { .. } | TaskConfig::Cover { .. } => {
                Some(("Reachable floor scanned [%]", paths::COVERED))
            }
        };
        let covered = share.map(|(name, figure)| self.plot(name, &[figure], Some([0.0, 105.0])));
        let speed = self.plot("Speed (green), sent (blue) [m/s]", &[paths::SPEED, paths::SPEED_SENT], None);
        let clearance = self.plot("Clearance [m]", &[paths::CLEARANCE], None);
        let planning = self.planning(&run.mission);
        let states = bp::StateTimelineView::new("States")
            .with_origin(format!("/{}", paths::STATE))
            .with_contents(["$origin/**"])
            .into();
        // The full length of the run, even while it is still being read.
        let link = view::TimeAxis::update_fields().with_link(view_part::LinkAxis::LinkToGlobal);
        self.add(&view_path(&states), "TimeAxis", &link);
        let log = self.log();
        let mission = bp::TextDocumentView::new("Mission").with_origin(format!("/{}", paths::SUMMARY)).into();
        let scenario =
            bp::TextDocumentView::new("Scenario").with_origin(format!("/{}", paths::SCENARIO)).into();
        bp::Vertical::new([
            bp::Horizontal::new([error].into_iter().chain(covered)).into(),
            bp::Horizontal::new([speed, clearance]).into(),
            planning,
            states,
            bp::Tabs::new([log, mission, scenario]).into(),
        ])
        .with_row_shares(vec![1.5, 1.5, 1.7, 1.8, 1.9])
        .into()
    }

    /// Plots of the planner's internal figures: one at a time, the most informative first.
    fn planning(&mut self, mission: &MissionConfig) -> bp::ContainerLike {
        let forces = self.plot("Forces [N]", &[paths::FORCE_SIZES], None);
        let figures = self.plot_with_legend("Planner", paths::PLANNER_SCALARS);
        match (&mission.task, &mission.tether) {
            (_, Some(tether)) => {
                let out =
                    [paths::TETHER_OUT, paths::TETHER_OUT_TRUE, paths::TETHER_HOME, paths::TETHER_SLACK];
                let out = self.plot("Tether [m]", &out, None);
                let wraps = self.plot("Wraps [deg]", &[paths::TETHER_WRAP, paths::TETHER_SUM], None);
                let pull = tether.reel.map(|_| {
                    let pulls = [paths::TETHER_PULL, paths::TETHER_PULL_MEASURED];
                    self.plot("Pull on the tether [N]", &pulls, None)
                });
                let cross_track = self.plot("Cross-track [m]", &[paths::CROSS_TRACK], None);
                let residuals = self.residuals();
                let others = [cross_track, residuals, forces, figures];
                bp::Tabs::new([out, wraps].into_iter().chain(pull).chain(others)).into()
            }
            (TaskConfig::Follow { .. } | TaskConfig::Cover { .. }, None) => {
                let cross_track = self.plot("Cross-track [m]", &[paths::CROSS_TRACK], None);
                let residuals = self.residuals();
                bp::Tabs::new([cross_track, residuals, forces, figures]).into()
            }
            (TaskConfig::Goto { .. } | TaskConfig::Survey { .. }, None) => {
                let residuals = self.residuals();
                bp::Tabs::new([forces, figures, residuals]).into()
            }
        }
    }

    /// The event log without the path column, which only repeats the text.
    fn log(&mut self) -> bp::ContainerLike {
        let log = bp::TextLogView::new("Events").with_origin(format!("/{}", paths::LOG)).into();
        let shown = |kind| view_data::TextLogColumn { visible: true.into(), kind };
        let columns = [view_data::TextLogColumnKind::LogLevel, view_data::TextLogColumnKind::Body];
        let columns = view::TextLogColumns::update_fields().with_text_log_columns(columns.map(shown));
        self.add(&view_path(&log), "TextLogColumns", &columns);
        log
    }

    fn residuals(&mut self) -> bp::ContainerLike {
        self.plot_with_legend("Residuals [m]", paths::RESIDUALS)
    }

    /// A plot of everything below an entity; the names are known only later.
    fn plot_with_legend(&mut self, name: &str, below: &str) -> bp::ContainerLike {
        let plot = self.plot_of(name, &[&format!("{below}/**")], None);
        let legend = view::PlotLegend::new().with_corner(view_part::Corner2D::RightTop);
        self.add(&view_path(&plot), "PlotLegend", &legend);
        plot
    }

    /// A plot without a legend, which would cover the curves; its name or the document beside the map explains them.
    fn plot(&mut self, name: &str, entities: &[&str], range: Option<[f64; 2]>) -> bp::ContainerLike {
        let plot = self.plot_of(name, entities, range);
        self.add(&view_path(&plot), "PlotLegend", &view::PlotLegend::new().with_visible(false));
        plot
    }

    fn plot_of(&mut self, name: &str, entities: &[&str], range: Option<[f64; 2]>) -> bp::ContainerLike {
        let plot = bp::TimeSeriesView::new(name)
            .with_origin(format!("/{}", paths::SCALARS))
            .with_contents(entities.iter().map(|entity| format!("/{entity}")))
            .into();
        let path = view_path(&plot);
        if let Some(range) = range {
            self.add(&path, "ScalarAxis", &view::ScalarAxis::new().with_range(datatypes::Range1D(range)));
        }
        let whole = datatypes::TimeRange {
            start: datatypes::TimeRangeBoundary::Infinite,
            end: datatypes::TimeRangeBoundary::Infinite,
        };
        self.add(&path, "TimeAxis", &view::TimeAxis::new().with_view_range(whole));
        plot
    }

    fn add(&mut self, view: &str, property: &str, what: &dyn AsComponents) {
        self.extras.push(Extra { path: format!("{view}/{property}"), what: what.as_serialized_batches() });
    }
}

fn view_path(view: &bp::ContainerLike) -> String {
    match view {
        bp::ContainerLike::View(view) => view.blueprint_path().to_string(),
        _ => unreachable!("a view was made just before"),
    }
}

/// The part of the map that is shown initially: the tank with a margin and the key below it, flipped like the map
/// itself.
fn bounds(run: &RunOpened) -> view::VisualBounds2D {
    let (mut low, high) = run.world.boundary.bounds();
    let margin = MARGIN * (high - low).max();
    low.y -= margin;
    view::VisualBounds2D::new(view_part::VisualBounds2D(datatypes::Range2D {
        x_range: [low.x - margin, high.x + margin].into(),
        y_range: [-high.y - margin, -low.y + margin].into(),
    }))
}

fn since_the_start() -> view::VisibleTimeRanges {
    let start = || datatypes::TimeRangeBoundary::Infinite;
    view::VisibleTimeRanges::new([until_now(TICK, start()), until_now(SIM_TIME, start())])
}

fn until_now(timeline: &str, start: datatypes::TimeRangeBoundary) -> datatypes::VisibleTimeRange {
    let end = datatypes::TimeRangeBoundary::CursorRelative(datatypes::TimeInt(0));
    datatypes::VisibleTimeRange { timeline: timeline.into(), range: datatypes::TimeRange { start, end } }
}
