//! A mechanism as machine code. In: one tape per entry. Out: a [`System`]. Never knows how code is written.

use std::fmt;
use std::sync::{Arc, OnceLock};

use linkwear_runtime::clearance_joint::Clearance;
use linkwear_runtime::{
    Bundle, Description, Entry, InnerStages, STATES, SideBySide, Sizes, StepPlan, System, WithLaws,
};
use linkwear_tape::Tape;

#[cfg(any(target_arch = "aarch64", target_arch = "x86_64"))]
use crate::functions::Functions;
use crate::refusal::Refusal;
#[cfg(not(any(target_arch = "aarch64", target_arch = "x86_64")))]
use crate::unsupported::Functions;

/// A mechanism as machine code of this processor. Clones share the code.
///
/// ```
/// use linkwear_codegen::{Options, SourceFile, compile};
/// use linkwear_native::Native;
/// use linkwear_runtime::{Entry, System};
///
/// let text = r#"
/// spec = 1
/// name = "swing"
/// [points]
/// O = ["0 m", "0 m", "0 m"]
/// E = ["1 m", "0 m", "0 m"]
/// [bodies]
/// bar = { rod = ["O", "E"], radius = "10 mm", density = "7850 kg/m^3" }
/// [joints]
/// R1 = { revolute = ["ground", "bar"], at = "O", axis = [0, -1, 0] }
/// "#;
/// let source = SourceFile { name: "swing.toml".to_owned(), text: text.to_owned() };
/// let swing = compile(&source, &Options::default())?;
/// let answer = |system: &dyn System<f64>| {
///     // Time, angle, speed.
///     let (input, mut output) = ([0.0, 0.3, 2.0], vec![0.0; system.sizes().output(Entry::Energy)]);
///     system.evaluate(Entry::Energy, &input, &mut output, &mut vec![0.0; system.sizes().workspace]);
///     output
/// };
/// // Where this processor has no code, or a system forbids it, the reason is told.
/// match Native::new(swing.tapes(), swing.sizes()) {
///     Ok(native) => assert_eq!(answer(&native), answer(&swing.interpreter())),
///     Err(refusal) => println!("{refusal}"),
/// }
/// # Ok::<(), linkwear_codegen::Diagnostics>(())
/// ```
#[derive(Clone)]
pub struct Native {
    alone: Lanes<1>,
    several: Several,
    laws: Option<Laws>,
}

/// The derivative with the laws of contact inside.
#[derive(Clone)]
struct Laws {
    functions: Arc<Functions>,
    /// See [`WithLaws::laws`].
    words: Arc<str>,
    stages: Arc<Stages>,
}

/// The stages within a step, with the laws of contact inside.
struct Stages {
    tapes: Vec<Tape>,
    plan: StepPlan,
    /// Written when they are asked for first: the code is three times as long as that of a derivative.
    functions: OnceLock<Option<Functions>>,
}

/// What runs ask at several states at once.
#[derive(Clone)]
struct Several {
    functions: Arc<Functions>,
    entries: &'static [Entry],
}

/// Columns; and the derivatives of slopes by states, which stiff motion is integrated with. Contacts are integrated by other methods.
const OF_SEVERAL: [Entry; 2] = [Entry::Observe, Entry::Derivative];

/// A mechanism as machine code that evaluates `N` states side by side, 4 or 8: every one with the bits that it would have
/// alone. Clones share the code.
#[derive(Clone)]
pub struct Lanes<const N: usize> {
    functions: Arc<Functions>,
    sizes: Sizes,
}

impl fmt::Debug for Native {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Native").field(&self.alone.sizes).finish()
    }
}

impl<const N: usize> fmt::Debug for Lanes<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Lanes").field("lanes", &N).field("sizes", &self.sizes).finish_non_exhaustive()
    }
}

impl<const N: usize> Lanes<N> {
    /// Writes the code of tapes, in the order of [`Entry::ALL`]. `sizes.workspace` is set here.
    ///
    /// # Errors
    /// If this processor or this system cannot run it, or a tape makes no sense.
    pub fn new(tapes: &[Tape], sizes: Sizes) -> Result<Self, Refusal> {
        if let Some(entry) = Entry::ALL.get(tapes.len()) {
            return Err(Refusal::missing(*entry));
        }
        let functions = Functions::new::<N>(tapes)?;
        let sizes = Sizes { workspace: functions.workspace().div_ceil(N), ..sizes };
        Ok(Self { functions: Arc::new(functions), sizes })
    }

    /// The layout of inputs and outputs, as for one state.
    pub const fn sizes(&self) -> Sizes {
        self.sizes
    }

    /// Evaluates `entry`: every value is that of all states. It is fastest where inputs and outputs begin at multiples of
    /// 64 bytes.
    ///
    /// # Panics
    /// If a slice is shorter than [`Sizes`] says.
    pub fn evaluate(
        &self,
        entry: Entry,
        input: &[[f64; N]],
        output: &mut [[f64; N]],
        workspace: &mut [[f64; N]],
    ) {
        let (input, output) = (input.as_flattened(), output.as_flattened_mut());
        self.functions.run(entry as usize, input, output, workspace.as_flattened_mut());
    }
}

/// Steps of `N` trajectories of a mechanism side by side as machine code, laws of contact included. Clones share the code.
#[derive(Clone)]
pub struct NativeBundle<const N: usize> {
    parts: Arc<Functions>,
    sizes: Sizes,
}

