//! Which file of a library uses which: read from its `mod`, `use` and paths, without the compiler.
//!
//! Modules that are compiled for tests only are left out. Paths in macros are found as text.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs;
use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};

/// A module's path from the root, without `crate`.
pub type Module = Vec<String>;

/// Contents of one file.
#[derive(Default)]
pub struct File {
    /// Below `src`.
    pub path: String,
    pub is_unsafe: bool,
    pub names_gl: bool,
    /// Names that its `use` lines bring in, and what they mean.
    imports: HashMap<String, Module>,
    children: BTreeSet<String>,
    /// Absolute paths that it names.
    named: BTreeSet<Module>,
    /// Types, traits and type aliases that other files can name.
    pub types: BTreeSet<String>,
}

impl File {
    /// Folder of the file, below `src`; a file directly in `src` is a folder of its own.
    pub fn folder(&self) -> PathBuf {
        match Path::new(&self.path).parent() {
            Some(folder) if folder != Path::new("") => folder.to_path_buf(),
            _ => Path::new(&self.path).with_extension(""),
        }
    }
}

/// A library by its modules.
#[derive(Default)]
pub struct Code {
    pub files: BTreeMap<Module, File>,
}

/// One file's use of another.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Arrow {
    pub from: Module,
    pub to: Module,
    /// The path that names it.
    pub path: String,
}

impl Code {
    /// Reads the library whose root is `lib.rs` in `folder`.
    pub fn read(folder: &Path) -> Self {
        let mut code = Self::default();
        code.read_file(folder, &folder.join("lib.rs"), Module::new());
        code
    }

    fn read_file(&mut self, root: &Path, path: &Path, module: Module) {
        let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let syntax = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let name = path.strip_prefix(root).unwrap().display().to_string();
        let mut reader =
            Reader { file: File { path: name, ..File::default() }, module: module.clone(), found: Vec::new() };
        reader.visit_file(&syntax);
        let Reader { mut file, found, .. } = reader;
        for names in found {
            file.named.extend(absolute(&names, &module, &file));
        }
        let folder = match path.file_name().unwrap().to_str() {
            Some("lib.rs" | "mod.rs") => path.parent().unwrap().to_path_buf(),
            _ => path.with_extension(""),
        };
        let children = file.children.clone();
        self.files.insert(module.clone(), file);
        for child in children {
            let places: [PathBuf; 2] = [folder.join(format!("{child}.rs")), folder.join(&child).join("mod.rs")];
            let place = places.iter().find(|place| place.exists()).unwrap_or_else(|| panic!("no file of {child}"));
            self.read_file(root, place, [module.as_slice(), &[child]].concat());
        }
    }

    /// Every use of another file, each once.
    pub fn arrows(&self) -> BTreeSet<Arrow> {
        let mut arrows = BTreeSet::new();
        for (from, file) in &self.files {
            for path in &file.named {
                let to = self.file_of(path, 0);
                if to != *from && !to.is_empty() {
                    arrows.insert(Arrow { from: from.clone(), to, path: path.join("::") });
                }
            }
        }
        arrows
    }

    /// The module in whose file a path ends, through what other modules re-export.
    fn file_of(&self, path: &[String], depth: usize) -> Module {
        let mut module = Module::new();
        for (index, name) in path.iter().enumerate() {
            let longer = [module.as_slice(), std::slice::from_ref(name)].concat();
            if self.files.contains_key(&longer) {
                module = longer;
                continue;
            }
            match self.files[&module].imports.get(name) {
                Some(target) if depth < 8 => {
                    return self.file_of(&[target.as_slice(), &path[index + 1..]].concat(), depth + 1);
                }
                _ => return module,
            }
        }
        module
    }

    /// Sets of files that use each other in a circle. A folder's `mod.rs` is its head: that a file of the folder uses what
    /// the head has is no circle.
    pub fn circles(&self) -> Vec<Vec<Arrow>> {
        let arrows: Vec<Arrow> =
            self.arrows().into_iter().filter(|arrow| !arrow.from.starts_with(arrow.to.as_slice())).collect();
        let mut next: BTreeMap<&Module, BTreeSet<&Module>> = BTreeMap::new();
        for arrow in &arrows {
            next.entry(&arrow.from).or_default().insert(&arrow.to);
        }
        let mut reached: BTreeMap<&Module, BTreeSet<&Module>> = BTreeMap::new();
        for start in self.files.keys() {
            let mut open = vec![start];
            let seen = reached.entry(start).or_default();
            while let Some(at) = open.pop() {
                open.extend(next.get(at).into_iter().flatten().filter(|to| seen.insert(to)));
            }
        }
        let mut circles: Vec<Vec<Arrow>> = Vec::new();
        let mut done: BTreeSet<&Module> = BTreeSet::new();
        for start in self.files.keys().filter(|start| reached[start].contains(start)) {
            if done.contains(start) {
                continue;
            }
            let together = |other: &Module| reached[start].contains(other) && reached[other].contains(start);
            let circle: Vec<Arrow> =
                arrows.iter().filter(|arrow| together(&arrow.from) && together(&arrow.to)).cloned().collect();
            done.extend(self.files.keys().filter(|other| together(other)));
            circles.push(circle);
        }
        circles
    }
}

