//! Odd ways in which files are written, and missing normals.

use std::path::PathBuf;

use glam::Vec3;

use super::*;

fn written(name: &str, files: &[(&str, &str)]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().join(name);
    (folder, path)
}

fn load(text: &str) -> (Mesh, Vec<Warning>) {
    let (_folder, path) = written("a.obj", &[("a.obj", text)]);
    load_obj(&path).unwrap()
}

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 5 6 7 8\nf 2 1 4 3\nf 6 2 3 7\nf 1 5 8 4\nf 8 7 3 4\nf 1 2 6 5\n";

#[test]
fn edges_sharper_than_the_crease_are_split() {
    let (mesh, warnings) = load(CUBE);
    assert!(warnings.is_empty() && mesh.is_closed());
    assert_eq!((mesh.positions.len(), mesh.triangle_count()), (24, 12));
    for triangle in mesh.indices.chunks(3) {
        let [a, b, c] = [0, 1, 2].map(|k| Vec3::from_array(mesh.positions[triangle[k] as usize]));
        let own = (b - a).cross(c - a).normalize();
        for index in triangle {
            assert_eq!(mesh.normals[*index as usize], own.to_array());
        }
    }
}

/// A pyramid as flat as this is smooth: its top's normal is the axis, though one side is cut into slivers.
#[test]
fn smooth_normals_are_weighted_by_angle() {
    let base = "v 1 0 1\nv 1 0 -1\nv -1 0 -1\nv -1 0 1\nv 0 0.5 0\nv 1 0 0\n";
    let (mesh, _) = load(&format!("{base}f 1 6 5\nf 6 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"));
    let top = mesh.positions.iter().position(|position| *position == [0.0, 0.5, 0.0]).unwrap();
    assert!(Vec3::from_array(mesh.normals[top]).distance(Vec3::Y) < 1e-6);
    assert_eq!(mesh.positions.len(), 6);
}

#[test]
fn sphere_without_normals_gets_those_of_the_sphere() {
    let sphere = super::super::primitive("sphere").unwrap();
    let mut text = String::new();
    for [x, y, z] in &sphere.positions {
        text += &format!("v {x} {y} {z}\n");
    }
    for triangle in sphere.indices.chunks(3) {
        text += &format!("f {} {} {}\n", triangle[0] + 1, triangle[1] + 1, triangle[2] + 1);
    }
    let (mesh, _) = load(&text);
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        assert!(Vec3::from_array(*position).distance(Vec3::from_array(*normal)) < 2e-3);
    }
}

#[test]
fn unusable_normals_are_made_anew_and_others_kept() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let (mesh, warnings) = load(&format!("{triangle}vn 0 0 0\nvn nan 0 1\nvn 0 3 4\nf 1//1 2//2 3//3\n"));
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.6, 0.8]]);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    // Overflows to infinity, and some corners without.
    let (mesh, _) = load(&format!("{triangle}vn 1e39 0 0\nvn 0 3 4\nf 1//1 2 3//2\n"));
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.6, 0.8]]);
}

#[test]
fn triangles_without_area_do_not_bend_normals() {
    let (mesh, _) = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 3\n");
    assert_eq!(mesh.triangle_count(), 3);
    assert!(mesh.normals.iter().all(|normal| *normal == [0.0, 0.0, 1.0]));
    let (mesh, _) = load("v 0 0 0\nf 1 1 1\n");
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]]);
}

#[test]
fn coordinates_near_the_limits_of_floats_give_unit_normals() {
    for size in ["3e38", "1e-40"] {
        let (mesh, _) = load(&format!("v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nf 1 2 3\n"));
        assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3], "{size}");
    }
}

#[test]
fn odd_spellings_are_read() {
    let text = "\u{feff}# a\r\no\tbox one\r\n  v 0 0 0 1 0 0 1\r\nv 1 0 0 2\r\n\tv 0 1. +0e0\r\nvt 0.5\r\n\
        l 1 2 3\r\np 1\r\nusemtl\r\ng\r\nf 4/1 5/1 6/1\r\nv 0 0 1\nv 1 0 1\nv 0 1 1\ncstype bezier\nf 1 2 3 # end";
    let (mesh, warnings) = load(text);
    let said: Vec<_> = warnings.iter().map(ToString::to_string).collect();
    let tail = |line: usize, what: &str| said.iter().any(|said| said.ends_with(&format!("a.obj:{line}: {what}")));
    let left_out =
        [(3, "v: colours of vertices are not drawn"), (7, "l: lines are not drawn"), (8, "p: points are not drawn")];
    assert!(said.len() == 3 && left_out.iter().all(|(line, what)| tail(*line, what)), "{said:?}");
    assert_eq!((mesh.triangle_count(), mesh.positions.len()), (2, 6));
    assert_eq!((mesh.positions[0], mesh.positions[4]), ([0.0, 0.0, 1.0], [0.5, 0.0, 0.0]));
    assert_eq!(mesh.texcoords.unwrap(), [[0.5, 0.0], [0.5, 0.0], [0.5, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]]);
}

