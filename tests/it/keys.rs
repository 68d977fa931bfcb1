//! `glumbra keys` and `glumbra init`: the list of keys is that of the code, and says of each what holds without it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex};

use glumbra::keys::{Absent, EXEMPLARS, Key, find, page, schema, table};
use glumbra::plan::{self, Request};
use glumbra::scene::{self, Embedded, Scene};
use glumbra::techniques;
use serde_json::Value;

use crate::support::shell;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Number of tables `[[name]]` of an exemplar.
fn count(exemplar: &Embedded, name: &str) -> usize {
    let text: toml::Table = toml::from_str(exemplar.text).unwrap();
    text.get(name).and_then(toml::Value::as_array).map_or(0, Vec::len)
}

/// The places in an exemplar where a key can be set: the path with numbers. A place whose table is not there is none.
fn places(exemplar: &Embedded, key: &str) -> Vec<String> {
    let text: toml::Value = toml::Value::Table(toml::from_str(exemplar.text).unwrap());
    let mut places = vec![(String::new(), Some(&text))];
    let parts: Vec<&str> = key.split('.').collect();
    let (last, tables) = parts.split_last().unwrap();
    for part in tables {
        places = places
            .into_iter()
            .flat_map(|(path, value)| match value.and_then(|value| value.get(*part)) {
                Some(toml::Value::Array(items)) => {
                    items.iter().enumerate().map(|(i, item)| (format!("{path}{part}.{i}."), Some(item))).collect()
                }
                Some(value) => vec![(format!("{path}{part}."), Some(value))],
                None => Vec::new(),
            })
            .collect();
    }
    let is_free = |value: &Option<&toml::Value>| value.is_some_and(|value| value.get(*last).is_none());
    places.into_iter().filter(|(_, value)| is_free(value)).map(|(path, _)| format!("{path}{last}")).collect()
}

fn load(exemplar: &Embedded, overrides: &[String]) -> Result<Scene, scene::Error> {
    techniques::load_embedded(exemplar, overrides).map(|loaded| loaded.scene)
}

/// The passes of a scene as text, or why it has none.
fn passes(scene: &Scene) -> String {
    plan::make(scene, &Request::default()).map_or_else(|error| error.to_string(), |plan| format!("{:?}", plan.list))
}

/// The passes of an exemplar with one override; `None`: it is refused. Found once for all keys.
fn known_passes(exemplar: &Embedded, chosen: &str) -> Option<String> {
    static KNOWN: Mutex<BTreeMap<String, Option<String>>> = Mutex::new(BTreeMap::new());
    let find = || load(exemplar, &[chosen.to_owned()]).ok().map(|scene| passes(&scene));
    KNOWN.lock().unwrap().entry(format!("{} {chosen}", exemplar.path)).or_insert_with(find).clone()
}

/// Sets the default of a key of `[light.shadow]` for each light, under each technique that reads it. Returns how often that
/// could be done, and where it changed the passes.
fn shadow_defaults(key: &Key, value: &str) -> (usize, Vec<String>) {
    let (mut done, mut changed) = (0, Vec::new());
    for exemplar in &EXEMPLARS {
        for place in places(exemplar, &key.key) {
            let light = place.split(".shadow.").next().unwrap();
            for technique in &key.read_by {
                let chosen = format!("{light}.shadow.technique=\"{technique}\"");
                let Some(without) = known_passes(exemplar, &chosen) else { continue };
                let set = [chosen, format!("{place}={value}")];
                let Ok(with) = load(exemplar, &set) else { continue };
                done += 1;
                if without != passes(&with) {
                    changed.push(set.join(" "));
                }
            }
        }
    }
    (done, changed)
}

/// The same for a key of another table, where the scene itself must not change.
fn scene_defaults(key: &Key, value: &str) -> (usize, Vec<String>) {
    static AS_THEY_ARE: LazyLock<Vec<String>> =
        LazyLock::new(|| EXEMPLARS.iter().map(|exemplar| format!("{:?}", load(exemplar, &[]).unwrap())).collect());
    let (mut done, mut changed) = (0, Vec::new());
    for (exemplar, as_it_is) in EXEMPLARS.iter().zip(AS_THEY_ARE.iter()) {
        for place in places(exemplar, &key.key) {
            let set = format!("{place}={value}");
            let Ok(with) = load(exemplar, std::slice::from_ref(&set)) else { continue };
            done += 1;
            if *as_it_is != format!("{with:?}") {
                changed.push(set);
            }
        }
    }
    (done, changed)
}

