// Published benchmarks, compiled for tests only: read by benchmarks/build.rs and benchmarks/src/lib.rs.
mechanisms! {
    /// Andrews' squeezing mechanism: seven bodies, three loops, a spring and a motor.
    andrews,
    /// Two parallelogram cells; passes positions where it could go on in several ways.
    n_four_bar_2,
    /// Forty parallelogram cells.
    n_four_bar_40,
    /// Bricard's six revolutes: overconstrained, yet it moves.
    bricard,
    /// Bennett's four skew revolutes: overconstrained, yet it moves.
    bennett,
    /// The stiff flyball governor.
    flyball,
    /// A Geneva drive while its pin is in the slot.
    geneva,
    /// A disc cam with a roller follower.
    cam,
    /// A wheel carrier on five rods without mass.
    five_link,
    /// A press: a ram moved by a cam's law, and a sprung pad that meets the blank.
    cam_press,
}
