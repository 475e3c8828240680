//! The columns of a file with readings of thickness, and how a row is interpreted.

use crate::{clock, problem::Problem};
use csv::StringRecord;

/// Units of thickness and depth, with their factor for conversion to millimetres.
pub const UNITS: [(&str, f64); 6] =
    [("mm", 1.0), ("um", 1e-3), ("cm", 10.0), ("in", 25.4), ("inch", 25.4), ("mil", 0.0254)];
/// Units of time, with their factor for conversion to seconds.
const TIMES: [(&str, f64); 3] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6)];
/// Names of the column with the number of the channel.
const CHANNEL: [&str; 2] = ["channel", "ch"];
/// Names of the column with a unit for each row.
const UNIT: [&str; 2] = ["unit", "units"];

/// A unit of thickness: its name, and its factor for conversion to millimetres.
pub type Unit = (&'static str, f64);

/// Whether two units are the same, such as `in` and `inch`.
fn is_same(one: Unit, other: Unit) -> bool {
    (one.1 - other.1).abs() < 1e-12
}

/// The unit with a name.
pub fn unit(name: &str) -> Option<Unit> {
    let name = name.trim().to_lowercase().replace(['µ', 'μ'], "u");
    UNITS.into_iter().find(|(known, _)| *known == name)
}

/// What a column states about the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Quantity {
    Thickness,
    Depth,
    /// Depth as a percentage of the nominal thickness.
    Percent,
}

/// A column with a value.
#[derive(Debug, Clone, PartialEq)]
struct Value {
    index: usize,
    quantity: Quantity,
    unit: Option<Unit>,
    /// The channel, if every channel has its own column.
    channel: Option<u16>,
}

/// The columns of a file.
#[derive(Debug, Clone)]
pub(super) struct Columns {
    names: Vec<String>,
    /// The column with the time; without a unit, it contains dates or times of day.
    time: (usize, Option<f64>),
    channel: Option<usize>,
    unit: Option<usize>,
    values: Vec<Value>,
    nominal_mm: f64,
    has_commas: bool,
    /// Units and decimal marks of earlier rows.
    seen: Seen,
}

#[derive(Debug, Clone, Default)]
struct Seen {
    unit: Option<(Unit, u64)>,
    /// The line of the first number with a decimal point, and of the first one with a decimal comma.
    marks: [Option<u64>; 2],
}

impl Seen {
    /// Refuses a number whose decimal mark differs from that of an earlier number.
    fn check_mark(&self, text: &str) -> Result<(), String> {
        let mark = usize::from(text.contains(','));
        let Some(line) = self.marks[1 - mark].filter(|_| text.contains([',', '.'])) else { return Ok(()) };
        let (here, there) = if mark == 1 { ("comma", "point") } else { ("point", "comma") };
        Err(format!("`{text}` has a decimal {here}, but line {line} has a decimal {there}"))
    }

    fn mark(&mut self, text: &str, line: u64) {
        if text.contains([',', '.']) {
            self.marks[usize::from(text.contains(','))].get_or_insert(line);
        }
    }
}

/// A reading as it is in a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub(super) channel: u16,
    pub(super) thickness_mm: f64,
    /// The column of the value.
    pub(super) index: usize,
}

/// The kind of a fault, for counting.
pub(super) type Kind = &'static str;

/// A fault in a value: its kind, the index of the column, and what is wrong.
type Fault = (Kind, usize, String);

impl Columns {
    /// Finds the columns that the first line names. `given` is the unit of columns that state none.
    pub(super) fn new(
        header: &StringRecord,
        given: Option<Unit>,
        (nominal_mm, has_commas): (f64, bool),
    ) -> Result<Self, String> {
        let names: Vec<String> = header.iter().map(str::to_owned).collect();
        let found = |what: &str| format!("{what}; columns found: {}", names.join(", "));
        let (mut time, mut channel, mut unit_column, mut values) = (None, None, None, Vec::new());
        for (index, name) in names.iter().map(|name| plain(name)).enumerate() {
            if let Some(TimeColumn(factor)) = time_factor(&name) {
                let is_better = time.is_none_or(|(_, known): (usize, Option<f64>)| known.is_none());
                time = if is_better { Some((index, factor)) } else { time };
            } else if CHANNEL.contains(&name.as_str()) {
                channel = Some(index);
            } else if UNIT.contains(&name.as_str()) {
                unit_column = Some(index);
            } else if let Some(value) = value(&name, index) {
                values.push(value);
            }
        }
        let is_wide = values.iter().any(|value| value.channel.is_some());
        let time = time.ok_or_else(|| {
            found("no time column: add t_s, t_ms or t_us, or `time` with dates or times of day")
        })?;
        match (values.len(), is_wide, channel) {
            (0, ..) => {
                return Err(found(
                    "no column with readings: add thickness_mm or depth_mm (also in um, cm, in and mil; depth also in \
                     percent), or a column for each channel: ch0_mm, ch1_mm, ...",
                ));
            }
            (2.., false, _) => {
                return Err(found(
                    "more than one column with readings; keep thickness or depth, in one unit",
                ));
            }
            (_, true, Some(_)) => {
                return Err(found("a column `channel` and a column for each channel; keep one of the two"));
            }
            (_, true, None) if values.iter().any(|value| value.channel.is_none()) => {
                return Err(found("columns for each channel and for all channels; keep one of the two"));
            }
            _ => {}
        }
        for value in &mut values {
            value.unit = value.unit.or(given);
            if value.unit.is_none() && value.quantity != Quantity::Percent && unit_column.is_none() {
                let name = &names[value.index];
                return Err(found(&format!(
                    "column {name} states no unit: name it {name}_mm (or um, cm, in, mil), or give --unit"
                )));
            }
        }
        let seen = Seen::default();
        Ok(Self { names, time, channel, unit: unit_column, values, nominal_mm, has_commas, seen })
    }

