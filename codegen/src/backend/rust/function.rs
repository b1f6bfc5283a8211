//! One entry point as a documented function over flat slices, in parts where it is long.
//! In: a tape and its split. Out: tokens.

use std::collections::{BTreeMap, HashMap};

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::derive::Block;
use crate::expr::{Binary, Unary};
use crate::tape::{Op, Operand, Part, Split, Statement, Tape};

use super::comment::{MARKER, count_text, one_line};
use super::names::Names;

/// The public function and its parts.
pub fn functions(tape: &Tape, split: &Split, runtime: &TokenStream) -> TokenStream {
    let name = format_ident!("{}", tape.name);
    let docs = documentation(tape, split);
    let (inputs, outputs, slots) = (tape.input_len(), tape.output_len(), split.slots as usize);
    let calls: Vec<Ident> =
        (1..=split.parts.len()).map(|number| format_ident!("{}_part_{}", tape.name, number)).collect();
    let several = split.parts.len() > 1;
    let direct = stores(&tape.direct, &|operand| direct_operand(operand));
    let bounds = bounds(inputs, outputs, slots);
    let body = if several { quote!(#(#calls(x, y, w);)*) } else { part_body(tape, &split.parts[0]) };
    let parts = several.then(|| {
        let parts = split.parts.iter().zip(&calls).map(|(part, call)| {
            let body = part_body(tape, part);
            quote! {
                #[allow(non_snake_case, unused_variables, clippy::all, clippy::pedantic)]
                #[inline(never)]
                fn #call<T: #runtime::Scalar>(x: &[T], y: &mut [T], w: &mut [T]) {
                    #bounds
                    #body
                }
            }
        });
        quote!(#(#parts)*)
    });
    quote! {
        #(#[doc = #docs])*
        #[allow(non_snake_case, unused_variables, clippy::all, clippy::pedantic)]
        pub fn #name<T: #runtime::Scalar>(x: &[T], y: &mut [T], w: &mut [T]) {
            #bounds
            #direct
            #body
        }
        #parts
    }
}

/// Slices of known length, so that every index below is checked once, here.
fn bounds(inputs: usize, outputs: usize, slots: usize) -> TokenStream {
    let [inputs, outputs, slots] = [inputs, outputs, slots].map(Literal::usize_unsuffixed);
    quote! {
        let x = &x[..#inputs];
        let y = &mut y[..#outputs];
        let w = &mut w[..#slots];
    }
}

fn documentation(tape: &Tape, split: &Split) -> Vec<String> {
    let mut lines = vec![format!(" {}", one_line(&tape.doc)), String::new()];
    let mut list = |title: &str, blocks: &[Block]| {
        let mut first = 0;
        for block in blocks {
            let end = first + block.entries.len();
            let range = if first == end { "empty".to_owned() } else { format!("{first}..{end}") };
            first = end;
            let text = format!("{}{}", block.doc, block.cited());
            lines.push(format!(
                " - `{title}[{range}]` {} ({}): {}",
                block.name,
                block.shape(),
                one_line(&text.replace('[', "\\[").replace(']', "\\]"))
            ));
        }
    };
    list("x", &tape.inputs);
    list("y", &tape.outputs);
    lines.push(String::new());
    lines.push(format!(
        " {} in {} {}; `w` holds {} values between parts.",
        count_text(&tape.operations()),
        split.parts.len(),
        if split.parts.len() == 1 { "part" } else { "parts" },
        split.slots
    ));
    lines
}

/// Statements of one part.
fn part_body(tape: &Tape, part: &Part) -> TokenStream {
    let mut names = Names::default();
    let mut inputs: BTreeMap<u32, Ident> = BTreeMap::new();
    let mut values: HashMap<u32, TokenStream> = HashMap::new();
    let mut tokens = TokenStream::new();
    let statements = &tape.statements[part.statements.clone()];
    for statement in statements {
        for operand in statement.reads() {
            if let Operand::Input(index) = operand {
                inputs.entry(index).or_insert_with(|| names.unique(&tape.input_names[index as usize]));
            }
        }
    }
    for (index, name) in &inputs {
        let index = Literal::u32_unsuffixed(*index);
        tokens.extend(quote!(let #name = x[#index];));
    }
    // Read where they are used: a `let` each would count against what compilers can take in one function.
    for (value, slot) in &part.loads {
        let slot = Literal::usize_unsuffixed(*slot as usize);
        values.insert(*value, quote!(w[#slot]));
    }
    let mut section = None;
    for statement in statements {
        if section != Some(statement.section) {
            section = Some(statement.section);
            let marker = format_ident!("{}", MARKER);
            let index = Literal::usize_unsuffixed(statement.section);
            tokens.extend(quote!(#marker!(#index);));
        }
        tokens.extend(statement_tokens(statement, &inputs, &mut values, &mut names));
    }
    for (value, slot) in &part.saves {
        let (name, slot) = (&values[value], Literal::usize_unsuffixed(*slot as usize));
        tokens.extend(quote!(w[#slot] = #name;));
    }
    tokens
}

fn statement_tokens(
    statement: &Statement,
    inputs: &BTreeMap<u32, Ident>,
    values: &mut HashMap<u32, TokenStream>,
    names: &mut Names,
) -> TokenStream {
    let right = {
        let operand = |operand: Operand| operand_tokens(operand, inputs, values);
        match statement.op {
            Op::Unary(operation, a) => unary(operation, &operand(a)),
            Op::Binary(operation, a, b) => binary(operation, &operand(a), &operand(b)),
            Op::SinCos(a) => {
                let a = operand(a);
                quote!(T::sin_cos(#a))
            }
        }
    };
    let mut name = |which: u32| {
        let value = statement.first + which;
        let wanted = statement.labels[which as usize].clone().unwrap_or_else(|| format!("t{value}"));
        let name = names.unique(&wanted);
        values.insert(value, quote!(#name));
        name
    };
    let left = match statement.op {
        Op::SinCos(_) => {
            let (sine, cosine) = (name(0), name(1));
            quote!((#sine, #cosine))
        }
        _ => {
            let name = name(0);
            quote!(#name)
        }
    };
    let stores = stores(&statement.stores, &|operand| operand_tokens(operand, inputs, values));
    quote!(let #left = #right; #stores)
}

fn stores(list: &[(u32, Operand)], tokens: &dyn Fn(Operand) -> TokenStream) -> TokenStream {
    let stores = list.iter().map(|(index, operand)| {
        let (index, value) = (Literal::usize_unsuffixed(*index as usize), tokens(*operand));
        quote!(y[#index] = #value;)
    });
    quote!(#(#stores)*)
}

fn direct_operand(operand: Operand) -> TokenStream {
    match operand {
        Operand::Input(index) => {
            let index = Literal::usize_unsuffixed(index as usize);
            quote!(x[#index])
        }
        other => operand_tokens(other, &BTreeMap::new(), &HashMap::new()),
    }
}

fn operand_tokens(
    operand: Operand,
    inputs: &BTreeMap<u32, Ident>,
    values: &HashMap<u32, TokenStream>,
) -> TokenStream {
    match operand {
        Operand::Constant(number) => constant(number),
        Operand::Input(index) => {
            let name = &inputs[&index];
            quote!(#name)
        }
        Operand::Value(value) => values[&value].clone(),
    }
}

/// A number as its shortest literal that reads back to the same bits.
fn constant(number: f64) -> TokenStream {
    if number.is_nan() {
        return quote!(T::constant(f64::NAN));
    }
    if number.is_infinite() {
        let name = if number > 0.0 { quote!(INFINITY) } else { quote!(NEG_INFINITY) };
        return quote!(T::constant(f64::#name));
    }
    #[expect(clippy::expect_used, reason = "`Debug` of a finite number is a literal of Rust")]
    let literal: Literal = format!("{:?}", number.abs()).parse().expect("Debug of f64 is a literal");
    if number.is_sign_negative() { quote!(T::constant(-#literal)) } else { quote!(T::constant(#literal)) }
}

#[expect(clippy::unreachable, reason = "lowering turns sines and cosines into pairs")]
fn unary(operation: Unary, a: &TokenStream) -> TokenStream {
    match operation {
        Unary::Neg => quote!(-#a),
        Unary::Sqrt => quote!(T::sqrt(#a)),
        Unary::Exp => quote!(T::exp(#a)),
        Unary::Ln => quote!(T::ln(#a)),
        Unary::LogCoefficient(rank) => {
            let rank = Literal::u8_unsuffixed(rank);
            quote!(log_coefficient(#rank, #a))
        }
        Unary::Sin | Unary::Cos => unreachable!("lowering turns sines and cosines into pairs"),
    }
}

fn binary(operation: Binary, a: &TokenStream, b: &TokenStream) -> TokenStream {
    match operation {
        Binary::Add => quote!(#a + #b),
        Binary::Sub => quote!(#a - #b),
        Binary::Mul => quote!(#a * #b),
        Binary::Div => quote!(#a / #b),
        Binary::Atan2 => quote!(T::atan2(#a, #b)),
        Binary::AngleOverSine => quote!(angle_over_sine(#a, #b)),
    }
}
