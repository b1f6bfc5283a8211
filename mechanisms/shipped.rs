// Mechanisms that are compiled into linkwear, one a line: read by shipped/build.rs and by shipped/src/lib.rs.
mechanisms! {
    /// A bar that swings about one revolute joint.
    pendulum,
    /// Planar four-bar with four revolute joints: three of its constraint rows are redundant.
    four_bar,
    /// Slider-crank with a driven crank.
    slider_crank,
    /// The case study's spatial four-bar, rigid, with ideal joints.
    rssr_rigid,
    /// The case study's spatial four-bar with a flexible coupler and ideal joints.
    rssr_flexible,
    /// The case study: flexible coupler, and a wearing bearing with clearance at the crank.
    rssr,
    /// The case study's four-bar with a wearing ball between crank and coupler.
    rssr_ball_wear,
    /// The planar four-bar with two wearing bearings.
    four_bar_wear,
    /// Slider-crank with a loose pin at its slider, by Flores and Ambrosio.
    slider_crank_clearance,
    /// A six-bar with two loops.
    six_bar,
    /// A spatial slider-crank with a universal joint.
    spatial_slider_crank,
}
