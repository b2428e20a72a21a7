//! Data for the screen, made when what they show has changed and kept until then.

use std::sync::{Arc, Mutex, PoisonError};

/// Something made from a key, once.
#[derive(Debug)]
pub struct Memo<K, V> {
    made: Option<(K, V)>,
}

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Self { made: None }
    }
}

impl<K: PartialEq, V: Clone> Memo<K, V> {
    /// What `make` makes of a key; made again when the key is another.
    pub fn get(&mut self, key: K, make: impl FnOnce(&K) -> V) -> V {
        match &self.made {
            Some((of, value)) if *of == key => value.clone(),
            _ => {
                let value = make(&key);
                self.made = Some((key, value.clone()));
                value
            }
        }
    }
}

/// The same for what takes long: made on a thread of its own, while the old one stays.
#[derive(Debug)]
pub struct Later<K, V> {
    made: Option<(K, V)>,
    under_way: Option<(K, Arc<Mutex<Option<V>>>)>,
}

impl<K, V> Default for Later<K, V> {
    fn default() -> Self {
        Self { made: None, under_way: None }
    }
}

impl<K: PartialEq + Clone + Send + 'static, V: Clone + Send + 'static> Later<K, V> {
    /// What `make` makes of a key, or of the key before while that is under way; `wake` is called when it is done.
    pub fn get(
        &mut self,
        key: &K,
        make: impl FnOnce(&K) -> V + Send + 'static,
        wake: impl FnOnce() + Send + 'static,
    ) -> Option<V> {
        let done =
            self.under_way.as_ref().and_then(|(_, slot)| slot.lock().unwrap_or_else(PoisonError::into_inner).take());
        if let Some(value) = done
            && let Some((key, _)) = self.under_way.take()
        {
            self.made = Some((key, value));
        }
        let is_made = self.made.as_ref().is_some_and(|(of, _)| of == key);
        // One at a time: a key that changes while the thread works is seen to when it is done.
        if !is_made && self.under_way.is_none() {
            let slot = Arc::new(Mutex::new(None));
            self.under_way = Some((key.clone(), Arc::clone(&slot)));
            let key = key.clone();
            let work = move || {
                let value = make(&key);
                *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(value);
                wake();
            };
            // Without a thread the layer stays empty; the next frame tries again.
            if std::thread::Builder::new().name("layer".to_owned()).spawn(work).is_err() {
                self.under_way = None;
            }
        }
        self.made.as_ref().map(|(_, value)| value.clone())
    }

    /// Whether something is being made.
    pub fn is_busy(&self) -> bool {
        self.under_way.is_some()
    }
}

/// Shared data, the same as another only where it is that very one.
#[derive(Debug)]
pub struct Same<T>(pub Option<Arc<T>>);

impl<T> Clone for Same<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

    #[test]
    fn what_has_not_changed_is_not_made_again() {
        let mut memo = Memo::default();
        let mut made = 0;
        for key in [1, 1, 2, 2, 1] {
            let value = memo.get(key, |key| {
                made += 1;
                key * 10
            });
            assert_eq!(value, key * 10);
        }
        assert_eq!(made, 3);
    }

    #[test]
    fn while_the_new_is_made_the_old_stays() {
        let mut later = Later::default();
        let gate = Arc::new(Mutex::new(()));
        let until = |later: &mut Later<i32, i32>, key: i32, want: i32| {
            let began = Instant::now();
            while later.get(&key, move |key| key * 10, || {}) != Some(want) {
                assert!(began.elapsed() < Duration::from_secs(20));
                std::thread::yield_now();
            }
        };
        until(&mut later, 1, 10);
        let held = gate.lock().unwrap();
        let waits = Arc::clone(&gate);
        let slow = move |key: &i32| {
            drop(waits.lock());
            key * 10
        };
        assert_eq!(later.get(&2, slow, || {}), Some(10));
        assert!(later.is_busy());
        drop(held);
        until(&mut later, 2, 20);
        assert!(!later.is_busy());
    }

    #[test]
    fn shared_data_are_the_same_where_they_are_that_very_one() {
        let (a, b) = (Arc::new(1), Arc::new(1));
        assert!(Same(Some(Arc::clone(&a))) == Same(Some(a.clone())) && Same(Some(a)) != Same(Some(b)));
        assert!(Same::<i32>(None) == Same(None));
    }
}
