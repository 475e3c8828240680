//! Reads a section: gets values by key, checks them against the schema, and notes problems.

use super::{
    problem::{Complaint, Problem},
    schema::{Default, Key, Kind, Span, joined},
    source::Source,
    suggest,
};
use mission::{ParamValue, Parameters, spelling::nearest};
use std::ops::Range;
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};
use world::Point;

/// The largest number of obstacles, zones or stations of a scenario.
const MOST_ENTRIES: usize = 50_000;

/// Largest plausible coordinate, in metres; larger ones are mistakes.
const FAR_M: f64 = 10_000.0;

/// The position of a value, for later reports of problems with it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Place {
    /// The path of the key.
    pub key: String,
    /// The bytes of the value.
    pub at: Range<usize>,
}

/// A table of the file with its allowed keys.
pub(crate) struct Section<'a> {
    source: &'a Source<'a>,
    table: Option<&'a DeTable<'a>>,
    keys: &'static [Key],
    path: String,
    at: Range<usize>,
}

type Value<'a> = Spanned<DeValue<'a>>;

impl<'a> Section<'a> {
    /// Opens the whole file as a section; complains about unknown keys.
    pub(crate) fn root(source: &'a Source<'a>, table: &'a DeTable<'a>, keys: &'static [Key]) -> Self {
        let end = source.text.trim_end().len();
        let root = Self { source, table: Some(table), keys, path: String::new(), at: end..end };
        root.refuse_unknown();
        root
    }

    fn inner(&self, name: &str, keys: &'static [Key], value: &'a Value<'a>) -> Option<Self> {
        let path = joined(&self.path, name);
        let DeValue::Table(table) = value.get_ref() else {
            let remedy = "write { key = value, ... }, or the keys below a header in square brackets";
            self.complain_at(path, &value.span(), wrong_type("a table", remedy));
            return None;
        };
        let section = Self { source: self.source, table: Some(table), keys, path, at: value.span() };
        section.refuse_unknown();
        Some(section)
    }

    fn refuse_unknown(&self) {
        let unknown = self
            .table
            .into_iter()
            .flat_map(DeTable::iter)
            .filter(|(name, _)| !self.keys.iter().any(|key| key.name == &**name.get_ref()));
        for (name, value) in unknown.take_while(|_| !self.source.is_full()) {
            let number = as_number(value.get_ref());
            let remedy = suggest::remedy(&self.path, self.keys, name.get_ref(), number);
            let shown = number.is_some().then(|| self.source.excerpt(&value.span()));
            self.source.note(Problem {
                key: joined(&self.path, &shortened(name.get_ref())),
                value: shown,
                at: Some(name.span()),
                what: Complaint::UnknownKey { remedy },
            });
        }
    }

    /// The path of a key of this section.
    pub(crate) fn path_of(&self, name: &str) -> String {
        joined(&self.path, name)
    }

    /// The position of a key's value; if the key is not given, the position of the section.
    pub(crate) fn place(&self, name: &str) -> Place {
        let at = self.value(name).map_or_else(|| self.at.clone(), Spanned::span);
        Place { key: self.path_of(name), at }
    }

