//! Values that are found from a mesh and expensive to find again: its moved or cut copies, its parts, its adjacency, its
//! hierarchy of boxes. A plan is made for every frame, and passes that draw the same meshes again are not redrawn.

use std::any::{Any, TypeId};
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use super::Mesh;

/// Values derived from meshes, each kept until its mesh is dropped. One belongs to a renderer, which plans many frames of
/// the same meshes.
#[derive(Debug, Default)]
pub struct Derived(Mutex<HashMap<Place, Entry>>);

/// The type of a key and its value, and a mesh by its address, which is unique while a `Weak` of it exists.
type Place = (TypeId, usize);

#[derive(Debug)]
struct Entry {
    mesh: Weak<Mesh>,
    /// Pairs of a key and its value, oldest first.
    pairs: VecDeque<Box<dyn Any + Send>>,
}

/// Number of values of one kind that are kept.
#[derive(Clone, Copy, Debug)]
pub enum Most {
    /// For one mesh. The oldest value goes first.
    OfMesh(usize),
    /// For all meshes together. All go at once.
    OfAll(usize),
}

impl Derived {
    /// The value of `key` for `mesh`, which `find` finds where it is not known. Keys of one type are of one kind.
    pub fn get<K, V>(&self, mesh: &Arc<Mesh>, most: Most, key: K, find: impl FnOnce() -> V) -> V
    where
        K: PartialEq + Send + 'static,
        V: Clone + Send + 'static,
    {
        let place = (TypeId::of::<(K, V)>(), Arc::as_ptr(mesh) as usize);
        let is_it = |pair: &Box<dyn Any + Send>| {
            pair.downcast_ref::<(K, V)>().filter(|(known, _)| *known == key).map(|(_, value)| value.clone())
        };
        if let Some(value) = self.lock().get(&place).and_then(|entry| entry.pairs.iter().rev().find_map(is_it)) {
            return value;
        }
        let value = find(); // unlocked: it may derive something itself
        let mut kept = self.lock();
        if let Most::OfAll(most) = most {
            let of_kind = |(kind, _): &Place| *kind == place.0;
            let count: usize =
                kept.iter().filter(|(place, _)| of_kind(place)).map(|(_, entry)| entry.pairs.len()).sum();
            if count >= most {
                kept.retain(|place, _| !of_kind(place));
            }
        }
        let entry = kept.entry(place).or_insert_with(|| Entry { mesh: Arc::downgrade(mesh), pairs: VecDeque::new() });
        if let Most::OfMesh(most) = most
            && entry.pairs.len() >= most
        {
            entry.pairs.pop_front();
        }
        entry.pairs.push_back(Box::new((key, value.clone())));
        value
    }

    /// Drops the values of meshes that have been dropped.
    pub fn forget_dropped(&self) {
        self.lock().retain(|_, entry| entry.mesh.strong_count() > 0);
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<Place, Entry>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// Looks up `key` and says whether it had to be found.
    fn is_found(derived: &Derived, mesh: &Arc<Mesh>, most: Most, key: u32) -> bool {
        let found = Cell::new(false);
        let value = derived.get(mesh, most, key, || {
            found.set(true);
            2 * key
        });
        assert_eq!(value, 2 * key);
        found.get()
    }

    #[test]
    fn a_value_is_found_once_for_each_mesh_key_and_type() {
        let (derived, most) = (Derived::default(), Most::OfMesh(2));
        let [a, b] = [(); 2].map(|()| Arc::new(Mesh::default()));
        for (mesh, key, expected) in [(&a, 1, true), (&a, 1, false), (&b, 1, true), (&a, 2, true), (&a, 1, false)] {
            assert_eq!(is_found(&derived, mesh, most, key), expected, "{key}");
        }
        assert_eq!(derived.get(&a, most, 1_u64, || 7), 7, "a key of another type");
        // The third key of a mesh is one too many: the first goes. Another mesh keeps its own.
        for (mesh, key, expected) in [(&a, 3, true), (&a, 2, false), (&a, 1, true), (&b, 1, false)] {
            assert_eq!(is_found(&derived, mesh, most, key), expected, "{key} after the third");
        }
    }

    #[test]
    fn a_bound_of_all_meshes_drops_one_kind() {
        let (derived, most) = (Derived::default(), Most::OfAll(2));
        let meshes = [(); 3].map(|()| Arc::new(Mesh::default()));
        derived.get(&meshes[0], most, 'a', || 'b');
        for mesh in &meshes {
            assert!(is_found(&derived, mesh, most, 1));
        }
        assert!(!is_found(&derived, &meshes[2], most, 1), "the newest is kept");
        assert!(is_found(&derived, &meshes[0], most, 1), "the others are dropped");
        assert_eq!(derived.get(&meshes[0], most, 'a', || 'c'), 'b', "another kind is kept");
    }

    #[test]
    fn what_is_derived_is_dropped_after_its_mesh() {
        let derived = Derived::default();
        let (mesh, value) = (Arc::new(Mesh::default()), Arc::new(()));
        derived.get(&mesh, Most::OfMesh(1), (), || value.clone());
        derived.forget_dropped();
        assert_eq!(Arc::strong_count(&value), 2);
        drop(mesh);
        derived.forget_dropped();
        assert_eq!(Arc::strong_count(&value), 1);
    }

    #[test]
    fn a_value_may_be_derived_from_another() {
        let (derived, most) = (Derived::default(), Most::OfMesh(1));
        let mesh = Arc::new(Mesh::default());
        assert_eq!(derived.get(&mesh, most, 1_u32, || derived.get(&mesh, most, 1_u64, || 5_u32) + 1), 6);
    }
}
