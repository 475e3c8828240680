//! Loads a library and calls its planners. This module contains most of the console's unsafe code, and runs only in a
//! worker.
#![expect(unsafe_code, reason = "third-party libraries are loaded and called here")]

mod instance;
mod sink;
mod stage;

pub(crate) use instance::Instance;
use sink::{LONGEST_TEXT, plain};
pub(crate) use sink::{Sink, Watch};
use stage::Staged;

use crate::checks::limits::MOST_PLANNERS;
use crate::discovery::{read_bytes, sha256_hex, too_large_for_machine};
use crate::parameters;
use crate::stamp::{self, Abi, CONSOLE_ABI};
use crate::supervisor::no_worker;
use crate::wire::answer::{Described, Refusal};
use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
use planner_api::abi;
use std::error::Error;
use std::path::Path;

/// The checked function table of one planner.
pub(crate) struct Table {
    pub(crate) id: String,
    name: String,
    version: String,
    about: String,
    caps: u32,
    state_version: u32,
    raw: abi::Planner,
}

/// The checked private copy of a plugin's file; none of its code has run.
pub(crate) struct File {
    name: String,
    pub(crate) sha256: String,
    pub(crate) abi: Abi,
    staged: Staged,
}

/// A library whose constructors have run; it stays loaded until the process ends.
pub(crate) struct Loaded(abi::Entry);

/// The reason why a file cannot be loaded.
pub(crate) enum NotRead {
    /// The file is not a plugin that can be loaded.
    Refused(String),
    /// This machine prevents the file from being loaded.
    Machine(String),
}

impl File {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// The reason why the file is refused; the text follows "refused:".
    pub(crate) fn read(path: &Path) -> Result<Self, NotRead> {
        let bytes = read_bytes(path).map_err(NotRead::Refused)?;
        let abi = stamp::read(&bytes).map_err(|error| NotRead::Refused(error.to_string()))?;
        if let Some(why) = too_large_for_machine(path) {
            return Err(NotRead::Machine(format!("cannot be loaded: {why}")));
        }
        let staged = stage::stage(&bytes).map_err(|error| {
            NotRead::Machine(no_worker("cannot make a private copy of the plugin", &error))
        })?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { name, sha256: sha256_hex(&bytes), abi, staged })
    }

    /// Loads exactly the bytes that were checked.
    ///
    /// # Errors
    /// The reason why the library is refused; the text follows "refused:". The same applies below.
    pub(crate) fn load(self) -> Result<Loaded, String> {
        let staged = self.staged.path();
        // All symbols are resolved now, so a missing symbol causes a refusal here instead of ending the process on
        // first use. SAFETY: this runs the library's constructors, whatever they do; the purpose of this process is to
        // contain them.
        let library = unsafe { Library::open(Some(staged), RTLD_NOW | RTLD_LOCAL) }.map_err(|error| {
            let reason = error.source().map_or_else(|| error.to_string(), ToString::to_string);
            format!("the loader refused it: {}", reason.replace(&*staged.to_string_lossy(), &self.name))
        })?;
        // SAFETY: the stamp promises that this symbol is an entry; the entry's own magic number is checked before
        // anything else.
        let entry = unsafe {
            let symbol = library.get::<*const abi::Entry>(abi::SYMBOL);
            let symbol = symbol.map_err(|_| format!("does not export `{}`", abi::SYMBOL))?;
            symbol.as_ref().ok_or_else(|| format!("exports a null `{}`", abi::SYMBOL))?
        };
        let entry = *entry;
        // Code with thread-local destructors must not be unloaded, so the library stays loaded until the process ends.
        std::mem::forget(library);
        self.staged.keep();
        Ok(Loaded(entry))
    }
}

impl Loaded {
    /// Checks the function tables of all planners.
    pub(crate) fn tables(self) -> Result<Vec<Table>, String> {
        let Self(entry) = self;
        check_entry(&entry)?;
        let tables = (0..entry.n_planners as usize)
            .map(|index| read_table(&entry, index))
            .collect::<Result<Vec<_>, _>>()?;
        if let Some((_, twice)) =
            tables.iter().enumerate().find(|(i, t)| tables[..*i].iter().any(|u| u.id == t.id))
        {
            return Err(format!("exports the planner `{}` twice", twice.id));
        }
        Ok(tables)
    }
}

