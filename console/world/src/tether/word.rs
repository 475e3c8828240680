//! The crossing word: which rays a way crossed, and in which sense, with everything undone left out.
//!
//! One ray leaves each obstacle, all in one direction, so they never meet. Two ways with the same ends can be turned
//! into each other without lifting the cable over an obstacle exactly if their reduced words are equal (the word is
//! an element of the free group over the obstacles). Cheap and exact, but it knows neither lengths nor angles.

use crate::geometry::{Point, Vector};

/// Bearing of the rays: none that drawings have.
const BEARING_RAD: f64 = 1.134_567_891;

/// One crossing: the obstacle whose ray it was, and whether it was crossed counter-clockwise about the obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Letter {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Counter-clockwise.
    pub ccw: bool,
}

/// The freely reduced crossing word of a way.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Word {
    letters: Vec<Letter>,
}

impl Word {
    /// The word of a whole way.
    pub fn of(way: &[Point], hearts: &[Point]) -> Self {
        let mut word = Self::default();
        way.windows(2).for_each(|pair| word.go(pair[0], pair[1], hearts));
        word
    }

    /// Takes one straight piece of the way; `hearts` are the points that the rays leave.
    pub fn go(&mut self, from: Point, to: Point, hearts: &[Point]) {
        let ray = Vector::new(BEARING_RAD.cos(), BEARING_RAD.sin());
        // How far clockwise of the ray through the origin a point lies.
        let aside = |p: &Point| -ray.perp(&p.coords);
        let (start, end) = (aside(&from), aside(&to));
        let mut crossed: Vec<(f64, Letter)> = Vec::new();
        for (obstacle, heart) in hearts.iter().enumerate() {
            let here = aside(heart);
            if (start <= here) == (end <= here) {
                continue;
            }
            let share = (here - start) / (end - start);
            if ray.dot(&(from + (to - from) * share - heart)) > 0.0 {
                crossed.push((share, Letter { obstacle, ccw: end < start }));
            }
        }
        crossed.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, letter) in crossed {
            self.append(letter);
        }
    }

    fn append(&mut self, letter: Letter) {
        let undone = Letter { ccw: !letter.ccw, ..letter };
        if self.letters.last() == Some(&undone) {
            self.letters.pop();
        } else {
            self.letters.push(letter);
        }
    }

    /// The letters, first crossing first.
    pub fn letters(&self) -> &[Letter] {
        &self.letters
    }

    /// Whether everything crossed has been undone.
    pub fn is_empty(&self) -> bool {
        self.letters.is_empty()
    }
}
