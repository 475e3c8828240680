//! Why two surveys are not compared.

/// The reason why two surveys are not compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The second survey is not after the first one.
    #[error("the second survey must be later than the first one; swap the runs, or correct their dates")]
    NotLater,
    /// The shells differ in kind or size.
    #[error("the tanks differ: the shell is {first} in the first survey and {second} in the second one")]
    Shell {
        /// The shell in the first survey.
        first: String,
        /// The shell in the second survey.
        second: String,
    },
    /// The numbers of columns differ.
    #[error(
        "the tanks differ: the drawing has {first} columns in the first survey and {second} in the second one"
    )]
    Columns {
        /// Number of columns in the first survey.
        first: usize,
        /// Number of columns in the second survey.
        second: usize,
    },
    /// A landmark of the first survey has no counterpart in the second one.
    #[error(
        "the tanks differ: {landmark} of the first survey has no counterpart within {tolerance_m} m in the second \
         one; the nearest is {nearest_m:.2} m away"
    )]
    NoCounterpart {
        /// The landmark.
        landmark: String,
        /// Distance to the nearest landmark of that kind and size, metres.
        nearest_m: f64,
        /// The largest distance allowed, metres.
        tolerance_m: f64,
    },
    /// The landmarks fit in more than one way.
    #[error(
        "the columns fit turned by {first_deg:.1}° and by {second_deg:.1}°, so the two frames cannot be matched; \
         draw both surveys in one frame"
    )]
    Ambiguous {
        /// The first turn that fits, degrees.
        first_deg: f64,
        /// The second one, degrees.
        second_deg: f64,
    },
    /// The plates differ.
    #[error("the tanks differ: {0}")]
    Plates(String),
    /// The nominal thicknesses differ, so the depths cannot be compared.
    #[error(
        "the nominal thickness is {first_mm} mm in the first survey and {second_mm} mm in the second one; depths are \
         measured from it, so they cannot be compared"
    )]
    Thickness {
        /// Nominal thickness in the first survey, millimetres.
        first_mm: f64,
        /// Nominal thickness in the second survey, millimetres.
        second_mm: f64,
    },
    /// So many indications lie within their position errors of each other that no match can be decided.
    #[error(
        "{0} indications lie so close to each other that the position errors do not tell them apart; compare the \
         thickness of the plates instead"
    )]
    TooDense(usize),
}
