//! Meshes that a robot's file names, read once each. In: names and scales. Out: solids, or why there are none. Never knows what has them.

use std::cell::RefCell;
use std::collections::HashMap;

use super::files::Files;
use super::solid::Solid;
use super::stl::{Triangle, triangles};

/// Triangles of all meshes of a robot, together: 50 bytes each in a binary file.
const TRIANGLES: usize = 4_000_000;

/// Meshes by name.
pub struct Meshes<'a> {
    files: &'a dyn Files,
    read: RefCell<HashMap<String, Result<Vec<Triangle>, String>>>,
}

impl<'a> Meshes<'a> {
    pub fn new(files: &'a dyn Files) -> Self {
        Self { files, read: RefCell::default() }
    }

    /// What a mesh encloses, its corners moved [m].
    pub fn solid(&self, name: &str, moved: impl Fn([f64; 3]) -> [f64; 3]) -> Result<Solid, String> {
        if !name.to_ascii_lowercase().ends_with(".stl") {
            return Err("meshes are read from STL files alone".to_owned());
        }
        let mut read = self.read.borrow_mut();
        let so_far: usize = read.values().flatten().map(Vec::len).sum();
        let mesh = read.entry(name.to_owned()).or_insert_with(|| {
            let bytes = self.files.bytes(name).map_err(|error| format!("it cannot be read: {error}"))?;
            let found = triangles(&bytes)?;
            match so_far + found.len() > TRIANGLES {
                true => Err(format!("all meshes together have more than {TRIANGLES} triangles")),
                false => Ok(found),
            }
        });
        let mesh = mesh.as_ref().map_err(Clone::clone)?;
        Solid::enclosed(&mesh.iter().map(|corners| corners.map(&moved)).collect::<Vec<_>>())
    }
}
