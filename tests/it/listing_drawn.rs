//! The C of `glumbra plan --gl`, compiled, loaded and run, draws the picture that glumbra draws.

use std::cell::RefCell;
use std::ffi::{CString, c_int, c_void};
use std::path::Path;
use std::process::Command;
use std::rc::Rc;

use glam::Vec3;
use glow::HasContext;
use glumbra::context::compatibility::{Binding, raw};
use glumbra::context::{self, Context, ContextRequest, Profile};
use glumbra::device::{Device, Measure, Pixels};
use glumbra::fixed_function::{FixedFunction, listing};
use glumbra::geometry::{MeshTangents, normal_cube};
use glumbra::pass::{Draw, ImageDesc, IndexOrder, MeshRef, PassList, Program, Stage, Storage, Work};
use glumbra::plan::{self, Plan, Request};
use libloading::Library;

use crate::support::gl_headers;

const PROGRAMS: usize = 16;
const IMAGES: usize = 32;

/// Code that the caller of a listing brings, in C.
const SHIM: &str = "
#define GL_POINTERS
#include <GL/gl.h>
GLuint programs[16];
const void *all_texels[32];
void (*bind_for_listing)(int mesh);
const void *texels(int image) { return all_texels[image]; }
void bind_mesh(int mesh) { bind_for_listing(mesh); }
const void *(*levels_for_listing)(int image, int level);
const void *level_texels(int image, int level) { return levels_for_listing(image, level); }
const GLfloat *(*vectors_for_listing)(int mesh, const GLfloat *light, const GLfloat *eye);
const GLfloat *tangent_vectors(int mesh, const GLfloat light[4], const GLfloat eye[4])
{
    return vectors_for_listing(mesh, light, eye);
}
";

/// The buffers of a mesh: positions with their components, normals, coordinates, indices.
struct Buffers {
    positions: (glow::Buffer, i32),
    normals: Option<glow::Buffer>,
    texcoords: Option<glow::Buffer>,
    indices: glow::Buffer,
    mesh: MeshRef,
}

struct Meshes {
    gl: Rc<glow::Context>,
    binding: Binding,
    buffers: Vec<Buffers>,
    /// Levels, or faces, of each image.
    levels: Vec<Vec<Vec<[u8; 4]>>>,
    /// Vectors that a listing has asked for, as long as it may read them.
    vectors: Vec<Vec<[f32; 3]>>,
}

thread_local! {
    static MESHES: RefCell<Option<Meshes>> = const { RefCell::new(None) };
}

/// Texture units that may read the mesh's own coordinates.
const UNITS: u32 = 8;

/// Binds the arrays of fixed function, and those of programs.
extern "C" fn bind_mesh(mesh: c_int) {
    MESHES.with_borrow(|meshes| {
        let Meshes { gl, binding, buffers, .. } = meshes.as_ref().unwrap();
        let Buffers { positions: (positions, components), normals, texcoords, indices, .. } = &buffers[mesh as usize];
        // SAFETY: the context is current; the arrays are offsets into buffers.
        unsafe {
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(*positions));
            binding.VertexPointer(*components, glow::FLOAT, 0, std::ptr::null());
            binding.EnableClientState(raw::VERTEX_ARRAY);
            gl.vertex_attrib_pointer_f32(0, *components, glow::FLOAT, false, 0, 0);
            gl.enable_vertex_attrib_array(0);
            for (attribute, buffer, components) in [(1, normals, 3), (2, texcoords, 2)] {
                gl.bind_buffer(glow::ARRAY_BUFFER, *buffer);
                match buffer {
                    Some(_) => {
                        gl.vertex_attrib_pointer_f32(attribute, components, glow::FLOAT, false, 0, 0);
                        gl.enable_vertex_attrib_array(attribute);
                    }
                    None => gl.disable_vertex_attrib_array(attribute),
                }
            }
            if let Some(normals) = normals {
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(*normals));
                binding.NormalPointer(glow::FLOAT, 0, std::ptr::null());
                binding.EnableClientState(raw::NORMAL_ARRAY);
            }
            for unit in 0..UNITS {
                binding.ClientActiveTexture(glow::TEXTURE0 + unit);
                gl.bind_buffer(glow::ARRAY_BUFFER, *texcoords);
                if texcoords.is_some() {
                    binding.TexCoordPointer(2, glow::FLOAT, 0, std::ptr::null());
                    binding.EnableClientState(raw::TEXTURE_COORD_ARRAY);
                } else {
                    binding.DisableClientState(raw::TEXTURE_COORD_ARRAY);
                }
            }
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(*indices));
            // Mesa 22.3.6 keeps the fragment program of a framebuffer without colour for the next one with colour, where
            // no texture or fog state has changed. This makes it look again.
            gl.enable(raw::COLOR_SUM);
            gl.disable(raw::COLOR_SUM);
        }
    });
}

