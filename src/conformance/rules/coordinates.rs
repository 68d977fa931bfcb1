//! GL-T2 to GL-T4: the division by q, interpolation, and a surface's shadow on itself [GL 4.6, 14.6.1, 15.2.2].

use super::planes;
use crate::conformance::bench::{
    Error, GlCompare, GlDraw, GlFormat, GlImage, GlOffset, GlState, Sampling, Shader, Vertex, full, triangle,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings, RuleVerdict};

const PROJECTED: &str = "result = vec4(compare_proj(texelFetch(inputs, ivec2(gl_FragCoord.xy), 0)));";
const DIVIDED: &str = "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(compare(at.xyz / at.w));";

/// Texels along a side of GL-T2's map.
const SIDE: usize = 16;

/// GL-T2: projective look-ups against a division of one's own, and both against the verifier.
pub fn division(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut random = Random::new(2);
    let depths: Vec<f32> = (0..SIDE * SIDE).map(|_| random.unit()).collect();
    let inputs: Vec<[f32; 4]> = (0..4096)
        .map(|_| {
            let q = random.between(0.1, 9.0);
            [random.unit() * q, random.unit() * q, random.unit() * q, q]
        })
        .collect();
    let image = subject.bench.depth_image(GlFormat::Depth24, [SIDE as u32; 2], &[&depths])?;
    let stored = subject.bench.image_depths(&image)?;
    for (name, sampling) in [
        ("NEAREST", Sampling::compare(GlCompare::LessEqual)),
        ("LINEAR", Sampling::compare_linear(GlCompare::LessEqual)),
    ] {
        let images = [("shadow", &image, sampling)];
        let projected = subject.bench.map(PROJECTED, &inputs, &images)?;
        let divided = subject.bench.map(DIVIDED, &inputs, &images)?;
        let mut tally = GradeTally::default();
        for (input, (projected, divided)) in inputs.iter().zip(projected.iter().zip(&divided)) {
            let grade = texel_grade(f64::from(projected[0]), *input, &stored, sampling.linear);
            tally.add(grade, f64::from(projected[0] - divided[0]));
        }
        findings.tally(format!("{name}: textureProj"), tally, "of a division in the shader");
    }
    findings.part(|findings| fixed(subject, findings));
    Ok(())
}

fn fixed(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    crate::conformance::rules::fixed::division(subject, findings)
}

/// Tests whether `value` is what the map gives at `s/q, t/q` against `r/q`.
pub(super) fn texel_grade(value: f64, [s, t, r, q]: [f32; 4], stored: &[f64], linear: bool) -> Grade {
    let [s, t, r] = [s, t, r].map(|coordinate| f64::from(coordinate) / f64::from(q));
    let place = |coordinate: f64| coordinate * SIDE as f64 - if linear { 0.5 } else { 0.0 };
    let [u, v] = [place(s), place(t)];
    let texel = |x: f64, y: f64| {
        let [x, y] = [x, y].map(|index| index.clamp(0.0, SIDE as f64 - 1.0) as usize);
        stored[y * SIDE + x]
    };
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let depths = corners.map(|[dx, dy]| texel(u.floor() + dx, v.floor() + dy));
    if depths.iter().any(|depth| (depth - r).abs() < verify::NEAR_TIE) {
        return Grade::Good;
    }
    let passes = depths.map(|depth| r <= depth);
    if linear {
        return verify::filtered(value, passes, [u - u.floor(), v - v.floor()]);
    }
    // Within 2^-7 of a texel's edge the neighbour may be meant.
    let edge = [u, v].iter().any(|place| (place - place.round()).abs() < 1.0 / 128.0);
    if edge {
        verify::within(value - 0.5, 0.5, 0.5)
    } else {
        verify::within(value - f64::from(u8::from(passes[0])), 0.0, 0.0)
    }
}

/// GL-T3: varyings with perspective, depth without, and what gl_FragCoord.z says.
pub fn interpolation(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    findings.part(|findings| varyings(subject, findings));
    findings.part(|findings| fragment_depth(subject, findings));
    planes::near_origin(subject, findings);
    findings.part(|findings| planes::far_from_origin(subject, findings));
    Ok(())
}

/// Clip coordinates with w of 1, 2 and 4.
const IN_DEPTH: [[f32; 4]; 3] = [[-1.0, -1.0, 0.0, 1.0], [2.0, -2.0, 1.0, 2.0], [-2.0, 4.0, 3.0, 4.0]];

