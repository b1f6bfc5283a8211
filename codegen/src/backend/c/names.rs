//! Identifiers of C: unique, valid in C and C++, as close to the reader's names as possible. In: labels. Out: identifiers.

use super::super::names::{Unique, plain};

/// Words that a name of the user's cannot be, in C or in C++; such a name gets an underscore.
const TAKEN: &[&str] = &[
    // Keywords of C99 and C11.
    "auto",
    "break",
    "case",
    "char",
    "const",
    "continue",
    "default",
    "do",
    "double",
    "else",
    "enum",
    "extern",
    "float",
    "for",
    "goto",
    "if",
    "inline",
    "int",
    "long",
    "register",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "struct",
    "switch",
    "typedef",
    "union",
    "unsigned",
    "void",
    "volatile",
    "while",
    "_Bool",
    "_Complex",
    "_Imaginary",
    "_Alignas",
    "_Alignof",
    "_Atomic",
    "_Generic",
    "_Noreturn",
    "_Static_assert",
    "_Thread_local",
    "asm",
    "typeof",
    "constexpr",
    "nullptr",
    "alignas",
    "alignof",
    "bool",
    "true",
    "false",
    "static_assert",
    "thread_local",
    "typeof_unqual",
    // Of C++.
    "and",
    "and_eq",
    "bitand",
    "bitor",
    "catch",
    "char8_t",
    "char16_t",
    "char32_t",
    "class",
    "compl",
    "concept",
    "consteval",
    "constinit",
    "const_cast",
    "co_await",
    "co_return",
    "co_yield",
    "decltype",
    "delete",
    "dynamic_cast",
    "explicit",
    "export",
    "friend",
    "mutable",
    "namespace",
    "new",
    "noexcept",
    "not",
    "not_eq",
    "operator",
    "or",
    "or_eq",
    "private",
    "protected",
    "public",
    "reinterpret_cast",
    "requires",
    "static_cast",
    "template",
    "this",
    "throw",
    "try",
    "typeid",
    "typename",
    "using",
    "virtual",
    "wchar_t",
    "xor",
    "xor_eq",
    // Macros that compilers and headers bring along.
    "NULL",
    "NAN",
    "INFINITY",
    "HUGE_VAL",
    "linux",
    "unix",
    "i386",
    "EOF",
    "errno",
    "assert",
    "near",
    "far",
    "OVERFLOW",
    "UNDERFLOW",
    "DOMAIN",
    "SING",
    "I",
    "complex",
    "stdin",
    "stdout",
    "stderr",
    "signals",
    "slots",
    "emit",
    "math_errhandling",
    "offsetof",
    // Arguments, and functions that are called beside the user's names.
    "x",
    "y",
    "w",
    "sqrt",
    "fabs",
    "fma",
    "angle",
    "angle_over_sine",
    "exponential",
    "logarithm",
    "log_coefficient_0",
    "log_coefficient_1",
    "log_coefficient_2",
    "power_of_two",
    "significand",
    "binary_exponent",
    "sine_cosine",
    "sine_cosine_pair",
    "with_sign_of",
    "number_bits",
    "pair_0",
];

/// A valid identifier made of a name.
pub fn clean(name: &str) -> String {
    let mut text = plain(name);
    // Two underscores belong to the compiler in C++, one and a capital letter in C.
    while let Some(at) = text.find("__") {
        text.remove(at);
    }
    if text.starts_with('_') {
        text.insert(0, 'n');
    }
    if TAKEN.contains(&text.as_str()) {
        text.push('_');
    }
    text
}

/// Begin of every name in the files of a mechanism.
pub fn prefix(mechanism: &str) -> String {
    clean(mechanism).trim_end_matches('_').to_owned()
}

/// Hands out names that are unique within one function or list.
#[derive(Default)]
pub struct Names(Unique);

impl Names {
    /// The name, or the name with a number if it is taken.
    pub fn unique(&mut self, wanted: &str) -> String {
        self.0.of(clean(wanted))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_both_languages_digits_and_repeats_become_valid_names() {
        let mut names = Names::default();
        let found = ["class", "2nd", "a-b", "a.b", "x", "linux", "a__b", "_Q", "", "R1.q"]
            .map(|name| names.unique(name));
        assert_eq!(found, ["class_", "n2nd", "a_b", "a_b_2", "x_", "linux_", "a_b_3", "n_Q", "n", "R1_q"]);
    }
}
