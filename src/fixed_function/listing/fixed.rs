//! A batch by the fixed-function pipeline: its layers, each with its texture units, primary colour, tests and blending.

use glam::{DMat4, Mat4};

use super::super::layer::{
    AlphaSource, Combine, Layer, LayerBlend, LayerLighting, Operand, Primary, Unit, UnitCoordinates, UnitImage,
};
use super::super::{bounds, reading, tangent_vectors};
use super::c::{self, float, floats, vector};
use super::state::ListingState;
use super::{Listing, names};
use crate::geometry::Placement;
use crate::pass::{Batch, Channels, Draw, DrawPass, DrawState, Sampler, Wrap};

const COORDINATES: [&str; 4] = ["S", "T", "R", "Q"];

impl<'a> Listing<'a> {
    pub(super) fn fixed_batch(&mut self, pass: &DrawPass, batch: &'a Batch, now: &mut ListingState) {
        // The list was checked before.
        for (number, layer) in reading::layers(batch, pass.state.blend).unwrap_or_default().into_iter().enumerate() {
            self.title(&format!("{}: {}", names(batch), layer.name));
            self.set_layer(layer.state(number, &batch.state(&pass.state)), &layer, now);
            self.body.load_matrix("GL_MODELVIEW", &DMat4::IDENTITY);
            for (index, unit) in layer.units.iter().enumerate() {
                self.unit(index, unit, batch);
            }
            self.primary(&layer.primary);
            if let Some((test, reference)) = layer.alpha_test {
                self.body.call("glEnable(GL_ALPHA_TEST)");
                self.body.call(&format!("glAlphaFunc({}, {})", c::compare(test), float(reference)));
            }
            for draw in &batch.draws {
                self.title(&draw.label);
                self.matrices(batch, draw);
                self.mirror(now, draw.mirrored);
                let mesh = self.bind_mesh(draw);
                self.tangent_vectors(mesh, &layer, draw);
                self.draw_elements(draw);
            }
            self.take_down(&layer, now);
        }
    }

    /// Raster state of a layer, and its blending.
    fn set_layer(&mut self, state: DrawState, layer: &Layer, now: &mut ListingState) {
        self.change(now, ListingState::of(state));
        if keeps_alpha(&state, layer) {
            self.body.call("glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE)");
        }
        let factors = match layer.blend {
            LayerBlend::Replace => return,
            LayerBlend::Add => "GL_ONE, GL_ONE",
            LayerBlend::Erase => "GL_ZERO, GL_ZERO",
            LayerBlend::AddByStoredAlpha => "GL_DST_ALPHA, GL_ONE",
            LayerBlend::Multiply => "GL_DST_COLOR, GL_ZERO",
            LayerBlend::MultiplyAndStoreAlpha => "GL_DST_COLOR, GL_ZERO, GL_ONE, GL_ZERO",
        };
        let function =
            if layer.blend == LayerBlend::MultiplyAndStoreAlpha { "glBlendFuncSeparate" } else { "glBlendFunc" };
        self.body.call("glEnable(GL_BLEND)");
        self.body.call("glBlendEquation(GL_FUNC_ADD)");
        self.body.call(&format!("{function}({factors})"));
    }

    fn take_down(&mut self, layer: &Layer, now: &ListingState) {
        for (index, unit) in layer.units.iter().enumerate() {
            if let UnitCoordinates::Tangent(_) = unit.coordinates {
                self.body.call(&format!("glClientActiveTexture(GL_TEXTURE{index})"));
                self.body.call("glDisableClientState(GL_TEXTURE_COORD_ARRAY)");
            }
            self.body.call(&format!("disable_unit({index})"));
            self.objects.disables_units = true;
        }
        if let Primary::Lighting(lighting) = &layer.primary {
            self.body.call("glDisable(GL_LIGHTING)");
            (0..lighting.sources.len()).for_each(|index| self.body.call(&format!("glDisable(GL_LIGHT{index})")));
        }
        if layer.alpha_test.is_some() {
            self.body.call("glDisable(GL_ALPHA_TEST)");
        }
        if layer.blend != LayerBlend::Replace {
            self.body.call("glDisable(GL_BLEND)");
        }
        if keeps_alpha(&now.state, layer) {
            self.body.call("glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE)");
        }
    }

    fn unit(&mut self, index: usize, unit: &Unit, batch: &Batch) {
        let (name, sampler, alpha) = match unit.image {
            UnitImage::Mask(mask) => (format!("masks[{}]", self.objects.mask(mask)), None, AlphaSource::Own),
            UnitImage::Input { index, alpha } => {
                let Some(input) = batch.inputs.get(index) else { return };
                (format!("images[{}]", input.image.0), Some(input.sampler), alpha)
            }
            UnitImage::Cube(index) => {
                let Some(input) = batch.inputs.get(index) else { return };
                (format!("images[{}]", input.image.0), Some(input.sampler), AlphaSource::Own)
            }
        };
        let target = if let UnitImage::Cube(_) = unit.image { "GL_TEXTURE_CUBE_MAP" } else { "GL_TEXTURE_2D" };
        self.body.call(&format!("glActiveTexture(GL_TEXTURE{index})"));
        self.body.call(&format!("glBindTexture({target}, {name})"));
        self.body.call(&format!("glEnable({target})"));
        if let Some(sampler) = sampler {
            self.sampling(target, sampler, alpha);
        }
        self.coordinates(&unit.coordinates, &unit.placement);
        self.combiners(unit);
    }

