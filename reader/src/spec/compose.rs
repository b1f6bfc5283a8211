//! A file with all files that it includes as one: their tables joined, their names behind those of their parts, their places moved. In: a
//! [`Spec`]. Out: a [`Spec`] without parts to read, and the texts of all files. Never knows what the tables mean.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use toml::de::DeTable;

use super::drawn::Turn;
use super::file::{File, Parameter};
use super::include::{IncludeSpec, RotationSpec};
use super::not_toml;
use super::parse::{self, Spec};
use super::placed::{Place, turn};
use super::read;
use super::scope::{Asked, Scope, files_of};
use super::syntax::parse_expression;
use super::words::{fits_one, without_braces};
use super::written::{At, Literal, Name, Quantity, Table, Triple};
use crate::diagnostic::{Code, Diagnostic, brief};
use crate::input::{Reach, read_named};
use crate::limits;
use crate::source::{SourceFile, Sources, Span};

/// A file together with its parts.
#[derive(Clone, Debug)]
pub struct Composed {
    /// The tables of all.
    pub spec: Spec,
    /// The texts of all.
    pub sources: Sources,
    /// Paths of the included files, each once.
    pub read: Vec<PathBuf>,
}

/// Reads all files that a file includes, within reach. Faults wait in the [`Spec`].
pub fn composed(spec: &Spec, reach: Reach) -> Composed {
    let mut spec = spec.clone();
    let file = std::mem::take(&mut spec.file);
    let place = PathBuf::from(&spec.source.name);
    let above: Vec<PathBuf> = place.canonicalize().into_iter().collect();
    let sources = Sources::new(spec.source.clone());
    let mut composer = Composer { reach, spec, sources, read: Vec::new(), told: HashSet::new(), parts: 0 };
    let file = composer.flat(file, &place, &above);
    let Composer { mut spec, sources, read, .. } = composer;
    spec.file = file;
    spec.source = sources.whole().clone();
    Composed { spec, sources, read }
}

struct Composer {
    reach: Reach,
    /// What is found besides tables.
    spec: Spec,
    sources: Sources,
    read: Vec<PathBuf>,
    /// Files whose own faults are told: once, however often they are included.
    told: HashSet<PathBuf>,
    parts: usize,
}

impl Composer {
    /// A file of the path `place` with its parts, as it would name them itself; `above`: the files that are being included.
    fn flat(&mut self, mut file: File, place: &Path, above: &[PathBuf]) -> File {
        for (name, include) in file.include.0.clone() {
            match self.part(&name, &include, place, above) {
                Some(part) => append(&mut file, part),
                // Nothing follows from the absence of its names.
                None => self.spec.lost.push(name.value),
            }
        }
        self.check_bodies(&file);
        file
    }

    /// Bodies that shall stand for those of parts and do not exist.
    fn check_bodies(&mut self, file: &File) {
        let groups = file.repeat.0.iter().flat_map(|(_, group)| &group.value.bodies.0);
        let bodies = file.bodies.0.iter().chain(groups).map(|(name, _)| without_braces(&name.value));
        let known: Vec<String> = bodies.chain(["ground".to_owned()]).collect();
        for (_, outer) in file.include.0.iter().flat_map(|(_, include)| &include.value.bodies.0) {
            let name = &outer.value;
            if fits_one(&known, &name.value) || self.spec.lost.contains(&name.value) {
                continue;
            }
            let message = format!("there is no body `{}` that a body of the part could be", name.value);
            let known = known.iter().map(String::as_str);
            self.tell(
                Diagnostic::new(Code::UnknownName, message)
                    .at(name.span, "")
                    .did_you_mean(&name.value, known)
                    .help("the part's body is on the left, that of this file on the right"),
            );
            self.spec.lost.push(name.value.clone());
        }
    }

