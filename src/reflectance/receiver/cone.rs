//! The viewers within a receiver's cone, as unit squares for a rule, and the projected solid angle of those above the horizon.
//!
//! A viewer is kept as what it differs by from the mirror direction, in which a narrow lobe can be told from its neighbours.
//! Where a lobe is as wide as the cone or passes it by, the squares are polar coordinates around the axis. Where it is narrower
//! and in the cone or at its rim, they are polar coordinates around the mirror direction, evenly in asinh(δ/width): a lobe of any
//! width is then a bump of width 1.

mod squares;

use super::folds::{Cosines, Folds};
use crate::reflectance::degrees::{SinCos, to_radians};
use crate::reflectance::geometry::{FacetAngles, Geometry};
use crate::reflectance::numeric::elementary::hypotenuse;
use crate::reflectance::numeric::quadrature::{self, Integral};
use crate::reflectance::numeric::scaled::Scaled;
use crate::reflectance::quantity::{Azimuth, ReceiverHalfAngle, SourceZenith, ViewerZenith};
use core::f64::consts::{FRAC_PI_2, PI, TAU};

/// A lobe so many times as wide as the cone is smooth over it.
const WIDE: f64 = 4.0;
/// A lobe so far from the axis, over the cone's half angle, is smooth over it but for how it falls off.
const FAR: f64 = 1.5;
/// sin θ_i up to which the lobe is about the same all around the normal.
const EVEN: f64 = 0.02;
/// Steps of asinh(δ/width) that one square covers at most.
const STEP: f64 = 3.0;

/// The directions within some angle of a viewer's, and a source.
#[derive(Clone, Debug)]
pub(super) struct Cone {
    source: SinCos,
    /// Of θ_r, not negative, and of the azimuth at which it then is.
    axis: SinCos,
    azimuth: SinCos,
    /// β in radians, its sine and cosine.
    half_angle: f64,
    half: SinCos,
    /// Axis less mirror direction.
    offset: [f64; 3],
    /// The angle between them, its sine and cosine, and its bearing from the mirror direction, 0 away from the normal.
    distance: f64,
    apart: SinCos,
    bearing: f64,
    /// Whether it goes below the horizon.
    is_cut: bool,
    /// Whether it holds the mirror direction; none where rounding would decide.
    holds_mirror: Option<bool>,
    frame: Frame,
    squares: Vec<Square>,
}

#[derive(Clone, Copy, Debug)]
enum Frame {
    Axis,
    /// The lobe's width in the plane of incidence, radians, and cos θ_i, which its width across it goes with, not 0.
    Mirror {
        width: f64,
        across: f64,
    },
}

/// A range of the azimuth around the frame's pole, and a part of the way from its rim to the far one.
#[derive(Clone, Copy, Debug)]
struct Square {
    low: f64,
    high: f64,
    part: f64,
    parts: f64,
}

/// One ray of a frame from its pole.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    /// Its azimuth.
    towards: SinCos,
    /// Its beginning and its end, as the frame's coordinate.
    from: f64,
    to: f64,
    /// The lobe's width along it.
    width: f64,
    /// Where it meets the horizon.
    horizon: f64,
    /// d azimuth over the square's first side.
    stretch: f64,
}

/// One viewer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewer {
    /// cos θ_r dω over the square.
    pub(super) measure: f64,
    pub(super) geometry: Geometry,
}

