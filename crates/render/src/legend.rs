//! What the colours of a field mean, under the picture.

use std::convert::Infallible;

use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::iso_8859_1::FONT_9X18;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::text::{Alignment, Text};
use tessgraph_io::viridis;

use crate::{Picture, light};

/// A bar of colours and its numbers.
pub(crate) struct Legend {
    pub(crate) title: String,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

/// Rows that a legend takes at the scale of 1.
const ROOM: u32 = 74;

/// The colour of the writing.
const INK: Rgb888 = Rgb888::new(40, 40, 40);

/// How many pixels a dot of the writing is wide.
fn scale(size: [u32; 2]) -> u32 {
    (size[0].min(size[1]) / 700).max(1)
}

/// The rows that a legend takes of a picture; none if it is too small for one.
pub(crate) fn room(size: [u32; 2]) -> u32 {
    let room = ROOM * scale(size);
    if size[1] < 3 * room || size[0] < 240 {
        0
    } else {
        room
    }
}

/// A picture in dots of several pixels.
struct Dots<'a> {
    picture: &'a mut Picture,
    scale: i32,
    /// The dot of the picture's pixel (0, y) that counts as row 0.
    top: i32,
}

impl Dots<'_> {
    fn dot(&mut self, x: i32, y: i32, color: [u8; 3]) {
        for k in 0..self.scale * self.scale {
            let (dx, dy) = (k % self.scale, k / self.scale);
            self.picture
                .set(x * self.scale + dx, self.top + y * self.scale + dy, color);
        }
    }
}

impl OriginDimensions for Dots<'_> {
    fn size(&self) -> Size {
        Size::new(self.picture.size[0] / self.scale as u32, ROOM)
    }
}

impl DrawTarget for Dots<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        for Pixel(at, color) in pixels {
            self.dot(at.x, at.y, [color.r(), color.g(), color.b()]);
        }
        Ok(())
    }
}

impl Legend {
    /// Draws itself into the lowest `room` rows.
    pub(crate) fn draw(&self, picture: &mut Picture, room: u32) {
        if room == 0 {
            return;
        }
        let scale = scale(picture.size) as i32;
        let top = (picture.size[1] - room) as i32;
        let mut dots = Dots {
            picture,
            scale,
            top,
        };
        let width = dots.size().width as i32;
        let (left, length) = (24, (width - 48).min(420));
        for x in 0..length {
            let along = f64::from(x) / f64::from(length - 1);
            let color = light::srgb(viridis(along));
            (28..40).for_each(|y| dots.dot(left + x, y, color));
        }
        let style = MonoTextStyle::new(&FONT_9X18, INK);
        let mut write = |text: &str, x: i32, y: i32, alignment: Alignment| {
            let text = Text::with_alignment(text, Point::new(x, y), style, alignment);
            let Ok(_) = text.draw(&mut dots);
        };
        write(&self.title, left, 18, Alignment::Left);
        write(&short(self.low), left, 58, Alignment::Left);
        if length >= 360 {
            let middle = self.low / 2.0 + self.high / 2.0;
            write(&short(middle), left + length / 2, 58, Alignment::Center);
        }
        write(&short(self.high), left + length, 58, Alignment::Right);
    }
}

/// A number in four digits.
pub(crate) fn short(number: f64) -> String {
    let size = number.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{number:.3e}");
    }
    // Digits before the point take from those after it.
    let before = format!("{size:.0}").len();
    let after = 4_usize.saturating_sub(if size < 1.0 { 0 } else { before });
    let text = format!("{number:.after$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
