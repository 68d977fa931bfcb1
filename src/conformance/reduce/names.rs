//! Names of GL's constants.

use std::collections::BTreeMap;

/// Every constant of OpenGL 4.6, compatibility profile, with its value: from Khronos's registry, by the build script.
const NAMES: &[(&str, u32)] = include!(concat!(env!("OUT_DIR"), "/enum_names.rs"));

/// Values of one name each.
pub struct Names(BTreeMap<u32, &'static str>);

impl Names {
    pub fn new() -> Self {
        let mut names: BTreeMap<u32, &'static str> = BTreeMap::new();
        for (name, value) in NAMES.iter().filter(|(_, value)| *value > 0x40) {
            // Of two, the shorter: GL_SRC0_RGB, not GL_SOURCE0_RGB.
            let known = names.entry(*value).or_insert(name);
            // A mask's bit may have the number of an enum.
            let is_better = known.ends_with("_BIT") || (name.len() < known.len() && !name.ends_with("_BIT"));
            if is_better {
                *known = name;
            }
        }
        Self(names)
    }

    /// The name of an enum; its small numbers mean another in each function.
    pub fn of(&self, function: &str, value: u32) -> Option<&'static str> {
        const PRIMITIVES: [&str; 7] = [
            "GL_POINTS",
            "GL_LINES",
            "GL_LINE_LOOP",
            "GL_LINE_STRIP",
            "GL_TRIANGLES",
            "GL_TRIANGLE_STRIP",
            "GL_TRIANGLE_FAN",
        ];
        match (function, value) {
            (
                "glBegin"
                | "glDrawArrays"
                | "glDrawArraysInstanced"
                | "glDrawElements"
                | "glDrawElementsInstanced"
                | "glDrawElementsBaseVertex",
                mode,
            ) => PRIMITIVES.get(mode as usize).copied(),
            (name, 0) if name.contains("Blend") || name.contains("StencilOp") => Some("GL_ZERO"),
            (name, 1) if name.contains("Blend") => Some("GL_ONE"),
            (name, 0) if name.contains("Buffer") => Some("GL_NONE"),
            (_, value) => self.0.get(&value).copied(),
        }
    }

    /// Names of bits.
    pub fn bits(value: u32) -> Vec<&'static str> {
        let known = [
            (glow::COLOR_BUFFER_BIT, "GL_COLOR_BUFFER_BIT"),
            (glow::DEPTH_BUFFER_BIT, "GL_DEPTH_BUFFER_BIT"),
            (glow::STENCIL_BUFFER_BIT, "GL_STENCIL_BUFFER_BIT"),
        ];
        known.into_iter().filter(|(bit, _)| value & bit != 0).map(|(_, name)| name).collect()
    }

    /// The value of a name.
    pub fn value(name: &str) -> Option<u32> {
        if let Some(truth) = ["GL_FALSE", "GL_TRUE"].iter().position(|known| *known == name) {
            return Some(truth as u32);
        }
        NAMES.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
    }
}
