//! The channels of the instrument: which of them are dead, and the parts of the tool that test the floor.
//!
//! One rule for the mission and for all readers of its events. Floor that a dead channel touches does not count as
//! scanned, however small the part of a cell is.

use crate::{config::MissionConfig, event::ChannelsJudged};
use world::{Tool, ToolPart};

/// The channels of the instrument of a mission.
///
/// ```
/// # use mission::{Channels, event::ChannelsJudged};
/// let mut channels = Channels::of(4, world::Tool::Bar { swath_m: 0.4 });
/// assert_eq!(channels.live(0.0).len(), 1);
/// channels.apply(&ChannelsJudged { dead: vec![1], count: 4 });
/// let widths_m: Vec<f64> = channels.live(0.0).iter().map(|part| part.tool().swath_m()).collect();
/// assert!((widths_m[0] - 0.1).abs() < 1e-12 && (widths_m[1] - 0.2).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Channels {
    /// Number of channels; 0 if it is not known.
    count: u16,
    tool: Tool,
    /// In ascending order.
    dead: Vec<u16>,
}

impl Channels {
    /// The channels of the instrument of a mission, all of them working.
    pub fn new(mission: &MissionConfig) -> Self {
        let sampling = mission.instrument.as_ref().and_then(|instrument| instrument.sampling);
        Self::of(sampling.map_or(0, |sampling| sampling.channels), mission.tool())
    }

    /// A number of working channels, evenly spaced across a tool; 0 if the number is not known.
    pub fn of(count: u16, tool: Tool) -> Self {
        Self { count, tool, dead: Vec::new() }
    }

    /// The dead channels, in ascending order.
    pub fn dead(&self) -> &[u16] {
        &self.dead
    }

    /// Number of channels; 0 if it is not known.
    pub fn count(&self) -> u16 {
        self.count
    }

    /// Whether a channel is dead.
    pub fn is_dead(&self, channel: u16) -> bool {
        self.dead.binary_search(&channel).is_ok()
    }

    /// Takes the channels that the instrument declares dead, in ascending order; `None` if it declares nothing. Returns
    /// the event if they are others than before.
    pub fn judge(&mut self, declared: Option<&[u16]>) -> Option<ChannelsJudged> {
        let dead = declared.filter(|dead| *dead != self.dead)?;
        self.dead = dead.to_vec();
        Some(ChannelsJudged { dead: dead.to_vec(), count: self.count })
    }

    /// Takes over a judgement from an event.
    pub fn apply(&mut self, judged: &ChannelsJudged) {
        self.dead.clone_from(&judged.dead);
    }

    /// The parts of the tool that test the floor, without what lies within `rim_m` metres of a dead channel. If a dead
    /// channel has no place, because the number of channels is not known or smaller, no part of the tool is trusted.
    pub fn live(&self, rim_m: f64) -> Vec<ToolPart> {
        if self.dead.iter().any(|channel| *channel >= self.count) {
            return Vec::new();
        }
        let stretches: Vec<[f64; 2]> = self.dead.iter().map(|channel| self.stretch(*channel)).collect();
        ToolPart::without(self.tool, &stretches, rim_m)
    }

    /// The dead channels, each with the part of the tool within `rim_m` metres of it: the whole tool for a channel
    /// without a place.
    pub fn blind(&self, rim_m: f64) -> Vec<(u16, ToolPart)> {
        let part = |channel: u16| {
            if channel >= self.count {
                return ToolPart::whole(self.tool);
            }
            let [from_m, to_m] = self.stretch(channel);
            let half_m = self.tool.swath_m() / 2.0;
            ToolPart::between(self.tool, [(from_m - rim_m).max(-half_m), (to_m + rim_m).min(half_m)])
        };
        self.dead.iter().map(|channel| (*channel, part(*channel))).collect()
    }

    /// The two ends of a channel, as distances from the middle of the tool, metres; positive to the left.
    fn stretch(&self, channel: u16) -> [f64; 2] {
        let width_m = self.tool.swath_m() / f64::from(self.count.max(1));
        let from_m = width_m * f64::from(channel) - self.tool.swath_m() / 2.0;
        [from_m, from_m + width_m]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOOL: Tool = Tool::Bar { swath_m: 0.6 };

    #[test]
    fn only_a_change_is_an_event() {
        let mut channels = Channels::of(20, TOOL);
        assert_eq!(channels.judge(None), None);
        assert_eq!(channels.judge(Some(&[])), None);
        assert_eq!(channels.judge(Some(&[3, 7])), Some(ChannelsJudged { dead: vec![3, 7], count: 20 }));
        assert_eq!(channels.judge(Some(&[3, 7])), None);
        assert_eq!(channels.judge(None), None, "without a declaration, the channels stay dead");
        assert!(channels.is_dead(7) && !channels.is_dead(4));
        assert_eq!(channels.judge(Some(&[])), Some(ChannelsJudged { dead: vec![], count: 20 }));
        assert_eq!(channels.live(0.04), [ToolPart::whole(TOOL)]);
    }

    #[test]
    fn live_and_blind_parts_divide_the_tool() {
        let mut channels = Channels::of(20, TOOL);
        channels.judge(Some(&[0, 9]));
        let width_m = |parts: Vec<ToolPart>| parts.iter().map(|part| part.tool().swath_m()).sum::<f64>();
        for rim_m in [0.0, 0.01] {
            let blind: Vec<ToolPart> = channels.blind(rim_m).into_iter().map(|(_, part)| part).collect();
            assert!((width_m(channels.live(rim_m)) + width_m(blind) - 0.6).abs() < 1e-12);
        }
    }

    #[test]
    fn a_dead_channel_without_a_place_leaves_no_part_of_the_tool() {
        for count in [0, 4] {
            let mut channels = Channels::of(count, TOOL);
            channels.judge(Some(&[4]));
            assert_eq!(channels.live(0.0), []);
            assert_eq!(channels.blind(0.0), [(4, ToolPart::whole(TOOL))]);
        }
    }
}
