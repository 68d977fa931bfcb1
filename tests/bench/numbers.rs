//! The numbers of the bench's scenes, those of `data/scenes/bench_*.toml`; the bench compares the pictures.

use glam::Vec3;

use super::Scene;

/// One scene's.
pub struct Numbers {
    pub size: i32,
    pub map_size: i32,
    pub eye: Vec3,
    pub target: Vec3,
    pub fov_y_degrees: f32,
    pub near_far: [f32; 2],
    pub light: Vec3,
    pub light_target: Vec3,
    pub cone_degrees: f32,
    pub light_near_far: [f32; 2],
    pub floor_half: f32,
    pub models: Vec<Vec3>,
}

/// Those of `scene`.
pub fn numbers(scene: Scene) -> Numbers {
    match scene {
        Scene::S1 => Numbers {
            size: 512,
            map_size: 1024,
            eye: Vec3::new(3.0, 2.5, 4.0),
            target: Vec3::new(0.0, 0.6, 0.0),
            fov_y_degrees: 40.0,
            near_far: [0.1, 50.0],
            light: Vec3::new(2.0, 4.0, 3.0),
            light_target: Vec3::new(0.0, 0.5, 0.0),
            cone_degrees: 60.0,
            light_near_far: [0.5, 20.0],
            floor_half: 4.0,
            models: vec![Vec3::ZERO],
        },
        Scene::S2 => Numbers {
            size: 1024,
            map_size: 2048,
            eye: Vec3::new(16.0, 14.0, 22.0),
            target: Vec3::new(0.0, 0.0, 1.0),
            fov_y_degrees: 45.0,
            near_far: [0.5, 100.0],
            light: Vec3::new(8.0, 26.0, 12.0),
            light_target: Vec3::new(0.0, 0.0, 0.0),
            cone_degrees: 70.0,
            light_near_far: [5.0, 70.0],
            floor_half: 20.0,
            models: (0..100)
                .map(|k| Vec3::new(3.6 * ((k % 10) as f32 - 4.5), 0.0, 3.6 * ((k / 10) as f32 - 4.5)))
                .collect(),
        },
    }
}
