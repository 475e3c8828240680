//! What is wrong with a package.

use std::io;

/// A file that is not a package, or not as it was written.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// The system refuses to read or write the file.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The file is not in the form in which packages are written.
    #[error("{0}")]
    Form(String),
    /// An entry has a name that packages do not use, because it could lead out of the folder in which it is unpacked.
    #[error(
        "entry \"{0}\" has a name that packages do not use: names consist of letters a to z, digits, `.`, `_`, `-` and `/`, \
         and stay in the folder"
    )]
    Name(String),
    /// An entry is compressed or encrypted.
    #[error(
        "entry {0} is compressed or encrypted; a package stores its files as they are, so it was not unpacked"
    )]
    Compressed(String),
    /// Two entries have one name.
    #[error("entry {0} is in the package twice")]
    Twice(String),
    /// An entry is not where the entry before it ends, or the two headers of an entry differ.
    #[error("entry {0} does not follow the entry before it; bytes are hidden, missing or shared")]
    Hidden(String),
    /// The package would be too large or have too many entries.
    #[error("{0}")]
    TooLarge(String),
}

/// A difference between a package and its list of digests.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// The content of an entry is not the one in the list.
    #[error("{name} was altered: expected SHA-256 {expected}, found {found}")]
    Altered {
        /// Name of the entry.
        name: String,
        /// SHA-256 in the list, hexadecimal.
        expected: String,
        /// SHA-256 of the content, hexadecimal.
        found: String,
    },
    /// The content of an entry is the one in the list, but its header states another checksum.
    #[error("the header of {0} was altered: its CRC-32 is not that of the content")]
    Checksum(String),
    /// The list names an entry that is not in the package.
    #[error("{0} is missing")]
    Missing(String),
    /// An entry is not in the list.
    #[error("{0} was added: SHA256SUMS does not list it")]
    Added(String),
    /// The list names an entry twice.
    #[error("SHA256SUMS lists {0} twice")]
    ListedTwice(String),
    /// A line of the list cannot be read.
    #[error("SHA256SUMS cannot be read: line {0} is not a digest, two spaces and a name")]
    Line(usize),
    /// The package has no list.
    #[error("SHA256SUMS is missing, so nothing can be checked")]
    NoList,
}
