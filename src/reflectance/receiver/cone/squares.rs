//! How the viewers of a cone are cut into squares, on whose edges horizon and rim lie.

use super::{Cone, Frame, STEP, Square};
use crate::reflectance::degrees::SinCos;
use core::f64::consts::{FRAC_PI_2, PI, TAU};

impl Cone {
    /// The frame's azimuths between which the rim is smooth, and the squares between them.
    pub(super) fn cut(&self) -> Vec<Square> {
        let mut edges = match self.frame {
            Frame::Axis => {
                let mut edges: Vec<f64> = (0..=4).map(|i| FRAC_PI_2 * f64::from(i) - PI).collect();
                if self.is_cut {
                    let cot = self.half.cos * self.axis.cos / (self.half.sin * self.axis.sin);
                    let meets = libm::acos(cot.clamp(-1.0, 1.0));
                    edges.extend([-meets, meets]);
                }
                edges
            }
            Frame::Mirror { .. } => {
                let mut edges: Vec<f64> = if self.surrounds() {
                    (0..=4).map(|i| FRAC_PI_2 * f64::from(i) - PI).collect()
                } else {
                    vec![-FRAC_PI_2, 0.0, FRAC_PI_2]
                };
                if self.is_cut {
                    edges.extend(self.horizon_meets_rim());
                }
                edges
            }
        };
        edges.sort_by(f64::total_cmp);
        edges.dedup_by(|next, before| *next - *before < 1e-12);
        let mut squares = Vec::new();
        for pair in edges.windows(2) {
            let &[low, high] = pair else { continue };
            let parts = self.parts(low, high);
            let of_part = |part| Square { low, high, part: f64::from(part), parts: f64::from(parts) };
            squares.extend((0..parts).map(of_part));
        }
        squares
    }

    /// Whether rays in all directions from the mirror direction, or from its antipode, meet the cone.
    pub(super) fn surrounds(&self) -> bool {
        self.half.sin >= self.apart.sin
    }

    /// Where rim and horizon meet, by the first coordinate of the mirror's frame.
    fn horizon_meets_rim(&self) -> Vec<f64> {
        let cos = self.half.cos / self.axis.sin;
        if cos > 1.0 {
            return Vec::new();
        }
        let away = libm::acos(cos);
        let axis = libm::atan2(self.azimuth.sin, self.azimuth.cos);
        let towards = [axis - away, axis + away].map(SinCos::of_radians);
        let found = towards.map(|towards| {
            let around = libm::atan2(towards.sin, towards.cos * self.source.cos) - self.bearing;
            let around = around - TAU * (around / TAU).round();
            if self.surrounds() {
                around
            } else {
                libm::asin((libm::sin(around) * self.apart.sin / self.half.sin).clamp(-1.0, 1.0))
            }
        });
        found.to_vec()
    }

    /// In how many parts rays between two azimuths are cut.
    fn parts(&self, low: f64, high: f64) -> u32 {
        if matches!(self.frame, Frame::Axis) {
            return 1;
        }
        let longest = [0.0, 0.25, 0.5, 0.75, 1.0]
            .map(|share| self.ray_at(low + (high - low) * share))
            .into_iter()
            .fold(0.0, |longest: f64, ray| longest.max(ray.to - ray.from));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to some 30")]
        let parts = (longest / STEP).ceil() as u32;
        parts.max(1)
    }
}
