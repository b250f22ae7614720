//! Radiometry of the sensor, (42)-(46) and (51).

use super::degrees::SinCos;
use super::quantity::{Area, Length, OffAxis};

/// (z/f)² `dA_im` cos γ of (43), square micrometres: what a pixel sees of a plane that faces it.
pub fn footprint(pixel_area: Area, distance: Length, focal_length: Length, off_axis: OffAxis) -> f64 {
    let magnification = distance.get() / focal_length.get();
    magnification * magnification * pixel_area.get() * SinCos::of_degrees(off_axis.get()).cos
}
