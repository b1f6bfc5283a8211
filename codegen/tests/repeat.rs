//! Groups whose cells differ, and hang on each other by couplings: the same as written out.

use linkwear_codegen::{Compiled, Diagnostics, Options, SourceFile, compile};

const GROUP: &str = r#"spec = 1
name = "train"
gravity = [0, 0, 0]

[parameters]
modulus = "2 mm"
steel = "7850 kg/m^3"

[points]
P0 = [0, 0, 0]
Q0 = [0, 0, "10 mm"]

[bodies]
wheel0 = { rod = ["P0", "Q0"], radius = "10*modulus", density = "steel" }

[joints]
R0 = { revolute = ["ground", "wheel0"], at = "P0", axis = [0, 0, 1], drive = "2*pi*(1 Hz)*t" }

[repeat.train]
count = 3
values = { d = ["20 mm", "40 mm", "70 mm"], r = "{d}/2", x = ["30 mm", "60 mm", "115 mm"], zs = "{d}/modulus", before = [20, 10, 20] }

[repeat.train.points]
"P{i}" = ["{x}", 0, 0]
"Q{i}" = ["{x}", 0, "10 mm"]

[repeat.train.bodies]
"wheel{i}" = { rod = ["P{i}", "Q{i}"], radius = "{r}", density = "steel" }

[repeat.train.joints]
"R{i}" = { revolute = ["ground", "wheel{i}"], at = "P{i}", axis = [0, 0, 1], damping = "{i}*1e-3 N m s/rad" }

[repeat.train.couplings]
"mesh{i}" = { gears = ["wheel{i-1}", "wheel{i}"], teeth = ["{before}", "{zs}"] }
"#;

const FLAT: &str = r#"spec = 1
name = "train"
gravity = [0, 0, 0]

[parameters]
modulus = "2 mm"
steel = "7850 kg/m^3"

[points]
P0 = [0, 0, 0]
Q0 = [0, 0, "10 mm"]
P1 = ["30 mm", 0, 0]
Q1 = ["30 mm", 0, "10 mm"]
P2 = ["60 mm", 0, 0]
Q2 = ["60 mm", 0, "10 mm"]
P3 = ["115 mm", 0, 0]
Q3 = ["115 mm", 0, "10 mm"]

[bodies]
wheel0 = { rod = ["P0", "Q0"], radius = "10*modulus", density = "steel" }
wheel1 = { rod = ["P1", "Q1"], radius = "(20 mm)/2", density = "steel" }
wheel2 = { rod = ["P2", "Q2"], radius = "(40 mm)/2", density = "steel" }
wheel3 = { rod = ["P3", "Q3"], radius = "(70 mm)/2", density = "steel" }

[joints]
R0 = { revolute = ["ground", "wheel0"], at = "P0", axis = [0, 0, 1], drive = "2*pi*(1 Hz)*t" }
R1 = { revolute = ["ground", "wheel1"], at = "P1", axis = [0, 0, 1], damping = "1e-3 N m s/rad" }
R2 = { revolute = ["ground", "wheel2"], at = "P2", axis = [0, 0, 1], damping = "2e-3 N m s/rad" }
R3 = { revolute = ["ground", "wheel3"], at = "P3", axis = [0, 0, 1], damping = "3e-3 N m s/rad" }

[couplings]
mesh1 = { gears = ["wheel0", "wheel1"], teeth = [20, 10] }
mesh2 = { gears = ["wheel1", "wheel2"], teeth = [10, 20] }
mesh3 = { gears = ["wheel2", "wheel3"], teeth = [20, 35] }
"#;

fn compiled(text: &str) -> Result<Compiled, Diagnostics> {
    compile(&SourceFile { name: "train.toml".into(), text: text.into() }, &Options::default())
}

#[test]
fn cells_with_values_and_couplings_are_what_is_written_out() {
    let group = compiled(GROUP).unwrap_or_else(|errors| panic!("{errors}"));
    let flat = compiled(FLAT).unwrap_or_else(|errors| panic!("{errors}"));
    let code = |compiled: &Compiled| compiled.rust_source().replace(&compiled.sha256(), "");
    let (one, other) = (code(&group), code(&flat));
    let differ = one.lines().zip(other.lines()).find(|(a, b)| a != b);
    assert!(one == other, "{differ:#?}");
}

