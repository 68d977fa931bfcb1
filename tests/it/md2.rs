//! Key-framed models: MD2 files that come back to the bit, malformed ones with the byte that is wrong, poses by hand.

use std::path::{Path, PathBuf};

use glam::DVec3;
use glumbra::geometry::md2::{self, Frame, Md2, Model, NormalSource, Pose, Triangle};
use glumbra::geometry::tangents::{BasisFit, Tangents};
use glumbra::geometry::{Mesh, topology};

/// A closed body of random vertices: a sphere of latitudes and longitudes with a seam in its skin, clockwise as MD2 has it,
/// which other random numbers bulge in each frame.
pub fn random_model(random: &mut fastrand::Rng) -> Md2 {
    let (rings, sides) = (random.usize(2..7), random.usize(3..9));
    let place = |ring: usize, side: usize| match ring {
        0 => 0,
        ring if ring == rings => 1,
        ring => 2 + (ring - 1) * sides + side % sides,
    };
    let texcoord = |ring: usize, side: usize| (ring * (sides + 1) + side) as u16;
    let mut triangles = Vec::new();
    for (ring, side) in (0..rings).flat_map(|ring| (0..sides).map(move |side| (ring, side))) {
        let corners = [(ring, side), (ring + 1, side), (ring + 1, side + 1), (ring, side + 1)];
        for [a, b, c] in [[0, 2, 1], [0, 3, 2]].map(|three| three.map(|corner: usize| corners[corner])) {
            let vertices = [a, b, c].map(|(ring, side)| place(ring, side) as u16);
            let texcoords = [a, b, c].map(|(ring, side)| texcoord(ring, side));
            if vertices[0] != vertices[1] && vertices[1] != vertices[2] && vertices[2] != vertices[0] {
                triangles.push(Triangle { vertices, texcoords });
            }
        }
    }
    let vertices = 2 + (rings - 1) * sides;
    let name = |text: &str| {
        let mut bytes = [0; 16];
        bytes[..text.len()].copy_from_slice(text.as_bytes());
        bytes
    };
    let frames: Vec<Frame> = (1..=4)
        .map(|number| {
            let mut codes = vec![[0; 4]; vertices];
            for (ring, side) in (0..=rings).flat_map(|ring| (0..sides).map(move |side| (ring, side))) {
                let down = std::f64::consts::PI * ring as f64 / rings as f64;
                let around = std::f64::consts::TAU * side as f64 / sides as f64;
                let reach = 90.0 + 30.0 * random.f64();
                let code = |part: f64| (127.5 + reach * part) as u8;
                codes[place(ring, side)] = [
                    code(down.sin() * around.cos()),
                    code(down.sin() * around.sin()),
                    code(down.cos()),
                    random.u8(0..162),
                ];
            }
            let scale = [(); 3].map(|()| 0.01 + random.f32());
            Frame {
                scale,
                translate: scale.map(|scale| -127.0 * scale),
                name: name(&format!("walk{number}")),
                vertices: codes,
            }
        })
        .collect();
    let mut skin = [0; 64];
    skin[..8].copy_from_slice(b"body.png");
    Md2 {
        skin_size: [random.i32(1..400), random.i32(1..400)],
        skins: vec![skin],
        texcoords: (0..=rings)
            .flat_map(|ring| (0..=sides).map(move |side| [(4 * side) as i16, (3 * ring) as i16]))
            .collect(),
        triangles,
        frames,
        gl_commands: (0..random.i32(0..9)).collect(),
    }
}

/// The model of a file, and its warnings.
fn ready(file: &Md2) -> (Model, Vec<String>) {
    let mut warnings = Vec::new();
    let model = Model::new(file.clone(), "model.md2", |warning| warnings.push(warning));
    (model, warnings)
}

