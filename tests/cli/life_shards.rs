//! `life --shard` and `merge`: shards lived apart are together the undivided life, in every byte; what cannot be put together is
//! refused with what to do.

use std::fs;

use crate::command::{Answer, Folder, linkwear};

/// Coarse steps and few lives: only bytes are compared.
const LIFE: [&str; 11] = [
    "life",
    "mechanisms/rssr.toml",
    "--rigid",
    "--step",
    "1e-4",
    "--settle",
    "0",
    "--trajectories",
    "10",
    "--format",
    "json",
];
const RESULTS: [&str; 5] =
    ["life.json", "cycles.csv", "cycles.csv-metadata.json", "lives.csv", "lives.csv-metadata.json"];

/// Lives a shard, and returns its folder.
fn shard(folder: &Folder, name: &str, shard: &str, more: &[&str]) -> String {
    let out = folder.path(name);
    let answer = linkwear(&[&LIFE[..], more, &["--shard", shard, "--out", &out]].concat());
    let json = answer.json();
    assert_eq!(format!("{}/{}", json["shard"]["index"], json["shard"]["of"]), shard);
    // Its own statistics would be taken for those of the study.
    assert!(RESULTS.iter().all(|name| !fs::exists(format!("{out}/{name}")).unwrap_or(true)), "{shard}");
    out
}

fn merge(folder: &Folder, shards: &[&str], out: &str) -> Answer {
    let out = folder.path(out);
    linkwear(&[&["merge"], shards, &["--out", &out, "--format", "json"]].concat())
}

fn error(answer: &Answer) -> (String, String) {
    let said = |key: &str| answer.errors()[0][key].as_str().expect("text").to_owned();
    assert_eq!((answer.code, &*said("code")), (1, "C0014"), "{}", answer.out);
    (said("message"), said("help"))
}

#[test]
fn shards_of_any_number_in_any_order_are_together_the_undivided_life() {
    let folder = Folder::new("shards");
    let whole = linkwear(&[&LIFE[..], &["--out", &folder.path("whole")]].concat());
    let expected = RESULTS.map(|name| fs::read(folder.path(&format!("whole/{name}"))).expect("a result"));
    for (of, order) in
        [(1, vec![1]), (2, vec![2, 1]), (7, vec![3, 1, 7, 2, 5, 6, 4, 5]), (16, (1..=16).rev().collect())]
    {
        // Of 16 shards of 10 lives some are empty.
        let made: Vec<String> = (1..=of)
            .map(|index| {
                shard(&folder, &format!("{index}of{of}"), &format!("{index}/{of}"), &["--threads", "1"])
            })
            .collect();
        let given: Vec<&str> = order.iter().map(|index: &usize| &*made[index - 1]).collect();
        let out = format!("merged{of}");
        let merged = merge(&folder, &given, &out);
        assert_eq!((merged.code, &merged.out), (0, &whole.out), "{of} shards: {}", merged.err);
        let found = RESULTS.map(|name| fs::read(folder.path(&format!("{out}/{name}"))).expect("a result"));
        assert!(found == expected, "{of} shards");
    }
}

#[test]
fn what_is_no_whole_study_is_refused_with_what_to_do() {
    let folder = Folder::new("no-shards");
    let [a, b] = [("a", "1/3"), ("b", "3/3")].map(|(name, which)| shard(&folder, name, which, &[]));
    let (message, help) = error(&merge(&folder, &[&a, &b], "x"));
    assert_eq!(message, "1 of 3 shards is missing: 2");
    let command = help.split('`').nth(1).expect("a command").to_owned();
    assert!(command.contains("--shard 2/3 --out shard2"), "{command}");
    // The command makes what is missing.
    let words: Vec<String> =
        command.split(' ').skip(1).map(|word| word.replace("shard2", &folder.path("shard2"))).collect();
    assert_eq!(linkwear(&words.iter().map(String::as_str).collect::<Vec<_>>()).code, 0, "{command}");
    let third = folder.path("shard2");
    assert_eq!(merge(&folder, &[&third, &b, &a], "whole").code, 0);

    let other = shard(&folder, "other", "2/3", &["--seed", "8"]);
    let (message, _) = error(&merge(&folder, &[&a, &b, &other], "x"));
    assert!(message.contains("the seed is 8 here, 1 there"), "{message}");
    let halves = shard(&folder, "halves", "2/2", &[]);
    let (message, _) = error(&merge(&folder, &[&a, &halves], "x"));
    assert!(message.contains("the number of shards is 2 here, 3 there"), "{message}");
    let whole = folder.path("whole");
    let (message, _) = error(&merge(&folder, &[&a, &whole], "x"));
    assert!(message.contains("holds no shard"), "{message}");
    assert!(!fs::exists(folder.path("x")).unwrap_or(true), "nothing is written");

    // A flipped bit, and a file cut off.
    let file = format!("{a}/life.shard");
    let bytes = fs::read(&file).expect("a shard");
    let mut flipped = bytes.clone();
    flipped[bytes.len() / 2] ^= 1;
    for wrong in [&flipped[..], &bytes[..bytes.len() / 2], &[]] {
        fs::write(&file, wrong).expect("a file");
        let (message, _) = error(&merge(&folder, &[&a, &b, &third], "x"));
        assert!(message.contains("damaged"), "{message}");
    }
    fs::write(&file, bytes).expect("a file");
    let used = merge(&folder, &[&a, &b, &third], "whole");
    assert_eq!((used.code, used.errors()[0]["code"].as_str()), (1, Some("C0004")), "a used folder");
}

#[test]
fn a_shard_needs_random_lives_a_folder_and_a_number() {
    let folder = Folder::new("shard-usage");
    let out = folder.path("out");
    let life = ["life", "mechanisms/rssr.toml", "--format", "json"];
    for wrong in [
        &["--shard", "3/2", "--out", &out][..],
        &["--shard", "0/2", "--out", &out],
        &["--shard", "two", "--out", &out],
        &["--shard", "1/2"],
        &["--shard", "1/2", "--out", &out, "--mean"],
        &["--shard", "1/2", "--out", &out, "--coupling", "full"],
    ] {
        let answer = linkwear(&[&life, wrong].concat());
        assert_eq!(answer.code, 2, "{wrong:?}: {}", answer.out);
    }
    // Another shard does not go on in the folder of this one.
    let a = shard(&folder, "a", "1/2", &[]);
    let answer = linkwear(&[&LIFE[..], &["--shard", "2/2", "--out", &a, "--resume"]].concat());
    let error = &answer.errors()[0];
    assert!(
        error["message"].as_str().is_some_and(|text| text.contains("the shard is 2/2 now, and was 1/2")),
        "{error}"
    );
}

#[test]
fn what_a_stopped_shard_had_told_of_its_lives_goes_when_it_is_finished() {
    let folder = Folder::new("stopped-shard");
    let out = shard(&folder, "first", "1/2", &[]);
    // As Ctrl-C leaves them: the cycles, and the lives that were finished by then.
    let tables = &RESULTS[1..];
    tables.iter().for_each(|name| drop(folder.write(&format!("first/{name}"), "1")));
    let again = linkwear(&[&LIFE[..], &["--shard", "1/2", "--out", &out, "--resume"]].concat());
    assert_eq!(again.code, 0, "{}", again.err);
    assert!(tables.iter().all(|name| !fs::exists(format!("{out}/{name}")).expect("a folder")));
}
