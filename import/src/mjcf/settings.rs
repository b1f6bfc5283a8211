//! What `<compiler>` and `<option>` say of the whole file. In: elements. Out: settings. Never knows bodies.

use super::super::error::ImportError;
use super::super::mass::{Mass, diagonal_matrix};
use super::super::place::{Matrix, Place, cross, direction, dot, of_quaternion, product, rotation};
use super::super::xml::Element;
use nalgebra::{Matrix3, SymmetricEigen};

/// Where masses come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FromGeoms {
    /// Where there is no <inertial>.
    Auto,
    Always,
    Never,
}

/// What the flags of a file switch off.
#[derive(Clone, Debug, Default)]
pub struct Disabled {
    pub springs: bool,
    pub dampers: bool,
    pub actuation: bool,
    pub equality: bool,
    /// Ranges of the signals of actuators.
    pub clamps: bool,
    /// Groups of actuators.
    pub groups: Vec<f64>,
}

/// Settings.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Radians in the unit of angles.
    pub angle: f64,
    /// Axes 0 to 2 of the angles of `euler`, and whether they turn along.
    euler: [(usize, bool); 3],
    pub limits_by_range: bool,
    pub from_geoms: FromGeoms,
    pub groups: [f64; 2],
    bound_mass: f64,
    bound_inertia: f64,
    balances: bool,
    pub total_mass: Option<f64>,
    pub mesh_folder: String,
    pub strips_path: bool,
    pub gravity: [f64; 3],
    pub disabled: Disabled,
}

impl Settings {
    /// Of a file.
    pub fn of(root: &Element, left_out: &mut Vec<String>) -> Result<Self, ImportError> {
        let mut settings = Self {
            angle: 1_f64.to_radians(),
            euler: [(0, true), (1, true), (2, true)],
            limits_by_range: true,
            from_geoms: FromGeoms::Auto,
            groups: [0.0, 5.0],
            bound_mass: 0.0,
            bound_inertia: 0.0,
            balances: false,
            total_mass: None,
            mesh_folder: String::new(),
            strips_path: false,
            gravity: [0.0, 0.0, -9.81],
            disabled: Disabled::default(),
        };
        for compiler in root.all("compiler") {
            settings.compiler(compiler)?;
        }
        let mut medium = false;
        for option in root.all("option") {
            settings.gravity = option.numbers("gravity", Some(settings.gravity))?;
            let wind = option.numbers("wind", Some([0.0; 3]))?;
            medium |= wind != [0.0; 3]
                || option.number("density", Some(0.0))? != 0.0
                || option.number("viscosity", Some(0.0))? != 0.0;
            if option.attribute("actuatorgroupdisable").is_some() {
                settings.disabled.groups = option.up_to("actuatorgroupdisable", 31)?;
            }
            for flags in option.all("flag") {
                settings.flags(flags)?;
            }
        }
        settings.disabled.tell(left_out);
        if medium {
            left_out.push("wind, density and viscosity of <option>: no medium resists the motion".to_owned());
        }
        Ok(settings)
    }

    /// What `<flag>` says of all.
    fn flags(&mut self, element: &Element) -> Result<(), ImportError> {
        let off = |key: &str| -> Result<Option<bool>, ImportError> {
            Ok(word(element, key, &["disable", "enable"])?.map(|word| word == "disable"))
        };
        if off("gravity")? == Some(true) {
            self.gravity = [0.0; 3];
        }
        let Disabled { springs, dampers, actuation, equality, clamps, groups: _ } = &mut self.disabled;
        // `passive`, of older versions, is both of springs and dampers; `constraint` is equality and what touches.
        for (state, keys) in [
            (springs, ["passive", "spring"]),
            (dampers, ["passive", "damper"]),
            (actuation, ["actuation", "actuation"]),
            (equality, ["constraint", "equality"]),
            (clamps, ["clampctrl", "clampctrl"]),
        ] {
            let [whole, own] = [off(keys[0])?, off(keys[1])?];
            *state = match (whole, own) {
                (None, None) => *state,
                (whole, own) => whole == Some(true) || own == Some(true),
            };
        }
        Ok(())
    }

