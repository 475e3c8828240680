//! Numbers, texts and points as bytes.

use foreign::plain;
use nalgebra::{Matrix3, Point2};
use planner_api::PoseEstimate;

/// Longest text, bytes; what a worker sends is shorter.
const LONGEST_TEXT: usize = 16 << 10;

/// A frame under construction.
#[derive(Debug, Default)]
pub(crate) struct Writer(Vec<u8>);

impl Writer {
    /// Begins a frame, throwing away the one before.
    pub(crate) fn begin(&mut self, kind: u8, sequence: u32, soft_deadline_us: u32) -> &mut Self {
        self.0.clear();
        self.u32(0).u8(kind).u32(sequence).u32(soft_deadline_us)
    }

    /// The finished frame, or its length when that is beyond the limit.
    pub(crate) fn finish(&mut self) -> Result<&[u8], usize> {
        let length = self.0.len() - size_of::<u32>();
        if length > super::LONGEST {
            return Err(length);
        }
        self.0[..size_of::<u32>()].copy_from_slice(&(length as u32).to_le_bytes());
        Ok(&self.0)
    }

    /// The frame that was finished last.
    pub(crate) fn frame(&self) -> &[u8] {
        &self.0
    }

    /// What was written without a frame around it.
    pub(crate) fn into_bytes(self) -> Vec<u8> {
        self.0
    }

    /// Something that was written before.
    pub(crate) fn written(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.extend_from_slice(bytes);
        self
    }

    pub(crate) fn u8(&mut self, value: u8) -> &mut Self {
        self.0.push(value);
        self
    }

    pub(crate) fn flag(&mut self, value: bool) -> &mut Self {
        self.u8(u8::from(value))
    }

    pub(crate) fn u32(&mut self, value: u32) -> &mut Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    pub(crate) fn i32(&mut self, value: i32) -> &mut Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    pub(crate) fn u64(&mut self, value: u64) -> &mut Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    pub(crate) fn f64(&mut self, value: f64) -> &mut Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    pub(crate) fn bytes(&mut self, value: &[u8]) -> &mut Self {
        self.u32(value.len() as u32);
        self.0.extend_from_slice(value);
        self
    }

    pub(crate) fn text(&mut self, value: &str) -> &mut Self {
        self.bytes(value.as_bytes())
    }

    pub(crate) fn point(&mut self, value: &Point2<f64>) -> &mut Self {
        self.f64(value.x).f64(value.y)
    }

    pub(crate) fn vector(&mut self, value: &nalgebra::Vector2<f64>) -> &mut Self {
        self.f64(value.x).f64(value.y)
    }

    pub(crate) fn points(&mut self, values: &[Point2<f64>]) -> &mut Self {
        self.all(values, |w, point| {
            w.point(point);
        })
    }

    /// A count and then every item.
    pub(crate) fn all<T>(&mut self, items: &[T], mut write: impl FnMut(&mut Self, &T)) -> &mut Self {
        self.u32(items.len() as u32);
        for item in items {
            write(self, item);
        }
        self
    }

    pub(crate) fn pose(&mut self, pose: &PoseEstimate) -> &mut Self {
        self.point(&pose.position).f64(pose.heading_rad);
        for number in planner_api::abi::lend::covariance(&pose.covariance) {
            self.f64(number);
        }
        self
    }
}

/// A body that is not what its kind says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Malformed;

/// The rest of a body that is being read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Body<'a>(pub(crate) &'a [u8]);

/// What was read, or that it was not there.
pub(crate) type Read<T> = Result<T, Malformed>;

impl<'a> Body<'a> {
    fn take(&mut self, n: usize) -> Read<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(n).ok_or(Malformed)?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Read<[u8; N]> {
        let (taken, rest) = self.0.split_first_chunk().ok_or(Malformed)?;
        self.0 = rest;
        Ok(*taken)
    }

    pub(crate) fn u8(&mut self) -> Read<u8> {
        Ok(self.array::<1>()?[0])
    }

    pub(crate) fn flag(&mut self) -> Read<bool> {
        match self.u8()? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(Malformed),
        }
    }

    pub(crate) fn u32(&mut self) -> Read<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(crate) fn i32(&mut self) -> Read<i32> {
        self.array().map(i32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Read<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub(crate) fn f64(&mut self) -> Read<f64> {
        self.array().map(f64::from_le_bytes)
    }

    pub(crate) fn bytes(&mut self) -> Read<&'a [u8]> {
        let n = self.u32()? as usize;
        self.take(n)
    }

    /// A text that can be shown as it is.
    pub(crate) fn text(&mut self) -> Read<String> {
        let bytes = self.bytes()?;
        if bytes.len() > LONGEST_TEXT {
            return Err(Malformed);
        }
        std::str::from_utf8(bytes).map(|text| plain(text).into_owned()).map_err(|_| Malformed)
    }

    pub(crate) fn point(&mut self) -> Read<Point2<f64>> {
        Ok(Point2::new(self.f64()?, self.f64()?))
    }

    pub(crate) fn points(&mut self) -> Read<Vec<Point2<f64>>> {
        self.all(Self::point)
    }

    /// A count and then every item.
    pub(crate) fn all<T>(&mut self, mut read: impl FnMut(&mut Self) -> Read<T>) -> Read<Vec<T>> {
        let n = self.u32()? as usize;
        // Every item takes at least a byte: a count beyond the body is a lie and must not reserve memory.
        if n > self.0.len() {
            return Err(Malformed);
        }
        (0..n).map(|_| read(self)).collect()
    }

    /// A count that is not larger than this, and then every item.
    pub(crate) fn at_most<T>(&mut self, most: usize, read: impl FnMut(&mut Self) -> Read<T>) -> Read<Vec<T>> {
        let n = Self(self.0).u32()? as usize;
        if n > most { Err(Malformed) } else { self.all(read) }
    }

    pub(crate) fn pose(&mut self) -> Read<PoseEstimate> {
        let (position, heading_rad) = (self.point()?, self.f64()?);
        let mut next = || self.f64();
        let [xx, xy, xh, yy, yh, hh] = [next()?, next()?, next()?, next()?, next()?, next()?];
        let covariance = Matrix3::new(xx, xy, xh, xy, yy, yh, xh, yh, hh);
        Ok(PoseEstimate { position, heading_rad, covariance })
    }

    /// Ends the reading.
    pub(crate) fn end(self) -> Read<()> {
        if self.0.is_empty() { Ok(()) } else { Err(Malformed) }
    }
}
