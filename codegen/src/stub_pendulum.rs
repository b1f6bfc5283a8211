/// Tunable parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// Damping [N m s/rad].
    pub damping: f64,
}

impl Default for Mechanism {
    fn default() -> Self {
        Self { damping: 0.0 }
    }
}

impl Mechanism {
    /// Tunable parameters as the slice that entries want.
    #[must_use]
    pub fn parameters(&self) -> [f64; 1] {
        [self.damping]
    }
}

/// Hash of the source.
pub const SOURCE_SHA256: &str = "@SHA@";

static DESCRIPTION: ::std::sync::LazyLock<::linkwear_runtime::Description> = ::std::sync::LazyLock::new(|| {
    use ::linkwear_runtime::{Channel, Description, List, ParameterInfo, Text, VariableInfo, Motion};
    fn channel(name: &'static str, unit: &'static str) -> Channel {
        Channel { name: Text::Borrowed(name), unit: Text::Borrowed(unit), wraps: false }
    }
    Description {
        name: Text::Borrowed("pendulum"),
        parameters: List::Owned(vec![ParameterInfo { name: Text::Borrowed("damping"), unit: Text::Borrowed("N m s/rad"), default: 0.0 }]),
        coordinates: List::Borrowed(&[VariableInfo { name: Text::Borrowed("R1.q"), unit: Text::Borrowed("rad"), held: true }]),
        speeds: List::Borrowed(&[VariableInfo { name: Text::Borrowed("R1.v"), unit: Text::Borrowed("rad/s"), held: true }]),
        motions: List::Borrowed(&[Motion::Scalar { driver: None }]),
        quaternions: List::Borrowed(&[]),
        rows: List::Borrowed(&[]),
        drivers: List::Borrowed(&[]),
        channels: List::Owned(vec![channel("R1.q", "rad"), channel("R1.v", "rad/s"), channel("R1.a", "rad/s^2"),
            channel("R1.Fx", "N"), channel("R1.Fy", "N"), channel("R1.Fz", "N"),
            channel("R1.Mx", "N m"), channel("R1.My", "N m"), channel("R1.Mz", "N m"),
            channel("energy.kinetic", "J"), channel("energy.potential", "J")]),
        turn_driver: None,
    }
});

/// Names and units.
#[must_use]
pub fn description() -> &'static ::linkwear_runtime::Description {
    &DESCRIPTION
}

impl<T: ::linkwear_runtime::Scalar> ::linkwear_runtime::System<T> for Mechanism {
    fn sizes(&self) -> ::linkwear_runtime::Sizes {
        ::linkwear_runtime::Sizes { parameters: 1, coordinates: 1, speeds: 1, all_coordinates: 1, all_speeds: 1, rows: 0, all_rows: 0, drivers: 0, channels: 11, workspace: 0 }
    }

    fn evaluate(&self, entry: ::linkwear_runtime::Entry, input: &[T], output: &mut [T], _workspace: &mut [T]) {
        use ::linkwear_runtime::Entry;
        let c = T::constant;
        // 1 kg point mass, 1 m, 9.81: angle from the horizontal, positive upwards
        match entry {
            Entry::Start => { output[0] = c(0.0); output[1] = c(0.0); }
            Entry::ForwardDynamics => { output[0] = -c(9.81) * input[2].sin_cos().1 - input[0] * input[3]; }
            Entry::Rates => { output[0] = input[3]; output[1] = c(0.0); output[2] = input[0] * input[3] * input[3]; }
            Entry::Energy => { output[0] = c(0.5) * input[3] * input[3]; output[1] = c(9.81) * input[2].sin_cos().0; }
            Entry::Observe => {
                let (s, co) = input[2].sin_cos();
                let (v, a) = (input[3], input[4]);
                output[0] = input[2]; output[1] = v; output[2] = a;
                output[3] = -a * s - v * v * co; output[4] = c(0.0); output[5] = a * co - v * v * s + c(9.81);
                output[6] = c(0.0); output[7] = c(0.0); output[8] = c(0.0);
                output[9] = c(0.5) * v * v; output[10] = c(9.81) * s;
            }
            _ => {}
        }
    }
}
