//! The types of some crates, as defined in their sources.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};
use syn::{Attribute, File, Item, ItemEnum, ItemStruct, ItemType, Meta, TypeParam, UseTree};

/// The definition of a type.
#[derive(Debug, Clone)]
pub(crate) enum Definition {
    Struct(ItemStruct),
    Enum(ItemEnum),
    Alias(ItemType),
}

/// A type, and the place of its definition.
#[derive(Debug, Clone)]
pub(crate) struct Defined {
    pub of_crate: String,
    pub file: PathBuf,
    pub name: String,
    pub definition: Definition,
}

impl Defined {
    /// The type parameters.
    pub(crate) fn parameters(&self) -> Vec<&TypeParam> {
        let generics = match &self.definition {
            Definition::Struct(item) => &item.generics,
            Definition::Enum(item) => &item.generics,
            Definition::Alias(item) => &item.generics,
        };
        generics.type_params().collect()
    }
}

/// The types of some crates.
#[derive(Debug, Default)]
pub struct Sources {
    all: Vec<Defined>,
    /// For each file and name, the crate from which the name is imported.
    uses: BTreeMap<(PathBuf, String), Vec<String>>,
    /// The root of each crate.
    libs: BTreeMap<String, PathBuf>,
}

impl Sources {
    /// Reads crates, given by name and source folder.
    ///
    /// # Panics
    /// If a file cannot be read or is not Rust.
    pub fn read(crates: &[(&str, &Path)]) -> Self {
        let mut sources = Self::default();
        for (name, folder) in crates {
            sources.libs.insert((*name).to_owned(), folder.join("lib.rs"));
            sources.read_folder(name, folder);
        }
        sources
    }

    fn read_folder(&mut self, of_crate: &str, folder: &Path) {
        let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
        paths.sort();
        for path in paths {
            if path.is_dir() {
                self.read_folder(of_crate, &path);
            } else if path.extension().is_some_and(|end| end == "rs") {
                let text =
                    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                let file =
                    syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                self.take(of_crate, &path, &file);
            }
        }
    }

    fn take(&mut self, of_crate: &str, path: &Path, file: &File) {
        for item in &file.items {
            let (name, definition) = match item {
                Item::Struct(item) => (item.ident.to_string(), Definition::Struct(item.clone())),
                Item::Enum(item) => (item.ident.to_string(), Definition::Enum(item.clone())),
                Item::Type(item) => (item.ident.to_string(), Definition::Alias(item.clone())),
                Item::Use(item) => {
                    self.take_use(path, &item.tree, &mut Vec::new());
                    continue;
                }
                _ => continue,
            };
            // Other types with this name are never written; an alias stands for its target.
            let is_written = match &definition {
                Definition::Struct(item) => is_serialised(&item.attrs),
                Definition::Enum(item) => is_serialised(&item.attrs),
                Definition::Alias(_) => true,
            };
            if !is_written {
                continue;
            }
            self.all.push(Defined { of_crate: of_crate.to_owned(), file: path.to_owned(), name, definition });
        }
    }

    fn take_use(&mut self, file: &Path, tree: &UseTree, before: &mut Vec<String>) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.take_use(file, &path.tree, before);
                before.pop();
            }
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.take_use(file, tree, before)),
            UseTree::Name(name) => {
                self.uses.insert((file.to_owned(), name.ident.to_string()), before.clone());
            }
            UseTree::Rename(rename) => {
                let whole = before.iter().cloned().chain([rename.ident.to_string()]).collect();
                self.uses.insert((file.to_owned(), rename.rename.to_string()), whole);
            }
            UseTree::Glob(_) => {}
        }
    }

    /// The type that a path refers to in a file of a crate; `None` if none of the crates has it.
    ///
    /// # Panics
    /// If the path is ambiguous.
    pub(crate) fn find(&self, at: &Defined, path: &[String]) -> Option<&Defined> {
        let (name, before) = path.split_last()?;
        let used = self.uses.get(&(at.file.clone(), path[0].clone()));
        let way: Vec<String> = match used {
            Some(used) if before.is_empty() => used.clone(),
            Some(used) => used.iter().chain(before).cloned().collect(),
            None => before.to_vec(),
        };
        let is_known = |name: &String| self.all.iter().any(|defined| defined.of_crate == *name);
        let of_crate = way.first().filter(|first| is_known(first)).unwrap_or(&at.of_crate);
        let lib = self.libs.get(of_crate).filter(|lib| **lib != at.file && way.len() <= 1);
        if let Some(lib) = lib.filter(|lib| self.uses.contains_key(&((*lib).clone(), name.clone()))) {
            // The name is at the root of the crate, which states its origin.
            let root = Defined { of_crate: of_crate.clone(), file: lib.clone(), ..at.clone() };
            return self.find(&root, std::slice::from_ref(name));
        }
        let named = |of_crate: Option<&str>| -> Vec<&Defined> {
            let is_it = |defined: &&Defined| {
                defined.name == *name && of_crate.is_none_or(|known| defined.of_crate == known)
            };
            self.all.iter().filter(is_it).collect()
        };
        let mut found = named(Some(of_crate));
        if found.is_empty() {
            // The name is re-exported from another crate.
            found = named(None);
        }
        if found.len() > 1 && way.len() <= 1 {
            let here: Vec<&Defined> =
                found.iter().copied().filter(|defined| defined.file == at.file).collect();
            found = if here.is_empty() { found } else { here };
        }
        if let Some(module) = way.last().filter(|_| found.len() > 1) {
            let is_in = |defined: &&Defined| {
                let stem = defined.file.with_extension("");
                stem.components().any(|part| part.as_os_str() == module.as_str())
            };
            let inside: Vec<&Defined> = found.iter().copied().filter(is_in).collect();
            found = if inside.is_empty() { found } else { inside };
        }
        assert!(found.len() < 2, "{path:?} in {} can be {:?}", at.file.display(), places(&found));
        found.pop()
    }

    /// The type of a name in a crate.
    ///
    /// # Panics
    /// If there is no such type, or more than one.
    pub(crate) fn root(&self, of_crate: &str, name: &str) -> &Defined {
        let is_it = |defined: &&Defined| defined.of_crate == of_crate && defined.name == name;
        let found: Vec<&Defined> = self.all.iter().filter(is_it).collect();
        assert!(found.len() == 1, "{of_crate}::{name} is in {:?}", places(&found));
        found[0]
    }
}

/// Whether a type derives `Serialize`, possibly only with a feature.
fn is_serialised(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) if list.path.is_ident("derive") || list.path.is_ident("cfg_attr") => {
            list.tokens.to_string().contains("Serialize")
        }
        _ => false,
    })
}

fn places(found: &[&Defined]) -> Vec<String> {
    found.iter().map(|defined| defined.file.display().to_string()).collect()
}
