//! Units of FMI 3.0 under a driver in C, whose types and signatures are those of the standard: the bits of `simulate`, kept
//! states, model exchange with events, derivatives, wrong calls. FMPy looks at them where it is installed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use linkwear::fmu;
use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_fmu::{PROGRAM_FILE, Unit, Variable, Variables};
use linkwear_native::Native;
use linkwear_runtime::{Integrator, Settings, Span, Watch, channels, simulate};

fn compiled(name: &str) -> Compiled {
    let path = format!("mechanisms/{name}.toml");
    let text = fs::read_to_string(&path).expect("a mechanism");
    compile(&SourceFile { name: path, text }, &Options::default()).expect("no errors")
}

/// A unit, unpacked.
struct Unpacked {
    folder: tempfile::TempDir,
    compiled: Compiled,
    unit: Unit,
    binary: PathBuf,
}

/// Files of an archive, by its directory at the end.
fn files(archive: &[u8]) -> Vec<(String, Vec<u8>)> {
    let short = |at: usize| usize::from(u16::from_le_bytes([archive[at], archive[at + 1]]));
    let long = |at: usize| short(at) + (short(at + 2) << 16);
    let end = archive.len() - 22;
    let (count, mut at) = (short(end + 10), long(end + 16));
    let mut files = Vec::new();
    for _ in 0..count {
        assert_eq!(&archive[at..at + 4], b"PK\x01\x02");
        let (method, packed, size, name, head) =
            (short(at + 10), long(at + 20), long(at + 24), short(at + 28), long(at + 42));
        let title = String::from_utf8(archive[at + 46..at + 46 + name].to_vec()).expect("a name");
        let begin = head + 30 + short(head + 26) + short(head + 28);
        let stored = &archive[begin..begin + packed];
        let content = match method {
            0 => stored.to_vec(),
            _ => miniz_oxide::inflate::decompress_to_vec(stored).expect("deflated"),
        };
        assert_eq!(content.len(), size);
        files.push((title, content));
        at += 46 + name;
    }
    files
}

/// Mechanisms whose units several tests drive: packing one takes longer than most runs of it.
const SHARED: [&str; 4] = ["pendulum", "rssr_rigid", "rssr_flexible", "rssr"];

impl Unpacked {
    fn new(name: &str) -> Self {
        static UNITS: [OnceLock<(Compiled, Vec<u8>)>; SHARED.len()] =
            [const { OnceLock::new() }; SHARED.len()];
        let place = SHARED.iter().position(|shared| *shared == name).expect("a name of the list");
        let (compiled, bytes) = UNITS[place].get_or_init(|| {
            let compiled = compiled(name);
            let bytes = fmu::unit(&compiled).expect("a unit");
            (compiled, bytes)
        });
        Self::written(compiled.clone(), bytes)
    }

    fn of(compiled: Compiled) -> Self {
        let bytes = fmu::unit(&compiled).expect("a unit");
        Self::written(compiled, &bytes)
    }

    fn written(compiled: Compiled, bytes: &[u8]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("unit.fmu"), bytes).expect("written");
        let mut binary = PathBuf::new();
        for (name, content) in files(bytes) {
            let path = folder.path().join(&name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(&path, content).expect("written");
            if name.starts_with("binaries/") {
                binary = path;
            }
        }
        let program = fs::read(folder.path().join("resources").join(PROGRAM_FILE)).expect("a program");
        let unit = Unit::from_bytes(&program).expect("a unit");
        Self { folder, compiled, unit, binary }
    }

    fn variables(&self) -> Variables {
        Variables::new(&self.unit, &channels(self.compiled.description()))
    }

