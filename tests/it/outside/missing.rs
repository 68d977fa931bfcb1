//! Whatever needs a cargo feature that is off says which one that is.
use glumbra::context::Choice;
use glumbra::prelude::*;

#[test]
fn files_name_their_features() {
    for feature in ["exr"] {
        let error = output::check_path(format!("a.{feature}").as_ref()).unwrap_err().to_string();
        assert!(error.contains(&format!("cargo feature `{feature}`")), "{error}");
    }
}

#[test]
fn a_window_names_its_feature() {
    let request = ContextRequest { choice: Choice::Window, ..ContextRequest::default() };
    let error = context::open(&request).err().expect("there is no window").to_string();
    assert!(error.contains("cargo feature `window`"), "{error}");
}

#[test]
fn casters_that_are_not_simplified_have_a_warning() {
    let light = LightBuilder::spot([-2.0, 5.0, 1.5], [0.0; 3], 50.0).shadow("shadow-map").set("shadow.casters", "texel");
    let objects = Scene::builder().light(light).object(ObjectBuilder::mesh("sphere")).object(ObjectBuilder::mesh("quad"));
    let plan = glumbra::plan::make(&objects.build().unwrap().scene, &Request::default()).unwrap();
    assert!(plan.warnings.iter().any(|warning| warning.contains("cargo feature `meshopt`")), "{:?}", plan.warnings);
}
