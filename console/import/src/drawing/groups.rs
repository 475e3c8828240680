//! Parser for DXF text, which consists of sections with pairs of lines: a code and a value.

use super::curves::Spline;
use crate::{
    error::ImportError,
    input::Input,
    text::{code_page, decoded},
};
use world::Point;

/// An entity as its codes and values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entity {
    /// The type as named in the file: `LINE`, `CIRCLE`, `INSERT`, ...
    pub kind: String,
    groups: Vec<(i32, String)>,
    /// The vertices of a `POLYLINE`, or the attributes of an `INSERT`.
    pub parts: Vec<Entity>,
}

/// A block: a named part of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    /// The block record, with the name and the base point.
    pub head: Entity,
    pub entities: Vec<Entity>,
}

/// The parts of a drawing from which a floor is read.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Drawing {
    /// The value of `$INSUNITS` in the header.
    pub units: Option<i32>,
    /// The layers that are off or frozen.
    pub hidden: Vec<String>,
    pub blocks: Vec<Block>,
    pub entities: Vec<Entity>,
}

impl Entity {
    /// Codes and values in file order.
    pub(super) fn groups(&self) -> &[(i32, String)] {
        &self.groups
    }

    /// The first value with this code.
    pub(super) fn text(&self, code: i32) -> Option<&str> {
        self.groups.iter().find(|(known, _)| *known == code).map(|(_, value)| value.as_str())
    }

    /// All values with this code that are finite numbers.
    pub(super) fn numbers(&self, code: i32) -> impl Iterator<Item = f64> + '_ {
        let values = self.groups.iter().filter(move |(known, _)| *known == code);
        values.filter_map(|(_, value)| value.parse().ok()).filter(|number: &f64| number.is_finite())
    }

    /// The first number with this code, or the default.
    pub(super) fn number(&self, code: i32, default: f64) -> f64 {
        self.numbers(code).next().unwrap_or(default)
    }

    /// Whether a bit of the flags (code 70) is set.
    pub(super) fn has_flag(&self, bit: i32) -> bool {
        self.number(70, 0.0) as i32 & bit != 0
    }

    /// Points, given by the codes of their coordinates.
    pub(super) fn points(&self, x: i32, y: i32) -> Vec<Point> {
        self.numbers(x).zip(self.numbers(y)).map(|(x, y)| Point::new(x, y)).collect()
    }

    /// The data of a `SPLINE`; there are no control points if the spline is given by the points that it passes through.
    pub(super) fn spline(&self) -> Spline {
        Spline {
            degree: self.number(71, 3.0).max(0.0) as usize,
            knots: self.numbers(40).collect(),
            controls: self.points(10, 20),
            weights: self.numbers(41).collect(),
        }
    }

    /// The vertices of an `LWPOLYLINE`: x, y and bulge.
    pub(super) fn corners(&self) -> Vec<[f64; 3]> {
        let mut corners: Vec<[f64; 3]> = Vec::new();
        for (code, value) in &self.groups {
            let number = value.parse().ok().filter(|number: &f64| number.is_finite()).unwrap_or_default();
            match (code, corners.last_mut()) {
                (10, _) => corners.push([number, 0.0, 0.0]),
                (20, Some(corner)) => corner[1] = number,
                (42, Some(corner)) => corner[2] = number,
                _ => {}
            }
        }
        corners
    }
}

