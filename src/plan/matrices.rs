//! The matrices of shadow mapping with their numbers, for `glumbra plan --matrices` [HSM, "Computing
//! Transformations for Shadow Mapping" and Appendix A].

use std::collections::HashSet;
use std::fmt::Write;

use glam::{DMat4, DVec3, DVec4};

use super::Plan;
use crate::lights::projector::{Projector, face_frustum};
use crate::lights::{Coordinates, LightTerm, MapShape};
use crate::math::texgen::{self, SetUp, Split, Texgen};
use crate::pass::{Batch, CubeFace, UniformValue, Work};
use crate::scene::{LightKind, Scene};

/// The camera's view and the lights' texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrices {
    /// `V⁻¹`.
    pub eye_from_world: DMat4,
    /// Vector by which a scene far from the world's origin is moved before it is drawn; 0 elsewhere.
    pub moved: DVec3,
    /// The lights that are drawn, in the scene's order.
    pub lights: Vec<LightMatrices>,
}

/// Making of one light's texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct LightMatrices {
    /// Index into the scene's lights, or number of a photograph.
    pub index: usize,
    /// Name of the light, as in [`crate::scene::Light::name`].
    pub name: String,
    /// `spot`, `point`, `directional` or `photograph`.
    pub kind: &'static str,
    /// `None`: the light is drawn without texture coordinates.
    pub coordinates: Option<Coordinates>,
    /// Faces of a cube map.
    pub faces: Vec<FaceMatrices>,
}

/// Matrices that one face of a cube map is drawn with.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceMatrices {
    /// Face, by the axis that it is looked along.
    pub face: CubeFace,
    /// `P_light`.
    pub face_clip_from_face: DMat4,
    /// `L⁻¹`.
    pub face_from_world: DMat4,
}

const SET_UPS: [(SetUp, &str); 4] =
    [(SetUp::Eye, "eye"), (SetUp::World, "world"), (SetUp::Light, "light"), (SetUp::Identity, "identity")];

impl Matrices {
    /// Matrices of the lights that have a term in `terms`.
    pub(super) fn new<'t>(scene: &Scene, terms: impl Iterator<Item = &'t LightTerm>) -> Self {
        let lights = terms.map(|term| {
            let photo = term.index.checked_sub(scene.lights.len());
            let (source, is_photo) = (&term.source, photo.is_some());
            LightMatrices {
                index: photo.unwrap_or(term.index),
                name: scene.lights.get(term.index).unwrap_or(source).name.clone(),
                kind: if is_photo { "photograph" } else { source.kind.name() },
                coordinates: term.coordinates.clone(),
                faces: term.map_info.map_or_else(Vec::new, |map| faces(&source.kind, map.shape)),
            }
        });
        Self { eye_from_world: scene.camera.view_from_world(), moved: DVec3::ZERO, lights: lights.collect() }
    }
}

/// The faces of a point light's map.
fn faces(kind: &LightKind, shape: MapShape) -> Vec<FaceMatrices> {
    let (LightKind::Point(point), MapShape::Cube { .. }) = (kind, shape) else { return Vec::new() };
    let matrices = |face| {
        let Projector { clip_from_light, light_from_world, .. } = Projector::of_frustum(&face_frustum(point, face));
        FaceMatrices { face, face_clip_from_face: clip_from_light, face_from_world: light_from_world }
    };
    CubeFace::ALL.map(matrices).into()
}

impl Plan {
    /// The matrices in words and numbers.
    pub fn matrices_text(&self) -> String {
        let mut out = Text(String::new());
        out.line("Column vectors; (s, t, r, q) = T E_e x_eye, where E_e = E_po modelview_po^-1 are the eye planes that GL keeps");
        out.line("[HSM, Eq. 1]. Names beside the document's letters are target_from_source.");
        if self.matrices.moved != DVec3::ZERO {
            let [x, y, z] = self.matrices.moved.to_array();
            out.line(&format!(
                "The scene lies far from the origin and is drawn moved by ({x}, {y}, {z}); so are these matrices."
            ));
        }
        out.line("\nCamera");
        let eye_from_world = self.matrices.eye_from_world;
        out.matrix("V, world_from_eye", &eye_from_world.inverse());
        out.matrix("V^-1, eye_from_world", &eye_from_world);
        if self.matrices.lights.is_empty() {
            out.line("\nNo light is drawn.");
        }
        for light in &self.matrices.lights {
            out.light(light, eye_from_world);
        }
        self.other_planes(&mut out);
        out.0
    }

