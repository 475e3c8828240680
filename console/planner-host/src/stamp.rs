//! Reads what a library states about itself before any of its code runs.
//!
//! Loading a library runs its constructors, so the planner ABI is first read from a section of the file.

use object::{Architecture, BinaryFormat, File, Object, ObjectKind, ObjectSection};
use planner_api::abi;
use std::fmt;

/// The version of the planner ABI for which a library was built.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Abi {
    /// The major version; must equal the console's.
    pub major: u32,
    /// The minor version; may be newer or older than the console's.
    pub minor: u32,
}

impl fmt::Display for Abi {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}

/// The ABI that this console uses.
pub const CONSOLE_ABI: Abi = Abi { major: abi::MAJOR, minor: abi::MINOR };

/// The reason why a file is not a plugin for this console; the text follows "refused:".
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StampError {
    /// The file is neither ELF, Mach-O nor PE.
    #[error("not a shared library")]
    NotALibrary,
    /// The file ends too early, or its tables are wrong.
    #[error("truncated or damaged library ({0})")]
    Damaged(String),
    /// The library is for a different operating system or processor.
    #[error("built for a different system ({theirs}; this console runs on {ours})")]
    OtherSystem {
        /// File format and processor of the library.
        theirs: String,
        /// File format and processor of the console.
        ours: String,
    },
    /// The file is a program or an object file.
    #[error("not a shared library but {0}")]
    OtherKind(&'static str),
    /// The file has no section with a stamp, or the section contains something else.
    #[error(
        "a library, but not a planner plugin (no .tankplan stamp; Rust: export_planners!(..), C: TP_STAMP)"
    )]
    NoStamp,
    /// The library has a different major version of the ABI.
    #[error("built for planner ABI {theirs}; this console uses {CONSOLE_ABI}: {advice}", advice = advice(*theirs))]
    OtherAbi {
        /// The ABI version of the library.
        theirs: Abi,
    },
}

fn advice(theirs: Abi) -> &'static str {
    if theirs.major < CONSOLE_ABI.major { "rebuild the plugin" } else { "update the console" }
}

/// Reads the stamp of a library and accepts it if this console can run the library.
///
/// # Errors
/// The reason why the file is not a plugin for this console.
pub fn read(bytes: &[u8]) -> Result<Abi, StampError> {
    let kind = object::FileKind::parse(bytes).map_err(|_| StampError::NotALibrary)?;
    if !is_library_format(kind) {
        return Err(StampError::NotALibrary);
    }
    let file = File::parse(bytes).map_err(|error| StampError::Damaged(error.to_string()))?;
    check_system(&file)?;
    match file.kind() {
        ObjectKind::Dynamic => {}
        ObjectKind::Executable => return Err(StampError::OtherKind("a program")),
        _ => return Err(StampError::OtherKind("an object file")),
    }
    let section =
        abi::SECTIONS.iter().find_map(|name| file.section_by_name(name)).ok_or(StampError::NoStamp)?;
    let stamp = section.data().map_err(|error| StampError::Damaged(error.to_string()))?;
    accept(parse(stamp).ok_or(StampError::NoStamp)?)
}

/// Returns the planner ids of a library, if its stamp lists them.
pub fn ids(bytes: &[u8]) -> Option<Vec<String>> {
    let file = File::parse(bytes).ok()?;
    let section = abi::SECTIONS.iter().find_map(|name| file.section_by_name(name))?;
    let ids = section.data().ok()?.get(size_of::<abi::Stamp>()..)?;
    let ids = ids.split(|byte| *byte == 0).filter(|id| !id.is_empty());
    let ids: Vec<String> = ids.map(|id| String::from_utf8_lossy(id).into_owned()).collect();
    let are_ids = !ids.is_empty() && ids.iter().all(|id| planner_api::export::is_id(id));
    are_ids.then_some(ids)
}

/// Accepts every ABI with the console's own major version.
///
/// # Errors
/// [`StampError::OtherAbi`].
pub fn accept(theirs: Abi) -> Result<Abi, StampError> {
    if theirs.major == CONSOLE_ABI.major { Ok(theirs) } else { Err(StampError::OtherAbi { theirs }) }
}

