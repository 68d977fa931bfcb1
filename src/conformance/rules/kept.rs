//! GL-K1: what is set stays set, whatever is called between it and the draw [GL 4.6, 2.2.1, A.1; 17.4.3, 9.2.1].

use crate::conformance::bench::{
    Error, GlBlend, GlClear, GlCompare, GlCopyTo, GlFace, GlFormat, GlImageDesc, GlOffset, GlState, GlStencil,
    GlStencilOp, GlUpload, Shader, Surface, Vertex,
};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 16;
const OFFSET: GlOffset = GlOffset { factor: 1.0, units: 64.0, clamp: 0.0 };
/// A shader that writes a clip distance.
const CLIPPED: Shader = Shader {
    vertex: "gl_Position = position; passed = value; gl_ClipDistance[0] = position.x - 0.1 * position.w;",
    ..Shader::PLAIN
};
/// Another program than those that draw.
const OTHER: Shader = Shader::of("result = vec4(passed.w, 0.25, 0.5, 1.0);");

/// A state that is seen in a picture, and the shader that shows it.
struct Shown {
    name: &'static str,
    state: GlState,
    shader: Shader,
}

fn states() -> Vec<Shown> {
    let plain = GlState::WRITE;
    let side = GlStencil { compare: GlCompare::LessEqual, reference: 3, ..GlStencil::on_pass(GlStencilOp::Invert) };
    let back = GlStencil { write_mask: 0x0F, ..GlStencil::on_pass(GlStencilOp::IncrementWrap) };
    let [x, y] = [3, 5];
    let all = [
        ("the depth function", GlState { depth: Some(GlCompare::Less), ..plain }),
        ("the depth test switched off", GlState { depth: None, ..plain }),
        ("the depth mask", GlState { depth_write: false, ..plain }),
        ("the depth range", GlState { depth_range: [0.25, 0.75], ..plain }),
        ("a depth range that is turned", GlState { depth_range: [0.9, 0.2], short_calls: true, ..plain }),
        ("depth clamp", GlState { depth_clamp: true, ..plain }),
        ("the offset", GlState { offset: Some(OFFSET), ..plain }),
        ("the offset by glPolygonOffset", GlState { offset: Some(OFFSET), short_calls: true, ..plain }),
        ("the stencil test", GlState { stencil: Some([side, back]), ..plain }),
        ("culling of back faces", GlState { cull: Some(GlFace::Back), ..plain }),
        ("culling of front faces", GlState { cull: Some(GlFace::Front), ..plain }),
        ("the winding", GlState { cull: Some(GlFace::Back), clockwise: true, ..plain }),
        ("blending", GlState { blend: Some(GlBlend::AddByStoredAlpha), ..plain }),
        ("the colour mask", GlState { channels: [true, false, true, false], ..plain }),
        ("colour switched off", GlState { color_write: false, ..plain }),
        ("the scissor", GlState { scissor: Some([x, y, 7, 6]), ..plain }),
        ("the viewport", GlState { viewport: Some([x, y, 7, 6]), ..plain }),
    ];
    let plain_ones = all.into_iter().map(|(name, state)| Shown { name, state, shader: Shader::PLAIN });
    let clipped = Shown { name: "a clip distance", state: GlState { clip_distances: 1, ..plain }, shader: CLIPPED };
    plain_ones.chain([clipped]).collect()
}

/// Slanted rectangles in four columns: front faces and back faces, near and far; and one beyond the far plane.
fn scene() -> Vec<Vertex> {
    let mut vertices = Vec::new();
    for (index, (z, turned)) in
        [(-0.6, false), (0.3, false), (-0.5, true), (0.4, true), (1.5, false)].into_iter().enumerate()
    {
        let low = index as f32 * 0.4 - 1.0;
        let corner = |x: f32, y: f32| Vertex {
            position: [low + 0.4 * x, 2.0 * y - 1.0, z + 0.2 * x + 0.1 * y, 1.0],
            value: [0.5, 0.25, 0.125 * index as f32, 0.75],
        };
        let [a, b, c, d] = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        vertices.extend(if turned { [a, c, b, a, d, c] } else { [a, b, c, a, c, d] });
    }
    vertices
}

