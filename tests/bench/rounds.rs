//! Starts the processes in turn and gathers what they say, after the pictures have been found to be the same.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use super::child::{Sample, model_file, scene_file};
use super::table::{Row, print};
use super::{Arguments, Redraw, Result, Scene, Who, pictures};

/// Measurements of one round.
#[derive(Clone, Debug, Default)]
struct Round {
    floor: Sample,
    floor_once: Sample,
    tuned: Sample,
    glumbra: Sample,
    glumbra_once: Sample,
    /// One frame and a PNG: start of the process to its end, in milliseconds.
    floor_start: f64,
    glumbra_start: f64,
    first_pixel: f64,
    floor_start_kib: u64,
    glumbra_start_kib: u64,
}

/// Processes a round.
const STEPS: usize = 9;

/// The ratios that the issue expects at most.
struct Expected;

impl Expected {
    const REDRAWN: f64 = 0.65;
    const ONCE: f64 = 0.45;
    const START: f64 = 1.2;
    const MEMORY: f64 = 1.2;
}

/// Measures each scene and prints its table.
pub fn run(arguments: &Arguments) -> Result<()> {
    let rounds = if arguments.quick { 3 } else { arguments.rounds.max(1) };
    for_each_scene(arguments, |bench| bench.run(rounds))
}

