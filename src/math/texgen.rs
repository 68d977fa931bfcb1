//! Eye-linear texture-coordinate generation, emulated [HSM, "Computing Transformations for Shadow Mapping", Appendix A].
//!
//! `(s, t, r, q) = T · E_e · x_eye` with `E_e = E_po · modelview_po⁻¹`: the planes as specified to glTexGen, times the
//! inverse of the modelview in effect at that call, then the texture matrix.

use glam::{DMat4, DVec3, DVec4};

use super::dd::DdMat4;

/// The modelview under which the planes are specified: four equal set-ups [HSM, Appendix A], named for the space in which
/// the planes then stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SetUp {
    /// (i) modelview I; planes `S·P_light·L⁻¹·V`.
    Eye,
    /// (ii) modelview `V⁻¹`; planes `S·P_light·L⁻¹`.
    World,
    /// (iii) modelview `V⁻¹·L`; planes `S·P_light`.
    Light,
    /// (iv) modelview `V⁻¹·L·P_light⁻¹·S⁻¹`; planes I.
    Identity,
}

/// Share of the transform that the texture matrix `T` carries, in place of the planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Split {
    /// T = I.
    Planes,
    /// T = S.
    ScaleBias,
    /// T = S·P_light.
    Projection,
}

/// The matrices from which the set-ups are made; `S` maps the light's clip space to texture space.
#[derive(Clone, Copy, Debug)]
pub struct Spaces {
    pub texture_from_light_clip: DMat4,
    pub light_clip_from_light: DMat4,
    pub light_from_world: DMat4,
    pub eye_from_world: DMat4,
}

/// Arguments for glTexGen, glMatrixMode(GL_TEXTURE) and the modelview stack. Rows of `planes` are s, t, r, q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texgen {
    /// `E_po`, as specified.
    pub planes: DMat4,
    /// `modelview_po`, in effect when the planes are specified.
    pub modelview: DMat4,
    /// `T`.
    pub texture_matrix: DMat4,
    /// `E_e`, as GL stores and queries it (GL_EYE_PLANE).
    pub eye_planes: DMat4,
}

/// The planes, modelview and texture matrix of one set-up. `None` where the light's projection has no inverse.
pub fn set_up(spaces: &Spaces, set_up: SetUp, split: Split) -> Option<Texgen> {
    let scale_bias = DdMat4::from(spaces.texture_from_light_clip);
    let projection = DdMat4::from(spaces.light_clip_from_light);
    let light_from_world = DdMat4::from(spaces.light_from_world);
    let eye_from_world = DdMat4::from(spaces.eye_from_world);
    let identity = DdMat4::IDENTITY;

    let texture_matrix = match split {
        Split::Planes => identity,
        Split::ScaleBias => scale_bias,
        Split::Projection => scale_bias * projection,
    };
    // The planes have what remains after T.
    let texture_from_light = match split {
        Split::Planes => scale_bias * projection,
        Split::ScaleBias => projection,
        Split::Projection => identity,
    };
    let (planes, modelview) = match set_up {
        SetUp::Eye => (texture_from_light * light_from_world * eye_from_world.inverse()?, identity),
        SetUp::World => (texture_from_light * light_from_world, eye_from_world),
        SetUp::Light => (texture_from_light, eye_from_world * light_from_world.inverse()?),
        SetUp::Identity => (identity, eye_from_world * light_from_world.inverse()? * texture_from_light.inverse()?),
    };
    let eye_planes = planes * modelview.inverse()?;
    Some(Texgen {
        planes: planes.to_f64(),
        modelview: modelview.to_f64(),
        texture_matrix: texture_matrix.to_f64(),
        eye_planes: eye_planes.to_f64(),
    })
}

/// `S`: halves and shifts clip coordinates into [0, 1]; `r` scaled and biased by its own pair, (0.5, 0.5) in [HSM, "Setting
/// Up the Transformations"] and stepped by 1/65535 in the sample program. Negative `r_scale`: a map drawn with its depth
/// reversed.
pub fn scale_bias(r_scale: f64, r_bias: f64) -> DMat4 {
    DMat4::from_translation(DVec3::new(0.5, 0.5, r_bias)) * DMat4::from_scale(DVec3::new(0.5, 0.5, r_scale))
}

