//! The stop service.

use super::about;
use crate::{
    bridge::Input,
    config::{Mapping, StopService},
    types::{TriggerRequest, TriggerResponse},
};
use ros2_client::{
    Name, Node, QosProfile, ServiceMapping, ServiceTypeName,
    qos::{History, WhenFull},
    service::Client,
};
use std::time::{Duration, Instant};

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_secs(1);

/// A client of the stop service.
pub(super) struct Stop {
    client: Client<TriggerRequest, TriggerResponse>,
    /// The time of the call, until the service has answered.
    called: Option<Instant>,
}

impl Stop {
    pub(super) fn create(node: &mut Node, stop: &StopService) -> Result<Self, String> {
        let name = Name::parse(&stop.service).map_err(about(&stop.service))?;
        let mapping = match stop.mapping {
            Mapping::Enhanced => ServiceMapping::Enhanced,
            Mapping::Cyclone => ServiceMapping::Cyclone,
            Mapping::Basic => ServiceMapping::Basic,
        };
        let qos = QosProfile::subscription_default()
            .history(History::KeepLast { depth: 10 })
            .reliability_reliable(WhenFull::Fail);
        let kind = ServiceTypeName::new("std_srvs", "Trigger");
        let client = node.create_client(mapping, &name, &kind, qos.clone(), qos);
        Ok(Self { client: client.map_err(about(&stop.service))?, called: None })
    }

    pub(super) fn call(&mut self) -> Option<Input> {
        match self.client.send_request(TriggerRequest::default()) {
            Ok(_) => {
                self.called = Some(Instant::now());
                None
            }
            Err(error) => Some(Input::StopAnswered(Err(error.to_string()))),
        }
    }

    pub(super) fn answer(&mut self) -> Option<Input> {
        let called = self.called?;
        let answer = match self.client.receive_response() {
            Ok(Some((_, response))) if response.success => Ok(()),
            Ok(Some((_, response))) => Err(response.message),
            Ok(None) if called.elapsed() < PATIENCE => return None,
            Ok(None) => Err("no answer within 1 s".to_owned()),
            Err(error) => Err(error.to_string()),
        };
        self.called = None;
        Some(Input::StopAnswered(answer))
    }
}
