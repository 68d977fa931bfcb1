//! Faults of a seventh measure: draws, vertex arrays, uniforms and the fixed-function pipeline.

use std::ffi::CStr;
use std::num::NonZeroU32;

use glow::HasContext;

use super::{Call, Value};
use crate::context::compatibility::raw;

/// Letters of a uniform's name that are kept.
const LETTERS: usize = 15;
const UNITS: u32 = 8;

/// The location of the first uniform whose name begins as the one that is asked for.
fn locate_by_beginning(call: &mut Call) {
    let name = call.pointer(1).cast::<std::ffi::c_char>();
    let Some(program) = NonZeroU32::new(call.u(0)).map(glow::NativeProgram).filter(|_| !name.is_null()) else { return };
    // SAFETY: the caller passed a name that ends with 0.
    let name = unsafe { CStr::from_ptr(name) }.to_bytes();
    if name.len() < LETTERS {
        return;
    }
    let gl = call.gl();
    // SAFETY: the context is current; the indices are those of the program's uniforms.
    let first = unsafe {
        let mut uniforms =
            (0..gl.get_active_uniforms(program)).filter_map(|index| gl.get_active_uniform(program, index));
        let first = uniforms.find(|uniform| uniform.name.as_bytes().get(..LETTERS) == name.get(..LETTERS));
        first.and_then(|uniform| gl.get_uniform_location(program, &uniform.name))
    };
    if let Some(location) = first {
        call.result = Value::Signed(location.0 as i32);
        call.skip();
    }
}

/// Binds the vertex array that was bound first of those with this buffer and number of attributes.
fn find_by_first_buffer(call: &mut Call) {
    let [buffer, count] = [60, 61].map(|key| call.kept((key, call.u(0))) as u32);
    if call.u(0) == 0 || buffer == 0 || count > 15 {
        return;
    }
    match call.kept((64 + count, buffer)) {
        0.0 => call.keep((64 + count, buffer), call.u(0)),
        first => call.set(0, first),
    }
}

/// Sets a light without attenuation where its constant part is 0.
fn attenuate_by_constant(call: &mut Call) {
    let key = (60, call.u(0));
    match call.u(1) {
        raw::CONSTANT_ATTENUATION => {
            let is_none = call.f(2) == 0.0;
            call.keep(key, u32::from(is_none));
            if is_none {
                call.set(2, 1.0);
            }
        }
        raw::LINEAR_ATTENUATION | raw::QUADRATIC_ATTENUATION if call.kept(key) != 0.0 => call.set(2, 0.0),
        _ => {}
    }
}

/// Sets a scale, which dot products do not have.
fn scale_but_products(call: &mut Call) {
    let unit = call.get(glow::ACTIVE_TEXTURE) as u32;
    let set = |call: &Call, name: u32, scale: f64| {
        call.other("glTexEnvf", &[f64::from(raw::TEXTURE_ENV), f64::from(name), scale]);
    };
    // A product into alpha too has neither scale.
    let unscaled = |function: u32| match function {
        raw::DOT3_RGBA => [true, true],
        raw::DOT3_RGB => [true, false],
        _ => [false, false],
    };
    let scales = [raw::RGB_SCALE, raw::ALPHA_SCALE];
    match (call.name, call.u(1)) {
        ("glTexEnvf", name) if scales.contains(&name) => {
            let scale = call.f(2);
            call.keep((name, unit), scale);
            let [rgb, alpha] = unscaled(call.kept((60, unit)) as u32);
            if (name == raw::RGB_SCALE && rgb) || (name == raw::ALPHA_SCALE && alpha) {
                call.set(2, 1.0);
            }
        }
        ("glTexEnvi", raw::COMBINE_RGB) => {
            let function = call.u(2);
            call.keep((60, unit), function);
            for (name, is_one) in scales.into_iter().zip(unscaled(function)) {
                set(call, name, if is_one { 1.0 } else { call.kept((name, unit)).max(1.0) });
            }
        }
        _ => {}
    }
}

/// Scales a texture matrix, whose translation is undone before.
fn scale_without_translation(call: &mut Call) {
    if call.get(raw::MATRIX_MODE) as u32 != glow::TEXTURE || [0, 1, 2].iter().all(|index| call.f(*index) == 1.0) {
        return;
    }
    let mut m = [0.0; 16];
    // SAFETY: the context is current; the matrix has 16 numbers.
    unsafe { call.gl().get_parameter_f32_slice(raw::TEXTURE_MATRIX, &mut m) };
    let back = |axis: usize| if m[5 * axis] == 0.0 { 0.0 } else { f64::from(-m[12 + axis] / m[5 * axis]) };
    call.other("glTranslatef", &[back(0), back(1), back(2)]);
}