#[test]
fn defaults_are_what_holds_where_a_key_is_not_written() {
    let mut wrong = Vec::new();
    let (mut tried, mut places) = (0, 0);
    for key in table().unwrap() {
        let Absent::Default(value) = &key.absent else { continue };
        if key.key == "light.shadow.technique" {
            continue; // it chooses who reads the others; the next test holds it
        }
        let test = if key.read_by.is_empty() { scene_defaults } else { shadow_defaults };
        let (done, changed) = test(&key, value);
        if done == 0 {
            wrong.push(format!("{} = {value} could be set in no exemplar", key.key));
        }
        wrong.extend(changed);
        tried += 1;
        places += done;
    }
    assert!(wrong.is_empty(), "defaults of data/keys.toml that change a scene:\n{}", wrong.join("\n"));
    assert!(tried > 60 && places > 150, "only {tried} defaults were tried, at {places} places");
}

#[test]
fn without_a_technique_a_light_has_none() {
    let of_lens = &EXEMPLARS[1];
    let [without, with] =
        [vec![], vec![String::from("light.0.shadow.technique=\"none\"")]].map(|set| load(of_lens, &set));
    assert_eq!(passes(&without.unwrap()), passes(&with.unwrap()));
}

#[test]
fn a_table_without_a_needed_key_is_refused() {
    let mut wrong = Vec::new();
    let mut tried = 0;
    for key in table().unwrap() {
        if key.absent != Absent::Needed || key.key == "object" {
            continue;
        }
        // Written in some exemplar, and refused without it.
        let written = EXEMPLARS.iter().filter_map(|exemplar| without(exemplar, &key.key));
        let refusals: Vec<bool> = written.map(|text| glumbra::load_str(&text, &root(), &[]).is_err()).collect();
        if refusals.is_empty() || refusals.contains(&false) {
            wrong.push(key.key);
        }
        tried += 1;
    }
    assert!(wrong.is_empty(), "keys that are needed as data/keys.toml has it, and are not: {wrong:?}");
    assert!(tried > 10, "only {tried} were tried");
}

/// The exemplar without a key, if it has it. Its files are then those of data/.
fn without(exemplar: &Embedded, key: &str) -> Option<String> {
    fn remove(value: &mut toml::Value, path: &[&str]) -> bool {
        match value {
            toml::Value::Array(items) => {
                items.iter_mut().map(|item| remove(item, path)).collect::<Vec<_>>().contains(&true)
            }
            toml::Value::Table(table) => match path {
                [last] => table.remove(*last).is_some(),
                [first, rest @ ..] => table.get_mut(*first).is_some_and(|value| remove(value, rest)),
                [] => false,
            },
            _ => false,
        }
    }
    let text = exemplar.text.replace("picture.png", "data/textures/barn-doors.png");
    let text = text.replace("knight.md2", "data/meshes/knight.md2");
    assert!(glumbra::load_str(&text, &root(), &[]).is_ok(), "{} is refused as it is", exemplar.path);
    let mut value = toml::Value::Table(toml::from_str(&text).unwrap());
    let path: Vec<&str> = key.split('.').collect();
    remove(&mut value, &path).then(|| toml::to_string(&value).unwrap())
}

#[test]
fn every_exemplar_is_all_of_a_scene() {
    for exemplar in &EXEMPLARS {
        assert!(count(exemplar, "object") > 0 && load(exemplar, &[]).is_ok(), "{}", exemplar.path);
    }
}

#[test]
fn the_page_and_the_schema_are_those_of_the_code() {
    let keys = table().unwrap();
    let files = [("data/scenes/keys.md", page(&keys)), ("data/scenes/schema.json", format!("{:#}\n", schema(&keys)))];
    let is_blessed = std::env::var_os("GLUMBRA_BLESS").is_some_and(|value| value == "1");
    let mut changed = Vec::new();
    for (name, text) in files {
        if fs::read_to_string(root().join(name)).unwrap_or_default() != text {
            changed.push(name);
            if is_blessed {
                fs::write(root().join(name), text).unwrap();
            }
        }
    }
    assert!(
        changed.is_empty(),
        "{changed:?} differ from `glumbra keys --markdown` and `--schema`; GLUMBRA_BLESS=1 cargo test --test it keys:: writes them"
    );
}

