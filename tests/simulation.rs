//! A simulation advanced from outside: the bits of `simulate`, states put back, parameters changed on the way.

use linkwear::backend::Backend;
use linkwear::mechanism::{Mechanism, read_source};
use linkwear_codegen::Options;
use linkwear_runtime::{
    Description, Integrator, RunError, Settings, SetupError, Simulation, SimulationState, Span, StateSpace,
    System, Watch, simulate,
};

/// A mechanism with its equations.
struct Made {
    mechanism: Mechanism,
    system: Box<dyn System<f64>>,
}

impl Made {
    fn new(name: &str) -> Self {
        let mechanism = Mechanism::shipped(name).expect("a shipped mechanism");
        let system = mechanism.system();
        Self { mechanism, system }
    }

    fn description(&self) -> &Description {
        &self.mechanism.description
    }

    fn parameters(&self) -> Vec<f64> {
        self.description().parameters.iter().map(|parameter| parameter.default).collect()
    }

    fn place(&self, parameter: &str) -> usize {
        self.description().parameters.iter().position(|one| one.name == parameter).expect("a parameter")
    }

    fn start(&self, settings: &Settings) -> Simulation<'_> {
        Simulation::start(&*self.system, self.description(), &self.parameters(), settings).expect("a start")
    }
}

fn settings(made: &Made, span: f64, samples: usize) -> Settings {
    Settings::new(Integrator::adaptive(made.description(), None), Span::Time(span), samples)
}

/// Rows at evenly spaced times from where it is.
fn rows(simulation: &mut Simulation<'_>, times: impl Iterator<Item = f64>) -> Vec<Vec<u64>> {
    let mut row = |t: f64| {
        simulation.advance(t, Watch::NONE).expect("it goes on");
        simulation.values().iter().map(|value| value.to_bits()).collect()
    };
    times.map(&mut row).collect()
}

/// Machine code tells slopes of several states at once, once it was asked often, compiled code never does.
#[test]
fn parameters_that_change_on_the_way_count_on_every_back_end() {
    let source = read_source("mechanisms/rssr_flexible.toml".as_ref()).expect("a file");
    let bits = |backend| {
        let mechanism = Mechanism::compile(&source, &Options::default(), backend).ok()?;
        let made = Made { system: mechanism.system(), mechanism };
        let integrator = Integrator::Rodas5P { tolerance: 1e-8, max_step: None };
        let mut simulation = made.start(&Settings::new(integrator, Span::Time(1.5), 2));
        let mut all = rows(&mut simulation, [1.0].into_iter());
        let mut parameters = made.parameters();
        parameters[made.place("c_rocker")] *= 3.0;
        simulation.set_parameters(&parameters).expect("another damper");
        all.extend(rows(&mut simulation, [1.1, 1.2].into_iter()));
        Some(all)
    };
    let compiled = bits(Backend::Compiled).expect("compiled code");
    // Where this processor has no machine code there is nothing to compare.
    assert!(bits(Backend::Native).is_none_or(|native| native == compiled));
}

#[test]
fn a_simulation_over_the_samples_of_a_run_gives_its_bits() {
    let methods: [&dyn Fn(&Made) -> Integrator; 3] = [
        &|made| Integrator::adaptive(made.description(), None),
        &|_| Integrator::Rk4 { step: 1e-4 },
        &|_| Integrator::GeneralizedAlpha { step: 1e-3, rho: 0.8 },
    ];
    for (name, methods) in
        [("pendulum", &methods[..]), ("rssr_flexible", &methods[..2]), ("rssr", &methods[..1])]
    {
        let made = Made::new(name);
        for method in methods {
            let settings = Settings::new(method(&made), Span::Time(0.25), 41);
            let run = simulate(&*made.system, made.description(), &made.parameters(), &settings, Watch::NONE);
            let run = run.expect("it runs");
            assert_eq!(run.stopped, None);
            let mut simulation = made.start(&settings);
            for (t, row) in run.times.iter().zip(&run.rows) {
                simulation.advance(*t, Watch::NONE).expect("it goes on");
                assert_eq!(simulation.values(), row, "{name} at {t}");
            }
            let statistics = simulation.finish().statistics;
            assert_eq!(
                (statistics.steps, statistics.rejected),
                (run.statistics.steps, run.statistics.rejected)
            );
        }
    }
}