#[test]
fn missing_libraries_and_materials_are_warned_of() {
    let text = "mtllib no.mtl\nmtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n";
    let (_folder, path) = written("a.obj", &[("a.obj", text), ("a b.mtl", "newmtl red\nKd 1 0 0\n")]);
    let (mesh, warnings) = load_obj(&path).unwrap();
    let said: Vec<_> = warnings.iter().map(|warning| (warning.line, warning.message.as_str())).collect();
    let missing = "there is no material library 'no.mtl'";
    assert_eq!(said, [(1, missing), (8, "no material is named 'blue'; the default is used")]);
    assert_eq!(mesh.parts.iter().map(|part| part.material).collect::<Vec<_>>(), [Some(0), None]);
    assert_eq!(mesh.materials[0].diffuse, [1.0, 0.0, 0.0]);
}

#[test]
fn material_statements_are_read_in_odd_spellings() {
    let library = "newmtl  a b \nkd 0.5\nKa 0 0.25 2\nKs spectral x.rfl\nNs 5000\nd -halo 0.25\nillum 9\nKe 1\n\
        newmtl c\nTr 0.75\nnewmtl c\nKd 0 1 0\n";
    let text = "usemtl c\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl a b\nf 1 2 3\n";
    let (_folder, path) = written("a.obj", &[("a.obj", text), ("a.mtl", library)]);
    let (mesh, warnings) = load_obj(&path).unwrap();
    let said: Vec<_> = warnings.iter().map(|warning| (warning.line, warning.message.as_str())).collect();
    let expected = [
        (3, "Ka: 2 is not in [0, 1]; 1 is drawn"),
        (4, "Ks spectral is left out: colours are red, green and blue"),
        (5, "Ns: 5000 is not in [0, 1000]; 1000 is drawn"),
        (6, "d -halo is drawn as d: the angle of view does not count"),
        (7, "illum is left out: all surfaces are lit as by illum 2"),
        (8, "Ke is left out: nothing shines by itself"),
    ];
    assert_eq!(said, expected);
    assert_eq!(mesh.parts.iter().map(|part| part.material).collect::<Vec<_>>(), [Some(2), Some(0)]);
    let [ab, first_c, c] = &mesh.materials[..] else { panic!("{:?}", mesh.materials) };
    assert_eq!((ab.ambient, ab.diffuse, ab.specular), ([0.0, 0.25, 1.0], [0.5; 3], [0.0; 3]));
    assert_eq!((ab.shininess, ab.opacity, first_c.opacity, c.diffuse), (1000.0, 0.25, 0.25, [0.0, 1.0, 0.0]));
}

/// The warnings of a triangle with the statements `material`, as line and message, and its material.
fn material(material: &str) -> (Vec<(usize, String)>, super::super::Material) {
    let picture = image::RgbaImage::from_pixel(2, 2, image::Rgba([10, 200, 30, 255]));
    let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
    let (folder, path) = written("a.obj", &[("a.obj", text), ("a.mtl", &format!("newmtl m\n{material}"))]);
    picture.save(folder.path().join("a.png")).unwrap();
    let (mesh, warnings) = load_obj(&path).unwrap();
    let said = warnings.into_iter().map(|warning| (warning.line, warning.message)).collect();
    (said, mesh.materials[0].clone())
}

#[test]
fn options_of_maps_are_applied() {
    let (said, found) = material("map_Kd -s 2 3 -o 0.5 -clamp on a.png\nmap_d -imfchan g -mm 0.1 0.5 a.png\n");
    assert!(said.is_empty(), "{said:?}");
    let placed = found.decal_placement;
    assert_eq!((placed.scale, placed.offset, placed.clamped), ([2.0, 3.0], [0.5, 0.0], true));
    assert_eq!((found.decal.unwrap().rgba[0], found.alpha_placement), (10, Default::default()));
    let alpha = found.alpha.unwrap();
    assert_eq!((alpha.rgba[0], alpha.has_alpha), ((0.1_f32 * 255.0 + 100.0).round() as u8, false));
}

