//! The functions of both sides, the entry of a library, and its stamp.
#![allow(missing_docs, reason = "the header explains the fields")]

use super::{Draw, Leg, Param, PlanIn, PlanOut, Site, Sized32, StepIn, StepOut, Str, Value, Vec2};
use std::ffi::c_void;

/// Signatures of the console's services; the first argument is always [`Host::ctx`].
pub type Ask = unsafe extern "C" fn(*mut c_void) -> u32;
pub type AskSeconds = unsafe extern "C" fn(*mut c_void) -> f64;
pub type TakeText = unsafe extern "C" fn(*mut c_void, *const u8, usize);
pub type TakeLog = unsafe extern "C" fn(*mut c_void, u32, *const u8, usize);
pub type TakeParam = unsafe extern "C" fn(*mut c_void, *const Param);
pub type TakePoints = unsafe extern "C" fn(*mut c_void, *const Vec2, usize);
pub type TakeLegs = unsafe extern "C" fn(*mut c_void, *const Leg, usize);
pub type TakeDraws = unsafe extern "C" fn(*mut c_void, *const Draw, usize);
pub type TakeScalar = unsafe extern "C" fn(*mut c_void, Str, f64, Str);
pub type TakeProgress = unsafe extern "C" fn(*mut c_void, f64, *const u8, usize);

/// The services that the console offers during a call.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Host {
    pub size: u32,
    pub abi_minor: u32,
    pub ctx: *mut c_void,
    pub should_stop: Option<Ask>,
    pub time_left_s: Option<AskSeconds>,
    pub wants_drawing: Option<Ask>,
    pub error: Option<TakeText>,
    pub log: Option<TakeLog>,
    pub param: Option<TakeParam>,
    pub points: Option<TakePoints>,
    pub draw: Option<TakeDraws>,
    pub scalar: Option<TakeScalar>,
    pub bytes: Option<TakeText>,
    // Since 1.1.
    pub legs: Option<TakeLegs>,
    pub cut: Option<TakePoints>,
    // Since 1.2.
    pub progress: Option<TakeProgress>,
}

/// Signatures of a planner's functions; those that return `i32` return 0 or a [`crate::Code`].
pub type Describe = unsafe extern "C" fn(*const Host) -> i32;
pub type Create = unsafe extern "C" fn(*const Host, *const Site, *const Value, u32, *mut *mut c_void) -> i32;
pub type Destroy = unsafe extern "C" fn(*mut c_void);
pub type Reconfigure = unsafe extern "C" fn(*mut c_void, *const Host, *const Value, u32) -> i32;
pub type Plan = unsafe extern "C" fn(*mut c_void, *const Host, *const PlanIn, *mut PlanOut) -> i32;
pub type Step = unsafe extern "C" fn(*mut c_void, *const Host, *const StepIn, *mut StepOut) -> i32;
/// Returns 0 if the planner can be stopped immediately, 1 if it needs a few more steps.
pub type Stopping = unsafe extern "C" fn(*mut c_void, *const Host) -> u32;
pub type Snapshot = unsafe extern "C" fn(*mut c_void, *const Host) -> i32;
pub type Restore = unsafe extern "C" fn(*mut c_void, *const Host, u32, *const u8, usize) -> i32;
/// Returns the function table of an optional extension by name, or null.
pub type GetExtension = unsafe extern "C" fn(Str) -> *const c_void;

/// One planner. The functions are optional so that a null pointer causes an error message rather than undefined
/// behaviour.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Planner {
    pub size: u32,
    pub caps: u32,
    pub state_version: u32,
    pub reserved: u32,
    pub id: Str,
    pub name: Str,
    pub version: Str,
    pub about: Str,
    pub describe: Option<Describe>,
    pub create: Option<Create>,
    pub destroy: Option<Destroy>,
    pub plan: Option<Plan>,
    pub step: Option<Step>,
    pub reconfigure: Option<Reconfigure>,
    pub stopping: Option<Stopping>,
    pub snapshot: Option<Snapshot>,
    pub restore: Option<Restore>,
    pub get_extension: Option<GetExtension>,
}

/// The one exported symbol. It is data rather than a function, so the console can read it before it calls anything.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    pub magic: [u8; 8],
    pub abi_major: u32,
    pub abi_minor: u32,
    pub size: u32,
    pub n_planners: u32,
    pub planners: *const *const Planner,
    pub built_with: Str,
}

/// The stamp, in a separate section. The console reads it from the file before it loads the library.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stamp {
    pub magic: [u8; 8],
    pub abi_major: u32,
    pub abi_minor: u32,
}

/// The content of the stamp's section in a Rust library: the stamp, followed by the planner ids, each terminated by a
/// zero byte. The console reads the ids from it before it loads anything. If a library lists no ids there (libraries
/// written in C do not), the console searches the whole file for the ids.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Label<const N: usize> {
    pub stamp: Stamp,
    pub ids: [u8; N],
}

/// The list of planners that [`Entry::planners`] points to.
#[repr(transparent)]
#[derive(Debug)]
pub struct PlannerList<const N: usize>(pub [*const Planner; N]);

// SAFETY: immutable; the pointers point to immutable statics.
unsafe impl Sync for Entry {}
// SAFETY: as above.
unsafe impl Sync for Planner {}
// SAFETY: as above.
unsafe impl<const N: usize> Sync for PlannerList<N> {}
// SAFETY: consists of numbers, raw pointers and optional functions, and begins with its size.
unsafe impl Sized32 for Host {}
// SAFETY: as above.
unsafe impl Sized32 for Planner {}

impl Stamp {
    /// The stamp of libraries built with this crate.
    pub const CURRENT: Self = Self { magic: super::MAGIC, abi_major: super::MAJOR, abi_minor: super::MINOR };
}

impl<const N: usize> Label<N> {
    /// The label of a library built with this crate; `N` must be [`label_len`] of the same ids.
    pub const fn of(of: &[&str]) -> Self {
        let mut ids = [0; N];
        let (mut at, mut i) = (0, 0);
        while i < of.len() {
            let bytes = of[i].as_bytes();
            let mut k = 0;
            while k < bytes.len() {
                ids[at + k] = bytes[k];
                k += 1;
            }
            at += bytes.len() + 1;
            i += 1;
        }
        Self { stamp: Stamp::CURRENT, ids }
    }
}

/// The number of bytes that these ids take up in a [`Label`].
pub const fn label_len(ids: &[&str]) -> usize {
    let (mut n, mut i) = (0, 0);
    while i < ids.len() {
        n += ids[i].len() + 1;
        i += 1;
    }
    n
}

impl<const N: usize> PlannerList<N> {
    /// The entry of a library with these planners.
    pub const fn entry(&'static self) -> Entry {
        Entry {
            magic: super::MAGIC,
            abi_major: super::MAJOR,
            abi_minor: super::MINOR,
            size: size_of::<Entry>() as u32,
            n_planners: N as u32,
            planners: self.0.as_ptr(),
            built_with: Str::of(concat!("planner-api ", env!("CARGO_PKG_VERSION"))),
        }
    }
}
