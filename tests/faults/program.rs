//! Tells which rules of `glumbra check` see each fault of `conformance::faults`, and which pictures it changes.
//!
//! `cargo run --release --example faults -- --help` says how to ask. 1: a fault changes a picture and no rule, or a program of
//! `--reduce` is wrong.

mod judge;
mod reduced;
mod shown;

use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use glumbra::conformance::TABLE;
use glumbra::conformance::faults::{self, Fault};
use judge::{END, MARKER, PAGE, Row, changed, each, red, rows, sound};

/// Tells which rules of `glumbra check` see each fault of drivers, and which pictures it changes: all take an hour and more.
#[derive(Parser)]
struct Arguments {
    /// Rules by their ids (GL-X7), and faults by a part of their names or of the functions that they break; all without
    #[arg(value_name = "RULE|NAME")]
    chosen: Vec<String>,
    /// Only faults that no rule sees by the table of ci/drivers.md
    #[arg(long)]
    holes: bool,
    /// Draws the scenes too
    #[arg(long)]
    pictures: bool,
    /// Puts the results of all rules into the table of ci/drivers.md
    #[arg(long)]
    write: bool,
    /// Runs no rules, but programs as `glumbra check --reduce` writes them, for each fault and each rule that sees it by the
    /// table, held against the broken driver and the sound one
    #[arg(long)]
    reduce: bool,
    /// Runs no rules, but draws the scenes in which faults of the tenth measure are shown, and tells the share of their pixels
    /// that each fault changes
    #[arg(long)]
    shown: bool,
}

/// The table's text, from all faults and what is known of them.
fn table(known: &[Row]) -> String {
    let mut text =
        String::from("| fault | a driver that has it | rules that fail | scenes that change |\n|---|---|---|---|\n");
    for fault in faults::all() {
        let row = known.iter().find(|row| row.fault == fault.name).cloned().unwrap_or_default();
        let red = match (row.red.is_empty(), fault.hole) {
            (false, _) => row.red.join(" "),
            (true, Some(reason)) => format!("none: {reason}"),
            (true, None) => String::from("none"),
        };
        let changed = row.changed.map_or(String::from("-"), |count| count.to_string());
        text += &format!("| {} | {} | {red} | {changed} |\n", fault.name, fault.says);
    }
    text
}

/// Prints the scenes of `shown` that each fault changes, and the share of their pixels.
fn tell_shares(faults: &[&'static Fault]) {
    let scenes = judge::sound_of(&shown::scenes());
    println!("{} faults, {} scenes", faults.len(), scenes.len());
    each(faults, |fault| {
        let mut shares = judge::shares(fault, &scenes);
        shares.sort_by(|a, b| b.1.total_cmp(&a.1));
        let shares: Vec<_> = shares.iter().map(|(name, share)| format!("{name} {:.2} %", 100.0 * share)).collect();
        println!("{}: {}", fault.name, shares.join(", "));
    });
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let (ids, names): (Vec<_>, Vec<_>) = arguments.chosen.iter().cloned().partition(|name| name.starts_with("GL-"));
    if arguments.write && !ids.is_empty() {
        eprintln!("--write: the table has the results of all rules; leave {} out", ids.join(" "));
        return ExitCode::FAILURE;
    }
    if let Some(id) = ids.iter().find(|id| TABLE.iter().all(|rule| rule.id != id.as_str())) {
        eprintln!("{id}: no such rule; `glumbra check --list` names them");
        return ExitCode::FAILURE;
    }
    let page = std::fs::read_to_string(PAGE).unwrap_or_default();
    let mut known = rows(&page);
    let is_hole = |fault: &Fault| known.iter().all(|row| row.fault != fault.name || row.red.is_empty());
    let is_meant_by = |fault: &Fault, name: &str| {
        fault.name.contains(name) || fault.breaks.iter().any(|broken| broken.contains(name))
    };
    if let Some(name) = names.iter().find(|name| !faults::all().any(|fault| is_meant_by(fault, name))) {
        eprintln!("{name}: no fault has it in its name or in what it breaks");
        return ExitCode::FAILURE;
    }
    let named = |fault: &Fault| names.is_empty() || names.iter().any(|name| is_meant_by(fault, name));
    let chosen: Vec<_> = faults::all().filter(|fault| named(fault) && (!arguments.holes || is_hole(fault))).collect();
    if arguments.reduce {
        return if reduced::all(&chosen, &known) { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    }
    if arguments.shown {
        tell_shares(&chosen);
        return ExitCode::SUCCESS;
    }
    // Rules by their ids: those among the names that begin with GL-.
    let is_meant = |rule: &&glumbra::conformance::Rule| ids.is_empty() || ids.iter().any(|id| id == rule.id);
    let rules: Vec<_> = TABLE.iter().filter(is_meant).collect();
    println!("a sound driver: {:?} fail", red(None, &rules, false));
    let scenes = if arguments.pictures { sound() } else { Vec::new() };
    println!("{} faults, {} rules, {} scenes", chosen.len(), rules.len(), scenes.len());
    let start = Instant::now();
    let results = each(&chosen, |fault| {
        let red: Vec<_> = red(Some(fault), &rules, false).into_iter().map(str::to_owned).collect();
        let differ = arguments.pictures.then(|| changed(fault, &scenes));
        println!("{}: {}; {}", fault.name, red.join(" "), differ.clone().unwrap_or_default().join(", "));
        Row { fault: fault.name.to_owned(), red, changed: differ.map(|scenes| scenes.len()) }
    });
    println!("{:.0} s", start.elapsed().as_secs_f64());
    let of = |test: fn(&Row) -> bool| {
        results.iter().filter(|row| test(row)).map(|row| row.fault.as_str()).collect::<Vec<_>>()
    };
    let holes = of(|row| row.red.is_empty() && row.changed != Some(0));
    let neither = of(|row| row.red.is_empty() && row.changed == Some(0));
    println!("holes: {holes:#?}\nchange neither a rule nor a picture: {neither:#?}");
    let fails = !holes.is_empty();
    for mut row in results {
        let before = known.iter().position(|known| known.fault == row.fault).map(|index| known.swap_remove(index));
        row.changed = row.changed.or(before.and_then(|before| before.changed));
        known.push(row);
    }
    if arguments.write {
        let (before, rest) = page.split_once(MARKER).expect("the marker");
        let (_, after) = rest.split_once(END).expect("the end's marker");
        std::fs::write(PAGE, format!("{before}{MARKER}\n\n{}\n{END}{after}", table(&known))).expect("the page");
    }
    if fails { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
