//! The colours of the themes.

use super::{Role, ThemeName};

/// Red, green and blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rgb(pub u8, pub u8, pub u8);

const fn rgb_of(hex: u32) -> Rgb {
    Rgb((hex >> 16) as u8, (hex >> 8) as u8, hex as u8)
}

/// The colour of a role.
pub(super) fn rgb(role: Role, name: ThemeName) -> Rgb {
    // The dark, light and high-contrast themes.
    let [dark, light, contrast] = match role {
        Role::Text | Role::Title | Role::Selected | Role::Wall | Role::Robot => {
            [0xd8_dee4, 0x1f_2328, 0xff_ffff]
        }
        Role::Dim | Role::Border | Role::Stale => [0x8b_98a5, 0x59_636e, 0xc8_c8c8],
        Role::Good | Role::Run | Role::Pull => [0x6c_c070, 0x11_6329, 0x00_ff66],
        Role::Watch | Role::Key | Role::Focus | Role::Plate => [0x5c_c8d8, 0x0b_6e8a, 0x00_e5ff],
        Role::Warn | Role::Hold | Role::Confirm => [0xe0_b040, 0x8a_5a00, 0xff_d000],
        Role::Crit | Role::Push | Role::Missed => [0xff_6b60, 0xc0_1c28, 0xff_8a80],
        Role::Scanned => [0x2f_7fb0, 0x4f_92be, 0x2a_62d0],
        Role::Ground => [0x1a_4a68, 0xb6_dcf2, 0x00_3a94],
        Role::Overlap => [0x58_aee0, 0x2f_6f9f, 0x6a_a4ff],
        Role::Unreachable | Role::Margin => [0x78_7878, 0x8a_8a8a, 0x80_8080],
        Role::Untestable => [0x9a_7ad0, 0x90_70c8, 0x9a_7ad0],
        Role::Ghost => [0xc7_9bff, 0x6a_3fb5, 0xd9_b3ff],
        Role::Partly => [0x5f_8296, 0x74_8e9d, 0x5a_6f94],
        Role::Trail | Role::Station => [0x82_cdeb, 0x0a_5a8a, 0x7f_e8ff],
        Role::Plan | Role::Target => [0xd6_af5f, 0x7d_4e00, 0xff_d000],
        Role::Tether => [0xfa_faeb, 0x00_0000, 0xff_ffff],
        Role::Obstacle | Role::NoGo => [0xf0_8064, 0x98_2c12, 0xff_9a7a],
        Role::Found | Role::Drawn => [0xf0_82dc, 0x9c_1f8a, 0xff_7af0],
    };
    rgb_of(match name {
        ThemeName::Dark => dark,
        ThemeName::Light => light,
        ThemeName::Contrast => contrast,
    })
}

/// The levels of the 6x6x6 cube in the 256-colour palette.
const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];

/// The nearest colour in the cube and greys of the 256-colour palette.
pub(super) fn nearest_indexed(colour: Rgb) -> u8 {
    let cube = (0..216_u8).map(|at| {
        let level = |digit: u8| LEVELS[usize::from(digit % 6)];
        (16 + at, Rgb(level(at / 36), level(at / 6), level(at)))
    });
    let greys = (0..24_u8).map(|at| (232 + at, Rgb(8 + 10 * at, 8 + 10 * at, 8 + 10 * at)));
    let all = cube.chain(greys);
    all.min_by_key(|(_, known)| distance(*known, colour)).map_or(15, |(index, _)| index)
}

/// The contrast of two colours, 1 to 21 (WCAG 2.2, relative luminance).
pub(super) fn contrast(one: Rgb, other: Rgb) -> f64 {
    let (one, other) = (luminance(one), luminance(other));
    (one.max(other) + 0.05) / (one.min(other) + 0.05)
}

