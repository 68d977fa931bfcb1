//! Bump maps on the objects of random scenes: a quarter of the scenes has some. They are judged with the scene's other colours.

use fastrand::Rng;

/// Share of the objects without a material that get bumps, in scenes with bumps.
const SHARE: f64 = 0.7;

/// Sizes of the maps: of powers of two and others, lines, and a single texel.
const SIZES: [[u32; 2]; 6] = [[64, 64], [256, 128], [33, 20], [1, 16], [16, 1], [1, 1]];

/// Names of the pictures that bumps are made of.
pub const HILLS: [&str; 2] = ["hills.png", "deep-hills.png"];

/// The scene's text, where chance gives its objects bumps; and the sizes of [`HILLS`].
pub fn with_bumps(seed: u64, index: u64, toml: &str) -> (String, [[u32; 2]; 2]) {
    let mut rng = Rng::with_seed(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ index ^ 0x6275_6d70_7300);
    let sizes = [(); 2].map(|()| SIZES[rng.usize(0..SIZES.len())]);
    if rng.f64() >= 0.25 {
        return (toml.to_owned(), sizes);
    }
    // Passes and photographs of their own leave no room for three of bumps.
    let is_plain = !toml.contains("passes = \"") && !toml.contains("photo = {");
    let method = match rng.usize(0..4) {
        0 | 1 => "reference",
        2 if is_plain => "three-pass",
        _ => "one-pass",
    };
    let mut blocks = toml.split("\n[[object]]\n");
    let mut out = with_method(blocks.next().unwrap_or_default(), method, &mut rng);
    for block in blocks {
        out.push_str("\n[[object]]\n");
        out.push_str(block);
        // The meshes of files have no texture coordinates.
        if !block.contains("material = ") && !block.contains(".obj\"") && rng.f64() < SHARE {
            out.push_str(if block.ends_with('\n') { "" } else { "\n" });
            out.push_str(&material(&mut rng, method == "reference"));
        }
    }
    (out, sizes)
}

fn with_method(head: &str, method: &str, rng: &mut Rng) -> String {
    let normalize = ["", "normalize = \"exact\"\n", "normalize = { cube = 16, seamless = false }\n"][rng.usize(0..3)];
    let normalize = if method == "reference" { "" } else { normalize };
    let keys = format!("[shading]\nbump = \"{method}\"\n{normalize}");
    match head.contains("[shading]\n") {
        true => head.replacen("[shading]\n", &keys, 1),
        false => format!("{keys}\n{head}"),
    }
}

fn material(rng: &mut Rng, any_shininess: bool) -> String {
    let mut pick = |choices: &[&'static str]| choices[rng.usize(0..choices.len())];
    let keys = [
        pick(&["", ", difference = \"forward\""]),
        pick(&["", "", ", format = \"unorm8\""]),
        pick(&["", ", mipmaps = \"mean\""]),
        pick(&["", ", border = \"clamp\""]),
        pick(&["", "", ", basis = \"skewed\"", ", basis = \"per-polygon\""]),
    ];
    let (name, scale) = (pick(&HILLS), pick(&["1.0", "4.0", "-3.0", "0.0", "1e4"]));
    let shininess = if any_shininess { pick(&["8", "1", "40"]) } else { "8" };
    let specular = pick(&["", "specular = [0.4, 0.3, 0.2], "]);
    let texgen = pick(&["", "", "", "texgen = { s = [0.5, 0.1, 0.0, 0.2], t = [0.0, 0.3, 0.6, 0.0] }, "]);
    format!(
        "material = {{ {texgen}{specular}shininess = {shininess}, bump = {{ height = \"{name}\", scale = {scale}{} }} }}\n",
        keys.concat()
    )
}