#[test]
fn values_that_do_not_fit_are_refused_where_they_are() {
    let mut wrong = Vec::new();
    for (from, to, told, cure) in [
        ("[20, 10, 20]", "[20, 10]", "has 2 values for 3 cells", "one for each cell"),
        ("r = \"{d}/2\"", "i = \"{d}/2\"", "the name of the index", "another name"),
        ("radius = \"{r}\"", "radius = \"{rr}\"", "hold no whole number", "`{r}`"),
        ("r = \"{d}/2\"", "r = \"{zs}/2\"", "hold no whole number", "`{d}`"),
    ] {
        assert!(GROUP.contains(from));
        let Err(errors) = compiled(&GROUP.replace(from, to)) else {
            wrong.push(format!("{told}: compiles"));
            continue;
        };
        let found = errors.entries();
        let is_told = |entry: &linkwear_codegen::diagnostic::Entry| {
            entry.code == "E0110" && entry.message.contains(told) && entry.help.contains(cure)
        };
        if !found.iter().any(is_told) {
            wrong.push(format!("{told}: {errors}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

const AXES: &str = r#"spec = 1
name = "axes"
gravity = [0, "-9.81 m/s^2", 0]

[parameters]
k = { value = "2 N m", tunable = true }

[points]
P0 = [0, 0, 0]

[bodies]
arm0 = { mass = "1 kg", centre = "P0", inertia = ["0.1 kg m^2", "0.1 kg m^2", "0.1 kg m^2"] }

[joints]
R0 = { revolute = ["ground", "arm0"], at = "P0", axis = [0, 0, 1] }

[sensors]
total = "0.1*R0.q"
"#;

const CELLS: &str = r#"
[repeat.axis]
count = 2
values = { goal = ["10 deg", "-20 deg"] }

[repeat.axis.points]
"P{i}" = ["{i}*0.2 m", 0, 0]

[repeat.axis.bodies]
"arm{i}" = { mass = "1 kg", centre = "P{i}", inertia = ["0.1 kg m^2", "0.1 kg m^2", "0.1 kg m^2"] }

[repeat.axis.joints]
"R{i}" = { revolute = ["arm{i-1}", "arm{i}"], at = "P{i-1}", axis = [0, 0, 1], force = "hold{i} + lead{i} - heat{i}*(0.01 N m/J)" }

[repeat.axis.states]
"heat{i}" = { initial = "{i}*1 J", rate = "0.1*abs(R{i}.Mz*R{i}.v) - heat{i}/(2 s)" }

[repeat.axis.sensors]
"sum{i}" = "R{i}.q + R{i-1}.q"

[repeat.axis.controllers]
"hold{i}" = { measured = "sum{i}", setpoint = "{goal}", proportional = "k", integral = "k/({i}*1 s)", upper = "3 N m", sample_time = "2 ms" }
"lead{i}" = { sample_time = "4 ms", output = "hold{i} + (1 N m)*lead{i}.x", states = { x = { initial = 0.1, next = "0.5*lead{i}.x + R{i}.q" } } }
"#;

const WRITTEN_OUT: &str = r#"
[states]
heat1 = { initial = "1*1 J", rate = "0.1*abs(R1.Mz*R1.v) - heat1/(2 s)" }
heat2 = { initial = "2*1 J", rate = "0.1*abs(R2.Mz*R2.v) - heat2/(2 s)" }

[controllers]
hold1 = { measured = "sum1", setpoint = "10 deg", proportional = "k", integral = "k/(1*1 s)", upper = "3 N m", sample_time = "2 ms" }
lead1 = { sample_time = "4 ms", output = "hold1 + (1 N m)*lead1.x", states = { x = { initial = 0.1, next = "0.5*lead1.x + R1.q" } } }
hold2 = { measured = "sum2", setpoint = "-20 deg", proportional = "k", integral = "k/(2*1 s)", upper = "3 N m", sample_time = "2 ms" }
lead2 = { sample_time = "4 ms", output = "hold2 + (1 N m)*lead2.x", states = { x = { initial = 0.1, next = "0.5*lead2.x + R2.q" } } }
"#;

/// Tables that the file has too: behind what stands there.
const CELLS_WRITTEN_OUT: [(&str, &str); 4] = [
    ("P0 = [0, 0, 0]\n", "P1 = [\"0.2 m\", 0, 0]\nP2 = [\"0.4 m\", 0, 0]\n"),
    (
        "\"0.1 kg m^2\"] }\n",
        r#"arm1 = { mass = "1 kg", centre = "P1", inertia = ["0.1 kg m^2", "0.1 kg m^2", "0.1 kg m^2"] }
arm2 = { mass = "1 kg", centre = "P2", inertia = ["0.1 kg m^2", "0.1 kg m^2", "0.1 kg m^2"] }
"#,
    ),
    (
        "axis = [0, 0, 1] }\n",
        r#"R1 = { revolute = ["arm0", "arm1"], at = "P0", axis = [0, 0, 1], force = "hold1 + lead1 - heat1*(0.01 N m/J)" }
R2 = { revolute = ["arm1", "arm2"], at = "P1", axis = [0, 0, 1], force = "hold2 + lead2 - heat2*(0.01 N m/J)" }
"#,
    ),
    ("total = \"0.1*R0.q\"\n", "sum1 = \"R1.q + R0.q\"\nsum2 = \"R2.q + R1.q\"\n"),
];

#[test]
fn cells_have_states_sensors_and_controllers_of_their_own() {
    let mut flat = AXES.to_owned();
    for (behind, more) in CELLS_WRITTEN_OUT {
        flat = flat.replacen(behind, &format!("{behind}{more}"), 1);
    }
    let [group, flat] = [format!("{AXES}{CELLS}"), format!("{flat}{WRITTEN_OUT}")]
        .map(|text| compiled(&text).unwrap_or_else(|errors| panic!("{errors}")));
    let code = |compiled: &Compiled| compiled.rust_source().replace(&compiled.sha256(), "");
    let (one, other) = (code(&group), code(&flat));
    let differ = one.lines().zip(other.lines()).find(|(a, b)| a != b);
    assert!(one == other, "{differ:#?}");
    // A cell may not ask for what a later one puts out.
    let early =
        format!("{AXES}{CELLS}").replace("setpoint = \"{goal}\"", "setpoint = \"{goal} + hold{i+1}/k\"");
    let errors = compiled(&early).expect_err("it asks for what comes later");
    assert!(errors.to_string().contains("`hold2` acts later"), "{errors}");
}
