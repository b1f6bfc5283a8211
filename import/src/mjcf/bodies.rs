//! Bodies and joints of `<worldbody>`. In: elements. Out: links, joints, sites. Never knows what else moves them.

use std::collections::{HashMap, HashSet};

use super::super::error::ImportError;
use super::super::mass::{Mass, diagonal_matrix, together};
use super::super::place::Place;
use super::super::robot::{Joint, Kind, Link, MOST};
use super::super::xml::Element;
use super::classes::Classes;
use super::geoms::{Assets, mass};
use super::joints;
use super::settings::{FromGeoms, Settings};

/// Elements that make bodies of which this reader knows nothing.
const MAKERS: [&str; 4] = ["replicate", "attach", "composite", "flexcomp"];

/// What was found.
pub struct Tree<'a> {
    pub classes: &'a Classes,
    pub settings: &'a Settings,
    pub assets: &'a Assets<'a>,
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
    /// Coordinate of each joint while it is as drawn [rad or m], in the unit and count of the file.
    pub references: Vec<f64>,
    /// Link of a body by its name.
    pub bodies: HashMap<String, usize>,
    /// Link of a site by its name, and its place there.
    pub sites: HashMap<String, (usize, Place)>,
    /// Names of the file, and those that were made up.
    pub taken: HashSet<String>,
    /// Meshes whose mass MuJoCo takes from their convex hulls.
    pub hulls: usize,
    pub left_out: Vec<String>,
}

/// A body while it is read.
struct Body {
    link: usize,
    geoms: Option<Mass>,
    inertial: Option<Mass>,
    joints: Vec<Joint>,
    references: Vec<f64>,
    has_inertial: bool,
    line: usize,
}

impl Body {
    fn new(link: usize, element: &Element) -> Self {
        Self {
            link,
            geoms: None,
            inertial: None,
            joints: Vec::new(),
            references: Vec::new(),
            has_inertial: element.first("inertial").is_some(),
            line: element.line,
        }
    }

    /// Whether its mass is that of its geoms; where it is not, they need not be what can be read.
    fn counts_geoms(&self, from: FromGeoms) -> bool {
        self.link > 0 && (from == FromGeoms::Always || (from == FromGeoms::Auto && !self.has_inertial))
    }
}

