//! Licences, sources and doubled dependencies, by the lists of deny.toml. cargo-deny, where it is installed, checks the
//! same and more; this test needs only cargo.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Command;

use serde_json::Value;
use toml::Table;

fn read(path: &str) -> Table {
    fs::read_to_string(path).expect("a file").parse().expect("TOML")
}

fn texts(list: &toml::Value, key: Option<&str>) -> BTreeSet<String> {
    let list = list.as_array().expect("a list").iter();
    let text =
        |entry: &toml::Value| key.map_or(entry, |key| &entry[key]).as_str().expect("a text").to_owned();
    list.map(text).collect()
}

/// Whether one may choose among the licences of an SPDX expression so that all that are needed are allowed.
fn may_use(expression: &str, allowed: &BTreeSet<String>) -> bool {
    let expression = expression.trim();
    let parts = |operator: &str| -> Vec<String> {
        let (mut parts, mut depth) = (vec![String::new()], 0);
        for word in expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ").split_whitespace()
        {
            depth += i32::from(word == "(") - i32::from(word == ")");
            if depth == 0 && word == operator {
                parts.push(String::new());
            } else if let Some(part) = parts.last_mut() {
                part.push_str(if part.is_empty() { "" } else { " " });
                part.push_str(word);
            }
        }
        parts
    };
    let (any, all) = (parts("OR"), parts("AND"));
    if any.len() > 1 {
        return any.iter().any(|part| may_use(part, allowed));
    }
    if all.len() > 1 {
        return all.iter().all(|part| may_use(part, allowed));
    }
    match expression.strip_prefix('(').and_then(|inside| inside.strip_suffix(')')) {
        Some(inside) => may_use(inside, allowed),
        None => allowed.contains(expression),
    }
}

#[test]
fn the_reader_of_licences_knows_choices_and_sums() {
    let allowed = BTreeSet::from(["MIT", "Zlib"].map(str::to_owned));
    for good in ["MIT", "MIT OR GPL-3.0", "GPL-3.0/MIT", "(GPL-3.0 OR MIT) AND Zlib", "MIT AND (Zlib)"] {
        assert!(may_use(good, &allowed), "{good}");
    }
    for bad in ["GPL-3.0", "MIT AND GPL-3.0", "(GPL-3.0 OR AGPL-3.0) AND MIT", "MIT WITH Something", ""] {
        assert!(!may_use(bad, &allowed), "{bad}");
    }
}

#[test]
fn every_package_that_is_built_has_an_allowed_licence() {
    let allowed = texts(&read("deny.toml")["licenses"]["allow"], None);
    let version = Command::new("rustc").arg("-vV").output().expect("rustc");
    let version = String::from_utf8(version.stdout).expect("UTF-8");
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host");
    // What other systems need is not here.
    let metadata = Command::new(env!("CARGO"))
        .args(["metadata", "--locked", "--all-features", "--format-version", "1", "--filter-platform", host])
        .output()
        .expect("cargo");
    let metadata: Value = serde_json::from_slice(&metadata.stdout).expect("JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    assert!(packages.len() > 100, "{}", packages.len());
    for package in packages {
        let licence = package["license"].as_str().unwrap_or_default();
        assert!(may_use(licence, &allowed), "{}: licence `{licence}`", package["name"]);
    }
}

#[test]
fn all_comes_from_the_registry_and_nothing_twice_without_a_reason() {
    let skipped = texts(&read("deny.toml")["bans"]["skip"], Some("crate"));
    let lock = read("Cargo.lock");
    let packages = lock["package"].as_array().expect("packages");
    // Cargo.toml asks for it by its version alone, so it comes from Cargo's own registry.
    let own = packages.iter().find(|package| package["name"].as_str() == Some("serde")).expect("serde");
    let own = own["source"].as_str().expect("a source");
    assert!(own.starts_with("registry+"), "{own}");
    let mut versions: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for package in packages {
        let name = package["name"].as_str().expect("a name");
        versions.entry(name).or_default().push(package["version"].as_str().expect("a version"));
        // Without a source: of this workspace.
        let source = package.get("source").and_then(toml::Value::as_str);
        let known = source.is_none_or(|source| source == own);
        assert!(known, "{name} comes from {source:?}");
    }
    let doubled: BTreeSet<String> =
        versions.iter().filter(|(_, all)| all.len() > 1).map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(doubled, skipped, "what is there twice, and what deny.toml gives a reason for");
}
