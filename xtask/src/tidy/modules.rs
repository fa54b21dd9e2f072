//! Module circles: sibling modules of any folder look downwards only.
//!
//! Every path that starts at `crate`, `self`, `super` or a name brought in by `use` is followed to the module that
//! defines what it names, through re-exports. Where the paths of two modules part, the two siblings get an arrow. A
//! module may use what its own ancestors define, and an ancestor its descendants; tests may look anywhere.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};

use super::{is_test, read};

/// Module path inside its crate; empty for the root.
type ModulePath = Vec<String>;

/// Longest chain of re-exports that is followed.
const LONGEST_CHAIN: usize = 16;

/// One module as read.
#[derive(Default)]
struct Module {
    file: PathBuf,
    children: BTreeSet<String>,
    /// Names that `use` brings in and the paths they stand for, as written.
    aliases: BTreeMap<String, Vec<String>>,
    /// Every path of the module that may lead to another one, with its line.
    paths: Vec<(Vec<String>, usize)>,
    /// Types with an inherent `impl` here, with its line.
    impls: Vec<(String, usize)>,
}

/// All modules of one crate.
pub(super) struct Modules {
    modules: BTreeMap<ModulePath, Module>,
}

impl Modules {
    /// Reads the crate with the root file `root` (`lib.rs` or `main.rs`).
    pub(super) fn read(root: &Path) -> Result<Self, String> {
        let mut all = Self {
            modules: BTreeMap::new(),
        };
        let folder = root.parent().unwrap_or(root).to_path_buf();
        all.read_file(root, &folder, Vec::new())?;
        Ok(all)
    }

    fn read_file(&mut self, file: &Path, folder: &Path, path: ModulePath) -> Result<(), String> {
        let text = read(file)?;
        let parsed = syn::parse_file(&text).map_err(|e| format!("{}: {e}", file.display()))?;
        self.read_items(file, folder, path, &parsed.items)
    }

    fn read_items(
        &mut self,
        file: &Path,
        folder: &Path,
        path: ModulePath,
        items: &[syn::Item],
    ) -> Result<(), String> {
        let mut module = Module {
            file: file.to_path_buf(),
            ..Module::default()
        };
        for item in items {
            let syn::Item::Mod(child) = item else {
                Collector(&mut module).visit_item(item);
                continue;
            };
            let name = child.ident.to_string();
            if is_test(&child.attrs) || name == "tests" {
                continue;
            }
            module.children.insert(name.clone());
            let mut below = path.clone();
            below.push(name.clone());
            let inner = folder.join(&name);
            match &child.content {
                Some((_, items)) => self.read_items(file, &inner, below, items)?,
                None => self.read_file(&folder.join(format!("{name}.rs")), &inner, below)?,
            }
        }
        self.modules.insert(path, module);
        Ok(())
    }

    /// One line for each circle, with an arrow of it and the line that draws that arrow.
    pub(super) fn circles(&self, root: &Path) -> Vec<String> {
        let mut arrows: BTreeMap<ModulePath, Graph> = BTreeMap::new();
        for (from, module) in &self.modules {
            for (written, line) in &module.paths {
                let Some(to) = self.resolve(from, written, 0) else {
                    continue;
                };
                let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
                if common < from.len() && common < to.len() {
                    let shown = super::shown(&module.file, root);
                    arrows
                        .entry(from[..common].to_vec())
                        .or_default()
                        .entry(from[common].clone())
                        .or_default()
                        .entry(to[common].clone())
                        .or_insert_with(|| format!("{shown}:{line}"));
                }
            }
        }
        arrows
            .iter()
            .flat_map(|(parent, graph)| circles_of(parent, graph))
            .collect()
    }

    /// Inherent `impl`s that stand outside the module of their type and of its descendants.
    pub(super) fn scattered_impls(&self, root: &Path) -> Vec<String> {
        let mut faults = Vec::new();
        for (from, module) in &self.modules {
            for (name, line) in &module.impls {
                let home = self.resolve(from, std::slice::from_ref(name), 0);
                if home.is_some_and(|home| !from.starts_with(&home)) {
                    let shown = super::shown(&module.file, root);
                    faults.push(format!(
                        "{shown}:{line}: `impl {name}` belongs to the file of {name}"
                    ));
                }
            }
        }
        faults
    }

