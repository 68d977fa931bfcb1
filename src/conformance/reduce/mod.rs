//! `glumbra check --reduce`: the smallest program that shows a rule's failure on this driver.
//!
//! 1. The rule is run, and its calls are noted (`log.rs`).
//! 2. Which number of the driver's is wrong, and what would be right, the rule is asked itself (`ask.rs`).
//! 3. The calls that the number depends on by the specification are found (`slice.rs`, by what each call writes and reads:
//!    `effects.rs`), made again in a new context (`replay.rs`), and made fewer as long as the driver errs in the same way
//!    (`shrink.rs`).
//! 4. They are written as C (`program.rs`).

mod ask;
mod bounds;
mod draws;
mod effects;
mod fixed;
mod images;
mod log;
mod meaning;
mod names;
mod pixels;
mod program;
mod replay;
mod shrink;
mod slice;
mod state;

use std::cell::RefCell;
use std::rc::Rc;
use std::time::{Duration, Instant};

use self::ask::{Asked, Judgement, findings_of};
use self::log::{Mode, Recorded};
use self::program::Heading;
use super::{DriverUnderTest, Finding, Rule, bench, layer};
use crate::c_text::comment;
use crate::context::{self, Context, ContextInfo};

/// Reason why there is no program.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum ReduceError {
    /// The rule does not fail.
    #[error("{rule} passes on this driver: nothing to reduce")]
    Passes { rule: &'static str },
    /// The context lacks what the rule is about.
    #[error("{rule} cannot be tested here: nothing to reduce")]
    Untestable { rule: &'static str },
    /// The rule crashes, hangs or loses the context.
    #[error("{rule} ends the process ({how}): --reduce cannot reduce a crash, a hang or a lost context")]
    Ends { rule: &'static str, how: String },
    /// No number that, changed alone, makes the rule content; or its bound depends on another answer.
    #[error(
        "{rule}: \"{finding}\" fails, but not by one number of one answer, with a bound that no other answer of the driver \
         moves: --reduce cannot say that in a program"
    )]
    NoNumber { rule: &'static str, finding: String },
    /// The limit of time or of questions was met before a number was found.
    #[error(
        "{rule}: \"{finding}\" fails, but which number is wrong was not found within {seconds} s or {questions} runs of the rule"
    )]
    GivenUp { rule: &'static str, finding: String, seconds: u64, questions: usize },
    /// The driver does not err when the calls are made again.
    #[error("{rule}: \"{finding}\" fails, but not when the same calls are made again in a new context")]
    NotAgain { rule: &'static str, finding: String },
    /// A call with data of unknown size.
    #[error("{rule} calls {function}, whose data --reduce cannot note")]
    Unknown { rule: &'static str, function: &'static str },
    /// A call whose effects are not followed.
    #[error("{rule} calls {function}, whose effects --reduce does not know")]
    NotFollowed { rule: &'static str, function: &'static str },
    /// No context for a replay.
    #[error(transparent)]
    Context(#[from] context::Error),
    /// A driver without the objects that the bench needs.
    #[error(transparent)]
    Bench(#[from] bench::Error),
}

/// A program, and how it came about.
pub struct Reduced {
    /// The text in C.
    pub program: String,
    /// Number of calls of the rule before its failure, and of the program.
    pub calls: [usize; 2],
    /// How often a scene was drawn again.
    pub replays: usize,
    /// The wrong number and the right one, in a line.
    pub says: String,
    scene: Vec<Recorded>,
    judgement: Judgement,
}

impl Reduced {
    /// Makes the program's calls in another context, which is current: tests whether that driver has the fault. `None`: GL
    /// made an error.
    pub fn shows_in(&self, context: &dyn Context) -> Option<bool> {
        let replayed = replay::replay(context, &self.scene.iter().collect::<Vec<_>>());
        let got = self.judgement.layout.get(&replayed.bytes, self.judgement.element);
        (replayed.error == 0).then(|| !self.judgement.holds(&got))
    }
}

/// Steps of the work, to be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The rule is asked about a number.
    Asks,
    /// A smaller scene is drawn.
    Draws,
}

/// Replays at most.
pub const MOST_REPLAYS: usize = shrink::MOST_TRIALS;

/// Finds the smallest program that shows the failure of `rule` in contexts as `open` makes them.
///
/// # Errors
///
/// A rule that does not fail, or whose failure is no wrong number; no context.
pub fn reduce(
    open: &dyn Fn() -> Result<Rc<dyn Context>, context::Error>,
    rule: &'static Rule,
    tick: &mut dyn FnMut(Step),
) -> Result<Reduced, ReduceError> {
    let Noted { judgement, finding, calls, info } = note(open, rule, tick)?;
    let what = finding.message();
    let mut open_error = None;
    let mut errs = |calls: &[&Recorded], whole: bool, bytes: &[u8]| {
        tick(Step::Draws);
        let context = match open() {
            Ok(context) => context,
            Err(error) => {
                open_error.get_or_insert(error);
                return false;
            }
        };
        let replayed = replay::replay(context.as_ref(), calls);
        let got = judgement.layout.get(&replayed.bytes, judgement.element);
        let is_same =
            got.len() == judgement.got.len() && got.iter().zip(&judgement.got).all(|(a, b)| a.to_bits() == b.to_bits());
        replayed.error == 0 && is_same && (!whole || replayed.bytes == bytes)
    };
    let Calls { calls, bytes } = calls;
    let before = calls.len();
    let mut trials = shrink::Trials { errs: &mut |calls, whole| errs(calls, whole, &bytes), count: 0 };
    let reduced = shrink::calls(&mut trials, &calls).map(|calls| shrink::data(&mut trials, calls, &judgement));
    let replays = trials.count;
    if let Some(error) = open_error {
        return Err(error.into());
    }
    let reduced = reduced.ok_or(ReduceError::NotAgain { rule: rule.id, finding: what.clone() })?;
    let place = match (shrink::pixel_of(&reduced, &judgement), reduced.last()) {
        (Some([x, y]), _) => format!("pixel ({x}, {y})"),
        (None, Some(call)) => format!("{}, value {}", call.name, judgement.element),
        (None, None) => String::new(),
    };
    let says = format!("{place}: {} is due, {} is read", due(&judgement), numbers(&judgement.got));
    let heading = heading(rule, &finding, &info, &says, [before, reduced.len()], judge(&judgement, &place));
    let program = program::write(&reduced, &heading);
    Ok(Reduced { program, calls: [before, reduced.len()], replays, says, scene: reduced, judgement })
}

/// A rule's run, and what was wrong in it.
struct Noted {
    judgement: Judgement,
    finding: Finding,
    calls: Calls,
    info: ContextInfo,
}

/// Calls up to a read, and its answer.
struct Calls {
    calls: Vec<Recorded>,
    bytes: Vec<u8>,
}

/// Runs the rule, notes its calls, and finds the number that is wrong.
fn note(
    open: &dyn Fn() -> Result<Rc<dyn Context>, context::Error>,
    rule: &'static Rule,
    tick: &mut dyn FnMut(Step),
) -> Result<Noted, ReduceError> {
    let mode = Rc::new(RefCell::new(Mode::Pass));
    let context = layer::over(open()?, |layer| log::hook(layer, &mode));
    *mode.borrow_mut() = Mode::Record(log::Log::default());
    let subject = DriverUnderTest::new(&context, None)?;
    // The bench itself asks for errors, which the rule's later runs do not.
    let skipped = if let Mode::Record(log) = &*mode.borrow() { log.reads.len() } else { 0 };
    let findings = findings_of(rule, &subject);
    let Mode::Record(log) = mode.replace(Mode::Pass) else { return Err(ReduceError::Passes { rule: rule.id }) };
    let failing: Vec<&Finding> = findings.iter().filter(|finding| finding.verdict.fails()).collect();
    if failing.is_empty() {
        let is_tested = findings.iter().any(|finding| finding.verdict > super::RuleVerdict::Untestable);
        return Err(if is_tested {
            ReduceError::Passes { rule: rule.id }
        } else {
            ReduceError::Untestable { rule: rule.id }
        });
    }
    if let Some(function) = log.unknown {
        return Err(ReduceError::Unknown { rule: rule.id, function });
    }
    let reads = Rc::new(log.reads[skipped..].to_vec());
    let mut given_up = None;
    for finding in &failing {
        let of_name = findings.iter().filter(|other| other.what == finding.what);
        let before = of_name.take_while(|other| !std::ptr::eq(*other, *finding)).count();
        let mut tick = || tick(Step::Asks);
        let finding = (*finding).clone();
        let mut asked = Asked {
            rule,
            subject: &subject,
            mode: &mode,
            reads: reads.clone(),
            finding: finding.clone(),
            before,
            tick: &mut tick,
            left: ask::MOST_QUESTIONS,
            until: Instant::now() + Duration::from_secs(ask::MOST_SECONDS),
        };
        let judged = asked.judge();
        if judged.is_none() && asked.left == 0 {
            given_up.get_or_insert_with(|| finding.message());
        }
        if let Some(judgement) = judged {
            let read = skipped + judgement.read;
            let end = log.calls.iter().position(|call| call.read == Some(read)).map_or(0, |index| index + 1);
            if let Some(function) = slice::unknown(&log.calls[..end]) {
                return Err(ReduceError::NotFollowed { rule: rule.id, function });
            }
            let calls = Calls { calls: log.calls[..end].to_vec(), bytes: log.reads[read].bytes.clone() };
            let info = subject.info.clone();
            return Ok(Noted { judgement, finding, calls, info });
        }
    }
    Err(match given_up {
        Some(finding) => {
            ReduceError::GivenUp { rule: rule.id, finding, seconds: ask::MOST_SECONDS, questions: ask::MOST_QUESTIONS }
        }
        None => ReduceError::NoNumber { rule: rule.id, finding: failing[0].message() },
    })
}

fn numbers(values: &[f64]) -> String {
    let all: Vec<String> = values.iter().map(f64::to_string).collect();
    if let [one] = &all[..] { one.clone() } else { format!("({})", all.join(", ")) }
}

/// The right numbers in words.
fn due(judgement: &Judgement) -> String {
    let one = |range: &Option<[f64; 2]>| match range {
        None => "any".to_owned(),
        Some([low, high]) if low == high => low.to_string(),
        Some([low, high]) => format!("{low:.9} to {high:.9}"),
    };
    let all: Vec<String> = judgement.right.iter().map(one).collect();
    if let [one] = &all[..] { one.clone() } else { format!("({})", all.join(", ")) }
}

/// The end of the program: reads the numbers and compares.
fn judge(judgement: &Judgement, place: &str) -> String {
    let layout = judgement.layout;
    let offset = layout.offset(judgement.element);
    let ranges = judgement.right.iter().map(|range| range.unwrap_or(layout.scalar.range()));
    let ranges: Vec<String> = ranges.map(|[low, high]| format!("{{{low:?}, {high:?}}}")).collect();
    let count = judgement.right.len();
    let c_type = layout.scalar.c_type();
    let component = match layout.scalar {
        pixels::Scalar::Depth24Stencil8 => "        double got = i == 0 ? numbers[0] >> 8 : numbers[0] & 0xFF;\n",
        _ => "        double got = (double)numbers[i];\n",
    };
    let words = if layout.scalar == pixels::Scalar::Depth24Stencil8 { 1 } else { count };
    format!(
        "
    GLenum error = glGetError();
    if (error) {{
        printf(\"GL error 0x%04X: nothing can be said\\n\", error);
        return 2;
    }}
    /* {place}: least and greatest right number of each component. */
    static const double right[{count}][2] = {{{}}};
    {c_type} numbers[{words}];
    memcpy(numbers, (const char *)answer + {offset}, sizeof numbers);
    int wrong = 0;
    for (int i = 0; i < {count}; i++) {{
{component}        int is_right = got >= right[i][0] && got <= right[i][1];
        printf(\"{place}, component %d: expected %.9g to %.9g, got %.9g%s\\n\", i, right[i][0], right[i][1], got,
               is_right ? \"\" : \": wrong\");
        wrong += !is_right;
    }}
    puts(wrong ? \"The driver has the fault.\" : \"The driver does not have the fault.\");
    return wrong ? 1 : 0;
",
        ranges.join(", ")
    )
}

fn heading(
    rule: &Rule,
    finding: &Finding,
    info: &ContextInfo,
    says: &str,
    calls: [usize; 2],
    judge: String,
) -> Heading {
    let section = format!("OpenGL 4.6, compatibility profile, {}", rule.section);
    let lines = vec![
        format!("{}: {}", rule.id, rule.title),
        section.clone(),
        rule.says.to_owned(),
        String::new(),
        format!("The check that fails: {}", finding.message()),
        says.to_owned(),
        String::new(),
        format!("Driver: {}", info.renderer),
        format!("        {} ({})", info.version, info.vendor),
        format!(
            "Written by glumbra {} check --reduce {} on {}, from {} calls of GL to {}.",
            env!("CARGO_PKG_VERSION"),
            rule.id,
            today(),
            calls[0],
            calls[1]
        ),
        String::new(),
        "cc FILE.c -o reduced -ldl && ./reduced".to_owned(),
        "Exit status: 1 the driver has the fault, 0 it does not, 2 nothing can be said (no context, a GL error)."
            .to_owned(),
    ];
    let says = vec![format!("{}: {}", rule.id, rule.title), section, comment(rule.says), comment(&finding.what)];
    let is_core = info.profile == "core";
    Heading { lines, says, profile: if is_core { 1 } else { 2 }, judge }
}

/// The date as 2026-01-31, in UTC.
fn today() -> String {
    let seconds = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |since| since.as_secs());
    // Days since 0000-03-01 of the Gregorian calendar, which repeats every 146097 days.
    let days = seconds / 86400 + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let date = day - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    format!("{:04}-{month:02}-{date:02}", era * 400 + year + next)
}
