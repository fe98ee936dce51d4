//! Pictures as numbers: the luminance of a PNG.

use std::io::Cursor;

use crate::{Fault, FaultKind, IoError, Place};

/// A picture's luminance, row by row from the top, 0 black to 1 white.
#[derive(Debug, Clone, PartialEq)]
pub struct Luminance {
    width: usize,
    height: usize,
    values: Vec<f64>,
}

/// Pixels at most; beyond it a file is refused before anything is allocated.
const PIXELS: usize = 1 << 28;

/// Reads a PNG of any kind; `file` names it in errors.
///
/// Luminance is 0.2126 R + 0.7152 G + 0.0722 B (Rec. 709) of the values as
/// stored, so that a grey drawn as 50 % is 0.5. Transparency is ignored.
///
/// # Errors
/// [`IoError::Fault`] for bytes that are no sound PNG and pictures above 2²⁸
/// pixels.
pub fn read_luminance(bytes: &[u8], file: &str) -> Result<Luminance, IoError> {
    let broken = |error: png::DecodingError| {
        let help = "export it again as a PNG file";
        fault(file, FaultKind::Syntax, error.to_string(), help)
    };
    let large = || {
        let cause = "the picture has more than 2^28 pixels".to_owned();
        fault(file, FaultKind::TooLarge, cause, "make it smaller")
    };
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(broken)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    if width.saturating_mul(height) > PIXELS {
        return Err(large());
    }
    let mut data = vec![0; reader.output_buffer_size().ok_or_else(large)?];
    let frame = reader.next_frame(&mut data).map_err(broken)?;
    let wide = frame.bit_depth == png::BitDepth::Sixteen;
    let samples = frame.color_type.samples();
    let sample = |index: usize| {
        if wide {
            f64::from(u16::from_be_bytes([data[2 * index], data[2 * index + 1]])) / 65535.0
        } else {
            f64::from(data[index]) / 255.0
        }
    };
    let pixel = |index: usize| {
        let at = |k: usize| sample(index * samples + k);
        if samples < 3 {
            at(0)
        } else {
            0.2126 * at(0) + 0.7152 * at(1) + 0.0722 * at(2)
        }
    };
    Ok(Luminance {
        width,
        height,
        values: (0..width * height).map(pixel).collect(),
    })
}

/// Writes a PNG of 8 bits: `pixels` holds red, green and blue in sRGB, row by row
/// from the top. `texts` say what it is of: each a keyword such as "Title", of 1
/// to 79 Latin letters, and a text, kept as UTF-8 (chunk iTXt of the standard).
///
/// Cost: O(pixels).
///
/// # Panics
/// If there are not three bytes for each pixel, or no pixels, or a keyword is none.
pub fn write_png([width, height]: [u32; 2], pixels: &[u8], texts: &[(&str, String)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    for (keyword, text) in texts {
        encoder
            .add_itxt_chunk((*keyword).to_owned(), text.clone())
            .expect("a keyword");
    }
    let mut writer = encoder.write_header().expect("a size that is not zero");
    writer
        .write_image_data(pixels)
        .expect("three bytes for each pixel, and memory to write to");
    drop(writer);
    bytes
}

fn fault(file: &str, kind: FaultKind, cause: String, help: &str) -> IoError {
    IoError::Fault(Box::new(Fault {
        file: file.to_owned(),
        format: None,
        place: Place::File,
        kind,
        cause,
        help: help.to_owned(),
    }))
}

impl Luminance {
    /// The luminance at texture coordinates, bilinear between the middles of
    /// pixels; (0, 0) is the lower left corner and the picture repeats beyond
    /// 0..=1, as textures do. Any finite place has a value.
    pub fn at(&self, u: f64, v: f64) -> f64 {
        let (x, y) = (u - u.floor(), v - v.floor());
        // A picture that ends at 1 must not show its other edge there.
        let last = |place: f64, given: f64| {
            if place <= 0.0 && given > 0.0 {
                1.0
            } else {
                place
            }
        };
        let column = last(x, u) * self.width as f64 - 0.5;
        let row = (1.0 - last(y, v)) * self.height as f64 - 0.5;
        let pixel = |row: f64, column: f64| {
            let row = row.clamp(0.0, self.height as f64 - 1.0) as usize;
            let column = column.clamp(0.0, self.width as f64 - 1.0) as usize;
            self.values[row * self.width + column]
        };
        let (left, top) = (column.floor(), row.floor());
        let (s, t) = (column - left, row - top);
        let along = |row: f64| pixel(row, left) * (1.0 - s) + pixel(row, left + 1.0) * s;
        along(top) * (1.0 - t) + along(top + 1.0) * t
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(color: png::ColorType, width: u32, height: u32, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(color);
        encoder
            .write_header()
            .unwrap()
            .write_image_data(data)
            .unwrap();
        bytes
    }

    #[test]
    fn pictures_carry_texts_of_every_script() {
        let texts = [
            ("Title", "façade.ron".to_owned()),
            ("Parameters", "höhe = 3 m".to_owned()),
        ];
        let bytes = write_png([1, 1], &[1, 2, 3], &texts);
        let reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
        let chunks = &reader.info().utf8_text;
        let read = chunks
            .iter()
            .map(|chunk| (chunk.keyword.as_str(), chunk.get_text().unwrap()));
        assert!(read.eq(texts));
    }

    #[test]
    fn greys_are_read_from_the_top_and_sampled_from_the_bottom() {
        let bytes = encoded(png::ColorType::Grayscale, 2, 2, &[0, 255, 51, 102]);
        let picture = read_luminance(&bytes, "p.png").unwrap();
        for (u, v, expected) in [
            (0.25, 0.75, 0.0),
            (0.75, 0.75, 1.0),
            (0.25, 0.25, 0.2),
            (1.75, -0.75, 0.4),
            (0.5, 0.75, 0.5),
            (1.0, 1.0, 1.0),
            (0.0, 0.0, 0.2),
        ] {
            assert!((picture.at(u, v) - expected).abs() < 1e-12, "{u} {v}");
        }
    }

    #[test]
    fn colours_are_weighted_and_broken_files_named() {
        let bytes = encoded(png::ColorType::Rgba, 1, 1, &[255, 0, 0, 9]);
        let picture = read_luminance(&bytes, "p.png").unwrap();
        assert!((picture.at(0.3, 0.9) - 0.2126).abs() < 1e-12);
        for broken in [&bytes[..bytes.len() / 2], b"GIF89a", b""] {
            let error = read_luminance(broken, "p.png").unwrap_err().to_string();
            assert!(error.contains("p.png"), "{error}");
        }
    }
}
