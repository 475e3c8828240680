//! Turns types into schemas.

use crate::{
    Sources,
    attributes::{Serde, documentation},
    sources::{Defined, Definition},
};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use syn::{Field, Fields, GenericArgument, ItemEnum, ItemStruct, PathArguments, Type, TypeParam, Variant};

/// The root type of a document.
#[derive(Debug, Clone, Copy)]
pub struct Root {
    /// The crate of the type.
    pub of_crate: &'static str,
    /// The name of the type.
    pub name: &'static str,
    /// The description of the documents of this type.
    pub about: &'static str,
}

/// A schema document under construction.
#[derive(Debug)]
pub struct Document<'a> {
    sources: &'a Sources,
    definitions: BTreeMap<String, Value>,
    /// The arguments of the generic type that is being written, and of the generic types around it.
    parameters: Vec<BTreeMap<String, Value>>,
}

type Object = Map<String, Value>;

impl<'a> Document<'a> {
    /// The schema of documents that have any of these types.
    ///
    /// # Panics
    /// If a type is written in a way that this crate does not support.
    pub fn of(sources: &'a Sources, title: &str, id: &str, roots: &[Root]) -> Value {
        let mut document = Self { sources, definitions: BTreeMap::new(), parameters: Vec::new() };
        let any: Vec<Value> = roots
            .iter()
            .map(|root| {
                let mut schema = document.defined(sources.root(root.of_crate, root.name), &[]);
                schema.as_object_mut().expect("an object").insert("description".into(), root.about.into());
                schema
            })
            .collect();
        let mut whole = json!({
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "$id": id,
            "title": title,
            "$defs": document.definitions,
        });
        let whole_object = whole.as_object_mut().expect("an object");
        match &any[..] {
            [only] => whole_object.extend(only.as_object().expect("an object").clone()),
            _ => {
                whole_object.insert("anyOf".into(), any.into());
            }
        }
        whole
    }

    /// A reference to a type; adds its definition if it is missing.
    fn defined(&mut self, at: &Defined, inner: &[Value]) -> Value {
        let parameters: Vec<&TypeParam> = at.parameters();
        let mut means = BTreeMap::new();
        let mut name = format!("{}.{}", at.of_crate, at.name);
        for (k, parameter) in parameters.iter().enumerate() {
            let by_default = || parameter.default.as_ref().map(|written| self.of_type(at, written));
            let schema = inner.get(k).cloned().or_else(by_default);
            let schema = schema.unwrap_or_else(|| panic!("{name} needs an argument"));
            name = format!("{name}_of_{}", short(&schema));
            means.insert(parameter.ident.to_string(), schema);
        }
        self.parameters.push(means);
        let reference = self.defined_as(at, name);
        self.parameters.pop();
        reference
    }

    #[allow(clippy::needless_pass_by_value, reason = "callers make the name")]
    fn defined_as(&mut self, at: &Defined, name: String) -> Value {
        if !self.definitions.contains_key(&name) {
            // The entry exists before the definition is complete, so that a type may contain itself.
            self.definitions.insert(name.clone(), Value::Null);
            let schema = self.definition(at);
            self.definitions.insert(name.clone(), schema);
        }
        json!({ "$ref": format!("#/$defs/{name}") })
    }

    fn definition(&mut self, at: &Defined) -> Value {
        let (attributes, schema) = match &at.definition {
            Definition::Struct(item) => (&item.attrs, self.of_struct(at, item)),
            Definition::Enum(item) => (&item.attrs, self.of_enum(at, item)),
            Definition::Alias(item) => (&item.attrs, self.of_type(at, &item.ty)),
        };
        described(schema, &documentation(attributes))
    }

    fn of_struct(&mut self, at: &Defined, item: &ItemStruct) -> Value {
        let serde = Serde::of(&item.attrs);
        if let Some(into) = &serde.into {
            let written: Type = syn::parse_str(into).expect("a type");
            return self.of_type(at, &written);
        }
        match &item.fields {
            Fields::Named(fields) => {
                let fields: Vec<&Field> = fields.named.iter().collect();
                self.object(at, &fields, Object::new(), Vec::new())
            }
            Fields::Unnamed(fields) if fields.unnamed.len() == 1 => self.of_field(at, &fields.unnamed[0]),
            Fields::Unnamed(fields) => {
                let items: Vec<Value> = fields.unnamed.iter().map(|field| self.of_field(at, field)).collect();
                tuple(items)
            }
            Fields::Unit => json!({ "type": "null" }),
        }
    }