impl Cone {
    /// Around a viewer; the lobe is about so wide in the plane of incidence, as the slope of its facets.
    pub(super) fn new(
        (theta_i, theta_r, phi_r): (SourceZenith, ViewerZenith, Azimuth),
        half_angle: ReceiverHalfAngle,
        slope: f64,
    ) -> Self {
        let (theta_i, theta_r, phi_r, beta) = (theta_i.get(), theta_r.get(), phi_r.get(), half_angle.get());
        let (source, axis) = (SinCos::of_degrees(theta_i), SinCos::of_degrees(theta_r.abs()));
        let (mut azimuth, mut half_azimuth) =
            (SinCos::of_degrees(phi_r), SinCos::of_degrees(0.5 * phi_r).sin);
        if theta_r < 0.0 {
            half_azimuth = SinCos::of_degrees(0.5 * phi_r).cos;
            azimuth = SinCos { sin: -azimuth.sin, cos: -azimuth.cos };
        }
        let half_sum = SinCos::of_degrees(0.5 * (theta_i + theta_r.abs()));
        let half_difference = SinCos::of_degrees(0.5 * (theta_r.abs() - theta_i)).sin;
        let offset = [
            2.0 * half_sum.cos * half_difference - 2.0 * axis.sin * half_azimuth * half_azimuth,
            axis.sin * azimuth.sin,
            -2.0 * half_sum.sin * half_difference,
        ];
        let chord = hypotenuse(hypotenuse(offset[0], offset[1]), offset[2]).min(2.0);
        let distance = 2.0 * libm::asin(0.5 * chord);
        let outwards = offset[0] * source.cos - offset[2] * source.sin;
        let mut cone = Self {
            source,
            axis,
            azimuth,
            half_angle: to_radians(beta),
            half: SinCos::of_degrees(beta),
            offset,
            distance,
            apart: SinCos::of_radians(distance),
            bearing: libm::atan2(offset[1], outwards),
            is_cut: theta_r.abs() + beta > 90.0,
            holds_mirror: if half_azimuth == 0.0 {
                Some(differ_by_less(theta_r.abs(), theta_i, beta))
            } else {
                let clear = 32.0 * f64::EPSILON * (distance + to_radians(beta));
                let margin = to_radians(beta) - distance;
                (margin.abs() > clear).then_some(margin > 0.0)
            },
            frame: Frame::Axis,
            squares: Vec::new(),
        };
        let width = 2.0 * slope;
        if width < WIDE * cone.half_angle && cone.distance < FAR * cone.half_angle {
            cone.frame = Frame::Mirror { width, across: source.cos.max(slope.min(1.0)) };
        }
        cone.squares = cone.cut();
        cone
    }

    /// Whether the mirror direction is in it, its rim included; none where rounding would decide.
    pub(super) fn holds_mirror(&self) -> Option<bool> {
        self.holds_mirror
    }

    /// How many squares.
    pub(super) fn squares(&self) -> usize {
        self.squares.len()
    }

    /// What rounding of the rim may add or take, over the integral of a lobe of that width.
    pub(super) fn rim(&self, slope: f64) -> f64 {
        let width = 2.0 * slope * self.source.cos.max(slope.min(1.0));
        let beyond = self.distance - self.half_angle;
        // A lobe that ends well within the cone does not meet the rim.
        if beyond < -40.0 * slope.max(1e-3 * self.half_angle) {
            return 0.0;
        }
        f64::EPSILON * 16.0 * (1.0 + beyond.abs() / width) * (self.distance + self.half_angle) / width
    }

    /// ∫ cos θ_r dω of what is above the horizon, with its relative error.
    pub(super) fn projected(&self) -> (Scaled, f64) {
        if !self.is_cut {
            return (Scaled::new(self.half.sin).squared() * PI * self.axis.cos, 16.0 * f64::EPSILON);
        }
        // By the height e above the horizon: the cone holds 2Δφ of azimuth there,
        // sin²(Δφ/2) = sin((β + e − e_c)/2) sin((β − e + e_c)/2)/(cos e cos e_c).
        let centre = libm::atan2(self.axis.cos, self.axis.sin);
        let top = centre + self.half_angle;
        let whole = if top > FRAC_PI_2 { PI - top } else { top };
        let strip = |e: f64| {
            let sines = libm::sin(0.5 * (self.half_angle + e - centre)) * libm::sin(0.5 * (top - e));
            let share = (sines / (libm::cos(e) * self.axis.sin)).clamp(0.0, 1.0);
            4.0 * libm::asin(share.sqrt()) * libm::sin(e) * libm::cos(e)
        };
        let around =
            if self.axis.sin == 0.0 { Integral::ZERO } else { quadrature::integrate(0.0, whole, strip) };
        let overhead = if top > FRAC_PI_2 { PI * libm::cos(whole).powi(2) } else { 0.0 };
        let value = around.value + overhead;
        (Scaled::new(value), around.error / value + 64.0 * f64::EPSILON)
    }

