//! Random expression graphs: the tape computes what the graph means, and symbolic derivatives are those of dual numbers.

use linkwear_codegen::backend::interp::Interpreted;
use linkwear_codegen::derive::{Block, Equations, Function};
use linkwear_codegen::expr::{Expr, ExprId, Graph, Scope};
use linkwear_codegen::tape::{lower, split, verify};
use linkwear_runtime::{Description, Dual, Entry, Sizes, System};
use proptest::prelude::*;

const SYMBOLS: usize = 4;

/// One step of building: an operation and the places of its operands among what is there already.
type Step = (u8, u16, u16);

/// Symbols and outputs.
fn build<'g>(g: &'g Scope, steps: &[Step]) -> (Vec<Expr<'g>>, Vec<Expr<'g>>) {
    let symbols: Vec<Expr<'g>> = (0..SYMBOLS).map(|i| g.symbol(format!("s{i}"))).collect();
    let mut made = symbols.clone();
    for constant in [0.0, 1.0, -1.0, 0.75, 2.5] {
        made.push(g.number(constant));
    }
    for (operation, a, b) in steps {
        let (a, b) = (made[*a as usize % made.len()], made[*b as usize % made.len()]);
        let next = match operation % 9 {
            0 | 1 => a + b,
            2 | 3 => a - b,
            4 | 5 => a * b,
            6 => -a,
            7 => a.sin(),
            _ => a.cos(),
        };
        made.push(next);
    }
    let outputs = made[made.len() - 6.min(made.len())..].to_vec();
    (symbols, outputs)
}

fn ids(expressions: Vec<Expr<'_>>) -> Vec<ExprId> {
    expressions.into_iter().map(Expr::id).collect()
}

/// A finished graph with the ids of its symbols and outputs.
fn built(steps: &[Step]) -> (Graph, Vec<ExprId>, Vec<ExprId>) {
    let g = Scope::new();
    let (symbols, outputs) = build(&g, steps);
    let (symbols, outputs) = (ids(symbols), ids(outputs));
    (g.into_graph(), symbols, outputs)
}

/// The same function under every entry point: the interpreter wants one tape for each.
fn equations(graph: Graph, symbols: &[ExprId], outputs: &[ExprId]) -> Equations {
    let function = |entry: &Entry| Function {
        name: entry.name().to_owned(),
        doc: String::new(),
        inputs: vec![Block::vector("x", symbols.to_vec())],
        outputs: vec![Block::vector("y", outputs.to_vec())],
        goes_on: false,
    };
    Equations::of(graph, Entry::ALL.iter().map(function).collect())
}

fn nobody() -> Description {
    Description {
        name: "none".into(),
        parameters: vec![].into(),
        coordinates: vec![].into(),
        speeds: vec![].into(),
        motions: vec![].into(),
        inputs: vec![].into(),
        quaternions: vec![].into(),
        rows: vec![].into(),
        drivers: vec![].into(),
        channels: vec![].into(),
        turn_driver: None,
        contacts: Vec::new().into(),
        journals: Vec::new().into(),
        guides: Vec::new().into(),
        bends: Vec::new().into(),
        coefficients: Vec::new().into(),
        missions: Vec::new().into(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn tapes_compute_what_the_graph_means(
        steps in prop::collection::vec(any::<Step>(), 1..120),
        point in prop::array::uniform4(-2.0_f64..2.0),
    ) {
        let (graph, symbols, outputs) = built(&steps);
        let expected = graph.evaluate_all(&point);
        let expected: Vec<f64> = outputs.iter().map(|id| expected[id.index()]).collect();
        let tapes = lower(&equations(graph, &symbols, &outputs));
        prop_assert_eq!(verify(&tapes[0]), Ok(()));
        let interpreter = Interpreted::new(&tapes, Sizes::default(), nobody());
        let mut found = vec![0.0; outputs.len()];
        let mut workspace = vec![0.0; System::<f64>::sizes(&interpreter).workspace];
        interpreter.evaluate(Entry::Prescribed, &point, &mut found, &mut workspace);
        for (a, b) in found.iter().zip(&expected) {
            // Equal, or both not a number; absorbing a sign may turn 0 into -0, which compares equal.
            prop_assert!(a == b || (a.is_nan() && b.is_nan()), "{a} {b}");
        }
    }

    #[test]
    fn parts_hand_over_every_value_that_crosses(
        steps in prop::collection::vec(any::<Step>(), 1..200),
        limit in 3_usize..40,
    ) {
        let (graph, symbols, outputs) = built(&steps);
        let tape = lower(&equations(graph, &symbols, &outputs)).remove(0);
        let split = split(&tape, limit);
        let mut slots = vec![None; split.slots as usize];
        for part in &split.parts {
            let mut known: Vec<u32> = Vec::new();
            for (value, slot) in &part.loads {
                prop_assert_eq!(slots[*slot as usize], Some(*value));
                known.push(*value);
            }
            for statement in &tape.statements[part.statements.clone()] {
                let stored = statement.stores.iter().map(|(_, operand)| *operand);
                for operand in statement.op.operands() {
                    if let linkwear_codegen::tape::Operand::Value(value) = operand {
                        prop_assert!(known.contains(&value));
                    }
                }
                known.extend(statement.results());
                for operand in stored {
                    if let linkwear_codegen::tape::Operand::Value(value) = operand {
                        prop_assert!(known.contains(&value));
                    }
                }
            }
            for (value, slot) in &part.saves {
                slots[*slot as usize] = Some(*value);
            }
        }
    }

    #[test]
    fn symbolic_derivatives_are_those_of_dual_numbers(
        steps in prop::collection::vec(any::<Step>(), 1..25),
        point in prop::array::uniform4(-1.5_f64..1.5),
        by in 0..SYMBOLS,
    ) {
        let g = Scope::new();
        let (symbols, outputs) = build(&g, &steps);
        let derivatives = ids(outputs.iter().map(|output| output.derivative(symbols[by])).collect());
        let outputs = ids(outputs);
        let graph = g.into_graph();
        let values = graph.evaluate_all(&point);
        let duals: Vec<Dual<f64>> = point
            .iter()
            .enumerate()
            .map(|(i, x)| Dual { value: *x, derivative: f64::from(u8::from(i == by)) })
            .collect();
        let lifted = graph.evaluate_all(&duals);
        for (output, derivative) in outputs.iter().zip(&derivatives) {
            let (a, b) = (values[derivative.index()], lifted[output.index()].derivative);
            // Products of up to 25 factors below 1.5 and their sums: a few hundred roundings of the largest term.
            prop_assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs().max(b.abs())) || !b.is_finite(), "{a} {b}");
        }
    }
}
