//! Pictures of a glTF, and how its samplers and texture transforms place them [Khronos, "glTF 2.0 Specification", 3.8;
//! Khronos, "KHR_texture_transform"].

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use gltf::json::extensions::texture::TextureTransform;
use gltf::json::texture::{MagFilter, MinFilter, Sampler, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Image, Index};

use super::super::tally::WarningTally;
use super::super::{Error, Texture, decode_texture};
use super::file::File;

/// A use of a texture.
#[derive(Clone, Debug)]
pub(super) struct Sampled {
    pub texture: Arc<Texture>,
    pub clamped: bool,
    pub uv: Uv,
}

/// Texture coordinates of a use: a set of the mesh's, and what is done to them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Uv {
    pub set: u32,
    pub offset: [f32; 2],
    pub rotation: f32,
    pub scale: [f32; 2],
}

impl Uv {
    /// (s, t), t upwards, of (u, v), v downwards from the picture's upper edge.
    pub fn texcoord(&self, [u, v]: [f64; 2]) -> [f32; 2] {
        let (u, v) = (u * f64::from(self.scale[0]), v * f64::from(self.scale[1]));
        let (sine, cosine) = f64::from(self.rotation).sin_cos();
        let turned = [cosine * u + sine * v, cosine * v - sine * u];
        let [u, v] = [0, 1].map(|k| turned[k] + f64::from(self.offset[k]));
        [u as f32, (1.0 - v) as f32]
    }
}

/// A `textureInfo` of any kind.
pub(super) struct Info<'a> {
    pub index: Index<gltf::json::Texture>,
    pub set: u32,
    pub transform: Option<&'a TextureTransform>,
    pub place: String,
}

/// The pictures that were decoded so far.
#[derive(Default)]
pub(super) struct Pictures {
    /// By the image's index; `None`: it cannot be read, which was said.
    decoded: HashMap<usize, Option<Arc<Texture>>>,
}

impl Pictures {
    /// The texture of a use; `None`: it cannot be read, which `odd` says.
    pub fn sampled(&mut self, info: &Info<'_>, file: &File, odd: &mut WarningTally) -> Result<Option<Sampled>, Error> {
        let texture = file.get(info.index, &info.place, "textures")?;
        let place = format!("textures[{}]", info.index.value());
        if texture.source.value() == u32::MAX as usize {
            let what = || format!("{place}: has no PNG or JPEG: not drawn");
            odd.note("texture without a picture", &file.path, 0, what);
            return Ok(None);
        }
        let image = file.get(texture.source, &place, "images")?;
        let sampler = texture.sampler.map(|sampler| file.get(sampler, &place, "samplers")).transpose()?;
        let clamped = sampler.is_some_and(|sampler| wrap(sampler, &place, &file.path, odd));
        let picture = self.picture(texture.source, image, file, odd)?;
        let uv = Uv {
            set: info.transform.and_then(|transform| transform.tex_coord).unwrap_or(info.set),
            offset: info.transform.map_or([0.0; 2], |transform| transform.offset.0),
            rotation: info.transform.map_or(0.0, |transform| transform.rotation.0),
            scale: info.transform.map_or([1.0; 2], |transform| transform.scale.0),
        };
        Ok(picture.map(|texture| Sampled { texture, clamped, uv }))
    }

    fn picture(
        &mut self,
        index: Index<Image>,
        image: &Image,
        file: &File,
        odd: &mut WarningTally,
    ) -> Result<Option<Arc<Texture>>, Error> {
        if let Some(known) = self.decoded.get(&index.value()) {
            return Ok(known.clone());
        }
        let place = format!("images[{}]", index.value());
        let name = format!("{}#{place}", file.path.display());
        let decoded = match (&image.uri, image.buffer_view) {
            (Some(uri), _) if uri.starts_with("data:") => {
                file.read_uri(uri, &place).and_then(|bytes| decode_texture(Path::new(&name), &bytes))
            }
            (Some(uri), _) => file.beside(uri, &place).and_then(|path| super::super::load_texture(&path)),
            // A view that does not exist is no picture that is odd, but a file that is broken.
            (None, Some(view)) => decode_texture(Path::new(&name), file.view(view, &place)?.0),
            (None, None) => Err(file.error(&place, "has neither a `uri` nor a `bufferView`")),
        };
        let decoded = match decoded {
            Ok(texture) => Some(Arc::new(texture)),
            Err(error) => {
                odd.note(&place, &file.path, 0, || format!("{place}: not drawn: {error}"));
                None
            }
        };
        self.decoded.insert(index.value(), decoded.clone());
        Ok(decoded)
    }
}

/// Tests whether a sampler clamps; names what a scene cannot say: it repeats or clamps both coordinates, and filters between
/// texels and levels.
fn wrap(sampler: &Sampler, place: &str, path: &Path, odd: &mut WarningTally) -> bool {
    let way = |wrap: &Checked<WrappingMode>| match wrap {
        Checked::Valid(way) => *way,
        Checked::Invalid => WrappingMode::Repeat,
    };
    let (s, t) = (way(&sampler.wrap_s), way(&sampler.wrap_t));
    if s == WrappingMode::MirroredRepeat || t == WrappingMode::MirroredRepeat {
        odd.note("mirrored", path, 0, || format!("{place}: MIRRORED_REPEAT is drawn as REPEAT"));
    } else if s != t {
        odd.note("mixed", path, 0, || format!("{place}: is clamped along one coordinate alone: drawn as REPEAT"));
    }
    let nearest = matches!(sampler.mag_filter, Some(Checked::Valid(MagFilter::Nearest)))
        || !matches!(
            sampler.min_filter,
            None | Some(Checked::Valid(MinFilter::Linear | MinFilter::LinearMipmapLinear))
        );
    if nearest {
        odd.note("nearest", path, 0, || format!("{place}: a filter of nearest texels or levels is drawn as trilinear"));
    }
    s == WrappingMode::ClampToEdge && t == WrappingMode::ClampToEdge
}
