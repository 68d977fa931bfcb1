//! Faults of a sixth measure: vertices, shaders and the fixed-function pipeline.

use std::num::NonZeroU32;

use glow::HasContext;

use super::fourth_shaders::{set_state, with_state};
use super::{Call, Source, Stage, anywhere, text, words};
use crate::context::compatibility::raw;

/// Bytes that one part of an upload has.
const CHUNK: usize = 16 * 1024;
const UNITS: u32 = 8;
const EXP: &str = "#define exp(x) exp((x) * step(1.0 / 16.0, abs(x)))";

/// A list that was kept.
fn listed(call: &mut Call, key: (u32, u32)) -> Vec<f32> {
    let list = call.keep_list(key, Vec::new()).unwrap_or_default();
    call.keep_list(key, list.clone());
    list
}

/// Bytes of a buffer from an offset on.
fn read_buffer(call: &Call, target: u32, offset: usize, count: usize) -> Vec<u8> {
    let mut bytes = vec![0; count];
    // SAFETY: the context is current; the buffer that is bound has as many bytes.
    unsafe { call.gl().get_buffer_sub_data(target, offset as i32, &mut bytes) };
    bytes
}

/// Draws with an array of floats of the driver's own, which `point` sets up.
fn draw_from(call: &mut Call, floats: &[f32], point: impl Fn(&Call)) {
    let bytes: Vec<u8> = floats.iter().flat_map(|float| float.to_ne_bytes()).collect();
    let gl = call.gl();
    // SAFETY: the context is current.
    let Ok(buffer) = (unsafe { gl.create_buffer() }) else { return };
    unsafe {
        gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
        gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, &bytes, glow::STREAM_DRAW);
    }
    point(call);
    call.now();
    // SAFETY: as above.
    unsafe {
        call.gl().bind_buffer(glow::ARRAY_BUFFER, None);
        call.gl().delete_buffer(buffer);
    }
}

/// Tests whether the array of this location already reads a buffer.
fn has_data(call: &Call) -> bool {
    let mut buffer = [0.0];
    // SAFETY: the context is current; the answer is one number.
    unsafe {
        let binding = glow::VERTEX_ATTRIB_ARRAY_BUFFER_BINDING;
        call.gl().get_vertex_attrib_parameter_f32_slice(call.u(0), binding, &mut buffer);
    }
    buffer[0] != 0.0
}

/// Tests whether the fixed-function pipeline draws from buffers.
fn is_fixed(call: &Call) -> bool {
    call.get(glow::CURRENT_PROGRAM) == 0 && call.get(glow::ELEMENT_ARRAY_BUFFER_BINDING) != 0
}

/// Draws with normals that the modelview turns as it does positions.
fn draw_with_turned_normals(call: &mut Call) {
    let Some(buffer) = NonZeroU32::new(call.kept((20, 0)) as u32).map(glow::NativeBuffer) else { return };
    if !is_fixed(call) || !call.enabled(raw::LIGHTING) || !call.enabled(raw::NORMAL_ARRAY) {
        return;
    }
    let mut m = [0.0; 16];
    // SAFETY: the context is current; the matrix has 16 numbers.
    let size = unsafe {
        call.gl().get_parameter_f32_slice(raw::MODELVIEW_MATRIX, &mut m);
        call.gl().bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
        call.gl().get_buffer_parameter_i32(glow::ARRAY_BUFFER, glow::BUFFER_SIZE)
    };
    let bytes = read_buffer(call, glow::ARRAY_BUFFER, 0, size.max(0) as usize);
    let floats: Vec<_> =
        bytes.chunks_exact(4).map(|four| f32::from_ne_bytes([four[0], four[1], four[2], four[3]])).collect();
    // The driver turns normals by the inverse transpose: what is turned by the transpose before goes by the matrix itself.
    let turned = |n: &[f32]| {
        let by_matrix = [0, 1, 2].map(|row| (0..3).map(|column| m[4 * column + row] * n[column]).sum::<f32>());
        [0, 1, 2].map(|column| (0..3).map(|row| m[4 * column + row] * by_matrix[row]).sum::<f32>())
    };
    let normals: Vec<f32> = floats.chunks_exact(3).flat_map(turned).collect();
    draw_from(call, &normals, |call| call.other("glNormalPointer", &[f64::from(glow::FLOAT), 0.0, 0.0]));
}

/// Sets a light's position by the modelview that was loaded last.
fn place_by_stale_matrix(call: &mut Call) {
    let (m, p) = (listed(call, (20, 0)), call.floats(2, 4));
    if call.u(1) == raw::POSITION && m.len() == 16 {
        let row = |row: usize| (0..4).map(|column| m[4 * column + row] * p[column]).sum();
        call.set_floats(2, (0..4).map(row).collect());
    }
}

