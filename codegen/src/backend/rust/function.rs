//! One entry point as a documented function over flat slices, in parts where it is long.
//! In: a tape and its split. Out: text.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::tape::{Split, Tape};

use super::super::comment::one_line;
use super::super::interface::{blocks, cost, function_name};
use super::body;
use super::format::format_items;

/// Name of the macro that stands for a function's statements until its frame is formatted.
const STATEMENTS: &str = "__statements";

/// The public function and its parts.
pub fn functions(tape: &Tape, split: &Split, runtime: &TokenStream) -> String {
    let several = split.parts.len() > 1;
    let mut parts: Vec<String> = split.parts.iter().map(|part| body::part(tape, part)).collect();
    let (mut public, name) = (body::direct(tape), function_name(tape));
    if several {
        public.extend((1..=parts.len()).map(|number| format!("    {name}_part_{number}(x, y, w);\n")));
    } else {
        public.push_str(&parts.remove(0));
    }
    let mut statements = std::iter::once(public).chain(parts);
    let mut text = String::new();
    for line in format_items(frames(tape, split, runtime)).lines() {
        if line.trim_start().starts_with(STATEMENTS) {
            text.extend(statements.next());
        } else {
            text.extend([line, "\n"]);
        }
    }
    text
}

/// The functions with their documentation and bounds, without statements.
fn frames(tape: &Tape, split: &Split, runtime: &TokenStream) -> TokenStream {
    let own = function_name(tape);
    let name = format_ident!("{own}");
    let docs = documentation(tape, split);
    let (inputs, outputs, slots) = (tape.input_len(), tape.output_len(), split.slots as usize);
    let calls: Vec<Ident> =
        (1..=split.parts.len()).map(|number| format_ident!("{own}_part_{number}")).collect();
    let bounds = bounds(inputs, outputs, slots);
    let statements = format_ident!("{}", STATEMENTS);
    let parts = calls.iter().filter(|_| calls.len() > 1).map(|call| {
        quote! {
            #[allow(non_snake_case, unused_variables, clippy::all, clippy::pedantic)]
            #[inline(never)]
            fn #call<T: #runtime::Scalar>(x: &[T], y: &mut [T], w: &mut [T]) {
                #bounds
                #statements!();
            }
        }
    });
    quote! {
        #(#[doc = #docs])*
        #[allow(non_snake_case, unused_variables, clippy::all, clippy::pedantic)]
        pub fn #name<T: #runtime::Scalar>(x: &[T], y: &mut [T], w: &mut [T]) {
            #bounds
            #statements!();
        }
        #(#parts)*
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
    let escape = |text: &str| text.replace('[', "\\[").replace(']', "\\]");
    let mut lines = vec![one_line(&tape.doc), String::new()];
    lines.extend(blocks(tape, escape));
    lines.extend([String::new(), cost(tape, split)]);
    lines.iter().map(|line| if line.is_empty() { String::new() } else { format!(" {line}") }).collect()
}
