//! A teapot by another renderer in GL, through `glumbra test`: it is right, and its planted faults are found.

use std::path::Path;

use super::{glumbra, text};
use crate::judge::other_renderer::renderer::{self, Faults};

#[test]
#[cfg(unix)]
fn another_renderers_faults_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/other_renderer/teapot.toml");
    for (name, faults) in [
        ("right", Faults::default()),
        ("no-bias", Faults { no_bias: true, ..Faults::default() }),
        ("turned", Faults { turned_degrees: 1.0, ..Faults::default() }),
    ] {
        let case = folder.path().join("all").join(name);
        std::fs::create_dir_all(&case).unwrap();
        renderer::draw(faults, &case.join("drawn.png")).unwrap();
        // Limits as of the judge's own test: twice what is found, and 0.01 %, 6 pixels, outside the band.
        let toml = format!(
            "asks = \"Is the teapot's shadow right?\"\nscene = {scene:?}\nrender = [\"cp\", \"drawn.png\", \"{{out}}\"]\n\
             [[truth]]\nfalse_shadow = 0.06\nleak = 0.04\noutside_band = 0.01\nedge = 0.1\nband = 2.0\nwhy = \"2048 texels\"\n"
        );
        std::fs::write(case.join("case.toml"), toml).unwrap();
    }
    let output = glumbra(folder.path(), &["all", "--verbose"]);
    let screen = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{screen}");
    assert_eq!(screen.lines().last(), Some("FAIL: no-bias, turned"), "{screen}");
    assert!(screen.contains("false_shadow may be 0.06 %") && screen.contains("edge may be 0.1 pixels"), "{screen}");
}