#[test]
fn files_come_back_to_the_bit() {
    let mut random = fastrand::Rng::with_seed(3);
    for _ in 0..50 {
        let model = random_model(&mut random);
        let bytes = md2::write(&model);
        let back = md2::read(&bytes, Path::new("model.md2")).unwrap();
        assert_eq!(back, model);
        assert_eq!(md2::write(&back), bytes);
        assert_eq!(ready(&back).1, Vec::<String>::new());
    }
}

/// Puts a little-endian integer at an offset.
fn patched(bytes: &[u8], offset: usize, value: i32) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[offset..offset + 4].copy_from_slice(&value.to_le_bytes());
    bytes
}

#[test]
fn malformed_files_name_the_byte() {
    let model = random_model(&mut fastrand::Rng::with_seed(1));
    let good = md2::write(&model);
    let header = |index: usize| i32::from_le_bytes(good[4 * index..4 * index + 4].try_into().unwrap());
    let [texcoords, triangles, frames] = [12, 13, 14].map(|index| header(index) as usize);
    let short = |offset: usize, value: u16| {
        let mut bytes = good.clone();
        bytes[offset..offset + 2].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    let byte = |offset: usize, value: u8| {
        let mut bytes = good.clone();
        bytes[offset] = value;
        bytes
    };
    let nan = i32::from_le_bytes(f32::NAN.to_le_bytes());
    let huge = i32::from_le_bytes(3e38_f32.to_le_bytes());
    let cases: Vec<(Vec<u8>, usize, &str)> = vec![
        (Vec::new(), 0, "the file ends after 0 bytes"),
        (good[..30].to_vec(), 44, "the file ends after 30 bytes"),
        (byte(0, b'J'), 0, "begins with \"JDP2\"; an MD2 file begins with \"IDP2\""),
        (patched(&good, 4, 7), 4, "has version 7; MD2 files have version 8"),
        (patched(&good, 8, 0), 8, "the skin's width is 0 texels"),
        (patched(&good, 12, -4), 12, "the skin's height is -4 texels"),
        (patched(&good, 16, 44), 16, "bytes, not 44"),
        (patched(&good, 24, 0), 24, "has 0 vertices; an MD2 model has 1 to 65536"),
        (patched(&good, 24, -1), 24, "the number of vertices is -1"),
        (patched(&good, 20, i32::MAX), 44, "2147483647 skins of 64 bytes"),
        (patched(&good, 28, i32::MAX), 48, "texture coordinates of 4 bytes"),
        (patched(&good, 32, 0), 32, "has no triangles"),
        (patched(&good, 40, 0), 40, "has no frames"),
        (patched(&good, 40, i32::MAX), 56, "2147483647 frames of"),
        (patched(&good, 48, 4), 48, "from byte 4 on do not fit"),
        (patched(&good, 52, -12), 52, "the offset of the triangles is -12"),
        (patched(&good, 52, good.len() as i32), 52, "do not fit in"),
        (patched(&good, 52, texcoords as i32 + 2), texcoords + 2, "the texture coordinates reach to byte"),
        (patched(&good, 64, good.len() as i32 + 1), 64, "and ends after"),
        (short(triangles + 2, 60_000), triangles + 2, "a triangle uses vertex 60000 of"),
        (short(triangles + 12 + 10, 60_001), triangles + 22, "a triangle uses texture coordinate 60001 of"),
        (patched(&good, frames, nan), frames, "a frame's scale is NaN"),
        (patched(&good, frames + 12, nan), frames + 12, "a frame's offset is NaN"),
        (patched(&good, frames + 4, huge), frames, "reach out to 7.65"),
        (byte(frames + 40 + 3, 162), frames + 43, "vertex 0 has normal 162 of 162"),
    ];
    assert!(cases.len() >= 20);
    for (bytes, offset, expected) in cases {
        let error = md2::read(&bytes, Path::new("model.md2")).unwrap_err().to_string();
        let begins = format!("model.md2: at byte {offset}: ");
        assert!(error.starts_with(&begins) && error.contains(expected), "{error}: not {begins}{expected}");
    }
    // Cut off anywhere: an error.
    for length in 0..good.len() {
        assert!(md2::read(&good[..length], Path::new("model.md2")).is_err(), "{length} of {} bytes", good.len());
    }
}

#[test]
fn bytes_changed_at_random_are_read_or_refused() {
    let mut random = fastrand::Rng::with_seed(8);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..3000 {
        let mut bytes = md2::write(&random_model(&mut random));
        for _ in 0..random.usize(1..5) {
            let at = if random.bool() { random.usize(0..68) } else { random.usize(0..bytes.len()) };
            bytes[at] = random.u8(..);
        }
        match md2::read(&bytes, Path::new("model.md2")) {
            Ok(file) => {
                read += 1;
                let (model, _) = ready(&file);
                let last = model.frame_count() - 1;
                let mesh = model.mesh(&Pose { frames: [0, last], blend: 0.3 }, NormalSource::File);
                let numbers = mesh.positions.iter().chain(&mesh.normals).flatten();
                assert!(numbers.chain(mesh.texcoords.iter().flatten().flatten()).all(|number| number.is_finite()));
            }
            Err(_) => refused += 1,
        }
    }
    assert!(read > 300 && refused > 500, "{read} read, {refused} refused");
}

/// A vertex between two frames, by its own arithmetic: dequantised, blended, turned from z up to y up.
fn by_hand(file: &Md2, [first, second]: [usize; 2], blend: f64, vertex: usize) -> DVec3 {
    let place = |frame: usize| {
        let Frame { scale, translate, vertices, .. } = &file.frames[frame];
        let at = |axis: usize| f64::from(vertices[vertex][axis]) * f64::from(scale[axis]) + f64::from(translate[axis]);
        DVec3::new(at(0), at(2), -at(1))
    };
    (1.0 - blend) * place(first) + blend * place(second)
}

#[test]
fn a_pose_is_blended_by_hand() {
    let mut random = fastrand::Rng::with_seed(4);
    for _ in 0..30 {
        let file = random_model(&mut random);
        let (model, _) = ready(&file);
        let (frames, blend) = ([random.usize(0..4), random.usize(0..4)], random.f64());
        let mesh = model.mesh(&Pose { frames, blend }, NormalSource::File);
        assert!(mesh.is_closed() && mesh.signed_volume() > 0.0, "closed, looking outwards");
        assert_eq!(mesh.triangle_count(), file.triangles.len());
        for (vertex, position) in model.vertices().zip(&mesh.positions) {
            let expected = by_hand(&file, frames, blend, vertex);
            let found = DVec3::from_array(position.map(f64::from));
            assert!(found.distance(expected) <= 1e-7 * expected.length().max(100.0), "{found}, not {expected}");
        }
        // The first corner of each triangle has the file's texture coordinate, t upwards.
        let [width, height] = file.skin_size.map(|size| size as f32);
        for (triangle, indices) in file.triangles.iter().zip(mesh.indices.as_chunks::<3>().0) {
            let [s, t] = file.texcoords[usize::from(triangle.texcoords[0])].map(f32::from);
            let [found_s, found_t] = mesh.texcoords.as_ref().unwrap()[indices[0] as usize];
            assert!((found_s - s / width).abs() < 1e-6 && (found_t - (1.0 - t / height)).abs() < 1e-5);
        }
    }
}

/// Mean angle in degrees between a mesh's normals and those of another.
fn mean_angle(a: &Mesh, b: &Mesh) -> f64 {
    let angles = a.normals.iter().zip(&b.normals).map(|(a, b)| {
        let [a, b] = [a, b].map(|normal| DVec3::from_array(normal.map(f64::from)));
        a.angle_between(b).to_degrees()
    });
    angles.sum::<f64>() / a.normals.len() as f64
}

/// Models that this machine has, of Debian's assimp-testmodels.
fn real_files() -> Vec<PathBuf> {
    let files = ["faerie", "sydney"].map(|name| PathBuf::from(format!("/usr/share/assimp/models/MD2/{name}.md2")));
    files.into_iter().filter(|path| path.exists()).collect()
}

/// The file's normals are those of its triangles, but for the rounding to 162 directions: 6 degrees in the mean, and their own way of weighing triangles.
#[test]
fn real_models_have_the_normals_of_their_triangles() {
    for path in real_files() {
        let (model, warnings) = Model::load(&path).unwrap_or_else(|error| panic!("{error}"));
        println!("{}: {} frames; {warnings:?}", path.display(), model.frame_count());
        for frame in (0..model.frame_count()).step_by(20) {
            let pose = Pose { frames: [frame; 2], blend: 0.0 };
            let [own, recomputed] =
                [NormalSource::File, NormalSource::Recomputed].map(|source| model.mesh(&pose, source));
            let apart = mean_angle(&own, &recomputed);
            assert!(apart < 20.0, "{} frame {frame}: {apart:.1} degrees", path.display());
            assert!(topology::inspect(&own).triangles > 600);
        }
    }
}

/// On a sphere, whose normals are known, rounded to the nearest direction by the test itself: no normal is more than 11
/// degrees off, and a wrong order of the directions would be.
#[test]
fn normals_by_number_are_the_nearest_directions() {
    let mut random = fastrand::Rng::with_seed(2);
    let mut file = random_model(&mut random);
    let mut directions = Vec::new();
    for normal in 0..162 {
        file.frames[0].vertices[0][3] = normal;
        let (model, _) = ready(&file);
        let vertex = model.vertices().position(|vertex| vertex == 0).unwrap();
        directions.push(model.mesh(&Pose::default(), NormalSource::File).normals[vertex]);
    }
    // Known entries of the format: the first is (-0.525731, 0, 0.850651), number 5 is z, 32 is y, 52 is x, z up.
    for (number, expected) in
        [(0, [-0.525_731, 0.850_651, 0.0]), (5, [0.0, 1.0, 0.0]), (32, [0.0, 0.0, -1.0]), (52, [1.0, 0.0, 0.0])]
    {
        let found: [f32; 3] = directions[number];
        assert!(found.iter().zip(expected).all(|(a, b): (&f32, f32)| (a - b).abs() < 1e-5), "{number}: {found:?}");
    }
}

const SCENE: &str = "[camera]\neye = [0, 100, 300]\ntarget = [0, 0, 0]\n[[object]]\nmesh = \"model.md2\"\n";

/// Loads the scene with keys of the object, and says what is wrong.
fn scene(folder: &Path, keys: &str) -> Result<std::sync::Arc<Mesh>, String> {
    let path = folder.join("scene.toml");
    std::fs::write(&path, format!("{SCENE}{keys}\n")).unwrap();
    let loaded = glumbra::load(&path, &[]).map_err(|error| error.to_string())?;
    Ok(loaded.scene.objects[0].mesh.clone())
}

#[test]
fn scenes_name_frames() {
    let folder = tempfile::tempdir().unwrap();
    let file = random_model(&mut fastrand::Rng::with_seed(6));
    std::fs::write(folder.path().join("model.md2"), md2::write(&file)).unwrap();
    let (model, _) = ready(&file);
    for (keys, frames, blend) in [
        ("", [0, 0], 0.0),
        ("frame = 2", [2, 2], 0.0),
        ("frame = \"walk4\"", [3, 3], 0.0),
        ("frame = 1.25", [1, 2], 0.25),
        ("frame = 3.0", [3, 3], 0.0),
        ("frames = [3, \"walk1\"]\nblend = 0.4", [3, 0], 0.4),
        ("frames = [\"walk2\", 1]", [1, 1], 0.0),
    ] {
        let found = scene(folder.path(), keys).unwrap();
        let expected = model.mesh(&Pose { frames, blend }, NormalSource::File);
        assert_eq!(found.positions, expected.positions, "{keys}");
        assert_eq!(found.normals, expected.normals, "{keys}");
    }
    let recomputed = scene(folder.path(), "normals = \"recomputed\"").unwrap();
    assert_eq!(recomputed.normals, model.mesh(&Pose::default(), NormalSource::Recomputed).normals);
    for (keys, expected) in [
        ("frame = 3.5", "scene.toml:6: `object.frame` must be a frame from 0 to 3, not 3.5"),
        ("frame = -1", "scene.toml:6: `object.frame` must be a frame from 0 to 3, not -1"),
        (
            "frame = \"walk\"",
            "scene.toml:6: `object.frame` names no frame of the model, \"walk\": did you mean `walk1`?",
        ),
        ("frame = true", "`object.frame` must be the number or the name of a frame"),
        ("frames = [0]", "`object.frames` must be an array of two frames"),
        ("frames = [0, 1.5]", "`object.frames` must be the number or the name of a frame"),
        ("frames = [0, 1]\nblend = 1.5", "`object.blend` must be in [0, 1], not 1.5"),
        ("blend = 0.5", "`object.blend` needs `frames`"),
        ("frame = 1\nframes = [0, 1]", "`object.frame` and `frames` exclude each other"),
        ("normals = \"smooth\"", "`object.normals` cannot be \"smooth\""),
    ] {
        let error = scene(folder.path(), keys).unwrap_err();
        assert!(error.contains(expected), "{keys}: {error}");
    }
    let path = folder.path().join("box.toml");
    std::fs::write(&path, "[[object]]\nmesh = \"box\"\nframe = 1\n").unwrap();
    let error = glumbra::load(&path, &[]).unwrap_err().to_string();
    assert!(error.contains("box.toml:3: `object.frame` belongs to key-framed models"), "{error}");
}

/// The decal of the scene's object, and what its plan says of it.
fn decal(folder: &Path, keys: &str) -> (Option<[u32; 2]>, Vec<String>) {
    let path = folder.join("scene.toml");
    std::fs::write(&path, format!("{SCENE}{keys}\n")).unwrap();
    let loaded = glumbra::load(&path, &[]).unwrap();
    assert!(loaded.warnings.iter().all(|warning| warning.contains("no [[light]]")), "{:?}", loaded.warnings);
    let plan = glumbra::plan::make(&loaded.scene, &Default::default()).unwrap();
    assert!(plan.warnings.is_empty(), "{:?}", plan.warnings);
    let said = plan.chosen.iter().filter(|chosen| chosen.why.contains("skin"));
    let said = said.map(|chosen| format!("{}: {}: {}", chosen.of, chosen.choice, chosen.why)).collect();
    let material = loaded.scene.objects[0].material.as_ref();
    let decal = material.and_then(|material| material.decal.as_ref());
    (decal.map(|decal| [decal.width, decal.height]), said)
}

#[test]
fn a_skin_beside_the_file_is_the_decal() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut file = random_model(&mut fastrand::Rng::with_seed(14));
    let picture = |name: &str, width: u32| image::RgbImage::new(width, 2).save(folder.join(name)).unwrap();
    let write = |file: &Md2| std::fs::write(folder.join("model.md2"), md2::write(file)).unwrap();
    let name = |file: &mut Md2, text: &str| {
        file.skins[0] = [0; 64];
        file.skins[0][..text.len()].copy_from_slice(text.as_bytes());
    };
    write(&file);
    // The random model names body.png.
    let (found, said) = decal(folder, "");
    assert_eq!(found, None);
    assert!(
        said.len() == 1 && said[0].contains("no decal: its model names the skin body.png: no file body.png"),
        "{said:?}"
    );
    picture("body.png", 3);
    picture("other.png", 5);
    let (found, said) = decal(folder, "");
    assert_eq!(found, Some([3, 2]));
    assert!(said.len() == 1 && said[0].contains("decal ") && said[0].contains("body.png: its model names"), "{said:?}");
    assert_eq!(decal(folder, "material = { diffuse = [1, 0, 0] }").0, Some([3, 2]));
    assert_eq!(decal(folder, "material = { decal = \"other.png\" }"), (Some([5, 2]), Vec::new()));
    // The file's name alone, with slashes of either kind, in any case; a picture in place of a .pcx.
    for (written, expected) in
        [("players/male/BODY.png", 3), (r"C:\quake2\other.png", 5), ("models/other.pcx", 5), ("../body.png", 3)]
    {
        name(&mut file, written);
        write(&file);
        assert_eq!(decal(folder, "").0, Some([expected, 2]), "{written}");
    }
    std::fs::write(folder.join("broken.png"), b"no picture").unwrap();
    name(&mut file, "broken.png");
    write(&file);
    let (found, said) = decal(folder, "");
    assert!(found.is_none() && said.len() == 1 && said[0].contains("broken.png"), "{said:?}");
    for written in ["", "textures/", ".."] {
        name(&mut file, written);
        write(&file);
        assert_eq!(decal(folder, "").0, None, "{written}");
    }
    file.skins.clear();
    write(&file);
    assert_eq!(decal(folder, ""), (None, Vec::new()));
}

