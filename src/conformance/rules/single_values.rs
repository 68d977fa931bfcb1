//! GL-K3: one value changes and all others stay [GL 4.6, 7.6.1, 17.3.3].

use crate::conformance::bench::{
    Error, GlAttribute, GlCompare, GlDraw, GlElements, GlFormat, GlIndices, GlPrimitive, GlState, GlStencil,
    GlStencilOp, GlUniform, Shader, Vertex, full, rectangle,
};
use crate::conformance::{DriverUnderTest, Findings};

/// Numbers of the uniforms: a mat4, a mat3, an array of eight vec4, a vec4, a vec3, a vec2, a float.
const LENGTHS: [usize; 7] = [16, 9, 32, 4, 3, 2, 1];
const NAMES: [&str; 7] = ["mat4", "mat3", "vec4[8]", "vec4", "vec3", "vec2", "float"];
const COUNT: usize = 67;
const DECLARATIONS: &str = "uniform mat4 m4; uniform mat3 m3; uniform vec4 list[8]; uniform vec4 v4; uniform vec3 v3; uniform vec2 v2; uniform float f;";
/// A pixel for each number.
const READ: &str = "int k = int(gl_FragCoord.x); float seen = f;
if (k < 16) seen = m4[k / 4][k % 4];
else if (k < 25) seen = m3[(k - 16) / 3][(k - 16) % 3];
else if (k < 57) seen = list[(k - 25) / 4][(k - 25) % 4];
else if (k < 61) seen = v4[k - 57];
else if (k < 64) seen = v3[k - 61];
else if (k < 66) seen = v2[k - 64];
result = vec4(seen);";

fn part<const N: usize>(numbers: &[f32], first: usize) -> [f32; N] {
    std::array::from_fn(|index| numbers[first + index])
}

