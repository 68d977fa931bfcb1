//! Tells which rules of `glumbra check` see each fault of `conformance::faults`.
//!
//! `cargo run --release --example faults -- [--quick] [NAME...]`: with `--quick` only the rules that the fault names, else all
//! of them; only faults whose name or whose broken functions contain one of the names.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use glumbra::conformance::faults::{self, Fault};
use glumbra::conformance::{self, DriverUnderTest, RuleVerdict, waivers};
use glumbra::context::{self, ContextRequest, Profile};

/// Ids of the rules that fail on a driver with the fault, in the table's order.
fn red(fault: Option<&Fault>, ids: &[&str]) -> Result<Vec<&'static str>, String> {
    let request = ContextRequest { profile: Profile::Compatibility, ..ContextRequest::default() };
    let mut context = context::open(&request).map_err(|error| error.to_string())?;
    if let Some(fault) = fault {
        context = faults::broken(context, fault);
    }
    let subject = DriverUnderTest::new(context.as_ref(), None).map_err(|error| error.to_string())?;
    let rules: Vec<_> = conformance::TABLE.iter().filter(|rule| ids.is_empty() || ids.contains(&rule.id)).collect();
    let mut outcomes = conformance::run(&subject, &rules, |_| {});
    let waivers = waivers::load(None).map_err(|error| error.to_string())?;
    waivers::apply(&waivers, &subject.info, &mut outcomes);
    Ok(outcomes.iter().filter(|outcome| outcome.verdict == RuleVerdict::Fail).map(|outcome| outcome.id).collect())
}

fn main() {
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    let quick = names.iter().any(|name| name == "--quick");
    names.retain(|name| name != "--quick");
    let wanted = |fault: &&Fault| {
        names.is_empty()
            || names.iter().any(|name| {
                fault.name.contains(name.as_str()) || fault.breaks.iter().any(|broken| broken.contains(name.as_str()))
            })
    };
    let faults: Vec<_> = faults::all().filter(wanted).collect();
    println!("sound: {:?}", red(None, &[]));
    let next = AtomicUsize::new(0);
    let start = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(fault) = faults.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let start = Instant::now();
                    let red = red(Some(fault), &[]);
                    let seconds = start.elapsed().as_secs_f64();
                    let seen = match &red {
                        Ok(red) if red.is_empty() => "NOTHING".to_owned(),
                        Ok(red) => red.join(" "),
                        Err(error) => error.clone(),
                    };
                    println!("{}: {seen} ({seconds:.2} s)", fault.name);
                }
            });
        }
    });
    println!("{} faults in {:.1} s", faults.len(), start.elapsed().as_secs_f64());
}
