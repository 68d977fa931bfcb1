//! Another renderer than glumbra: one spotlight's shadow map by hand in raw OpenGL, with tessellation, views and shaders of
//! its own. Of glumbra it has only the context, and of the scene `teapot.toml` nothing: its numbers stand here again.

use std::path::Path;

use glow::{HasContext, NativeFramebuffer, NativeTexture};

/// Faults to plant.
#[derive(Clone, Copy, Default)]
pub struct Faults {
    /// No polygon offset while the map is drawn: acne.
    pub no_bias: bool,
    /// Degrees by which the light stands elsewhere, turned about the vertical axis through its target.
    pub turned_degrees: f64,
}

type Vector = [f64; 3];
const SIZE: [i32; 2] = [400, 300];
const MAP: i32 = 2048;
const CELLS: usize = 16;

/// The light, the eye: where each stands, what it looks at, half its height at distance 1, near and far.
const LIGHT: (Vector, Vector, f64, [f64; 2]) = ([-2.4, 4.0, 2.2], [0.0, 0.4, 0.0], 28.0, [1.0, 12.0]);
const EYE: (Vector, Vector, f64, [f64; 2]) = ([2.6, 3.0, 5.0], [0.0, 0.5, 0.0], 18.0, [0.5, 20.0]);

const VERTEX: &str = "#version 330 core
layout(location = 0) in vec3 point;
uniform vec3 eye[4], light[4]; uniform vec4 eye_lens, light_lens;
out vec4 in_light;
vec4 project(vec3 view[4], vec4 lens) { // position, right, up, forward; scales of x and y, near, far
    vec3 way = point - view[0];
    float ahead = dot(way, view[3]);
    float z = (ahead * (lens.w + lens.z) - 2.0 * lens.w * lens.z) / (lens.w - lens.z);
    return vec4(dot(way, view[1]) * lens.x, dot(way, view[2]) * lens.y, z, ahead);
}
void main() { gl_Position = project(eye, eye_lens); in_light = project(light, light_lens); }";

const FRAGMENT: &str = "#version 330 core
in vec4 in_light; out vec4 shade; uniform sampler2D map;
void main() {
    vec3 at = in_light.xyz / in_light.w * 0.5 + 0.5;
    shade = vec4(vec3(at.z <= texture(map, at.xy).r ? 1.0 : 0.0), 1.0);
}";

/// Draws the shade as a PNG of grey and alpha: 1 lit, 0 in shadow, alpha 0 where nothing is.
pub fn draw(faults: Faults, picture: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let context = glumbra::context::open(&Default::default())?;
    let gl = context.gl();
    let points = floor().into_iter().chain(teapot()?).flatten().map(|value| value as f32);
    let bytes: Vec<u8> = points.flat_map(f32::to_ne_bytes).collect();
    let count = (bytes.len() / 12) as i32;
    let mut light = LIGHT;
    light.0 = turned(light.0, light.1, faults.turned_degrees.to_radians());
    let mut texels = vec![0; (4 * SIZE[0] * SIZE[1]) as usize];
    // Sound: the context is current, and every object is its own.
    unsafe {
        gl.bind_vertex_array(Some(gl.create_vertex_array()?));
        gl.bind_buffer(glow::ARRAY_BUFFER, Some(gl.create_buffer()?));
        gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, &bytes, glow::STATIC_DRAW);
        gl.enable_vertex_attrib_array(0);
        gl.vertex_attrib_pointer_f32(0, 3, glow::FLOAT, false, 0, 0);
        let program = gl.create_program()?;
        for (kind, text) in [(glow::VERTEX_SHADER, VERTEX), (glow::FRAGMENT_SHADER, FRAGMENT)] {
            let shader = gl.create_shader(kind)?;
            gl.shader_source(shader, text);
            gl.compile_shader(shader);
            gl.attach_shader(program, shader);
        }
        gl.link_program(program);
        if !gl.get_program_link_status(program) {
            return Err(gl.get_program_info_log(program).into());
        }
        gl.use_program(Some(program));
        gl.enable(glow::DEPTH_TEST);
        set_view(gl, program, "light", light, 1.0);
        let (map_target, map) = target(gl, [MAP; 2], false)?;
        set_view(gl, program, "eye", light, 1.0);
        if !faults.no_bias {
            gl.enable(glow::POLYGON_OFFSET_FILL);
            gl.polygon_offset(2.0, 4.0);
        }
        pass(gl, map_target, [MAP; 2], count);
        gl.disable(glow::POLYGON_OFFSET_FILL);
        let (picture_target, _) = target(gl, SIZE, true)?;
        set_view(gl, program, "eye", EYE, f64::from(SIZE[0]) / f64::from(SIZE[1]));
        gl.bind_texture(glow::TEXTURE_2D, Some(map));
        pass(gl, picture_target, SIZE, count);
        let out = glow::PixelPackData::Slice(Some(&mut texels));
        gl.read_pixels(0, 0, SIZE[0], SIZE[1], glow::RGBA, glow::UNSIGNED_BYTE, out);
    }
    let at = |x: u32, y: u32| 4 * ((SIZE[1] as u32 - 1 - y) * SIZE[0] as u32 + x) as usize; // GL's rows run upwards
    let [width, height] = SIZE.map(|side| side as u32);
    let gray = |x, y| image::LumaA([texels[at(x, y)], texels[at(x, y) + 3]]);
    Ok(image::GrayAlphaImage::from_fn(width, height, gray).save(picture)?)
}

