//! Automatic near planes: random scenes over and under huge floors, where a plain loop over rays says what is nearest.

use std::fmt::Write as _;

use glam::DVec3;
use glumbra::context::{self, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::scene::{LightKind, Loaded, Object, Scene};

use crate::support::random::Random;

fn load(text: &str, overrides: &[&str]) -> Loaded {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, text).unwrap();
    let overrides: Vec<String> = overrides.iter().map(|text| text.to_string()).collect();
    glumbra::load(&path, &overrides).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A camera and a light over a floor of any size, with boxes; all `scale` times as large.
fn random_scene(random: &mut Random, scale: f64, kind: &str) -> String {
    let point = |p: [f64; 3]| format!("[{:?}, {:?}, {:?}]", p[0] * scale, p[1] * scale, p[2] * scale);
    let mut place =
        |height: f64| [random.within(-4.0, 4.0), height * random.within(0.2, 1.0), random.within(-4.0, 4.0)];
    let (eye, target, lamp) = (place(3.0), place(1.0), place(5.0));
    let boxes: Vec<_> = (0..4).map(|_| place(2.0)).collect();
    let floor = random.size(1.0, 1e6) * scale;
    let size = [[64, 64], [96, 40], [30, 90]][(random.share() * 3.0) as usize];
    let mut text = format!("[image]\nsize = {size:?}\n[camera]\neye = {}\ntarget = {}\n", point(eye), point(target));
    write!(
        text,
        "fov_y = {:?}\n[[light]]\nkind = \"{kind}\"\nposition = {}\n",
        random.within(20.0, 100.0),
        point(lamp)
    )
    .unwrap();
    if kind == "spot" {
        write!(text, "target = {}\ncone = {:?}\n", point(target), random.within(20.0, 100.0)).unwrap();
    }
    write!(text, "[[object]]\nmesh = \"quad\"\nscale = [{floor:?}, 1.0, {floor:?}]\n").unwrap();
    for at in boxes {
        let turn = random.within(0.0, 90.0);
        write!(
            text,
            "[[object]]\nmesh = \"box\"\ntranslate = {}\nscale = {:?}\nrotate = {{ axis = [0, 1, 0], angle = {turn:?} }}\n",
            point(at),
            random.within(0.05, 0.4) * scale
        )
        .unwrap();
    }
    text
}

/// The share of pixels, in percent, on which two shades differ.
fn difference(renderer: &mut Renderer, a: &Scene, b: &Scene) -> f64 {
    let [a, b] = [a, b].map(|scene| draw_shade(scene, 0, renderer).unwrap());
    let differs = |k: &usize| a.covered[*k] != b.covered[*k] || (a.shade[*k] < 0.5) != (b.shade[*k] < 0.5);
    100.0 * (0..a.shade.len()).filter(differs).count() as f64 / a.shade.len() as f64
}

/// A scene of `text` moved as a whole.
fn moved(scene: &Scene, by: DVec3) -> Scene {
    let mut scene = scene.clone();
    scene.camera.eye += by;
    scene.camera.target += by;
    for light in &mut scene.lights {
        match &mut light.kind {
            LightKind::Spot(spot) => {
                spot.frustum.position += by;
                spot.frustum.target += by;
            }
            LightKind::Point(point) => point.position += by,
            LightKind::Directional { .. } => {}
        }
    }
    scene.objects.iter_mut().for_each(|object| object.world_from_model.w_axis += by.extend(0.0));
    scene
}

#[test]
fn a_scene_far_from_the_origin_has_the_same_picture() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut random = Random::new(7);
    for (round, by) in [1e4, 1e6, 1e9].into_iter().cycle().take(18).enumerate() {
        let kind = ["spot", "point", "sun"][round % 3];
        let mut text = random_scene(&mut random, 1.0, if kind == "point" { "point" } else { "spot" });
        if kind == "sun" {
            let from = text.find("kind").unwrap();
            let to = text.find("[[object]]").unwrap();
            text.replace_range(from..to, "kind = \"directional\"\ndirection = [-1.0, -2.0, -0.6]\n");
        }
        let technique = ["shadow-map", "shadow-volume"][round / 3 % 2];
        let at = text.find("[[object]]").unwrap();
        text.insert_str(at, &format!("[light.shadow]\ntechnique = \"{technique}\"\nsize = 256\n"));
        // The map of a sun over a larger floor is so coarse that which of its texels are drawn is left to rounding.
        let scene = load(&text, &["object.0.scale=8"]).scene;
        let far = moved(&scene, by * DVec3::new(1.0, -0.7, 0.3));
        let off = difference(&mut renderer, &scene, &far);
        // At 1e9 f64 rounds coordinates by 1e-7, a hundred-thousandth of a pixel; only edges of shadows may move.
        assert!(off < 0.2, "{by:e} {technique}: {off} % differ\n{text}");
    }
}

