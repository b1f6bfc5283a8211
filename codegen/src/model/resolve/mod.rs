//! From the file as written to the mechanism it means: names to ids, text to formulas in SI, and every
//! check that needs no motion. In: [`Spec`], [`Overrides`]. Out: [`Mechanism`] and warnings, or all errors.
//!
//! A thing that is wrong is reported and replaced by something harmless (`NaN`, a dummy axis), so that
//! the rest of the file is still checked; with any error the mechanism is thrown away.

mod advice;
mod ball_springs;
mod beam;
mod belt;
mod bodies;
mod call;
mod clearance;
mod coaxial;
mod connect;
mod controllers;
mod coupling_numbers;
mod couplings;
mod dry_friction;
mod flexible;
mod forces;
mod held;
mod held_places;
mod held_points;
mod inertia;
mod inputs;
mod joint_model;
mod joints;
mod known_controllers;
mod lookup;
mod matrices;
mod mesh;
mod missions;
mod modal_keys;
mod modal_start;
mod names;
mod overrides;
mod own_law;
mod parameters;
mod pid;
mod pid_keys;
mod points;
mod quantity;
mod resolver;
mod responses;
mod section;
mod sensors;
mod series;
mod starts;
mod states;
mod stops;
mod surface;
mod tabled;
mod tables;
mod term;
mod turns;
mod wear;
mod wheels;
mod words;

pub use overrides::{OverrideError, Overrides};

use self::known_controllers::Controllers;
use self::names::{Names, Thing};
use self::quantity::Allowed;
use self::resolver::Resolver;
use super::{Formula, Mechanism};
use crate::diagnostic::{Code, Diagnostic, Diagnostics, Severity};
use crate::input::Reach;
use crate::source::{Sources, Span};
use crate::spec::{CheckSpec, Composed, Dimension, File, ForceKind, Spec, composed};

/// Finds out what a file means; files that it names are read within reach.
///
/// # Errors
/// All errors of the file, those found while reading it included.
pub fn resolve(
    spec: &Spec,
    overrides: &Overrides,
    reach: Reach,
) -> Result<(Mechanism, Vec<Diagnostic>), Diagnostics> {
    let Composed { spec, sources, read } = composed(spec, reach);
    let mut resolver = Resolver {
        source: sources.whole(),
        reach,
        skipped: &spec.skipped,
        diagnostics: spec.problems.clone(),
        names: Names::new(&spec.lost),
        parameters: Vec::new(),
        values: Vec::new(),
        written_out: Vec::new(),
        state_turning: Vec::new(),
        sensor_turning: Vec::new(),
        used: Vec::new(),
        points: Vec::new(),
        joint_models: Vec::new(),
        modal_starts: Vec::new(),
        driven: Vec::new(),
        force_kinds: Vec::new(),
        states: Vec::new(),
        sensors: Vec::new(),
        controllers: Controllers::default(),
        reading_controller: false,
        attached: read,
        tables: Vec::new(),
        lost_tables: Vec::new(),
    };
    let mut mechanism = resolver.mechanism(&spec.file, overrides);
    // Beside errors, too: what is meant is no news in a file that is being written.
    resolver.diagnostics.retain(|diagnostic| !mechanism.allowed.contains(&diagnostic.code));
    resolver.fold_cells(&spec.file);
    let all = Diagnostics::from_list(resolver.diagnostics).located_in(&sources);
    if all.has_errors() {
        return Err(all);
    }
    let warnings = all.list().iter().filter(|d| d.severity == Severity::Warning).cloned().collect();
    mechanism.sources = sources;
    Ok((mechanism, warnings))
}