    /// Runs the driver: mode, stop time, tolerance, rows, further arguments.
    fn drive(
        &self,
        driver: &Path,
        mode: &str,
        (stop, tolerance, rows): (f64, f64, usize),
        more: &[&str],
    ) -> Output {
        let first = self.variables().reference(Variable::Output(0));
        let mut command = Command::new(driver);
        command.arg(&self.binary).arg(self.folder.path().join("resources/"));
        command.args([&*self.unit.instantiation_token, mode]);
        command.args([stop.to_string(), tolerance.to_string(), rows.to_string(), first.to_string()]);
        let outputs = channels(self.compiled.description()).len();
        command.arg(outputs.to_string()).args(more).env("DRIVER_VERBOSE", "1");
        if let Some(first) =
            self.compiled.description().input_infos().position(|(info, _)| info.name == "angle")
        {
            let index = self.compiled.description().tunable() + first;
            command.env("DRIVER_LEADS", self.variables().reference(Variable::Parameter(index)).to_string());
        }
        let output = command.output().expect("the driver runs");
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{mode}: {:?} {told}", output.status);
        output
    }

    /// Builds the library as `buildDescription.xml` says; `more`: further options.
    fn built(&self, more: &[&str]) -> PathBuf {
        let sources = self.folder.path().join("sources");
        let description = fs::read_to_string(sources.join("buildDescription.xml")).expect("how to build");
        let values = |attribute: &str| -> Vec<String> {
            let begin = format!("{attribute}=\"");
            let parts = description.split(&begin).skip(1);
            parts.map(|rest| rest.split('"').next().expect("a value").to_owned()).collect()
        };
        let library = self.folder.path().join(format!("built{}{}", more.len(), std::env::consts::DLL_SUFFIX));
        let mut compiler = Command::new(&values("compiler")[0]);
        compiler
            .args(values("compilerOptions")[0].split(' '))
            .args(["-std=c99", "-Wall", "-Wextra", "-Werror"]);
        compiler.args(more).args(["-shared", "-fPIC"]).current_dir(&sources);
        for element in description.split('<').filter(|element| element.starts_with("SourceFile ")) {
            compiler.arg(element.split('"').nth(1).expect("a file"));
        }
        for folder in description.split('<').filter(|element| element.starts_with("IncludeDirectory ")) {
            compiler.arg("-I").arg(folder.split('"').nth(1).expect("a folder"));
        }
        let done = compiler.args(["-lm", "-o"]).arg(&library).output().expect("a C compiler");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        library
    }

    /// Step of the sources [s].
    fn step_of_sources(&self) -> f64 {
        let file = self.folder.path().join("sources").join(format!("{}_unit.c", self.compiled.c_prefix()));
        let text = fs::read_to_string(file).expect("a source");
        let step = text.split("#define UNIT_STEP ").nth(1).expect("a step");
        step.lines().next().expect("a line").parse().expect("a number")
    }

    fn integrator(&self) -> Integrator {
        Integrator::adaptive(self.compiled.description(), None)
    }
}

/// Rows of hexadecimal numbers as the driver prints them.
fn rows(output: &Output) -> Vec<Vec<f64>> {
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().map(|line| line.split(' ').map(hexadecimal).collect()).collect()
}

/// A number as `%a` prints it.
fn hexadecimal(text: &str) -> f64 {
    let (sign, rest) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let rest = rest.strip_prefix("0x").expect("hexadecimal");
    let (digits, power) = rest.split_once('p').expect("a power");
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    let bits = u64::from_str_radix(&format!("{whole}{part}"), 16).expect("digits");
    let power: i32 = power.parse::<i32>().expect("a power") - 4 * part.len() as i32;
    // In two halves: powers of subnormal numbers have none themselves.
    sign * bits as f64 * 2.0_f64.powi(power / 2) * 2.0_f64.powi(power - power / 2)
}

fn driver(sanitized: bool) -> &'static Path {
    static DRIVERS: [OnceLock<PathBuf>; 2] = [OnceLock::new(), OnceLock::new()];
    DRIVERS[usize::from(sanitized)].get_or_init(|| {
        let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fmu_driver_{sanitized}"));
        let mut compiler = Command::new("cc");
        compiler.args(["-std=gnu11", "-Wall", "-Wextra", "-Werror", "-O1", "-g"]);
        if sanitized {
            compiler.args(["-fsanitize=address,undefined", "-fno-sanitize-recover=undefined"]);
        }
        let done = compiler.arg("tests/fmu/driver.c").arg("-o").arg(&out).args(["-ldl", "-lm"]).output();
        let done = done.expect("a C compiler");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        out
    })
}

