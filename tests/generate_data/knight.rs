//! A knight of few polygons, as an MD2 file with two animations: "stand", who breathes and looks around, and "run". Space as
//! in the file: x forwards, y to the left, z up; the ground is at -24, as in Quake II.
//!
//! Body parts are closed tubes. The trunk and the head have one half of a skin, mirrored at the middle; the left limbs are
//! mirrored copies of the right ones, with the same skin.

use glam::{DVec3, dvec3};
use glumbra::geometry::md2::{Frame, Md2, Triangle, nearest_normal};

use super::knight_pose::{Joint, Pose, Side, running, standing, wave};
use super::knight_skin::{Region, SIZE};

/// Frames of each animation.
const FRAMES: usize = 8;

/// Cross-section of a tube at a place along its axis: middle, and half widths forwards and sideways.
struct Ring {
    z: f64,
    x: f64,
    half: [f64; 2],
}

/// A tube along z with flat ends.
struct Tube {
    region: Region,
    sides: usize,
    /// From the top down.
    rings: Vec<Ring>,
    /// True if both halves, left and right, have the same skin.
    is_mirrored_at_middle: bool,
    joint: Joint,
}

fn ring(z: f64, x: f64, half: [f64; 2]) -> Ring {
    Ring { z, x, half }
}

fn tubes() -> Vec<Tube> {
    let both = [Side::Right, Side::Left];
    let tube = |region, sides, joint, rings| Tube { region, sides, rings, is_mirrored_at_middle: false, joint };
    let middle = |region, sides, joint, rings| Tube { region, sides, rings, is_mirrored_at_middle: true, joint };
    let mut tubes = vec![
        middle(
            Region::Trunk,
            8,
            Joint::Trunk,
            vec![
                ring(18.2, 0.2, [2.2, 2.6]),
                ring(16.8, 0.0, [3.6, 6.8]),
                ring(13.0, 0.5, [4.9, 7.0]),
                ring(8.0, 0.3, [4.3, 5.7]),
                ring(4.5, 0.1, [3.7, 4.9]),
                ring(2.4, 0.1, [4.4, 5.6]),
                ring(-5.5, 0.4, [6.0, 7.6]),
            ],
        ),
        middle(
            Region::Head,
            8,
            Joint::Head,
            vec![
                ring(11.2, -0.4, [1.2, 1.0]),
                ring(10.0, -0.3, [3.2, 2.7]),
                ring(7.4, 0.1, [4.3, 3.6]),
                ring(4.4, 0.5, [4.5, 3.6]),
                ring(1.4, 0.6, [4.0, 3.2]),
                ring(-0.6, 0.2, [3.0, 3.0]),
            ],
        ),
        // The plume: thin, over the middle of the helmet.
        middle(
            Region::Plume,
            6,
            Joint::Head,
            vec![
                ring(15.8, -3.4, [1.2, 0.5]),
                ring(14.9, -2.0, [3.6, 0.7]),
                ring(12.8, -1.6, [4.9, 0.9]),
                ring(10.6, -1.2, [4.6, 0.7]),
                ring(9.4, -1.0, [3.6, 0.6]),
            ],
        ),
        tube(
            Region::Shield,
            6,
            Joint::Shield,
            vec![
                ring(7.2, 0.0, [4.6, 0.5]),
                ring(6.4, 0.0, [5.4, 0.9]),
                ring(0.0, 0.0, [5.0, 1.5]),
                ring(-6.0, 0.0, [3.0, 1.1]),
                ring(-9.6, 0.0, [0.7, 0.6]),
            ],
        ),
        tube(
            Region::Sword,
            6,
            Joint::Sword,
            vec![
                ring(3.2, 0.0, [0.7, 0.6]),
                ring(-0.6, 0.0, [0.5, 0.5]),
                ring(-1.5, 0.0, [2.9, 0.7]),
                ring(-2.4, 0.0, [2.9, 0.7]),
                ring(-3.3, 0.0, [1.1, 0.4]),
                ring(-20.0, 0.0, [0.9, 0.35]),
                ring(-22.5, 0.0, [0.4, 0.3]),
            ],
        ),
    ];
    for side in both {
        tubes.extend([
            tube(
                Region::Pauldron,
                6,
                Joint::UpperArm(side),
                vec![
                    ring(3.2, 0.0, [1.4, 1.2]),
                    ring(2.2, 0.0, [3.3, 2.6]),
                    ring(-0.4, 0.0, [3.9, 3.1]),
                    ring(-2.6, 0.0, [3.5, 2.9]),
                ],
            ),
            tube(
                Region::UpperArm,
                6,
                Joint::UpperArm(side),
                vec![ring(0.5, 0.0, [2.3, 2.1]), ring(-4.0, 0.0, [2.4, 2.1]), ring(-9.2, 0.0, [1.9, 1.7])],
            ),
            tube(
                Region::Forearm,
                6,
                Joint::Forearm(side),
                vec![
                    ring(1.2, 0.0, [2.2, 2.0]),
                    ring(-2.5, 0.0, [2.4, 2.2]),
                    ring(-6.6, 0.0, [1.8, 1.7]),
                    ring(-7.4, 0.0, [2.3, 2.0]),
                    ring(-10.8, 0.0, [1.5, 1.1]),
                ],
            ),
            tube(
                Region::Thigh,
                6,
                Joint::Thigh(side),
                vec![ring(2.0, 0.0, [3.0, 2.8]), ring(-4.0, 0.2, [3.1, 2.9]), ring(-11.6, 0.1, [2.5, 2.4])],
            ),
            tube(
                Region::Shin,
                6,
                Joint::Shin(side),
                vec![
                    ring(2.0, 0.5, [2.5, 2.3]),
                    ring(0.4, 0.7, [3.2, 2.8]),
                    ring(-1.8, 0.2, [2.6, 2.5]),
                    ring(-4.6, -0.2, [2.7, 2.5]),
                    ring(-11.0, 0.0, [1.9, 1.8]),
                ],
            ),
            tube(
                Region::Foot,
                6,
                Joint::Foot(side),
                vec![ring(1.6, 0.2, [2.0, 1.9]), ring(-0.6, 1.4, [3.6, 2.2]), ring(-1.6, 1.8, [4.5, 2.5])],
            ),
        ]);
    }
    tubes
}

