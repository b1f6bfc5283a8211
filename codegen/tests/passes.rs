//! Passes that shorten a function change its values by rounding only. Each evaluation carries a bound of its own rounding
//! errors, so the test needs no tolerance: a value that moves further than both bounds together is another value.

use std::path::Path;

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::expr::{Binary, Expr, ExprId, Graph, Node, Scope, Unary, shortened};
use linkwear_codegen::source::SourceFile;
use proptest::prelude::*;

/// A value, and how far rounding may have moved it.
#[derive(Clone, Copy)]
struct Bounded {
    value: f64,
    error: f64,
}

/// Values of all nodes with running error bounds; a node that has no bound here gets an infinite one.
fn bounded(graph: &Graph, nodes: usize, symbol: &dyn Fn(usize) -> f64) -> Vec<Bounded> {
    let mut all: Vec<Bounded> = Vec::with_capacity(nodes);
    for index in 0..nodes {
        let at = |id: ExprId| all[id.index()];
        // A number may have been exchanged for one a few roundings away.
        let near = |value: f64| Bounded { value, error: 4.0 * f64::EPSILON * value.abs() };
        let (value, error) = match graph.node(ExprId::new(index)) {
            Node::Constant(bits) => (f64::from_bits(bits), near(f64::from_bits(bits)).error),
            Node::Symbol(id) => (symbol(id.index()), 0.0),
            Node::Unary(Unary::Neg, a) => (-at(a).value, at(a).error),
            Node::Unary(Unary::Sin, a) => (at(a).value.sin(), at(a).error),
            Node::Unary(Unary::Cos, a) => (at(a).value.cos(), at(a).error),
            Node::Unary(Unary::Sqrt, a) => (at(a).value.sqrt(), at(a).error / at(a).value.sqrt()),
            Node::Unary(Unary::Exp, a) => (at(a).value.exp(), at(a).error * at(a).value.exp()),
            // A choice may fall the other way after a rounding.
            Node::Unary(..) | Node::Binary(Binary::AngleOverSine, ..) | Node::Select(..) => {
                (f64::NAN, f64::INFINITY)
            }
            Node::Binary(operation, a, b) => {
                let (a, b) = (at(a), at(b));
                let square = a.value * a.value + b.value * b.value;
                match operation {
                    Binary::Add => (a.value + b.value, a.error + b.error),
                    Binary::Sub => (a.value - b.value, a.error + b.error),
                    Binary::Mul => (
                        a.value * b.value,
                        a.value.abs() * b.error + b.value.abs() * a.error + a.error * b.error,
                    ),
                    Binary::Div => {
                        let value = a.value / b.value;
                        (value, (a.error + value.abs() * b.error) / (b.value.abs() - b.error).max(0.0))
                    }
                    Binary::Atan2 | Binary::AngleOverSine => {
                        let turned = a.value.abs() * b.error + b.value.abs() * a.error;
                        (a.value.atan2(b.value), turned / square)
                    }
                }
            }
        };
        // Sines and cosines are good to one unit in the last place, the rest to half a unit.
        all.push(Bounded { value, error: error + 2.0 * f64::EPSILON * value.abs() });
    }
    all
}

/// Largest share of the allowed difference that outputs use; `None` where nothing can be said.
fn worst(before: &[Bounded], after: &[Bounded]) -> Option<f64> {
    let shares = before.iter().zip(after).map(|(a, b)| {
        let allowed = a.error + b.error;
        let known = a.value.is_finite() && b.value.is_finite() && allowed.is_finite();
        (known && a.value != b.value).then(|| (a.value - b.value).abs() / allowed)
    });
    shares.flatten().reduce(f64::max)
}