#[test]
fn a_state_put_back_goes_on_with_the_same_bits() {
    let stiff = Some(Integrator::Rodas5P { tolerance: 1e-5, max_step: None });
    let cases =
        [("slider_crank_clearance", None), ("rssr_flexible", None), ("rssr_flexible", stiff), ("rssr", None)];
    for (name, method) in cases {
        let made = Made::new(name);
        let method = method.unwrap_or_else(|| Integrator::adaptive(made.description(), None));
        let settings = Settings::new(method, Span::Time(0.2), 0);
        let mut simulation = made.start(&settings);
        simulation.advance(0.0803, Watch::NONE).expect("it goes on");
        let kept = simulation.state();
        let times = || (1..=20).map(|index| 0.0803 + 0.003 * f64::from(index));
        let first = rows(&mut simulation, times());
        simulation.restore(&kept).expect("its own state");
        assert_eq!(simulation.state(), kept, "{name}");
        assert_eq!(rows(&mut simulation, times()), first, "{name}");
        // In another one of the same mechanism too.
        let mut other = made.start(&settings);
        other.restore(&kept).expect("a state of the same mechanism");
        assert_eq!(rows(&mut other, times()), first, "{name}");
        // And in one that began with other parameters: what it learnt at its start is not what the first one did.
        let mut parameters = made.parameters();
        parameters.iter_mut().for_each(|value| *value *= 1.5);
        let system = &*made.system;
        let mut foreign =
            Simulation::start(system, made.description(), &parameters, &settings).expect("a start");
        foreign.restore(&kept).expect("a state of the same mechanism");
        assert!(rows(&mut foreign, times()) == first, "{name}");
    }
}

#[test]
fn times_between_do_not_change_the_motion_of_adaptive_steps() {
    let made = Made::new("rssr");
    let settings = settings(&made, 0.1, 0);
    let coarse = rows(&mut made.start(&settings), [0.1].into_iter());
    let fine = rows(&mut made.start(&settings), (1..=100).map(|index| 1e-3 * f64::from(index)));
    assert_eq!(coarse[0], fine[99]);
}

#[test]
fn it_goes_on_beyond_the_time_it_was_meant_for() {
    let made = Made::new("pendulum");
    let mut short = made.start(&settings(&made, 0.3, 0));
    let mut long = made.start(&settings(&made, 1.0, 0));
    for simulation in [&mut short, &mut long] {
        simulation.advance(1.0, Watch::NONE).expect("it goes on");
    }
    for (a, b) in short.values().iter().zip(long.values()) {
        // Other steps: ten times the tolerance of 1e-9.
        assert!((a - b).abs() <= 1e-8 * b.abs().max(1.0), "{a} {b}");
    }
}

#[test]
fn a_damper_changed_on_the_way_acts_from_there_on() {
    let made = Made::new("rssr_flexible");
    let (damper, speed) = (made.place("c_rocker"), made.place("speed"));
    let mut simulation = made.start(&settings(&made, 0.4, 0));
    let drive = simulation.channels().iter().position(|one| one.name == "R1.drive").expect("a drive");
    simulation.advance(0.123, Watch::NONE).expect("it goes on");
    let before = simulation.values()[drive];
    let mut parameters = made.parameters();
    parameters[damper] += 0.5;
    simulation.set_parameters(&parameters).expect("a damper may change");
    assert_ne!(simulation.values()[drive], before);
    assert_eq!(simulation.t(), 0.123);
    simulation.advance(0.2, Watch::NONE).expect("it goes on");
    // A driver may not jump.
    let kept = simulation.state();
    parameters[speed] *= 2.0;
    let refused = simulation.set_parameters(&parameters);
    assert!(matches!(&refused, Err(RunError::Setup(SetupError::Jump { .. }))), "{refused:?}");
    assert_eq!(simulation.state(), kept);
    simulation.advance(0.3, Watch::NONE).expect("it goes on");
}

