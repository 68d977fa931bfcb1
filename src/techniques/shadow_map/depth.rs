//! The passes that draw the casters' depth from the light [HSM, "How To Do It"].

use glam::{DMat4, DVec3};

use super::bias;
use super::casters::is_before_near;
use super::settings::{Order, Settings, Transfer};
use super::term::raster_from_clip;
use crate::lights::cut::Cutter;
use crate::lights::drawable::depth_batches;
use crate::lights::projector::Rays;
use crate::lights::{Chosen, Drawable, FrustumView, LightView, Notes};
use crate::pass::{
    Batch, Chunk, Clear, Compare, Define, DrawPass, DrawState, FixedFunctionDesc, Format, ImageDesc, ImageId, Input,
    Pass, PassList, PolygonOffset, Redraw, Storage, Target, Uniform, Work,
};

/// One pass of depth over the casters.
pub struct DepthLayer<'a> {
    /// Name of the pass, after the light's number.
    pub name: &'static str,
    /// Name of the image, after the light's number.
    pub image: &'static str,
    /// Ending of the fragments; `None`: they write their depth only.
    pub ending: Option<DepthEnding>,
    /// The polygon offset of the pass.
    pub offset: PolygonOffset,
    /// True if depth is clamped even if no caster comes before the near plane.
    pub clamped: bool,
    /// The texels that may be drawn, as [`DrawState::scissor`]; `None`: all.
    pub scissor: Option<[u32; 4]>,
    pub casters: &'a [&'a Drawable],
    /// Casters that are drawn only in parts of these texels, once in each.
    pub in_parts: &'a [InParts<'a>],
    /// Items that cast nothing, drawn after the casters with both faces, whichever faces the map leaves out.
    pub receivers: &'a [&'a Drawable],
    pub receivers_in_parts: &'a [InParts<'a>],
}

impl<'a> DepthLayer<'a> {
    /// A layer of the depth of `casters`, all over the map.
    pub fn plain(name: &'static str, image: &'static str, offset: PolygonOffset, casters: &'a [&'a Drawable]) -> Self {
        Self {
            name,
            image,
            ending: None,
            offset,
            clamped: false,
            scissor: None,
            casters,
            in_parts: &[],
            receivers: &[],
            receivers_in_parts: &[],
        }
    }
}

/// A caster, and the scissors under which it is drawn.
pub struct InParts<'a> {
    pub item: &'a Drawable,
    pub scissors: Vec<[u32; 4]>,
}

/// Work of a layer's fragment after the alpha test.
#[derive(Clone)]
pub struct DepthEnding {
    pub label: &'static str,
    /// Chunk with `main`.
    pub fragment: Chunk,
    pub defines: Vec<Define>,
    pub uniforms: Vec<Uniform>,
    pub inputs: Vec<Input>,
}

/// Draws a layer and, with `transfer = "copy"`, copies it. Returns the depth texture.
pub fn draw(
    view: &FrustumView<'_>,
    layer: &DepthLayer<'_>,
    settings: &Settings,
    list: &mut PassList,
    notes: &mut Notes,
) -> ImageId {
    let DepthLayer { name, image, .. } = layer;
    let levels = bias::levels(settings);
    let storage = if levels > 1 { Storage::Mipmapped(levels) } else { Storage::Texture };
    let map = list.image(desc(view, image, settings, storage));
    let drawn = match settings.transfer {
        Transfer::Fbo => map,
        Transfer::Copy => list.image(desc(view, &format!("{image}: depth buffer"), settings, Storage::Renderbuffer)),
    };
    let mut batches = batches(view, layer, settings, list);
    let received = DepthLayer {
        casters: layer.receivers,
        in_parts: layer.receivers_in_parts,
        ending: layer.ending.clone(),
        ..*layer
    };
    let received = self::batches(view, &received, settings, list);
    let label = format!("{}: {name}", view.name());
    notes.left_out(format!("colour attachment and colour writes of \"{label}\""), "only its depth is read");
    let clamped = is_clamped(view, layer, "depth", notes);
    let (plain, cleared) = state(settings, layer.offset, clamped);
    let plain = if ends_before_cleared(view, layer, settings) { before_cleared(plain) } else { plain };
    let mut state = DrawState { scissor: layer.scissor, ..plain };
    if !received.is_empty() {
        let cull = state.cull.take();
        batches.iter_mut().for_each(|batch| batch.cull = cull);
        batches.extend(received);
    }
    for level in 0..levels {
        list.passes.push(Pass {
            label: if level == 0 { label.clone() } else { format!("{label}, level {level}") },
            redraw: Redraw::WhenChanged,
            work: Work::Draw(DrawPass {
                target: Target { color: None, depth: Some(drawn), level, face: None },
                viewport: [(settings.size >> level).max(1); 2],
                clear: Clear { depth: Some(cleared), ..Clear::default() },
                state,
                batches: batches.clone(),
            }),
        });
    }
    if settings.transfer == Transfer::Copy {
        let label = format!("{label}, copied");
        list.passes.push(Pass {
            label,
            redraw: Redraw::WhenChanged,
            work: Work::CopyDepth { from: drawn, to: map, face: None },
        });
    }
    map
}

