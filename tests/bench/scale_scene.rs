//! Scenes of `ci/bench --scale`: balls on a floor, of which one number grows. The same scene for glumbra, as files, and for the
//! floor, as numbers.

use std::fmt::Write as _;
use std::path::Path;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::Result;
use super::ball::ball;
use super::model_files::Format;
use super::numbers::Numbers;

/// Numbers of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Triangles of the model, about.
    pub triangles: usize,
    pub objects: usize,
    pub lights: usize,
    /// Texels a side.
    pub map: usize,
    /// Pixels a side.
    pub picture: usize,
    /// True if objects stand one above another before the light: a shadow lies in the volumes of all of them.
    pub nested: bool,
    /// True if glumbra counts shadow volumes. The floor draws its map all the same.
    pub volumes: bool,
    /// Format of glumbra's model. The floor's is an OBJ file.
    pub format: Format,
}

impl Default for Point {
    fn default() -> Self {
        let (nested, volumes, format) = (false, false, Format::Obj);
        Self { triangles: 500, objects: 100, lights: 1, map: 1024, picture: 512, nested, volumes, format }
    }
}

/// Files of a scene, in their folder.
pub const SCENE: &str = "scene.toml";
pub const MODEL: &str = "model.obj";
const PLACES: &str = "places.jsonl";
pub const POINT: &str = "point.json";

/// Half a side of the square in which objects stand.
const HALF: f32 = 14.0;

/// A line of the file of places.
#[derive(Serialize, Deserialize)]
struct Place {
    translate: [f32; 3],
}

impl Point {
    /// Radius of the model, which stands on the floor.
    fn radius(&self) -> f32 {
        if self.nested { 2.0 } else { 0.4 * 2.0 * HALF / self.side() }
    }

    /// Objects along a side of the square.
    fn side(&self) -> f32 {
        (self.objects as f32).sqrt().ceil()
    }

    fn places(&self) -> impl Iterator<Item = Vec3> {
        let (side, step) = (self.side(), 2.0 * HALF / self.side());
        (0..self.objects).map(move |k| match self.nested {
            true => Vec3::new(0.0, 6.0 * k as f32 / self.objects as f32, 0.0),
            false => {
                let [x, z] = [k as f32 % side, (k as f32 / side).floor()].map(|at| step * (at + 0.5) - HALF);
                Vec3::new(x, 0.0, z)
            }
        })
    }

    /// The floor's scene, but for its models: [`read_places`] has these.
    pub fn numbers(&self) -> Numbers {
        Numbers {
            size: self.picture as i32,
            map_size: self.map as i32,
            eye: Vec3::new(4.0, 30.0, 40.0),
            target: Vec3::ZERO,
            fov_y_degrees: 45.0,
            near_far: [1.0, 120.0],
            light: light(0),
            light_target: Vec3::ZERO,
            cone_degrees: 60.0,
            light_near_far: [5.0, 80.0],
            floor_half: 18.0,
            models: Vec::new(),
        }
    }

    /// Writes the scene's files into `folder`.
    pub fn write(&self, folder: &Path) -> Result<()> {
        std::fs::write(folder.join(POINT), serde_json::to_string(self)?)?;
        std::fs::write(folder.join(MODEL), ball(self.triangles, self.radius()))?;
        if self.format != Format::Obj {
            let (mesh, _) = glumbra::geometry::load_obj(&folder.join(MODEL))?;
            self.format.write(&mesh, &self.places().collect::<Vec<_>>(), folder)?;
        }
        let mut lines = String::new();
        for place in self.places() {
            let _ = writeln!(lines, "{}", serde_json::to_string(&Place { translate: place.to_array() })?);
        }
        std::fs::write(folder.join(PLACES), lines)?;
        Ok(std::fs::write(folder.join(SCENE), self.text())?)
    }

    fn text(&self) -> String {
        let Numbers { eye, target, fov_y_degrees, near_far: [near, far], light_target, .. } = self.numbers();
        let Numbers { cone_degrees, light_near_far, floor_half, .. } = self.numbers();
        let side = self.picture;
        let vector = |at: Vec3| format!("{:?}", at.to_array());
        let mut text = format!(
            "[image]\nsize = [{side}, {side}]\nbackground = [0.30, 0.40, 0.60]\n[camera]\neye = {}\ntarget = {}\n\
             fov_y = {fov_y_degrees:?}\nnear = {near:?}\nfar = {far:?}\n",
            vector(eye),
            vector(target)
        );
        let shadow = match self.volumes {
            true => String::from("technique = \"shadow-volume\""),
            false => format!(
                "technique = \"shadow-map\", size = {}, offset = {{ factor = 1.1, units = 4.0 }}, redraw = \"always\"",
                self.map
            ),
        };
        for index in 0..self.lights {
            let _ = writeln!(
                text,
                "[[light]]\nkind = \"spot\"\nposition = {}\ntarget = {}\ncone = {cone_degrees:?}\nnear = {:?}\nfar = {:?}\n\
                 shadow = {{ {shadow} }}",
                vector(light(index)),
                vector(light_target),
                light_near_far[0],
                light_near_far[1]
            );
        }
        let places = match self.format {
            Format::Nodes => String::new(),
            _ => format!("instances = \"{PLACES}\""),
        };
        // The material of files that have none; glTF's is another.
        let gray = match self.format {
            Format::Glb | Format::Nodes => "material = { ambient = [0.8, 0.8, 0.8], diffuse = [0.8, 0.8, 0.8] }",
            _ => "",
        };
        let _ = writeln!(
            text,
            "[[object]]\nmesh = \"quad\"\nscale = [{floor_half:?}, 1.0, {floor_half:?}]\n\
             material = {{ diffuse = [0.7, 0.7, 0.7] }}\n[[object]]\nmesh = \"{}\"\n{gray}\n{places}",
            self.format.name()
        );
        text
    }
}

/// Places of the models, from the file that glumbra reads, too.
pub fn read_places(folder: &Path) -> Result<Vec<Vec3>> {
    let text = std::fs::read_to_string(folder.join(PLACES))?;
    text.lines().map(|line| Ok(Vec3::from_array(serde_json::from_str::<Place>(line)?.translate))).collect()
}

/// Position of a light: on a circle above the floor.
fn light(index: usize) -> Vec3 {
    let angle = index as f32;
    Vec3::new(14.0 * angle.cos(), 34.0, 14.0 * angle.sin())
}
