//! Positions and shapes as `GeoJSON`.

use crate::drawing::polygons::Polygon;
use account::Inspection;
use serde_json::{Value, json};
use world::{Boundary, Point, Shape};

/// The tank frame in a coordinate system; without a datum, the tank frame is a system of its own.
pub(crate) struct Datum<'a> {
    east_m: f64,
    north_m: f64,
    turn_rad: f64,
    /// Name of the coordinate system; `None` for the tank frame.
    crs: Option<&'a str>,
}

impl<'a> Datum<'a> {
    /// The datum of an inspection.
    pub(crate) fn of(facts: &'a Inspection) -> Self {
        let [east_m, north_m] = facts.datum_m.unwrap_or([0.0, 0.0]);
        let unnamed = "system not named (inspection.datum_crs)";
        let crs = facts.datum_m.map(|_| facts.datum_crs.as_deref().unwrap_or(unnamed));
        Self { east_m, north_m, turn_rad: -facts.datum_north_deg.unwrap_or(0.0).to_radians(), crs }
    }

    /// The member that names the coordinate system. Programs read coordinates as degrees of longitude and latitude
    /// unless they know the name in this member. A system whose name they may not know is therefore written as a
    /// local system in WKT.
    pub(crate) fn crs(&self) -> Value {
        let name = match self.crs {
            Some(name) if is_known(name) => name.to_owned(),
            Some(name) => local(name),
            None => local("tank frame: x east and y north in the tank, no datum (inspection.datum_m)"),
        };
        json!({ "type": "name", "properties": { "name": name } })
    }

    /// A description of the coordinates, for people.
    pub(crate) fn words(&self) -> String {
        match self.crs {
            Some(name) => format!("{name}, metres"),
            None => "tank frame, metres; not longitude and latitude".to_owned(),
        }
    }

    /// A position, rounded to a tenth of a millimetre.
    pub(crate) fn at(&self, p: Point) -> Value {
        let (sin, cos) = self.turn_rad.sin_cos();
        json!([rounded(self.east_m + p.x * cos - p.y * sin), rounded(self.north_m + p.x * sin + p.y * cos)])
    }

    /// Polygons with holes as one geometry.
    pub(crate) fn polygons(&self, polygons: &[Polygon]) -> Value {
        let rings = |polygon: &Polygon| -> Value { polygon.rings().map(|ring| self.ring(ring)).collect() };
        match polygons {
            [only] => json!({ "type": "Polygon", "coordinates": rings(only) }),
            all => {
                let all: Value = all.iter().map(rings).collect();
                json!({ "type": "MultiPolygon", "coordinates": all })
            }
        }
    }

    /// A point.
    pub(crate) fn point(&self, at: Point) -> Value {
        json!({ "type": "Point", "coordinates": self.at(at) })
    }

    /// The geometry of a shape: a polygon, or the centre line of a pipe.
    pub(crate) fn shape(&self, shape: &Shape) -> Value {
        match shape {
            Shape::Polyline { points, .. } => self.line(points),
            shape => self.polygon(&corners(shape)),
        }
    }

    fn ring(&self, points: &[Point]) -> Value {
        points.iter().chain(points.first()).map(|p| self.at(*p)).collect()
    }

    /// A polygon; this function closes its ring.
    pub(crate) fn polygon(&self, points: &[Point]) -> Value {
        json!({ "type": "Polygon", "coordinates": [self.ring(points)] })
    }

    /// A line.
    pub(crate) fn line(&self, points: &[Point]) -> Value {
        let places: Value = points.iter().map(|p| self.at(*p)).collect();
        json!({ "type": "LineString", "coordinates": places })
    }
}

/// Whether programs know the name of a system: an EPSG code, or its definition in WKT.
fn is_known(name: &str) -> bool {
    let is_code = |code: &str| !code.is_empty() && code.bytes().all(|byte| byte.is_ascii_digit());
    let lower = name.trim().to_ascii_lowercase();
    let code = ["epsg:", "urn:ogc:def:crs:epsg::"].iter().find_map(|start| lower.strip_prefix(start));
    code.is_some_and(is_code) || (lower.contains("crs[") || lower.contains("cs[")) && lower.ends_with(']')
}

/// A local system in metres as WKT 1: all programs based on GDAL read it, and none transforms it.
fn local(name: &str) -> String {
    let name: String = name.chars().map(|c| if matches!(c, '"' | '[' | ']') { ' ' } else { c }).collect();
    format!(r#"LOCAL_CS["{name}",UNIT["metre",1]]"#)
}

/// Rounds a number to four decimals: a tenth of a millimetre, or a square centimetre.
pub(crate) fn rounded(value: f64) -> f64 {
    // A number that rounds to zero has no sign.
    (10_000.0 * value).round() / 10_000.0 + 0.0
}

/// A feature.
pub(crate) fn feature(geometry: Value, properties: Value) -> Value {
    let members = [("type", "Feature".into()), ("geometry", geometry), ("properties", properties)];
    Value::Object(members.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}

/// The wall as a ring.
pub(crate) fn outline(boundary: &Boundary) -> Vec<Point> {
    match boundary {
        Boundary::Circle { radius_m } => circle(Point::origin(), *radius_m),
        Boundary::Polygon { vertices } => vertices.clone(),
    }
}

/// The outline of a shape.
fn corners(shape: &Shape) -> Vec<Point> {
    match shape {
        Shape::Disc { center, radius_m } => circle(*center, *radius_m),
        Shape::Polygon { vertices } => vertices.clone(),
        Shape::Polyline { points, .. } => points.clone(),
    }
}

fn circle(center: Point, radius_m: f64) -> Vec<Point> {
    let at = |k: u32| center + world::geometry::unit_vector(f64::from(k).to_radians() * 5.0) * radius_m;
    (0..72).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_that_programs_may_not_know_is_written_as_a_local_one() {
        let name = |facts: &Inspection| Datum::of(facts).crs()["properties"]["name"].clone();
        let facts = |crs: Option<&str>| Inspection {
            datum_m: Some([691_000.0, 5_334_000.0]),
            datum_crs: crs.map(str::to_owned),
            ..Inspection::default()
        };
        assert_eq!(name(&facts(Some("EPSG:25832"))), "EPSG:25832");
        assert_eq!(name(&facts(Some("works grid \"A\""))), r#"LOCAL_CS["works grid  A ",UNIT["metre",1]]"#);
        for unknown in [facts(None), Inspection::default(), facts(Some("EPSG:utm"))] {
            let name = name(&unknown).to_string();
            assert!(name.starts_with("\"LOCAL_CS["), "{name}");
        }
    }

    #[test]
    fn numbers_are_as_fine_as_a_tenth_of_a_millimetre() {
        assert_eq!(rounded(0.052_500_000_000_000_01).to_string(), "0.0525");
        assert_eq!(rounded(-0.000_01).to_string(), "0");
    }
}