/// Models with what other programs may refuse, and with triangles to be left out or turned.
#[test]
fn what_is_odd_is_told() {
    let good = random_model(&mut fastrand::Rng::with_seed(9));
    let mut turned = good.clone();
    turned.triangles.iter_mut().for_each(|triangle| {
        triangle.vertices.swap(1, 2);
        triangle.texcoords.swap(1, 2);
    });
    let (model, warnings) = ready(&turned);
    assert!(warnings.len() == 1 && warnings[0].contains("counter-clockwise"), "{warnings:?}");
    assert!(model.mesh(&Pose::default(), NormalSource::File).signed_volume() > 0.0);
    let mut flat = good.clone();
    flat.triangles.push(Triangle { vertices: [0, 0, 1], texcoords: [0, 1, 2] });
    let (model, warnings) = ready(&flat);
    assert_eq!(warnings, ["1 triangles have no area in any frame; left out"]);
    assert_eq!(model.indices().len(), 3 * good.triangles.len());
    let mut endless = good.clone();
    endless.frames[0].name = [b'x'; 16];
    assert_eq!(ready(&endless).1, ["1 names of frames or skins have no zero byte at their end"]);
    let mut many = good.clone();
    many.skins = vec![[0; 64]; 33];
    assert_eq!(ready(&many).1, ["has 33 skins; Quake II allows 32, and other programs may refuse the file"]);
}

