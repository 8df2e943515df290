//! Values, each once.
//!
//! In: values. Out: the place of each in a list in which equal ones are one entry, numbered as they came: what is numbered
//! does not depend on the hashes, by which equal ones are found. A search among ordered values compares with a dozen of them;
//! here it is one or two, which shows in a macro, built without optimisation.

use std::borrow::Borrow;
use std::hash::{Hash, Hasher};
use std::ops::Index;

/// A list in which no two values are equal.
#[derive(Clone, Debug)]
pub struct Distinct<T> {
    values: Vec<T>,
    hashes: Vec<u64>,
    /// One more than the place of a value, at its hash or at the next slot that was free; 0 where none is. A power of two of
    /// slots, at most half of them taken.
    slots: Vec<usize>,
}

impl<T> Default for Distinct<T> {
    fn default() -> Self {
        Self { values: Vec::new(), hashes: Vec::new(), slots: vec![0; 16] }
    }
}

impl<T> Distinct<T> {
    /// All values, in the order in which they came.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The place of a value.
    pub fn find<Q: Hash + Eq>(&self, value: &Q) -> Option<usize>
    where
        T: Borrow<Q>,
    {
        self.slots[self.slot(value, hash(value))].checked_sub(1)
    }

    /// The place of a value that is there afterwards.
    pub fn insert<Q: Hash + Eq>(&mut self, value: Q) -> usize
    where
        T: Borrow<Q> + From<Q>,
    {
        let hash = hash(&value);
        let slot = self.slot(&value, hash);
        if let Some(place) = self.slots[slot].checked_sub(1) {
            return place;
        }
        self.values.push(value.into());
        self.hashes.push(hash);
        self.slots[slot] = self.values.len();
        if 2 * self.values.len() > self.slots.len() {
            self.grow();
        }
        self.values.len() - 1
    }

    /// The slot of a value: where it is, or where it would be.
    fn slot<Q: Eq>(&self, value: &Q, hash: u64) -> usize
    where
        T: Borrow<Q>,
    {
        let mut slot = self.first(hash);
        while let Some(place) = self.slots[slot].checked_sub(1) {
            if self.hashes[place] == hash && self.values[place].borrow() == value {
                break;
            }
            slot = (slot + 1) % self.slots.len();
        }
        slot
    }

    /// The slot at which a search begins. The upper bits of a hash are the mixed ones.
    fn first(&self, hash: u64) -> usize {
        (hash >> 32) as usize % self.slots.len()
    }

    fn grow(&mut self) {
        self.slots = vec![0; 2 * self.slots.len()];
        for place in 0..self.hashes.len() {
            let mut slot = self.first(self.hashes[place]);
            while self.slots[slot] != 0 {
                slot = (slot + 1) % self.slots.len();
            }
            self.slots[slot] = place + 1;
        }
    }
}

impl<T> Index<usize> for Distinct<T> {
    type Output = T;

    fn index(&self, place: usize) -> &T {
        &self.values[place]
    }
}

fn hash(value: &impl Hash) -> u64 {
    let mut hash = Multiplied(0);
    value.hash(&mut hash);
    hash.finish()
}

/// Words mixed by a product with an odd number, the golden ratio: few steps for the few small numbers that a node consists of.
struct Multiplied(u64);

impl Hasher for Multiplied {
    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.write_u64(u64::from(*byte));
        }
    }

    fn write_u32(&mut self, word: u32) {
        self.write_u64(u64::from(word));
    }

    fn write_u64(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn write_usize(&mut self, word: usize) {
        self.write_u64(word as u64);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