    /// An object with some fields, in addition to existing properties.
    fn object(
        &mut self,
        at: &Defined,
        fields: &[&Field],
        mut properties: Object,
        mut required: Vec<Value>,
    ) -> Value {
        let mut choices: Option<Vec<Value>> = None;
        for field in fields {
            let serde = Serde::of(&field.attrs);
            if serde.skip {
                continue;
            }
            if serde.flatten {
                let flat = self.of_type(at, &field.ty);
                let flat = self.resolved(&flat);
                if let Some(any) = flat.get("oneOf").and_then(Value::as_array) {
                    choices = Some(any.clone());
                } else {
                    properties.extend(flat["properties"].as_object().cloned().unwrap_or_default());
                    required.extend(flat["required"].as_array().cloned().unwrap_or_default());
                }
                continue;
            }
            let own = field.ident.as_ref().expect("a named field").to_string();
            let name = serde.name(&own, None);
            properties
                .insert(name.clone(), described(self.of_field(at, field), &documentation(&field.attrs)));
            if !serde.default && !serde.skip_if {
                required.push(name.into());
            }
        }
        match choices {
            None => json!({ "type": "object", "properties": properties, "required": required }),
            Some(choices) => {
                let joined = choices.iter().map(|choice| {
                    let mut choice = self.resolved(choice);
                    let all = properties
                        .clone()
                        .into_iter()
                        .chain(choice["properties"].as_object().cloned().unwrap_or_default());
                    choice["properties"] = all.collect::<Object>().into();
                    let needed = required
                        .iter()
                        .cloned()
                        .chain(choice["required"].as_array().cloned().unwrap_or_default());
                    choice["required"] = needed.collect::<Vec<_>>().into();
                    choice
                });
                json!({ "oneOf": joined.collect::<Vec<_>>() })
            }
        }
    }

    fn of_field(&mut self, at: &Defined, field: &Field) -> Value {
        match Serde::of(&field.attrs).with.as_deref() {
            None => self.of_type(at, &field.ty),
            Some("world::geometry::symmetric" | "geometry::symmetric" | "super" | "symmetric") => {
                symmetric(&field.ty)
            }
            Some(other) => panic!("serde(with = {other}) is not known to the schemas"),
        }
    }

    fn of_enum(&mut self, at: &Defined, item: &ItemEnum) -> Value {
        let serde = Serde::of(&item.attrs);
        if let Some(into) = &serde.into {
            let written: Type = syn::parse_str(into).expect("a type");
            return self.of_type(at, &written);
        }
        let choices: Vec<Value> = item
            .variants
            .iter()
            .filter(|variant| !Serde::of(&variant.attrs).skip)
            .map(|variant| {
                let name =
                    Serde::of(&variant.attrs).name(&variant.ident.to_string(), serde.rename_all.as_deref());
                let schema = match &serde.tag {
                    _ if serde.untagged => self.content(at, variant),
                    Some(tag) => self.tagged(at, variant, tag, &name),
                    None => self.named(at, variant, &name),
                };
                described(schema, &documentation(&variant.attrs))
            })
            .collect();
        json!({ if serde.untagged { "anyOf" } else { "oneOf" }: choices })
    }

    /// A variant by its name alone, or with its content under it.
    fn named(&mut self, at: &Defined, variant: &Variant, name: &str) -> Value {
        if matches!(variant.fields, Fields::Unit) {
            return json!({ "const": name });
        }
        let content = self.content(at, variant);
        json!({ "type": "object", "properties": { name: content }, "required": [name] })
    }

    /// A variant with its name beside its content.
    fn tagged(&mut self, at: &Defined, variant: &Variant, tag: &str, name: &str) -> Value {
        let head = Object::from_iter([(tag.to_owned(), json!({ "const": name }))]);
        let required = vec![Value::from(tag)];
        match &variant.fields {
            Fields::Named(fields) => {
                let fields: Vec<&Field> = fields.named.iter().collect();
                self.object(at, &fields, head, required)
            }
            Fields::Unit => json!({ "type": "object", "properties": head, "required": required }),
            Fields::Unnamed(fields) => {
                let content = self.of_type(at, &fields.unnamed[0].ty);
                let mut content = self.resolved(&content);
                let properties = content["properties"].as_object().cloned().unwrap_or_default();
                content["properties"] = head.into_iter().chain(properties).collect::<Object>().into();
                let needed = content["required"].as_array().cloned().unwrap_or_default();
                content["required"] = required.into_iter().chain(needed).collect::<Vec<_>>().into();
                content
            }
        }
    }

    fn content(&mut self, at: &Defined, variant: &Variant) -> Value {
        match &variant.fields {
            Fields::Named(fields) => {
                let fields: Vec<&Field> = fields.named.iter().collect();
                self.object(at, &fields, Object::new(), Vec::new())
            }
            Fields::Unnamed(fields) if fields.unnamed.len() == 1 => self.of_field(at, &fields.unnamed[0]),
            Fields::Unnamed(fields) => {
                let items: Vec<Value> = fields.unnamed.iter().map(|field| self.of_field(at, field)).collect();
                tuple(items)
            }
            Fields::Unit => json!({ "type": "null" }),
        }
    }

    /// Replaces a reference by the schema itself.
    fn resolved(&self, schema: &Value) -> Value {
        match schema.get("$ref").and_then(Value::as_str) {
            Some(reference) => self.definitions[reference.trim_start_matches("#/$defs/")].clone(),
            None => schema.clone(),
        }
    }