/// As [`worst`], for a function before and after the passes.
fn changed(graph: &Graph, inputs: &[ExprId], roots: &[ExprId], point: &[f64]) -> (Option<f64>, [usize; 2]) {
    let short = shortened(graph, inputs, roots);
    let outputs = |graph: &Graph, inputs: &[ExprId], roots: &[ExprId]| -> Vec<Bounded> {
        let mut values = vec![
            0.0;
            1 + inputs
                .iter()
                .map(|id| graph.as_symbol(*id).expect("a symbol").index())
                .max()
                .unwrap_or(0)
        ];
        for (id, value) in inputs.iter().zip(point) {
            values[graph.as_symbol(*id).expect("a symbol").index()] = *value;
        }
        let last = roots.iter().chain(inputs).map(|id| id.index()).max().unwrap_or(0);
        let all = bounded(graph, last + 1, &|symbol| values.get(symbol).copied().unwrap_or(0.0));
        roots.iter().map(|id| all[id.index()]).collect()
    };
    let counts = [graph.operations(roots), short.graph.operations(&short.roots)];
    let (before, after) = (outputs(graph, inputs, roots), outputs(&short.graph, &short.inputs, &short.roots));
    (worst(&before, &after), counts)
}

fn mechanism(name: &str) -> Compiled {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mechanisms").join(format!("{name}.toml"));
    let source = SourceFile { name: name.to_owned(), text: std::fs::read_to_string(path).expect("a file") };
    compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn shortened_mechanisms_have_the_same_values_but_for_rounding() {
    let mut compared = 0;
    for name in ["four_bar", "bennett", "rssr_rigid", "rssr_flexible", "rssr", "andrews", "flyball"] {
        let compiled = mechanism(name);
        for (graph, function) in compiled.equations.functions() {
            let flat = |blocks: &[linkwear_codegen::derive::Block]| -> Vec<ExprId> {
                blocks.iter().flat_map(|block| block.entries.clone()).collect()
            };
            let (inputs, roots) = (flat(&function.inputs), flat(&function.outputs));
            // Any point will do: these are facts about expressions, not about closed positions.
            let point: Vec<f64> = (0..inputs.len()).map(|i| 0.3 + 0.7 * (1.7 * i as f64).sin()).collect();
            let (worst, [before, after]) = changed(graph, &inputs, &roots, &point);
            assert!(after <= before, "{name} {}: {before} to {after}", function.name);
            assert!(worst.is_none_or(|share| share <= 1.0), "{name} {}: {worst:?}", function.name);
            compared += usize::from(worst.is_some());
        }
    }
    // Where nothing moved, nothing was tested.
    assert!(compared > 20, "{compared}");
}

/// One step of building: an operation and the places of its operands among what is there already.
type Step = (u8, u16, u16);

fn build<'g>(g: &'g Scope, steps: &[Step]) -> (Vec<Expr<'g>>, Vec<Expr<'g>>) {
    let symbols: Vec<Expr<'g>> = (0..5).map(|i| g.symbol(format!("s{i}"))).collect();
    let mut made = symbols.clone();
    made.extend([0.75, -2.5].map(|number| g.number(number)));
    for (operation, a, b) in steps {
        let (a, b) = (made[*a as usize % made.len()], made[*b as usize % made.len()]);
        made.push(match operation % 8 {
            0 | 1 => a + b,
            2 | 3 => a - b,
            4..=6 => a * b,
            _ => a.sin(),
        });
    }
    let outputs = made[made.len() - 4.min(made.len())..].to_vec();
    (symbols, outputs)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn shortened_graphs_have_the_same_values_but_for_rounding(
        steps in prop::collection::vec(any::<Step>(), 1..80),
        point in prop::array::uniform5(-1.2_f64..1.2),
    ) {
        let g = Scope::new();
        let (symbols, outputs) = build(&g, &steps);
        let [symbols, outputs] = [symbols, outputs].map(|list| list.into_iter().map(Expr::id).collect::<Vec<_>>());
        let (worst, [before, after]) = changed(&g.into_graph(), &symbols, &outputs, &point);
        prop_assert!(after <= before);
        prop_assert!(worst.is_none_or(|share| share <= 1.0), "{worst:?}");
    }
}
