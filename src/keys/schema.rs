//! The table of keys as a JSON schema, by which editors complete and check a scene file.

use std::ops::RangeInclusive;

use serde_json::{Map, Value, json};

use super::{Absent, Key};
use crate::scene::ValueForm;

/// Schema dialect that editors of TOML read.
const DIALECT: &str = "http://json-schema.org/draft-07/schema#";

/// The schema of a scene file.
pub fn schema(keys: &[Key]) -> Value {
    let mut root = table(keys, "");
    if let Value::Object(root) = &mut root {
        root.insert(String::from("$schema"), json!(DIALECT));
        root.insert(String::from("title"), json!("glumbra scene"));
        root.insert(String::from("definitions"), json!({ "shadow": table(keys, "light.shadow.") }));
    }
    root
}

/// A table whose keys begin with `prefix`.
fn table(keys: &[Key], prefix: &str) -> Value {
    let own = keys.iter().filter_map(|key| Some((key.key.strip_prefix(prefix)?, key)));
    let own = own.filter(|(name, _)| !name.contains('.'));
    let mut properties = Map::new();
    let mut required = Vec::new();
    for (name, key) in own {
        properties.insert(name.to_owned(), property(keys, key));
        if key.absent == Absent::Needed && !prefix.is_empty() {
            required.push(name);
        }
    }
    // A file that others include need not be whole.
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

fn property(keys: &[Key], key: &Key) -> Value {
    let mut schema = match key.key.as_str() {
        "light.shadow" | "object.material.photo.map" => json!({ "allOf": [{ "$ref": "#/definitions/shadow" }] }),
        _ => values(keys, key),
    };
    let notes = match &key.absent {
        Absent::Needed | Absent::Default(_) => String::new(),
        Absent::Words(words) => format!("\nWhere it is not written: {words}."),
    };
    let by = if key.read_by.is_empty() { String::new() } else { format!("\nRead by {}.", key.read_by.join(", ")) };
    if let Value::Object(schema) = &mut schema {
        schema.insert(String::from("description"), json!(format!("{}\nValues: {}.{notes}{by}", key.is, key.values)));
        if let Some(default) = default(key) {
            schema.insert(String::from("default"), default);
        }
    }
    schema
}

/// The default as JSON.
fn default(key: &Key) -> Option<Value> {
    let Absent::Default(text) = &key.absent else { return None };
    let table: toml::Table = toml::from_str(&format!("value = {text}")).ok()?;
    serde_json::to_value(table.get("value")?).ok()
}

fn values(keys: &[Key], key: &Key) -> Value {
    let prefix = format!("{}.", key.key);
    let has_keys = keys.iter().any(|other| other.key.starts_with(&prefix));
    let object = || table(keys, &prefix);
    let forms: Vec<Value> = key.forms.iter().map(|form| self::form(form, &object)).collect();
    let is_told_apart = key.forms.contains(&ValueForm::Any) || forms.is_empty();
    match forms.as_slice() {
        _ if is_told_apart && !has_keys => json!({}),
        _ if is_told_apart => {
            let plain = json!({ "type": ["string", "number", "boolean"] });
            json!({ "anyOf": [plain, object(), { "type": "array", "items": { "anyOf": [plain, object()] } }] })
        }
        [one] => one.clone(),
        several => json!({ "anyOf": several }),
    }
}

fn form(form: &ValueForm, object: &dyn Fn() -> Value) -> Value {
    match form {
        ValueForm::Any => json!({}),
        ValueForm::Text | ValueForm::File => json!({ "type": "string" }),
        ValueForm::Boolean => json!({ "type": "boolean" }),
        ValueForm::Integer(range) => json!({ "type": "integer", "minimum": range.start(), "maximum": range.end() }),
        ValueForm::Number(range) => number(range),
        ValueForm::Length => json!({ "type": "number", "exclusiveMinimum": 0 }),
        ValueForm::Angle([low, high]) => json!({ "type": "number", "exclusiveMinimum": low, "exclusiveMaximum": high }),
        ValueForm::Numbers(count, range) => {
            json!({ "type": "array", "items": number(range), "minItems": count, "maxItems": count })
        }
        ValueForm::Choice(names) => json!({ "enum": names }),
        ValueForm::Table => object(),
        ValueForm::Tables => json!({ "type": "array", "items": object() }),
    }
}

/// A number in a range; f64's limits are no bounds.
fn number(range: &RangeInclusive<f64>) -> Value {
    let mut schema = json!({ "type": "number" });
    if *range.start() > f64::MIN {
        schema["minimum"] = json!(range.start());
    }
    if *range.end() < f64::MAX {
        schema["maximum"] = json!(range.end());
    }
    schema
}
