//! JSON text to [`Settings`], as `parse.rs` does for TOML. The grammar is that of `serde_json`; it knows no meaning of keys.

use std::fmt;

use serde::de::{self, DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};

use super::Error;
use super::parse::shown;
use super::settings::{Entry, Origin, Settings, Value};

/// The object of one line. `name` is its dotted name for messages, `origin` the line's place.
pub(super) fn table(name: &str, line: &str, origin: &Origin) -> Result<Settings, Error> {
    let wrong = |error: &serde_json::Error| {
        let written = error.to_string();
        // The place is the line's, not that of the text that was read.
        let what = written.split(" at line ").next().unwrap_or(&written);
        let message = format!("{what}, in column {}; expected a JSON object a line", error.column());
        Error::Syntax { origin: origin.clone(), message, text: shown(line) }
    };
    let mut source = serde_json::Deserializer::from_str(line);
    let read = Table { name, origin }.deserialize(&mut source);
    read.and_then(|table| source.end().map(|()| table)).map_err(|error| wrong(&error))
}

/// Reads an object.
#[derive(Clone, Copy)]
struct Table<'a> {
    name: &'a str,
    origin: &'a Origin,
}

/// Reads a value of any kind; `name` is the dotted name of its key.
#[derive(Clone, Copy)]
struct Any<'a> {
    name: &'a str,
    origin: &'a Origin,
}

impl<'de> DeserializeSeed<'de> for Table<'_> {
    type Value = Settings;

    fn deserialize<D: Deserializer<'de>>(self, source: D) -> Result<Settings, D::Error> {
        source.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Table<'_> {
    type Value = Settings;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an object")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Settings, M::Error> {
        let mut table = Settings { path: self.name.to_owned(), origin: self.origin.clone(), entries: Vec::new() };
        while let Some(key) = map.next_key::<String>()? {
            if table.get(&key).is_some() {
                return Err(de::Error::custom(format_args!("key `{key}` comes twice")));
            }
            let value = map.next_value_seed(Any { name: &table.key(&key), origin: self.origin })?;
            table.entries.push((key, Entry { value, origin: self.origin.clone() }));
        }
        Ok(table)
    }
}

impl<'de> DeserializeSeed<'de> for Any<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, source: D) -> Result<Value, D::Error> {
        source.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Any<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a number, a string, true, false, an array or an object")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Boolean(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(Value::Integer(value))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Value, E> {
        let out_of_range = |_| E::custom(format_args!("`{}` is out of range: {value}", self.name));
        i64::try_from(value).map(Value::Integer).map_err(out_of_range)
    }

    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(Value::Float(value))
    }

    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(Value::String(text.to_owned()))
    }

    fn visit_seq<S: SeqAccess<'de>>(self, mut items: S) -> Result<Value, S::Error> {
        let mut array = Vec::new();
        while let Some(value) = items.next_element_seed(self)? {
            array.push(Entry { value, origin: self.origin.clone() });
        }
        Ok(Value::Array(array))
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<Value, M::Error> {
        Table { name: self.name, origin: self.origin }.visit_map(map).map(Value::Table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> Result<String, String> {
        table("t", line, &Origin::BuiltIn).map(|table| table.to_toml()).map_err(|error| error.to_string())
    }

    #[test]
    fn values_are_those_of_toml() {
        let toml = read("{\"z\": [1, -2.5, 1e300], \"a\": {\"b\": true, \"c\": \"\\u00e9\"}, \"e\": []}").unwrap();
        assert_eq!(toml, "z = [1, -2.5, 1e300]\ne = []\n\n[a]\nb = true\nc = \"é\"\n");
    }

    #[test]
    fn what_is_no_object_is_refused_with_its_column() {
        for (line, expected) in [
            ("[1, 2]", "invalid type: sequence, expected an object, in column"),
            ("{\"a\": 1", "EOF while parsing an object, in column 7"),
            ("{\"a\": null}", "invalid type: null, expected a number"),
            ("{\"a\": 1, \"a\": 2}", "key `a` comes twice"),
            ("{\"a\": 18446744073709551615}", "`t.a` is out of range: 18446744073709551615"),
            ("{} {}", "trailing characters, in column 4"),
            ("{\"a\": 1e999}", "number out of range"),
        ] {
            let error = read(line).unwrap_err();
            assert!(error.contains(expected) && error.ends_with(&format!("\n  {line}")), "{error}");
        }
    }
}
