//! A cut through shadow volumes, and what a ray of the eye counts on its way [GDC, "Review: Stenciled Shadow Volumes"].

use glam::{DVec2, DVec3, dvec2};

use super::Diagram;
use super::section::{Placement, Section};
use super::svg::Svg;
use crate::gallery::draw::DrawnSide;
use crate::scene::{LightKind, Object};

/// A caster as the plane cuts it.
struct Cut {
    lines: Vec<[DVec2; 2]>,
    /// The two of its points that limit its shadow.
    limits: [DVec2; 2],
}

/// The light in the plane.
#[derive(Clone, Copy)]
enum From {
    Point(DVec2),
    Direction(DVec2),
}

impl From {
    /// Way of the light at a point.
    fn way(self, at: DVec2) -> DVec2 {
        match self {
            Self::Point(light) => (at - light).normalize_or_zero(),
            Self::Direction(way) => way,
        }
    }

    fn cut(self, lines: Vec<[DVec2; 2]>) -> Option<Cut> {
        let points = || lines.iter().flatten().copied();
        let first = points().next()?;
        let reference = self.way(points().sum::<DVec2>() / (2 * lines.len()) as f64);
        let aside = |point: DVec2| match self {
            Self::Point(_) => reference.perp_dot(self.way(point)),
            Self::Direction(way) => way.perp_dot(point),
        };
        let limits = points().fold([first; 2], |[low, high], point| {
            let lower = if aside(point) < aside(low) { point } else { low };
            [lower, if aside(point) > aside(high) { point } else { high }]
        });
        Some(Cut { lines, limits })
    }

    /// Tests whether a caster keeps the light from a point.
    fn is_shaded(self, point: DVec2, cut: &Cut) -> bool {
        let light = match self {
            Self::Point(light) => light,
            Self::Direction(way) => point - 1e3 * way,
        };
        cut.lines.iter().any(|[a, b]| {
            let side = |from: DVec2, to: DVec2, of: DVec2| (to - from).perp_dot(of - from) > 0.0;
            side(light, point, *a) != side(light, point, *b) && side(*a, *b, light) != side(*a, *b, point)
        })
    }
}

/// The upright plane through the light and the middle of two casters; `None`: the scene has no light or caster to cut.
pub fn draw(drawn: &DrawnSide) -> Option<Diagram> {
    let scene = &drawn.scene;
    let casters: Vec<&Object> = scene.objects.iter().filter(|object| object.casts_shadow).take(2).collect();
    let middle = |object: &Object| object.world_from_model.transform_point3(DVec3::ZERO);
    let (position, direction) = match &scene.lights.first()?.kind {
        LightKind::Spot(spot) => (spot.frustum.position, None),
        LightKind::Point(point) => (point.position, None),
        LightKind::Directional { direction } => (middle(casters.first()?) - 3.0 * *direction, Some(*direction)),
    };
    let between = casters.iter().map(|object| middle(object)).sum::<DVec3>() / casters.len() as f64;
    let section = Section::through(position, between, position + DVec3::Y)?;
    let light = match direction {
        Some(way) => From::Direction((section.flat(position + way) - section.flat(position)).normalize_or_zero()),
        None => From::Point(section.flat(position)),
    };
    let cuts: Vec<Cut> = casters.iter().filter_map(|object| light.cut(section.cut(object))).collect();
    let floor = section.flat(middle(scene.objects.first()?)).y;
    let ends = |cut: &Cut| {
        cut.limits.map(|limit| limit + light.way(limit) * ((floor - limit.y) / light.way(limit).y).clamp(0.0, 12.0))
    };
    let shown = cuts.iter().flat_map(|cut| cut.lines.iter().flatten().copied().chain(ends(cut)));
    let shown: Vec<DVec2> = shown.chain([section.flat(position)]).collect();
    let placement = Placement::around(&shown, 26.0, 260.0);
    let mut svg = Svg::new(placement.height + 8.0, "A cut through the light and its shadow volumes");
    for cut in &cuts {
        let [low, high] = ends(cut);
        svg.area("umbra", &[cut.limits[0], cut.limits[1], high, low].map(|point| placement.at(point)));
    }
    for cut in &cuts {
        for line in &cut.lines {
            svg.line("", &line.map(|point| placement.at(point)));
        }
    }
    let ground = [
        shown.iter().map(|point| point.x).fold(f64::INFINITY, f64::min),
        shown.iter().map(|point| point.x).fold(f64::NEG_INFINITY, f64::max),
    ];
    svg.line("", &ground.map(|x| placement.at(dvec2(x, floor))));
    svg.dot("lamp", placement.at(section.flat(position)), 6.0);
    counts(&mut svg, &placement, &cuts, light, [ground[0], ground[1]], floor);
    let says = format!(
        "A cut through the light and {}. Grey is where it keeps the light away; numbers say how many volumes hold the floor \
         there: not 0 is in shadow.",
        casters.iter().map(|object| object.name.as_str()).collect::<Vec<_>>().join(" and ")
    );
    Some(Diagram { svg: svg.finish(), says })
}

/// Writes below each stretch of the floor how many volumes hold it.
fn counts(svg: &mut Svg, placement: &Placement, cuts: &[Cut], light: From, [left, right]: [f64; 2], floor: f64) {
    const STEPS: usize = 400;
    let at = |step: usize| left + (right - left) * (step as f64 + 0.5) / STEPS as f64;
    let count = |step: usize| {
        let point = dvec2(at(step), floor + 1e-4);
        cuts.iter().filter(|cut| light.is_shaded(point, cut)).count()
    };
    let mut begin = 0;
    for step in 1..=STEPS {
        if step < STEPS && count(step) == count(begin) {
            continue;
        }
        let middle = placement.at(dvec2(0.5 * (at(begin) + at(step - 1)), floor)) + dvec2(0.0, 15.0);
        if step - begin > STEPS / 40 {
            svg.text("count", middle, &count(begin).to_string());
        }
        begin = step;
    }
}
