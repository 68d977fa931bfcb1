//! Both roads of a pass list: shaders and the driver's own fixed-function pipeline. With planes and matrices of the driver's
//! arithmetic the shade is the same to the bit; with ours, but for a handful of pixels; colours are within 1/255.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use glam::DMat4;
use glumbra::context::{self, Choice, Context, ContextRequest, Profile};
use glumbra::device::{Measure, Pixels};
use glumbra::frame::Renderer;
use glumbra::oracle::fixed_function::{Error, FixedFunction, Inexpressible};
use glumbra::pass::{Meaning, PassList, Projection, Work};
use glumbra::plan::{Plan, Request, ViewRequest};
use glumbra::scene::{self, Scene};
use glumbra::techniques::views::View;
use glumbra::viewer::Mode;

const SAMPLE: &str = "data/scenes/hw_shadowmaps_simple.toml";

/// One code of 8 bits: decals and spot images are filtered with weights of 8 bits, so that coordinates which differ in
/// their last bit may come out one code apart. A little more for the sums around it.
const ONE_CODE: f32 = 1.02 / 255.0;

/// Pixels, of 262,144, whose shade may come out otherwise when planes and positions round in f64 first and not in the
/// driver's f32 products: a texel's border or a silhouette runs through them. Measured: at most 8, 2 with NEAREST.
const HANDFUL: usize = 12;

/// Both roads on one context.
struct Roads {
    renderer: Renderer,
    fixed: FixedFunction,
    _context: Box<dyn Context>,
}

/// A plan drawn by both: its picture, then its views; RGBA in floats.
struct Drawn {
    shaders: Vec<Vec<f32>>,
    fixed: Vec<Vec<f32>>,
}

impl Roads {
    fn open() -> Self {
        Self::on(Choice::Auto)
    }

    fn on(choice: Choice) -> Self {
        let profile = Profile::Compatibility;
        let context = context::open(&ContextRequest { choice, profile, debug: true, ..Default::default() }).unwrap();
        let fixed = FixedFunction::new(&*context).unwrap();
        Self { renderer: Renderer::new(&*context), fixed, _context: context }
    }

    fn plan(&mut self, scene: &Scene, request: &Request) -> Plan {
        self.renderer.plan(scene, request).unwrap_or_else(|error| panic!("{error}"))
    }

    fn draw(&mut self, plan: &Plan) -> Result<Drawn, Error> {
        let fixed = self.draw_fixed(plan, &plan.list)?;
        Ok(Drawn { fixed, shaders: self.draw_shaders(plan, &plan.list) })
    }

    /// As `draw`, where the shaders take planes and matrices from the driver.
    fn draw_in_driver_arithmetic(&mut self, plan: &Plan) -> Result<Drawn, Error> {
        let fixed = self.draw_fixed(plan, &plan.list)?;
        let list = self.fixed.in_driver_arithmetic(&plan.list);
        Ok(Drawn { fixed, shaders: self.draw_shaders(plan, &list) })
    }

    fn draw_fixed(&mut self, plan: &Plan, list: &PassList) -> Result<Vec<Vec<f32>>, Error> {
        self.fixed.run(list)?;
        images(plan).map(|image| Ok(floats(&self.fixed.read(list, image)?))).collect()
    }

    fn draw_shaders(&mut self, plan: &Plan, list: &PassList) -> Vec<Vec<f32>> {
        let device = self.renderer.device();
        device.forget();
        device.run(list, Measure::No).unwrap();
        images(plan).map(|image| floats(&device.read(list, image).unwrap())).collect()
    }
}

fn images(plan: &Plan) -> impl Iterator<Item = glumbra::pass::ImageId> {
    std::iter::once(plan.picture).chain(plan.views.iter().map(|(_, image)| *image))
}

fn floats(pixels: &Pixels) -> Vec<f32> {
    match pixels {
        Pixels::Rgba8 { data, .. } => data.iter().map(|code| f32::from(*code) / 255.0).collect(),
        Pixels::RgbaF32 { data, .. } => data.clone(),
        other => panic!("colours, not {:?}", other.size()),
    }
}

/// Pixels that differ by more than `within`; colours above 1 are white in every picture.
fn differing(a: &[f32], b: &[f32], within: f32) -> usize {
    assert_eq!(a.len(), b.len());
    let differs = |(a, b): (&[f32], &[f32])| !a.iter().zip(b).all(|(a, b)| (a.min(1.0) - b.min(1.0)).abs() <= within);
    a.chunks(4).zip(b.chunks(4)).filter(|pixel| differs((pixel.0, pixel.1))).count()
}

