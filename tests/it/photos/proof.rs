//! The proof that needs no asset: a scene photographed by the program, and the photograph projected back onto it.

use glumbra::scene::Scene;
use glumbra::truth::{self, Answer, Surroundings};

use super::*;

/// Pixels a side of photographs and pictures.
const SIZE: u32 = 144;

struct Case {
    objects: Vec<String>,
    from: Pose,
    elsewhere: Pose,
}

fn case(studio: &Studio, seed: u64) -> Case {
    let mut random = Random::new(seed);
    let objects = generated_objects(studio, &mut random);
    let (from, elsewhere) = (generated_pose(&mut random), generated_pose(&mut random));
    Case { objects, from, elsewhere }
}

impl Case {
    fn direct(&self, studio: &Studio, pose: &Pose) -> Scene {
        studio.load(&scene_text([SIZE; 2], pose, &self.objects, ""))
    }

    fn projected(&self, studio: &Studio, pose: &Pose, path: &Path, more: &str) -> Scene {
        studio.load(&scene_text([SIZE; 2], pose, &self.objects, &self.from.photo(path, more)))
    }

    /// The scene with a light in the place of the photograph's camera, for the ray tracer.
    fn lit_from_photo(&self, studio: &Studio, pose: &Pose) -> Scene {
        let text = scene_text([SIZE; 2], pose, &self.objects, "");
        let Pose { eye, target, fov_y } = self.from;
        let light = format!(
            "[[light]]\nposition = {}\ntarget = {}\ncone = {fov_y:?}\nshape = \"frustum\"\n",
            vector(eye),
            vector(target)
        );
        studio.load(&(text + &light))
    }
}

#[test]
fn from_its_own_eye_a_photograph_is_what_it_shows_to_the_bit() {
    let mut studio = Studio::new();
    for seed in 0..12 {
        let case = case(&studio, seed);
        let scene = case.direct(&studio, &case.from);
        let (path, photo) = studio.take(&scene, "photo.png");
        // Without a test of depth; by a map whose texels are the pixels; and by a finer one.
        for (more, silhouettes) in [
            ("filter = \"nearest\", hidden = \"smear\"", false),
            ("filter = \"nearest\", map = { size = 144, filter = \"nearest\" }", false),
            ("filter = \"linear\", map = { size = 144 }", false),
            ("filter = \"nearest\", map = { size = 1024 }", true),
        ] {
            let scene = case.projected(&studio, &case.from, &path, more);
            let picture = studio.draw(&scene);
            let differ: Vec<usize> = (0..picture.len()).filter(|pixel| picture[*pixel] != photo[*pixel]).collect();
            println!("seed {seed}, {more}: {} of {} pixels differ", differ.len(), picture.len());
            if !silhouettes {
                assert!(differ.is_empty(), "seed {seed}, {more}: {differ:?}");
                continue;
            }
            // A texel of another grid than the pixels' may hold, at a silhouette, the surface behind or before it: then the
            // pixel is grey. Nowhere else, and in few pixels.
            let truth = colors(&scene, Some(1024));
            for pixel in &differ {
                assert_eq!(picture[*pixel], GREY, "seed {seed}: pixel {pixel}");
                let at = truth.pixels[*pixel];
                assert!(!at.is_known || at.rgb[0].jumps, "seed {seed}: pixel {pixel} is at no silhouette: {at:?}");
            }
            assert!(differ.len() < 60, "seed {seed}: {}", differ.len());
        }
    }
}

