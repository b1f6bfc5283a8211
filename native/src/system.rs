//! A mechanism as machine code. In: its tapes by entry. Out: a [`System`]. Never knows how code is written.

use std::fmt;
use std::sync::{Arc, OnceLock};

use linkwear_runtime::clearance_joint::Clearance;
use linkwear_runtime::{
    ClassicalStep, Description, Entry, STATES, SideBySide, Sizes, StageSum, StepPlan, System, WithLaws,
};
use linkwear_tape::{Tape, Tapes};

#[cfg(any(target_arch = "aarch64", target_arch = "x86_64"))]
use crate::functions::Functions;
use crate::refusal::Refusal;
use crate::seldom::Seldom;
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
    sizes: Sizes,
    tapes: Arc<dyn Tapes>,
    /// Of entries that are written at once.
    functions: Arc<Functions>,
    /// By entry, which of these answers it.
    places: [Option<usize>; Entry::ALL.len()],
    seldom: Arc<Seldom>,
    several: Arc<OnceLock<Option<Several>>>,
    laws: Option<Laws>,
}

/// The derivative with the laws of contact inside.
#[derive(Clone)]
struct Laws {
    functions: Arc<Functions>,
    /// See [`WithLaws::laws`].
    words: Arc<str>,
    step: Arc<WholeStep>,
}

/// A whole step, with the laws of contact inside.
struct WholeStep {
    tapes: Arc<dyn Tapes>,
    plan: StepPlan,
    /// Written when it is asked for first: the code is four times as long as that of a derivative.
    /// One for each order of its sum: a run takes one of them.
    functions: [OnceLock<Option<Functions>>; 2],
}

/// What runs ask at several states at once. Written when it is asked for first: short runs do not.
struct Several {
    functions: Functions,
    entries: &'static [Entry],
}

/// Columns; and the derivatives of slopes by states, which stiff motion is integrated with. Contacts are integrated by other methods.
const OF_SEVERAL: [Entry; 2] = [Entry::Observe, Entry::Derivative];

/// What every run asks for, those that take long first, for they are written side by side; contacts are there with the derivative.
/// Accelerations tell how stiff contacts are where a run begins: without joints with clearance few ask for them.
const OFTEN: [Entry; 8] = [
    Entry::Accelerations,
    Entry::Observe,
    Entry::Derivative,
    Entry::Energy,
    Entry::Closure,
    Entry::Start,
    Entry::Prescribed,
    Entry::Contacts,
];

impl fmt::Debug for Native {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Native").field(&self.sizes).finish()
    }
}

impl Native {
    /// Writes the code of tapes, in the order of [`Entry::ALL`]. `sizes.workspace` is set here.
    ///
    /// # Errors
    /// If this processor or this system cannot run it, or a tape makes no sense.
    pub fn new(tapes: &[Tape], sizes: Sizes) -> Result<Self, Refusal> {
        Self::written(Arc::new(tapes.to_vec()), &Entry::ALL, sizes)
    }

    /// The same with the laws of contact inside the derivative, if the mechanism has joints with clearance. Wear by bearing angle
    /// stays outside, and so do laws with constants out of range, which runs are told of where they begin.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_laws(tapes: &[Tape], sizes: Sizes, description: &Description) -> Result<Self, Refusal> {
        Self::new(tapes, sizes)?.and_laws(description)
    }

    /// The same of tapes that are made when they are asked for: here those that every run asks for, the others by who evaluates
    /// their entries first. `sizes.held` is set here, too.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn when_asked(
        tapes: Arc<dyn Tapes>,
        sizes: Sizes,
        description: &Description,
    ) -> Result<Self, Refusal> {
        Self::written(tapes, &OFTEN[usize::from(sizes.contacts == 0)..], sizes)?.and_laws(description)
    }

    fn written(tapes: Arc<dyn Tapes>, entries: &'static [Entry], sizes: Sizes) -> Result<Self, Refusal> {
        let functions = Functions::of_entries::<1>(&*tapes, entries)?;
        let held = tapes.tape(Entry::Contacts).map_or(0, Tape::output_len);
        let sizes = Sizes { workspace: functions.workspace(), ..sizes.with_held(held) };
        let places = Entry::ALL.map(|entry| entries.iter().position(|known| *known == entry));
        let (functions, seldom, several) = (Arc::new(functions), Arc::default(), Arc::default());
        Ok(Self { sizes, tapes, functions, places, seldom, several, laws: None })
    }

    fn and_laws(self, description: &Description) -> Result<Self, Refusal> {
        let Ok(plan) = StepPlan::new(description, self.sizes) else { return Ok(self) };
        if plan.joints().is_empty() || plan.joints().iter().any(Clearance::keeps_profiles) {
            return Ok(self);
        }
        let tapes = Arc::clone(&self.tapes);
        let functions = Arc::new(Functions::of_laws(&*tapes, &plan)?);
        let words = plan.laws().into();
        let step = Arc::new(WholeStep { tapes, plan, functions: Default::default() });
        Ok(Self { laws: Some(Laws { functions, words, step }), ..self })
    }
}

impl System<f64> for Native {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn evaluate(&self, entry: Entry, input: &[f64], output: &mut [f64], workspace: &mut [f64]) {
        match self.places[entry as usize] {
            Some(function) => self.functions.run(function, input, output, workspace),
            None => self.seldom.evaluate(&*self.tapes, entry, (input, output, workspace)),
        }
    }

    fn side_by_side(&self) -> Option<&dyn SideBySide<f64>> {
        let written = self.several.get_or_init(|| {
            let entries = &OF_SEVERAL[..if self.sizes.contacts > 0 { 1 } else { 2 }];
            let functions = Functions::of_entries::<STATES>(&*self.tapes, entries).ok()?;
            Some(Several { functions, entries })
        });
        written.as_ref().map(|several| several as &dyn SideBySide<f64>)
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

    fn classical_step(&self, sum: StageSum) -> Option<&dyn ClassicalStep<f64>> {
        let WholeStep { tapes, plan, functions: [ends_first, in_turn] } = &*self.step;
        let functions = match sum {
            StageSum::EndsFirst => ends_first,
            StageSum::InTurn => in_turn,
        };
        let written = functions.get_or_init(|| Functions::of_whole_step(&**tapes, plan, sum).ok());
        written.as_ref().map(|written| written as &dyn ClassicalStep<f64>)
    }
}

impl ClassicalStep<f64> for Functions {
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