/// Product of raster, crop, and the light's clip space.
pub fn map_clip_from_world(view: &FrustumView<'_>, settings: &Settings) -> DMat4 {
    raster_from_clip(settings) * view.projector.crop.map_clip_from_light_clip() * view.clip_from_world()
}

/// An image of the map's size and format. A depth buffer that is copied is always sized: an unsized texture must follow it.
pub fn desc(view: &LightView<'_>, name: &str, settings: &Settings, storage: Storage) -> ImageDesc {
    let is_unsized = settings.is_unsized && storage != Storage::Renderbuffer;
    let format = if is_unsized { Format::UnsizedDepth } else { Format::Depth(settings.format) };
    ImageDesc { label: format!("{} {name}", view.name()), size: [settings.size; 2], format, storage }
}

/// Tests whether the layer is drawn under GL_DEPTH_CLAMP, so that casters before the near plane are drawn at that plane's
/// depth instead of being clipped; notes it for `what`. Near and far are the map's, not the light's.
pub fn is_clamped(view: &FrustumView<'_>, layer: &DepthLayer<'_>, what: &str, notes: &mut Notes) -> bool {
    let Some(item) = clamps_near(view, layer) else { return layer.clamped };
    let Rays::From { near, .. } = view.projector.rays else { return layer.clamped };
    let why = format!("{} may come nearer than the near plane at {near}: it casts from there", item.label);
    let chosen = Chosen { of: format!("{what} of {}'s map", view.name()), choice: "GL_DEPTH_CLAMP".into(), why };
    if !notes.chosen.contains(&chosen) {
        notes.chosen.push(chosen);
    }
    true
}

/// The first caster of the layer that may lie before the near plane.
fn clamps_near<'a>(view: &FrustumView<'_>, layer: &DepthLayer<'a>) -> Option<&'a Drawable> {
    let in_parts = layer.in_parts.iter().map(|part| part.item);
    layer.casters.iter().copied().chain(in_parts).find(|item| is_before_near(view, item))
}

/// Draw state and cleared depth; reversed depth range, test and offset for GEQUAL.
///
/// GL adds the offset before it clamps [GL 4.6, 14.6.5 and 17.3.4]: an offset away from the light moves casters before the
/// near plane like any other, and only those still before it are then clamped to the plane.
pub fn state(
    settings: &Settings,
    PolygonOffset { factor, units }: PolygonOffset,
    depth_clamp: bool,
) -> (DrawState, f32) {
    let offset = |sign: f32| {
        (factor != 0.0 || units != 0.0).then_some(PolygonOffset { factor: sign * factor, units: sign * units })
    };
    let plain = DrawState { cull: settings.cull, depth_clamp, ..DrawState::DEPTH_ONLY };
    match settings.order {
        Order::LessEqual => (DrawState { polygon_offset: offset(1.0), ..plain }, 1.0),
        Order::GreaterEqual => {
            let reversed = DrawState {
                depth_test: Some(Compare::Greater),
                depth_range: [1.0, 0.0],
                polygon_offset: offset(-1.0),
                ..plain
            };
            (reversed, 0.0)
        }
    }
}