impl<const N: usize> fmt::Debug for NativeBundle<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NativeBundle").field("lanes", &N).field("sizes", &self.sizes).finish_non_exhaustive()
    }
}

impl<const N: usize> NativeBundle<N> {
    /// Writes the code of a plan with tapes, in the order of [`Entry::ALL`].
    ///
    /// # Errors
    /// As [`Lanes::new`]; and if a joint keeps wear by bearing angle.
    pub fn new(tapes: &[Tape], plan: &StepPlan) -> Result<Self, Refusal> {
        if plan.joints().iter().any(Clearance::keeps_profiles) {
            return Err(Refusal::Profile);
        }
        Ok(Self { parts: Arc::new(Functions::of_steps::<N>(tapes, plan)?), sizes: plan.sizes() })
    }
}

impl<const N: usize> Bundle<N> for NativeBundle<N> {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn workspace(&self) -> usize {
        self.parts.workspace().div_ceil(N)
    }

    fn attempt(&self, question: &[[f64; N]], answer: &mut [[f64; N]], workspace: &mut [[f64; N]]) {
        let (question, answer) = (question.as_flattened(), answer.as_flattened_mut());
        self.parts.run(0, question, answer, workspace.as_flattened_mut());
    }

    fn conclude(&self, arena: &[[f64; N]], answer: &mut [[f64; N]], workspace: &mut [[f64; N]]) {
        let (arena, answer) = (arena.as_flattened(), answer.as_flattened_mut());
        self.parts.run(1, arena, answer, workspace.as_flattened_mut());
    }
}

impl Native {
    /// Writes the code of tapes, in the order of [`Entry::ALL`]. `sizes.workspace` is set here.
    ///
    /// # Errors
    /// If this processor or this system cannot run it, or a tape makes no sense.
    pub fn new(tapes: &[Tape], sizes: Sizes) -> Result<Self, Refusal> {
        let alone = Lanes::new(tapes, sizes)?;
        let entries = &OF_SEVERAL[..if sizes.contacts > 0 { 1 } else { 2 }];
        let asked: Vec<Tape> = entries.iter().map(|entry| tapes[*entry as usize].clone()).collect();
        let functions = Arc::new(Functions::new::<STATES>(&asked)?);
        Ok(Self { alone, several: Several { functions, entries }, laws: None })
    }

    /// The same with the laws of contact inside the derivative, if the mechanism has joints with clearance. Wear by bearing angle
    /// stays outside, and so do laws with constants out of range, which runs are told of where they begin.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_laws(tapes: &[Tape], sizes: Sizes, description: &Description) -> Result<Self, Refusal> {
        let outside = Self::new(tapes, sizes)?;
        let Ok(plan) = StepPlan::new(description, sizes) else { return Ok(outside) };
        if plan.joints().is_empty() || plan.joints().iter().any(Clearance::keeps_profiles) {
            return Ok(outside);
        }
        let functions = Arc::new(Functions::of_laws(tapes, &plan)?);
        let words = plan.laws().into();
        let stages = Arc::new(Stages { tapes: tapes.to_vec(), plan, functions: OnceLock::new() });
        Ok(Self { laws: Some(Laws { functions, words, stages }), ..outside })
    }
}

impl System<f64> for Native {
    fn sizes(&self) -> Sizes {
        self.alone.sizes
    }

    fn evaluate(&self, entry: Entry, input: &[f64], output: &mut [f64], workspace: &mut [f64]) {
        self.alone.functions.run(entry as usize, input, output, workspace);
    }

    fn side_by_side(&self) -> Option<&dyn SideBySide<f64>> {
        Some(&self.several)
    }

    fn laws_inside(&self) -> Option<&dyn WithLaws<f64>> {
        self.laws.as_ref().map(|laws| laws as &dyn WithLaws<f64>)
    }
}

impl WithLaws<f64> for Laws {
    fn laws(&self) -> &str {
        &self.words
    }

    fn workspace(&self) -> usize {
        self.functions.workspace()
    }

    fn derivative(&self, question: &[f64], answer: &mut [f64], workspace: &mut [f64]) {
        self.functions.run(0, question, answer, workspace);
    }

    fn inner_stages(&self) -> Option<&dyn InnerStages<f64>> {
        let Stages { tapes, plan, functions } = &*self.stages;
        let written = functions.get_or_init(|| Functions::of_stages(tapes, plan).ok());
        written.as_ref().map(|written| written as &dyn InnerStages<f64>)
    }
}

impl InnerStages<f64> for Functions {
    fn workspace(&self) -> usize {
        self.workspace()
    }

    fn evaluate(&self, question: &[f64], answer: &mut [f64], workspace: &mut [f64]) {
        self.run(0, question, answer, workspace);
    }
}

impl SideBySide<f64> for Several {
    fn answers(&self, entry: Entry) -> bool {
        self.entries.contains(&entry)
    }

    fn workspace(&self) -> usize {
        self.functions.workspace().div_ceil(STATES)
    }

    fn evaluate(
        &self,
        entry: Entry,
        input: &[[f64; STATES]],
        output: &mut [[f64; STATES]],
        workspace: &mut [[f64; STATES]],
    ) {
        let (input, output) = (input.as_flattened(), output.as_flattened_mut());
        let place = self.entries.iter().position(|known| *known == entry).unwrap_or(usize::MAX);
        self.functions.run(place, input, output, workspace.as_flattened_mut());
    }
}