/// Faults of a value by a schema; of JSON Schema as much as ours uses.
fn faults(root: &Value, schema: &Value, value: &Value, path: &str) -> Vec<String> {
    schema
        .as_object()
        .unwrap()
        .iter()
        .flat_map(|(word, rule)| broken(root, [schema, rule], word, value, path))
        .collect()
}

/// Faults by one word of a schema, which has this rule.
fn broken(root: &Value, [schema, rule]: [&Value; 2], word: &str, value: &Value, path: &str) -> Vec<String> {
    let unless = |holds: bool, what: String| if holds { Vec::new() } else { vec![format!("{path}: {what}")] };
    let rules = || rule.as_array().unwrap().iter().map(|rule| faults(root, rule, value, path));
    let limit = |holds: fn(f64, f64) -> bool| {
        let holds = value.as_f64().is_none_or(|number| holds(number, rule.as_f64().unwrap()));
        unless(holds, format!("{value}, and {word} is {rule}"))
    };
    match word {
        "description" | "default" | "title" | "$schema" | "definitions" | "additionalProperties" => Vec::new(),
        "type" => {
            let names = rule.as_array().map_or_else(|| vec![rule], |names| names.iter().collect());
            let is_one = |name: &&Value| match name.as_str().unwrap() {
                "object" => value.is_object(),
                "array" => value.is_array(),
                "string" => value.is_string(),
                "boolean" => value.is_boolean(),
                "integer" => value.is_i64(),
                "number" => value.is_number(),
                other => panic!("{other}"),
            };
            unless(names.iter().any(is_one), format!("{value} is no {rule}"))
        }
        "enum" => unless(rule.as_array().unwrap().contains(value), format!("{value} is none of {rule}")),
        "minimum" => limit(|number, limit| number >= limit),
        "maximum" => limit(|number, limit| number <= limit),
        "exclusiveMinimum" => limit(|number, limit| number > limit),
        "exclusiveMaximum" => limit(|number, limit| number < limit),
        "minItems" | "maxItems" => {
            let (items, limit) = (value.as_array().map(Vec::len), rule.as_u64().unwrap() as usize);
            let holds = items.is_none_or(|items| if word == "minItems" { items >= limit } else { items <= limit });
            unless(holds, format!("{items:?} items, and {word} is {limit}"))
        }
        "items" => {
            let items = value.as_array().into_iter().flatten().enumerate();
            items.flat_map(|(i, item)| faults(root, rule, item, &format!("{path}.{i}"))).collect()
        }
        "required" => {
            let missing = |key: &&Value| value.is_object() && value.get(key.as_str().unwrap()).is_none();
            rule.as_array().unwrap().iter().filter(missing).map(|key| format!("{path}: {key} is missing")).collect()
        }
        "properties" => {
            assert_eq!(schema["additionalProperties"], Value::Bool(false), "{path}");
            let of_key = |(key, item): (&String, &Value)| match rule.get(key) {
                None => vec![format!("{path}: unknown key {key}")],
                Some(rule) => faults(root, rule, item, &format!("{path}.{key}")),
            };
            value.as_object().into_iter().flatten().flat_map(of_key).collect()
        }
        "anyOf" => {
            let each: Vec<_> = rules().collect();
            if each.iter().any(Vec::is_empty) { Vec::new() } else { each.concat() }
        }
        "allOf" => rules().flatten().collect(),
        "$ref" => {
            let pointer = rule.as_str().unwrap().trim_start_matches('#');
            faults(root, root.pointer(pointer).unwrap(), value, path)
        }
        other => panic!("{other} is no word that this test knows"),
    }
}

fn scene_files() -> Vec<PathBuf> {
    let in_folder = |folder: &Path| -> Vec<PathBuf> {
        let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
        files.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect()
    };
    let mut files = in_folder(&root().join("data/scenes"));
    files.extend(in_folder(&root().join("data/figures")));
    files.extend(in_folder(&root().join("data/keys")));
    files
}

