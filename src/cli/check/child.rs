//! The process that checks: it opens the context, runs rules, and tells how far it is by a line each step.

use std::rc::Rc;

use super::CheckArgs;
use crate::cli::{Error, child_process};
use crate::conformance::events::{Event, rule};
use crate::conformance::{self, DriverUnderTest, ResetStatus, Rule, RuleVerdict};
use crate::context::{self, Context, Profile};

/// Runs the rules of these ids, and writes a line each step on standard output.
///
/// # Errors
///
/// Standard output that is closed: whoever started this process is no more.
pub fn run(arguments: &CheckArgs, ids: &[String]) -> Result<(), Error> {
    child_process::end_with_parent(drop);
    let rules: Vec<&Rule> = ids.iter().filter_map(|id| rule(id)).collect();
    steps(arguments, &rules, |event| {
        let is_lost = matches!(event, Event::Ends { lost: true, .. });
        child_process::tell(&event)?;
        if is_lost {
            // Objects of a lost context are not deleted.
            crate::process::leave(0);
        }
        Ok(())
    })
}

/// Runs `rules` in this process and gives each step to `tell`.
///
/// # Errors
///
/// Those of `tell`.
pub fn steps(
    arguments: &CheckArgs,
    rules: &[&'static Rule],
    mut tell: impl FnMut(Event) -> Result<(), Error>,
) -> Result<(), Error> {
    let opened = open(arguments).map_err(Error::from);
    let subject = opened.and_then(|context| Ok((DriverUnderTest::new(&context, None)?, context)));
    let (subject, context) = match subject {
        Ok(opened) => opened,
        Err(error) => return tell(Event::Refused(error.to_string())),
    };
    let reset = ResetStatus::of(context.as_ref());
    tell(Event::Context(Box::new(subject.info.clone())))?;
    for rule in rules {
        tell(Event::Begins(rule.id.to_owned()))?;
        let mut outcome = conformance::run_rule(&subject, rule);
        if let Some(why) = reset.why() {
            outcome.findings.push(conformance::Finding::new("the context", RuleVerdict::ContextLost, why));
        }
        // What GL does after it has run out of memory is undefined [GL 4.6, 2.3.1].
        let ends = [RuleVerdict::ContextLost, RuleVerdict::OutOfMemory];
        let lost = outcome.findings.iter().any(|finding| ends.contains(&finding.verdict));
        tell(Event::ends(outcome, lost))?;
    }
    Ok(())
}

/// A compatibility context, or a core one where there is none.
///
/// # Errors
///
/// No context.
pub fn open(arguments: &CheckArgs) -> Result<Rc<dyn Context>, context::Error> {
    if !arguments.core
        && let Ok(context) = context::open(&arguments.context.request(Profile::Compatibility))
    {
        return Ok(context);
    }
    context::open(&arguments.context.request(Profile::Core33))
}
