//! GL-X6: streams of random commands of the fixed-function pipeline, and every draw against a model of GL.
//!
//! The [maker](generate) makes commands and applies them to its [state](state::FixedState); nothing is set again between draws:
//! what a driver forgets or mixes up shows in what comes after.

mod apply;
mod changes;
mod draws;
mod environment;
mod fragment;
mod generate;
mod judge;
mod kept;
mod lighting;
mod start;
mod state;
mod textures;
mod vertex;

use super::fixed;
use crate::conformance::bench::fixed_commands::{FixedCommand as Command, FixedTexture};
use crate::conformance::bench::fixed_function::FixedBench;
use crate::conformance::bench::{Error, GlFormat, Surface};
use crate::conformance::random::Random;
use crate::conformance::{DriverUnderTest, Findings};

use draws::{CELL, CELLS};
use generate::{Decks, StreamMaker};
use judge::{Count, Wrong};

/// Streams, draws of each, and draws from one change of what a driver compiles programs for to the next.
const STREAMS: u64 = 8;
const DRAWS: usize = 30;
const EVERY: usize = 6;

/// Seed of the first stream; none of those that follow is skipped. Of the first two that were tried, the one whose streams show more
/// of the known faults.
const FIRST_SEED: u64 = 2000;

/// Streams in a finding.
const GROUP: u64 = 4;

/// Plays a stream; the first draw that is wrong.
fn stream(
    subject: &DriverUnderTest,
    fixed: &FixedBench,
    surface: &Surface,
    textures: &[FixedTexture],
    number: u64,
    (decks, count): (&mut Decks, &mut Count),
) -> Result<Option<(usize, Wrong, String)>, Error> {
    let mut player = fixed.player(&subject.bench, surface, textures)?;
    let mut maker = StreamMaker::new(FIRST_SEED + number, textures, fixed.most_units(), decks);
    maker.begin();
    let mut found = None;
    for draw in 0..DRAWS {
        maker.step(draw % EVERY == 0);
        let background = [0.25, 0.5, 0.75, 0.125];
        maker.push(Command::Clear(background));
        maker.refresh();
        player.play_all(&maker.made)?;
        maker.made.clear();
        let figure = maker.figure();
        let command = Command::Draw(figure.clone());
        player.play(&command)?;
        let wrong = maker.state.judge(&figure, textures, &surface.colors(), count);
        if let Some(wrong) = wrong {
            found = Some((draw, wrong, maker.state.in_words(&figure, textures)));
            break;
        }
        maker.push(command);
        maker.made.clear();
        player.leave(&figure);
    }
    while !maker.state.saved.is_empty() {
        maker.push(Command::PopAttrib);
    }
    player.play_all(&maker.made)?;
    player.play_all(&maker.unstacked())?;
    player.play_all(&start::starting())?;
    Ok(found)
}

/// GL-X6: streams of the fixed-function pipeline.
pub fn generated(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = fixed::pipeline(subject, findings, "the fixed-function pipeline") else { return Ok(()) };
    let size = [(CELLS[0] * CELL) as u32, (CELLS[1] * CELL) as u32];
    let surface = subject.bench.surface(size, Some(GlFormat::Rgba8), None)?;
    let textures = textures::textures(&mut Random::new(77));
    let mut decks = Decks::default();
    for group in 0..STREAMS / GROUP {
        let (mut count, mut broken) = (Count::default(), None);
        for number in group * GROUP..(group + 1) * GROUP {
            // One is enough: the next streams would find the same again.
            if broken.is_none() {
                let found = stream(subject, fixed, &surface, &textures, number, (&mut decks, &mut count))?;
                broken = found.map(|found| (number, found));
            }
        }
        let measured = match &broken {
            Some((number, (draw, wrong, words))) => format!("stream {number}, draw {draw}: {wrong}; {words}"),
            None => format!("all {} pixels right, {} more are not judged", count.judged, count.unsure),
        };
        let what = format!("streams {} to {}", group * GROUP, (group + 1) * GROUP - 1);
        findings.must_hold(what, broken.is_none() && count.judged > 4 * count.unsure, measured);
    }
    Ok(())
}
