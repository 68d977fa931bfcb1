//! Matrices and bounds of a scene.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};

use super::{Camera, Focus, Frustum, Image, Light, LightKind, Object, Scene, Shadow, Spot};
use crate::geometry::Texture;
use crate::math::{Aabb, spaces};

/// Ratio of distance from the world's origin to size from which a scene is moved.
const FAR: f64 = 8.0;

impl Image {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }
}

impl Scene {
    /// The picture's width over its height.
    pub fn aspect(&self) -> f64 {
        self.image.aspect()
    }

    /// The box around all objects, in world space.
    pub fn world_bounds(&self) -> Aabb {
        self.objects.iter().fold(Aabb::EMPTY, |bounds, object| bounds.union(object.world_bounds()))
    }

    /// The same scene moved to where the eye is near the world's origin, so that products of matrices lose nothing of
    /// f64; `None`: it is as near as it is large. Moved by a power of two not below the scene's size, coordinates keep
    /// all of their digits.
    pub fn brought_near(&self) -> Option<Self> {
        let places = self.lights.iter().filter_map(Light::position).chain([self.camera.eye]);
        let size = 2.0 * places.fold(self.world_bounds(), Aabb::including).radius();
        let away = self.camera.eye.abs().max_element();
        if !(size.is_finite() && size > 0.0 && away > FAR * size) {
            return None;
        }
        let step = size.log2().ceil().exp2();
        let origin = (self.camera.eye / step).round() * step;
        let mut scene = self.clone();
        let mut ends = vec![&mut scene.camera.eye, &mut scene.camera.target];
        for light in &mut scene.lights {
            match &mut light.kind {
                LightKind::Spot(spot) => ends.extend([&mut spot.frustum.position, &mut spot.frustum.target]),
                LightKind::Point(point) => ends.push(&mut point.position),
                LightKind::Directional { .. } => {}
            }
        }
        ends.into_iter().for_each(|end| *end -= origin);
        scene.objects.iter_mut().for_each(|object| object.world_from_model.w_axis -= origin.extend(0.0));
        let photos = self.photos().into_iter();
        let moved: HashMap<_, _> = photos.map(|photo| (Arc::as_ptr(photo), Arc::new(photo.moved(-origin)))).collect();
        for photo in scene.objects.iter_mut().filter_map(|object| object.photo.as_mut()) {
            if let Some(moved) = moved.get(&Arc::as_ptr(photo)) {
                *photo = moved.clone();
            }
        }
        Some(scene)
    }
}

impl Camera {
    /// The camera looks along -z of view space, y is up.
    pub fn view_from_world(&self) -> DMat4 {
        spaces::view_from_world(self.eye, self.target, self.up)
    }

    /// `aspect` is the picture's width over its height.
    pub fn clip_from_view(&self, aspect: f64) -> DMat4 {
        spaces::perspective(self.fov_y_radians, aspect, self.near, self.far)
    }
}

impl Light {
    /// The spotlight's own values; `None`: another kind.
    pub fn spot(&self) -> Option<&Spot> {
        if let LightKind::Spot(spot) = &self.kind { Some(spot) } else { None }
    }

    /// Frustum of a spotlight; other lights have none.
    pub fn frustum(&self) -> Option<&Frustum> {
        self.spot().map(|spot| &spot.frustum)
    }

    /// Position of the light; `None` if it is infinitely far away.
    pub fn position(&self) -> Option<DVec3> {
        match &self.kind {
            LightKind::Spot(spot) => Some(spot.frustum.position),
            LightKind::Point(point) => Some(point.position),
            LightKind::Directional { .. } => None,
        }
    }

    /// Constant, linear and quadratic; (1, 0, 0) for a light that is as bright everywhere.
    pub fn attenuation(&self) -> [f32; 3] {
        match &self.kind {
            LightKind::Spot(spot) => spot.attenuation,
            LightKind::Point(point) => point.attenuation,
            LightKind::Directional { .. } => [1.0, 0.0, 0.0],
        }
    }
}

impl Spot {
    /// The image that is projected beside the beam's map: none if a lens moves it, for the map has it then.
    pub fn plain_image(&self) -> Option<&Arc<Texture>> {
        let has_lens = self.beam.as_ref().is_some_and(|beam| beam.lens != 0.0);
        self.image.as_ref().filter(|_| !has_lens)
    }

    /// The focus, where it changes the picture: through several points of a lens that has a size.
    pub fn lens(&self) -> Option<Focus> {
        self.focus.filter(|focus| focus.samples > 1 && focus.radius > 0.0)
    }

    /// A frustum that holds the light's, through every point of its lens.
    pub fn reach(&self) -> Frustum {
        self.lens().map_or_else(|| self.frustum.clone(), |focus| self.frustum.around(&focus))
    }
}

