//! A cube map of unit vectors: a lookup normalises [GDC, "Normalization Cube Map"].

use glam::DVec3;

/// Face axes of a cube map: outwards, then the ways of s and of t, in GL's order +x, -x, +y, -y, +z, -z
/// [GL 4.6, Table 8.19].
pub const FACES: [[DVec3; 3]; 6] = [
    [DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y],
    [DVec3::NEG_X, DVec3::Z, DVec3::NEG_Y],
    [DVec3::Y, DVec3::X, DVec3::Z],
    [DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z],
    [DVec3::Z, DVec3::X, DVec3::NEG_Y],
    [DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y],
];

/// Unit vectors through the middles of a face's texels, row by row from t = 0. `size`: texels a side.
pub fn face(index: usize, size: u32) -> impl ExactSizeIterator<Item = DVec3> {
    let [out, along_s, along_t] = FACES[index];
    let middle = move |at: u32| (2.0 * f64::from(at) + 1.0) / f64::from(size) - 1.0;
    (0..size * size)
        .map(move |texel| (out + middle(texel % size) * along_s + middle(texel / size) * along_t).normalize())
}

/// A face in bytes, x as round(255 (x / 2 + 1 / 2)); alpha is 255.
pub fn packed_face(index: usize, size: u32) -> Vec<[u8; 4]> {
    let code = |part: f64| (255.0 * (0.5 * part + 0.5)).round() as u8;
    face(index, size).map(|vector| [code(vector.x), code(vector.y), code(vector.z), 255]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The vector that a linear lookup within one face finds, unpacked.
    fn lookup(faces: &[Vec<[u8; 4]>], size: u32, vector: DVec3) -> DVec3 {
        let index = (0..6).max_by(|a, b| vector.dot(FACES[*a][0]).total_cmp(&vector.dot(FACES[*b][0]))).unwrap();
        let [out, along_s, along_t] = FACES[index];
        let place = |way: DVec3| (0.5 + 0.5 * vector.dot(way) / vector.dot(out)) * f64::from(size) - 0.5;
        let (s, t) = (place(along_s), place(along_t));
        let texel = |x: f64, y: f64| {
            let inside = |at: f64| at.clamp(0.0, f64::from(size - 1)) as usize;
            let [red, green, blue, _] = faces[index][inside(y) * size as usize + inside(x)];
            DVec3::from_array([red, green, blue].map(|code| 2.0 * f64::from(code) / 255.0 - 1.0))
        };
        let row = |y: f64| texel(s.floor(), y).lerp(texel(s.floor() + 1.0, y), s - s.floor());
        row(t.floor()).lerp(row(t.floor() + 1.0), t - t.floor())
    }

    /// Errors fall with the size, down to what eight bits hold: a third of a degree. Near an edge of the cube the last half
    /// texel of a face has no neighbour: the error is of first order.
    #[test]
    fn errors_fall_to_those_of_eight_bits() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut number = || 2.0 * random.f64() - 1.0;
        let mut vectors: Vec<DVec3> = (0..20_000).map(|_| DVec3::new(number(), number(), number())).collect();
        // Edges and corners of the cube.
        vectors.extend((0..5_000).map(|_| DVec3::new(1.0, 1.0, number())));
        vectors.extend(
            (0..8).map(|corner| DVec3::from_array([1, 2, 4].map(|bit| if corner & bit == 0 { 1.0 } else { -1.0 }))),
        );
        let worst = [16, 32, 64, 128, 256].map(|size| {
            let faces: Vec<_> = (0..6).map(|index| packed_face(index, size)).collect();
            let found = vectors.iter().map(|vector| (lookup(&faces, size, *vector), vector.normalize()));
            let (angle, length) = found.fold((0.0_f64, 0.0_f64), |(angle, length), (found, exact)| {
                (angle.max(found.angle_between(exact).to_degrees()), length.max((found.length() - 1.0).abs()))
            });
            (angle, length)
        });
        println!("{worst:.4?} degrees and length at 16, 32, 64, 128, 256");
        let angles = worst.map(|(angle, _)| angle);
        assert!(angles.windows(2).all(|pair| pair[1] < pair[0]), "{angles:?}");
        assert!(angles[0] < 2.2 && angles[1] < 1.2 && angles[2] < 0.75 && angles[4] < 0.45, "{angles:?}");
        assert!(worst.iter().all(|(_, length)| *length < 0.01));
    }

    #[test]
    fn faces_meet_at_their_edges() {
        // Each of a face's axes is at right angles to the others, and the six look outwards to all sides.
        for [out, along_s, along_t] in FACES {
            assert_eq!((out.dot(along_s), out.dot(along_t), along_s.dot(along_t)), (0.0, 0.0, 0.0));
            // Seen from outside s runs to the left where t runs upwards: faces are drawn to be seen from inside.
            assert_eq!(along_s.cross(along_t), -out);
        }
        assert_eq!(FACES.iter().map(|face| face[0]).sum::<DVec3>(), DVec3::ZERO);
        assert!(face(4, 1).eq([DVec3::Z]));
    }
}