fn varyings(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const SIZE: u32 = 32;
    let surface = subject.bench.surface([SIZE; 2], Some(GlFormat::Rgba32F), None)?;
    surface.clear_color([-1.0; 4]);
    let mut vertices = triangle(IN_DEPTH);
    for (index, vertex) in vertices.iter_mut().enumerate() {
        vertex.value[index] = 1.0;
    }
    subject.bench.draw(&GlDraw::plain(&surface, GlState { depth: None, ..GlState::WRITE }, &vertices))?;
    let corners = planes::window(IN_DEPTH, [0.0, 0.0], f64::from(SIZE));
    let mut tally = GradeTally::default();
    for (index, value) in surface.floats().iter().enumerate().filter(|(_, value)| value[0] >= 0.0) {
        let [x, y] = [index as u32 % SIZE, index as u32 / SIZE].map(|place| f64::from(place) + 0.5);
        let ideal = planes::perspective_weights(corners, IN_DEPTH, [x, y]);
        let off = (0..3).map(|corner| (f64::from(value[corner]) - ideal[corner]).abs()).fold(0.0, f64::max);
        // A weight changes by at most about 1/8 a pixel here; one sub-pixel of that is allowed.
        let subpixel = f64::from(-(subject.bench.subpixel_bits() as i32)).exp2();
        tally.add(verify::within(off, 1.0 / 65536.0, subpixel / 8.0 + 1.0 / 65536.0), off * 65536.0);
    }
    findings.tally("varyings with perspective", tally, "of 2^-16");
    Ok(())
}

fn fragment_depth(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([64; 2], Some(GlFormat::Rgba32F), Some(GlFormat::Depth32F))?;
    surface.clear_depth(0.0);
    surface.clear_color([0.0; 4]);
    let shader = Shader { fragment: "result = vec4(gl_FragCoord.z);", ..Shader::PLAIN };
    let vertices = triangle(IN_DEPTH);
    subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(&surface, GlState::WRITE, &vertices) })?;
    let (colors, depths) = (surface.floats(), surface.depths());
    let wrong = colors.iter().zip(&depths).filter(|(color, depth)| f64::from(color[0]) != **depth).count();
    let drawn = depths.iter().filter(|depth| **depth > 0.0).count();
    findings.none_wrong("gl_FragCoord.z against the depth stored as a float", wrong, drawn);
    Ok(())
}

/// Pixels along a side of GL-T4's map.
const MAP: u32 = 128;
/// A floor under the light's view, corners in clip space (60 degrees, near 1, far 30).
const FLOOR: [[f32; 4]; 4] =
    [[-1.6, -1.4, 0.069, 1.0345], [1.6, -1.4, 0.069, 1.0345], [14.0, 9.0, 12.0, 12.9], [-14.0, 9.0, 12.0, 12.9]];

/// GL-T4: the floor's shadow map, looked up from the light's own view.
pub fn self_shadow(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth32F] {
        findings.part(|findings| {
            let mut lit = [0.0; 4];
            for (lit, units) in lit.iter_mut().zip([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 4.0]]) {
                *lit = lit_share(subject, format, units)?;
            }
            let percent = lit.map(|share| format!("{:.1} %", share * 100.0));
            findings.fact(
                format!("{}: lit of a floor under its own map", format.name()),
                format!("{} without offset, {} with (0, 1), {} with (1, 1)", percent[0], percent[1], percent[2]),
            );
            let (verdict, measured) = match () {
                () if lit[2] == 1.0 => (RuleVerdict::Pass, "polygon offset (1, 1) leaves no false shadow".to_owned()),
                () if lit[3] == 1.0 => {
                    (RuleVerdict::Warning, format!("{} lit with (1, 1), all with (2, 4)", percent[2]))
                }
                () => (RuleVerdict::Fail, format!("only {} lit with (2, 4)", percent[3])),
            };
            findings.add(format.name(), verdict, measured);
            Ok(())
        });
    }
    Ok(())
}

fn lit_share(subject: &DriverUnderTest, format: GlFormat, [factor, units]: [f32; 2]) -> Result<f64, Error> {
    let vertices = [0, 1, 2, 0, 2, 3].map(|corner| Vertex { position: FLOOR[corner], value: FLOOR[corner] });
    let map = subject.bench.surface([MAP; 2], None, Some(format))?;
    map.clear_depth(1.0);
    let offset = GlOffset { factor, units, clamp: 0.0 };
    let state = GlState { depth: Some(GlCompare::Less), offset: Some(offset), color_write: false, ..GlState::WRITE };
    subject.bench.draw(&GlDraw::plain(&map, state, &vertices))?;
    let Some(image) = map.depth_image() else { return Ok(0.0) };
    lit_from(subject, image, &vertices)
}

fn lit_from(subject: &DriverUnderTest, image: &GlImage, vertices: &[Vertex]) -> Result<f64, Error> {
    let view = subject.bench.surface([MAP; 2], Some(GlFormat::Rgba8), None)?;
    view.clear_color([0.5; 4]);
    let shader = Shader {
        fragment: "result = vec4(compare_proj(vec4(0.5 * (passed.xyz + passed.w), passed.w)));",
        ..Shader::PLAIN
    };
    let images = [("shadow", image, Sampling::compare(GlCompare::LessEqual))];
    let state = GlState { depth: None, ..GlState::WRITE };
    subject.bench.draw(&GlDraw { shader, images: &images, ..GlDraw::plain(&view, state, vertices) })?;
    let colors = view.colors();
    let count = |wanted: u8| colors.iter().filter(|color| color[0] == wanted).count() as f64;
    Ok(count(255) / (count(255) + count(0)).max(1.0))
}

/// A whole viewport, for others of this room.
pub(super) fn flat(depth: f64) -> [Vertex; 6] {
    full((2.0 * depth - 1.0) as f32)
}