#[test]
fn co_simulation_gives_the_bits_of_simulate() {
    for (name, stop) in [("pendulum", 0.7), ("rssr_rigid", 0.5), ("rssr_flexible", 0.25), ("rssr", 0.25)] {
        let unpacked = Unpacked::new(name);
        let (compiled, integrator) = (&unpacked.compiled, unpacked.integrator());
        let settings = Settings::new(integrator, Span::Time(stop), 101);
        let system = Native::new(compiled.tapes(), compiled.sizes()).expect("machine code");
        let run = simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE);
        let run = run.expect("it runs");
        let tolerance = integrator.tolerance().expect("a tolerance");
        let found = rows(&unpacked.drive(driver(false), "cs", (stop, tolerance, 101), &[]));
        assert_eq!(found.len(), 101);
        for ((t, expected), found) in run.times.iter().zip(&run.rows).zip(&found) {
            assert_eq!(found[0], *t);
            assert_eq!(&found[1..], expected, "{name} at {t} s");
        }
    }
}

#[test]
fn kept_states_go_on_with_the_same_bits_in_any_instance() {
    for name in ["rssr_flexible", "rssr"] {
        let unpacked = Unpacked::new(name);
        let tolerance = unpacked.integrator().tolerance().expect("a tolerance");
        let found = rows(&unpacked.drive(driver(false), "states", (0.2, tolerance, 20), &[]));
        assert_eq!(found.len(), 60);
        assert_eq!(found[..20], found[20..40], "{name}");
        assert_eq!(found[..20], found[40..], "{name}");
    }
}

/// Other platforms build the unit from its sources: steps of one length, in the bits of a run with such steps.
#[test]
fn a_library_from_the_sources_gives_the_trajectory() {
    // Beside the unit's own method at a hundredth of its tolerance, as a part of each column's largest value: its rows lie within its steps, where
    // their error is some hundred times the tolerance; steps of one length are off in the phase of the fastest modes (1e-5 seen), and
    // with clearance forces ring at some kilohertz.
    for (name, stop, within) in [
        ("pendulum", 0.5, 1e-8),
        ("rssr_rigid", 0.25, 1e-6),
        ("rssr_flexible", 0.1, 1e-4),
        ("rssr", 0.02, 1e-2),
    ] {
        let mut unpacked = Unpacked::new(name);
        let tolerance = unpacked.integrator().tolerance().expect("a tolerance");
        let own = rows(&unpacked.drive(driver(false), "cs", (stop, 1e-2 * tolerance, 51), &[]));
        unpacked.binary = unpacked.built(&[]);
        let theirs = rows(&unpacked.drive(driver(false), "cs", (stop, tolerance, 51), &[]));
        let compiled = &unpacked.compiled;
        for (column, channel) in channels(compiled.description()).iter().enumerate() {
            let size = own.iter().fold(1e-6_f64, |most, row| most.max(row[column + 1].abs()));
            for (own, theirs) in own.iter().zip(&theirs) {
                let off = (own[column + 1] - theirs[column + 1]).abs() / size;
                assert!(off < within, "{name} {} at {}: {off:e}", channel.name, own[0]);
            }
        }
        // Both ends: rows between are put onto the constraints once more.
        let step = unpacked.step_of_sources();
        let settings = Settings::new(Integrator::Rk4 { step }, Span::Time(stop), 2);
        let system = Native::new(compiled.tapes(), compiled.sizes()).expect("machine code");
        let run = simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE);
        let run = run.expect("it runs");
        let found = rows(&unpacked.drive(driver(false), "cs", (stop, tolerance, 2), &[]));
        for (expected, found) in run.rows.iter().zip(&found) {
            assert_eq!(&found[1..], expected, "{name}");
        }
    }
}

