//! Reports of projected light as a user runs them: slide projectors, lenses, dusty air; colours, sweeps, claims.

use std::path::PathBuf;
use std::process::Command;

use glumbra::context::ContextRequest;
use glumbra::report::measure::grid::Grid;
use glumbra::report::measure::run::{self, MeasureOptions};
use glumbra::report::store::claimed::ClaimVerdict;
use glumbra::report::store::merge;
use glumbra::report::store::results::{Report, SceneReport};
use glumbra::report::store::swept::{LightSweep, SweepSeries};
use image::{Rgb, RgbImage};

const GLUMBRA: &str = env!("CARGO_BIN_EXE_glumbra");

const IMAGE: &str = "[image]\nsize = [96, 72]\nbackground = [0, 0, 0]\n[camera]\neye = [2.6, 2.2, 3.4]\ntarget = [0.0, 0.4, 0.0]\n\
     fov_y = 40.0\nnear = 0.5\nfar = 12.0\n";

const OBJECTS: &str = "[[object]]\nmesh = \"quad\"\nscale = [3.0, 1.0, 3.0]\nmaterial = { diffuse = [0.8, 0.8, 0.8] }\n\
     [[object]]\nmesh = \"box\"\nscale = 0.4\ntranslate = [0.0, 0.6, 0.0]\n";

/// A light without `more`, which ends in its tables.
fn scene(before: &str, more: &str) -> String {
    format!(
        "{IMAGE}{before}[[light]]\nkind = \"spot\"\nshape = \"frustum\"\nposition = [1.0, 3.2, 1.6]\ntarget = [0.0, 0.3, 0.0]\n\
         cone = 46.0\nnear = 0.5\nfar = 8.0\n{more}{OBJECTS}"
    )
}

fn slide() -> String {
    let passes = "[shading]\npasses = \"slide\"\nambient = [0.2, 0.2, 0.2]\n";
    scene(passes, "image = \"slide.png\"\nlaw = \"slide\"\n[light.shadow]\ntechnique = \"none\"\n")
}

/// A folder with a scene and a slide of 20 texels a side, which stand far apart in the picture.
struct Work {
    folder: tempfile::TempDir,
}

impl Work {
    fn new(scene: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
        let code = |x: u32, y: u32| if (x / 2 + y / 2).is_multiple_of(2) { 230 } else { 20 };
        let slide = RgbImage::from_fn(20, 20, |x, y| Rgb([code(x, y), code(x, 0), 120]));
        slide.save(folder.path().join("slide.png")).unwrap();
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, arguments: &[&str]) -> (Option<i32>, String, String) {
        let output =
            Command::new(GLUMBRA).current_dir(self.folder.path()).arg("report").args(arguments).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code(), text(output.stdout), text(output.stderr))
    }

    /// Reports the scene in few settings, and what was printed.
    fn report(&self) -> (SceneReport, String) {
        let (code, out, error) = self.run(&["scene.toml", "--quick", "--runs", "1", "-o", "out"]);
        assert_eq!(code, Some(0), "{error}");
        (self.load("out").scenes.remove(0), out)
    }

    fn load(&self, folder: &str) -> Report {
        merge::load(&self.path(folder)).unwrap()
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }
}

fn sweep<'a>(scene: &'a SceneReport, name: &str) -> &'a LightSweep {
    scene.sweeps.iter().find(|sweep| sweep.name == name).unwrap_or_else(|| panic!("no sweep of {name}"))
}

/// RMSE of each point.
fn errors(series: &SweepSeries) -> Vec<f64> {
    series.points.iter().map(|point| point.measured().unwrap().errors.rmse_codes).collect()
}