    fn part(
        &mut self,
        name: &Name,
        include: &At<IncludeSpec>,
        place: &Path,
        above: &[PathBuf],
    ) -> Option<File> {
        let own = &include.value;
        let Some(path) = &own.file else {
            let message = format!("the part `{}` does not say which file it is", name.value);
            let fault = Diagnostic::new(Code::MissingKey, message).at(name.span, "");
            self.tell(fault.help("add `file = \"leg.toml\"`"));
            return None;
        };
        let (file, path) = self.file(path, place, above)?;
        let mut above = above.to_vec();
        above.extend(path.canonicalize());
        let mut file = self.flat(file, &path, &above);
        for data in files_of(&mut file) {
            // Named from the folder of the whole.
            if let Some(folder) = own.file.as_ref().and_then(|file| Path::new(&file.value).parent()) {
                data.value = folder.join(&data.value).to_string_lossy().replace('\\', "/");
            }
        }
        self.check_keys(name, own, &file);
        let bodies = bodies_of(own);
        let scope = Scope::new(&name.value, &file, &bodies);
        file.bodies.0.retain(|(body, _)| !bodies.iter().any(|(inner, _)| *inner == body.value));
        if let Some((_, ground)) = bodies.iter().find(|(inner, _)| inner == "ground") {
            push_against(&mut file, ground);
        }
        let asked = scope.rename(&mut file);
        let turn = own.rotation.as_ref().and_then(|rotation| self.turn(name, rotation));
        let place = Place { turn, origin: self.origin(own) };
        if place.turn.is_some() || !place.origin.is_empty() {
            for Asked { span, .. } in asked.into_iter().filter(|asked| asked.place || place.turn.is_some()) {
                let message = format!(
                    "the part `{}` is moved, and this formula asks for components along axes of the ground",
                    name.value
                );
                self.refuse(span, message, "write such a formula in the file that includes the part, or include it where it is drawn");
            }
            for (span, what, cure) in place.apply(&mut file) {
                self.refuse(span, format!("the part `{}` cannot be turned: {what}", name.value), cure);
            }
        }
        for (parameter, value) in &own.parameters.0 {
            let called = format!("{}.{}", name.value, parameter.value);
            if let Some((_, known)) = file.parameters.0.iter_mut().find(|(known, _)| known.value == called) {
                set(&mut known.value, value.value.clone());
            }
        }
        Some(file)
    }

    /// An included file as written, and its path.
    fn file(&mut self, name: &Name, place: &Path, above: &[PathBuf]) -> Option<(File, PathBuf)> {
        let (path, text) = match read_named(place, &name.value, self.reach, limits::FILE_BYTES) {
            Ok(found) => found,
            Err(error) => {
                let message =
                    format!("the part `{}` cannot be read: {}", name.value, brief(&error.to_string()));
                self.refuse(
                    name.span,
                    message,
                    "the path is relative to this file, and leads below its folder",
                );
                return None;
            }
        };
        let real = path.canonicalize().unwrap_or_else(|_| path.clone());
        if above.contains(&real) {
            let message = format!("the file `{}` includes itself, directly or through its parts", name.value);
            self.refuse(name.span, message, "take one of the includes away");
            return None;
        }
        self.parts += 1;
        let bytes = self.sources.whole().text.len() + text.len();
        if let Some(fault) =
            limits::PARTS.broken_by(self.parts).or_else(|| limits::FILE_BYTES.broken_by(bytes))
        {
            self.tell(fault.at(name.span, ""));
            return None;
        }
        if !self.read.contains(&path) {
            self.read.push(path.clone());
        }
        let start = self.sources.add(path.to_string_lossy().replace('\\', "/"), &text);
        // Blanks before it, so that places are those in the whole.
        let placed = SourceFile { name: String::new(), text: " ".repeat(start) + &text };
        let is_first = self.told.insert(real);
        let (document, errors) = DeTable::parse_recoverable(&placed.text);
        let mut problems = not_toml::syntax_errors(&placed, &errors);
        let mut file = None;
        if problems.is_empty() {
            let says_version = parse::said_version(&document);
            let (found, notes) = read::read::<File>(document);
            let wrong = parse::version_problem(&found, says_version, Span { start, end: start });
            file = wrong.is_none().then_some(found);
            problems.extend(wrong);
            problems.extend(notes.diagnostics);
            self.spec.skipped.extend(notes.skipped);
            self.spec.lost.extend(notes.lost);
        }
        if is_first {
            self.spec.problems.extend(problems);
        }
        Some((file?, path))
    }

    /// Parameters and bodies that the part does not have.
    fn check_keys(&mut self, name: &Name, own: &IncludeSpec, file: &File) {
        let known =
            |table: &mut dyn Iterator<Item = &Name>| table.map(|name| name.value.clone()).collect::<Vec<_>>();
        let parameters = known(&mut file.parameters.0.iter().map(|(name, _)| name));
        let mut bodies = known(&mut file.bodies.0.iter().map(|(name, _)| name));
        bodies.push("ground".to_owned());
        let wanted = own.parameters.0.iter().map(|(key, _)| (key, "parameter", &parameters));
        let wanted = wanted.chain(own.bodies.0.iter().map(|(key, _)| (key, "body", &bodies)));
        for (key, what, known) in
            wanted.filter(|(key, _, known)| !known.contains(&key.value)).collect::<Vec<_>>()
        {
            if self.spec.lost.contains(&key.value) {
                continue;
            }
            let message = format!("the part `{}` has no {what} `{}`", name.value, key.value);
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            let mut fault = Diagnostic::new(Code::UnknownName, message)
                .at(key.span, "")
                .did_you_mean(&key.value, known.iter().copied());
            if fault.help.is_empty() {
                fault = fault.help(match &known[..] {
                    [] => format!("it has no {what}"),
                    _ => format!("it has: {}", known.join(", ")),
                });
            }
            self.tell(fault);
        }
    }

