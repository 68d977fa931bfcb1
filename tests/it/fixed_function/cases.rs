//! Every scene, and every case's scene with what the case sets, by both pipelines.

use std::collections::BTreeSet;
use std::path::PathBuf;

use glumbra::fixed_function::Inexpressible;
use glumbra::frame::Renderer;
use glumbra::plan::Request;
use glumbra::scene;

use super::pipelines::{Pipelines, compare};

/// Reasons for which a case's scene may be refused: features that no layer of fixed function computes, and no more.
const KNOWN_LIMITS: &[&str] = &[
    "beyond the light's far plane",
    "saturate",
    "more comparisons than one",
    "in a cube map",
    "tag in the stencil buffer",
    "volumes have no modelview",
    "a clip plane of the vertex stage",
    "waves in the vertex stage",
    "drawn once by a stencil test, of several numbers of layers",
    "a law of planar distance",
    "without perspective",
];

#[test]
fn scenes_and_cases_agree_per_vertex_or_say_why_not() {
    let mut pipelines = Pipelines::open();
    let (mut drawn, mut shadowed, mut refused) = (0, 0, 0);
    for (path, set) in cases() {
        let Ok(loaded) = glumbra::load(&path, &set) else { continue };
        let of_maps = |light: &scene::Light| {
            let technique = light.shadow.written().get("technique").map(|entry| format!("{:?}", entry.value));
            technique.is_none_or(|name| name.contains("\"shadow-map\"") || name.contains("\"none\""))
        };
        let request = Request { sampled_warnings: false, ..Request::default() };
        let plans = Renderer::plan(&mut pipelines.renderer, &loaded.scene, &request).is_ok();
        if !plans || !loaded.scene.lights.iter().all(of_maps) {
            continue;
        }
        let name = format!("{} {}", path.display(), set.join(" "));
        match compare(&mut pipelines, &loaded.scene, &name) {
            Ok(shadow) => {
                drawn += 1;
                shadowed += usize::from(shadow);
            }
            Err(all) => {
                refused += 1;
                let known = |each: &Inexpressible| KNOWN_LIMITS.iter().any(|limit| each.why.contains(limit));
                assert!(all.iter().all(known), "{name}: {all:#?}");
            }
        }
    }
    println!("{drawn} scenes drawn on both pipelines, {shadowed} of them with a shadow; {refused} refused");
    assert!(drawn >= 60 && shadowed >= 40, "{drawn} scenes were drawn, {shadowed} with a shadow");
}

/// Every scene, and every case's with what the case sets, lit per vertex; each once.
fn cases() -> BTreeSet<(PathBuf, Vec<String>)> {
    let mut found = BTreeSet::new();
    let mut add = |scene: PathBuf, set: &[String]| {
        let own = ["shading.lighting=per-vertex", "image.size=[192, 192]"].map(str::to_owned);
        found.insert((scene, [set, &own].concat()));
    };
    for path in files("data/scenes").into_iter().chain(files("data/cases/scenes")) {
        add(path, &[]);
    }
    for technique in ["none", "shadow-map", "slide-projector", "alpha-shadows"] {
        for folder in files(&format!("data/cases/{technique}")) {
            let text = std::fs::read_to_string(folder.join("case.toml")).unwrap();
            let case: toml::Table = text.parse().unwrap();
            let scene = folder.join(case.get("scene").map_or("scene.toml", |path| path.as_str().unwrap()));
            let own = case.get("set").map(strings).unwrap_or_default();
            for base in repeated(case.get("for_each"), &own) {
                add(scene.clone(), &base);
                for check in case.values().filter_map(toml::Value::as_array).flatten() {
                    let keys = ["set", "with"].into_iter().filter_map(|key| check.get(key)).map(strings);
                    let several = check.get("sets").and_then(toml::Value::as_array).into_iter().flatten().map(strings);
                    let sets: Vec<_> = keys.chain(several).chain([Vec::new()]).collect();
                    for base in repeated(check.get("for_each"), &base) {
                        sets.iter().for_each(|set| add(scene.clone(), &[base.clone(), set.clone()].concat()));
                    }
                }
            }
        }
    }
    found
}

/// `base` with each set of a `for_each`, or itself where there is none.
fn repeated(for_each: Option<&toml::Value>, base: &[String]) -> Vec<Vec<String>> {
    let Some(sets) = for_each else { return vec![base.to_vec()] };
    sets.as_array().into_iter().flatten().map(|set| [base, &strings(set)].concat()).collect()
}

fn strings(value: &toml::Value) -> Vec<String> {
    value.as_array().into_iter().flatten().filter_map(|each| each.as_str().map(str::to_owned)).collect()
}

/// Files of a folder, without pictures.
fn files(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.is_dir() || path.extension().is_some_and(|extension| extension == "toml")).collect()
}
