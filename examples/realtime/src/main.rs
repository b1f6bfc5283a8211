//! RSSR with its worn bearing, against the wall clock: every millisecond the simulation goes on by a millisecond, and the
//! program tells how much of it that took, at worst.
//!
//!     cargo run --release -- 5          five seconds

use std::error::Error;
use std::time::{Duration, Instant};

use linkwear_runtime::{Integrator, Settings, Simulation, Span, Watch};

mod rssr {
    linkwear_runtime::include_mechanism!("rssr");
}

/// How often the outside is served.
const TICK: Duration = Duration::from_millis(1);
/// Equal steps, so that every tick takes about the same work [s].
const STEP: f64 = 50e-6;
/// The system wakes a sleeper late by about so much: the rest is waited for awake.
const AWAKE: Duration = Duration::from_micros(200);

fn main() -> Result<(), Box<dyn Error>> {
    let seconds: f64 = std::env::args().nth(1).map_or(Ok(2.0), |text| text.parse())?;
    let bar = rssr::Mechanism::default();
    let settings = Settings {
        integrator: Integrator::Rk4 { step: STEP },
        span: Span::Time(seconds),
        samples: 0,
        ..Settings::default()
    };
    let mut plant = Simulation::start(&bar, rssr::description(), &bar.parameters(), &settings)?;
    let torque = plant.channels().iter().position(|channel| channel.name.ends_with(".drive"));
    let torque = torque.ok_or("nothing drives")?;

    let ticks = (seconds / TICK.as_secs_f64()).round() as u32;
    let mut work = Vec::with_capacity(ticks as usize);
    let (mut late, mut peak) = (0, 0.0_f64);
    let start = Instant::now();
    for tick in 1..=ticks {
        let due = start + TICK * (tick - 1);
        wait_until(due);
        let begun = Instant::now();
        plant.advance(TICK.as_secs_f64() * f64::from(tick), Watch::NONE)?;
        peak = peak.max(plant.values()[torque].abs());
        work.push(begun.elapsed());
        late += u32::from(Instant::now() > due + TICK);
    }
    work.sort_unstable();
    let part = |p: f64| 1e6 * work[((work.len() - 1) as f64 * p) as usize].as_secs_f64();
    println!("{ticks} ticks of {} us in {:.3} s", TICK.as_micros(), start.elapsed().as_secs_f64());
    println!(
        "work of a tick: median {:.0} us, 99 % {:.0} us, worst {:.0} us",
        part(0.5),
        part(0.99),
        part(1.0)
    );
    println!("{late} ticks ended after the next was due");
    println!("largest drive torque {peak:.3} N m");
    Ok(())
}

fn wait_until(due: Instant) {
    if let Some(rest) = due.checked_duration_since(Instant::now() + AWAKE) {
        std::thread::sleep(rest);
    }
    while Instant::now() < due {
        std::hint::spin_loop();
    }
}
