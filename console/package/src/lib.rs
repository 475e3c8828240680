//! Packages: files and the list of their digests in one ZIP file.
//!
//! [`Writer`] stores each file as it is, without compression, and ends with [`SUMS`], the list that `sha256sum -c` reads.
//! [`Package::open`] accepts only files of this form, so nothing can be hidden between the entries, unpacked to another
//! place, or grow when it is unpacked; [`Package::faults`] compares every entry with the list. Pure: reads and writes
//! streams, and never creates a file.

mod fault;
mod header;
mod name;
mod package;
mod writer;

pub use fault::{Fault, PackageError};
pub use name::is_name;
pub use package::{Entry, Package};
pub use writer::{Writer, sha256_of};

/// Name of the list of digests, the last entry of a package.
pub const SUMS: &str = "SHA256SUMS";
/// The most entries of a package.
pub const MOST_ENTRIES: usize = 10_000;
/// The largest size of a package, bytes: what the ZIP format can address without extensions.
pub const MOST_BYTES: u64 = u32::MAX as u64;

#[cfg(test)]
mod tests;
