//! The roles of marks on the screen, and how each terminal displays them.

mod colours;

use crate::caps::{Caps, Colours};
use colours::{Rgb, contrast, nearest_indexed};
use ratatui::style::{Color, Modifier, Style};
use serde::{Deserialize, Serialize};

/// Defines the roles, each with its letter in the screen snapshots of the tests.
macro_rules! roles {
    ($($(#[$doc:meta])* $role:ident $letter:literal,)*) => {
        /// The role of a mark on the screen. The view refers to roles only, never to colours.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Role {
            $($(#[$doc])* $role,)*
        }

        impl Role {
            /// Every role.
            pub const ALL: [Self; [$($letter),*].len()] = [$(Self::$role),*];

            /// The letter of the role in the screen snapshots of the tests.
            pub fn letter(self) -> char {
                [$($letter),*][self as usize]
            }
        }
    };
}

roles! {
    /// Plain text.
    Text '.',
    /// Less prominent text: units, hints.
    Dim 'd',
    /// Title of a pane.
    Title 'T',
    /// Frame of a pane.
    Border 'b',
    /// Frame of the pane that responds to the arrow keys.
    Focus 'F',
    /// Name of a key.
    Key 'k',
    /// All is well.
    Good 'g',
    /// Worth watching.
    Watch 'w',
    /// Needs attention.
    Warn 'W',
    /// Needs action now.
    Crit 'C',
    /// The robot moves automatically.
    Run 'R',
    /// The robot is held.
    Hold 'H',
    /// A stale value.
    Stale '~',
    /// The selected line of a list.
    Selected 's',
    /// The line that asks for confirmation before the robot moves.
    Confirm 'c',
    /// Floor that has been scanned.
    Scanned '%',
    /// The background of lines on scanned floor.
    Ground 'q',
    /// Partially scanned floor.
    Partly ':',
    /// Floor that has been scanned more than once.
    Overlap '2',
    /// Reachable floor that was not scanned when the mission ended.
    Missed 'm',
    /// Unreachable floor.
    Unreachable '/',
    /// The shell margin.
    Margin 'n',
    /// Floor that the tool cannot test.
    Untestable 'u',
    /// Outline and name of a plate.
    Plate 'P',
    /// The tank's wall.
    Wall 'o',
    /// An obstacle on the drawing.
    Obstacle '#',
    /// A found obstacle.
    Found '?',
    /// A no-go zone.
    NoGo 'z',
    /// An acoustic-emission station.
    Station '*',
    /// The robot's trail.
    Trail '-',
    /// The path of the plan.
    Plan 'p',
    /// The path of another plan, for comparison.
    Ghost 'G',
    /// The robot's next target.
    Target 'x',
    /// A planner drawing: attraction.
    Pull '+',
    /// A planner drawing: repulsion.
    Push '=',
    /// A planner drawing: neither attraction nor repulsion.
    Drawn 'D',
    /// The robot.
    Robot '@',
    /// The tether.
    Tether 't',
}

/// A colour theme.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ThemeName {
    /// For a dark background.
    #[default]
    Dark,
    /// For a light background.
    Light,
    /// For a black background and poor light or eyesight.
    Contrast,
}

impl ThemeName {
    /// Every theme.
    pub const ALL: [Self; 3] = [Self::Dark, Self::Light, Self::Contrast];

    /// The theme's name in configuration and commands.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dark => "dark",
            Self::Light => "light",
            Self::Contrast => "contrast",
        }
    }

    /// The theme with the given name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|theme| theme.name() == name)
    }

    /// The theme for a background colour: red, green and blue.
    pub fn on([red, green, blue]: [u8; 3]) -> Self {
        let background = Rgb(red, green, blue);
        let is_light = contrast(background, Rgb(0, 0, 0)) > contrast(background, Rgb(255, 255, 255));
        if is_light { Self::Light } else { Self::Dark }
    }

    /// The theme for the background that the terminal reports in `COLORFGBG`, such as `0;15`; dark if the variable is
    /// not set.
    pub fn for_background(colorfgbg: Option<&str>) -> Self {
        let background = colorfgbg.and_then(|colours| colours.rsplit(';').next());
        match background.and_then(|number| number.parse().ok()) {
            Some(7 | 9..=15) => Self::Light,
            Some(0..=255_u8) | None => Self::Dark,
        }
    }
}

/// The style of every role.
#[derive(Debug, Clone, PartialEq)]
pub struct Theme {
    styles: [Style; Role::ALL.len()],
}

impl Theme {
    /// The styles for a terminal. A terminal with few colours gets its own colours, and no terminal gets a colour
    /// that it lacks.
    pub fn new(name: ThemeName, caps: &Caps) -> Self {
        Self { styles: Role::ALL.map(|role| style(role, name, caps.colours)) }
    }

    /// Gives each role a unique colour, so that [`Theme::role_of`] can tell the roles apart.
    pub fn labelled() -> Self {
        Self { styles: Role::ALL.map(|role| Style::new().fg(Color::Indexed(16 + role as u8))) }
    }

    /// The role of a colour on a screen drawn with [`Theme::labelled`].
    pub fn role_of(colour: Color) -> Option<Role> {
        Role::ALL.into_iter().find(|role| colour == Color::Indexed(16 + *role as u8))
    }

    /// The text style of a role.
    pub fn style(&self, role: Role) -> Style {
        self.styles[role as usize]
    }

    /// The colour of a role on the map.
    pub fn color(&self, role: Role) -> Color {
        self.style(role).fg.unwrap_or(Color::Reset)
    }
}

