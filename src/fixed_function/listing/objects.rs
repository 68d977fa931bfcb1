//! Objects that the passes use: images, samplers, framebuffers, planes, and those that the caller must bring.

use glam::DMat4;

use super::super::layer::Mask;
use super::c::{self, Text, comment, vector};
use crate::pass::{
    CubeFace, Format, ImageDesc, ImageId, IndexOrder, MeshRef, PassList, Program, Sampler, Storage, Target, Wrap,
};

/// Each kind in the order in which the passes first need one.
#[derive(Default)]
pub struct Objects<'a> {
    programs: Vec<&'a Program>,
    meshes: Vec<(&'a MeshRef, IndexOrder)>,
    samplers: Vec<Sampler>,
    framebuffers: Vec<Target>,
    masks: Vec<Mask>,
    /// Texgen planes, and the modelview under which they are loaded.
    planes: Vec<(DMat4, DMat4)>,
    pub uses_eye_planes: bool,
    pub disables_units: bool,
    pub uses_tangent_vectors: bool,
}

/// The place of a value, which is added where it is new.
fn place<T: PartialEq>(list: &mut Vec<T>, value: T) -> usize {
    list.iter().position(|each| *each == value).unwrap_or_else(|| {
        list.push(value);
        list.len() - 1
    })
}

impl<'a> Objects<'a> {
    pub fn program(&mut self, program: &'a Program) -> usize {
        place(&mut self.programs, program)
    }

    pub fn mesh(&mut self, mesh: &'a MeshRef, order: IndexOrder) -> usize {
        place(&mut self.meshes, (mesh, order))
    }

    pub fn sampler(&mut self, sampler: Sampler) -> usize {
        place(&mut self.samplers, sampler)
    }

    pub fn framebuffer(&mut self, target: Target) -> usize {
        place(&mut self.framebuffers, target)
    }

    pub fn mask(&mut self, mask: Mask) -> usize {
        place(&mut self.masks, mask)
    }

    pub fn planes(&mut self, planes: &DMat4, modelview: &DMat4) -> usize {
        place(&mut self.planes, (*planes, *modelview))
    }

    /// Declares the objects that the caller brings, then defines all others and `create`.
    pub fn write(&mut self, list: &PassList, out: &mut Text) {
        self.declare(list, out);
        let arrays = [
            ("images", list.images.len()),
            ("samplers", self.samplers.len()),
            ("masks", self.masks.len()),
            ("framebuffers", self.framebuffers.len()),
        ];
        for (name, count) in arrays.into_iter().filter(|(_, count)| *count > 0) {
            out.line(&format!("static GLuint {name}[{count}];"));
        }
        for (index, (planes, modelview)) in self.planes.iter().enumerate() {
            write_planes(out, index, planes, modelview);
        }
        if self.uses_eye_planes {
            out.line(USE_EYE_PLANES);
        }
        if self.disables_units {
            out.line(DISABLE_UNIT);
        }
        out.line("\nvoid create(void)\n{");
        out.call("glDisable(GL_DITHER)");
        if list.images.iter().any(|desc| matches!(desc.storage, Storage::Cube(_) | Storage::UnitVectors)) {
            out.call("glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS)");
        }
        list.images.iter().enumerate().for_each(|(index, desc)| write_image(out, index, desc));
        self.masks.iter().enumerate().for_each(|(index, mask)| write_mask(out, index, *mask));
        self.samplers.iter().enumerate().for_each(|(index, sampler)| write_sampler(out, index, *sampler));
        self.framebuffers.iter().enumerate().for_each(|(index, target)| write_framebuffer(out, index, *target, list));
        out.line("}");
    }

