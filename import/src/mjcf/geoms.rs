//! Masses of `<geom>` elements. In: elements with their defaults. Out: mass of each in the frame of its body. Never knows joints.

use std::collections::HashMap;

use super::super::error::ImportError;
use super::super::mass::{Mass, Shape};
use super::super::meshes::Meshes;
use super::super::place::{Place, direction};
use super::super::xml::Element;
use super::classes::Classes;
use super::settings::{Settings, flag, to_z};

/// Density of what says none [kg/m^3].
const DENSITY: f64 = 1000.0;
const CURE: &str = "give the body an <inertial> with its mass and inertia";
const MESH_CURE: &str = "give the body an <inertial> with its mass and inertia; files outside the folder are read with --allow-outside-data";

/// The meshes of a file by name, and those that were taken otherwise than MuJoCo takes them.
pub struct Assets<'a> {
    meshes: Meshes<'a>,
    by_name: HashMap<String, Element>,
    folder: String,
}

impl<'a> Assets<'a> {
    pub fn of(
        root: &Element,
        classes: &Classes,
        settings: &Settings,
        meshes: Meshes<'a>,
    ) -> Result<Self, ImportError> {
        let mut by_name = HashMap::new();
        for mesh in root.all("asset").flat_map(|asset| asset.all("mesh")) {
            let mesh = classes.applied(mesh, None)?;
            let file = mesh.attribute("file").unwrap_or_default();
            let last = file.rsplit(['/', '\\']).next().unwrap_or_default();
            let stem = last.rsplit_once('.').map_or(last, |(stem, _)| stem);
            let name = mesh.attribute("name").unwrap_or(stem).to_owned();
            by_name.insert(name, mesh);
        }
        let folder = settings.mesh_folder.trim_end_matches('/').to_owned();
        Ok(Self { meshes, by_name, folder })
    }

    /// Mass of a geom that is a mesh, in the mesh's frame, and whether MuJoCo would take that of its convex hull.
    fn mass(&self, geom: &Element, settings: &Settings) -> Result<(Mass, bool), ImportError> {
        let name = geom.needed("mesh")?;
        let mesh = self.by_name.get(name).ok_or_else(|| {
            geom.fault(format!("there is no mesh `{name}` in <asset>"), "names are case-sensitive")
        })?;
        let spread = mesh.attribute("inertia");
        if spread == Some("shell") {
            return Err(geom.fault(format!("the mass of the mesh `{name}` is spread over its surface"), CURE));
        }
        let Some(file) = mesh.attribute("file") else {
            return Err(geom.fault(format!("the mesh `{name}` is not of a file"), CURE));
        };
        let file =
            if settings.strips_path { file.rsplit(['/', '\\']).next().unwrap_or_default() } else { file };
        let path = if self.folder.is_empty() { file.to_owned() } else { format!("{}/{file}", self.folder) };
        let scale = mesh.numbers("scale", Some([1.0; 3]))?;
        let at = mesh.numbers("refpos", Some([0.0; 3]))?;
        let quaternion = mesh.numbers("refquat", Some([1.0, 0.0, 0.0, 0.0]))?;
        let turn = direction(quaternion)
            .map(|(quaternion, _)| super::super::place::of_quaternion(quaternion))
            .ok_or_else(|| mesh.fault("`refquat` of <mesh> is zero", "give it by four numbers"))?;
        // As MuJoCo: seen from the frame that `refpos` and `refquat` give, in the unit of the file, and scaled there.
        let moved = |corner: [f64; 3]| {
            let from: [f64; 3] = std::array::from_fn(|i| corner[i] - at[i]);
            std::array::from_fn(|j| scale[j] * (0..3).map(|i| turn[i][j] * from[i]).sum::<f64>())
        };
        let solid = self.meshes.solid(&path, moved).map_err(|why| {
            geom.fault(format!("the mass of the mesh `{name}` ({path}) is not known: {why}"), MESH_CURE)
        })?;
        let mass = match geom.attribute("mass") {
            Some(_) => solid.of_mass(positive(geom, "mass", 0.0)?),
            None => solid.of_density(positive(geom, "density", DENSITY)?),
        };
        Ok((mass, spread == Some("convex")))
    }
}

