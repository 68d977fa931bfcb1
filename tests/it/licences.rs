//! Every dependency that is built here has a licence that deny.toml allows: what `cargo deny check licenses` says,
//! where that is not installed.

use std::process::Command;

#[test]
fn licences_of_the_dependencies_are_allowed() {
    let root = env!("CARGO_MANIFEST_DIR");
    let deny: toml::Table = std::fs::read_to_string(format!("{root}/deny.toml")).unwrap().parse().unwrap();
    let allowed: Vec<spdx::Licensee> = deny["licenses"]["allow"]
        .as_array()
        .unwrap()
        .iter()
        .map(|name| spdx::Licensee::parse(name.as_str().unwrap()).unwrap())
        .collect();
    let metadata = Command::new(env!("CARGO"))
        .args(["metadata", "--locked", "--format-version=1", "--filter-platform", "x86_64-unknown-linux-gnu"])
        .current_dir(root)
        .output()
        .unwrap();
    assert!(metadata.status.success(), "{}", String::from_utf8_lossy(&metadata.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&metadata.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 50, "cargo metadata names only {} packages", packages.len());
    let refused: Vec<String> = packages
        .iter()
        .filter_map(|package| {
            let name = package["name"].as_str().unwrap();
            let Some(licence) = package["license"].as_str() else { return Some(format!("{name}: none stated")) };
            let expression = spdx::Expression::parse_mode(licence, spdx::ParseMode::LAX).unwrap();
            let satisfied = expression.evaluate(|wanted| allowed.iter().any(|have| have.satisfies(wanted)));
            (!satisfied).then(|| format!("{name}: {licence}"))
        })
        .collect();
    assert!(refused.is_empty(), "deny.toml does not allow {refused:#?}");
}
