//! `material.photo = { … }`: a photograph that is projected back onto an object [Segal 1992, 3.1].

use std::iter::repeat_n;
use std::sync::Arc;

use glam::DVec2;

use super::light::{ASPECTS, FILTERS};
use crate::geometry::Texture;
use crate::scene::assets::Assets;
use crate::scene::settings::{Settings, SettingsError};
use crate::scene::{
    Error, Frustum, Hidden, ImageFilter, Interpolation, Law, Light, LightKind, LightShape, Object, Photo, ReadShadow,
    Spot, camera_framing,
};

const HIDDEN: [(&str, Hidden); 3] = [("smear", Hidden::Smear), ("grey", Hidden::Grey), ("leave", Hidden::Leave)];

/// A photograph as written; the planes of its frustum are not known yet.
pub(in crate::scene) struct PhotoKeys {
    settings: Settings,
    image: Arc<Texture>,
    filter: ImageFilter,
    frustum: Frustum,
    planes: [Option<f64>; 2],
    hidden: Hidden,
    map: Settings,
}

/// Reads the keys, and checks them as far as that is possible without the objects.
pub(super) fn read(table: &Settings, assets: &mut Assets) -> Result<PhotoKeys, Error> {
    let mut reader = table.read();
    let (name, origin) =
        reader.file("image")?.ok_or_else(|| reader.missing("image", "the photograph, a picture file"))?;
    let eye =
        reader.vector("eye")?.ok_or_else(|| reader.missing("eye", "the place that the photograph was taken from"))?;
    let target =
        reader.vector("target")?.ok_or_else(|| reader.missing("target", "a point in the photograph's middle"))?;
    let up = reader.up(["eye", "target"], eye, target)?;
    let fov_y_radians = reader.angle_between("fov_y", 1.0, 179.0)?.ok_or_else(|| {
        reader.missing("fov_y", "the photograph's full angle from its lower to its upper side, in degrees")
    })?;
    let aspect = reader.number("aspect", ASPECTS)?;
    let filter = reader.choice("filter", &FILTERS)?.unwrap_or(ImageFilter::Linear);
    let hidden = reader.choice("hidden", &HIDDEN)?.unwrap_or(Hidden::Grey);
    let planes = reader.near_and_far()?;
    let absent = || Settings { path: table.key("map"), origin: table.origin.clone(), entries: Vec::new() };
    let map = reader.table("map")?.cloned().unwrap_or_else(absent);
    reader.finish()?;
    let image = assets.texture(name, origin)?;
    let aspect = aspect.unwrap_or_else(|| {
        let own = f64::from(image.width) / f64::from(image.height);
        own.clamp(*ASPECTS.start(), *ASPECTS.end())
    });
    let (cone_radians, position) = (fov_y_radians, eye);
    let frustum = Frustum { position, target, up, cone_radians, aspect, near: 0.0, far: 0.0, lean: DVec2::ZERO };
    Ok(PhotoKeys { settings: table.clone(), image, filter, frustum, planes, hidden, map })
}

/// Gives each of `objects` its photograph. Objects with the same keys share one, and so its depth map. `keys`: of each
/// `[[object]]`, with the number of its instances.
pub(super) fn complete(
    keys: &[(Option<PhotoKeys>, usize)],
    objects: &mut [Object],
    shadows: &dyn ReadShadow,
) -> Result<(), SettingsError> {
    let mut known: Vec<(&PhotoKeys, Arc<Photo>)> = Vec::new();
    let mut photos = Vec::with_capacity(objects.len());
    for (keys, instances) in keys {
        let Some(keys) = keys else {
            photos.extend(repeat_n(None, *instances));
            continue;
        };
        let photo = match known.iter().find(|(other, _)| keys.equals(other)) {
            Some((_, photo)) => photo.clone(),
            None => {
                let photo = Arc::new(keys.complete(known.len(), objects, shadows)?);
                known.push((keys, photo.clone()));
                photo
            }
        };
        photos.extend(repeat_n(Some(photo), *instances));
    }
    objects.iter_mut().zip(photos).for_each(|(object, photo)| object.photo = photo);
    Ok(())
}

impl PhotoKeys {
    fn equals(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.image, &other.image)
            && (self.filter, self.hidden, self.planes) == (other.filter, other.hidden, other.planes)
            && self.frustum == other.frustum
            && self.map.to_toml() == other.map.to_toml()
    }

    /// The photograph `number`, from 0, with planes around `objects` where they are missing.
    fn complete(&self, number: usize, objects: &[Object], shadows: &dyn ReadShadow) -> Result<Photo, SettingsError> {
        let mut spot = Spot {
            frustum: self.frustum.clone(),
            shape: LightShape::Frustum,
            attenuation: [1.0, 0.0, 0.0],
            image: Some(self.image.clone()),
            image_filter: self.filter,
            beam: None,
            falloff: None,
            interpolation: Interpolation::Perspective,
            frustum_shown: false,
            focus: None,
        };
        let found = camera_framing::spot_range(&spot, objects);
        let [near, far] = self.planes;
        spot.frustum.near = near.unwrap_or_else(|| far.map_or(found[0], |far| found[0].min(far / 2.0)));
        spot.frustum.far = far.unwrap_or_else(|| found[1].max(2.0 * spot.frustum.near));
        self.settings.read().check_far(spot.frustum.near, spot.frustum.far)?;
        let kind = LightKind::Spot(spot);
        let shadow = shadows.read_photo(self.map.clone(), &kind, objects)?;
        let projector = Light {
            kind,
            ambient: [0.0; 3],
            diffuse: [1.0; 3],
            specular: [0.0; 3],
            law: Law::Slide,
            name: format!("photograph {number}"),
            dust: None,
            shadow,
        };
        Ok(Photo { projector, hidden: self.hidden })
    }
}
