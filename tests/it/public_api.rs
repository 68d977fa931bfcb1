//! The library's front: what a program outside can name without a hidden module. `data/public-api.txt` lists it, so that a
//! change is seen; `GLUMBRA_BLESS=1 cargo test --test it public_api` writes it, and fails.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use syn::{Attribute, Item, Visibility};

/// Most items outside of the prelude.
const MOST_ITEMS: usize = 100;

const LIST: &str = "data/public-api.txt";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn parse(path: &Path) -> syn::File {
    syn::parse_file(&fs::read_to_string(path).unwrap()).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn is_public(vis: &Visibility) -> bool {
    matches!(vis, Visibility::Public(_))
}

fn is_hidden(attributes: &[Attribute]) -> bool {
    let is_hidden = |attribute: &&Attribute| {
        attribute.path().is_ident("doc")
            && attribute.parse_args::<syn::Path>().is_ok_and(|word| word.is_ident("hidden"))
    };
    attributes.iter().find(is_hidden).is_some()
}

fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Path>().is_ok_and(|word| word.is_ident("test"))
    })
}

/// The file of module `name` in `folder`, and the folder of its own modules.
fn file_of(folder: &Path, name: &str) -> (PathBuf, PathBuf) {
    let (flat, deep) = (folder.join(format!("{name}.rs")), folder.join(name).join("mod.rs"));
    (if flat.exists() { flat } else { deep }, folder.join(name))
}

/// Fields, variants, methods of a type by its module and name, wherever in that module its definition and its `impl` blocks
/// stand; an `impl` elsewhere names the module.
#[derive(Default)]
struct Members {
    module: String,
    types: BTreeMap<[String; 2], BTreeSet<String>>,
}

impl Members {
    /// Reads a module's files, private ones too: what they define may be exported elsewhere.
    fn read(&mut self, folder: &Path, file: &Path) {
        for item in parse(file).items {
            let key = |name: &syn::Ident| [self.module.clone(), name.to_string()];
            match &item {
                Item::Mod(child) if child.content.is_none() && !is_for_tests(&child.attrs) => {
                    let (file, folder) = file_of(folder, &child.ident.to_string());
                    self.read(&folder, &file);
                }
                Item::Struct(item) => {
                    let fields = item.fields.iter().filter(|field| is_public(&field.vis));
                    let fields = fields.enumerate().map(|(index, field)| {
                        field.ident.as_ref().map_or_else(|| index.to_string(), ToString::to_string)
                    });
                    self.types.entry(key(&item.ident)).or_default().extend(fields);
                }
                Item::Enum(item) => {
                    let variants = item.variants.iter().map(|variant| variant.ident.to_string());
                    self.types.entry(key(&item.ident)).or_default().extend(variants);
                }
                Item::Trait(item) => {
                    let functions = item.items.iter().filter_map(|inner| match inner {
                        syn::TraitItem::Fn(function) => Some(format!("{}()", function.sig.ident)),
                        _ => None,
                    });
                    self.types.entry(key(&item.ident)).or_default().extend(functions);
                }
                Item::Impl(block) if block.trait_.is_none() => self.read_methods(block),
                _ => {}
            }
        }
    }

    fn read_methods(&mut self, block: &syn::ItemImpl) {
        let syn::Type::Path(path) = &*block.self_ty else { return };
        let names: Vec<String> = path.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        let key = match names.as_slice() {
            [name] => [self.module.clone(), name.clone()],
            [.., module, name] => [module.clone(), name.clone()],
            [] => return,
        };
        let public = block.items.iter().filter_map(|item| match item {
            syn::ImplItem::Fn(item) if is_public(&item.vis) && !is_hidden(&item.attrs) => {
                Some(format!("{}()", item.sig.ident))
            }
            syn::ImplItem::Const(item) if is_public(&item.vis) => Some(item.ident.to_string()),
            _ => None,
        });
        self.types.entry(key).or_default().extend(public);
    }
}

/// Public names of the library.
#[derive(Default)]
struct Front {
    items: BTreeSet<String>,
    /// Modules of the root that they and their methods are defined in, hidden ones too.
    modules: BTreeSet<String>,
}

