//! Shaders whose results are known.

use super::{Compiled, LANES, Machine, NoTextures, compile};
use crate::conformance::model::number::Num;

fn run(text: &str) -> (Compiled, Machine) {
    let shader = compile(text, false).unwrap();
    let mut machine = Machine::new(&shader);
    for (lane, [x, y]) in [[0.5, 0.5], [1.5, 0.5], [0.5, 1.5], [1.5, 1.5]].into_iter().enumerate() {
        machine.slots[shader.position[0] as usize][lane] = Num::exact(x);
        machine.slots[shader.position[1] as usize][lane] = Num::exact(y);
    }
    machine.run(&shader, &NoTextures);
    (shader, machine)
}

/// The first output in each lane.
fn results(text: &str) -> [f64; LANES] {
    let (shader, machine) = run(text);
    machine.slots[shader.outputs[0].slots[0] as usize].map(|number| number.value)
}

#[test]
fn macros_loops_branches_and_calls_are_followed() {
    let text = "#define SQUARE(x) ((x) * (x))\n\
        #if defined(SQUARE) && !defined(OTHER)\n#define COUNT 3\n#else\n#define COUNT 4\n#endif\n\
        out vec4 color;\nfloat total = 0.0;\n\
        float add(float by);\n\
        float add(float by)\n{\n    if (by > 2.0)\n        return -1.0;\n    total += SQUARE(by);\n    return total;\n}\n\
        void main()\n{\n    for (int k = 0; k < COUNT; ++k)\n        add(float(k));\n\
        vec2 v = vec2(1.0, 2.0);\n    v = v.yx;\n    color = vec4(add(floor(gl_FragCoord.x) * 3.0) + v.x, v, 1.0);\n}\n";
    // 0 + 1 + 4, and 2 of the vector; where x is 1, the call returns at once.
    assert_eq!(results(text), [7.0, 1.0, 7.0, 1.0]);
}

#[test]
fn a_component_is_assigned_a_function_of_itself() {
    let text = "out vec4 color;\nvoid main()\n{\n    vec3 v = vec3(gl_FragCoord.xy, 5.0);\n\
        v.z = clamp(v.z, 0.0, v.x);\n    color = vec4(v.z);\n}\n";
    assert_eq!(results(text), [0.5, 1.5, 0.5, 1.5]);
}

#[test]
fn discard_in_a_function_ends_the_fragment() {
    let text = "out vec4 color;\nvoid test()\n{\n    if (gl_FragCoord.x < 1.0)\n        discard;\n}\n\
        void main()\n{\n    color = vec4(1.0);\n    test();\n    color = vec4(2.0, 0.0, 0.0, dFdx(color.x));\n}\n";
    let (shader, machine) = run(text);
    assert_eq!((machine.discarded, machine.unsure), (0b0101, 0));
    let slots = &shader.outputs[0].slots;
    assert_eq!(machine.slots[slots[0] as usize][1].value, 2.0);
    // A neighbour is gone.
    assert!(!machine.slots[slots[3] as usize][1].is_known());
}

#[test]
fn derivatives_are_differences_in_the_quad() {
    let text = "out vec4 color;\nvoid main()\n{\n    float v = gl_FragCoord.x * gl_FragCoord.y;\n    color = vec4(dFdx(v), dFdy(v), 0.0, 0.0);\n}\n";
    let (shader, machine) = run(text);
    let along = machine.slots[shader.outputs[0].slots[0] as usize][0];
    // 0.5 in the lower row, 1.5 in the upper one.
    let reach = along.error * crate::conformance::model::number::SLACK;
    assert!(along.value - reach <= 0.5 && along.value + reach >= 1.5 && reach < 0.51, "{along:?}");
}

#[test]
fn what_is_not_understood_is_said() {
    for (text, why) in [("void main() { foo(1.0); }", "foo"), ("void main() { x = 1.0; }", "name x"), ("Lit l;", "Lit")]
    {
        let said = compile(text, false).unwrap_err();
        assert!(said.contains(why), "{said}");
    }
}
