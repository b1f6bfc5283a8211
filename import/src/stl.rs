//! STL files, binary or as text, as triangles. In: bytes. Out: corners. Never knows what they enclose.

use std::borrow::Cow;
use std::io::Cursor;

/// Corners of a triangle, seen from outside against the clock, in the unit of the file.
pub type Triangle = [[f64; 3]; 3];

/// Bytes of a binary file before its triangles, and of each triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// The triangles of a file, or what is wrong with it.
pub fn triangles(bytes: &[u8]) -> Result<Vec<Triangle>, String> {
    let mesh = stl_io::create_stl_reader(&mut Cursor::new(as_expected(bytes)?.as_ref()))
        .and_then(|reader| reader.collect::<Result<Vec<_>, _>>())
        .map_err(|error| error.to_string())?;
    let corners =
        |triangle: &stl_io::Triangle| -> Triangle { triangle.vertices.map(|corner| corner.0.map(f64::from)) };
    let triangles: Vec<Triangle> = mesh.iter().map(corners).collect();
    if triangles.is_empty() {
        return Err("it has no triangles".to_owned());
    }
    match triangles.iter().flatten().flatten().any(|x| !x.is_finite()) {
        true => Err("a corner is not at finite coordinates".to_owned()),
        false => Ok(triangles),
    }
}

/// What the reader takes for what it is: it takes all that begins with "solid " as text, but many programs write that into binary files
/// too, and text may begin in other ways.
fn as_expected(bytes: &[u8]) -> Result<Cow<'_, [u8]>, String> {
    let count = bytes.get(HEADER - 4..HEADER).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    let size = count.map(|count| HEADER as u64 + u64::from(count) * TRIANGLE as u64);
    if size.is_some_and(|size| size <= bytes.len() as u64 && bytes.len() as u64 <= size + 2) {
        // The header says nothing.
        return Ok(Cow::Owned([&[0; 80], &bytes[80..]].concat()));
    }
    let text = bytes.trim_ascii_start();
    if !text.get(..5).is_some_and(|start| start.eq_ignore_ascii_case(b"solid")) {
        return Err(match (count, size) {
            (Some(count), Some(size)) => format!(
                "it is no text, and for a binary file of {count} triangles it has {} bytes in place of {size}",
                bytes.len()
            ),
            _ => "it is too short to be one".to_owned(),
        });
    }
    let text = text.to_ascii_lowercase();
    let lines = || text.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii);
    if !lines().any(|line| line.starts_with(b"endsolid")) {
        return Err("its text breaks off: there is no `endsolid`".to_owned());
    }
    // Several solids are as good as one of all their triangles.
    let facets = lines().filter(|line| !line.starts_with(b"solid") && !line.starts_with(b"endsolid"));
    let mut one = b"solid \n".to_vec();
    for line in facets {
        one.extend_from_slice(line);
        one.push(b'\n');
    }
    one.extend_from_slice(b"endsolid\n");
    Ok(Cow::Owned(one))
}