/// The side that a tube's copy is mirrored for.
fn side(joint: Joint) -> Option<Side> {
    match joint {
        Joint::UpperArm(side) | Joint::Forearm(side) | Joint::Thigh(side) | Joint::Shin(side) | Joint::Foot(side) => {
            Some(side)
        }
        _ => None,
    }
}

/// The mesh in the poses' joints: vertices by part, triangles clockwise seen from outside.
struct Mesh {
    /// Place in the joint's space, and the joint.
    vertices: Vec<(DVec3, Joint)>,
    texcoords: Vec<[i16; 2]>,
    triangles: Vec<Triangle>,
}

impl Mesh {
    fn new() -> Self {
        let mut mesh = Self { vertices: Vec::new(), texcoords: Vec::new(), triangles: Vec::new() };
        tubes().iter().for_each(|tube| mesh.add(tube));
        mesh
    }

    fn add(&mut self, tube: &Tube) {
        // The left copy's y is turned around, and so are its triangles.
        let mirror = if side(tube.joint) == Some(Side::Left) { -1.0 } else { 1.0 };
        let around = |number: usize| {
            // Eighths or sixths of a turn, from the front.
            match (tube.sides, number % tube.sides) {
                (8, at) => (wave(at + 2), wave(at)),
                (_, 0) => (1.0, 0.0),
                (_, 3) => (-1.0, 0.0),
                (_, at) => (
                    if at == 1 || at == 5 { 0.5 } else { -0.5 },
                    if at < 3 { 0.75_f64.sqrt() } else { -(0.75_f64.sqrt()) },
                ),
            }
        };
        let [top, bottom] = [tube.rings[0].z, tube.rings[tube.rings.len() - 1].z];
        let down = |z: f64| 0.06 + 0.88 * (top - z) / (top - bottom);
        let (sides, rings) = (tube.sides, tube.rings.len());
        let first = self.vertices.len() as u16;
        let first_st = self.texcoords.len() as u16;
        for ring in &tube.rings {
            for number in 0..sides {
                let (x, y) = around(number);
                let place = dvec3(ring.x + ring.half[0] * x, mirror * ring.half[1] * y, ring.z);
                self.vertices.push((place, tube.joint));
            }
            // One more than sides: the seam has two.
            for number in 0..=sides {
                let across = number as f64 / sides as f64;
                let across = if tube.is_mirrored_at_middle { 1.0 - (2.0 * across - 1.0).abs() } else { across };
                self.texcoords.push(tube.region.texel(0.04 + 0.92 * across, down(ring.z)));
            }
        }
        let [above, below] = [&tube.rings[0], &tube.rings[rings - 1]].map(|ring| dvec3(ring.x, 0.0, ring.z));
        let (top_vertex, top_st) = (self.vertices.len() as u16, self.texcoords.len() as u16);
        self.vertices.extend([(above, tube.joint), (below, tube.joint)]);
        self.texcoords.extend([tube.region.texel(0.5, 0.0), tube.region.texel(0.5, 1.0)]);
        let vertex = |ring: usize, number: usize| first + (ring * sides + number % sides) as u16;
        let texcoord = |ring: usize, number: usize| first_st + (ring * (sides + 1) + number) as u16;
        let mut add = |corners: [(u16, u16); 3]| {
            let [a, b, c] = if mirror < 0.0 { [corners[0], corners[2], corners[1]] } else { corners };
            self.triangles.push(Triangle { vertices: [a.0, b.0, c.0], texcoords: [a.1, b.1, c.1] });
        };
        for number in 0..sides {
            let corner = |ring: usize, number: usize| (vertex(ring, number), texcoord(ring, number));
            for ring in 0..rings - 1 {
                let [a, b] = [corner(ring, number), corner(ring, number + 1)];
                let [c, d] = [corner(ring + 1, number), corner(ring + 1, number + 1)];
                add([a, b, d]);
                add([a, d, c]);
            }
            add([(top_vertex, top_st), corner(0, number + 1), corner(0, number)]);
            let last = rings - 1;
            add([(top_vertex + 1, top_st + 1), corner(last, number), corner(last, number + 1)]);
        }
    }

