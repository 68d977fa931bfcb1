//! `glumbra gallery`: the set of entries, that each failure is as wrong as its entry says, that each printed command draws
//! the page's picture again to the bit, and that the page is one well-formed file.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glumbra::context::{self, ContextRequest};
use glumbra::figures::FIGURES;
use glumbra::frame::Renderer;
use glumbra::gallery::{self, EntrySide, GalleryEntry, MeasuredChoice, PageFacts, ShownEntry};
use glumbra::techniques::{LightShadow, TABLE};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const GLUMBRA: &str = env!("CARGO_BIN_EXE_glumbra");

/// The entries and what was drawn of each in quick pictures, the page, and what was measured of the choices.
type Drawn = (Vec<(GalleryEntry, ShownEntry)>, String, Vec<MeasuredChoice>);

static GALLERY: LazyLock<Drawn> = LazyLock::new(|| {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let shown: Vec<(GalleryEntry, ShownEntry)> = gallery::chosen(&[])
        .unwrap()
        .into_iter()
        .map(|entry| {
            let shown = gallery::show(&entry, true, &mut renderer).unwrap();
            (entry, shown)
        })
        .collect();
    let choices = gallery::choices().unwrap();
    let measured = choices.iter().map(|choice| gallery::measure_choice(choice, true, &mut renderer).unwrap());
    let measured: Vec<MeasuredChoice> = measured.collect();
    let page =
        gallery::to_html(&shown, &measured, &PageFacts { driver: String::from("<driver>"), quick: true }).unwrap();
    (shown, page, measured)
});

/// An element of the page: its name, its attributes, and the text in it.
#[derive(Debug)]
struct Element {
    name: String,
    attributes: BTreeMap<String, String>,
    text: String,
}

impl Element {
    fn of(start: &BytesStart<'_>) -> Self {
        let attributes = start.attributes().map(|attribute| {
            let attribute = attribute.unwrap();
            let key = String::from_utf8(attribute.key.as_ref().to_vec()).unwrap();
            (key, quick_xml::escape::unescape(std::str::from_utf8(&attribute.value).unwrap()).unwrap().into_owned())
        });
        let name = String::from_utf8(start.name().as_ref().to_vec()).unwrap();
        Self { name, attributes: attributes.collect(), text: String::new() }
    }

    fn get(&self, attribute: &str) -> &str {
        self.attributes.get(attribute).map_or("", String::as_str)
    }
}

/// The elements in the order in which they begin. Panics where the page is not well-formed.
fn elements(page: &str) -> Vec<Element> {
    let mut reader = Reader::from_str(page);
    let (mut found, mut open): (Vec<Element>, Vec<usize>) = (Vec::new(), Vec::new());
    loop {
        match reader.read_event().unwrap() {
            Event::Start(start) => {
                open.push(found.len());
                found.push(Element::of(&start));
            }
            Event::Empty(start) => found.push(Element::of(&start)),
            Event::End(_) => drop(open.pop().unwrap()),
            Event::Text(text) => {
                let text = text.decode().unwrap().into_owned();
                open.iter().for_each(|index| found[*index].text += &text);
            }
            Event::GeneralRef(reference) => {
                let text = format!("&{};", reference.decode().unwrap());
                let text = quick_xml::escape::unescape(&text).unwrap().into_owned();
                open.iter().for_each(|index| found[*index].text += &text);
            }
            Event::Eof => break,
            _ => {}
        }
    }
    assert!(open.is_empty(), "{} elements are not closed", open.len());
    found
}