/// Pixels whose bits differ.
fn differing_bits(a: &[f32], b: &[f32]) -> usize {
    a.chunks(4).zip(b.chunks(4)).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.to_bits() != b.to_bits())).count()
}

/// Pixels that the light reaches, and those of them that are all in shadow.
fn reached_and_shadowed(shade: &[f32]) -> (usize, usize) {
    let reached = shade.chunks(4).filter(|pixel| pixel[3] == 1.0);
    (reached.clone().count(), reached.filter(|pixel| pixel[0] == 0.0).count())
}

fn load(path: &Path, set: &[&str]) -> Scene {
    let set: Vec<String> = set.iter().map(|set| (*set).to_owned()).collect();
    scene::load(path, &set).unwrap_or_else(|error| panic!("{error}")).scene
}

/// The picture in floats, so that nothing is rounded before it is compared, and each light's shade.
fn picture_and_shades(scene: &Scene) -> Request {
    let views = (0..scene.lights.len()).map(|light| ViewRequest { view: View::Shade, light }).collect();
    Request { views, float_picture: true, ..Request::default() }
}

/// Holds both roads against each other; `Ok` with whether some light's shade has a shadow.
fn compare(roads: &mut Roads, scene: &Scene, name: &str) -> Result<bool, Vec<Inexpressible>> {
    let plan = roads.plan(scene, &picture_and_shades(scene));
    let same = match roads.draw_in_driver_arithmetic(&plan) {
        Err(Error::Inexpressible(all)) => return Err(all),
        other => other.unwrap_or_else(|error| panic!("{name}: {error}")),
    };
    let own = roads.draw(&plan).unwrap();
    let handful = HANDFUL * same.fixed[0].len().div_ceil(4 * 262_144);
    let shades = || same.shaders.iter().zip(&same.fixed).skip(1).zip(own.shaders.iter().zip(&own.fixed).skip(1));
    for (light, ((shader, fixed), (own_shader, own_fixed))) in shades().enumerate() {
        assert_eq!(differing_bits(shader, fixed), 0, "{name}: shade of light {light}, in the driver's arithmetic");
        let off = differing(own_shader, own_fixed, ONE_CODE);
        assert!(off <= handful, "{name}: shade of light {light}: {off} pixels");
    }
    assert_eq!(differing(&same.shaders[0], &same.fixed[0], ONE_CODE), 0, "{name}: the picture");
    let off = differing(&own.shaders[0], &own.fixed[0], ONE_CODE);
    assert!(off <= handful, "{name}: the picture: {off} pixels");
    Ok(same.fixed.iter().skip(1).any(|shade| reached_and_shadowed(shade).1 > 0))
}

#[test]
fn the_sample_is_the_same_in_every_mode_to_one_code() {
    let mut roads = Roads::open();
    for (name, mode) in Mode::ALL {
        let scene = load(Path::new(SAMPLE), &[]);
        let (scene, request) = mode.frame(&scene, scene.image.size);
        let plan = roads.plan(&scene, &request);
        let drawn = roads.draw_in_driver_arithmetic(&plan).unwrap();
        // Rounded to 8 bits: one code more, where a value lies at the border of two.
        assert_eq!(differing(&drawn.shaders[0], &drawn.fixed[0], ONE_CODE), 0, "{name}");
        let apart = differing_bits(&drawn.shaders[0], &drawn.fixed[0]);
        assert!(apart < 262_144 / 1000, "{name}: {apart} pixels of 8 bits differ by a code");
        let off = roads.draw(&plan).map(|drawn| differing(&drawn.shaders[0], &drawn.fixed[0], ONE_CODE)).unwrap();
        assert!(off <= HANDFUL, "{name}: {off} pixels with our own planes");
    }
}

/// What of the sample's shadow is varied, beside set-ups and splits.
const VARIANTS: &[&[&str]] = &[
    &["light.shadow.format=depth16"],
    &["light.shadow.format=depth32f", "light.far=20"],
    &["light.shadow.filter=nearest"],
    &["light.shadow.transfer=copy"],
    &["light.shadow.compare=gequal"],
    &["light.shadow.addressing=direct3d"],
    &["light.shadow.cull=front"],
    &["light.shadow.r.bias=0.498"],
    &["light.shadow.dimming=0.4"],
    &["light.shape=cone"],
    &["light.shape=cone", "light.shadow.dimming=0.4", "shading.ambient=[0.2, 0.2, 0.2]"],
    &["light.ambient=[0.2, 0.1, 0.1]"],
    &["light.attenuation=[0.5, 0.1, 0.02]", "shading.ambient=[0.2, 0.2, 0.2]"],
    &["light.attenuation=[1.5, 0.1, 0.02]", "light.ambient=[0.1, 0.1, 0.2]", "light.diffuse=[0.8, 0.9, 0.7]"],
];