/// Runs `measure` on each scene, whose file lies in a folder that is removed afterwards.
pub fn for_each_scene(arguments: &Arguments, measure: impl Fn(&Bench) -> Result<()>) -> Result<()> {
    let folder = std::env::temp_dir().join(format!("glumbra-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let scenes = arguments.scene.map_or(vec![Scene::S1, Scene::S2], |scene| vec![scene]);
    let result = scenes.into_iter().try_for_each(|scene| {
        let bench = Bench {
            scene,
            quick: arguments.quick,
            folder: folder.clone(),
            model: model_file(arguments).canonicalize()?,
        };
        bench.write_scene()?;
        measure(&bench)
    });
    std::fs::remove_dir_all(&folder)?;
    result
}

pub struct Bench {
    pub scene: Scene,
    pub quick: bool,
    pub folder: PathBuf,
    pub model: PathBuf,
}

impl Bench {
    fn run(&self, rounds: usize) -> Result<()> {
        // The first run of each also fills Mesa's shader cache.
        self.start(Who::Floor)?;
        self.start(Who::Glumbra)?;
        let difference = pictures::compare(&self.picture(Who::Floor), &self.picture(Who::Glumbra))?;
        println!("\n{:?}: {rounds} rounds of {} frames a process; {difference}", self.scene, self.frames());
        difference.check()?;
        let mut measured = Vec::new();
        for round in 0..rounds {
            eprintln!("{:?}: round {} of {rounds}", self.scene, round + 1);
            measured.push(self.round(round % 2 == 1)?);
        }
        print(&rows(&measured));
        Ok(())
    }

    fn round(&self, reversed: bool) -> Result<Round> {
        let mut round = Round::default();
        for step in 0..STEPS {
            self.step(if reversed { STEPS - 1 - step } else { step }, &mut round)?;
        }
        Ok(round)
    }

    /// One process of a round; those that are compared stand side by side.
    fn step(&self, step: usize, round: &mut Round) -> Result<()> {
        match step {
            0 => round.floor = self.frames_of(Who::Floor, Redraw::Always, &[])?,
            1 => round.glumbra = self.frames_of(Who::Glumbra, Redraw::Always, &[])?,
            2 => round.tuned = self.frames_of(Who::Tuned, Redraw::Always, &[])?,
            3 => round.glumbra_once = self.frames_of(Who::Glumbra, Redraw::Once, &[])?,
            4 => round.floor_once = self.frames_of(Who::Floor, Redraw::Once, &[])?,
            5 => (round.floor_start, round.floor_start_kib) = self.start(Who::Floor)?,
            6 => round.glumbra_start = self.start_of_command()?,
            7 => round.glumbra_start_kib = self.start(Who::Glumbra)?.1,
            _ => round.first_pixel = timed(self.child(Who::Clear)?)?.0,
        }
        Ok(())
    }

    fn frames(&self) -> usize {
        match (self.scene, self.quick) {
            (Scene::S1, false) => 60,
            (Scene::S2, false) => 5,
            (Scene::S1, true) => 10,
            (Scene::S2, true) => 3,
        }
    }

    pub fn frames_of(&self, who: Who, redraw: Redraw, sets: &[&str]) -> Result<Sample> {
        self.frames_with(who, redraw, sets, &[])
    }

    /// With more of the child's arguments.
    pub fn frames_with(&self, who: Who, redraw: Redraw, sets: &[&str], more: &[&str]) -> Result<Sample> {
        let mut command = self.child(who)?;
        command.args(more);
        for set in sets {
            command.args(["--set", set]);
        }
        command.arg("--frames").arg(self.frames().to_string());
        command.arg("--redraw").arg(if redraw == Redraw::Always { "always" } else { "once" });
        sample(&timed(command)?.1)
    }

    /// One frame and a PNG by a child of this bench: milliseconds, and peak memory.
    fn start(&self, who: Who) -> Result<(f64, u64)> {
        self.start_with(who, &[], &[])
    }

    /// With more of the child's arguments.
    pub fn start_with(&self, who: Who, sets: &[&str], more: &[&str]) -> Result<(f64, u64)> {
        let mut command = self.child(who)?;
        command.args(more);
        for set in sets {
            command.args(["--set", set]);
        }
        command.arg("-o").arg(self.picture(who));
        let (ms, printed) = timed(command)?;
        Ok((ms, sample(&printed)?.peak_kib))
    }

    /// One frame and a PNG by the command, as a user types it.
    fn start_of_command(&self) -> Result<f64> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glumbra"));
        command.arg("render").arg(self.folder.join("scene.toml")).arg("-o").arg(self.folder.join("command.png"));
        Ok(timed(command)?.0)
    }

    fn child(&self, who: Who) -> Result<Command> {
        let mut command = Command::new(std::env::current_exe()?);
        let who = match who {
            Who::Floor => "floor",
            Who::Tuned => "tuned",
            Who::Glumbra => "glumbra",
            Who::Clear => "clear",
        };
        command.args(["--child", who, "--scene", if self.scene == Scene::S1 { "s1" } else { "s2" }]);
        command.arg("--model").arg(&self.model).arg("--file").arg(self.folder.join("scene.toml"));
        Ok(command)
    }

    /// The scene's file with the model's place in it.
    pub fn write_scene(&self) -> Result<()> {
        let text = std::fs::read_to_string(scene_file(self.scene))?;
        let model = format!("{:?}", self.model.to_str().ok_or("the model's path is no text")?);
        let text = text.replace("\"../meshes/dense.obj\"", &model);
        Ok(std::fs::write(self.folder.join("scene.toml"), text)?)
    }

    pub fn picture(&self, who: Who) -> PathBuf {
        self.folder.join(format!("{:?}-{who:?}.png", self.scene))
    }
}

/// The command's time from its start to its end, and what it printed.
fn timed(mut command: Command) -> Result<(f64, String)> {
    let start = Instant::now();
    let output = command.stderr(Stdio::inherit()).output()?;
    let ms = start.elapsed().as_secs_f64() * 1e3;
    if !output.status.success() {
        return Err(format!("{}: {}", Path::new(command.get_program()).display(), output.status).into());
    }
    Ok((ms, String::from_utf8(output.stdout)?))
}

fn sample(printed: &str) -> Result<Sample> {
    Ok(serde_json::from_str(printed)?)
}

fn rows(rounds: &[Round]) -> Vec<Row> {
    let row = |name, unit, expected, pair: &dyn Fn(&Round) -> (f64, f64)| Row {
        name,
        unit,
        expected,
        pairs: rounds.iter().map(pair).collect(),
    };
    let mib = |kib: u64| kib as f64 / 1024.0;
    vec![
        row("depth pass", "ms", None, &|r| (r.floor.depth_ms, r.glumbra.depth_ms)),
        row("lit pass", "ms", None, &|r| (r.floor.lit_ms, r.glumbra.lit_ms)),
        row("frame, map redrawn", "ms", Some(Expected::REDRAWN), &|r| (r.floor.frame_ms, r.glumbra.frame_ms)),
        row("frame, map redrawn, processor time", "ms", None, &|r| (r.floor.cpu_ms, r.glumbra.cpu_ms)),
        row("frame, map redrawn, hand-tuned floor", "ms", None, &|r| (r.floor.frame_ms, r.tuned.frame_ms)),
        row("the same, processor time", "ms", None, &|r| (r.floor.cpu_ms, r.tuned.cpu_ms)),
        row("frame, map drawn once (floor: redrawn)", "ms", Some(Expected::ONCE), &|r| {
            (r.floor.frame_ms, r.glumbra_once.frame_ms)
        }),
        row("frame, map drawn once by both", "ms", None, &|r| (r.floor_once.frame_ms, r.glumbra_once.frame_ms)),
        row("peak memory, many frames", "MiB", Some(Expected::MEMORY), &|r| {
            (mib(r.floor.peak_kib), mib(r.glumbra.peak_kib))
        }),
        row("peak memory, one frame to PNG", "MiB", Some(Expected::MEMORY), &|r| {
            (mib(r.floor_start_kib), mib(r.glumbra_start_kib))
        }),
        row("start to PNG", "ms", Some(Expected::START), &|r| (r.floor_start, r.glumbra_start)),
        row("glumbra's start to PNG : first cleared pixel", "ms", None, &|r| (r.first_pixel, r.glumbra_start)),
        row("floor's start to PNG : first cleared pixel", "ms", None, &|r| (r.first_pixel, r.floor_start)),
    ]
}
