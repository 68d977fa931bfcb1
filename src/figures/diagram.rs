//! Diagrams that no scene shows: a kernel's weights, and the frames that a projected texture is seen in.

use super::painter::{Align, Painter, Pen, UnitPoint};
use crate::output::canvas::{Canvas, Color};
use crate::output::letters::{FontWeight, TextStyle};

const INK: Color = [40, 42, 50];
const FAINT: Color = [120, 124, 134];
const LIGHT: Color = [213, 94, 0];
const EYE: Color = [0, 114, 178];

/// A filter of a shadow map: `taps` by `taps` comparisons, one a texel apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kernel {
    pub taps: u32,
    /// Each comparison weighs four texels, as by GL_LINEAR.
    pub is_linear: bool,
}

impl Kernel {
    /// Weight of a texel along one axis, in texels: `distance` is that from the looked-up point to the texel's middle.
    ///
    /// Linear: the sum of hats of neighbouring comparisons is the length of the texel's part in a box of `taps` texels around
    /// the point. Nearest: each comparison has one texel.
    pub fn weight(self, distance: f64) -> f64 {
        let half = 0.5 * f64::from(self.taps);
        match self.is_linear {
            true => (half + 0.5 - distance.abs()).clamp(0.0, 1.0),
            false => f64::from(u8::from(distance.abs() < half)),
        }
    }
}

/// Draws a kernel in the lower left corner: texels as squares, dark by their weight, and the point that is looked up.
pub fn draw_kernel(painter: &mut Painter<'_>, kernel: Kernel) {
    const SIDE: f32 = 15.0;
    const POINT: [f64; 2] = [0.3, -0.2];
    let reach = (kernel.taps / 2 + 1) as i32;
    let cells = (2 * reach + 1) as f32;
    let [_, height] = painter.size();
    let (left, top) = (10.0 + 8.0, height - 10.0 - 8.0 - SIDE * cells);
    painter.fill([left - 8.0, top - 8.0], [SIDE * cells + 16.0; 2], [255, 255, 255]);
    for row in -reach..=reach {
        for column in -reach..=reach {
            let weight = kernel.weight(f64::from(column) - POINT[0]) * kernel.weight(f64::from(row) - POINT[1]);
            let shade = |dark: u8| (255.0 - weight * (255.0 - f64::from(dark))).round() as u8;
            let corner = [left + SIDE * (column + reach) as f32, top + SIDE * (row + reach) as f32];
            painter.fill(corner, [SIDE; 2], [205, 207, 212]);
            painter.fill([corner[0] + 0.5, corner[1] + 0.5], [SIDE - 1.0; 2], [shade(20), shade(90), shade(150)]);
        }
    }
    let middle = |offset: f64| SIDE * (reach as f32 + 0.5 + offset as f32);
    let point = [left + middle(POINT[0]), top + middle(POINT[1])];
    painter.disc(point, 3.6, [255, 255, 255]);
    painter.disc(point, 2.6, LIGHT);
}

/// Draws a legend into the darkest corner of `picture`, or the upper left one: dark is what nothing is drawn on.
pub fn draw_legend(painter: &mut Painter<'_>, picture: &Canvas, legend: &[(Color, String)]) {
    const EDGE: f32 = 4.0;
    const ROW: f32 = 14.5;
    let style = TextStyle { weight: FontWeight::Regular, size: 11.5, color: [234, 235, 238] };
    let widest = legend.iter().map(|(_, name)| painter.letters().width(&style, name)).fold(0.0, f32::max);
    let room = [widest + 36.0, ROW * legend.len() as f32 + 9.0];
    let [width, height] = painter.size();
    let (right, bottom) = (width - room[0] - EDGE, height - room[1] - EDGE);
    let corners = [[EDGE, EDGE], [right, EDGE], [EDGE, bottom], [right, bottom]];
    let pixels_a_unit = picture.size()[0] as f32 / width;
    let dark = |corner: &UnitPoint| {
        let [left, top, right, bottom] = [corner[0], corner[1], corner[0] + room[0], corner[1] + room[1]]
            .map(|side| (side * pixels_a_unit).max(0.0) as usize);
        let row = 3 * picture.size()[0] as usize;
        let pixels = (top..bottom).filter_map(|y| picture.bytes().get(y * row + 3 * left..y * row + 3 * right));
        pixels.flat_map(|row| row.as_chunks::<3>().0).filter(|color| color.iter().all(|channel| *channel < 50)).count()
    };
    // The first of the best.
    let [left, top] = corners.into_iter().rev().max_by_key(dark).unwrap_or([EDGE; 2]);
    painter.fill([left, top], room, [24, 26, 30]);
    for (index, (color, name)) in (0u8..).zip(legend) {
        let base = top + 4.0 + ROW * f32::from(index);
        painter.fill([left + 7.0, base + 2.0], [14.0, 10.5], *color);
        painter.write([left + 28.0, base + 11.5], &name.replace('-', "−"), &style, Align::Left);
    }
}

