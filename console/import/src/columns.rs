//! Lists of columns as CSV.

use crate::{
    error::{ImportError, read_text},
    plan::{FloorPlan, Named},
};
use std::{collections::HashSet, path::Path};
use world::{Boundary, Point, Shape};

/// So much of the name of a field is repeated in a message, characters.
const LONGEST_NAME: usize = 40;

/// Reads a list of round columns in a round tank of a radius, metres.
///
/// The first line names the fields: `x_m`, `y_m`, `radius_m` or `diameter_m`, and perhaps `name`, in any order, separated by
/// commas or semicolons. The origin is the tank's centre. Lines that begin with `#` are skipped.
///
/// # Errors
/// File, line and field of what is wrong.
pub fn read(file: &Path, tank_radius_m: f64) -> Result<FloorPlan, ImportError> {
    let text = read_text(file)?;
    let delimiter = if text.lines().find(|line| !line.starts_with('#')).unwrap_or_default().contains(';') {
        b';'
    } else {
        b','
    };
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.trim_start_matches('\u{feff}').as_bytes());
    let wrong = |line: u64, key: &str, what: String| ImportError {
        file: file.display().to_string(),
        line: Some(line as usize),
        key: Some(key.to_owned()).filter(|key| !key.is_empty()),
        what,
    };
    let bad = |error: &csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        wrong(line, "", format!("not a CSV file: {error}"))
    };
    let header = reader.headers().map_err(|error| bad(&error))?.clone();
    let known = ["name", "x_m", "y_m", "radius_m", "diameter_m"];
    if let Some(other) = header.iter().find(|field| !known.contains(field)) {
        let other: String = other.chars().take(LONGEST_NAME).collect();
        return Err(wrong(
            1,
            &other,
            format!("is no field; the first line names some of {}", known.join(", ")),
        ));
    }
    let index = |field: &str| header.iter().position(|name| name == field);
    let missing = |field: &str| wrong(1, field, "missing in the first line, as in x_m,y_m,radius_m".into());
    let (x, y) = (index("x_m").ok_or_else(|| missing("x_m"))?, index("y_m").ok_or_else(|| missing("y_m"))?);
    let mut size = ["radius_m", "diameter_m"].into_iter().zip([1.0, 0.5]);
    let (size, per_size) =
        size.find_map(|(field, factor)| Some((index(field)?, factor))).ok_or_else(|| missing("radius_m"))?;
    let (mut names, mut obstacles) = (HashSet::new(), Vec::new());
    for record in reader.records() {
        let record = record.map_err(|error| bad(&error))?;
        let line = record.position().map_or(1, csv::Position::line);
        let number = |field: usize| {
            let written = record.get(field).unwrap_or_default();
            let number = written.parse::<f64>().ok().filter(|v| v.is_finite());
            number
                .ok_or_else(|| wrong(line, &header[field], format!("`{written}` is not a number, in metres")))
        };
        let (center, radius_m) = (Point::new(number(x)?, number(y)?), number(size)? * per_size);
        if radius_m <= 0.0 {
            return Err(wrong(
                line,
                &header[size],
                format!("{} must be greater than 0", record[size].to_owned()),
            ));
        }
        if center.coords.norm() - radius_m >= tank_radius_m {
            let what = format!("({}, {}) lies outside the tank of {tank_radius_m} m", center.x, center.y);
            return Err(wrong(line, "x_m", what));
        }
        let given = index("name").and_then(|field| record.get(field)).filter(|name| !name.is_empty());
        let name = given.map_or_else(|| format!("column {}", obstacles.len() + 1), str::to_owned);
        if !names.insert(name.clone()) {
            return Err(wrong(line, "name", format!("`{name}` is there twice")));
        }
        obstacles.push(Named { name, shape: Shape::Disc { center, radius_m } });
    }
    let boundary = Boundary::Circle { radius_m: tank_radius_m };
    Ok(FloorPlan { boundary, obstacles, no_go: Vec::new(), notes: Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<FloorPlan, String> {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("c.csv");
        std::fs::write(&file, text).unwrap();
        read(&file, 10.0).map_err(|error| {
            let file = "c.csv".into();
            ImportError { file, ..error }.to_string()
        })
    }

    #[test]
    fn fields_come_in_any_order_and_with_semicolons() {
        let plan = read_text("# survey\nname;diameter_m;y_m;x_m\nA1;0.5;1;2\n;1;-3;0\n").unwrap();
        let disc = |x: f64, y: f64, radius_m: f64| Shape::Disc { center: Point::new(x, y), radius_m };
        let found: Vec<_> = plan.obstacles.iter().map(|o| (o.name.as_str(), o.shape.clone())).collect();
        assert_eq!(found, [("A1", disc(2.0, 1.0, 0.25)), ("column 2", disc(0.0, -3.0, 0.5))]);
    }

    #[test]
    fn errors_name_line_and_field() {
        let message = |text: &str| read_text(text).unwrap_err();
        let header = "x_m,y_m,radius_m\n";
        assert_eq!(
            message("x,y_m\n"),
            "c.csv, line 1, x: is no field; the first line names some of name, x_m, y_m, radius_m, diameter_m"
        );
        assert_eq!(
            message("x_m,y_m\n1,2\n"),
            "c.csv, line 1, radius_m: missing in the first line, as in x_m,y_m,radius_m"
        );
        assert_eq!(
            message(&format!("{header}1,2,0.3\n1,b,0.3\n")),
            "c.csv, line 3, y_m: `b` is not a number, in metres"
        );
        assert_eq!(message(&format!("{header}1,2,0\n")), "c.csv, line 2, radius_m: 0 must be greater than 0");
        assert_eq!(
            message(&format!("{header}11,2,0.3\n")),
            "c.csv, line 2, x_m: (11, 2) lies outside the tank of 10 m"
        );
        assert!(message(&format!("{header}1,2\n")).starts_with("c.csv, line 2: not a CSV file"));
    }
}
