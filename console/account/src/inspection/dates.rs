//! Dates in texts written by people.

use std::fmt;

/// A day of the calendar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Date {
    year: u32,
    month: u32,
    day: u32,
}

impl Date {
    /// Reads `2027-03-31`, or `2027-03` as the last day of that month; `None` for anything else.
    ///
    /// ```
    /// use account::Date;
    /// assert_eq!(Date::read("2028-02"), Date::read("2028-02-29"));
    /// assert!(Date::read("2027-02-29").is_none() && Date::read("next year").is_none());
    /// ```
    pub fn read(text: &str) -> Option<Self> {
        let parts: Vec<&str> = text.trim().split('-').collect();
        let number = |part: &str, digits: usize| {
            let is_number = part.len() == digits && part.bytes().all(|byte| byte.is_ascii_digit());
            is_number.then(|| part.parse().ok()).flatten()
        };
        let (year, month) = (number(parts.first()?, 4)?, number(parts.get(1)?, 2)?);
        let last = last_day(year, month)?;
        let day = match parts.get(2) {
            Some(day) => number(day, 2)?,
            None => last,
        };
        (parts.len() <= 3 && (1..=last).contains(&day)).then_some(Self { year, month, day })
    }

    /// Finds the last day that a text names after a word such as `until`: in `valid to 2027-05`, or in `expires 2019`
    /// (the end of the year).
    pub fn until(text: &str) -> Option<Self> {
        let lower = text.to_lowercase();
        let words: Vec<&str> = lower
            .split(|letter: char| !(letter.is_alphanumeric() || letter == '-'))
            .filter(|word| !word.is_empty())
            .collect();
        let is_end = |word: &&str| UNTIL.contains(word);
        let dated = |(at, word): (usize, &&str)| {
            let is_last = words[at.saturating_sub(2)..at].iter().any(is_end);
            let year = word.len() == 4 && word.starts_with(['1', '2']);
            let date = Self::read(word).or_else(|| Self::read(&format!("{word}-12")).filter(|_| year));
            date.filter(|_| is_last)
        };
        words.iter().enumerate().filter_map(dated).max()
    }
}

/// Words that precede a last day.
const UNTIL: [&str; 12] = [
    "until",
    "till",
    "to",
    "through",
    "thru",
    "expires",
    "expired",
    "expiry",
    "expiration",
    "ends",
    "end",
    "bis",
];

fn last_day(year: u32, month: u32) -> Option<u32> {
    let is_leap = year.is_multiple_of(4) && !year.is_multiple_of(100) || year.is_multiple_of(400);
    match month {
        1 | 3 | 5 | 7 | 8 | 10 | 12 => Some(31),
        4 | 6 | 9 | 11 => Some(30),
        2 => Some(if is_leap { 29 } else { 28 }),
        _ => None,
    }
}

impl fmt::Display for Date {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04}-{:02}-{:02}", self.year, self.month, self.day)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_certificate_is_read_out_of_its_text() {
        let end = |text: &str| Date::until(text).map(|date| date.to_string());
        assert_eq!(end("MT-2 no. 8812, valid until 2027-03").as_deref(), Some("2027-03-31"));
        assert_eq!(end("UT-2 1234, valid to 2027-05-02").as_deref(), Some("2027-05-02"));
        assert_eq!(end("Level 2, expired 2019").as_deref(), Some("2019-12-31"));
        assert_eq!(end("expiry date: 2020-01-15").as_deref(), Some("2020-01-15"));
        assert_eq!(end("issued 2019-03-01, valid from 2019-04 to 2024-03").as_deref(), Some("2024-03-31"));
        assert_eq!((end("UT-2 no. 2019"), end("issued 2019-03-01")), (None, None));
    }
}