/// Parameter of a ray where it first meets a triangle.
fn first_hit(objects: &[Object], from: DVec3, way: DVec3) -> Option<f64> {
    let mut nearest = f64::INFINITY;
    for object in objects {
        for triangle in object.mesh.indices.as_chunks::<3>().0 {
            let [a, b, c] = triangle.map(|index| {
                let place = DVec3::from_array(object.mesh.positions[index as usize].map(f64::from));
                object.world_from_model.transform_point3(place) - from
            });
            let normal = (b - a).cross(c - a);
            let t = normal.dot(a) / normal.dot(way);
            let inside = [a.cross(b), b.cross(c), c.cross(a)].map(|side| side.dot(way));
            let is_met = inside.iter().all(|side| *side >= 0.0) || inside.iter().all(|side| *side <= 0.0);
            if is_met && t > 0.0 {
                nearest = nearest.min(t);
            }
        }
    }
    nearest.is_finite().then_some(nearest)
}

/// The least and the greatest depth of first hits over a grid that reaches the sides of a pyramid.
fn depths(objects: &[Object], from: DVec3, [ahead, right, up]: [DVec3; 3]) -> Option<[f64; 2]> {
    const STEPS: i32 = 20;
    let steps = || (-STEPS..=STEPS).map(|k| 0.999_999 * f64::from(k) / f64::from(STEPS));
    let ways = steps().flat_map(|x| steps().map(move |y| ahead + x * right + y * up));
    let hits: Vec<f64> = ways.filter_map(|way| first_hit(objects, from, way)).collect();
    let least = hits.iter().copied().fold(f64::INFINITY, f64::min);
    (!hits.is_empty()).then(|| [least, hits.iter().copied().fold(0.0, f64::max)])
}

fn axes(ahead: DVec3, up: DVec3, [tan_x, tan_y]: [f64; 2]) -> [DVec3; 3] {
    let ahead = ahead.normalize();
    let right = ahead.cross(up).normalize();
    [ahead, right * tan_x, right.cross(ahead) * tan_y]
}

/// Checks that objects in view begin at or behind the near plane, and that it is not much nearer than it must be. A grid of
/// rays may miss the nearest point, by a part of a step: the lower bound is loose.
#[track_caller]
fn check(what: &str, [near, far]: [f64; 2], seen: Option<[f64; 2]>) {
    let Some([least, most]) = seen else { return };
    assert!(near <= least && most <= far, "{what}: {near} to {far} holds not {least} to {most}");
    assert!(near >= 0.3 * least || near >= 0.9 * far / 2.0_f64.powi(14), "{what}: {near} wastes depth before {least}");
}

