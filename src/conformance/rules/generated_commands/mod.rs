//! GL-X1: streams of random commands, and every image against a model of GL.
//!
//! The [generator](generate) proposes commands; the [model](state::State) allows those whose result GL defines, applies them, and says what
//! each number that is read may be. Nothing is set again between commands: what a driver forgets or mixes up shows in
//! what comes after.

mod answers;
mod apply;
mod blend;
mod copies;
mod draw;
mod generate;
mod image;
mod images;
mod look;
mod palette;
mod pixel;
mod pixels;
mod reading;
mod settings;
mod state;
mod transfer;

use crate::conformance::bench::Error;
use crate::conformance::bench::commands::{Command, Player, Sampled};
use crate::conformance::{DriverUnderTest, Findings};

use answers::{Fault, Judged};
use generate::Generator;
use pixel::Bounds;
use state::State;

/// Streams, and commands of each before all is read.
const STREAMS: u64 = 30;
const COMMANDS: usize = 220;

/// Streams in a finding.
const GROUP: u64 = 10;

/// A number that is wrong in a stream.
struct Broken {
    stream: u64,
    fault: Fault,
    /// The command after which an image is wrong first, when all are read after each command that writes.
    command: Option<String>,
}

/// Plays one command, and judges what it gives back.
fn step(
    player: &mut Player,
    state: &mut State,
    command: &Command,
    judged: &mut Judged,
) -> Result<Option<Fault>, Error> {
    let answer = player.play(command)?;
    state.apply(command);
    Ok(answer.and_then(|bytes| state.judge(command, &bytes, judged)))
}

/// Plays commands until one gives back what is wrong.
fn steps(
    player: &mut Player,
    state: &mut State,
    commands: &[Command],
    judged: &mut Judged,
) -> Result<Option<Fault>, Error> {
    for command in commands {
        if let Some(fault) = step(player, state, command, judged)? {
            return Ok(Some(fault));
        }
    }
    Ok(None)
}

/// Plays a stream, and reads all images at its end; or after each command that writes, to find the first that is wrong.
fn stream(
    player: &mut Player,
    number: u64,
    each: bool,
    judged: &mut Judged,
) -> Result<Option<(Fault, Option<Command>)>, Error> {
    let (mut state, mut generator) = (State::new(), Generator::new(number));
    let mut left = COMMANDS;
    while left > 0 {
        let Some(command) = generator.next(&state) else { break };
        left -= usize::from(generator.is_between());
        let mut fault = step(player, &mut state, &command, judged)?;
        if each && command.writes() && !state.is_counting {
            let all = reading::all(&state);
            fault = fault.or(steps(player, &mut state, &all, judged)?);
        }
        if let Some(fault) = fault {
            return Ok(Some((fault, Some(command))));
        }
    }
    let all = reading::opening(&state);
    let fault = steps(player, &mut state, &all, judged)?;
    let all = reading::all(&state);
    Ok(fault.or(steps(player, &mut state, &all, judged)?).map(|fault| (fault, None)))
}

/// Plays a stream; where something is wrong, plays it again to find the command.
fn judged(subject: &DriverUnderTest, number: u64, judged: &mut Judged) -> Result<Option<Broken>, Error> {
    let mut player = subject.bench.player()?;
    let Some((fault, _)) = stream(&mut player, number, false, judged)? else { return Ok(None) };
    drop(player);
    let again = stream(&mut subject.bench.player()?, number, true, &mut Judged::default())?;
    let command = again.and_then(|(_, command)| command).map(|command| command.in_short());
    Ok(Some(Broken { stream: number, fault, command }))
}

/// GL-X1: streams of random commands.
pub fn generated(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for group in 0..STREAMS / GROUP {
        let mut count = Judged::default();
        let mut broken = None;
        for number in group * GROUP..(group + 1) * GROUP {
            // One is enough: the next streams would find the same again.
            if broken.is_none() {
                broken = judged(subject, number, &mut count)?;
            }
        }
        let what = format!("streams {} to {}", group * GROUP, (group + 1) * GROUP - 1);
        let measured = match &broken {
            Some(Broken { stream, fault: Fault { what, expected: Bounds { low, high }, got }, command }) => {
                let after = command.as_ref().map_or("it is right if all is read after each command", String::as_str);
                format!("stream {stream}: {what}: {low} to {high} expected, {got} found; first wrong after: {after}")
            }
            None => format!("all {} numbers right, {} more are not defined", count.known, count.unknown),
        };
        findings.must_hold(what, broken.is_none() && count.known > count.unknown, measured);
    }
    Ok(())
}