    fn of_type(&mut self, at: &Defined, written: &Type) -> Value {
        match written {
            Type::Reference(reference) => self.of_type(at, &reference.elem),
            Type::Paren(inner) => self.of_type(at, &inner.elem),
            Type::Tuple(all) if all.elems.is_empty() => json!({ "type": "null" }),
            Type::Tuple(all) => {
                let items: Vec<Value> = all.elems.iter().map(|item| self.of_type(at, item)).collect();
                tuple(items)
            }
            Type::Slice(slice) => list(self.of_type(at, &slice.elem)),
            Type::Array(array) => list(self.of_type(at, &array.elem)),
            Type::Path(path) => {
                let names: Vec<String> =
                    path.path.segments.iter().map(|part| part.ident.to_string()).collect();
                let last = path.path.segments.last().expect("a path has an end");
                let inner: Vec<&Type> = match &last.arguments {
                    PathArguments::AngleBracketed(all) => all
                        .args
                        .iter()
                        .filter_map(|argument| match argument {
                            GenericArgument::Type(inner) => Some(inner),
                            _ => None,
                        })
                        .collect(),
                    _ => Vec::new(),
                };
                self.of_path(at, &names, &inner)
            }
            other => panic!("{}: a type that is not known to the schemas: {other:?}", at.file.display()),
        }
    }

    fn of_path(&mut self, at: &Defined, names: &[String], inner: &[&Type]) -> Value {
        let name = names.last().expect("a path has an end").as_str();
        if let Some(means) = self.parameters.last().and_then(|means| means.get(name)) {
            return means.clone();
        }
        match (name, inner) {
            ("bool", _) => json!({ "type": "boolean" }),
            ("f64" | "f32", _) => json!({ "type": "number" }),
            ("i8" | "i16" | "i32" | "i64" | "isize", _) => json!({ "type": "integer" }),
            ("u8" | "u16" | "u32" | "u64" | "usize", _) => json!({ "type": "integer", "minimum": 0 }),
            ("String" | "str" | "char", _) => json!({ "type": "string" }),
            ("Value", _) => json!({}),
            ("Option", [inner]) => json!({ "anyOf": [self.of_type(at, inner), { "type": "null" }] }),
            ("Box" | "Arc" | "Cow" | "Rc", [inner]) => self.of_type(at, inner),
            ("Vec" | "VecDeque" | "BTreeSet" | "HashSet", [inner]) => list(self.of_type(at, inner)),
            ("BTreeMap" | "HashMap", [_, inner]) => {
                json!({ "type": "object", "additionalProperties": self.of_type(at, inner) })
            }
            // This type has its own `Serialize`.
            ("PlanId", _) => json!({ "type": "string", "description": "SHA-256, hexadecimal" }),
            ("Point" | "Vector" | "Point2" | "Vector2", _) => json!({
                "type": "array",
                "description": "x and y, metres unless it says otherwise",
                "items": { "type": "number" },
                "minItems": 2,
                "maxItems": 2,
            }),
            _ => {
                let found = self.sources.find(at, names).cloned();
                let found = found.unwrap_or_else(|| panic!("{}: no type {names:?}", at.file.display()));
                let inner: Vec<Value> = inner.iter().map(|inner| self.of_type(at, inner)).collect();
                self.defined(&found, &inner)
            }
        }
    }
}

/// A one-word name of a schema, for the name of a generic type.
fn short(schema: &Value) -> String {
    let reference = schema["$ref"].as_str().and_then(|path| path.rsplit(['.', '/']).next());
    reference.or(schema["type"].as_str()).unwrap_or("any").to_owned()
}

#[allow(clippy::needless_pass_by_value, reason = "callers make the schema")]
fn list(items: Value) -> Value {
    json!({ "type": "array", "items": items })
}

#[allow(clippy::needless_pass_by_value, reason = "callers make the schemas")]
fn tuple(items: Vec<Value>) -> Value {
    let n = items.len();
    json!({ "type": "array", "prefixItems": items, "minItems": n, "maxItems": n })
}

/// The written form of a symmetric matrix: its upper triangle, row by row.
fn symmetric(written: &Type) -> Value {
    let is_of_two = matches!(written, Type::Path(path) if path.path.segments.last().is_some_and(|last| last.ident == "Matrix2"));
    let (n, what) = if is_of_two {
        (3, "covariance of x and y: xx, xy, yy; square metres")
    } else {
        (6, "covariance of x, y and heading θ: xx, xy, xθ, yy, yθ, θθ; metres and radians")
    };
    json!({
        "type": "array",
        "description": what,
        "items": { "type": "number" },
        "minItems": n,
        "maxItems": n,
    })
}

/// A schema with its documentation.
fn described(mut schema: Value, documentation: &str) -> Value {
    if !documentation.is_empty()
        && let Some(object) = schema.as_object_mut()
    {
        object.insert("description".into(), documentation.into());
    }
    schema
}