    /// The module that defines what `written` names when it stands in `from`; `None` for other crates and for locals.
    fn resolve(&self, from: &ModulePath, written: &[String], depth: usize) -> Option<ModulePath> {
        let mut at = from.clone();
        let mut rest = written;
        let mut absolute = false;
        while let Some((first, tail)) = rest.split_first() {
            match first.as_str() {
                "crate" => at.clear(),
                "self" => {}
                "super" => drop(at.pop()),
                _ => break,
            }
            absolute = true;
            rest = tail;
        }
        let Some((first, _)) = rest.split_first() else {
            return absolute.then_some(at);
        };
        let module = self.modules.get(&at)?;
        if !absolute && !module.children.contains(first) && !module.aliases.contains_key(first) {
            return None;
        }
        self.descend(at, rest, depth)
    }

    fn descend(&self, mut at: ModulePath, names: &[String], depth: usize) -> Option<ModulePath> {
        for (i, name) in names.iter().enumerate() {
            let module = self.modules.get(&at)?;
            if module.children.contains(name) {
                at.push(name.clone());
                continue;
            }
            if let Some(alias) = module.aliases.get(name)
                && depth < LONGEST_CHAIN
            {
                let mut path = alias.clone();
                path.extend_from_slice(&names[i + 1..]);
                // A name of another crate is nobody's here.
                return self.resolve(&at, &path, depth + 1);
            }
            return Some(at);
        }
        Some(at)
    }
}

/// Arrows between siblings: from, to, the line that draws it.
type Graph = BTreeMap<String, BTreeMap<String, String>>;

/// Whether `to` can be reached from `from`.
fn reaches(graph: &Graph, from: &str, to: &str) -> bool {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(next) = open.pop() {
        for target in graph.get(next).into_iter().flat_map(BTreeMap::keys) {
            if target == to {
                return true;
            }
            if seen.insert(target) {
                open.push(target);
            }
        }
    }
    false
}

fn circles_of(parent: &ModulePath, graph: &Graph) -> Vec<String> {
    let mut faults = Vec::new();
    let mut told: BTreeSet<&String> = BTreeSet::new();
    for name in graph.keys() {
        if told.contains(name) || !reaches(graph, name, name) {
            continue;
        }
        let members: Vec<&String> = graph
            .keys()
            .filter(|other| reaches(graph, name, other) && reaches(graph, other, name))
            .collect();
        let inside = |from: &&String| {
            let targets = graph[*from].iter();
            let targets = targets.filter(|(to, _)| members.contains(to));
            let shown = targets.map(|(to, line)| format!("{from} -> {to} ({line})"));
            shown.collect::<Vec<_>>()
        };
        let lines: Vec<String> = members.iter().flat_map(inside).collect();
        faults.push(format!(
            "circle of modules in `{}`: {}",
            if parent.is_empty() {
                "the crate root".to_owned()
            } else {
                parent.join("::")
            },
            lines.join(", ")
        ));
        told.extend(members);
    }
    faults
}

/// Gathers the paths of one module.
struct Collector<'a>(&'a mut Module);

impl Collector<'_> {
    fn tree(&mut self, before: &[String], tree: &syn::UseTree) {
        let with = |ident: &syn::Ident| {
            let mut path = before.to_vec();
            path.push(ident.to_string());
            path
        };
        match tree {
            syn::UseTree::Path(p) => self.tree(&with(&p.ident), &p.tree),
            syn::UseTree::Group(group) => {
                group.items.iter().for_each(|t| self.tree(before, t));
            }
            syn::UseTree::Name(name) => self.alias(&name.ident, with(&name.ident)),
            syn::UseTree::Rename(name) => self.alias(&name.rename, with(&name.ident)),
            syn::UseTree::Glob(glob) => {
                let line = glob.star_token.spans[0].start().line;
                self.0.paths.push((before.to_vec(), line));
            }
        }
    }

    fn alias(&mut self, name: &syn::Ident, mut path: Vec<String>) {
        let mut name = name.to_string();
        let line = line_of(path.last(), name.as_str(), &self.0.file);
        if path.last().is_some_and(|last| last == "self") {
            path.pop();
            if name == "self" {
                name = path.last().cloned().unwrap_or(name);
            }
        }
        self.0.paths.push((path.clone(), line.unwrap_or(0)));
        // `use x;` of another crate's name would lead back to itself.
        if path.as_slice() != std::slice::from_ref(&name) {
            self.0.aliases.insert(name, path);
        }
    }
}