/// Draws a projected texture as the eye sees it [Segal 1992, Figure 1]: a point of an object, its place on the screen and its
/// place in the texture.
pub fn draw_geometry(painter: &mut Painter<'_>) {
    let [width, height] = painter.size();
    let at = |x: f32, y: f32| [x * width, y * height];
    let (eye, light, point) = (at(0.10, 0.80), at(0.40, 0.08), at(0.67, 0.62));
    draw_object(painter, point);
    frustum(painter, eye, [at(0.225, 0.42), at(0.29, 0.54), at(0.29, 0.96), at(0.225, 0.84)], EYE);
    frustum(painter, light, [at(0.365, 0.35), at(0.485, 0.265), at(0.635, 0.325), at(0.515, 0.41)], LIGHT);
    let thin = |color| Pen { color, width: 1.6, is_dashed: false };
    painter.line(&[eye, point], thin(EYE));
    painter.arrow(light, point, thin(LIGHT));
    let on = |from: UnitPoint, share: f32| [0, 1].map(|k| from[k] + share * (point[k] - from[k]));
    let (on_screen, on_texture) = (on(eye, 0.276), on(light, 0.478));
    for (place, color) in [(point, INK), (on_screen, EYE), (on_texture, LIGHT), (eye, EYE), (light, LIGHT)] {
        painter.disc(place, 5.0, [255, 255, 255]);
        painter.disc(place, 4.0, color);
    }
    label_geometry(painter, [eye, light, point, on_screen, on_texture]);
    draw_world(painter, at(0.085, 0.27));
}

/// A plane between an apex and what it looks at, and the edges to its corners.
fn frustum(painter: &mut Painter<'_>, apex: UnitPoint, corners: [UnitPoint; 4], color: Color) {
    painter.area(&corners, color, 0.13);
    for index in 0..4 {
        painter.line(&[apex, corners[index]], Pen { color: FAINT, width: 0.8, is_dashed: true });
        painter.line(&[corners[index], corners[(index + 1) % 4]], Pen { color, width: 1.6, is_dashed: false });
    }
}

/// A slanted surface around the point.
fn draw_object(painter: &mut Painter<'_>, [x, y]: UnitPoint) {
    let corners = [[x - 110.0, y + 42.0], [x + 42.0, y + 78.0], [x + 118.0, y - 40.0], [x - 34.0, y - 76.0]];
    painter.area(&corners, [150, 156, 168], 0.35);
    for index in 0..4 {
        painter.line(&[corners[index], corners[(index + 1) % 4]], Pen { color: FAINT, width: 1.2, is_dashed: false });
    }
}

fn label_geometry(painter: &mut Painter<'_>, [eye, light, point, on_screen, on_texture]: [UnitPoint; 5]) {
    let bold = |color| TextStyle { weight: FontWeight::SemiBold, size: 14.0, color };
    let plain = |color| TextStyle { weight: FontWeight::Regular, size: 13.0, color };
    let beside = |[x, y]: UnitPoint, right: f32, down: f32| [x + right, y + down];
    painter.write(beside(eye, 0.0, 24.0), "eye", &bold(EYE), Align::Middle);
    painter.write(beside(eye, 0.0, 41.0), "clip coordinates", &plain(EYE), Align::Middle);
    painter.write(beside(light, -12.0, 4.0), "light", &bold(LIGHT), Align::Right);
    painter.write(beside(light, -12.0, 21.0), "light coordinates", &plain(LIGHT), Align::Right);
    let side = 88.0;
    painter.write(beside(point, side, 44.0), "Q on the surface", &bold(INK), Align::Left);
    painter.write(beside(point, side, 62.0), "(x, y, z, w) of the eye", &plain(EYE), Align::Left);
    painter.write(beside(point, side, 80.0), "(xˡ, yˡ, zˡ, wˡ) of the light", &plain(LIGHT), Align::Left);
    painter.write(beside(on_screen, 38.0, 46.0), "screen", &bold(EYE), Align::Left);
    painter.write(beside(on_screen, 38.0, 63.0), "(x / w, y / w)", &plain(EYE), Align::Left);
    painter.write(beside(on_texture, 92.0, -12.0), "texture: the slide", &bold(LIGHT), Align::Left);
    painter.write(beside(on_texture, 92.0, 5.0), "(xˡ / wˡ, yˡ / wˡ)", &plain(LIGHT), Align::Left);
}

/// The axes of the world.
fn draw_world(painter: &mut Painter<'_>, origin: UnitPoint) {
    let pen = Pen { color: INK, width: 1.4, is_dashed: false };
    let style = TextStyle { weight: FontWeight::Regular, size: 13.0, color: INK };
    for (x, y, name) in [(36.0, 6.0, "x"), (0.0, -36.0, "y"), (-26.0, 13.0, "z")] {
        painter.arrow(origin, [origin[0] + x, origin[1] + y], pen);
        painter.write([origin[0] + 1.25 * x, origin[1] + 1.25 * y + 4.0], name, &style, Align::Middle);
    }
    painter.write([origin[0] + 14.0, origin[1] - 24.0], "world", &style, Align::Left);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A comparison by GL_LINEAR weighs texels by a hat; a kernel has `taps` of them, a texel apart around its point.
    #[test]
    fn a_kernel_weighs_as_its_comparisons_do_together() {
        for taps in 1..=7 {
            let kernel = Kernel { taps, is_linear: true };
            for point in [0.0, 0.13, 0.5, 0.87] {
                let mut sum = 0.0;
                for texel in -6..=6 {
                    let hat = |tap: u32| {
                        let place = point + f64::from(tap) - 0.5 * f64::from(taps - 1);
                        (1.0 - (f64::from(texel) - place).abs()).max(0.0)
                    };
                    let expected: f64 = (0..taps).map(hat).sum();
                    let found = kernel.weight(f64::from(texel) - point);
                    assert!(
                        (found - expected).abs() < 1e-12,
                        "{taps} taps at {point}, texel {texel}: {found}, {expected}"
                    );
                    sum += found;
                }
                assert!((sum - f64::from(taps)).abs() < 1e-12);
            }
        }
    }
}