extern "C" fn level_texels(image: c_int, level: c_int) -> *const c_void {
    MESHES.with_borrow(|meshes| meshes.as_ref().unwrap().levels[image as usize][level as usize].as_ptr().cast())
}

/// Vectors in tangent space, as the listing's comment has them.
extern "C" fn tangent_vectors(mesh: c_int, light: *const [f32; 4], eye: *const [f32; 4]) -> *const [f32; 3] {
    // SAFETY: the listing gives four numbers, or no eye.
    let (light, eye) = unsafe { (*light, eye.as_ref()) };
    MESHES.with_borrow_mut(|meshes| {
        let meshes = meshes.as_mut().unwrap();
        let mesh = &meshes.buffers[mesh as usize].mesh;
        let MeshTangents { tangents, bitangents } = mesh.tangents.as_ref().unwrap();
        let way = |vertex: usize, [x, y, z, w]: [f32; 4]| {
            let way = Vec3::new(x, y, z) - w * Vec3::from(mesh.positions[vertex]);
            Vec3::from([tangents, bitangents, &mesh.normals].map(|axes| way.dot(Vec3::from(axes[vertex]))))
        };
        let of_vertex = |vertex: usize| match eye {
            Some(eye) => (way(vertex, light).normalize() + way(vertex, *eye).normalize()).to_array(),
            None => way(vertex, light).to_array(),
        };
        let vectors = (0..mesh.positions.len()).map(of_vertex).collect();
        meshes.vectors.push(vectors);
        meshes.vectors.last().unwrap().as_ptr()
    })
}

/// Texels of an image's levels, or of the faces of a cube map of unit vectors.
fn levels(desc: &ImageDesc) -> Vec<Vec<[u8; 4]>> {
    match &desc.storage {
        Storage::Levels(map) => map.levels.clone(),
        Storage::UnitVectors => (0..6).map(|face| normal_cube::packed_face(face, desc.size[0])).collect(),
        _ => Vec::new(),
    }
}

fn draws(list: &PassList) -> impl Iterator<Item = (&Program, &Draw)> {
    let passes = list.passes.iter().filter_map(|pass| match &pass.work {
        Work::Draw(draw) => Some(draw),
        Work::CopyDepth { .. } => None,
    });
    passes.flat_map(|pass| &pass.batches).flat_map(|batch| batch.draws.iter().map(|draw| (&batch.program, draw)))
}

fn push_new<T: PartialEq>(list: &mut Vec<T>, value: T) {
    if !list.contains(&value) {
        list.push(value);
    }
}

fn upload(gl: &glow::Context, bytes: &[u8]) -> glow::Buffer {
    // SAFETY: the context is current.
    unsafe {
        let buffer = gl.create_buffer().unwrap();
        gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
        gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytes, glow::STATIC_DRAW);
        buffer
    }
}

/// The meshes in the order of the listing: as draws first need them.
fn buffers(gl: &glow::Context, list: &PassList) -> Vec<Buffers> {
    let mut meshes = Vec::new();
    draws(list).for_each(|(_, draw)| push_new(&mut meshes, (&draw.mesh, draw.order)));
    let make = |(mesh, order): &(&glumbra::pass::MeshRef, IndexOrder)| {
        let indices = if *order == IndexOrder::VertexCache { mesh.cache_ordered() } else { mesh.indices.clone() };
        let positions = match mesh.positions.is_empty() {
            true => (upload(gl, bytemuck::cast_slice(&mesh.homogeneous)), 4),
            false => (upload(gl, bytemuck::cast_slice(&mesh.positions)), 3),
        };
        Buffers {
            positions,
            normals: (!mesh.normals.is_empty()).then(|| upload(gl, bytemuck::cast_slice(&mesh.normals))),
            texcoords: mesh.texcoords.as_ref().map(|texcoords| upload(gl, bytemuck::cast_slice(texcoords))),
            indices: upload(gl, bytemuck::cast_slice(&indices)),
            mesh: (*mesh).clone(),
        }
    };
    meshes.iter().map(make).collect()
}

