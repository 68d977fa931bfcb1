//! Growth with the size of a scene: `ci/bench --scale`. Time of a frame, planning, start-up and memory over ladders of sizes,
//! beside the floor in the same round; the exponent of each curve. `tests/it/growth.rs` holds the exponents of counted work.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::child::median;
use super::model_files::Format;
use super::scale_child::ScaleSample;
use super::scale_scene::Point;
use super::{Arguments, Result, Who, pictures, scale_plot};

/// Something of a scene that grows.
struct Ladder {
    name: &'static str,
    /// The things that `sizes` count.
    unit: &'static str,
    sizes: &'static [usize],
    /// The shorter ladder of `--quick`.
    quick: &'static [usize],
    point: fn(usize) -> Point,
}

/// Ladders of files in other formats than OBJ.
const FILES: Ladder = Ladder {
    name: "",
    unit: "triangles of one file (floor: an OBJ file)",
    sizes: &[100_000, 300_000, 1_000_000, 3_000_000, 10_000_000],
    quick: &[3_000, 10_000, 30_000, 100_000],
    point: |size| of_file(size, Format::Obj),
};

fn of_file(triangles: usize, format: Format) -> Point {
    Point { triangles, objects: 1, format, ..Point::default() }
}

/// From 256 volumes on planning looks for counts that eight bits cannot hold: their exponents are those above that step.
const LADDERS: [Ladder; 11] = [
    Ladder {
        name: "triangles",
        unit: "triangles of one object",
        sizes: &[10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000],
        quick: &[3_000, 10_000, 30_000, 100_000],
        point: |size| Point { triangles: size, objects: 1, ..Point::default() },
    },
    Ladder {
        name: "objects",
        unit: "instances",
        sizes: &[100, 300, 1_000, 3_000, 10_000, 30_000, 100_000],
        quick: &[30, 100, 300, 1_000],
        point: |size| Point { objects: size, triangles: 48, ..Point::default() },
    },
    Ladder { point: |size| of_file(size, Format::Glb), name: "glTF triangles", ..FILES },
    Ladder { point: |size| of_file(size, Format::Ply), name: "PLY triangles", ..FILES },
    Ladder { point: |size| of_file(size, Format::Stl), name: "STL triangles", ..FILES },
    Ladder {
        name: "nodes",
        unit: "nodes of a glTF file",
        sizes: &[1_000, 3_000, 10_000, 30_000, 100_000],
        quick: &[100, 300, 1_000],
        point: |size| Point { objects: size, triangles: 48, format: Format::Nodes, ..Point::default() },
    },
    Ladder {
        name: "lights",
        unit: "lights with a map (floor: one map, drawn for each)",
        sizes: &[1, 2, 4, 8, 16, 32, 64],
        quick: &[1, 2, 4, 8],
        point: |size| Point { lights: size, map: 512, ..Point::default() },
    },
    Ladder {
        name: "map",
        unit: "texels",
        sizes: &[256 << 8, 512 << 9, 1024 << 10, 2048 << 11, 4096 << 12, 8192 << 13, 16384 << 14],
        quick: &[256 << 8, 512 << 9, 1024 << 10, 2048 << 11],
        point: |size| Point { map: size.isqrt(), ..Point::default() },
    },
    Ladder {
        name: "picture",
        unit: "pixels",
        sizes: &[256 << 8, 512 << 9, 1024 << 10, 2048 << 11, 4096 << 12],
        quick: &[256 << 8, 512 << 9, 1024 << 10],
        point: |size| Point { picture: size.isqrt(), ..Point::default() },
    },
    Ladder {
        name: "casters of volumes",
        unit: "volumes (floor: casters in a map)",
        sizes: &[100, 300, 1_000, 3_000, 10_000],
        quick: &[100, 300, 1_000, 3_000],
        point: |size| Point { objects: size, triangles: 48, volumes: true, ..Point::default() },
    },
    Ladder {
        name: "nesting",
        unit: "volumes in one another (floor: casters in a map)",
        sizes: &[1, 4, 16, 64, 256, 512, 1024],
        quick: &[1, 4, 16, 64],
        point: |size| Point { objects: size, triangles: 200, nested: true, volumes: true, ..Point::default() },
    },
];

