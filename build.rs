//! Compiles the shipped mechanisms, with the same few lines a user's build script has.
//! src/mechanisms.rs includes what this writes: keep the two lists equal.

fn main() {
    linkwear_codegen::Builder::new()
        .mechanism("mechanisms/pendulum.toml")
        .mechanism("mechanisms/four_bar.toml")
        .mechanism("mechanisms/slider_crank.toml")
        .mechanism("mechanisms/rssr_rigid.toml")
        .mechanism("mechanisms/rssr_flexible.toml")
        .mechanism("mechanisms/rssr.toml")
        .mechanism("mechanisms/rssr_ball_wear.toml")
        .mechanism("mechanisms/four_bar_wear.toml")
        .mechanism("mechanisms/slider_crank_clearance.toml")
        .mechanism("mechanisms/andrews.toml")
        .mechanism("mechanisms/n_four_bar_2.toml")
        .mechanism("mechanisms/n_four_bar_40.toml")
        .mechanism("mechanisms/bricard.toml")
        .mechanism("mechanisms/bennett.toml")
        .mechanism("mechanisms/flyball.toml")
        .mechanism("mechanisms/six_bar.toml")
        .mechanism("mechanisms/spatial_slider_crank.toml")
        .write_or_exit();
}
