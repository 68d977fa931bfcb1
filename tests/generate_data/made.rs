//! The files themselves. No function is used whose last bit differs between platforms: sums, products, quotients and square
//! roots only.

mod facade;
mod knight;
mod knight_pose;
mod knight_skin;
mod noise;
mod slide;
mod statue;
mod tetrahedra;
mod textures;

use std::fmt::Write as _;

use glam::DVec3;

/// Writes every file below `folder`.
///
/// # Errors
///
/// A file that cannot be written.
pub fn write_all(folder: &std::path::Path) -> Result<(), Box<dyn std::error::Error>> {
    std::fs::create_dir_all(folder.join("meshes"))?;
    std::fs::create_dir_all(folder.join("textures"))?;
    let (positions, triangles) = statue::sculpt();
    std::fs::write(folder.join("meshes/dense.obj"), obj_text(&positions, &triangles))?;
    for (name, text) in facade::meshes() {
        std::fs::write(folder.join("meshes").join(name), text)?;
    }
    facade::bricks().save(folder.join("textures/bricks.png"))?;
    textures::checker().save(folder.join("textures/checker.png"))?;
    textures::floor().save(folder.join("textures/floor.png"))?;
    textures::spot().save(folder.join("textures/spot.png"))?;
    slide::slide().save(folder.join("textures/slide.png"))?;
    textures::studs().save(folder.join("textures/studs.png"))?;
    textures::barn_doors().save(folder.join("textures/barn-doors.png"))?;
    textures::head_light().save(folder.join("textures/head-light.png"))?;
    std::fs::write(folder.join("meshes/knight.md2"), glumbra::geometry::md2::write(&knight::knight()))?;
    let (colors, heights, gloss) = knight_skin::skins();
    colors.save(folder.join("textures/knight.png"))?;
    heights.save(folder.join("textures/knight-height.png"))?;
    gloss.save(folder.join("textures/knight-gloss.png"))?;
    Ok(())
}

/// The mesh as an OBJ file with six significant digits and without normals.
fn obj_text(positions: &[DVec3], triangles: &[[u32; 3]]) -> String {
    let mut text = String::with_capacity(32 * positions.len() + 24 * triangles.len());
    text.push_str(
        "# A seated cat on a plinth, made by generate_data. Closed; no normals, as scans have none.\no cat\n",
    );
    for position in positions {
        text.push('v');
        for value in position.to_array() {
            text.push(' ');
            push_number(&mut text, value);
        }
        text.push('\n');
    }
    for [a, b, c] in triangles {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    text
}

/// Appends `value`, of magnitude below 10, with six significant digits or seven decimals, whichever are fewer.
fn push_number(text: &mut String, value: f64) {
    let decimals = match value.abs() {
        1.0.. => 5,
        0.1.. => 6,
        _ => 7,
    };
    let mut digits = format!("{value:.decimals$}");
    if digits.contains('.') {
        digits.truncate(digits.trim_end_matches('0').trim_end_matches('.').len());
    }
    text.push_str(if digits == "-0" { "0" } else { &digits });
}
