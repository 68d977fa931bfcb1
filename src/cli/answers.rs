//! Parts that `compare` and `judge` share: an answer as text or JSON, and the texts of pictures.

use std::path::Path;

use serde::Serialize;

use super::Error;
use super::json::JsonArgs;
use crate::output::{self, FileFormat};

/// Writes the JSON of `command`, and prints the text where standard output is not for the JSON.
pub fn answer(
    json: &JsonArgs,
    command: &str,
    value: &impl Serialize,
    text: impl FnOnce() -> String,
) -> Result<(), Error> {
    json.write(command, value)?;
    if json.takes_standard_output() { Ok(()) } else { super::print(&text()) }
}

/// Checks the name of a picture to write: a PNG, and none of the files that are read.
pub fn check_png(path: &Path, read: &[&Path]) -> Result<(), Error> {
    if output::check_path(path)? != FileFormat::Png {
        return Err(Error::NotPng { path: path.to_owned() });
    }
    match read.iter().any(|read| output::is_same_file(path, read)) {
        true => Err(Error::IsRead { path: path.to_owned() }),
        false => Ok(()),
    }
}

/// Keywords of two pictures' texts that differ, with what each says; "nothing" where one does not have it.
pub fn difference_of_texts(actual: &[(String, String)], expected: &[(String, String)]) -> Vec<[String; 3]> {
    let text_of = |texts: &[(String, String)], keyword: &str| {
        texts.iter().find(|(known, _)| known == keyword).map(|(_, text)| text.clone())
    };
    let mut keywords: Vec<&String> = Vec::new();
    for (keyword, _) in actual.iter().chain(expected) {
        if !keywords.contains(&keyword) {
            keywords.push(keyword);
        }
    }
    let differing = keywords.into_iter().filter_map(|keyword| {
        let both = [actual, expected].map(|texts| text_of(texts, keyword));
        let [actual, expected] = both.clone().map(|text| text.unwrap_or_else(|| String::from("nothing")));
        (both[0] != both[1]).then(|| [keyword.clone(), actual, expected])
    });
    differing.collect()
}
