//! Value of texels with only one layer, if it is not the far plane: a pass over the whole map stores the nearest layer
//! there. It writes a third map, as no pass may read what it draws into [GL 4.6, 9.3.1].

use crate::lights::{FrustumView, whole_target};
use crate::pass::{
    Attribute, Batch, Clear, Compare, Define, DrawPass, DrawState, Filter, FixedFunctionDesc, ImageId, Input, Pass,
    PassList, Program, Redraw, Sampler, Storage, Target, Work, Wrap, glsl,
};
use crate::techniques::shadow_map::depth;
use crate::techniques::shadow_map::settings::{Order, Settings};

/// Joins both maps to a third one.
pub fn fill(
    view: &FrustumView<'_>,
    nearest: ImageId,
    midpoint: ImageId,
    settings: &Settings,
    list: &mut PassList,
) -> ImageId {
    let map = list.image(depth::desc(view, "map", settings, Storage::Texture));
    let sampler = Sampler { filter: Filter::Nearest, wrap: Wrap::ClampToEdge, compare: None, lod_halves: None };
    let input = |name: &'static str, image| Input { name: name.into(), image, sampler };
    let defines = match settings.order {
        Order::LessEqual => Vec::new(),
        Order::GreaterEqual => vec![Define::flag("REVERSED")],
    };
    let batch = Batch {
        program: Program {
            label: String::from("single layer"),
            defines,
            vertex: vec![glsl!("common/position.vert"), glsl!("common/depth.vert")],
            fragment: vec![glsl!("midpoint/single.frag")],
            attributes: vec![Attribute::Position],
        },
        meaning: FixedFunctionDesc::Shader("one map where another has no second layer"),
        uniforms: Vec::new(),
        inputs: vec![input("midpoint", midpoint), input("nearest", nearest)],
        cull: None,
        scissor: None,
        clip_planes: 0,
        draws: vec![whole_target("every texel")],
    };
    list.passes.push(Pass {
        label: format!("{}: single layer", view.name()),
        redraw: Redraw::WhenChanged,
        work: Work::Draw(DrawPass {
            target: Target { color: None, depth: Some(map), level: 0, face: None },
            viewport: [settings.size; 2],
            // All of it is drawn over; cleared, it is not read before.
            clear: Clear { depth: Some(1.0), ..Clear::default() },
            state: DrawState { depth_test: Some(Compare::Always), ..DrawState::DEPTH_ONLY },
            batches: vec![batch],
        }),
    });
    map
}