fn link(gl: &glow::Context, program: &Program) -> u32 {
    // SAFETY: the context is current.
    unsafe {
        let name = gl.create_program().unwrap();
        for (stage, kind) in [(Stage::Vertex, glow::VERTEX_SHADER), (Stage::Fragment, glow::FRAGMENT_SHADER)] {
            let shader = gl.create_shader(kind).unwrap();
            gl.shader_source(shader, &program.source(stage).text);
            gl.compile_shader(shader);
            gl.attach_shader(name, shader);
        }
        gl.link_program(name);
        assert!(gl.get_program_link_status(name), "{}", gl.get_program_info_log(name));
        name.0.get()
    }
}

/// Compiles a listing with the shim and loads it, its function pointers set.
fn load(folder: &Path, text: &str, context: &dyn Context) -> Library {
    let [listing, shim, library] = ["listing.c", "shim.c", "listing.so"].map(|name| folder.join(name));
    std::fs::write(&listing, text).unwrap();
    std::fs::write(&shim, SHIM).unwrap();
    let mut cc = Command::new("cc");
    cc.args(["-std=c99", "-shared", "-fPIC", "-Wl,-Bsymbolic", "-o"])
        .args([&library, &listing, &shim])
        .arg("-I")
        .arg(folder);
    let output = cc.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    // SAFETY: it has just been compiled from what is above.
    let library = unsafe { Library::new(&library) }.unwrap();
    let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    for name in words.filter(|word| word.starts_with("gl") && word[2..].starts_with(|c: char| c.is_ascii_uppercase())) {
        let address = context.address_of(&CString::new(name).unwrap());
        assert!(!address.is_null(), "the driver has no {name}");
        // SAFETY: the shim defines a pointer of this name for every function of GL.
        unsafe { **library.get::<*mut *const c_void>(format!("ptr_{name}").as_bytes()).unwrap() = address };
    }
    library
}

fn open() -> Rc<dyn Context> {
    context::open(&ContextRequest { profile: Profile::Compatibility, ..ContextRequest::default() }).unwrap()
}

/// The picture that the listing draws, in RGBA, rows from the top down.
fn run_listing(plan: &Plan) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    gl_headers::write(folder.path(), true);
    let text = listing::c_source(&plan.list);
    let context = open();
    let library = load(folder.path(), &text, &*context);
    let gl = context.gl().clone();
    let mut programs = Vec::new();
    draws(&plan.list).for_each(|(program, _)| push_new(&mut programs, program));
    assert!(programs.len() <= PROGRAMS && plan.list.images.len() <= IMAGES);
    let (binding, buffers) = (Binding::load(&*context).unwrap(), buffers(&gl, &plan.list));
    let levels = plan.list.images.iter().map(levels).collect();
    MESHES.set(Some(Meshes { gl: gl.clone(), binding, buffers, levels, vectors: Vec::new() }));
    // SAFETY: the symbols are the shim's and the listing's, of these types; the context is current.
    unsafe {
        **library.get::<*mut extern "C" fn(c_int)>(b"bind_for_listing").unwrap() = bind_mesh;
        type Levels = extern "C" fn(c_int, c_int) -> *const c_void;
        type Vectors = extern "C" fn(c_int, *const [f32; 4], *const [f32; 4]) -> *const [f32; 3];
        **library.get::<*mut Levels>(b"levels_for_listing").unwrap() = level_texels;
        **library.get::<*mut Vectors>(b"vectors_for_listing").unwrap() = tangent_vectors;
        let names = *library.get::<*mut u32>(b"programs").unwrap();
        programs.iter().enumerate().for_each(|(index, program)| *names.add(index) = link(&gl, program));
        let texels = *library.get::<*mut *const u8>(b"all_texels").unwrap();
        for (index, desc) in plan.list.images.iter().enumerate() {
            if let Storage::Uploaded(texture) = &desc.storage {
                *texels.add(index) = texture.rgba.as_ptr();
            }
        }
        for function in [&b"create"[..], b"frame"] {
            (*library.get::<extern "C" fn()>(function).unwrap())();
        }
        let [width, height] = plan.list.desc(plan.picture).size;
        let row = 4 * width as usize;
        let mut pixels = vec![0; row * height as usize];
        let target = glow::PixelPackData::Slice(Some(&mut pixels));
        gl.read_pixels(0, 0, width as i32, height as i32, glow::RGBA, glow::UNSIGNED_BYTE, target);
        assert_eq!(gl.get_error(), glow::NO_ERROR);
        MESHES.take();
        pixels.chunks(row).rev().flatten().copied().collect()
    }
}

/// Pixels that differ by more than so many codes.
fn differing(a: &[u8], b: &[u8], codes: u8) -> usize {
    assert_eq!(a.len(), b.len());
    a.chunks(4).zip(b.chunks(4)).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > codes)).count()
}

