//! The content of the report page as text; the template only defines the layout.

use super::maps::{Figure, Legend};
use world::coverage::percent;

/// A text, the name of a missing key, or both.
#[derive(Debug, Clone, Default)]
pub(super) struct Value {
    pub(super) text: Option<String>,
    pub(super) missing: Option<String>,
}

impl Value {
    /// A fact, or its key if it is missing.
    pub(super) fn fact(fact: Option<&String>, key: &str) -> Self {
        let missing = fact.is_none().then(|| format!("inspection.{key}"));
        Self { text: fact.cloned(), missing }
    }

    /// A text that is always known, followed by a fact.
    pub(super) fn with_fact(known: impl Into<String>, fact: Option<&String>, key: &str) -> Self {
        let known = known.into();
        let text = fact.map_or_else(|| format!("{known};"), |fact| format!("{known}; {fact}"));
        Self { text: Some(text), missing: fact.is_none().then(|| format!("inspection.{key}")) }
    }
}

impl<T: Into<String>> From<T> for Value {
    fn from(text: T) -> Self {
        Self { text: Some(text.into()), missing: None }
    }
}

/// A field of the title block.
pub(super) struct Field {
    pub(super) class: &'static str,
    pub(super) label: &'static str,
    pub(super) value: Value,
    pub(super) note: String,
}

/// The verdict of the report.
pub(super) struct Verdict {
    pub(super) class: &'static str,
    pub(super) lead: String,
    pub(super) cause: String,
}

/// A large figure on the first sheet.
pub(super) struct Share {
    pub(super) value: String,
    /// Unit of the figure.
    pub(super) unit: &'static str,
    pub(super) of: &'static str,
    pub(super) about: String,
}

/// A decision of the inspector.
pub(super) struct Todo {
    pub(super) text: String,
    /// The decision, or its key if it is missing.
    pub(super) value: Value,
    pub(super) section: usize,
}

/// A table.
#[derive(Default)]
pub(super) struct Table {
    pub(super) number: usize,
    pub(super) caption: String,
    pub(super) heads: Vec<Head>,
    pub(super) rows: Vec<Row>,
    /// Whether the rows of the table become cards on a phone.
    pub(super) is_cards: bool,
    /// Whether the table fits a phone as it is.
    pub(super) is_slim: bool,
}

pub(super) struct Head {
    pub(super) text: &'static str,
    pub(super) unit: &'static str,
    pub(super) class: &'static str,
}

#[derive(Default)]
pub(super) struct Row {
    pub(super) id: String,
    pub(super) class: &'static str,
    pub(super) cells: Vec<Cell>,
}

#[derive(Default)]
pub(super) struct Cell {
    pub(super) value: Value,
    pub(super) class: &'static str,
    /// The label of the cell on a card.
    pub(super) key: &'static str,
    pub(super) span: usize,
    /// A picture in front of the text.
    pub(super) svg: String,
}

impl Table {
    /// A table with these columns: text, unit, class.
    pub(super) fn new(
        caption: impl Into<String>,
        heads: &[(&'static str, &'static str, &'static str)],
    ) -> Self {
        let heads = heads.iter().map(|(text, unit, class)| Head { text, unit, class });
        Self { caption: caption.into(), heads: heads.collect(), ..Self::default() }
    }

    /// Adds a row whose cells have the classes of their columns.
    pub(super) fn row(&mut self, values: Vec<Value>) -> &mut Row {
        let cells = values.into_iter().zip(&self.heads);
        let cell = |(value, head): (Value, &Head)| Cell { value, class: head.class, ..Cell::default() };
        let row = Row { cells: cells.map(cell).collect(), ..Row::default() };
        let at = self.rows.len();
        self.rows.push(row);
        &mut self.rows[at]
    }
}

/// A picture on the page.
pub(super) struct Picture {
    pub(super) number: usize,
    pub(super) caption: String,
    pub(super) svg: String,
    pub(super) legend: Vec<Legend>,
}

/// A signature block.
pub(super) struct SignatureBlock {
    pub(super) who: &'static str,
    pub(super) what: &'static str,
    pub(super) name: Value,
    pub(super) certificate: Value,
    pub(super) signed: String,
}

/// A part of a section.
pub(super) enum Block {
    Text(String),
    Heading(String),
    Note(String),
    Words(Vec<(&'static str, String)>),
    /// Missed areas in columns, with their numbers.
    Columns(Vec<(usize, String)>),
    /// Other places in columns, with their numbers.
    Places(Vec<(usize, String)>),
    List(Vec<String>),
    Table(Table),
    Wide(Picture),
    Pair(Vec<Picture>),
    Legend(Vec<Legend>),
    Facts(Vec<(&'static str, Value)>),
    Hashes(Vec<(String, String)>),
    Barred(String),
    Signatures(Vec<SignatureBlock>),
}

/// A section.
pub(super) struct Section {
    pub(super) number: usize,
    pub(super) title: &'static str,
    pub(super) is_new_sheet: bool,
    pub(super) blocks: Vec<Block>,
}

pub(super) fn section(title: &'static str, blocks: Vec<Block>) -> Section {
    Section { number: 0, title, is_new_sheet: false, blocks }
}

/// A numbered figure.
pub(super) fn picture(figure: &Figure) -> Picture {
    let Figure { caption, svg, legend } = figure;
    Picture { number: 0, caption: caption.clone(), svg: svg.clone(), legend: legend.clone() }
}

/// The whole page.
pub(super) struct Page {
    pub(super) title: String,
    /// The title on the page.
    pub(super) heading: &'static str,
    /// The notice at the top of a report on located readings; otherwise empty.
    pub(super) banner: String,
    pub(super) css: &'static str,
    pub(super) head: String,
    pub(super) mark: &'static str,
    pub(super) foot: String,
    pub(super) is_simulation: bool,
    pub(super) is_signed: bool,
    pub(super) status: String,
    pub(super) answered: usize,
    pub(super) items: usize,
    pub(super) fields: Vec<Field>,
    pub(super) verdict: Verdict,
    pub(super) shares: Vec<Share>,
    pub(super) bases: Option<Table>,
    pub(super) todo: Vec<Todo>,
    pub(super) sections: Vec<Section>,
}

/// A percentage in the format used everywhere.
pub(super) fn per_cent(share: f64) -> String {
    format!("{:.1}", percent(share))
}
