//! Faults that the generated rule of the fixed-function pipeline was tried on.

use super::{Call, ignore};
use crate::context::compatibility::raw;

/// Makes a call while the modelview is the identity.
fn under_identity(call: &mut Call) {
    let mode = call.get(raw::MATRIX_MODE);
    call.other("glMatrixMode", &[f64::from(raw::MODELVIEW)]);
    call.other("glPushMatrix", &[]);
    call.other("glLoadIdentity", &[]);
    call.now();
    call.other("glPopMatrix", &[]);
    call.other("glMatrixMode", &[f64::from(mode)]);
}

/// Takes bits out of a mask of attributes.
fn without(call: &mut Call, bit: u32) {
    let mask = call.u(0) & !bit;
    call.set(0, mask);
}

faults! {
    "specular-of-later-lights-kept" [glLightfv GL_SPECULAR]
    "The specular light of light 2 and of those after it stays as it was." {
        glLightfv => |call| if call.u(0) >= raw::LIGHT0 + 2 { ignore(call, raw::SPECULAR) }
    }
    "spot-exponent-of-first-light" [glLightf GL_SPOT_EXPONENT]
    "Light 0 alone has a spot exponent." {
        glLightf => |call| if call.u(0) > raw::LIGHT0 { ignore(call, raw::SPOT_EXPONENT) }
    }
    "quadratic-attenuation-halved" [glLightf GL_QUADRATIC_ATTENUATION]
    "Quadratic attenuation is half of itself." {
        glLightf => |call| if call.u(1) == raw::QUADRATIC_ATTENUATION { let half = call.f(2) / 2.0; call.set(2, half); }
    }
    "ambient-material-takes-diffuse-too" [glColorMaterial GL_AMBIENT]
    "A colour that is the ambient material is the diffuse one too." {
        glColorMaterial => |call| { call.replace(1, raw::AMBIENT, raw::AMBIENT_AND_DIFFUSE); }
    }
    "fog-not-saved" [glPushAttrib GL_FOG_BIT] "glPushAttrib does not save fog." { glPushAttrib => |call| without(call, raw::FOG_BIT) }
    "current-not-saved" [glPushAttrib GL_CURRENT_BIT] "glPushAttrib does not save current values." { glPushAttrib => |call| without(call, raw::CURRENT_BIT) }
    "fog-exp2-is-exp" [glFogi GL_EXP2] "EXP2 is EXP." { glFogi => |call| { call.replace(1, raw::EXP2, raw::EXP); } }
    "clip-planes-not-transformed" [glClipPlane] "Clip planes are given in eye space." { glClipPlane => under_identity }
    "decal-is-replace" [GL_DECAL glTexEnvi] "DECAL is REPLACE." { glTexEnvi => |call| if call.u(1) == raw::TEXTURE_ENV_MODE { call.replace(2, raw::DECAL, glow::REPLACE); } }
    "color-arrays-opaque" [glColorPointer]
    "Colours of arrays have alpha 1." { glColorPointer => |call| call.set(0, 3) }
}
