//! Texts of a PNG that shows a scene.

use crate::png_file::PngTexts;
use crate::scene::{Light, Scene};
use crate::techniques::LightShadow;

/// Scene, changes to it, technique of each light, and driver.
pub fn scene_texts(path: &str, overrides: String, scene: &Scene, driver: &str) -> PngTexts {
    let technique = |light: &Light| LightShadow::of(&light.shadow).map_or("none", |shadow| shadow.technique.name());
    let techniques: Vec<&str> = scene.lights.iter().map(technique).collect();
    PngTexts::default()
        .with(PngTexts::SCENE, path)
        .with(PngTexts::OVERRIDES, overrides)
        .with(PngTexts::TECHNIQUE, techniques.join(", "))
        .with(PngTexts::DRIVER, driver)
}
