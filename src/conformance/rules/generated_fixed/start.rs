//! Commands that make a context's state that of [`FixedState::new`], whatever was set before.

use super::state::{FixedState, LIGHTS, PLANES, TARGETS};
use crate::conformance::bench::fixed_commands::{FIXED_UNITS, FixedCommand as Command};
use crate::context::compatibility::raw;

pub const COORDINATES: [[u32; 2]; 4] = [
    [raw::S, raw::TEXTURE_GEN_S],
    [raw::T, raw::TEXTURE_GEN_T],
    [raw::R, raw::TEXTURE_GEN_R],
    [raw::Q, raw::TEXTURE_GEN_Q],
];

/// Switches that are no unit's, but lights and clip planes.
pub const SWITCHES: [u32; 7] = [
    raw::LIGHTING,
    raw::NORMALIZE,
    raw::RESCALE_NORMAL,
    raw::FOG,
    raw::COLOR_SUM,
    raw::ALPHA_TEST,
    raw::COLOR_MATERIAL,
];

fn four(value: glam::DVec4) -> [f32; 4] {
    value.as_vec4().to_array()
}

/// All of it; each command has its value from the model's start.
pub fn starting() -> Vec<Command> {
    let start = FixedState::new(0);
    let mut all: Vec<Command> = SWITCHES.map(|what| Command::Switch(what, false)).to_vec();
    all.extend((0..PLANES as u32).map(|plane| Command::Switch(raw::CLIP_PLANE0 + plane, false)));
    for mode in [raw::PROJECTION, raw::MODELVIEW] {
        all.extend([Command::MatrixMode(mode), Command::LoadIdentity]);
    }
    all.extend((0..PLANES as u32).map(|plane| Command::ClipPlane(plane, [0.0; 4])));
    for (index, light) in (0..).zip(&start.lights).take(LIGHTS) {
        all.push(Command::Switch(raw::LIGHT0 + index, false));
        let colors = [(raw::AMBIENT, light.ambient), (raw::DIFFUSE, light.diffuse), (raw::SPECULAR, light.specular)];
        all.extend(colors.map(|(name, color)| Command::Light(index, name, four(color))));
        all.push(Command::Light(index, raw::POSITION, four(light.position)));
        all.push(Command::Light(index, raw::SPOT_DIRECTION, four(light.direction.extend(0.0))));
        let numbers = [
            (raw::SPOT_EXPONENT, light.exponent),
            (raw::SPOT_CUTOFF, light.cutoff),
            (raw::CONSTANT_ATTENUATION, light.attenuation.x),
            (raw::LINEAR_ATTENUATION, light.attenuation.y),
            (raw::QUADRATIC_ATTENUATION, light.attenuation.z),
        ];
        all.extend(numbers.map(|(name, number)| Command::LightNumber(index, name, number as f32)));
    }
    all.push(Command::SceneAmbient(four(start.scene_ambient)));
    for name in [raw::LIGHT_MODEL_TWO_SIDE, raw::LIGHT_MODEL_LOCAL_VIEWER] {
        all.push(Command::LightModel(name, 0));
    }
    all.push(Command::LightModel(raw::LIGHT_MODEL_COLOR_CONTROL, raw::SINGLE_COLOR as i32));
    let both = glow::FRONT_AND_BACK;
    let material = start.materials[0];
    let colors = [
        (raw::AMBIENT, material.ambient),
        (raw::DIFFUSE, material.diffuse),
        (raw::SPECULAR, material.specular),
        (raw::EMISSION, material.emission),
    ];
    all.extend(colors.map(|(name, color)| Command::Material(both, name, four(color))));
    all.push(Command::Shininess(both, material.shininess as f32));
    all.push(Command::ColorMaterial(start.color_material[0], start.color_material[1]));
    all.push(Command::ShadeModel(start.shade));
    all.push(Command::FrontFace(start.front));
    let fog = start.fog;
    all.push(Command::Fog(raw::FOG_MODE, fog.mode as i32));
    all.push(Command::Fog(raw::FOG_COORD_SRC, fog.source as i32));
    for (name, number) in [(raw::FOG_DENSITY, fog.density), (raw::FOG_START, fog.start), (raw::FOG_END, fog.end)] {
        all.push(Command::FogNumber(name, number as f32));
    }
    all.push(Command::FogColor(four(fog.color)));
    all.push(Command::AlphaFunc(start.alpha_test.0, 0.0));
    all.push(Command::Color([1.0; 4]));
    all.push(Command::SecondaryColor([0.0; 3]));
    all.push(Command::Normal([0.0, 0.0, 1.0]));
    all.push(Command::FogCoord(0.0));
    all.extend((0..FIXED_UNITS as u32).rev().flat_map(|unit| of_unit(&start, unit)));
    all.push(Command::MatrixMode(raw::MODELVIEW));
    all
}

fn of_unit(start: &FixedState, unit: u32) -> Vec<Command> {
    let state = &start.units[unit as usize];
    let mut all = vec![Command::ActiveTexture(unit), Command::MultiTexCoord(unit, [0.0, 0.0, 0.0, 1.0])];
    all.extend([Command::MatrixMode(glow::TEXTURE), Command::LoadIdentity]);
    all.extend(TARGETS.map(|target| Command::Switch(target, false)));
    for ([coordinate, switch], plane) in COORDINATES.into_iter().zip(state.object_planes) {
        all.push(Command::Switch(switch, false));
        all.push(Command::TexGenMode(coordinate, raw::EYE_LINEAR));
        all.extend(
            [raw::OBJECT_PLANE, raw::EYE_PLANE].map(|name| Command::TexGenPlane(coordinate, name, four(plane), false)),
        );
    }
    all.push(Command::TexEnv(raw::TEXTURE_ENV_MODE, state.mode as i32));
    all.push(Command::TexEnvColor([0.0; 4]));
    let parts = [
        (state.rgb, raw::COMBINE_RGB, raw::SRC0_RGB, raw::OPERAND0_RGB, raw::RGB_SCALE),
        (state.alpha, raw::COMBINE_ALPHA, raw::SRC0_ALPHA, raw::OPERAND0_ALPHA, raw::ALPHA_SCALE),
    ];
    for (combiner, function, source, operand, scale) in parts {
        all.push(Command::TexEnv(function, combiner.function as i32));
        for index in 0..3 {
            all.push(Command::TexEnv(source + index, combiner.sources[index as usize] as i32));
            all.push(Command::TexEnv(operand + index, combiner.operands[index as usize] as i32));
        }
        all.push(Command::TexEnvScale(scale, 1.0));
    }
    all
}
