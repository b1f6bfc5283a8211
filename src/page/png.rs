//! A picture as PNG, feature `png`. In: SVG. Out: bytes, the same on every machine: letters are those of DejaVu Sans, which is compiled
//! in. Never knows what is drawn.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, fontdb};

use super::chart::VERSION;

/// Pixels per unit of a picture: sharp in print at half a page's width.
const SCALE: f32 = 2.0;
/// Where the first chunk after that of the size begins.
const AFTER_SIZE: usize = 33;

/// The picture; why not, if it is none.
pub fn png(svg: &str) -> Result<Vec<u8>, String> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let options = usvg::Options { fontdb: Arc::new(fonts), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| error.to_string())?;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pictures are small")]
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * SCALE) as u32);
    let mut pixels = Pixmap::new(width, height).ok_or_else(|| "it has no pixels".to_owned())?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    let mut bytes = pixels.encode_png().map_err(|error| error.to_string())?;
    // By which program, so that it may be replaced: PNG (ISO/IEC 15948), 11.3.4.3.
    let said = [&b"tEXtSoftware\0linkwear "[..], VERSION.as_bytes()].concat();
    let length = u32::try_from(said.len() - 4).unwrap_or_default().to_be_bytes();
    let chunk = [&length[..], &said, &checksum(&said).to_be_bytes()].concat();
    bytes.splice(AFTER_SIZE..AFTER_SIZE, chunk);
    Ok(bytes)
}

/// CRC-32 of a chunk: ISO/IEC 15948, annex D.
fn checksum(bytes: &[u8]) -> u32 {
    let shifted = |crc: u32, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), shifted))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_drawn_and_the_file_says_who_made_it() {
        let picture = |text: &str| {
            let style = "<style>.chart{font:12px system-ui,Helvetica,Arial,sans-serif;fill:#343a40}</style>";
            png(&format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" width=\"60\" height=\"20\">{style}<text x=\"2\" y=\"15\">{text}</text></svg>"
            ))
            .expect("a picture")
        };
        assert_eq!(picture("abc"), picture("abc"));
        // Missing letters would all look alike.
        assert_ne!(picture("abc"), picture("xyz"));
        assert!(picture("a").windows(9).any(|part| part == b"linkwear "));
        assert!(png("no picture").is_err());
        // The check value of the standard.
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
    }
}