    /// The names of the columns that are not used.
    pub(super) fn ignored(&self) -> Vec<String> {
        let used = [Some(self.time.0), self.channel, self.unit];
        let is_used = |index: usize| {
            used.contains(&Some(index)) || self.values.iter().any(|value| value.index == index)
        };
        let names = self.names.iter().enumerate().filter(|(index, _)| !is_used(*index));
        names.map(|(_, name)| name.clone()).collect()
    }

    /// The name of a column.
    pub(super) fn name(&self, index: usize) -> &str {
        &self.names[index]
    }

    /// The index of the time column.
    pub(super) fn time_index(&self) -> usize {
        self.time.0
    }

    /// The text of the time in a row.
    pub(super) fn time_text<'a>(&self, cells: &'a StringRecord) -> &'a str {
        cells.get(self.time.0).unwrap_or_default()
    }

    /// Reads a time by the clock of the file, seconds.
    pub(super) fn time_s(&self, text: &str) -> Result<f64, String> {
        let example = clock::EXAMPLE;
        match self.time.1 {
            _ if text.is_empty() => Err("empty; every row needs a time".into()),
            Some(factor) => self.number(text).map(|number| number * factor),
            None if clock::Written::of(text) == clock::Written::Number => Err(format!(
                "`{text}` is not a time of day or a date; write 07:40:12.250 or {example}, or name the column t_s, t_ms \
                 or t_us"
            )),
            None => clock::time_s(text, self.has_commas),
        }
    }

    /// Reads the values in a row; each fault belongs to one value. A cell without a value is left out.
    pub(super) fn cells(&mut self, cells: &StringRecord, line: u64) -> Vec<Result<Cell, (Kind, Problem)>> {
        (0..self.values.len()).filter_map(|value| self.cell(cells, line, value).transpose()).collect()
    }

    fn cell(
        &mut self,
        cells: &StringRecord,
        line: u64,
        value: usize,
    ) -> Result<Option<Cell>, (Kind, Problem)> {
        let value = self.values[value].clone();
        let text = cells.get(value.index).unwrap_or_default();
        if text.is_empty() {
            return Ok(None);
        }
        let read = self.read(cells, text, &value);
        let cell = read.map_err(|(kind, index, what)| {
            (kind, Problem { line, column: Some(self.names[index].clone()), what, is_end: false })
        })?;
        self.seen.mark(text, line);
        if self.unit.is_some() {
            self.seen.unit = self.seen.unit.or(cell.1.map(|unit| (unit, line)));
        }
        Ok(Some(cell.0))
    }

    /// Reads a value and its unit.
    fn read(&self, cells: &StringRecord, text: &str, value: &Value) -> Result<(Cell, Option<Unit>), Fault> {
        let index = value.index;
        let (number, written) = split_unit(text);
        let unit = self.agreed_unit(cells, (text, written), value)?;
        let number = self.number(number).map_err(|what| ("numbers", index, what))?;
        self.seen.check_mark(text).map_err(|what| ("numbers", index, what))?;
        let factor = unit.map_or(1.0, |(_, factor)| factor);
        let thickness_mm = match value.quantity {
            Quantity::Thickness => number * factor,
            Quantity::Depth => self.nominal_mm - number * factor,
            Quantity::Percent => self.nominal_mm * (1.0 - number / 100.0),
        };
        possible(text, value.quantity, number, (thickness_mm, self.nominal_mm))
            .map_err(|(kind, what)| (kind, index, what))?;
        let channel = self.channel(cells, value)?;
        Ok((Cell { channel, thickness_mm, index }, unit))
    }

    /// The unit of a value, which the column, the row or the cell states; they must agree.
    fn agreed_unit(
        &self,
        cells: &StringRecord,
        (text, written): (&str, Option<&str>),
        value: &Value,
    ) -> Result<Option<Unit>, Fault> {
        let of_row = self.unit.map(|index| {
            let name = cells.get(index).unwrap_or_default();
            let what = || format!("`{name}` is not a unit; write mm, um, cm, in or mil");
            unit(name).ok_or_else(|| ("units", index, what()))
        });
        let own = of_row.transpose()?.or(value.unit);
        if let Some(name) = written
            && !unit(name).zip(own).is_some_and(|(written, own)| is_same(written, own))
        {
            let what = match own {
                Some((own, _)) => format!("`{text}` is in {name}, but the column is in {own}; use one unit"),
                None => format!("`{text}`: write the number without `{name}`"),
            };
            return Err(("units", value.index, what));
        }
        match own.zip(self.seen.unit) {
            Some((own, (first, line))) if !is_same(own, first) => {
                let what = format!("{}, but line {line} is in {}; use one unit in a file", own.0, first.0);
                Err(("units", self.unit.unwrap_or(value.index), what))
            }
            _ => Ok(own),
        }
    }

    /// The channel of a value, from its column or from the row.
    fn channel(&self, cells: &StringRecord, value: &Value) -> Result<u16, Fault> {
        let Some(index) = self.channel.filter(|_| value.channel.is_none()) else {
            return Ok(value.channel.unwrap_or(0));
        };
        let text = cells.get(index).unwrap_or_default();
        text.parse().map_err(|_| ("channels", index, format!("`{text}` is not the number of a channel")))
    }

    fn number(&self, text: &str) -> Result<f64, String> {
        let read = if self.has_commas { text.replace(',', ".").parse::<f64>() } else { text.parse() };
        let read = read.ok().filter(|number| number.is_finite());
        read.ok_or_else(|| {
            if !self.has_commas && text.contains(',') {
                format!("`{text}` has a decimal comma; write a decimal point, or separate the columns with ; or a tab")
            } else {
                format!("`{text}` is not a number")
            }
        })
    }
}