/// Greatest exponent of what grows as the scene does: linear, and a tenth for the fit.
const MOST: f64 = 1.1;

/// Rounds, where no fewer are asked for: a ladder's last scenes take seconds.
const MOST_ROUNDS: usize = 3;

/// A measured quantity.
pub struct Quantity {
    pub name: &'static str,
    pub unit: &'static str,
    of: fn(&ScaleSample) -> f64,
    /// True if the floor has it.
    has_floor: bool,
}

pub const QUANTITIES: [Quantity; 4] = [
    Quantity { name: "frame", unit: "ms", of: |sample| sample.frame_ms, has_floor: true },
    Quantity { name: "planning", unit: "ms", of: |sample| sample.plan_ms, has_floor: false },
    Quantity { name: "start-up", unit: "ms", of: |sample| sample.start_ms, has_floor: true },
    Quantity { name: "memory", unit: "MiB", of: |sample| sample.peak_kib as f64 / 1024.0, has_floor: true },
];

/// Curves of one quantity over a ladder, a value for each size.
pub struct Curves {
    /// `None`: the floor does not have it.
    pub floor: Option<Vec<f64>>,
    pub glumbra: Vec<f64>,
    /// Medians of the ratios of one round.
    ratios: Vec<f64>,
}

/// Measurements over a ladder.
pub struct Measured {
    pub name: &'static str,
    pub unit: &'static str,
    pub sizes: Vec<usize>,
    /// One for each of [`QUANTITIES`].
    pub curves: Vec<Curves>,
}

/// Measures all ladders, or those whose names contain `--only`; prints tables, and plots with `-o`.
pub fn run(arguments: &Arguments) -> Result<()> {
    let folder = tempfile::tempdir()?;
    let wanted = |ladder: &&Ladder| arguments.only.as_ref().is_none_or(|only| ladder.name.contains(only.as_str()));
    let mut all = Vec::new();
    for ladder in LADDERS.iter().filter(wanted) {
        let measured = measure(ladder, folder.path(), arguments)?;
        print(&measured);
        all.push(measured);
    }
    if all.is_empty() {
        let names: Vec<&str> = LADDERS.iter().map(|ladder| ladder.name).collect();
        return Err(format!("no ladder has that in its name; there are {}", names.join(", ")).into());
    }
    match &arguments.output {
        Some(path) => scale_plot::write(&all, path),
        None => Ok(()),
    }
}

fn measure(ladder: &Ladder, folder: &Path, arguments: &Arguments) -> Result<Measured> {
    let rounds = if arguments.quick { 1 } else { arguments.rounds.clamp(1, MOST_ROUNDS) };
    let sizes = if arguments.quick { ladder.quick } else { ladder.sizes };
    let mut rows: Vec<Vec<[ScaleSample; 2]>> = Vec::new();
    for size in sizes {
        let point = (ladder.point)(*size);
        point.write(folder)?;
        let mut samples = Vec::new();
        for round in 0..rounds {
            eprintln!("{}: {size}, round {} of {rounds}", ladder.name, round + 1);
            samples.push(both(folder, round % 2 == 1)?);
        }
        // More lights than the floor's one, and volumes, are other pictures.
        if point.lights == 1 && !point.volumes {
            let difference = pictures::compare(&picture(folder, Who::Floor), &picture(folder, Who::Glumbra))?;
            difference.check().map_err(|error| format!("{}, {size}: {error} ({difference})", ladder.name))?;
        }
        rows.push(samples);
    }
    let curves = QUANTITIES.iter().map(|quantity| curves(quantity, &rows)).collect();
    Ok(Measured { name: ladder.name, unit: ladder.unit, sizes: sizes.to_vec(), curves })
}

