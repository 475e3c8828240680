//! The topic of commands: a publisher, and a subscription that detects commands of other programs.

use super::{about, joined::Joined, wall_clock};
use crate::{
    bridge::Input,
    config::{self, CommandType},
    types::{Header, Twist, TwistStamped, Typed, Vector3},
};
use ros2_client::{MessageTypeName, Publisher, Subscription};
use tankops_adapter::commands::Velocity;

/// The topic of commands, by its type.
pub(super) enum Commands {
    Plain(Both<Twist>),
    Stamped(Both<TwistStamped>, String),
}

impl Commands {
    pub(super) fn create(joined: &mut Joined, command: &config::Command) -> Result<Self, String> {
        Ok(match command.kind {
            CommandType::Twist => Self::Plain(Both::create(joined, command)?),
            CommandType::TwistStamped => Self::Stamped(Both::create(joined, command)?, command.frame.clone()),
        })
    }

    pub(super) fn publish(&self, velocity: Velocity) -> Result<(), String> {
        let twist = Twist {
            linear: Vector3 { x: velocity.forward_m_per_s, y: velocity.sideways_m_per_s, z: 0.0 },
            angular: Vector3 { z: velocity.turn_rad_per_s, ..Vector3::default() },
        };
        match self {
            Self::Plain(both) => both.publish(twist),
            Self::Stamped(both, frame) => {
                let header = Header { stamp: wall_clock(), frame_id: frame.clone() };
                both.publish(TwistStamped { header, twist })
            }
        }
    }

    pub(super) fn news(&self, joined: &Joined) -> Vec<Input> {
        match self {
            Self::Plain(both) => both.news(joined),
            Self::Stamped(both, _) => both.news(joined),
        }
    }
}

/// Both ends of a topic of commands.
pub(super) struct Both<M: Typed> {
    name: String,
    publisher: Publisher<M>,
    subscription: Subscription<M>,
}

impl<M: Typed + 'static> Both<M> {
    fn create(joined: &mut Joined, command: &config::Command) -> Result<Self, String> {
        let name = &command.topic;
        let topic = joined.topic::<M>(name, command.qos)?;
        let publisher = joined.node.create_publisher(&topic, None).map_err(about(name))?;
        // The subscription must match every publisher.
        let topic = joined.topic::<M>(name, config::Qos::of_sensors())?;
        let subscription = joined.node.create_subscription(&topic, None).map_err(about(name))?;
        Ok(Self { name: name.clone(), publisher, subscription })
    }

    fn publish(&self, message: M) -> Result<(), String> {
        self.publisher.publish(message).map_err(|error| format!("a command was not published: {error}"))
    }

    fn news(&self, joined: &Joined) -> Vec<Input> {
        let (node, (package, kind)) = (&joined.node, M::TYPE);
        let expected = MessageTypeName::new(package, kind).dds_msg_type();
        let types = joined.types_of_readers(&self.name, self.publisher.guid());
        let wrong_type = types.iter().find(|kind| **kind != expected).cloned();
        // The middleware matches by name and QoS only. The adapter's own ends match each other, too.
        let matched = self.publisher.get_subscription_count(node).saturating_sub(1);
        let mut news = vec![Input::Matched {
            subscriptions: types.iter().filter(|kind| **kind == expected).count().min(matched),
            publishers: self.subscription.get_publisher_count(node).saturating_sub(1),
            wrong_type,
        }];
        let ours = self.publisher.gid();
        while let Ok(Some((_, info))) = self.subscription.take() {
            if info.publisher_gid() != ours {
                news.push(Input::OtherCommand);
            }
        }
        news
    }
}