#[test]
fn what_no_picture_shows_is_warned_of_once() {
    let (said, _) = material(
        "map_Kd -bm 2 -imfchan r a.png\nmap_Bump -bm 1 a.png\nnorm a.png\nPr 0.5\nPm 1\nmap_Pr a.png\nKe 0 0 0\n\
         Ni 1.5\nillum 2\n# a note\nKdd 1 1 1\nmap_Ka a.png\n",
    );
    let expected = [
        (2, "map_Kd -bm is left out"),
        (2, "map_Kd -imfchan is left out"),
        (
            3,
            "map_Bump is left out: MTL has no unit of height, not in -bm either; name the picture in the scene, with its \
             height in texels: material = { bump = { height = \"FILE\", scale = 4.0 } }",
        ),
        (4, "norm is left out: name it in the scene: material = { bump = { normal_map = \"FILE\" } }"),
        (5, "Pr is left out, as all of physically based materials: Ka, Kd, Ks and Ns are drawn (3 times)"),
        (12, "'Kdd' is no statement of MTL; it is left out"),
    ];
    assert_eq!(said, expected.map(|(line, what)| (line, what.to_owned())));
    // Another picture for ambient light than for diffuse light.
    let (said, _) = material("map_Ka a.png\n");
    assert_eq!(said, [(2, String::from("map_Ka is left out: of textures, map_Kd and map_d are drawn"))]);
}

#[test]
fn d_counts_where_a_tr_contradicts_it() {
    for (text, opacity, warned) in [
        ("d 1\nTr 1\n", 1.0, true),
        ("Tr 1\nd 1\n", 1.0, true),
        ("d 0.25\nTr 0.75\n", 0.25, false),
        ("Tr 0.75\nTr 0.25\n", 0.75, false),
        ("d 0.5\nd 1\nTr 0\n", 1.0, false),
    ] {
        let (said, found) = material(text);
        assert_eq!((found.opacity, said.len()), (opacity, usize::from(warned)), "{text}: {said:?}");
        assert!(said.iter().all(|(line, what)| *line == 3 && what.contains("d counts")), "{said:?}");
        assert!(found.opacity_origin.contains("a.mtl:"), "{}", found.opacity_origin);
    }
}

#[test]
fn cache_order_keeps_triangles_and_parts() {
    let sphere = super::super::primitive("sphere").unwrap();
    let mut triangles = [sphere.indices.clone(), sphere.cache_ordered()].map(|indices| {
        let turned = |t: &[u32; 3]| {
            let mut t = *t;
            let first = (0..3).min_by_key(|k| t[*k]).unwrap();
            t.rotate_left(first);
            t
        };
        indices.as_chunks::<3>().0.iter().map(turned).collect::<Vec<_>>()
    });
    assert_ne!(triangles[0], triangles[1]);
    triangles.iter_mut().for_each(|triangles| triangles.sort_unstable());
    assert_eq!(triangles[0], triangles[1]);
    let optimized = sphere.cache_optimized();
    assert!(optimized.is_closed() && optimized.bounds == sphere.bounds && optimized.parts == sphere.parts);
    let ratio = |mesh: &Mesh| meshopt::analyze_vertex_cache(&mesh.indices, mesh.positions.len(), 16, 0, 0).acmr;
    assert!(ratio(&optimized) < 0.75 && ratio(&sphere) > 0.9, "{} {}", ratio(&optimized), ratio(&sphere));
}

#[test]
fn topology_tells_open_turned_and_crowded_edges() {
    let count = |text: &str| {
        let topology = super::super::topology::inspect(&load(text).0);
        [topology.open_edges, topology.turned_edges, topology.crowded_edges]
    };
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\n";
    assert_eq!(count(&format!("{vertices}f 1 2 3\n")), [3, 0, 0]);
    assert_eq!(count(&format!("{vertices}f 1 2 3\nf 1 2 4\n")), [4, 1, 0]);
    assert_eq!(count(&format!("{vertices}f 1 2 3\nf 2 1 4\nf 1 2 5\n")), [6, 0, 1]);
    assert_eq!(count(&format!("{vertices}f 1 2 3\nf 3 2 1\nf 1 1 4\n")), [0, 0, 0]);
}

/// A prism over a regular polygon of `sides` corners, of radius `radius` and as high, around `middle`; and its volume.
fn prism(sides: usize, radius: f64, middle: [f64; 3]) -> (String, f64) {
    let mut text = String::new();
    for height in [0.0, radius] {
        for k in 0..sides {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / sides as f64).sin_cos();
            let [x, y, z] = [middle[0] + radius * cos, middle[1] + height, middle[2] - radius * sin];
            text += &format!("v {x} {y} {z}\n");
        }
    }
    for k in 0..sides {
        let next = (k + 1) % sides;
        text += &format!("f {} {} {} {}\n", k + 1, next + 1, sides + next + 1, sides + k + 1);
    }
    let ring = |from: usize| (0..sides).map(|k| (from + k).to_string()).collect::<Vec<_>>();
    let mut bottom = ring(1);
    bottom.reverse();
    text += &format!("f {}\nf {}\n", bottom.join(" "), ring(sides + 1).join(" "));
    let area = 0.5 * sides as f64 * radius * radius * (std::f64::consts::TAU / sides as f64).sin();
    (text, area * radius)
}

