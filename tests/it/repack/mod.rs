//! Skins packed again: each triangle keeps its picture, pieces keep apart, and tangent bases agree better across edges. The
//! pictures and places are judged by lookups and a rasteriser of their own.

mod command;
mod meshes;

use std::f64::consts::TAU;
use std::path::Path;

use glam::{DMat2, DVec2, DVec3, dvec2};
use glumbra::geometry::skin::{self, Raster, RepackOptions, Repacked, Skin};
use glumbra::geometry::tangents::{BasisFit, Tangents};
use glumbra::geometry::{Mesh, decode_obj};

use meshes::*;

#[test]
fn every_triangle_keeps_its_picture() {
    let mut random = fastrand::Rng::with_seed(11);
    let (mut points, mut worst) = (0, 0.0_f64);
    for round in 0..60 {
        let mesh = random_mesh(&mut random);
        let skin = Skin::of_mesh(&mesh, [SIDE; 2]).unwrap();
        let decal = smooth_decal(&mut random);
        let options = random_options(&mut random);
        let new = skin::repack(&skin, &options).unwrap();
        if new.flattened > 0 {
            continue;
        }
        let picture = new.resample(&skin, &decal).unwrap();
        let stretches = skin.texels().zip(new.skin.texels()).map(|(old, new)| stretch(&old, &new));
        // A texel of the rim may have the colour of one beside it: then the centre is off by half a diagonal and one diagonal
        // of the new picture; the old lookup is off by half a diagonal of the old one. Codes are rounded in both.
        let half = 0.5_f64.sqrt();
        let reach = stretches.fold(0.0, f64::max) * 3.0 * half + half;
        let bound = GRADIENT * reach + 1.0;
        for (old, new) in skin.texels().zip(new.skin.texels()) {
            for _ in 0..20 {
                let weights = random_weights(&mut random);
                let [before, after] = [lookup(&decal, at(&old, weights)), lookup(&picture, at(&new, weights))];
                for (before, after) in before.iter().zip(after) {
                    let error = f64::from(before.abs_diff(*after));
                    assert!(error <= bound, "round {round}: {before} became {after}, bound {bound:.1}, {options:?}");
                    worst = worst.max(error / bound);
                }
                points += 1;
            }
        }
    }
    println!("{points} points; the largest error is {worst:.2} of its bound");
    assert!(points > 10_000 && worst > 0.3, "a bound that is never near says little");
}

/// The triangle of each texel's centre, by the signs of three cross products. Errors: a centre in two triangles.
fn rasterise(new: &Repacked) -> Result<Vec<Option<usize>>, String> {
    let [width, height] = new.skin.size();
    let mut owners = vec![None; (width * height) as usize];
    for (number, corners) in new.skin.texels().enumerate() {
        let low = corners.iter().copied().fold(DVec2::INFINITY, DVec2::min).floor();
        let high = corners.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max).ceil();
        if low.min_element() < 0.0 || high.x > f64::from(width) || high.y > f64::from(height) {
            return Err(format!("triangle {number} reaches from {low} to {high}, beyond {width}x{height}"));
        }
        for (y, x) in (low.y as u32..high.y as u32).flat_map(|y| (low.x as u32..high.x as u32).map(move |x| (y, x))) {
            let centre = dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let side = |a: usize, b: usize| (corners[b] - corners[a]).perp_dot(centre - corners[a]);
            let sides = [side(0, 1), side(1, 2), side(2, 0)];
            // Strictly inside: a centre on an edge belongs to either side.
            if sides.iter().all(|side| *side > 1e-9) || sides.iter().all(|side| *side < -1e-9) {
                let owner = &mut owners[(y * width + x) as usize];
                match owner {
                    Some(other) => return Err(format!("triangles {other} and {number} share texel {x}, {y}")),
                    None => *owner = Some(number),
                }
            }
        }
    }
    Ok(owners)
}

