//! Answers of the mission to a script's orders.

use mission::{EventKind, Order};
use tui::{Msg, RunMsg};

/// The orders that the mission has not answered yet, and the reason of the first refusal.
#[derive(Debug, Default)]
pub(super) struct Answers {
    awaited: Vec<Order>,
    refused: Option<String>,
}

impl Answers {
    /// Records orders that were sent.
    pub(super) fn await_for<'a>(&mut self, sent: impl IntoIterator<Item = &'a Order>) {
        self.awaited.extend(sent.into_iter().cloned());
    }

    /// Whether any order is not answered yet.
    pub(super) fn is_waiting(&self) -> bool {
        !self.awaited.is_empty()
    }

    /// The reason for the first refusal.
    pub(super) fn refusal(&self) -> Option<&str> {
        self.refused.as_deref()
    }

    /// Takes the answers in a message.
    pub(super) fn hear(&mut self, msg: &Msg) {
        let Msg::Run(_, msg) = msg else { return };
        match msg {
            RunMsg::Events(events) => events.iter().for_each(|event| self.take(&event.kind)),
            RunMsg::OrderFailed { order, why } => self.answer(order, Some(why)),
            // The mission is closed and gives no more answers.
            RunMsg::Closed(_) | RunMsg::OpenFailed(_) => self.awaited.clear(),
            _ => {}
        }
    }

    fn take(&mut self, event: &EventKind) {
        match event {
            EventKind::Ordered { order } => self.answer(order, None),
            EventKind::OrderRefused { order, why } => self.answer(order, Some(why)),
            EventKind::RunOpened(_) => self.awaited.clear(),
            _ => {}
        }
    }

    fn answer(&mut self, order: &Order, refused: Option<&String>) {
        let Some(index) = self.awaited.iter().position(|awaited| awaited == order) else { return };
        self.awaited.remove(index);
        if let Some(why) = refused {
            self.refused.get_or_insert_with(|| why.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::Event;
    use tui::model::RunId;

    fn says(kind: EventKind) -> Msg {
        Msg::Run(RunId::default(), RunMsg::Events(vec![Event { tick: 1, t_s: 0.1, kind }]))
    }

    #[test]
    fn every_order_is_waited_for_and_the_first_refusal_is_kept() {
        let mut answers = Answers::default();
        answers.await_for(&[Order::Hold, Order::Resume]);
        answers.hear(&says(EventKind::Ordered { order: Order::Abort }));
        answers.hear(&says(EventKind::Ordered { order: Order::Hold }));
        assert!(answers.is_waiting() && answers.refusal().is_none());
        answers.hear(&says(EventKind::OrderRefused { order: Order::Resume, why: "not held".into() }));
        assert!(!answers.is_waiting() && answers.refusal() == Some("not held"));
    }
}