/// A path as a file has it, from the root. `None`: it names another crate or something local.
fn absolute(names: &[String], module: &[String], file: &File) -> Option<Module> {
    let first = names.first()?;
    let mut base = module.to_vec();
    let mut rest = names;
    match first.as_str() {
        "crate" => return Some(names[1..].to_vec()),
        "self" => rest = &names[1..],
        "super" => {
            while rest.first().is_some_and(|name| name == "super") {
                base.pop()?;
                rest = &rest[1..];
            }
        }
        name if file.children.contains(name) => {}
        name => {
            let target = file.imports.get(name)?;
            return Some([target.as_slice(), &names[1..]].concat());
        }
    }
    base.extend(rest.iter().cloned());
    Some(base)
}

struct Reader {
    file: File,
    module: Module,
    found: Vec<Vec<String>>,
}

impl Reader {
    fn use_tree(&mut self, tree: &syn::UseTree, before: &[String]) {
        match tree {
            syn::UseTree::Path(path) => self.use_tree(&path.tree, &[before, &[path.ident.to_string()]].concat()),
            syn::UseTree::Group(group) => group.items.iter().for_each(|item| self.use_tree(item, before)),
            syn::UseTree::Glob(_) => self.found.push(before.to_vec()),
            syn::UseTree::Name(name) if name.ident == "self" => {
                self.import(before.last().cloned().unwrap_or_default(), before.to_vec());
            }
            syn::UseTree::Name(name) => {
                let name = name.ident.to_string();
                self.import(name.clone(), [before, &[name]].concat());
            }
            syn::UseTree::Rename(rename) => {
                self.import(rename.rename.to_string(), [before, &[rename.ident.to_string()]].concat());
            }
        }
    }

    fn import(&mut self, name: String, path: Vec<String>) {
        self.note_gl(&path);
        if let Some(target) = absolute(&path, &self.module, &self.file) {
            self.file.imports.insert(name, target);
        }
        self.found.push(path);
    }

    fn note_gl(&mut self, path: &[String]) {
        self.file.names_gl |= path.first().is_some_and(|name| name == "glow");
    }
}

fn is_for_tests(attributes: &[syn::Attribute]) -> bool {
    let is_test = |attribute: &syn::Attribute| {
        attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Path>().is_ok_and(|path| path.is_ident("test"))
    };
    attributes.iter().any(is_test)
}

impl<'a> Visit<'a> for Reader {
    fn visit_file(&mut self, file: &'a syn::File) {
        for item in &file.items {
            if let syn::Item::Mod(child) = item
                && child.content.is_none()
                && !is_for_tests(&child.attrs)
            {
                self.file.children.insert(child.ident.to_string());
            }
            let named = match item {
                syn::Item::Struct(item) => Some((&item.vis, &item.ident)),
                syn::Item::Enum(item) => Some((&item.vis, &item.ident)),
                syn::Item::Union(item) => Some((&item.vis, &item.ident)),
                syn::Item::Trait(item) => Some((&item.vis, &item.ident)),
                syn::Item::Type(item) => Some((&item.vis, &item.ident)),
                _ => None,
            };
            self.file.types.extend(
                named.filter(|(vis, _)| !matches!(vis, syn::Visibility::Inherited)).map(|(_, name)| name.to_string()),
            );
        }
        visit::visit_file(self, file);
    }

    fn visit_item_mod(&mut self, item: &'a syn::ItemMod) {
        if !is_for_tests(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        if !is_for_tests(&item.attrs) {
            self.use_tree(&item.tree, &[]);
        }
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.note_gl(&names);
        if names.len() > 1 {
            self.found.push(names);
        }
        visit::visit_path(self, path);
    }

    fn visit_visibility(&mut self, _: &'a syn::Visibility) {}

    fn visit_attribute(&mut self, _: &'a syn::Attribute) {}

    fn visit_macro(&mut self, item: &'a syn::Macro) {
        visit::visit_macro(self, item);
        let text = item.tokens.to_string().replace(" :: ", "::");
        let part_of_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
        for words in text.split(|c: char| !part_of_path(c)).filter(|words| words.contains("::")) {
            let names: Vec<String> = words.split("::").map(str::to_owned).collect();
            self.note_gl(&names);
            self.found.push(names);
        }
    }

    fn visit_expr_unsafe(&mut self, block: &'a syn::ExprUnsafe) {
        self.file.is_unsafe = true;
        visit::visit_expr_unsafe(self, block);
    }

    fn visit_signature(&mut self, signature: &'a syn::Signature) {
        self.file.is_unsafe |= signature.unsafety.is_some();
        visit::visit_signature(self, signature);
    }

    fn visit_item_impl(&mut self, item: &'a syn::ItemImpl) {
        self.file.is_unsafe |= item.unsafety.is_some();
        visit::visit_item_impl(self, item);
    }
}