#[test]
fn from_elsewhere_it_is_the_direct_picture_where_its_eye_saw() {
    let mut studio = Studio::new();
    let (mut shown, mut hidden, mut worst) = (0, 0, 0.0_f64);
    for seed in 20..36 {
        let case = case(&studio, seed);
        let photographed = case.direct(&studio, &case.from);
        let (path, photo) = studio.take(&photographed, "photo.png");
        let scene = case.direct(&studio, &case.elsewhere);
        let direct = studio.draw(&scene);
        let more = "filter = \"linear\", map = { size = 1024 }";
        let scene = case.projected(&studio, &case.elsewhere, &path, more);
        let picture = studio.draw(&scene);
        let scene = case.lit_from_photo(&studio, &case.elsewhere);
        let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
        let truth = truth::trace(&scene, 0, &options).unwrap();
        let around = Surroundings::new(&scene, 0, &options).unwrap();
        // Two texels of the map, on the plane at distance 1.
        let tangent = (0.5 * case.from.fov_y.to_radians()).tan();
        let reach = 2.0 * 2.0 * tangent / 1024.0;
        for (index, pixel) in truth.pixels.iter().enumerate() {
            let (x, y) = (index as u32 % SIZE, index as u32 / SIZE);
            let Some(hit) = pixel.hit.filter(|_| matches!(pixel.answer, Answer::Lit | Answer::Shadowed)) else {
                continue;
            };
            let Some(around) = around.around(x, y, reach) else { continue };
            let thin = around.blockers.iter().any(|near| near.gap < 0.1);
            // A point that is hidden has a blocker before it; one that is seen may be hidden by what rises beside it.
            let rises = pixel.answer == Answer::Lit && around.rise > 0.25 * reach * around.scale;
            if around.edge || thin || rises {
                continue;
            }
            if pixel.answer == Answer::Shadowed {
                assert_eq!(picture[index], GREY, "seed {seed}: pixel ({x}, {y}) was hidden");
                hidden += 1;
                continue;
            }
            // Texels of the photograph that a pixel covers, and those that its own place may be off by: half of one by the
            // filter, and half by the photograph's own pixels.
            let to_photo = 0.5 * f64::from(SIZE) / (tangent * ahead(&case.from, hit.position));
            let magnification = hit.pixel_size * to_photo;
            let st = hit.in_map * 0.5 + 0.5;
            let place = [st.x, 1.0 - st.y].map(|share| share * f64::from(SIZE) - 0.5);
            // At the frame's edge and across a silhouette the photograph has other things, too.
            let [least, most] = extremes(&photo, place, 1.5 + 2.0 * magnification);
            // Pixels that one of the photograph covers here; decals are mixed over twice as many.
            let covered = 1.0 / (to_photo * pixel_width(&case.elsewhere, hit.position) * hit.cos_light.abs().max(0.02));
            let own = extremes(&direct, [f64::from(x), f64::from(y)], 1.0 + 2.0 * covered);
            for k in 0..3 {
                let contrast = f64::from(most[k] - least[k]).max(f64::from(own[1][k] - own[0][k]));
                let error = f64::from((picture[index][k] - direct[index][k]).abs());
                worst = worst.max(error - contrast);
                assert!(error <= 2.0 + contrast, "seed {seed}: pixel ({x}, {y}): {error} codes, contrast {contrast}");
            }
            shown += 1;
        }
    }
    println!("{shown} pixels shown, {hidden} hidden; at worst {worst} codes beyond the local contrast");
    assert!(shown > 30_000 && hidden > 5_000, "{shown} {hidden}");
}

/// Distance of a point along the camera's axis.
fn ahead(pose: &Pose, point: DVec3) -> f64 {
    (pose.target - pose.eye).normalize().dot(point - pose.eye)
}

/// Width of a pixel at a point, across the view.
fn pixel_width(pose: &Pose, point: DVec3) -> f64 {
    2.0 * (0.5 * pose.fov_y.to_radians()).tan() * ahead(pose, point) / f64::from(SIZE)
}

/// The least and the greatest codes of pixels around a place, by channel.
fn extremes(pixels: &[[i32; 3]], [x, y]: [f64; 2], reach: f64) -> [[i32; 3]; 2] {
    let last = f64::from(SIZE) - 1.0;
    let span = |at: f64| (at - reach).ceil().clamp(0.0, last) as usize..=(at + reach).floor().clamp(0.0, last) as usize;
    let mut found = [[255; 3], [0; 3]];
    for (x, y) in span(y).flat_map(|y| span(x).map(move |x| (x, y))) {
        let pixel = pixels[y * SIZE as usize + x];
        for k in 0..3 {
            found[0][k] = found[0][k].min(pixel[k]);
            found[1][k] = found[1][k].max(pixel[k]);
        }
    }
    found
}

#[test]
fn colours_are_those_of_the_ray_tracer() {
    let mut studio = Studio::new();
    let mut compared = 0;
    for seed in 40..64 {
        let case = case(&studio, seed);
        let photographed = case.direct(&studio, &case.from);
        let (path, _) = studio.take(&photographed, "photo.png");
        let mut random = Random::new(seed);
        let hidden = random.pick(&["smear", "grey", "leave"]);
        let filter = random.pick(&["nearest", "linear", "trilinear"]);
        let aspect = random.pick(&["", "aspect = 0.7, ", "aspect = 1.6, "]);
        let technique =
            random.pick(&["", "technique = \"midpoint\", ", "bias = \"receiver-plane\", ", "fit = \"view\", "]);
        let more = format!("{aspect}filter = \"{filter}\", hidden = \"{hidden}\", map = {{ {technique}size = 1024 }}");
        let scene = case.projected(&studio, &case.elsewhere, &path, &more);
        let picture = studio.draw(&scene);
        let truth = colors(&scene, Some(1024));
        let (known, wrong) = beyond(&truth, &picture, 2.0);
        println!("seed {seed}, {more}: {known} known, {} beyond the bounds", wrong.len());
        for pixel in wrong.iter().take(20) {
            println!("  pixel {pixel}: {:?} against {:?}", picture[*pixel], truth.pixels[*pixel].rgb);
        }
        assert!(wrong.is_empty(), "seed {seed}, {more}: {} pixels", wrong.len());
        compared += known;
    }
    assert!(compared > 200_000, "{compared}");
}
