//! The JSON Schema for editors agrees with the parser: every shipped file passes, every file whose form is wrong does not.

#[path = "../../tests/outputs/schema.rs"]
mod validator;

use serde_json::Value;
use validator::faults;

/// As shipped; a test beside the parser's types says that it is theirs.
fn json_schema() -> Value {
    serde_json::from_str(include_str!("../../docs/linkwear.schema.json")).unwrap()
}

/// All TOML files of a folder beside this crate's manifest, as JSON; files that are not TOML are left out.
fn files(folder: &str) -> Vec<(String, Value)> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .filter_map(|path| {
            let value: Value = toml::from_str(&std::fs::read_to_string(&path).unwrap()).ok()?;
            Some((path.file_stem().unwrap().to_string_lossy().into_owned(), value))
        })
        .collect();
    files.sort_by(|a, b| a.0.cmp(&b.0));
    files
}

#[test]
fn every_shipped_mechanism_fits_the_schema() {
    let schema = json_schema();
    let files = files("../mechanisms");
    assert!(files.len() >= 4);
    for (name, value) in files {
        assert_eq!(faults(&schema, &value), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn files_of_wrong_form_do_not_fit_the_schema_and_others_do() {
    let schema = json_schema();
    for (name, value) in files("tests/spec_fail") {
        // E0102 to E0109 are about form, and so are the presence of a unit (E0304), of segments (E0416), of ends of stops (E0418), the rows of a matrix (E0419)
        // and the states of a controller (E0420); NaN (E0308) is no JSON.
        let form = [
            "E0102",
            "E0103",
            "E0104",
            "E0105",
            "E0106",
            "E0107",
            "E0108",
            "E0109",
            "E0304",
            "E0308_not",
            "E0416",
            "E0418_bad",
            "E0419",
            "E0420",
        ];
        // A mechanism name, a number of cells and the like are checked beyond the form; these files are well-formed.
        // So are keys that have no effect beside others.
        let is_of_keys_beside = name.starts_with("E0107_beside");
        let wrong = form.iter().any(|code| name.starts_with(code)) && !is_of_keys_beside;
        assert_eq!(!faults(&schema, &value).is_empty(), wrong, "{name}");
    }
}

/// What a key needs beside it, how many entries a list has, what is blank: `check` refuses each by its form, and so does the schema.
#[test]
fn what_is_wrong_beside_other_keys_does_not_fit_the_schema() {
    let schema = json_schema();
    let head = "name = \"m\"\ngravity = [0, 0, 0]\npoints.O = [0, 0, 0]\npoints.A = [\"1 m\", 0, 0]\n";
    let bar = "bodies.bar = { rod = [\"O\", \"A\"], radius = \"5 mm\", mass = \"1 kg\" }\n";
    let hinge = "joints.R = { revolute = [\"ground\", \"bar\"], at = \"O\", axis = [0, 0, 1] }\n";
    let both = [bar, hinge].concat();
    let fits = |spec: &str, rest: &str| {
        let text = format!("spec = {spec}\n{head}{rest}");
        let source = linkwear_codegen::source::SourceFile { name: "m.toml".into(), text: text.clone() };
        let is_taken = linkwear_codegen::compile::compile(&source, &Default::default()).is_ok();
        (is_taken, faults(&schema, &toml::from_str(&text).unwrap()).is_empty())
    };
    // Also what could be mistaken for wrong.
    for rest in [
        "points.P = { bar = [0, 0, 0], doc = \"tip\" }",
        "points.P = { at = { bar = [\"0 mm\", \"-0\", 0] } }",
        "forces.f = { spring = [\"ground\", \"bar\"], at = [\"O\", \"A\"], preload = \"1 N\" }",
        "forces.f = { force = \"bar\", at = [\"A\"], components = [\"1 N\", 0, 0] }",
        "tables.T = { argument = [\"0 rad\", 1], value = [\"0 N\", \"1 N\"] }",
        "inputs.u = { unit = \"N\" }",
    ] {
        assert_eq!(fits("1", &format!("{both}{rest}\n")), (true, true), "{rest}");
    }
    for rest in [
        "points.P = {}",
        "points.P = { doc = \"nowhere\" }",
        "points.P = { at = {} }",
        "points.P = [\" \", 0, 0]",
        "parameters.p = \"\"",
        "inputs.u = { doc = \"of what?\" }",
        "bodies.more = { box = [\"O\", \"A\"], mass = \"1 kg\" }",
        "bodies.more = { box = [\"O\", \"A\"], mass = \"1 kg\", width = [\"1 mm\", \"2 mm\"] }",
        "bodies.more = { tube = [\"O\", \"A\"], mass = \"1 kg\", radius = \"5 mm\" }",
        "bodies.more = { rod = [\"O\", \"A\"], radius = \"5 mm\" }",
        "bodies.more = { centre = \"A\", mass = \"1 kg\", inertia = [1, 2] }",
        "joints.S = { prismatic = [\"ground\", \"bar\"], at = \"O\" }",
        "joints.S = { screw = [\"ground\", \"bar\"], at = \"O\", axis = [0, 0, 1] }",
        "joints.S = { slot = [\"ground\", \"bar\"], at = \"O\", axis = [0, 0, 1] }",
        "joints.S = { universal = [\"ground\", \"bar\"], at = \"O\", axes = [[1, 0, 0]] }",
        "joints.S = { distance = [\"ground\", \"bar\"], at = \"A\" }",
        "joints.S = { revolute = [\"ground\", \"bar\"], at = \"O\", axis = [0, 0, 1], spring = {} }",
        "forces.f = { spring = [\"ground\", \"bar\"], at = [\"O\", \"A\"], stiffness = \"1 N/m\" }",
        "forces.f = { spring = [\"ground\", \"bar\"], at = [\"O\", \"A\"] }",
        "forces.f = { spring = [\"ground\", \"bar\"], at = [\"O\"], preload = \"1 N\" }",
        "forces.f = { force = \"bar\", at = [\"O\", \"A\"], components = [\"1 N\", 0, 0] }",
        "forces.f = { bushing = [\"ground\", \"bar\"], at = \"O\" }",
        "couplings.c = { worm = [\"bar\", \"bar\"], teeth = [1, 40] }",
        "couplings.c = { gears = [\"bar\"], teeth = [20, 40] }",
        "stops.s = { joint = \"R\", stiffness = \"1 N m/rad\" }",
        "stops.s = { joint = \"R\", upper = \"1 rad\", stiffness = \"1 N m/rad\", law = \"exact\" }",
        "tables.T = { argument = [\"0 rad\", 1] }",
        "missions.m = {}",
        "missions.m = { segments = { full = {} } }",
        "controllers.c = { setpoint = \"0 rad\", proportional = \"1 N m\" }",
        "controllers.c = { output = \"0 N m\" }",
    ] {
        assert_eq!(fits("1", &format!("{both}{rest}\n")), (false, false), "{rest}");
    }
    for version in ["0", "2", "\"1\""] {
        assert_eq!(fits(version, &both), (false, false), "spec = {version}");
    }
}

/// Validators that are strict stop at a null where a schema should be.
#[test]
fn nothing_in_the_schema_is_null() {
    fn nulls(value: &Value) -> usize {
        match value {
            Value::Null => 1,
            Value::Array(items) => items.iter().map(nulls).sum(),
            // A default of null is one.
            Value::Object(fields) => {
                fields.iter().filter(|(key, _)| *key != "default").map(|(_, value)| nulls(value)).sum()
            }
            _ => 0,
        }
    }
    assert_eq!(nulls(&json_schema()), 0);
}

#[test]
fn schema_documents_every_table() {
    let schema = json_schema();
    let tables = schema["properties"].as_object().unwrap();
    for (name, table) in tables {
        assert!(table.get("description").is_some() || table.get("$ref").is_some(), "{name}");
    }
    assert!(tables.contains_key("joints") && tables.contains_key("repeat"));
}
