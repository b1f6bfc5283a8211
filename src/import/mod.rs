//! Robots of other formats as mechanism files. In: text of a URDF file. Out: a mechanism file as text, and a list of what it does not
//! carry over. Never knows paths or terminals.

mod error;
mod imported;
mod inertia;
mod names;
mod place;
mod robot;
mod urdf;
mod write;
mod xml;

pub use error::ImportError;
pub use imported::Imported;
pub use robot::Base;

/// From a URDF file (Unified Robot Description Format); `base` says whether its root link is held.
///
/// # Errors
/// [`ImportError`].
pub fn from_urdf(text: &str, base: Base) -> Result<Imported, ImportError> {
    let (robot, mut left_out) = urdf::read(text)?;
    let bodies = inertia::merged(&robot, base, &mut left_out)?;
    Ok(write::written(&robot, &bodies, base, left_out))
}

#[cfg(test)]
mod tests;
