//! Commands of the fixed-function pipeline as plain data, and a player that gives them one at a time: each is one call, and all
//! that an earlier command set stays in force.

mod draw;
mod player;

pub use player::FixedPlayer;

/// Texture units that are used.
pub const FIXED_UNITS: usize = 4;

/// One command. Enums are GL's numbers.
#[derive(Clone, Debug)]
pub enum FixedCommand {
    /// glEnable or glDisable; a unit's switches are those of the active one.
    Switch(u32, bool),
    ActiveTexture(u32),
    /// glBindTexture of a slot to its target.
    Texture(usize),
    /// glTexParameteri of the texture that is bound to a target.
    TexParameter(u32, u32, i32),
    /// glTexEnvi.
    TexEnv(u32, i32),
    /// glTexEnvf of RGB_SCALE or ALPHA_SCALE.
    TexEnvScale(u32, f32),
    TexEnvColor([f32; 4]),
    /// glTexGeni of a coordinate's mode.
    TexGenMode(u32, u32),
    /// glTexGenfv, or glTexGendv, of a coordinate: name and plane.
    TexGenPlane(u32, u32, [f32; 4], bool),
    MatrixMode(u32),
    LoadIdentity,
    LoadMatrix([f32; 16]),
    MultMatrix([f32; 16]),
    Translate([f32; 3]),
    Scale([f32; 3]),
    /// Degrees and an axis.
    Rotate(f32, [f32; 3]),
    PushMatrix,
    PopMatrix,
    /// glLightfv of a light's number.
    Light(u32, u32, [f32; 4]),
    /// glLightf.
    LightNumber(u32, u32, f32),
    /// glLightModeli.
    LightModel(u32, i32),
    SceneAmbient([f32; 4]),
    /// glMaterialfv of faces.
    Material(u32, u32, [f32; 4]),
    Shininess(u32, f32),
    ColorMaterial(u32, u32),
    ShadeModel(u32),
    FrontFace(u32),
    /// glFogi.
    Fog(u32, i32),
    /// glFogf.
    FogNumber(u32, f32),
    FogColor([f32; 4]),
    AlphaFunc(u32, f32),
    ClipPlane(u32, [f64; 4]),
    PushAttrib(u32),
    PopAttrib,
    Color([f32; 4]),
    SecondaryColor([f32; 3]),
    Normal([f32; 3]),
    FogCoord(f32),
    MultiTexCoord(u32, [f32; 4]),
    /// glNewList with these commands, and glEndList.
    NewList(usize, Vec<FixedCommand>),
    CallList(usize),
    /// glClear of colour.
    Clear([f32; 4]),
    Draw(FixedFigure),
}

/// A vertex, with all that it may be given.
#[derive(Clone, Copy, Debug)]
pub struct FixedVertex {
    pub position: [f32; 4],
    pub color: [f32; 4],
    pub secondary: [f32; 3],
    pub normal: [f32; 3],
    pub fog: f32,
    pub coordinates: [[f32; 4]; FIXED_UNITS],
}

/// Attributes that each vertex is given; others are the current values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct FixedGiven {
    pub color: bool,
    pub secondary: bool,
    pub normal: bool,
    pub fog: bool,
    pub coordinates: [bool; FIXED_UNITS],
}

/// The way that vertices come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixedWay {
    /// glBegin and glEnd.
    Immediate,
    /// glDrawArrays from the client's memory.
    Arrays,
    /// glDrawElements from there.
    Elements,
    /// glDrawElements from buffers, one for each attribute.
    Buffers,
}

/// Primitives and their vertices.
#[derive(Clone, Debug)]
pub struct FixedFigure {
    pub primitive: u32,
    /// Vertices of each glBegin or draw; all are of one length.
    pub length: usize,
    pub vertices: Vec<FixedVertex>,
    pub given: FixedGiven,
    pub way: FixedWay,
}

/// A texture: its target, internal format and size, and its texels as the client has them, of four bytes or of one float.
#[derive(Clone, Debug)]
pub struct FixedTexture {
    pub target: u32,
    pub format: u32,
    pub size: [u32; 3],
    pub texels: Vec<[u8; 4]>,
    /// Depths, where the format is one of depth.
    pub depths: Vec<f32>,
}