#[test]
fn automatic_ranges_hold_what_is_in_view_at_any_scale() {
    let mut random = Random::new(1);
    let mut compared = 0;
    for round in 0..120 {
        let scale = [1.0, 1e-12, 1e12, 1e-4, 1e4][round % 5];
        let kind = ["spot", "point"][round % 2];
        let text = random_scene(&mut random, scale, kind);
        let Loaded { scene, warnings, .. } = load(&text, &[]);
        assert!(warnings.is_empty(), "{warnings:?}\n{text}");
        let camera = &scene.camera;
        let tan = (0.5 * camera.fov_y_radians).tan();
        let seen = depths(
            &scene.objects,
            camera.eye,
            axes(camera.target - camera.eye, camera.up, [tan * scene.aspect(), tan]),
        );
        check(&format!("camera\n{text}"), [camera.near, camera.far], seen);
        compared += usize::from(seen.is_some());
        match &scene.lights[0].kind {
            LightKind::Spot(spot) => {
                let frustum = &spot.frustum;
                let tan = (0.5 * frustum.cone_radians).tan();
                let around = axes(frustum.target - frustum.position, frustum.up, [tan; 2]);
                let seen = depths(&scene.objects, frustum.position, around);
                check(&format!("spot\n{text}"), [frustum.near, frustum.far], seen);
            }
            LightKind::Point(point) => {
                let faces = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|way| [way, -way]);
                let faces = faces.filter_map(|way| {
                    depths(&scene.objects, point.position, axes(way, way.any_orthonormal_vector(), [1.0; 2]))
                });
                let seen = faces.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
                // Rays end at what hides the floor's far end.
                check(&format!("point\n{text}"), [point.near, point.far], seen);
            }
            LightKind::Directional { .. } => {}
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn texgen_and_waves_go_by_the_files_own_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let corners = [[5e5, 210.0, 5.4e6], [5e5 + 1.5, 210.25, 5.4e6], [5e5, 210.5, 5.4e6 - 2.25]];
    let lines = corners.map(|[x, y, z]: [f64; 3]| format!("v {x} {y} {z}\n")).concat();
    std::fs::write(folder.path().join("a.obj"), format!("{lines}f 1 2 3\n")).unwrap();
    let text = "[[object]]\nmesh = \"a.obj\"\nscale = 2.0\ntranslate = [-1e6, 0.0, 0.0]\n\
        material = { texgen = { s = [1.0, 0.5, 0.0, 0.25], t = [0.0, 0.0, -1.0, 0.0], scale = 0.25 } }\n\
        wave = { direction = [0, 1, 0], amplitude = 0.1, axis = [1, 0, 1], wavelength = 0.7, phase = 0.2 }\n";
    let path = folder.path().join("a.toml");
    std::fs::write(&path, text).unwrap();
    let scene = glumbra::load(&path, &[]).unwrap().scene;
    let object = &scene.objects[0];
    assert_ne!(object.mesh.origin, DVec3::ZERO);
    let (texgen, wave) = (object.material.as_ref().unwrap().texgen.unwrap(), object.wave.unwrap());
    // How far two numbers of turns are apart.
    let apart = |a: f64, b: f64| ((a - b) - (a - b).round()).abs();
    for corner in corners.map(DVec3::from_array) {
        let held = object.mesh.positions.iter().map(|p| DVec3::from_array(p.map(f64::from)));
        let held = held.min_by(|a, b| {
            (*a + object.mesh.origin).distance(corner).total_cmp(&(*b + object.mesh.origin).distance(corner))
        });
        let held = held.unwrap();
        assert!(object.world_from_model.transform_point3(held).distance(2.0 * corner - DVec3::X * 1e6) < 1e-6);
        for (plane, of_file) in [(texgen.s, [1.0, 0.5, 0.0, 0.25]), (texgen.t, [0.0, 0.0, -1.0, 0.0])] {
            let at = |[a, b, c, d]: [f64; 4], place: DVec3| 0.25 * (DVec3::new(a, b, c).dot(place) + d);
            assert!(apart(at(plane.map(f64::from), held), at(of_file, corner)) < 1e-6, "{corner}");
        }
        let of_file = (corner.x + corner.z) / 2.0_f64.sqrt() / 0.7 + 0.2;
        assert!(apart(wave.vector.dot(held) + wave.phase, of_file) < 1e-6, "{corner}");
    }
}

const OVER_A_FLOOR: &str = "[camera]\neye = [3.0, 2.5, 4.0]\ntarget = [0.0, 0.6, 0.0]\n[[light]]\n\
    position = [2.0, 4.0, 3.0]\ntarget = [0.0, 0.5, 0.0]\ncone = 60.0\n[[object]]\nmesh = \"box\"\nscale = 0.5\n\
    translate = [0.0, 0.5, 0.0]\n[[object]]\nmesh = \"quad\"\nname = \"floor\"\nscale = 5000.0\n";

#[test]
fn a_written_plane_that_cuts_is_said_and_one_that_does_not_is_not() {
    for (overrides, said) in [
        (&[][..], ""),
        (&["camera.near=3.5"], ""),
        (&["camera.near=4"], "`camera.near` = 4 cuts off part of `floor`, which begins at 3.595"),
        // The floor alone, whose near end the camera does not see.
        (&["camera.near=3.59", "object.0.translate=[0.0, -9.0, 0.0]"], ""),
        (&["camera.near=1e3"], "`camera.near` = 1000 cuts off `floor`, which begins at 3.595"),
        (&["camera.far=20"], "`camera.far` = 20 cuts off part of `floor`, which ends at "),
        // Behind the box, which fills the picture.
        (&["camera.far=7", "camera.fov_y=2"], ""),
        (&["camera.far=4.8", "object.1.scale=0.01"], "`camera.far` = 4.8 cuts off part of `box`, which ends at "),
        // What is wholly behind the camera, or clear: no word of planes.
        (&["camera.near=4", "object.1.translate=[0.0, 9.0, 0.0]"], ""),
        (&["camera.near=4", "object.1.material.opacity=0.1"], "below 0.5 the alpha test discards all of object"),
        (
            &["camera.near=6e-6", "camera.far=100", "object.1.scale=2"],
            "tells apart no less than 0.2059 at `box`, 4.552 away",
        ),
        (&["camera.near=1e-4"], "is less than 32-bit floats may be off by, 0.0004218, at the vertices of `floor`"),
        (
            &["camera.near=1e-8"],
            "what is farther than 0.08389 falls on the last two values of a depth buffer of 24 bits, as does some of `floor`",
        ),
        (&["object.1.scale=1e7"], "`floor` has vertices 1.414e7 away from the eye"),
        // The eye lies in the box's side.
        (
            &["camera.eye=[0.5, 0.6, 0.0]", "camera.target=[0.5, 0.6, -1.0]", "object.1.scale=2"],
            "cuts off part of `box`, which begins at 0",
        ),
    ] {
        let warnings = load(OVER_A_FLOOR, overrides).warnings;
        let expected = usize::from(!said.is_empty());
        assert!(
            warnings.len() == expected && warnings.iter().all(|line| line.contains(said)),
            "{overrides:?}: {warnings:?}"
        );
    }
}
