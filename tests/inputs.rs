//! Inputs: signals from outside act as the formulas that they are samples of; tables of them are read with their units,
//! and refused where they cannot be right.

mod command;

use command::{Folder, linkwear};
use linkwear::mechanism::Mechanism;
use linkwear_runtime::{Integrator, SampledSignals, Settings, Simulation, Span, Watch, simulate_with_inputs};

/// An arm pushed by a torque and a load.
const MOTOR: &str = r#"
spec = 1
name = "motor"
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[inputs]
torque = { unit = "N m", default = 0.5 }
load = "2 N"
[points]
pivot = ["0 m", "0 m", "0 m"]
tip = ["300 mm", "0 m", "0 m"]
[bodies]
arm = { rod = ["pivot", "tip"], radius = "10 mm", density = "7850 kg/m^3" }
[joints]
A = { revolute = ["ground", "arm"], at = "pivot", axis = [0, 0, 1], damping = "0.02 N m s/rad", force = "torque" }
[forces]
weight = { force = "arm", at = "tip", components = ["0 N", "-load", "0 N"] }
[initial]
A = { q = "-30 deg", v = "0 rad/s" }
"#;

/// A four-bar whose crank follows an input, with a motion of its own on top.
const DRIVE: &str = r#"
spec = 1
name = "crank"
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[inputs]
angle = { unit = "deg", default = 10 }
[points]
O = ["0 m", "0 m", "0 m"]
A = ["0.1 m", "0 m", "0 m"]
D = ["0.3 m", "0 m", "0 m"]
C = { coupler = ["0.4 m", "0 m", "0 m"], rocker = ["0.55 m", "0 m", "0 m"] }
[bodies]
crank = { rod = ["O", "A"], radius = "5 mm", density = "7850 kg/m^3" }
coupler = { rod = ["A", "C"], radius = "5 mm", density = "7850 kg/m^3" }
rocker = { rod = ["D", "C"], radius = "5 mm", density = "7850 kg/m^3" }
[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "2*angle + 0.1*sin(t*(3 rad/s))" }
R2 = { revolute = ["crank", "coupler"], at = "A", axis = [0, 0, 1] }
R3 = { revolute = ["coupler", "rocker"], at = "C", axis = [0, 0, 1] }
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1] }
[assembly]
R2 = "56 deg"
R4 = "97 deg"
"#;

/// The last row of a run, by column.
fn last_row(folder: &Folder, text: &str, options: &[&str]) -> Vec<(String, f64)> {
    let (file, out) = (folder.path("m.toml"), folder.path("out.csv"));
    std::fs::write(&file, text).unwrap();
    let answer = linkwear(&[&["simulate", &file, "--time", "2", "--out", &out], options].concat());
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    let table = std::fs::read_to_string(&out).unwrap();
    let header = table.lines().next().unwrap().split(',').map(str::to_owned);
    let row = table.lines().last().unwrap().split(',').map(|cell| cell.parse().unwrap());
    header.zip(row).collect()
}

fn value(row: &[(String, f64)], column: &str) -> f64 {
    row.iter().find(|(name, _)| name == column).unwrap_or_else(|| panic!("no {column}")).1
}

fn samples(folder: &Folder, header: &str, count: u32, cells: impl Fn(f64) -> String) -> String {
    let rows: String = (0..=count).map(|k| cells(2.0 * f64::from(k) / f64::from(count)) + "\n").collect();
    let file = folder.path("inputs.csv");
    std::fs::write(&file, format!("{header}\n{rows}")).unwrap();
    file
}