    fn compiler(&mut self, element: &Element) -> Result<(), ImportError> {
        if element.attribute("coordinate") == Some("global") {
            let cure = "write local coordinates: MuJoCo before 2.3.4 does so where it saves a model";
            return Err(element.fault("places are in global coordinates, which MuJoCo has given up", cure));
        }
        if let Some(unit) = word(element, "angle", &["degree", "radian"])? {
            self.angle = if unit == "degree" { 1_f64.to_radians() } else { 1.0 };
        }
        if let Some(text) = element.attribute("eulerseq") {
            let axes: Option<Vec<(usize, bool)>> = text
                .chars()
                .map(|letter| Some(("xyz".find(letter.to_ascii_lowercase())?, letter.is_ascii_lowercase())))
                .collect();
            self.euler = axes.and_then(|axes| axes.try_into().ok()).ok_or_else(|| {
                let message = format!("`eulerseq` is \"{text}\"");
                element.fault(message, "three of x, y, z stand there, or of X, Y, Z for axes that stay")
            })?;
        }
        if let Some(word) = word(element, "inertiafromgeom", &["auto", "true", "false"])? {
            self.from_geoms = match word {
                "true" => FromGeoms::Always,
                "false" => FromGeoms::Never,
                _ => FromGeoms::Auto,
            };
        }
        self.limits_by_range = flag(element, "autolimits", self.limits_by_range)?;
        self.balances = flag(element, "balanceinertia", self.balances)?;
        self.strips_path = flag(element, "strippath", self.strips_path)?;
        self.groups = element.numbers("inertiagrouprange", Some(self.groups))?;
        self.bound_mass = bound(element, "boundmass", self.bound_mass)?;
        self.bound_inertia = bound(element, "boundinertia", self.bound_inertia)?;
        let total = element.number("settotalmass", Some(self.total_mass.unwrap_or(-1.0)))?;
        self.total_mass = (total > 0.0).then_some(total);
        if let Some(folder) = element.attribute("meshdir").or_else(|| element.attribute("assetdir")) {
            folder.clone_into(&mut self.mesh_folder);
        }
        Ok(())
    }

    /// The mass of a body within the bounds that the file sets.
    pub fn bounded(&self, mass: Option<Mass>) -> Option<Mass> {
        let found = mass.filter(|mass| mass.mass > 0.0);
        if self.bound_mass <= 0.0 && self.bound_inertia <= 0.0 && !self.balances {
            return found;
        }
        let mut mass =
            found.unwrap_or(Mass { mass: 0.0, centre: [0.0; 3], inertia: diagonal_matrix([0.0; 3]) });
        mass.mass = mass.mass.max(self.bound_mass);
        let entries = Matrix3::from_fn(|i, j| mass.inertia[i][j]);
        let principal = SymmetricEigen::new(entries);
        let mut moments: [f64; 3] = std::array::from_fn(|i| principal.eigenvalues[i].max(self.bound_inertia));
        let sum: f64 = moments.iter().sum();
        if self.balances && moments.iter().any(|own| 2.0 * own > sum) {
            moments = [sum / 3.0; 3];
        }
        let axes = std::array::from_fn(|i| std::array::from_fn(|j| principal.eigenvectors[(i, j)]));
        let changed = (0..3).any(|i| moments[i] != principal.eigenvalues[i]);
        if changed {
            mass.inertia = Place { origin: [0.0; 3], turn: axes }.tensor(&diagonal_matrix(moments));
        }
        (mass.mass > 0.0).then_some(mass)
    }

    /// Place of an element in its parent: `pos` and one of the ways to say how it is turned.
    pub fn place(&self, element: &Element) -> Result<Place, ImportError> {
        Ok(Place::turned(element.numbers("pos", Some([0.0; 3]))?, self.turn(element)?))
    }