/// The Direct3D texture matrix [HSM, "Direct3D API Details"]: y flipped, `r` in integer units of a map of `bits` bits,
/// `bias` in the same units (negative: towards the light). `half_texel`: half the width of a texel in [0, 1], for its
/// addressing; 0 where the map was drawn with its viewport moved by as much.
pub fn direct3d_scale_bias(half_texel: f64, bits: u32, bias: f64) -> DMat4 {
    let offset = 0.5 + half_texel;
    let z_scale = 2.0_f64.powi(bits as i32) - 1.0;
    DMat4::from_cols(
        DVec4::new(0.5, 0.0, 0.0, 0.0),
        DVec4::new(0.0, -0.5, 0.0, 0.0),
        DVec4::new(0.0, 0.0, z_scale, 0.0),
        DVec4::new(offset, offset, bias, 1.0),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::spaces::{perspective, view_from_world};

    const SET_UPS: [SetUp; 4] = [SetUp::Eye, SetUp::World, SetUp::Light, SetUp::Identity];

    fn spaces(near: f64, far: f64, eye: DVec3) -> Spaces {
        Spaces {
            texture_from_light_clip: scale_bias(0.5, 0.5),
            light_clip_from_light: perspective(1.0, 1.0, near, far),
            light_from_world: view_from_world(DVec3::new(2.0, 4.0, 3.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y),
            eye_from_world: view_from_world(eye, DVec3::new(0.0, 0.6, 0.0), DVec3::Y),
        }
    }

    #[test]
    fn set_ups_round_to_the_same_f32_planes_however_stiff() {
        for (near, far) in [(0.5, 20.0), (1e-3, 1e3), (1e-5, 1e6)] {
            for eye in [DVec3::new(3.0, 2.5, 4.0), DVec3::new(1e4, 2e3, -7e4)] {
                let spaces = spaces(near, far, eye);
                let expected = set_up(&spaces, SetUp::Eye, Split::Planes).unwrap().eye_planes.as_mat4();
                for each in SET_UPS {
                    let planes = set_up(&spaces, each, Split::Planes).unwrap().eye_planes.as_mat4();
                    assert_eq!(planes, expected, "{each:?} {near} {far} {eye}");
                }
            }
        }
    }

    #[test]
    fn the_split_moves_factors_and_keeps_the_product() {
        let spaces = spaces(0.5, 20.0, DVec3::new(3.0, 2.5, 4.0));
        let whole = set_up(&spaces, SetUp::World, Split::Planes).unwrap();
        for each in SET_UPS {
            for split in [Split::ScaleBias, Split::Projection] {
                let texgen = set_up(&spaces, each, split).unwrap();
                assert_ne!(texgen.texture_matrix, DMat4::IDENTITY);
                let product = texgen.texture_matrix * texgen.eye_planes;
                assert!(product.abs_diff_eq(whole.eye_planes, 1e-12), "{each:?} {split:?}");
            }
        }
    }

    #[test]
    fn known_points_map_to_known_texture_coordinates() {
        let spaces = spaces(0.5, 20.0, DVec3::new(3.0, 2.5, 4.0));
        let planes = set_up(&spaces, SetUp::Identity, Split::Planes).unwrap().eye_planes;
        let eye_from_light = spaces.eye_from_world * spaces.light_from_world.inverse();
        // On the light's axis at the near and far planes: the middle of the map, r/q = 0 and 1.
        for (z, r) in [(-0.5, 0.0), (-20.0, 1.0)] {
            let coord = planes * eye_from_light * DVec4::new(0.0, 0.0, z, 1.0);
            let found = coord.truncate() / coord.w;
            assert!(found.abs_diff_eq(DVec3::new(0.5, 0.5, r), 1e-12), "{found}");
        }
        // Behind the light q is negative.
        assert!((planes * eye_from_light * DVec4::new(0.0, 0.0, 1.0, 1.0)).w < 0.0);
    }

    #[test]
    fn direct3d_addresses_texel_centres_and_counts_depth_in_codes() {
        let s = direct3d_scale_bias(0.5 / 1024.0, 16, -4.0);
        let top_left = s * DVec4::new(-1.0, 1.0, 0.0, 1.0);
        assert_eq!(top_left.truncate(), DVec3::new(0.5 / 1024.0, 0.5 / 1024.0, -4.0));
        assert_eq!((s * DVec4::new(0.0, 0.0, 1.0, 1.0)).z, 65531.0);
    }
}
