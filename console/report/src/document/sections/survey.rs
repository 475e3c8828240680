//! The report on a survey: its map, its columns, and the difference to the drawing.

use super::{
    super::{
        model::Document,
        page::{Block, Share, Table, Value, per_cent, picture},
        survey::{ColumnPart, Instead, MapPart},
        words::{cm, number},
    },
    task::figures_table,
};
use crate::human::text::counted;

/// The large figures of the first sheet.
pub(super) fn shares(map: &MapPart) -> Vec<Share> {
    let share =
        |value: String, unit: &'static str, of: &'static str, about: String| Share { value, unit, of, about };
    let worst_m = map.columns.iter().map(|column| column.center_95_m).reduce(f64::max);
    let errors = worst_m.map_or_else(
        || "none was found".to_owned(),
        |worst_m| format!("95 % error of the centre at most {} cm", cm(worst_m)),
    );
    vec![
        share(per_cent(map.explored), "%", "explored", "of the floor within the wall".into()),
        share(map.columns.len().to_string(), "", "columns", errors),
        share(
            map.differences().to_string(),
            "",
            "differences",
            "columns and other objects that are not drawn, and drawn objects that are not there".into(),
        ),
    ]
}

/// The figures, the map, the columns and the difference to the drawing.
pub(super) fn blocks(document: &Document, map: Option<&MapPart>, rows: Vec<[String; 3]>) -> Vec<Block> {
    let figures = Block::Table(figures_table(rows));
    let Some(map) = map else {
        return vec![figures, Block::Note("The run ended before it had made a map.".into())];
    };
    let mut blocks = vec![figures, Block::Wide(picture(&document.pictures.coverage))];
    blocks.push(Block::Heading("Columns on the map".into()));
    if map.columns.is_empty() {
        blocks.push(Block::Note("The scans show no columns.".into()));
    } else {
        blocks.push(Block::Table(columns(map)));
        blocks.push(Block::Note(
            "± is the 95 % error; that of the centre is given along its worse axis. It contains the errors of the \
             scanner and of the position, but no error of the drawing."
                .into(),
        ));
    }
    blocks.push(Block::Heading("Difference to the drawing".into()));
    blocks.extend(difference(map));
    blocks
}

/// The table of the columns.
fn columns(map: &MapPart) -> Table {
    let mut table = Table::new(
        "Columns on the map, with their 95 % errors",
        &[
            ("No.", "", "nw"),
            ("x", "m", "r nw"),
            ("y", "m", "r nw"),
            ("±", "m", "r nw"),
            ("Radius", "m", "r nw"),
            ("±", "m", "r nw"),
            ("On the drawing", "", "full"),
        ],
    );
    table.is_cards = true;
    for column in &map.columns {
        let row = table.row(vec![
            Value::from(column.number.to_string()),
            number(column.center.x, 3).into(),
            number(column.center.y, 3).into(),
            number(column.center_95_m, 3).into(),
            number(column.radius_m, 3).into(),
            number(column.radius_95_m, 3).into(),
            on_drawing(column).into(),
        ]);
        let keys = ["", "x", "y", "±", "radius", "±", ""];
        row.cells.iter_mut().zip(keys).for_each(|(cell, key)| cell.key = key);
    }
    table
}

/// Where a column is on the drawing.
fn on_drawing(column: &ColumnPart) -> String {
    let Some(drawn) = &column.drawn else { return "not on the drawing".into() };
    let [east_m, north_m] = drawn.moved_m;
    let signed = |m: f64| format!("{}{}", if m > 0.0 { "+" } else { "" }, number(100.0 * m, 1));
    format!(
        "{}: {} cm from its drawn place ({} cm east, {} cm north), radius {} cm",
        drawn.name,
        cm(drawn.distance_m()),
        signed(east_m),
        signed(north_m),
        signed(drawn.grown_m)
    )
}

/// How many columns and how many other objects on the map are not drawn.
fn not_drawn(map: &MapPart) -> [String; 2] {
    [(map.not_drawn(), "column"), (map.objects_not_drawn.len(), "other object")]
        .map(|(count, what)| counted(count as u64, what))
}

/// The table of the objects that are neither columns nor drawn; `None` without any.
fn objects_not_drawn(map: &MapPart) -> Option<Block> {
    let mut table = Table::new(
        "Objects on the map that are neither columns nor on the drawing",
        &[("From x", "m", "r nw"), ("From y", "m", "r nw"), ("To x", "m", "r nw"), ("To y", "m", "r nw")],
    );
    table.is_slim = true;
    for object in &map.objects_not_drawn {
        let corners = [object.low.x, object.low.y, object.high.x, object.high.y];
        table.row(corners.map(|m| Value::from(number(m, 2))).into());
    }
    (!map.objects_not_drawn.is_empty()).then_some(Block::Table(table))
}

/// The drawn objects that were not found, and the objects that are not drawn.
fn difference(map: &MapPart) -> Vec<Block> {
    if map.drawn == 0 {
        let [columns, objects] = not_drawn(map);
        let note = format!("The drawing shows only the wall; {columns} and {objects} found are not on it.");
        return std::iter::once(Block::Note(note)).chain(objects_not_drawn(map)).collect();
    }
    let moved = map.moved_max_m().map_or_else(String::new, |moved_m| {
        format!(
            " The largest distance between a drawn centre and the centre on the map is {} cm.",
            cm(moved_m)
        )
    });
    let [columns, objects] = not_drawn(map);
    let summary = format!(
        "{} on the drawing: {} found as columns, {} as other objects, {} not there, {} not seen. {columns} and {objects} \
         on the map are not on the drawing.{moved}",
        counted(map.drawn as u64, "object"),
        map.drawn - map.not_found.len(),
        map.with_instead(Instead::Object),
        map.with_instead(Instead::FreeFloor),
        map.with_instead(Instead::NotSeen),
    );
    let mut blocks = vec![Block::Note(summary)];
    blocks.extend(objects_not_drawn(map));
    if map.not_found.is_empty() {
        return blocks;
    }
    let mut table = Table::new(
        "Objects on the drawing that are not columns on the map",
        &[("Object", "", ""), ("x", "m", "r nw"), ("y", "m", "r nw"), ("The map shows there", "", "full")],
    );
    table.is_cards = true;
    for lack in &map.not_found {
        let row = table.row(vec![
            Value::from(lack.name.clone()),
            number(lack.at.x, 2).into(),
            number(lack.at.y, 2).into(),
            lack.instead.words().to_owned().into(),
        ]);
        (row.cells[1].key, row.cells[2].key) = ("x", "y");
    }
    blocks.push(Block::Table(table));
    blocks
}
