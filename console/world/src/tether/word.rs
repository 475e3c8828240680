//! The crossing word: which rays a way crossed, and in which sense, with everything undone left out.
//!
//! One ray leaves each obstacle, all in one direction, so they never meet. Two ways with the same ends can be turned
//! into each other without lifting the cable over an obstacle exactly if their reduced words are equal (the word is
//! an element of the free group over the obstacles). Cheap and exact, but it knows neither lengths nor angles.

use geometry::{Point, Vector};

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

/// One point within each obstacle, from which its ray leaves, ready to be asked which rays a move crosses.
#[derive(Debug, Clone)]
pub struct Rays {
    ray: Vector,
    /// How far clockwise of the ray through the origin each lies, least first; with its obstacle.
    sorted: Vec<(f64, usize, Point)>,
}

impl Rays {
    /// Rays from these points; the obstacles are their indices.
    pub fn new(hearts: &[Point]) -> Self {
        let ray = Vector::new(BEARING_RAD.cos(), BEARING_RAD.sin());
        let mut sorted: Vec<(f64, usize, Point)> =
            hearts.iter().enumerate().map(|(k, heart)| (-ray.perp(&heart.coords), k, *heart)).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { ray, sorted }
    }

    fn aside(&self, point: Point) -> f64 {
        -self.ray.perp(&point.coords)
    }
}

impl Word {
    /// The word of a whole way.
    pub fn of(way: &[Point], rays: &Rays) -> Self {
        let mut word = Self::default();
        way.windows(2).for_each(|pair| word.go(pair[0], pair[1], rays));
        word
    }

    /// Takes one straight piece of the way.
    pub fn go(&mut self, from: Point, to: Point, rays: &Rays) {
        let (start, end) = (rays.aside(from), rays.aside(to));
        let until = |bound: f64| rays.sorted.partition_point(|(here, ..)| *here < bound);
        let passed = &rays.sorted[until(start.min(end))..until(start.max(end))];
        let cross = |(here, obstacle, heart): &(f64, usize, Point)| {
            let share = (here - start) / (end - start);
            let is_crossed = rays.ray.dot(&(from + (to - from) * share - heart)) > 0.0;
            is_crossed.then_some(Letter { obstacle: *obstacle, ccw: end < start })
        };
        // The way back meets the rays in exactly the other order, those that lie on each other too: all is undone.
        if end < start {
            passed.iter().rev().filter_map(cross).for_each(|letter| self.append(letter));
        } else {
            passed.iter().filter_map(cross).for_each(|letter| self.append(letter));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_is_the_empty_word_also_where_obstacles_share_their_middle() {
        let hearts =
            [Point::new(1.0, 2.0), Point::new(1.0, 2.0), Point::new(-1.0, 0.5), Point::new(1.0, 2.0)];
        let rays = Rays::new(&hearts);
        let way = [Point::new(-6.0, 4.0), Point::new(9.0, 6.0), Point::new(9.0, -5.0), Point::new(-6.0, 4.5)];
        assert!(Word::of(&way[..2], &rays).letters().len() >= 3);
        let back = way.iter().rev().skip(1);
        let there_and_back: Vec<Point> = way.iter().chain(back).copied().collect();
        assert!(Word::of(&there_and_back, &rays).is_empty());
    }
}
