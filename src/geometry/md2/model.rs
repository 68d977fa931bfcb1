//! A key-framed model made ready to draw: corners, triangles that are counter-clockwise from outside, poses.

use std::collections::HashMap;
use std::path::Path;

use glam::{DVec3, Vec3};

use super::super::{Error, Mesh, Part, Warning, normals as smooth};
use super::file::{self, Md2, Triangle};
use super::normals;
use crate::math::Aabb;

/// Greatest numbers of triangles, vertices, frames and skins in Quake II, for which the format was made.
const OF_QUAKE: [(&str, usize); 4] = [("triangles", 4096), ("vertices", 2048), ("frames", 512), ("skins", 32)];

/// Share of the box's volume below which a model has no inside: its triangles are turned by the format's rule.
const LEAST_VOLUME: f64 = 1e-3;

/// A model's skin, triangles and frames. Model space is right-handed with y up: the file's x stays, its z is y.
#[derive(Clone, Debug)]
pub struct Model {
    file: Md2,
    name: String,
    /// Distinct pairs of the file's vertex and texture coordinate: the vertices of the mesh.
    corners: Vec<[u16; 2]>,
    /// Three corners a triangle, counter-clockwise from outside.
    indices: Vec<u32>,
    /// Unit directions of the file's normals, in model space.
    directions: Vec<DVec3>,
}

/// A place between two key frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Numbers of two frames, below the model's.
    pub frames: [usize; 2],
    /// Share of the second, in [0, 1].
    pub blend: f64,
}

/// Source of a model's normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NormalSource {
    /// The file's, of 162 directions: up to 11 degrees off.
    #[default]
    File,
    /// Means of the triangles around each vertex.
    Recomputed,
}

impl Model {
    /// Reads the MD2 file at `path`. Warnings are: counts beyond Quake II's, names without an end, triangles without an area
    /// in any frame, which are left out, and triangles that are counter-clockwise although the format has them clockwise.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, and those of [`file::read`].
    pub fn load(path: &Path) -> Result<(Self, Vec<Warning>), Error> {
        Self::decode(path, &super::super::text::read(path)?)
    }

    /// [`Self::load`] of a file that is in memory; `path` is its name.
    ///
    /// # Errors
    ///
    /// Those of [`file::read`].
    pub fn decode(path: &Path, bytes: &[u8]) -> Result<(Self, Vec<Warning>), Error> {
        let mut warnings = Vec::new();
        let model = Self::new(file::read(bytes, path)?, &path.display().to_string(), |message| {
            warnings.push(Warning { path: path.to_owned(), line: 0, message });
        });
        Ok((model, warnings))
    }

    /// Makes a model ready. `name`: that of its meshes.
    pub fn new(file: Md2, name: &str, mut warn: impl FnMut(String)) -> Self {
        let vertices = file.frames.first().map_or(0, |frame| frame.vertices.len());
        let counts = [file.triangles.len(), vertices, file.frames.len(), file.skins.len()];
        for (count, (what, most)) in counts.into_iter().zip(OF_QUAKE).filter(|(count, (_, most))| count > most) {
            warn(format!("has {count} {what}; Quake II allows {most}, and other programs may refuse the file"));
        }
        let frames = file.frames.iter().map(|frame| frame.name.as_slice());
        let endless =
            frames.chain(file.skins.iter().map(<[u8; 64]>::as_slice)).filter(|name| !name.contains(&0)).count();
        if endless > 0 {
            warn(format!("{endless} names of frames or skins have no zero byte at their end"));
        }
        let turned: Vec<DVec3> = normals::directions().into_iter().map(upright).collect();
        let mut model =
            Self { file, name: name.to_owned(), corners: Vec::new(), indices: Vec::new(), directions: turned };
        let kept: Vec<Triangle> =
            model.file.triangles.iter().copied().filter(|triangle| model.has_area(triangle)).collect();
        if kept.len() < model.file.triangles.len() {
            let flat = model.file.triangles.len() - kept.len();
            warn(format!("{flat} triangles have no area in any frame; left out"));
        }
        let is_clockwise = model.is_clockwise(&kept);
        if !is_clockwise {
            warn(String::from("its triangles are counter-clockwise seen from outside; those of MD2 are clockwise"));
        }
        let mut known = HashMap::new();
        for triangle in &kept {
            let order = if is_clockwise { [0, 2, 1] } else { [0, 1, 2] };
            for corner in order {
                let pair = [triangle.vertices[corner], triangle.texcoords[corner]];
                let index = *known.entry(pair).or_insert(model.corners.len() as u32);
                if index as usize == model.corners.len() {
                    model.corners.push(pair);
                }
                model.indices.push(index);
            }
        }
        model
    }

