//! The JSON Schema of the file, for editors, is made from the types of the parser and kept in `docs/`.

use std::fs;

use super::file::File;

#[test]
fn the_shipped_schema_is_that_of_the_parser() {
    let mut schema = schemars::schema_for!(File).to_value();
    schema.as_object_mut().expect("an object").insert("title".into(), "linkwear mechanism".into());
    let (path, current) = ("../docs/linkwear.schema.json", format!("{schema:#}\n"));
    if std::env::var_os("LINKWEAR_WRITE_SCHEMA").is_some() {
        fs::write(path, &current).expect("the schema is written");
    }
    let shipped = fs::read_to_string(path).expect("the shipped schema");
    assert!(shipped == current, "stale: LINKWEAR_WRITE_SCHEMA=1 cargo test -p linkwear-codegen schema");
}
