//! GL-C6, GL-T1 and parts of GL-T2 and GL-I1: rules of the fixed-function pipeline only [GL 4.6 compatibility, 8.23,
//! 12.1.3, A.3].

use glam::{DMat4, DVec3, DVec4};

use crate::conformance::bench::fixed_function::{DepthMode, FixedBench, FixedDraw};
use crate::conformance::bench::{
    Error, GlCompare, GlFormat, GlImage, GlState, GlTexgen, Sampling, Surface, Vertex, full,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};
use crate::math::spaces;

const SIDE: u32 = 64;
const FLAT: GlState = GlState { depth: None, ..GlState::WRITE };

/// The fixed-function pipeline, or a finding that says why there is none.
pub(super) fn pipeline<'a>(
    subject: &'a DriverUnderTest,
    findings: &mut Findings,
    what: &str,
) -> Option<&'a FixedBench> {
    match &subject.fixed {
        Ok(fixed) => Some(fixed),
        Err(why) => {
            findings.untestable(what, why.clone());
            None
        }
    }
}

/// GL-C6: what a comparison becomes in each DEPTH_TEXTURE_MODE, by REPLACE.
pub fn depth_mode(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = pipeline(subject, findings, "DEPTH_TEXTURE_MODE") else { return Ok(()) };
    let image = subject.bench.depth_image(GlFormat::Depth24, [1, 1], &[&[0.5]])?;
    let surface = subject.bench.surface([4, 4], Some(GlFormat::Rgba8), None)?;
    let color = [0.5, 0.6, 0.7, 0.8];
    for (mode, of) in [
        (DepthMode::Luminance, (|r| [r, r, r, 0.8]) as fn(f32) -> [f32; 4]),
        (DepthMode::Intensity, |r| [r; 4]),
        (DepthMode::Alpha, |r| [0.5, 0.6, 0.7, r]),
        (DepthMode::Red, |r| [r, 0.0, 0.0, 0.8]),
    ] {
        // References 0.25 and 0.75 against 0.5.
        for (reference, result) in [(0.25, 1.0), (0.75, 0.0)] {
            let vertices = full(0.0).map(|vertex| Vertex { value: [0.5, 0.5, reference, 1.0], ..vertex });
            let image = Some((&image, Sampling::compare(GlCompare::LessEqual), mode));
            fixed.draw(&subject.bench, &FixedDraw { image, color, ..FixedDraw::plain(&surface, FLAT, &vertices) })?;
            let seen = surface.colors()[5];
            let due = of(result).map(|value| (value * 255.0).round() as u8);
            let grade = (0..4).map(|index| verify::unorm8(seen[index], f64::from(of(result)[index]))).max();
            let name = format!("{mode:?}, the comparison {}", if result > 0.0 { "passes" } else { "fails" });
            findings.grade(name, grade.unwrap_or(Grade::Wrong), format!("{seen:?}; {due:?} is due"));
        }
    }
    Ok(())
}

/// A camera, a model and a light's map, none of them on an axis.
struct Setup {
    projection: DMat4,
    eye_from_world: DMat4,
    world_from_model: DMat4,
    /// Matrix to s, t, r and q of the map.
    map_from_world: DMat4,
    floor: Vec<Vertex>,
}

fn setup() -> Setup {
    let scale_bias = DMat4::from_translation(DVec3::splat(0.5)) * DMat4::from_scale(DVec3::splat(0.5));
    let light = spaces::view_from_world(DVec3::new(2.0, 4.0, 1.5), DVec3::new(0.2, 0.0, -0.1), DVec3::Y);
    let corner = |x: f32, z: f32| Vertex { position: [x, 0.1 * x, z, 1.0], value: [0.0; 4] };
    let floor = [corner(-2.0, -2.0), corner(2.0, -2.0), corner(2.0, 2.0), corner(-2.0, 2.0)];
    Setup {
        projection: spaces::perspective(0.9, 1.0, 0.5, 30.0),
        eye_from_world: spaces::view_from_world(DVec3::new(-1.0, 3.0, 4.0), DVec3::new(0.0, 0.2, 0.0), DVec3::Y),
        world_from_model: DMat4::from_rotation_y(0.4) * DMat4::from_translation(DVec3::new(0.1, 0.0, -0.2)),
        map_from_world: scale_bias * spaces::perspective(1.2, 1.0, 1.0, 12.0) * light,
        floor: [0, 2, 1, 0, 3, 2].map(|index| floor[index]).to_vec(),
    }
}

