//! Photographs in every composition: where a photograph decides the colour, lights change nothing; elsewhere the picture is
//! that without photographs.

use super::*;

const SIZE: [u32; 2] = [120, 90];

/// Lit objects under `lights`; each text lacks the end of its material.
fn lit_objects(random: &mut Random) -> Vec<String> {
    let mut objects =
        vec![String::from("mesh = \"quad\"\nscale = [3.0, 1.0, 3.0]\nmaterial = { diffuse = [0.7, 0.6, 0.5], ")];
    for _ in 0..3 {
        let mesh = random.pick(&["box", "sphere", "torus"]);
        let at = random.vector() * DVec3::new(1.6, 0.0, 1.6) + DVec3::Y * 0.8;
        objects.push(format!(
            "mesh = \"{mesh}\"\ntranslate = {}\nrotate = {{ axis = {}, angle = 40.0 }}\nscale = 0.6\n\
             material = {{ diffuse = [0.3, 0.7, 0.9], specular = [0.4, 0.4, 0.4], ",
            vector(at),
            vector(random.vector())
        ));
    }
    objects
}

fn spot(position: &str, more: &str, shadow: &str) -> String {
    format!(
        "[[light]]\nposition = {position}\ntarget = [0.0, 0.3, 0.0]\ncone = 70.0\ncolor = [0.5, 0.4, 0.4]\n{more}\n\
         [light.shadow]\n{shadow}\n"
    )
}

#[test]
fn lights_of_every_composition_leave_photographs_alone() {
    let mut studio = Studio::new();
    let path = studio.path("photo.png");
    smooth_decal(&mut Random::new(3)).save(&path).unwrap();
    let map = "technique = \"shadow-map\"\nsize = 512";
    let volume = "technique = \"shadow-volume\"";
    let one = |shadow: &str| spot("[1.5, 4.0, 2.0]", "", shadow);
    let both = |first: &str, second: &str| one(first) + &spot("[-2.5, 3.0, 1.0]", "", second);
    let many: String = (0..11).map(|k| spot(&format!("[{k}.5, 6.0, -4.0]"), "specular = [0, 0, 0]", map)).collect();
    let slide = |color: &str| {
        format!(
            "[[light]]\nposition = [1.5, 4.0, 2.0]\ntarget = [0.0, 0.3, 0.0]\ncone = 60.0\nlaw = \"slide\"\n\
             image = {path:?}\ncolor = {color}\n"
        )
    };
    let slides = slide("[0.9, 0.9, 0.9]") + &slide("[0.5, 0.5, 0.5]");
    let focused = spot("[1.5, 4.0, 2.0]", "focus = { distance = 4.0, radius = 0.1, samples = 4 }", map);
    let cases: [(&str, &str, String); 12] = [
        ("no light", "", String::new()),
        ("one map", "", one(map)),
        ("no shadow", "", one("")),
        ("per vertex", "lighting = \"per-vertex\"", both(map, map)),
        ("volumes", "", both(volume, map)),
        ("a tag", "", both("technique = \"shadow-map\"\ninto = \"stencil\"", "")),
        ("volumes per vertex", "lighting = \"per-vertex\"", one(volume)),
        ("eleven lights", "", many),
        ("shadows in alpha", "passes = \"shadow\"", both(map, map)),
        ("slides", "passes = \"slide\"", slides.clone()),
        ("slides on an ambient background", "passes = \"slide\"\nbackground = \"ambient\"", slides),
        ("a lens", "", focused),
    ];
    for (number, (name, shading, lights)) in cases.into_iter().enumerate() {
        let mut random = Random::new(number as u64);
        let objects = lit_objects(&mut random);
        let (from, camera) = (generated_pose(&mut random), generated_pose(&mut random));
        let text = |photo: &str| {
            let text = scene_text(SIZE, &camera, &objects, photo);
            text.replace("ambient = [1.0, 1.0, 1.0]", &format!("ambient = [0.2, 0.2, 0.2]\n{shading}")) + &lights
        };
        let photo = |hidden: &str| from.photo(&path, &format!("hidden = \"{hidden}\", map = {{ size = 512 }}"));
        let mut pictures = |photo: &str| {
            let scene = studio.load(&text(photo));
            let all = glumbra::plan::Request { keep_all: true, ..Request::default() };
            let picture = studio.draw(&scene);
            let kept = studio.draw_as(&scene, &all);
            // A product or a sum in other passes is rounded by a code each.
            let apart = |a: &[i32; 3], b: &[i32; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).max().unwrap_or(0);
            let most = picture.iter().zip(&kept).map(|(a, b)| apart(a, b)).max().unwrap_or(0);
            assert!(most <= 1, "{name}: what is left out changes {most} codes");
            picture
        };
        let (plain, left, grey, smeared) =
            (pictures(""), pictures(&photo("leave")), pictures(&photo("grey")), pictures(&photo("smear")));
        let [mut shown, mut hidden, mut background] = [0; 3];
        for pixel in 0..plain.len() {
            // Grey tells the two apart: no photograph here has that very colour, and no light makes it.
            match grey[pixel] {
                GREY => {
                    assert_eq!(left[pixel], plain[pixel], "{name}: pixel {pixel} is hidden from the photograph");
                    hidden += 1;
                }
                own if own == plain[pixel] && left[pixel] == own && smeared[pixel] == own => background += 1,
                own => {
                    assert_eq!(own, left[pixel], "{name}: pixel {pixel} shows the photograph");
                    assert_eq!(own, smeared[pixel], "{name}: pixel {pixel} shows the photograph");
                    shown += 1;
                }
            }
        }
        println!("{name}: {shown} pixels shown, {hidden} hidden, {background} without a surface");
        assert!(shown > 500 && hidden > 500, "{name}: {shown} {hidden}");
    }
}

#[test]
fn a_photograph_is_the_same_in_the_light_of_any_lamp() {
    let mut studio = Studio::new();
    let path = studio.path("photo.png");
    smooth_decal(&mut Random::new(4)).save(&path).unwrap();
    let mut random = Random::new(9);
    let objects = lit_objects(&mut random);
    let (from, camera) = (generated_pose(&mut random), generated_pose(&mut random));
    let text = scene_text(SIZE, &camera, &objects, &from.photo(&path, "hidden = \"grey\""));
    let dark = studio.load(&text);
    let lit = studio.load(&(text + &spot("[1.5, 4.0, 2.0]", "", "technique = \"shadow-map\"")));
    assert_eq!(studio.draw(&dark), studio.draw(&lit));
}
