//! Faults of the fixed-function pipeline's lighting.

use super::{ignore, never_on};
use crate::context::compatibility::raw;

faults! {
    "lighting-ignored" [GL_LIGHTING] "There is no lighting." { glEnable => |call| never_on(call, raw::LIGHTING) }
    "lighting-stays-on" [GL_LIGHTING glDisable] "Lighting stays on once it was." { glDisable => |call| never_on(call, raw::LIGHTING) }
    "light-0-off" [GL_LIGHT0] "Light 0 is off." { glEnable => |call| never_on(call, raw::LIGHT0) }
    "lights-beyond-first-off" [GL_LIGHT0] "Lights beyond the first are off." {
        glEnable => |call| if (raw::LIGHT1..=raw::LIGHT7).contains(&call.u(0)) { call.skip() }
    }
    "normalize-off" [GL_NORMALIZE] "Normals are not made of unit length." { glEnable => |call| never_on(call, raw::NORMALIZE) }
    "color-sum-on" [GL_COLOR_SUM] "The secondary colour stays added." (hole: "the secondary colour is black, as nothing sets another") { glDisable => |call| never_on(call, raw::COLOR_SUM) }
    "color-material-on" [GL_COLOR_MATERIAL] "The primary colour stays the material's." {
        glDisable => |call| never_on(call, raw::COLOR_MATERIAL);
        glEnable => |call| if call.u(0) == raw::LIGHTING { call.other("glEnable", &[f64::from(raw::COLOR_MATERIAL)]) }
    }
    "shading-flat" [glShadeModel GL_SMOOTH] "Primary colours are those of each triangle's last vertex." { glShadeModel => |call| call.set(0, raw::FLAT) }
    "scene-ambient-ignored" [GL_LIGHT_MODEL_AMBIENT glLightModelfv] "The scene's ambient light is 0.2." { glLightModelfv => |call| call.skip() }
    "viewer-is-local" [GL_LIGHT_MODEL_LOCAL_VIEWER glLightModeli] "Highlights are those of a viewer at the eye." {
        glLightModeli => |call| if call.u(0) == raw::LIGHT_MODEL_LOCAL_VIEWER { call.set(1, 1) }
    }
    "lit-on-both-sides" [GL_LIGHT_MODEL_TWO_SIDE glLightModeli] "Back faces are lit by the turned normal." {
        glLightModeli => |call| if call.u(0) == raw::LIGHT_MODEL_TWO_SIDE { call.set(1, 1) }
    }
    "material-emission-ignored" [GL_EMISSION glMaterialfv] "Materials do not emit." { glMaterialfv => |call| ignore(call, raw::EMISSION) }
    "material-ambient-ignored" [GL_AMBIENT glMaterialfv] "The ambient colour of materials is 0.2." { glMaterialfv => |call| ignore(call, raw::AMBIENT) }
    "material-diffuse-ignored" [GL_DIFFUSE glMaterialfv] "The diffuse colour of materials is 0.8." { glMaterialfv => |call| ignore(call, raw::DIFFUSE) }
    "material-specular-ignored" [GL_SPECULAR glMaterialfv] "Materials have no highlights." { glMaterialfv => |call| ignore(call, raw::SPECULAR) }
    "material-of-back-only" [GL_FRONT_AND_BACK glMaterialfv glMaterialf] "Materials are those of back faces." {
        glMaterialfv glMaterialf => |call| call.set(0, glow::BACK)
    }
    "shininess-ignored" [GL_SHININESS glMaterialf] "The exponent of highlights is 0." { glMaterialf => |call| call.skip() }
    "light-position-ignored" [GL_POSITION glLightfv] "Lights shine along the view." { glLightfv => |call| ignore(call, raw::POSITION) }
    "light-ambient-ignored" [GL_AMBIENT glLightfv] "Lights have no ambient part." { glLightfv => |call| ignore(call, raw::AMBIENT) }
    "light-diffuse-ignored" [GL_DIFFUSE glLightfv] "The diffuse part of light 0 is 1, of others 0." { glLightfv => |call| ignore(call, raw::DIFFUSE) }
    "light-specular-ignored" [GL_SPECULAR glLightfv] "The specular part of light 0 is 1, of others 0." { glLightfv => |call| ignore(call, raw::SPECULAR) }
    "spot-cutoff-narrow" [GL_SPOT_CUTOFF glLightf] "Lights are cones of 20 degrees." { glLightf => |call| if call.u(1) == raw::SPOT_CUTOFF { call.set(2, 20) } }
    "constant-attenuation-ignored" [GL_CONSTANT_ATTENUATION glLightf] "The constant attenuation is 1." { glLightf => |call| ignore(call, raw::CONSTANT_ATTENUATION) }
    "linear-attenuation-ignored" [GL_LINEAR_ATTENUATION glLightf] "The linear attenuation is 0." { glLightf => |call| ignore(call, raw::LINEAR_ATTENUATION) }
    "quadratic-attenuation-ignored" [GL_QUADRATIC_ATTENUATION glLightf] "The quadratic attenuation is 0." { glLightf => |call| ignore(call, raw::QUADRATIC_ATTENUATION) }
}