#[test]
fn pieces_keep_apart_by_their_gutters() {
    let mut random = fastrand::Rng::with_seed(12);
    for round in 0..40 {
        let mesh = random_mesh(&mut random);
        let skin = Skin::of_mesh(&mesh, [SIDE; 2]).unwrap();
        let options = RepackOptions { steps: None, ..random_options(&mut random) };
        let new = skin::repack(&skin, &options).unwrap();
        let owners = rasterise(&new).unwrap_or_else(|error| panic!("round {round}: {error}, {options:?}"));
        let [width, height] = new.skin.size().map(i64::from);
        let piece = |x: i64, y: i64| owners[(y * width + x) as usize].map(|number| new.piece_of_triangle[number]);
        let gutter = i64::from(options.gutter);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let Some(own) = piece(x, y) else { continue };
            let margin = [x, y, width - 1 - x, height - 1 - y].into_iter().min().unwrap();
            assert!(margin >= gutter, "round {round}: texel {x}, {y} is {margin} from the rim, {options:?}");
            let columns = (x - 2 * gutter).max(0)..=(x + 2 * gutter).min(width - 1);
            for near in (y..=(y + 2 * gutter).min(height - 1)).flat_map(|y| columns.clone().map(move |x| [x, y])) {
                let other = piece(near[0], near[1]);
                assert!(other.is_none_or(|other| other == own), "round {round}: {x}, {y} and {near:?}, {options:?}");
            }
        }
    }
}

#[test]
fn the_mean_angle_never_grows_at_full_size() {
    let mut random = fastrand::Rng::with_seed(13);
    let mut fell = 0;
    for round in 0..60 {
        let mesh = random_mesh(&mut random);
        let skin = Skin::of_mesh(&mesh, [SIDE; 2]).unwrap();
        let options = RepackOptions { size: None, steps: None, ..random_options(&mut random) };
        let before = skin.discontinuity();
        let new = skin::repack(&skin, &options).unwrap();
        let (from, to) = (before.mean_degrees, new.discontinuity.mean_degrees);
        assert!(to <= from + 1e-4, "round {round}: {from} degrees became {to}, {options:?}");
        assert_eq!(before.pairs(), new.discontinuity.pairs());
        assert_eq!((new.scale, new.flattened), (1.0, 0));
        assert!((skin.density() - new.skin.density()).abs() <= 1e-9 * skin.density());
        fell += usize::from(to < 0.5 * from);
    }
    assert!(fell > 10, "{fell} of 60 fell by half");
}

/// The same for skins in whole texels that are rounded to them again, as of MD2 files.
#[test]
fn the_mean_angle_never_grows_in_whole_texels() {
    let mut random = fastrand::Rng::with_seed(19);
    let mut turned = 0;
    for round in 0..60 {
        let mesh = random_mesh(&mut random);
        let side = f64::from(SIDE);
        let texel = |[s, t]: &[f32; 2]| dvec2(f64::from(*s) * side, (1.0 - f64::from(*t)) * side).round();
        let skin = Skin::of_texels(&mesh, [SIDE; 2], mesh.texcoords.as_ref().unwrap().iter().map(texel));
        let steps = Some(random.u32(1..5));
        let new = skin::repack(&skin, &RepackOptions { steps, unmirror: random.bool(), ..OPTIONS }).unwrap();
        let (from, to) = (skin.discontinuity().mean_degrees, new.discontinuity.mean_degrees);
        assert!(to <= from + 1e-9, "round {round}: {from} degrees became {to}, {steps:?}");
        turned += usize::from(new.turned > 0);
    }
    assert!(turned > 10, "islands of {turned} of 60 were turned");
}

/// 4 x 3 islands of a cylinder, each turned by some angle: all t axes can agree, since a cylinder unrolls.
#[test]
fn a_cylinder_of_turned_islands_is_cured() {
    let mut random = fastrand::Rng::with_seed(14);
    for round in 0..20 {
        let blocks = Blocks { blocks: [4, 3], cells: [6, 2] };
        let mirrors = round % 2 == 1;
        // Cells that are square on the surface: 1.57 around to 0.67 upwards.
        let square = DMat2::from_diagonal(dvec2(1.0, 0.4244));
        let mesh = blocks.mesh(cylinder, |_| (any_turn(&mut random) * square, mirrors && random.bool()));
        let skin = Skin::of_mesh(&mesh, [SIDE; 2]).unwrap();
        let before = skin.discontinuity();
        let found = [None, Some(1), Some(8)].map(|steps| {
            let new = skin::repack(&skin, &RepackOptions { steps, unmirror: true, ..OPTIONS }).unwrap();
            assert_eq!((new.islands, new.pieces, new.skin.mirrored()), (12, 12, 0));
            (new.discontinuity.mean_degrees, new.discontinuity.largest_degrees)
        });
        println!(
            "{round}: mean {:.2}, then mean and largest {found:.4?} exact, in whole texels, in eighths",
            before.mean_degrees
        );
        assert!(before.mean_degrees > 8.0);
        // f32 texture coordinates are off by 2e-5 texels, edges are 4 texels long or more. A quarter turn that is worse by
        // 0.05 degrees in the mean is taken.
        assert!(found[0].0 < 0.06, "{found:?}");
        // Corners are off by half a diagonal of a texel, over edges of some 5 texels: a few degrees.
        assert!(found[1].0 < 6.0 && found[2].0 < 0.8, "{found:?}");
    }
}

