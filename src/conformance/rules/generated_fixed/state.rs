//! State of the model: what each command sets, as GL has it at the start [GL 4.6 compatibility, 23].

use glam::{DMat4, DVec3, DVec4};

use crate::conformance::bench::fixed_commands::{FIXED_UNITS, FixedCommand};
use crate::context::compatibility::raw;

/// Lights that are used.
pub const LIGHTS: usize = 8;
pub const PLANES: usize = 4;

/// Codes that are on.
#[derive(Clone, Debug, Default)]
pub struct Switches(Vec<u32>);

impl Switches {
    pub fn has(&self, what: u32) -> bool {
        self.0.contains(&what)
    }

    pub fn set(&mut self, what: u32, on: bool) {
        self.0.retain(|other| *other != what);
        if on {
            self.0.push(what);
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct LightState {
    pub ambient: DVec4,
    pub diffuse: DVec4,
    pub specular: DVec4,
    /// In eye space.
    pub position: DVec4,
    pub direction: DVec3,
    pub exponent: f64,
    pub cutoff: f64,
    pub attenuation: DVec3,
}

#[derive(Clone, Copy, Debug)]
pub struct MaterialState {
    pub ambient: DVec4,
    pub diffuse: DVec4,
    pub specular: DVec4,
    pub emission: DVec4,
    pub shininess: f64,
}

impl MaterialState {
    /// Sets the colour that GL calls `name`; GL_AMBIENT_AND_DIFFUSE is what is left.
    pub fn set(&mut self, name: u32, color: DVec4) {
        match name {
            raw::AMBIENT => self.ambient = color,
            raw::DIFFUSE => self.diffuse = color,
            raw::SPECULAR => self.specular = color,
            raw::EMISSION => self.emission = color,
            _ => (self.ambient, self.diffuse) = (color, color),
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct FogState {
    pub mode: u32,
    pub source: u32,
    pub density: f64,
    pub start: f64,
    pub end: f64,
    pub color: DVec4,
}

/// Combiner of RGB or of alpha: function, sources, operands, scale.
#[derive(Clone, Copy, Debug)]
pub struct CombinerState {
    pub function: u32,
    pub sources: [u32; 3],
    pub operands: [u32; 3],
    pub scale: f64,
}

#[derive(Clone, Debug)]
pub struct FixedUnit {
    /// Targets and coordinates that are on.
    pub on: Switches,
    /// Textures by target: 1D, 2D, 3D, cube map.
    pub bound: [Option<usize>; 4],
    pub mode: u32,
    pub constant: DVec4,
    pub rgb: CombinerState,
    pub alpha: CombinerState,
    pub generate: [u32; 4],
    pub object_planes: [DVec4; 4],
    /// Times the inverse of the modelview under which they were given.
    pub eye_planes: [DVec4; 4],
}

/// Parameters of a texture.
#[derive(Clone, Copy, Debug)]
pub struct TextureState {
    pub linear: bool,
    pub wrap: [u32; 3],
    pub compares: bool,
    pub function: u32,
    /// DEPTH_TEXTURE_MODE.
    pub mode: u32,
}

/// Values that vertices have which are given none.
#[derive(Clone, Copy, Debug)]
pub struct CurrentState {
    pub color: DVec4,
    pub secondary: DVec3,
    pub normal: DVec3,
    pub fog: f64,
    pub coordinates: [DVec4; FIXED_UNITS],
}

#[derive(Clone, Debug)]
pub struct FixedState {
    pub matrix_mode: u32,
    pub modelview: Vec<DMat4>,
    pub projection: Vec<DMat4>,
    pub texture_matrices: [Vec<DMat4>; FIXED_UNITS],
    pub active: usize,
    pub units: [FixedUnit; FIXED_UNITS],
    pub textures: Vec<TextureState>,
    /// Switches that are no unit's.
    pub on: Switches,
    pub lights: [LightState; LIGHTS],
    pub scene_ambient: DVec4,
    pub two_side: bool,
    pub local_viewer: bool,
    pub separate: bool,
    /// Front and back.
    pub materials: [MaterialState; 2],
    pub color_material: [u32; 2],
    pub shade: u32,
    pub front: u32,
    pub fog: FogState,
    pub alpha_test: (u32, f64),
    /// In eye space.
    pub planes: [DVec4; PLANES],
    pub current: CurrentState,
    pub background: DVec4,
    pub lists: [Vec<FixedCommand>; 3],
    /// Masks of glPushAttrib, and what was in force.
    pub saved: Vec<(u32, Box<FixedState>)>,
}

/// Index of a texture's target.
pub fn target_index(target: u32) -> usize {
    match target {
        glow::TEXTURE_1D => 0,
        glow::TEXTURE_2D => 1,
        glow::TEXTURE_3D => 2,
        _ => 3,
    }
}

pub const TARGETS: [u32; 4] = [glow::TEXTURE_1D, glow::TEXTURE_2D, glow::TEXTURE_3D, glow::TEXTURE_CUBE_MAP];

impl FixedState {
    /// As a context starts, with so many textures.
    pub fn new(textures: usize) -> Self {
        let black = DVec4::W;
        let light = |index: usize| LightState {
            ambient: black,
            diffuse: if index == 0 { DVec4::ONE } else { black },
            specular: if index == 0 { DVec4::ONE } else { black },
            position: DVec4::Z,
            direction: DVec3::NEG_Z,
            exponent: 0.0,
            cutoff: 180.0,
            attenuation: DVec3::X,
        };
        let material = MaterialState {
            ambient: DVec4::new(0.2, 0.2, 0.2, 1.0),
            diffuse: DVec4::new(0.8, 0.8, 0.8, 1.0),
            specular: black,
            emission: black,
            shininess: 0.0,
        };
        let sources = [glow::TEXTURE, raw::PREVIOUS, raw::CONSTANT];
        let combiner = |operands| CombinerState { function: raw::MODULATE, sources, operands, scale: 1.0 };
        let unit = FixedUnit {
            on: Switches::default(),
            bound: [None; 4],
            mode: raw::MODULATE,
            constant: DVec4::ZERO,
            rgb: combiner([glow::SRC_COLOR, glow::SRC_COLOR, glow::SRC_ALPHA]),
            alpha: combiner([glow::SRC_ALPHA; 3]),
            generate: [raw::EYE_LINEAR; 4],
            object_planes: [DVec4::X, DVec4::Y, DVec4::ZERO, DVec4::ZERO],
            eye_planes: [DVec4::X, DVec4::Y, DVec4::ZERO, DVec4::ZERO],
        };
        let texture = TextureState {
            linear: false,
            wrap: [glow::REPEAT; 3],
            compares: false,
            function: glow::LEQUAL,
            mode: raw::LUMINANCE,
        };
        let one = vec![DMat4::IDENTITY];
        Self {
            matrix_mode: raw::MODELVIEW,
            modelview: one.clone(),
            projection: one.clone(),
            texture_matrices: std::array::from_fn(|_| one.clone()),
            active: 0,
            units: std::array::from_fn(|_| unit.clone()),
            textures: vec![texture; textures],
            on: Switches::default(),
            lights: std::array::from_fn(light),
            scene_ambient: DVec4::new(0.2, 0.2, 0.2, 1.0),
            two_side: false,
            local_viewer: false,
            separate: false,
            materials: [material; 2],
            color_material: [glow::FRONT_AND_BACK, raw::AMBIENT_AND_DIFFUSE],
            shade: raw::SMOOTH,
            front: glow::CCW,
            fog: FogState {
                mode: raw::EXP,
                source: raw::FRAGMENT_DEPTH,
                density: 1.0,
                start: 0.0,
                end: 1.0,
                color: DVec4::ZERO,
            },
            alpha_test: (glow::ALWAYS, 0.0),
            planes: [DVec4::ZERO; PLANES],
            current: CurrentState {
                color: DVec4::ONE,
                secondary: DVec3::ZERO,
                normal: DVec3::Z,
                fog: 0.0,
                coordinates: [DVec4::W; FIXED_UNITS],
            },
            background: DVec4::ZERO,
            lists: [const { Vec::new() }; 3],
            saved: Vec::new(),
        }
    }

    pub fn top(stack: &[DMat4]) -> DMat4 {
        stack.last().copied().unwrap_or_default()
    }

    /// The stack that matrix commands change.
    pub fn stack(&mut self) -> &mut Vec<DMat4> {
        match self.matrix_mode {
            raw::PROJECTION => &mut self.projection,
            glow::TEXTURE => &mut self.texture_matrices[self.active],
            _ => &mut self.modelview,
        }
    }

    /// The texture of a unit that is in force: cube map before 3D before 2D before 1D [GL 4.6 compatibility, 16.1].
    pub fn texture_of(&self, unit: usize) -> Option<usize> {
        let unit = &self.units[unit];
        let target = TARGETS.into_iter().rev().find(|target| unit.on.has(*target))?;
        unit.bound[target_index(target)]
    }
}
