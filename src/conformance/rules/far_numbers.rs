//! GL-K16: numbers that small scenes do not have: references beyond 1, w of thousands, loops of many turns, derivatives of what
//! no half float holds [GL 4.6, 8.23.1, 14.6.1; GLSL 4.60, 4.7.1, 6.3, 8.14.1].

use crate::conformance::bench::{Error, GlCompare, GlDraw, GlFormat, GlState, Sampling, Shader, Vertex, full};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: usize = 16;
const FLAT: GlState = GlState { depth: None, ..GlState::WRITE };

/// GL-K16.
pub fn far(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    findings.part(|findings| references(subject, findings));
    findings.part(|findings| distances(subject, findings));
    findings.part(|findings| loops(subject, findings));
    findings.part(|findings| derivatives(subject, findings));
    Ok(())
}

/// A fixed-point map clamps the reference to [0, 1] [8.23.1]; one of floats does not.
fn references(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let lookups = [
        ("texture", "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(compare(at.xyz));"),
        (
            "textureProj",
            "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(compare_proj(vec4(2.0 * at.xyz, 2.0)));",
        ),
    ];
    let formats = [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth24Stencil8, GlFormat::Depth32F];
    for format in formats {
        findings.part(|findings| {
            let surface = subject.bench.surface([2, 1], None, Some(format))?;
            surface.clear_depth_in(Some([0, 0, 1, 1]), 0.0);
            surface.clear_depth_in(Some([1, 0, 1, 1]), 1.0);
            let Some(image) = surface.depth_image() else { return Ok(()) };
            for (name, fragment) in lookups {
                let (mut wrong, mut count) = (0, 0);
                for compare in GlCompare::ALL {
                    let places = [-100.0_f32, -0.5, 0.0, 0.5, 1.0, 1.25, 2.0, 1000.0];
                    let inputs: Vec<_> =
                        places.iter().flat_map(|at| [[0.25, 0.5, *at, 0.0], [0.75, 0.5, *at, 1.0]]).collect();
                    let sampling = Sampling::compare(compare);
                    let seen = subject.bench.map(fragment, &inputs, &[("shadow", image, sampling)])?;
                    for (seen, [_, _, reference, stored]) in seen.iter().zip(&inputs) {
                        let reference =
                            if format == GlFormat::Depth32F { *reference } else { reference.clamp(0.0, 1.0) };
                        let due = compare.holds(reference.total_cmp(stored));
                        wrong += usize::from(seen[0] != if due { 1.0 } else { 0.0 });
                        count += 1;
                    }
                }
                findings.none_wrong(format!("{}: {name} of references from -100 to 1000", format.name()), wrong, count);
            }
            Ok(())
        });
    }
    Ok(())
}

/// Varyings between corners whose w are far apart [14.6.1, equation 14.9].
fn distances(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba32F), None)?;
    for [left, right] in [[1.0_f32, 16.0], [512.0, 4096.0], [4096.0, 65536.0], [1e6, 3e6], [1e-6, 4e-6]] {
        let at = |vertex: Vertex| {
            let w = if vertex.position[0] < 0.0 { left } else { right };
            let [x, y, ..] = vertex.position;
            Vertex { position: [x * w, y * w, 0.0, w], value: [(x + 1.0) / 2.0, 1.0, 0.0, 0.0] }
        };
        let vertices = full(0.0).map(at);
        subject.bench.draw(&GlDraw::plain(&surface, FLAT, &vertices))?;
        let mut tally = GradeTally::default();
        for (pixel, seen) in surface.floats().into_iter().enumerate() {
            let share = ((pixel % SIDE) as f64 + 0.5) / SIDE as f64;
            let [near, far] = [(1.0 - share) / f64::from(left), share / f64::from(right)];
            let off = f64::from(seen[0]) - far / (near + far);
            tally.add(verify::within(off, 1e-4, 1e-3), off);
        }
        findings.tally(format!("varyings between w of {left} and {right}"), tally, "");
    }
    Ok(())
}

/// Loops that end when their condition fails, however late.
fn loops(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let inputs: Vec<_> = (0..300).map(|turns| [turns as f32, 0.0, 0.0, 0.0]).collect();
    for (name, fragment) in [
        (
            "while",
            "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); float n = 0.0;
while (n < at.x) { n += 1.0; } result = vec4(n);",
        ),
        (
            "for",
            "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); float n = 0.0;
for (int i = 0; i < int(at.x); ++i) { n += 1.0; } result = vec4(n);",
        ),
        (
            "do",
            "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); float n = -1.0;
do { n += 1.0; } while (n < at.x); result = vec4(n);",
        ),
        (
            "while with break and continue",
            "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); float n = 0.0; int i = 0;
while (true) { if (i >= 2 * int(at.x)) break; ++i; if (i % 2 == 0) continue; n += 1.0; } result = vec4(n);",
        ),
    ] {
        let seen = subject.bench.map(fragment, &inputs, &[])?;
        let wrong = seen.iter().zip(&inputs).filter(|(seen, due)| seen[0] != due[0]).count();
        findings.none_wrong(format!("{name}: up to 299 turns"), wrong, inputs.len());
    }
    Ok(())
}

/// Derivatives are differences of floats, whose neighbours may be closer together than half floats are.
fn derivatives(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba32F), None)?;
    let shader = Shader::of("result = vec4(dFdx(passed.x), dFdy(passed.x), fwidth(passed.x), 0.0);");
    let mut tally = GradeTally::default();
    for start in [1.0_f32, 100.0, 1000.0] {
        for [a, b] in [[0.3_f32, -0.7], [-0.01, 0.003], [0.1, 0.2]] {
            let vertices = full(0.0).map(|vertex| {
                let [x, y] = [vertex.position[0], vertex.position[1]].map(|ndc| (ndc + 1.0) * SIDE as f32 / 2.0);
                Vertex { value: [start + a * x + b * y, 0.0, 0.0, 0.0], ..vertex }
            });
            subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(&surface, FLAT, &vertices) })?;
            let [a, b] = [a, b].map(f64::from);
            for seen in surface.floats() {
                for (seen, due) in seen.into_iter().zip([a, b, a.abs() + b.abs()]) {
                    // In units of the last place of the values.
                    let off = (f64::from(seen) - due) / f64::from(start) * f64::from(1 << 23);
                    tally.add(verify::within(off, 16.0, 256.0), off);
                }
            }
        }
    }
    findings.tally("derivatives of what no half float holds", tally, "roundings");
    Ok(())
}
