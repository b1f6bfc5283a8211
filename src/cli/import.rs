//! `import`: a mechanism file from a robot or a part of another format.

use std::io::{self, ErrorKind, Write as _};
use std::path::Path;

use linkwear_codegen::input::{Reach, read_bytes, read_named_bytes, read_text};
use linkwear_codegen::limits;

use super::answer::Answer;
use super::answer::equations::{ImportAnswer, PartAnswer};
use super::arguments::ImportArguments;
use super::failure::Failure;
use super::input::check_output;
use crate::files::write_whole;
use crate::import::{Base, Files, ImportError, LengthUnit, from_robot, from_stl};
use crate::number::fixed;

pub fn run(arguments: &ImportArguments) -> Result<Answer, Failure> {
    let (file, out) = (&arguments.file, &arguments.out);
    check_output(&[file], Some(out), arguments.replace)?;
    let is_part = file.extension().is_some_and(|end| end.eq_ignore_ascii_case("stl"));
    if is_part { part(arguments) } else { robot(arguments) }
}

fn robot(arguments: &ImportArguments) -> Result<Answer, Failure> {
    let (file, out) = (&arguments.file, &arguments.out);
    if arguments.unit != LengthUnit::default() {
        return Err(Failure::usage("--unit is for parts: robots are in metres", "take it away"));
    }
    let text = read_text(file, limits::DATA_BYTES).map_err(Failure::read(file))?;
    let base = if arguments.floating { Base::Floating } else { Base::Fixed };
    let reach = if arguments.allow_outside_data { Reach::Anywhere } else { Reach::Below };
    let made = from_robot(&text, base, arguments.density, &Beside { file, reach }).map_err(fault(file))?;
    write_whole(out, |target| target.write_all(made.text.as_bytes()))?;
    let shown = out.display();
    let mut text = format!("{shown} written: {} bodies, {} joints\n", made.bodies, made.joints);
    if !made.left_out.is_empty() {
        text.push_str("\nnot carried over, or changed:\n");
    }
    for line in &made.left_out {
        text.push_str(&format!("  {line}\n"));
    }
    text.push_str(&format!("\nNext:\n  linkwear check {shown}"));
    let told = ImportAnswer {
        file: shown.to_string(),
        name: made.name,
        bodies: made.bodies,
        joints: made.joints,
        left_out: made.left_out,
        part: None,
    };
    Ok(Answer::new(text, told, None))
}

fn part(arguments: &ImportArguments) -> Result<Answer, Failure> {
    let (file, out) = (&arguments.file, &arguments.out);
    let Some(density) = arguments.density else {
        let help = "add what it is made of: --density \"7850 kg/m^3\"";
        return Err(Failure::usage("a part needs a density, which a mesh does not have", help));
    };
    if arguments.floating {
        return Err(Failure::usage("--floating is for robots", "take it away"));
    }
    let bytes = read_bytes(file, limits::MESH_BYTES).map_err(Failure::read(file))?;
    let name = file.file_stem().map_or_else(|| "part".into(), |stem| stem.to_string_lossy());
    let made = from_stl(&bytes, &name, density, arguments.unit).map_err(fault(file))?;
    write_whole(out, |target| target.write_all(made.text.as_bytes()))?;
    let shown = out.display();
    let lengths = |values: [f64; 3]| values.map(|x| fixed(1e3 * x, 6)).join(", ");
    let mut text = format!(
        "{shown} written: {}, {} triangles, closed, coordinates in {}\n\n  size    {} mm\n  volume  {:.6e} m^3\n  mass    {:.6} kg\n  centre  {} mm\n  inertia {} kg m^2\n          about the centre: xx, yy, zz, xy, xz, yz\n",
        made.name,
        made.triangles,
        arguments.unit.name(),
        lengths(made.size),
        made.volume,
        made.mass,
        lengths(made.centre),
        made.inertia.map(|x| format!("{x:.6e}")).join(", "),
    );
    for remark in &made.remarks {
        text.push_str(&format!("\n{remark}\n"));
    }
    text.push_str(&format!(
        "\nNext: copy the body, or include it:\n  [include.{0}]\n  file = \"{shown}\"",
        made.name
    ));
    let told = ImportAnswer {
        file: shown.to_string(),
        name: made.name,
        bodies: 1,
        joints: 1,
        left_out: made.remarks,
        part: Some(PartAnswer {
            triangles: made.triangles,
            size_m: made.size,
            volume_m3: made.volume,
            density_kg_m3: density,
            mass_kg: made.mass,
            centre_m: made.centre,
            inertia_kg_m2: made.inertia,
        }),
    };
    Ok(Answer::new(text, told, None))
}

/// Faults in the file, or in one that it includes.
fn fault(file: &Path) -> impl Fn(ImportError) -> Failure + '_ {
    let one = move |error: &ImportError| {
        let included = error.file.as_ref().map(|name| file.with_file_name(name));
        let line = Some(error.line).filter(|line| *line > 0);
        Failure::data(included.as_deref().unwrap_or(file), line, &error.message, &error.cure)
    };
    move |error| error.others.iter().map(one).fold(one(&error), Failure::and)
}

/// Files that a robot's file names.
struct Beside<'a> {
    file: &'a Path,
    reach: Reach,
}

impl Files for Beside<'_> {
    fn bytes(&self, name: &str) -> io::Result<Vec<u8>> {
        let read = |name: &str| Ok(read_named_bytes(self.file, name, self.reach, limits::MESH_BYTES)?.1);
        let Some(path) = name.strip_prefix("package://") else {
            return read(name.strip_prefix("file://").unwrap_or(name));
        };
        // A file lies in its package, in a folder beside others of it, or above the package.
        let within = path.split_once('/').map_or(path, |(_, within)| within);
        let ways = [within.to_owned(), path.to_owned(), format!("../{within}")];
        let mut first = None;
        for way in ways {
            match read(&way) {
                Err(error) if error.kind() == ErrorKind::NotFound => first = first.or(Some(error)),
                // Out of reach: the file is there, and may not be read.
                answer => return answer,
            }
        }
        Err(first.unwrap_or_else(|| ErrorKind::NotFound.into()))
    }
}