    fn turn(&self, element: &Element) -> Result<Matrix, ImportError> {
        let axis_of = |key: &str, vector: [f64; 3]| {
            direction(vector).map(|(direction, _)| direction).ok_or_else(|| {
                element.fault(
                    format!("`{key}` of <{}> has an axis of length 0", element.tag),
                    "give its direction",
                )
            })
        };
        if element.attribute("axisangle").is_some() {
            let [x, y, z, angle] = element.numbers("axisangle", None)?;
            return Ok(rotation(axis_of("axisangle", [x, y, z])?, angle * self.angle));
        }
        if element.attribute("euler").is_some() {
            let angles: [f64; 3] = element.numbers("euler", None)?;
            let mut turn = Place::default().turn;
            for (angle, (axis, turns_along)) in angles.into_iter().zip(self.euler) {
                let about = std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 });
                let step = rotation(about, angle * self.angle);
                turn = if turns_along { product(&turn, &step) } else { product(&step, &turn) };
            }
            return Ok(turn);
        }
        if element.attribute("xyaxes").is_some() {
            let given: [f64; 6] = element.numbers("xyaxes", None)?;
            let x = axis_of("xyaxes", [given[0], given[1], given[2]])?;
            let y = axis_of("xyaxes", [given[3], given[4], given[5]])?;
            let along = dot(x, y);
            // Parallel to ten digits: what is left across is rounding.
            let y = if 1.0 - along.abs() < 1e-10 {
                [0.0; 3]
            } else {
                std::array::from_fn(|i| y[i] - along * x[i])
            };
            let y = axis_of("xyaxes", y)?;
            let z = cross(x, y);
            return Ok(std::array::from_fn(|i| [x[i], y[i], z[i]]));
        }
        if element.attribute("zaxis").is_some() {
            return Ok(to_z(axis_of("zaxis", element.numbers("zaxis", None)?)?));
        }
        let quaternion = element.numbers("quat", Some([1.0, 0.0, 0.0, 0.0]))?;
        direction(quaternion).map(|(quaternion, _)| of_quaternion(quaternion)).ok_or_else(|| {
            element.fault(
                format!("`quat` of <{}> is zero", element.tag),
                "give it by four numbers, the scalar first",
            )
        })
    }
}

impl Disabled {
    fn tell(&self, left_out: &mut Vec<String>) {
        for (is_off, what) in [
            (self.springs, "springs of joints"),
            (self.dampers, "damping of joints"),
            (self.actuation, "actuators"),
            (self.equality, "all of <equality>"),
            (self.clamps, "ranges of the signals of actuators"),
        ] {
            if is_off {
                left_out.push(format!("{what}: a <flag> of the file disables them"));
            }
        }
    }
}

/// The shortest turn that brings z to a direction of length 1.
pub fn to_z(z: [f64; 3]) -> Matrix {
    let across = cross([0.0, 0.0, 1.0], z);
    match direction(across) {
        Some((axis, sine)) if sine > 1e-15 => rotation(axis, libm::atan2(sine, z[2])),
        _ if z[2] < 0.0 => rotation([1.0, 0.0, 0.0], std::f64::consts::PI),
        _ => Place::default().turn,
    }
}

/// A word out of some; None without the attribute.
pub fn word<'a>(element: &Element, key: &str, words: &[&'a str]) -> Result<Option<&'a str>, ImportError> {
    let Some(text) = element.attribute(key) else { return Ok(None) };
    words.iter().find(|word| **word == text).map(|word| Some(*word)).ok_or_else(|| {
        let message = format!("`{key}` of <{}> is \"{text}\"", element.tag);
        element.fault(message, format!("it is one of: {}", words.join(", ")))
    })
}

/// A yes or no, or its default.
pub fn flag(element: &Element, key: &str, default: bool) -> Result<bool, ImportError> {
    Ok(word(element, key, &["false", "true"])?.map_or(default, |word| word == "true"))
}

/// Whether what has a range is limited to it.
pub fn is_limited(
    element: &Element,
    key: &str,
    range: &str,
    settings: &Settings,
) -> Result<bool, ImportError> {
    let given = word(element, key, &["auto", "false", "true"])?.unwrap_or("auto");
    Ok(match given {
        "auto" => settings.limits_by_range && element.attribute(range).is_some(),
        given => given == "true",
    })
}

fn bound(element: &Element, key: &str, default: f64) -> Result<f64, ImportError> {
    let value = element.number(key, Some(default))?;
    if value < 0.0 {
        return Err(element.fault(format!("`{key}` is {value}"), "a bound is 0 or positive"));
    }
    Ok(value)
}
