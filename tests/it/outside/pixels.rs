//! Pixels of a shadow, tested by a crate that has nothing but glumbra's core.
use std::{env, error::Error, fs};

use glumbra::prelude::*;

fn room(map_size: u32) -> Result<Scene, Box<dyn Error>> {
    let light = LightBuilder::spot([-2.0, 5.0, 1.5], [0.0; 3], 50.0).shadow("shadow-map");
    let floor = ObjectBuilder::mesh("quad").scale([8.0, 1.0, 8.0]);
    let cube = ObjectBuilder::mesh("box").at([0.0, 0.5, 0.0]).scale([0.5; 3]).color([0.8, 0.5, 0.3]);
    let scene = Scene::builder().size([128; 2]).camera([2.5, 4.5, 5.0], [0.2, 0.2, 0.0], 40.0);
    Ok(scene.light(light.set("shadow.size", map_size)).object(floor).object(cube).build()?.scene)
}

#[test]
fn the_shadow_lies_where_it_must() -> Result<(), Box<dyn Error>> {
    let mut renderer = Renderer::new(&context::open(&ContextRequest::default())?);
    let request = Request { views: vec![ViewRequest { view: View::Shade, light: 0 }], ..Request::default() };
    let scene = room(1024)?;
    let mut frame = renderer.render(&scene, &request)?;
    let shade = frame.views.remove(0);
    // A pick: the box's corner (0.5, 1, -0.5) throws its shadow to light + 5/4 (corner - light) = (1.125, 0, -1).
    let at = |x, z| scene.pixel(glam::DVec3::new(x, 0.0, z)).and_then(|pixel| shade.at(pixel)).map(|texel| texel[0]);
    assert_eq!([at(1.05, -0.93), at(1.2, -1.07)], [Some(0.0), Some(1.0)]);
    // A relation: half the map's texels move at most the shadow's edge, a pixel wide here.
    let coarse = renderer.render(&room(512)?, &request)?.views.remove(0);
    let all = || (0..128).flat_map(|y| (0..128).map(move |x| [x, y]));
    let moved = all().filter(|pixel| shade.at(*pixel) != coarse.at(*pixel)).count();
    assert!(moved > 0 && moved < 200, "{moved} pixels differ");
    // Truth: where the ray tracer is sure, 1 pixel in 200 may be wrong.
    let truth = truth::trace(&scene, 0, &Default::default())?;
    let sure = all().zip(&truth.pixels).filter(|(_, pixel)| matches!(pixel.answer, Answer::Lit | Answer::Shadowed));
    let wrong = sure.filter(|(p, t)| shade.at(*p).is_none_or(|s| (s[0] >= 0.5) != (t.answer == Answer::Lit))).count();
    assert!(wrong < 128 * 128 / 200, "{wrong} pixels are wrong");
    // A golden: the same picture to the bit, on the driver that drew it.
    let [golden, drawn] = ["golden.png", "drawn.png"].map(|name| env::temp_dir().join(name));
    let path = if env::var_os("BLESS").is_some() { &golden } else { &drawn };
    output::write_all(&[Output { path, pixels: &frame.picture, view: None }])?;
    assert_eq!(fs::read(&golden)?, fs::read(path)?, "the picture has changed: look at {}", path.display());
    Ok(())
}