fn uniforms(numbers: &[f32]) -> [(&'static str, GlUniform); 7] {
    [
        ("m4", GlUniform::Mat4(part(numbers, 0))),
        ("m3", GlUniform::Mat3(part(numbers, 16))),
        ("list", GlUniform::Vec4s(std::array::from_fn(|index| part(numbers, 25 + 4 * index)))),
        ("v4", GlUniform::Vec4(part(numbers, 57))),
        ("v3", GlUniform::Vec3(part(numbers, 61))),
        ("v2", GlUniform::Vec2(part(numbers, 64))),
        ("f", GlUniform::Float(numbers[66])),
    ]
}

/// GL-K3: each number of each uniform by itself, and each value of the stencil test.
pub fn alone(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    findings.part(|findings| numbers(subject, findings));
    findings.part(|findings| stencil(subject, findings));
    findings.part(|findings| between_draws(subject, findings));
    Ok(())
}

/// A vec3 that is set between draws of one vertex array, whose indices go on where those of the draw before end.
fn between_draws(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const PARTS: u32 = 5;
    let surface = subject.bench.surface([PARTS, 1], Some(GlFormat::Rgba32F), None)?;
    let edge = |part: u32| 2.0 * part as f32 / PARTS as f32 - 1.0;
    let positions: Vec<f32> = (0..PARTS)
        .flat_map(|part| rectangle([edge(part), -1.0], [edge(part + 1), 1.0], 0.0, [0.0; 4]))
        .flat_map(|vertex| vertex.position)
        .collect();
    let indices: Vec<u32> = (0..6 * PARTS).collect();
    let color = |part: u32| [part as f32 + 0.5, -2.0 * part as f32, 8.0 - part as f32];
    let draw = GlElements {
        surface: &surface,
        state: GlState { depth: None, ..GlState::WRITE },
        shader: Shader { declarations: "uniform vec3 tint;", ..Shader::of("result = vec4(tint, 1.0);") },
        attributes: &[GlAttribute { location: 0, components: 4, stride: 0, offset: 0, numbers: &positions }],
        indices: GlIndices::Long(&indices),
        range: [0, 0],
        primitive: GlPrimitive::Triangles,
        base: 0,
    };
    let ranges: Vec<_> = (0..PARTS).map(|part| ([6 * part, 6], Some(color(part)))).collect();
    subject.bench.draw_ranges(&draw, &ranges)?;
    let seen = surface.floats();
    let wrong = (0..PARTS).zip(&seen).filter(|(part, seen)| seen[..3] != color(*part)).count();
    findings.none_wrong("a vec3 between draws of adjoining indices", wrong, seen.len());
    Ok(())
}

fn numbers(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([COUNT as u32, 1], Some(GlFormat::Rgba32F), None)?;
    let shader = Shader { declarations: DECLARATIONS, ..Shader::of(READ) };
    let state = GlState { depth: None, ..GlState::WRITE };
    let mut numbers: Vec<f32> = (0..COUNT).map(|index| 0.5 * index as f32 - 9.0).collect();
    let drawn = |numbers: &[f32], only: Option<usize>| {
        let all = uniforms(numbers);
        let uniforms = only.map_or(&all[..], |kind| &all[kind..=kind]);
        subject.bench.draw(&GlDraw { shader, uniforms, ..GlDraw::plain(&surface, state, &full(0.0)) })?;
        Ok::<_, Error>(surface.floats().iter().zip(numbers).filter(|(seen, due)| seen[0] != **due).count())
    };
    drawn(&numbers, None)?;
    let mut first = 0;
    for (kind, (length, name)) in LENGTHS.into_iter().zip(NAMES).enumerate() {
        let mut wrong = 0;
        for number in first..first + length {
            // All uniforms are set again, then the one alone.
            for only in [None, Some(kind)] {
                numbers[number] += 1.25;
                wrong += drawn(&numbers, only)?;
            }
        }
        findings.none_wrong(format!("each number of a {name}"), wrong, 2 * length * COUNT);
        first += length;
    }
    Ok(())
}

/// Front faces on the left, back faces on the right.
fn halves() -> Vec<Vertex> {
    let [a, b, c, d, e, f] = rectangle([0.0, -1.0], [1.0, 1.0], 0.0, [0.0; 4]);
    [&rectangle([-1.0; 2], [0.0, 1.0], 0.0, [0.0; 4])[..], &[a, c, b, d, f, e]].concat()
}

/// By glStencilFunc, glStencilMask and glStencilOp, which hold for both faces.
fn stencil(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const BEFORE: u8 = 0x5A;
    let surface = subject.bench.surface([8, 4], None, Some(GlFormat::Depth24Stencil8))?;
    let start = GlStencil { reference: 1, ..GlStencil::on_pass(GlStencilOp::Replace) };
    let mut steps = Vec::new();
    steps.extend([1, 2, 7, 0x5A, 0xFF, 0].map(|reference| ("references", GlStencil { reference, ..start })));
    let masked = GlStencil { compare: GlCompare::Equal, reference: 0x0A, ..start };
    steps.extend([0xFF, 0x0F, 0xF0, 0x0A, 0].map(|read_mask| ("read masks", GlStencil { read_mask, ..masked })));
    let ordered = GlStencil { reference: 0x5A, ..start };
    steps.extend(GlCompare::ALL.map(|compare| ("functions", GlStencil { compare, ..ordered })));
    steps.extend(
        [0xFF, 0x0F, 0xF0, 0x80].map(|write_mask| ("write masks", GlStencil { write_mask, reference: 0xA5, ..start })),
    );
    for name in ["references", "read masks", "functions", "write masks"] {
        let (mut wrong, mut count) = (0, 0);
        for (_, side) in steps.iter().filter(|(of, _)| *of == name) {
            surface.clear_stencil(BEFORE);
            let state = GlState {
                depth: None,
                color_write: false,
                stencil: Some([*side; 2]),
                short_calls: true,
                ..GlState::WRITE
            };
            subject.bench.draw(&GlDraw::plain(&surface, state, &halves()))?;
            let (reference, mask) = (side.reference as u32, side.read_mask);
            let passes = side.compare.holds((reference & mask).cmp(&(u32::from(BEFORE) & mask)));
            let write = side.write_mask;
            let due = if passes { u32::from(BEFORE) & !write | reference & write } else { u32::from(BEFORE) };
            let stencils = surface.stencils();
            wrong += stencils.iter().filter(|seen| u32::from(**seen) != due & 0xFF).count();
            count += stencils.len();
        }
        findings.none_wrong(format!("stencil {name}, on front and back faces"), wrong, count);
    }
    Ok(())
}
