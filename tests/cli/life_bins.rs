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