#[test]
fn samples_of_a_force_act_as_its_formula() {
    let folder = Folder::new("inputs-force");
    let by_formula = MOTOR
        .replace("force = \"torque\"", "force = \"torque + 0.5 N m + (1 N m)*sin(t*(5 rad/s))\"")
        .replace("default = 0.5", "default = -0.5")
        .replace("-load", "-load - t*(1 N/s)");
    let exact = last_row(&folder, &by_formula, &[]);
    let mut errors = Vec::new();
    for count in [400, 800] {
        // In other units than the file's, in another order, and with the columns' names of an output.
        let cells = |t: f64| format!("{},{},{}", 2.0 + t, 1e3 * t, 1e3 * (5.0 * t).sin());
        let file = samples(&folder, "load [N],time [ms],torque.u [N mm]", count, cells);
        let row = last_row(&folder, MOTOR, &["--inputs", &file]);
        assert!((value(&row, "torque.u [N m]") - (10.0_f64).sin()).abs() < 1e-15);
        assert_eq!(value(&row, "load.u [N]"), 4.0);
        errors.push((value(&row, "A.q [rad]") - value(&exact, "A.q [rad]")).abs());
    }
    // Straight lines between samples lie 1 N m (5 rad/s h)^2/12 inside of the sine on average, 2e-6 N m of 0.02 kg m^2 at
    // 2.5 ms, and a fourth of that at half the distance.
    assert!(errors[0] < 1e-3 && errors[1] < 0.3 * errors[0], "{errors:?}");
}

#[test]
fn a_drive_follows_samples_with_their_rates() {
    let folder = Folder::new("inputs-drive");
    let formula = DRIVE.replace("2*angle", "2*(0.4*sin(t*(2 rad/s))) + 0*angle");
    let exact = last_row(&folder, &formula, &[]);
    let mut errors = Vec::new();
    for count in [100, 200] {
        let cells = |t: f64| format!("{t},{}", (0.4 * (2.0 * t).sin()).to_degrees());
        let file = samples(&folder, "t [s],angle [deg]", count, cells);
        let row = last_row(&folder, DRIVE, &["--inputs", &file]);
        let error = |column: &str| (value(&row, column) - value(&exact, column)).abs();
        // The end of a spline is met; its rates have errors of h^3 and h^2 times derivatives of about ten.
        assert!(error("R1.q [rad]") < 1e-12);
        assert!(error("R1.v [rad/s]") < 1e-4 && error("R4.v [rad/s]") < 1e-4);
        errors.push(error("R1.a [rad/s^2]"));
    }
    assert!(errors[0] < 2e-2 && errors[1] < 0.3 * errors[0], "{errors:?}");
}

#[test]
fn columns_count_turns_where_their_inputs_do() {
    let folder = Folder::new("inputs-turns");
    let text =
        DRIVE.replace("angle = { unit = \"deg\", default = 10 }", "rate = \"1 Hz\"\nspin = \"1 rad/s\"");
    let text = text.replace("2*angle", "0.01*sin(2*pi*rate*(1 s)) + 0.01*sin(spin*(1 s))");
    let file = folder.path("m.toml");
    std::fs::write(&file, text).unwrap();
    let run = |header: &str| {
        let inputs = samples(&folder, header, 4, |t| format!("{t},1"));
        linkwear(&["simulate", &file, "--time", "2", "--inputs", &inputs])
    };
    for (header, message, cure) in [
        ("t [s],rate [rad/s]", "counts radians, but `rate` counts turns", "gives `rate` in Hz"),
        ("t [s],spin.u [rpm]", "counts turns, but `spin.u` counts radians", "gives `spin.u` in rad/s"),
    ] {
        let answer = run(header);
        assert_ne!(answer.code, 0, "{header}");
        assert!(answer.err.contains(message) && answer.err.contains(cure), "{}", answer.err);
    }
    for header in ["t [s],rate [rpm]", "t [s],rate.u [1/s]", "t [s],spin [deg/s]"] {
        let answer = run(header);
        assert_eq!(answer.code, 0, "{header}: {}", answer.err);
    }
}

