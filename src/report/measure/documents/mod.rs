//! Claims of the documents that are about how shadows are drawn, not about one technique's settings: copies, smaller levels,
//! ways to count, far planes, the angle between eye and light, one grid for both. Each is measured on the report's scene;
//! where the scene has nothing that shows it, its row says why.

mod angle;
mod copies;
mod mipmaps;
mod same_grid;
mod volumes;

pub use copies::copy_from;
pub use volumes::cut_by_far;

use super::claims::{in_words, judge};
use crate::device::Pixels;
use crate::frame::Renderer;
use crate::plan::{Request, ViewRequest};
use crate::report::store::claim_sweep::ClaimSweep;
use crate::report::store::claimed::{ClaimVerdict, Claimed, Measurement};
use crate::scene::{self, Scene, with_shadow};
use crate::techniques::claims::Relation;
use crate::techniques::{self, vary};
use crate::truth::Truth;
use crate::views::View;

/// Scene, and how thoroughly it is measured.
pub struct ClaimRequest<'a> {
    /// The scene, in clear air, its light from one point.
    pub scene: &'a Scene,
    /// Index of the measured light.
    pub light: usize,
    /// The ray tracer's answer for it.
    pub truth: &'a Truth,
    /// True for fewer values and smaller pictures.
    pub quick: bool,
}

/// Claims, and the sweeps that they rest on.
#[derive(Default)]
pub struct Further {
    /// Claims in the order of the documents.
    pub claims: Vec<Claimed>,
    /// Their sweeps.
    pub sweeps: Vec<ClaimSweep>,
}

impl Further {
    fn add(&mut self, (claims, sweeps): (Vec<Claimed>, Vec<ClaimSweep>)) {
        self.claims.extend(claims);
        self.sweeps.extend(sweeps);
    }
}

/// A number, or the reason why there is none.
type Number = Result<f64, String>;

/// Measures all of them. What cannot be measured has a row with its reason. `tick` is called with the name of each.
pub fn measure(request: &ClaimRequest<'_>, renderer: &mut Renderer, mut tick: impl FnMut(&str)) -> Further {
    let mut further = Further::default();
    tick("copies of unequal precision");
    further.add((copies::measure(request, renderer), Vec::new()));
    tick("smaller levels");
    further.add(mipmaps::measure(request, renderer));
    tick("ways to count");
    further.add((volumes::counting(request, renderer), Vec::new()));
    tick("far planes");
    further.add(volumes::far_planes(request, renderer));
    tick("the angle between eye and light");
    further.add(angle::measure(request, renderer, &mut tick));
    tick("one grid for eye and light");
    further.add((same_grid::measure(request, renderer), Vec::new()));
    further
}

/// A claim before it is measured.
#[derive(Clone, Copy)]
struct Said<'a> {
    technique: &'a str,
    source: &'a str,
    says: &'a str,
    quantity: &'a str,
}

impl Said<'_> {
    /// The claim with both numbers, each with its setting.
    fn compare(self, relation: Relation, first: (String, Number), second: (String, Number)) -> Claimed {
        let (first, second) = (number(first), number(second));
        let verdict = match judge(relation, &first, &second) {
            ClaimVerdict::Unknown => ClaimVerdict::NotMeasured,
            verdict => verdict,
        };
        Claimed {
            technique: self.technique.to_owned(),
            source: self.source.to_owned(),
            says: self.says.to_owned(),
            quantity: self.quantity.to_owned(),
            first,
            relation: in_words(relation),
            second,
            ratio_range: None,
            verdict,
        }
    }
}

fn number((settings, value): (String, Number)) -> Measurement {
    match value {
        Ok(value) => Measurement { settings, value: Some(value), why: None },
        Err(why) => Measurement { settings, value: None, why: Some(why) },
    }
}

/// The scene with keys of `[light.shadow]` in TOML over the light's own.
fn with_keys(scene: &Scene, light: usize, keys: &str) -> Result<Scene, String> {
    let source = scene.lights.get(light).ok_or("there is no such light")?;
    let keys = scene::shadow_settings(keys).map_err(|error| error.to_string())?;
    let table = vary::over(source.shadow.written(), &keys);
    let shadow = techniques::read(table, &source.kind, &scene.objects).map_err(|error| error.to_string())?;
    Ok(with_shadow(scene, light, &shadow))
}

/// Depths in [0, 1] of the camera's picture or of the light's map, with its width and height; rows from the top.
fn depths(scene: &Scene, light: usize, view: View, renderer: &mut Renderer) -> Result<([usize; 2], Vec<f64>), String> {
    let views = vec![ViewRequest { view, light }];
    let request = Request { views, sampled_warnings: false, ..Request::default() };
    let frame = renderer.render(scene, &request).map_err(|error| error.to_string())?;
    match frame.views.into_iter().next() {
        Some(Pixels::Depth { size, data }) => {
            Ok((size.map(|side| side as usize), data.into_iter().map(f64::from).collect()))
        }
        _ => Err(format!("the view {} has no depths", view.name())),
    }
}
