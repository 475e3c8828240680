//! The fields of a list of columns, and how their numbers are parsed.

use super::marks::Marks;
use csv::StringRecord;

/// The maximum number of characters of a field name that a message quotes.
const LONGEST_NAME: usize = 40;
/// Units of length, with their sizes in metres.
const UNITS: [(&str, f64); 7] = [
    ("m", 1.0),
    ("cm", 1e-2),
    ("mm", 1e-3),
    ("in", 0.0254),
    ("inch", 0.0254),
    ("ft", 0.3048),
    ("feet", 0.3048),
];

/// A length that a list gives for each column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    X,
    Y,
    Radius,
}

/// The fields of a list: their positions and units.
pub(super) struct Fields {
    names: Vec<String>,
    /// The position, and the size of the unit in metres, indexed by [`Quantity`].
    lengths: [(usize, f64); 3],
    name: Option<usize>,
    /// The names of unused fields.
    pub unused: Vec<String>,
}

/// A result; the error consists of a field and the problem with the field.
type Wrong<T> = Result<T, (String, String)>;

impl Fields {
    /// Interprets the first line of a list.
    pub(super) fn new(header: &StringRecord) -> Wrong<Self> {
        let names: Vec<String> =
            header.iter().map(|name| name.chars().take(LONGEST_NAME).collect()).collect();
        let (mut lengths, mut name, mut unused): ([Option<(usize, f64)>; 3], _, _) =
            ([None; 3], None, Vec::new());
        for (index, written) in names.iter().enumerate() {
            let twice =
                || (written.clone(), "has the same meaning as another field; remove one of them".to_owned());
            match meaning(written).map_err(|what| (written.clone(), what))? {
                Meaning::Length(quantity, unit_m) => {
                    if lengths[quantity as usize].replace((index, unit_m)).is_some() {
                        return Err(twice());
                    }
                }
                Meaning::Name if name.replace(index).is_some() => return Err(twice()),
                Meaning::Name => {}
                Meaning::Other if written.is_empty() => {}
                Meaning::Other => unused.push(written.clone()),
            }
        }
        let found = |quantity: Quantity, field: &str| {
            lengths[quantity as usize].ok_or_else(|| {
                let what =
                    "missing from the first line; write, for example, x_m,y_m,radius_m (also diameter; mm, cm, \
                     in, ft)";
                let there = format!("{what}; the fields are: {}", names.join(", "));
                (field.to_owned(), there.chars().take(400).collect())
            })
        };
        let lengths =
            [found(Quantity::X, "x_m")?, found(Quantity::Y, "y_m")?, found(Quantity::Radius, "radius_m")?];
        Ok(Self { names, lengths, name, unused })
    }

    /// The name of the field for a quantity in the first line.
    pub(super) fn name_of(&self, quantity: Quantity) -> &str {
        &self.names[self.lengths[quantity as usize].0]
    }

    /// The name of a column, if there is a name field.
    pub(super) fn name<'a>(&self, record: &'a StringRecord) -> Option<&'a str> {
        record.get(self.name?)
    }

    /// A quantity of a column in metres; also passes the number to `marks`.
    pub(super) fn metres(
        &self,
        record: &StringRecord,
        quantity: Quantity,
        has_commas: bool,
        marks: &mut Marks,
    ) -> Result<f64, (&str, String)> {
        let (index, unit_m) = self.lengths[quantity as usize];
        let written = record.get(index).unwrap_or_default();
        marks.see(written, self.name_of(quantity), unit_m);
        let number = if has_commas { written.replacen(',', ".", 1).parse() } else { written.parse() };
        number.ok().filter(|number: &f64| number.is_finite()).map(|number| number * unit_m).ok_or_else(|| {
            let what = format!(
                "`{written}` is not a number; write it without a unit and without thousands separators"
            );
            (self.name_of(quantity), what)
        })
    }
}

/// The meaning of a field.
enum Meaning {
    Length(Quantity, f64),
    Name,
    Other,
}

/// Interprets the name of a field: a word and a unit, as in `x_m`, `X [mm]` or `Diameter in cm`.
fn meaning(name: &str) -> Result<Meaning, String> {
    let lower = name.to_lowercase();
    let words: Vec<&str> =
        lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let (quantity, share) = match words.first() {
        Some(&"name") if words.len() == 1 => return Ok(Meaning::Name),
        Some(&"x") => (Quantity::X, 1.0),
        Some(&"y") => (Quantity::Y, 1.0),
        Some(&"radius") => (Quantity::Radius, 1.0),
        Some(&"diameter") => (Quantity::Radius, 0.5),
        _ => return Ok(Meaning::Other),
    };
    let unit = match words[1..] {
        [unit] | ["in", unit] => unit,
        [] => return Err("has no unit; append one, as in x_m or x [mm]".into()),
        _ => return Ok(Meaning::Other),
    };
    let unit_m = UNITS.iter().find(|(known, _)| *known == unit).map(|(_, unit_m)| unit_m * share);
    unit_m
        .map(|unit_m| Meaning::Length(quantity, unit_m))
        .ok_or_else(|| format!("`{unit}` is not a known unit of length; use m, cm, mm, in or ft"))
}