#[test]
fn the_samples_shadow_is_the_same_to_the_bit() {
    let mut roads = Roads::open();
    for variant in VARIANTS {
        let name = variant.join(" ");
        let shadowed = compare(&mut roads, &load(Path::new(SAMPLE), variant), &name);
        assert!(shadowed.unwrap_or_else(|all| panic!("{name}: {all:?}")), "{name}: no shadow");
    }
}

#[test]
fn planes_set_under_every_modelview_give_the_shadow_to_the_bit() {
    let mut roads = Roads::open();
    for set_up in ["eye", "world", "light", "identity"] {
        for split in ["identity", "scale-bias", "projection"] {
            let set = [format!("light.shadow.texgen={set_up}"), format!("light.shadow.texture_matrix={split}")];
            let scene = load(Path::new(SAMPLE), &[&set[0], &set[1], "image.size=[256, 256]"]);
            assert_eq!(compare(&mut roads, &scene, &set.join(" ")), Ok(true));
        }
    }
}

/// What is wrong with the planes that GL is given.
type Mistake = fn(&mut Projection);

const MISTAKES: &[(&str, Mistake)] = &[
    ("planes under the identity", |projection| projection.texgen.modelview = DMat4::IDENTITY),
    ("planes under the inverse", |projection| projection.texgen.modelview = projection.texgen.modelview.inverse()),
    ("planes transposed", |projection| projection.texgen.planes = projection.texgen.planes.transpose()),
    ("no texture matrix", |projection| projection.texgen.texture_matrix = DMat4::IDENTITY),
    ("r and q exchanged", |projection| {
        let rows = projection.texgen.planes.transpose();
        projection.texgen.planes = DMat4::from_cols(rows.x_axis, rows.y_axis, rows.w_axis, rows.z_axis).transpose();
    }),
];

#[test]
fn mistakes_in_the_planes_are_seen() {
    let mut roads = Roads::open();
    let set = ["light.shadow.texgen=light", "light.shadow.texture_matrix=scale-bias", "image.size=[256, 256]"];
    let scene = load(Path::new(SAMPLE), &set);
    let plan = roads.plan(&scene, &picture_and_shades(&scene));
    let right = roads.draw(&plan).unwrap();
    assert!(differing(&right.shaders[1], &right.fixed[1], ONE_CODE) <= HANDFUL);
    for (name, mistake) in MISTAKES {
        let mut list = plan.list.clone();
        for pass in &mut list.passes {
            let Work::Draw(draw) = &mut pass.work else { continue };
            for batch in &mut draw.batches {
                if let Meaning::Sampled(view) = &mut batch.meaning {
                    mistake(&mut view.projection);
                }
            }
        }
        let wrong = roads.draw_fixed(&plan, &list).unwrap();
        let off = differing(&right.shaders[1], &wrong[1], ONE_CODE);
        assert!(off > 1000, "{name}: {off} pixels differ");
    }
}

/// Why a case's scene may be refused: what no layer of fixed function computes, and no more.
const KNOWN_LIMITS: &[&str] = &["beyond the light's far plane", "saturate"];

#[test]
fn scenes_and_cases_agree_per_vertex_or_say_why_not() {
    let mut roads = Roads::open();
    let (mut drawn, mut shadowed, mut refused) = (0, 0, 0);
    for (path, set) in cases() {
        let Ok(loaded) = scene::load(&path, &set) else { continue };
        let of_maps = |light: &scene::Light| {
            let technique = light.shadow.get("technique").map(|entry| format!("{:?}", entry.value));
            technique.is_none_or(|name| name.contains("\"shadow-map\"") || name.contains("\"none\""))
        };
        let plans = Renderer::plan(&mut roads.renderer, &loaded.scene, &Request::default()).is_ok();
        if !plans || !loaded.scene.lights.iter().all(of_maps) {
            continue;
        }
        let name = format!("{} {}", path.display(), set.join(" "));
        match compare(&mut roads, &loaded.scene, &name) {
            Ok(shadow) => {
                drawn += 1;
                shadowed += usize::from(shadow);
            }
            Err(all) => {
                refused += 1;
                let known = |each: &Inexpressible| KNOWN_LIMITS.iter().any(|limit| each.why.contains(limit));
                assert!(all.iter().all(known), "{name}: {all:#?}");
            }
        }
    }
    println!("{drawn} scenes drawn on both roads, {shadowed} of them with a shadow; {refused} refused");
    assert!(drawn >= 60 && shadowed >= 40, "{drawn} scenes were drawn, {shadowed} with a shadow");
}

