//! Vertices in immediate mode, from the client's arrays and from buffers.

use glow::HasContext;

use super::player::FIRST_INDEX;
use super::{FIXED_UNITS, FixedFigure, FixedGiven, FixedPlayer, FixedVertex, FixedWay};
use crate::context::compatibility::raw;

impl FixedPlayer<'_> {
    /// Sets the current colour, by three components where the fourth is what GL makes it.
    pub(super) fn color(&self, color: [f32; 4]) {
        let [red, green, blue, alpha] = color;
        // SAFETY: the context is current; four numbers are read.
        unsafe {
            match () {
                () if alpha == 1.0 => self.binding().Color3f(red, green, blue),
                () if red > green => self.binding().Color4fv(color.as_ptr()),
                () => self.binding().Color4f(red, green, blue, alpha),
            }
        }
    }

    /// Sets current coordinates, by as few components as say the same.
    pub(super) fn coordinates(&self, unit: u32, values: [f32; 4]) {
        let name = glow::TEXTURE0 + unit;
        let [s, t, r, q] = values;
        // SAFETY: the context is current; four numbers are read.
        unsafe {
            match () {
                () if [r, q] == [0.0, 1.0] && unit == 0 => self.binding().TexCoord2f(s, t),
                () if [r, q] == [0.0, 1.0] => self.binding().MultiTexCoord2f(name, s, t),
                () if q == 1.0 => self.binding().MultiTexCoord3f(name, s, t, r),
                () if unit == 0 && s > t => self.binding().TexCoord4fv(values.as_ptr()),
                () => self.binding().MultiTexCoord4fv(name, values.as_ptr()),
            }
        }
    }

    fn vertex(&self, given: FixedGiven, vertex: &FixedVertex) {
        let fixed = self.binding();
        // SAFETY: the context is current; each call reads as many numbers as it takes.
        unsafe {
            if given.color {
                fixed.Color4fv(vertex.color.as_ptr());
            }
            if given.secondary {
                fixed.SecondaryColor3fv(vertex.secondary.as_ptr());
            }
            if given.normal {
                fixed.Normal3fv(vertex.normal.as_ptr());
            }
            if given.fog {
                fixed.FogCoordf(vertex.fog);
            }
            for unit in (0..FIXED_UNITS).filter(|unit| given.coordinates[*unit]) {
                // All by four: calls of different counts in one primitive are not tried.
                fixed.MultiTexCoord4fv(glow::TEXTURE0 + unit as u32, vertex.coordinates[unit].as_ptr());
            }
            let [x, y, z, w] = vertex.position;
            if w == 1.0 && x > y { fixed.Vertex3f(x, y, z) } else { fixed.Vertex4fv(vertex.position.as_ptr()) }
        }
    }

    /// Enables these arrays and no others.
    pub(super) fn enable(&mut self, given: FixedGiven) {
        let fixed = self.binding();
        let switch = |array: u32, was: bool, is: bool| {
            // SAFETY: the context is current; sets state.
            unsafe {
                match (was, is) {
                    (false, true) => fixed.EnableClientState(array),
                    (true, false) => fixed.DisableClientState(array),
                    _ => {}
                }
            }
        };
        let was = self.enabled;
        switch(raw::COLOR_ARRAY, was.color, given.color);
        switch(raw::SECONDARY_COLOR_ARRAY, was.secondary, given.secondary);
        switch(raw::NORMAL_ARRAY, was.normal, given.normal);
        switch(raw::FOG_COORD_ARRAY, was.fog, given.fog);
        for unit in 0..FIXED_UNITS {
            if was.coordinates[unit] != given.coordinates[unit] {
                // SAFETY: as above.
                unsafe { fixed.ClientActiveTexture(glow::TEXTURE0 + unit as u32) };
                switch(raw::TEXTURE_COORD_ARRAY, was.coordinates[unit], given.coordinates[unit]);
            }
        }
        self.enabled = given;
    }

    pub(super) fn draw(&mut self, figure: &FixedFigure) {
        let FixedFigure { primitive, length, vertices, given, way } = figure;
        if *way == FixedWay::Immediate {
            for part in vertices.chunks(*length) {
                // SAFETY: the context is current; nothing but vertices comes between.
                unsafe {
                    self.binding().Begin(*primitive);
                    part.iter().for_each(|vertex| self.vertex(*given, vertex));
                    self.binding().End();
                }
            }
            return;
        }
        self.enable(*given);
        if *way == FixedWay::Buffers {
            return self.draw_from_buffers(figure);
        }
        let (fixed, stride) = (self.binding(), size_of::<FixedVertex>() as i32);
        let Some(first) = vertices.first() else { return };
        // SAFETY: the context is current, no buffer is bound, and the vertices outlive the draws.
        unsafe {
            fixed.VertexPointer(4, glow::FLOAT, stride, first.position.as_ptr().cast());
            fixed.EnableClientState(raw::VERTEX_ARRAY);
            if given.color {
                fixed.ColorPointer(4, glow::FLOAT, stride, first.color.as_ptr().cast());
            }
            if given.secondary {
                fixed.SecondaryColorPointer(3, glow::FLOAT, stride, first.secondary.as_ptr().cast());
            }
            if given.normal {
                fixed.NormalPointer(glow::FLOAT, stride, first.normal.as_ptr().cast());
            }
            if given.fog {
                fixed.FogCoordPointer(glow::FLOAT, stride, std::ptr::from_ref(&first.fog).cast());
            }
            for unit in (0..FIXED_UNITS).filter(|unit| given.coordinates[*unit]) {
                fixed.ClientActiveTexture(glow::TEXTURE0 + unit as u32);
                fixed.TexCoordPointer(4, glow::FLOAT, stride, first.coordinates[unit].as_ptr().cast());
            }
            for from in (0..vertices.len()).step_by(*length) {
                if *way == FixedWay::Arrays {
                    self.gl.draw_arrays(*primitive, from as i32, *length as i32);
                } else {
                    self.gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(self.indices));
                    self.gl.draw_elements(*primitive, *length as i32, glow::UNSIGNED_BYTE, from as i32);
                    self.gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, None);
                }
            }
            fixed.DisableClientState(raw::VERTEX_ARRAY);
        }
    }

    /// Draws from a buffer for each attribute that is given.
    fn draw_from_buffers(&self, figure: &FixedFigure) {
        let FixedFigure { primitive, length, vertices, given, .. } = figure;
        let (fixed, gl, float) = (self.binding(), &self.gl, glow::FLOAT);
        let null = std::ptr::null();
        // SAFETY: the context is current; each array has as many numbers as its pointer says, and one for each vertex.
        unsafe {
            self.fill(0, vertices.iter().flat_map(|vertex| &vertex.position));
            fixed.VertexPointer(4, float, 0, null);
            fixed.EnableClientState(raw::VERTEX_ARRAY);
            if given.color {
                self.fill(1, vertices.iter().flat_map(|vertex| &vertex.color));
                fixed.ColorPointer(4, float, 0, null);
            }
            if given.secondary {
                self.fill(2, vertices.iter().flat_map(|vertex| &vertex.secondary));
                fixed.SecondaryColorPointer(3, float, 0, null);
            }
            if given.normal {
                self.fill(3, vertices.iter().flat_map(|vertex| &vertex.normal));
                fixed.NormalPointer(float, 0, null);
            }
            if given.fog {
                self.fill(4, vertices.iter().map(|vertex| &vertex.fog));
                fixed.FogCoordPointer(float, 0, null);
            }
            for unit in (0..FIXED_UNITS).filter(|unit| given.coordinates[*unit]) {
                self.fill(5 + unit, vertices.iter().flat_map(|vertex| &vertex.coordinates[unit]));
                fixed.ClientActiveTexture(glow::TEXTURE0 + unit as u32);
                fixed.TexCoordPointer(4, float, 0, null);
            }
            gl.bind_buffer(glow::ARRAY_BUFFER, None);
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(self.wide_indices));
            for from in (0..vertices.len()).step_by(*length) {
                let place = FIRST_INDEX + size_of::<u32>() * from;
                gl.draw_elements(*primitive, *length as i32, glow::UNSIGNED_INT, place as i32);
            }
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, None);
            fixed.DisableClientState(raw::VERTEX_ARRAY);
        }
    }

    /// Fills one of the buffers, and leaves it bound.
    fn fill<'v>(&self, which: usize, numbers: impl Iterator<Item = &'v f32>) {
        let bytes: Vec<u8> = numbers.flat_map(|number| number.to_ne_bytes()).collect();
        // SAFETY: the context is current.
        unsafe {
            self.gl.bind_buffer(glow::ARRAY_BUFFER, Some(self.arrays[which]));
            self.gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, &bytes, glow::STREAM_DRAW);
        }
    }
}

impl FixedPlayer<'_> {
    /// Makes the current values those of a figure's last vertex, where its arrays leave them undefined.
    pub fn leave(&self, figure: &FixedFigure) {
        let (FixedFigure { given, way, .. }, Some(last)) = (figure, figure.vertices.last()) else { return };
        if *way == FixedWay::Immediate {
            return;
        }
        let fixed = self.binding();
        // SAFETY: the context is current; each call reads as many numbers as it takes.
        unsafe {
            if given.color {
                self.color(last.color);
            }
            if given.secondary {
                fixed.SecondaryColor3fv(last.secondary.as_ptr());
            }
            if given.normal {
                fixed.Normal3fv(last.normal.as_ptr());
            }
            if given.fog {
                fixed.FogCoordf(last.fog);
            }
            for unit in (0..FIXED_UNITS).filter(|unit| given.coordinates[*unit]) {
                self.coordinates(unit as u32, last.coordinates[unit]);
            }
        }
    }
}
