use std::error::Error;
use std::ops::ControlFlow;

use linkwear_runtime::{Entry, Settings, Span, System, simulate};

mod swing {
    linkwear_runtime::include_mechanism!("swing");
}

fn main() -> Result<(), Box<dyn Error>> {
    // Tunable parameters are fields, in SI.
    let bar = swing::Mechanism { damping: 0.2 };
    let names = swing::description();

    // Let it fall from the horizontal for two seconds and look at its bearing.
    let settings = Settings { span: Span::Time(2.0), ..Settings::default() };
    let go_on = &mut |_| ControlFlow::Continue(());
    let run = simulate(&bar, names, &bar.parameters(), &settings, go_on)?;
    let at = names.channels.iter().position(|channel| channel.name == "R1.Fz");
    let force = at.ok_or("no such column")?;
    let peak = run.rows.iter().map(|row| row[force]).fold(0.0, f64::max);
    println!("largest vertical force at R1: {peak:.2} N");

    // Or call the equations: parameters, time, coordinates, speeds in; accelerations out.
    let sizes = System::<f64>::sizes(&bar);
    let input = [bar.damping, 0.0, 0.0, 0.0];
    let mut output = vec![0.0; sizes.output(Entry::ForwardDynamics)];
    let mut workspace = vec![0.0; sizes.workspace];
    bar.evaluate(Entry::ForwardDynamics, &input, &mut output, &mut workspace);
    println!("angular acceleration when let go: {:.4} rad/s^2", output[0]);
    Ok(())
}