/// A slide projector has no shade to compare; its report has colours all the same, and no shadow settings.
#[test]
fn a_slide_projector_is_measured_by_its_colours() {
    let work = Work::new(&slide());
    let (scene, out) = work.report();
    assert!(scene.unshaded.as_ref().is_some_and(|why| why.contains("casts no shadow")), "{:?}", scene.unshaded);
    assert_eq!(scene.rows.len(), 1);
    let row = scene.rows[0].measured().unwrap();
    assert_eq!(row.metrics.all.compared, 0);
    let colors = row.colors.unwrap();
    // Against colours in f64: no pixel is beyond what the error of a sample explains.
    assert!(scene.colors_from.as_ref().is_some_and(|from| from.contains("in f64")), "{:?}", scene.colors_from);
    assert!(colors.compared > 5000 && colors.rmse_codes < 4.0 && colors.beyond_percent < 0.1, "{colors:?}");
    assert!(colors.flip.is_some_and(|flip| flip < 0.05), "{colors:?}");
    assert!(out.contains("No setting is named: a slide projector casts no shadow"), "{out}");
    // The slide's texels are several pixels wide: the squares of the nearest filter are the larger error.
    let filters = &sweep(&scene, "image filters").series[0];
    let [nearest, linear, trilinear] = errors(filters)[..] else { panic!("{filters:?}") };
    assert!(nearest > 1.5 * linear && (linear - trilinear).abs() < 0.5 * linear, "{nearest} {linear} {trilinear}");
    let page = work.read("out/report.html");
    for part in ["FLIP 0.25 and more", "Sweep: image filters", "colour: FLIP", "The colours to compare with"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("false shadow in blue") && !page.contains("There is no row to plot"));
    assert_eq!(work.read("out/sweeps.csv").lines().count(), 1 + 3);
    assert!(work.read("out/report.csv").lines().next().unwrap().contains("color_flip"));
    let plots: Vec<String> =
        ["rmse", "flip"].map(|kind| format!("out/plots/1-scene-image_filters-{kind}-against-time.svg")).into();
    assert!(plots.iter().all(|plot| work.read(plot).contains("nearest")));
}

/// Merged parts have the sweeps, and the pictures of projected light.
#[test]
fn a_merged_report_keeps_what_the_first_part_measured() {
    let work = Work::new(&slide());
    let (whole, _) = work.report();
    let (code, _, error) = work.run(&["merge", "out", "-o", "merged"]);
    assert_eq!(code, Some(0), "{error}");
    let merged = work.load("merged").scenes.remove(0);
    assert_eq!(merged.sweeps, whole.sweeps);
    let pictures = |page: &str| work.read(page).matches("data:image/png;base64,").count();
    // As written, to compare with, FLIP of it; of the sweep the reference, one drawn, three of FLIP.
    assert_eq!((pictures("out/report.html"), pictures("merged/report.html")), (8, 8));
}

#[test]
fn a_grid_of_shadows_is_refused_where_there_is_none() {
    let work = Work::new(&slide());
    std::fs::write(work.path("grid.toml"), "[[sweep]]\ntechnique = \"shadow-map\"\n").unwrap();
    let (code, _, error) = work.run(&["scene.toml", "--grid", "grid.toml", "-o", "out"]);
    assert_eq!(code, Some(1));
    assert!(error.contains("light 0 has no [light.shadow] to sweep") && error.contains("leave out --grid"), "{error}");
    assert!(!work.path("out").exists());
}

/// Errors fall with the number of lens points by the law of accumulation; kernels of percentage-closer filtering do not come
/// near, because their width knows nothing of the distance from caster to receiver.
#[test]
fn lens_points_come_near_to_an_area_light_and_kernels_do_not() {
    let focus = "focus = { distance = 3.4, radius = 0.25, samples = 16 }\n";
    let work = Work::new(&scene("", &format!("{focus}[light.shadow]\ntechnique = \"shadow-map\"\nsize = 256\n")));
    let (scene, out) = work.report();
    let lens = sweep(&scene, "lens points");
    let [points, kernels] = &lens.series[..] else { panic!("{lens:?}") };
    let falling = errors(points);
    assert!(falling.windows(2).all(|pair| pair[1] < 0.7 * pair[0]), "{falling:?}");
    let fit = points.fit.unwrap();
    assert!(fit.exponent > 0.45 && fit.exponent < 1.1 && fit.points == 4, "{fit:?}");
    assert!(out.contains("lens points: RMSE ∝ count^-") && out.contains("95 % range"), "{out}");
    let least = errors(kernels).into_iter().fold(f64::INFINITY, f64::min);
    assert!(kernels.points.len() == 4 && least > 2.0 * falling[2], "{least} {falling:?}");
    let claims: Vec<_> = scene.claims.iter().filter(|claim| claim.technique == "percentage-closer filtering").collect();
    assert_eq!(claims.len(), 2);
    assert_eq!((claims[1].verdict, claims[1].second.value), (ClaimVerdict::Holds, Some(falling[2])));
    // Claims of shadow techniques are about the light from one point.
    assert!(!out.contains("second-depth"), "{out}");
}

