//! Values by index.
//!
//! In: indices that count from 0, as handles of expressions do. Out: a [`Table`], in which a value is found at its index and
//! not by comparisons: a macro is built without optimisation, and there a search tree takes most of the time. A table that is
//! almost empty costs almost nothing, however large its indices are.

use std::marker::PhantomData;

/// A place in a list.
pub trait Index: Copy {
    /// The place, from 0.
    fn index(self) -> usize;
}

/// A map from indices to values.
#[derive(Clone, Debug)]
pub struct Table<K, V> {
    /// One more than where the value stands, 0 for none: memory of zeros is free.
    places: Vec<usize>,
    values: Vec<V>,
    keys: PhantomData<K>,
}

impl<K, V> Default for Table<K, V> {
    fn default() -> Self {
        Self { places: Vec::new(), values: Vec::new(), keys: PhantomData }
    }
}

impl<K: Index, V> Table<K, V> {
    /// The value at an index.
    #[must_use]
    pub fn get(&self, key: K) -> Option<&V> {
        match self.places.get(key.index()) {
            None | Some(0) => None,
            Some(place) => Some(&self.values[*place - 1]),
        }
    }

    /// Whether there is a value at an index.
    #[must_use]
    pub fn contains(&self, key: K) -> bool {
        self.get(key).is_some()
    }

    /// Puts a value at an index, in place of one that is there.
    pub fn insert(&mut self, key: K, value: V) {
        let index = key.index();
        self.reach(index);
        let place = self.places[index];
        if place == 0 {
            self.values.push(value);
            self.places[index] = self.values.len();
        } else {
            self.values[place - 1] = value;
        }
    }

    /// The value at an index, the default where there was none.
    pub fn entry(&mut self, key: K) -> &mut V
    where
        V: Default,
    {
        if !self.contains(key) {
            self.insert(key, V::default());
        }
        &mut self.values[self.places[key.index()] - 1]
    }

    fn reach(&mut self, index: usize) {
        if index >= self.places.len() {
            let mut places = vec![0; (index + 1).max(2 * self.places.len())];
            places[..self.places.len()].copy_from_slice(&self.places);
            self.places = places;
        }
    }
}

impl<K: Index, V> Extend<(K, V)> for Table<K, V> {
    fn extend<I: IntoIterator<Item = (K, V)>>(&mut self, entries: I) {
        for (key, value) in entries {
            self.insert(key, value);
        }
    }
}

impl<K: Index, V> FromIterator<(K, V)> for Table<K, V> {
    fn from_iter<I: IntoIterator<Item = (K, V)>>(entries: I) -> Self {
        let mut table = Self::default();
        table.extend(entries);
        table
    }
}