#[test]
fn files_far_from_their_origin_keep_their_shape() {
    for (sides, radius, middle) in [
        (24, 0.5, [500_000.0, 210.0, 5_400_000.0]),
        (7, 0.3, [1e4, -1e4, 1e4]),
        (64, 12.0, [3.4e6, 5.7e6, 120.0]),
        (5, 1e-3, [0.0, 37.0, 0.0]),
        (9, 1e5, [-1e12, 1e12, 0.0]),
    ] {
        let (text, volume) = prism(sides, radius, middle);
        let (mesh, warnings) = load(&text);
        assert!(warnings.is_empty() && mesh.is_closed(), "{middle:?}: {warnings:?}");
        let off = mesh.signed_volume() / volume - 1.0;
        // f64 itself rounds what the file holds by 2^-53 of its distance.
        let rounding = 1e-15 * f64::from(middle.map(|x: f64| x.abs() as f32).into_iter().fold(0.0, f32::max)) / radius;
        assert!(off.abs() < 1e-6 + 10.0 * rounding, "{middle:?}: the volume is off by {off:e}");
        let center = mesh.origin + mesh.bounds.center();
        let expected = glam::DVec3::from(middle) + glam::DVec3::Y * (0.5 * radius);
        // The middle of an odd polygon's box is not its own.
        assert!(center.distance(expected) < 0.1 * radius, "{center} is not {expected}");
    }
}

#[test]
fn files_near_their_origin_are_read_as_they_are() {
    for middle in [[0.0; 3], [0.7, -0.3, 0.1], [3.0, 0.0, 5.0]] {
        let (text, _) = prism(24, 0.5, middle);
        let (mesh, _) = load(&text);
        assert_eq!(mesh.origin, glam::DVec3::ZERO);
        for line in text.lines().filter(|line| line.starts_with("v ")) {
            let place: Vec<f32> = line[2..].split(' ').map(|word| word.parse().unwrap()).collect();
            assert!(mesh.positions.iter().any(|position| position[..] == place[..]), "{line}");
        }
    }
}

#[test]
fn what_is_too_fine_for_floats_is_warned_of() {
    // Two prisms far from each other have no origin near both.
    for (radius, apart, lost) in [(0.5, 1e7, true), (0.5, 1e6, true), (0.5, 1e4, false), (0.5, 10.0, false)] {
        let (first, _) = prism(24, radius, [0.0; 3]);
        let (second, _) = prism(24, radius, [apart, 0.0, 0.0]);
        let second: String = second
            .lines()
            .map(|line| match line.strip_prefix("f ") {
                Some(corners) => {
                    let corners = corners.split(' ').map(|k| (k.parse::<usize>().unwrap() + 48).to_string());
                    format!("f {}\n", corners.collect::<Vec<_>>().join(" "))
                }
                None => format!("{line}\n"),
            })
            .collect();
        let (_, warnings) = load(&format!("{first}{second}"));
        let said = warnings.iter().any(|warning| warning.message.contains("too fine for 32-bit floats"));
        assert_eq!(said, lost, "{apart}: {warnings:?}");
    }
    // Vertices that an exporter has rounded twice are no detail.
    let (_, warnings) = load("v 1 1 0\nv 1.00000000001 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n");
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn words_end_at_every_white_space() {
    // U+0085 and U+00A0, as Latin-1 has them, and a vertical tab.
    for space in ['\u{85}', '\u{a0}', '\u{b}'] {
        let text = format!("v 0 0 0\nv{space}1 0 0\nv 0 1 0\nf{space}{space}\nf{space}1 2 3\n");
        let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.obj");
        std::fs::write(&path, latin).unwrap();
        let (mesh, warnings) = load_obj(&path).unwrap();
        assert_eq!((mesh.positions.len(), mesh.indices.len()), (3, 3), "{space:?}");
        assert_eq!(warnings.len(), 1, "{space:?}: {warnings:?}");
    }
}

#[test]
fn concave_polygons_too_large_to_be_clipped_have_a_warning() {
    // A star of 4100 rays: every second corner is nearer to the middle.
    let star = |corners: u32| {
        let place = |k: u32| {
            let (angle, radius) = (std::f64::consts::TAU * f64::from(k) / f64::from(corners), f64::from(1 + k % 2));
            format!("v {} {} 0\n", radius * angle.cos(), radius * angle.sin())
        };
        let face: String = (1..=corners).map(|k| format!(" {k}")).collect();
        (0..corners).map(place).collect::<String>() + "f" + &face + "\n"
    };
    let warned = |text: &str| {
        let path = Path::new("star.obj");
        decode_obj(path, text.as_bytes())
            .unwrap()
            .1
            .iter()
            .any(|warning| warning.message.contains("of more than 8192 corners"))
    };
    assert!(warned(&star(8200)) && !warned(&star(200)));
}
