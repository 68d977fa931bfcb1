//! Faults that the generated rule of the fixed-function pipeline was tried on.

use super::Call;
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
    "fog-not-saved" [glPushAttrib GL_FOG_BIT] "glPushAttrib does not save fog." { glPushAttrib => |call| without(call, raw::FOG_BIT) }
    "fog-exp2-is-exp" [glFogi GL_EXP2] "EXP2 is EXP." { glFogi => |call| { call.replace(1, raw::EXP2, raw::EXP); } }
    "clip-planes-not-transformed" [glClipPlane] "Clip planes are given in eye space." { glClipPlane => under_identity }
    "decal-is-replace" [GL_DECAL glTexEnvi] "DECAL is REPLACE." { glTexEnvi => |call| if call.u(1) == raw::TEXTURE_ENV_MODE { call.replace(2, raw::DECAL, glow::REPLACE); } }
    "color-arrays-opaque" [glColorPointer]
    "Colours of arrays have alpha 1." { glColorPointer => |call| call.set(0, 3) }
}