/// All that a surface stores.
#[derive(PartialEq)]
struct Stored {
    colors: Vec<[u8; 4]>,
    depths: Vec<f64>,
    stencils: Vec<u8>,
}

fn stored(surface: &Surface) -> Stored {
    let stencils =
        if surface.depth_encoding().is_some_and(|depth| depth.stencil_bits > 0) { surface.stencils() } else { vec![] };
    Stored { colors: surface.colors(), depths: surface.depths(), stencils }
}

/// Calls between a state and its draw.
type Between<'a> = &'a dyn Fn() -> Result<(), Error>;

/// Draws and reads: the state is set, `between` is called, and then the state is left alone or set anew by way of another.
fn drawn(
    subject: &DriverUnderTest,
    surface: &Surface,
    shown: &Shown,
    between: Between,
    anew: bool,
) -> Result<Stored, Error> {
    let bench = &subject.bench;
    surface.clear_color([0.25, 0.5, 0.75, 0.5]);
    surface.clear_depth(0.5);
    surface.clear_stencil(2);
    bench.set_state(surface, shown.state);
    between()?;
    bench.bind_surface(surface);
    if anew {
        bench.set_state(surface, GlState::WRITE);
        bench.set_state(surface, shown.state);
    }
    bench.draw_as_it_is(shown.shader, &scene())?;
    let seen = stored(surface);
    bench.set_state(surface, GlState::WRITE);
    Ok(seen)
}

