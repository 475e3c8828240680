//! The static scene: tank, obstacles, zones, stations, preset path, and the styles of everything else.

use super::{
    lane::{Flat, flat},
    paths,
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};
use mission::{TaskConfig, event::RunOpened};
use std::f64::consts::TAU;
use world::{Boundary, Obstacle, Point, Shape, Tool, Vector, Zone, ZoneKind};

type Done = Result<(), RecordingError>;

/// Maximum number of labels; more would hide the map. The names still appear when the pointer is over an item.
const MOST_LABELS: usize = 12;
/// Half the size of the cross that marks an obstacle without extent, metres.
const CROSS_M: f64 = 0.08;

/// Distance, metres, below which points share a label.
const LABEL_M: f64 = 0.5;

/// Draws the static scene.
pub(crate) fn draw(stream: &Stream, run: &RunOpened) -> Done {
    // The viewer's 2D view has y pointing down. The view is flipped once, here; the data stays true.
    let upright = [[1.0_f32, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    stream.always(paths::WORLD, &rr::Transform3D::from_mat3x3(upright))?;
    draw_wall(stream, &run.world.boundary)?;
    let (known, hidden): (Vec<_>, Vec<_>) = run.world.obstacles.iter().partition(|obstacle| obstacle.known);
    draw_obstacles(stream, paths::OBSTACLES_KNOWN, &known, style::OBSTACLE, 2.0)?;
    draw_obstacles(stream, paths::OBSTACLES_HIDDEN, &hidden, style::HIDDEN, 1.0)?;
    draw_zones(stream, run)?;
    draw_plates(stream, run)?;
    draw_key(stream, run)?;
    draw_stations(stream, run)?;
    draw_task(stream, run)?;
    let at = run.mission.start.position;
    // A coverage mission ends where it starts, and two labels in the same place would be unreadable.
    let ends_here =
        matches!(&run.mission.task, TaskConfig::Cover { anchor, .. } if (anchor - at).norm() < LABEL_M);
    let start = rr::Points2D::new([flat(at)]).with_colors([style::color(style::WALL)]);
    let label = if ends_here && run.mission.tether.is_some() { "start and anchor" } else { "start" };
    stream.always(paths::START, &start.with_radii([style::on_screen(3.0)]).with_labels([label]))?;
    style_moving(stream, run)
}

fn draw_wall(stream: &Stream, boundary: &Boundary) -> Done {
    let wall = match boundary {
        Boundary::Circle { radius_m } => circle(Point::origin(), *radius_m, 180),
        Boundary::Polygon { vertices } => ring(vertices),
    };
    stream.always(paths::TANK, &lines([wall], style::WALL, 2.0))
}

fn draw_obstacles(stream: &Stream, path: &str, obstacles: &[&Obstacle], color: [u8; 4], width: f32) -> Done {
    if obstacles.is_empty() {
        return Ok(());
    }
    let strips = obstacles.iter().map(|obstacle| outline(&obstacle.shape));
    let drawn = lines(strips, color, width)
        .with_radii(obstacles.iter().map(|obstacle| thickness(&obstacle.shape, width)))
        .with_labels(obstacles.iter().map(|obstacle| obstacle.name.as_str()))
        .with_show_labels(path == paths::OBSTACLES_KNOWN && obstacles.len() <= MOST_LABELS);
    stream.always(path, &drawn)
}

fn draw_zones(stream: &Stream, run: &RunOpened) -> Done {
    let zones = &run.world.zones;
    if zones.is_empty() {
        return Ok(());
    }
    stream.always(paths::ZONES, &drawn_zones(zones))
}

/// A zone that was drawn during the run.
pub(super) fn draw_zone(stream: &Stream, at: At, zone: &Zone) -> Done {
    let path = format!("{}/{}", paths::ZONES, zone.name.replace(' ', "-"));
    stream.once(&path, at, &drawn_zones(std::slice::from_ref(zone)))
}

fn drawn_zones(zones: &[Zone]) -> rr::LineStrips2D {
    let color = |kind| match kind {
        ZoneKind::NoGo => [235, 100, 90, 140],
        ZoneKind::Land => [200, 180, 120, 110],
        ZoneKind::Underwater => [80, 150, 200, 110],
    };
    lines(zones.iter().map(|zone| outline(&zone.shape)), style::WALL, 1.0)
        .with_radii(zones.iter().map(|zone| thickness(&zone.shape, 1.0)))
        .with_colors(zones.iter().map(|zone| style::color(color(zone.kind))))
        .with_labels(zones.iter().map(|zone| zone.name.as_str()))
        .with_show_labels(zones.len() <= MOST_LABELS)
        .with_draw_order(-5.0)
}

/// The seams of the plates, and the name of each plate at the middle of its floor.
fn draw_plates(stream: &Stream, run: &RunOpened) -> Done {
    let Some(layout) = &run.plates else { return Ok(()) };
    let seams = layout.seams(&run.world.boundary);
    let seams = seams.iter().map(|seam| seam.iter().map(|point| flat(*point)).collect());
    stream.always(paths::PLATES, &lines(seams, style::PLATE, 0.6).with_draw_order(-8.0))?;
    let map = layout.map(&run.world.boundary, &run.floor);
    let mut sums = vec![(0.0, Vector::zeros()); map.plates.len()];
    for cell in 0..run.floor.len() {
        if let Some((count, sum)) = map.plate_of(cell).and_then(|plate| sums.get_mut(plate)) {
            *count += 1.0;
            *sum += run.floor.center(cell).coords;
        }
    }
    let middles = sums.iter().map(|(count, sum)| flat(*sum / f64::max(*count, 1.0)));
    let names = rr::Points2D::new(middles)
        .with_colors([style::color(style::PLATE)])
        .with_radii([style::on_screen(0.0)])
        .with_labels(map.plates.iter().map(|plate| plate.name.as_str()))
        .with_show_labels(map.plates.len() <= MOST_LABELS);
    stream.always(paths::PLATE_NAMES, &names)
}

/// The key to the colours: a row of dots below the tank.
fn draw_key(stream: &Stream, run: &RunOpened) -> Done {
    let floor = match &run.mission.task {
        TaskConfig::Goto { .. } => &[][..],
        TaskConfig::Survey { .. } => &[("explored", style::SCANNED), ("columns", style::FOUND)],
        TaskConfig::Follow { .. } => &[("scanned", style::SCANNED), ("unreachable", style::OUT_OF_REACH)],
        TaskConfig::Cover { .. } => &[
            ("scanned", style::SCANNED),
            ("to do", style::TO_DO),
            ("missed", style::MISSED),
            ("unreachable", style::OUT_OF_REACH),
        ],
    };
    let ways = [("true", style::TRUE), ("estimated", style::ESTIMATE), ("planned", style::PLAN)];
    let entries: Vec<_> = floor.iter().chain(&ways).collect();
    let (low, high) = run.world.boundary.bounds();
    let size_m = (high - low).max();
    let middle = nalgebra::center(&low, &high);
    let at = |index: usize| {
        let step = index as f64 - (entries.len() - 1) as f64 / 2.0;
        flat([middle.x + 0.15 * size_m * step, low.y - 0.06 * size_m])
    };
    let places = || (0..entries.len()).map(at);
    let dots = rr::Points2D::new(places())
        .with_colors(entries.iter().map(|(_, color)| style::color(*color)))
        .with_radii([style::on_screen(6.0)]);
    stream.always(paths::KEY, &dots)?;
    // Labels have the colour of their points, and the floor is dark.
    let names = rr::Points2D::new(places())
        .with_colors([style::color(style::WALL)])
        .with_radii([style::on_screen(1.0)])
        .with_labels(entries.iter().map(|(name, _)| *name))
        .with_show_labels(true);
    stream.always(paths::KEY_NAMES, &names)
}

fn draw_stations(stream: &Stream, run: &RunOpened) -> Done {
    let stations = &run.world.stations;
    let drawn = rr::Points2D::new(stations.iter().map(|station| flat(station.position)))
        .with_colors([style::color(style::STATION)])
        .with_radii([style::on_screen(6.0)])
        .with_labels(stations.iter().map(|station| station.name.as_str()))
        .with_show_labels(stations.len() <= MOST_LABELS);
    stream.always(paths::STATIONS, &drawn)
}

fn draw_task(stream: &Stream, run: &RunOpened) -> Done {
    match &run.mission.task {
        TaskConfig::Follow { path, .. } => {
            let preset = path.iter().map(|point| flat(*point)).collect();
            stream.always(paths::PRESET, &lines([preset], style::PRESET, 0.8))
        }
        TaskConfig::Goto { goal, .. } => draw_end(stream, *goal, Some("goal")),
        TaskConfig::Cover { anchor, .. } | TaskConfig::Survey { anchor, .. } => {
            let is_apart = (anchor - run.mission.start.position).norm() >= LABEL_M;
            draw_end(stream, *anchor, is_apart.then_some("anchor"))
        }
    }
}

fn draw_end(stream: &Stream, at: Point, label: Option<&str>) -> Done {
    let end = rr::Points2D::new([flat(at)]).with_colors([style::color(style::PLAN)]);
    stream.always(paths::GOAL, &end.with_radii([style::on_screen(6.0)]).with_labels(label))
}

/// Colours and widths of moving entities, and the shapes that move with the robot; the stream then carries positions
/// only.
fn style_moving(stream: &Stream, run: &RunOpened) -> Done {
    let radius_m = run.mission.limits.radius_m;
    let (low, high) = run.world.boundary.bounds();
    let heading_m = (2.0 * radius_m).max(0.03 * (high - low).norm());
    let heading = rr::Arrows2D::from_vectors([[heading_m as f32, 0.0]]).with_origins([[0.0, 0.0]]);
    stream.always(
        paths::HEADING,
        &heading.with_colors([style::color(style::TRUE)]).with_radii([style::on_screen(2.0)]),
    )?;
    stream.always(paths::HULL, &lines([circle(Point::origin(), radius_m, 32)], style::TRUE, 1.5))?;
    if matches!(run.mission.task, TaskConfig::Follow { .. } | TaskConfig::Cover { .. }) {
        let half_m = (run.mission.swath_m / 2.0) as f32;
        let swath = match run.mission.tool() {
            Tool::Bar { .. } => vec![[0.0, -half_m], [0.0, half_m]],
            Tool::Disc { swath_m } => circle(Point::origin(), swath_m / 2.0, 32),
        };
        stream.always(paths::SWATH, &lines([swath], style::SWATH, 2.0))?;
    }
    let dots = |color, radius| {
        rr::Points2D::update_fields()
            .with_colors([style::color(color)])
            .with_radii([style::on_screen(radius)])
    };
    let center = |color, radius| dots(color, radius).with_positions([[0.0, 0.0]]);
    stream.always(paths::TRUE, &center(style::TRUE, 2.0))?;
    stream.always(paths::ESTIMATE, &center(style::ESTIMATE, 1.5))?;
    stream.always(paths::TARGET, &dots(style::PLAN, 4.0))?;
    stream.always(paths::FIX, &dots(style::STATION, 2.5))?;
    let covariance = rr::Ellipses2D::update_fields().with_colors([style::color(style::ESTIMATE)]);
    stream.always(paths::ESTIMATE, &covariance.with_line_radii([style::on_screen(1.2)]))?;
    stream.always(paths::PLANNED, &line_style(style::PLAN, 1.0))?;
    if matches!(run.mission.task, TaskConfig::Cover { .. }) {
        stream.always(paths::CUTS, &line_style(style::WARNING, 1.2))?;
    }
    stream.always(paths::WAY_TRUE, &line_style([90, 220, 130, 130], 1.0))?;
    stream.always(paths::WAY_ESTIMATE, &line_style([255, 120, 220, 110], 0.8))?;
    stream.always(paths::RANGES, &rr::LineStrips2D::update_fields().with_radii([style::on_screen(0.7)]))?;
    let Some(tether) = &run.mission.tether else { return Ok(()) };
    stream.always(paths::TETHER, &line_style(style::TETHER, 1.5))?;
    stream.always(paths::TETHER_CABLE, &line_style(style::TRUE, 1.0))?;
    stream.always(paths::TETHER_CONTACTS, &dots(style::WARNING, 4.0))?;
    let anchor = rr::Points2D::new([flat(tether.anchor)]).with_colors([style::color(style::TETHER)]);
    stream.always(paths::TETHER_ANCHOR, &anchor.with_radii([style::on_screen(5.0)]))
}

/// Colour and width of lines that are added later.
pub(crate) fn line_style(color: [u8; 4], width: f32) -> rr::LineStrips2D {
    rr::LineStrips2D::update_fields().with_colors([style::color(color)]).with_radii([style::on_screen(width)])
}

/// Lines of one colour.
pub(crate) fn lines(
    strips: impl IntoIterator<Item = Vec<Flat>>,
    color: [u8; 4],
    width: f32,
) -> rr::LineStrips2D {
    rr::LineStrips2D::new(strips.into_iter().map(rr::LineStrip2D::from_iter))
        .with_colors([style::color(color)])
        .with_radii([style::on_screen(width)])
}

/// The outline of a shape as a line; a polyline is represented by its centre line, at its true width.
pub(crate) fn outline(shape: &Shape) -> Vec<Flat> {
    match shape {
        Shape::Disc { center, radius_m } if *radius_m < CROSS_M / 4.0 => cross(*center),
        Shape::Disc { center, radius_m } => circle(*center, *radius_m, 48),
        Shape::Polygon { vertices } => ring(vertices),
        Shape::Polyline { points, .. } => points.iter().map(|point| flat(*point)).collect(),
    }
}

/// The line width of the outline of a shape.
pub(crate) fn thickness(shape: &Shape, width: f32) -> rr::Radius {
    match shape {
        Shape::Polyline { half_width_m, .. } if *half_width_m > 0.0 => style::on_floor(*half_width_m),
        _ => style::on_screen(width),
    }
}

fn ring(vertices: &[Point]) -> Vec<Flat> {
    vertices.iter().chain(vertices.first()).map(|point| flat(*point)).collect()
}

fn circle(center: Point, radius_m: f64, pieces: u32) -> Vec<Flat> {
    let at = |k| {
        let angle = TAU * f64::from(k) / f64::from(pieces);
        flat([center.x + radius_m * angle.cos(), center.y + radius_m * angle.sin()])
    };
    (0..=pieces).map(at).collect()
}

fn cross(center: Point) -> Vec<Flat> {
    let corner = |x, y| flat([center.x + x * CROSS_M, center.y + y * CROSS_M]);
    vec![corner(-1.0, -1.0), corner(1.0, 1.0), corner(0.0, 0.0), corner(-1.0, 1.0), corner(1.0, -1.0)]
}