/// Every scene, and every case's with what the case sets, lit per vertex; each once.
fn cases() -> BTreeSet<(PathBuf, Vec<String>)> {
    let mut found = BTreeSet::new();
    let mut add = |scene: PathBuf, set: &[String]| {
        let own = ["shading.lighting=per-vertex", "image.size=[192, 192]"].map(str::to_owned);
        found.insert((scene, [set, &own].concat()));
    };
    for path in files("data/scenes").into_iter().chain(files("data/cases/scenes")) {
        add(path, &[]);
    }
    for technique in ["none", "shadow-map"] {
        for folder in files(&format!("data/cases/{technique}")) {
            let text = std::fs::read_to_string(folder.join("case.toml")).unwrap();
            let case: toml::Table = text.parse().unwrap();
            let scene = folder.join(case.get("scene").map_or("scene.toml", |path| path.as_str().unwrap()));
            let base = case.get("set").map(strings).unwrap_or_default();
            add(scene.clone(), &base);
            for check in case.values().filter_map(toml::Value::as_array).flatten() {
                let keys = ["set", "with"].into_iter().filter_map(|key| check.get(key)).map(strings);
                let several = check.get("sets").and_then(toml::Value::as_array).into_iter().flatten().map(strings);
                keys.chain(several).for_each(|set| add(scene.clone(), &[base.clone(), set].concat()));
            }
        }
    }
    found
}

fn strings(value: &toml::Value) -> Vec<String> {
    value.as_array().into_iter().flatten().filter_map(|each| each.as_str().map(str::to_owned)).collect()
}

/// What lies in a folder, pictures left out.
fn files(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.is_dir() || path.extension().is_some_and(|extension| extension == "toml")).collect()
}

/// What fixed function cannot do: settings, the pass, the draw, and words of the reason.
const REFUSED: &[(&[&str], &str, &str, &str)] = &[
    (&["shading.lighting=per-fragment"], "lit", "teapot", "for each fragment"),
    (&["light.shadow.format=depth32f"], "lit", "floor", "beyond the light's far plane"),
    (&["object.1.material.shininess=200"], "lit", "teapot", "GL_SHININESS ends at 128"),
    (&["light.shadow.technique=shadow-volume"], "light 0", "teapot", "stencil"),
];

#[test]
fn what_fixed_function_cannot_draw_is_named() {
    let mut roads = Roads::open();
    for (set, pass, what, why) in REFUSED {
        let scene = load(Path::new(SAMPLE), set);
        let plan = roads.plan(&scene, &Request::default());
        let error = roads.draw(&plan).err().unwrap_or_else(|| panic!("{set:?} is drawn"));
        let Error::Inexpressible(all) = &error else { panic!("{error}") };
        let named = |each: &Inexpressible| each.pass == *pass && each.what.contains(what) && each.why.contains(why);
        assert!(all.iter().any(named), "{error}");
        assert!(error.to_string().contains(&format!("\"{pass}\", ")), "{error}");
    }
    let scene = load(Path::new(SAMPLE), &[]);
    let views = vec![ViewRequest { view: View::LightDistance, light: 0 }];
    let plan = roads.plan(&scene, &Request { views, ..Request::default() });
    let named = roads.fixed.inexpressible(&plan.list);
    let [only] = named.as_slice() else { panic!("{named:#?}") };
    assert_eq!((only.pass.as_str(), only.why.as_str()), ("view: light-distance of light 0", "r/q as a colour"));
}

#[test]
fn osmesa_has_the_fixed_function_road_too() {
    let request = ContextRequest { choice: Choice::OsMesa, profile: Profile::Compatibility, ..Default::default() };
    if context::open(&request).is_err() {
        println!("skipped: this machine has no libOSMesa");
        return;
    }
    let scene = load(Path::new(SAMPLE), &["image.size=[256, 256]"]);
    assert_eq!(compare(&mut Roads::on(Choice::OsMesa), &scene, "OSMesa"), Ok(true));
}
