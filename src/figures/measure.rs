//! Numbers and marks of panels: wrong shares by the ray tracer, and differences of pictures. Knows pixels; no scene.

use glam::DVec3;

use crate::frame::ShadeImage;
use crate::judge::metrics::{self, Band, compare};
use crate::output::canvas::{Canvas, Color};
use crate::truth::{Answer, Truth};

/// Marks of wrong pixels: shadow where light belongs, and light where none belongs.
pub const FALSE_SHADOW: Color = [213, 94, 0];
pub const LEAK: Color = [0, 114, 178];
/// A leak that shading hides.
const HIDDEN_LEAK: Color = [168, 205, 230];
const SEAM: Color = [230, 60, 40];

/// Wrong pixels in percent of those compared, on surfaces whose visible side faces the light: on the others shading leaves no
/// light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Shadow where light belongs.
    pub false_shadow: f64,
    /// Light where none belongs.
    pub leak: f64,
}

impl Share {
    /// The wrong share of a picture's shade.
    ///
    /// # Errors
    ///
    /// Pictures that cannot be compared.
    pub fn of(truth: &Truth, shade: &ShadeImage) -> Result<Self, metrics::Error> {
        // The band does not enter these shares.
        let facing = compare(truth, shade, &Band { texels: 1.0, map_size: [1024; 2] })?.facing;
        Ok(Self { false_shadow: facing.false_shadow_percent, leak: facing.leak_percent })
    }

    /// Both together.
    pub fn wrong(&self) -> f64 {
        self.false_shadow + self.leak
    }

    /// As below a panel.
    pub fn in_words(&self) -> String {
        let percent = |share: f64| if share == 0.0 { "0".to_owned() } else { format!("{share:.2}") };
        let (lost, leak) = (percent(self.false_shadow), percent(self.leak));
        format!("wrong {} %: false shadow {lost} %, leak {leak} %", percent(self.wrong()))
    }
}

/// Differences of two pictures of one size, in codes of eight bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    pub most: u8,
    /// Pixels that differ by more than a code in any channel, in percent of all.
    pub percent: f64,
}

impl Apart {
    /// Compares two pictures.
    pub fn of(one: &Canvas, other: &Canvas) -> Self {
        let worst = |(a, b): (&Color, &Color)| (0..3).map(|k| a[k].abs_diff(b[k])).max().unwrap_or(0);
        let pairs = one.bytes().as_chunks::<3>().0.iter().zip(other.bytes().as_chunks::<3>().0);
        let (mut most, mut differing, mut all) = (0, 0_u32, 0_u32);
        for codes in pairs.map(worst) {
            most = most.max(codes);
            differing += u32::from(codes > 1);
            all += 1;
        }
        Self { most, percent: 100.0 * f64::from(differing) / f64::from(all.max(1)) }
    }

    /// As below a panel. `from`: name of the other picture.
    pub fn in_words(&self, from: &str) -> String {
        let Self { most, percent } = *self;
        match most {
            0 => format!("equal to {from} to the bit"),
            1 => format!("at most 1 code from {from}"),
            _ if percent < 0.1 => format!("at most {most} codes from {from}, over 1 in less than 0.1 % of pixels"),
            _ => format!("at most {most} codes from {from}, over 1 in {percent:.1} % of pixels"),
        }
    }
}

/// Absolute differences of two pictures, `gain` times as bright.
pub fn amplify(one: &Canvas, other: &Canvas, gain: u8) -> Canvas {
    let pairs = one.bytes().iter().zip(other.bytes());
    Canvas::of_bytes(one.size(), pairs.map(|(a, b)| a.abs_diff(*b).saturating_mul(gain)).collect())
}

/// Mean code of two pictures' channels where either differs from the colour of its upper left corner, which nothing covers.
pub fn brightness(one: &Canvas, other: &Canvas) -> [f64; 2] {
    let [first, second] = [one, other].map(|picture| picture.bytes().as_chunks::<3>().0);
    let is_drawn = |index: usize| first[index] != first[0] || second[index] != second[0];
    let drawn: Vec<usize> = (0..first.len().min(second.len())).filter(|index| is_drawn(*index)).collect();
    let mean = |pixels: &[Color]| {
        let sum: u32 = drawn.iter().flat_map(|index| pixels[*index]).map(u32::from).sum();
        f64::from(sum) / (3 * drawn.len()).max(1) as f64
    };
    [mean(first), mean(second)]
}

