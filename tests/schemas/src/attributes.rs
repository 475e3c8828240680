//! The information in the attributes of a type, a field or a variant.

use syn::{Attribute, Expr, Lit, Meta, Token, punctuated::Punctuated};

/// The serde attributes that change the written form.
#[derive(Debug, Clone, Default)]
#[allow(clippy::struct_excessive_bools, reason = "each is an attribute of its own")]
pub(crate) struct Serde {
    pub default: bool,
    pub skip: bool,
    pub skip_if: bool,
    pub flatten: bool,
    pub untagged: bool,
    pub transparent: bool,
    pub tag: Option<String>,
    pub rename: Option<String>,
    pub rename_all: Option<String>,
    pub into: Option<String>,
    pub with: Option<String>,
}

impl Serde {
    /// Includes attributes that depend on a feature: the console enables all of them.
    pub(crate) fn of(attributes: &[Attribute]) -> Self {
        let mut serde = Self::default();
        for attribute in attributes {
            serde.take(&attribute.meta);
        }
        serde
    }

    fn take(&mut self, meta: &Meta) {
        let Meta::List(list) = meta else { return };
        let inner = || list.parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated);
        if list.path.is_ident("cfg_attr") {
            inner().into_iter().flatten().skip(1).for_each(|meta| self.take(&meta));
        }
        if list.path.is_ident("serde") {
            inner().into_iter().flatten().for_each(|meta| self.take_one(&meta));
        }
    }

    fn take_one(&mut self, meta: &Meta) {
        let name = meta.path().get_ident().map(ToString::to_string).unwrap_or_default();
        let value = match meta {
            Meta::NameValue(pair) => text(&pair.value),
            _ => None,
        };
        match name.as_str() {
            "default" => self.default = true,
            "skip" => self.skip = true,
            "skip_serializing_if" => self.skip_if = true,
            "flatten" => self.flatten = true,
            "untagged" => self.untagged = true,
            "transparent" => self.transparent = true,
            "tag" => self.tag = value,
            "rename" => self.rename = value,
            "rename_all" => self.rename_all = value,
            "into" => self.into = value,
            "with" => self.with = value,
            // These attributes only affect reading.
            "from" | "try_from" | "alias" | "deny_unknown_fields" | "bound" => {}
            other => panic!("serde({other}) is not known to the schemas"),
        }
    }

    /// A name in its written form.
    pub(crate) fn name(&self, own: &str, all: Option<&str>) -> String {
        match (&self.rename, all) {
            (Some(name), _) => name.clone(),
            (None, Some("snake_case")) => snake(own),
            (None, None) => own.trim_start_matches("r#").to_owned(),
            (None, Some(other)) => panic!("rename_all = {other} is not known to the schemas"),
        }
    }
}

fn snake(name: &str) -> String {
    let mut snake = String::new();
    for (at, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && at > 0 {
            snake.push('_');
        }
        snake.extend(letter.to_lowercase());
    }
    snake
}

/// The documentation, with one line for each paragraph.
pub(crate) fn documentation(attributes: &[Attribute]) -> String {
    let lines: Vec<String> = attributes
        .iter()
        .filter(|attribute| attribute.path().is_ident("doc"))
        .filter_map(|attribute| match &attribute.meta {
            Meta::NameValue(pair) => text(&pair.value),
            _ => None,
        })
        .map(|line| line.trim().to_owned())
        .collect();
    let text =
        lines.iter().take_while(|line| !line.starts_with("```")).cloned().collect::<Vec<_>>().join("\n");
    let paragraphs = text.split("\n\n").map(|paragraph| paragraph.replace('\n', " "));
    paragraphs.collect::<Vec<_>>().join("\n").trim().to_owned()
}

fn text(value: &Expr) -> Option<String> {
    match value {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Str(text) => Some(text.value()),
            _ => None,
        },
        _ => None,
    }
}
