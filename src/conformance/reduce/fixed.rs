//! Effects of calls on the fixed-function pipeline's state.

use super::effects::Tracker;
use super::log::Recorded;
use super::state::{Effects, State, faces, text};
use crate::context::compatibility::raw;

/// Functions that ask, or wait.
const WITHOUT_EFFECT: &[&str] = &[
    "glFinish",
    "glFlush",
    "glGetIntegerv",
    "glGetFloatv",
    "glGetQueryObjectiv",
    "glGetTexGenfv",
    "glGetTexImage",
    "glGetTexLevelParameteriv",
];

impl Tracker {
    /// State of the fixed-function pipeline.
    pub(super) fn fixed(&mut self, call: &Recorded, unit: u32, numbers: &[f64]) -> Effects {
        let rest = |from: usize| text(&numbers[from.min(numbers.len())..]);
        let one = |key: String, value: String| Effects::set(vec![(key, value)], Vec::new());
        let matrix =
            |mode: u32| if mode == glow::TEXTURE { format!("matrix:{mode}:{unit}") } else { format!("matrix:{mode}") };
        let modelview = matrix(raw::MODELVIEW);
        // What is transformed as it is set: its value is that of the matrix, too.
        let under = |value: String, state: &State| format!("{value}|{}", state.get(&modelview).unwrap_or_default());
        match call.name {
            "glMatrixMode" => one("MatrixMode".into(), rest(0)),
            "glLoadIdentity" | "glLoadMatrixf" | "glLoadMatrixd" | "glMultMatrixf" | "glMultMatrixd" | "glScalef"
            | "glTranslatef" => {
                let key = matrix(self.state.number("MatrixMode") as u32);
                let reads = vec!["MatrixMode".to_owned(), "ActiveTexture".to_owned()];
                match call.name {
                    "glLoadIdentity" => Effects::set(vec![(key, "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1".into())], reads),
                    "glLoadMatrixf" | "glLoadMatrixd" => Effects::set(vec![(key, rest(0))], reads),
                    _ => {
                        let sets = vec![(key.clone(), format!("product {}", self.serial))];
                        Effects { writes: vec![key], kills: false, reads, sets }
                    }
                }
            }
            "glTexEnvi" | "glTexEnvf" | "glTexEnvfv" => {
                let key = format!("texenv:{unit}:{}:{}", call.u(0), call.u(1));
                Effects::set(vec![(key, rest(2))], vec!["ActiveTexture".into()])
            }
            "glTexGeni" | "glTexGenfv" | "glTexGendv" => {
                let is_eye = call.u(1) == raw::EYE_PLANE;
                let value = if is_eye { under(rest(2), &self.state) } else { rest(2) };
                let mut reads = vec!["ActiveTexture".into()];
                reads.extend(is_eye.then_some(modelview));
                Effects::set(vec![(format!("texgen:{unit}:{}:{}", call.u(0), call.u(1)), value)], reads)
            }
            "glGetTexGendv" => {
                let reads = vec![format!("texgen:{unit}:{}:{}", call.u(0), call.u(1)), "ActiveTexture".into()];
                Effects::change(Vec::new(), reads)
            }
            "glLightf" | "glLightfv" => {
                let value = under(rest(2), &self.state);
                Effects::set(vec![(format!("light:{}:{}", call.u(0), call.u(1)), value)], vec![modelview])
            }
            "glLightModeli" | "glLightModelfv" | "glFogf" | "glFogi" | "glFogfv" | "glColorMaterial" => {
                one(format!("fixed:{}:{}", call.name.trim_end_matches(['f', 'i', 'v']), call.u(0)), rest(1))
            }
            "glMaterialf" | "glMaterialfv" => {
                let names: &[u32] = match call.u(1) {
                    raw::AMBIENT_AND_DIFFUSE => &[raw::AMBIENT, raw::DIFFUSE],
                    _ => &[call.u(1)],
                };
                let sets = names.iter().flat_map(|name| faces(call, &format!("material:{name}"), &rest(2)));
                Effects::set(sets.collect(), Vec::new())
            }
            "glColor4f" | "glColor4fv" => one("current:color".into(), rest(0)),
            "glNormal3f" | "glNormal3fv" => one("current:normal".into(), rest(0)),
            "glTexCoord4fv" => one(format!("current:{}", glow::TEXTURE0), rest(0)),
            "glMultiTexCoord4fv" => one(format!("current:{}", call.u(0)), rest(1)),
            name => {
                if !WITHOUT_EFFECT.contains(&name) {
                    self.unknown.get_or_insert(name);
                }
                Effects::default()
            }
        }
    }
}