/// Texels along a side of the map.
const MAP: u32 = 32;

fn map(subject: &DriverUnderTest, format: GlFormat) -> Result<GlImage, Error> {
    let mut random = Random::new(71);
    let depths: Vec<f32> = (0..MAP * MAP).map(|_| random.between(0.5, 1.0)).collect();
    subject.bench.depth_image(format, [MAP; 2], &[&depths])
}

const TRANSFORM: &str = "#version 120
void main() {
    vec4 eye = gl_ModelViewMatrix * gl_Vertex;
    vec4 at = vec4(dot(gl_EyePlaneS[0], eye), dot(gl_EyePlaneT[0], eye), dot(gl_EyePlaneR[0], eye), dot(gl_EyePlaneQ[0], eye));
    gl_TexCoord[0] = gl_TextureMatrix[0] * at;
    gl_Position = ftransform();
}";
const LOOK_UP: &str = "#version 120
uniform sampler2DShadow map;
void main() { gl_FragColor = vec4(shadow2DProj(map, gl_TexCoord[0]).rgb, 1.0); }";
const PASS_ON: &str = "#version 120
void main() { gl_TexCoord[0] = gl_MultiTexCoord0; gl_Position = ftransform(); }";

/// GL-T1: eye planes are multiplied by the inverse of the modelview at the time they are given, object planes are not, and
/// the texture matrix comes after.
pub fn texgen(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = pipeline(subject, findings, "glTexGen") else { return Ok(()) };
    let setup = setup();
    queried(fixed, findings, &setup);
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), None)?;
    for format in [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth32F] {
        findings.part(|findings| {
            let map = map(subject, format)?;
            for linear in [false, true] {
                looked_up(subject, fixed, findings, &setup, &surface, &map, linear)?;
            }
            Ok(())
        });
    }
    Ok(())
}

fn queried(fixed: &FixedBench, findings: &mut Findings, setup: &Setup) {
    let planes = setup.map_from_world;
    let due = planes * setup.eye_from_world.inverse();
    fixed.set_texgen(&GlTexgen { eye: true, planes, modelview: setup.eye_from_world });
    let first = fixed.eye_planes();
    let off =
        (0..4).map(|row| ((first.row(row) - due.row(row)).abs().max_element()) / due.row(row).abs().max_element());
    let off = off.fold(0.0, f64::max);
    // An inverse in f32 of a matrix that is well conditioned: some tens of its rounding.
    let grade = verify::within(off, 64.0 * f64::from(f32::EPSILON), 1e-4);
    findings.grade(
        "eye planes asked back: p times the inverse modelview",
        grade,
        format!("{:.1} x 2^-23 off", off / f64::from(f32::EPSILON)),
    );
    fixed.set_texgen(&GlTexgen { eye: false, planes, modelview: setup.world_from_model });
    let kept = fixed.eye_planes() == first;
    let measured = if kept { "as they were" } else { "changed with the modelview" };
    findings.must_hold("eye planes asked back under another modelview", kept, measured);
}

