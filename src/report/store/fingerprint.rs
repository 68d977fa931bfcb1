//! Hashes of everything that rows depend on: equal hashes mean the same rows. A fingerprint is a hash of the loaded scene,
//! with the contents of every mesh, material and picture that it names, and of the grid. A stamp is a hash of the program,
//! the driver and the machine, on which errors and times depend, too. FNV-1a, 64 bits.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt::{self, Write};
use std::sync::Arc;

use super::results::{Machine, Row, VERSION};
use crate::geometry::{Material, Mesh, Texture};
use crate::report::measure::options::MeasureOptions;
use crate::scene::{LightKind, Scene};
use crate::techniques;

/// Hashes everything that decides the rows, but not the machine. File names are not included: the same scene in another
/// folder has the same fingerprint.
pub fn of_rows<'r>(scene: &Scene, rows: impl Iterator<Item = &'r Row>, options: &MeasureOptions) -> String {
    let mut mark = Mark::new();
    mark.scene(scene);
    for row in rows {
        mark.debug(&(&row.technique, &row.settings));
    }
    mark.debug(&(options.light, options.band_texels, VERSION));
    mark.finish()
}

/// Hashes the program, the driver and the machine, which all rows of one report must share.
pub fn stamp(machine: &Machine, options: &MeasureOptions) -> String {
    let mut mark = Mark::new();
    mark.debug(&(machine, options.runs));
    // If the program cannot be read, its version is used.
    let program = std::env::current_exe().and_then(std::fs::read).unwrap_or_default();
    mark.bytes(&program);
    mark.finish()
}

/// Hashes a text.
pub fn of_text(text: &str) -> String {
    let mut mark = Mark::new();
    mark.bytes(text.as_bytes());
    mark.finish()
}

struct Mark(u64);

impl Mark {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn bytes(&mut self, bytes: &[u8]) {
        let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        self.0 = bytes.iter().fold(self.0, step);
    }

    /// Adds all fields of a value.
    fn debug(&mut self, value: &dyn fmt::Debug) {
        // Writing to a hash cannot fail.
        let _ = writeln!(self, "{value:?}");
    }

    fn finish(self) -> String {
        format!("{:016x}", self.0)
    }

    fn scene(&mut self, scene: &Scene) {
        self.debug(&(&scene.image, &scene.camera, &scene.shading));
        for light in &scene.lights {
            let mut rest = light.clone();
            self.bytes(rest.shadow.written().to_toml().as_bytes());
            // Without the lines that it was written in.
            rest.shadow = techniques::unshadowed();
            if let LightKind::Spot(spot) = &mut rest.kind {
                let image = spot.image.take();
                self.texture(image.as_ref());
                // The map follows from the rest.
                if let Some(beam) = spot.beam.take() {
                    self.texture(beam.shield.as_ref());
                    self.debug(&(&beam.profile, beam.lens));
                }
            }
            self.debug(&rest);
        }
        // A mesh that objects share, a hundred thousand instances, is hashed once; then its number stands for it.
        let mut known: HashMap<*const Mesh, usize> = HashMap::new();
        for object in &scene.objects {
            let number = known.len();
            match known.entry(Arc::as_ptr(&object.mesh)) {
                Entry::Occupied(known) => self.debug(known.get()),
                Entry::Vacant(new) => {
                    new.insert(number);
                    self.mesh(&object.mesh);
                }
            }
            let mut rest = object.clone();
            rest.mesh = Arc::default();
            let material = rest.material.take();
            self.material(material.as_deref());
            self.debug(&rest);
        }
    }

    /// Hashes a mesh: long arrays as bytes, the rest field by field, so that a new field of a mesh is hashed too.
    fn mesh(&mut self, mesh: &Mesh) {
        let mut rest = mesh.clone();
        rest.name = String::new();
        self.bytes(bytemuck::cast_slice(&std::mem::take(&mut rest.positions)));
        self.bytes(bytemuck::cast_slice(&std::mem::take(&mut rest.normals)));
        self.bytes(bytemuck::cast_slice(&rest.texcoords.take().unwrap_or_default()));
        self.bytes(bytemuck::cast_slice(&rest.colors.take().unwrap_or_default()));
        self.bytes(bytemuck::cast_slice(&std::mem::take(&mut rest.indices)));
        for material in std::mem::take(&mut rest.materials) {
            self.material(Some(&material));
        }
        self.debug(&rest);
    }

    fn material(&mut self, material: Option<&Material>) {
        let mut rest = material.cloned();
        if let Some(rest) = &mut rest {
            let (decal, alpha) = (rest.decal.take(), rest.alpha.take());
            self.texture(decal.as_ref());
            self.texture(alpha.as_ref());
        }
        self.debug(&rest);
    }

    fn texture(&mut self, texture: Option<&Arc<Texture>>) {
        let mut rest = texture.map(|texture| Texture::clone(texture));
        if let Some(rest) = &mut rest {
            rest.name = String::new();
            self.bytes(&std::mem::take(&mut rest.rgba));
        }
        self.debug(&rest);
    }
}

impl fmt::Write for Mark {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.bytes(text.as_bytes());
        Ok(())
    }
}
