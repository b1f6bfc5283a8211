//! `life` with the deepest place of a bearing: whether its bins tell it.

use crate::command::{Folder, linkwear};

#[test]
fn a_place_as_narrow_as_a_bin_is_told_with_the_bins_that_do() {
    let folder = Folder::new("life-bins");
    let bush = std::fs::read_to_string("examples/data/worn_bush.toml").expect("the example");
    let told = |bins: u32| {
        let deepest = format!("area = \"hertz\"\nmeasure = \"maximum\"\nbins = {bins}");
        let file = folder.write("bush.toml", &bush.replacen("area = \"hertz\"", &deepest, 1));
        let answer = linkwear(&["life", &file, "--mean", "--format", "json"]);
        assert_eq!(answer.code, 0, "{}", answer.err);
        let json = answer.json();
        let warnings = json["warnings"].as_array().expect("warnings").iter();
        let of_bins =
            warnings.filter_map(|one| one["message"].as_str()).filter(|one| one.contains("`bins = "));
        (of_bins.count(), json["mean"].as_f64().expect("a life"))
    };
    let ((coarse, by_72), (fine, by_720)) = (told(72), told(720));
    assert_eq!((coarse, fine), (1, 0));
    // The contact is 3.7 degrees wide to either side, so that a bin of 5 holds less than its depth.
    assert!(by_72 > 1.1 * by_720, "{by_72} {by_720}");
}

/// A disc driven round under a steady load: its contact is 4.26 degrees wide, and wears in one place alone.
const DISC: &str = r#"spec = 1
name = "disc"
gravity = [0, 0, 0]
[points]
O = [0, 0, 0]
[bodies]
disc = { mass = "1 kg", centre = "O", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "1e-3 kg m^2"] }
[joints]
R1 = { revolute = ["ground", "disc"], at = "O", axis = [0, 0, 1], drive = "2*pi*(2 Hz)*t" }
[forces]
load = { force = "disc", at = "O", components = [LOAD] }
[clearance.R1]
radial = "20 um"
journal_radius = "10 mm"
length = "20 mm"
modulus = "115 GPa"
law = "flores"
restitution = 0.5
friction = 0.001
[wear.R1]
coefficient = 1e-8
hardness = "3.5 GPa"
threshold = "80 um"
area = "hertz"
measure = "maximum"
feedback = 0
revolutions_per_cycle = 1e6
bins = BINS
"#;

#[test]
fn a_contact_narrower_than_bins_is_told_as_deep_as_it_may_be_and_the_bins_advised_tell_its_life() {
    let folder = Folder::new("life-narrow");
    // k/H F 2 pi r/(r L) per revolution, at the middle of a half ellipse of 2 x 0.03719 rad: 104.27 cycles.
    let by_hand = 104.27;
    // On the border of two bins, where one holds half of the wear, and off it.
    for load in [r#"0, "-50 N", 0"#, r#""18 N", "46.65 N", 0"#] {
        let told = |bins: u64| {
            let text = DISC.replace("LOAD", load).replace("BINS", &bins.to_string());
            let json =
                linkwear(&["life", &folder.write("disc.toml", &text), "--mean", "--format", "json"]).json();
            let warnings = json["warnings"].as_array().expect("warnings").iter();
            let of_bins =
                warnings.filter_map(|one| one["message"].as_str()).find(|one| one.contains("`bins = "));
            (json["mean"].as_f64().expect("a life"), of_bins.map(str::to_owned))
        };
        for bins in [8, 72, 288] {
            let (life, warning) = told(bins);
            let warning = warning.expect("bins wider than the contact");
            let number = |from: &str, to: &str| {
                let rest = warning.split_once(from).expect(from).1;
                rest.split_once(to).expect(to).0.parse::<f64>().expect("a number")
            };
            let times = if warning.contains("times as deep") {
                number("may be ", " times")
            } else {
                1.0 + number("may be ", " %") / 100.0
            };
            // The bound holds, but for its digits, and is no more than a fifth too large.
            let right = life / by_hand;
            assert!(times > 0.98 * right && times < 1.2 * right, "{load} {bins}: {life} {warning}");
            assert_eq!(number("`bins = ", "`"), 720.0, "{warning}");
        }
        let (life, warning) = told(720);
        assert!((life / by_hand - 1.0).abs() < 0.01 && warning.is_none(), "{load}: {life} {warning:?}");
    }
}