    /// By the texture's own parameters. A comparison's result becomes RGB, and alpha where that is wanted.
    fn sampling(&mut self, target: &str, sampler: Sampler, alpha: AlphaSource) {
        let [min, mag] = c::filters(sampler.filter);
        let mut set = |name: &str, value: &str| {
            self.body.call(&format!("glTexParameteri({target}, GL_TEXTURE_{name}, {value})"));
        };
        set("MIN_FILTER", min);
        set("MAG_FILTER", mag);
        set("WRAP_S", c::wrap(sampler.wrap));
        set("WRAP_T", c::wrap(sampler.wrap));
        if target == "GL_TEXTURE_CUBE_MAP" {
            set("WRAP_R", c::wrap(sampler.wrap));
        }
        match sampler.compare {
            Some(compare) => {
                set("COMPARE_MODE", "GL_COMPARE_REF_TO_TEXTURE");
                set("COMPARE_FUNC", c::compare(compare));
                let mode = if alpha == AlphaSource::Comparison { "GL_INTENSITY" } else { "GL_LUMINANCE" };
                self.body.call(&format!("glTexParameteri(GL_TEXTURE_2D, GL_DEPTH_TEXTURE_MODE, {mode})"));
            }
            None => set("COMPARE_MODE", "GL_NONE"),
        }
        if alpha == AlphaSource::Red {
            self.body.call("glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_A, GL_RED)");
        }
        if let Wrap::ClampToBorder(border) = sampler.wrap {
            let color = vector(&border.color());
            self.body.call(&format!("glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, {color})"));
        }
    }

    fn coordinates(&mut self, coordinates: &UnitCoordinates, placement: &Placement) {
        if let UnitCoordinates::EyeLinear(eye_linear) = coordinates {
            let planes = self.objects.planes(&eye_linear.planes, &eye_linear.modelview);
            self.body.load_matrix("GL_TEXTURE", &eye_linear.texture_matrix);
            self.body.call(&format!("load_planes_{planes}()"));
            COORDINATES.iter().for_each(|name| self.body.call(&format!("glEnable(GL_TEXTURE_GEN_{name})")));
            return;
        }
        self.body.load_matrix("GL_TEXTURE", &DMat4::IDENTITY);
        let [scale_s, scale_t, offset_s, offset_t] = placement.scale_and_offset();
        if !placement.is_plain() {
            self.body.call(&format!("glTranslatef({}, 0.0f)", floats(&[offset_s, offset_t])));
            self.body.call(&format!("glScalef({}, 1.0f)", floats(&[scale_s, scale_t])));
        }
        if let UnitCoordinates::ObjectLinear(generated) = coordinates {
            let scale = float(generated.scale);
            self.body.call(&format!("glScalef({scale}, {scale}, 1.0f)"));
            for (name, plane) in COORDINATES.iter().zip([generated.s, generated.t]) {
                self.body.call(&format!("glTexGeni(GL_{name}, GL_TEXTURE_GEN_MODE, GL_OBJECT_LINEAR)"));
                self.body.call(&format!("glTexGenfv(GL_{name}, GL_OBJECT_PLANE, {})", vector(&plane)));
                self.body.call(&format!("glEnable(GL_TEXTURE_GEN_{name})"));
            }
        }
    }

    /// Binds vectors of a mesh's vertices in tangent space to the units that look them up.
    fn tangent_vectors(&mut self, mesh: usize, layer: &Layer, draw: &Draw) {
        for (index, unit) in layer.units.iter().enumerate() {
            let UnitCoordinates::Tangent(tangent) = unit.coordinates else { continue };
            let [light, eye] = tangent_vectors::in_model(draw, tangent).map(|point| vector(&point.to_array()));
            let eye = if tangent.half { eye } else { String::from("NULL") };
            self.objects.uses_tangent_vectors = true;
            self.body.call("glBindBuffer(GL_ARRAY_BUFFER, 0)");
            self.body.call(&format!("glClientActiveTexture(GL_TEXTURE{index})"));
            self.body.call(&format!("glTexCoordPointer(3, GL_FLOAT, 0, tangent_vectors({mesh}, {light}, {eye}))"));
            self.body.call("glEnableClientState(GL_TEXTURE_COORD_ARRAY)");
        }
    }

