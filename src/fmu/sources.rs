//! Sources of a unit in C99, for platforms that its library is not for, and how to build them: FMI 3.0, section 2.5. In: a compiled
//! mechanism. Out: files of the folder `sources`.

use linkwear_codegen::Compiled;
use linkwear_fmu::{Unit, belongs_to_contacts, belongs_to_start};
use linkwear_runtime::{Integrator, Settings, Span, Watch, channels, simulate};

use super::description::escaped;

/// Of steps as long as the adaptive method takes on average: one of fixed length has to do where forces change fastest too.
const SHORTER: f64 = 0.25;
/// Step where none is known [s].
const STEP: f64 = 1e-5;
/// Longest step, as a part of the run [1].
const LONGEST: f64 = 2e-4;

/// The files, by their names; none where the file has no consistent start, or a controller acts at sampled times.
pub fn sources(mechanism: &Compiled, unit: &Unit, stop: f64) -> Vec<(String, String)> {
    // C takes no samples.
    if mechanism.description().acts_at_samples() || mechanism.start().is_err() {
        return Vec::new();
    }
    let name = mechanism.c_prefix();
    let header = format!("{name}.h");
    let files = mechanism.c_files(&header);
    let step = step(mechanism, stop);
    let own = mechanism.c_outputs(&header, &format!("{}\n{}", numbers(unit, step), include_str!("unit.c")));
    let build = build_description(&unit.program.description().name, &name);
    vec![
        ("buildDescription.xml".to_owned(), build),
        (format!("{name}_unit.c"), own),
        (format!("{name}.c"), files.source),
        (header, files.header),
    ]
}

/// A list as an array of C, which has at least one entry.
fn array(of: &str, entries: impl Iterator<Item = String>) -> String {
    let entries: Vec<String> = entries.collect();
    let list = if entries.is_empty() { "0".to_owned() } else { entries.join(", ") };
    format!("static const {of}[] = {{{list}}};\n")
}

/// What of a unit the functions have to know.
fn numbers(unit: &Unit, step: f64) -> String {
    let description = unit.program.description();
    let (start, contacts) = (belongs_to_start(&unit.program), belongs_to_contacts(&unit.program));
    let fixed = start.iter().zip(contacts).map(|(start, contacts)| u8::from(*start || contacts).to_string());
    let channels = channels(description);
    let wraps = channels.iter().map(|channel| u8::from(channel.wraps).to_string());
    let constants = &unit.constants;
    let mut text = format!(
        "enum {{ UNIT_OUTPUTS = {}, UNIT_CONSTANTS = {}, UNIT_WRAPS = {} }};\n#define UNIT_STEP {step:e}\n",
        channels.len(),
        constants.len(),
        u8::from(channels.iter().any(|channel| channel.wraps)),
    );
    text.push_str(&format!("static const char unit_token[] = \"{}\";\n", unit.instantiation_token));
    text.push_str(&array("unsigned char unit_wraps", wraps));
    text.push_str(&array("unsigned char unit_is_fixed", fixed));
    let defaults = description.parameters.iter().map(|parameter| format!("{:e}", parameter.default));
    text.push_str(&array("double unit_defaults", defaults));
    text.push_str(&array("double unit_constants", constants.iter().map(|one| format!("{:e}", one.value))));
    text
}

/// Step of the unit's own [s]: shorter than those of the method that chooses them, on two digits.
fn step(mechanism: &Compiled, stop: f64) -> f64 {
    let description = mechanism.description();
    let settings = Settings::new(Integrator::adaptive(description, None), Span::Time(stop), 0);
    let run = simulate(
        mechanism.interpreter().on_numbers(),
        description,
        &mechanism.parameters(),
        &settings,
        Watch::NONE,
    );
    let steps = run.ok().filter(|run| run.stopped.is_none()).map_or(0, |run| run.statistics.steps);
    let step = if steps == 0 { STEP } else { (SHORTER * stop / steps as f64).min(LONGEST * stop) };
    let digits = 10.0_f64.powf(step.log10().floor() - 1.0);
    (step / digits).floor() * digits
}

fn build_description(model: &str, name: &str) -> String {
    let model = escaped(model);
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiBuildDescription fmiVersion="3.0">
  <BuildConfiguration modelIdentifier="{model}" description="Co-simulation by steps of fixed length; needs the standard library's mathematics (-lm)">
    <SourceFileSet language="C99" compiler="gcc" compilerOptions="-O2 -ffp-contract=off -fno-math-errno">
      <SourceFile name="{name}_unit.c"/>
      <SourceFile name="{name}.c"/>
      <IncludeDirectory name="."/>
    </SourceFileSet>
  </BuildConfiguration>
</fmiBuildDescription>
"#
    )
}