#[test]
fn sources_keep_states_and_refuse_wrong_calls() {
    let sanitizers = ["-fsanitize=address,undefined", "-fno-sanitize-recover=undefined"];
    let mut unpacked = Unpacked::new("rssr");
    let binaries = [(unpacked.built(&[]), false), (unpacked.built(&sanitizers), true)];
    for (binary, sanitized) in binaries {
        unpacked.binary = binary;
        let found = rows(&unpacked.drive(driver(sanitized), "states", (0.02, 1e-6, 5), &[]));
        assert_eq!(found.len(), 15);
        assert_eq!(found[..5], found[5..10]);
        assert_eq!(found[..5], found[10..]);
        unpacked.drive(driver(sanitized), "sources", (0.02, 1e-6, 5), &[]);
    }
}

#[test]
fn model_exchange_with_a_tools_own_method_gives_the_trajectory() {
    // Steps of the driver; part of each column's largest value, by rows of the unit's own method at a tolerance of 1e-10: they
    // lie within its steps, where their error is some hundred times that, and with clearance a step of the driver mixes both sides
    // of an onset.
    for (name, stop, steps, within) in
        [("pendulum", 0.5, 10, 1e-8), ("rssr_rigid", 0.2, 10, 1e-6), ("rssr", 0.02, 200, 1e-5)]
    {
        let unpacked = Unpacked::new(name);
        let own = rows(&unpacked.drive(driver(false), "cs", (stop, 1e-10, 51), &[]));
        let steps: i32 = steps;
        let theirs = rows(&unpacked.drive(driver(false), "me", (stop, 1e-10, 51), &[&steps.to_string()]));
        let channels = channels(unpacked.compiled.description());
        for (column, channel) in channels.iter().enumerate().map(|(place, channel)| (place + 1, channel)) {
            let size = own.iter().fold(1e-6_f64, |most, row| most.max(row[column].abs()));
            for (own, theirs) in own.iter().zip(&theirs) {
                let off = (own[column] - theirs[column]).abs() / size;
                assert!(off < within, "{name} {} at {}: {off:e}", channel.name, own[0]);
            }
        }
    }
}

#[test]
fn derivatives_along_directions_are_those_of_differences() {
    for name in ["rssr_flexible", "rssr"] {
        let unpacked = Unpacked::new(name);
        let output = unpacked.drive(driver(false), "derivatives", (0.1, 1e-9, 2), &[]);
        let text = String::from_utf8_lossy(&output.stdout);
        let numbers: Vec<f64> = text.lines().map(|line| line.parse().expect("a number")).collect();
        // Central differences over 1e-6 of the sizes: rounding of 1e-10 of large derivatives, and the third one.
        assert!(numbers[0] < 1e-4, "{name}: {text}");
        assert!(numbers[1] < 1e-12, "{name}: {text}");
    }
}

/// The rigid RSSR, its crank by another drive.
fn driven_by(drive: &str, inputs: &str) -> Compiled {
    let text = fs::read_to_string("mechanisms/rssr_rigid.toml").expect("a mechanism");
    let text = text
        .replace("\"2*pi*speed*t\"", &format!("\"{drive}\""))
        .replace("[points]", &format!("{inputs}\n[points]"));
    compile(&SourceFile { name: "driven.toml".to_owned(), text }, &Options::default()).expect("no errors")
}

/// Largest difference of columns of the crank and the rocker with these endings, as a part of their largest values.
fn off(columns: &Compiled, expected: &[Vec<f64>], found: &[Vec<f64>], ending: &str) -> f64 {
    let channels = channels(columns.description());
    let is_meant = |name: &str| name == format!("R1.{ending}") || name == format!("R4.{ending}");
    let places =
        channels.iter().enumerate().filter(|(_, channel)| is_meant(&channel.name)).map(|(place, _)| place);
    let of = |place: usize| {
        let size = expected.iter().fold(1e-6_f64, |most, row| most.max(row[place].abs()));
        expected.iter().zip(found).map(|(a, b)| (a[place] - b[place + 1]).abs() / size).fold(0.0, f64::max)
    };
    places.map(of).fold(0.0, f64::max)
}