/// A framebuffer and its depth texture, which is attached; with a colour texture, too.
unsafe fn target(
    gl: &glow::Context,
    size: [i32; 2],
    color: bool,
) -> Result<(NativeFramebuffer, NativeTexture), String> {
    let texture = |inside: u32, format: u32, kind: u32| unsafe {
        let texture = gl.create_texture()?;
        gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        let (none, [width, height]) = (glow::PixelUnpackData::Slice(None), size);
        gl.tex_image_2d(glow::TEXTURE_2D, 0, inside as i32, width, height, 0, format, kind, none);
        for key in [glow::TEXTURE_MIN_FILTER, glow::TEXTURE_MAG_FILTER] {
            gl.tex_parameter_i32(glow::TEXTURE_2D, key, glow::NEAREST as i32);
        }
        Ok::<_, String>(texture)
    };
    let depth = texture(glow::DEPTH_COMPONENT24, glow::DEPTH_COMPONENT, glow::UNSIGNED_INT)?;
    let color = if color { Some(texture(glow::RGBA8, glow::RGBA, glow::UNSIGNED_BYTE)?) } else { None };
    unsafe {
        let framebuffer = gl.create_framebuffer()?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::DEPTH_ATTACHMENT, glow::TEXTURE_2D, Some(depth), 0);
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, glow::TEXTURE_2D, color, 0);
        gl.draw_buffer(if color.is_some() { glow::COLOR_ATTACHMENT0 } else { glow::NONE });
        Ok((framebuffer, depth))
    }
}

unsafe fn pass(gl: &glow::Context, target: NativeFramebuffer, [width, height]: [i32; 2], count: i32) {
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(target));
        gl.viewport(0, 0, width, height);
        gl.clear_color(0.0, 0.0, 0.0, 0.0);
        gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        gl.draw_arrays(glow::TRIANGLES, 0, count);
    }
}

type View = (Vector, Vector, f64, [f64; 2]);

unsafe fn set_view(gl: &glow::Context, program: glow::NativeProgram, name: &str, view: View, aspect: f64) {
    let (place, target, half_degrees, [near, far]) = view;
    let forward = unit([0, 1, 2].map(|k| target[k] - place[k]));
    let right = unit(cross(forward, [0.0, 1.0, 0.0]));
    let vectors = [place, right, cross(right, forward), forward].concat();
    let scale = 1.0 / half_degrees.to_radians().tan();
    let vectors: Vec<f32> = vectors.into_iter().map(|value| value as f32).collect();
    let lens = [scale / aspect, scale, near, far].map(|value| value as f32);
    unsafe {
        gl.uniform_3_f32_slice(gl.get_uniform_location(program, name).as_ref(), &vectors);
        gl.uniform_4_f32_slice(gl.get_uniform_location(program, &format!("{name}_lens")).as_ref(), &lens);
    }
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: Vector) -> Vector {
    let length = v.iter().map(|value| value * value).sum::<f64>().sqrt();
    v.map(|value| value / length)
}

fn turned(place: Vector, about: Vector, angle: f64) -> Vector {
    let (x, z, (sin, cos)) = (place[0] - about[0], place[2] - about[2], angle.sin_cos());
    [about[0] + cos * x + sin * z, place[1], about[2] - sin * x + cos * z]
}

fn floor() -> Vec<Vector> {
    [[-4.0, -4.0], [-4.0, 4.0], [4.0, -4.0], [4.0, -4.0], [-4.0, 4.0], [4.0, 4.0]].map(|[x, z]| [x, 0.0, z]).to_vec()
}

/// Newell's patches, each mirrored as its heading says: two triangles a cell.
fn teapot() -> Result<Vec<Vector>, std::num::ParseFloatError> {
    let text = include_str!("../../data/teapot.txt");
    let lines: Vec<&str> = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')).collect();
    let mut triangles = Vec::new();
    for patch in lines.chunks(5) {
        let words = patch[1..].iter().flat_map(|line| line.split_whitespace());
        let numbers = words.map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        let signs: &[[f64; 2]] = &[[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        for [sx, sy] in &signs[..if patch[0].starts_with("turn") { 4 } else { 2 }] {
            let at = |i: usize, j: usize| -> Vector {
                let i = if sx * sy < 0.0 { CELLS - i } else { i }; // a mirrored patch is run through backwards
                let [u, v] = [i, j].map(|k| k as f64 / CELLS as f64);
                let weights =
                    |t: f64| [(1.0 - t).powi(3), 3.0 * t * (1.0 - t).powi(2), 3.0 * t * t * (1.0 - t), t.powi(3)];
                let (across, down) = (weights(u), weights(v));
                let sum = |k: usize| (0..16).map(|n| numbers[3 * n + k] * down[n / 4] * across[n % 4]).sum::<f64>();
                [0.5 * sx * sum(0), 0.5 * sum(2), -0.5 * sy * sum(1)]
            };
            for (i, j) in (0..CELLS * CELLS).map(|cell| (cell % CELLS, cell / CELLS)) {
                triangles.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    Ok(triangles)
}
