//! A model in motion: what each frame needs of it for bump mapping and shadow volumes, in buffers that are kept.

use super::super::Mesh;
use super::super::tangents::{BasisFit, Tangents};
use super::super::volume::{Caster, KeyPlanes, LightSource, Outline, PlaneBlend};
use super::{KeyTangents, Model, NormalSource, Pose};

/// A model in a pose: its mesh with the file's normals, its caster, bases and outlines. What depends on the skin or on the
/// triangles' neighbours is found once; what depends on two key frames when a pose first lies between them. Nothing is
/// allocated between the same two frames once the buffers are large enough.
#[derive(Clone, Debug)]
pub struct Animation<'m> {
    model: &'m Model,
    pose: Pose,
    mesh: Mesh,
    /// A vertex of the file at each of the caster's places.
    places: Vec<usize>,
    caster: Caster,
    key_tangents: KeyTangents,
    key_planes: KeyPlanes,
    tangents: Tangents,
    outline: Outline,
}

impl<'m> Animation<'m> {
    /// The model in its first frame.
    pub fn new(model: &'m Model) -> Self {
        let pose = Pose::default();
        let (places, triangles) = model.places();
        let at = |vertex: &usize| model.position(&pose, *vertex).as_vec3().to_array();
        let caster = Caster::of_places(places.iter().map(at).collect(), triangles);
        let mut animation = Self {
            model,
            pose,
            mesh: model.mesh(&pose, NormalSource::File),
            key_tangents: KeyTangents::new(model),
            key_planes: KeyPlanes::default(),
            tangents: Tangents::default(),
            outline: Outline::default(),
            places,
            caster,
        };
        animation.find_planes();
        animation
    }

    /// Moves the mesh and the caster.
    pub fn move_to(&mut self, pose: &Pose) {
        let is_between_others = pose.frames != self.pose.frames;
        self.pose = *pose;
        self.model.move_to(pose, NormalSource::File, &mut self.mesh);
        let (model, places) = (self.model, &self.places);
        self.caster.move_places(|place| model.position(pose, places[place]).as_vec3().to_array());
        if is_between_others {
            self.find_planes();
        }
    }

    fn find_planes(&mut self) {
        let keys = self.pose.frames.map(|frame| {
            let pose = Pose { frames: [frame; 2], blend: 0.0 };
            self.places.iter().map(|vertex| self.model.position(&pose, *vertex)).collect::<Vec<_>>()
        });
        self.key_planes.set(self.caster.triangles(), &keys[0], &keys[1]);
    }

    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// The mesh in the pose.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The caster in the pose. Its places are the model's, [`Model::places`].
    pub fn caster(&self) -> &Caster {
        &self.caster
    }

    /// Planes of the caster's triangles between the pose's two frames.
    pub fn planes(&self) -> &KeyPlanes {
        &self.key_planes
    }

    /// Bases of the mesh's corners in the pose.
    pub fn tangents(&mut self, fit: BasisFit) -> &Tangents {
        self.key_tangents.find(&self.pose, &self.mesh, fit, &mut self.tangents);
        &self.tangents
    }

    /// Outline of the caster in the pose for a light in model space.
    pub fn outline(&mut self, source: LightSource, planes: PlaneBlend) -> &Outline {
        self.outline.find_between(&self.caster, &self.key_planes, self.pose.blend, planes, source);
        &self.outline
    }
}