    /// Whether the key is given.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.value(name).is_some()
    }

    /// Whether the value of the key is a list.
    pub(crate) fn is_list(&self, name: &str) -> bool {
        self.value(name).is_some_and(|value| value.get_ref().is_array())
    }

    /// Complains about a key.
    pub(crate) fn complain(&self, name: &str, what: Complaint) {
        self.complain_about(&self.place(name), self.has(name), what);
    }

    /// Complains about the whole section.
    pub(crate) fn complain_whole(&self, what: Complaint) {
        let place = Place { key: self.path.clone(), at: self.at.clone() };
        self.complain_about(&place, false, what);
    }

    fn complain_about(&self, place: &Place, has_value: bool, what: Complaint) {
        let value = has_value.then(|| self.source.excerpt(&place.at));
        self.source.note(Problem { key: place.key.clone(), value, at: Some(place.at.clone()), what });
    }

    fn complain_at(&self, key: String, at: &Range<usize>, what: Complaint) {
        let value = Some(self.source.excerpt(at));
        self.source.note(Problem { key, value, at: Some(at.clone()), what });
    }

    /// Complains if the key is not given although another key requires it; returns whether it is given.
    pub(crate) fn require(&self, name: &str, remedy: &str) -> bool {
        if !self.has(name) {
            self.complain(name, Complaint::Missing { remedy: remedy.to_owned() });
        }
        self.has(name)
    }

    /// Complains about each of these keys that is given.
    pub(crate) fn refuse(&self, names: &[&str], beside: &str) {
        for name in names.iter().filter(|name| self.has(name)) {
            self.complain(name, Complaint::OutOfPlace { beside: beside.to_owned() });
        }
    }

    fn value(&self, name: &str) -> Option<&'a Value<'a>> {
        self.table?.get(name)
    }

    fn key(&self, name: &str) -> &'static Key {
        self.keys.iter().find(|key| key.name == name).expect("every key that is read is declared")
    }

    /// The value of a key; complains if a required key is missing.
    fn required(&self, name: &str) -> Option<&'a Value<'a>> {
        let value = self.value(name);
        if value.is_none() && self.key(name).default == Default::Required {
            let remedy = missing_remedy(&self.path, self.key(name));
            self.complain(name, Complaint::Missing { remedy });
        }
        value
    }

    /// A number; if it is not given, its default. `None` if there is no default or the value is invalid.
    pub(crate) fn number(&self, name: &str) -> Option<f64> {
        let key = self.key(name);
        let (Kind::Number(span), unit) = (key.kind, key.unit) else {
            panic!("{name} is not declared as a number")
        };
        match (self.required(name), key.default) {
            (None, Default::Number(default)) => Some(default),
            (None, _) => None,
            (Some(value), _) => self.checked_number(self.path_of(name), value, span, unit),
        }
    }

    fn checked_number(&self, key: String, value: &Value<'_>, span: Span, unit: &str) -> Option<f64> {
        let Some(number) = as_number(value.get_ref()) else {
            let remedy = match value.get_ref() {
                DeValue::String(text) if text.trim().parse::<f64>().is_ok() => "remove the quotes".to_owned(),
                _ if unit.is_empty() => "write a plain number".to_owned(),
                _ => format!("write a plain number, in {unit}"),
            };
            self.complain_at(key, &value.span(), Complaint::WrongType { wanted: "a number".into(), remedy });
            return None;
        };
        if !number.is_finite() {
            self.complain_at(key, &value.span(), Complaint::NotFinite);
            return None;
        }
        if let Some(must_be) = span.complaint(number, unit) {
            self.complain_at(key, &value.span(), Complaint::OutOfRange(must_be));
            return None;
        }
        Some(number)
    }

    /// A whole number; if it is not given, its default.
    pub(crate) fn whole(&self, name: &str) -> Option<i64> {
        let key = self.key(name);
        let Kind::Whole(low, high) = key.kind else { panic!("{name} is not declared as a whole number") };
        let Some(value) = self.required(name) else {
            return if let Default::Whole(default) = key.default { Some(default) } else { None };
        };
        let complaint = match as_whole(value.get_ref()) {
            Some(number) if number < low => Complaint::OutOfRange(format!("at least {low}")),
            Some(number) if number > high => Complaint::OutOfRange(format!("at most {high}")),
            Some(number) => return Some(number),
            None => wrong_type("a whole number", "write digits only"),
        };
        self.complain(name, complaint);
        None
    }

    /// A flag; if it is not given, its default.
    pub(crate) fn flag(&self, name: &str) -> Option<bool> {
        let Some(value) = self.required(name) else {
            return if let Default::Flag(default) = self.key(name).default { Some(default) } else { None };
        };
        let flag = value.get_ref().as_bool();
        if flag.is_none() {
            self.complain(name, wrong_type("true or false", "write true or false without quotes"));
        }
        flag
    }

    /// One of the allowed words; if it is not given, the default.
    pub(crate) fn word(&self, name: &str) -> Option<&'static str> {
        let key = self.key(name);
        let Kind::Word(words) = key.kind else { panic!("{name} is not declared as a word") };
        let Some(value) = self.required(name) else {
            return if let Default::Word(default) = key.default { Some(default) } else { None };
        };
        let written = value.get_ref().as_str();
        let known = words.iter().copied().find(|word| Some(*word) == written);
        if known.is_none() {
            let nearest = written.and_then(|text| nearest(&shortened(text), words.iter().copied()));
            self.complain(name, Complaint::UnknownWord { words, nearest });
        }
        known
    }

    /// Text; `None` if it is not given.
    pub(crate) fn text(&self, name: &str) -> Option<String> {
        let text = self.required(name)?.get_ref().as_str();
        match text {
            None => self.complain(name, wrong_type("text", "enclose it in double quotes")),
            Some(text) if text.trim().is_empty() && name == "name" => {
                self.complain(name, Complaint::OutOfRange("text with at least one character".into()));
                return None;
            }
            Some(_) => {}
        }
        text.map(str::to_owned)
    }

    /// A name that can be part of a file name.
    pub(crate) fn slug(&self, name: &str) -> Option<String> {
        let slug = self.text(name)?;
        let allowed = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        let starts_well = slug.starts_with(|c: char| c.is_ascii_alphanumeric());
        if !starts_well || slug.len() > 64 || !slug.chars().all(allowed) {
            let must_be = "at most 64 letters, digits, `-`, `_` or `.`, beginning with a letter or a digit";
            self.complain(name, Complaint::OutOfRange(must_be.into()));
            return None;
        }
        Some(slug)
    }

    /// Reads a point.
    pub(crate) fn point(&self, name: &str) -> Option<Point> {
        self.checked_point(self.path_of(name), self.required(name)?)
    }

    fn checked_point(&self, key: String, value: &Value<'_>) -> Option<Point> {
        let span = super::schema::at_least(-FAR_M).up_to(FAR_M);
        let [x, y] =
            self.checked_pair(key, value, span, "m", "write [x, y] in metres from the tank's centre")?;
        Some(Point::new(x, y))
    }

    fn checked_pair(
        &self,
        key: String,
        value: &Value<'_>,
        span: Span,
        unit: &str,
        remedy: &str,
    ) -> Option<[f64; 2]> {
        let numbers: Vec<&Value<'_>> = value.get_ref().as_array().into_iter().flatten().collect();
        let [first, second] = numbers[..] else {
            self.complain_at(key, &value.span(), wrong_type("a pair of numbers", remedy));
            return None;
        };
        let [a, b] = [first, second].map(|number| self.checked_number(key.clone(), number, span, unit));
        Some([a?, b?])
    }

    /// A list of points.
    pub(crate) fn points(&self, name: &str) -> Option<Vec<Point>> {
        let Kind::Points(need) = self.key(name).kind else {
            panic!("{name} is not declared as a list of points")
        };
        let list = self.list(name, "a list of points", "write [[x, y], [x, y], ...] in metres")?;
        if list.len() < need {
            self.complain(name, Complaint::TooFew { have: list.len(), need });
            return None;
        }
        let points: Vec<_> = list
            .iter()
            .enumerate()
            .map(|(i, value)| self.checked_point(format!("{}.{i}", self.path_of(name)), value))
            .collect();
        points.into_iter().collect()
    }

    /// A list of texts that are not empty.
    pub(crate) fn texts(&self, name: &str) -> Option<Vec<String>> {
        let remedy = "write [\"...\", ...]";
        let list = self.list(name, "a list of texts", remedy)?;
        if list.is_empty() {
            self.complain(name, Complaint::TooFew { have: 0, need: 1 });
            return None;
        }
        let text_at = |(i, value): (usize, &Value<'_>)| {
            let text = value.get_ref().as_str().filter(|text| !text.trim().is_empty());
            if text.is_none() {
                let key = format!("{}.{i}", self.path_of(name));
                self.complain_at(key, &value.span(), wrong_type("text with at least one character", remedy));
            }
            text.map(str::to_owned)
        };
        list.iter().enumerate().map(text_at).collect()
    }

    /// A list of boxes, each given by its south-west and north-east corners.
    pub(crate) fn boxes(&self, name: &str) -> Option<Vec<[Point; 2]>> {
        let remedy = "write [[west, south, east, north], ...] in metres";
        let list = self.list(name, "a list of boxes", remedy)?;
        if list.is_empty() {
            self.complain(name, Complaint::TooFew { have: 0, need: 1 });
            return None;
        }
        let boxes: Vec<_> = list
            .iter()
            .enumerate()
            .map(|(i, value)| self.checked_box(format!("{}.{i}", self.path_of(name)), value, remedy))
            .collect();
        boxes.into_iter().collect()
    }

    fn checked_box(&self, key: String, value: &Value<'_>, remedy: &str) -> Option<[Point; 2]> {
        let span = super::schema::at_least(-FAR_M).up_to(FAR_M);
        let numbers: Vec<&Value<'_>> = value.get_ref().as_array().into_iter().flatten().collect();
        let [west, south, east, north] = numbers[..] else {
            self.complain_at(key, &value.span(), wrong_type("four numbers", remedy));
            return None;
        };
        let [west, south, east, north] =
            [west, south, east, north].map(|number| self.checked_number(key.clone(), number, span, "m"));
        let (low, high) = (Point::new(west?, south?), Point::new(east?, north?));
        if low.x < high.x && low.y < high.y {
            return Some([low, high]);
        }
        let must_be = "[west, south, east, north] with west < east and south < north".to_owned();
        self.complain_at(key, &value.span(), Complaint::OutOfRange(must_be));
        None
    }

    fn list(&self, name: &str, wanted: &str, remedy: &str) -> Option<&'a [Value<'a>]> {
        let value = self.required(name)?;
        if let DeValue::Array(list) = value.get_ref() {
            return Some(list);
        }
        self.complain(name, wrong_type(wanted, remedy));
        None
    }

    /// Reads a pair of numbers.
    pub(crate) fn pair(&self, name: &str) -> Option<[f64; 2]> {
        let key = self.key(name);
        let Kind::Pair(span) = key.kind else { panic!("{name} is not declared as a pair") };
        self.checked_pair(self.path_of(name), self.required(name)?, span, key.unit, "write [number, number]")
    }

    /// A list of time spans, each from an earlier to a later time; empty if not given.
    pub(crate) fn times(&self, name: &str) -> Option<Vec<(f64, f64)>> {
        if !self.has(name) {
            return Some(Vec::new());
        }
        let span = super::schema::at_least(0.0);
        let list = self.list(name, "a list of time spans", "write [[from, to], ...] in seconds")?;
        let spans: Vec<Option<(f64, f64)>> = list
            .iter()
            .enumerate()
            .map(|(i, value)| {
                let key = format!("{}.{i}", self.path_of(name));
                let [from, to] =
                    self.checked_pair(key.clone(), value, span, "s", "write [from, to] in seconds")?;
                if from >= to {
                    let must_be = "a span from an earlier to a later time".to_owned();
                    self.complain_at(key, &value.span(), Complaint::OutOfRange(must_be));
                    return None;
                }
                Some((from, to))
            })
            .collect();
        spans.into_iter().collect()
    }

    /// A table within this section; `None` if it is missing or not a table.
    pub(crate) fn table(&self, name: &str) -> Option<Self> {
        let Kind::Table(keys) = self.key(name).kind else { panic!("{name} is not declared as a table") };
        self.inner(name, keys, self.required(name)?)
    }

    /// A table within this section; an empty table if it is not given.
    pub(crate) fn table_or_empty(&self, name: &str) -> Option<Self> {
        let Kind::Table(keys) = self.key(name).kind else { panic!("{name} is not declared as a table") };
        match self.value(name) {
            Some(value) => self.inner(name, keys, value),
            None => Some(Self {
                source: self.source,
                table: None,
                keys,
                path: self.path_of(name),
                at: self.at.clone(),
            }),
        }
    }

    /// A list of tables; empty if it is not given.
    pub(crate) fn tables(&self, name: &str) -> Vec<Self> {
        let Kind::Tables(keys) = self.key(name).kind else {
            panic!("{name} is not declared as a list of tables")
        };
        let remedy = format!(
            "write [[{}]] in double brackets, and its keys on the lines below it",
            self.path_of(name)
        );
        let list = self.list(name, "a list of tables", &remedy).unwrap_or_default();
        if list.len() > MOST_ENTRIES {
            self.complain(name, Complaint::TooMany { have: list.len(), most: MOST_ENTRIES });
            return Vec::new();
        }
        list.iter()
            .enumerate()
            .filter_map(|(i, value)| self.inner(&format!("{name}.{i}"), keys, value))
            .collect()
    }

    /// Planner parameters; empty if not given.
    pub(crate) fn parameters(&self, name: &str) -> Option<Parameters> {
        let Some(value) = self.value(name) else { return Some(Parameters::new()) };
        let DeValue::Table(table) = value.get_ref() else {
            let remedy = format!("write [{}] and its keys below", self.path_of(name));
            self.complain(name, wrong_type("a table", &remedy));
            return None;
        };
        let found: Vec<_> = table
            .iter()
            .map(|(key, value)| {
                Some((key.get_ref().to_string(), self.parameter(name, key.get_ref(), value)?))
            })
            .collect();
        found.into_iter().collect()
    }

    fn parameter(&self, table: &str, name: &str, value: &Value<'_>) -> Option<ParamValue> {
        let key = format!("{}.{}", self.path_of(table), shortened(name));
        let parameter = match value.get_ref() {
            DeValue::Boolean(flag) => Some(ParamValue::Flag(*flag)),
            DeValue::Integer(_) => as_whole(value.get_ref()).map(ParamValue::Int),
            DeValue::Float(_) => as_number(value.get_ref()).map(ParamValue::Float),
            DeValue::String(text) => Some(ParamValue::Word(text.to_string())),
            _ => None,
        };
        let what = match parameter {
            None => wrong_type("a number, a flag or a word", "`tankops planners` lists every parameter"),
            Some(ParamValue::Float(number)) if !number.is_finite() => Complaint::NotFinite,
            Some(parameter) => return Some(parameter),
        };
        self.complain_at(key, &value.span(), what);
        None
    }
}

