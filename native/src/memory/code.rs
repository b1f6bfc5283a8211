//! Executable memory and the call into it. In: functions as written. Out: [`Code`], whose calls are safe.
#![expect(unsafe_code, reason = "machine code cannot be called without; see the top of the crate")]

use std::mem;

use memmap2::{Mmap, MmapMut};

use crate::refusal::Refusal;
use crate::straight::write::Written;

/// Where functions begin, and constants: at whole lines of the cache.
const LINE: usize = 64;

/// A line of constants.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Line([u64; LINE / size_of::<u64>()]);

/// Inputs, outputs, constants, workspace. The same convention on every system.
#[cfg(target_arch = "x86_64")]
type Call = unsafe extern "sysv64" fn(*const f64, *mut f64, *const Line, *mut f64);
#[cfg(not(target_arch = "x86_64"))]
type Call = unsafe extern "C" fn(*const f64, *mut f64, *const Line, *mut f64);

/// A function in executable memory.
#[derive(Debug)]
struct Callable {
    /// Where its code begins.
    start: usize,
    pool: Vec<Line>,
    inputs: usize,
    outputs: usize,
    workspace: usize,
    slack: usize,
    passes: usize,
    advance: usize,
    columns: bool,
}

impl Callable {
    /// What it needs of a workspace, from where a line of the cache begins if that helps.
    fn scratch<'w>(&self, workspace: &'w mut [f64]) -> &'w mut [f64] {
        let skipped = if self.slack == 0 { 0 } else { workspace.as_ptr().align_offset(LINE).min(self.slack) };
        &mut workspace[skipped..][..self.workspace]
    }
}

/// Functions in executable memory.
#[derive(Debug)]
pub(crate) struct Code {
    memory: Mmap,
    functions: Vec<Callable>,
}

impl Code {
    /// Takes code that this processor has been found to run (invariants 1 and 3 of the crate: only `straight::write` makes it).
    ///
    /// # Errors
    /// If the system gives no executable memory.
    pub(crate) fn new(written: Vec<Written>) -> Result<Self, Refusal> {
        let mut bytes = Vec::new();
        let mut functions = Vec::with_capacity(written.len());
        for Written { code, pool, inputs, outputs, workspace, slack, passes, advance, columns } in written {
            let start = bytes.len();
            bytes.extend(code);
            bytes.resize(bytes.len().next_multiple_of(LINE), 0);
            let pool = lines(&pool);
            functions.push(Callable {
                start,
                pool,
                inputs,
                outputs,
                workspace,
                slack,
                passes,
                advance,
                columns,
            });
        }
        let refused = |error: std::io::Error| Refusal::Memory { reason: error.to_string() };
        let mut memory = MmapMut::map_anon(bytes.len().max(LINE)).map_err(refused)?;
        memory[..bytes.len()].copy_from_slice(&bytes);
        let memory = memory.make_exec().map_err(refused)?;
        #[cfg(target_arch = "aarch64")]
        show_to_instructions(&memory);
        Ok(Self { memory, functions })
    }

    /// Length of the scratch slice that every function is content with.
    pub(crate) fn workspace(&self) -> usize {
        self.functions.iter().map(|function| function.workspace + function.slack).max().unwrap_or(0)
    }

    /// Runs a function. Slices hold the numbers of all lanes, value by value.
    ///
    /// # Panics
    /// If a slice is too short, or there is no such function, or it was written for columns.
    pub(crate) fn run(&self, function: usize, input: &[f64], output: &mut [f64], workspace: &mut [f64]) {
        let callable = &self.functions[function];
        let Callable { start, pool, inputs, outputs, passes, advance, columns, .. } = callable;
        assert!(!columns, "written for columns");
        let (input, output) = (&input[..*inputs], &mut output[..*outputs]);
        let workspace = callable.scratch(workspace);
        let code = self.memory[*start..].as_ptr();
        // SAFETY: whole code of a function of this convention begins here (invariant 1) and is executable (invariant 4).
        let call = unsafe { mem::transmute::<*const u8, Call>(code) };
        for pass in 0..*passes {
            let input = input.as_ptr().wrapping_add(pass * advance);
            let output = output.as_mut_ptr().wrapping_add(pass * advance);
            // SAFETY: the slices are as long as the code takes them to be, in the last pass too (invariant 2), the three
            // that are not written may not change meanwhile and the two that are, are borrowed alone; the processor has
            // what it uses (invariant 3).
            unsafe { call(input, output, pool.as_ptr(), workspace.as_mut_ptr()) };
        }
    }
}

