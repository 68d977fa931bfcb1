//! Cases below folders, and the choice of some by name or by shard.

use std::path::{Path, PathBuf};

use super::Error;
use super::read::FILE;

/// A folder with a `case.toml`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundCase {
    /// The folder.
    pub folder: PathBuf,
    /// Its path below the folder that was given, with `/`; the given folder's own name where it is the case.
    pub name: String,
}

/// Finds each `case.toml` at or below `folders`, sorted by name. Hidden folders are left out, and links to folders are
/// followed only where they are given themselves.
///
/// # Errors
///
/// A folder that cannot be read, a name that is not UTF-8, two cases of one name, no case.
pub fn find(folders: &[PathBuf]) -> Result<Vec<FoundCase>, Error> {
    let mut found = Vec::new();
    for root in folders {
        search(root, root, &mut found)?;
    }
    found.sort_by(|a: &FoundCase, b| a.name.cmp(&b.name));
    // One folder that was given twice.
    found.dedup_by(|a, b| a.name == b.name && is_same(&a.folder, &b.folder));
    if let Some([first, second]) = found.windows(2).find(|pair| pair[0].name == pair[1].name) {
        let name = first.name.clone();
        return Err(Error::SameName { first: first.folder.clone(), second: second.folder.clone(), name });
    }
    match found.is_empty() {
        true => Err(Error::NoCases { folders: folders.to_vec() }),
        false => Ok(found),
    }
}

fn is_same(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

fn search(root: &Path, folder: &Path, found: &mut Vec<FoundCase>) -> Result<(), Error> {
    let failed = |reason| Error::Folder { path: folder.to_owned(), reason };
    if folder.join(FILE).is_file() {
        found.push(FoundCase { folder: folder.to_owned(), name: name_of(root, folder)? });
    }
    for entry in folder.read_dir().map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let is_hidden = entry.file_name().as_encoded_bytes().starts_with(b".");
        if !is_hidden && entry.file_type().map_err(failed)?.is_dir() {
            search(root, &entry.path(), found)?;
        }
    }
    Ok(())
}

fn name_of(root: &Path, folder: &Path) -> Result<String, Error> {
    let no_text = || Error::NoText { path: folder.to_owned() };
    // A child process is told the folder as text.
    folder.to_str().ok_or_else(no_text)?;
    let below = folder.strip_prefix(root).unwrap_or(folder);
    if below.as_os_str().is_empty() {
        let own = root.canonicalize().unwrap_or_else(|_| root.to_owned());
        let name = own.file_name().unwrap_or(own.as_os_str());
        return name.to_str().map(str::to_owned).ok_or_else(no_text);
    }
    let parts = below.components().map(|part| part.as_os_str().to_str());
    parts.collect::<Option<Vec<_>>>().map(|parts| parts.join("/")).ok_or_else(no_text)
}

/// Keeps the cases whose name has one of `filters`, or with `exact` is one of them; all where there is no filter.
///
/// # Errors
///
/// No case is left.
pub fn choose(cases: Vec<FoundCase>, filters: &[String], exact: bool) -> Result<Vec<FoundCase>, Error> {
    let of = cases.len();
    let is_wanted = |name: &str| {
        let has = |filter: &String| if exact { name == filter } else { name.contains(filter.as_str()) };
        filters.is_empty() || filters.iter().any(has)
    };
    let left: Vec<FoundCase> = cases.into_iter().filter(|case| is_wanted(&case.name)).collect();
    match left.is_empty() {
        true => Err(Error::NoneLeft { of, filters: filters.to_vec() }),
        false => Ok(left),
    }
}

/// The cases of part `index`, from 1, of `count`: each case is in exactly one part, and parts differ by one case at most.
pub fn shard(cases: Vec<FoundCase>, (index, count): (usize, usize)) -> Vec<FoundCase> {
    cases.into_iter().skip(index.saturating_sub(1)).step_by(count.max(1)).collect()
}
