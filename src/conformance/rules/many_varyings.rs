//! GL-K12: as many varyings as a renderer of several lights has [GLSL 4.60, 4.3.4, 7.3: 60 components at least].

use crate::conformance::bench::{Error, GlDraw, GlFormat, GlState, Shader, Vertex, full};
use crate::conformance::{DriverUnderTest, Findings};

/// Varyings of one kind: vec4 alone, or all kinds in turn.
struct Set {
    name: &'static str,
    declarations: &'static str,
    vertex: &'static str,
    fragment: &'static str,
    /// Components of each.
    lengths: &'static [usize],
}

const SETS: [Set; 2] = [
    Set {
        name: "twelve vec4",
        declarations: "#ifdef VERTEX
out vec4 a;
out vec4 b;
out vec4 c;
out vec4 d;
out vec4 e;
out vec4 f;
out vec4 g;
out vec4 h;
out vec4 i;
out vec4 j;
out vec4 k;
out vec4 l;
#else
in vec4 a;
in vec4 b;
in vec4 c;
in vec4 d;
in vec4 e;
in vec4 f;
in vec4 g;
in vec4 h;
in vec4 i;
in vec4 j;
in vec4 k;
in vec4 l;
#endif",
        vertex: "gl_Position = position; passed = value; vec4 x = value;
a = x + 1.0; b = x + 2.0; c = x + 3.0; d = x + 4.0; e = x + 5.0; f = x + 6.0;
g = x + 7.0; h = x + 8.0; i = x + 9.0; j = x + 10.0; k = x + 11.0; l = x + 12.0;",
        fragment: "int n = int(gl_FragCoord.x); vec4 seen = passed;
if (n == 1) seen = a; if (n == 2) seen = b; if (n == 3) seen = c; if (n == 4) seen = d; if (n == 5) seen = e; if (n == 6) seen = f;
if (n == 7) seen = g; if (n == 8) seen = h; if (n == 9) seen = i; if (n == 10) seen = j; if (n == 11) seen = k; if (n == 12) seen = l;
result = seen;",
        lengths: &[4; 12],
    },
    Set {
        name: "floats, vec2, vec3 and vec4",
        declarations: "#ifdef VERTEX
out float a;
out vec3 b;
out vec2 c;
out vec3 d;
out vec4 e;
out float f;
out vec2 g;
out vec3 h;
out float i;
out vec4 j;
out vec3 k;
out vec2 l;
#else
in float a;
in vec3 b;
in vec2 c;
in vec3 d;
in vec4 e;
in float f;
in vec2 g;
in vec3 h;
in float i;
in vec4 j;
in vec3 k;
in vec2 l;
#endif",
        vertex: "gl_Position = position; passed = value; vec4 x = value;
a = x.x + 1.0; b = x.xyz + 2.0; c = x.xy + 3.0; d = x.xyz + 4.0; e = x + 5.0; f = x.x + 6.0;
g = x.xy + 7.0; h = x.xyz + 8.0; i = x.x + 9.0; j = x + 10.0; k = x.xyz + 11.0; l = x.xy + 12.0;",
        fragment: "int n = int(gl_FragCoord.x); vec4 seen = passed;
if (n == 1) seen = vec4(a); if (n == 2) seen = vec4(b, 0.0); if (n == 3) seen = vec4(c, 0.0, 0.0); if (n == 4) seen = vec4(d, 0.0);
if (n == 5) seen = e; if (n == 6) seen = vec4(f); if (n == 7) seen = vec4(g, 0.0, 0.0); if (n == 8) seen = vec4(h, 0.0);
if (n == 9) seen = vec4(i); if (n == 10) seen = j; if (n == 11) seen = vec4(k, 0.0); if (n == 12) seen = vec4(l, 0.0, 0.0);
result = seen;",
        lengths: &[1, 3, 2, 3, 4, 1, 2, 3, 1, 4, 3, 2],
    },
];

/// GL-K12: each varying has its own value in each pixel.
pub fn many(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const WIDTH: usize = 13;
    const HEIGHT: usize = 8;
    let surface = subject.bench.surface([WIDTH as u32, HEIGHT as u32], Some(GlFormat::Rgba32F), None)?;
    // Linear in the window: x rises to the right and y upwards.
    let vertices = full(0.0).map(|vertex| {
        let [x, y, ..] = vertex.position;
        Vertex { value: [x, y, x + y, 2.0 * x - y], ..vertex }
    });
    for set in &SETS {
        findings.part(|findings| {
            let shader = Shader {
                version: "#version 150",
                declarations: set.declarations,
                vertex: set.vertex,
                fragment: set.fragment,
            };
            let state = GlState { depth: None, ..GlState::WRITE };
            subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(&surface, state, &vertices) })?;
            let (mut wrong, mut count) = (0, 0);
            for (pixel, seen) in surface.floats().iter().enumerate() {
                let number = pixel % WIDTH;
                let place = |at: usize, of: usize| (at as f32 + 0.5) * 2.0 / of as f32 - 1.0;
                let [x, y] = [place(number, WIDTH), place(pixel / WIDTH, HEIGHT)];
                let length = if number == 0 { 4 } else { set.lengths[number - 1] };
                for (seen, due) in seen.iter().zip([x, y, x + y, 2.0 * x - y]).take(length) {
                    // A few roundings of a sum of up to 15.
                    let is_near = (seen - due - number as f32).abs() < 1e-4;
                    wrong += usize::from(!is_near);
                    count += 1;
                }
            }
            findings.none_wrong(set.name, wrong, count);
            Ok(())
        });
    }
    Ok(())
}
