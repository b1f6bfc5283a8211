//! The lengths of what the code is called with. In: addresses. Out: whether a value there is within.

use super::place::{Address, Base, Shape};

/// Lengths in bytes of what the four pointers point to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lengths {
    pub(crate) input: usize,
    pub(crate) output: usize,
    pub(crate) pool: usize,
    pub(crate) frame: usize,
}

impl Lengths {
    /// What is left of inputs and outputs where the last pass begins: further on by the values of all others.
    pub(super) fn of_last_pass(self, shape: Shape) -> Self {
        let of_others = shape.step - shape.value;
        let left = |length: usize| length.saturating_sub(of_others);
        Self { input: left(self.input), output: left(self.output), ..self }
    }

    /// Whether so many bytes at an address may be read, or written.
    pub(crate) fn hold(self, Address { base, offset }: Address, bytes: usize, written: bool) -> bool {
        let (length, writable) = match base {
            Base::Input => (self.input, false),
            Base::Output => (self.output, true),
            Base::Pool => (self.pool, false),
            Base::Frame => (self.frame, true),
        };
        let end = usize::try_from(offset).map(|offset| offset + bytes);
        end.is_ok_and(|end| end <= length) && (writable || !written)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_pass_ends_where_inputs_and_outputs_do() {
        let shape = Shape { value: 16, step: 64, registers: 1, columns: false };
        let three = Lengths { input: 3 * 64, output: 3 * 64, pool: 32, frame: 32 }.of_last_pass(shape);
        for (base, last) in [(Base::Input, 128), (Base::Output, 128), (Base::Pool, 16), (Base::Frame, 16)] {
            assert!(three.hold(Address { base, offset: last }, 16, false));
            assert!(!three.hold(Address { base, offset: last + 1 }, 16, false));
        }
        let none = Lengths { input: 0, output: 0, pool: 0, frame: 0 }.of_last_pass(shape);
        assert!(!none.hold(Address { base: Base::Input, offset: 0 }, 16, false));
        let alone = Shape { step: 16, ..shape };
        let one = Lengths { input: 16, output: 16, pool: 0, frame: 0 }.of_last_pass(alone);
        assert!(one.hold(Address { base: Base::Output, offset: 0 }, 16, true));
    }
}
