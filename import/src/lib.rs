//! Files of other formats as mechanism files of linkwear. In: a robot as URDF or MJCF, or a part as STL. Out: a mechanism file as text, and a list of
//! what it does not carry over. Never knows paths or terminals.

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

mod error;
mod files;
mod imported;
mod inertia;
mod mass;
mod meshes;
mod mjcf;
mod names;
mod part;
mod place;
mod robot;
mod shells;
mod solid;
mod stl;
mod urdf;
mod write;
mod xml;

pub use error::ImportError;
pub use files::{Files, NoFiles};
pub use imported::Imported;
pub use part::{LengthUnit, Part, from_stl};
pub use robot::Base;

/// From a robot's file of either format, told by its root element: URDF (`<robot>`) or MJCF (`<mujoco>`). `base` says whether the root
/// link of a URDF file is held; `density` [kg/m^3] is that of its links without `<inertial>`, whose masses are those of their shapes then.
///
/// # Errors
/// [`ImportError`].
pub fn from_robot(
    text: &str,
    base: Base,
    density: Option<f64>,
    files: &dyn Files,
) -> Result<Imported, ImportError> {
    let root = xml::read(text, None)?;
    let (robot, mut left_out) = match &*root.tag {
        "robot" => urdf::read(&root, density, files)?,
        "mujoco" if base == Base::Floating => {
            let cure = "take --floating away: in MJCF a <freejoint/> in the body says so";
            return Err(root.fault("an MJCF file says itself what moves freely", cure));
        }
        "mujoco" if density.is_some() => {
            let cure = "take --density away, and write `density` into <default><geom/></default> where it is not 1000";
            return Err(root.fault("an MJCF file says itself what its shapes weigh", cure));
        }
        "mujoco" => mjcf::read(root, files)?,
        tag => {
            let message = format!("the file is of <{tag}>, not of <robot> or <mujoco>");
            return Err(root.fault(message, "give a URDF or an MJCF file"));
        }
    };
    let bodies = inertia::merged(&robot, base, &mut left_out)?;
    Ok(write::written(&robot, &bodies, base, left_out))
}

/// From a URDF file (Unified Robot Description Format) without other files; `base` says whether its root link is held.
///
/// # Errors
/// [`ImportError`].
pub fn from_urdf(text: &str, base: Base) -> Result<Imported, ImportError> {
    from_robot(text, base, None, &NoFiles)
}

#[cfg(test)]
mod tests;
