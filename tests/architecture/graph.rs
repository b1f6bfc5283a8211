//! Which file of a crate uses which. In: the source folder. Out: arrows from a file to the files that define what it
//! names. A re-export is followed to the file behind it and is no arrow itself.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::source::{code, identifier, rust_files};

/// A module's place in its crate: names from the root.
type Place = Vec<String>;

/// One file.
struct Module {
    file: String,
    /// Names it brings into scope, each with the path it stands for.
    uses: BTreeMap<String, Vec<String>>,
    /// Paths it depends on.
    paths: BTreeSet<Vec<String>>,
}

/// Arrows between files, by their names from the workspace.
pub struct Graph {
    arrows: BTreeMap<String, BTreeSet<String>>,
}

impl Graph {
    /// Reads every file below a source folder.
    pub fn read(root: &Path) -> Self {
        let files = rust_files(root).into_iter().filter(|file| !is_test(file));
        let modules: BTreeMap<Place, Module> =
            files.map(|file| (place(&file, root), Module::read(&file))).collect();
        let mut arrows = BTreeMap::new();
        for (at, module) in &modules {
            let targets = module.paths.iter().filter_map(|path| resolve(&modules, at, path, 0));
            let targets = targets.filter(|target| target != at).map(|target| modules[&target].file.clone());
            arrows.insert(module.file.clone(), targets.collect::<BTreeSet<String>>());
        }
        Self { arrows }
    }

    /// Whether this arrow exists, and its end leads back to its beginning.
    pub fn is_on_a_circle(&self, (from, to): &(&str, &str)) -> bool {
        let exists = self.arrows.get(*from).is_some_and(|targets| targets.contains(*to));
        exists && self.reachable(to).contains(*from)
    }

    /// Every arrow on a circle, as text.
    pub fn arrows_on_circles(&self) -> Vec<String> {
        let all = self.arrows.iter().flat_map(|(from, targets)| targets.iter().map(move |to| (from, to)));
        let circular = all.filter(|(from, to)| self.is_on_a_circle(&(from, to)));
        circular.map(|(from, to)| format!("{from} -> {to}")).collect()
    }

    fn reachable(&self, start: &str) -> BTreeSet<String> {
        let mut found = BTreeSet::from([start.to_owned()]);
        let mut open = vec![start.to_owned()];
        while let Some(file) = open.pop() {
            for target in self.arrows.get(&file).into_iter().flatten() {
                if found.insert(target.clone()) {
                    open.push(target.clone());
                }
            }
        }
        found
    }
}

fn is_test(file: &Path) -> bool {
    let is_tests = |part: &std::ffi::OsStr| part == "tests" || part == "tests.rs";
    file.components().any(|part| is_tests(part.as_os_str()))
}

/// `a/b.rs` and `a/b/mod.rs` are a::b; `lib.rs` and `main.rs` are the root.
fn place(file: &Path, root: &Path) -> Place {
    let inside = file.strip_prefix(root).expect("inside").with_extension("");
    let mut place: Place = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if place.last().is_some_and(|name| ["mod", "lib"].contains(&name.as_str())) {
        place.pop();
    }
    place
}

impl Module {
    fn read(file: &Path) -> Self {
        let mut module =
            Self { file: file.to_string_lossy().into_owned(), uses: BTreeMap::new(), paths: BTreeSet::new() };
        let text = code(file);
        let mut rest = text.as_str();
        while let Some((before, after)) = next_use(rest) {
            module.paths.extend(inline_paths(before));
            let (statement, after) = after.split_once(';').expect("a use ends");
            let is_public = before.trim_end().ends_with("pub") || before.trim_end().ends_with(')');
            for (path, name) in expanded(statement.trim()) {
                if !is_public {
                    module.paths.insert(path.clone());
                }
                module.uses.insert(name, path);
            }
            rest = after;
        }
        module.paths.extend(inline_paths(rest));
        module
    }
}

/// Splits at the next `use` that begins a statement.
fn next_use(text: &str) -> Option<(&str, &str)> {
    text.match_indices("use ").find_map(|(at, word)| {
        let line = text[..at].rsplit('\n').next().unwrap_or_default().trim();
        let begins = line.is_empty() || line == "pub" || (line.starts_with("pub(") && line.ends_with(')'));
        begins.then(|| (&text[..at], &text[at + word.len()..]))
    })
}

/// Every path of a use tree with the name it is known by: `a::{b as c, d::e}`.
pub fn expanded(tree: &str) -> Vec<(Vec<String>, String)> {
    let Some((head, group)) = tree.split_once('{') else {
        let (path, name) = tree.split_once(" as ").unwrap_or((tree, ""));
        let mut segments: Vec<String> = path.split("::").map(|part| part.trim().to_owned()).collect();
        if segments.last().is_some_and(|last| last == "self") {
            segments.pop();
        }
        let last = segments.last().cloned().unwrap_or_default();
        let name = if name.is_empty() { last } else { name.trim().to_owned() };
        return vec![(segments, name)];
    };
    let inner = group.trim_end().strip_suffix('}').unwrap_or(group);
    let parts = split_outside_braces(inner);
    parts.iter().flat_map(|part| expanded(&format!("{}{part}", head.trim()))).collect()
}

fn split_outside_braces(text: &str) -> Vec<String> {
    let (mut depth, mut parts) = (0, vec![String::new()]);
    for letter in text.chars() {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        parts.last_mut().expect("never empty").push(letter);
    }
    parts.into_iter().map(|part| part.trim().to_owned()).filter(|part| !part.is_empty()).collect()
}

/// Paths of two segments and more that stand in code.
fn inline_paths(code: &str) -> BTreeSet<Vec<String>> {
    let mut found = BTreeSet::new();
    let mut at = 0;
    while let Some(start) = code[at..].find(|letter: char| letter.is_alphabetic() || letter == '_') {
        let begin = at + start;
        let before = code[..begin].chars().next_back();
        let mut segments = Vec::new();
        at = begin;
        while let Some(name) = identifier(&code[at..]) {
            at += name.len();
            segments.push(name);
            if !code[at..].starts_with("::") {
                break;
            }
            at += 2;
        }
        if segments.len() > 1 && before.is_none_or(|letter| !"$:.".contains(letter) && !letter.is_numeric()) {
            found.insert(segments);
        }
    }
    found
}

/// The module that defines what a path names, seen from a module; None if that is another crate.
fn resolve(modules: &BTreeMap<Place, Module>, from: &Place, path: &[String], depth: usize) -> Option<Place> {
    let (mut at, mut rest) = (from.clone(), path);
    match rest.first()?.as_str() {
        "crate" => (at, rest) = (Place::new(), &rest[1..]),
        "self" => rest = &rest[1..],
        "super" => {
            while rest.first().is_some_and(|segment| segment == "super") {
                at.pop();
                rest = &rest[1..];
            }
        }
        first => {
            let child = [&at[..], &[first.to_owned()]].concat();
            if !modules.contains_key(&child) {
                return None;
            }
        }
    }
    while let Some(segment) = rest.first() {
        let child = [&at[..], std::slice::from_ref(segment)].concat();
        if !modules.contains_key(&child) {
            break;
        }
        (at, rest) = (child, &rest[1..]);
    }
    let imported = rest.first().and_then(|item| modules.get(&at)?.uses.get(item));
    match imported {
        Some(path) if depth < 8 => {
            let whole = [path, &rest[1..]].concat();
            resolve(modules, &at, &whole, depth + 1)
        }
        _ => modules.contains_key(&at).then_some(at),
    }
}
