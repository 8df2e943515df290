//! Values by index.
//!
//! In: indices that count from 0, as handles of expressions do. Out: a [`Table`], in which a value is found at its index and
//! not by comparisons: a macro is built without optimisation, and there a search tree takes most of the time. A table that is
//! almost empty costs almost nothing, however large its indices are: most passes over expressions see a few of many.

use std::marker::PhantomData;

/// A place in a list.
pub trait Index: Copy {
    /// The place, from 0.
    fn index(self) -> usize;
}

/// Indices of one page.
const PAGE: usize = 256;

/// A map from indices to values.
#[derive(Clone, Debug)]
pub struct Table<K, V> {
    /// One more than where a value stands, 0 for none; a page without values is empty.
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

    /// Puts a value at an index, in place of one that is there.
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

    /// The value at an index, the default where there was none.
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
