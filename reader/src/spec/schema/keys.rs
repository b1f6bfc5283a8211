//! The page of all keys: book/src/keys.md.

use std::fmt::Write as _;

use serde_json::Value;

use super::{Takes, held, schema};
use crate::spec::parse_expression;

const HEAD: &str = "# Every key of the mechanism file

This page is made from the types that read the file, as is the [JSON Schema](../../docs/linkwear.schema.json) by which editors complete it, show these sentences, and mark a number without
a unit. How things are meant and belong together is explained in [the mechanism file](../../docs/spec-reference.md).

A unit here is the SI unit; in a file any unit of the dimension goes, `\"120 mm\"`, or a formula, `\"L1 + 2*r\"`. Where there is a unit, a number alone is an error, except 0. Angles are pure numbers: `\"30 deg\"`.
A mark is `assumed = true`, your own assumption and not from the source you cite, or `doc = \"..\"`, what a thing is.
";

/// Types with keys, in the order of the page, and where they stand in a file.
const TABLES: [(&str, &str); 31] = [
    ("", "Top level"),
    ("ParameterTable", "A parameter, where it is a table"),
    ("InputTable", "An input, where it is a table"),
    ("PointSpec", "A point, where it is a table"),
    ("BodySpec", "A body"),
    ("FlexibleSpec", "`flexible` of a body"),
    ("SectionSpec", "`section` of a flexible body"),
    ("StepSpec", "One of `steps` of a flexible body"),
    ("PointMassSpec", "One of `masses` of a flexible body"),
    ("JointSpec", "A joint"),
    ("EachCoordinate", "`drive`, `damping`, `friction`, `force` by coordinate"),
    ("SpringSpec", "`spring` of a joint"),
    ("SpringPart", "`spring` of one coordinate"),
    ("DryFrictionSpec", "`dry_friction` of a joint"),
    ("CouplingSpec", "A coupling"),
    ("StopSpec", "A stop"),
    ("ForceSpec", "A force"),
    ("ByAxis", "`translation` and `rotation` of a bushing"),
    ("StateSpec", "A state"),
    ("SensorTable", "A sensor, where it is a table"),
    ("ControllerSpec", "A controller"),
    ("ControllerStateSpec", "A state of a controller"),
    ("StartTable", "Start values in `[assembly]` and `[initial]`, where they are a table"),
    ("ClearanceSpec", "`[clearance.<joint>]`"),
    ("WearSpec", "`[wear.<joint>]`"),
    ("TableSpec", "`[tables.<name>]`"),
    ("MissionSpec", "`[missions.<name>]`"),
    ("SegmentSpec", "A segment of a mission"),
    ("SegmentJointSpec", "A joint in a segment of a mission"),
    ("IncludeSpec", "`[include.<part>]`"),
    ("RotationSpec", "`rotation` of a part"),
];

/// These two have no other types behind them.
const LAST: [(&str, &str); 2] = [("RepeatSpec", "`[repeat.<group>]`"), ("CheckSpec", "`[check]`")];

/// Words that a key takes, where it takes words.
fn words(schema: &Value, field: &Value) -> Vec<String> {
    let name = field.to_string();
    let types = schema["$defs"].as_object().expect("types");
    let is_named = |of: &&String| name.contains(&format!("\"#/$defs/{of}\""));
    types.keys().find(is_named).map_or(Vec::new(), |of| {
        let variants = &types[of];
        let each = variants["oneOf"].as_array().into_iter().flatten();
        let told = each.filter_map(|variant| {
            Some(format!("{}: {}", variant["const"], variant["description"].as_str()?))
        });
        told.collect()
    })
}

fn code(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("`{text}`") }
}

fn rows(page: &mut String, schema: &Value, fields: &Value) {
    page.push_str(
        "\n| key | meaning | unit or kind | range | default | example |\n|---|---|---|---|---|---|\n",
    );
    for (key, field) in fields.as_object().expect("keys") {
        let description = field["description"].as_str().unwrap_or_default();
        let takes = Takes::of(description)
            .unwrap_or_else(|| panic!("`{key}` does not say what it takes: {description}"));
        let is_unit = takes.dimensions().is_some();
        let mut meaning = takes.sentence;
        let words = words(schema, field);
        if !words.is_empty() {
            write!(meaning, " {}", words.join(" ")).expect("a text");
        }
        // A unit is code, a kind a word.
        let unit = if is_unit { code(&takes.unit) } else { takes.unit };
        let cells = [code(key), meaning, unit, takes.range, takes.default, code(&takes.example)];
        // A line break or a stroke would end a cell.
        let cells =
            cells.map(|cell| cell.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|"));
        writeln!(page, "| {} |", cells.join(" | ")).expect("a text");
    }
}

/// The keys of a type: its own, or those of the form that is a table.
fn fields(of: &Value) -> Option<&Value> {
    let forms = of["anyOf"].as_array().into_iter().flatten();
    std::iter::once(of).chain(forms).map(|form| &form["properties"]).find(|fields| fields.is_object())
}

fn page() -> String {
    let schema = schema();
    let mut page = HEAD.to_owned();
    for (name, heading) in TABLES.iter().chain(&LAST) {
        let of = if name.is_empty() { &schema } else { &schema["$defs"][name] };
        write!(page, "\n## {heading}\n").expect("a text");
        if let Some(about) = of["description"].as_str().filter(|_| !name.is_empty()) {
            write!(page, "\n{}\n", about.replace('\n', " ")).expect("a text");
        }
        rows(&mut page, &schema, fields(of).unwrap_or_else(|| panic!("{name} has no keys")));
    }
    page
}

#[test]
fn the_page_of_keys_is_that_of_the_schema() {
    let page = page();
    for row in page.lines().filter(|line| line.contains(" | ")) {
        assert!(row.starts_with('|') && row.matches(" | ").count() == 5, "{row}");
    }
    held("../book/src/keys.md", &page);
}

#[test]
fn every_type_with_keys_is_on_the_page() {
    let schema = schema();
    for (name, of) in schema["$defs"].as_object().expect("types") {
        let base = name.strip_suffix("WithUnit").unwrap_or(name);
        let is_there = TABLES.iter().chain(&LAST).any(|(known, _)| *known == base);
        assert!(is_there || fields(of).is_none(), "{name} is missing");
    }
}

/// An example with a unit has the unit of its key.
#[test]
fn examples_are_of_the_dimension_they_stand_for() {
    let schema = schema();
    let types = schema["$defs"].as_object().expect("types").values().filter_map(fields);
    let mut seen = 0;
    for (key, field) in types.flat_map(|fields| fields.as_object().expect("keys")) {
        let Some(takes) = field["description"].as_str().and_then(Takes::of).filter(Takes::needs_a_unit)
        else {
            continue;
        };
        let dimensions = takes.dimensions().expect("units");
        let texts = takes.example.split('"').skip(1).step_by(2);
        for quantity in texts.filter_map(|text| parse_expression(text, &|_| false).ok()?.quantity()) {
            seen += 1;
            assert!(dimensions.contains(&quantity.1), "`{key}`: {}", takes.example);
        }
    }
    assert!(seen > 30, "{seen} examples");
}
