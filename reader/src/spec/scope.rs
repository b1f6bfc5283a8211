//! Names of a part within the file that includes it: `R1` becomes `left.R1` wherever it stands. In: the part's [`File`]. Out: the same
//! with its names as the whole has them. Never knows where parts are.

use std::collections::HashMap;
use std::mem::take;

use super::controller::ControllerStateSpec;
use super::file::{File, Input, RepeatSpec};
use super::syntax::parse_expression;
use super::texts::{Change, Texts as _};
use super::words::{fits_one, roots, without_braces, words};
use super::written::{Name, Table};
use crate::source::Span;

/// Where a formula asks for components along axes of the ground.
pub(super) struct Asked {
    pub(super) span: Span,
    /// Whether they are of a place, which a shift changes too.
    pub(super) place: bool,
}

/// What a part's names are in the whole.
pub(super) struct Scope {
    /// `left.`
    prefix: String,
    /// Names of the part, and those of its groups with [`BRACES`].
    own: Vec<String>,
    by_name: HashMap<String, String>,
    /// Points and bodies, whose members are along axes of the ground.
    along_ground: Vec<String>,
}

impl Scope {
    /// `bodies`: those of the part, or its ground, that are bodies of the whole.
    pub(super) fn new(part: &str, file: &File, bodies: &[(String, String)]) -> Self {
        let prefix = format!("{part}.");
        let own: Vec<String> = names_of(file).iter().map(|name| without_braces(name)).collect();
        let mut by_name: HashMap<String, String> =
            own.iter().map(|name| (name.clone(), format!("{prefix}{name}"))).collect();
        by_name.extend(bodies.iter().cloned());
        let points = file.repeat.0.iter().flat_map(|(_, group)| keys(&group.value.points));
        let bodies = file.repeat.0.iter().flat_map(|(_, group)| keys(&group.value.bodies));
        let named = keys(&file.points).chain(keys(&file.bodies)).chain(points).chain(bodies);
        let along_ground = named.map(without_braces).collect();
        Self { prefix, own, by_name, along_ground }
    }

    /// Renames all that is named in the file. Gives the places where formulas ask for components along axes of the ground.
    pub(super) fn rename(&self, file: &mut File) -> Vec<Asked> {
        let mut words = words_of(file);
        let kept: Vec<Option<Name>> = words.iter_mut().map(|word| take(*word)).collect();
        // Values of cells are named in braces only.
        let values: Vec<Vec<String>> =
            file.repeat.0.iter().map(|(_, group)| names(&group.value.values)).collect();
        // And states of a controller behind its name only.
        let states: Vec<Vec<String>> = states_of(file).into_iter().map(|own| names(own)).collect();
        let mut asked = Vec::new();
        each(file, &mut |text, span| self.renamed(text, span, &mut asked));
        for (word, kept) in words_of(file).into_iter().zip(kept) {
            *word = kept;
        }
        for ((_, group), values) in file.repeat.0.iter_mut().zip(values) {
            put_back(&mut group.value.values, values);
        }
        for (own, states) in states_of(file).into_iter().zip(states) {
            put_back(own, states);
        }
        asked
    }

    fn renamed(&self, text: &mut String, span: Span, asked: &mut Vec<Asked>) {
        if let Some(name) = self.name(text) {
            *text = name;
            return;
        }
        let mut found = Vec::new();
        if text.contains('{') {
            found = words(text);
        } else if let Ok(expression) = parse_expression(text, &|word| self.name(word).is_some()) {
            roots(text, &expression, &mut found);
        }
        found.sort_by_key(|(at, ..)| std::cmp::Reverse(*at));
        for (at, word, member) in found {
            let Some(name) = self.name(&word) else { continue };
            // Forces and moments in joints and bushings have such components too; the pull of a cable has none.
            let along = |member: &str| {
                (member.starts_with(['F', 'M']) && member != "F") || fits_one(&self.along_ground, &word)
            };
            if let Some(member) = member.filter(|member| along(member)) {
                asked.push(Asked { span, place: member.starts_with(['x', 'y', 'z']) });
            }
            text.replace_range(at..at + word.len(), &name);
        }
    }

    /// What a name of the part is in the whole.
    fn name(&self, word: &str) -> Option<String> {
        if let Some(name) = self.by_name.get(word) {
            return Some(name.clone());
        }
        fits_one(&self.own, word).then(|| format!("{}{word}", self.prefix))
    }
}

/// All names that a file declares.
pub(super) fn names_of(file: &File) -> Vec<&str> {
    let mut names: Vec<&str> =
        keys(&file.parameters).chain(keys(&file.inputs)).chain(keys(&file.tables)).collect();
    names.extend(keys(&file.points).chain(keys(&file.bodies)).chain(keys(&file.joints)));
    names.extend(
        keys(&file.stops).chain(keys(&file.couplings)).chain(keys(&file.forces)).chain(keys(&file.include)),
    );
    names.extend(keys(&file.states).chain(keys(&file.sensors)).chain(keys(&file.controllers)));
    names.extend(keys(&file.repeat));
    for (_, group) in &file.repeat.0 {
        // Without `..`, as in `each`: start values name joints, values stand in braces.
        let RepeatSpec {
            count: _,
            index: _,
            first: _,
            values: _,
            assembly: _,
            initial: _,
            points,
            bodies,
            joints,
            couplings,
            stops,
            forces,
            states,
            sensors,
            controllers,
        } = &group.value;
        names.extend(keys(points).chain(keys(bodies)).chain(keys(joints)));
        names.extend(keys(stops).chain(keys(couplings)).chain(keys(forces)));
        names.extend(keys(states).chain(keys(sensors)).chain(keys(controllers)));
    }
    names
}

