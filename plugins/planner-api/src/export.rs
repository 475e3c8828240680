//! Turns types that implement [`Planner`] into the symbol that the console looks for.

use crate::abi::{self, Str};
use crate::{Kind, ParamSpec, Planner, glue};

/// Exports planners from a crate of type `cdylib`. A plugin needs no other boilerplate.
///
/// The author's crate may `#![forbid(unsafe_code)]`. Ids and parameters are checked at compile time. See [`Planner`]
/// for an example.
#[macro_export]
macro_rules! export_planners {
    ($($planner:ty),+ $(,)?) => {
        const _: () = {
            static PLANNERS: $crate::abi::PlannerList<{ [$(stringify!($planner)),+].len() }> =
                $crate::abi::PlannerList([$({
                    static TABLE: $crate::abi::Planner = $crate::export::table::<$planner>(env!("CARGO_PKG_VERSION"));
                    &raw const TABLE
                }),+]);

            #[unsafe(no_mangle)]
            #[allow(non_upper_case_globals)]
            pub static tank_planner_entry: $crate::abi::Entry = PLANNERS.entry();

            const IDS: &[&str] = &[$(<$planner as $crate::Planner>::ID),+];

            #[used]
            #[cfg_attr(any(target_os = "macos", target_os = "ios"), unsafe(link_section = "__DATA,__tankplan"))]
            #[cfg_attr(windows, unsafe(link_section = ".tankpln"))]
            #[cfg_attr(
                not(any(windows, target_os = "macos", target_os = "ios")),
                unsafe(link_section = ".tankplan")
            )]
            static LABEL: $crate::abi::Label<{ $crate::abi::label_len(IDS) }> = $crate::abi::Label::of(IDS);
        };
    };
}

/// Builds the function table of one planner. An id or a parameter that the console would refuse does not compile.
#[doc(hidden)]
pub const fn table<P: Planner>(version: &'static str) -> abi::Planner {
    assert!(is_id(P::ID), "a planner's ID must be 1 to 32 characters from a-z, 0-9, _ and -");
    let mut i = 0;
    while i < P::PARAMS.len() {
        assert!(!P::PARAMS[i].key.is_empty(), "a parameter has no key");
        assert!(default_fits(&P::PARAMS[i]), "the default of a parameter is outside its range");
        i += 1;
    }
    abi::Planner {
        size: size_of::<abi::Planner>() as u32,
        caps: P::CAPS.0,
        state_version: P::STATE_VERSION,
        reserved: 0,
        id: Str::of(P::ID),
        name: Str::of(P::NAME),
        version: Str::of(version),
        about: Str::of(P::ABOUT),
        describe: Some(glue::describe::<P>),
        create: Some(glue::create::<P>),
        destroy: Some(glue::destroy::<P>),
        plan: Some(glue::plan::<P>),
        step: Some(glue::step::<P>),
        reconfigure: Some(glue::reconfigure::<P>),
        stopping: Some(glue::stopping::<P>),
        snapshot: Some(glue::snapshot::<P>),
        restore: Some(glue::restore::<P>),
        get_extension: None,
    }
}

/// Whether a string is a valid planner id: 1 to 32 characters from a-z, 0-9, `_` and `-`.
///
/// ```
/// use planner_api::export::is_id;
///
/// assert!(is_id("apf-dwa") && is_id("planner_2"));
/// assert!(!is_id("") && !is_id("Straight") && !is_id("two words"));
/// ```
pub const fn is_id(id: &str) -> bool {
    let bytes = id.as_bytes();
    let mut i = 0;
    while i < bytes.len() {
        if !matches!(bytes[i], b'a'..=b'z' | b'0'..=b'9' | b'_' | b'-') {
            return false;
        }
        i += 1;
    }
    !bytes.is_empty() && bytes.len() <= 32
}

const fn default_fits(spec: &ParamSpec) -> bool {
    match spec.kind {
        Kind::Float { min, max, default } => min <= default && default <= max,
        Kind::Int { min, max, default } => min <= default && default <= max,
        Kind::Flag { .. } => true,
        Kind::Choice { options, default } => default < options.len() && are_words(options),
    }
}

/// Words are joined by `|` when they cross the boundary, so no word may contain that character.
const fn are_words(options: &[&str]) -> bool {
    let mut i = 0;
    while i < options.len() {
        let bytes = options[i].as_bytes();
        let mut k = 0;
        while k < bytes.len() {
            if bytes[k] == b'|' {
                return false;
            }
            k += 1;
        }
        if bytes.is_empty() {
            return false;
        }
        i += 1;
    }
    true
}
