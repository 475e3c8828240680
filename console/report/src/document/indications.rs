//! Indications of the scanning instrument, by time, placed on the track.

use crate::record::Record;
use foreign::unplain;
use serde::{Deserialize, Serialize};
use world::{Point, geometry::unit_vector};

/// A row of the file: when, where on the tool, and what.
#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Row {
    /// Name of the run; needed with several.
    #[serde(default)]
    run: Option<String>,
    /// Mission time, seconds.
    t_s: f64,
    /// Offset from the middle of the tool to the left of the heading, metres.
    #[serde(default)]
    left_m: f64,
    /// Offset ahead of the middle of the tool, metres.
    #[serde(default)]
    ahead_m: f64,
    #[serde(default)]
    kind: String,
    #[serde(default)]
    size_mm: Option<f64>,
    #[serde(default)]
    depth_mm: Option<f64>,
    #[serde(default)]
    note: String,
}

/// An indication with its place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Indication {
    /// Its number, from 1.
    pub number: usize,
    /// Name of the run in which it was found.
    pub run: String,
    /// Mission time, seconds.
    pub t_s: f64,
    /// Where it lies, metres.
    pub at: Point,
    /// 95 % error of the place, metres.
    pub error_m: f64,
    /// The plate on which it lies; absent if the layout of the plates is not known.
    pub plate: Option<String>,
    /// What kind, as the instrument says.
    pub kind: String,
    /// Size, millimetres.
    pub size_mm: Option<f64>,
    /// Depth, millimetres.
    pub depth_mm: Option<f64>,
    /// Anything else.
    pub note: String,
}

/// Reads indications from CSV with the columns `t_s` and, if there are, `run`, `left_m`, `ahead_m`, `kind`, `size_mm`,
/// `depth_mm` and `note`, and places each where the robot believed its tool to be; `run` is needed with several runs.
/// `thickness_mm`: of the plates, if it is known; `plate_at` names the plate of a place.
///
/// # Errors
/// A file that cannot be read, or a time outside the run: with the line, and what would be right.
pub(super) fn indications(
    csv: &str,
    runs: &[(&str, &Record)],
    thickness_mm: Option<f64>,
    plate_at: impl Fn(Point) -> Option<String>,
) -> Result<Vec<Indication>, String> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(csv.as_bytes());
    let headers = reader.headers().map_err(|error| error.to_string())?.clone();
    let known = ["run", "t_s", "left_m", "ahead_m", "kind", "size_mm", "depth_mm", "note"];
    if let Some(unknown) = headers.iter().find(|name| !known.contains(name)) {
        return Err(format!("line 1: unknown column `{unknown}`; there are {}", known.join(", ")));
    }
    if runs.len() > 1 && !headers.iter().any(|name| name == "run") {
        let names: Vec<&str> = runs.iter().map(|(name, _)| *name).collect();
        return Err(format!(
            "line 1: with several runs a column `run` must name the run of each indication: {}",
            names.join(", ")
        ));
    }
    let end_s = |record: &Record| record.track.last().map_or(0.0, |point| f64::from(point.t_s));
    let place = |(index, fields): (usize, csv::Result<csv::StringRecord>)| {
        let fields = fields.map_err(|error| error.to_string())?;
        let line = fields.position().map_or(0, csv::Position::line);
        let row = row(&fields, &headers, thickness_mm).map_err(|error| format!("line {line}: {error}"))?;
        let (run, record) =
            run_of(runs, row.run.as_deref()).map_err(|error| format!("line {line}: {error}"))?;
        let end_s = end_s(record);
        let inside = (0.0..=end_s + 0.5).contains(&row.t_s);
        let point = record.at(row.t_s).filter(|_| inside);
        let point =
            point.ok_or(format!("line {line}: t_s = {}: the run lasts from 0 to {end_s:.1} s", row.t_s))?;
        let heading = f64::from(point.heading_rad);
        let left = unit_vector(heading + std::f64::consts::FRAC_PI_2);
        let at = point.position() + left * row.left_m + unit_vector(heading) * row.ahead_m;
        Ok(Indication {
            number: index + 1,
            run: run.to_owned(),
            t_s: row.t_s,
            at,
            error_m: f64::from(point.error_m),
            plate: plate_at(at),
            kind: row.kind,
            size_mm: row.size_mm,
            depth_mm: row.depth_mm,
            note: row.note,
        })
    };
    reader.records().enumerate().map(place).collect()
}

/// The run of a name, or the only one.
fn run_of<'a>(runs: &[(&'a str, &'a Record)], name: Option<&str>) -> Result<(&'a str, &'a Record), String> {
    let found = match name {
        Some(name) => runs.iter().find(|(run, _)| *run == name),
        None => runs.first().filter(|_| runs.len() == 1),
    };
    found.copied().ok_or_else(|| {
        let names: Vec<&str> = runs.iter().map(|(name, _)| *name).collect();
        format!("run = {}: must be one of {}", name.unwrap_or("(empty)"), names.join(", "))
    })
}

