//! A map that drops values that have not been used for long.

use std::collections::HashMap;
use std::hash::Hash;

/// Values by key, of which the ones used last are kept.
pub struct Recent<K, V> {
    /// Values, each with the round in which it was last used.
    known: HashMap<K, (u64, V)>,
    round: u64,
    most: usize,
}

impl<K: Eq + Hash, V> Recent<K, V> {
    /// An empty map. `most`: how many values outlive the round in which they were used.
    pub fn new(most: usize) -> Self {
        Self { known: HashMap::new(), round: 0, most }
    }

    pub fn get(&self, key: &K) -> Option<&V> {
        self.known.get(key).map(|(_, value)| value)
    }

    /// Marks a value as used in this round.
    pub fn touch(&mut self, key: &K) -> Option<&V> {
        let (used, value) = self.known.get_mut(key)?;
        *used = self.round;
        Some(value)
    }

    /// Adds a value that is used in this round.
    pub fn insert(&mut self, key: K, value: V) {
        self.known.insert(key, (self.round, value));
    }

    /// Ends a round. If there are too many values, keeps all of this round and the most recently used others, up to half of
    /// the limit: the search then costs no more than the insertions. Returns whether any was dropped.
    pub fn end_round(&mut self) -> bool {
        let round = self.round;
        self.round += 1;
        if self.known.len() <= self.most {
            return false;
        }
        let mut rounds: Vec<u64> = self.known.values().map(|(used, _)| *used).collect();
        rounds.sort_unstable_by(|a, b| b.cmp(a));
        let oldest = rounds.get(self.most / 2).copied().unwrap_or(0);
        let before = self.known.len();
        self.known.retain(|_, (used, _)| *used == round || *used > oldest);
        self.known.len() < before
    }
}

#[cfg(test)]
mod tests {
    use super::Recent;

    #[test]
    fn what_was_used_last_stays() {
        let mut recent = Recent::new(8);
        for key in 0..100 {
            recent.insert(key, ());
            assert!(recent.touch(&0).is_some(), "0 is used in every round");
            recent.end_round();
            assert!(recent.known.len() <= 8, "{} after {key}", recent.known.len());
            assert!(recent.get(&key).is_some());
        }
        assert!(recent.get(&0).is_some() && recent.get(&98).is_some() && recent.get(&50).is_none());
    }

    #[test]
    fn one_round_may_use_more_than_stay() {
        let mut recent = Recent::new(4);
        (0..10).for_each(|key| recent.insert(key, ()));
        assert!(!recent.end_round());
        assert_eq!(recent.known.len(), 10);
        recent.insert(10, ());
        assert!(recent.end_round());
        assert_eq!(recent.known.len(), 1);
    }
}