fn parse(stamp: &[u8]) -> Option<Abi> {
    let rest = stamp.strip_prefix(&abi::MAGIC)?;
    let (major, rest) = rest.split_first_chunk::<4>()?;
    let (minor, _) = rest.split_first_chunk::<4>()?;
    Some(Abi { major: u32::from_ne_bytes(*major), minor: u32::from_ne_bytes(*minor) })
}

fn is_library_format(kind: object::FileKind) -> bool {
    use object::FileKind::{Elf32, Elf64, MachO32, MachO64, Pe32, Pe64};
    matches!(kind, Elf32 | Elf64 | MachO32 | MachO64 | Pe32 | Pe64)
}

const OUR_FORMAT: BinaryFormat = if cfg!(target_vendor = "apple") {
    BinaryFormat::MachO
} else if cfg!(windows) {
    BinaryFormat::Pe
} else {
    BinaryFormat::Elf
};

fn our_processor() -> Architecture {
    match std::env::consts::ARCH {
        "x86_64" => Architecture::X86_64,
        "aarch64" => Architecture::Aarch64,
        "riscv64" => Architecture::Riscv64,
        _ => Architecture::Unknown,
    }
}

fn processor_name(processor: Architecture) -> &'static str {
    match processor {
        Architecture::X86_64 => "x86-64",
        Architecture::I386 => "32-bit x86",
        Architecture::Aarch64 => "AArch64",
        Architecture::Arm => "32-bit ARM",
        Architecture::Riscv64 => "64-bit RISC-V",
        _ => "a different processor",
    }
}

fn format_name(format: BinaryFormat) -> &'static str {
    match format {
        BinaryFormat::Elf => "ELF",
        BinaryFormat::MachO => "Mach-O",
        BinaryFormat::Pe => "PE",
        _ => "a different format",
    }
}

fn check_system(file: &File<'_>) -> Result<(), StampError> {
    let (theirs, ours) = ((file.format(), file.architecture()), (OUR_FORMAT, our_processor()));
    // A processor that is not in the list above is accepted here; the loader decides.
    let fits = theirs.0 == ours.0 && (ours.1 == Architecture::Unknown || theirs.1 == ours.1);
    let text = |(format, processor)| format!("{} for {}", format_name(format), processor_name(processor));
    if fits { Ok(()) } else { Err(StampError::OtherSystem { theirs: text(theirs), ours: text(ours) }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_file_is_no_library() {
        assert_eq!(read(b"not a library"), Err(StampError::NotALibrary));
        assert_eq!(read(b""), Err(StampError::NotALibrary));
    }

    #[test]
    fn a_stamp_is_magic_major_minor() {
        let mut stamp = abi::MAGIC.to_vec();
        stamp.extend(1_u32.to_ne_bytes().into_iter().chain(7_u32.to_ne_bytes()));
        assert_eq!(parse(&stamp), Some(Abi { major: 1, minor: 7 }));
        assert_eq!(parse(&stamp[..15]), None);
        assert_eq!(parse(b"TANKPLUM00000000"), None);
    }

    #[test]
    fn another_major_version_is_refused_with_what_to_do() {
        let newer = accept(Abi { major: 9, minor: 0 }).map_err(|error| error.to_string());
        assert_eq!(newer, Err("built for planner ABI 9.0; this console uses 1.5: update the console".into()));
        let older = accept(Abi { major: 0, minor: 3 }).map_err(|error| error.to_string());
        assert_eq!(older, Err("built for planner ABI 0.3; this console uses 1.5: rebuild the plugin".into()));
        assert!(accept(Abi { major: 1, minor: 99 }).is_ok(), "a newer minor version is accepted");
    }

    proptest::proptest! {
        #![proptest_config(proptest::prelude::ProptestConfig::with_cases(200))]

        /// A damaged library is refused or read; headers are at its beginning, tables at its end.
        #[test]
        fn a_damaged_library_is_refused_or_read(
            at_end in proptest::prelude::any::<bool>(),
            damage in mutations::mutations(),
        ) {
            let program = std::env::current_exe().and_then(std::fs::read).expect("this program");
            let (head, tail) = program.split_at(if at_end { program.len() - 8192 } else { 4096 });
            let damaged = if at_end {
                [head, &mutations::mutated(tail, &damage)].concat()
            } else {
                [&mutations::mutated(head, &damage), tail].concat()
            };
            let _ = read(&damaged);
        }
    }
}
