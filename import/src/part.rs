//! A part of which there is a mesh and no robot: its mass, centre and inertia as a body. In: an STL file, a density. Out: a mechanism
//! file of that body. Never knows paths.

use super::error::ImportError;
use super::names::Names;
use super::shells::bounds;
use super::solid::Solid;
use super::stl::triangles;
use super::write::{comment, mass_keys};

/// The unit of the coordinates of a file that does not say it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LengthUnit {
    /// As in robots.
    Metre,
    /// Hundredth of it.
    Centimetre,
    /// What programs of design write.
    #[default]
    Millimetre,
    /// 25.4 mm.
    Inch,
}

impl LengthUnit {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Metre, Self::Centimetre, Self::Millimetre, Self::Inch];

    /// As it is written.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Inch => "in",
        }
    }

    /// In metres.
    const fn size(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 1e-2,
            Self::Millimetre => 1e-3,
            Self::Inch => 0.0254,
        }
    }
}

/// A body made from a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Name of the body.
    pub name: String,
    /// The mechanism file (TOML).
    pub text: String,
    /// [kg]
    pub mass: f64,
    /// In the frame of the mesh [m].
    pub centre: [f64; 3],
    /// About the centre, along the axes of the mesh: xx, yy, zz, xy, xz, yz as entries of the matrix [kg m^2].
    pub inertia: [f64; 6],
    /// [m^3]
    pub volume: f64,
    /// Its extent along the axes of the mesh [m].
    pub size: [f64; 3],
    /// How many there are.
    pub triangles: usize,
    /// What was changed on the way; a sentence each.
    pub remarks: Vec<String>,
}

/// A part of this density [kg/m^3] whose surface is that of an STL file, text or binary.
///
/// # Errors
/// What is no STL file; a surface that is not closed, or whose triangles face both ways.
pub fn from_stl(bytes: &[u8], name: &str, density: f64, unit: LengthUnit) -> Result<Part, ImportError> {
    let fault = |message: String, cure: &str| ImportError::new(0, message, cure);
    let mut mesh = triangles(bytes).map_err(|why| {
        fault(format!("this is no STL file that can be read: {why}"), "export it again, as binary STL")
    })?;
    mesh.iter_mut().flatten().flatten().for_each(|x| *x *= unit.size());
    let solid = Solid::enclosed(&mesh).map_err(|why| {
        fault(
            format!("the mass of this mesh is not known: {why}"),
            "repair it in the program it comes from, so that it is one closed surface; or give mass, centre and inertia by hand",
        )
    })?;
    let mass = solid.of_density(density);
    let i = mass.inertia;
    let inertia = [i[0][0], i[1][1], i[2][2], i[0][1], i[0][2], i[1][2]];
    if !(mass.mass > 0.0 && mass.mass.is_finite() && inertia.iter().all(|x| x.is_finite())) {
        return Err(fault(format!("its mass would be {} kg", mass.mass), "check --density and --unit"));
    }
    let (low, high) = bounds(&mesh);
    let size: [f64; 3] = std::array::from_fn(|i| high[i] - low[i]);
    let body = Names::default().fresh(name);
    let shown = size.map(|x| format!("{}", (1e7 * x / unit.size()).round() / 1e7));
    let text = format!(
        "spec = 1\nname = \"{body}\"\n# From the mesh {}: {} triangles, closed, {} {}, {:e} m^3, at {density} kg/m^3. Axes and origin are those of the mesh.\ngravity = [0, 0, \"-9.81 m/s^2\"]\n\n[points]\n{body}_origin = [0, 0, 0]\n\n[bodies]\n{body} = {{ {} }}\n\n[joints]\n{body}_free = {{ free = [\"ground\", \"{body}\"], at = \"{body}_origin\" }}\n",
        comment(name),
        mesh.len(),
        shown.join(" x "),
        unit.name(),
        solid.volume,
        mass_keys(&mass),
    );
    let mut remarks = Vec::new();
    if solid.is_inside_out {
        remarks.push("its triangles face inwards: what they enclose was taken as solid".to_owned());
    }
    let (mass, centre) = (mass.mass, mass.centre);
    Ok(Part {
        name: body,
        text,
        mass,
        centre,
        inertia,
        volume: solid.volume,
        size,
        triangles: mesh.len(),
        remarks,
    })
}
