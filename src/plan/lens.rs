//! The lens points of a light in focus, each described by the light's technique as a light of its own.

use std::collections::HashMap;

use crate::compositions::focus::{self, Focused, LensPoint};
use crate::lights::{LightTerm, LightView, Notes};
use crate::pass::{ImageDesc, ImageId, Pass, PassList, Redraw};
use crate::scene::{Focus, Light, LightKind};

/// Describes the light of `view` from each point of its lens by `describe`. Images that differ in nothing are the same
/// from point to point, because one is drawn after the other.
pub fn focused(
    view: &LightView<'_>,
    lens: &Focus,
    list: &mut PassList,
    notes: &mut Notes,
    describe: &dyn Fn(&LightView<'_>, &mut PassList, &mut Notes) -> LightTerm,
) -> Focused {
    let count = lens.samples as usize;
    let mut shared = Vec::new();
    let point = |number: usize| {
        let source = through(view.light(), lens, number as u32);
        let is_first = number == 0;
        let sampled_warnings = view.sampled_warnings && is_first;
        let view = LightView { source: &source, sampled_warnings, ..*view };
        // What is to be said of a lens point is that of the first.
        let (mut own, mut unheard) = (PassList::default(), Notes::default());
        let mut term = describe(&view, &mut own, if is_first { notes } else { &mut unheard });
        let images = share(&own.images, &mut shared, list);
        let renumber = |image: &mut ImageId| *image = images.get(image.0).copied().unwrap_or(*image);
        term.map.iter_mut().for_each(renumber);
        term.shade.inputs.iter_mut().map(|input| &mut input.image).for_each(renumber);
        let rename = |mut pass: Pass| {
            pass.images_mut().into_iter().for_each(renumber);
            // The next lens point draws over it.
            Pass { label: focus::label(&pass.label, number, count), redraw: Redraw::Always, ..pass }
        };
        LensPoint { term, passes: own.passes.into_iter().map(rename).collect() }
    };
    let points = (0..count).map(point).collect();
    let why = format!("its lens of radius {} has its focal plane at {}", lens.radius, lens.distance);
    notes.chosen(format!("light {}", view.index), format!("{count} lens points, added one by one"), why);
    Focused { index: view.index, points }
}

/// The light that comes from one lens point.
fn through(light: &Light, lens: &Focus, number: u32) -> Light {
    let mut light = light.clone();
    if let LightKind::Spot(spot) = &mut light.kind {
        spot.frustum = spot.frustum.through(lens.lens_point(number), lens);
        spot.focus = None;
    }
    light
}

/// The images of one lens point in the frame's list: those of earlier ones, where the descriptions are equal.
fn share(own: &[ImageDesc], shared: &mut Vec<ImageId>, list: &mut PassList) -> Vec<ImageId> {
    let mut free: HashMap<(String, [u32; 2]), Vec<ImageId>> = HashMap::new();
    for image in shared.iter() {
        let desc = list.desc(*image);
        free.entry((desc.label.clone(), desc.size)).or_default().push(*image);
    }
    let find = |desc: &ImageDesc| {
        let alike = free.entry((desc.label.clone(), desc.size)).or_default();
        if let Some(place) = alike.iter().position(|image| list.desc(*image) == desc) {
            return alike.remove(place);
        }
        let image = list.filled_image(desc.clone());
        shared.push(image);
        image
    };
    own.iter().map(find).collect()
}
