//! The last `n` samples of a stream, pooled without ever subtracting one: an outlier leaves no trace when it leaves.
//!
//! The stream is cut into segments as long as the window. Every window is the end of one segment and the start of the
//! next; the ends are pooled once, backwards, when a segment is complete, the start grows with each sample. Three
//! joins per sample on average; the sample that completes a segment pays for `n` of them.
//!
//! Source: van Herk, Pattern Recognition Letters 13 (1992) 517; Gil, Werman, IEEE PAMI 15 (1993) 504, for extremes;
//! here for any pool that can be joined.

use crate::error::Error;

/// What is known of several samples, and can be joined.
pub(crate) trait Pool: Copy {
    /// One sample.
    type Sample: Copy;
    /// The pool of one.
    fn of(sample: Self::Sample) -> Self;
    /// Both; where a pool has an origin, this one's stays.
    fn join(&self, other: &Self) -> Self;
}

/// A window over a stream.
#[derive(Debug, Clone)]
pub(crate) struct Window<P: Pool> {
    length: usize,
    /// The samples of the complete segment and of the one that grows.
    before: Vec<P::Sample>,
    growing: Vec<P::Sample>,
    /// `ends[i]` pools the complete segment from sample `i` on.
    ends: Vec<P>,
    start: Option<P>,
}

/// The longest window: its memory is then about a gigabyte.
pub const LONGEST: usize = 10_000_000;

impl<P: Pool> Window<P> {
    pub(crate) fn new(length: usize) -> Result<Self, Error> {
        if !(1..=LONGEST).contains(&length) {
            return Err(Error::OutOfRange {
                name: "window",
                value: length as f64,
                interval: format!("[1, {LONGEST}]"),
            });
        }
        Ok(Self {
            length,
            before: Vec::with_capacity(length),
            growing: Vec::with_capacity(length),
            ends: Vec::with_capacity(length),
            start: None,
        })
    }

    pub(crate) fn length(&self) -> usize {
        self.length
    }

    pub(crate) fn push(&mut self, sample: P::Sample) {
        self.growing.push(sample);
        if self.growing.len() == self.length {
            self.complete();
        } else {
            let one = P::of(sample);
            self.start = Some(self.start.map_or(one, |start| start.join(&one)));
        }
    }

    fn complete(&mut self) {
        std::mem::swap(&mut self.before, &mut self.growing);
        self.growing.clear();
        self.start = None;
        self.ends.clear();
        // From the newest backwards: the newest sample, the origin, is part of every window these ends belong to.
        let mut pooled: Option<P> = None;
        for sample in self.before.iter().rev() {
            let one = P::of(*sample);
            let next = pooled.map_or(one, |p| p.join(&one));
            self.ends.push(next);
            pooled = Some(next);
        }
        self.ends.reverse();
    }

    /// The last samples, as many as the window holds or as there were; None of nothing.
    pub(crate) fn pool(&self) -> Option<P> {
        match (self.ends.get(self.growing.len()), self.start) {
            (Some(end), Some(start)) => Some(start.join(end)),
            (Some(end), None) => Some(*end),
            (None, start) => start,
        }
    }

    /// The samples that rebuild this object when pushed into a new one.
    pub(crate) fn samples(&self) -> impl Iterator<Item = P::Sample> {
        self.before.iter().chain(&self.growing).copied()
    }
}
