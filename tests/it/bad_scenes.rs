//! Malformed scenes, one a row: each gives its own clear error with the line, and never a panic.

use std::fs;
use std::path::Path;

use glumbra::scene;
use proptest::prelude::*;

/// A light that is right but for what a row adds.
const LIGHT: &str = "[[light]]\nposition = [2, 4, 3]\ntarget = [0, 0, 0]\ncone = 60\nnear = 0.5\nfar = 20\n";

/// A point light and a directional one, as [`LIGHT`].
const POINT: &str = "[[light]]\nkind = \"point\"\nposition = [2, 4, 3]\n";
const SUN: &str = "[[light]]\nkind = \"directional\"\ndirection = [0, -1, 0]\n";

/// An object that is right but for what a row adds.
const QUAD: &str = "[[object]]\nmesh = \"quad\"\n";

/// Name, text (`{LIGHT}`, `{POINT}`, `{SUN}` and `{QUAD}` stand for the above), line or 0, what the message must say.
const ROWS: &[(&str, &str, usize, &str)] = &[
    ("empty file", "", 1, "`object` is missing: a scene needs at least one [[object]]"),
    ("no objects", "[image]\nsize = [4, 4]\n", 1, "`object` is missing"),
    ("syntax", "[camera]\neye = [1, 2\n[image]\n", 3, "missing comma between array elements"),
    ("no value", "{QUAD}lit =\n", 3, "lit ="),
    ("unterminated string", "{QUAD}name = \"x\n", 3, "name = \"x"),
    ("duplicate key", "{QUAD}lit = true\nlit = false\n", 4, "duplicate key"),
    ("duplicate table", "[image]\n[image]\n{QUAD}", 2, "duplicate key"),
    ("unknown table", "{QUAD}[kamera]\n", 3, "unknown key `kamera` in the scene: did you mean `camera`?"),
    ("unknown key", "[camera]\nfov = 40\n{QUAD}", 2, "unknown key `fov` in [camera]: did you mean `fov_y`?"),
    ("unknown light key", "{LIGHT}colour = [1, 1, 1]\n{QUAD}", 7, "in [light]: did you mean `color`?"),
    ("unknown object key", "{QUAD}rotation = 1\n", 3, "unknown key `rotation` in [object]"),
    ("unknown material key", "{QUAD}material = { difuse = [1, 1, 1] }\n", 3, "did you mean `diffuse`?"),
    (
        "a wave of what",
        "{QUAD}wave = {}\n",
        3,
        "`object.wave.direction` is missing: the way that vertices move, [x, y, z]",
    ),
    ("a wave nowhere", "{QUAD}wave = { direction = [0, 0, 0] }\n", 3, "must not be of zero length"),
    (
        "a wave of NaN",
        "{QUAD}wave = { direction = [0, 1, 0], axis = [1, 0, 0], wavelength = 1, amplitude = nan }\n",
        3,
        "`object.wave.amplitude` must be finite, not NaN",
    ),
    (
        "a wave of no length",
        "{QUAD}wave = { direction = [0, 1, 0], axis = [1, 0, 0], amplitude = 1, wavelength = 0 }\n",
        3,
        "`object.wave.wavelength` must be above 0, not 0",
    ),
    (
        "a wave out of the world",
        "{QUAD}wave = { direction = [0, 1, 0], axis = [1, 0, 0], wavelength = 1, amplitude = 1e18 }\nscale = 10\n",
        1,
        "coordinates may be 1e18 at most",
    ),
    (
        "unknown wave key",
        "{QUAD}wave = { direction = [0, 1, 0], axis = [1, 0, 0], wavelength = 1, amplitude = 1, phse = 1 }\n",
        3,
        "did you mean `phase`?",
    ),
    ("unknown rotate key", "{QUAD}rotate = { axis = [0, 1, 0], angel = 1, angle = 1 }\n", 3, "did you mean `angle`?"),
    (
        "a table for a light",
        "[light]\ncone = 1\n{QUAD}",
        1,
        "`light` must be an array of tables, [[light]], not a table",
    ),
    ("a number for an object", "object = 3\n", 1, "`object` must be an array of tables, [[object]]"),
    ("mixed array", "object = [{ mesh = \"quad\" }, 3]\n", 1, "not an integer"),
    ("a date", "[image]\nsize = 2020-01-01\n{QUAD}", 2, "`image.size` cannot be a date"),
    ("camera is a string", "camera = \"here\"\n{QUAD}", 1, "`camera` must be a table, not a string"),
    ("zero picture", "[image]\nsize = [0, 4]\n{QUAD}", 2, "two whole numbers in 1..=16384, not [0, 4]"),
    ("huge picture", "[image]\nsize = [100000, 100000]\n{QUAD}", 2, "1..=16384"),
    ("negative picture", "[image]\nsize = [-1, 4]\n{QUAD}", 2, "not [-1, 4]"),
    ("half a pixel", "[image]\nsize = [1.5, 4]\n{QUAD}", 2, "whole numbers"),
    ("one side", "[image]\nsize = [4]\n{QUAD}", 2, "`image.size` must have 2 numbers, not 1"),
    ("integer overflow", "[image]\nsize = [9223372036854775808, 4]\n{QUAD}", 2, "out of range: 9223372036854775808"),
    ("background", "[image]\nbackground = [0, 0, 1.5]\n{QUAD}", 2, "must be in [0, 1], not 1.5"),
    ("background of bytes", "[image]\nbackground = [0, 0, \"ff\"]\n{QUAD}", 2, "must be a number, not a string"),
    (
        "eye is target",
        "[camera]\neye = [1, 2, 3]\ntarget = [1, 2, 3]\n{QUAD}",
        3,
        "`camera.target` must differ from `eye`",
    ),
    (
        "up along the view",
        "[camera]\neye = [0, 5, 0]\ntarget = [0, 0, 0]\nup = [0, -2, 0]\n{QUAD}",
        4,
        "parallel to the view",
    ),
    ("up of no length", "[camera]\neye = [0, 5, 0]\ntarget = [0, 0, 0]\nup = [0, 0, 0]\n{QUAD}", 4, "zero length"),
    ("near is far", "[camera]\nnear = 2\nfar = 2\n{QUAD}", 3, "`camera.far` must be above `near`, 2, not 2"),
    ("near beyond the objects", "[camera]\nnear = 1e17\nfar = 0.1\n{QUAD}", 3, "`camera.far` must be above `near`"),
    ("near zero", "[camera]\nnear = 0\n{QUAD}", 2, "`camera.near` must be above 0, not 0"),
    ("near negative", "[camera]\nnear = -0.1\n{QUAD}", 2, "`camera.near` must be above 0, not -0.1"),
    ("far beyond f32", "[camera]\nfar = 1e39\n{QUAD}", 2, "`camera.far` must be at most 1e18, not 1e39"),
    ("fov zero", "[camera]\nfov_y = 0\n{QUAD}", 2, "above 1 and below 179 degrees, not 0"),
    ("fov 180", "[camera]\nfov_y = 180.0\n{QUAD}", 2, "above 1 and below 179 degrees, not 180"),
    ("nan eye", "[camera]\neye = [0, nan, 0]\n{QUAD}", 2, "`camera.eye` must be finite, not NaN"),
    ("infinite fov", "[camera]\nfov_y = inf\n{QUAD}", 2, "`camera.fov_y` must be finite, not inf"),
    ("literal overflow", "[camera]\neye = [0, 1e999, 0]\n{QUAD}", 2, "`camera.eye`"),
    ("eye beyond f32", "[camera]\neye = [0, 1e39, 0]\n{QUAD}", 2, "must be in [-1e18, 1e18], not 1e39"),
    ("ambient", "[shading]\nambient = [-0.1, 0, 0]\n{QUAD}", 2, "must be in [0, 1], not -0.1"),
    ("lighting", "[shading]\nlighting = \"per-pixel\"\n{QUAD}", 2, "cannot be \"per-pixel\""),
    ("cone of a point light", "{POINT}cone = 60\n{QUAD}", 4, "`light.cone` is no key of a point light, which shines"),
    ("shape of a point light", "{POINT}shape = \"cone\"\n{QUAD}", 4, "`light.shape` is no key of a point light"),
    ("target of a point light", "{POINT}target = [0, 0, 0]\n{QUAD}", 4, "`light.target` is no key of a point light"),
    ("image of a point light", "{POINT}image = \"a.png\"\n{QUAD}", 4, "`light.image` is no key of a point light"),
    ("frustum of a point light", "{POINT}frustum = \"shown\"\n{QUAD}", 4, "`light.frustum` is no key of a point light"),
    ("point light nowhere", "{QUAD}[[light]]\nkind = \"point\"\n", 3, "`light.position` is missing"),
    ("point near", "{POINT}near = 2\nfar = 1\n{QUAD}", 5, "`light.far` must be above `near`, 2, not 1"),
    ("point near alone", "{POINT}near = 0\n{QUAD}", 4, "`light.near` must be above 0, not 0"),
    ("point attenuation", "{POINT}attenuation = [0, 0, 0]\n{QUAD}", 4, "must not be all zero"),
    ("misspelt point key", "{POINT}positon = [0, 0, 0]\n{QUAD}", 4, "did you mean `position`?"),
    ("cone of a sun", "{SUN}cone = 60\n{QUAD}", 4, "`light.cone` is no key of a directional light, whose rays"),
    ("near of a sun", "{SUN}near = 1\n{QUAD}", 4, "`light.near` is no key of a directional light"),
    (
        "attenuation of a sun",
        "{SUN}attenuation = [1, 0, 1]\n{QUAD}",
        4,
        "`light.attenuation` is no key of a directional",
    ),
    ("image of a sun", "{SUN}image = \"a.png\"\n{QUAD}", 4, "`light.image` is no key of a directional light"),
    ("two directions", "{SUN}target = [0, 0, 0]\n{QUAD}", 4, "`light.target` cannot stand beside `direction`"),
    ("no direction", "{QUAD}[[light]]\nkind = \"directional\"\n", 3, "`light.direction` is missing: the way that"),
    (
        "half a direction",
        "[[light]]\nkind = \"directional\"\nposition = [0, 1, 0]\n{QUAD}",
        1,
        "`light.target` is missing",
    ),
    (
        "the other half",
        "[[light]]\nkind = \"directional\"\ntarget = [0, 1, 0]\n{QUAD}",
        1,
        "`light.position` is missing",
    ),
    (
        "direction of no length",
        "[[light]]\nkind = \"directional\"\ndirection = [0, 0, 0]\n{QUAD}",
        3,
        "`light.direction` must not be of zero length",
    ),
    (
        "direction from here to here",
        "[[light]]\nkind = \"directional\"\nposition = [1, 1, 1]\ntarget = [1, 1, 1]\n{QUAD}",
        4,
        "`light.target` must differ from `position`",
    ),
    (
        "direction of a spot",
        "{LIGHT}direction = [0, -1, 0]\n{QUAD}",
        7,
        "is no key of a spotlight, which has a `target`",
    ),
    ("no such light", "{LIGHT}kind = \"spott\"\n{QUAD}", 7, "did you mean `spot`?"),
    ("light without cone", "[[light]]\nposition = [0, 1, 0]\ntarget = [0, 0, 0]\n{QUAD}", 1, "`light.cone` is missing"),
    ("light without position", "{QUAD}[[light]]\ncone = 50\n", 3, "`light.position` is missing"),
    ("cone 1", "{QUAD}[[light]]\ncone = 1\n", 4, "`light.cone` must be above 1 and below 179 degrees"),
    ("cone 179", "{QUAD}[[light]]\ncone = 179\n", 4, "`light.cone` must be above 1 and below 179 degrees"),
    (
        "light at its target",
        "{QUAD}[[light]]\ncone = 50\nposition = [1, 1, 1]\ntarget = [1, 1, 1]\n",
        6,
        "must differ from `position`",
    ),
    ("light color", "{LIGHT}color = [1, -1, 1]\n{QUAD}", 7, "`light.color` must be in [0, 1000000], not -1"),
    ("light shape", "{LIGHT}shape = \"square\"\n{QUAD}", 7, "cannot be \"square\": known: cone, frustum"),
    ("no attenuation", "{LIGHT}attenuation = [0, 0, 0]\n{QUAD}", 7, "must not be all zero"),
    ("light image", "{LIGHT}image = \"no.png\"\n{QUAD}", 7, "no.png"),
    ("shadow is no table", "{LIGHT}shadow = true\n{QUAD}", 7, "`light.shadow` must be a table, not true or false"),
    ("no mesh", "[[object]]\nlit = true\n", 1, "`object.mesh` is missing"),
    (
        "no such mesh",
        "[[object]]\nmesh = \"tepot\"\n",
        2,
        "no mesh \"tepot\": neither built in (did you mean `teapot`?",
    ),
    ("no name of a mesh", "[[object]]\nmesh = \"\"\n", 2, "`object.mesh` must name a file"),
    ("mesh of another kind", "[[object]]\nmesh = \"a.step\"\n", 2, "nor a file that ends in .obj"),
    ("no such file", "[[object]]\nmesh = \"no.obj\"\n", 2, "no.obj"),
    ("zero scale", "{QUAD}scale = 0\n", 3, "`object.scale` must not be zero"),
    ("flat scale", "{QUAD}scale = [1, 0.0, 1]\n", 3, "`object.scale` must not be zero"),
    ("word scale", "{QUAD}scale = \"big\"\n", 3, "must be a number or an array of three"),
    ("two scales", "{QUAD}scale = [1, 2]\n", 3, "must have 3 numbers, not 2"),
    ("nan scale", "{QUAD}scale = nan\n", 3, "must be finite, not NaN"),
    (
        "axis of no length",
        "{QUAD}rotate = { axis = [0, 0, 0], angle = 1 }\n",
        3,
        "`object.rotate.axis` must not be of zero length",
    ),
    ("no axis", "{QUAD}rotate = { angle = 1 }\n", 3, "`object.rotate.axis` is missing"),
    ("no angle", "{QUAD}rotate = [{ axis = [0, 1, 0] }]\n", 3, "`object.rotate.angle` is missing"),
    ("rotate by a number", "{QUAD}rotate = 90\n", 3, "must be { axis = [x, y, z], angle = degrees }"),
    ("translate too far", "{QUAD}translate = [1e30, 0, 0]\n", 3, "must be in [-1e18, 1e18], not 1e30"),
    ("reaches too far", "{QUAD}translate = [1e18, 0, 0]\nscale = 1e18\n", 1, "reaches out to 2e18"),
    ("diffuse", "{QUAD}material = { diffuse = [1, 1, 255] }\n", 3, "must be in [0, 1], not 255"),
    ("shininess", "{QUAD}material = { shininess = 1001 }\n", 3, "must be in [0, 1000], not 1001"),
    ("opacity", "{QUAD}material = { opacity = -1 }\n", 3, "must be in [0, 1], not -1"),
    ("no decal", "{QUAD}material = { decal = \"no.png\" }\n", 3, "no.png"),
    ("lit", "{QUAD}lit = 1\n", 3, "`object.lit` must be true or false, not an integer"),
    (
        "deep",
        "a = [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
        1,
        "max recursion depth",
    ),
];

