//! An SVG file of [`super::svg`] as PNG. In: its text. Out: bytes. Fonts of the machine are not asked: letters are
//! those of DejaVu Sans, which is compiled in, so that pictures have the same bytes everywhere.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, fontdb};

use super::PlotError;

/// The picture as PNG with `scale` pixels per unit of the chart.
///
/// # Errors
/// If the text is no SVG, or has no pixels.
pub fn png(svg: &str, scale: f32) -> Result<Vec<u8>, PlotError> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let options = usvg::Options { fontdb: Arc::new(fonts), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| PlotError(error.into()))?;
    let size = tree.size();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pictures are small")]
    let (width, height) = ((size.width() * scale) as u32, (size.height() * scale) as u32);
    let mut pixels = Pixmap::new(width, height).ok_or_else(|| PlotError("it has none".into()))?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| PlotError(error.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_drawn_without_fonts_of_the_machine() {
        let picture = |text: &str| {
            let svg = format!(
                "<svg width=\"60\" height=\"20\" xmlns=\"http://www.w3.org/2000/svg\">\
                 <text x=\"2\" y=\"15\" font-family=\"sans-serif\" font-size=\"12\">{text}</text></svg>"
            );
            png(&svg, 2.0).expect("a picture")
        };
        assert_eq!(picture("abc"), picture("abc"));
        // Missing letters would all look alike.
        assert_ne!(picture("abc"), picture("xyz"));
        assert_ne!(picture("µγ"), picture("αβ"));
        assert!(png("no picture", 1.0).is_err());
    }
}
