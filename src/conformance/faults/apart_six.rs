//! Faults of a sixth measure, by a hand that had seen no rule: images, framebuffers and rasters. Each has a sentence on how a
//! driver comes by it.

use std::num::NonZeroU32;

use glow::HasContext;

use super::{Call, text};

/// Texture units that are looked at.
const UNITS: u32 = 8;
/// Sampler object of the active unit.
const SAMPLER_BINDING: u32 = 0x8919;
const WRAPS: [u32; 2] = [glow::TEXTURE_WRAP_S, glow::TEXTURE_WRAP_T];

/// Does something with each texture unit active.
fn on_units(call: &Call, mut act: impl FnMut(&Call)) {
    let active = f64::from(call.get(glow::ACTIVE_TEXTURE));
    for unit in 0..UNITS {
        call.other("glActiveTexture", &[f64::from(glow::TEXTURE0 + unit)]);
        act(call);
    }
    call.other("glActiveTexture", &[active]);
}

/// Depths of the near and the far plane in the window.
fn depth_range(call: &Call) -> [f32; 2] {
    let mut range = [0.0; 2];
    // SAFETY: the context is current; the range has two numbers.
    unsafe { call.gl().get_parameter_f32_slice(glow::DEPTH_RANGE, &mut range) };
    range
}

/// Tests whether a framebuffer object without colour is drawn into.
fn is_bare(call: &Call) -> bool {
    let kind = glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE;
    call.get(glow::DRAW_FRAMEBUFFER_BINDING) != 0 && call.attached(glow::COLOR_ATTACHMENT0, kind) == 0
}

/// Takes a sampler object off the unit that it was bound to before.
fn bind_once(call: &mut Call) {
    let (unit, sampler) = (call.u(0), call.u(1));
    let before = call.kept((20, sampler)) as u32;
    call.keep((21, unit), sampler);
    if sampler != 0 {
        call.keep((20, sampler), unit + 1);
        if before != 0 && before - 1 != unit && call.kept((21, before - 1)) == f64::from(sampler) {
            call.keep((21, before - 1), 0);
            call.other("glBindSampler", &[f64::from(before - 1), 0.0]);
        }
    }
}

/// Where the wrap modes of an active unit's 2D texture are: a sampler object, or the texture itself.
fn wraps(call: &Call) -> (Option<glow::NativeSampler>, [i32; 2]) {
    let sampler = NonZeroU32::new(call.get(SAMPLER_BINDING) as u32).map(glow::NativeSampler);
    // SAFETY: the context is current.
    let read = |name| unsafe {
        match sampler {
            Some(sampler) => call.gl().get_sampler_parameter_i32(sampler, name),
            None => call.gl().get_tex_parameter_i32(glow::TEXTURE_2D, name),
        }
    };
    (sampler, WRAPS.map(read))
}

fn set_wraps(call: &Call, sampler: Option<glow::NativeSampler>, modes: [i32; 2]) {
    for (name, mode) in WRAPS.into_iter().zip(modes) {
        // SAFETY: the context is current.
        unsafe {
            match sampler {
                Some(sampler) => call.gl().sampler_parameter_i32(sampler, name, mode),
                None => call.gl().tex_parameter_i32(glow::TEXTURE_2D, name, mode),
            }
        }
    }
}