fn keys<T>(table: &Table<T>) -> impl Iterator<Item = &str> {
    table.0.iter().map(|(name, _)| &*name.value)
}

fn names<T>(table: &Table<T>) -> Vec<String> {
    keys(table).map(str::to_owned).collect()
}

fn put_back<T>(table: &mut Table<T>, names: Vec<String>) {
    for ((name, _), kept) in table.0.iter_mut().zip(names) {
        name.value = kept;
    }
}

fn each(file: &mut File, change: Change<'_>) {
    let nowhere = Span::default();
    // Without `..`: a table that is new must be thought of here.
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
    } = file;
    parameters.each(nowhere, change);
    inputs.each(nowhere, change);
    points.each(nowhere, change);
    bodies.each(nowhere, change);
    joints.each(nowhere, change);
    couplings.each(nowhere, change);
    stops.each(nowhere, change);
    forces.each(nowhere, change);
    states.each(nowhere, change);
    sensors.each(nowhere, change);
    controllers.each(nowhere, change);
    assembly.each(nowhere, change);
    initial.each(nowhere, change);
    clearance.each(nowhere, change);
    wear.each(nowhere, change);
    tables.each(nowhere, change);
    repeat.each(nowhere, change);
    for (name, part) in &mut include.0 {
        change(&mut name.value, name.span);
        part.value.bodies.0.clear();
    }
}

/// States that controllers keep, those of groups included.
fn states_of(file: &mut File) -> Vec<&mut Table<ControllerStateSpec>> {
    let groups = file.repeat.0.iter_mut().flat_map(|(_, group)| &mut group.value.controllers.0);
    let controllers = file.controllers.0.iter_mut().chain(groups);
    controllers.map(|(_, own)| &mut own.value.states).collect()
}

/// Texts that are neither names nor formulas.
fn words_of(file: &mut File) -> Vec<&mut Option<Name>> {
    let mut words = Vec::new();
    for (_, input) in &mut file.inputs.0 {
        if let Input::Table(table) = &mut input.value {
            words.push(&mut table.unit);
        }
    }
    words.extend(file.tables.0.iter_mut().map(|(_, table)| &mut table.value.data));
    let groups = file.repeat.0.iter_mut().map(|(_, group)| &mut group.value);
    let mut bodies: Vec<_> = file.bodies.0.iter_mut().collect();
    for group in groups {
        words.push(&mut group.index);
        bodies.extend(&mut group.bodies.0);
    }
    words.extend(
        bodies
            .into_iter()
            .filter_map(|(_, body)| body.value.flexible.as_mut())
            .map(|bent| &mut bent.value.data),
    );
    words
}

/// Names of files in a file that lies in another folder than the whole.
pub(super) fn files_of(file: &mut File) -> Vec<&mut Name> {
    let groups = file.repeat.0.iter_mut().flat_map(|(_, group)| &mut group.value.bodies.0);
    let bodies = file.bodies.0.iter_mut().chain(groups);
    let bent = bodies.filter_map(|(_, body)| body.value.flexible.as_mut()?.value.data.as_mut());
    file.tables.0.iter_mut().filter_map(|(_, table)| table.value.data.as_mut()).chain(bent).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scope() -> Scope {
        let own = ["L", "m", "A", "B{i}", "R{i}", "curve", "knee", "knee.R1"].map(without_braces).to_vec();
        let by_name = [("base".to_owned(), "frame".to_owned())].into();
        Scope {
            prefix: "left.".into(),
            own,
            by_name,
            along_ground: ["A", "B{i}"].map(without_braces).to_vec(),
        }
    }

    #[test]
    fn names_get_the_part_before_them_and_units_and_members_stay() {
        for (text, renamed) in [
            ("L + 2 m*L", "left.L + 2 m*left.L"),
            ("2*( (L)) - (knee.R1.q)", "2*( (left.L)) - (left.knee.R1.q)"),
            ("base", "frame"),
            ("ground", "ground"),
            ("knee.R1.q", "left.knee.R1.q"),
            ("curve(A.x - B3.L)", "left.curve(left.A.x - left.B3.L)"),
            ("B{i}.x - B{i-1}.x + 2 m", "left.B{i}.x - left.B{i-1}.x + 2 m"),
            ("R{2*i+1}", "left.R{2*i+1}"),
            ("{L}*0.1 m + {m} m + L", "{L}*0.1 m + {m} m + left.L"),
            ("R12", "left.R12"),
            ("Rx + sin(L)", "Rx + sin(left.L)"),
        ] {
            let mut found = text.to_owned();
            scope().renamed(&mut found, Span::default(), &mut Vec::new());
            assert_eq!(found, renamed, "{text}");
        }
    }

    #[test]
    fn formulas_that_ask_where_a_point_is_are_told() {
        for (text, count) in [
            ("A.x", 1),
            ("B{i}.x - B{i+1}.y", 2),
            ("R1.q", 0),
            ("R1.Fx", 1),
            ("R1.F", 0),
            ("2*R{i}.Mz", 1),
            ("L", 0),
        ] {
            let mut asked = Vec::new();
            scope().renamed(&mut text.to_owned(), Span::default(), &mut asked);
            assert_eq!(asked.len(), count, "{text}");
        }
    }
}