/// How a function that was written for columns is called: tables of pointers, constants, workspace.
#[cfg(target_arch = "x86_64")]
type CallColumns = unsafe extern "sysv64" fn(*const *const f64, *const *mut f64, *const Line, *mut f64);
#[cfg(not(target_arch = "x86_64"))]
type CallColumns = unsafe extern "C" fn(*const *const f64, *const *mut f64, *const Line, *mut f64);

impl Code {
    /// Runs a function that was written for columns, for `LANES` states at a time: as many as the answers have, at most those that make
    /// whole lanes. A column of one value is that value for all states.
    ///
    /// # Panics
    /// If there are other columns than the function has, or a slice is too short, or there is no such function, or it was written for
    /// lanes.
    pub(crate) fn run_columns<const LANES: usize>(
        &self,
        function: usize,
        columns: &[&[f64]],
        answers: &mut [&mut [f64]],
        workspace: &mut [f64],
    ) {
        let callable = &self.functions[function];
        let Callable { start, pool, inputs, outputs, columns: of_columns, .. } = callable;
        let states = answers.first().map_or(0, |answers| answers.len());
        assert!(*of_columns, "written for lanes");
        assert!(*inputs == columns.len() * LANES && *outputs == answers.len() * LANES);
        assert!(columns.iter().all(|column| column.len() == 1 || column.len() == states));
        assert!(answers.iter().all(|answers| answers.len() == states));
        let constants: Vec<[f64; LANES]> =
            columns.iter().map(|column| [column.first().copied().unwrap_or(0.0); LANES]).collect();
        let is_constant = |column: &[f64]| column.len() == 1;
        let mut from: Vec<*const f64> = columns
            .iter()
            .zip(&constants)
            .map(|(column, constant)| if is_constant(column) { constant.as_ptr() } else { column.as_ptr() })
            .collect();
        let steps: Vec<usize> =
            columns.iter().map(|column| if is_constant(column) { 0 } else { LANES }).collect();
        let mut to: Vec<*mut f64> = answers.iter_mut().map(|answers| answers.as_mut_ptr()).collect();
        let workspace = callable.scratch(workspace);
        let code = self.memory[*start..].as_ptr();
        // SAFETY: whole code of a function that was written for columns begins here (invariant 1) and is executable (invariant 4).
        let call = unsafe { mem::transmute::<*const u8, CallColumns>(code) };
        for _ in 0..states / LANES {
            // SAFETY: both tables have a pointer for each input and output (invariant 2). Columns and answers have so many states left
            // from there, or the pointer is that of a constant in every lane; answers and workspace are borrowed alone, and the processor
            // has what the code uses (invariant 3).
            unsafe { call(from.as_ptr(), to.as_ptr(), pool.as_ptr(), workspace.as_mut_ptr()) };
            for (pointer, step) in from.iter_mut().zip(&steps) {
                *pointer = pointer.wrapping_add(*step);
            }
            for pointer in &mut to {
                *pointer = pointer.wrapping_add(LANES);
            }
        }
    }
}

/// Writes what was stored back to where instructions are fetched from, and forgets what was fetched before: this processor
/// does neither by itself (Arm Architecture Reference Manual for A-profile: CTR_EL0, DC CVAU, IC IVAU).
#[cfg(target_arch = "aarch64")]
fn show_to_instructions(code: &[u8]) {
    use std::arch::asm;

    let lengths: usize;
    // SAFETY: reads the lengths of the caches' lines, which programs may on Linux, and on no other system they come here.
    unsafe { asm!("mrs {}, ctr_el0", out(reg) lengths, options(nomem, nostack, preserves_flags)) };
    // Both count words of four bytes, as powers of two.
    let [of_data, of_instructions] = [lengths >> 16 & 15, lengths & 15].map(|power| 4_usize << power);
    let lines = |length: usize| {
        let code = code.as_ptr_range();
        (code.start.addr() / length * length..code.end.addr()).step_by(length)
    };
    for line in lines(of_data) {
        // SAFETY: stays in the caches, for lines of this slice; no number in memory changes.
        unsafe { asm!("dc cvau, {}", in(reg) line, options(nostack, preserves_flags)) };
    }
    // SAFETY: waits, no more.
    unsafe { asm!("dsb ish", options(nostack, preserves_flags)) };
    for line in lines(of_instructions) {
        // SAFETY: as above.
        unsafe { asm!("ic ivau, {}", in(reg) line, options(nostack, preserves_flags)) };
    }
    // SAFETY: waits, then fetches anew.
    unsafe { asm!("dsb ish", "isb", options(nostack, preserves_flags)) };
}

fn lines(pool: &[u64]) -> Vec<Line> {
    let line = |part: &[u64]| {
        let mut line = Line([0; LINE / size_of::<u64>()]);
        line.0[..part.len()].copy_from_slice(part);
        line
    };
    pool.chunks(LINE / size_of::<u64>()).map(line).collect()
}