    /// A frame of the file: bytes in the box around the pose, and the nearest normals.
    fn frame(&self, name: &str, pose: &Pose) -> Frame {
        let places: Vec<DVec3> = self.vertices.iter().map(|(place, joint)| pose.place(*joint).of(*place)).collect();
        let mut normals = vec![DVec3::ZERO; places.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.vertices.map(|vertex| places[usize::from(vertex)]);
            // Clockwise: the normal is the other way around.
            let normal = (c - a).cross(b - a);
            triangle.vertices.iter().for_each(|vertex| normals[usize::from(*vertex)] += normal);
        }
        let low = places.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let scale = ((high - low) / 255.0).as_vec3();
        let translate = low.as_vec3();
        let vertices = places.iter().zip(&normals).map(|(place, normal)| {
            let codes = ((*place - translate.as_dvec3()) / scale.as_dvec3()).to_array();
            let [x, y, z] = codes.map(|code| (code + 0.5).floor().clamp(0.0, 255.0) as u8);
            [x, y, z, nearest_normal(*normal)]
        });
        let mut bytes = [0; 16];
        bytes[..name.len()].copy_from_slice(name.as_bytes());
        Frame { scale: scale.to_array(), translate: translate.to_array(), name: bytes, vertices: vertices.collect() }
    }
}

/// The model.
pub fn knight() -> Md2 {
    let mesh = Mesh::new();
    let frames = |name: &str, pose: fn(usize) -> Pose| -> Vec<Frame> {
        (0..FRAMES).map(|frame| mesh.frame(&format!("{name}{}", frame + 1), &pose(frame))).collect()
    };
    let frames = [frames("stand", standing), frames("run", running)].concat();
    let mut skin = [0; 64];
    skin[..10].copy_from_slice(b"knight.png");
    Md2 {
        skin_size: [SIZE as i32; 2],
        skins: vec![skin],
        texcoords: mesh.texcoords,
        triangles: mesh.triangles,
        frames,
        gl_commands: vec![0],
    }
}
