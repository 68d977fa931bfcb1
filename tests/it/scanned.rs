//! PLY and STL files, text and binary, and colours of vertices: meshes by formulas, pictures against truth.

use std::fmt::Write as _;
use std::path::Path;

use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::judge::colors::{color_options, draw_colors, errors_of};
use glumbra::scene::{Loaded, Scene};
use glumbra::truth;

use crate::support::random::Random;

/// A tent: two slopes of which each is a polygon of four corners, and its two gables.
const CORNERS: [[f32; 3]; 6] =
    [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0], [-0.75, 1.25, 0.0], [0.75, 1.25, 0.0]];
const COLORS: [[u8; 3]; 6] = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 51], [0, 255, 255], [204, 102, 255]];
const FACES: [&[u32]; 5] = [&[0, 1, 5, 4], &[2, 3, 4, 5], &[1, 2, 5], &[3, 0, 4], &[0, 3, 2, 1]];

fn ply_header(format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment by a test\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float quality\nelement face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        CORNERS.len(),
        FACES.len()
    )
}

fn text_ply() -> Vec<u8> {
    let mut text = ply_header("ascii");
    for ([x, y, z], [red, green, blue]) in CORNERS.iter().zip(&COLORS) {
        let _ = writeln!(text, "{x} {y} {z} {red} {green} {blue} 0.5");
    }
    for face in FACES {
        let corners: Vec<String> = face.iter().map(u32::to_string).collect();
        let _ = writeln!(text, "{} {}", face.len(), corners.join(" "));
    }
    text.into_bytes()
}

fn binary_ply(is_little: bool) -> Vec<u8> {
    let mut bytes = ply_header(if is_little { "binary_little_endian" } else { "binary_big_endian" }).into_bytes();
    let word = |word: u32| if is_little { word.to_le_bytes() } else { word.to_be_bytes() };
    for (corner, color) in CORNERS.iter().zip(&COLORS) {
        bytes.extend(corner.iter().flat_map(|number| word(number.to_bits())));
        bytes.extend(color);
        bytes.extend(word(0.5_f32.to_bits()));
    }
    for face in FACES {
        bytes.push(face.len() as u8);
        bytes.extend(face.iter().flat_map(|corner| word(*corner)));
    }
    bytes
}

/// The triangles of the tent, each polygon from its first corner.
fn triangles() -> Vec<[[f32; 3]; 3]> {
    let fan = |face: &&[u32]| {
        let place = |index: u32| CORNERS[index as usize];
        face[1..].windows(2).map(|pair| [place(face[0]), place(pair[0]), place(pair[1])]).collect::<Vec<_>>()
    };
    FACES.iter().flat_map(fan).collect()
}

/// `solids`: the numbers of triangles of each.
fn text_stl(solids: &[usize]) -> String {
    let (mut text, mut rest) = (String::new(), &triangles()[..]);
    for count in solids {
        let (these, after) = rest.split_at(*count);
        rest = after;
        text += "solid\n";
        for triangle in these {
            text += "facet normal 0 0 0\n outer loop\n";
            for [x, y, z] in triangle {
                let _ = writeln!(text, "  vertex {x} {y} {z}");
            }
            text += " endloop\nendfacet\n";
        }
        text += "endsolid\n";
    }
    text
}

/// `start`: the first bytes of the header, which say nothing.
fn binary_stl(start: &[u8]) -> Vec<u8> {
    let triangles = triangles();
    let mut bytes = start.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|number| number.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn written(folder: &Path, name: &str, bytes: &[u8]) -> Result<Loaded, String> {
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    let overrides = ["image.size=[96, 72]", "floor=false"].map(str::to_owned);
    glumbra::load(&path, &overrides).map_err(|error| error.to_string())
}

/// The places of a mesh's triangles, each from its least corner on, in order.
fn places(scene: &Scene) -> Vec<[[i32; 3]; 3]> {
    let mesh = &scene.objects[0].mesh;
    sorted(mesh.indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(|index| mesh.positions[index as usize])))
}

