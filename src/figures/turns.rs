//! How far tangent bases turn across a model's edges, as bars: before its skin is packed again, and after.

use super::painter::{Align, Painter, Pen};
use super::skins;
use crate::geometry::skin::{self, CLASS_ENDS, Discontinuity, Skin};
use crate::output::canvas::Color;
use crate::output::letters::{FontWeight, TextStyle};
use crate::scene::Scene;

/// Colours of the skins.
const COLORS: [Color; 4] = [[140, 144, 154], [213, 94, 0], [0, 114, 178], [0, 130, 95]];
/// Their names.
const NAMES: [&str; 4] = ["(a) as it is", "(b) turned at random", "(c) that packed again", "(f) mirrored pieces apart"];

const INK: Color = [40, 42, 50];
const RULE: Color = [222, 223, 227];

/// Measures the first object with bumps: as it is, with the pieces of its skin turned at random, with those packed again, and
/// as it is but with mirrored pieces apart.
///
/// # Errors
///
/// A skin that cannot be packed.
pub fn measure(scene: &Scene) -> Result<Vec<Discontinuity>, skin::Error> {
    let found = scene.objects.iter().find_map(|object| {
        let size = object.material.as_deref()?.bump.as_ref()?.size();
        Some((&object.mesh, size, Skin::of_mesh(&object.mesh, size)?))
    });
    let Some((mesh, size, old)) = found else { return Ok(Vec::new()) };
    let again =
        |skin: &Skin, unmirror: bool| skin::repack(skin, &skins::options(unmirror)).map(|new| new.discontinuity);
    let mut all = vec![old.discontinuity()];
    let turned = skins::careless(mesh, size)?;
    if let Some(turned) = turned.and_then(|(mesh, size)| Skin::of_mesh(&mesh, size)) {
        all.extend([turned.discontinuity(), again(&turned, false)?]);
    }
    all.push(again(&old, true)?);
    Ok(all)
}

/// The measures in words.
pub fn in_words(all: &[Discontinuity]) -> String {
    let words = |measure: fn(&Discontinuity) -> String| all.iter().map(measure).collect::<Vec<_>>().join(", ");
    let mean = words(|own| format!("{:.1}°", own.mean_degrees));
    let mirrored = words(|own| format!("{:.1} %", 100.0 * own.mirrored_share));
    format!("mean angle {mean}; edges between a mirrored and a plain triangle {mirrored} of their length")
}

/// Draws a group of bars for each class of angles.
pub fn draw(painter: &mut Painter<'_>, all: &[Discontinuity]) {
    let style = TextStyle { weight: FontWeight::Regular, size: 12.0, color: INK };
    let [width, height] = painter.size();
    let (left, right, top, bottom) = (58.0, width - 16.0, 40.0, height - 46.0);
    let most =
        10.0 * (all.iter().flat_map(|own| own.classes).map(|class| 10.0 * class.share).fold(1.0, f64::max)).ceil();
    let level = |percent: f64| bottom - (percent / most) as f32 * (bottom - top);
    for percent in (0_u8..=100).step_by(20).map(f64::from).filter(|percent| *percent <= most) {
        let y = level(percent).round() + 0.5;
        painter.line(&[[left, y], [right, y]], Pen { color: RULE, width: 1.0, is_dashed: false });
        painter.write([left - 8.0, y + 4.0], &format!("{percent}"), &style, Align::Right);
    }
    let group = (right - left) / CLASS_ENDS.len() as f32;
    let bar = (0.21 * group).min(38.0);
    for (class, end) in CLASS_ENDS.into_iter().enumerate() {
        let middle = left + group * (class as f32 + 0.5);
        for (index, own) in all.iter().enumerate() {
            let percent = 100.0 * own.classes[class].share;
            let x = middle + bar * (index as f32 - 0.5 * all.len() as f32);
            painter.fill([x, level(percent)], [bar - 2.0, bottom - level(percent)], COLORS[index % COLORS.len()]);
            painter.write([x + 0.5 * bar - 1.0, level(percent) - 4.0], &format!("{percent:.0}"), &style, Align::Middle);
        }
        let start = class.checked_sub(1).map_or(0.0, |before| CLASS_ENDS[before]);
        painter.write([middle, bottom + 17.0], &format!("{start}° to {end}°"), &style, Align::Middle);
    }
    painter.line(&[[left, bottom + 0.5], [right, bottom + 0.5]], Pen { color: INK, width: 1.0, is_dashed: false });
    let middle = 0.5 * (left + right);
    painter.write(
        [middle, height - 10.0],
        "angle between the t axes of two triangles at an edge",
        &style,
        Align::Middle,
    );
    painter.write_turned([18.0, 0.5 * (top + bottom)], "% of the edges' length", &style, Align::Middle, true);
    let mut x = left;
    for (name, color) in NAMES.into_iter().zip(COLORS) {
        painter.fill([x, 12.0], [14.0, 10.0], color);
        painter.write([x + 20.0, 21.0], name, &style, Align::Left);
        x += 20.0 + painter.letters().width(&style, name) + 22.0;
    }
}
