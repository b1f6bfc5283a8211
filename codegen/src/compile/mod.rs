//! The whole pipeline, in order: parse, resolve, derive, analyse, derive again without redundant rows, shorten, lower.
//! In: a source file. Out: [`Compiled`]. Never knows how a stage works.

mod compiled;

use std::sync::Arc;

use crate::derive::{self, Derived, Guide, Purpose};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::input::Reach;
use crate::limits::{self, Limit};
use crate::model::{self, Closure, Mechanism, Overrides, Topology};
use crate::preflight::{self, Case, Findings, OwnUnits, Waypoint};
use crate::source::SourceFile;
use crate::spec;
use crate::tape::{AtHand, Lowered, ShortTapes};

pub use compiled::{Compiled, FunctionCount};

/// Where runs ask for so many expressions, the equations of motion by themselves may break the limit: they are derived at once then.
const UNSEEN: usize = limits::EXPRESSIONS.most / 4;

/// What a caller may change without touching the file.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Overrides the file's closure.
    pub closure: Option<Closure>,
    /// Parameter values by name, with units in the text.
    pub overrides: Vec<(String, String)>,
    /// Takes flexible bodies as rigid.
    pub rigid: bool,
    /// Where the files of data may lie that the file names.
    pub reach: Reach,
    /// With columns of where every body is, `BODY.pose0` to `BODY.pose11`: for pictures.
    pub pictured: bool,
    /// Forward dynamics by the saddle point alone, where rows first would be shorter: to compare both.
    pub saddle: bool,
    /// Forward dynamics link by link, wherever that is possible: to compare.
    pub link_by_link: bool,
    /// `equations_of_motion` with the mass matrix of mechanisms, too, that are so long that it is left out (zeros).
    pub whole_equations: bool,
}

/// Compiles a file.
///
/// # Errors
/// All that is wrong with the file, in one go.
///
/// ```
/// use linkwear_codegen::{Options, SourceFile, compile};
///
/// let text = r#"
/// spec = 1
/// name = "swing"
///
/// [points]
/// O = ["0 m", "0 m", "0 m"]
/// E = ["1 m", "0 m", "0 m"]
///
/// [bodies]
/// bar = { rod = ["O", "E"], radius = "10 mm", density = "7850 kg/m^3" }
///
/// [joints]
/// R1 = { revolute = ["ground", "bar"], at = "O", axis = [0, -1, 0] }
/// "#;
/// let source = SourceFile { name: "swing.toml".to_owned(), text: text.to_owned() };
/// let swing = compile(&source, &Options::default())?;
/// assert_eq!(&*swing.description().coordinates[0].name, "R1.q");
/// assert!(swing.rust_source().contains("pub struct Mechanism"));
///
/// // A mistake has its place, its cause and a cure.
/// let wrong = SourceFile { text: text.replace("\"bar\"]", "\"barr\"]"), ..source };
/// let errors = compile(&wrong, &Options::default()).unwrap_err();
/// assert!(errors.to_string().contains("swing.toml:13"));
/// # Ok::<(), linkwear_codegen::Diagnostics>(())
/// ```
pub fn compile(source: &SourceFile, options: &Options) -> Result<Compiled, Diagnostics> {
    within(source, [(limits::FILE_BYTES, source.text.len())])?;
    let spec = spec::parse(source)?;
    let overrides = Overrides::from_pairs(&options.overrides);
    let (mechanism, warnings) = model::resolve(&spec, &overrides, options.reach)?;
    let sources = mechanism.sources.clone();
    let compiled = understood(mechanism, warnings, source, sources.whole(), options);
    compiled.map_err(|errors| errors.located_in(&sources))
}

/// All that follows from a mechanism; `source`: with the texts of its parts.
fn understood(
    mut mechanism: Mechanism,
    mut warnings: Vec<Diagnostic>,
    file: &SourceFile,
    source: &SourceFile,
    options: &Options,
) -> Result<Compiled, Diagnostics> {
    let counts = [
        mechanism.points.len(),
        mechanism.joints.len(),
        mechanism.couplings.len(),
        mechanism.stops.len(),
        mechanism.forces.len(),
        mechanism.states.len(),
        mechanism.sensors.len(),
    ];
    within(source, [(limits::BODIES, mechanism.bodies.len())])?;
    within(source, counts.map(|count| (limits::ELEMENTS, count)))?;
    let closure_in_file = mechanism.closure;
    mechanism.closure = options.closure.unwrap_or(closure_in_file);
    if options.rigid {
        mechanism.freeze();
    }
    let mut topology = model::topology::spanning_tree(&mechanism).map_err(|errors| errors.located(source))?;
    if let Some(other) = model::with_free_sections(&mechanism, &topology)
        && derive::clearly_shorter(&mechanism, [&other, &topology])
    {
        topology = other;
    }
    topology.rows_in_ground = derive::shorter_in_ground(&mechanism, &topology);
    topology.rows_off_balls = derive::shorter_off_balls(&mechanism, &topology);
    let mut findings = analyse(source, &mechanism, &topology)?;
    if derive::splits_plane_rows(&mechanism, &topology, &findings.guide.keep) {
        topology.rows_in_ground = false;
        findings = analyse(source, &mechanism, &topology)?;
    }
    let Findings { analysis, mut guide, warnings: remarks, waypoints } = findings;
    guide.link_by_link = options.link_by_link;
    guide.whole_equations = options.whole_equations;
    if options.saddle {
        // Without numbers no accelerations count as fixed by the rows.
        guide.jacobians.clear();
    }
    warnings.extend(remarks);
    let purpose = if options.pictured { Purpose::Picture } else { Purpose::Run };
    let derived = derived(source, &mechanism, &topology, Some(&guide), purpose)?;
    let (mechanism, topology) = (Arc::new(mechanism), Arc::new(topology));
    let of = (Arc::clone(&mechanism), Arc::clone(&topology));
    let closed = derived.closed;
    let apart = move || derive::equations_of_motion(&of.0, &of.1, &guide, closed);
    let equations = Arc::new(derived.equations.and_apart(apart));
    if options.whole_equations || equations.wanted() > UNSEEN {
        within(source, [(limits::EXPRESSIONS, equations.wanted_apart())])?;
    }
    let mut compiled = Compiled {
        source: file.clone(),
        mechanism,
        closure_in_file,
        topology,
        analysis,
        warnings,
        tapes: Arc::new(ShortTapes::new(Arc::clone(&equations))),
        equations,
        lowered: Lowered::default(),
        description: derived.description,
        sizes: derived.sizes,
    };
    let remarks = try_out(&compiled, &waypoints)?;
    compiled.warnings.extend(remarks);
    let allowed = &compiled.mechanism.allowed;
    compiled.warnings.retain(|warning| !allowed.contains(&warning.code));
    Ok(compiled)
}

