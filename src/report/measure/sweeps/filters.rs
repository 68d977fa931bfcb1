//! Filters of a light's image: nearest, linear, trilinear, against the image averaged over each pixel.

use super::super::reference::{Error, inner_pixels, supersampled, with_light, with_spot};
use super::{Experiment, SweepRequest, series};
use crate::frame::Renderer;
use crate::report::store::swept::LightSweep;
use crate::scene::{ImageFilter, Scene};

const FILTERS: [(&str, ImageFilter); 3] =
    [("nearest", ImageFilter::Nearest), ("linear", ImageFilter::Linear), ("trilinear", ImageFilter::Trilinear)];

pub(super) fn experiment(request: &SweepRequest<'_>, renderer: &mut Renderer) -> Result<Option<Experiment>, Error> {
    let light = request.light;
    let has_image = |scene: &Scene| scene.lights.get(light).and_then(|light| light.spot()?.image.as_ref()).is_some();
    if !has_image(request.scene) {
        return Ok(None);
    }
    // A lens blurs the image, and dust shows it in the air: both have sweeps of their own.
    let bare = with_light(request.scene, light, |light| light.dust = None);
    let bare = with_spot(&bare, light, |spot| spot.focus = None);
    let with = |filter: ImageFilter| with_spot(&bare, light, |spot| spot.image_filter = filter);
    let Some((reference, side)) = supersampled(&with(ImageFilter::Linear), renderer)? else { return Ok(None) };
    let inner = inner_pixels(request.truth);
    let reference = reference.to_truth(|index| inner.get(index).copied().unwrap_or(false));
    let value = |(name, _): &(&str, ImageFilter)| (String::from(*name), None, format!("filter = \"{name}\""));
    let sweep = LightSweep {
        name: String::from("image filters"),
        key: String::from("filter"),
        source: String::from("Segal 1992, 3.2; GL 4.6, 8.14"),
        reference: format!(
            "a picture of {side} × {side} samples a pixel of the linearly filtered image, averaged over each pixel; pixels \
             beside the edge of a surface are not compared. Light comes from the lens's middle, through clear air"
        ),
        law: String::new(),
        second_reference: None,
        series: vec![series("filters", FILTERS.iter().map(value).collect(), None)],
    };
    let scenes = vec![FILTERS.iter().map(|(_, filter)| Ok(with(*filter))).collect()];
    Ok(Some(Experiment { sweep, reference, second: None, in_floats: false, scenes }))
}
