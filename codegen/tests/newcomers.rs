//! Mistakes that newcomers made with a first slider-crank: each answer leads to the cure in one reading.

use linkwear_codegen::compile::{Options, compile};
use linkwear_codegen::diagnostic::Diagnostics;
use linkwear_codegen::source::SourceFile;

/// One crank, a rod, a ram; the pin between crank and rod has clearance and wears.
const RIGHT: &str = r#"spec = 1
name = "press"
gravity = [0, "-9.81 m/s^2", 0]

[parameters]
L1 = "40 mm"
L2 = "160 mm"
steel = "7850 kg/m^3"
c0 = { value = "25 um", tunable = true }
speed = { value = "300 rpm", tunable = true }

[points]
O = [0, 0, 0]
A = ["L1", 0, 0]
B = ["L1 + L2", 0, 0]

[bodies]
crank = { rod = ["O", "A"], radius = "10 mm", density = "steel" }
rod = { rod = ["A", "B"], radius = "8 mm", density = "steel" }
ram = { mass = "0.5 kg", centre = "B", inertia = ["1e-4 kg m^2", "1e-4 kg m^2", "1e-4 kg m^2"] }

[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "2*pi*speed*t" }
pin = { revolute = ["crank", "rod"], at = "A", axis = [0, 0, 1] }
wrist = { revolute = ["rod", "ram"], at = "B", axis = [0, 0, 1] }
guide = { prismatic = ["ground", "ram"], at = "B", axis = [1, 0, 0], force = "-500 N" }

[clearance.pin]
radial = "c0"
journal_radius = "12 mm"
length = "20 mm"
modulus = "115 GPa"
restitution = 0.9
friction = 0.05

[wear.pin]
coefficient = 1e-8
hardness = "3.5 GPa"
threshold = "80 um"

[assembly]
pin = "-0.2 rad"
"#;