/// A cylinder of single triangles, each alone on the skin and turned by some angle: all t axes can agree.
#[test]
fn single_triangles_of_a_cylinder_are_cured() {
    let mut random = fastrand::Rng::with_seed(15);
    let mesh =
        Blocks { blocks: [8, 4], cells: [1, 1] }.mesh(cylinder, |_| (DMat2::from_diagonal(dvec2(1.0, 0.64)), false));
    // Every triangle has corners of its own.
    let mut torn = Mesh { texcoords: Some(Vec::new()), ..Mesh::default() };
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let turn = any_turn(&mut random);
        for index in triangle {
            torn.indices.push(torn.positions.len() as u32);
            torn.positions.push(mesh.positions[*index as usize]);
            torn.normals.push(mesh.normals[*index as usize]);
            let texel = DVec2::from_array(mesh.texcoords.as_ref().unwrap()[*index as usize].map(f64::from));
            torn.texcoords.as_mut().unwrap().push((turn * texel).as_vec2().to_array());
        }
    }
    let skin = Skin::of_mesh(&torn, [SIDE; 2]).unwrap();
    let new = skin::repack(&skin, &OPTIONS).unwrap();
    let (before, after) = (skin.discontinuity().mean_degrees, new.discontinuity.mean_degrees);
    println!("{} islands: {before:.2} degrees became {after:.4}", new.islands);
    assert_eq!(new.islands, 64);
    assert!(before > 60.0 && after < 0.06);
}

/// Two triangles of a square, the second's skin turned and perhaps mirrored: the angle is the turn. Light vectors in tangent
/// space, from the bases of the renderer's code, jump by up to that; by 180 degrees if one is mirrored.
#[test]
fn the_angle_is_the_worst_jump_of_a_light_vector() {
    let mut random = fastrand::Rng::with_seed(16);
    for _ in 0..200 {
        let angle = TAU * random.f64();
        let is_mirrored = random.bool();
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let corners = [0, 1, 2, 0, 2, 3];
        let normal = DVec3::Z.as_vec3().to_array();
        let texcoord = |number: usize| {
            let at = DVec2::from_array(square[corners[number]]);
            match number < 3 {
                true => at,
                // Mirrored across its own t axis, which is then turned.
                false if is_mirrored => DMat2::from_angle(angle) * (dvec2(-1.0, 1.0) * at),
                false => DMat2::from_angle(angle) * at,
            }
        };
        let mesh = Mesh {
            positions: corners
                .iter()
                .map(|corner| [square[*corner][0] as f32, square[*corner][1] as f32, 0.0])
                .collect(),
            normals: vec![normal; 6],
            texcoords: Some((0..6).map(|number| texcoord(number).as_vec2().to_array()).collect()),
            indices: (0..6).collect(),
            ..Mesh::default()
        };
        let found = Skin::of_mesh(&mesh, [SIDE; 2]).unwrap().discontinuity();
        let apart = angle.min(TAU - angle).to_degrees();
        assert!((found.largest_degrees - apart).abs() < 1e-3, "{} for {apart}", found.largest_degrees);
        assert_eq!((found.pairs(), found.mirrored_pairs, found.without), (1, usize::from(is_mirrored), 0));
        let tangents = Tangents::of_skin(&mesh, BasisFit::Orthogonal).unwrap();
        let jump = |light: DVec3| {
            let [first, second] = [0, 3].map(|corner: usize| tangents.corners[corner].tangent_from_model(light));
            first.angle_between(second).to_degrees()
        };
        let lights = (0..720).map(|step| DVec2::from_angle(TAU * f64::from(step) / 720.0).extend(0.3 * random.f64()));
        let flat = (0..720).map(|step| DVec2::from_angle(TAU * f64::from(step) / 720.0).extend(0.0));
        let worst = lights.chain(flat).map(jump).fold(0.0, f64::max);
        let expected = if is_mirrored { 180.0 } else { apart };
        assert!((worst - expected).abs() < 0.6, "{worst} for {expected}");
    }
}