impl Resolver<'_> {
    fn mechanism(&mut self, written: &File, overrides: &Overrides) -> Mechanism {
        let name = self.mechanism_name(written);
        self.names.foresee(written);
        self.names.declare_table(&written.include, |_| Thing::Part, &mut self.diagnostics);
        self.resolve_parameters(&written.parameters, overrides);
        self.resolve_inputs(&written.inputs, overrides);
        self.resolve_tables(&written.tables);
        self.check_overrides(written, overrides);
        let (file, problems) = crate::spec::expand(written, &mut |count| {
            let count = self.formula(count, Some(Dimension::NONE), Allowed::CONSTANTS, "`count`");
            count.value(&self.values).filter(|count| count.is_finite())
        });
        self.diagnostics.extend(problems);
        self.names.declare_all(&file, &mut self.diagnostics);
        let gravity = self.gravity(&file);
        self.resolve_points(&file);
        let models = file.joints.0.iter().map(|(name, joint)| self.joint_model(name, joint)).collect();
        self.joint_models = models;
        self.add_clearance(&file);
        self.note_drives(&file);
        self.force_kinds = file.forces.0.iter().map(|(_, force)| ForceKind::of(&force.value)).collect();
        self.declare_states(&file.states);
        self.resolve_sensors(&file.sensors);
        self.resolve_controllers(&file.controllers);
        let mut bodies = self.resolve_bodies(&file.bodies);
        let mut joints = self.resolve_joints(&file.joints);
        self.resolve_clearances(&file, &mut joints);
        let missions = self.resolve_missions(&file, &joints);
        let couplings = self.resolve_couplings(&file, &joints);
        let mut forces = self.resolve_forces(&file.forces);
        forces.extend(self.ball_springs(&file.joints, &joints));
        let mut states = self.resolve_states(&file.states);
        let (held, samplers, outputs) = self.take_controllers();
        states.extend(held);
        self.check_responses(&joints, &forces, &states);
        let starts = self.resolve_starts(&file, &joints);
        let stops = self.resolve_stops(&file.stops, &joints, &starts);
        self.find_carriers(&file, &bodies, &joints, (&forces, &couplings));
        if !self.has_errors() {
            self.warn_held_elsewhere(&file, &bodies, &joints, &forces);
        }
        self.resolve_flexible(&file, &mut bodies, &joints, &forces, &gravity);
        self.check_connected(&file, &joints);
        self.warn_unused(written);
        Mechanism {
            name,
            parameters: std::mem::take(&mut self.parameters),
            gravity,
            bodies,
            points: std::mem::take(&mut self.points),
            joints,
            couplings,
            stops,
            forces,
            states,
            samplers,
            sensors: self.take_sensors(&file.sensors).into_iter().chain(outputs).collect(),
            missions,
            closure: file.closure.unwrap_or_default(),
            allowed: self.allowed(&file.check),
            starts,
            attached: std::mem::take(&mut self.attached),
            sources: Sources::default(),
        }
    }

    fn mechanism_name(&mut self, file: &File) -> String {
        match &file.name {
            Some(name) if names::is_name(&name.value) => return name.value.clone(),
            Some(name) => self.report(names::bad_name(name)),
            None => {
                let message = "the mechanism has no name";
                self.missing(self.whole_file(), Span::default(), Code::MissingKey, message)
                    .help("add `name = \"my_linkage\"`");
            }
        }
        String::new()
    }

    /// Codes that `[check]` switches off; an error cannot be.
    fn allowed(&mut self, check: &CheckSpec) -> Vec<Code> {
        let mut allowed = Vec::new();
        for name in check.allow.as_ref().map_or(&[][..], |list| &list.value) {
            let warnings = || Code::ALL.iter().filter(|code| code.severity() == Severity::Warning);
            if let Some(code) = warnings().find(|code| code.as_str() == name.value) {
                allowed.push(*code);
                continue;
            }
            let message = format!("`{}` is not the code of a warning", name.value);
            self.refuse(Code::BadChoice, name.span, message)
                .did_you_mean(&name.value, warnings().map(|code| code.as_str()))
                .help("warnings have codes such as W0112; errors cannot be switched off");
        }
        allowed
    }

    fn gravity(&mut self, file: &File) -> [Formula; 3] {
        let acceleration = Dimension::of(1, 0, -2);
        if let Some(gravity) = &file.gravity {
            return self.triple(gravity, acceleration, Allowed::PARAMETERS, "`gravity`");
        }
        // Another fault may be why: a misspelt `gravity` is one.
        if !self.has_errors() {
            self.report(Diagnostic::new(Code::NoGravity, "there is no gravity in this file").help(
                "write `gravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]`, or `gravity = [0, 0, 0]` to say so",
            ));
        }
        std::array::from_fn(|_| Formula::number(0.0, acceleration))
    }

    /// Only of files without errors: what is wrong may be what would have used it.
    fn warn_unused(&mut self, file: &File) {
        if self.has_errors() {
            return;
        }
        let parameters = file.parameters.0.iter().map(|(name, _)| ("parameter", name));
        let all = parameters.chain(file.inputs.0.iter().map(|(name, _)| ("input", name)));
        for (position, (what, name)) in all.enumerate() {
            if self.used.get(position) == Some(&false) {
                let message = format!("nothing uses the {what} `{}`", name.value);
                self.refuse(Code::UnusedParameter, name.span, message)
                    .help("use it in a formula, or delete it");
            }
        }
    }

    /// A fault in the text of a repeated group appears once per cell: keeps the first and counts the others.
    fn fold_cells(&mut self, file: &File) {
        let groups = crate::spec::group_spans(file);
        let inside =
            |span: Span| groups.iter().any(|group| group.start <= span.start && span.end <= group.end);
        let mut kept: Vec<(Diagnostic, usize)> = Vec::new();
        for diagnostic in std::mem::take(&mut self.diagnostics) {
            let same = |known: &&mut (Diagnostic, usize)| {
                known.0.code == diagnostic.code && known.0.span() == diagnostic.span()
            };
            match diagnostic.span().filter(|span| inside(*span)).and_then(|_| kept.iter_mut().find(same)) {
                Some((_, more)) => *more += 1,
                None => kept.push((diagnostic, 0)),
            }
        }
        self.diagnostics = kept
            .into_iter()
            .map(|(diagnostic, more)| match more {
                0 => diagnostic,
                _ => diagnostic.help(format!("{more} more cells have the same fault")),
            })
            .collect();
    }
}