fn check_entry(entry: &abi::Entry) -> Result<(), String> {
    if entry.magic != abi::MAGIC {
        return Err(format!("`{}` is not a planner entry (wrong magic)", abi::SYMBOL));
    }
    let theirs = Abi { major: entry.abi_major, minor: entry.abi_minor };
    stamp::accept(theirs).map_err(|error| error.to_string())?;
    check_size("its entry", entry.size, size_of::<abi::Entry>())?;
    if !(1..=MOST_PLANNERS).contains(&(entry.n_planners as usize)) || entry.planners.is_null() {
        return Err(format!("exports {} planners; 1 to {MOST_PLANNERS} are allowed", entry.n_planners));
    }
    Ok(())
}

/// Checks the size of a struct. Version 1.0 has the smallest structs; later versions only add to them.
fn check_size(what: &str, size: u32, needed: usize) -> Result<(), String> {
    if (size as usize) < needed {
        return Err(format!(
            "{what} has {size} bytes, but ABI {CONSOLE_ABI} needs {needed}; it was built with a broken header"
        ));
    }
    Ok(())
}

fn read_table(entry: &abi::Entry, index: usize) -> Result<Table, String> {
    // SAFETY: the entry promises `n_planners` pointers to tables that live as long as the library, which is never
    // unloaded.
    let raw = unsafe {
        let table = *entry.planners.add(index);
        if table.is_null() {
            return Err(format!("planner number {index} is null"));
        }
        let size = table.cast::<u32>().read();
        check_size(&format!("the table of planner number {index}"), size, size_of::<abi::Planner>())?;
        abi::copy_sized(table)
    };
    let text = |raw| plain(raw, LONGEST_TEXT);
    let id = text(raw.id);
    if !planner_api::export::is_id(&id) {
        return Err(format!("`{id}` is not a planner id; ids are 1 to 32 characters from a-z, 0-9, _ and -"));
    }
    let functions = [
        ("describe", raw.describe.is_some()),
        ("create", raw.create.is_some()),
        ("destroy", raw.destroy.is_some()),
        ("plan", raw.plan.is_some()),
        ("step", raw.step.is_some()),
    ];
    let missing: Vec<&str> =
        functions.into_iter().filter(|(_, is_there)| !is_there).map(|(name, _)| name).collect();
    if !missing.is_empty() {
        return Err(format!("planner `{id}` lacks required functions: {}", missing.join(", ")));
    }
    let [name, version, about] = [raw.name, raw.version, raw.about].map(text);
    Ok(Table { id, name, version, about, caps: raw.caps, state_version: raw.state_version, raw })
}

impl Table {
    /// Asks the planner to describe its parameters.
    pub(crate) fn describe(&self, sink: &mut Sink<'_>) -> Result<Described, String> {
        let describe = self.raw.describe.expect("checked when the table was read");
        // SAFETY: the services outlive the call.
        let code = sink.during(|host| unsafe { describe(host) });
        if code != 0 {
            return Err(format!("planner `{}` failed to describe itself: {}", self.id, sink.take_error()));
        }
        let parameters = std::mem::take(&mut sink.params);
        parameters::check(&parameters).map_err(|why| format!("planner `{}`: {why}", self.id))?;
        let [id, name, version, about] = [&self.id, &self.name, &self.version, &self.about].map(Clone::clone);
        Ok(Described {
            id,
            name,
            version,
            about,
            caps: self.caps,
            state_version: self.state_version,
            parameters,
        })
    }

    /// Creates an instance.
    pub(crate) fn create(
        &self,
        site: &planner_api::Site<'_>,
        values: &[(String, f64)],
        sink: &mut Sink<'_>,
    ) -> Result<Instance, Refusal> {
        Instance::create(&self.raw, site, values, sink)
    }
}
