//! The limits on what the console accepts from a worker. The plugin can write to the socket, too, so the console trusts
//! nothing that it has not checked itself. It checks counts and lengths while reading, before it reserves memory, and
//! it checks numbers.

use crate::Progress;
use foreign::plain;
use mission::Sandbox;
use planner_api::{Drawing, LogLevel, abi};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// The maximum number of planners in a library.
pub(crate) const MOST_PLANNERS: usize = 64;
/// The maximum numbers of elements of each kind in one answer.
pub(crate) const MOST_PARAMS: usize = 256;
pub(crate) const MOST_DRAWINGS: usize = 4096;
pub(crate) const MOST_SCALARS: usize = 256;
/// The maximum number of log messages of the planner in one answer; the worker may add one more message.
pub(crate) const MOST_LOGS: usize = 64;
pub(crate) const MOST_POINTS: usize = 1_000_000;
pub(crate) const MOST_CUTS: usize = 10_000;
/// The maximum number of words that a choice parameter may have: as many as fit into a text with separators between
/// them.
pub(crate) const MOST_OPTIONS: usize = LONGEST_TEXT;
/// The maximum length of a text, bytes; the texts that workers send are shorter.
const LONGEST_TEXT: usize = 16 << 10;
/// The maximum number of elements for which memory is reserved before they are read.
const RESERVED: usize = 1024;

struct AtMost<T, const MOST: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de>, const MOST: usize> Visitor<'de> for AtMost<T, MOST> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at most {MOST} elements")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Vec<T>, A::Error> {
        let mut all = Vec::with_capacity(elements.size_hint().unwrap_or(0).min(MOST).min(RESERVED));
        while let Some(element) = elements.next_element()? {
            if all.len() == MOST {
                return Err(A::Error::custom("too many elements"));
            }
            all.push(element);
        }
        Ok(all)
    }
}

/// Reads a list of at most `MOST` elements.
pub(crate) fn at_most<'de, D: Deserializer<'de>, T: Deserialize<'de>, const MOST: usize>(
    from: D,
) -> Result<Vec<T>, D::Error> {
    from.deserialize_seq(AtMost::<T, MOST>(PhantomData))
}

/// A text that is safe to display because it contains no control characters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Text(pub(crate) String);

impl<'de> Deserialize<'de> for Text {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        shown(<&str>::deserialize(from)?)
    }
}

fn shown<E: Error>(text: &str) -> Result<Text, E> {
    if text.len() > LONGEST_TEXT {
        return Err(E::custom("text too long"));
    }
    Ok(Text(plain(text).into_owned()))
}

/// Reads a text that is safe to display.
pub(crate) fn text<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    Text::deserialize(from).map(|Text(text)| text)
}

/// Reads the words of a choice parameter.
pub(crate) fn words<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<String>, D::Error> {
    let words = at_most::<_, Text, MOST_OPTIONS>(from)?;
    Ok(words.into_iter().map(|Text(word)| word).collect())
}

/// Reads drawings; all their numbers must be finite.
pub(crate) fn drawings<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Drawing>, D::Error> {
    let drawings = at_most::<_, Drawing, MOST_DRAWINGS>(from)?;
    let are_finite = drawings.iter().all(|drawing| abi::Draw::from(drawing).get().is_some());
    if are_finite {
        Ok(drawings)
    } else {
        Err(D::Error::custom("a drawing with a number that is not finite"))
    }
}

/// Reads figures; all their values must be finite.
pub(crate) fn scalars<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(String, f64, String)>, D::Error> {
    let scalars = at_most::<_, (Text, f64, Text), MOST_SCALARS>(from)?;
    if !scalars.iter().all(|(_, value, _)| value.is_finite()) {
        return Err(D::Error::custom("a figure that is not finite"));
    }
    Ok(scalars.into_iter().map(|(Text(name), value, Text(unit))| (name, value, unit)).collect())
}

/// Reads log messages.
pub(crate) fn logs<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(LogLevel, String)>, D::Error> {
    const MOST: usize = MOST_LOGS + 1;
    let logs = at_most::<_, (LogLevel, Text), MOST>(from)?;
    Ok(logs.into_iter().map(|(level, Text(message))| (level, message)).collect())
}

/// Reads the extent of a worker's sandbox; the reason must be safe to display.
pub(crate) fn sandbox<'de, D: Deserializer<'de>>(from: D) -> Result<Sandbox, D::Error> {
    Ok(match Sandbox::deserialize(from)? {
        Sandbox::Full => Sandbox::Full,
        Sandbox::Partial(why) => Sandbox::Partial(shown(&why)?.0),
        Sandbox::None(why) => Sandbox::None(shown(&why)?.0),
    })
}

/// Reads a share from 0 to 1.
pub(crate) fn share<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    let share = f64::deserialize(from)?;
    if (0.0..=1.0).contains(&share) { Ok(share) } else { Err(D::Error::custom("not a share from 0 to 1")) }
}

/// Reads the activity of a planner, which must fit on one line.
pub(crate) fn doing<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    let what = text(from)?;
    let is_short = what.chars().count() <= Progress::LONGEST;
    if is_short { Ok(what) } else { Err(D::Error::custom("text too long")) }
}
