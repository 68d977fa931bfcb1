//! `glumbra check` on drivers that crash, hang, run out of memory or lose the context: each is the verdict of the rule that
//! met it, and the run goes on. The fault is a function of GL that a library, loaded before the driver, gives in its place.

use std::os::unix::process::ExitStatusExt;
use std::path::PathBuf;
use std::process::Stdio;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use super::*;
use crate::support::processes::{await_end, children_of};

/// glCopyTexSubImage2D, which GL-F1 alone calls of the rules below, does what FAULT says. `dlsym` is how libEGL's own
/// eglGetProcAddress is found.
const SOURCE: &str = r#"
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
typedef void *(*Lookup)(const char *);
typedef unsigned (*GetError)(void);
static Lookup driver;
static GetError error;
static unsigned code;
static unsigned get_error(void) { return code ? code : error(); }
static void fault(void) {
    const char *kind = getenv("FAULT");
    if (!strcmp(kind, "crash")) *(volatile int *)0 = 0;
    if (!strcmp(kind, "abort")) abort();
    if (!strcmp(kind, "exit")) _exit(3);
    if (!strcmp(kind, "killed")) raise(SIGKILL);
    if (!strcmp(kind, "memory")) code = 0x0505;
    if (!strcmp(kind, "lost")) code = 0x0507;
    if (!strcmp(kind, "hang")) for (;;) pause();
    if (!strcmp(kind, "busy")) for (;;) ;
}
static void *lookup(const char *name) {
    if (!strcmp(name, "glCopyTexSubImage2D")) return (void *)fault;
    if (!strcmp(name, "glGetError")) { error = (GetError)driver(name); return (void *)get_error; }
    return driver(name);
}
"#;

static LIBRARY: LazyLock<(tempfile::TempDir, PathBuf)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let [source, library] = ["fault.c", "fault.so"].map(|name| folder.path().join(name));
    std::fs::write(&source, format!("{SOURCE}{FOUND_BY_DLSYM}")).unwrap();
    let built = Command::new("cc").args(["-shared", "-fPIC", "-o"]).args([&library, &source]).arg("-ldl").status();
    assert!(built.unwrap().success(), "cc is what cargo links with");
    (folder, library)
});

fn broken(folder: &Path, fault: &str, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("glumbra").unwrap();
    command.current_dir(folder).args(["check", "--context", "egl"]).args(arguments);
    command.env("LD_PRELOAD", &LIBRARY.1).env("FAULT", fault);
    command
}

#[test]
fn what_ends_a_rule_is_its_verdict_and_the_others_are_run() {
    let rules = ["--filter", "C1", "--filter", "F1", "--filter", "F2", "--filter", "S2"];
    for (fault, verdict, told, kind) in [
        ("crash", "crash", "crashed (SIGSEGV)", "error"),
        ("abort", "crash", "crashed (SIGABRT)", "error"),
        ("exit", "crash", "ended itself (exit status: 3)", "error"),
        ("killed", "out_of_memory", "was killed by SIGKILL", "error"),
        ("memory", "out_of_memory", "GL_OUT_OF_MEMORY", "error"),
        ("lost", "context_lost", "GL_CONTEXT_LOST", "error"),
        ("hang", "hang", "did not end in 2 s, and was killed", "error"),
        ("busy", "hang", "did not end in 2 s, and was killed", "error"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let arguments = [&rules[..], &["--timeout", "2", "--json", "x.json", "--junit", "x.xml"]].concat();
        let output = broken(folder.path(), fault, &arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{fault}: {}", text(&output.stderr));
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        let json: serde_json::Value = serde_json::from_str(&read("x.json")).unwrap();
        let verdicts = json["outcomes"].as_array().unwrap().iter().map(|outcome| {
            let [id, verdict] = ["id", "verdict"].map(|key| outcome[key].as_str().unwrap());
            let finding = outcome["findings"].as_array().unwrap().iter().find(|f| f["verdict"] == verdict).unwrap();
            (id.to_owned(), verdict.to_owned(), finding["measured"].as_str().unwrap().to_owned())
        });
        let mut verdicts: Vec<_> = verdicts.collect();
        let at = verdicts.iter().position(|(id, ..)| id == "GL-F1").unwrap();
        let (_, got, measured) = verdicts.remove(at);
        assert_eq!(got, verdict, "{fault}: {measured}");
        assert!(measured.contains(told), "{fault}: {measured}");
        assert_eq!(verdicts.len(), 3, "{fault}");
        assert!(verdicts.iter().all(|(_, verdict, _)| verdict == "pass"), "{fault}: {verdicts:?}");
        assert!(read("x.xml").contains(&format!("<{kind} ")), "{fault}: {}", read("x.xml"));
        assert!(text(&output.stdout).ends_with("FAIL: GL-F1\n"), "{fault}: {}", text(&output.stdout));
    }
}

/// Files while a rule hangs have what was found before it; a run that is killed leaves them, and no process.
#[test]
fn a_run_that_is_killed_leaves_its_results_and_no_process() {
    for signal in [libc::SIGINT, libc::SIGKILL] {
        let folder = tempfile::tempdir().unwrap();
        let rules = ["--filter", "C1", "--filter", "F1", "--filter", "M1"];
        let arguments = [&rules[..], &["--jobs", "1", "--json", "x.json", "--junit", "x.xml"]].concat();
        let mut run = broken(folder.path(), "busy", &arguments).stdout(Stdio::null()).spawn().unwrap();
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap_or_default();
        let start = Instant::now();
        while !(read("x.json").contains("\"id\": \"GL-C1\"") && read("x.xml").contains("name=\"GL-F1\"")) {
            assert!(start.elapsed() < Duration::from_secs(20), "nothing is written: {}", read("x.json"));
            std::thread::sleep(Duration::from_millis(50));
        }
        let children = children_of(run.id());
        assert_eq!(children.len(), 1);
        // SAFETY: the process is this test's own.
        unsafe { libc::kill(run.id() as i32, signal) };
        assert_eq!(run.wait().unwrap().signal(), Some(signal));
        let json: serde_json::Value = serde_json::from_str(&read("x.json")).unwrap();
        assert_eq!(json["unfinished"], serde_json::json!(["GL-F1", "GL-M1"]));
        await_end(&children);
    }
}