    fn combiners(&mut self, unit: &Unit) {
        let mut set =
            |name: &str, value: &str| self.body.call(&format!("glTexEnvi(GL_TEXTURE_ENV, GL_{name}, {value})"));
        set("TEXTURE_ENV_MODE", "GL_COMBINE");
        for (channel, combine) in [("RGB", unit.rgb), ("ALPHA", unit.alpha)] {
            let (function, operands) = match combine {
                Combine::Replace(a) => ("GL_REPLACE", vec![a]),
                Combine::Modulate(a, b) => ("GL_MODULATE", vec![a, b]),
                Combine::Subtract(a, b) => ("GL_SUBTRACT", vec![a, b]),
                Combine::Interpolate(a, b, by) => ("GL_INTERPOLATE", vec![a, b, by]),
                Combine::Dot3Rgba(a, b) => ("GL_DOT3_RGBA", vec![a, b]),
                Combine::Dot3Rgb(a, b) => ("GL_DOT3_RGB", vec![a, b]),
            };
            set(&format!("COMBINE_{channel}"), function);
            for (number, operand) in operands.into_iter().enumerate() {
                let alpha = channel == "ALPHA" || operand.is_alpha();
                set(&format!("SRC{number}_{channel}"), &operand_name(operand));
                set(&format!("OPERAND{number}_{channel}"), if alpha { "GL_SRC_ALPHA" } else { "GL_SRC_COLOR" });
            }
        }
        let (constant, rgb_scale, scale) = (vector(&unit.constant), float(unit.rgb_scale), float(unit.alpha_scale));
        self.body.call(&format!("glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, {constant})"));
        self.body.call(&format!("glTexEnvf(GL_TEXTURE_ENV, GL_RGB_SCALE, {rgb_scale})"));
        self.body.call(&format!("glTexEnvf(GL_TEXTURE_ENV, GL_ALPHA_SCALE, {scale})"));
    }

    fn primary(&mut self, primary: &Primary) {
        match primary {
            Primary::Color(color) => self.body.call(&format!("glColor4f({})", floats(color))),
            Primary::Lighting(lighting) => self.lighting(lighting),
        }
    }

    /// The modelview is the identity: positions are in eye space.
    fn lighting(&mut self, lighting: &LayerLighting) {
        let opaque = |[r, g, b]: [f32; 3]| vector(&[r, g, b, 1.0]);
        for what in ["LIGHTING", "NORMALIZE"] {
            self.body.call(&format!("glEnable(GL_{what})"));
        }
        self.body.call(&format!("glLightModelfv(GL_LIGHT_MODEL_AMBIENT, {})", opaque([0.0; 3])));
        let [r, g, b] = lighting.diffuse;
        for (name, color) in [
            ("EMISSION", opaque(lighting.emission)),
            ("AMBIENT", opaque(lighting.ambient)),
            ("DIFFUSE", vector(&[r, g, b, lighting.opacity])),
            ("SPECULAR", opaque(lighting.specular)),
        ] {
            self.body.call(&format!("glMaterialfv(GL_FRONT_AND_BACK, GL_{name}, {color})"));
        }
        self.body.call(&format!("glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, {})", float(lighting.shininess)));
        for (index, source) in lighting.sources.iter().enumerate() {
            self.body.call(&format!("glEnable(GL_LIGHT{index})"));
            for (name, value) in [
                ("POSITION", vector(&source.position)),
                ("AMBIENT", opaque(source.ambient)),
                ("DIFFUSE", opaque(source.diffuse)),
                ("SPECULAR", opaque(source.specular)),
            ] {
                self.body.call(&format!("glLightfv(GL_LIGHT{index}, GL_{name}, {value})"));
            }
            for (name, value) in ["CONSTANT", "LINEAR", "QUADRATIC"].iter().zip(source.attenuation) {
                self.body.call(&format!("glLightf(GL_LIGHT{index}, GL_{name}_ATTENUATION, {})", float(value)));
            }
        }
    }

    /// A draw without eye space has all of its transform in the projection.
    fn matrices(&mut self, batch: &Batch, draw: &Draw) {
        let (projection, modelview) = match (batch.meaning.clip_from_eye(), bounds::eye_from_model(draw)) {
            (Some(clip_from_eye), Ok(eye_from_model)) => (clip_from_eye, eye_from_model),
            _ => (draw.clip_from_model, Mat4::IDENTITY),
        };
        self.body.load_matrix("GL_PROJECTION", &projection);
        self.body.load_matrix("GL_MODELVIEW", &modelview.as_dmat4());
    }
}

/// Tests whether a layer leaves alpha alone that its pass would write.
fn keeps_alpha(state: &DrawState, layer: &Layer) -> bool {
    state.color_write == Channels::All && !layer.alpha_write
}

fn operand_name(operand: Operand) -> String {
    String::from(match operand {
        Operand::Texture => "GL_TEXTURE",
        Operand::Constant | Operand::ConstantAlpha => "GL_CONSTANT",
        Operand::Primary => "GL_PRIMARY_COLOR",
        Operand::Previous | Operand::PreviousAlpha => "GL_PREVIOUS",
        Operand::Other(unit) | Operand::OtherAlpha(unit) => return format!("GL_TEXTURE{unit}"),
    })
}