    /// The ray at a position along the first side of a square.
    pub(super) fn ray(&self, square: usize, position: f64) -> Ray {
        let Square { low, high, part, parts } = self.squares[square];
        let ray = self.ray_at(low + (high - low) * position);
        let step = (ray.to - ray.from) / parts;
        let from = ray.from + step * part;
        Ray { from, to: from + step, stretch: ray.stretch * (high - low), ..ray }
    }

    /// Whether the lobe is folded at some viewer, as far as can be seen on some rays of each square.
    pub(super) fn has(&self, folds: Folds) -> bool {
        let rays = (0..self.squares.len())
            .flat_map(|square| [0.0, 0.25, 0.5, 0.75, 1.0].map(|position| self.ray(square, position)));
        folds.are_there()
            && rays.into_iter().any(|ray| folds.are_on([ray.from, ray.to], |at| self.cosines(&ray, at)))
    }

    /// Whether folds go round the mirror direction, at one distance all around.
    pub(super) fn is_even(&self) -> bool {
        self.source.sin < EVEN
    }

    /// Where a ray is at a coordinate: the cosines of θ_i, θ_r, and of the angle between source and viewer.
    fn cosines(&self, ray: &Ray, coordinate: f64) -> Cosines {
        let SinCos { sin: sin_i, cos: cos_i } = self.source;
        let SinCos { sin: across, cos: outwards } = ray.towards;
        let (angle, at_pole, towards);
        match self.frame {
            Frame::Axis => {
                let SinCos { sin, cos } = self.axis;
                angle = coordinate;
                at_pole = cos_i * cos - sin_i * sin * self.azimuth.cos;
                towards = -outwards * (sin_i * cos * self.azimuth.cos + cos_i * sin)
                    + across * sin_i * self.azimuth.sin;
            }
            Frame::Mirror { .. } => {
                angle = ray.width * libm::sinh(coordinate);
                at_pole = (cos_i - sin_i) * (cos_i + sin_i);
                towards = -2.0 * sin_i * cos_i * outwards;
            }
        }
        let SinCos { sin, cos } = SinCos::of_radians(angle);
        Cosines {
            i: cos_i,
            r: self.swing(ray) * libm::sin(ray.horizon - angle),
            between: at_pole * cos + towards * sin,
        }
    }

    /// The largest cos θ_r on the great circle of a ray.
    fn swing(&self, ray: &Ray) -> f64 {
        let pole = match self.frame {
            Frame::Axis => self.axis,
            Frame::Mirror { .. } => self.source,
        };
        hypotenuse(pole.cos, pole.sin * ray.towards.cos)
    }

    fn ray_at(&self, position: f64) -> Ray {
        match self.frame {
            Frame::Axis => {
                let towards = SinCos::of_radians(position);
                let horizon = libm::atan2(self.axis.cos, self.axis.sin * towards.cos);
                let to = if self.is_cut { self.half_angle.min(horizon) } else { self.half_angle };
                Ray { towards, from: 0.0, to, width: 1.0, horizon, stretch: 1.0 }
            }
            Frame::Mirror { width, across } => self.ray_from_mirror(position, width, across),
        }
    }

    fn ray_from_mirror(&self, position: f64, width: f64, across: f64) -> Ray {
        // Rays from outside are spaced so that the first and the last graze the rim without a square root.
        let (around, stretch, grazing) = if self.surrounds() {
            let SinCos { sin, .. } = SinCos::of_radians(position);
            let sin = self.apart.sin * sin;
            (position, 1.0, ((self.half.sin - sin) * (self.half.sin + sin)).max(0.0).sqrt())
        } else {
            let SinCos { sin, cos } = SinCos::of_radians(position);
            let ratio = self.half.sin / self.apart.sin;
            let around = libm::asin(ratio * sin);
            (around, ratio * cos / libm::cos(around), self.half.sin * cos.max(0.0))
        };
        let towards = SinCos::of_radians(self.bearing + around);
        // The chord that the cone cuts out of the great circle: its middle and half its length.
        let middle = libm::atan2(self.apart.sin * libm::cos(around), self.apart.cos);
        // Behind the source it is beyond the antipode rather than before the beginning.
        let middle = if self.apart.cos < 0.0 && middle < 0.0 { middle + TAU } else { middle };
        let half = libm::atan2(grazing, self.half.cos);
        let horizon = libm::atan2(self.source.cos, self.source.sin * towards.cos);
        let far = (middle + half).min(horizon).max(0.0);
        let near =
            if self.surrounds() && self.apart.cos > 0.0 { 0.0 } else { (middle - half).clamp(0.0, far) };
        let width = width * across / hypotenuse(towards.cos * across, towards.sin);
        let coordinate = |delta: f64| libm::asinh(delta / width);
        Ray { towards, from: coordinate(near), to: coordinate(far), width, horizon, stretch }
    }