/// Draws with 2D textures of sides that are no powers of two clamped where they repeat.
fn clamp_odd_sizes(call: &mut Call) {
    let mut found = Vec::new();
    on_units(call, |call| {
        let sides = [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(|name| call.level(0, name) as u32);
        let is_odd = call.get(glow::TEXTURE_BINDING_2D) != 0 && !sides.iter().all(|side| side.is_power_of_two());
        let (sampler, modes) = wraps(call);
        if is_odd && sides[0] > 0 && modes.contains(&(glow::REPEAT as i32)) {
            found.push((call.get(glow::ACTIVE_TEXTURE), sampler, modes));
        }
    });
    if found.is_empty() {
        return;
    }
    let active = f64::from(call.get(glow::ACTIVE_TEXTURE));
    let each = |call: &Call, change: &dyn Fn([i32; 2]) -> [i32; 2]| {
        for (unit, sampler, modes) in &found {
            call.other("glActiveTexture", &[f64::from(*unit)]);
            set_wraps(call, *sampler, change(*modes));
        }
        call.other("glActiveTexture", &[active]);
    };
    let clamped = |mode| if mode == glow::REPEAT as i32 { glow::CLAMP_TO_EDGE as i32 } else { mode };
    each(call, &|modes| modes.map(clamped));
    call.now();
    each(call, &|modes| modes);
}

/// Puts the corner of the first small level where the levels below it are.
fn alias_small_levels(call: &Call) {
    let size = |level| [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(|name| call.level(level, name).max(0) as usize);
    let Some(first) = (0..16).find(|level| size(*level).into_iter().max() <= Some(8)) else { return };
    let [width, height] = size(first);
    let mut texels = vec![0; 4 * width * height];
    let pixels = glow::PixelPackData::Slice(Some(&mut texels));
    // SAFETY: the context is current; the level's texels fill the bytes.
    unsafe { call.gl().get_tex_image(glow::TEXTURE_2D, first, glow::RGBA, glow::UNSIGNED_BYTE, pixels) };
    for level in first + 1.. {
        let [across, up] = size(level);
        if across == 0 {
            return;
        }
        let corner: Vec<u8> =
            texels.chunks_exact(4 * width).take(up).flat_map(|row| &row[..4 * across]).copied().collect();
        call.upload(level, [across as i32, up as i32], &corner);
    }
}

/// Maps the depths that a copy has brought by the depth range.
fn map_copied_depths(call: &mut Call) {
    call.now();
    let (target, level, [near, far]) = (call.u(0), call.i(1), depth_range(call));
    let gl = call.gl();
    // SAFETY: the context is current; a texture of this target is bound.
    let read = |name| unsafe { gl.get_tex_level_parameter_i32(target, level, name) };
    let size @ [width, height] = [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(read);
    if [near, far] == [0.0, 1.0] || read(glow::TEXTURE_DEPTH_SIZE) == 0 || size != [call.i(6), call.i(7)] {
        return;
    }
    let (format, kind) = (glow::DEPTH_COMPONENT, glow::FLOAT);
    let mut bytes = vec![0; 4 * width as usize * height as usize];
    // SAFETY: as above; the depths fill the bytes.
    unsafe { gl.get_tex_image(target, level, format, kind, glow::PixelPackData::Slice(Some(&mut bytes))) };
    for four in bytes.chunks_exact_mut(4) {
        let depth = f32::from_ne_bytes([four[0], four[1], four[2], four[3]]);
        four.copy_from_slice(&(near + (far - near) * depth).to_ne_bytes());
    }
    let pixels = glow::PixelUnpackData::Slice(Some(&bytes));
    // SAFETY: as above.
    unsafe { gl.tex_sub_image_2d(target, level, 0, 0, width, height, format, kind, pixels) };
}

/// Draws with the offset's units in those of 16 bits where depths are floats.
fn offset_floats_by_16_bits(call: &mut Call) {
    if call.enabled(glow::POLYGON_OFFSET_FILL) && call.depth_format().1 == glow::FLOAT {
        let [factor, units] = [glow::POLYGON_OFFSET_FACTOR, glow::POLYGON_OFFSET_UNITS].map(|name| call.float(name));
        call.other("glPolygonOffset", &[factor, 256.0 * units]);
        call.now();
        call.other("glPolygonOffset", &[factor, units]);
    }
}

/// Draws with the other face culled where the far plane is nearer in the window.
fn cull_by_depth_range(call: &mut Call) {
    let [near, far] = depth_range(call);
    let face = call.get(glow::CULL_FACE_MODE) as u32;
    if call.enabled(glow::CULL_FACE) && near > far && face != glow::FRONT_AND_BACK {
        let other = if face == glow::BACK { glow::FRONT } else { glow::BACK };
        call.other("glCullFace", &[f64::from(other)]);
        call.now();
        call.other("glCullFace", &[f64::from(face)]);
    }
}

/// Draws without writing stencil by a program whose shaders discard.
fn keep_stencil(call: &mut Call) {
    let discards = call.kept((21, call.get(glow::CURRENT_PROGRAM) as u32)) != 0.0;
    if discards && call.enabled(glow::STENCIL_TEST) {
        let mask = f64::from(call.get(glow::STENCIL_WRITEMASK) as u32 & 0xFF);
        call.other("glStencilMask", &[0.0]);
        call.now();
        call.other("glStencilMask", &[mask]);
    }
}

faults! {
    // The object keeps the one unit that it is bound to, for what must be told when a parameter changes.
    "sampler-bound-to-one-unit" [glBindSampler]
    "A sampler object that is bound to a unit leaves the one where it was bound before." { glBindSampler => bind_once }
    // The hardware repeats by the low bits of the coordinate, and other sizes were allowed later.
    "odd-sizes-never-repeat" [GL_REPEAT glTexImage2D]
    "A 2D texture whose sides are not all powers of two is clamped to its edge where it should repeat." {
        draw => clamp_odd_sizes
    }
    // Levels below the smallest tile share one, and their places in it are not added.
    "small-levels-share-a-tile" [glGenerateMipmap]
    "Made levels of less than 8 texels are the corner of the level of 8." {
        glGenerateMipmap => |call| {
            call.now();
            let is_plain = call.level(0, glow::TEXTURE_INTERNAL_FORMAT) as u32 == glow::RGBA8;
            if call.u(0) == glow::TEXTURE_2D && is_plain { alias_small_levels(call) }
        }
    }
    // The texture unit gives the border's colour as soon as a coordinate is outside, before it compares.
    "zero-borders-not-compared" [GL_TEXTURE_BORDER_COLOR GL_TEXTURE_COMPARE_FUNC GL_GEQUAL]
    "A comparison by GEQUAL or GREATER with a sampler object's border of 0 gives 0." {
        glSamplerParameterfv => |call| if call.u(1) == glow::TEXTURE_BORDER_COLOR {
            let first = call.floats(2, 1)[0];
            call.keep((20, call.u(0)), first);
        };
        glSamplerParameteri => |call| if call.u(1) == glow::TEXTURE_COMPARE_FUNC
            && [glow::GEQUAL, glow::GREATER].contains(&call.u(2))
            && call.kept((20, call.u(0))) == 0.0
            && let Some(sampler) = NonZeroU32::new(call.u(0)).map(glow::NativeSampler)
        {
            // SAFETY: the context is current. Nothing reaches this border.
            unsafe { call.gl().sampler_parameter_f32_slice(sampler, glow::TEXTURE_BORDER_COLOR, &[2.0; 4]) };
        }
    }
    // Uploads of depth go through a blit that takes the texture's first face for its image.
    "depth-uploads-to-first-face" [glTexImage2D GL_TEXTURE_CUBE_MAP_POSITIVE_X GL_DEPTH_COMPONENT]
    "Depths given for a face other than the first are 0." {
        glTexImage2D => |call| if (glow::TEXTURE_CUBE_MAP_NEGATIVE_X..=glow::TEXTURE_CUBE_MAP_NEGATIVE_Z).contains(&call.u(0))
            && call.u(6) == glow::DEPTH_COMPONENT && call.u(7) == glow::FLOAT && !call.pointer(8).is_null()
        {
            let count = call.u(3) as usize * call.u(4) as usize;
            call.set_floats(8, vec![0.0; count]);
        }
    }
    // The copy is a quad drawn by the driver, which saves all state and sets all but this.
    "copied-depths-through-depth-range" [glCopyTexSubImage2D glDepthRange]
    "Depths that are copied into a texture are mapped by the depth range once more." {
        glCopyTexSubImage2D => map_copied_depths
    }
    // A format that the table lacks takes the units of the smallest.
    "offsets-of-floats-in-units-of-16-bits" [glPolygonOffset GL_DEPTH_COMPONENT32F]
    "An offset's units are 256 times too large for depths of floats." { draw => offset_floats_by_16_bits }
    // Two rows of an if that compares with what is set: the last one is lost.
    "viewport-compared-without-height" [glViewport]
    "A viewport that differs from the one before by its height alone is not set." {
        glViewport => |call| {
            let [x, y, width, _] = call.get4(glow::VIEWPORT);
            if [x, y, width] == [call.i(0), call.i(1), call.i(2)] { call.skip() }
        }
    }
    // The late test of a shader that discards was written for depth.
    "stencil-kept-where-shaders-discard" [discard glStencilOpSeparate]
    "A draw whose shaders may discard does not write stencil." {
        glCreateProgram => |call| {
            call.now();
            if let super::Value::Unsigned(program) = call.result { call.keep((21, program), 0) }
        };
        glShaderSource => |call| {
            let discards = text::words(&text::joined(call)).any(|word| word == "discard");
            call.keep((20, call.u(0)), u32::from(discards));
        };
        glAttachShader => |call| {
            let either = call.kept((21, call.u(0))).max(call.kept((20, call.u(1))));
            call.keep((21, call.u(0)), either);
        };
        draw => keep_stencil
    }
    // Rows are counted from above in a window, and the test for a window asks for its colour.
    "scissor-from-above-without-color" [glScissor]
    "The scissor box is measured from the top in a framebuffer that has no colour." {
        glScissor => |call| if is_bare(call) {
            let height = call.get4(glow::VIEWPORT)[3];
            call.set(1, height - call.i(1) - call.i(3));
        }
    }
    // Factors are bytes, and 255 stands for 1 though a product is shifted by eight.
    "added-by-255-of-256" [glBlendFuncSeparate GL_ONE]
    "What is added to stored colours of 8 bits is 255/256 of the fragment's." {
        glBlendFuncSeparate => |call| if [call.u(0), call.u(1)] == [glow::ONE; 2]
            && call.attached(glow::COLOR_ATTACHMENT0, glow::FRAMEBUFFER_ATTACHMENT_RED_SIZE) == 8
        {
            call.other("glBlendColor", &[255.0 / 256.0; 4]);
            call.set(0, glow::CONSTANT_COLOR);
        }
    }
    // Drivers over another API turn faces in a viewport that is upside down, and ask the wrong axis.
    "culling-turned-in-reversed-range" [glCullFace glDepthRange]
    "The other face is culled where the depth range goes from far to near." { draw => cull_by_depth_range }
}