/// Correlation of two series, in [-1, 1]; 0 where one does not vary.
pub fn correlation(pairs: &[[f64; 2]]) -> f64 {
    let count = pairs.len().max(1) as f64;
    let mean = [0, 1].map(|k| pairs.iter().map(|pair| pair[k]).sum::<f64>() / count);
    let moment = |i: usize, k: usize| pairs.iter().map(|pair| (pair[i] - mean[i]) * (pair[k] - mean[k])).sum::<f64>();
    let spread = (moment(0, 0) * moment(1, 1)).sqrt();
    if spread > 0.0 { moment(0, 1) / spread } else { 0.0 }
}

/// Root mean square of the differences of two pictures of one size, in codes of eight bits.
pub fn difference(one: &Canvas, other: &Canvas) -> f64 {
    let squares = one.bytes().iter().zip(other.bytes()).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2));
    (squares.sum::<f64>() / one.bytes().len().max(1) as f64).sqrt()
}

/// The picture whose pixels are means of `samples` times `samples`.
pub fn average(picture: &Canvas, samples: u32) -> Canvas {
    let size = picture.size().map(|side| side / samples);
    let row = 3 * picture.size()[0] as usize;
    let mean = |x: u32, y: u32, channel: usize| {
        let corner = (y * samples) as usize * row + 3 * (x * samples) as usize + channel;
        let within = |index: u32| corner + (index / samples) as usize * row + 3 * (index % samples) as usize;
        let count = samples * samples;
        let sum: u32 = (0..count).map(|index| u32::from(picture.bytes()[within(index)])).sum();
        ((sum + count / 2) / count) as u8
    };
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let bytes = pixels.flat_map(|(x, y)| [0, 1, 2].map(|channel| mean(x, y, channel))).collect();
    Canvas::of_bytes(size, bytes)
}

/// `lit` where the ray tracer finds light, `dark` elsewhere.
pub fn compose(truth: &Truth, lit: &Canvas, dark: &Canvas) -> Canvas {
    let pixels = lit.bytes().as_chunks::<3>().0.iter().zip(dark.bytes().as_chunks::<3>().0).zip(&truth.pixels);
    let bytes = pixels.flat_map(|((lit, dark), pixel)| match pixel.lit_at_center {
        Some(false) => *dark,
        Some(true) | None => *lit,
    });
    Canvas::of_bytes(lit.size(), bytes.collect())
}

/// The picture, pale, with its wrong pixels in the colours of their kinds.
pub fn mark(truth: &Truth, shade: &ShadeImage, picture: &Canvas) -> Canvas {
    let pixels = picture.bytes().as_chunks::<3>().0.iter().zip(&truth.pixels).enumerate();
    let bytes = pixels.flat_map(|(index, (color, pixel))| {
        let is_lit = shade.shade.get(index).is_some_and(|shade| *shade >= 0.5);
        let is_drawn = shade.covered.get(index) == Some(&true);
        match pixel.answer {
            Answer::Lit if is_drawn && !is_lit => FALSE_SHADOW,
            Answer::Shadowed if is_drawn && is_lit => {
                if pixel.hit.is_some_and(|hit| hit.faces_light()) {
                    LEAK
                } else {
                    HIDDEN_LEAK
                }
            }
            _ => {
                let gray = color.iter().map(|channel| u32::from(*channel)).sum::<u32>() / 3;
                [(150 + gray * 2 / 5).min(255) as u8; 3]
            }
        }
    });
    Canvas::of_bytes(picture.size(), bytes.collect())
}

/// The picture with a line where neighbours are in different faces of a cube around `light`, and each face in a hue.
pub fn mark_faces(truth: &Truth, light: DVec3, picture: &Canvas) -> Canvas {
    const HUES: [Color; 6] =
        [[214, 110, 80], [240, 190, 80], [110, 180, 100], [90, 190, 190], [90, 130, 210], [180, 110, 190]];
    let width = truth.width as usize;
    let face = |index: usize| {
        let way = truth.pixels.get(index)?.hit?.position - light;
        let axis = (0..3).max_by(|a, b| way[*a].abs().total_cmp(&way[*b].abs()))?;
        Some(2 * axis + usize::from(way[axis] < 0.0))
    };
    let pixels = picture.bytes().as_chunks::<3>().0.iter().enumerate();
    let bytes = pixels.flat_map(|(index, color)| {
        let Some(own) = face(index) else { return *color };
        let differs = |other: usize| face(other).is_some_and(|other| other != own);
        if differs(index + 1) && (index + 1) % width != 0 || differs(index + width) {
            return SEAM;
        }
        std::array::from_fn(|k| {
            ((3 * u32::from(color[k]) * u32::from(HUES[own][k]) / 255 + u32::from(color[k])) / 3).min(255) as u8
        })
    });
    Canvas::of_bytes(picture.size(), bytes.collect())
}