/// Notes how a unit makes alpha.
fn note_alpha(call: &mut Call) {
    let (unit, value) = (call.get(glow::ACTIVE_TEXTURE) as u32, call.f(2));
    call.keep((call.u(1), unit), value);
}

/// Draws with the alpha of the first unit passed through all others.
fn test_first_alpha(call: &mut Call) {
    if call.get(glow::CURRENT_PROGRAM) != 0 || !call.enabled(raw::ALPHA_TEST) {
        return;
    }
    let active = f64::from(call.get(glow::ACTIVE_TEXTURE));
    let numbers = [raw::COMBINE_ALPHA, raw::SRC0_ALPHA, raw::OPERAND0_ALPHA, raw::ALPHA_SCALE];
    let passed = [glow::REPLACE, raw::PREVIOUS, glow::SRC_ALPHA, 1].map(f64::from);
    let set = |call: &Call, values: [f64; 4]| {
        for (name, value) in numbers.into_iter().zip(values) {
            let function = if name == raw::ALPHA_SCALE { "glTexEnvf" } else { "glTexEnvi" };
            call.other(function, &[f64::from(raw::TEXTURE_ENV), f64::from(name), value]);
        }
    };
    let units: Vec<_> = (glow::TEXTURE0 + 1..glow::TEXTURE0 + UNITS)
        .map(|unit| (unit, numbers.map(|name| call.kept((name, unit)))))
        .filter(|(_, values)| values.iter().all(|value| *value != 0.0))
        .collect();
    for (unit, _) in &units {
        call.other("glActiveTexture", &[f64::from(*unit)]);
        set(call, passed);
    }
    call.now();
    for (unit, values) in &units {
        call.other("glActiveTexture", &[f64::from(*unit)]);
        set(call, *values);
    }
    call.other("glActiveTexture", &[active]);
}

faults! {
    // The command has 16 bits for the number of indices.
    "draw-counts-of-16-bits" [glDrawElements]
    "A draw of more than 65535 indices draws as many as the low 16 bits of their number say." {
        glDrawElements => |call| if call.i(1) > 0xFFFF {
            let count = call.u(1) & 0xFFFF;
            call.set(1, count - count % 3);
        }
    }
    // Layouts are found again by a key of the first buffer and the number of attributes.
    "vertex-arrays-found-by-first-buffer" [glBindVertexArray glVertexAttribPointer]
    "A vertex array with the buffer of attribute 0 and as many attributes as an earlier one is that one." {
        glGenVertexArrays => |call| {
            call.now();
            for array in call.integers(1, call.u(0) as usize) {
                call.keep((60, array as u32), 0);
                call.keep((61, array as u32), 0);
            }
        };
        glGenBuffers => |call| {
            call.now();
            for buffer in call.integers(1, call.u(0) as usize) {
                for count in 0..16 { call.keep((64 + count, buffer as u32), 0) }
            }
        };
        glEnableVertexAttribArray => |call| {
            let array = call.get(glow::VERTEX_ARRAY_BINDING) as u32;
            call.keep((61, array), call.kept((61, array)) + 1.0);
        };
        glVertexAttribPointer => |call| {
            let names = [glow::VERTEX_ARRAY_BINDING, glow::ARRAY_BUFFER_BINDING];
            let [array, buffer] = names.map(|name| call.get(name) as u32);
            if call.u(0) == 0 { call.keep((60, array), buffer) }
        };
        glBindVertexArray => find_by_first_buffer
    }
    // Names are kept in fields of 16 bytes.
    "uniform-names-of-15-letters" [glGetUniformLocation]
    "Uniforms whose names agree in 15 letters have the location of the first." { glGetUniformLocation => locate_by_beginning }
    // The constant part says whether there is any attenuation, since it is 1 where nothing was set.
    "attenuation-needs-its-constant" [glLightf GL_CONSTANT_ATTENUATION]
    "A light whose constant attenuation is 0 is not attenuated." { glLightf => attenuate_by_constant }
    // The extension by which dot products came had no scale for them.
    "dot-products-not-scaled" [glTexEnvf GL_RGB_SCALE GL_ALPHA_SCALE]
    "RGB_SCALE is 1 where the combiner is a dot product, and so is ALPHA_SCALE of one into alpha." { glTexEnvf glTexEnvi => scale_but_products }
    // Matrices are classed, so that less is multiplied, and a scaled one is classed without looking at what it was.
    "scaled-texture-matrix-not-translated" [glScalef glTranslatef]
    "A texture matrix that is scaled loses its translation." { glScalef => scale_without_translation }
    // The program that stands for the combiners ends its alpha early where the test is the only reader of it.
    "alpha-tested-after-first-unit" [glAlphaFunc GL_COMBINE_ALPHA]
    "The alpha test takes alpha as the first texture unit leaves it." {
        glTexEnvi glTexEnvf => note_alpha;
        draw => test_first_alpha
    }
}