/// The first `use` line of a file that names `name`.
fn line_of(last: Option<&String>, name: &str, file: &Path) -> Option<usize> {
    let text = read(file).ok()?;
    let name = last.map_or(name, String::as_str);
    let word = |l: &str| {
        l.split(|c: char| !c.is_alphanumeric() && c != '_')
            .any(|w| w == name)
    };
    text.lines().position(word).map(|i| i + 1)
}

impl<'ast> Visit<'ast> for Collector<'_> {
    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if !is_test(&item.attrs) {
            self.tree(&[], &item.tree);
        }
    }

    fn visit_item_mod(&mut self, _: &'ast syn::ItemMod) {}

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        if let (None, syn::Type::Path(path)) = (&item.trait_, &*item.self_ty)
            && let Some(name) = path.path.get_ident().map(ToString::to_string).or_else(|| {
                let last = path.path.segments.last()?;
                Some(last.ident.to_string())
            })
        {
            let line = item.impl_token.span.start().line;
            self.0.impls.push((name, line));
        }
        visit::visit_item_impl(self, item);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let written: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        if path.leading_colon.is_none() && written.len() > 1 {
            let line = path.segments[0].ident.span().start().line;
            self.0.paths.push((written, line));
        }
        visit::visit_path(self, path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn module(all: &mut Modules, path: &str, text: &str) {
        let path: ModulePath = path
            .split("::")
            .filter(|s| !s.is_empty())
            .map(Into::into)
            .collect();
        let mut module = Module::default();
        for item in syn::parse_file(text).unwrap().items {
            Collector(&mut module).visit_item(&item);
        }
        if let Some((name, parent)) = path.split_last() {
            let parent = all.modules.entry(parent.to_vec()).or_default();
            parent.children.insert(name.clone());
        }
        let known = all.modules.entry(path).or_default();
        module.children = std::mem::take(&mut known.children);
        *known = module;
    }

    fn house(modules: &[(&str, &str)]) -> Modules {
        let mut all = Modules {
            modules: BTreeMap::new(),
        };
        for (path, text) in modules {
            module(&mut all, path, text);
        }
        all
    }

    #[test]
    fn a_circle_through_a_reexport_is_seen() {
        let all = house(&[
            ("", "pub use low::Low; pub use high::High;"),
            ("low", "use crate::High; pub struct Low;"),
            ("high", "use crate::low::Low; pub struct High;"),
        ]);
        let circles = all.circles(Path::new(""));
        assert_eq!(circles.len(), 1, "{circles:?}");
        assert!(circles[0].contains("high -> low") && circles[0].contains("low -> high"));
    }

    #[test]
    fn cousins_make_an_arrow_between_their_parents() {
        let all = house(&[
            ("", ""),
            ("a", ""),
            ("a::x", "fn f() { crate::b::y::g() }"),
            ("b", ""),
            ("b::y", "use super::super::a;"),
        ]);
        assert_eq!(all.circles(Path::new("")).len(), 1);
    }

    #[test]
    fn looking_down_or_at_ancestors_is_no_circle() {
        let all = house(&[
            ("", "use low::Low;"),
            ("low", "pub struct Low;"),
            ("high", "use crate::low::Low; mod part;"),
            ("high::part", "use super::High; use crate::low;"),
            (
                "other",
                "use std::fmt; use nalgebra::Vector3; fn f() { fmt::format(); }",
            ),
        ]);
        assert!(all.circles(Path::new("")).is_empty());
    }

    #[test]
    fn an_impl_away_from_its_type_is_seen() {
        let all = house(&[
            ("", ""),
            ("low", "pub struct Low; impl Low {}"),
            (
                "high",
                "use crate::low::Low; impl Low {} impl Clone for Low {}",
            ),
        ]);
        let faults = all.scattered_impls(Path::new(""));
        assert_eq!(faults.len(), 1);
        assert!(faults[0].contains("impl Low"));
    }
}
