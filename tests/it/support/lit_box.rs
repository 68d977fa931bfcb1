//! A small scene that loads and draws at once.

/// A box on a floor in a spotlight, 96 × 96 pixels.
pub const SCENE: &str = r#"
[image]
size = [96, 96]
[camera]
eye = [3.0, 2.5, 4.0]
target = [0.0, 0.6, 0.0]
[[light]]
kind = "spot"
position = [2.0, 4.0, 3.0]
target = [0.0, 0.5, 0.0]
cone = 60.0
near = 0.5
far = 20.0
[light.shadow]
technique = "shadow-map"
size = 256
[[object]]
mesh = "quad"
scale = [4.0, 1.0, 4.0]
[[object]]
mesh = "box"
scale = 0.5
translate = [0.0, 0.7, 0.0]
"#;
