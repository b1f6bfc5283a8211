use std::error::Error;

use linkwear_runtime::{Entry, Settings, Span, System, Watch, simulate};

mod swing {
    linkwear_runtime::include_mechanism!("swing");
}

fn main() -> Result<(), Box<dyn Error>> {
    // Tunable parameters are fields, in SI.
    let bar = swing::Mechanism { damping: 0.2 };

    // Let it fall from the horizontal for two seconds and look at its bearing.
    let settings = Settings { span: Span::Time(2.0), ..Settings::default() };
    let run = simulate(&bar, swing::description(), &bar.parameters(), &settings, Watch::NONE)?;
    let peak = run.range("R1.Fz")?.high.value;
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