impl Focus {
    /// Lens point `index` in 0..samples: its place to the right of and above the light's position. Points come in pairs
    /// across the middle, which an odd number of them begins with. Each stands for the same area: pair j, from 0, lies at
    /// the share √((2 j + 1) / samples) of the radius, or √((2 j + 2) / samples) of it around a point in the middle, and is
    /// turned by π (√5 - 1) / 2 against the pair before it [Vogel 1979].
    pub fn lens_point(&self, index: u32) -> DVec2 {
        let odd = self.samples % 2;
        let Some(paired) = index.checked_sub(odd) else { return DVec2::ZERO };
        let (pair, sign) = (f64::from(paired / 2), if paired.is_multiple_of(2) { 1.0 } else { -1.0 });
        let share = (2.0 * pair + 1.0 + f64::from(odd)) / f64::from(self.samples);
        let angle = pair * std::f64::consts::PI * 0.5 * (5.0_f64.sqrt() - 1.0);
        sign * self.radius * share.sqrt() * DVec2::from_angle(angle)
    }
}

impl LightKind {
    /// The value of `kind` in a scene file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Spot(_) => "spot",
            Self::Point(_) => "point",
            Self::Directional { .. } => "directional",
        }
    }
}

impl Frustum {
    /// The light looks along -z of its view space, y is up.
    pub fn view_from_world(&self) -> DMat4 {
        spaces::view_from_world(self.position, self.target, self.up)
    }

    /// Perspective of the light's image.
    pub fn clip_from_view(&self) -> DMat4 {
        let mut clip = spaces::perspective(self.cone_radians, self.aspect, self.near, self.far);
        clip.z_axis.x = self.lean.x * clip.x_axis.x;
        clip.z_axis.y = self.lean.y * clip.y_axis.y;
        clip
    }

    /// Half its width and half its height at distance 1.
    pub fn tangents(&self) -> DVec2 {
        let tan = (0.5 * self.cone_radians).tan();
        DVec2::new(tan * self.aspect, tan)
    }

    /// The same from a point of its lens: its apex moves, and the cross-section at the focal distance stays.
    pub fn through(&self, lens_point: DVec2, focus: &Focus) -> Self {
        let world_from_view = self.view_from_world().transpose();
        let moved = world_from_view.transform_vector3(lens_point.extend(0.0));
        let [position, target] = [self.position, self.target].map(|place| place + moved);
        Self { position, target, lean: self.lean - lens_point / focus.distance, ..self.clone() }
    }

    /// A pyramid around those through all lens points. At the distance d these reach to `tan d + radius |1 - d / F|` from
    /// the axis; with the tangent larger by radius / F, and the apex so far behind that it is as wide as the lens there, it
    /// is wider everywhere.
    fn around(&self, focus: &Focus) -> Self {
        let tangents = self.tangents() + focus.radius / focus.distance;
        let behind = focus.radius / tangents.min_element();
        let ahead = (self.target - self.position).normalize();
        Self {
            position: self.position - behind * ahead,
            cone_radians: 2.0 * tangents.y.atan(),
            aspect: tangents.x / tangents.y,
            far: self.far + behind,
            ..self.clone()
        }
    }

    /// The same pyramid from its apex to far beyond its far plane: the region that the light can reach.
    pub fn unbounded(&self) -> Self {
        Self { near: 1e-3 * self.near, far: 1e3 * self.far, ..self.clone() }
    }

    /// Perspective and view together.
    pub fn clip_from_world(&self) -> DMat4 {
        self.clip_from_view() * self.view_from_world()
    }
}

impl Object {
    /// The box around the mesh's own box, grown by its wave, in world space.
    pub fn world_bounds(&self) -> Aabb {
        self.reach(self.mesh.bounds).transformed(&self.world_from_model)
    }

    /// A box in model space, grown by the wave.
    pub fn reach(&self, bounds: Aabb) -> Aabb {
        self.wave.map_or(bounds, |wave| wave.bounds(bounds))
    }

    /// The mesh's positions, moved by the wave.
    pub fn drawn_positions(&self) -> Cow<'_, [[f32; 3]]> {
        match &self.wave {
            Some(wave) => Cow::Owned(wave.moved_positions(&self.mesh)),
            None => Cow::Borrowed(&self.mesh.positions),
        }
    }
}

/// `scene` with `[light.shadow]` of one light replaced.
pub fn with_shadow(scene: &Scene, light: usize, shadow: &Shadow) -> Scene {
    let mut scene = scene.clone();
    if let Some(light) = scene.lights.get_mut(light) {
        light.shadow = shadow.clone();
    }
    scene
}