/// The project's own figure: two animations of eight frames, each part closed, half of the head's and the trunk's triangles
/// mirrored on the skin.
#[test]
fn the_knight_is_closed_and_mirrored_in_every_frame() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/meshes/knight.md2");
    let (model, warnings) = Model::load(&path).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    let names: Vec<String> = model.file().frames.iter().map(Frame::name).collect();
    let expected: Vec<String> =
        ["stand", "run"].iter().flat_map(|name| (1..=8).map(move |number| format!("{name}{number}"))).collect();
    assert_eq!(names, expected);
    for frame in 0..model.frame_count() {
        let mesh = model.mesh(&Pose { frames: [frame, (frame + 1) % 16], blend: 0.5 }, NormalSource::File);
        assert!((600..1000).contains(&mesh.triangle_count()), "{} triangles", mesh.triangle_count());
        assert!(mesh.is_closed() && mesh.signed_volume() > 0.0, "frame {frame}");
        let tangents = Tangents::of_skin(&mesh, BasisFit::Orthogonal).unwrap();
        assert!(2 * tangents.mirrored > mesh.triangle_count() * 8 / 10, "{} mirrored", tangents.mirrored);
        assert!(2 * tangents.mirrored < mesh.triangle_count() * 12 / 10, "{} mirrored", tangents.mirrored);
        assert_eq!(tangents.without, 0, "{:?}", mesh.texcoords);
    }
}
