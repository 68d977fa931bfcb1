//! Batches of equal program, uniforms and inputs become one, found without a look at all that there are.

use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

use crate::pass::Batch;

/// Batches in the order in which the first of each kind was added.
#[derive(Default)]
pub struct JoinedBatches {
    pub batches: Vec<Batch>,
    /// Places of batches by their [`hash`].
    places: HashMap<u64, Vec<usize>>,
}

impl JoinedBatches {
    /// Place of the batch that draws with the same program, uniforms, inputs and culled faces; `batch` is added where there is
    /// none.
    pub fn place(&mut self, batch: Batch) -> usize {
        let places = self.places.entry(hash(&batch)).or_default();
        let joins = |place: &&usize| {
            let known = &self.batches[**place];
            known.cull == batch.cull
                && known.inputs == batch.inputs
                && known.uniforms == batch.uniforms
                && known.program == batch.program
        };
        if let Some(&place) = places.iter().find(joins) {
            let known = &self.batches[place];
            debug_assert_eq!(known.meaning, batch.meaning, "the meaning follows from program, uniforms and inputs");
            return place;
        }
        places.push(self.batches.len());
        self.batches.push(batch);
        self.batches.len() - 1
    }
}

/// A number that is the same for batches that join. Programs differ in their defines.
fn hash(batch: &Batch) -> u64 {
    let mut hasher = DefaultHasher::new();
    batch.program.defines.hash(&mut hasher);
    for uniform in &batch.uniforms {
        uniform.name.hash(&mut hasher);
        // Adding zero turns -0 into +0, which is equal to it.
        uniform.value.floats().iter().for_each(|value| (value + 0.0).to_bits().hash(&mut hasher));
    }
    batch.inputs.iter().for_each(|input| (&input.name, input.image).hash(&mut hasher));
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pass::{Define, FixedFunctionDesc, Program, Uniform};

    fn batch(define: u32, value: f32) -> Batch {
        let (defines, uniforms) = (vec![Define::number("KIND", define)], vec![Uniform::new("value", value)]);
        let label = String::from("test");
        Batch {
            program: Program { label, defines, vertex: Vec::new(), fragment: Vec::new(), attributes: Vec::new() },
            meaning: FixedFunctionDesc::Shader("a test"),
            uniforms,
            inputs: Vec::new(),
            cull: None,
            scissor: None,
            clip_planes: 0,
            draws: Vec::new(),
        }
    }

    #[test]
    fn equal_batches_are_one() {
        let mut joined = JoinedBatches::default();
        let added = [(0, 1.0), (0, 2.0), (1, 1.0), (0, 1.0), (0, 0.0), (0, -0.0), (1, 1.0)];
        let places = added.map(|(define, value)| joined.place(batch(define, value)));
        assert_eq!(places, [0, 1, 2, 0, 3, 3, 2]);
        assert_eq!(joined.batches.len(), 4);
    }

    #[test]
    fn many_batches_are_each_compared_with_few() {
        let mut joined = JoinedBatches::default();
        (0..10_000).for_each(|value| assert_eq!(joined.place(batch(0, value as f32)), value));
        assert!(joined.places.values().all(|places| places.len() < 3));
    }
}
