//! How a long call is watched and stopped from another thread.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Progress of a batch, and the word to stop it; shared between the threads that work and the one that waits.
#[derive(Debug, Default)]
pub struct Control {
    stop: AtomicBool,
    done: AtomicUsize,
}

impl Control {
    /// Asks the batch to end: what is finished stays, what is under way is given up within a few samples.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to end.
    #[inline]
    #[must_use]
    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Lanes that are finished.
    #[must_use]
    pub fn done(&self) -> usize {
        self.done.load(Ordering::Relaxed)
    }

    /// Counts lanes that are finished.
    pub(super) fn add(&self, lanes: usize) {
        self.done.fetch_add(lanes, Ordering::Relaxed);
    }
}