/// The image by glTexGen, by a shader from GL's own planes, and by the verifier in f64.
fn looked_up(
    subject: &DriverUnderTest,
    fixed: &FixedBench,
    findings: &mut Findings,
    setup: &Setup,
    surface: &Surface,
    map: &GlImage,
    linear: bool,
) -> Result<(), Error> {
    let modelview = setup.eye_from_world * setup.world_from_model;
    let compare = Sampling { linear, ..Sampling::compare(GlCompare::LessEqual) };
    let moved = DMat4::from_translation(DVec3::new(0.0, 0.0, -0.01));
    let eye = GlTexgen { eye: true, planes: setup.map_from_world, modelview: setup.eye_from_world };
    let draw = FixedDraw {
        projection: setup.projection,
        modelview,
        texture_matrix: moved,
        texgen: Some(eye),
        image: Some((map, compare, DepthMode::Luminance)),
        ..FixedDraw::plain(surface, FLAT, &setup.floor)
    };
    let picture = |draw: &FixedDraw| {
        surface.clear_color([0.0, 0.0, 0.0, 0.0]);
        fixed.draw(&subject.bench, draw)?;
        Ok::<_, Error>(surface.colors())
    };
    let by_texgen = picture(&draw)?;
    let by_shader = picture(&FixedDraw { shaders: Some([TRANSFORM, LOOK_UP]), ..draw })?;
    let object = GlTexgen { eye: false, planes: setup.map_from_world * setup.world_from_model, modelview };
    let by_object = picture(&FixedDraw { texgen: Some(object), ..draw })?;
    let filter = if linear { "LINEAR" } else { "NEAREST" };
    let name = |what: &str| format!("{}, {filter}: {what}", map.format.name());
    let differ = by_texgen.iter().zip(&by_shader).filter(|(a, b)| a != b).count();
    // A.3 promises no equality of fixed function and a shader's own sums.
    let grade = if differ == 0 { Grade::Good } else { Grade::Allowed };
    findings.grade(
        name("EYE_LINEAR and a shader with GL's planes"),
        grade,
        format!("{differ} of {} pixels differ", by_texgen.len()),
    );
    let stored = subject.bench.image_depths(map)?;
    let map_from_model = moved * setup.map_from_world * setup.world_from_model;
    let clip_from_model = setup.projection * modelview;
    for (what, picture) in [("EYE_LINEAR", by_texgen), ("OBJECT_LINEAR", by_object)] {
        let tally = judged(&picture, &stored, clip_from_model, map_from_model, linear);
        findings.tally(name(what), tally, "of the ideal");
    }
    Ok(())
}

/// Each pixel of the floor against the map, found in f64.
fn judged(
    picture: &[[u8; 4]],
    stored: &[f64],
    clip_from_model: DMat4,
    map_from_model: DMat4,
    linear: bool,
) -> GradeTally {
    let mut tally = GradeTally::default();
    for (index, color) in picture.iter().enumerate().filter(|(_, color)| color[3] == 255) {
        let [x, y] =
            [index as u32 % SIDE, index as u32 / SIDE].map(|at| (f64::from(at) + 0.5) * 2.0 / f64::from(SIDE) - 1.0);
        let Some(model) = on_floor(clip_from_model, [x, y]) else { continue };
        let at = map_from_model * model;
        if let Some(grade) = texel_grade(f64::from(color[0]) / 255.0, at / at.w, stored, linear) {
            tally.add(grade, 0.0);
        }
    }
    tally
}

/// The point of the plane y = 0.1 x, which the floor lies in, behind a point of normalised device coordinates.
fn on_floor(clip_from_model: DMat4, [x, y]: [f64; 2]) -> Option<DVec4> {
    let model_from_clip = clip_from_model.inverse();
    let [near, far] = [-1.0, 1.0].map(|z| {
        let point = model_from_clip * DVec4::new(x, y, z, 1.0);
        point / point.w
    });
    let above = |point: DVec4| point.y - 0.1 * point.x;
    let along = above(near) / (above(near) - above(far));
    along.is_finite().then(|| near + (far - near) * along)
}

/// Tests whether a look-up's result is valid; `None` where coordinates or reference are too close to call: positions are
/// known to about 1/32 texel, the reference to 1e-3.
fn texel_grade(value: f64, at: DVec4, stored: &[f64], linear: bool) -> Option<Grade> {
    let side = f64::from(MAP);
    let place = [at.x, at.y].map(|coordinate| coordinate * side - if linear { 0.5 } else { 0.0 });
    if place.iter().any(|place| (place - place.round()).abs() < 1.0 / 32.0) {
        return None;
    }
    let texel = |dx: f64, dy: f64| {
        let [x, y] = [place[0].floor() + dx, place[1].floor() + dy].map(|index| index.clamp(0.0, side - 1.0) as usize);
        stored[y * MAP as usize + x]
    };
    let depths = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[dx, dy]| texel(dx, dy));
    let used = if linear { &depths[..] } else { &depths[..1] };
    if used.iter().any(|depth| (depth - at.z).abs() < 1e-3) {
        return None;
    }
    let passes = depths.map(|depth| at.z <= depth);
    if linear {
        Some(verify::filtered(value, passes, place.map(|place| place - place.floor())))
    } else {
        Some(verify::within(value - f64::from(u8::from(passes[0])), 0.0, 0.0))
    }
}

