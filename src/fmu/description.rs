//! What a unit tells about itself: the model description of FMI 3.0, and a page for people. In: a unit. Out: XML, HTML.

use std::collections::BTreeSet;
use std::fmt::{Display, Write as _};

use linkwear_fmu::{Unit, Variable, Variables, belongs_to_start};
use linkwear_runtime::{Integrator, channels};

use super::names::names;
use super::si::{BASE, powers};

/// Time between two exchanges that tools propose [s].
const STEP: f64 = 1e-3;

/// Text for XML and HTML, in quotation marks or not.
pub fn escaped(text: impl Display) -> String {
    let mut escaped = String::new();
    for letter in text.to_string().chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            letter if letter.is_control() => escaped.push(' '),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// A variable with what the description says of it.
struct Row {
    reference: u32,
    variable: Variable,
    name: String,
    unit: String,
    /// Causality, variability, and what stands beside them.
    kind: String,
}

fn rows(unit: &Unit) -> Vec<Row> {
    let description = unit.program.description();
    let channels = channels(description);
    let variables = Variables::new(unit, &channels);
    let fixed = belongs_to_start(&unit.program);
    let row = |((reference, variable), (name, si)): ((u32, Variable), (String, String))| {
        let kind = match variable {
            Variable::Time => r#"causality="independent" variability="continuous""#.to_owned(),
            Variable::Parameter(index) => {
                let start = description.parameters[index].default;
                if index >= description.tunable() {
                    format!(r#"causality="input" variability="continuous" start="{start}""#)
                } else {
                    let variability = if fixed[index] { "fixed" } else { "tunable" };
                    format!(
                        r#"causality="parameter" variability="{variability}" initial='exact' start="{start}""#
                    )
                }
            }
            Variable::Output(_) => {
                r#"causality="output" variability="continuous" initial="calculated""#.to_owned()
            }
            Variable::State(_) | Variable::Indicator(_) => {
                r#"causality="local" variability="continuous" initial="calculated""#.to_owned()
            }
            Variable::Derivative(index) => {
                let state = variables.reference(Variable::State(index));
                format!(
                    r#"causality="local" variability="continuous" initial="calculated" derivative="{state}""#
                )
            }
            Variable::Constant(index) => {
                let value = unit.constants[index].value;
                format!(r#"causality="local" variability="constant" initial='exact' start="{value}""#)
            }
        };
        Row { reference, variable, name, unit: si, kind }
    };
    variables.all().zip(names(unit, &channels)).map(row).collect()
}

/// The file `modelDescription.xml`; `stop`: end of the default experiment [s].
pub fn model_description(unit: &Unit, stop: f64) -> String {
    let description = unit.program.description();
    let (name, token) = (escaped(&description.name), escaped(&unit.instantiation_token));
    let rows = rows(unit);
    let tolerance =
        Integrator::adaptive(description, None).tolerance().unwrap_or(Integrator::SMOOTH_TOLERANCE);
    let version = env!("CARGO_PKG_VERSION");
    let can = r#"canGetAndSetFMUState="true" canSerializeFMUState="true" providesDirectionalDerivatives="true" providesAdjointDerivatives="true""#;
    // An integrator from outside does not know of samples.
    let exchange = if description.acts_at_samples() {
        String::new()
    } else {
        format!("  <ModelExchange modelIdentifier=\"{name}\" {can} needsCompletedIntegratorStep=\"true\"/>\n")
    };
    let mut xml = format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="{name}" instantiationToken="{token}" generationTool="linkwear {version}" variableNamingConvention="structured">
{exchange}  <CoSimulation modelIdentifier="{name}" {can} canHandleVariableCommunicationStepSize="true" hasEventMode="true"/>
"#
    );
    let units: BTreeSet<&str> = rows.iter().map(|row| &*row.unit).filter(|unit| *unit != "1").collect();
    xml.push_str("  <UnitDefinitions>\n");
    for unit in units {
        let powers = powers(unit).map(|powers| {
            let factors = BASE.into_iter().zip(powers).filter(|(_, power)| *power != 0);
            let factors: String = factors.map(|(base, power)| format!(" {base}=\"{power}\"")).collect();
            format!("<BaseUnit{factors}/>")
        });
        let _ = writeln!(xml, "    <Unit name=\"{}\">{}</Unit>", escaped(unit), powers.unwrap_or_default());
    }
    let _ = write!(
        xml,
        r#"  </UnitDefinitions>
  <LogCategories>
    <Category name="logStatusError" description="Why a call has failed"/>
    <Category name="logEvents" description="Contacts that close and open"/>
  </LogCategories>
  <DefaultExperiment startTime="0" stopTime="{stop}" tolerance="{tolerance}" stepSize="{STEP}"/>
  <ModelVariables>
"#
    );
    for Row { reference, name, unit, kind, .. } in &rows {
        let unit = if unit == "1" { String::new() } else { format!(" unit=\"{}\"", escaped(unit)) };
        let name = escaped(name);
        let _ = writeln!(xml, r#"    <Float64 name="{name}" valueReference="{reference}" {kind}{unit}/>"#);
    }
    xml.push_str("  </ModelVariables>\n  <ModelStructure>\n");
    let is_output = |variable| matches!(variable, Variable::Output(_));
    let is_derivative = |variable| matches!(variable, Variable::Derivative(_));
    let calculated =
        |variable| is_output(variable) || is_derivative(variable) || matches!(variable, Variable::State(_));
    let mut list = |element: &str, belongs: &dyn Fn(Variable) -> bool| {
        for row in rows.iter().filter(|row| belongs(row.variable)) {
            let _ = writeln!(xml, r#"    <{element} valueReference="{}"/>"#, row.reference);
        }
    };
    list("Output", &is_output);
    list("ContinuousStateDerivative", &is_derivative);
    list("InitialUnknown", &calculated);
    list("EventIndicator", &|variable| matches!(variable, Variable::Indicator(_)));
    xml.push_str("  </ModelStructure>\n</fmiModelDescription>\n");
    xml
}

/// The page `documentation/index.html`.
pub fn documentation(unit: &Unit) -> String {
    let name = escaped(&unit.program.description().name);
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{name}</title></head>\n<body>\n\
         <h1>{name}</h1>\n<p>Made by linkwear {} for FMI 3.0. All numbers are SI.</p>\n<table>\n\
         <tr><th>variable</th><th>unit</th><th>what it is</th></tr>\n",
        env!("CARGO_PKG_VERSION")
    );
    for Row { name, unit, variable, .. } in rows(unit) {
        let what = match variable {
            Variable::Time => "independent variable",
            Variable::Parameter(_) => "parameter or input",
            Variable::Output(_) => "output",
            Variable::State(_) => "continuous state",
            Variable::Derivative(_) => "its derivative",
            Variable::Indicator(_) => "event indicator: depth of a contact",
            Variable::Constant(_) => "number that is part of the equations",
        };
        let _ =
            writeln!(page, "<tr><td>{}</td><td>{}</td><td>{what}</td></tr>", escaped(name), escaped(unit));
    }
    page.push_str("</table>\n</body>\n</html>\n");
    page
}