/// Inputs that a drive follows, told by the driver: a course of 4 pi t + 0.1 sin 3 t with its rates.
#[test]
fn drives_follow_inputs_of_a_unit_that_moves() {
    let unpacked = Unpacked::of(driven_by("angle", "[inputs]\nangle = \"0 rad\""));
    let truth = driven_by("2*pi*speed*t + 0.1*sin(1.5*speed*t)", "");
    let expected = |rows: usize| {
        let settings =
            Settings::new(Integrator::Dopri5 { tolerance: 1e-12, max_step: None }, Span::Time(0.5), rows);
        let system = Native::new(truth.tapes(), truth.sizes()).expect("machine code");
        simulate(&system, truth.description(), &truth.parameters(), &settings, Watch::NONE)
            .expect("it runs")
            .rows
    };
    // The columns of the truth lack that of the input, which stands behind those of joints.
    let led = |rows_wanted: usize| {
        let found = rows(&unpacked.drive(driver(false), "cs", (0.5, 1e-12, rows_wanted), &[]));
        let expected = expected(rows_wanted);
        ["q", "v", "a"].map(|ending| off(&truth, &expected, &found, ending))
    };
    let (coarse, fine) = (led(51), led(101));
    println!("exchanges of 10 ms {coarse:?}, of 5 ms {fine:?}");
    // Told truly, the end of a step is off by h^3 / 6 of the third derivative, 2.7 rad/s^3, and the acceleration by h times it: 0.027 of
    // the 0.9 rad/s^2 that the crank has, a tenth more allowed; the angle by 4.5e-7 of 6 rad.
    assert!(coarse[0] < 4.5e-7 && coarse[2] < 0.033, "{coarse:?}");
    // Orders 3, 2 and 1, a fifth less allowed.
    assert!(
        fine[0] < coarse[0] / 6.0 && fine[1] < coarse[1] / 3.2 && fine[2] < coarse[2] / 1.6,
        "{coarse:?} {fine:?}"
    );
    // The driver's own method, to which the inputs are told at all its times; as of other mechanisms.
    let exchanged = rows(&unpacked.drive(driver(false), "me", (0.5, 1e-12, 51), &["20"]));
    for ending in ["q", "v", "a"] {
        let off = off(&truth, &expected(51), &exchanged, ending);
        assert!(off < 1e-6, "{ending}: {off:e}");
    }
    // Kept states have the way of the drive with them.
    let found = rows(&unpacked.drive(driver(true), "states", (0.2, 1e-8, 20), &[]));
    assert_eq!(found[..20], found[20..40]);
    assert_eq!(found[..20], found[40..]);
    unpacked.drive(driver(true), "derivatives", (0.1, 1e-9, 2), &[]);
}

#[test]
fn wrong_calls_are_told_and_nothing_breaks() {
    let unpacked = Unpacked::new("rssr");
    for sanitized in [false, true] {
        let output = unpacked.drive(driver(sanitized), "wrong", (0.5, 1e-6, 2), &[]);
        let messages: u32 = String::from_utf8_lossy(&output.stdout).trim().parse().expect("a count");
        assert!(messages > 20, "{messages}");
    }
    unpacked.drive(driver(true), "states", (0.05, 1e-6, 3), &[]);
    unpacked.drive(driver(true), "me", (0.01, 1e-6, 3), &["1000"]);
    unpacked.drive(driver(true), "derivatives", (0.1, 1e-6, 2), &[]);
}