/// Mass of a geom in the frame of its body; None where it has none, and whether MuJoCo takes that of a convex hull.
pub fn mass(
    geom: &Element,
    settings: &Settings,
    assets: &Assets<'_>,
) -> Result<Option<(Mass, bool)>, ImportError> {
    let group = geom.number("group", Some(0.0))?;
    let has_none =
        |key: &str| Ok::<_, ImportError>(geom.attribute(key).is_some() && positive(geom, key, 0.0)? == 0.0);
    if group < settings.groups[0] || group > settings.groups[1] || has_none("mass")? {
        return Ok(None);
    }
    if geom.attribute("mass").is_none() && has_none("density")? {
        return Ok(None);
    }
    if flag(geom, "shellinertia", false)? {
        return Err(geom.fault("the mass of a <geom> is spread over its surface", CURE));
    }
    let kind = geom.attribute("type").unwrap_or("sphere");
    if matches!(kind, "plane" | "hfield") {
        return Ok(None);
    }
    if kind == "mesh" {
        let (mass, by_hull) = assets.mass(geom, settings)?;
        return Ok(Some((mass.seen_from(&settings.place(geom)?), by_hull)));
    }
    if geom.attribute("mesh").is_some() {
        return Err(geom.fault(format!("a {kind} is fitted to a mesh"), CURE));
    }
    let (shape, place) = shape(geom, kind, settings)?;
    let volume = shape.volume();
    let mass = match geom.attribute("mass") {
        Some(_) => positive(geom, "mass", 0.0)?,
        None => positive(geom, "density", DENSITY)? * volume,
    };
    if !(volume > 0.0 && volume.is_finite() && mass.is_finite()) {
        return Err(geom.fault(format!("the volume of a {kind} is {volume:e} m^3"), "give sizes in metres"));
    }
    Ok(Some((shape.of_mass(mass).seen_from(&place), false)))
}

fn shape(geom: &Element, kind: &str, settings: &Settings) -> Result<(Shape, Place), ImportError> {
    let mut size = geom.up_to("size", 3)?;
    let mut place = None;
    if geom.attribute("fromto").is_some() {
        if !matches!(kind, "capsule" | "cylinder" | "ellipsoid" | "box") {
            let cure = "`fromto` is for capsules, cylinders, ellipsoids and boxes";
            return Err(geom.fault(format!("a {kind} has `fromto`"), cure));
        }
        let ends: [f64; 6] = geom.numbers("fromto", None)?;
        let along = std::array::from_fn(|i| ends[i] - ends[i + 3]);
        let Some((z, length)) = direction::<3>(along) else {
            return Err(geom.fault("`fromto` has both ends at one place", "give two places"));
        };
        let middle = std::array::from_fn(|i| 0.5 * (ends[i] + ends[i + 3]));
        place = Some(Place::turned(middle, to_z(z)));
        let radius = size.first().copied().unwrap_or(0.0);
        size = if matches!(kind, "capsule" | "cylinder") {
            vec![radius, 0.5 * length]
        } else {
            vec![radius, radius, 0.5 * length]
        };
    }
    let many = match kind {
        "sphere" => 1,
        "capsule" | "cylinder" => 2,
        "ellipsoid" | "box" => 3,
        _ => {
            let cure = "shapes with mass are sphere, capsule, cylinder, ellipsoid, box and mesh; else give the body an <inertial>";
            return Err(geom.fault(format!("a <geom> is of the type \"{kind}\""), cure));
        }
    };
    if size.len() < many || size[..many].iter().any(|x| *x <= 0.0) {
        let given = geom.attribute("size").unwrap_or("missing");
        return Err(geom.fault(
            format!("`size` of a {kind} is {given}"),
            format!("{many} positive numbers must stand there, in metres: radius and half lengths"),
        ));
    }
    let shape = match (kind, &size[..]) {
        ("capsule", [radius, half, ..]) => Shape::Capsule { radius: *radius, half: *half },
        ("cylinder", [radius, half, ..]) => Shape::Cylinder { radius: *radius, half: *half },
        ("ellipsoid", [a, b, c]) => Shape::Ellipsoid { half: [*a, *b, *c] },
        ("box", [a, b, c]) => Shape::Box { half: [*a, *b, *c] },
        _ => Shape::Sphere { radius: size[0] },
    };
    Ok((shape, place.map_or_else(|| settings.place(geom), Ok)?))
}

fn positive(element: &Element, key: &str, default: f64) -> Result<f64, ImportError> {
    let value = element.number(key, Some(default))?;
    if value < 0.0 {
        let message = format!("`{key}` of <{}> is {value}", element.tag);
        return Err(element.fault(message, "it is 0 or positive"));
    }
    Ok(value)
}