    fn origin(&mut self, own: &IncludeSpec) -> Vec<Quantity> {
        let Some(Triple(origin)) = &own.origin else { return Vec::new() };
        if origin.value.len() != 3 {
            let message = format!("`origin` has {} entries, not 3", origin.value.len());
            self.tell(Diagnostic::new(Code::WrongCount, message).at(origin.span, "write 3"));
            return Vec::new();
        }
        origin.value.clone()
    }

    fn turn(&mut self, name: &Name, rotation: &At<RotationSpec>) -> Option<Turn> {
        let RotationSpec { axis, angle } = &rotation.value;
        let (Some(axis), Some(angle)) = (axis, angle) else {
            let message = format!("`rotation` of the part `{}` needs `axis` and `angle`", name.value);
            let fault = Diagnostic::new(Code::MissingKey, message).at(rotation.span, "");
            self.tell(fault.help("write `rotation = { axis = [0, 0, 1], angle = \"90 deg\" }`"));
            return None;
        };
        let axis: Option<[f64; 3]> = axis
            .0
            .value
            .iter()
            .map(number)
            .collect::<Option<Vec<f64>>>()
            .and_then(|list| list.try_into().ok());
        let found = axis.zip(number(angle)).and_then(|(axis, angle)| turn(axis, angle));
        if found.is_none() {
            let message = format!("`rotation` of the part `{}` is no turn about an axis", name.value);
            let cure = "its axis is three numbers, not all 0, its angle a quantity such as \"90 deg\", not a formula";
            self.refuse(rotation.span, message, cure);
        }
        found
    }

    fn refuse(&mut self, span: Span, message: impl Into<String>, cure: &str) {
        self.tell(Diagnostic::new(Code::BadInclude, message).at(span, "").help(cure));
    }

    fn tell(&mut self, fault: Diagnostic) {
        self.spec.problems.push(fault);
    }
}

/// Bodies of the part and those of the whole that stand for them.
fn bodies_of(own: &IncludeSpec) -> Vec<(String, String)> {
    own.bodies.0.iter().map(|(inner, outer)| (inner.value.clone(), outer.value.value.clone())).collect()
}

/// What pushes against the ground unless something else is written, where the part's ground is a body of the whole.
fn push_against(file: &mut File, ground: &str) {
    let groups = file.repeat.0.iter_mut().flat_map(|(_, group)| &mut group.value.forces.0);
    for (_, force) in file.forces.0.iter_mut().chain(groups) {
        let force = &mut force.value;
        let Some(place) = force.force.as_ref().or(force.torque.as_ref()).map(|body| body.span) else {
            continue;
        };
        let name = || Name { span: place, value: ground.to_owned() };
        force.reaction.get_or_insert_with(name);
        force.axes.get_or_insert_with(name);
    }
}

/// A quantity without names, in SI.
fn number(quantity: &Quantity) -> Option<f64> {
    match &quantity.value {
        Literal::Number(value) => Some(*value),
        Literal::Text(text) => parse_expression(text, &|_| false).ok()?.quantity().map(|(value, _)| value),
    }
}

/// What follows from other parameters changes with them, and is no longer changeable alone.
fn set(parameter: &mut Parameter, value: Quantity) {
    if number(&value).is_none() {
        *parameter = Parameter::Plain(value);
        return;
    }
    match parameter {
        Parameter::Plain(known) => *known = value,
        Parameter::Marked(table) => table.value = Some(value),
    }
}

fn append(file: &mut File, part: File) {
    fn join<T>(table: &mut Table<T>, more: Table<T>) {
        table.0.extend(more.0);
    }
    // Without `..`: a table that is new must be thought of here. What is left out is the whole's affair.
    let File {
        spec: _,
        name: _,
        doc: _,
        gravity: _,
        closure: _,
        check: _,
        missions: _,
        parameters,
        inputs,
        points,
        bodies,
        joints,
        couplings,
        stops,
        forces,
        states,
        sensors,
        controllers,
        assembly,
        initial,
        clearance,
        wear,
        tables,
        repeat,
        include,
    } = part;
    join(&mut file.parameters, parameters);
    join(&mut file.inputs, inputs);
    join(&mut file.points, points);
    join(&mut file.bodies, bodies);
    join(&mut file.joints, joints);
    join(&mut file.couplings, couplings);
    join(&mut file.stops, stops);
    join(&mut file.forces, forces);
    join(&mut file.states, states);
    join(&mut file.sensors, sensors);
    join(&mut file.controllers, controllers);
    join(&mut file.assembly, assembly);
    join(&mut file.initial, initial);
    join(&mut file.clearance, clearance);
    join(&mut file.wear, wear);
    join(&mut file.tables, tables);
    join(&mut file.repeat, repeat);
    join(&mut file.include, include);
}
