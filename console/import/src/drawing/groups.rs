//! The text of a DXF file: pairs of lines, a code and a value, in sections.

use crate::error::{ImportError, read_file};
use std::path::Path;

/// What a drawing holds, by its codes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entity {
    /// As the file names it: `LINE`, `CIRCLE`, `INSERT`, ...
    pub kind: String,
    groups: Vec<(i32, String)>,
    /// The vertices of a `POLYLINE`.
    pub vertices: Vec<Entity>,
}

/// A named part of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    /// By itself, with the name and the base point.
    pub head: Entity,
    pub entities: Vec<Entity>,
}

/// A drawing, as far as floors need it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Drawing {
    /// `$INSUNITS` of the header.
    pub units: Option<i32>,
    pub blocks: Vec<Block>,
    pub entities: Vec<Entity>,
}

impl Entity {
    /// The first value of a code.
    pub(super) fn text(&self, code: i32) -> Option<&str> {
        self.groups.iter().find(|(known, _)| *known == code).map(|(_, value)| value.as_str())
    }

    /// All values of a code that are finite numbers.
    pub(super) fn numbers(&self, code: i32) -> impl Iterator<Item = f64> + '_ {
        let values = self.groups.iter().filter(move |(known, _)| *known == code);
        values.filter_map(|(_, value)| value.parse().ok()).filter(|number: &f64| number.is_finite())
    }

    /// The first number of a code, or what holds without it.
    pub(super) fn number(&self, code: i32, default: f64) -> f64 {
        self.numbers(code).next().unwrap_or(default)
    }

    /// Whether a bit of the flags (code 70) is set.
    pub(super) fn has_flag(&self, bit: i32) -> bool {
        self.number(70, 0.0) as i32 & bit != 0
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
    /// Reads a drawing.
    ///
    /// # Errors
    /// It cannot be read, is binary, is cut off, or has a line without a code where one must be.
    pub(super) fn read(file: &Path) -> Result<Self, ImportError> {
        let bytes = read_file(file)?;
        if bytes.starts_with(b"AutoCAD Binary DXF") {
            return Err(ImportError::of_file(file, "a binary DXF; save it as ASCII (text) DXF"));
        }
        // Old drawings have texts in other encodings; no key or number does.
        let text = String::from_utf8_lossy(&bytes);
        let mut drawing = Self::default();
        let (mut section, mut variable, mut block) = (String::new(), String::new(), None::<Block>);
        let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
        while let Some((line, code)) = lines.next() {
            let wrong = |what: String| ImportError {
                file: file.display().to_string(),
                line: Some(line + 1),
                key: None,
                what,
            };
            let Some((_, value)) = lines.next() else { break };
            let value = value.trim();
            let code: i32 = code.trim().parse().map_err(|_| {
                wrong(format!(
                    "no DXF drawing: `{}` is no group code",
                    code.trim().chars().take(20).collect::<String>()
                ))
            })?;
            match (code, value) {
                (0, "EOF") => return Ok(drawing),
                (0, "SECTION" | "ENDSEC") => section.clear(),
                (2, _) if section.is_empty() => value.clone_into(&mut section),
                (9, _) if section == "HEADER" => value.clone_into(&mut variable),
                (70, _) if section == "HEADER" && variable == "$INSUNITS" => {
                    drawing.units = value.parse().ok();
                }
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
        // What is missing could be columns.
        Err(ImportError::of_file(file, "the drawing is cut off: it does not end with EOF; save it again"))
    }
}

impl Entity {
    fn new(kind: &str) -> Self {
        Self { kind: kind.to_owned(), groups: Vec::new(), vertices: Vec::new() }
    }

    /// The vertex that is being read, or the entity itself.
    fn innermost(&mut self) -> &mut Self {
        if self.vertices.is_empty() { self } else { self.vertices.last_mut().expect("it is not empty") }
    }
}

/// Begins an entity; vertices belong to the polyline before them.
fn begin(entities: &mut Vec<Entity>, kind: &str) {
    match (kind, entities.last_mut()) {
        ("VERTEX", Some(last)) if last.kind == "POLYLINE" => last.vertices.push(Entity::new(kind)),
        ("SEQEND", _) => {}
        _ => entities.push(Entity::new(kind)),
    }
}
