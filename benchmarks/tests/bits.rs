//! Compiled code, machine code written at run time and the interpreter run the same tape: every entry point of every shipped
//! mechanism must agree in every bit.

#[path = "../../tests/support/random.rs"]
mod random;

use linkwear::mechanisms::{SHIPPED, Shipped};
use linkwear::native::{Lanes, Native, Refusal};
use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_runtime::{Description, Entry, System};
use random::Random;

/// All that are compiled in, here or in linkwear itself.
fn all() -> impl Iterator<Item = &'static Shipped> {
    SHIPPED.iter().chain(linkwear_benchmarks::SHIPPED)
}

fn compiled(name: &str) -> Compiled {
    let path = format!("{}/../mechanisms/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped mechanism");
    compile(&SourceFile { name: format!("mechanisms/{name}.toml"), text }, &Options::default())
        .expect("shipped mechanisms compile")
}

#[test]
fn compiled_and_interpreted_entries_agree_bit_for_bit() {
    for shipped in all() {
        let interpreted = compiled(shipped.name).interpreter();
        let system = (shipped.system)();
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let (sizes, other) = (system.sizes(), System::<f64>::sizes(&interpreted));
        for entry in Entry::ALL {
            assert_eq!(sizes.input(entry), other.input(entry), "{}", shipped.name);
            for _ in 0..50 {
                let input: Vec<f64> = (0..sizes.input(entry)).map(|_| 3.0 * random.next()).collect();
                let mut outputs = [vec![0.0; sizes.output(entry)], vec![1.0; sizes.output(entry)]];
                system.evaluate(entry, &input, &mut outputs[0], &mut vec![0.0; sizes.workspace]);
                interpreted.evaluate(entry, &input, &mut outputs[1], &mut vec![0.0; other.workspace]);
                let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
                assert_eq!(bits(&outputs[0]), bits(&outputs[1]), "{} of {}", entry.name(), shipped.name);
            }
        }
    }
}

/// Machine code; none on processors that it is not written for.
fn native(compiled: &Compiled) -> Option<Native> {
    match Native::new(compiled.tapes(), compiled.sizes()) {
        Err(Refusal::Processor { .. }) => None,
        written => Some(written.expect("shipped mechanisms are written")),
    }
}

#[test]
fn native_and_interpreted_entries_agree_bit_for_bit() {
    for shipped in all() {
        let compiled = compiled(shipped.name);
        let Some(native) = native(&compiled) else { return };
        let interpreted = compiled.interpreter();
        let mut random = Random(0x2545_F491_4F6C_DD1D);
        let (sizes, other) = (native.sizes(), System::<f64>::sizes(&interpreted));
        for entry in Entry::ALL {
            for _ in 0..50 {
                let input: Vec<f64> = (0..sizes.input(entry)).map(|_| 3.0 * random.next()).collect();
                let mut outputs = [vec![0.0; sizes.output(entry)], vec![1.0; sizes.output(entry)]];
                native.evaluate(entry, &input, &mut outputs[0], &mut vec![f64::NAN; sizes.workspace]);
                interpreted.evaluate(entry, &input, &mut outputs[1], &mut vec![0.0; other.workspace]);
                let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
                assert_eq!(bits(&outputs[0]), bits(&outputs[1]), "{} of {}", entry.name(), shipped.name);
            }
        }
    }
}

/// Every lane has the bits of the state alone.
fn lanes_agree<const N: usize>() {
    for shipped in all() {
        let compiled = compiled(shipped.name);
        let lanes = match Lanes::<N>::new(compiled.tapes(), compiled.sizes()) {
            Err(Refusal::Processor { .. }) => return,
            written => written.expect("shipped mechanisms are written"),
        };
        let alone = compiled.interpreter();
        let mut random = Random(0x9E6C_63D0_876A_68DE);
        let (sizes, other) = (lanes.sizes(), System::<f64>::sizes(&alone));
        for entry in Entry::ALL {
            let mut input = vec![[0.0; N]; sizes.input(entry)];
            input.as_flattened_mut().fill_with(|| 3.0 * random.next());
            let mut output = vec![[0.0; N]; sizes.output(entry)];
            lanes.evaluate(entry, &input, &mut output, &mut vec![[f64::NAN; N]; sizes.workspace]);
            for lane in 0..N {
                let state: Vec<f64> = input.iter().map(|value| value[lane]).collect();
                let mut expected = vec![1.0; sizes.output(entry)];
                alone.evaluate(entry, &state, &mut expected, &mut vec![0.0; other.workspace]);
                let found = output.iter().map(|value| value[lane].to_bits());
                let expected = expected.iter().map(|value| value.to_bits());
                assert!(found.eq(expected), "lane {lane} of {}, {} of {}", N, entry.name(), shipped.name);
            }
        }
    }
}

#[test]
fn four_states_side_by_side_have_the_bits_of_each_alone() {
    lanes_agree::<4>();
}

#[test]
fn eight_states_side_by_side_have_the_bits_of_each_alone() {
    lanes_agree::<8>();
}

#[test]
fn compiled_code_describes_itself_as_the_generator_does() {
    for shipped in all() {
        // Tables of generated code do not say how far bodies may bend.
        let expected =
            Description { bends: Vec::new().into(), ..compiled(shipped.name).description().clone() };
        assert_eq!((shipped.description)(), &expected);
    }
}

#[test]
fn every_shipped_file_is_compiled_and_carries_its_own_name() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../mechanisms");
    let files = std::fs::read_dir(folder).expect("mechanisms folder");
    let mut names: Vec<String> = files
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    names.sort();
    let mut compiled: Vec<&str> = all().map(|shipped| shipped.name).collect();
    compiled.sort_unstable();
    assert_eq!(names, compiled);
    for shipped in all() {
        assert_eq!((shipped.description)().name, shipped.name);
    }
}
