//! Faults of the fixed-function pipeline: matrices, generated coordinates, environments, alpha test, lighting.

use super::{Call, ignore, never_on};
use crate::context::compatibility::raw;

/// Sources of the environments' arguments.
const SOURCES: [u32; 6] =
    [raw::SRC0_RGB, raw::SRC1_RGB, raw::SRC2_RGB, raw::SRC0_ALPHA, glow::SRC1_ALPHA, raw::SRC2_ALPHA];

/// Puts a function of GL_COMBINE where another is wanted.
fn combine(call: &mut Call, from: u32, to: u32) {
    if [raw::COMBINE_RGB, raw::COMBINE_ALPHA].contains(&call.u(1)) {
        call.replace(2, from, to);
    }
}

/// Puts a source where another is wanted.
fn source(call: &mut Call, from: u32, to: u32) {
    if SOURCES.contains(&call.u(1)) {
        call.replace(2, from, to);
    }
}

/// A matrix by rows.
fn transpose(call: &mut Call) {
    let values = call.floats(0, 16);
    let turned = (0..16).map(|index| values[index % 4 * 4 + index / 4]).collect();
    call.set_floats(0, turned);
}

faults! {
    "alpha-test-ignored" [GL_ALPHA_TEST]
    "There is no alpha test." { glEnable => |call| never_on(call, raw::ALPHA_TEST) }
    "alpha-test-stays-on" [GL_ALPHA_TEST glDisable]
    "The alpha test stays on once it was." { glDisable => |call| never_on(call, raw::ALPHA_TEST) }
    "alpha-func-turned" [glAlphaFunc]
    "GREATER and LESS, and their forms with equality, are exchanged in the alpha test." {
        glAlphaFunc => |call| {
            call.exchange(0, glow::GREATER, glow::LESS);
            call.exchange(0, glow::GEQUAL, glow::LEQUAL);
        }
    }
    "alpha-reference-ignored" [glAlphaFunc]
    "The reference of the alpha test is 0." { glAlphaFunc => |call| call.set(1, 0) }
    "texture-matrix-ignored" [glMatrixMode GL_TEXTURE]
    "The texture matrix is the identity." {
        glLoadMatrixf glLoadMatrixd glScalef glTranslatef => |call| if call.get(raw::MATRIX_MODE) as u32 == glow::TEXTURE { call.skip() }
    }
    "projection-is-modelview" [glMatrixMode GL_PROJECTION GL_MODELVIEW]
    "The projection is the modelview and the other way round." { glMatrixMode => |call| call.exchange(0, raw::PROJECTION, raw::MODELVIEW) }
    "identity-ignored" [glLoadIdentity]
    "glLoadIdentity leaves the matrix." { glLoadIdentity => |call| call.skip() }
    "loaded-matrix-transposed" [glLoadMatrixf]
    "A loaded matrix is transposed." { glLoadMatrixf => transpose }
    "multiplied-matrix-transposed" [glMultMatrixf GL_PROJECTION_MATRIX]
    "A matrix that is multiplied is transposed." { glMultMatrixf => transpose }
    "scale-ignored" [glScalef]
    "glScalef leaves the matrix." { glScalef => |call| call.skip() }
    "translation-ignored" [glTranslatef]
    "glTranslatef leaves the matrix." { glTranslatef => |call| call.skip() }
    "eye-planes-are-object-planes" [glTexGeni GL_EYE_LINEAR GL_EYE_PLANE]
    "EYE_LINEAR takes the vertex in model space." {
        glTexGeni => |call| { call.replace(2, raw::EYE_LINEAR, raw::OBJECT_LINEAR); };
        glTexGenfv glTexGendv => |call| { call.replace(1, raw::EYE_PLANE, raw::OBJECT_PLANE); }
    }
    "object-planes-are-eye-planes" [glTexGeni GL_OBJECT_LINEAR GL_OBJECT_PLANE]
    "OBJECT_LINEAR takes the vertex in eye space." {
        glTexGeni => |call| { call.replace(2, raw::OBJECT_LINEAR, raw::EYE_LINEAR); };
        glTexGenfv glTexGendv => |call| { call.replace(1, raw::OBJECT_PLANE, raw::EYE_PLANE); }
    }
    "eye-planes-not-kept" [glTexGenfv GL_EYE_PLANE]
    "glTexGenfv does not keep eye planes." { glTexGenfv => |call| ignore(call, raw::EYE_PLANE) }
    "object-planes-not-kept" [glTexGenfv GL_OBJECT_PLANE]
    "glTexGenfv does not keep object planes." { glTexGenfv => |call| ignore(call, raw::OBJECT_PLANE) }
    "texgen-mode-ignored" [GL_TEXTURE_GEN_MODE glTexGeni]
    "Coordinates are generated from the vertex in eye space whatever the mode." { glTexGeni => |call| call.skip() }
    "texgen-s-is-t" [GL_TEXTURE_GEN_S GL_TEXTURE_GEN_T GL_S GL_T]
    "Planes of s and t are exchanged." { glTexGenfv glTexGendv => |call| call.exchange(0, raw::S, raw::T) }
    "texgen-s-off" [GL_TEXTURE_GEN_S] "s is not generated." { glEnable => |call| never_on(call, raw::TEXTURE_GEN_S) }
    "texgen-t-off" [GL_TEXTURE_GEN_T] "t is not generated." { glEnable => |call| never_on(call, raw::TEXTURE_GEN_T) }
    "texgen-r-off" [GL_TEXTURE_GEN_R] "r is not generated." { glEnable => |call| never_on(call, raw::TEXTURE_GEN_R) }
    "texgen-q-off" [GL_TEXTURE_GEN_Q] "q is not generated." { glEnable => |call| never_on(call, raw::TEXTURE_GEN_Q) }
    "texgen-on-unit-0-only" [GL_TEXTURE_GEN_S glTexGenfv]
    "Coordinates are generated on unit 0 alone." {
        glEnable => |call| if (raw::TEXTURE_GEN_S..=raw::TEXTURE_GEN_Q).contains(&call.u(0)) && call.get(glow::ACTIVE_TEXTURE) as u32 != glow::TEXTURE0 {
            call.skip();
        }
    }
    "texgen-r-is-q" [GL_R GL_Q glTexGenfv]
    "Planes of r and q are exchanged." { glTexGenfv glTexGendv => |call| call.exchange(0, raw::R, raw::Q) }
    "texgen-planes-read-as-zeros" [glGetTexGenfv]
    "Planes that are read back are zeros." {
        glGetTexGenfv => |call| {
            call.now();
            call.write(2, &[0.0_f32; 4]);
        };
        glGetTexGendv => |call| {
            call.now();
            call.write(2, &[0.0_f64; 4]);
        }
    }
    "environment-mode-ignored" [GL_TEXTURE_ENV_MODE GL_COMBINE glTexEnvi GL_TEXTURE_ENV]
    "Environments modulate whatever the mode." { glTexEnvi => |call| ignore(call, raw::TEXTURE_ENV_MODE) }
    "environment-color-ignored" [GL_TEXTURE_ENV_COLOR glTexEnvfv]
    "The environment's constant is 0." { glTexEnvfv => |call| call.skip() }
    "rgb-scale-ignored" [GL_RGB_SCALE glTexEnvf]
    "RGB_SCALE is 1." { glTexEnvf => |call| ignore(call, raw::RGB_SCALE) }
    "alpha-scale-ignored" [GL_ALPHA_SCALE glTexEnvf]
    "ALPHA_SCALE is 1." { glTexEnvf => |call| ignore(call, raw::ALPHA_SCALE) }
    "modulate-is-add" [GL_MODULATE] "MODULATE of GL_COMBINE adds." { glTexEnvi => |call| combine(call, raw::MODULATE, raw::ADD) }
    "subtract-is-add" [GL_SUBTRACT] "SUBTRACT adds." { glTexEnvi => |call| combine(call, raw::SUBTRACT, raw::ADD) }
    "interpolate-is-replace" [GL_INTERPOLATE] "INTERPOLATE takes the first." { glTexEnvi => |call| combine(call, raw::INTERPOLATE, glow::REPLACE) }
    "combine-replace-is-modulate" [GL_REPLACE GL_COMBINE_RGB GL_COMBINE_ALPHA] "REPLACE of GL_COMBINE modulates." { glTexEnvi => |call| combine(call, glow::REPLACE, raw::MODULATE) }
    "add-signed-is-add" [GL_COMBINE_RGB] "ADD_SIGNED adds." { glTexEnvi => |call| combine(call, raw::ADD_SIGNED, raw::ADD) }
    "dot3-rgb-is-modulate" [GL_DOT3_RGB] "DOT3_RGB modulates." { glTexEnvi => |call| combine(call, raw::DOT3_RGB, raw::MODULATE) }
    "dot3-rgba-is-dot3-rgb" [GL_DOT3_RGBA] "DOT3_RGBA leaves alpha." { glTexEnvi => |call| combine(call, raw::DOT3_RGBA, raw::DOT3_RGB) }
    "combine-alpha-ignored" [GL_COMBINE_ALPHA] "The combiner of alpha modulates." { glTexEnvi => |call| ignore(call, raw::COMBINE_ALPHA) }
    "combine-rgb-ignored" [GL_COMBINE_RGB] "The combiner of RGB modulates." { glTexEnvi => |call| ignore(call, raw::COMBINE_RGB) }
    "constant-is-primary" [GL_CONSTANT] "CONSTANT is the primary colour." { glTexEnvi => |call| source(call, raw::CONSTANT, raw::PRIMARY_COLOR) }
    "primary-is-previous" [GL_PRIMARY_COLOR] "PRIMARY_COLOR is the unit before." { glTexEnvi => |call| source(call, raw::PRIMARY_COLOR, raw::PREVIOUS) }
    "previous-is-primary" [GL_PREVIOUS] "PREVIOUS is the primary colour." { glTexEnvi => |call| source(call, raw::PREVIOUS, raw::PRIMARY_COLOR) }
    "texture-source-is-unit-0" [GL_TEXTURE GL_SRC0_RGB] "TEXTURE is that of unit 0." { glTexEnvi => |call| source(call, glow::TEXTURE, glow::TEXTURE0) }
    "crossbar-ignored" [GL_TEXTURE0 GL_SRC1_RGB] "Another unit's texture is the unit's own." {
        glTexEnvi => |call| if SOURCES.contains(&call.u(1)) && (glow::TEXTURE0..glow::TEXTURE0 + 8).contains(&call.u(2)) {
            call.set(2, glow::TEXTURE);
        }
    }
    "second-rgb-source-is-previous" [GL_SRC1_RGB] "The second source of RGB is the unit before." { glTexEnvi => |call| ignore(call, raw::SRC1_RGB) }
    "third-rgb-source-is-constant" [GL_SRC2_RGB] "The third source of RGB is the constant." { glTexEnvi => |call| ignore(call, raw::SRC2_RGB) }
    "first-rgb-source-is-texture" [GL_SRC0_RGB] "The first source of RGB is the texture." { glTexEnvi => |call| ignore(call, raw::SRC0_RGB) }
    "first-alpha-source-is-texture" [GL_SRC0_ALPHA] "The first source of alpha is the texture." { glTexEnvi => |call| ignore(call, raw::SRC0_ALPHA) }
    "second-alpha-source-is-previous" [GL_SRC1_ALPHA] "The second source of alpha is the unit before." { glTexEnvi => |call| ignore(call, glow::SRC1_ALPHA) }
    "third-alpha-source-is-constant" [GL_SRC2_ALPHA] "The third source of alpha is the constant." { glTexEnvi => |call| ignore(call, raw::SRC2_ALPHA) }
    "operand-alpha-is-color" [GL_OPERAND0_RGB GL_SRC_ALPHA GL_SRC_COLOR] "RGB's operands are colours, never alphas." {
        glTexEnvi => |call| if (raw::OPERAND0_RGB..raw::OPERAND0_RGB + 3).contains(&call.u(1)) {
            call.replace(2, glow::SRC_ALPHA, glow::SRC_COLOR);
        }
    }
    "alpha-operand-complemented" [GL_OPERAND0_ALPHA] "The first operand of alpha is 1 less itself." {
        glTexEnvi => |call| if call.u(1) == raw::OPERAND0_ALPHA { call.exchange(2, glow::SRC_ALPHA, glow::ONE_MINUS_SRC_ALPHA) }
    }
    "depth-mode-ignored" [GL_DEPTH_TEXTURE_MODE GL_LUMINANCE GL_INTENSITY]
    "Depth textures are luminance." { glTexParameteri => |call| ignore(call, raw::DEPTH_TEXTURE_MODE) }
    "depth-mode-intensity-is-luminance" [GL_INTENSITY]
    "INTENSITY of a depth texture leaves alpha 1." {
        glTexParameteri => |call| if call.u(1) == raw::DEPTH_TEXTURE_MODE { call.replace(2, raw::INTENSITY, raw::LUMINANCE); }
    }
    "depth-mode-alpha-is-intensity" [GL_ALPHA GL_DEPTH_TEXTURE_MODE]
    "ALPHA of a depth texture sets RGB too." {
        glTexParameteri => |call| if call.u(1) == raw::DEPTH_TEXTURE_MODE { call.replace(2, glow::ALPHA, raw::INTENSITY); }
    }
    "textures-off-beyond-unit-0" [GL_TEXTURE_2D glEnable]
    "2D textures are off on units beyond the first." {
        glEnable => |call| if call.u(0) == glow::TEXTURE_2D && call.get(glow::ACTIVE_TEXTURE) as u32 != glow::TEXTURE0 { call.skip() }
    }
    "texture-cubes-off" [GL_TEXTURE_CUBE_MAP glEnable]
    "Cube maps are off in the fixed-function pipeline." { glEnable => |call| never_on(call, glow::TEXTURE_CUBE_MAP) }
    "primary-color-white" [glColor4f]
    "glColor4f leaves the colour white." { glColor4f glColor4fv => |call| call.skip() }
    "primary-alpha-one" [glColor4f]
    "The alpha of glColor4f is 1." { glColor4f => |call| call.set(3, 1) }
    "client-texture-unit-ignored" [glClientActiveTexture]
    "Arrays of coordinates are those of unit 0." { glClientActiveTexture => |call| call.set(0, glow::TEXTURE0) }
    "coordinates-not-enabled" [glEnableClientState GL_TEXTURE_COORD_ARRAY]
    "Arrays of coordinates are not read." { glEnableClientState => |call| never_on(call, raw::TEXTURE_COORD_ARRAY) }
    "vertices-not-enabled" [glEnableClientState GL_VERTEX_ARRAY]
    "Arrays of positions are not read." { glEnableClientState => |call| never_on(call, raw::VERTEX_ARRAY) }
    "normals-not-enabled" [glEnableClientState GL_NORMAL_ARRAY]
    "Arrays of normals are not read." { glEnableClientState => |call| never_on(call, raw::NORMAL_ARRAY) }
    "coordinate-arrays-stay-on" [glDisableClientState GL_TEXTURE_COORD_ARRAY]
    "An array of coordinates is read ever after." { glDisableClientState => |call| never_on(call, raw::TEXTURE_COORD_ARRAY) }
    "coordinates-of-two" [glTexCoordPointer]
    "Arrays of coordinates are read with two components." { glTexCoordPointer => |call| call.set(0, 2) }
    "positions-of-two" [glVertexPointer]
    "Positions in arrays have two components." { glVertexPointer => |call| { call.replace(0, 3, 2); } }
    "normals-not-set" [glNormalPointer]
    "Arrays of normals are those of the positions." { glNormalPointer => |call| call.skip() }
}
