//! Pictures of the scene: its own, a view or the ray tracer's picture in its place or beside it, a pass, sheets.

use crate::judge::truth_pictures::TruthView;
use crate::plan::ViewRequest;
use crate::scene::Shadow;
use crate::techniques::LightShadow;
use crate::viewer::sheet::next_page;
use crate::views::View;

/// Techniques that views need: one with a map, and one that counts.
const MAP: &str = "shadow-map";
const VOLUMES: &str = "shadow-volume";

/// A picture in place of the scene's, or beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    Drawn(View),
    Truth,
    Difference,
}

/// All of them, in the order of their key.
pub(super) const LOOKS: &[Look] = &[
    Look::Drawn(View::LightDepth),
    Look::Drawn(View::Volume),
    Look::Drawn(View::Silhouette),
    Look::Drawn(View::StencilColors),
    Look::Drawn(View::TexelsPerPixel),
    Look::Truth,
    Look::Difference,
];

/// Sheet of text that pages through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Paged {
    Help,
    LeftOut,
}

/// Pictures beside the scene itself.
#[derive(Clone, Debug, Default)]
pub(super) struct Looks {
    /// Place in [`LOOKS`]; `None`: the picture alone.
    pub look: Option<usize>,
    /// The look that was shown last.
    pub last: usize,
    /// True if the look cannot be drawn: the picture is shown.
    pub has_failed: bool,
    pub is_beside: bool,
    /// The pass after which the picture is shown, by its place among those of the picture.
    pub pass: Option<usize>,
    /// A sheet, and its page.
    pub paged: Option<(Paged, usize)>,
    pub times: bool,
}

impl Looks {
    pub fn now(&self) -> Option<Look> {
        self.look.filter(|_| !self.has_failed).and_then(|place| LOOKS.get(place)).copied()
    }

    /// Steps through the looks; before the first and after the last comes the picture alone.
    pub fn step(&mut self, by: i32) {
        let count = LOOKS.len() as i32 + 1;
        let place = self.look.map_or(0, |place| place as i32 + 1);
        self.look = usize::try_from((place + by).rem_euclid(count) - 1).ok();
        self.last = self.look.unwrap_or(self.last);
        self.has_failed = false;
        self.pass = None;
    }

    /// The next page of a sheet that has so many; after the last none.
    pub fn page(&mut self, sheet: Paged, count: usize) {
        let now = self.paged.filter(|(shown, _)| *shown == sheet).map(|(_, page)| page);
        self.paged = next_page(now, count).map(|page| (sheet, page));
    }
}

impl Look {
    pub fn name(self) -> &'static str {
        match self {
            Self::Drawn(view) => view.name(),
            Self::Truth => "truth",
            Self::Difference => "difference",
        }
    }

    /// Its contents.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Drawn(View::LightDepth) => "the light's shadow map",
            Self::Drawn(View::Volume) => "the shadow volumes: outsides orange, insides blue",
            Self::Drawn(View::Silhouette) => "the casters' silhouettes, as the light sees them",
            Self::Drawn(View::StencilColors) => "the count in the stencil buffer",
            Self::Drawn(View::TexelsPerPixel) => "texels of the map that a pixel's side shows",
            Self::Drawn(_) => "",
            Self::Truth => "what is lit and shadowed, by rays",
            Self::Difference => "the picture's errors against that",
        }
    }

    /// The technique that a light has for this view, if its own makes none of what is shown.
    pub fn technique(self, shadow: &Shadow) -> Option<&'static str> {
        let read = LightShadow::of(shadow)?;
        let map = read.map();
        let counts = read.technique.name() == VOLUMES || map.is_some_and(|map| map.counts_by().is_some());
        match self {
            Self::Drawn(view) if view.needs_map() && map.is_none() => Some(MAP),
            Self::Drawn(view) if view.needs_count() && !counts => Some(VOLUMES),
            _ => None,
        }
    }

    /// The view of `light` that is drawn.
    pub fn drawn(self, light: usize) -> Option<ViewRequest> {
        match self {
            Self::Drawn(view) => Some(ViewRequest { view, light: if view.of_light() { light } else { 0 } }),
            _ => None,
        }
    }

    /// The ray tracer's picture of `light`.
    pub fn traced(self, light: usize) -> Option<TruthView> {
        (!matches!(self, Self::Drawn(_))).then_some(TruthView { light, is_difference: self == Self::Difference })
    }
}