#[test]
fn values_that_cannot_be_stay_refused() {
    let drive = |unpacked: &Unpacked, names: &[&str]| {
        let parameters = &unpacked.compiled.description().parameters;
        let reference = |name: &&str| {
            let place = parameters.iter().position(|known| known.name == **name).expect("a parameter");
            unpacked.variables().reference(Variable::Parameter(place)).to_string()
        };
        let references: Vec<String> = names.iter().map(reference).collect();
        let references: Vec<&str> = references.iter().map(String::as_str).collect();
        unpacked.drive(driver(true), "refused", (0.002, 1e-6, 2), &references);
    };
    drive(&Unpacked::new("rssr"), &["c0"]);
    let path = "mechanisms/rssr.toml".to_owned();
    let text =
        fs::read_to_string(&path).expect("a mechanism").replace("radial = \"c0\"", "radial = \"c0 - less\"");
    let text = text.replace("\nc0 = {", "\nless = { value = \"0 um\", tunable = true }\nc0 = {");
    let two = compile(&SourceFile { name: path, text }, &Options::default()).expect("no errors");
    drive(&Unpacked::of(two), &["c0", "less"]);
}

#[test]
fn a_unit_is_the_same_bytes_every_time_and_tells_itself_from_others() {
    let (one, two) = (compiled("rssr_rigid"), compiled("pendulum"));
    assert_eq!(fmu::unit(&one), fmu::unit(&one));
    let tokens = [&one, &two].map(|mechanism| {
        let bytes = fmu::unit(mechanism).expect("a unit");
        let program =
            files(&bytes).into_iter().find(|(name, _)| name.ends_with(PROGRAM_FILE)).expect("a program");
        Unit::from_bytes(&program.1).expect("a unit").instantiation_token
    });
    assert_ne!(tokens[0], tokens[1]);
}

/// Of the model description of a text: name and unit of every variable, and the elements `Unit`.
fn described(text: &str) -> (Vec<(String, String)>, Vec<String>) {
    let source = SourceFile { name: "m.toml".to_owned(), text: text.to_owned() };
    let bytes = fmu::unit(&compile(&source, &Options::default()).expect("no errors")).expect("a unit");
    let description = files(&bytes).into_iter().find(|(name, _)| name == "modelDescription.xml");
    let xml = String::from_utf8(description.expect("a description").1).expect("text");
    let value = |line: &str, key: &str| {
        let rest = line.split_once(&format!(" {key}=\""))?.1;
        rest.split('"').next().map(str::to_owned)
    };
    let variables = xml.lines().filter(|line| line.trim().starts_with("<Float64 "));
    let variables = variables.map(|line| (value(line, "name").expect("a name"), value(line, "unit")));
    let units = xml.lines().map(str::trim).filter(|line| line.starts_with("<Unit "));
    (
        variables.map(|(name, unit)| (name, unit.unwrap_or_default())).collect(),
        units.map(str::to_owned).collect(),
    )
}

/// An arm whose names are those that a unit adds: of a joint, and of what damps it.
fn named(joint: &str, parameter: &str, more: &str) -> String {
    format!(
        "spec = 1\nname = \"m\"\ngravity = [0, \"-9.81 m/s^2\", 0]\n[parameters]\n\
         {parameter} = {{ value = \"0.01 N m s\", tunable = {tunable} }}\n[points]\nO = [0, 0, 0]\nA = [\"0.2 m\", 0, 0]\n[bodies]\n\
         b = {{ rod = [\"O\", \"A\"], radius = \"6 mm\", mass = \"1 kg\" }}\n[joints]\n\
         {joint} = {{ revolute = [\"ground\", \"b\"], at = \"O\", axis = [0, 0, 1], damping = \"{parameter}\" }}\n{more}",
        tunable = parameter == "time",
    )
}

#[test]
fn no_two_variables_have_one_name_and_the_file_keeps_its_own() {
    let contact = "q = { revolute = [\"b\", \"c\"], at = \"A\", axis = [0, 0, 1] }\n\
                   [bodies.c]\nrod = [\"A\", \"O\"]\nradius = \"6 mm\"\nmass = \"1 kg\"\n[clearance.q]\nradial = \"1 mm\"\n\
                   journal_radius = \"10 mm\"\nlength = \"20 mm\"\nmodulus = \"115 GPa\"\nrestitution = 0.9\n";
    for (text, kept, added) in [
        (named("J", "time", ""), "time", "time_"),
        (named("constant", "q", ""), "constant.q", "constant.q_"),
        (named("penetration", "k", contact), "penetration.q", "penetration.q_"),
    ] {
        let (variables, _) = described(&text);
        let names: Vec<&str> = variables.iter().map(|(name, _)| &**name).collect();
        let distinct: std::collections::BTreeSet<&str> = names.iter().copied().collect();
        assert_eq!(distinct.len(), names.len(), "{names:?}");
        assert!(names.contains(&kept) && names.contains(&added), "{kept} {added}: {names:?}");
    }
}