/// Largest reading, as a multiple of the thickness of a plate: where plates overlap, two are under the tool.
const MOST_PLATES: f64 = 2.5;

/// Refuses what no instrument can read on a plate.
fn possible(
    text: &str,
    quantity: Quantity,
    number: f64,
    (thickness_mm, nominal_mm): (f64, f64),
) -> Result<(), (Kind, String)> {
    let is_depth = quantity != Quantity::Thickness;
    let name = if is_depth { "depth" } else { "thickness" };
    if number < 0.0 {
        return Err(("negative values", format!("`{text}`: a {name} is not negative")));
    }
    if is_depth && thickness_mm < -1e-9 {
        let what =
            format!("`{text}`: deeper than the plate is thick ({nominal_mm} mm, instrument.thickness_mm)");
        return Err(("depth above thickness", what));
    }
    let most_mm = MOST_PLATES * nominal_mm;
    if thickness_mm > most_mm {
        let is_long = thickness_mm >= 1e6;
        let shown = if is_long { format!("{thickness_mm:.1e}") } else { format!("{thickness_mm:.1}") };
        let what = format!(
            "`{text}`: {shown} mm, more than {most_mm} mm ({MOST_PLATES} times instrument.thickness_mm, because plates \
             overlap); is the unit right?"
        );
        return Err(("thickness above two plates", what));
    }
    Ok(())
}

/// Divides a number from a unit that follows it.
fn split_unit(text: &str) -> (&str, Option<&str>) {
    let end = text.trim_end_matches(|c: char| c.is_alphabetic() || c == '"').len();
    let (number, unit) = text.split_at(end);
    // The letters of a number such as `nan` are not a unit.
    if unit.is_empty() || number.trim().is_empty() { (text, None) } else { (number.trim(), Some(unit)) }
}

/// A name in lower case, with its words joined by `_`.
fn plain(name: &str) -> String {
    let lower = name.to_lowercase().replace(['µ', 'μ'], "u").replace('%', " percent");
    let words = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("_")
}

/// The factor of a time column; without a unit, it contains dates or times of day.
struct TimeColumn(Option<f64>);

fn time_factor(name: &str) -> Option<TimeColumn> {
    let unit = ["timestamp", "time", "t"].into_iter().find_map(|base| name.strip_prefix(base))?;
    if unit.is_empty() {
        return Some(TimeColumn(None));
    }
    let unit = unit.strip_prefix('_')?;
    TIMES.into_iter().find(|(known, _)| *known == unit).map(|(_, factor)| TimeColumn(Some(factor)))
}

/// The value that a column contains; `None` for other columns.
fn value(name: &str, index: usize) -> Option<Value> {
    let bases = [("thickness", Quantity::Thickness), ("depth", Quantity::Depth), ("loss", Quantity::Depth)];
    for (base, quantity) in bases {
        let Some(rest) = name.strip_prefix(base) else { continue };
        return match rest.strip_prefix('_') {
            None if rest.is_empty() => Some(Value { index, quantity, unit: None, channel: None }),
            Some("percent") if quantity == Quantity::Depth => {
                Some(Value { index, quantity: Quantity::Percent, unit: None, channel: None })
            }
            Some(name) => Some(Value { index, quantity, unit: Some(unit(name)?), channel: None }),
            None => None,
        };
    }
    let rest = CHANNEL.into_iter().find_map(|base| name.strip_prefix(base))?;
    let (number, of) =
        rest.trim_start_matches('_').split_once('_').unwrap_or((rest.trim_start_matches('_'), ""));
    let unit = if of.is_empty() { None } else { Some(unit(of)?) };
    Some(Value { index, quantity: Quantity::Thickness, unit, channel: Some(number.parse().ok()?) })
}
