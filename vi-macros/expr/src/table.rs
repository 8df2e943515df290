//! Maps from small indices to values.
//!
//! In: indices that count from 0, such as handles of expressions. Out: a [`Table`] with direct access. A macro is built
//! without optimization, where a search tree would dominate the run time. A sparse table costs little for any size of
//! its indices: most passes visit a few of many expressions.

use std::marker::PhantomData;

/// A position in a list.
pub trait Index: Copy {
    /// The position, from 0.
    fn index(self) -> usize;
}

/// Number of indices in one page.
const PAGE: usize = 256;

/// A map from indices to values.
#[derive(Clone, Debug)]
pub struct Table<K, V> {
    /// One plus the position of the value, 0 for none; a page without values is empty.
    pages: Vec<Vec<usize>>,
    values: Vec<V>,
    keys: PhantomData<K>,
}

impl<K, V> Default for Table<K, V> {
    fn default() -> Self {
        Self { pages: Vec::new(), values: Vec::new(), keys: PhantomData }
    }
}

impl<K: Index, V> Table<K, V> {
    /// The value at an index.
    #[must_use]
    pub fn get(&self, key: K) -> Option<&V> {
        let place = self.pages.get(key.index() / PAGE)?.get(key.index() % PAGE)?;
        self.values.get(place.checked_sub(1)?)
    }

    /// Whether there is a value at an index.
    #[must_use]
    pub fn contains(&self, key: K) -> bool {
        self.get(key).is_some()
    }

    /// Sets the value at an index.
    pub fn insert(&mut self, key: K, value: V) {
        let next = self.values.len() + 1;
        let place = self.place(key);
        if let Some(there) = place.checked_sub(1) {
            self.values[there] = value;
        } else {
            *place = next;
            self.values.push(value);
        }
    }

    /// The value at an index; inserts the default if there is none.
    pub fn entry(&mut self, key: K) -> &mut V
    where
        V: Default,
    {
        if !self.contains(key) {
            self.insert(key, V::default());
        }
        let place = *self.place(key) - 1;
        &mut self.values[place]
    }

    fn place(&mut self, key: K) -> &mut usize {
        let (page, place) = (key.index() / PAGE, key.index() % PAGE);
        if page >= self.pages.len() {
            self.pages.resize(page + 1, Vec::new());
        }
        if self.pages[page].is_empty() {
            self.pages[page] = vec![0; PAGE];
        }
        &mut self.pages[page][place]
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
