//! A node in the domain, and its subscriptions.

use super::about;
use crate::{
    bridge::Input,
    config::{Config, Durability, Qos, Reliability},
    types::{Bool, Float64, Typed},
};
use futures::{StreamExt, executor::block_on};
use ros2_client::dds::rustdds::{GUID, Topic};
use ros2_client::{
    Context, ContextOptions, MessageTypeName, Name, Node, NodeName, NodeOptions, QosProfile, Subscription,
    qos::{self, History, WhenFull},
};
use std::{env, pin::pin, sync::mpsc::SyncSender, thread, time::Duration};

/// Longest time for which a command waits for a robot that does not accept it.
const FULL_FOR: Duration = Duration::from_millis(5);

/// A node in the domain.
pub(super) struct Joined {
    pub(super) node: Node,
    context: Context,
}

impl Joined {
    pub(super) fn join(config: &Config) -> Result<Self, String> {
        let options = ContextOptions::new().domain_id(domain(config.domain)?);
        let context = Context::with_options(options).map_err(about("the DDS participant"))?;
        let name = NodeName::new("/", &config.node).map_err(about("node"))?;
        let options = NodeOptions::new().enable_rosout(false).start_parameter_services(false);
        let mut node = context.new_node(name, options).map_err(about("the ROS node"))?;
        let spinner = node.spinner().map_err(about("the ROS node"))?;
        thread::spawn(|| block_on(spinner.spin()));
        Ok(Self { node, context })
    }

    /// The types, as DDS spells them, of the subscriptions to a topic, except those of the participant `ours`.
    pub(super) fn types_of_readers(&self, name: &str, ours: GUID) -> Vec<String> {
        let (ours, name) = (ours.prefix, format!("rt{name}"));
        let readers = self.context.domain_participant().discovered_readers();
        let data = readers.iter().map(|reader| &reader.subscription_topic_data);
        let of_others = data.filter(|data| data.key().prefix != ours && *data.topic_name() == name);
        of_others.map(|data| data.type_name().clone()).collect()
    }

    pub(super) fn topic<M: Typed>(&self, name: &str, qos: Qos) -> Result<Topic, String> {
        let (package, kind) = M::TYPE;
        let parsed = Name::parse(name).map_err(about(name))?;
        let created = self.node.create_topic(&parsed, MessageTypeName::new(package, kind), &profile(qos));
        created.map_err(about(name))
    }

    pub(super) fn subscribe_all(
        &mut self,
        config: &Config,
        inputs: &SyncSender<Input>,
    ) -> Result<(), String> {
        if let Some(of) = &config.odometry {
            self.subscribe(&of.topic, of.qos, inputs, |odometry| Input::Odometry(Box::new(odometry)))?;
        }
        if let Some(of) = &config.tf {
            self.subscribe(&of.topic, of.qos, inputs, Input::Tf)?;
        }
        if let Some(of) = &config.scan {
            self.subscribe(&of.topic, of.qos, inputs, |scan| Input::Scan(Box::new(scan)))?;
        }
        if let Some(of) = &config.ae {
            self.subscribe(&of.topic, of.qos, inputs, Input::Ranges)?;
        }
        if let Some(of) = &config.tether {
            self.subscribe(&of.topic, of.qos, inputs, |length: Float64| Input::Tether(length.data))?;
        }
        if let Some(of) = &config.contact {
            self.subscribe(&of.topic, of.qos, inputs, |is_pressed: Bool| Input::Contact(is_pressed.data))?;
        }
        if let Some(of) = &config.battery {
            self.subscribe(&of.topic, of.qos, inputs, |battery| Input::Battery(Box::new(battery)))?;
        }
        if let Some(of) = &config.emergency_stop {
            self.subscribe(&of.topic, of.qos, inputs, |is_on: Bool| Input::EmergencyStop(is_on.data))?;
        }
        if let Some(of) = &config.manual {
            self.subscribe(&of.topic, of.qos, inputs, |is_on: Bool| Input::Manual(is_on.data))?;
        }
        Ok(())
    }

    fn subscribe<M: Typed + Send + 'static>(
        &mut self,
        name: &str,
        qos: Qos,
        inputs: &SyncSender<Input>,
        to: impl Fn(M) -> Input + Send + 'static,
    ) -> Result<(), String> {
        let topic = self.topic::<M>(name, qos)?;
        let subscription = self.node.create_subscription::<M>(&topic, None).map_err(about(name))?;
        let (name, inputs) = (name.to_owned(), inputs.clone());
        thread::spawn(move || block_on(listen(&name, &subscription, &inputs, to)));
        Ok(())
    }
}

async fn listen<M: Typed + 'static>(
    name: &str,
    subscription: &Subscription<M>,
    inputs: &SyncSender<Input>,
    to: impl Fn(M) -> Input,
) {
    let mut samples = pin!(subscription.async_stream());
    while let Some(sample) = samples.next().await {
        let input = match sample {
            Ok((message, _)) => to(message),
            Err(error) => Input::Unreadable(format!("{name}: {error}")),
        };
        if inputs.send(input).is_err() {
            return;
        }
    }
}

/// The domain of the settings, or of the environment.
fn domain(of_settings: Option<u16>) -> Result<u16, String> {
    if let Some(domain) = of_settings {
        return Ok(domain);
    }
    match env::var("ROS_DOMAIN_ID") {
        Ok(text) => text.trim().parse().map_err(|_| format!("ROS_DOMAIN_ID: `{text}` is not a number")),
        Err(_) => Ok(0),
    }
}

fn profile(of: Qos) -> QosProfile {
    let profile = QosProfile::subscription_default()
        .history(History::KeepLast { depth: usize::from(of.depth) })
        .durability(match of.durability {
            Durability::Volatile => qos::Durability::Volatile,
            Durability::TransientLocal => qos::Durability::TransientLocal,
        });
    match of.reliability {
        Reliability::Reliable => profile.reliability_reliable(WhenFull::Wait(FULL_FOR)),
        Reliability::BestEffort => profile.reliability_best_effort(),
    }
}