fn style(role: Role, name: ThemeName, colours: Colours) -> Style {
    let plain = Style::new().add_modifier(weight(role));
    // Colours already make the text less prominent; dimming it as well would make it too faint.
    let coloured = Style::new().add_modifier(weight(role) - Modifier::DIM);
    match colours {
        Colours::None => plain,
        Colours::Sixteen => sixteen(role, name).map_or(plain, |color| plain.fg(color)),
        Colours::Indexed => coloured.fg(Color::Indexed(nearest_indexed(colours::rgb(role, name)))),
        Colours::True => {
            let Rgb(red, green, blue) = colours::rgb(role, name);
            coloured.fg(Color::Rgb(red, green, blue))
        }
    }
}

/// The style of a role without colours.
fn weight(role: Role) -> Modifier {
    match role {
        Role::Crit | Role::Confirm => Modifier::BOLD | Modifier::REVERSED,
        Role::Selected => Modifier::REVERSED,
        Role::Title
        | Role::Focus
        | Role::Key
        | Role::Warn
        | Role::Missed
        | Role::Run
        | Role::Hold
        | Role::Station
        | Role::Robot => Modifier::BOLD,
        Role::Dim | Role::Border => Modifier::DIM,
        Role::Stale => Modifier::ITALIC,
        _ => Modifier::empty(),
    }
}

/// The terminal's own colours; on a light background, those that are dark enough to read in the palette of xterm.
fn sixteen(role: Role, name: ThemeName) -> Option<Color> {
    let color = sixteen_on_dark(role)?;
    if name != ThemeName::Light {
        return Some(color);
    }
    match color {
        Color::Cyan | Color::LightCyan | Color::Green | Color::LightGreen => Some(Color::Blue),
        Color::Yellow | Color::LightYellow | Color::LightMagenta => Some(Color::Magenta),
        Color::Blue => Some(Color::Cyan),
        Color::LightRed => Some(Color::Red),
        Color::White | Color::DarkGray => None,
        color => Some(color),
    }
}

fn sixteen_on_dark(role: Role) -> Option<Color> {
    match role {
        Role::Good | Role::Run => Some(Color::Green),
        Role::Watch | Role::Key | Role::Focus | Role::Overlap => Some(Color::Cyan),
        Role::Warn | Role::Hold | Role::Confirm => Some(Color::Yellow),
        Role::Crit | Role::Push | Role::Missed | Role::Obstacle | Role::NoGo => Some(Color::LightRed),
        Role::Scanned => Some(Color::LightBlue),
        Role::Ground => Some(Color::Blue),
        Role::Partly | Role::Unreachable | Role::Margin | Role::Plate => Some(Color::DarkGray),
        Role::Found | Role::Drawn | Role::Ghost | Role::Untestable => Some(Color::LightMagenta),
        Role::Tether => Some(Color::White),
        Role::Station | Role::Trail => Some(Color::LightCyan),
        Role::Plan | Role::Target => Some(Color::LightYellow),
        Role::Pull => Some(Color::LightGreen),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::Glyphs;

    fn theme(colours: Colours) -> Theme {
        Theme::new(ThemeName::Dark, &Caps { colours, glyphs: Glyphs::Braille, ssh: false })
    }

    #[test]
    fn every_role_has_its_own_place_and_letter() {
        for (index, role) in Role::ALL.into_iter().enumerate() {
            assert_eq!(role as usize, index);
            assert_eq!(Role::ALL.into_iter().filter(|other| other.letter() == role.letter()).count(), 1);
            assert_eq!(Theme::role_of(Theme::labelled().color(role)), Some(role));
        }
    }

    #[test]
    fn no_terminal_is_sent_a_colour_that_it_does_not_have() {
        for role in Role::ALL {
            let few = |color: Color| !matches!(color, Color::Rgb(..) | Color::Indexed(_));
            assert_eq!(theme(Colours::None).color(role), Color::Reset);
            assert!(few(theme(Colours::Sixteen).color(role)));
            assert!(!matches!(theme(Colours::Indexed).color(role), Color::Rgb(..)));
        }
    }

    #[test]
    fn selection_and_alarm_survive_without_colour() {
        let none = theme(Colours::None);
        assert!(none.style(Role::Selected).add_modifier.contains(Modifier::REVERSED));
        assert!(none.style(Role::Crit).add_modifier.contains(Modifier::BOLD));
    }

    #[test]
    fn a_background_gets_the_theme_that_can_be_read_on_it() {
        for (background, theme) in [
            ([0, 0, 0], ThemeName::Dark),
            ([0x28, 0x2c, 0x34], ThemeName::Dark),
            ([0x80, 0, 0], ThemeName::Dark),
            ([0xfd, 0xf6, 0xe3], ThemeName::Light),
            ([255, 255, 255], ThemeName::Light),
        ] {
            assert_eq!(ThemeName::on(background), theme, "{background:?}");
        }
    }

    #[test]
    fn the_background_is_read_from_colorfgbg() {
        for (answer, theme) in [
            (None, ThemeName::Dark),
            (Some(""), ThemeName::Dark),
            (Some("15;0"), ThemeName::Dark),
            (Some("0;15"), ThemeName::Light),
            (Some("0;default;7"), ThemeName::Light),
            (Some("12;8"), ThemeName::Dark),
            (Some("none"), ThemeName::Dark),
        ] {
            assert_eq!(ThemeName::for_background(answer), theme, "{answer:?}");
        }
    }
}