/// GL-K1: each state and each call. The same commands on the same state give the same picture, to the bit [GL 4.6, A.1].
pub fn kept(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let bench = &subject.bench;
    let (color, depth) = (Some(GlFormat::Rgba8), Some(GlFormat::Depth24Stencil8));
    let surface = bench.surface([SIDE; 2], color, depth)?;
    let other = bench.surface([SIDE; 2], color, depth)?;
    let third = bench.surface([SIDE; 2], color, depth)?;
    let image = bench
        .filled(GlImageDesc { levels: 5, ..GlImageDesc::flat(GlFormat::Rgba8, [SIDE; 2]) }, |level, _| {
            vec![77; 4 << (8 - 2 * level)]
        })?;
    let texels = vec![99; 4 * 4 * 4];
    let upload = GlUpload {
        level: 0,
        layer: 0,
        area: [1, 2, 4, 4],
        layout: [glow::RGBA, glow::UNSIGNED_BYTE],
        alignment: 4,
        row: 0,
        bytes: &texels,
    };
    let clear = |clear: GlClear| move || bench.clear_as_it_is(clear);
    let colors = clear(GlClear { color: Some([0.5, 0.25, 0.0, 0.25]), ..GlClear::default() });
    let depths = clear(GlClear { depth: Some(0.6), ..GlClear::default() });
    let stencils = clear(GlClear { stencil: Some(5), ..GlClear::default() });
    let on_other = |what: GlClear| {
        let other = &other;
        move || {
            bench.bind_surface(other);
            bench.clear_as_it_is(what)
        }
    };
    let other_colors = on_other(GlClear { color: Some([1.0, 0.0, 0.0, 1.0]), ..GlClear::default() });
    let other_depths = on_other(GlClear { depth: Some(0.0), ..GlClear::default() });
    let other_stencils = on_other(GlClear { stencil: Some(9), ..GlClear::default() });
    let draw_other = || {
        bench.bind_surface(&other);
        bench.draw_as_it_is(OTHER, &scene())
    };
    let calls: [(&str, Between); 14] = [
        ("nothing", &|| Ok(())),
        ("a clear of colour", &colors),
        ("a clear of depth", &depths),
        ("a clear of stencil", &stencils),
        ("a clear of another framebuffer's colour", &other_colors),
        ("a clear of another framebuffer's depth", &other_depths),
        ("a clear of another framebuffer's stencil", &other_stencils),
        ("a draw into another framebuffer", &draw_other),
        ("another program", &|| bench.use_shader(OTHER)),
        ("a copy", &|| {
            let to = GlCopyTo { image: &image, level: 0, layer: 0, at: [2, 3] };
            bench.copy(&surface, [1, 1, 8, 8], to).map_or(Ok(()), |codes| Err(Error::Gl { what: "a copy", codes }))
        }),
        ("a blit between other framebuffers", &|| {
            bench.blit_as_it_is(&other, &third, glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT)
        }),
        ("an upload", &|| bench.upload(&image, &upload)),
        ("levels of a texture that are made", &|| bench.generate_mipmap(&image)),
        ("a read-back", &|| {
            stored(&surface);
            Ok(())
        }),
    ];
    let states = states();
    let alone: Vec<_> = states.iter().map(|shown| drawn(subject, &surface, shown, &|| Ok(()), true)).collect();
    let alone = alone.into_iter().collect::<Result<Vec<_>, _>>()?;
    for (name, between) in calls {
        // What leaves the surface alone must leave the picture as it is without it.
        let clears = ["a clear of colour", "a clear of depth", "a clear of stencil"].contains(&name);
        let mut lost = Vec::new();
        for (shown, alone) in states.iter().zip(&alone) {
            let left = drawn(subject, &surface, shown, between, false)?;
            let is_kept = if clears { left == drawn(subject, &surface, shown, between, true)? } else { left == *alone };
            if !is_kept {
                lost.push(shown.name);
            }
        }
        let measured = if lost.is_empty() { format!("{} states kept", states.len()) } else { lost.join(", ") };
        findings.must_hold(format!("after {name}"), lost.is_empty(), measured);
    }
    // Each state shows: the same without it is another picture. What a clip distance does where none is on, GL-R2 asks.
    let mut unseen = Vec::new();
    for shown in states.iter().filter(|shown| shown.state.clip_distances == 0) {
        let plain = Shown { state: GlState::WRITE, ..*shown };
        let [with, without] = [shown, &plain].map(|shown| drawn(subject, &surface, shown, &|| Ok(()), true));
        if with? == without? {
            unseen.push(shown.name);
        }
    }
    findings.must_hold("each state shows in the picture", unseen.is_empty(), unseen.join(", "));
    findings.part(|findings| formats(subject, findings));
    Ok(())
}

/// A state that is set while a framebuffer with depths of another format is bound.
fn formats(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let formats = [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth24Stencil8, GlFormat::Depth32F];
    let surface = |format: GlFormat| subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), Some(format));
    let surfaces = formats.into_iter().map(surface).collect::<Result<Vec<_>, _>>()?;
    let mut lost = Vec::new();
    for shown in states().iter().filter(|shown| shown.state.stencil.is_none()) {
        for (before, first) in surfaces.iter().zip(formats) {
            for (after, second) in surfaces.iter().zip(formats).filter(|(_, second)| *second != first) {
                let bench = &subject.bench;
                let seen = |anew: bool| {
                    after.clear_color([0.25, 0.5, 0.75, 0.5]);
                    after.clear_depth(0.5);
                    bench.set_state(before, GlState::WRITE);
                    bench.set_state(if anew { after } else { before }, shown.state);
                    bench.bind_surface(after);
                    bench.draw_as_it_is(shown.shader, &scene())?;
                    let colors = after.colors();
                    let seen = (colors, after.depths());
                    bench.set_state(after, GlState::WRITE);
                    Ok::<_, Error>(seen)
                };
                if seen(false)? != seen(true)? {
                    lost.push(format!("{} from {} to {}", shown.name, first.name(), second.name()));
                }
            }
        }
    }
    let measured = if lost.is_empty() { "all kept".to_owned() } else { lost.join(", ") };
    findings.must_hold("set while depths of another format are bound", lost.is_empty(), measured);
    Ok(())
}