    fn declare(&self, list: &PassList, out: &mut Text) {
        out.line("\n/* The caller brings: */");
        if !self.programs.is_empty() {
            out.line("/* the programs of glumbra plan --shaders, of the same scene, in its order */");
            for (index, program) in self.programs.iter().enumerate() {
                out.line(&format!("/*   programs[{index}]: {} */", comment(&program.label)));
            }
            out.line(&format!("extern const GLuint programs[{}];", self.programs.len()));
        }
        out.line("/* a function that binds a mesh's vertex arrays and its index buffer */");
        for (index, (mesh, order)) in self.meshes.iter().enumerate() {
            let order = if *order == IndexOrder::VertexCache { ", in vertex-cache order" } else { "" };
            let vertices = mesh.positions.len() + mesh.homogeneous.len();
            let (name, indices) = (comment(&mesh.name), mesh.indices.len());
            out.line(&format!("/*   mesh {index}: {name}, {vertices} vertices, {indices} indices{order} */"));
        }
        out.line("extern void bind_mesh(int mesh);");
        let has_levels = |desc: &&ImageDesc| matches!(desc.storage, Storage::Levels(_) | Storage::UnitVectors);
        if list.images.iter().any(|desc| has_levels(&desc)) {
            out.line("/* a function that answers with the RGBA texels of one level, rows from the bottom up; for a cube map of");
            out.line("   unit vectors v the level is the face, and texels are 255 (v / 2 + 1 / 2) in their middles */");
            for (index, desc) in list.images.iter().enumerate().filter(|(_, desc)| has_levels(desc)) {
                out.line(&format!("/*   image {index}: {} */", comment(&desc.label)));
            }
            out.line("extern const void *level_texels(int image, int level);");
        }
        let uploads = |desc: &&ImageDesc| matches!(desc.storage, Storage::Uploaded(_));
        if list.images.iter().any(|desc| uploads(&desc)) {
            out.line("/* a function that answers with an image's RGBA8 texels, rows from the bottom up */");
            for (index, desc) in list.images.iter().enumerate().filter(|(_, desc)| uploads(desc)) {
                out.line(&format!("/*   image {index}: {} */", comment(&desc.label)));
            }
            out.line("extern const void *texels(int image);");
        }
        if self.uses_tangent_vectors {
            out.line(TANGENT_VECTORS);
        }
        out.line("");
    }
}

const TANGENT_VECTORS: &str = "/* a function that answers with a vector of three for each vertex of a mesh: d . T, d . B and d . N of its tangents,
   bitangents and normals, where d leads from the vertex to the light, xyz - w position, in model space; with an eye, the
   sum of this vector and the same one to the eye, both of unit length */
extern const GLfloat *tangent_vectors(int mesh, const GLfloat light[4], const GLfloat eye[4]);";

const USE_EYE_PLANES: &str = "
/* Gives a program the eye planes that GL keeps, E_e = E_po modelview_po^-1. */
static void use_eye_planes(GLuint program, const char *name)
{
    GLfloat planes[16];
    glGetTexGenfv(GL_S, GL_EYE_PLANE, planes);
    glGetTexGenfv(GL_T, GL_EYE_PLANE, planes + 4);
    glGetTexGenfv(GL_R, GL_EYE_PLANE, planes + 8);
    glGetTexGenfv(GL_Q, GL_EYE_PLANE, planes + 12);
    glUniform4fv(glGetUniformLocation(program, name), 4, planes);
}";

const DISABLE_UNIT: &str = "
static void disable_unit(int unit)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_TEXTURE_CUBE_MAP);
    glDisable(GL_TEXTURE_GEN_S);
    glDisable(GL_TEXTURE_GEN_T);
    glDisable(GL_TEXTURE_GEN_R);
    glDisable(GL_TEXTURE_GEN_Q);
    glMatrixMode(GL_TEXTURE);
    glLoadIdentity();
}";

/// The planes as specified, while the modelview is that of their own space.
fn write_planes(out: &mut Text, index: usize, planes: &DMat4, modelview: &DMat4) {
    out.line("\n/* E_po of the active texture unit, loaded while the modelview is modelview_po. */");
    out.line(&format!("static void load_planes_{index}(void)\n{{"));
    out.load_matrix("GL_MODELVIEW", modelview);
    let rows = planes.as_mat4().transpose();
    for (name, row) in ["S", "T", "R", "Q"].iter().zip([rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis]) {
        out.call(&format!("glTexGeni(GL_{name}, GL_TEXTURE_GEN_MODE, GL_EYE_LINEAR)"));
        out.call(&format!("glTexGenfv(GL_{name}, GL_EYE_PLANE, {})", vector(&row.to_array())));
    }
    if *modelview != DMat4::IDENTITY {
        out.call("glLoadIdentity()");
    }
    out.line("}");
}

