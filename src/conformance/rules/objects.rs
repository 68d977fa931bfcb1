//! GL-K15: objects that are made and used again, strips and outlines under culling, offsets of attributes [GL 4.6, 4.2, 8.2,
//! 8.14.4, 10.1.11, 10.3.9, 14.6.1, 14.6.4].

use std::rc::Rc;

use crate::conformance::bench::{
    Error, GlAttribute, GlDraw, GlElements, GlFace, GlFormat, GlImageDesc, GlIndices, GlPart, GlPlace, GlPolygonMode,
    GlPrimitive, GlSampledBy, GlState, GlWrap, Sampling, Shader, Vertex, rectangle,
};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 16;
const COUNT: usize = (SIDE * SIDE) as usize;
const FLAT: GlState = GlState { depth: None, ..GlState::WRITE };

/// GL-K15.
pub fn objects(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    findings.part(|findings| samplers(subject, findings));
    findings.part(|findings| queries(subject, findings));
    findings.part(|findings| borders(subject, findings));
    findings.part(|findings| levels(subject, findings));
    findings.part(|findings| strips(subject, findings));
    findings.part(|findings| outlines(subject, findings));
    findings.part(|findings| offsets(subject, findings));
    Ok(())
}

/// A new sampler object has the initial values [8.2, table 23.18].
fn samplers(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let cases = [
        ("TEXTURE_MIN_FILTER", glow::TEXTURE_MIN_FILTER, glow::NEAREST, glow::NEAREST_MIPMAP_LINEAR),
        ("TEXTURE_MAG_FILTER", glow::TEXTURE_MAG_FILTER, glow::NEAREST, glow::LINEAR),
        ("TEXTURE_WRAP_S", glow::TEXTURE_WRAP_S, glow::CLAMP_TO_BORDER, glow::REPEAT),
        ("TEXTURE_WRAP_T", glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE, glow::REPEAT),
        ("TEXTURE_WRAP_R", glow::TEXTURE_WRAP_R, glow::MIRRORED_REPEAT, glow::REPEAT),
        ("TEXTURE_COMPARE_MODE", glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE, glow::NONE),
        ("TEXTURE_COMPARE_FUNC", glow::TEXTURE_COMPARE_FUNC, glow::GREATER, glow::LEQUAL),
    ];
    let given: Vec<_> = cases.iter().map(|(_, name, value, _)| (*name, *value)).collect();
    let seen = subject.bench.sampler_after(&given, &cases.map(|(_, name, ..)| name))?;
    let wrong: Vec<_> =
        cases.iter().zip(seen).filter(|((.., due), seen)| due != seen).map(|((name, ..), _)| *name).collect();
    findings.must_hold("a sampler object made after another was deleted", wrong.is_empty(), wrong.join(", "));
    Ok(())
}

/// A query that is begun again counts from 0 [4.2.1].
fn queries(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), None)?;
    let columns = [4, 16, 0, 1, 8];
    let counts = subject.bench.samples_again(columns.len() as u32, |turn| {
        let right = columns[turn as usize] as f32 * 2.0 / SIDE as f32 - 1.0;
        subject.bench.draw(&GlDraw::plain(&surface, FLAT, &rectangle([-1.0; 2], [right, 1.0], 0.0, [1.0; 4])))
    })?;
    let due = columns.map(|columns| columns * SIDE);
    findings.must_hold("a query that is begun again", counts == due, format!("{counts:?} of {due:?}"));
    Ok(())
}

/// Borders that differ in one component alone.
fn borders(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let image = subject.bench.float_image([2, 2], &[[9.0; 4]; 4])?;
    let fragment = "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = texture(map, at.xy);";
    for by in GlSampledBy::ALL {
        let (mut wrong, mut count) = (0, 0);
        for component in 0..4 {
            for value in [0.25, 0.5, 0.75] {
                let mut border = [0.375; 4];
                border[component] = value;
                let sampling = Sampling { wrap: [GlWrap::ClampToBorder; 3], border, by, ..Sampling::NEAREST };
                let seen = subject.bench.map(fragment, &[[-1.0, 0.5, 0.0, 0.0]; 4], &[("map", &image, sampling)])?;
                wrong += seen.iter().filter(|seen| **seen != border).count();
                count += seen.len();
            }
        }
        findings.none_wrong(format!("borders that differ in one component{}", by.suffix()), wrong, count);
    }
    Ok(())
}

