//! Laws of the legend: it names what the map shows at every size.

use crate::fixture::{PLAIN, RICH};
use crate::maps::of_lanes;
use crate::screens::{drawn, text};
use tui::Msg;

/// The largest number of lines that stand beside each other in a row of the map.
fn lines_beside(shown: &str) -> usize {
    let map = |row: &str| -> String { row.chars().skip(1).take_while(|letter| *letter != '│').collect() };
    let is_dots = |letter: char| ('\u{2801}'..='\u{28ff}').contains(&letter);
    let groups = |row: &str| {
        let dots: Vec<bool> = map(row).chars().map(is_dots).collect();
        usize::from(dots.first().is_some_and(|first| *first))
            + dots.windows(2).filter(|pair| !pair[0] && pair[1]).count()
    };
    shown.lines().map(groups).max().unwrap_or(0)
}

#[test]
fn a_map_that_leaves_lanes_out_says_so_at_every_size() {
    let (mut thinned, mut whole) = (0, 0);
    for (lane_m, lanes) in [(0.3, 61), (0.4, 46), (0.5, 37), (0.6, 31), (0.8, 23), (1.2, 16)] {
        let mut screen = of_lanes(lane_m, lanes);
        for (width, height) in (100..=200).step_by(10).flat_map(|w| (28..=60).step_by(4).map(move |h| (w, h)))
        {
            screen.send(Msg::Resize { width, height });
            for caps in [RICH, PLAIN] {
                let shown = text(&drawn(&screen.model, caps, (width, height)));
                let is_thinned = lines_beside(&shown) < lanes as usize * 6 / 10;
                let at = format!("{lanes} lanes at {width}x{height}:\n{shown}");
                assert_eq!(shown.contains("plan, every "), is_thinned, "{at}");
                if is_thinned { thinned += 1 } else { whole += 1 }
            }
        }
    }
    assert!(thinned > 100 && whole > 100, "{thinned} thinned, {whole} whole");
}
