//! Columns of tables: names, units, meanings. In: nothing. Out: the list that `docs/outputs.md` is made from and tables are held to.
//! Never knows values.

use linkwear_runtime::life::CycleJoint;

/// Columns of one form.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnForm {
    /// Their names: `<joint>`, `<body>`, .. stand for a name, `<axis>` for x, y or z, `<n>` for a number from 0.
    pub name: String,
    /// Their units: one of these; empty for a column without a unit, `<unit>` for any.
    pub units: &'static [&'static str],
    /// What they are.
    pub meaning: &'static str,
}

/// Tables, by what writes them: `simulate --out`, `study --out`, `cycles.csv`, `lives.csv`.
pub fn tables() -> [(&'static str, Vec<ColumnForm>); 4] {
    let form = |(name, units, meaning): &(&str, &'static [&'static str], &'static str)| ColumnForm {
        name: (*name).to_owned(),
        units,
        meaning,
    };
    let of_joint = CycleJoint::columns().map(|column| ColumnForm {
        name: format!("<joint>.{}", column.symbol),
        units: match column.unit {
            "m" => &["m"],
            "J" => &["J"],
            "N" => &["N"],
            _ => &["1"],
        },
        meaning: column.meaning,
    });
    [
        ("simulate --out", SAMPLES.iter().map(form).collect()),
        ("study --out", POINTS.iter().map(form).collect()),
        ("cycles.csv", CYCLES.iter().map(form).chain(of_joint).collect()),
        ("lives.csv", LIVES.iter().map(form).collect()),
    ]
}

/// Name, units, meaning. Vectors are along the ground's axes unless another frame is named.
const SAMPLES: &[(&str, &[&str], &str)] = &[
    ("t", &["s"], "Time"),
    (
        "t.switch<n>",
        &["1"],
        "A condition of a formula with pieces, by number from 1: below zero where it holds",
    ),
    (
        "t.row<n>",
        &["1"],
        "How many rows the argument of a table has passed, by number from 1: 0 at the first row, with the part of the way to the \
         next; of a periodic table rising from period to period",
    ),
    ("t.sample<n>", &["s"], "Time from sample to sample of a controller, by number from 1"),
    (
        "<joint>.q",
        &["rad", "m"],
        "Coordinate of a joint with one: angle or displacement, zero at the reference pose",
    ),
    ("<joint>.v", &["rad/s", "m/s"], "Its rate"),
    ("<joint>.a", &["rad/s^2", "m/s^2"], "The rate of that"),
    (
        "<joint>.q<n>",
        &["rad", "m", "1"],
        "Coordinates of a joint with several, from 1; of a spherical or free joint the unit quaternion q0 to q3, scalar first, of the \
         child relative to the parent",
    ),
    (
        "<joint>.e<n>",
        &["1"],
        "The unit quaternion e0 to e3 likewise, of a joint that has coordinates with numbers besides",
    ),
    ("<joint>.v<n>", &["rad/s", "m/s"], "Their rates"),
    ("<joint>.a<n>", &["rad/s^2", "m/s^2"], "The rates of those"),
    (
        "<element>.<axis>",
        &["m"],
        "Position of a point; of a free joint, displacement of the child from the parent; of a joint that holds a place, that place seen \
         from its origin; of a joint with clearance, offset of the \
         journal or ball in the bearing, in the bearing's frame",
    ),
    (
        "<element>.v<axis>",
        &["m/s"],
        "Velocity of a point; of a free joint or one that holds a place, the rate of its displacement in the parent",
    ),
    ("<body>.w<axis>", &["rad/s"], "Angular velocity of a body, absolute"),
    (
        "<element>.F<axis>",
        &["N"],
        "Force by the parent on the child at a joint, drive not included; by the first body on the second in a bushing",
    ),
    (
        "<element>.M<axis>",
        &["N m"],
        "Moment of the same about the joint's point of the child, which on a slide moves with it; of a bushing about the second body's point",
    ),
    ("<joint>.spring_M<axis>", &["N m"], "Moment of the spring of a spherical joint on the child"),
    ("<joint>.drive", &["N m", "N"], "Moment or force that the drive exerts on the child"),
    (
        "<joint>.drive<n>",
        &["N m", "N"],
        "The same of a joint with several coordinates, by their number from 1",
    ),
    (
        "<joint>.drive_M<axis>",
        &["N m"],
        "Moment that the drive of a spherical joint exerts on the child, about the joint",
    ),
    ("<joint>.lambda<n>", &["N m", "N"], "Multipliers of the rows that close a loop at a joint, from 1"),
    ("<coupling>.Ft", &["N"], "Tangential force on the second wheel of a pair; of a belt its pull"),
    ("<coupling>.Fr", &["N"], "Radial force on it, which parts the wheels"),
    ("<coupling>.Fa", &["N"], "Axial force on it along its joint's axis"),
    ("<coupling>.F<n>", &["N"], "Tension of either strand of a belt"),
    (
        "<coupling>.T<n>",
        &["N m"],
        "Moment on a body of a planetary set or differential, in their order from 1",
    ),
    (
        "<element>.T",
        &["N m"],
        "Multiplier of a relation whose sum is an angle; moment of a stop about its coordinate, on the child",
    ),
    (
        "<element>.F",
        &["N"],
        "Multiplier of a relation whose sum is a length; force of a stop along its coordinate, on the child; pull of a cable",
    ),
    ("<stop>.depth", &["m", "rad"], "How far a coordinate is beyond a stop; zero where it is free"),
    ("<force>.length", &["m"], "Distance of the ends of a cable"),
    ("<input>.u", &["<unit>"], "Value of an input of the mechanism"),
    (
        "<state>.value",
        &["<unit>"],
        "Value of a state of the mechanism's own or of a sensor; what a controller puts out",
    ),
    ("<state>.rate", &["<unit>"], "Rate of a state"),
    (
        "<state>.next",
        &["<unit>"],
        "What a sampled controller would hold from here on, were there a sample now",
    ),
    ("<body>.eta<n>", &["kg^0.5 m", "1"], "Modal coordinates of a flexible body, from 1"),
    ("<body>.u<axis>", &["m"], "Displacement at mid-span of a flexible link, in the link's own frame"),
    ("<body>.u<axis>_<station>", &["m"], "The same at its other stations, or at named nodes"),
    (
        "<body>.stress_<axis>",
        &["Pa"],
        "Bending stress at mid-span, at the outermost fibre along y or z of the link's own frame",
    ),
    ("<body>.stress_<axis>_<station>", &["Pa"], "The same at its other stations"),
    ("<body>.modal_energy", &["J"], "Elastic and kinetic energy of the modes"),
    (
        "<joint>.gap",
        &["m"],
        "Distance of the surfaces of a joint with clearance; below zero they press into each other",
    ),
    ("<joint>.Fn", &["N"], "Normal force of a contact"),
    ("<joint>.vt", &["m/s"], "Sliding speed of a contact"),
    ("<joint>.contact_angle", &["rad"], "Angle of the contact in the bearing's frame, in (-pi, pi]"),
    (
        "<joint>.journal_angle",
        &["rad"],
        "The same in the frame of a journal that wears: which place of it touches",
    ),
    ("energy.kinetic", &["J"], "Kinetic energy of all bodies"),
    ("energy.potential", &["J"], "Potential energy: gravity, springs, elastic bodies"),
];

