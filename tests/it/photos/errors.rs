//! Mistakes in a photograph's keys: one clear error, with file and line.

use super::*;

#[test]
fn wrong_keys_are_errors_with_their_line() {
    let studio = Studio::new();
    let path = studio.path("photo.png");
    smooth_decal(&mut Random::new(8)).save(&path).unwrap();
    let good = format!("image = {path:?}, eye = [0, 1, 5], target = [0, 0, 0], fov_y = 40.0");
    let without = |key: &str| {
        let kept = good.split(", ").collect::<Vec<_>>().join(", ");
        let at = kept.find(key).unwrap();
        let end = kept[at..].find(", ").filter(|_| key != "eye" && key != "target");
        let end = end.or_else(|| kept[at..].find("], ").map(|end| end + 1)).map_or(kept.len(), |end| at + end + 2);
        format!("{}{}", &kept[..at], &kept[end..]).trim_end_matches(", ").to_owned()
    };
    let cases = [
        (without("image"), "`object.material.photo.image` is missing: the photograph, a picture file"),
        (without("eye"), "`object.material.photo.eye` is missing: the place that the photograph was taken from"),
        (without("target"), "`object.material.photo.target` is missing: a point in the photograph's middle"),
        (without("fov_y"), "`object.material.photo.fov_y` is missing"),
        (good.replace("[0, 0, 0]", "[0, 1, 5]"), "`object.material.photo.target` must differ from `eye`"),
        (good.replace("40.0", "180.0"), "`object.material.photo.fov_y` must be above 1 and below 179 degrees"),
        (format!("{good}, up = [0, 1, 5]"), "`object.material.photo.up` must not be parallel"),
        (format!("{good}, aspect = 0.0"), "`object.material.photo.aspect` must be"),
        (format!("{good}, hidden = \"red\""), "`object.material.photo.hidden` "),
        (format!("{good}, filter = \"cubic\""), "`object.material.photo.filter` "),
        (format!("{good}, near = 2.0, far = 1.0"), "`object.material.photo.far` must be above `near`"),
        (format!("{good}, hiden = \"grey\""), "unknown key `hiden` in [object.material.photo]: did you mean `hidden`?"),
        (format!("{good}, map = {{ size = 0 }}"), "`object.material.photo.map.size` must be"),
        (format!("{good}, map = {{ sice = 9 }}"), "unknown key `sice` in [object.material.photo.map]"),
        (
            format!("{good}, map = {{ technique = \"shadow-volume\" }}"),
            "`object.material.photo.map.technique` needs a depth map that the shader looks up, and technique = \
             \"shadow-volume\" counts in the stencil buffer",
        ),
        (
            format!("{good}, map = {{ into = \"stencil\" }}"),
            "`object.material.photo.map.technique` needs a depth map that the shader looks up, and into = \"stencil\" counts",
        ),
        (
            format!("{good}, map = {{ dimming = 0.5 }}"),
            "`object.material.photo.map.dimming` is no key of a photograph's map, which lights nothing",
        ),
        (good.replace("photo.png", "nothing.png"), "nothing.png"),
    ];
    for (keys, expected) in cases {
        let text = format!("[[object]]\nmesh = \"quad\"\n\n\nmaterial = {{ photo = {{ {keys} }} }}\n");
        let error = studio.try_load(&text).map(|_| ()).expect_err(&keys).to_string();
        assert!(error.contains("scene.toml:5: "), "{keys}: {error}");
        assert!(error.contains(expected), "{keys}: {error}");
    }
    studio.load(&format!("[[object]]\nmesh = \"quad\"\nmaterial = {{ photo = {{ {good} }} }}\n"));
}
