//! Matrices and draws: cells of the window, each of two triangles, from places that the matrices bring there.

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::generate::StreamMaker;
use super::state::FixedState;
use crate::conformance::bench::fixed_commands::{
    FIXED_UNITS, FixedCommand as Command, FixedFigure, FixedGiven, FixedVertex, FixedWay,
};
use crate::context::compatibility::raw;

/// Cells along x and y, and pixels along a cell's side.
pub const CELLS: [usize; 2] = [8, 2];
pub const CELL: usize = 4;

/// Size of the window in pixels.
pub const SIZE: DVec2 = DVec2::new((CELLS[0] * CELL) as f64, (CELLS[1] * CELL) as f64);

fn numbers(matrix: DMat4) -> [f32; 16] {
    matrix.as_mat4().to_cols_array()
}

/// A parallel projection of x within 2 of `middle`, y within `reach`, z from -1 to -9.
fn orthographic(middle: f64, reach: f64) -> DMat4 {
    let scale = DMat4::from_scale(DVec3::new(0.5, 1.0 / reach, -0.25));
    scale * DMat4::from_translation(DVec3::new(-middle, 0.0, 5.0))
}

impl StreamMaker<'_> {
    /// A rotation, a scale or a shift.
    fn any_motion(&mut self) -> DMat4 {
        let axis = DVec3::from_array(self.vector(1.0).map(f64::from)).normalize();
        let scale = DVec3::from_array([(); 3].map(|()| f64::from(self.random.between(0.6, 1.7))));
        let shift = DVec3::from_array(self.vector(1.0).map(f64::from));
        let angle = f64::from(self.random.between(-1.5, 1.5));
        DMat4::from_translation(shift) * DMat4::from_axis_angle(axis, angle) * DMat4::from_scale(scale)
    }

    fn motion(&mut self) {
        let axis = self.vector(1.0);
        match self.random.below(6) {
            0 => {
                let degrees = self.random.between(-90.0, 90.0);
                self.push(Command::Rotate(degrees, axis));
            }
            1 => {
                let scale = [(); 3].map(|()| self.random.pick(&[0.75, 1.25, 1.0, -1.0]));
                self.push(Command::Scale(scale));
            }
            2 => self.push(Command::Translate(axis)),
            3 => {
                let by = self.any_motion();
                self.push(Command::MultMatrix(numbers(by)));
            }
            4 => self.push(Command::LoadIdentity),
            _ => {
                let to = self.any_motion();
                self.push(Command::LoadMatrix(numbers(to)));
            }
        }
    }

    /// Keeps the matrix of the mode, or gives one back.
    fn stacked(&mut self) {
        let depth = self.state.stack().len();
        if depth > 1 && self.chance(0.5) {
            self.push(Command::PopMatrix);
        } else if depth < 2 || self.state.matrix_mode == raw::MODELVIEW && depth < 6 {
            self.push(Command::PushMatrix);
            self.motion();
        }
    }

    pub fn modelview(&mut self) {
        self.matrix_mode(raw::MODELVIEW);
        if self.chance(0.3) { self.stacked() } else { self.motion() }
    }

    /// The view, orthographic or with perspective; one that is kept.
    pub fn projection(&mut self) {
        self.matrix_mode(raw::PROJECTION);
        let depth = self.state.projection.len();
        if depth > 1 && self.chance(0.5) {
            return self.push(Command::PopMatrix);
        }
        if depth == 1 && self.chance(0.3) {
            self.push(Command::PushMatrix);
        }
        let reach = f64::from(self.random.between(0.8, 1.6));
        let side = f64::from(self.random.between(-0.3, 0.3));
        let matrix = if self.chance(0.5) {
            orthographic(side, 1.5)
        } else {
            let near = 1.0;
            DMat4::from_cols(
                DVec4::new(near / reach, 0.0, 0.0, 0.0),
                DVec4::new(0.0, near / (0.7 * reach), 0.0, 0.0),
                DVec4::new(side, 0.1, -10.0 / 8.0, -1.0),
                DVec4::new(0.0, 0.0, -18.0 / 8.0, 0.0),
            )
        };
        self.push(Command::LoadMatrix(numbers(matrix)));
    }

    pub fn texture_matrix(&mut self) {
        match self.random.below(7) {
            0 => self.push(Command::LoadIdentity),
            1 => self.stacked(),
            // As a texture is placed: moved, then scaled.
            6 => {
                let by = self.vector(0.6);
                let scale = [(); 3].map(|()| self.random.pick(&[0.5, 0.75, 1.5, 2.0]));
                self.push(Command::LoadIdentity);
                self.push(Command::Translate(by));
                self.push(Command::Scale(scale));
            }
            // One that makes q of s.
            2 => {
                let mut matrix = [0.0; 16];
                (matrix[0], matrix[5], matrix[10], matrix[15]) = (0.8, 1.2, 0.9, 1.0);
                matrix[3] = self.random.between(-0.2, 0.2);
                matrix[12] = self.random.between(-0.5, 0.5);
                self.push(Command::LoadMatrix(matrix));
            }
            _ => self.motion(),
        }
    }

    /// Loads matrices anew that bring no place into the window.
    pub fn repair_matrices(&mut self) {
        let projection = FixedState::top(&self.state.projection);
        if projection == DMat4::IDENTITY || !projection.is_finite() || projection.determinant().abs() < 1e-6 {
            self.projection();
            // One that is given back may be no better.
            if FixedState::top(&self.state.projection) == DMat4::IDENTITY {
                let matrix = orthographic(0.0, 1.0);
                self.push(Command::LoadMatrix(numbers(matrix)));
            }
        }
        let modelview = FixedState::top(&self.state.modelview);
        let sides = [0, 1, 2].map(|axis| modelview.col(axis).length());
        let shift = modelview.col(3).truncate().length();
        let even = modelview.determinant().abs() > 0.1 && sides.iter().all(|side| (0.3..3.0).contains(side));
        if !even || shift > 6.0 {
            self.matrix_mode(raw::MODELVIEW);
            let to = self.any_motion();
            self.push(Command::LoadMatrix(numbers(to)));
        }
        // A texture matrix that has grown.
        for unit in 0..FIXED_UNITS {
            let matrix = FixedState::top(&self.state.texture_matrices[unit]);
            if matrix.to_cols_array().iter().any(|number| number.abs() > 4.0) {
                self.activate(unit);
                self.matrix_mode(glow::TEXTURE);
                self.push(Command::LoadIdentity);
            }
        }
    }

    /// Place in model space that the matrices bring to a place of the window, at any depth.
    fn place(&mut self, object_from_clip: DMat4, window: DVec2) -> [f32; 4] {
        let at = window / SIZE * 2.0 - 1.0;
        let z = f64::from(self.random.between(-0.8, 0.8));
        let object = object_from_clip * DVec4::new(at.x, at.y, z, 1.0);
        let [x, y, z, _] = (object / object.w).as_vec4().to_array();
        [x, y, z, 1.0]
    }

    /// Chooses what vertices are given from now on. A driver compiles another vertex program for it.
    pub fn give(&mut self) {
        self.given = FixedGiven {
            color: self.chance(0.6),
            secondary: self.chance(0.4),
            normal: self.chance(0.6),
            fog: self.chance(0.5),
            coordinates: [(); FIXED_UNITS].map(|()| self.chance(0.6)),
        };
    }

    /// Values that a vertex has beside its place.
    fn values(&mut self) -> FixedVertex {
        let length = if self.state.on.has(raw::NORMALIZE) { self.random.between(0.2, 3.0) } else { 1.0 };
        let color = self.color();
        FixedVertex {
            position: [0.0; 4],
            color,
            secondary: [(); 3].map(|()| self.random.between(0.0, 0.4)),
            normal: self.vector(length),
            fog: self.random.between(0.0, 6.0),
            coordinates: [(); FIXED_UNITS].map(|()| self.coordinates()),
        }
    }

    /// A draw of all cells: quads of one value each, or of four.
    pub fn figure(&mut self) -> FixedFigure {
        let clip_from_object = FixedState::top(&self.state.projection) * FixedState::top(&self.state.modelview);
        let object_from_clip = clip_from_object.inverse();
        let given = self.given;
        // The colours of a quad or a polygon between its corners are open: a fifth of the draws have them.
        let primitives = [
            glow::TRIANGLES,
            glow::TRIANGLES,
            glow::TRIANGLES,
            glow::TRIANGLE_STRIP,
            glow::TRIANGLE_STRIP,
            glow::TRIANGLE_FAN,
            glow::TRIANGLE_FAN,
            glow::TRIANGLE_FAN,
            raw::QUADS,
            raw::POLYGON,
        ];
        let primitive = self.deal("primitive", &primitives);
        let (order, length): (&[usize], usize) = match primitive {
            glow::TRIANGLES => (&[0, 1, 2, 0, 2, 3], 6 * CELLS[0] * CELLS[1]),
            glow::TRIANGLE_STRIP => (&[0, 1, 3, 2], 4),
            raw::QUADS => (&[0, 1, 2, 3], 4 * CELLS[0] * CELLS[1]),
            _ => (&[0, 1, 2, 3], 4),
        };
        let is_triangles = !matches!(primitive, raw::QUADS | raw::POLYGON);
        let (constant, turns) = (!is_triangles || self.chance(0.5), self.chance(0.5));
        let mut vertices = Vec::new();
        for cell in 0..CELLS[0] * CELLS[1] {
            let corner = DVec2::new((cell % CELLS[0]) as f64, (cell / CELLS[0]) as f64);
            let turned = turns && self.chance(0.5);
            let shared = self.values();
            let mut corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|at| {
                let values = if constant { shared } else { self.values() };
                let position = self.place(object_from_clip, (corner + DVec2::from_array(at)) * CELL as f64);
                FixedVertex { position, ..values }
            });
            if turned {
                corners.swap(1, 3);
            }
            vertices.extend(order.iter().map(|index| corners[*index]));
        }
        let ways = [
            FixedWay::Immediate,
            FixedWay::Immediate,
            FixedWay::Arrays,
            FixedWay::Elements,
            FixedWay::Buffers,
            FixedWay::Buffers,
        ];
        let way = self.deal("way", &ways);
        FixedFigure { primitive, length, vertices, given, way }
    }
}
