//! What a mark on the screen stands for, and how each terminal shows it.

use crate::caps::{Caps, Colours};
use ratatui::style::{Color, Modifier, Style};

/// Makes the roles, each with the letter for it in the stored screens of the tests.
macro_rules! roles {
    ($($(#[$doc:meta])* $role:ident $letter:literal,)*) => {
        /// What a mark on the screen stands for. The view speaks only in roles.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Role {
            $($(#[$doc])* $role,)*
        }

        impl Role {
            /// Every role.
            pub const ALL: [Self; [$($letter),*].len()] = [$(Self::$role),*];

            /// One letter for the role, as the stored screens of the tests show it.
            pub fn letter(self) -> char {
                [$($letter),*][self as usize]
            }
        }
    };
}

roles! {
    /// Plain text.
    Text '.',
    /// Text of less weight: units, hints.
    Dim 'd',
    /// Title of a pane.
    Title 'T',
    /// Frame of a pane.
    Border 'b',
    /// Frame of the pane that takes the arrow keys.
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
    /// The robot moves by itself.
    Run 'R',
    /// The robot is held.
    Hold 'H',
    /// A value older than it should be.
    Stale '~',
    /// The selected line of a list.
    Selected 's',
    /// The line that asks before the robot moves.
    Confirm 'c',
    /// Floor that has been scanned.
    Scanned '%',
    /// Floor of which a part has been scanned.
    Partly ':',
    /// Floor that has been scanned again.
    Overlap '2',
    /// Floor in reach that was not scanned when the mission ended.
    Missed 'm',
    /// Floor out of reach.
    Unreachable '/',
    /// Floor out of reach along the shell.
    Margin 'n',
    /// Outline and name of a plate.
    Plate 'P',
    /// The tank's wall.
    Wall 'o',
    /// An obstacle of the drawing.
    Obstacle '#',
    /// An obstacle that was discovered.
    Found '?',
    /// A no-go zone.
    NoGo 'z',
    /// An acoustic-emission station.
    Station '*',
    /// Where the robot has been.
    Trail '-',
    /// Where the plan leads.
    Plan 'p',
    /// Where another plan leads, for comparison.
    Ghost 'G',
    /// Where the robot goes next.
    Target 'x',
    /// What the planner drew: pulls.
    Pull '+',
    /// What the planner drew: pushes.
    Push '=',
    /// What the planner drew: anything else.
    Drawn 'D',
    /// The robot.
    Robot '@',
    /// The tether.
    Tether 't',
}

/// The style of every role.
#[derive(Debug, Clone, PartialEq)]
pub struct Theme {
    styles: [Style; Role::ALL.len()],
}

impl Theme {
    /// The styles for a terminal: its own colours where it has few, never one it does not have.
    pub fn for_caps(caps: &Caps) -> Self {
        Self { styles: Role::ALL.map(|role| style(role, caps.colours)) }
    }

    /// Gives each role a colour that no other has, so that [`Theme::role_of`] can distinguish them.
    pub fn labelled() -> Self {
        Self { styles: Role::ALL.map(|role| Style::new().fg(Color::Indexed(16 + role as u8))) }
    }

    /// For a screen drawn with [`Theme::labelled`]: what a colour stands for.
    pub fn role_of(colour: Color) -> Option<Role> {
        Role::ALL.into_iter().find(|role| colour == Color::Indexed(16 + *role as u8))
    }

    /// How text of a role looks.
    pub fn style(&self, role: Role) -> Style {
        self.styles[role as usize]
    }

    /// The colour in which a role is drawn on the map.
    pub fn color(&self, role: Role) -> Color {
        self.style(role).fg.unwrap_or(Color::Reset)
    }
}

fn style(role: Role, colours: Colours) -> Style {
    let plain = Style::new().add_modifier(weight(role));
    match colours {
        Colours::None => plain,
        Colours::Sixteen => sixteen(role).map_or(plain, |color| plain.fg(color)),
        Colours::Indexed => rich(role)
            .map_or_else(|| style(role, Colours::Sixteen), |(index, _)| plain.fg(Color::Indexed(index))),
        Colours::True => rich(role).map_or_else(
            || style(role, Colours::Sixteen),
            |(_, (red, green, blue))| plain.fg(Color::Rgb(red, green, blue)),
        ),
    }
}

/// What is left of a role without colour.
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

fn sixteen(role: Role) -> Option<Color> {
    match role {
        Role::Good | Role::Run => Some(Color::Green),
        Role::Watch | Role::Key | Role::Focus => Some(Color::Cyan),
        Role::Warn | Role::Hold | Role::Confirm => Some(Color::Yellow),
        Role::Crit | Role::Push | Role::Missed => Some(Color::Red),
        Role::Scanned => Some(Color::Blue),
        Role::Partly | Role::Unreachable | Role::Margin | Role::Plate => Some(Color::DarkGray),
        Role::Overlap => Some(Color::LightBlue),
        Role::Obstacle | Role::NoGo => Some(Color::LightRed),
        Role::Found | Role::Drawn => Some(Color::LightMagenta),
        Role::Tether => Some(Color::White),
        Role::Station | Role::Trail => Some(Color::LightCyan),
        Role::Plan | Role::Target => Some(Color::LightYellow),
        Role::Ghost => Some(Color::Magenta),
        Role::Pull => Some(Color::LightGreen),
        _ => None,
    }
}

/// Colours of the map where there are enough of them: of the palette of 256, and as red, green, blue.
fn rich(role: Role) -> Option<(u8, (u8, u8, u8))> {
    match role {
        Role::Scanned => Some((24, (26, 74, 104))),
        Role::Partly => Some((236, (38, 50, 58))),
        Role::Overlap => Some((31, (46, 116, 156))),
        Role::Missed => Some((203, (255, 107, 96))),
        Role::Unreachable | Role::Margin => Some((242, (108, 108, 108))),
        Role::Plate => Some((66, (95, 135, 135))),
        Role::Trail => Some((117, (130, 205, 235))),
        Role::Plan => Some((179, (214, 175, 95))),
        Role::Ghost => Some((177, (199, 155, 255))),
        Role::Obstacle => Some((209, (240, 128, 100))),
        Role::Tether => Some((255, (250, 250, 235))),
        Role::Found => Some((213, (240, 130, 220))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::Glyphs;

    fn theme(colours: Colours) -> Theme {
        Theme::for_caps(&Caps { colours, glyphs: Glyphs::Braille, ssh: false })
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
}
