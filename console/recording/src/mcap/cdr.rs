//! Common data representation: the binary layout of ROS 2 messages.

use super::ros::{FRAME, Pose3, Stamp};

/// Bytes before the content that do not count for alignment: "little endian, plain".
const HEAD: [u8; 4] = [0, 1, 0, 0];

/// A message under construction. Numbers are aligned to their size.
pub(super) struct Cdr(Vec<u8>);

impl Cdr {
    pub(super) fn new() -> Self {
        Self(HEAD.to_vec())
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.0
    }

    fn put<const N: usize>(mut self, bytes: [u8; N]) -> Self {
        while !(self.0.len() - HEAD.len()).is_multiple_of(N) {
            self.0.push(0);
        }
        self.0.extend(bytes);
        self
    }

    pub(super) fn u8(self, value: u8) -> Self {
        self.put([value])
    }

    pub(super) fn i8(self, value: i8) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn u32(self, value: u32) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn i32(self, value: i32) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn f32(self, value: f32) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn f64(self, value: f64) -> Self {
        self.put(value.to_le_bytes())
    }

    /// Writes the length including the final zero, then the bytes, then the zero.
    pub(super) fn text(self, text: &str) -> Self {
        let mut written = self.u32(text.len() as u32 + 1);
        written.0.extend(text.as_bytes());
        written.u8(0)
    }

    /// `std_msgs/Header` in the tank frame.
    pub(super) fn stamp(self, Stamp { sec, nanosec }: Stamp) -> Self {
        self.i32(sec).u32(nanosec).text(FRAME)
    }

    /// `geometry_msgs/Pose`.
    pub(super) fn pose(self, pose: Pose3) -> Self {
        pose.0.iter().fold(self, |written, value| written.f64(*value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_at_multiples_of_their_length_after_the_head() {
        let message = Cdr::new().u8(7).f64(1.0).text("ab").u32(1);
        let content = [
            vec![7, 0, 0, 0, 0, 0, 0, 0],
            1.0_f64.to_le_bytes().to_vec(),
            vec![3, 0, 0, 0, b'a', b'b', 0, 0],
            vec![1, 0, 0, 0],
        ];
        assert_eq!(message.bytes(), [HEAD.to_vec(), content.concat()].concat());
    }
}
