//! The comparison of a shadow map: A, the depth that the map holds, and B, that of the point that is seen, where B is
//! farther and where both are one [HSM, Figure 1].

use glam::{DVec2, DVec3, dvec2};

use super::Diagram;
use super::section::{Placement, Section};
use super::svg::Svg;
use crate::gallery::draw::DrawnSide;

/// Rays of the light that are looked at.
const RAYS: usize = 160;

/// A ray of the light in the plane: its way for each unit of depth, and the depths at which it meets lines, nearest first.
struct Ray {
    way: DVec2,
    depths: Vec<f64>,
}

/// The upright plane through the light and its target; `None`: the light is no spotlight, or nothing is behind another.
pub fn draw(drawn: &DrawnSide) -> Option<Diagram> {
    let scene = &drawn.scene;
    let frustum = &scene.lights.first()?.spot()?.frustum;
    let section = Section::through(frustum.position, frustum.target, frustum.position + DVec3::Y)?;
    let axis = section.flat(frustum.target).normalize_or_zero();
    let cuts: Vec<[DVec2; 2]> = scene.objects.iter().flat_map(|object| section.cut(object)).collect();
    let across = (0.5 * frustum.cone_radians).tan();
    let way = |part: f64| axis + (2.0 * part - 1.0) * across * axis.perp();
    let rays: Vec<Ray> = (0..RAYS).map(|index| meet(&cuts, way((index as f64 + 0.5) / RAYS as f64))).collect();
    // Where a point lies in shadow the farthest of what is met is it; the clearest case has the largest gap.
    // A caster is entered and left: of more than three lines the last lies under something else, where no eye sees it.
    let gap = |ray: &&Ray| match (&ray.depths[..], ray.depths.len() <= 3) {
        ([near, .., far], true) => far - near,
        _ => 0.0,
    };
    let shadowed = rays.iter().max_by(|one, other| gap(one).total_cmp(&gap(other))).filter(|ray| gap(ray) > 0.0)?;
    let lit = rays.iter().filter(|ray| ray.depths.len() == 1).max_by(|one, other| {
        let apart = |ray: &Ray| ray.way.distance(shadowed.way);
        apart(one).total_cmp(&apart(other))
    })?;
    let (near, far, both) = (*shadowed.depths.first()?, *shadowed.depths.last()?, *lit.depths.first()?);
    let eye = section.flat(scene.camera.eye);
    let reach = far.max(both) * 1.05;
    let is_near = |point: &DVec2| point.length() < 1.5 * reach;
    let shown = cuts.iter().flatten().copied().filter(is_near).chain([DVec2::ZERO, eye]);
    let placement = Placement::around(&shown.collect::<Vec<_>>(), 26.0, 260.0);
    let at = |point: DVec2| placement.at(point);
    let mut svg = Svg::new(placement.height + 44.0, "A shadow map's comparison, in shadow and in the light");
    svg.area("beam", &[at(DVec2::ZERO), at(reach * way(0.0)), at(reach * way(1.0))]);
    svg.line("stair", &[at(frustum.near * way(0.0)), at(frustum.near * way(1.0))]);
    for line in cuts.iter().filter(|line| line.iter().all(is_near)) {
        svg.line("", &line.map(at));
    }
    for (ray, depth, class) in [(shadowed, far, "dark"), (lit, both, "good")] {
        let point = depth * ray.way;
        svg.line("ray", &[at(DVec2::ZERO), at(point)]);
        svg.line("thin", &[at(eye), at(point)]);
        let end = at(point);
        svg.line(class, &[end - dvec2(6.0, 0.0), end + dvec2(6.0, 0.0)]);
    }
    for (point, letter) in [(near * shadowed.way, "A"), (far * shadowed.way, "B"), (both * lit.way, "A = B")] {
        svg.dot("sample", at(point), 3.5);
        svg.text("words", at(point) + dvec2(6.0, -7.0), letter);
    }
    svg.dot("lamp", at(DVec2::ZERO), 6.0);
    svg.dot("sample", at(eye), 4.0);
    svg.text("words", at(eye) + dvec2(-8.0, -9.0), "eye");
    svg.legend(
        dvec2(12.0, placement.height + 10.0),
        &[
            ("stair", "the map's plane, at the light's near plane"),
            ("ray", "to the light: the depths that are compared"),
        ],
    );
    let says = format!(
        "A cut through the light. Along one ray the map holds A = {near:.2}, and the point seen lies at B = {far:.2}: A < B, shadow. \
         Along the other both are {both:.2}: light. The eye's place does not matter to the comparison."
    );
    Some(Diagram { svg: svg.finish(), says })
}

/// Depths at which a ray meets lines.
fn meet(cuts: &[[DVec2; 2]], way: DVec2) -> Ray {
    let crossing = |[a, b]: &[DVec2; 2]| {
        let [from, to] = [way.perp_dot(*a), way.perp_dot(*b)];
        let point = ((from < 0.0) != (to < 0.0)).then(|| a.lerp(*b, from / (from - to)))?;
        Some(point.dot(way) / way.length_squared()).filter(|depth| *depth > 0.0)
    };
    let mut depths: Vec<f64> = cuts.iter().filter_map(crossing).collect();
    depths.sort_by(f64::total_cmp);
    Ray { way, depths }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_lines_in_the_order_of_their_depths() {
        let cuts = [
            [dvec2(4.0, -1.0), dvec2(4.0, 2.0)],
            [dvec2(1.0, -1.0), dvec2(3.0, 1.0)],
            [dvec2(2.0, 3.0), dvec2(5.0, 9.0)],
        ];
        assert_eq!(meet(&cuts, dvec2(1.0, 0.0)).depths, [2.0, 4.0]);
        assert_eq!(meet(&cuts, dvec2(-1.0, 0.0)).depths, [] as [f64; 0]);
    }
}
