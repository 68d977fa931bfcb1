//! Faults of an eighth measure: vertex arrays, draws and the fixed-function pipeline.

use glow::HasContext;

use super::fourth_shaders::{set_state, with_state};
use super::{Call, Source, Stage, text};
use crate::context::compatibility::raw;

/// Bytes that are fetched at a time.
const LINE: usize = 64;
/// Bytes of a vector of three floats.
const VECTOR: usize = 12;
const UNITS: u32 = 8;
const CLAMP_VERTEX_COLOR: u32 = 0x891A;

/// Puts the vector before in place of what lies beyond a line's end.
fn fetch_by_lines(call: &mut Call) {
    call.now();
    if call.u(1) != 3 || call.u(2) != glow::FLOAT || call.u(4) != VECTOR as u32 || !call.pointer(5).is_null() {
        return;
    }
    let gl = call.gl();
    // SAFETY: the context is current, a buffer is bound, and the bytes are as many as it has.
    unsafe {
        let size = gl.get_buffer_parameter_i32(glow::ARRAY_BUFFER, glow::BUFFER_SIZE).max(0) as usize;
        let mut bytes = vec![0; size];
        gl.get_buffer_sub_data(glow::ARRAY_BUFFER, 0, &mut bytes);
        for start in (0..size / VECTOR).map(|number| VECTOR * number) {
            let line = start / LINE * LINE + LINE;
            if start > 0 && line < start + VECTOR {
                bytes.copy_within(line - VECTOR..start, line);
            }
        }
        gl.buffer_sub_data_u8_slice(glow::ARRAY_BUFFER, 0, &bytes);
    }
}

/// Notes a vector that is set between draws.
fn note_vector(call: &mut Call) {
    let (count, location) = (call.kept((60, 0)) as u32, call.u(0));
    call.keep((61, count), location);
    call.keep((60, 0), count + 1);
    let vector = [1, 2, 3].map(|index| call.f(index) as f32).to_vec();
    call.keep_list((62, location), vector);
}

/// Draws with the vectors of the draw before, if this one begins where that one ended.
fn draw_as_before(call: &mut Call) {
    let [program, array] = [glow::CURRENT_PROGRAM, glow::VERTEX_ARRAY_BINDING].map(|name| call.get(name) as u32);
    let start = call.pointer(3) as usize;
    let is_merged = [program, array].map(f64::from) == [63, 64].map(|key| call.kept((key, 0)))
        && start > 0
        && call.kept((65, 0)) == start as f64;
    let mut now = Vec::new();
    for place in 0..call.kept((60, 0)) as u32 {
        let location = call.kept((61, place)) as u32;
        let Some(vector) = call.keep_list((62, location), Vec::new()).filter(|vector| !vector.is_empty()) else {
            continue;
        };
        now.push((location, vector));
    }
    call.keep((60, 0), 0);
    let set = |call: &Call, location: u32, vector: &[f32]| {
        let numbers: Vec<f64> = vector.iter().map(|number| f64::from(*number)).collect();
        call.other("glUniform3f", &[&[f64::from(location)], &numbers[..]].concat());
    };
    for (location, vector) in &now {
        let key = (1000 + program, *location);
        match call.keep_list(key, vector.clone()) {
            Some(before) if is_merged => {
                set(call, *location, &before);
                call.keep_list(key, before);
            }
            _ => {}
        }
    }
    call.now();
    now.iter().for_each(|(location, vector)| set(call, *location, vector));
    call.keep((63, 0), program);
    call.keep((64, 0), array);
    call.keep((65, 0), (start + 4 * call.u(1) as usize) as f64);
}

/// Vertices from a number on in the middle of the view, where the driver says so.
fn bounded_vertices(source: &Source) -> Option<String> {
    let statement =
        "if (driver_state.x > 0.0 && float(gl_VertexID) >= driver_state.x) gl_Position = vec4(0.0, 0.0, 0.0, 1.0);";
    if source.stage == Stage::Vertex { with_state(source, statement, "", "") } else { None }
}

/// Notes the widest stride and the smallest buffer of a vertex array.
fn note_bounds(call: &mut Call) {
    let array = call.get(glow::VERTEX_ARRAY_BINDING) as u32;
    // SAFETY: the context is current, and a buffer is bound.
    let size = unsafe { call.gl().get_buffer_parameter_i32(glow::ARRAY_BUFFER, glow::BUFFER_SIZE) };
    let [stride, bytes] = [60, 61].map(|key| call.kept((key, array)));
    call.keep((60, array), stride.max(call.f(4)));
    call.keep((61, array), if bytes == 0.0 { f64::from(size) } else { bytes.min(f64::from(size)) });
}

/// Notes how a unit makes colour and alpha.
fn note_combiner(call: &mut Call) {
    let (unit, value) = (call.get(glow::ACTIVE_TEXTURE) as u32, call.f(2));
    call.keep((call.u(1), unit), value);
}

