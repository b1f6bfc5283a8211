//! What every code means, with an example that has the fault and the same one cured. In: a code. Out: words, lines of a
//! mechanism file. A test compiles all examples. Never knows what is wrong with a user's file.

mod assembly;
mod example;
mod flexible;
mod form;
mod mechanics;
mod names;
mod quantities;
mod structure;
mod warnings;

use super::Code;
pub use example::Explanation;

impl Code {
    /// What it means, with an example; every code has one.
    pub fn explanation(self) -> Option<&'static Explanation> {
        let groups = [
            form::FORM,
            names::NAMES,
            quantities::QUANTITIES,
            mechanics::MECHANICS,
            structure::STRUCTURE,
            assembly::ASSEMBLY,
            warnings::WARNINGS,
            warnings::PLAUSIBILITY,
            flexible::FLEXIBLE,
        ];
        groups.into_iter().flatten().find(|explanation| explanation.code == self)
    }
}

#[cfg(test)]
mod tests {
    use super::example::File;
    use super::*;
    use crate::compile::{Options, compile};
    use crate::source::SourceFile;

    /// Codes of all that is said of some lines of an example, and whether it compiles.
    fn told(explanation: &Explanation, lines: &str) -> (Vec<Code>, bool, String) {
        let set = lines.strip_prefix("--set ").and_then(|set| set.split_once('='));
        let overrides = set.into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
        // Where the files beside an example are.
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/diagnostic/explanation");
        let source = SourceFile { name: format!("{folder}/example.toml"), text: explanation.file(lines) };
        let (said, compiles) = match compile(&source, &Options { overrides, ..Options::default() }) {
            Ok(compiled) => (compiled.warnings, true),
            Err(errors) => (errors.list().to_vec(), false),
        };
        let texts: Vec<_> = said.iter().map(|one| one.message.clone()).collect();
        (said.iter().map(|one| one.code).collect(), compiles, texts.join("\n"))
    }

    #[test]
    fn every_code_has_an_example_that_shows_it_and_a_cure_that_does_not() {
        let mut wrong = String::new();
        for &code in Code::ALL {
            let Some(explanation) = code.explanation() else {
                wrong.push_str(&format!("{code:?}: no explanation\n"));
                continue;
            };
            let (codes, _, texts) = told(explanation, explanation.wrong);
            if !codes.contains(&code) {
                wrong.push_str(&format!("{} is not shown, but {codes:?} {texts}\n", code.as_str()));
            }
            let (codes, compiles, texts) = told(explanation, explanation.right);
            if !compiles || codes.iter().any(|code| *code != Code::UnusedParameter) {
                wrong.push_str(&format!("{} is not cured: {codes:?} {texts}\n", code.as_str()));
            }
        }
        assert!(wrong.is_empty(), "{wrong}");
    }

    #[test]
    fn examples_alone_are_right() {
        for file in [File::Swing, File::FourBar, File::Press] {
            let source = SourceFile { name: "example.toml".into(), text: file.text().into() };
            assert!(compile(&source, &Options::default()).unwrap().warnings.is_empty(), "{file:?}");
        }
    }
}
