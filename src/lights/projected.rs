//! Notes on light that differs over a spotlight's cross-section and along its axis: tables that are not fine enough, and
//! coordinates that swim.

use super::Notes;
use crate::scene::{Falloff, Interpolation, Light, LightBeam, Scene, TableSteps};

/// Error of a map or a table between its texels, in codes of 1/255, above which there is a warning.
const FINE: f64 = 0.5;

/// Warns of what is not exact, and notes how laws of distance are tabulated.
pub fn note_projected(scene: &Scene, notes: &mut Notes) {
    for (index, light) in scene.lights.iter().enumerate() {
        let Some(spot) = light.spot() else { continue };
        if let Some(beam) = &spot.beam {
            note_beam(index, beam, spot.frustum.cone_radians.to_degrees(), brightest(light), notes);
        }
        if let Some(falloff) = &spot.falloff {
            note_falloff(index, falloff, [spot.frustum.near, spot.frustum.far], brightest(light), notes);
        }
        if spot.interpolation == Interpolation::Affine {
            notes.warnings.push(format!(
                "light {index}: interpolate = \"affine\": its image and its shadow swim: they are right at vertices alone. \
                 \"perspective\" is right"
            ));
        }
    }
}

/// The most that a white surface gets of a light: what a table is off by counts as much.
fn brightest(light: &Light) -> f64 {
    let [constant, ..] = light.attenuation();
    let color = light.diffuse.into_iter().chain(light.specular).fold(0.0, f32::max);
    if color == 0.0 { 0.0 } else { f64::from(color / constant) }
}

fn note_beam(index: usize, beam: &LightBeam, cone_degrees: f64, brightest: f64, notes: &mut Notes) {
    let (width, height, error) = (beam.map.width, beam.map.height, beam.map_error_codes);
    let why = format!("between texels it is off by at most {error:.2} codes");
    notes.chosen(format!("beam of light {index}"), format!("a map of {width}x{height}"), why);
    let error = (error * brightest).min(255.0);
    if error >= FINE {
        notes.warnings.push(format!(
            "light {index}: its beam is off by up to {error:.1} codes of 255 between the {width}x{height} texels of its map: \
             the intensity changes too fast over its cross-section (cone {cone_degrees:.0} degrees). A narrower cone, a \
             smoother profile or a weaker lens has less"
        ));
    }
}

fn note_falloff(index: usize, falloff: &Falloff, [near, far]: [f64; 2], brightest: f64, notes: &mut Notes) {
    let table = &falloff.table;
    let (count, error) = (table.values.len(), table.error_codes);
    let choice = match table.steps {
        TableSteps::Depth => format!("{count} steps even in window depth"),
        TableSteps::Distance => format!("{count} steps even in distance"),
        TableSteps::Logarithm => format!("{count} steps even in the logarithm of distance"),
        TableSteps::Entries => format!("its own {} entries, searched for each fragment", count / 2),
    };
    let why = match table.steps {
        TableSteps::Entries => String::from("it bends too sharply for even steps"),
        _ => format!("off by at most {error:.2} codes between them"),
    };
    notes.chosen(format!("falloff of light {index}"), choice, why);
    let error = (error * brightest).min(255.0);
    if error >= FINE {
        notes.warnings.push(format!(
            "light {index}: its falloff is off by up to {error:.1} codes of 255 between {count} steps from near = {near:e} to \
             far = {far:e}: a near plane farther away has less"
        ));
    }
}