/// Number of the mistake in the list of all, what is written for what, and what the answer must say: its code, and a
/// phrase of the cure. Mistakes 6a, 23 and 25 are of the command line, 3d, 11b and 12b of mechanisms with their clearances closed.
const MISTAKES: &[(&str, &str, &str, &str, &str)] = &[
    ("1", r#"radius = "10 mm""#, "radius = 10", "E0304", "\"10 mm\" or \"10 m\""),
    ("2", r#"L1 = "40 mm""#, r#"L1 = "40 m""#, "W0112", "m for mm is a factor of 1000"),
    ("3a", r#""O", axis = [0, 0, 1]"#, r#""O", axis = [0, 0, 0]"#, "E0401", "[0, 0, 1]"),
    ("3e", r#""O", axis = [0, 0, 1]"#, r#""O", axis = "z""#, "E0105", "axis = [0, 0, 1]"),
    ("4a", "guide = {", "# guide = {", "W0115", "add the joint that is missing"),
    (
        "4b",
        "[joints]",
        "lost = { rod = [\"A\", \"B\"], radius = \"8 mm\", density = \"steel\" }\n[joints]",
        "E0501",
        "add a joint",
    ),
    ("5a", "[wear.pin]", "[wear.pim]", "E0204", "did you mean `pin`?"),
    ("5b", r#"["crank", "rod"]"#, r#"["crank", "rodd"]"#, "E0204", "did you mean `rod`?"),
    ("5c", r#"["A", "B"]"#, r#"["A", "C"]"#, "E0204", "there are: `O`, `A`, `B`"),
    ("5d", "pin = \"-0.2 rad\"", "pinn = \"-0.2 rad\"", "E0204", "did you mean `pin`?"),
    ("6c", "pin = \"-0.2 rad\"", "R1 = \"0.5 rad\"", "E0410", "put the start into the motion"),
    ("7", r#"drive = "2*pi*speed*t""#, r#"damping = "0.1 N s/m""#, "E0303", "0.1 N m s/rad"),
    ("8a", r#""25 um""#, r#""25 mm""#, "E0415", "difference of the radii"),
    ("8b", r#""25 um""#, r#""2.5 mm""#, "W0114", "difference of the radii"),
    (
        "9",
        r#"density = "steel" }
rod"#,
        r#"density = "stel" }
rod"#,
        "E0204",
        "did you mean `steel`?",
    ),
    (
        "10",
        r#"L1 = "40 mm"
L2 = "160 mm""#,
        r#"L1 = "L2/4"
L2 = "4*L1""#,
        "E0207",
        "give one of them a value",
    ),
    ("13", "threshold =", "treshold =", "E0104", "did you mean `threshold`?"),
    ("14", "2*pi*speed*t", "speed*t", "W0111", "write `2*pi*speed*t`"),
    ("15a", "\"2*pi*speed*t\"", "\"speed\"", "E0303", "write \"2*pi*speed*t\""),
    ("15b", "\"2*pi*speed*t\"", "\"60 deg/s\"", "E0303", "write \"60 deg/s*t\""),
    ("16", "coefficient = 1e-8", "coefficient = \"1e-14 m^2/N\"", "E0303", "a pure number such as 1e-8"),
    ("17a", "\"3.5 GPa\"", "\"120 HB\"", "E0302", "\"1.177 GPa\""),
    ("17b", "\"3.5 GPa\"", "120", "E0304", "Brinell"),
    (
        "18",
        r#"[clearance.pin]
radial = "c0"
journal_radius = "12 mm"
length = "20 mm"
modulus = "115 GPa"
restitution = 0.9
friction = 0.05
"#,
        "",
        "E0415",
        "add `[clearance.pin]`",
    ),
    ("19", r#"radial = "c0""#, "radial = c0", "E0101", "stand in quotes"),
    ("20", "pin = { revolute", "R1 = { revolute", "E0101", "give the other a name of its own"),
    ("21", r#""160 mm""#, r#""160,5 mm""#, "E0301", "write `160.5`"),
    ("24", r#""80 um""#, r#""100 mm""#, "W0114", "check the unit"),
    ("26", "[clearance.pin]", "[clearance.guide]", "E0415", "revolute and spherical joints can"),
    ("density", r#"steel = "7850 kg/m^3""#, r#"steel = "7.85 kg/m^3""#, "W0113", "steel has 7850 kg/m^3"),
    (
        "inertia",
        r#"["1e-4 kg m^2","#,
        r#"["100 kg m^2", "100 kg m^2", "100 kg m^2"] } # "#,
        "W0112",
        "the units of its numbers",
    ),
    ("modulus", r#""115 GPa""#, r#""80 MPa""#, "W0113", "115 GPa"),
];

fn answer(text: &str, overrides: &[(&str, &str)]) -> Diagnostics {
    let source = SourceFile { name: "press.toml".into(), text: text.into() };
    let overrides = overrides.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
    match compile(&source, &Options { overrides, ..Options::default() }) {
        Ok(compiled) => Diagnostics::from_list(compiled.warnings),
        Err(errors) => errors,
    }
}

#[test]
fn the_right_file_is_taken_without_a_word() {
    assert_eq!(answer(RIGHT, &[]).to_string(), "");
}

#[test]
fn every_mistake_leads_to_its_cure() {
    let mut failures = Vec::new();
    for (number, right, wrong, code, cure) in MISTAKES {
        assert!(RIGHT.contains(right), "{number}: {right}");
        let answer = answer(&RIGHT.replacen(right, wrong, 1), &[]);
        let entries = answer.entries();
        let told = entries.iter().any(|entry| entry.code == *code && entry.help.contains(cure));
        if !told {
            failures.push(format!("{number}: {code} with \"{cure}\" is not in\n{answer}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}

#[test]
fn a_crank_that_is_too_long_is_told_where_it_ends() {
    // Without clearance: what holds it is kinematics.
    let ideal = RIGHT.split("[clearance.pin]").next().unwrap_or_default().replace("40 mm", "170 mm");
    let answer = answer(&ideal, &[]);
    // The rod stands across the guide where sin(phi) = 160/170.
    let entry = answer.entries().into_iter().find(|entry| entry.code == "W0116").expect("it cannot turn");
    assert!(entry.message.contains("turns only to 70.2 deg"), "{answer}");
}

#[test]
fn an_override_keeps_the_unit_of_the_file_and_turns_are_no_radians() {
    let wrong = |value: &str| {
        let entries = answer(RIGHT, &[("speed", value)]).entries();
        entries.into_iter().map(|entry| (entry.code, entry.help)).next()
    };
    let (code, help) = wrong("10").expect("an error");
    assert!(code == "E0304" && help.contains("--set speed=\"10 rpm\""), "{code} {help}");
    let (code, help) = wrong("10 rad/s").expect("an error");
    assert!(code == "E0303" && help.contains("a turn is 2*pi rad"), "{code} {help}");
    assert_eq!(wrong("5 Hz"), None);
    assert_eq!(wrong("5 1/s"), None);
}

#[test]
fn a_warning_is_switched_off_by_its_code() {
    let odd = RIGHT.replacen("steel = \"7850", "steel = \"7.85", 1);
    assert!(answer(&odd, &[]).entries().iter().all(|entry| entry.code == "W0113"));
    assert_eq!(answer(&format!("{odd}\n[check]\nallow = [\"W0113\"]\n"), &[]).to_string(), "");
}