impl Front {
    fn read(&mut self, folder: &Path, file: &Path, module: &str) {
        for item in parse(file).items {
            let (vis, attributes, name) = match &item {
                Item::Mod(child) if child.content.is_none() => {
                    if is_public(&child.vis) && !is_hidden(&child.attrs) {
                        let name = child.ident.to_string();
                        if module.is_empty() {
                            self.modules.insert(name.clone());
                        }
                        let (file, folder) = file_of(folder, &name);
                        self.read(&folder, &file, &format!("{module}{name}::"));
                    }
                    continue;
                }
                Item::Use(item) => {
                    if is_public(&item.vis) && !is_hidden(&item.attrs) {
                        self.read_use(&item.tree, module);
                    }
                    continue;
                }
                Item::Struct(item) => (&item.vis, &item.attrs, &item.ident),
                Item::Enum(item) => (&item.vis, &item.attrs, &item.ident),
                Item::Trait(item) => (&item.vis, &item.attrs, &item.ident),
                Item::Type(item) => (&item.vis, &item.attrs, &item.ident),
                Item::Const(item) => (&item.vis, &item.attrs, &item.ident),
                Item::Static(item) => (&item.vis, &item.attrs, &item.ident),
                Item::Fn(item) => (&item.vis, &item.attrs, &item.sig.ident),
                _ => continue,
            };
            if is_public(vis) && !is_hidden(attributes) {
                self.items.insert(format!("{module}{name}"));
            }
        }
    }

    fn read_use(&mut self, tree: &syn::UseTree, module: &str) {
        match tree {
            syn::UseTree::Path(path) => {
                if let (true, syn::UseTree::Path(next)) = (path.ident == "crate", &*path.tree) {
                    self.modules.insert(next.ident.to_string());
                }
                self.read_use(&path.tree, module);
            }
            syn::UseTree::Group(group) => group.items.iter().for_each(|tree| self.read_use(tree, module)),
            syn::UseTree::Name(name) if name.ident == "self" => {}
            syn::UseTree::Name(name) => drop(self.items.insert(format!("{module}{}", name.ident))),
            syn::UseTree::Rename(name) => drop(self.items.insert(format!("{module}{}", name.rename))),
            syn::UseTree::Glob(_) => panic!("{module} exports with `*`: nobody sees what"),
        }
    }
}

/// The names, a line each, with the members of types.
fn listed() -> Vec<String> {
    let src = root().join("src");
    let mut front = Front::default();
    front.read(&src, &src.join("lib.rs"), "");
    let mut members = Members::default();
    // Builders are built where shadow settings are read.
    front.modules.insert(String::from("techniques"));
    for module in &front.modules {
        let (file, folder) = file_of(&src, module);
        members.module.clone_from(module);
        members.read(&folder, &file);
    }
    let line = |path: &String| {
        let name = path.rsplit("::").next().unwrap_or(path);
        let module = path.split("::").next().unwrap_or(path);
        // What another module defines has a name of its own.
        let mut found = members.types.iter().filter(|([_, type_name], _)| type_name == name);
        let own = members.types.get(&[module.to_owned(), name.to_owned()]);
        let inner = own.or_else(|| found.next().map(|(_, inner)| inner));
        let inner = inner.filter(|inner| !inner.is_empty() && module != "prelude");
        inner.map_or_else(
            || path.clone(),
            |inner| format!("{path}: {}", inner.iter().cloned().collect::<Vec<_>>().join(" ")),
        )
    };
    front.items.iter().map(line).collect()
}

#[test]
fn the_front_is_as_it_is_listed() {
    let now = listed().join("\n") + "\n";
    if std::env::var_os("GLUMBRA_BLESS").is_some_and(|value| value == "1") {
        fs::write(root().join(LIST), &now).unwrap();
        panic!("{LIST} is written; look at its changes, then test again");
    }
    let kept = fs::read_to_string(root().join(LIST)).unwrap_or_default();
    let [kept, now] = [&kept, &now].map(|text| text.lines().collect::<BTreeSet<_>>());
    let changes = kept.difference(&now).map(|line| format!("- {line}"));
    let changes: Vec<String> = changes.chain(now.difference(&kept).map(|line| format!("+ {line}"))).collect();
    assert!(changes.is_empty(), "the public API differs from {LIST}:\n{}", changes.join("\n"));
}

#[test]
fn the_front_is_small() {
    let count = listed().iter().filter(|line| !line.starts_with("prelude::")).count();
    assert!(count <= MOST_ITEMS, "{count} items outside of the prelude; hide what only the command and the tests need");
    assert!(count > 30, "{count} items: the list misses some");
}
