//! A unit ready to run, once in a process. In: the folder of its resources. Out: [`Loaded`].

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use linkwear_native::Native;
use linkwear_runtime::System;
use linkwear_tape::Interpreted;

use crate::needs::{belongs_to_start, leads_drives};
use crate::unit::{PROGRAM_FILE, Unit};

/// A unit with its equations on a back end.
#[derive(Debug)]
pub struct Loaded {
    /// What it was read from.
    pub unit: Unit,
    /// See [`belongs_to_start`].
    pub fixed: Vec<bool>,
    /// By parameter, whether it is an input that a drive follows, or a rate of one.
    pub leads: Vec<bool>,
    /// Whether one does: asked with every value.
    pub has_leading_inputs: bool,
    pub(crate) interpreter: Interpreted,
    native: Option<Native>,
    /// Why it is interpreted, if it is.
    pub refusal: Option<String>,
}

impl Loaded {
    /// A unit as machine code, else interpreted.
    pub fn new(unit: Unit) -> Self {
        let program = &unit.program;
        let native = Native::with_laws(program.tapes(), program.sizes(), program.description());
        let refusal = native.as_ref().err().map(ToString::to_string);
        let (interpreter, fixed) = (unit.program.interpreter(), belongs_to_start(&unit.program));
        let leads = leads_drives(&unit.program);
        Self {
            interpreter,
            fixed,
            has_leading_inputs: leads.contains(&true),
            leads,
            native: native.ok(),
            refusal,
            unit,
        }
    }

    /// Whether a parameter is an input.
    pub fn is_input(&self, parameter: usize) -> bool {
        parameter >= self.unit.program.description().tunable()
    }

    /// The equations.
    pub fn system(&self) -> &dyn System<f64> {
        match &self.native {
            Some(native) => native,
            None => &self.interpreter,
        }
    }

    /// The unit in a folder of resources. It stays for as long as the process does: instances refer to it, and tools make and
    /// free instances by the thousand.
    ///
    /// # Errors
    /// Why it cannot be read, in a sentence.
    pub fn from_resources(folder: &Path) -> Result<&'static Self, String> {
        static LOADED: Mutex<Vec<(PathBuf, Vec<u8>, &'static Loaded)>> = Mutex::new(Vec::new());
        let file = folder.join(PROGRAM_FILE);
        let told = |reason: &dyn std::fmt::Display| format!("cannot read `{}`: {reason}", file.display());
        let bytes = fs::read(&file).map_err(|error| told(&error))?;
        let mut loaded = LOADED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, _, known)) = loaded.iter().find(|(path, known, _)| *path == file && *known == bytes) {
            return Ok(known);
        }
        let unit = Unit::from_bytes(&bytes).map_err(|damage| told(&damage))?;
        let made: &'static Self = Box::leak(Box::new(Self::new(unit)));
        loaded.push((file, bytes, made));
        Ok(made)
    }
}