/// A strip whose skin runs around a corner: both parts are one island, whose t axes jump where the skin is bent.
#[test]
fn a_bent_island_is_cut_where_its_axes_jump() {
    let columns = 8;
    let mut mesh = Mesh { texcoords: Some(Vec::new()), ..Mesh::default() };
    for column in 0..=columns {
        for row in 0..2 {
            let (along, across) = (column as f64 / columns as f64, f64::from(row));
            mesh.positions.push([along as f32 * 8.0, across as f32, 0.0]);
            mesh.normals.push([0.0, 0.0, 1.0]);
            // Along s up to the middle, then along t, with a mitre between.
            let inner = 0.5 - 0.1 * across;
            let texcoord = match column {
                0..=4 => dvec2(along.min(0.5) + if column == 4 { -0.1 * across } else { 0.0 }, 0.1 + 0.1 * across),
                _ => dvec2(inner, 0.1 + along - 0.5),
            };
            mesh.texcoords.as_mut().unwrap().push(texcoord.as_vec2().to_array());
        }
    }
    for column in 0..columns as u32 {
        let [a, b, c, d] = [0, 2, 3, 1].map(|corner| 2 * column + corner);
        mesh.indices.extend([a, b, c, a, c, d]);
    }
    let skin = Skin::of_mesh(&mesh, [SIDE; 2]).unwrap();
    let cut = |cut_degrees: f64| skin::repack(&skin, &RepackOptions { cut_degrees, ..OPTIONS }).unwrap();
    let [whole, parts] = [180.0, 30.0].map(cut);
    assert_eq!(whole.islands, 1);
    assert_eq!(whole.discontinuity.mean_degrees, skin.discontinuity().mean_degrees);
    assert!(skin.discontinuity().largest_degrees > 60.0);
    assert!(parts.islands >= 2, "{}", parts.islands);
    println!("{} degrees in the mean became {}", whole.discontinuity.mean_degrees, parts.discontinuity.mean_degrees);
    assert!(parts.discontinuity.mean_degrees < 0.5 * whole.discontinuity.mean_degrees);
    rasterise(&parts).unwrap();
}

/// Halves that share their texels, one mirrored: they stay together, or part.
#[test]
fn mirrored_halves_share_texels_or_have_their_own() {
    let mut mesh = Blocks { blocks: [2, 1], cells: [3, 2] }.mesh(sheet, |_| (DMat2::IDENTITY, false));
    let texcoords = mesh.texcoords.as_mut().unwrap();
    let half = texcoords.len() / 2;
    for row in 0..3 {
        for column in 0..4 {
            texcoords[half + 4 * row + column] = texcoords[4 * row + 3 - column];
        }
    }
    let skin = Skin::of_mesh(&mesh, [SIDE; 2]).unwrap();
    assert_eq!((skin.mirrored(), skin.discontinuity().mirrored_pairs), (12, 2));
    let [together, apart] =
        [false, true].map(|unmirror| skin::repack(&skin, &RepackOptions { unmirror, ..OPTIONS }).unwrap());
    assert_eq!((together.islands, together.pieces, together.skin.mirrored()), (2, 1, 12));
    let texels: Vec<[DVec2; 3]> = together.skin.texels().collect();
    assert!(texels[..12].iter().flatten().all(|texel| texels[12..].iter().flatten().any(|other| other == texel)));
    assert!(rasterise(&together).is_err(), "they overlap");
    assert_eq!((apart.islands, apart.pieces, apart.skin.mirrored()), (2, 2, 0));
    assert_eq!(apart.discontinuity.mirrored_pairs, 0);
    rasterise(&apart).unwrap();
}

/// Skins that make no sense: no area, one point, all triangles on each other, places far outside. None panics.
#[test]
fn degenerate_skins_are_packed() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let skins = [
        "vt 0.5 0.5\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n",
        "vt 0 0\nvt 1 1\nf 1/1 2/2 3/2\nf 1/1 3/2 4/1\n",
        "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/2 4/3\nf 1/2 2/1 4/3\nf 1/1 1/2 1/3\n",
        "vt -3 7\nvt 4 7\nvt 4 9\nf 1/1 2/2 3/3\nf 1/3 3/2 4/1\n",
    ];
    let picture = Raster { size: [32, 16], channels: 1, is_deep: false, samples: vec![77; 512] };
    for text in skins {
        for (unmirror, steps) in [(false, None), (true, None), (false, Some(1)), (true, Some(3))] {
            let (mesh, _) = decode_obj(Path::new("square.obj"), format!("{square}{text}").as_bytes()).unwrap();
            let skin = Skin::of_mesh(&mesh, picture.size).unwrap();
            let new = skin::repack(&skin, &RepackOptions { unmirror, steps, ..OPTIONS }).unwrap();
            let map = new.resample(&skin, &picture).unwrap();
            assert!(map.samples.iter().all(|code| *code == 77), "{text}");
            assert!(new.skin.texels().flatten().all(|texel| texel.is_finite() && texel.min_element() >= 2.0));
        }
    }
}