fn wrong_type(wanted: &str, remedy: &str) -> Complaint {
    Complaint::WrongType { wanted: wanted.to_owned(), remedy: remedy.to_owned() }
}

fn shortened(name: &str) -> String {
    let clean = name.chars().filter(|c| foreign::is_plain(*c));
    if name.chars().count() > 64 { clean.take(63).chain(['…']).collect() } else { clean.collect() }
}

fn as_whole(value: &DeValue<'_>) -> Option<i64> {
    let integer = value.as_integer()?;
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}

fn as_number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        DeValue::Integer(_) => as_whole(value).map(|number| number as f64),
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => None,
    }
}

/// The text to add for a missing required key.
fn missing_remedy(section: &str, key: &Key) -> String {
    let name = key.name;
    match key.kind {
        Kind::Table(_) if section.is_empty() => format!("add a [{name}] section"),
        Kind::Table(_) => format!("add {name} = {{ ... }}"),
        Kind::Tables(_) => format!("add {name} = [{{ ... }}, ...]"),
        Kind::Word(words) => format!("add {name} = one of {}", words.join(", ")),
        Kind::Text | Kind::Slug => format!("add {name} = \"...\""),
        Kind::Point => format!("add {name} = [x, y]"),
        Kind::Points(_) => format!("add {name} = [[x, y], ...]"),
        Kind::Pair(_) => format!("add {name} = [a, b]"),
        Kind::Texts => format!("add {name} = [\"...\", ...]"),
        Kind::Boxes => format!("add {name} = [[west, south, east, north], ...]"),
        _ if key.unit.is_empty() => format!("add {name} = ..."),
        _ => format!("add {name} = ..., in {}", key.unit),
    }
}