#[test]
fn a_short_pulse_is_not_leapt_over() {
    let folder = Folder::new("inputs-pulse");
    let quiet = MOTOR.replace("\"-9.81 m/s^2\"", "\"0 m/s^2\"").replace("load = \"2 N\"", "load = \"0 N\"");
    let quiet = quiet.replace(", damping = \"0.02 N m s/rad\"", "").replace("default = 0.5", "default = 0");
    let file = folder.path("inputs.csv");
    // A triangle of 2 ms and 1000 N m, 1 N m s, in two seconds of nothing.
    std::fs::write(&file, "t [s],torque [N m]\n0,0\n1.499,0\n1.5,1000\n1.501,0\n2,0\n").unwrap();
    let row = last_row(&folder, &quiet, &["--inputs", &file]);
    let mass = 7850.0 * std::f64::consts::PI * 0.01_f64.powi(2) * 0.3;
    let inertia = mass * (0.3_f64.powi(2) / 3.0 + 0.01_f64.powi(2) / 4.0);
    // Steps end at every row, so the impulse is exact but for the tolerance of the method, 1e-9.
    assert!((value(&row, "A.v [rad/s]") * inertia - 1.0).abs() < 1e-8);
}

#[test]
fn a_simulation_takes_inputs_as_they_come() {
    let folder = Folder::new("inputs-steps");
    let file = folder.path("m.toml");
    std::fs::write(&file, MOTOR).unwrap();
    let mechanism = Mechanism::read(&file).unwrap();
    let (system, description) = (mechanism.system(), &mechanism.description);
    let samples = samples(&folder, "t [s],torque [N m]", 2000, |t| format!("{t},{}", (5.0 * t).sin()));
    let exact = last_row(&folder, MOTOR, &["--inputs", &samples]);
    let settings = Settings { span: Span::Time(2.0), samples: 0, ..Settings::default() };
    let mut errors = Vec::new();
    for steps in [200, 400] {
        let h = 2.0 / f64::from(steps);
        let mut run = Simulation::start(&*system, description, &mechanism.parameters, &settings).unwrap();
        for step in 0..steps {
            // A controller that holds its torque for a step: the value in its middle.
            let mut parameters = mechanism.parameters.clone();
            parameters[description.tunable()] = (5.0 * h * (f64::from(step) + 0.5)).sin();
            run.set_parameters(&parameters).unwrap();
            run.advance(h * f64::from(step + 1), Watch::NONE).unwrap();
        }
        let angle = run.channels().iter().position(|channel| channel.name == *"A.q").unwrap();
        errors.push((run.values()[angle] - value(&exact, "A.q [rad]")).abs());
    }
    // Held in the middle of steps a torque is off by the square of their length: a fourth at half the length.
    assert!(errors[0] < 5e-3 && errors[1] < 0.3 * errors[0], "{errors:?}");
}

#[test]
fn without_a_table_an_input_is_a_constant() {
    let folder = Folder::new("inputs-constant");
    let constant = MOTOR.replace("force = \"torque\"", "force = \"torque*0 + 0.75 N m\"");
    let exact = value(&last_row(&folder, &constant, &[]), "A.q [rad]");
    let set = value(&last_row(&folder, MOTOR, &["--set", "torque=750 N mm"]), "A.q [rad]");
    // Other operations, so other roundings.
    assert!((exact - set).abs() < 1e-12);
}

/// A wheel that is pushed and braked from rest: after a second it turns with (torque - brake)/J.
const WHEEL: &str = r#"
spec = 1
name = "wheel"
gravity = [0, 0, 0]
[parameters]
J = "1 kg m^2"
[inputs]
torque = "1 N m"
brake = "0 N m"
[points]
O = [0, 0, 0]
[bodies]
wheel = { mass = "1 kg", centre = "O", inertia = ["J", "J", "J"] }
[joints]
R = { revolute = ["ground", "wheel"], at = "O", axis = [0, 0, 1], force = "torque - brake" }
"#;