const POINTS: &[(&str, &[&str], &str)] = &[
    ("<parameter>", &["<unit>"], "A parameter that varies, SI"),
    (
        "<result>",
        &["<unit>"],
        "A result that was asked for by `--of`, of the same name; an empty cell, or NaN, where there is none",
    ),
    ("error", &[""], "Code of the error of a point at which nothing could be run; empty without"),
];

const CYCLES: &[(&str, &[&str], &str)] = &[
    ("cycle", &[""], "Number of the cycle, from 1"),
    (
        "used",
        &["1"],
        "Largest wear of a joint over its threshold, at the end of the cycle: 1 or more is failure",
    ),
];

const LIVES: &[(&str, &[&str], &str)] = &[
    ("trajectory", &[""], "Number of the life, from 0"),
    ("life", &["cycles"], "Its length, the last cycle in part"),
    ("whole cycles", &[""], "Its length, the last cycle counted in full"),
    ("failed joint", &[""], "The joint that failed first"),
];

impl ColumnForm {
    /// Whether a column of a table has this form, by its head: `R1.q [rad]`.
    pub fn has(&self, head: &str) -> bool {
        let (name, unit) = match head.strip_suffix(']').and_then(|head| head.rsplit_once(" [")) {
            Some((name, unit)) => (name, unit),
            None => (head, ""),
        };
        let is_unit = |known: &&str| *known == unit || (*known == "<unit>" && !unit.is_empty());
        self.units.iter().any(is_unit) && fits(&self.name, name)
    }
}

fn is_word(part: &str) -> bool {
    !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}

/// Whether a name has a form. A place for a name takes all letters up to what follows it in the form.
fn fits(form: &str, name: &str) -> bool {
    let Some((before, rest)) = form.split_once('<') else { return form == name };
    let Some((place, after)) = rest.split_once('>') else { return false };
    let Some(name) = name.strip_prefix(before) else { return false };
    let is_one = |part: &str| match place {
        "axis" => ["x", "y", "z"].contains(&part),
        "n" => !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit()),
        // As `--of` has it: `peak.R1.F`.
        "result" => part.split('.').all(is_word),
        // Names of parts have those of the files that include them before them: `left.R1`.
        _ => part.split('.').all(is_word),
    };
    let ends = name.char_indices().map(|(at, _)| at).chain([name.len()]);
    ends.map(|end| name.split_at(end)).any(|(part, rest)| is_one(part) && fits(after, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_has_one_form_or_none() {
        let forms = &tables()[0].1;
        let names = |head: &str| -> Vec<&str> {
            forms.iter().filter(|form| form.has(head)).map(|form| &*form.name).collect()
        };
        assert_eq!(names("t [s]"), ["t"]);
        assert_eq!(names("R4.q [rad]"), ["<joint>.q"]);
        assert_eq!(names("left.knee.R4.q [rad]"), ["<joint>.q"]);
        assert_eq!(names("S2.q3 [1]"), ["<joint>.q<n>"]);
        assert_eq!(names("coupler.uy_1 [m]"), ["<body>.u<axis>_<station>"]);
        assert_eq!(names("coupler.stress_z [Pa]"), ["<body>.stress_<axis>"]);
        assert_eq!(names("torque.u [N m]"), ["<input>.u"]);
        assert_eq!(names("heat.rate [W]"), ["<state>.rate"]);
        for wrong in
            ["R4.q", "R4.q [N]", "R4 .q [rad]", "R4.p [rad]", "coupler.uw [m]", "t", "torque.u", "R1.q_1 [m]"]
        {
            assert!(names(wrong).is_empty(), "{wrong}");
        }
    }
}