    /// Planes beside the lights' own: a surface's object planes, a guard's texgen plane, clip planes.
    fn other_planes(&self, out: &mut Text) {
        let mut known = HashSet::new();
        for pass in &self.list.passes {
            let Work::Draw(draw) = &pass.work else { continue };
            for batch in &draw.batches {
                for text in planes_of(batch) {
                    if !known.contains(&text) {
                        out.line(&text);
                        known.insert(text);
                    }
                }
            }
        }
    }
}

fn planes_of(batch: &Batch) -> Vec<String> {
    let mut found = Vec::new();
    let mut names: Vec<&str> = batch.draws.iter().map(|draw| draw.label.as_str()).collect();
    names.dedup();
    let names = names.join(", ");
    for uniform in &batch.uniforms {
        let mut out = Text(String::new());
        match (uniform.name.as_ref(), &uniform.value) {
            ("object_planes", UniformValue::Vec4Array(planes)) => {
                out.line(&format!("\nObject planes of {names}"));
                out.line("  GL_OBJECT_LINEAR for s and t: no modelview is applied to them");
                out.rows(&planes.iter().map(|plane| plane.as_dvec4()).collect::<Vec<_>>());
                let scale = batch.uniforms.iter().find(|uniform| uniform.name == "texture_scale");
                if let Some(UniformValue::Float(scale)) = scale.map(|uniform| &uniform.value) {
                    out.line(&format!("  T scales s and t by {scale}"));
                }
            }
            (name, UniformValue::Vec4(plane)) if name.starts_with("side_plane_") => {
                let index = &name["side_plane_".len()..];
                out.line(&format!("\nPlane of guard = \"texture-1d\" of light {index}"));
                out.line("  GL_EYE_LINEAR for s, loaded under modelview_po = I");
                out.rows(&[plane.as_dvec4()]);
            }
            ("clip_planes", UniformValue::Vec4Array(planes)) => {
                out.line(&format!("\nClip planes of {names}"));
                out.line("  in eye space, as glClipPlane has them under modelview = I");
                out.rows(&planes.iter().map(|plane| plane.as_dvec4()).collect::<Vec<_>>());
            }
            _ => continue,
        }
        found.push(out.0.trim_end_matches('\n').to_owned());
    }
    found
}

/// Text that is appended to.
struct Text(String);

impl Text {
    fn line(&mut self, text: &str) {
        self.0.push_str(text);
        self.0.push('\n');
    }

    fn matrix(&mut self, name: &str, matrix: &DMat4) {
        self.line(&format!("  {name}"));
        self.rows(&[0, 1, 2, 3].map(|row| matrix.row(row)));
    }

    fn rows(&mut self, rows: &[DVec4]) {
        for row in rows {
            self.0.push_str("   ");
            for number in row.to_array() {
                // Writing into a string cannot fail.
                let _ = write!(self.0, " {:>14}", shown(number));
            }
            self.0.push('\n');
        }
    }

    fn light(&mut self, light: &LightMatrices, eye_from_world: DMat4) {
        match light.kind {
            "photograph" => self.line(&format!("\nPhotograph {}: its camera is the light", light.index)),
            kind => self.line(&format!("\nLight {} \"{}\" ({kind})", light.index, light.name.escape_default())),
        }
        let Some(coordinates) = &light.coordinates else {
            self.line("  no texture coordinates: nothing is looked up by them, and nothing bounds its reach");
            return;
        };
        if !light.faces.is_empty() {
            self.cube(&light.faces);
        }
        let biased = coordinates.receiver_bias != DMat4::IDENTITY;
        self.matrix("S, texture_from_light_clip", &coordinates.texture_from_light_clip);
        if biased {
            self.matrix("B, receiver_bias: receivers are moved towards the light before S", &coordinates.receiver_bias);
        }
        self.matrix("P_light, light_clip_from_light", &coordinates.light_clip_from_light);
        self.matrix("L^-1, light_from_world", &coordinates.light_from_world);
        for (number, (set_up, key)) in ["i", "ii", "iii", "iv"].into_iter().zip(SET_UPS) {
            let used = if set_up == coordinates.set_up { ", which this scene uses" } else { "" };
            self.line(&format!("  Set-up ({number}), texgen = \"{key}\"{used}"));
            let words = words(set_up, coordinates.split, biased);
            match texgen::set_up(&coordinates.spaces(eye_from_world), set_up, coordinates.split) {
                Some(texgen) => self.set_up(&texgen, &words),
                None => self.line("    a matrix of it has no inverse"),
            }
        }
    }

