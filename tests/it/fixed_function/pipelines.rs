//! A pass list drawn by both pipelines on one context, and the comparison of their pictures.

use std::path::Path;

use glumbra::context::{self, Choice, ContextRequest, Profile};
use glumbra::device::{Measure, Pixels};
use glumbra::fixed_function::{Error, FixedFunction, Inexpressible};
use glumbra::frame::Renderer;
use glumbra::pass::PassList;
use glumbra::plan::{Plan, Request, ViewRequest};
use glumbra::scene::Scene;
use glumbra::views::View;

/// One code of 8 bits: decals and spot images are filtered with weights of 8 bits, so that coordinates which differ in
/// their last bit may come out one code apart. A little more for the sums around it.
pub const ONE_CODE: f32 = 1.02 / 255.0;

/// Pixels, of 262,144, whose shade may come out otherwise when planes and positions round in f64 first and not in the
/// driver's f32 products: a texel's border or a silhouette runs through them. Measured: at most 8, 2 with NEAREST.
pub const HANDFUL: usize = 12;

/// Both pipelines on one context.
pub struct Pipelines {
    pub renderer: Renderer,
    pub fixed: FixedFunction,
    /// True if shades must agree to the bit: Mesa's fixed function rounds as a shader does until 26.
    to_the_bit: bool,
}

/// A plan drawn by both: its picture, then its views; RGBA in floats.
pub struct Drawn {
    pub shaders: Vec<Vec<f32>>,
    pub fixed: Vec<Vec<f32>>,
}

impl Pipelines {
    pub fn open() -> Self {
        Self::on(Choice::Auto)
    }

    pub fn on(choice: Choice) -> Self {
        let profile = Profile::Compatibility;
        let context = context::open(&ContextRequest { choice, profile, debug: true, ..Default::default() }).unwrap();
        let fixed = FixedFunction::new(&context).unwrap();
        let version = context.describe().version;
        let mesa = version.split_once("Mesa ").and_then(|(_, number)| number.split('.').next()?.parse::<u32>().ok());
        let to_the_bit = mesa.is_some_and(|major| major < 26);
        Self { renderer: Renderer::new(&context), fixed, to_the_bit }
    }

    pub fn plan(&mut self, scene: &Scene, request: &Request) -> Plan {
        self.renderer.plan(scene, request).unwrap_or_else(|error| panic!("{error}"))
    }

    pub fn draw(&mut self, plan: &Plan) -> Result<Drawn, Error> {
        let fixed = self.draw_fixed(plan, &plan.list)?;
        Ok(Drawn { fixed, shaders: self.draw_shaders(plan, &plan.list) })
    }

    /// As `draw`, where the shaders take planes and matrices from the driver.
    pub fn draw_in_driver_arithmetic(&mut self, plan: &Plan) -> Result<Drawn, Error> {
        let fixed = self.draw_fixed(plan, &plan.list)?;
        let list = self.fixed.in_driver_arithmetic(&plan.list);
        Ok(Drawn { fixed, shaders: self.draw_shaders(plan, &list) })
    }

    pub fn draw_fixed(&mut self, plan: &Plan, list: &PassList) -> Result<Vec<Vec<f32>>, Error> {
        self.fixed.run(list)?;
        images(plan).map(|image| Ok(floats(&self.fixed.read(list, image)?))).collect()
    }

    pub fn draw_shaders(&mut self, plan: &Plan, list: &PassList) -> Vec<Vec<f32>> {
        let device = self.renderer.device();
        device.forget();
        device.run(list, Measure::No).unwrap();
        images(plan).map(|image| floats(&device.read(list, image).unwrap())).collect()
    }
}

pub fn images(plan: &Plan) -> impl Iterator<Item = glumbra::pass::ImageId> {
    std::iter::once(plan.picture).chain(plan.views.iter().map(|(_, image)| *image))
}

pub fn floats(pixels: &Pixels) -> Vec<f32> {
    match pixels {
        Pixels::Rgba8 { data, .. } => data.iter().map(|code| f32::from(*code) / 255.0).collect(),
        Pixels::RgbaF32 { data, .. } => data.clone(),
        other => panic!("colours, not {:?}", other.size()),
    }
}

/// Pixels that differ by more than `within`; colours above 1 are white in every picture.
pub fn differing(a: &[f32], b: &[f32], within: f32) -> usize {
    assert_eq!(a.len(), b.len());
    let differs = |(a, b): (&[f32], &[f32])| !a.iter().zip(b).all(|(a, b)| (a.min(1.0) - b.min(1.0)).abs() <= within);
    a.chunks(4).zip(b.chunks(4)).filter(|pixel| differs((pixel.0, pixel.1))).count()
}

/// Pixels whose bits differ.
pub fn differing_bits(a: &[f32], b: &[f32]) -> usize {
    a.chunks(4).zip(b.chunks(4)).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.to_bits() != b.to_bits())).count()
}

/// Pixels that the light reaches, and those of them that are all in shadow.
pub fn reached_and_shadowed(shade: &[f32]) -> (usize, usize) {
    let reached = shade.chunks(4).filter(|pixel| pixel[3] == 1.0);
    (reached.clone().count(), reached.filter(|pixel| pixel[0] == 0.0).count())
}

pub fn load(path: &Path, set: &[&str]) -> Scene {
    let set: Vec<String> = set.iter().map(|set| (*set).to_owned()).collect();
    glumbra::load(path, &set).unwrap_or_else(|error| panic!("{error}")).scene
}

/// The picture in floats, so that nothing is rounded before it is compared, and each light's shade.
pub fn picture_and_shades(scene: &Scene) -> Request {
    let views = (0..scene.lights.len()).map(|light| ViewRequest { view: View::Shade, light }).collect();
    Request { views, float_picture: true, sampled_warnings: false, ..Request::default() }
}

/// Compares both pipelines. `Ok(true)` if some light's shade has a shadow.
pub fn compare(pipelines: &mut Pipelines, scene: &Scene, name: &str) -> Result<bool, Vec<Inexpressible>> {
    let plan = pipelines.plan(scene, &picture_and_shades(scene));
    let same = match pipelines.draw_in_driver_arithmetic(&plan) {
        Err(Error::Inexpressible(all)) => return Err(all),
        other => other.unwrap_or_else(|error| panic!("{name}: {error}")),
    };
    let own = pipelines.draw(&plan).unwrap();
    let handful = HANDFUL * same.fixed[0].len().div_ceil(4 * 262_144);
    let shades = || same.shaders.iter().zip(&same.fixed).skip(1).zip(own.shaders.iter().zip(&own.fixed).skip(1));
    for (light, ((shader, fixed), (own_shader, own_fixed))) in shades().enumerate() {
        let bits = differing_bits(shader, fixed);
        let off = differing(shader, fixed, ONE_CODE);
        let right = if pipelines.to_the_bit { bits == 0 } else { off <= handful };
        let what = format!("{name}: shade of light {light}, in the driver's arithmetic");
        assert!(right, "{what}: {bits} pixels differ in their bits, {off} by more than a code");
        let off = differing(own_shader, own_fixed, ONE_CODE);
        assert!(off <= handful, "{name}: shade of light {light}: {off} pixels");
    }
    assert_eq!(differing(&same.shaders[0], &same.fixed[0], ONE_CODE), 0, "{name}: the picture");
    let off = differing(&own.shaders[0], &own.fixed[0], ONE_CODE);
    assert!(off <= handful, "{name}: the picture: {off} pixels");
    Ok(same.fixed.iter().skip(1).any(|shade| reached_and_shadowed(shade).1 > 0))
}