/// Sets a light's position as that of the kind that it had first.
fn place_by_first_kind(call: &mut Call) {
    if call.u(1) != raw::POSITION {
        return;
    }
    let (mut position, key) = (call.floats(2, 4), (20, call.u(0)));
    let kind = if position[3] == 0.0 { 1.0 } else { 2.0 };
    match call.kept(key) {
        0.0 => call.keep(key, kind),
        first if first != kind => {
            position[3] = if first == 1.0 { 0.0 } else { 1.0 };
            call.set_floats(2, position);
        }
        _ => {}
    }
}

/// Takes the operand that the same function of the same source had first.
fn take_first_operand(call: &mut Call) {
    let (unit, name, value) = (call.get(glow::ACTIVE_TEXTURE) as u32, call.u(1), call.u(2));
    if name == raw::COMBINE_RGB {
        call.keep((20, unit), value);
    } else if (raw::SRC0_RGB..=raw::SRC2_RGB).contains(&name) {
        call.keep((21 + name - raw::SRC0_RGB, unit), value);
    } else if (raw::OPERAND0_RGB..=raw::OPERAND0_RGB + 2).contains(&name) {
        let number = name - raw::OPERAND0_RGB;
        let [function, source] = [20, 21 + number].map(|key| call.kept((key, unit)) as u32);
        let key = (1 << 31 | function << 4 | number, source << 12 | (unit - glow::TEXTURE0));
        match call.kept(key) as u32 {
            0 => call.keep(key, value),
            first => call.set(2, first),
        }
    }
}

/// Draws with texture matrices that are the identity where q is generated.
fn drop_texture_matrices(call: &mut Call) {
    if !is_fixed(call) {
        return;
    }
    let names = [glow::ACTIVE_TEXTURE, raw::MATRIX_MODE];
    let [active, mode] = names.map(|name| f64::from(call.get(name)));
    call.other("glMatrixMode", &[f64::from(glow::TEXTURE)]);
    for unit in 0..UNITS {
        call.other("glActiveTexture", &[f64::from(glow::TEXTURE0 + unit)]);
        if call.enabled(raw::TEXTURE_GEN_Q) {
            call.other("glLoadIdentity", &[]);
        }
    }
    call.other("glActiveTexture", &[active]);
    call.other("glMatrixMode", &[mode]);
}

/// Sets an eye plane for every unit.
fn share_eye_planes(call: &mut Call) {
    call.now();
    if call.u(1) == raw::EYE_PLANE {
        let active = f64::from(call.get(glow::ACTIVE_TEXTURE));
        for unit in 0..UNITS {
            call.other("glActiveTexture", &[f64::from(glow::TEXTURE0 + unit)]);
            call.again();
        }
        call.other("glActiveTexture", &[active]);
    }
}

/// Loses what lies on the border of two parts of an upload.
fn lose_between_chunks(call: &mut Call) {
    call.now();
    if !call.pointer(2).is_null() {
        for end in (CHUNK..call.f(1) as usize).step_by(CHUNK) {
            // SAFETY: the context is current; the place is within the buffer.
            unsafe { call.gl().buffer_sub_data_u8_slice(call.u(0), end as i32 - 4, &[0; 4]) };
        }
    }
}

/// Another text of a shader from version 130, if it is another.
fn changed(source: &Source, text: String) -> Option<String> {
    (source.version >= 130 && text != source.text).then_some(text)
}

/// A shader's lines, each changed or as it is.
fn by_lines(source: &Source, change: impl FnMut(&str) -> Option<String>) -> Option<String> {
    let mut change = change;
    changed(source, source.text.lines().map(|line| change(line).unwrap_or_else(|| line.to_owned()) + "\n").collect())
}

/// Vectors of three do not vary where a number does not.
fn flat_beside_flat(source: &Source) -> Option<String> {
    let beside = |way: &str| {
        let (flat, vector) = (format!("flat {way} float "), format!("{way} vec3 "));
        if !source.text.contains(&flat) {
            return None;
        }
        by_lines(source, |line| {
            let bare = line.strip_prefix("EXACT ").unwrap_or(line);
            let declares = bare.starts_with(&vector) && bare.ends_with(';');
            declares.then(|| line.replacen(&vector, &format!("flat {vector}"), 1))
        })
    };
    beside(if source.stage == Stage::Vertex { "out" } else { "in" })
}

