//! Included files, put where they are included. In: a tree of elements and the files it names. Out: one tree. Never knows what elements
//! mean.

use std::sync::Arc;

use super::super::error::ImportError;
use super::super::files::Files;
use super::super::xml::{Element, read};

/// Files that a robot may be put together of, each as often as it is included.
const MOST: usize = 200;

/// The tree with all that it includes.
pub fn whole(root: Element, files: &dyn Files) -> Result<Element, ImportError> {
    expanded(root, files, &mut Vec::new(), &mut 0)
}

fn expanded(
    element: Element,
    files: &dyn Files,
    within: &mut Vec<String>,
    count: &mut usize,
) -> Result<Element, ImportError> {
    let mut children = Vec::with_capacity(element.children.len());
    for child in element.children {
        if child.tag != "include" {
            children.push(expanded(child, files, within, count)?);
            continue;
        }
        let name = child.needed("file")?.to_owned();
        if within.contains(&name) {
            let cure = "take one of the includes away";
            return Err(child.fault(format!("`{name}` includes itself, by {}", within.join(", ")), cure));
        }
        *count += 1;
        if *count > MOST {
            return Err(child.fault(format!("more than {MOST} files are included"), "include fewer of them"));
        }
        let bytes = files.bytes(&name).map_err(|error| {
            let cure = "its path counts from the folder of the file that is imported; files elsewhere are read with --allow-outside-data";
            child.fault(format!("the included file `{name}` cannot be read: {error}"), cure)
        })?;
        let text = String::from_utf8(bytes)
            .map_err(|_| child.fault(format!("`{name}` is not UTF-8 text"), "give an XML file"))?;
        let included = read(&text, Some(&Arc::from(name.as_str())))?;
        within.push(name);
        children.extend(expanded(included, files, within, count)?.children);
        within.pop();
    }
    Ok(Element { children, ..element })
}