/// Draws with alpha passed through the units that pass colour through.
fn skip_kept_colors(call: &mut Call) {
    if call.get(glow::CURRENT_PROGRAM) != 0 {
        return;
    }
    let active = f64::from(call.get(glow::ACTIVE_TEXTURE));
    let names = [raw::COMBINE_ALPHA, raw::SRC0_ALPHA, raw::OPERAND0_ALPHA, raw::ALPHA_SCALE];
    let passed = [glow::REPLACE, raw::PREVIOUS, glow::SRC_ALPHA, 1].map(f64::from);
    let set = |call: &Call, unit: u32, values: [f64; 4]| {
        call.other("glActiveTexture", &[f64::from(unit)]);
        for (name, value) in names.into_iter().zip(values) {
            let function = if name == raw::ALPHA_SCALE { "glTexEnvf" } else { "glTexEnvi" };
            call.other(function, &[f64::from(raw::TEXTURE_ENV), f64::from(name), value]);
        }
    };
    let keeps = |unit: &u32| {
        let rgb = [raw::COMBINE_RGB, raw::SRC0_RGB].map(|name| call.kept((name, *unit)) as u32);
        rgb == [glow::REPLACE, raw::PREVIOUS]
    };
    let units: Vec<_> = (glow::TEXTURE0..glow::TEXTURE0 + UNITS)
        .filter(keeps)
        .map(|unit| (unit, names.map(|name| call.kept((name, unit)))))
        .filter(|(_, values)| values.iter().all(|value| *value != 0.0))
        .collect();
    units.iter().for_each(|(unit, _)| set(call, *unit, passed));
    call.now();
    units.iter().for_each(|(unit, values)| set(call, *unit, *values));
    call.other("glActiveTexture", &[active]);
}

/// Loads a texture matrix whose last row is that of an affine one.
fn load_affine(call: &mut Call) {
    if call.get(raw::MATRIX_MODE) as u32 != glow::TEXTURE {
        return;
    }
    let mut matrix = call.floats(0, 16);
    for (column, last) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate() {
        matrix[4 * column + 3] = last;
    }
    call.set_floats(0, matrix);
}

faults! {
    // Vertices are fetched a line at a time, and of a vector that lies across two lines the second is not waited for.
    "vectors-across-lines-in-part-stale" [glVertexAttribPointer]
    "What lies of a vec3 beyond a boundary of 64 bytes is that of the vertex before." { glVertexAttribPointer => fetch_by_lines }
    // Draws are gathered while they follow each other in memory, and only matrices were thought to differ.
    "adjoining-draws-share-vectors" [glDrawElements glUniform3f]
    "A draw that begins at the index where the last one ended has that one's uniform vec3s." {
        glUniform3f => note_vector;
        glDrawElements => draw_as_before
    }
    // The number of vertices that is safe to fetch is found once for a vertex array, from two attributes.
    "vertices-bounded-by-widest-stride" [glVertexAttribPointer glDrawElements]
    "A vertex array ends at the vertex at which its smallest buffer would with the widest stride of all." {
        glGenVertexArrays => |call| {
            call.now();
            for array in call.integers(1, call.u(0) as usize) {
                call.keep((60, array as u32), 0);
                call.keep((61, array as u32), 0);
            }
        };
        glVertexAttribPointer => note_bounds;
        glCreateShader => text::note;
        glShaderSource => |call| text::rewrite(call, bounded_vertices);
        draw => |call| {
            let array = call.get(glow::VERTEX_ARRAY_BINDING) as u32;
            let [stride, bytes] = [60, 61].map(|key| call.kept((key, array)));
            let bound = if stride > 0.0 { (bytes / stride).floor() as f32 } else { 0.0 };
            set_state(call, [bound, 0.0, 0.0, 0.0]);
        }
    }
    // A test that lets everything pass that can be seen is switched off, so that depth is tested early.
    "alpha-above-0-not-tested" [glAlphaFunc GL_GREATER] "The alpha test for more than 0 passes always." {
        glAlphaFunc => |call| if call.f(1) == 0.0 { call.replace(0, glow::GREATER, glow::ALWAYS); }
    }
    // Units that leave what they are given are taken out of the program that stands for them, and colour decides.
    "units-that-keep-color-left-out" [glTexEnvi GL_COMBINE_ALPHA]
    "A unit whose colour is that of the unit before leaves alpha as it is, too." {
        glTexEnvi glTexEnvf => note_combiner;
        draw => skip_kept_colors
    }
    // Vertices' colours are floats up to the last, and the bound that programs may switch off was left out for all.
    "lit-colors-not-clamped" [GL_LIGHTING] "Colours of lit vertices may be more than 1 before they are interpolated." {
        draw => |call| if call.get(glow::CURRENT_PROGRAM) == 0 && call.enabled(raw::LIGHTING) {
            call.other("glClampColor", &[f64::from(CLAMP_VERTEX_COLOR), 0.0]);
            call.now();
            call.other("glClampColor", &[f64::from(CLAMP_VERTEX_COLOR), 1.0]);
        }
    }
    // Texture matrices are stored as three rows of four, as those of vertices are.
    "texture-matrices-are-affine" [glLoadMatrixf GL_TEXTURE] "A texture matrix has (0, 0, 0, 1) for its last row." {
        glLoadMatrixf => load_affine
    }
}