/// Greatest depth to draw if the cleared depth must lie behind it: two codes of 16 bits before 1.
const LAST: f64 = 1.0 - 1.0 / 32_768.0;

/// Tests whether an offset could move a caster to the depth that the map is cleared to. Points beyond the box of parallel
/// light are compared at depth 1, and would be lit through it. A steep side's offset has no bound. Casters beyond the box
/// itself must still be clipped.
fn ends_before_cleared(view: &FrustumView<'_>, layer: &DepthLayer<'_>, settings: &Settings) -> bool {
    let PolygonOffset { factor, units } = layer.offset;
    let clip_from_world = map_clip_from_world(view, settings);
    let is_held = |item: &&Drawable| {
        let clip_from_model = clip_from_world * item.world_from_model;
        item.bounds.corners().into_iter().all(|corner| (clip_from_model * corner.extend(1.0)).z.abs() <= LAST)
    };
    matches!(view.projector.rays, Rays::Along(_))
        && (factor > 0.0 || units > 0.0)
        && !layer.clamped
        && layer.casters.iter().all(is_held)
}

/// Clamps depths, after their offset [GL 4.6, 14.6.5 and 17.3.4], to [`LAST`] from either end. The range is that of the state
/// before; [`depths_kept`] makes up for its being shorter.
fn before_cleared(state: DrawState) -> DrawState {
    let [near, far] = state.depth_range;
    let last = near + (far - near) * LAST as f32;
    DrawState { depth_clamp: true, depth_range: [near, last], ..state }
}

/// Matrix in clip space that makes up for the shorter range, so that depths stay what they were.
fn depths_kept() -> DMat4 {
    let longer = LAST.recip();
    DMat4::from_translation(DVec3::new(0.0, 0.0, longer - 1.0)) * DMat4::from_scale(DVec3::new(1.0, 1.0, longer))
}

/// The casters in as few batches as their alpha tests allow, with the layer's ending.
pub fn batches(view: &FrustumView<'_>, layer: &DepthLayer<'_>, settings: &Settings, list: &mut PassList) -> Vec<Batch> {
    let clip_from_world = map_clip_from_world(view, settings);
    let clip_from_world =
        if ends_before_cleared(view, layer, settings) { depths_kept() * clip_from_world } else { clip_from_world };
    let texel = bias::texel_at_one(&view.projector, settings);
    let clamped = layer.clamped || clamps_near(view, layer).is_some();
    let cutter = Cutter::for_map(&view.projector, &clip_from_world, texel, settings.size, clamped, view.derived);
    let cut = cutter.cut(layer.casters.iter().copied());
    let cut: Vec<&Drawable> = cut.iter().map(AsRef::as_ref).collect();
    let mut batches = depth_batches(&cut, &clip_from_world, list);
    for InParts { item, scissors } in layer.in_parts {
        let cut = cutter.cut([*item]);
        let cut: Vec<&Drawable> = cut.iter().map(AsRef::as_ref).collect();
        let whole = depth_batches(&cut, &clip_from_world, list);
        for scissor in scissors {
            batches.extend(whole.iter().map(|batch| Batch { scissor: Some(*scissor), ..batch.clone() }));
        }
    }
    let Some(ending) = &layer.ending else { return batches };
    for batch in &mut batches {
        batch.meaning = FixedFunctionDesc::Shader(ending.label);
        batch.program.label = ending.label.to_owned();
        batch.program.fragment.pop();
        batch.program.fragment.push(ending.fragment.clone());
        batch.program.defines.extend(ending.defines.iter().cloned());
        batch.uniforms.extend(ending.uniforms.iter().cloned());
        batch.inputs.extend(ending.inputs.iter().cloned());
    }
    batches
}