fn write_image(out: &mut Text, index: usize, desc: &ImageDesc) {
    let [internal, format, kind] = c::format(desc.format);
    let [width, height] = desc.size;
    let binding = c::binding(&desc.storage);
    out.line(&format!("    /* {} */", comment(&desc.label)));
    if let Storage::Renderbuffer = desc.storage {
        out.call(&format!("glGenRenderbuffers(1, &images[{index}])"));
        out.call(&format!("glBindRenderbuffer(GL_RENDERBUFFER, images[{index}])"));
        return out.call(&format!("glRenderbufferStorage(GL_RENDERBUFFER, {internal}, {width}, {height})"));
    }
    out.call(&format!("glGenTextures(1, &images[{index}])"));
    out.call(&format!("glBindTexture({binding}, images[{index}])"));
    let mut allocate = |target: &str, level: u32, texels: &str| {
        let [width, height] = [(width >> level).max(1), (height >> level).max(1)];
        out.call(&format!(
            "glTexImage2D({target}, {level}, {internal}, {width}, {height}, 0, {format}, {kind}, {texels})"
        ));
    };
    let levels = match &desc.storage {
        Storage::Uploaded(_) => {
            allocate(binding, 0, &format!("texels({index})"));
            return out.call(&format!("glGenerateMipmap({binding})"));
        }
        Storage::Levels(map) => {
            (0..map.levels.len() as u32)
                .for_each(|level| allocate(binding, level, &format!("level_texels({index}, {level})")));
            map.levels.len() as u32
        }
        Storage::UnitVectors => {
            for (number, face) in CubeFace::ALL.iter().enumerate() {
                allocate(c::face_name(*face), 0, &format!("level_texels({index}, {number})"));
            }
            1
        }
        Storage::Line(texels) => {
            let bytes: Vec<String> = texels.iter().flatten().map(u8::to_string).collect();
            let texels = format!("(const GLubyte[]){{{}}}", bytes.join(", "));
            out.call(&format!("glTexImage1D({binding}, 0, {internal}, {width}, 0, {format}, {kind}, {texels})"));
            1
        }
        Storage::Values(values) => {
            let numbers: Vec<String> = values.iter().map(|value| format!("{value:?}f")).collect();
            let texels = format!("(const GLfloat[]){{{}}}", numbers.join(", "));
            out.call(&format!("glTexImage1D({binding}, 0, {internal}, {width}, 0, {format}, {kind}, {texels})"));
            1
        }
        Storage::Cube(_) => {
            CubeFace::ALL.iter().for_each(|face| allocate(c::face_name(*face), 0, "NULL"));
            1
        }
        Storage::Mipmapped(levels) => {
            (0..*levels).for_each(|level| allocate(binding, level, "NULL"));
            *levels
        }
        Storage::Texture | Storage::Renderbuffer => {
            allocate(binding, 0, "NULL");
            1
        }
    };
    out.call(&format!("glTexParameteri({binding}, GL_TEXTURE_MAX_LEVEL, {})", levels - 1));
    if let Storage::Cube(cube) = &desc.storage {
        for (face, _) in CubeFace::ALL.iter().zip(cube.drawn).filter(|(_, drawn)| !drawn) {
            write_undrawn_face(out, index, *face, cube.rest);
        }
    }
}

/// A face that no pass draws is cleared, once.
fn write_undrawn_face(out: &mut Text, index: usize, face: CubeFace, depth: f32) {
    let name = c::face_name(face);
    out.line("    {\n        GLuint cleared;");
    for call in [
        String::from("glGenFramebuffers(1, &cleared)"),
        String::from("glBindFramebuffer(GL_FRAMEBUFFER, cleared)"),
        format!("glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, {name}, images[{index}], 0)"),
        String::from("glDrawBuffer(GL_NONE)"),
        String::from("glReadBuffer(GL_NONE)"),
        format!("glClearDepth({depth:?})"),
        String::from("glClear(GL_DEPTH_BUFFER_BIT)"),
        String::from("glDeleteFramebuffers(1, &cleared)"),
    ] {
        out.line(&format!("        {call};"));
    }
    out.line("    }");
}

