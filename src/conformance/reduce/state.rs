//! State of GL that a call sets, as keys with values; and the values that a new context has.

use std::collections::BTreeMap;

use super::log::Recorded;

/// A part of GL's state, or of an object: what is written, read and overwritten.
pub type Key = String;

/// Effects of a call on the state.
#[derive(Clone, Debug, Default)]
pub struct Effects {
    pub writes: Vec<Key>,
    /// The written no longer depends on what was there.
    pub kills: bool,
    pub reads: Vec<Key>,
    /// Values that are set, by key.
    pub sets: Vec<(Key, String)>,
}

impl Effects {
    /// Sets keys to values, whatever they were.
    pub fn set(sets: Vec<(Key, String)>, reads: Vec<Key>) -> Self {
        Self { writes: sets.iter().map(|(key, _)| key.clone()).collect(), kills: true, reads, sets }
    }

    /// Writes keys anew.
    pub fn make(writes: Vec<Key>, reads: Vec<Key>) -> Self {
        Self { writes, kills: true, reads, sets: Vec::new() }
    }

    /// OtherAnswers what is there.
    pub fn change(writes: Vec<Key>, reads: Vec<Key>) -> Self {
        Self { writes, kills: false, reads, sets: Vec::new() }
    }
}

/// Values in a line.
pub fn text(numbers: &[f64]) -> String {
    numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}

/// The values that are in force.
#[derive(Clone, Debug, Default)]
pub struct State {
    values: BTreeMap<Key, String>,
}

impl State {
    /// The value of a key; of a new context where none was set.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.values.get(key).map(String::as_str).or_else(|| default(key))
    }

    pub fn number(&self, key: &str) -> f64 {
        self.get(key).and_then(|value| value.parse().ok()).unwrap_or(0.0)
    }

    pub fn numbers(&self, key: &str) -> Vec<f64> {
        self.get(key).into_iter().flat_map(|value| value.split(',').filter_map(|number| number.parse().ok())).collect()
    }

    pub fn is_on(&self, cap: u32) -> bool {
        self.number(&format!("cap:{cap:04X}")) != 0.0
    }

    pub fn put(&mut self, sets: &[(Key, String)]) {
        sets.iter().for_each(|(key, value)| {
            self.values.insert(key.clone(), value.clone());
        });
    }

    /// Tests whether the values are in force already.
    pub fn has(&self, sets: &[(Key, String)]) -> bool {
        !sets.is_empty() && sets.iter().all(|(key, value)| self.get(key) == Some(value))
    }

    /// Keys that were set and begin so.
    pub fn keys<'a>(&'a self, prefix: &'a str) -> impl Iterator<Item = &'a Key> {
        self.values.range(prefix.to_owned()..).map(|(key, _)| key).take_while(move |key| key.starts_with(prefix))
    }
}

/// Values of a new context [GL 4.6, chapter 23].
fn default(key: &str) -> Option<&'static str> {
    let (head, tail) = key.split_once(':').unwrap_or((key, ""));
    let last = tail.rsplit(':').next().unwrap_or("");
    Some(match head {
        "unitcap" | "uni" => "0",
        "cap" => {
            if matches!(tail, "0BD0" | "809D") {
                "1"
            } else {
                "0"
            }
        }
        "glDepthFunc" => "513",
        "glDepthMask" | "ClearDepth" | "glLineWidth" | "glPointSize" => "1",
        "DepthRange" => "0,1",
        "glClearColor" | "glBlendColor" | "TextureBorder" => "0,0,0,0",
        "glClearStencil" => "0",
        "glCullFace" => "1029",
        "glFrontFace" => "2305",
        "PolygonMode" => "6914",
        "PolygonOffset" => "0,0,0",
        "StencilOp" => "7680,7680,7680",
        "BlendFunc" => "1,0,1,0",
        "BlendEquation" => "32774,32774",
        "glColorMask" | "current" if head == "glColorMask" || tail == "color" => "1,1,1,1",
        "current" if tail != "normal" => "0,0,0,1",
        "ActiveTexture" => "33984",
        "glPixelStorei" => {
            if matches!(last, "0CF5" | "0D05") {
                "4"
            } else {
                "0"
            }
        }
        "glPixelTransferf" => {
            if last == "0D1E" {
                "1"
            } else {
                "0"
            }
        }
        "tex" | "sampler" | "Program" | "VertexArray" | "ArrayBuffer" | "ElementBuffer" | "DrawFramebuffer"
        | "ReadFramebuffer" | "Renderbuffer" | "attron" => "0",
        "glAlphaFunc" => "519,0",
        "glShadeModel" => "7425",
        "MatrixMode" => "5888",
        "matrix" => "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1",
        "fb" if last == "draw" || last == "read" => "36064",
        "texpar" | "sampar" => match last {
            "2801" => "9986",
            "2800" => "9729",
            "2802" | "2803" | "8072" => "10497",
            "813A" => "-1000",
            "813B" | "813D" => "1000",
            "813C" | "884C" | "8501" => "0",
            "884D" => "515",
            "1004" => "0,0,0,0",
            "8E42" => "6403",
            "8E43" => "6404",
            "8E44" => "6405",
            "8E45" => "6406",
            _ => return None,
        },
        _ => return None,
    })
}

/// Keys of the faces that a call names.
pub fn faces(call: &Recorded, head: &str, value: &str) -> Vec<(Key, String)> {
    let sides: &[&str] = match call.u(0) {
        glow::FRONT => &["front"],
        glow::BACK => &["back"],
        _ => &["front", "back"],
    };
    sides.iter().map(|side| (format!("{head}:{side}"), value.to_owned())).collect()
}
