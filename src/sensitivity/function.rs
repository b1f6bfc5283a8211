//! A tape with its tangent, run for several directions side by side. In: a tape. Out: values and tangents. Never knows mechanics.

use linkwear_codegen::tape::{self, Tape};
use linkwear_native::Routine;

use super::tangents::Varied;

/// A tape with its tangent in `N` lanes, a direction in each.
pub(super) struct Function<const N: usize> {
    code: Code<N>,
    /// Inputs, then their tangents.
    pub(super) input: Vec<[f64; N]>,
    /// Outputs, then their tangents.
    output: Vec<[f64; N]>,
    workspace: Vec<[f64; N]>,
}

enum Code<const N: usize> {
    Native(Routine<N>),
    /// Where this processor has no code, or a system forbids it: lane by lane, in the same bits.
    Interpreted {
        routine: tape::Routine,
        numbers: Vec<f64>,
    },
}

impl<const N: usize> Function<N> {
    /// Of a tape, everything zero.
    pub(super) fn new(tape: &Tape) -> Self {
        let tangent = tape.tangent();
        let (code, workspace) = match Routine::new(&tangent) {
            Ok(routine) => {
                let workspace = vec![[0.0; N]; routine.workspace()];
                (Code::Native(routine), workspace)
            }
            Err(_) => {
                let routine = tape::Routine::new(&tangent);
                let numbers = tangent.input_len() + tangent.output_len() + routine.workspace();
                (Code::Interpreted { numbers: vec![0.0; numbers], routine }, Vec::new())
            }
        };
        let (input, output) = (vec![[0.0; N]; tangent.input_len()], vec![[0.0; N]; tangent.output_len()]);
        Self { code, input, output, workspace }
    }

    /// Writes an input, the same in all lanes.
    pub(super) fn put(&mut self, place: usize, value: f64) {
        self.input[place] = [value; N];
    }

    /// Writes an input that varies.
    pub(super) fn put_varied(&mut self, place: usize, one: &Varied<N>) {
        self.put(place, one.value);
        let inputs = self.input.len() / 2;
        self.input[inputs + place] = one.tangents;
    }

    /// Writes inputs from a place on as another function has answered: values and tangents.
    pub(super) fn put_many(&mut self, first: usize, (values, tangents): (&[[f64; N]], &[[f64; N]])) {
        let half = self.input.len() / 2;
        let (inputs, its_tangents) = self.input.split_at_mut(half);
        inputs[first..][..values.len()].copy_from_slice(values);
        its_tangents[first..][..tangents.len()].copy_from_slice(tangents);
    }

    /// Inputs from a place on: values and tangents.
    pub(super) fn told(&self, first: usize) -> (&[[f64; N]], &[[f64; N]]) {
        let (inputs, its_tangents) = self.input.split_at(self.input.len() / 2);
        (&inputs[first..], &its_tangents[first..])
    }

    /// Runs it. Out: values and tangents.
    pub(super) fn run(&mut self) -> (&[[f64; N]], &[[f64; N]]) {
        let Self { code, input, output, workspace } = self;
        match code {
            Code::Native(routine) => routine.run(input, output, workspace),
            Code::Interpreted { routine, numbers } => {
                let (inputs, rest) = numbers.split_at_mut(input.len());
                let (outputs, workspace) = rest.split_at_mut(output.len());
                for lane in 0..N {
                    inputs.iter_mut().zip(&*input).for_each(|(place, value)| *place = value[lane]);
                    routine.run(inputs, outputs, workspace);
                    output.iter_mut().zip(&*outputs).for_each(|(place, value)| place[lane] = *value);
                }
            }
        }
        output.split_at(output.len() / 2)
    }
}
