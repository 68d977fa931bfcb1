//! Bump mapping against its floor, in one pass and in three, and both against each other, beside the claim of the talk [GDC,
//! "Same Math in a Single Pass on GeForce3"]: `ci/bench --bumps`. The shadow map is redrawn in every frame.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use super::child::{Sample, median, processor_ms};
use super::floor_bumps::BumpFloor;
use super::table::{Row, print};
use super::{Arguments, Result, pictures};

/// Passes of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Passes {
    One,
    Three,
}

impl Passes {
    fn name(self) -> &'static str {
        if self == Self::One { "one" } else { "three" }
    }

    fn set(self) -> String {
        format!("shading.bump={}-pass", self.name())
    }
}

/// Greatest ratio of processor time to the floor's.
const WANTED: f64 = 0.8;

/// Pixels a clock of the talk's GeForce3: 400 million a second in one pass, 133 in three.
const TALK: f64 = 400.0 / 133.0;

fn scene_file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes/bench_bumps.toml")
}

/// Draws by the floor in this process, and prints a [`Sample`].
pub fn floor(passes: Passes, arguments: &Arguments) -> Result<()> {
    let scene = glumbra::load(&scene_file(), &[passes.set()])?.scene;
    let mut floor = BumpFloor::new(&scene, passes)?;
    let (mut cpu, mut times) = (processor_ms(), Vec::new());
    for frame in 0..arguments.frames {
        let start = Instant::now();
        floor.frame();
        times.push(start.elapsed().as_secs_f64() * 1e3);
        if frame == 0 {
            cpu = processor_ms();
        }
    }
    let cpu_ms = (processor_ms() - cpu) / (arguments.frames - 1).max(1) as f64;
    if let Some(path) = &arguments.output {
        floor.write_png(path)?;
    }
    let sample = Sample { frame_ms: median(&mut times), cpu_ms, ..Sample::default() };
    println!("{}", serde_json::to_string(&sample)?);
    Ok(())
}

/// Compares pictures, then measures.
pub fn run(arguments: &Arguments) -> Result<()> {
    let (rounds, frames) = if arguments.quick { (3, 10) } else { (arguments.rounds.max(1), 60) };
    let folder = tempfile::tempdir()?;
    for passes in [Passes::One, Passes::Three] {
        let [floor, own] = ["floor", "glumbra"].map(|who| folder.path().join(format!("{who}.png")));
        child("floor", passes, 1, Some(&floor))?;
        child("glumbra", passes, 1, Some(&own))?;
        let difference = pictures::compare(&floor, &own)?;
        println!("{} pass: {difference}", passes.name());
        difference.check()?;
    }
    let row = |name, expected| Row { name, unit: "ms", expected, pairs: Vec::new() };
    let mut rows = [row("one pass, processor time", Some(WANTED)), row("three passes, processor time", Some(WANTED))];
    let mut against = [row("glumbra: three passes against one", None), row("floor: three passes against one", None)];
    for round in 0..rounds {
        eprintln!("round {} of {rounds}", round + 1);
        let mut of = [[0.0; 2]; 2];
        for (index, passes) in [Passes::One, Passes::Three].into_iter().enumerate() {
            of[index] = [child("floor", passes, frames, None)?.cpu_ms, child("glumbra", passes, frames, None)?.cpu_ms];
            rows[index].pairs.push((of[index][0], of[index][1]));
        }
        against[0].pairs.push((of[0][1], of[1][1]));
        against[1].pairs.push((of[0][0], of[1][0]));
    }
    println!("\n{rounds} rounds of {frames} frames a process, map redrawn; base: the floor, or one pass");
    print(&rows);
    println!();
    print(&against);
    println!("The talk: {TALK:.2}, of pixels without vertices, maps and read-back.");
    Ok(())
}

fn child(who: &str, passes: Passes, frames: usize, picture: Option<&Path>) -> Result<Sample> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["--child", who, "--frames", &frames.to_string()]).arg("--file").arg(scene_file());
    match who {
        "floor" => command.args(["--bumps-floor", passes.name()]),
        _ => command.args(["--set", &passes.set()]),
    };
    if let Some(path) = picture {
        command.arg("-o").arg(path);
    }
    let output = command.stderr(Stdio::inherit()).output()?;
    if !output.status.success() {
        return Err(format!("{who}: {}", output.status).into());
    }
    Ok(serde_json::from_slice(&output.stdout)?)
}
