//! What generation and one call of the equations cost: `cargo bench -p linkwear-benchmarks`.
//! Compiled code and the interpreter run the same tape, so their ratio is the price of not having a compiler.

use std::path::Path;

use divan::{Bencher, black_box};
use linkwear::codegen::{Compiled, Options, SourceFile, compile};
use linkwear::mechanisms::SHIPPED;
use linkwear::runtime::{Entry, System};

const NAMES: [&str; 5] = ["pendulum", "four_bar", "rssr_rigid", "andrews", "n_four_bar_40"];

fn main() {
    divan::main();
}

fn source(name: &str) -> SourceFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mechanisms").join(format!("{name}.toml"));
    let text = std::fs::read_to_string(path).expect("a shipped mechanism");
    SourceFile { name: format!("mechanisms/{name}.toml"), text }
}

fn compiled(name: &str) -> Compiled {
    compile(&source(name), &Options::default()).expect("shipped mechanisms compile")
}

/// From text to Rust source, analysis included.
#[divan::bench(args = NAMES, sample_count = 10)]
fn generate(bencher: Bencher, name: &str) {
    let source = source(name);
    bencher.bench(|| compile(black_box(&source), &Options::default()).expect("compiles").rust_source().len());
}

fn forward(bencher: Bencher, system: &dyn System<f64>) {
    let sizes = system.sizes();
    let input: Vec<f64> = (0..sizes.input(Entry::ForwardDynamics)).map(|i| 0.3 + 0.1 * i as f64).collect();
    let mut output = vec![0.0; sizes.output(Entry::ForwardDynamics)];
    let mut workspace = vec![0.0; sizes.workspace];
    bencher.bench_local(|| {
        system.evaluate(Entry::ForwardDynamics, black_box(&input), &mut output, &mut workspace);
        output[0]
    });
}

/// One forward dynamics of compiled code.
#[divan::bench(args = NAMES)]
fn forward_dynamics_compiled(bencher: Bencher, name: &str) {
    let shipped = SHIPPED
        .iter()
        .chain(linkwear_benchmarks::SHIPPED)
        .find(|shipped| shipped.name == name)
        .expect("shipped");
    forward(bencher, &*(shipped.system)());
}

/// One forward dynamics by the interpreter.
#[divan::bench(args = NAMES)]
fn forward_dynamics_interpreted(bencher: Bencher, name: &str) {
    forward(bencher, &compiled(name).interpreter());
}
