//! The C ABI beneath the trait, as declared in `include/tankops_planner.h`, which documents every field.
//!
//! Rules of the boundary: neither side frees the other's memory. Inputs belong to the console and are valid only during
//! the call. Results are passed to the console's functions, which copy them before they return. Structs grow only at
//! the end and carry their writer's `size`. Enums cross the boundary as numbers, which are checked. No panic and no
//! exception may leave a planner's function.

pub mod input;
pub mod lend;
pub mod output;
pub mod table;

pub use input::{Obstacle, Outline, PlanIn, Site, StepIn, Zone};
pub use output::{Draw, Leg, Param, PlanOut, StepOut, Value};
pub use table::{Entry, Host, Label, Planner, PlannerList, Stamp, label_len};

/// The first bytes of the entry and of the stamp.
pub const MAGIC: [u8; 8] = *b"TANKPLAN";
/// The major version; the console refuses libraries with a different one.
pub const MAJOR: u32 = 1;
/// The minor version; raised when something is added at the end of a struct.
pub const MINOR: u32 = 5;
/// The one symbol that a library exports.
pub const SYMBOL: &str = "tank_planner_entry";
/// The name of the section that contains the stamp, as file readers report it on Linux, macOS and Windows.
pub const SECTIONS: [&str; 3] = [".tankplan", "__tankplan", ".tankpln"];

/// UTF-8 text without a terminating zero; it belongs to the side that passed it.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Str {
    /// Pointer to the first byte; may be null when `len` is zero.
    pub ptr: *const u8,
    /// The number of bytes.
    pub len: usize,
}

// SAFETY: in a static, a `Str` only ever points to a `&'static str`.
unsafe impl Sync for Str {}

impl Str {
    /// Lends a string; the pointer is valid for as long as the string exists.
    pub const fn of(text: &str) -> Self {
        Self { ptr: text.as_ptr(), len: text.len() }
    }

    /// Reads at most `most` bytes of the text, with invalid UTF-8 replaced.
    ///
    /// # Safety
    /// `ptr` is null or points to `len` readable bytes.
    pub unsafe fn to_text(self, most: usize) -> String {
        // SAFETY: promised by the caller.
        String::from_utf8_lossy(unsafe { slice(self.ptr, self.len.min(most)) }).into_owned()
    }
}

/// A point or vector in the tank frame, metres.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Vec2 {
    /// The east component.
    pub x: f64,
    /// The north component.
    pub y: f64,
}

impl From<nalgebra::Point2<f64>> for Vec2 {
    fn from(point: nalgebra::Point2<f64>) -> Self {
        Self { x: point.x, y: point.y }
    }
}

impl From<nalgebra::Vector2<f64>> for Vec2 {
    fn from(vector: nalgebra::Vector2<f64>) -> Self {
        Self { x: vector.x, y: vector.y }
    }
}

impl From<Vec2> for nalgebra::Point2<f64> {
    fn from(v: Vec2) -> Self {
        Self::new(v.x, v.y)
    }
}

impl From<Vec2> for nalgebra::Vector2<f64> {
    fn from(v: Vec2) -> Self {
        Self::new(v.x, v.y)
    }
}

/// A position and a heading.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// East, metres.
    pub x: f64,
    /// North, metres.
    pub y: f64,
    /// Heading, radians, counter-clockwise from east.
    pub heading: f64,
}

/// Borrows an array that was passed across the boundary; a null, empty or unaligned array becomes an empty slice.
///
/// # Safety
/// `ptr` is null or points to `len` readable values that do not change during `'a`.
pub unsafe fn slice<'a, T>(ptr: *const T, len: usize) -> &'a [T] {
    if ptr.is_null() || len == 0 || !ptr.is_aligned() {
        return &[];
    }
    // SAFETY: promised by the caller; null and unaligned pointers are handled above.
    unsafe { std::slice::from_raw_parts(ptr, len) }
}

/// A struct that begins with its writer's `size` and is valid when all its bytes are zero.
///
/// # Safety
/// Implement this trait only for `repr(C)` structs that begin with a `u32` size and consist of numbers, raw pointers
/// and `Option` function pointers.
pub unsafe trait Sized32: Copy {}

/// Copies a struct that may come from an older or newer writer; fields that the writer did not know are zero.
///
/// # Safety
/// `from` is aligned and points to a struct that begins with a `u32`, the number of its readable bytes.
pub unsafe fn copy_sized<T: Sized32>(from: *const T) -> T {
    let mut to = std::mem::MaybeUninit::<T>::zeroed();
    // SAFETY: the caller promises that the first `size` bytes are readable, and no more than the size of `T` is copied.
    // All-zero bytes are a valid `T` because it is `Sized32`.
    unsafe {
        let written = from.cast::<u32>().read() as usize;
        let n = written.min(size_of::<T>());
        std::ptr::copy_nonoverlapping(from.cast::<u8>(), to.as_mut_ptr().cast::<u8>(), n);
        to.assume_init()
    }
}

// The layout is the contract: code whose layout differs from the header must not compile. The header asserts the same
// numbers.
const _: () = {
    use std::mem::offset_of;
    assert!(size_of::<Str>() == 16 && size_of::<Vec2>() == 16 && size_of::<Pose>() == 24);
    assert!(size_of::<Outline>() == 24 && size_of::<Obstacle>() == 48 && size_of::<Zone>() == 32);
    assert!(size_of::<Site>() == 184 && offset_of!(Site, boundary) == 16);
    assert!(
        offset_of!(Site, obstacles) == 40 && offset_of!(Site, zones) == 56 && offset_of!(Site, motion) == 72
    );
    assert!(offset_of!(Site, acceleration) == 128 && offset_of!(Site, land_v_max) == 152);
    assert!(size_of::<PlanIn>() == 256 && offset_of!(PlanIn, covariance) == 48);
    assert!(offset_of!(PlanIn, targets) == 104 && offset_of!(PlanIn, site) == 136);
    assert!(offset_of!(PlanIn, regions) == 144 && offset_of!(PlanIn, reel) == 160);
    assert!(offset_of!(PlanIn, way) == 184 && offset_of!(PlanIn, way_cuts) == 208);
    assert!(offset_of!(PlanIn, pull_per_m) == 224 && offset_of!(PlanIn, preferred_pull) == 248);
    assert!(size_of::<StepIn>() == 176 && offset_of!(StepIn, target) == 120);
    assert!(offset_of!(StepIn, targets_ahead) == 136 && offset_of!(StepIn, obstacles) == 160);
    assert!(size_of::<PlanOut>() == 16 && size_of::<StepOut>() == 32 && size_of::<Draw>() == 48);
    assert!(size_of::<Param>() == 136 && offset_of!(Param, min) == 112 && size_of::<Value>() == 24);
    assert!(size_of::<Host>() == 120 && offset_of!(Host, scalar) == 80 && offset_of!(Host, legs) == 96);
    assert!(offset_of!(Host, progress) == 112);
    assert!(size_of::<Leg>() == 16);
    assert!(size_of::<Planner>() == 160 && offset_of!(Planner, describe) == 80);
    assert!(size_of::<Entry>() == 48 && offset_of!(Entry, planners) == 24 && size_of::<Stamp>() == 16);
    // Points are lent in place, without a conversion.
    assert!(
        size_of::<nalgebra::Point2<f64>>() == 16 && align_of::<nalgebra::Point2<f64>>() == align_of::<Vec2>()
    );
};
