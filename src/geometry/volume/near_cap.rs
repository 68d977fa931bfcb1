//! Volumes closed at the camera's near plane, for z-pass whatever the eye's place [GDC, "Near Clip Plane Capping Cases",
//! "Handling the "Hard" Near Clip Plane Capping Case"]. In view space: there, points of the near plane keep all their
//! digits however small near is.

use std::ops::Range;

use glam::{DMat4, DVec3};

use super::near_plane::{NearPlane, Stand, ViewPlace};
use super::{Caster, Outline};

/// Numbers of an outline's vertices that land on the near plane when projected away from the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Landing {
    /// None of them, nor any piece between them: nothing to cap.
    #[default]
    None,
    /// All: the "easy" case.
    All,
    /// Some: the "hard" case.
    Some,
}

/// The part of an infinite shadow volume beyond the near plane: sides and near cap (no light cap and no far cap: z-pass
/// never counts them). Buffers are kept from one cut to the next.
///
/// View space. Triangles run counter-clockwise seen from outside the volume *in view space*, for mirroring transforms
/// too: the caller draws them by `clip_from_view` alone and never turns the front face. Near-cap triangles lie at
/// z = -near exactly and always face the eye.
#[derive(Clone, Debug, Default)]
pub struct CappedVolume {
    vertices: Vec<[f32; 4]>,
    indices: Vec<u32>,
    sides: Range<u32>,
    near_cap: Range<u32>,
    landing: Landing,
    /// For each place of the caster: its position, and its vertices once it has them.
    places: Vec<ViewPlace>,
    polygon: Vec<u32>,
}

impl CappedVolume {
    /// View space; w is 1 or 0.
    pub fn vertices(&self) -> &[[f32; 4]] {
        &self.vertices
    }

    /// Three a triangle, into [`CappedVolume::vertices`].
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Range of [`CappedVolume::indices`] with the sides, cut off at the near plane.
    pub fn sides(&self) -> Range<u32> {
        self.sides.clone()
    }

    /// Part of the near plane that lies in shadow; [`crate::math::ledge`] says how to draw it.
    pub fn near_cap(&self) -> Range<u32> {
        self.near_cap.clone()
    }

    pub fn landing(&self) -> Landing {
        self.landing
    }

    /// Fills the buffers with the volume of `outline`, which was found for `caster`, cut at z = -`near` of view space.
    pub fn cut(&mut self, caster: &Caster, outline: &Outline, view_from_model: &DMat4, near: f64) {
        self.cut_before(caster, outline, view_from_model, near, None);
    }

    /// The same as [`cut`](Self::cut), with sides that end at the plane `normal · x = distance` of view space instead of at
    /// infinity: every ray crosses it, and all that is seen is before it. Short sides have more exact depths (see
    /// [`super::Extent`]).
    pub fn cut_before(
        &mut self,
        caster: &Caster,
        outline: &Outline,
        view_from_model: &DMat4,
        near: f64,
        end: Option<(DVec3, f64)>,
    ) {
        self.vertices.clear();
        self.indices.clear();
        self.places.clear();
        (self.sides, self.near_cap, self.landing) = (0..0, 0..0, Landing::None);
        let Some(source) = outline.source() else { return };
        let plane = NearPlane::new(source.transformed(view_from_model), near, end);
        let position = |[x, y, z]: &[f32; 3]| DVec3::new(f64::from(*x), f64::from(*y), f64::from(*z));
        let places = caster.positions.iter().map(|p| plane.place(view_from_model.transform_point3(position(p))));
        self.places.extend(places);

        let mirrored = view_from_model.determinant() < 0.0;
        for edge in outline.edges() {
            self.side_polygon(&plane, edge.from, edge.to);
            (0..edge.multiplicity).for_each(|_| self.add_polygon(mirrored));
        }
        self.sides = 0..self.indices.len() as u32;
        for (corners, weight) in caster.triangles.iter().zip(outline.weights()).filter(|(_, weight)| **weight != 0) {
            if self.cap_polygon(&plane, corners) {
                // Seen from the eye the cap runs as the triangle does seen from a light behind the near plane, and the
                // other way round for a light beyond it.
                self.add_polygon(mirrored ^ (*weight < 0) ^ plane.light_is_beyond());
            }
        }
        self.near_cap = self.sides.end..self.indices.len() as u32;
        self.landing = self.landing_of(outline);
    }

    fn landing_of(&self, outline: &Outline) -> Landing {
        let mut places = outline.edges().iter().flat_map(|edge| [edge.from, edge.to]);
        match places.all(|place| self.places[place as usize].lands()) {
            _ if self.near_cap.is_empty() => Landing::None,
            true => Landing::All,
            false => Landing::Some,
        }
    }