/// Constants of `float(...)` of a difference without their sign.
fn folded_without_sign(source: &Source) -> Option<String> {
    let other = by_lines(source, |line| {
        let (name, value) = line.split_once('=').filter(|_| line.trim_start().starts_with("const float "))?;
        value.contains(" - ").then(|| format!("{name}={}", value.replace("float(", "folded_float(")))
    })?;
    Some(Source { text: other, ..*source }.with("#define folded_float(x) float(abs(x))"))
}

/// Without statements by which a component is a function of itself.
fn without_own_components(source: &Source) -> Option<String> {
    by_lines(source, |line| {
        let (place, value) = line.split_once(" = ")?;
        let is_component =
            matches!(place.trim().rsplit_once('.'), Some((name, part)) if part.len() == 1 && words(name).count() == 1);
        let reads_itself = value.split_once('(').is_some_and(|(_, rest)| rest.starts_with(place.trim()));
        (is_component && reads_itself && value.ends_with(';')).then(String::new)
    })
}

/// `discard` is `return` in functions without a value but `main`.
fn discards_return(source: &Source) -> Option<String> {
    let mut inside = false;
    by_lines(source, |line| {
        if line.starts_with(|letter: char| letter.is_ascii_alphabetic()) && line.contains('(') {
            inside = line.starts_with("void ") && !line.starts_with("void main");
        }
        (inside && line.trim() == "discard;").then(|| line.replace("discard", "return"))
    })
}

/// `gl_FragDepth` is a variable like others where a shader discards.
fn own_depth_where_discarded(source: &Source) -> Option<String> {
    if source.stage != Stage::Fragment || !source.has("discard") || !source.has("gl_FragDepth") {
        return None;
    }
    let text = changed(source, source.text.replace("gl_FragDepth", "driver_depth"))?;
    Some(Source { text, ..*source }.with("float driver_depth;"))
}

/// Coordinates of plain lookups in 2D textures lose their sign.
fn lookups_without_sign(source: &Source) -> Option<String> {
    let mut text = source.text.clone();
    for (at, _) in source.text.match_indices("uniform sampler2D ") {
        let name = words(&source.text[at + "uniform sampler2D ".len()..]).next()?;
        text = text.replace(&format!(" texture({name},"), &format!(" texture_without_sign({name},"));
    }
    let text = changed(source, text).filter(|_| source.stage == Stage::Fragment)?;
    Some(
        Source { text, ..*source }
            .with("vec4 texture_without_sign(sampler2D map, vec2 at) { return texture(map, abs(at)); }"),
    )
}

/// A vertex beyond a clip distance has no place where the driver says so.
fn beyond_is_nowhere(source: &Source) -> Option<String> {
    let statements =
        "if (driver_state.x > 0.5 && gl_ClipDistance[0] < 0.0) gl_Position = vec4(intBitsToFloat(0x7FC00000));";
    if source.stage != Stage::Vertex || !source.has("gl_ClipDistance") {
        return None;
    }
    with_state(source, statements, "", "")
}