fn sorted(triangles: impl Iterator<Item = [[f32; 3]; 3]>) -> Vec<[[i32; 3]; 3]> {
    let mut all: Vec<[[i32; 3]; 3]> = triangles
        .map(|triangle| {
            let mut quarters = triangle.map(|corner| corner.map(|number| (4.0 * number) as i32));
            let least = (0..3).min_by_key(|at| quarters[*at]).unwrap();
            quarters.rotate_left(least);
            quarters
        })
        .collect();
    all.sort_unstable();
    all
}

#[test]
fn stl_files_have_their_triangles_however_they_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let expected = sorted(triangles().into_iter());
    let files: [(&str, Vec<u8>); 4] = [
        ("text.stl", text_stl(&[8]).into_bytes()),
        ("solids.stl", text_stl(&[3, 1, 4]).into_bytes()),
        ("binary.STL", binary_stl(b"made by a test")),
        ("misleading.stl", binary_stl(b"solid but binary")),
    ];
    for (name, bytes) in files {
        let loaded = written(folder.path(), name, &bytes).unwrap();
        assert_eq!(places(&loaded.scene), expected, "{name}");
        let mesh = &loaded.scene.objects[0].mesh;
        assert!(mesh.is_closed() && mesh.signed_volume() > 0.0, "{name}");
    }
}

#[test]
fn ply_files_have_their_polygons_and_colours_however_they_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let files = [("text.ply", text_ply()), ("little.ply", binary_ply(true)), ("big.ply", binary_ply(false))];
    for (name, bytes) in files {
        let loaded = written(folder.path(), name, &bytes).unwrap();
        assert_eq!(loaded.warnings, Vec::<String>::new());
        let mesh = &loaded.scene.objects[0].mesh;
        assert_eq!(mesh.indices.len(), 3 * triangles().len());
        assert!(mesh.is_closed() && mesh.signed_volume() > 0.0, "{name}");
        let colors = mesh.colors.as_ref().unwrap();
        assert_eq!(colors.len(), mesh.positions.len());
        for (position, color) in mesh.positions.iter().zip(colors) {
            let at = CORNERS.iter().position(|corner| corner == position).unwrap();
            assert_eq!(*color, COLORS[at].map(|code| (f64::from(code) / 255.0) as f32), "{name}");
        }
    }
}

/// Colours of the picture lie where the truth, which interpolates them in f64, has them; without them they do not.
#[test]
fn colours_of_vertices_are_drawn_as_the_truth_has_them() {
    let folder = tempfile::tempdir().unwrap();
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for overrides in [&[][..], &["shading.passes=shadow"], &["shading.ambient=[0.1, 0.5, 0.9]"]] {
        let path = folder.path().join("tent.ply");
        std::fs::write(&path, text_ply()).unwrap();
        let overrides: Vec<String> = [&["light.shadow={ technique = \"none\" }", "image.size=[200, 150]"], overrides]
            .concat()
            .iter()
            .map(|text| (*text).to_owned())
            .collect();
        let scene = glumbra::load(&path, &overrides).unwrap().scene;
        // Without shadows: at the edges of a map's they are the map's errors.
        let truth = truth::color(&scene, &[None], &color_options(&scene)).unwrap();
        let drawn = draw_colors(&scene, false, &mut renderer).unwrap();
        let (errors, _) = errors_of(&truth, &drawn).unwrap();
        assert!(errors.compared > truth.pixels.len() / 2, "{errors:?}");
        // The bounds hold the greatest error of a sample and of a code.
        assert_eq!(errors.beyond_percent, 0.0, "{overrides:?}: {errors:?}");
        let mut colorless = scene.clone();
        let mesh = std::sync::Arc::make_mut(&mut colorless.objects[0].mesh);
        mesh.colors = None;
        let plain = draw_colors(&colorless, false, &mut renderer).unwrap();
        assert!(errors_of(&truth, &plain).unwrap().0.beyond_percent > 5.0, "the truth has no colours");
    }
}