/// A small texture that says where a light reaches.
fn write_mask(out: &mut Text, index: usize, mask: Mask) {
    let (size, texels, filter, wrap): ([u32; 2], &[[f32; 4]], _, _) = match mask {
        Mask::White => ([1, 1], &[[1.0; 4]], "GL_NEAREST", "GL_CLAMP_TO_EDGE"),
        Mask::Square => ([1, 1], &[[1.0; 4]], "GL_NEAREST", "GL_CLAMP_TO_BORDER"),
        Mask::Step => ([2, 1], &[[0.0; 4], [1.0; 4]], "GL_NEAREST", "GL_CLAMP_TO_EDGE"),
        Mask::Ramp => {
            const CORNERS: &[[f32; 4]] =
                &[[0.0, 0.0, 0.5, 1.0], [1.0, 0.0, 0.5, 1.0], [0.0, 1.0, 0.5, 1.0], [1.0, 1.0, 0.5, 1.0]];
            ([2, 2], CORNERS, "GL_LINEAR", "GL_CLAMP_TO_EDGE")
        }
    };
    let what = match mask {
        Mask::White => "1 everywhere",
        Mask::Square => "1 inside [0, 1] x [0, 1], 0 outside",
        Mask::Step => "0 for s < 0.5, 1 from there on",
        Mask::Ramp => "s and t, for a dot product",
    };
    let ([width, height], texels) = (size, vector(texels.as_flattened()));
    out.line(&format!("    /* {what} */"));
    out.call(&format!("glGenTextures(1, &masks[{index}])"));
    out.call(&format!("glBindTexture(GL_TEXTURE_2D, masks[{index}])"));
    out.call(&format!("glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, {width}, {height}, 0, GL_RGBA, GL_FLOAT, {texels})"));
    for (name, value) in
        [("MAX_LEVEL", "0"), ("MIN_FILTER", filter), ("MAG_FILTER", filter), ("WRAP_S", wrap), ("WRAP_T", wrap)]
    {
        out.call(&format!("glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_{name}, {value})"));
    }
}

fn write_sampler(out: &mut Text, index: usize, sampler: Sampler) {
    let [min, mag] = c::filters(sampler.filter);
    let wrap = c::wrap(sampler.wrap);
    out.call(&format!("glGenSamplers(1, &samplers[{index}])"));
    let set = |out: &mut Text, name: &str, value: &str| {
        out.call(&format!("glSamplerParameteri(samplers[{index}], GL_TEXTURE_{name}, {value})"));
    };
    for (name, value) in [("MIN_FILTER", min), ("MAG_FILTER", mag), ("WRAP_S", wrap), ("WRAP_T", wrap)] {
        set(out, name, value);
    }
    if let Wrap::ClampToBorder(border) = sampler.wrap {
        let color = vector(&border.color());
        out.call(&format!("glSamplerParameterfv(samplers[{index}], GL_TEXTURE_BORDER_COLOR, {color})"));
    }
    if let Some(compare) = sampler.compare {
        set(out, "COMPARE_MODE", "GL_COMPARE_REF_TO_TEXTURE");
        set(out, "COMPARE_FUNC", c::compare(compare));
    }
    if let Some(halves) = sampler.lod_halves {
        for name in ["MIN_LOD", "MAX_LOD"] {
            let lod = c::float(0.5 * f32::from(halves));
            out.call(&format!("glSamplerParameterf(samplers[{index}], GL_TEXTURE_{name}, {lod})"));
        }
    }
}

fn write_framebuffer(out: &mut Text, index: usize, target: Target, list: &PassList) {
    out.call(&format!("glGenFramebuffers(1, &framebuffers[{index}])"));
    out.call(&format!("glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[{index}])"));
    match target.color {
        Some(color) => attach(out, "GL_COLOR_ATTACHMENT0", color, target, list),
        None => {
            out.call("glDrawBuffer(GL_NONE)");
            out.call("glReadBuffer(GL_NONE)");
        }
    }
    if let Some(depth) = target.depth {
        let point = match list.desc(depth).format {
            Format::Depth24Stencil8 => "GL_DEPTH_STENCIL_ATTACHMENT",
            _ => "GL_DEPTH_ATTACHMENT",
        };
        attach(out, point, depth, target, list);
    }
}

fn attach(out: &mut Text, point: &str, image: ImageId, target: Target, list: &PassList) {
    let name = format!("images[{}]", image.0);
    out.call(&match &list.desc(image).storage {
        Storage::Renderbuffer => {
            format!("glFramebufferRenderbuffer(GL_FRAMEBUFFER, {point}, GL_RENDERBUFFER, {name})")
        }
        storage => {
            let face = target.face.filter(|_| matches!(storage, Storage::Cube(_)));
            let texture = face.map_or(c::binding(storage), c::face_name);
            format!("glFramebufferTexture2D(GL_FRAMEBUFFER, {point}, {texture}, {name}, {})", target.level)
        }
    });
}