#[test]
fn the_schema_accepts_the_scenes_and_refuses_wrong_keys() {
    let schema = schema(&table().unwrap());
    let check = |text: &str| -> Vec<String> {
        let table: toml::Table = toml::from_str(text).unwrap();
        faults(&schema, &schema, &serde_json::to_value(table).unwrap(), "")
    };
    let files = scene_files();
    for file in &files {
        let found = check(&fs::read_to_string(file).unwrap());
        assert!(found.is_empty(), "{}: {found:?}", file.display());
    }
    assert!(files.len() > 12, "only {} scenes were found", files.len());
    let wrong = [
        ("[image]\nsise = [1, 1]", "unknown key sise"),
        ("[[light]]\ncone = 179.0", "exclusiveMaximum is 179.0"),
        ("[[light]]\nshadow = { size = 0 }", "minimum is 1"),
        ("[[light]]\nshadow = { technique = \"shadowmap\" }", "is none of"),
        ("[[object]]\nscale = 1", "\"mesh\" is missing"),
        ("[camera]\neye = [0, 1]", "Some(2) items"),
        ("[[object]]\nmesh = \"quad\"\nrotate = { axis = [0, 1, 0] }", "\"angle\" is missing"),
        ("[[object]]\nmesh = \"quad\"\nmaterial = { photo = { map = { sise = 1 } } }", "unknown key sise"),
        ("[shading]\npasses = 1", "is none of"),
    ];
    for (text, expected) in wrong {
        let found = check(text);
        assert!(found.iter().any(|fault| fault.contains(expected)), "{text}: {found:?}");
    }
}

#[test]
fn keys_are_found_by_path_by_table_and_by_part() {
    let keys = table().unwrap();
    let found = |pattern: &str| -> Vec<String> {
        find(&keys, pattern).unwrap().into_iter().map(|key| key.key.clone()).collect()
    };
    assert_eq!(found("light.0.shadow.size"), ["light.shadow.size"]);
    assert_eq!(found("size"), ["image.size", "light.shadow.size"]);
    assert!(found("light.shadow.offset").len() == 4 && found("offset").len() == 4);
    assert_eq!(found("casts-shadow"), ["object.casts_shadow"]);
    let error = find(&keys, "shadow.sise").unwrap_err().to_string();
    assert!(error.contains("did you mean `size`"), "{error}");
    assert!(find(&keys, "").is_err() && find(&keys, "0").is_err());
}

#[test]
fn who_reads_a_key_is_said() {
    let keys = table().unwrap();
    let readers = |key: &str| find(&keys, key).unwrap()[0].read_by.clone();
    assert_eq!(readers("light.shadow.average"), ["midpoint"]);
    assert_eq!(readers("light.shadow.method"), ["shadow-volume"]);
    assert_eq!(readers("light.shadow.dimming").len(), techniques::TABLE.len());
    assert_eq!(readers("light.shadow.offset.factor"), readers("light.shadow.offset"));
    assert!(readers("light.cone").is_empty());
}

#[test]
fn the_command_lists_keys_and_begins_a_scene_that_draws() {
    let work = shell::work();
    let ran = |script: &str| {
        let output = shell::run(work.path(), script);
        assert_eq!(shell::code(&output), 0, "{script}: {}", shell::text(&output.stderr));
        shell::text(&output.stdout)
    };
    let all = ran("glumbra keys");
    for key in table().unwrap() {
        assert!(all.contains(&key.key), "{} is not listed", key.key);
    }
    assert!(ran("glumbra keys cone").contains("degrees above 1 and below 179"));
    assert!(ran("glumbra keys size --json -").contains("\"read_by\""));
    ran("glumbra init first && glumbra render first/scene.toml --set image.size=[64,48] -o p.png");
    assert_eq!(shell::names(&work.path().join("first")), ["scene.toml", "schema.json"]);
    let warned = shell::run(work.path(), "glumbra render first/scene.toml -q -o p.png");
    assert_eq!(shell::text(&warned.stderr), "", "the first scene is warned of");
    shell::refused(&[
        ("twice", "glumbra init first && glumbra init first", 1, "first/scene.toml: is there already"),
        ("no such key", "glumbra keys kernal", 1, "did you mean `kernel`?"),
        ("two forms", "glumbra keys --markdown --schema", 2, "cannot be used with"),
    ]);
}