    /// The part of the side on the edge `a` to `b` that lies beyond the near plane: from b to a along its near end, back
    /// along its far end.
    fn side_polygon(&mut self, plane: &NearPlane, a: u32, b: u32) {
        self.polygon.clear();
        let ends = [a, b].map(|place| self.places[place as usize].stand);
        if plane.light_is_beyond() {
            // From the surface itself down to the plane, or to infinity.
            if ends[1].is_beyond_plane(plane) {
                self.push_own(b);
            }
            self.push_crossing_of_plane(plane, b, a);
            if ends[0].is_beyond_plane(plane) {
                self.push_own(a);
            }
            self.push_end(plane, a);
            self.push_crossing_at_infinity(plane, a, b);
            self.push_end(plane, b);
        } else {
            // From the plane, or from the surface where it stands beyond it, to infinity.
            self.push_start(plane, b);
            self.push_crossings(plane, b, a);
            self.push_start(plane, a);
            self.push_far(plane, a);
            self.push_far(plane, b);
        }
    }

    /// The part of a counted triangle whose rays meet the near plane, projected there. Returns whether there is any.
    fn cap_polygon(&mut self, plane: &NearPlane, corners: &[u32; 3]) -> bool {
        self.polygon.clear();
        let stands = corners.map(|place| self.places[place as usize].stand);
        if stands[0] == stands[1] && stands[1] == stands[2] && !stands[0].lands() {
            return false;
        }
        for k in 0..3 {
            if stands[k].lands() {
                self.push_projected(plane, corners[k]);
            }
            self.push_crossings(plane, corners[k], corners[(k + 1) % 3]);
        }
        self.polygon.len() >= 3
    }

    fn add_polygon(&mut self, turned: bool) {
        for k in 2..self.polygon.len() {
            let (b, c) = if turned { (k, k - 1) } else { (k - 1, k) };
            self.indices.extend([self.polygon[0], self.polygon[b], self.polygon[c]]);
        }
    }

    // Each of these adds one vertex to the polygon at most.

    fn push(&mut self, vertex: [f32; 4]) -> u32 {
        let index = self.vertices.len() as u32;
        self.vertices.push(vertex);
        self.polygon.push(index);
        index
    }

    /// Adds the place itself.
    fn push_own(&mut self, place: u32) {
        let ViewPlace { own, at, .. } = self.places[place as usize];
        match own {
            ViewPlace::NONE => self.places[place as usize].own = self.push(at.as_vec3().extend(1.0).to_array()),
            index => self.polygon.push(index),
        }
    }

    /// Adds the point where the place's ray meets the plane. The ray must meet it.
    fn push_projected(&mut self, plane: &NearPlane, place: u32) {
        let ViewPlace { projected, .. } = self.places[place as usize];
        match projected {
            ViewPlace::NONE => {
                let vertex = plane.projected(&self.places[place as usize]);
                self.places[place as usize].projected = self.push(vertex);
            }
            index => self.polygon.push(index),
        }
    }

    /// Adds the end of the place's ray: at infinity, or beyond all that is seen.
    fn push_infinite(&mut self, plane: &NearPlane, place: u32) {
        let ViewPlace { infinite, .. } = self.places[place as usize];
        match infinite {
            ViewPlace::NONE => {
                let vertex = plane.far_end(&self.places[place as usize]);
                self.places[place as usize].infinite = self.push(vertex);
            }
            index => self.polygon.push(index),
        }
    }

    /// For a light beyond the plane, adds the point where the ray of a place beyond the plane ends.
    fn push_end(&mut self, plane: &NearPlane, place: u32) {
        match self.places[place as usize].stand {
            Stand::AtPlane => {}
            Stand::Lands => self.push_projected(plane, place),
            Stand::Never => self.push_infinite(plane, place),
        }
    }

    /// For a light before the plane, adds the point where the ray of a place first is beyond the plane.
    fn push_start(&mut self, plane: &NearPlane, place: u32) {
        match self.places[place as usize].stand {
            Stand::AtPlane => self.push_own(place),
            Stand::Lands => self.push_projected(plane, place),
            Stand::Never => {}
        }
    }

    fn push_far(&mut self, plane: &NearPlane, place: u32) {
        if self.places[place as usize].stand != Stand::Never {
            self.push_infinite(plane, place);
        }
    }

    fn push_crossing_of_plane(&mut self, plane: &NearPlane, from: u32, to: u32) {
        if let Some(vertex) = plane.crossing(&self.places[from as usize], &self.places[to as usize]) {
            self.push(vertex);
        }
    }

    fn push_crossing_at_infinity(&mut self, plane: &NearPlane, from: u32, to: u32) {
        if let Some(vertex) = plane.direction_between(&self.places[from as usize], &self.places[to as usize]) {
            self.push(vertex);
        }
    }

    /// Adds both crossings, in the order from one place to the other.
    fn push_crossings(&mut self, plane: &NearPlane, from: u32, to: u32) {
        if self.places[from as usize].stand == Stand::Never {
            self.push_crossing_at_infinity(plane, from, to);
            self.push_crossing_of_plane(plane, from, to);
        } else {
            self.push_crossing_of_plane(plane, from, to);
            self.push_crossing_at_infinity(plane, from, to);
        }
    }
}
