//! Filtered columns kept for the next model that needs them: a search varies one effect at a time.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::effects::Contact;

/// So many bytes are kept, but at least and at most so many entries: a model has five to ten columns of which a search
/// varies one or two at a time; the grids of all candidates together have some 250 points.
const BYTES: usize = 16 << 20;
const FEWEST: usize = 48;
const MOST: usize = 256;

/// What a column depends on: the effect, its inner parameters and, for friction, the contact; floats by their bits.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Key {
    effect: &'static str,
    inner: Vec<u64>,
    contact: Option<[u64; 3]>,
}

impl Key {
    /// The key of an effect; `contact` where its columns depend on it.
    pub fn new(effect: &'static str, inner: &[f64], contact: Option<&Contact>) -> Self {
        Self {
            effect,
            inner: inner.iter().map(|v| v.to_bits()).collect(),
            contact: contact.map(|c| {
                [
                    c.breakaway.to_bits(),
                    c.gap.to_bits(),
                    u64::from(c.exponential),
                ]
            }),
        }
    }
}

/// A bounded store, shared by threads.
#[derive(Debug)]
pub struct Cache<V>(Mutex<Store<V>>);

#[derive(Debug)]
struct Store<V> {
    kept: HashMap<Key, (Arc<V>, u64)>,
    clock: u64,
    capacity: usize,
}

impl<V> Cache<V> {
    /// A cache for values of `samples` numbers each.
    pub fn new(samples: usize) -> Self {
        let bytes = (samples * size_of::<f64>()).max(1);
        Self(Mutex::new(Store {
            kept: HashMap::new(),
            clock: 0,
            capacity: (BYTES / bytes).clamp(FEWEST, MOST),
        }))
    }

    /// Returns what is kept under the key, or makes and keeps it. Made outside the lock: two threads may both make it.
    ///
    /// # Errors
    /// What `make` returns.
    pub fn get<E>(&self, key: Key, make: impl FnOnce() -> Result<V, E>) -> Result<Arc<V>, E> {
        if let Some(found) = self.store().look_up(&key) {
            return Ok(found);
        }
        let made = Arc::new(make()?);
        self.store().keep(key, Arc::clone(&made));
        Ok(made)
    }

    fn store(&self) -> MutexGuard<'_, Store<V>> {
        // A panic elsewhere leaves a store that is whole: it only holds finished values.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<V> Store<V> {
    fn look_up(&mut self, key: &Key) -> Option<Arc<V>> {
        self.clock += 1;
        let stamp = self.clock;
        self.kept.get_mut(key).map(|(value, last)| {
            *last = stamp;
            Arc::clone(value)
        })
    }

    fn keep(&mut self, key: Key, value: Arc<V>) {
        if self.kept.len() >= self.capacity {
            let oldest = self.kept.iter().min_by_key(|(_, (_, stamp))| *stamp);
            if let Some(oldest) = oldest.map(|(k, _)| k.clone()) {
                self.kept.remove(&oldest);
            }
        }
        self.clock += 1;
        self.kept.insert(key, (value, self.clock));
    }
}

#[cfg(test)]
mod tests {
    use super::{Cache, FEWEST, Key};

    #[test]
    fn what_was_used_last_stays() {
        let cache = Cache::new(usize::MAX / 64);
        let make = |v: f64| move || Ok::<_, ()>(v);
        let first = Key::new("a", &[0.0], None);
        cache.get(first.clone(), make(0.0)).unwrap();
        for i in 1..2 * FEWEST {
            cache
                .get(Key::new("b", &[i as f64], None), make(1.0))
                .unwrap();
            let again = cache
                .get(first.clone(), || -> Result<f64, ()> {
                    unreachable!("kept")
                })
                .unwrap();
            assert_eq!(*again, 0.0);
        }
    }
}