/// A row, read and within what numbers can be.
fn row(
    fields: &csv::StringRecord,
    headers: &csv::StringRecord,
    thickness_mm: Option<f64>,
) -> Result<Row, String> {
    let row: Row = fields.deserialize(Some(headers)).map_err(|error| match error.kind() {
        csv::ErrorKind::Deserialize { err, .. } => {
            let column = err.field().and_then(|index| usize::try_from(index).ok());
            let name = column.and_then(|index| headers.get(index)).unwrap_or("the row");
            format!("{name}: {}", err.kind())
        }
        _ => error.to_string(),
    })?;
    let texts = [("kind", &row.kind), ("note", &row.note)];
    if let Some((name, odd)) = texts.into_iter().find_map(|(name, text)| Some((name, unplain(text)?))) {
        return Err(format!("{name}: must be text that can be read: {odd} cannot"));
    }
    let numbers = [
        ("left_m", Some(row.left_m)),
        ("ahead_m", Some(row.ahead_m)),
        ("size_mm", row.size_mm),
        ("depth_mm", row.depth_mm),
    ];
    let odd = numbers.into_iter().find(|(_, number)| number.is_some_and(|number| !number.is_finite()));
    if let Some((name, _)) = odd {
        return Err(format!("{name}: must be a finite number"));
    }
    let sizes = [("size_mm", row.size_mm), ("depth_mm", row.depth_mm)];
    if let Some((name, Some(mm))) = sizes.into_iter().find(|(_, mm)| mm.is_some_and(|mm| mm <= 0.0)) {
        return Err(format!("{name} = {mm}: must be above 0"));
    }
    match (row.depth_mm, thickness_mm) {
        (Some(mm), Some(most_mm)) if mm > most_mm => Err(format!(
            "depth_mm = {mm}: must be at most {most_mm}, the thickness of the plate (inspection.nominal_thickness_mm)"
        )),
        _ => Ok(row),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::record::TrackPoint;

    fn record() -> Record {
        let point = |k: u16| TrackPoint {
            t_s: f32::from(k),
            x_m: f32::from(k),
            y_m: 0.0,
            heading_rad: 0.0,
            error_m: 0.05,
            true_error_m: f32::NAN,
        };
        let mut record = Record::new();
        record.track = (0..10).map(point).collect();
        record
    }

    #[test]
    fn an_indication_lies_beside_the_robot_at_its_time_with_the_error_of_then() {
        let csv = "t_s, left_m, kind, depth_mm\n 4.3, 0.2, pit, 2.5\n";
        let found = indications(csv, &[("a", &record())], Some(8.0), |_| Some("R-01".into())).unwrap();
        let [pit] = &found[..] else { panic!("{found:?}") };
        assert!((pit.at - Point::new(4.0, 0.2)).norm() < 1e-6 && (pit.error_m - 0.05).abs() < 1e-6);
        assert_eq!((pit.kind.as_str(), pit.depth_mm, pit.plate.as_deref()), ("pit", Some(2.5), Some("R-01")));
    }

    #[test]
    fn what_cannot_be_placed_is_refused_with_its_line() {
        let record = record();
        let refused = |csv: &str| indications(csv, &[("a", &record)], Some(8.0), |_| None).unwrap_err();
        assert_eq!(refused("t_s,size_mm\n1,0\n"), "line 2: size_mm = 0: must be above 0");
        assert!(
            refused("t_s,depth_mm\n1,9\n")
                .starts_with("line 2: depth_mm = 9: must be at most 8, the thickness")
        );
        let two = |csv: &str| indications(csv, &[("a", &record), ("b", &record)], None, |_| None);
        assert!(two("t_s\n1\n").unwrap_err().starts_with("line 1: with several runs a column `run`"));
        assert_eq!(two("run,t_s\nc,1\n").unwrap_err(), "line 2: run = c: must be one of a, b");
        assert_eq!(two("run,t_s\nb,1\n").unwrap()[0].run, "b");
        assert_eq!(refused("t_s\n1\n99\n"), "line 3: t_s = 99: the run lasts from 0 to 9.0 s");
        assert_eq!(refused("t_s,note\n1,\"two\nlines\"\nsoon,\n"), "line 4: t_s: invalid float literal");
        assert_eq!(refused("t_s,left_m\n1,nan\n"), "line 2: left_m: must be a finite number");
        assert_eq!(
            refused("t_s,kind\n1,\u{202E}pit\n"),
            "line 2: kind: must be text that can be read: U+202E cannot"
        );
        assert!(refused("time\n1\n").contains("unknown column `time`; there are run, t_s"));
    }
}