/// GL-T2's part: (s, t, r, q) given at the vertices.
pub fn division(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = pipeline(subject, findings, "fixed function: division by q") else { return Ok(()) };
    let map = map(subject, GlFormat::Depth24)?;
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), None)?;
    let corners = [[0.0, 0.0, 0.7, 1.0], [3.0, 0.0, 2.1, 3.0], [2.0, 2.0, 1.5, 2.0], [0.0, 4.0, 3.2, 4.0]];
    let mut vertices = full(0.0);
    for (vertex, corner) in vertices.iter_mut().zip([0, 1, 2, 0, 2, 3]) {
        vertex.value = corners[corner];
    }
    for linear in [false, true] {
        let compare = Sampling { linear, ..Sampling::compare(GlCompare::LessEqual) };
        let image = Some((&map, compare, DepthMode::Luminance));
        let draw = FixedDraw { image, ..FixedDraw::plain(&surface, FLAT, &vertices) };
        fixed.draw(&subject.bench, &draw)?;
        let picture = surface.colors();
        fixed.draw(&subject.bench, &FixedDraw { shaders: Some([PASS_ON, LOOK_UP]), ..draw })?;
        let differ = picture.iter().zip(surface.colors()).filter(|(a, b)| a[..3] != b[..3]).count();
        let grade = if differ == 0 { Grade::Good } else { Grade::Allowed };
        let filter = if linear { "LINEAR" } else { "NEAREST" };
        findings.grade(
            format!("{filter}: fixed function and shadow2DProj"),
            grade,
            format!("{differ} of {} pixels differ", picture.len()),
        );
    }
    Ok(())
}

const ONLY_TRANSFORM: &str = "#version 120
void main() { gl_Position = ftransform(); }";
const ONLY_PRODUCT: &str = "#version 120
void main() { gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex; }";
const WHITE: &str = "#version 120
void main() { gl_FragColor = vec4(1.0); }";

/// GL-I1's part: a shader meets the depths of the fixed-function pipeline by ftransform().
pub fn invariance(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = pipeline(subject, findings, "fixed function: ftransform()") else { return Ok(()) };
    let setup = setup();
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), Some(GlFormat::Depth24))?;
    let cases =
        [("ftransform()", ONLY_TRANSFORM, true), ("gl_ModelViewProjectionMatrix * gl_Vertex", ONLY_PRODUCT, false)];
    for (name, vertex, required) in cases {
        surface.clear_depth(1.0);
        surface.clear_color([0.0; 4]);
        let first = GlState { depth: Some(GlCompare::Less), color_write: false, ..GlState::WRITE };
        let draw = FixedDraw {
            projection: setup.projection,
            modelview: setup.eye_from_world * setup.world_from_model,
            ..FixedDraw::plain(&surface, first, &setup.floor)
        };
        fixed.draw(&subject.bench, &draw)?;
        let state = GlState { depth: Some(GlCompare::Equal), ..GlState::WRITE };
        fixed.draw(&subject.bench, &FixedDraw { state, shaders: Some([vertex, WHITE]), ..draw })?;
        let pairs: Vec<_> =
            surface.colors().into_iter().zip(surface.depths()).filter(|(_, depth)| *depth < 1.0).collect();
        let missed = pairs.iter().filter(|(color, _)| color[0] != 255).count();
        let grade = match missed {
            0 if !pairs.is_empty() => Grade::Good,
            _ if required => Grade::Wrong,
            _ => Grade::Allowed,
        };
        findings.grade(
            format!("fixed function, then {name}, EQUAL"),
            grade,
            format!("{missed} of {} pixels missed", pairs.len()),
        );
    }
    Ok(())
}
