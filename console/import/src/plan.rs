//! A floor plan from the file of another program, and the scenario made from it.

use std::{f64::consts::TAU, fmt::Write};
use world::{Boundary, DrawnPlate, Obstacle, ObstacleId, ObstacleMap, Point, Shape, World};

/// The largest number of corners of a polygon in a scenario, since the sides of a polygon are compared in pairs.
pub const MOST_CORNERS: usize = 200;
/// The largest number of plates of a floor in a scenario.
pub const MOST_PLATES: usize = 2_000;
/// The number of stations in a scenario made from a file without stations.
const N_STATIONS: usize = 5;
/// The number of points along each side of the grid from which the start is chosen.
const N_PLACES: usize = 64;
/// The width of a scanned pass in metres, and the speed in metres per second from which the time limit is estimated.
const SWATH_M: f64 = 0.6;
const PACE_M_PER_S: f64 = 0.1;

/// The largest time limit for a scenario in seconds, since the number of ticks is limited.
const LONGEST_S: f64 = 500_000.0;

/// A named shape in the tank frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// The name; it is unique.
    pub name: String,
    /// The outline; a polygon is convex.
    pub shape: Shape,
}

/// A floor plan in the tank frame; a round tank is centred at the origin.
#[derive(Debug, Clone, PartialEq)]
pub struct FloorPlan {
    /// The shell of the tank.
    pub boundary: Boundary,
    /// The columns and pipes.
    pub obstacles: Vec<Named>,
    /// Areas that the robot must not enter: sumps and no-go areas.
    pub no_go: Vec<Named>,
    /// Plates of the floor, if the file contains them; where plates overlap, the first takes precedence.
    pub plates: Vec<DrawnPlate>,
    /// Notes for the user on assumptions, changes, and unused parts of the file.
    pub notes: Vec<String>,
}

impl FloorPlan {
    /// The plan as a world, for drawing it.
    pub fn world(&self) -> World {
        let obstacle = |(index, named): (usize, &Named)| Obstacle {
            id: ObstacleId(index as u32 + 1),
            name: named.name.clone(),
            shape: named.shape.clone(),
            known: true,
        };
        let zone = |named: &Named| world::Zone {
            name: named.name.clone(),
            kind: world::ZoneKind::NoGo,
            shape: named.shape.clone(),
        };
        World {
            boundary: self.boundary.clone(),
            obstacles: self.obstacles.iter().enumerate().map(obstacle).collect(),
            stations: Vec::new(),
            zones: self.no_go.iter().map(zone).collect(),
        }
    }

    /// The text of a scenario that scans this floor with a planner. Comments mark the defaults used for values that the
    /// file does not state.
    pub fn scenario(&self, name: &str, source: &str, planner: &str) -> String {
        let mut text = format!("# The floor was imported from {}.\n", commented(source));
        for note in &self.notes {
            let _ = writeln!(text, "# - {}", commented(note));
        }
        let (name, about) = (quoted(name), quoted(&format!("The floor of {source}")));
        // Writing to a String cannot fail.
        let _ = write!(text, "\nname = {name}\nabout = {about}\nseed = 1\n\n[tank]\n");
        let _ = match &self.boundary {
            Boundary::Circle { radius_m } => writeln!(text, "radius_m = {}", micrometres(*radius_m)),
            Boundary::Polygon { vertices } => writeln!(text, "vertices_m = {}", points(vertices)),
        };
        entries(&mut text, "obstacles", "kind", &self.obstacles);
        entries(&mut text, "zones", "kind = \"no_go\"\nshape", &self.no_go);
        plates(&mut text, &self.plates);
        let start = self.roomiest();
        let seconds = (self.boundary.area_m2() / (SWATH_M * PACE_M_PER_S)).clamp(600.0, LONGEST_S).ceil();
        let cell_m = (self.boundary.area_m2().sqrt() / 400.0).max(0.05);
        let _ = write!(
            text,
            "\n# The start is the point with the most clearance; change it to the manhole.\n[robot]\nstart_m = \
             {}\n\n# Assumed: replace these stations with the surveyed ones.\n[ae]\nnoise = {{ model = \
             \"uniform\", ratio = 0.02 }}\nstations = [\n",
            point(start)
        );
        for (index, at) in self.stations().into_iter().enumerate() {
            let letter = char::from(b'A' + index as u8);
            let _ = writeln!(text, "    {{ name = \"{letter}\", at_m = {} }},", point(at));
        }
        let _ = write!(
            text,
            "]\n\n[mission]\nkind = \"cover\"\nswath_m = {SWATH_M}\noverlap_m = 0.1\nclearance_m = 0.1\n\
             cell_m = {cell_m:.2}\ntime_limit_s = {seconds:.1}\n\n[planner]\nid = {}\n",
            quoted(planner)
        );
        text
    }

