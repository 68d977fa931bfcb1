//! Mistakes made on purpose are seen by the metrics: a pass list is data, so each is put into an otherwise right plan.

use glumbra::context::{self, ContextRequest};
use glumbra::device::{Measure, Pixels};
use glumbra::frame::{Renderer, ShadeImage};
use glumbra::judge::metrics::{Band, Metrics, compare};
use glumbra::pass::{UniformValue, Work};
use glumbra::plan::{Plan, Request, ViewRequest};
use glumbra::scene::Scene;
use glumbra::truth::{self, Truth};
use glumbra::views::View;

fn scene(changes: &[&str]) -> Scene {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/data/");
    let mut all = vec![format!("object.1.mesh=\"{root}meshes/dense.obj\""), String::from("image.size=[256, 256]")];
    all.extend(changes.iter().map(|text| (*text).to_owned()));
    glumbra::load(format!("{root}scenes/example.toml").as_ref(), &all).unwrap().scene
}

fn plan(renderer: &mut Renderer, changes: &[&str]) -> Plan {
    let views = vec![ViewRequest { view: View::Shade, light: 0 }];
    renderer.plan(&scene(changes), &Request { views, ..Request::default() }).unwrap()
}

fn measure(renderer: &mut Renderer, plan: &Plan, truth: &Truth) -> Metrics {
    renderer.device().forget();
    renderer.device().run(&plan.list, Measure::No).unwrap();
    let Pixels::RgbaF32 { size: [width, height], data } = renderer.device().read(&plan.list, plan.views[0].1).unwrap()
    else {
        panic!("shade is not in float");
    };
    let shade = ShadeImage {
        width,
        height,
        shade: data.chunks_exact(4).map(|texel| texel[0]).collect(),
        covered: data.chunks_exact(4).map(|texel| texel[3] > 0.0).collect(),
    };
    compare(truth, &shade, &Band { texels: 2.0, map_size: [1024; 2] }).unwrap()
}

/// Changes every `eye_planes_0` of a plan.
fn change_planes(plan: &mut Plan, change: impl Fn(&mut Vec<glam::Vec4>)) {
    let mut changed = 0;
    for pass in &mut plan.list.passes {
        let Work::Draw(draw) = &mut pass.work else { continue };
        for uniform in draw.batches.iter_mut().flat_map(|batch| &mut batch.uniforms) {
            if let (true, UniformValue::Vec4Array(planes)) = (uniform.name == "eye_planes_0", &mut uniform.value) {
                change(planes);
                changed += 1;
            }
        }
    }
    assert!(changed > 0);
}

#[test]
fn mistakes_are_seen() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let truth = truth::trace(&scene(&[]), 0, &truth::Options::default()).unwrap();
    let right_plan = plan(&mut renderer, &[]);
    let right = measure(&mut renderer, &right_plan, &truth);
    println!("right: wrong {} %, beyond the band {} %", right.all.wrong_percent, right.all.wrong_outside_percent);
    assert!(right.all.wrong_percent < 0.3 && right.all.wrong_outside_percent < 0.1, "{right:?}");

    let no_offset = plan(&mut renderer, &["light.shadow.offset={factor=0.0, units=0.0}"]);
    let found = measure(&mut renderer, &no_offset, &truth);
    assert!(found.all.false_shadow_percent > 20.0, "no offset: {found:?}");

    let fifty = plan(&mut renderer, &["light.shadow.offset={factor=55.0, units=200.0}"]);
    let found = measure(&mut renderer, &fifty, &truth);
    assert!(found.all.leak_percent > 5.0 * right.all.leak_percent, "offset x 50: {found:?}");

    // The map as it is, looked up through a frustum that is one degree wider.
    let mut wider = plan(&mut renderer, &["light.cone=61.0"]);
    assert_eq!(wider.list.passes[0].label, right_plan.list.passes[0].label);
    wider.list.passes[0] = right_plan.list.passes[0].clone();
    let found = measure(&mut renderer, &wider, &truth);
    println!("1 degree: wrong {} %, beyond the band {} %", found.all.wrong_percent, found.all.wrong_outside_percent);
    assert!(found.all.wrong_outside_percent > 3.0 * right.all.wrong_outside_percent, "1 degree: {found:?}");

    let mut swapped = right_plan.clone();
    change_planes(&mut swapped, |planes| planes.swap(0, 1));
    let found = measure(&mut renderer, &swapped, &truth);
    assert!(found.all.wrong_outside_percent > 0.3, "s and t swapped: {found:?}");

    let mut mirrored = right_plan.clone();
    change_planes(&mut mirrored, |planes| planes[0] = planes[3] - planes[0]);
    let found = measure(&mut renderer, &mirrored, &truth);
    assert!(found.all.wrong_outside_percent > 0.3, "s mirrored: {found:?}");
}
