//! Classes of defaults. In: the `<default>` elements of a file. Out: elements with what their class gives them. Never knows what attributes
//! mean, but which of them say one thing.

use std::collections::HashMap;

use super::super::error::ImportError;
use super::super::xml::{Element, numbers_of};
use super::laws;

/// The class of all that names none.
const MAIN: &str = "main";
/// Attributes that say how a thing is turned: an element's own counts alone.
const TURNS: [&str; 6] = ["quat", "axisangle", "euler", "xyaxes", "zaxis", "fromto"];
/// Lists of which the defaults have what an element's own lacks at its end.
const LISTS: [&str; 3] = ["size", "gainprm", "biasprm"];
/// All of `<equality>`.
pub const EQUALITY: &str = "equality";
/// All of `<actuator>`.
const ACTUATOR: &str = "actuator";

type Attributes = Vec<(String, String)>;

/// Attributes by class and element.
#[derive(Debug, Default)]
pub struct Classes(HashMap<String, HashMap<&'static str, Attributes>>);

/// Elements that have defaults here.
const TAGS: [&str; 6] = ["joint", "geom", "site", "mesh", EQUALITY, ACTUATOR];

/// Elements that are one in `<default>`: any kind of actuator sets the defaults of all.
fn family(tag: &str) -> &str {
    if laws::KINDS.contains(&tag) { ACTUATOR } else { tag }
}

impl Classes {
    /// Of a file.
    pub fn of(root: &Element) -> Result<Self, ImportError> {
        let mut classes = Self(HashMap::from([(MAIN.to_owned(), HashMap::new())]));
        for default in root.all("default") {
            let name = default.attribute("class").unwrap_or(MAIN);
            if name != MAIN && !classes.0.contains_key(name) {
                // The outermost class may have any name; it is that of all.
                let main = classes.0.get(MAIN).cloned().unwrap_or_default();
                classes.0.insert(name.to_owned(), main);
            }
            classes.add(default, name)?;
            if name != MAIN
                && let Some(outermost) = classes.0.get(name).cloned()
            {
                classes.0.insert(MAIN.to_owned(), outermost);
            }
        }
        Ok(classes)
    }

    fn add(&mut self, default: &Element, name: &str) -> Result<(), ImportError> {
        let mut own = self.0.remove(name).unwrap_or_default();
        for element in default.children.iter().filter(|element| element.tag != "default") {
            let Some(tag) = TAGS.into_iter().find(|tag| *tag == family(&element.tag)) else { continue };
            let before = own.remove(tag).unwrap_or_default();
            let all = joined(&element.attributes, &before);
            let all = if tag == ACTUATOR { laws::stored(&element.with(all))? } else { all };
            own.insert(tag, all);
        }
        self.0.insert(name.to_owned(), own.clone());
        for nested in default.all("default") {
            let inner = nested.needed("class")?;
            if inner == name || (self.0.contains_key(inner) && inner == MAIN) {
                return Err(nested.fault(
                    format!("the class `{inner}` stands within itself"),
                    "give each class a name of its own",
                ));
            }
            self.0.insert(inner.to_owned(), own.clone());
            self.add(nested, inner)?;
        }
        Ok(())
    }

    /// An element with the defaults of its class, or of the one that its body gives.
    pub fn applied(&self, element: &Element, of_body: Option<&str>) -> Result<Element, ImportError> {
        self.applied_as(family(&element.tag), element, of_body)
    }

    /// The same of an element that stands among those of a family.
    pub fn applied_as(
        &self,
        family: &str,
        element: &Element,
        of_body: Option<&str>,
    ) -> Result<Element, ImportError> {
        let name = element.attribute("class").or(of_body).unwrap_or(MAIN);
        let class = self.0.get(name).ok_or_else(|| {
            let message = format!("there is no class `{name}`");
            element.fault(message, "name one of the classes in <default>; names are case-sensitive")
        })?;
        Ok(element.with(match class.get(family) {
            Some(defaults) => joined(&element.attributes, defaults),
            None => element.attributes.clone(),
        }))
    }
}

/// Attributes, and those of the defaults that they do not say themselves.
fn joined(own: &Attributes, defaults: &Attributes) -> Attributes {
    let has = |key: &str| own.iter().any(|(name, _)| name == key);
    let is_turned = own.iter().any(|(name, _)| TURNS.contains(&name.as_str()));
    let mut all = own.clone();
    for (key, value) in defaults {
        if key == "class" || (is_turned && TURNS.contains(&key.as_str())) {
            continue;
        }
        match all.iter_mut().find(|(name, _)| name == key) {
            Some((_, written)) if LISTS.contains(&key.as_str()) => {
                if let (Some(first), Some(rest)) = (numbers_of(written), numbers_of(value))
                    && first.len() < rest.len()
                {
                    let more = rest[first.len()..].iter().map(f64::to_string);
                    *written = std::iter::once(written.clone()).chain(more).collect::<Vec<_>>().join(" ");
                }
            }
            Some(_) => {}
            None if !has(key) => all.push((key.clone(), value.clone())),
            None => {}
        }
    }
    all
}
