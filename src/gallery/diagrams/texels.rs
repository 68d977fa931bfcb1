//! A shadow map's texels as a stair against the surface that they were drawn from [HSM, Figure 3 and "Why Is Polygon Offset
//! Needed?"], along the row or column of the map in which the surface of the scene's first object is steeper.

use glam::{DVec2, DVec3, dvec2};

use super::Diagram;
use super::svg::{Svg, WIDTH};
use crate::gallery::draw::DrawnSide;
use crate::lights::{MapInfo, MapShape};

/// Texels in the picture.
const SHOWN: usize = 5;

/// A row of texels on a plane. Lengths are in world units.
struct Row {
    /// Depth along the light's axis at a slope v / u across the map; `height` / (`along` + slope * `across`).
    height: f64,
    along: f64,
    across: f64,
    /// Width of a texel at depth 1.
    texel: f64,
    map: MapInfo,
}

impl Row {
    /// The row in the middle of the map of the first light, on the plane of the first object's upper side.
    fn of(drawn: &DrawnSide) -> Option<Self> {
        let map = *drawn.plan.maps.iter().find(|map| map.light == 0)?;
        let frustum = &drawn.scene.lights.first()?.spot()?.frustum;
        let floor = drawn.scene.objects.first()?.world_from_model;
        let normal = floor.inverse().transpose().transform_vector3(DVec3::Y).normalize_or_zero();
        let axis = (frustum.target - frustum.position).normalize_or_zero();
        let right = axis.cross(frustum.up).normalize_or_zero();
        let up = right.cross(axis);
        let steeper = if normal.dot(right).abs() > normal.dot(up).abs() { right } else { up };
        let height = normal.dot(floor.transform_point3(DVec3::ZERO) - frustum.position);
        let (along, across) = (normal.dot(axis), normal.dot(steeper));
        (height < 0.0 && along < 0.0).then_some(Self { height, along, across, texel: map.texel, map })
    }

    fn depth(&self, slope: f64) -> f64 {
        self.height / (self.along + slope * self.across)
    }

    /// Slope at the border `index` of the texels that are shown.
    fn border(&self, index: f64) -> f64 {
        self.texel * (index - SHOWN as f64 / 2.0)
    }

    /// The depth that a texel holds, by the surface at its centre and the polygon offset.
    fn stored(&self, index: usize) -> f64 {
        let slope = self.border(index as f64 + 0.5);
        let depth = self.depth(slope);
        let per_texel = (depth * depth * self.across / self.height).abs() * self.texel;
        let MapShape::Spot { near, far } = self.map.shape else { return depth };
        let a_unit = f64::from(self.map.format.bits()).exp2().recip() * depth * depth * (far - near) / (far * near);
        depth + f64::from(self.map.polygon.factor) * per_texel + f64::from(self.map.polygon.units) * a_unit
    }

    /// A place at a depth and a slope: along the surface and above it, in world units from the surface at slope 0.
    fn place(&self, depth: f64, slope: f64) -> DVec2 {
        let from_middle = dvec2(depth - self.depth(0.0), depth * slope);
        let out = dvec2(self.along, self.across).normalize_or_zero();
        dvec2(from_middle.dot(dvec2(-out.y, out.x)), from_middle.dot(out))
    }
}

/// The diagram of a side; `None`: the first light has no map of one frustum, or does not see the first object's upper side.
pub fn draw(drawn: &DrawnSide) -> Option<Diagram> {
    let row = Row::of(drawn)?;
    let ends = [0.0, SHOWN as f64].map(|index| row.place(row.depth(row.border(index)), row.border(index)).x);
    let scale = (WIDTH - 60.0) / (ends[1] - ends[0]).abs();
    let sign = (ends[1] - ends[0]).signum();
    let middle = dvec2(WIDTH / 2.0, 120.0);
    let to_picture = |place: DVec2| middle + dvec2(sign * place.x, -place.y) * scale;
    let at = |depth: f64, slope: f64| to_picture(row.place(depth, slope));
    let surface = |index: f64| at(row.depth(row.border(index)), row.border(index));

    let mut svg = Svg::new(240.0, "Texels of the shadow map as a stair against the floor");
    let (left, right) = (surface(0.0), surface(SHOWN as f64));
    let below = dvec2(0.0, 22.0);
    svg.area("ground", &[left, right, right + below, left + below]);
    let mut wrong = 0.0;
    for index in 0..SHOWN {
        let [near, far] = [index, index + 1].map(|border| border as f64);
        let stored = row.stored(index);
        for border in [near, far] {
            let light = at(row.depth(row.border(border)) - 70.0 / scale, row.border(border));
            svg.line("ray", &[light, surface(border)]);
        }
        // Where the surface is deeper than what the texel holds, it is in its own shadow.
        let steps = 64;
        let is_dark = |step: usize| {
            let index = near + (step as f64 + 0.5) / f64::from(steps);
            row.depth(row.border(index)) > stored
        };
        for step in 0..steps as usize {
            let part = |step: usize| surface(near + step as f64 / f64::from(steps));
            svg.line(if is_dark(step) { "dark" } else { "lit" }, &[part(step), part(step + 1)]);
            wrong += f64::from(u8::from(is_dark(step))) / f64::from(steps) / SHOWN as f64;
        }
        svg.line("stair", &[at(stored, row.border(near)), at(stored, row.border(far))]);
        svg.dot("sample", surface(near + 0.5), 2.5);
    }
    let light = dvec2(if surface(0.0).x < at(row.depth(0.0) - 1.0, 0.0).x { WIDTH - 90.0 } else { 8.0 }, 14.0);
    svg.text("words", light, "light from here");
    svg.legend(
        dvec2(12.0, 180.0),
        &[
            ("stair", "depth that a texel of the map holds"),
            ("lit", "surface nearer to the light than that: lit"),
            ("dark", "surface behind that: in its own shadow"),
        ],
    );
    let texel = (ends[1] - ends[0]).abs() / SHOWN as f64;
    let steep = (row.across / row.along).atan().to_degrees().abs();
    let offset = row.map.polygon;
    let words = if offset.factor == 0.0 && offset.units == 0.0 {
        format!("Without an offset {:.0} % of the floor lies behind the map's own stair", 100.0 * wrong)
    } else {
        let moved = row.stored(SHOWN / 2) - row.depth(0.0);
        format!(
            "An offset of factor {} and {} units moves each step {moved:.3} back; {:.0} % of the floor lies behind the stair",
            offset.factor,
            offset.units,
            100.0 * wrong
        )
    };
    let says = format!(
        "{words}. From the numbers of this scene: {} texels a side, of which one is {texel:.3} long on the floor, which leans \
         {steep:.0} degrees from facing the light along the map. Each dot is the one point of which a texel knows the depth.",
        row.map.size
    );
    Some(Diagram { svg: svg.finish(), says })
}