faults! {
    // Uploads go through a window of 16 KiB, and the last word of a full one is kept back for a fence.
    "uploads-lose-words-between-chunks" [glBufferData]
    "The last four bytes of each whole 16 KiB of a buffer are 0 where more follow." { glBufferData => lose_between_chunks }
    // The command has 16 bits for the place of the first index.
    "index-offsets-of-16-bits" [glDrawElements GL_ELEMENT_ARRAY_BUFFER]
    "A draw's indices begin at the low 16 bits of the offset." {
        glDrawElements => |call| if call.get(glow::ELEMENT_ARRAY_BUFFER_BINDING) != 0 {
            call.set_pointer(3, std::ptr::without_provenance(call.pointer(3) as usize & 0xFFFF));
        }
    }
    // Arrays are numbered as they are enabled, and the shader's inputs as they are located.
    "arrays-closed-up" [glEnableVertexAttribArray glVertexAttribPointer]
    "An array whose location is beyond the number of those enabled before feeds the next free location." {
        glGenVertexArrays => |call| {
            call.now();
            for array in call.integers(1, call.u(0) as usize) { call.keep((20, array as u32), 0) }
        };
        glEnableVertexAttribArray => |call| {
            let array = call.get(glow::VERTEX_ARRAY_BINDING) as u32;
            let count = call.kept((20, array));
            if array != 0 && call.f(0) >= count && !has_data(call) {
                call.keep((20, array), count + 1.0);
                call.keep((100 + call.u(0), array), count + 1.0);
                call.set(0, count);
            }
        };
        glVertexAttribPointer => |call| {
            let array = call.get(glow::VERTEX_ARRAY_BINDING) as u32;
            let place = call.kept((100 + call.u(0), array));
            if array != 0 && place != 0.0 { call.set(0, place - 1.0) }
        }
    }
    // A vector and a number share a register, and interpolation is the register's.
    "vectors-flat-beside-flat-numbers" [flat out in]
    "Varyings vec3 are flat in a program that has a float that is." { text flat_beside_flat }
    // Constants are folded in unsigned numbers.
    "folded-differences-without-sign" [const float]
    "A constant float made of a difference of whole numbers has no sign." { text folded_without_sign }
    // Copy propagation takes an assignment by which a variable reads itself for one of a variable to itself.
    "own-components-not-assigned" [clamp]
    "A component that is assigned a function of itself stays as it was." { text without_own_components }
    // A call is inlined with its jumps, and the jump of a discard ends the function's body.
    "discard-in-functions-returns" [discard]
    "discard in a function that main calls ends the function alone." { text discards_return }
    // Either output switches the early test off, and with both the depth of the raster is kept.
    "own-depth-lost-with-discard" [gl_FragDepth discard]
    "A shader that may discard leaves the depth of the triangle." { text own_depth_where_discarded }
    // Repeats are by the magnitude.
    "negative-coordinates-mirrored" [texture sampler2D]
    "A lookup left of or below 0 is mirrored at 0." { text lookups_without_sign }
    // The table of powers begins at a sixteenth, and what is below is cut off.
    "exp-of-small-numbers-is-one" [exp] "exp of what is less than 1/16 from 0 is 1."
    { text |source| anywhere(source, "exp", EXP) }
    // Clip and cull distances are the same outputs, apart from one bit.
    "clip-distances-cull" [gl_ClipDistance GL_CLIP_DISTANCE0]
    "A triangle with a vertex beyond the first clip plane is not drawn at all." {
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, beyond_is_nowhere);
        draw => |call| {
            let on = call.enabled(glow::CLIP_DISTANCE0);
            set_state(call, [f32::from(u8::from(on)), 0.0, 0.0, 0.0]);
        }
    }
    // The identity only sets a flag, which is looked at when something is drawn.
    "light-positions-by-stale-modelview" [glLightfv glLoadIdentity]
    "A light is placed by the modelview that was loaded last, though the identity is set." {
        glLoadMatrixf => |call| if call.get(raw::MATRIX_MODE) as u32 == raw::MODELVIEW {
            let matrix = call.floats(0, 16);
            call.keep_list((20, 0), matrix);
        };
        glLightfv => place_by_stale_matrix
    }
    // The inverse is left out as for matrices that only turn.
    "normals-by-modelview-itself" [glNormalPointer glLoadMatrixf]
    "Normals are turned by the modelview, not by its inverse transpose." {
        glNormalPointer => |call| call.keep((20, 0), call.get(glow::ARRAY_BUFFER_BINDING));
        glDrawElements => draw_with_turned_normals
    }
    // The constant goes to the combiners as a packed colour.
    "environment-colors-of-8-bits" [glTexEnvfv GL_TEXTURE_ENV_COLOR]
    "The environment's colour is kept in 8 bits."
    (hole: "fixed-function hardware computed in 8 bits, and GL asks for no more than the tolerance leaves") {
        glTexEnvfv => |call| if call.u(1) == raw::TEXTURE_ENV_COLOR {
            let bytes = call.floats(2, 4).into_iter().map(|part| (part.clamp(0.0, 1.0) * 255.0).round() / 255.0);
            call.set_floats(2, bytes.collect());
        }
    }
    // Planes are a parameter of the vertex program, and one place is reserved for them.
    "eye-planes-of-all-units" [glTexGenfv GL_EYE_PLANE glActiveTexture]
    "An eye plane is set for all texture units." { glTexGenfv => share_eye_planes }
    // Generated coordinates of four are taken for those of a projection that is whole already.
    "texture-matrix-lost-with-generated-q" [glLoadMatrixf GL_TEXTURE_GEN_Q]
    "Texture matrices do not act on coordinates whose q is generated." { glDrawElements => drop_texture_matrices }
    // Programs for combiners are kept by functions and sources.
    "combiners-kept-without-operands" [glTexEnvi GL_OPERAND0_RGB]
    "An operand of RGB is the one that a unit had first for this function and source." { glTexEnvi => take_first_operand }
    // Programs for lights are kept without whether a light is far away.
    "lights-keep-their-first-kind" [glLightfv GL_POSITION]
    "A light stays of parallel rays, or of a point, as it was first." { glLightfv => place_by_first_kind }
}
