//! The alpha test at a point of an item's triangle, in f64, for decisions by sampling.

use glam::{DVec2, DVec3};

use super::Drawable;
use crate::geometry::{Placement, Texture};

/// Tests whether the alpha test passes at `point` of a triangle, counted from the item's first; `corners` are of the space that
/// the point is in.
pub fn passes(item: &Drawable, triangle: u32, corners: &[DVec3; 3], point: DVec3) -> bool {
    if !(item.needs_alpha_test() && item.has_texcoords()) {
        return true;
    }
    let [a, b, c] = *corners;
    let area = (b - a).cross(c - a);
    let share = |cross: DVec3| cross.dot(area) / area.length_squared();
    let (v, w) = (share((point - a).cross(c - a)), share((b - a).cross(point - a)));
    let [ta, tb, tc] = vertices(item, triangle).map(|vertex| texcoord(item, vertex));
    let at = ta + v * (tb - ta) + w * (tc - ta);
    let material = &item.material;
    let decal = item.decal().filter(|_| item.material.decal_joins_alpha_test());
    let decal = decal.map_or(1.0, |decal| lookup(decal, 3, &material.decal_placement, at));
    let alpha = material.alpha.as_ref();
    let alpha = alpha.map_or(1.0, |map| lookup(map, map.alpha_channel(), &material.alpha_placement, at));
    f64::from(material.opacity) * decal * alpha >= 0.5
}

/// Three vertex indices of an item's triangle, into its mesh's arrays.
pub fn vertices(item: &Drawable, triangle: u32) -> [usize; 3] {
    let first = (item.indices.start + 3 * triangle) as usize;
    [0, 1, 2].map(|k| item.mesh.indices[first + k] as usize)
}

fn texcoord(item: &Drawable, vertex: usize) -> DVec2 {
    let Some(texgen) = &item.material.texgen else {
        let own = item.mesh.texcoords.as_ref().and_then(|all| all.get(vertex));
        return own.map_or(DVec2::ZERO, |own| DVec2::from_array(own.map(f64::from)));
    };
    let [x, y, z] = item.mesh.positions[vertex];
    let on = |plane: [f32; 4]| f64::from(plane[0] * x + plane[1] * y + plane[2] * z + plane[3]);
    f64::from(texgen.scale) * DVec2::new(on(texgen.s), on(texgen.t))
}

/// LINEAR, as in [`crate::lights::drawable::ALPHA_SAMPLER`], and REPEAT or CLAMP_TO_EDGE; in [0, 1].
fn lookup(texture: &Texture, channel: usize, placement: &Placement, at: DVec2) -> f64 {
    let [scale, offset] = [placement.scale, placement.offset].map(|pair| DVec2::from_array(pair.map(f64::from)));
    let at = scale * at + offset;
    let size = DVec2::new(f64::from(texture.width), f64::from(texture.height));
    let texel = at * size - 0.5;
    let (corner, weight) = (texel.floor(), texel - texel.floor());
    let fetch = |dx: f64, dy: f64| {
        let place = corner + DVec2::new(dx, dy);
        let wrapped = if placement.clamped { place.clamp(DVec2::ZERO, size - 1.0) } else { place.rem_euclid(size) };
        let index = wrapped.y as usize * texture.width as usize + wrapped.x as usize;
        texture.rgba.get(4 * index + channel).map_or(0.0, |byte| f64::from(*byte) / 255.0)
    };
    let row = |dy| fetch(0.0, dy) * (1.0 - weight.x) + fetch(1.0, dy) * weight.x;
    row(0.0) * (1.0 - weight.y) + row(1.0) * weight.y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texture_is_looked_up_where_it_is_placed() {
        let rgba = [0_u8, 255, 255, 0].iter().flat_map(|alpha| [9, 9, 9, *alpha]).collect();
        let checker = Texture { name: String::from("checker"), width: 2, height: 2, rgba, has_alpha: true };
        let placed = Placement { scale: [2.0, -1.0], offset: [0.5, 1.0], clamped: false };
        let clamped = Placement { clamped: true, ..placed };
        for (s, placement, expected) in [
            (0.25, Placement::default(), 0.0),
            (0.75, Placement::default(), 1.0),
            (-0.125, placed, 0.0),
            (0.125, placed, 1.0),
            (1.0, placed, 0.5),
            (9.0, clamped, 1.0),
        ] {
            let t = if placement == Placement::default() { 0.25 } else { 0.75 };
            assert_eq!(lookup(&checker, 3, &placement, DVec2::new(s, t)), expected, "{s} {placement:?}");
        }
    }
}
