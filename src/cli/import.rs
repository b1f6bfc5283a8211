//! `import`: a mechanism file from a robot of another format.

use std::io::Write as _;

use linkwear_codegen::input::read_text;
use linkwear_codegen::limits;

use super::answer::Answer;
use super::answer::equations::ImportAnswer;
use super::arguments::ImportArguments;
use super::failure::Failure;
use super::input::check_output;
use crate::files::{WriteError, write_whole};
use crate::import::{Base, from_urdf};

pub fn run(arguments: &ImportArguments) -> Result<Answer, Failure> {
    let (file, out) = (&arguments.file, &arguments.out);
    let is_stream = check_output(file, Some(out))?;
    if !is_stream && out.exists() {
        return Err(WriteError::Exists(out.clone()).into());
    }
    let text = read_text(file, limits::DATA_BYTES).map_err(Failure::read(file))?;
    let base = if arguments.floating { Base::Floating } else { Base::Fixed };
    let made = from_urdf(&text, base)
        .map_err(|error| Failure::data(file, Some(error.line), &error.message, &error.cure))?;
    write_whole(out, |target| target.write_all(made.text.as_bytes()))?;
    let shown = out.display();
    let mut text = format!("{shown} written: {} bodies, {} joints\n", made.bodies, made.joints);
    text.push_str("\nnot carried over, or changed:\n");
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
    };
    Ok(Answer::new(text, told, None))
}