/// A state that belongs to another time is told as that, not as a jump of parameters; on its loops it takes them.
#[test]
fn a_time_without_its_state_is_told_before_parameters_change() {
    let made = Made::new("rssr_flexible");
    let damper = made.place("c_rocker");
    let mut space = StateSpace::start_at(
        0.0,
        &*made.system,
        made.description(),
        &made.parameters(),
        &settings(&made, 0.4, 0),
    )
    .expect("a start");
    let mut parameters = made.parameters();
    parameters[damper] += 0.5;
    space.set_time(0.001);
    let refused = space.set_parameters(&parameters).expect_err("the crank has gone on alone");
    assert!(matches!(&refused, SetupError::NotOnLoops { t: 0.001, .. }), "{refused}");
    assert!(
        !refused.to_string().contains("parameters") && refused.to_string().contains("together"),
        "{refused}"
    );
    assert_eq!(space.parameters(), made.parameters());
    space.put_on().expect("near enough");
    space.set_parameters(&parameters).expect("a damper may change");
}

#[test]
fn a_worn_bearing_keeps_its_journal_in_contact() {
    let made = Made::new("rssr");
    let mut simulation = made.start(&settings(&made, 0.1, 0));
    simulation.advance(0.02, Watch::NONE).expect("it goes on");
    let (before, clearance) = (simulation.contacts()[0], simulation.clearances()[0]);
    assert!(before.gap < 0.0);
    simulation.set_worn(0, 5e-6, None).expect("wear");
    let after = simulation.contacts()[0];
    assert!((simulation.clearances()[0] - clearance - 5e-6).abs() < 1e-12);
    // Placing stops at 1e-11 m.
    assert!((after.gap - before.gap).abs() < 1e-10, "{} {}", after.gap, before.gap);
    simulation.advance(0.05, Watch::NONE).expect("it goes on");
    let refused = simulation.set_worn(0, 1.0, None);
    assert!(matches!(refused, Err(RunError::Setup(SetupError::Clearance { .. }))));
    simulation.advance(0.06, Watch::NONE).expect("it goes on");
}

#[test]
fn contacts_that_close_and_open_are_told() {
    let made = Made::new("slider_crank_clearance");
    let mut simulation = made.start(&settings(&made, 0.2, 0));
    simulation.advance(0.2, Watch::NONE).expect("it goes on");
    let events = simulation.take_events();
    assert!(!events.is_empty());
    // They alternate, from a start in contact.
    let closes: Vec<bool> = events.iter().map(|event| event.closes).collect();
    assert!(closes.iter().enumerate().all(|(index, closes)| *closes == (index % 2 == 1)), "{closes:?}");
    assert!(events.windows(2).all(|pair| pair[0].t <= pair[1].t));
    assert!(simulation.take_events().is_empty());
}

#[test]
fn a_foreign_state_is_refused_and_time_runs_forwards() {
    let (pendulum, rssr) = (Made::new("pendulum"), Made::new("rssr"));
    let mut simulation = pendulum.start(&settings(&pendulum, 1.0, 0));
    let foreign: SimulationState = rssr.start(&settings(&rssr, 0.1, 0)).state();
    assert!(matches!(simulation.restore(&foreign), Err(SetupError::Length { .. })));
    simulation.advance(0.5, Watch::NONE).expect("it goes on");
    for wrong in [0.4, f64::NAN, f64::INFINITY] {
        assert!(simulation.advance(wrong, Watch::NONE).is_err());
    }
    assert_eq!(simulation.t(), 0.5);
}