impl Tree<'_> {
    /// The world: link 0, which nothing moves.
    pub fn world(&mut self, world: &Element) -> Result<(), ImportError> {
        self.links.push(Link { name: "world".to_owned(), line: world.line, mass: None, is_between: false });
        self.bodies.insert("world".to_owned(), 0);
        let class = world.attribute("childclass").map(str::to_owned);
        self.parts(world, &mut Body::new(0, world), &Place::default(), class.as_deref())?;
        self.bodies_in(world, 0, &Place::default(), class.as_deref())
    }

    /// What stands in a body beside bodies, or in a <frame> that is at a place in it.
    fn parts(
        &mut self,
        element: &Element,
        body: &mut Body,
        frame: &Place,
        class: Option<&str>,
    ) -> Result<(), ImportError> {
        for child in &element.children {
            match &*child.tag {
                "geom" if body.counts_geoms(self.settings.from_geoms) => {
                    let geom = self.classes.applied(child, class)?;
                    if let Some((own, by_hull)) = mass(&geom, self.settings, self.assets)? {
                        let own = own.seen_from(frame);
                        self.hulls += usize::from(by_hull);
                        body.geoms = Some(body.geoms.map_or(own, |before| together(&before, &own)));
                    }
                }
                // As in MuJoCo, which has no such element there.
                "inertial" if element.tag == "frame" => {
                    let cure = "put it into the body itself, and its `pos` and `quat` as they are there";
                    return Err(child.fault("<inertial> stands in a <frame>", cure));
                }
                "inertial" => body.inertial = Some(self.inertial(child)?),
                "joint" | "freejoint" => self.joint(child, body, frame, class)?,
                "site" => {
                    let site = self.classes.applied(child, class)?;
                    if let Some(name) = site.attribute("name") {
                        let place = frame.then(&self.settings.place(&site)?);
                        self.sites.insert(name.to_owned(), (body.link, place));
                    }
                }
                "frame" => {
                    let inner = frame.then(&self.settings.place(child)?);
                    self.parts(child, body, &inner, child.attribute("childclass").or(class))?;
                }
                maker if MAKERS.contains(&maker) => {
                    let cure = "write the model out first: MuJoCo saves what it has compiled (mj_saveLastXML) without such elements";
                    return Err(
                        child.fault(format!("<{maker}> makes bodies that do not stand in the file"), cure)
                    );
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The bodies that stand in a body or in a <frame>.
    fn bodies_in(
        &mut self,
        element: &Element,
        parent: usize,
        frame: &Place,
        class: Option<&str>,
    ) -> Result<(), ImportError> {
        for child in &element.children {
            match &*child.tag {
                "body" => self.body(child, parent, frame, class)?,
                "frame" => {
                    let inner = frame.then(&self.settings.place(child)?);
                    self.bodies_in(child, parent, &inner, child.attribute("childclass").or(class))?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn body(
        &mut self,
        element: &Element,
        parent: usize,
        frame: &Place,
        class: Option<&str>,
    ) -> Result<(), ImportError> {
        if self.links.len() > MOST {
            return Err(element.fault(format!("there are more than {MOST} bodies"), "import a part of them"));
        }
        let class = element.attribute("childclass").or(class);
        let name = self.name_of(element, "body");
        let link = self.links.len();
        if self.bodies.insert(name.clone(), link).is_some() {
            return Err(
                element.fault(format!("two bodies are called `{name}`"), "give each a name of its own")
            );
        }
        self.links.push(Link { name: name.clone(), line: element.line, mass: None, is_between: false });
        let place = frame.then(&self.settings.place(element)?);
        let mut body = Body::new(link, element);
        self.parts(element, &mut body, &Place::default(), class)?;
        self.finish(&body, parent, &place, &name, element)?;
        self.bodies_in(element, link, &Place::default(), class)
    }

    /// Its name, or a new one.
    fn name_of(&mut self, element: &Element, what: &str) -> String {
        if let Some(name) = element.attribute("name") {
            return name.to_owned();
        }
        let numbered = (1_u64..).map(|number| format!("{what}_{number}"));
        let name = numbered.into_iter().find(|name| !self.taken.contains(name)).unwrap_or_default();
        self.taken.insert(name.clone());
        name
    }

    /// Mass and joints of a body whose elements are read.
    fn finish(
        &mut self,
        body: &Body,
        parent: usize,
        place: &Place,
        name: &str,
        element: &Element,
    ) -> Result<(), ImportError> {
        let mass = match self.settings.from_geoms {
            FromGeoms::Auto => body.inertial.or(body.geoms),
            FromGeoms::Always => body.geoms.or(body.inertial),
            FromGeoms::Never => body.inertial,
        };
        self.links[body.link].mass = self.settings.bounded(mass);
        for (key, what) in
            [("gravcomp", "what it weighs is not held up"), ("mocap", "nothing moves it from outside")]
        {
            if element.attribute(key).is_some_and(|value| value.trim() != "0" && value != "false") {
                self.left_out.push(format!("`{key}` of {name}: {what}"));
            }
        }
        let mut from = parent;
        let last = body.joints.len().checked_sub(1);
        for (at, joint) in body.joints.iter().enumerate() {
            let child = if Some(at) == last {
                body.link
            } else {
                let name = format!("{name}_behind_{}", joint.name);
                self.links.push(Link { name, line: body.line, mass: None, is_between: true });
                self.links.len() - 1
            };
            let place = if at == 0 { *place } else { Place::default() };
            self.joints.push(Joint { parent: from, child, place, ..joint.clone() });
            self.references.push(body.references[at]);
            from = child;
        }
        if body.joints.is_empty() {
            let name = format!("{name}_fixed");
            self.joints.push(Joint {
                parent,
                child: body.link,
                place: *place,
                ..joints::plain(name, Kind::Fixed, [0.0; 3], [0.0; 3])
            });
            self.references.push(0.0);
        }
        Ok(())
    }

    fn inertial(&self, element: &Element) -> Result<Mass, ImportError> {
        let mass = element.number("mass", None)?;
        let full = element.attribute("fullinertia").is_some();
        let inertia = if full {
            let [xx, yy, zz, xy, xz, yz] = element.numbers("fullinertia", None)?;
            [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        } else {
            diagonal_matrix(element.numbers("diaginertia", Some([0.0; 3]))?)
        };
        if mass < 0.0 {
            return Err(element.fault(format!("the mass of a body is {mass} kg"), "a mass is positive"));
        }
        let place = self.settings.place(element)?;
        Ok(Mass { mass, centre: [0.0; 3], inertia }.seen_from(&place))
    }

    fn joint(
        &mut self,
        element: &Element,
        body: &mut Body,
        frame: &Place,
        class: Option<&str>,
    ) -> Result<(), ImportError> {
        let name = self.name_of(element, "joint");
        if body.link == 0 {
            return Err(element.fault(
                format!("the joint `{name}` stands in the world, which does not move"),
                "put it into a body",
            ));
        }
        let is_known = |joint: &Joint| joint.name == name;
        if self.joints.iter().chain(&body.joints).any(is_known) {
            return Err(
                element.fault(format!("two joints are called `{name}`"), "give each a name of its own")
            );
        }
        let given;
        let element = if element.tag == "freejoint" {
            element
        } else {
            given = self.classes.applied(element, class)?;
            &given
        };
        let (joint, reference) = joints::read(element, name, frame, self.settings, &mut self.left_out)?;
        body.joints.push(joint);
        body.references.push(reference);
        Ok(())
    }
}