    /// The point of a grid with the most clearance.
    fn roomiest(&self) -> Point {
        let world = self.world();
        let solids: Vec<Obstacle> = world
            .obstacles
            .into_iter()
            .chain(world.zones.into_iter().map(|zone| Obstacle {
                id: ObstacleId(0),
                name: zone.name,
                shape: zone.shape,
                known: true,
            }))
            .collect();
        let map = ObstacleMap::new(&self.boundary, &solids);
        let (low, high) = self.boundary.bounds();
        let step = (high - low) / N_PLACES as f64;
        let place = |k: usize| {
            let (column, row) = ((k % N_PLACES) as f64 + 0.5, (k / N_PLACES) as f64 + 0.5);
            Point::new(low.x + column * step.x, low.y + row * step.y)
        };
        let places = (0..N_PLACES * N_PLACES).map(place);
        let best = places.max_by(|a, b| map.clearance_m(*a).total_cmp(&map.clearance_m(*b)));
        best.unwrap_or_else(Point::origin)
    }

    /// Points on the shell, evenly spaced.
    fn stations(&self) -> Vec<Point> {
        match &self.boundary {
            Boundary::Circle { radius_m } => {
                let at = |k: usize| TAU * k as f64 / N_STATIONS as f64;
                let inside_m = radius_m - 1e-3;
                (0..N_STATIONS).map(|k| Point::new(inside_m * at(k).cos(), inside_m * at(k).sin())).collect()
            }
            Boundary::Polygon { vertices } => {
                let n = N_STATIONS.min(vertices.len());
                (0..n).map(|k| vertices[k * vertices.len() / n]).collect()
            }
        }
    }
}

fn entries(text: &mut String, list: &str, kind: &str, all: &[Named]) {
    for Named { name, shape } in all {
        let outline = match shape {
            Shape::Disc { center, radius_m } => {
                format!("\"circle\"\ncenter_m = {}\nradius_m = {}", point(*center), micrometres(*radius_m))
            }
            Shape::Polygon { vertices } => format!("\"polygon\"\nvertices_m = {}", points(vertices)),
            Shape::Polyline { points: line, half_width_m } => {
                format!(
                    "\"polyline\"\npoints_m = {}\nwidth_m = {}",
                    points(line),
                    micrometres(2.0 * half_width_m)
                )
            }
        };
        let _ = write!(text, "\n[[{list}]]\nname = {}\n{kind} = {outline}\n", quoted(name));
    }
}

fn plates(text: &mut String, plates: &[DrawnPlate]) {
    if plates.is_empty() {
        return;
    }
    *text += "\n[plates]\noutlines = [\n";
    for DrawnPlate { name, vertices_m } in plates {
        let _ = writeln!(text, "    {{ name = {}, vertices_m = {} }},", quoted(name), points(vertices_m));
    }
    *text += "]\n";
}

/// A text as a TOML string; escapes any content, since names come from files of other programs.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// A text for a comment line; TOML allows no control characters there.
fn commented(text: &str) -> String {
    text.replace(char::is_control, " ")
}

fn micrometres(v: f64) -> f64 {
    (v * 1e6).round() / 1e6 + 0.0
}

fn point(at: Point) -> String {
    format!("[{}, {}]", micrometres(at.x), micrometres(at.y))
}

/// Points as TOML, rounded to the micrometre.
pub fn points(points: &[Point]) -> String {
    let all: Vec<String> = points.iter().map(|at| point(*at)).collect();
    format!("[{}]", all.join(", "))
}

/// The centre, and the smallest and largest radius, of a ring with many corners that is a circle to within half a per
/// cent.
pub(crate) fn round(ring: &[Point]) -> Option<(Point, f64, f64)> {
    const MANY: usize = 16;
    let center = world::shape::mean_of(ring);
    let radii = || ring.iter().map(|at| (at - center).norm());
    let (least_m, largest_m) = (radii().fold(f64::INFINITY, f64::min), radii().fold(0.0, f64::max));
    (ring.len() >= MANY && largest_m - least_m < 0.005 * largest_m).then_some((center, least_m, largest_m))
}
