//! Filtered columns kept for the next model that needs them: a search varies one effect at a time.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::Error;
use crate::effects::Contact;

/// The columns of one effect at full rate.
pub type Columns = Arc<Vec<Vec<f64>>>;

/// Columns are kept until this many of them are there; a model has five to ten, a search varies one or two at a time.
const CAPACITY: usize = 48;

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
#[derive(Debug, Default)]
pub struct Cache(Mutex<Store>);

#[derive(Debug, Default)]
struct Store {
    columns: HashMap<Key, (Columns, u64)>,
    clock: u64,
}

impl Cache {
    /// Returns what is kept under the key, or makes and keeps it. Made outside the lock: two threads may both make it.
    ///
    /// # Errors
    /// What `make` returns.
    pub fn get(
        &self,
        key: Key,
        make: impl FnOnce() -> Result<Vec<Vec<f64>>, Error>,
    ) -> Result<Columns, Error> {
        if let Some(found) = self.look_up(&key) {
            return Ok(found);
        }
        let made = Arc::new(make()?);
        // A panic elsewhere leaves a store that is whole: it only holds finished columns.
        let mut store = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if store.columns.len() >= CAPACITY {
            let oldest = store
                .columns
                .iter()
                .min_by_key(|(_, (_, stamp))| *stamp)
                .map(|(k, _)| k.clone());
            if let Some(oldest) = oldest {
                store.columns.remove(&oldest);
            }
        }
        store.clock += 1;
        let stamp = store.clock;
        store.columns.insert(key, (Arc::clone(&made), stamp));
        Ok(made)
    }

    fn look_up(&self, key: &Key) -> Option<Columns> {
        let mut store = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        store.clock += 1;
        let stamp = store.clock;
        store.columns.get_mut(key).map(|(columns, last)| {
            *last = stamp;
            Arc::clone(columns)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{CAPACITY, Cache, Key};

    #[test]
    fn what_was_used_last_stays() {
        let cache = Cache::default();
        let make = |v: f64| move || Ok(vec![vec![v]]);
        let first = Key::new("a", &[0.0], None);
        cache.get(first.clone(), make(0.0)).unwrap();
        for i in 1..2 * CAPACITY {
            cache
                .get(Key::new("b", &[i as f64], None), make(1.0))
                .unwrap();
            let again = cache.get(first.clone(), || unreachable!("kept")).unwrap();
            assert_eq!(again[0][0], 0.0);
        }
    }
}