    pub fn file(&self) -> &Md2 {
        &self.file
    }

    pub fn frame_count(&self) -> usize {
        self.file.frames.len()
    }

    /// Number of the first frame of this name.
    pub fn frame_named(&self, name: &str) -> Option<usize> {
        self.file.frames.iter().position(|frame| frame.name() == name)
    }

    /// Three indices a triangle into the vertices of [`Self::mesh`], counter-clockwise from outside.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// The file's vertex of each vertex of [`Self::mesh`].
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = usize> {
        self.corners.iter().map(|[vertex, _]| usize::from(*vertex))
    }

    /// The texel of each vertex of [`Self::mesh`], t downwards.
    pub fn texels(&self) -> impl ExactSizeIterator<Item = [i16; 2]> {
        self.corners.iter().map(|[_, texcoord]| self.file.texcoords[usize::from(*texcoord)])
    }

    /// The file with another skin: `texels` has one for each of [`Self::indices`]. Triangles are clockwise from outside;
    /// those without an area in any frame are left out. GL commands, where there are any, become one strip a triangle.
    ///
    /// `None`: more than 65536 distinct texels.
    pub fn with_skin(&self, size: [u32; 2], texels: &[[i16; 2]]) -> Option<Md2> {
        let mut file = Md2 {
            skin_size: size.map(u32::cast_signed),
            texcoords: Vec::new(),
            triangles: Vec::new(),
            ..self.file.clone()
        };
        let mut known = HashMap::new();
        for (triangle, texels) in self.indices.as_chunks::<3>().0.iter().zip(texels.as_chunks::<3>().0) {
            let mut written = Triangle::default();
            // Turned around, as MD2's are clockwise.
            for (place, corner) in [0, 2, 1].into_iter().enumerate() {
                let next = file.texcoords.len();
                let number = *known.entry(texels[corner]).or_insert(next);
                if number == next {
                    file.texcoords.push(texels[corner]);
                }
                written.vertices[place] = self.corners[triangle[corner] as usize][0];
                written.texcoords[place] = u16::try_from(number).ok()?;
            }
            file.triangles.push(written);
        }
        // A lone zero is the end of no commands.
        if file.gl_commands.len() > 1 {
            file.gl_commands = commands(&file);
        }
        Some(file)
    }

    /// Position of a vertex of the file in model space: both frames' positions in f64, blended.
    pub fn position(&self, pose: &Pose, vertex: usize) -> DVec3 {
        let [first, second] =
            pose.frames.map(|frame| upright(DVec3::from_array(self.file.frames[frame].position(vertex))));
        first + pose.blend * (second - first)
    }

    /// The mesh in a pose. Its vertices are the same corners in every pose; its only part has no material.
    ///
    /// A vertex's normal is that of the file, blended and of unit length, or the mean of its triangles by their angles.
    pub fn mesh(&self, pose: &Pose, source: NormalSource) -> Mesh {
        let indices = 0..self.indices.len() as u32;
        let part = Part { name: self.name.clone(), indices, material: None, bounds: Aabb::EMPTY };
        let mut mesh = Mesh {
            name: self.name.clone(),
            texcoords: Some(self.texcoords().collect()),
            indices: self.indices.clone(),
            parts: vec![part],
            ..Mesh::default()
        };
        self.move_to(pose, source, &mut mesh);
        mesh
    }

    /// Moves a mesh of [`Self::mesh`] to another pose. With the file's normals nothing is allocated.
    pub fn move_to(&self, pose: &Pose, source: NormalSource, mesh: &mut Mesh) {
        mesh.positions.clear();
        mesh.positions.extend(self.vertices().map(|vertex| self.position(pose, vertex).as_vec3().to_array()));
        mesh.normals.clear();
        match source {
            NormalSource::File => {
                // Unit length in f32 too, as completed normals have.
                let unit = |normal: Vec3| normal.as_dvec3().normalize_or_zero().as_vec3().to_array();
                mesh.normals.extend(self.vertices().map(|vertex| unit(self.normal(pose, vertex))));
            }
            NormalSource::Recomputed => mesh.normals.resize(self.corners.len(), [0.0; 3]),
        }
        // No edge stays sharp: the corners are the same in every pose.
        if mesh.normals.contains(&[0.0; 3]) {
            smooth::complete(mesh, std::f64::consts::PI);
        }
        mesh.update_bounds();
    }