#[test]
fn a_study_varies_inputs_beside_those_of_a_table() {
    let folder = Folder::new("inputs-study");
    let (file, inputs) = (folder.path("m.toml"), folder.path("inputs.csv"));
    std::fs::write(&file, WHEEL).unwrap();
    std::fs::write(&inputs, "t [s],torque [N m]\n0,1\n1,1\n").unwrap();
    let study = |more: &[&str]| {
        let words = ["study", &file, "--time", "1", "--inputs", &inputs, "--of", "final.R.v,final.brake.u"];
        linkwear(&[&words[..], more, &["--format", "json"]].concat())
    };
    // Compiled once, and anew for every inertia.
    let brakes = ["--vary", "brake=0 N m,0.5 N m,1 N m"];
    for inertias in [&[][..], &["--vary", "J=1 kg m^2,2 kg m^2"]] {
        let answer = study(&[&brakes, inertias].concat()).json();
        let rows = answer["rows"].as_array().unwrap();
        assert_eq!(rows.len(), 3 * inertias.len().max(1));
        for row in rows {
            let number = |at: usize| row[at].as_f64().unwrap();
            let (inertia, first) = if inertias.is_empty() { (1.0, 1) } else { (number(1), 2) };
            // By rounding of one, over the steps of a second.
            assert!((number(first) - (1.0 - number(0)) / inertia).abs() < 1e-12, "{row}");
            assert_eq!(row[first + 1], row[0]);
        }
    }
    let answer = study(&["--vary", "torque=1 N m,2 N m"]);
    let error = &answer.errors()[0];
    assert_eq!((answer.code, error["code"].as_str()), (2, Some("C0001")));
    let told = format!("{} {}", error["message"], error["help"]);
    assert!(told.contains("`torque` varies and is given over time") && told.contains("its column"), "{told}");
}

#[test]
fn an_input_that_is_set_and_given_over_time_is_refused() {
    let folder = Folder::new("inputs-set");
    let (file, inputs) = (folder.path("m.toml"), folder.path("inputs.csv"));
    std::fs::write(&file, WHEEL).unwrap();
    std::fs::write(&inputs, "t [s],torque [N m]\n0,1\n1,1\n").unwrap();
    let over_time = [&file, "--time", "1", "--inputs", &*inputs];
    for words in [&["simulate"][..], &["study", "--vary", "brake=0 N m,1 N m", "--of", "final.R.v"]] {
        let asked = |set: &str| linkwear(&[words, &over_time, &["--set", set, "--format", "json"]].concat());
        let answer = asked("torque=3 N m");
        let error = &answer.errors()[0];
        assert_eq!((answer.code, error["code"].as_str()), (2, Some("C0001")), "{words:?}");
        let told = format!("{} {}", error["message"], error["help"]);
        assert!(told.contains("`torque` is set and given over time"), "{told}");
        assert!(told.contains("--inputs") && told.contains("`--set torque`"), "{told}");
        assert_eq!(
            asked("brake=0.5 N m").code,
            i32::from(words.len() > 1) * 2,
            "another input, unless it varies"
        );
    }
}

#[test]
fn a_run_has_the_values_of_its_parameters_where_nothing_is_connected() {
    let folder = Folder::new("inputs-run");
    let file = folder.path("m.toml");
    std::fs::write(&file, WHEEL).unwrap();
    let mechanism = Mechanism::read(&file).unwrap();
    let description = &mechanism.description;
    let columns = [("torque".to_owned(), vec![1.0, 1.0])];
    let signals = SampledSignals::new(description, vec![0.0, 1.0], &columns).unwrap();
    assert!(signals.connects(0) && !signals.connects(1));
    let mut parameters = mechanism.parameters.clone();
    parameters[description.tunable() + 1] = 0.25;
    let settings = Settings::new(Integrator::adaptive(description, None), Span::Time(1.0), 2);
    let system = mechanism.system();
    let run = simulate_with_inputs(&*system, description, &parameters, &signals, &settings, Watch::NONE);
    let run = run.unwrap();
    let speed = run.rows.last().unwrap()[run.index("R.v").unwrap()];
    assert!((speed - 0.75).abs() < 1e-12, "{speed}");
}