/// Bands fall as one over the number of slices, towards the air marched in f64.
#[test]
fn slices_of_dust_come_near_to_the_air_in_f64() {
    let dust = "color = [1.0, 0.9, 0.8]\n[light.dust]\ndensity = 0.3\nslices = 32\n";
    let work = Work::new(&scene("", &format!("{dust}[light.shadow]\ntechnique = \"shadow-map\"\nsize = 512\n")));
    let (scene, _) = work.report();
    let sweep = sweep(&scene, "slices of dust");
    let [plain, jitter] = &sweep.series[..] else { panic!("{sweep:?}") };
    let fit = plain.fit.unwrap();
    assert!(fit.exponent > 0.7 && fit.exponent < 1.3, "{fit:?}");
    assert!(jitter.fit.is_some());
    let second: Vec<f64> =
        plain.points.iter().map(|point| point.measured().unwrap().second.unwrap().rmse_codes).collect();
    // What remains is the map's: shadow edges in the air to a texel, its offset, and the border of the beam.
    assert!(second[0] > 2.0 * second[3] && second[3] < 3.0, "{second:?}");
    // Shadow techniques are compared as ever, where they go with dust.
    assert!(scene.rows.len() > 3 && scene.rows[0].measured().unwrap().metrics.all.compared > 1000);
}

/// Noise has no colour of its own, and thousands of lens points take the ray tracer too long: both are compared with pictures
/// of many samples, and it is said.
#[test]
fn what_the_ray_tracer_leaves_is_compared_with_a_drawn_picture() {
    let from = |more: &str| {
        let work = Work::new(&scene("", more));
        let options = MeasureOptions {
            light: 0,
            runs: 1,
            jobs: 1,
            shard: (1, 1),
            band_texels: 2.0,
            context: ContextRequest::default(),
        };
        let sweep = run::prepare(&work.path("scene.toml"), &[], &Grid::Own(Vec::new()), &options).unwrap();
        (sweep.report.colors_from.clone().unwrap(), sweep)
    };
    let shadow = "[light.shadow]\ntechnique = \"none\"\n";
    let (noise, sweep) = from(&format!("[light.dust]\ndensity = 0.3\nslices = 16\njitter = true\n{shadow}"));
    assert!(noise.contains("4096 slices of dust, because") && noise.contains("jitter"), "{noise}");
    assert_eq!(sweep.scene.lights[0].dust.unwrap().slices, 16, "the scene is as written");
    let (many, _) = from(&format!("focus = {{ distance = 3.0, radius = 0.2, samples = 4096 }}\n{shadow}"));
    assert!(many.contains("4096 lens points, because") && many.contains("more than 16777216 samples"), "{many}");
    let (few, _) = from(&format!("focus = {{ distance = 3.0, radius = 0.2, samples = 8 }}\n{shadow}"));
    assert!(few.contains("in f64") && few.contains("the scene's own lens points"), "{few}");
}

/// A verdict on times follows from the range of their ratio, and is of this machine.
#[test]
fn claims_about_times_have_ranges_and_verdicts() {
    let work = Work::new(&scene("", "image = \"slide.png\"\n[light.shadow]\ntechnique = \"shadow-map\"\nsize = 512\n"));
    let (scene, out) = work.report();
    let timed: Vec<_> = scene.claims.iter().filter(|claim| claim.ratio_range.is_some()).collect();
    // Projecting and copying; copies of unequal precision, twice; counting in two draws.
    assert_eq!(timed.len(), 5, "{out}");
    for claim in timed {
        let [least, greatest] = claim.ratio_range.unwrap();
        assert!(0.0 < least && least <= greatest && claim.first.value.unwrap() > 0.0, "{claim}");
        let more = claim.relation == "more than";
        // On a busy machine a range may lie on both sides.
        let verdict = match (least > 1.0, greatest <= 1.1) {
            (false, false) => ClaimVerdict::Unknown,
            (is_more, _) if is_more == more => ClaimVerdict::Holds,
            _ => ClaimVerdict::FailsHere,
        };
        assert_eq!(claim.verdict, verdict, "{claim}");
        assert!(out.contains("95 % range"), "{out}");
    }
}

/// Without projected light nothing of it is measured.
#[test]
fn a_plain_light_has_no_sweeps_of_projected_light() {
    let work = Work::new(&scene("", "[light.shadow]\ntechnique = \"none\"\n"));
    std::fs::create_dir(work.path("out")).unwrap();
    std::fs::write(work.path("out/sweeps.csv"), "of an older report").unwrap();
    let (scene, _) = work.report();
    assert!(scene.sweeps.is_empty() && scene.colors_from.is_none());
    assert!(scene.rows[0].measured().unwrap().colors.is_none());
    assert!(!work.path("out/sweeps.csv").exists());
    assert!(!work.read("out/report.html").contains("<h3>Colours</h3>"));
}