fn luminance(Rgb(red, green, blue): Rgb) -> f64 {
    let linear = |part: u8| {
        let part = f64::from(part) / 255.0;
        if part <= 0.040_45 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * linear(red) + 0.7152 * linear(green) + 0.0722 * linear(blue)
}

fn distance(one: Rgb, other: Rgb) -> u32 {
    let square = |one: u8, other: u8| u32::from(one.abs_diff(other)).pow(2);
    square(one.0, other.0) + square(one.1, other.1) + square(one.2, other.2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::{Caps, Colours, Glyphs};
    use crate::theme::Theme;
    use ratatui::style::Color;

    /// The lightest and the darkest background for which a theme is made.
    fn backgrounds(name: ThemeName) -> [Rgb; 2] {
        match name {
            ThemeName::Dark => [rgb_of(0), rgb_of(0x28_2c34)],
            ThemeName::Light => [rgb_of(0xff_ffff), rgb_of(0xfd_f6e3)],
            ThemeName::Contrast => [rgb_of(0), rgb_of(0)],
        }
    }

    #[test]
    fn the_contrast_of_black_and_white_is_21() {
        assert!((contrast(rgb_of(0), rgb_of(0xff_ffff)) - 21.0).abs() < 1e-9);
    }

    #[test]
    fn text_can_be_read_on_every_background_of_its_theme() {
        for name in ThemeName::ALL {
            for role in Role::ALL.into_iter().filter(|role| !is_fill(*role)) {
                for background in backgrounds(name) {
                    let contrast = contrast(rgb(role, name), background);
                    assert!(contrast >= 4.5, "{role:?} in {name:?}: {contrast:.2} on {background:?}");
                }
            }
        }
    }

    /// A colour as the terminal shows it; the sixteen colours are those of xterm. `None` for the colour of plain text.
    fn shown(color: Color) -> Option<Rgb> {
        Some(match color {
            Color::Rgb(red, green, blue) => Rgb(red, green, blue),
            Color::Indexed(at @ 16..=231) => {
                let level = |digit: u8| LEVELS[usize::from(digit % 6)];
                Rgb(level((at - 16) / 36), level((at - 16) / 6), level(at - 16))
            }
            Color::Indexed(at) => Rgb(8 + 10 * (at - 232), 8 + 10 * (at - 232), 8 + 10 * (at - 232)),
            Color::Red => Rgb(205, 0, 0),
            Color::Green => Rgb(0, 205, 0),
            Color::Yellow => Rgb(205, 205, 0),
            Color::Blue => Rgb(0, 0, 238),
            Color::Magenta => Rgb(205, 0, 205),
            Color::Cyan => Rgb(0, 205, 205),
            Color::Gray => Rgb(229, 229, 229),
            Color::DarkGray => Rgb(127, 127, 127),
            Color::LightRed => Rgb(255, 0, 0),
            Color::LightGreen => Rgb(0, 255, 0),
            Color::LightYellow => Rgb(255, 255, 0),
            Color::LightBlue => Rgb(92, 92, 255),
            Color::LightMagenta => Rgb(255, 0, 255),
            Color::LightCyan => Rgb(0, 255, 255),
            Color::White => Rgb(255, 255, 255),
            Color::Black => Rgb(0, 0, 0),
            Color::Reset => return None,
        })
    }

    #[test]
    fn text_can_be_read_with_every_number_of_colours() {
        for (name, colours) in ThemeName::ALL.into_iter().flat_map(|name| {
            [Colours::Sixteen, Colours::Indexed, Colours::True].map(|colours| (name, colours))
        }) {
            let theme = Theme::new(name, &Caps { colours, glyphs: Glyphs::Braille, ssh: false });
            // With sixteen colours, the terminal's background is one of them.
            let [lightest, darkest] = backgrounds(name);
            let grounds = if colours == Colours::Sixteen { [lightest; 2] } else { [lightest, darkest] };
            for role in Role::ALL.into_iter().filter(|role| !is_fill(*role)) {
                let Some(text) = shown(theme.color(role)) else { continue };
                for ground in grounds {
                    let contrast = contrast(text, ground);
                    assert!(
                        contrast >= 4.5,
                        "{role:?} in {name:?}, {colours:?}: {contrast:.2} on {ground:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn lines_can_be_seen_on_scanned_floor() {
        for name in ThemeName::ALL {
            for role in [Role::Trail, Role::Plan, Role::Tether, Role::Obstacle, Role::Found, Role::Ghost] {
                let contrast = contrast(rgb(role, name), rgb(Role::Ground, name));
                assert!(contrast >= 3.4, "{role:?} in {name:?}: {contrast:.2}");
            }
        }
    }

    #[test]
    fn floor_on_the_map_stands_out_from_the_background() {
        for (name, colours) in ThemeName::ALL.into_iter().flat_map(|name| {
            [Colours::Sixteen, Colours::Indexed, Colours::True].map(|colours| (name, colours))
        }) {
            let theme = Theme::new(name, &Caps { colours, glyphs: Glyphs::Braille, ssh: false });
            let [lightest, darkest] = backgrounds(name);
            let grounds = if colours == Colours::Sixteen { [lightest; 2] } else { [lightest, darkest] };
            let fills = Role::ALL.into_iter().filter(|role| is_fill(*role) && *role != Role::Ground);
            for (role, ground) in fills.flat_map(|role| grounds.map(|ground| (role, ground))) {
                let Some(fill) = shown(theme.color(role)) else { continue };
                let contrast = contrast(fill, ground);
                assert!(contrast >= 3.0, "{role:?} in {name:?}, {colours:?}: {contrast:.2} on {ground:?}");
            }
        }
    }

    fn is_fill(role: Role) -> bool {
        matches!(
            role,
            Role::Scanned
                | Role::Ground
                | Role::Partly
                | Role::Overlap
                | Role::Unreachable
                | Role::Margin
                | Role::Untestable
        )
    }

    #[test]
    fn the_palette_of_256_has_something_near() {
        for (hex, index) in [(0x00_0000, 16), (0xff_ffff, 231), (0x8b_98a5, 246), (0x1a_4a68, 23)] {
            assert_eq!(nearest_indexed(rgb_of(hex)), index, "{hex:06x}");
        }
    }
}