    /// Texture coordinates of [`Self::mesh`], t upwards.
    pub fn texcoords(&self) -> impl ExactSizeIterator<Item = [f32; 2]> {
        let [width, height] = self.file.skin_size.map(f64::from);
        self.corners.iter().map(move |[_, texcoord]| {
            let [s, t] = self.file.texcoords[usize::from(*texcoord)].map(f64::from);
            [(s / width) as f32, (1.0 - t / height) as f32]
        })
    }

    /// A vertex of the file at each place, and the three places of each triangle, counter-clockwise from outside. Two vertices
    /// share a place if their positions are equal in every frame, and with that in every pose.
    pub fn places(&self) -> (Vec<usize>, Vec<[u32; 3]>) {
        let (mut known, mut vertices) = (HashMap::new(), Vec::new());
        let count = self.file.frames.first().map_or(0, |frame| frame.vertices.len());
        let places: Vec<u32> = (0..count)
            .map(|vertex| {
                // Adding zero makes 0 of -0, as they compare equal.
                let bits = |frame: &file::Frame| frame.position(vertex).map(|part| (part + 0.0).to_bits());
                let course: Vec<[u64; 3]> = self.file.frames.iter().map(bits).collect();
                *known.entry(course).or_insert_with(|| {
                    vertices.push(vertex);
                    (vertices.len() - 1) as u32
                })
            })
            .collect();
        let place = |index: u32| places[usize::from(self.corners[index as usize][0])];
        (vertices, self.indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(place)).collect())
    }

    /// The file's normal of a vertex; zero where two opposite ones are blended.
    fn normal(&self, pose: &Pose, vertex: usize) -> Vec3 {
        let [first, second] = pose.frames.map(|frame| {
            let [.., normal] = self.file.frames[frame].vertices[vertex];
            self.directions[usize::from(normal)]
        });
        (first + pose.blend * (second - first)).normalize_or_zero().as_vec3()
    }

    /// Tests whether a triangle has an area in some frame.
    fn has_area(&self, triangle: &Triangle) -> bool {
        let [a, b, c] = triangle.vertices.map(usize::from);
        self.file.frames.iter().any(|frame| {
            let [a, b, c] = [a, b, c].map(|vertex| DVec3::from_array(frame.position(vertex)));
            (b - a).cross(c - a) != DVec3::ZERO
        })
    }

    /// Tests whether the triangles are clockwise seen from outside: by the volume that they enclose in the first frame, and
    /// by the format's rule where they enclose none.
    fn is_clockwise(&self, triangles: &[Triangle]) -> bool {
        let at = |vertex: u16| self.position(&Pose::default(), usize::from(vertex));
        let corners = || triangles.iter().flat_map(|triangle| triangle.vertices.map(at));
        let bounds = Aabb::from_points(corners());
        let middle = 0.5 * (bounds.min + bounds.max);
        let volume: f64 = triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.vertices.map(|vertex| at(vertex) - middle);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        let extent = bounds.max - bounds.min;
        volume <= LEAST_VOLUME * extent.x * extent.y * extent.z
    }
}

/// A strip of three vertices for each triangle: (s, t) as a share of the skin, and the vertex.
fn commands(file: &Md2) -> Vec<i32> {
    let [width, height] = file.skin_size.map(|side| side as f32);
    let mut commands = Vec::with_capacity(10 * file.triangles.len() + 1);
    for triangle in &file.triangles {
        commands.push(3);
        for (vertex, texcoord) in triangle.vertices.iter().zip(triangle.texcoords) {
            let [s, t] = file.texcoords[usize::from(texcoord)].map(f32::from);
            commands.extend([(s / width).to_bits().cast_signed(), (t / height).to_bits().cast_signed()]);
            commands.push(i32::from(*vertex));
        }
    }
    commands.push(0);
    commands
}

/// A vector of the file, z up, in model space, y up.
fn upright(vector: DVec3) -> DVec3 {
    DVec3::new(vector.x, vector.z, -vector.y)
}