fn load(folder: &Path, text: &[u8]) -> Result<scene::Loaded, String> {
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    glumbra::load(&path, &[]).map_err(|error| error.to_string())
}

#[test]
fn each_malformed_scene_has_its_own_error() {
    let folder = tempfile::tempdir().unwrap();
    let mut wrong = Vec::new();
    for (name, text, line, expected) in ROWS {
        let named = [("{LIGHT}", LIGHT), ("{POINT}", POINT), ("{SUN}", SUN), ("{QUAD}", QUAD)];
        let text = named.into_iter().fold((*text).to_owned(), |text, (name, part)| text.replace(name, part));
        let start = format!("{}:{line}: ", folder.path().join("scene.toml").display());
        match load(folder.path(), text.as_bytes()) {
            Ok(_) => wrong.push(format!("{name}: loads")),
            Err(error) if !error.starts_with(&start) => wrong.push(format!("{name}: not line {line}: {error}")),
            Err(error) if !error.contains(expected) => wrong.push(format!("{name}: not \"{expected}\": {error}")),
            Err(_) => {}
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(ROWS.len() >= 60);
}

#[test]
fn files_that_are_no_scenes() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("folder.toml")).unwrap();
    fs::write(at("latin.toml"), b"[image]\n# caf\xe9\n").unwrap();
    fs::write(at("scene.json"), "{}").unwrap();
    fs::write(at("plain"), "").unwrap();
    fs::write(at("long.toml"), vec![b'\n'; (4 << 20) + 1]).unwrap();
    for (name, expected) in [
        ("folder.toml", "folder.toml: is a folder"),
        ("latin.toml", "latin.toml:2: is not UTF-8 text"),
        ("scene.json", "a scene ends in .toml, a model in .obj"),
        ("plain", "a scene ends in .toml, a model in .obj"),
        ("long.toml", "a file of its kind may have 4194304"),
        ("none.toml", "none.toml: cannot be read: "),
        ("none.obj", "none.obj: cannot be read: "),
    ] {
        let error = glumbra::load(&at(name), &[]).unwrap_err().to_string();
        assert!(error.contains(expected), "{name}: {error}");
    }
}

const EXAMPLE: &str = include_str!("../../data/scenes/example.toml");

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Bytes changed, cut and doubled at random: an error or a scene, never a panic.
    #[test]
    fn mutations_never_panic(changes in prop::collection::vec((0usize..4, any::<prop::sample::Index>(), any::<u8>()), 1..12)) {
        let folder = tempfile::tempdir().unwrap();
        let mut bytes = EXAMPLE.replace("../meshes/dense.obj", "box").into_bytes();
        for (kind, at, byte) in changes {
            let at = at.index(bytes.len().max(1)).min(bytes.len().saturating_sub(1));
            match kind {
                0 => bytes[at] = byte,
                // Likely characters, so that many a change still parses.
                1 => bytes[at] = b"0123456789.-e[]={}\"\n"[usize::from(byte) % 20],
                2 => { bytes.remove(at); }
                _ => bytes.insert(at, byte % 128),
            }
        }
        let _ = load(folder.path(), &bytes);
    }
}