    fn cube(&mut self, faces: &[FaceMatrices]) {
        self.line("  The map is a cube [GL 4.6, 8.13]. It is looked up by (s, t, r), the way from the light, below.");
        self.line("  Each face is drawn with gl_Position = P_light L^-1 x_world:");
        for FaceMatrices { face, face_clip_from_face, face_from_world } in faces {
            let name = face.name();
            self.line(&format!("  Face {name}"));
            self.matrix(&format!("P_light of {name}, face_clip_from_face"), face_clip_from_face);
            self.matrix(&format!("L^-1 of {name}, face_from_world"), face_from_world);
        }
    }

    fn set_up(&mut self, texgen: &Texgen, [planes, modelview, texture_matrix]: &[String; 3]) {
        self.line(&format!(
            "  E_po = {planes}: rows s, t, r, q, loaded while the modelview is modelview_po = {modelview}"
        ));
        self.matrix("E_po", &texgen.planes);
        self.matrix("modelview_po", &texgen.modelview);
        self.matrix("E_e = E_po modelview_po^-1", &texgen.eye_planes);
        self.matrix(&format!("T = {texture_matrix}"), &texgen.texture_matrix);
    }
}

/// E_po, modelview_po and T in the document's letters.
fn words(set_up: SetUp, split: Split, biased: bool) -> [String; 3] {
    let s = if biased { "S B" } else { "S" };
    let s_inverse = if biased { "B^-1 S^-1" } else { "S^-1" };
    let (texture_matrix, left, left_inverse) = match split {
        Split::Planes => (String::from("I"), format!("{s} P_light"), format!("P_light^-1 {s_inverse}")),
        Split::ScaleBias => (s.to_owned(), String::from("P_light"), String::from("P_light^-1")),
        Split::Projection => (format!("{s} P_light"), String::new(), String::new()),
    };
    let product = |text: String| if text.trim().is_empty() { String::from("I") } else { text.trim().to_owned() };
    let (planes, modelview) = match set_up {
        SetUp::Eye => (format!("{left} L^-1 V"), String::from("I")),
        SetUp::World => (format!("{left} L^-1"), String::from("V^-1")),
        SetUp::Light => (left, String::from("V^-1 L")),
        SetUp::Identity => (String::from("I"), format!("V^-1 L {left_inverse}")),
    };
    [product(planes), product(modelview), texture_matrix]
}

/// Eight significant digits, without an exponent where that is short.
fn shown(number: f64) -> String {
    if number == 0.0 {
        return String::from("0");
    }
    let exponent = number.abs().log10().floor();
    if !(-4.0..8.0).contains(&exponent) {
        return format!("{number:.7e}");
    }
    let decimals = (7.0 - exponent) as usize;
    let fixed = format!("{number:.decimals$}");
    if fixed.contains('.') { fixed.trim_end_matches('0').trim_end_matches('.').to_owned() } else { fixed }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_keep_eight_digits() {
        for (number, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (0.5, "0.5"),
            (-1.0, "-1"),
            (1.0 / 3.0, "0.33333333"),
            (1024.0, "1024"),
            (123456.789, "123456.79"),
            (-0.000_123_456_789, "-0.00012345679"),
            (1e-9, "1.0000000e-9"),
            (-2.5e12, "-2.5000000e12"),
        ] {
            assert_eq!(shown(number), text);
        }
    }

    #[test]
    fn products_are_the_documents() {
        let all = |split| SET_UPS.map(|(set_up, _)| words(set_up, split, false));
        let plain = all(Split::Planes);
        let expected = [
            ["S P_light L^-1 V", "I", "I"],
            ["S P_light L^-1", "V^-1", "I"],
            ["S P_light", "V^-1 L", "I"],
            ["I", "V^-1 L P_light^-1 S^-1", "I"],
        ];
        assert_eq!(plain, expected.map(|words| words.map(String::from)));
        assert_eq!(all(Split::Projection)[2], ["I", "V^-1 L", "S P_light"].map(String::from));
        assert_eq!(words(SetUp::Identity, Split::ScaleBias, true), ["I", "V^-1 L P_light^-1", "S B"].map(String::from));
    }
}