/// What a mechanism shows as it runs, with drivers and clearances.
fn try_out(compiled: &Compiled, waypoints: &[Waypoint]) -> Result<Vec<Diagnostic>, Diagnostics> {
    let Compiled { mechanism, description, .. } = compiled;
    let source = mechanism.sources.whole();
    if description.drivers.is_empty() && description.contacts.is_empty() {
        return Ok(Vec::new());
    }
    let system = compiled.interpreter_at_hand();
    preflight::check_prescribed(source, mechanism, description, &*system)?;
    let mut remarks = preflight::fast_drives(mechanism, description, &*system);
    let start = preflight::check_start(source, mechanism, description, &*system)?;
    let near = start.map(|start| preflight::contacts_near_modes(mechanism, start, waypoints));
    remarks.extend(near.unwrap_or_default());
    Ok(remarks)
}

fn analyse(source: &SourceFile, mechanism: &Mechanism, topology: &Topology) -> Result<Findings, Diagnostics> {
    let mut findings = examine(source, mechanism, topology, preflight::analyse)?;
    if mechanism.joints.iter().any(|joint| joint.clearance.is_some()) {
        let closed = mechanism.with_clearances_closed();
        let check = |case: &Case<'_>| preflight::check_without_play(case, mechanism, &findings.analysis);
        let warnings = examine(source, &closed, topology, check)?;
        // What moves only thanks to its clearances turns by them too, however its ideal twin would jam.
        if warnings.iter().any(|warning| warning.code == Code::MovesByClearance) {
            let of_ideal_turn = [Code::NoFullTurn, Code::PassesSingular, Code::AngleJumps];
            findings.warnings.retain(|warning| !of_ideal_turn.contains(&warning.code));
        }
        let known: Vec<Code> = findings.warnings.iter().map(|warning| warning.code).collect();
        findings.warnings.extend(warnings.into_iter().filter(|warning| !known.contains(&warning.code)));
    }
    Ok(findings)
}

/// Asks something of a mechanism whose drivers are released and whose rows are all kept.
fn examine<T>(
    source: &SourceFile,
    mechanism: &Mechanism,
    topology: &Topology,
    ask: impl Fn(&Case<'_>) -> Result<T, Diagnostics>,
) -> Result<T, Diagnostics> {
    let released = preflight::released(mechanism);
    let derived = derived(source, &released, topology, None, Purpose::Analysis)?;
    if !derived.equations.is_finite() {
        let beyond = preflight::beyond_numbers(mechanism);
        return Err(Diagnostics::from_list(vec![beyond]).located(source));
    }
    let lowered = Lowered::default();
    let system = AtHand::new(&derived.equations, &lowered, derived.sizes);
    let case = Case {
        source,
        mechanism,
        topology,
        linkage: &derived.linkage,
        description: &derived.description,
        system: &system,
        rows: &|question| system.rows(question),
        units: OwnUnits::new(mechanism, &derived.description),
    };
    ask(&case)
}

/// Derives, unless the equations become too large.
fn derived(
    source: &SourceFile,
    mechanism: &Mechanism,
    topology: &Topology,
    guide: Option<&Guide>,
    purpose: Purpose,
) -> Result<Derived, Diagnostics> {
    let derived = derive::derive(mechanism, topology, guide, purpose);
    within(source, [(limits::SPEEDS, derived.sizes.all_speeds)])?;
    within(source, [(limits::EXPRESSIONS, derived.equations.wanted())])?;
    Ok(derived)
}

/// Refuses counts beyond their limits.
fn within<const N: usize>(source: &SourceFile, counts: [(Limit, usize); N]) -> Result<(), Diagnostics> {
    let broken: Vec<_> = counts.iter().filter_map(|(limit, count)| limit.broken_by(*count)).collect();
    if broken.is_empty() { Ok(()) } else { Err(Diagnostics::from_list(broken).located(source)) }
}