#[test]
fn fixed_function_says_that_it_has_no_colours_of_vertices() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tent.ply");
    std::fs::write(&path, text_ply()).unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_glumbra"));
    let output = command
        .args(["render", "--quiet", "--pipeline", "fixed-function", "-o"])
        .args([folder.path().join("p.png"), path])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && said.contains("colours of its vertices"), "{said}");
}

#[test]
fn wrong_files_are_one_error_that_names_the_place() {
    let folder = tempfile::tempdir().unwrap();
    let ply = |from: &str, to: &str| String::from_utf8(text_ply()).unwrap().replacen(from, to, 1).into_bytes();
    let mut cut = binary_ply(true);
    cut.truncate(cut.len() - 3);
    let mut unplaced = binary_ply(true);
    let first = ply_header("binary_little_endian").len();
    unplaced[first..first + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    let mut short = binary_stl(b"x");
    short.truncate(short.len() - 3);
    let mut infinite = binary_stl(b"x");
    infinite[84 + 50 + 12..84 + 50 + 16].copy_from_slice(&f32::INFINITY.to_le_bytes());
    for (name, bytes, expected) in [
        ("a.ply", ply("4 0 1 5 4", "4 0 1 9 4"), "a.ply: face 0: names a vertex that is none of the 6"),
        ("b.ply", ply("4 0 1 5 4", "4 0 -1 5 4"), "b.ply: face 0: names a vertex"),
        ("c.ply", ply("-1 0 1 255", "nan 0 1 255"), "c.ply:15: "),
        ("i.ply", unplaced, "i.ply: vertex 0: has a position that is not finite"),
        ("d.ply", ply("property float z", "property float depth"), "d.ply: vertex 0: has no x, y and z"),
        ("e.ply", ply("format ascii 1.0", "formt ascii 1.0"), "e.ply:2: "),
        ("f.ply", ply("-1 0 1 255", "-1 0 one 255"), "f.ply:15: "),
        ("g.ply", cut, "g.ply"),
        ("h.ply", Vec::new(), "h.ply: PLY: "),
        ("a.stl", short, "a.stl: triangle 7: cannot be read: "),
        ("b.stl", infinite, "b.stl: triangle 1: has a position that is not finite"),
        ("c.stl", text_stl(&[8]).replacen("vertex", "vortex", 1).into_bytes(), "c.stl: triangle 0: cannot be read"),
        ("d.stl", b"solid\nendsolid\n".to_vec(), "d.stl: has no faces"),
    ] {
        let Err(error) = written(folder.path(), name, &bytes) else { panic!("{name} loads") };
        assert!(error.contains(expected) && !error.contains('\n'), "{name}: {error}");
    }
}

#[test]
fn no_changed_byte_makes_the_readers_panic() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random::new(0x517);
    let files = [
        ("t.ply", text_ply()),
        ("b.ply", binary_ply(true)),
        ("t.stl", text_stl(&[4, 4]).into_bytes()),
        ("b.stl", binary_stl(b"x")),
    ];
    for (name, bytes) in files {
        let mut loaded = 0;
        for _ in 0..300 {
            let mut changed = bytes.clone();
            for _ in 0..1 + random.below(3) {
                let at = random.below(changed.len());
                let is_text = name.starts_with("t.");
                changed[at] = if is_text {
                    *b"0123456789.- \ne".get(random.below(16)).unwrap_or(&b'x')
                } else {
                    random.below(256) as u8
                };
            }
            match written(folder.path(), name, &changed) {
                Ok(_) => loaded += 1,
                Err(error) => assert!(error.contains(name), "{error}"),
            }
        }
        assert!((20..300).contains(&loaded), "{name}: {loaded} of 300 load");
    }
}