#[test]
fn every_unit_has_its_powers_and_angles_are_in_radians() {
    let text = r#"spec = 1
name = "units"
gravity = [0, 0, 0]
[parameters]
a = { value = "3 1/(m s)", tunable = true }
lean = { value = "30 deg", tunable = true }
rate = { value = "2 rad/s", tunable = true }
speed = { value = "2 Hz", tunable = true }
part = { value = 0.5, tunable = true }
tilt = "10 deg"
[inputs]
angle = { unit = "deg", default = 10 }
[points]
O = [0, 0, 0]
[bodies]
d = { mass = "1 kg", centre = "O", inertia = ["1e-2 kg m^2", "1e-2 kg m^2", "1e-2 kg m^2"] }
[joints]
j = { revolute = ["ground", "d"], at = "O", axis = [0, 0, 1], drive = "angle + part*lean + tilt + sin(rate*t) + sin(2*pi*speed*t)" }
[states]
s1 = { initial = "1 1/(m s)", rate = "a/(2 s)" }
s3 = { initial = "1 kg/s", rate = "2 kg/s^2" }
s4 = { initial = "1 s^2", rate = "2 s" }
"#;
    let (variables, units) = described(text);
    let unit = |name: &str| &*variables.iter().find(|(known, _)| known == name).expect(name).1;
    for (name, expected) in [
        ("lean", "rad"),
        ("rate", "rad/s"),
        ("speed", "Hz"),
        ("part", ""),
        ("constant.tilt", "rad"),
        ("angle", "rad"),
        ("angle.v", "rad/s"),
        ("angle.a", "rad/s^2"),
        ("angle.u", "rad"),
        ("der(state.v.s1.value)", "1/(m s^2)"),
        ("der(state.v.s3.value)", "N/m"),
        ("der(state.v.s4.value)", "s"),
    ] {
        assert_eq!(unit(name), expected, "{name} {variables:?}");
    }
    assert!(!units.is_empty() && units.iter().all(|unit| unit.contains("<BaseUnit ")), "{units:?}");
}

/// `pip install fmpy`; `FMPY_PYTHON` names a Python that has it.
#[test]
fn fmpy_finds_no_fault_and_gets_the_trajectory() {
    let python = std::env::var("FMPY_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has = Command::new(&python).args(["-c", "import fmpy"]).output();
    if !has.is_ok_and(|has| has.status.success()) {
        println!("skipped: {python} has no fmpy");
        return;
    }
    for name in ["rssr_flexible", "rssr"] {
        let unpacked = Unpacked::new(name);
        let file = unpacked.folder.path().join("unit.fmu");
        let done = Command::new(&python)
            .arg("tests/fmu/fmpy_run.py")
            .arg(&file)
            .arg("0.2")
            .output()
            .expect("Python");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let tolerance = unpacked.integrator().tolerance().expect("a tolerance");
        let own = rows(&unpacked.drive(driver(false), "cs", (0.2, tolerance, 201), &[]));
        let text = String::from_utf8_lossy(&done.stdout);
        let theirs: Vec<Vec<f64>> = text
            .lines()
            .map(|line| line.split(' ').map(|x| x.parse().expect("a number")).collect())
            .collect();
        assert_eq!(theirs.len(), 201, "{name}");
        for (own, theirs) in own.iter().zip(&theirs) {
            for (own, theirs) in own.iter().zip(theirs) {
                // Its times are sums of steps: they differ in the last place, and forces with them.
                assert!((own - theirs).abs() <= 1e-6 * own.abs().max(1e-3), "{name}: {own} {theirs}");
            }
        }
    }
}