#[test]
fn entries_cover_the_techniques_and_cite_what_documents_md_lists() {
    let entries = gallery::entries().unwrap();
    let documents = fs::read_to_string(Path::new(ROOT).join("data/documents.md")).unwrap();
    let ids: BTreeSet<&str> = entries.iter().map(|entry| entry.id.as_str()).collect();
    assert_eq!(ids.len(), entries.len(), "two entries have one id");
    for technique in TABLE {
        let name = technique.name();
        assert!(entries.iter().any(|entry| entry.technique == name), "no entry is about {name}");
    }
    for entry in &entries {
        let id = &entry.id;
        assert!(id.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-'), "{id}");
        assert!(documents.contains(&format!("**[{}]**", entry.document)), "{id}: no document [{}]", entry.document);
        for section in entry.section.split("; ") {
            assert!(documents.contains(section), "{id}: data/documents.md has no section {section:?}");
        }
        for side in [EntrySide::Failure, EntrySide::Cure] {
            let scene = entry.scene_of(side, false).unwrap();
            let chosen = LightShadow::of(&scene.lights[entry.light].shadow).unwrap().technique.name();
            assert!(side == EntrySide::Cure || chosen == entry.technique, "{id}: the failing light has {chosen}");
        }
        assert!(entry.factor > 1.0 && entry.least > 0.0, "{id}: a failure that need not be worse");
        let figure = entry.figure.as_deref();
        assert!(figure.is_none_or(|name| FIGURES.iter().any(|figure| figure.name == name)), "{id}: {figure:?}");
        assert!(Path::new(ROOT).join(&entry.scene).is_file(), "{id}: {}", entry.scene);
    }
}

#[test]
fn choices_cite_what_documents_md_lists_and_say_what_is_measured() {
    let documents = fs::read_to_string(Path::new(ROOT).join("data/documents.md")).unwrap();
    for MeasuredChoice { choice, measures } in &GALLERY.2 {
        let id = &choice.id;
        assert!(documents.contains(&format!("**[{}]**", choice.document)), "{id}: no document [{}]", choice.document);
        for section in choice.section.split("; ") {
            assert!(documents.contains(section), "{id}: data/documents.md has no section {section:?}");
        }
        assert!(measures.iter().all(|price| price.frame_ms > 0.0), "{id}: {measures:?}");
        // A volume is exact but where a texture cuts its caster out; a map never is.
        let [map, volumes] = measures.map(|price| price.wrong_percent);
        let cuts_out = id == "cut-out-shapes";
        assert_eq!(volumes == 0.0, !cuts_out, "{id}: {volumes} % by volumes");
        assert!(map > 0.0 && (map < volumes) == cuts_out, "{id}: {map} % by the map, {volumes} % by volumes");
    }
}

#[test]
fn every_failure_is_as_much_worse_than_its_cure_as_its_entry_says() {
    let wrong: Vec<String> = GALLERY
        .0
        .iter()
        .filter_map(|(entry, shown)| {
            let [failure, cure] = [&shown.failure, &shown.cure].map(|side| side.numbers.get(entry.measure).unwrap());
            let words = || format!("{}: {failure} against {cure} {}", entry.id, entry.measure.unit());
            (!entry.is_kept_by(failure, cure)).then(words)
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_printed_commands_draw_the_page_s_pictures_again_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let page = elements(&GALLERY.1);
    let commands: Vec<&Element> = page.iter().filter(|element| element.get("class").starts_with("command ")).collect();
    assert_eq!(commands.len(), 2 * GALLERY.0.len());
    for command in commands {
        // The scene's path is relative to the sources, the picture's to the folder that the reader is in.
        let words = command.text.replace("-o ", &format!("--quiet -o {}/", folder.path().display()));
        let words = words.replacen("glumbra", GLUMBRA, 1);
        let run = Command::new("sh").args(["-c", &words]).current_dir(ROOT).output().unwrap();
        assert!(run.status.success(), "{}: {}", command.text, String::from_utf8_lossy(&run.stderr));
        let name = command.text.rsplit_once(' ').unwrap().1;
        let drawn = image::open(folder.path().join(name)).unwrap().to_rgb8();
        let id = name.strip_suffix(".png").unwrap();
        let figure = page.iter().position(|element| element.get("id") == id).unwrap();
        let shown = page[figure..].iter().find(|element| element.name == "img").unwrap();
        let png = STANDARD.decode(shown.get("src").strip_prefix("data:image/png;base64,").unwrap()).unwrap();
        let shown = image::load_from_memory(&png).unwrap().to_rgb8();
        assert!(drawn == shown, "{} draws another picture than the page's {id}", command.text);
    }
}

#[test]
fn the_page_is_one_well_formed_file_that_loads_nothing() {
    let page = elements(&GALLERY.1);
    let mut ids = BTreeSet::new();
    for element in &page {
        let id = element.get("id");
        assert!(id.is_empty() || ids.insert(id), "two elements have the id {id}");
    }
    for element in &page {
        for (name, value) in &element.attributes {
            match name.as_str() {
                "href" => assert!(value.strip_prefix('#').is_some_and(|id| ids.contains(id)), "{element:?}"),
                "src" => assert!(value.starts_with("data:image/png;base64,"), "{} loads {value}", element.name),
                _ => assert!(!value.contains("url("), "{element:?}"),
            }
        }
        assert!(!["link", "iframe", "object", "base"].contains(&element.name.as_str()), "{element:?}");
        let loads = ["url(", "@import", "fetch(", "http"].into_iter().find(|word| element.text.contains(word));
        let is_code = ["style", "script"].contains(&element.name.as_str());
        assert!(!is_code || loads.is_none(), "<{}> has {loads:?}", element.name);
        assert!(element.name != "img" || !element.get("alt").is_empty(), "a picture without words");
    }
    let sections = page.iter().filter(|element| element.name == "section" && element.get("class") == "entry");
    assert_eq!(sections.count(), GALLERY.0.len() + 1, "one of each entry, and the table of choices");
    assert!(GALLERY.1.contains("&lt;driver&gt;"), "the driver's name is not escaped");
}

fn run(arguments: &[&str]) -> (bool, String, String) {
    let run = Command::new(GLUMBRA).arg("gallery").args(arguments).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (run.status.success(), text(&run.stdout), text(&run.stderr))
}

#[test]
fn the_command_writes_a_page_of_one_entry_and_one_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (right, printed, error) = run(&["--quick", "--entry", "parity", "-o", &path("page")]);
    assert!(right && printed.trim() == path("page/index.html"), "{printed}{error}");
    let page = fs::read_to_string(path("page/index.html")).unwrap();
    let sections = elements(&page).iter().filter(|element| element.name == "section").count();
    assert_eq!(sections, 1, "one entry was asked for");
    let files = fs::read_dir(path("page")).unwrap().count();
    assert_eq!(files, 1, "the page needs no other file");

    let (right, _, error) = run(&["--quick", "--entry", "parity", "--picture", "failure", "-o", &path("p.png")]);
    assert!(right, "{error}");
    let (_, shown) = GALLERY.0.iter().find(|(entry, _)| entry.id == "parity").unwrap();
    assert!(image::open(path("p.png")).unwrap().to_rgb8() == shown.failure.picture);

    let (right, printed, _) = run(&["--list"]);
    assert!(right && printed.lines().count() == GALLERY.0.len(), "{printed}");
}

#[test]
fn wrong_arguments_are_refused_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("page").display().to_string();
    for (arguments, words) in [
        (&["--entry", "no-offest"][..], "did you mean `no-offset`?"),
        (&["--entry", "parity", "--entry", "no-offset", "--picture", "cure"], "one --entry is wanted, and 2 are given"),
        (&["--picture", "cure"], "--entry"),
        (&["--entry", "parity", "--picture", "cure"], "end it in .png"),
    ] {
        let (right, _, error) = run(&[arguments, &["-o", &path]].concat());
        assert!(!right && error.contains(words), "{arguments:?}: {error}");
        assert!(!Path::new(&path).exists(), "{arguments:?} left something");
    }
}
