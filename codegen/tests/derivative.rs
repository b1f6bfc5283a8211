//! The derivative is forward dynamics and rates in one, contacts in between; accelerations are the first block of forward
//! dynamics. Each has operations of its own: they agree but for rounding.

#[path = "../../tests/support/random.rs"]
mod random;

use std::path::Path;

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{CONTACT_WRENCH, Entry, System, assemble};
use random::Random;

fn compiled(path: &Path) -> Compiled {
    let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
    let source = SourceFile { name, text: std::fs::read_to_string(path).expect("a file") };
    compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Largest difference, relative to the largest number. What is not a number wins.
fn difference(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let size = expected.iter().fold(f64::MIN_POSITIVE, |size, x| size.max(x.abs()));
    found.iter().zip(expected).fold(0.0, |worst, (a, b)| larger(worst, (a - b).abs() / size))
}

fn larger(a: f64, b: f64) -> f64 {
    if b <= a { a } else { b }
}

/// Worst differences at random states beside closed positions, under random wrenches: of accelerations alone, then of the
/// derivative by block.
fn worst(compiled: &Compiled) -> (usize, [f64; 7]) {
    let system = compiled.interpreter();
    let sizes = System::<f64>::sizes(&system);
    let mut workspace = vec![0.0; sizes.workspace];
    let mut ask = |entry: Entry, input: &[f64]| {
        let mut output = vec![f64::NAN; sizes.output(entry)];
        system.evaluate(entry, input, &mut output, &mut workspace);
        output
    };
    let parameters = compiled.parameters();
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let (mut states, mut worst) = (0, [0.0_f64; 7]);
    for _ in 0..20 {
        let t = 0.1 * (1.0 + random.next());
        let Ok(mut state) = assemble(&system, compiled.description(), &parameters, t) else { continue };
        states += 1;
        for place in state.q.iter_mut().chain(&mut state.v) {
            *place += 1e-4 * random.next();
        }
        let wrenches: Vec<f64> = (0..CONTACT_WRENCH * sizes.contacts).map(|_| 10.0 * random.next()).collect();
        let base = [&parameters[..], &[t], &state.q, &state.v].concat();
        let loaded = [&base[..], &wrenches].concat();
        let forward = ask(Entry::ForwardDynamics, &loaded);
        let contacts = ask(Entry::Contacts, &base);
        let derivative = ask(Entry::Derivative, &[&loaded[..], &contacts].concat());
        let accelerations = ask(Entry::Accelerations, &loaded);
        let lengths = [sizes.speeds, sizes.rows, sizes.drivers, sizes.rows];
        let ends: Vec<usize> = lengths
            .iter()
            .scan(0, |end, length| {
                *end += length;
                Some(*end)
            })
            .collect();
        let drives = &forward[ends[1]..ends[2]];
        let rates = ask(Entry::Rates, &[&base[..], drives].concat());
        let (coordinates, rest) = derivative.split_at(sizes.coordinates);
        let (of_forward, powers) = rest.split_at(forward.len());
        let alone = [&forward[..ends[0]], &forward[ends[2]..]].concat();
        let (known_coordinates, known_powers) = rates.split_at(sizes.coordinates);
        let now = [
            difference(&accelerations[..ends[0]], &alone[..ends[0]]),
            difference(coordinates, known_coordinates),
            difference(&of_forward[..ends[0]], &forward[..ends[0]]),
            difference(&of_forward[ends[0]..ends[1]], &forward[ends[0]..ends[1]]),
            difference(&of_forward[ends[1]..ends[2]], drives),
            difference(&of_forward[ends[2]..], &forward[ends[2]..]),
            difference(powers, known_powers),
        ];
        worst.iter_mut().zip(now).for_each(|(worst, now)| *worst = larger(*worst, now));
    }
    (states, worst)
}

#[test]
fn it_agrees_with_the_entries_that_it_is_made_of() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mechanisms");
    let entries = std::fs::read_dir(folder)
        .expect("a folder of mechanisms")
        .map(|entry| entry.expect("an entry").path());
    let files: Vec<_> =
        entries.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
    assert!(files.len() >= 15, "{}", files.len());
    for path in files {
        let compiled = compiled(&path);
        let (states, worst) = worst(&compiled);
        let name = &compiled.source.name;
        assert!(states >= 3, "{name}: {states} states");
        // Some roundings of one value, times the condition of the equations; forty loops in a row have the worst.
        let bound = if compiled.sizes().contacts > 0 { 1e-14 } else { 1e-13 };
        assert!(worst.iter().all(|worst| *worst <= bound), "{name}: {worst:?}");
    }
}