fn rgba(pixels: Pixels) -> Vec<u8> {
    match pixels {
        Pixels::Rgba8 { data, .. } => data,
        other => panic!("a picture of 8 bits, not {:?}", other.size()),
    }
}

/// Scene, what is set, and whether fixed function draws it.
const DRAWN: &[(&str, &[&str], bool)] = &[
    ("data/cases/scenes/box.toml", &[], false),
    ("data/cases/scenes/box.toml", &["shading.lighting=\"per-vertex\""], true),
    ("data/cases/scenes/box.toml", &["shading.lighting=\"per-vertex\"", "light.shadow.transfer=\"copy\""], true),
    (
        "data/cases/scenes/box.toml",
        &["light.shadow.technique=\"shadow-volume\"", "light.shadow.method=\"z-fail\""],
        false,
    ),
    ("data/cases/scenes/box.toml", &["light.shadow.technique=\"midpoint\"", "light.shadow.single=\"first\""], false),
    ("data/cases/scenes/guards.toml", &["light.shadow.guard=\"clip-plane\""], false),
    ("data/cases/scenes/guards.toml", &["light.shadow.guard=\"texture-1d\""], false),
    ("data/stress/scenes/point.toml", &["light.shadow.technique=\"shadow-map\""], false),
    ("data/stress/scenes/sun.toml", &["light.shadow.technique=\"shadow-map\"", "light.shadow.kernel=\"3x3\""], false),
    ("data/cases/shadow-map/alpha-test/scene.toml", &[], false),
    ("data/cases/shadow-map/alpha-test/scene.toml", &["shading.lighting=\"per-vertex\""], true),
    ("data/scenes/hw_shadowmaps_simple.toml", &["shading.lighting=\"per-vertex\""], true),
    ("data/cases/slide-projector/room/scene.toml", &[], true),
    (
        "data/scenes/doughnut.toml",
        &[
            "shading.bump=\"three-pass\"",
            "object.0.closed=true",
            "object.0.material.specular=[0, 0, 0]",
            "object.0.material.bump.format=\"unorm8\"",
            "object.1.lit=false",
            "light.0.shape=\"frustum\"",
        ],
        true,
    ),
    (
        "data/scenes/doughnut.toml",
        &[
            "shading.bump=\"three-pass\"",
            "shading.two_units=true",
            "shading.normalize={ cube = 32, seamless = false }",
            "object.0.closed=true",
            "object.1.lit=false",
            "light.0.diffuse=[0, 0, 0]",
            "light.0.specular=[0, 0, 0]",
        ],
        true,
    ),
    ("data/cases/slide-projector/room/scene.toml", &["shading.background=\"ambient\""], true),
    ("data/cases/scenes/two_lights.toml", &["shading.passes=\"shadow\"", "shading.lighting=\"per-vertex\""], true),
    ("data/cases/scenes/two_lights.toml", &["shading.passes=\"shadow\""], false),
];

#[test]
fn the_listing_draws_the_picture() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (path, set, is_fixed) in DRAWN {
        let name = format!("{path} {set:?}");
        let set: Vec<String> = set.iter().map(|set| (*set).to_owned()).collect();
        let scene = glumbra::load(&root.join(path), &set).unwrap().scene;
        let plan = plan::make(&scene, &Request::default()).unwrap();
        let context = open();
        let mut fixed = FixedFunction::new(&context).unwrap();
        assert_eq!(fixed.inexpressible(&plan.list).is_empty(), *is_fixed, "{name}");
        let expected = if *is_fixed {
            fixed.run(&plan.list).unwrap();
            rgba(fixed.read(&plan.list, plan.picture).unwrap())
        } else {
            let mut device = Device::new(&context);
            device.run(&plan.list, Measure::No).unwrap();
            rgba(device.read(&plan.list, plan.picture).unwrap())
        };
        drop(fixed);
        drop(context);
        let colors: std::collections::HashSet<&[u8]> = expected.chunks(4).collect();
        assert!(colors.len() > 3, "{name}: an empty picture");
        let drawn = run_listing(&plan);
        // GL makes the eye planes in f32: a texel's border may run through a pixel.
        // Half-angle vectors of the caller's own arithmetic: measured 3 pixels.
        let has_half = set.iter().any(|set| set.contains("two_units"));
        let most = match (is_fixed, has_half) {
            (true, true) => 12,
            (true, false) => 0,
            (false, _) => expected.len() / 4 / 2000,
        };
        let off = differing(&expected, &drawn, u8::from(!*is_fixed));
        println!("{name}: {off} of {} pixels differ", expected.len() / 4);
        assert!(off <= most, "{name}: {off} pixels differ, {most} may");
    }
}
