//! A photograph of a plane, projected back onto the plane: a homography, whose corners are known in closed form.

use glam::{DMat3, DVec2};

use super::*;

/// Pixels a side of the picture, and of the photograph.
const SIZE: [u32; 2] = [240, 200];
const PHOTO: [u32; 2] = [360, 240];

/// Homogeneous pixels, (0, 0) at the lower left corner, from a point of the plane z = 0: (x, y, 1).
fn pixels_from_plane(pose: &Pose, size: [u32; 2]) -> DMat3 {
    let ahead = (pose.target - pose.eye).normalize();
    let right = ahead.cross(DVec3::Y).normalize();
    let up = right.cross(ahead);
    let [width, height] = size.map(f64::from);
    let focal = 0.5 * height / (0.5 * pose.fov_y.to_radians()).tan();
    // x = width/2 + focal (right·d)/(ahead·d), with d = p - eye.
    let rows = [focal * right + 0.5 * width * ahead, focal * up + 0.5 * height * ahead, ahead];
    let row = |way: DVec3| DVec3::new(way.x, way.y, -way.dot(pose.eye));
    DMat3::from_cols(row(rows[0]), row(rows[1]), row(rows[2])).transpose()
}

fn mapped(matrix: &DMat3, at: DVec2) -> DVec2 {
    let found = *matrix * at.extend(1.0);
    found.truncate() / found.z
}

/// Middle of the area of a convex polygon.
fn centroid(corners: &[DVec2]) -> DVec2 {
    let (mut area, mut sum) = (0.0, DVec2::ZERO);
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let cross = a.perp_dot(*b);
        area += cross;
        sum += cross * (*a + *b) / 3.0;
    }
    sum / area
}

#[test]
fn corners_of_a_photographed_plane_lie_where_the_homography_has_them() {
    let mut studio = Studio::new();
    // Four squares of twelve texels near the corners of the photograph, each in a colour of its own.
    let squares: [([u32; 2], [u8; 3]); 4] =
        [([60, 50], [255, 0, 0]), ([288, 50], [0, 255, 0]), ([60, 178], [0, 0, 255]), ([288, 178], [255, 255, 0])];
    let mut photo = RgbImage::new(PHOTO[0], PHOTO[1]);
    for (corner, color) in squares {
        for (x, y) in (0..12).flat_map(|y| (0..12).map(move |x| (x, y))) {
            // Rows of a file begin at the top.
            photo.put_pixel(corner[0] + x, PHOTO[1] - 1 - (corner[1] + y), Rgb(color));
        }
    }
    let path = studio.path("photo.png");
    photo.save(&path).unwrap();
    let mut random = Random::new(7);
    let mut worst = 0.0_f64;
    for number in 0..24 {
        let mut pose = |distance: f64| Pose {
            eye: DVec3::new(random.within(-2.5, 2.5), random.within(-1.5, 1.5), random.within(0.7, 1.0) * distance),
            target: random.vector() * DVec3::new(0.3, 0.3, 0.0),
            fov_y: random.within(34.0, 44.0),
        };
        let (from, elsewhere) = (pose(4.0), pose(5.5));
        let object = String::from(
            "mesh = \"quad\"\nlit = false\nrotate = { axis = [1, 0, 0], angle = 90.0 }\nscale = [9.0, 1.0, 9.0]\nmaterial = { ",
        );
        let more = "filter = \"linear\", hidden = \"grey\"";
        let scene = studio.load(&scene_text(SIZE, &elsewhere, &[object], &from.photo(&path, more)));
        let picture = studio.draw(&scene);
        let homography = pixels_from_plane(&elsewhere, SIZE) * pixels_from_plane(&from, PHOTO).inverse();
        for (corner, color) in squares {
            let at = corner.map(f64::from);
            let ends = [[0.0, 0.0], [12.0, 0.0], [12.0, 12.0], [0.0, 12.0]]
                .map(|[x, y]| mapped(&homography, DVec2::new(at[0] + x, at[1] + y)));
            let [width, height] = SIZE.map(f64::from);
            let is_inside = |at: &DVec2| at.cmpgt(DVec2::splat(2.0)).all() && at.x < width - 2.0 && at.y < height - 2.0;
            if !ends.iter().all(is_inside) {
                continue;
            }
            let expected = centroid(&ends);
            // Where the square shows: by the colour's share in each pixel. Grey and the other squares have none of it.
            let (mut weight, mut sum) = (0.0, DVec2::ZERO);
            for (index, pixel) in picture.iter().enumerate() {
                let at =
                    DVec2::new((index as u32 % SIZE[0]) as f64 + 0.5, height - (index as u32 / SIZE[0]) as f64 - 0.5);
                if at.distance(expected) > 40.0 || *pixel == GREY {
                    continue;
                }
                let is = |k: usize| if color[k] > 0 { f64::from(pixel[k]) } else { 255.0 - f64::from(pixel[k]) };
                let share = [0, 1, 2].map(is).into_iter().fold(255.0, f64::min) / 255.0;
                (weight, sum) = (weight + share, sum + share * at);
            }
            assert!(weight > 1.0, "view {number}: the square at {corner:?} is not to be seen near {expected}");
            let off = (sum / weight).distance(expected);
            worst = worst.max(off);
            assert!(off <= 0.5, "view {number}: the square at {corner:?} is {off} pixels from {expected}");
        }
    }
    println!("at worst {worst:.3} pixels");
}