fn curves(quantity: &Quantity, rows: &[Vec<[ScaleSample; 2]>]) -> Curves {
    let medians = |of: &dyn Fn(&[ScaleSample; 2]) -> f64| -> Vec<f64> {
        rows.iter().map(|samples| median(&mut samples.iter().map(of).collect::<Vec<_>>())).collect()
    };
    Curves {
        floor: quantity.has_floor.then(|| medians(&|pair| (quantity.of)(&pair[0]))),
        glumbra: medians(&|pair| (quantity.of)(&pair[1])),
        ratios: medians(&|pair| (quantity.of)(&pair[1]) / (quantity.of)(&pair[0])),
    }
}

/// The floor's process and glumbra's, one after the other.
fn both(folder: &Path, reversed: bool) -> Result<[ScaleSample; 2]> {
    if reversed {
        let glumbra = child(folder, Who::Glumbra)?;
        return Ok([child(folder, Who::Floor)?, glumbra]);
    }
    Ok([child(folder, Who::Floor)?, child(folder, Who::Glumbra)?])
}

fn child(folder: &Path, who: Who) -> Result<ScaleSample> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["--child", if who == Who::Glumbra { "glumbra" } else { "floor" }]);
    command.arg("--scale-scene").arg(folder).arg("-o").arg(picture(folder, who));
    let output = command.stderr(Stdio::inherit()).output()?;
    if !output.status.success() {
        return Err(format!("{who:?}: {}", output.status).into());
    }
    Ok(serde_json::from_slice(&output.stdout)?)
}

fn picture(folder: &Path, who: Who) -> PathBuf {
    folder.join(format!("{who:?}.png"))
}

/// Exponent of `value ∝ size^k` by least squares on logarithms, over the upper three sizes.
pub fn exponent(sizes: &[usize], values: &[f64]) -> f64 {
    let from = sizes.len().saturating_sub(3);
    let points = sizes[from..].iter().zip(&values[from..]);
    let points: Vec<[f64; 2]> = points.map(|(size, value)| [(*size as f64).ln(), value.ln()]).collect();
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let products = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum::<f64>();
    products / points.iter().map(|point| (point[0] - x).powi(2)).sum::<f64>()
}

/// Prints the table of a ladder as Markdown, with the exponents in its last row.
fn print(measured: &Measured) {
    let mut head = vec![measured.unit.to_owned()];
    for (quantity, curves) in QUANTITIES.iter().zip(&measured.curves) {
        let Quantity { name, unit, .. } = quantity;
        match curves.floor {
            Some(_) => head.extend([format!("{name}: floor, {unit}"), "glumbra".to_owned(), "ratio".to_owned()]),
            None => head.push(format!("{name}, {unit}")),
        }
    }
    println!("\n| {} |\n|{}", head.join(" | "), "---|".repeat(head.len()));
    for (index, size) in measured.sizes.iter().enumerate() {
        let mut cells = vec![size.to_string()];
        for curves in &measured.curves {
            cells.extend(curves.floor.iter().map(|values| format!("{:.1}", values[index])));
            cells.push(format!("{:.1}", curves.glumbra[index]));
            cells.extend(curves.floor.iter().map(|_| format!("{:.2}", curves.ratios[index])));
        }
        println!("| {} |", cells.join(" | "));
    }
    let mut cells = vec![String::from("exponent")];
    let mut steep = Vec::new();
    for (quantity, curves) in QUANTITIES.iter().zip(&measured.curves) {
        let of = |values: &Vec<f64>| exponent(&measured.sizes, values);
        cells.extend(curves.floor.iter().map(|values| format!("{:.2}", of(values))));
        let own = of(&curves.glumbra);
        cells.push(format!("{own:.2}"));
        cells.extend(curves.floor.iter().map(|_| String::new()));
        if own > MOST {
            steep.push(format!("{} grows with an exponent of {own:.2}, above {MOST}", quantity.name));
        }
    }
    println!("| {} |", cells.join(" | "));
    println!("{}: {}", measured.name, if steep.is_empty() { String::from("linear or less") } else { steep.join("; ") });
}