/// Levels are made of the texture on the active unit [8.14.4].
fn levels(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let bench = &subject.bench;
    let image = |code: u8| {
        let desc = GlImageDesc { levels: 3, ..GlImageDesc::flat(GlFormat::Rgba8, [8; 2]) };
        bench.filled(desc, move |level, _| vec![if level == 0 { code } else { 9 }; 4 << (6 - 2 * level)]).map(Rc::new)
    };
    let (one, other) = (image(100)?, image(200)?);
    bench.generate_on_second_unit(&one, &other)?;
    let (mut wrong, mut count) = (0, 0);
    for (image, due) in [(&one, 100), (&other, 9)] {
        for level in 1..3 {
            let colors = bench.surface_at(Some(GlPlace { image, level, part: GlPart::Face(0) }), None)?.colors();
            wrong += colors.iter().filter(|color| **color != [due; 4]).count();
            count += colors.len();
        }
    }
    findings.none_wrong("levels made on unit 1, another texture on unit 0", wrong, count);
    Ok(())
}

/// All triangles of a strip or fan face as its first does [10.1.11: the order of a strip's vertices].
fn strips(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), None)?;
    // Counter-clockwise, from left to right.
    let strip: Vec<f32> = (0..10).flat_map(|index| [(index / 2) as f32 * 0.5 - 1.0, [1.0, -1.0][index % 2]]).collect();
    let fan = vec![-1.0, -1.0, 1.0, -1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, -1.0, 1.0];
    for (name, primitive, places) in
        [("strip", GlPrimitive::TriangleStrip, strip), ("fan", GlPrimitive::TriangleFan, fan)]
    {
        let indices: Vec<u32> = (0..places.len() as u32 / 2).collect();
        for clockwise in [false, true] {
            for cull in [GlFace::Back, GlFace::Front] {
                surface.clear_color([0.0; 4]);
                subject.bench.draw_elements(&GlElements {
                    surface: &surface,
                    state: GlState { cull: Some(cull), clockwise, ..FLAT },
                    shader: Shader::of("result = vec4(1.0);"),
                    attributes: &[GlAttribute { location: 0, components: 2, numbers: &places, stride: 0, offset: 0 }],
                    indices: GlIndices::Long(&indices),
                    range: [0, indices.len() as u32],
                    primitive,
                    base: 0,
                })?;
                let is_drawn = (cull == GlFace::Back) != clockwise;
                let due = [if is_drawn { 255 } else { 0 }; 4];
                let wrong = surface.colors().into_iter().filter(|color| *color != due).count();
                let winding = if clockwise { "CW" } else { "CCW" };
                findings.none_wrong(format!("a {name}, {cull:?} faces culled, {winding}"), wrong, COUNT);
            }
        }
    }
    Ok(())
}

/// Polygons are culled whatever their mode [14.6.1, 14.6.4].
fn outlines(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), None)?;
    for mode in [GlPolygonMode::Line, GlPolygonMode::Point] {
        for cull in [GlFace::Back, GlFace::Front] {
            for turned in [false, true] {
                surface.clear_color([0.0; 4]);
                let mut vertices: Vec<Vertex> = rectangle([-0.5; 2], [0.5; 2], 0.0, [1.0; 4]).to_vec();
                if turned {
                    vertices.reverse();
                }
                let state = GlState { cull: Some(cull), mode: [mode; 2], ..FLAT };
                subject.bench.draw(&GlDraw::plain(&surface, state, &vertices))?;
                let drawn = surface.colors().into_iter().filter(|color| color[0] != 0).count();
                let is_culled = (cull == GlFace::Front) != turned;
                let name = format!("{mode:?} of {} faces, {cull:?} culled", if turned { "back" } else { "front" });
                findings.must_hold(name, is_culled == (drawn == 0), format!("{drawn} pixels drawn"));
            }
        }
    }
    Ok(())
}

/// Attributes that begin late in their buffer [10.3.9].
fn offsets(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba32F), None)?;
    let corners = [-1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0];
    for offset in [252_u32, 2044, 2048, 65_532, 65_536, 70_000, 1 << 20] {
        let mut numbers = vec![0.25; offset as usize / 4];
        numbers.extend([5.0; 4]);
        surface.clear_color([0.0; 4]);
        subject.bench.draw_elements(&GlElements {
            surface: &surface,
            state: FLAT,
            shader: Shader::of("result = passed.xxxx;"),
            attributes: &[
                GlAttribute { location: 0, components: 2, numbers: &corners, stride: 0, offset: 0 },
                GlAttribute { location: 1, components: 1, numbers: &numbers, stride: 0, offset },
            ],
            indices: GlIndices::Long(&[0, 1, 2, 0, 2, 3]),
            range: [0, 6],
            primitive: GlPrimitive::Triangles,
            base: 0,
        })?;
        let wrong = surface.floats().into_iter().filter(|color| (color[0] - 5.0).abs() > 1e-4).count();
        findings.none_wrong(format!("an attribute from byte {offset}"), wrong, COUNT);
    }
    Ok(())
}