impl Drawing {
    /// Reads the groups of a drawing.
    ///
    /// # Errors
    /// The file cannot be read, is binary or truncated, or has a line without a code where a code is required.
    pub(super) fn read(input: &Input) -> Result<Self, ImportError> {
        let bytes = &input.bytes;
        if bytes.starts_with(b"AutoCAD Binary DXF") {
            return Err(ImportError::of_input(input, "a binary DXF file; save it as ASCII (text) DXF"));
        }
        let text = decoded(bytes, code_page_of(bytes).and_then(code_page));
        let mut drawing = Self::default();
        let (mut section, mut variable, mut block) = (String::new(), String::new(), None::<Block>);
        let mut record = Entity::new("");
        let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
        while let Some((line, code)) = lines.next() {
            let wrong = |what: String| ImportError {
                file: input.name.clone(),
                line: Some(line + 1),
                key: None,
                what,
            };
            let Some((_, value)) = lines.next() else { break };
            let value = value.trim();
            let named;
            let value = if value.contains("\\U+") {
                named = unescaped(value);
                named.as_str()
            } else {
                value
            };
            let code: i32 = code.trim().parse().map_err(|_| {
                wrong(format!(
                    "not a DXF drawing: `{}` is not a group code",
                    code.trim().chars().take(20).collect::<String>()
                ))
            })?;
            match (code, value) {
                (0, "EOF") => return Ok(drawing),
                (0, "SECTION" | "ENDSEC") => {
                    drawing.take_record(&record);
                    record = Entity::new("");
                    section.clear();
                }
                (2, _) if section.is_empty() => value.clone_into(&mut section),
                (9, _) if section == "HEADER" => value.clone_into(&mut variable),
                (70, _) if section == "HEADER" && variable == "$INSUNITS" => {
                    drawing.units = value.parse().ok();
                }
                (0, _) if section == "TABLES" => {
                    drawing.take_record(&record);
                    record = Entity::new(value);
                }
                (_, _) if section == "TABLES" => record.groups.push((code, value.to_owned())),
                (0, "BLOCK") if section == "BLOCKS" => {
                    block = Some(Block { head: Entity::new("BLOCK"), entities: Vec::new() });
                }
                (0, "ENDBLK") if section == "BLOCKS" => drawing.blocks.extend(block.take()),
                (0, _) if section == "BLOCKS" => {
                    if let Some(block) = &mut block {
                        begin(&mut block.entities, value);
                    }
                }
                (_, _) if section == "BLOCKS" => {
                    if let Some(block) = &mut block {
                        let open = block.entities.last_mut().map_or(&mut block.head, |last| last.innermost());
                        open.groups.push((code, value.to_owned()));
                    }
                }
                (0, _) if section == "ENTITIES" => begin(&mut drawing.entities, value),
                (_, _) if section == "ENTITIES" => {
                    if let Some(last) = drawing.entities.last_mut() {
                        last.innermost().groups.push((code, value.to_owned()));
                    }
                }
                _ => {}
            }
        }
        // The missing part could contain columns.
        Err(ImportError::of_input(input, "the drawing is truncated: it does not end with EOF; save it again"))
    }

    /// Handles a record of a table.
    fn take_record(&mut self, record: &Entity) {
        const FROZEN: i32 = 1;
        // The colour of a layer that is off is negative.
        let is_hidden = || record.has_flag(FROZEN) || record.number(62, 7.0) < 0.0;
        if record.kind == "LAYER" && is_hidden() {
            self.hidden.extend(record.text(2).map(str::to_owned));
        }
    }
}

impl Entity {
    fn new(kind: &str) -> Self {
        Self { kind: kind.to_owned(), groups: Vec::new(), parts: Vec::new() }
    }

    /// The subentity being read, or the entity itself.
    fn innermost(&mut self) -> &mut Self {
        if self.parts.is_empty() { self } else { self.parts.last_mut().expect("not empty") }
    }
}

/// Begins an entity; a vertex belongs to the preceding polyline, and an attribute to the insertion.
fn begin(entities: &mut Vec<Entity>, kind: &str) {
    match (kind, entities.last_mut()) {
        ("VERTEX", Some(last)) if last.kind == "POLYLINE" => last.parts.push(Entity::new(kind)),
        ("ATTRIB", Some(last)) if last.kind == "INSERT" => last.parts.push(Entity::new(kind)),
        ("SEQEND", _) => {}
        _ => entities.push(Entity::new(kind)),
    }
}

/// The encoding stated in the header.
fn code_page_of(bytes: &[u8]) -> Option<&str> {
    const KEY: &[u8] = b"$DWGCODEPAGE";
    let at = bytes.windows(KEY.len()).position(|window| window == KEY)?;
    let value = bytes[at..].split(|byte| *byte == b'\n').nth(2)?;
    std::str::from_utf8(value).ok()
}

/// Decodes a name with letters written as `\U+00FC`.
pub(super) fn unescaped(name: &str) -> String {
    let mut parts = name.split("\\U+");
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let letter =
            part.get(..4).and_then(|digits| u32::from_str_radix(digits, 16).ok()).and_then(char::from_u32);
        if let Some(letter) = letter {
            whole.push(letter);
            whole.push_str(&part[4..]);
        } else {
            whole.push_str("\\U+");
            whole.push_str(part);
        }
    }
    whole
}