#[test]
fn a_life_over_time_is_refused_with_the_cure() {
    let folder = Folder::new("inputs-life");
    let (file, inputs) = (folder.path("m.toml"), folder.path("inputs.csv"));
    let pushed = MOTOR
        .replace("[initial]\nA = { q = \"-30 deg\", v = \"0 rad/s\" }\n", "")
        .replace("damping = \"0.02 N m s/rad\", force = \"torque\"", "drive = \"2*pi*2 Hz*t\"")
        .replace("torque = { unit = \"N m\", default = 0.5 }\n", "");
    let worn = "[parameters]\nc0 = \"20 um\"\n[clearance.A]\nradial = \"c0\"\njournal_radius = \"10 mm\"\nlength = \"20 mm\"\nmodulus = \"115 GPa\"\n\
                restitution = 0.9\nfriction = 0.05\n[wear.A]\ncoefficient = 1e-8\nhardness = \"3.5 GPa\"\n\
                threshold = \"80 um\"\nrevolutions_per_cycle = 1e7\n";
    std::fs::write(&file, pushed + worn).unwrap();
    std::fs::write(&inputs, "t [s],load [N]\n0,30\n1,30\n").unwrap();
    let words = ["study", &file, "--inputs", &inputs, "--of", "A.depth_m,life.mean_path"];
    let answer = linkwear(&[&words[..], &["--vary", "c0=20um,30um", "--format", "json"]].concat());
    let error = &answer.errors()[0];
    assert_eq!((answer.code, error["code"].as_str()), (2, Some("C0001")), "{}", answer.err);
    let told = format!("{} {}", error["message"], error["help"]);
    assert!(told.contains("`life.mean_path` is of a life") && told.contains("by a mission"), "{told}");
}

#[test]
fn wrong_tables_are_refused_with_the_cure() {
    let folder = Folder::new("inputs-wrong");
    let (motor, inputs) = (folder.path("m.toml"), folder.path("inputs.csv"));
    std::fs::write(&motor, MOTOR).unwrap();
    let cases = [
        ("t [s],torqe [N m]\n0,0\n2,0\n", "no input `torqe`", "did you mean `torque`?"),
        ("t [s],torque\n0,0\n2,0\n", "`torque` has no unit", "torque [N m]"),
        ("t [s],torque [N]\n0,0\n2,0\n", "`N` is no unit of `torque`", "N m"),
        ("torque [N m]\n0\n2\n", "no column gives the time", "t [s]"),
        ("t [s],time [s]\n0,0\n2,0\n", "two columns give the time", "delete one"),
        ("t [s],load [N],load [N]\n0,0,0\n2,0,0\n", "two columns give the input `load`", "delete one"),
        ("t [s],load [N]\n0,0\n2,0\n1,0\n", "not later than the one before", "times rising"),
        ("t [s],load [N]\n0,0\n2,x\n", "`x`, not a finite number", ""),
        ("t [s],load [N]\n", "there is none", "one row"),
        ("t [s],load [N]\n0,0\n1,0\n", "the run is from 0 s to 2 s", "shorter run"),
        ("t [s],load [N]\n1,0\n2,0\n", "known from 1 s", ""),
    ];
    for (table, message, cure) in cases {
        std::fs::write(&inputs, table).unwrap();
        let answer = linkwear(&["simulate", &motor, "--time", "2", "--inputs", &inputs]);
        assert_eq!(answer.code, 1, "{table}{}", answer.out);
        assert!(answer.err.contains(message) && answer.err.contains(cure), "{table}{}", answer.err);
    }
}

#[test]
fn wrong_uses_of_inputs_are_refused_with_the_cure() {
    let folder = Folder::new("inputs-uses");
    let file = folder.path("m.toml");
    let cases = [
        ("tip = [\"300 mm\"", "tip = [\"300 mm + load*(1 mm/N)\"", "the input `load` cannot be used here"),
        ("load = \"2 N\"", "load = {}", "neither unit nor default"),
        ("default = 0.5", "default = \"0.5 N\"", "torque"),
        ("unit = \"N m\"", "unit = \"N q\"", "torque"),
        ("load = \"2 N\"", "load = \"2 N\"\nspare = \"1 N\"", "nothing uses the input `spare`"),
        (
            "load = \"2 N\"",
            "load = \"2 N\"\narm = \"1 N\"",
            "the name `arm` is given to an input and to a body",
        ),
    ];
    for (from, to, message) in cases {
        std::fs::write(&file, MOTOR.replace(from, to)).unwrap();
        let answer = linkwear(&["check", &file]);
        let text = answer.out + &answer.err;
        assert!(text.contains(message), "{message}: {text}");
    }
}
