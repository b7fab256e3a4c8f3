//! How much of a part of a picture has a colour.

use image::{Rgb, RgbImage};

/// What counts as a colour.
#[derive(Clone, Copy, Debug)]
pub struct Colour {
    /// From and to, in degrees; it may wrap around 360.
    pub hue: [f32; 2],
    /// From and to, of 1.
    pub saturation: [f32; 2],
}

/// Share of the pixels of a region that have a colour. The region is left, top, right and bottom as fractions of the
/// picture.
pub fn share(picture: &RgbImage, [left, top, right, bottom]: [f32; 4], colour: Colour) -> f32 {
    let (width, height) = (picture.width() as f32, picture.height() as f32);
    let columns = (left * width) as u32..(right * width) as u32;
    let rows = (top * height) as u32..(bottom * height) as u32;
    let total = columns.len() * rows.len();
    let matching = rows
        .flat_map(|row| columns.clone().map(move |column| (column, row)))
        .filter(|&(column, row)| colour.is_of(picture.get_pixel(column, row)))
        .count();
    matching as f32 / total.max(1) as f32
}

impl Colour {
    fn is_of(&self, pixel: &Rgb<u8>) -> bool {
        let (hue, saturation) = hue_and_saturation(pixel.0.map(f32::from));
        let [hue_from, hue_to] = self.hue;
        let hue_fits =
            if hue_from <= hue_to { (hue_from..=hue_to).contains(&hue) } else { hue >= hue_from || hue <= hue_to };
        let [saturation_from, saturation_to] = self.saturation;
        hue_fits && (saturation_from..=saturation_to).contains(&saturation)
    }
}

/// Hue in degrees and saturation from 0 to 1, as in the HSV colour model.
fn hue_and_saturation([red, green, blue]: [f32; 3]) -> (f32, f32) {
    let largest = red.max(green).max(blue);
    let range = largest - red.min(green).min(blue);
    if range == 0.0 {
        return (0.0, 0.0);
    }
    let sixths = if largest == red {
        (green - blue) / range
    } else if largest == green {
        (blue - red) / range + 2.0
    } else {
        (red - green) / range + 4.0
    };
    ((60.0 * sixths).rem_euclid(360.0), range / largest)
}