    /// The viewer at a position along a ray; none below the horizon.
    pub(super) fn viewer(&self, ray: &Ray, position: f64) -> Option<Viewer> {
        let coordinate = ray.from + (ray.to - ray.from) * position;
        let along = (ray.to - ray.from) * ray.stretch;
        let SinCos { sin: towards_sin, cos: towards_cos } = ray.towards;
        let (moved, sin, cos_r, length);
        match self.frame {
            Frame::Axis => {
                let half = libm::sin(0.5 * coordinate);
                let less = 2.0 * half * half;
                sin = libm::sin(coordinate);
                let (across, outwards) = (sin * towards_sin, sin * towards_cos);
                let SinCos { sin: axis_sin, cos: axis_cos } = self.axis;
                let level = axis_cos * outwards - less * axis_sin;
                moved = [
                    self.offset[0] + self.azimuth.cos * level - self.azimuth.sin * across,
                    self.offset[1] + self.azimuth.sin * level + self.azimuth.cos * across,
                ];
                cos_r = self.swing(ray) * libm::sin(ray.horizon - coordinate);
                length = along;
            }
            Frame::Mirror { .. } => {
                let delta = ray.width * libm::sinh(coordinate);
                let half = libm::sin(0.5 * delta);
                let less = 2.0 * half * half;
                sin = libm::sin(delta);
                moved = [sin * towards_cos * self.source.cos - less * self.source.sin, sin * towards_sin];
                cos_r = self.swing(ray) * libm::sin(ray.horizon - delta);
                length = along * ray.width * libm::cosh(coordinate);
            }
        }
        let measure = sin * length * cos_r;
        // Not a number where a ray has no length.
        (cos_r > 0.0 && measure > 0.0).then(|| Viewer { measure, geometry: self.geometry(moved, cos_r) })
    }

    /// Of a viewer that differs from the mirror direction by this in the plane.
    fn geometry(&self, [along, across]: [f64; 2], cos_r: f64) -> Geometry {
        let horizontal = hypotenuse(along, across);
        let cos_sum = self.source.cos + cos_r;
        let length = hypotenuse(horizontal, cos_sum);
        let azimuth = if horizontal > 0.0 {
            SinCos { sin: across.abs() / horizontal, cos: -along / horizontal }
        } else {
            SinCos { sin: 0.0, cos: 1.0 }
        };
        Geometry::of_facet(&FacetAngles {
            source: self.source,
            slope: SinCos { sin: horizontal / length, cos: cos_sum / length },
            azimuth,
            cos_local: 0.5 * length,
            cos_r,
        })
    }

    /// Of the viewer in it that is closest to the mirror direction, or nearly.
    pub(super) fn nearest(&self) -> Geometry {
        if self.distance <= self.half_angle {
            return self.geometry([0.0, 0.0], self.source.cos);
        }
        let delta = self.distance - self.half_angle;
        let half = libm::sin(0.5 * delta);
        let (less, sin) = (2.0 * half * half, libm::sin(delta));
        let towards = SinCos::of_radians(self.bearing);
        let moved = [sin * towards.cos * self.source.cos - less * self.source.sin, sin * towards.sin];
        let cos_r = self.source.cos * libm::cos(delta) - self.source.sin * sin * towards.cos;
        self.geometry(moved, cos_r.max(f64::MIN_POSITIVE))
    }
}

/// Whether |`a` − `b`| ≤ `limit`, exactly.
fn differ_by_less(a: f64, b: f64, limit: f64) -> bool {
    let (large, small) = if a > b { (a, b) } else { (b, a) };
    let difference = large - small;
    // What rounding took from it.
    let virtual_small = large - difference;
    let rest = (large - (difference + virtual_small)) + (virtual_small - small);
    difference < limit || difference == limit && rest <= 0.0
}
