//! Source and viewer as the models need them: cosines, the half vector and the wave vector
//! v = k₁ − k₂ of (28), each in a form in which nothing cancels.

pub(super) mod lanes;

use super::degrees::SinCos;
use super::numeric::elementary::hypotenuse;
use super::quantity::{Azimuth, SourceZenith, ViewerZenith};

/// What a geometry is made of.
#[derive(Clone, Copy, Debug)]
struct Sines {
    /// Of `θ_i`
    source: SinCos,
    /// Of |`θ_r`|
    viewer: SinCos,
    /// Of (`θ_i` − |`θ_r`|)/2
    half_difference: SinCos,
    /// Of `φ_r`/2
    half_azimuth: SinCos,
    /// Of `φ_r`
    azimuth: SinCos,
    /// `θ_r` < 0
    behind: bool,
}

/// A viewer by the facet that mirrors the source to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct FacetAngles {
    /// Of `θ_i`
    pub(super) source: SinCos,
    /// Of α
    pub(super) slope: SinCos,
    /// Of the azimuth of the facet's normal: 0 leans towards the source, between 0 and 180° to positive `φ_r`.
    pub(super) azimuth: SinCos,
    /// cos `θ′`
    pub(super) cos_local: f64,
    /// cos `θ_r`, not negative but for rounding
    pub(super) cos_r: f64,
}

/// One pair of directions. The source lies at azimuth 180° of the x axis' half plane, so that
/// azimuth 0 of the viewer holds the mirror direction, as in figure 7.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometry {
    /// cos `θ_i`
    pub cos_i: f64,
    /// sin `θ_i`
    pub sin_i: f64,
    /// cos `θ_r`
    pub cos_r: f64,
    /// sin `θ_r`, not negative
    pub sin_r: f64,
    /// sin and cos of (`θ_i` − `θ_r`)/2
    half_difference: SinCos,
    /// sin and cos of `φ_r`/2
    half_azimuth: SinCos,
    /// cos `φ_r`
    cos_azimuth: f64,
    /// q = cos `θ_i` + cos `θ_r` = |v_z|/k
    pub cos_sum: f64,
    /// sin `θ_i` − sin `θ_r` = q tan((`θ_i` − `θ_r`)/2)
    sin_difference: f64,
    /// `v_xy`/k of (37) = q tan α
    pub horizontal: f64,
}

impl Geometry {
    /// From angles in degrees.
    pub fn new(theta_i: SourceZenith, theta_r: ViewerZenith, phi_r: Azimuth) -> Self {
        let (theta_i, theta_r, phi_r) = (theta_i.get(), theta_r.get(), phi_r.get());
        Self::of_sines(&Sines {
            source: SinCos::of_degrees(theta_i),
            viewer: SinCos::of_degrees(theta_r.abs()),
            half_difference: SinCos::of_degrees((theta_i - theta_r.abs()) / 2.0),
            half_azimuth: SinCos::of_degrees(phi_r / 2.0),
            azimuth: SinCos::of_degrees(phi_r),
            behind: theta_r < 0.0,
        })
    }

    /// From sines and cosines of the angles.
    #[inline(always)]
    fn of_sines(sines: &Sines) -> Self {
        let Sines { source, viewer, half_difference, half_azimuth, azimuth, behind } = *sines;
        // The same zenith at φ_r + 180°: half of it is φ_r/2 + 90°, exactly.
        let turned = SinCos { sin: half_azimuth.cos, cos: -half_azimuth.sin };
        let half_azimuth = SinCos {
            sin: if behind { turned.sin } else { half_azimuth.sin },
            cos: if behind { turned.cos } else { half_azimuth.cos },
        };
        let cos_azimuth = if behind { -azimuth.cos } else { azimuth.cos };
        Self::from_parts(source, viewer, half_difference, half_azimuth, cos_azimuth)
    }

    /// From angles in radians, taken as the exact doubles; `θ_i` may exceed π/2 (a source behind).
    pub fn from_radians(theta_i: f64, theta_r: f64, phi_r: f64) -> Self {
        Self::from_parts(
            SinCos::of_radians(theta_i),
            SinCos::of_radians(theta_r),
            SinCos::of_radians((theta_i - theta_r) / 2.0),
            SinCos::of_radians(phi_r / 2.0),
            SinCos::of_radians(phi_r).cos,
        )
    }

    /// From source and facet. Error of v/k and its parts below 32 ε of their terms and those of the angles.
    pub(super) fn of_facet(angles: &FacetAngles) -> Self {
        let &FacetAngles { source, slope, azimuth, cos_local, .. } = angles;
        let cos_r = angles.cos_r.max(0.0);
        let sin_r = ((1.0 - cos_r) * (1.0 + cos_r)).max(0.0).sqrt();
        let cos_sum = 2.0 * cos_local * slope.cos;
        // cos θ_r − cos θ_i, whose product with the sum is that of sin θ_i − sin θ_r with theirs.
        let cos_difference =
            2.0 * slope.sin * (source.sin * slope.cos * azimuth.cos - source.cos * slope.sin);
        let sin_sum = source.sin + sin_r;
        let sin_difference = if sin_sum > 0.0 { cos_difference * (cos_sum / sin_sum) } else { 0.0 };
        let half = hypotenuse(sin_difference, cos_sum);
        let half_difference = SinCos { sin: sin_difference / half, cos: cos_sum / half };
        let along = source.sin - 2.0 * cos_local * slope.sin * azimuth.cos;
        let across = 2.0 * cos_local * slope.sin * azimuth.sin;
        let (cos_azimuth, sin_azimuth) = if sin_r > 0.0 {
            ((along / sin_r).clamp(-1.0, 1.0), (across / sin_r).clamp(0.0, 1.0))
        } else {
            (1.0, 0.0)
        };
        // The larger of the two by its root, the other by their product.
        let larger = (0.5 * (1.0 + cos_azimuth.abs())).sqrt();
        let smaller = 0.5 * sin_azimuth / larger;
        let half_azimuth = if cos_azimuth < 0.0 {
            SinCos { sin: larger, cos: smaller }
        } else {
            SinCos { sin: smaller, cos: larger }
        };
        Self {
            cos_i: source.cos,
            sin_i: source.sin,
            cos_r,
            sin_r,
            half_difference,
            half_azimuth,
            cos_azimuth,
            cos_sum,
            sin_difference,
            horizontal: 2.0 * cos_local * slope.sin,
        }
    }

    #[inline(always)]
    fn from_parts(
        i: SinCos,
        r: SinCos,
        half_difference: SinCos,
        half_azimuth: SinCos,
        cos_azimuth: f64,
    ) -> Self {
        let cos_sum = i.cos + r.cos;
        let sin_difference = cos_sum * (half_difference.sin / half_difference.cos);
        let across = 2.0 * i.sin.sqrt() * r.sin.sqrt() * half_azimuth.sin;
        Self {
            cos_i: i.cos,
            sin_i: i.sin,
            cos_r: r.cos,
            sin_r: r.sin,
            half_difference,
            half_azimuth,
            cos_azimuth,
            cos_sum,
            sin_difference,
            horizontal: hypotenuse(sin_difference, across),
        }
    }

    /// v_x/k of (28): sin `θ_i` − sin `θ_r` cos `φ_r`.
    pub fn along(&self) -> f64 {
        let (front, back) = self.along_parts();
        front + back
    }

    /// v_x/k as two terms that may cancel: sin `θ_i` and −sin `θ_r` cos `φ_r`, or sin `θ_i` − sin `θ_r` and
    /// 2 sin `θ_r` sin²(`φ_r`/2), whichever cancel less.
    pub(super) fn along_parts(&self) -> (f64, f64) {
        let apart = (self.sin_i, -self.sin_r * self.cos_azimuth);
        let close = (self.sin_difference, 2.0 * self.sin_r * self.half_azimuth.sin * self.half_azimuth.sin);
        let size = |(a, b): (f64, f64)| a.abs() + b.abs();
        if size(apart) <= size(close) { apart } else { close }
    }

    /// v_y/k of (28) with the report's sign (errata E12: only its magnitude matters).
    pub fn across(&self) -> f64 {
        2.0 * self.sin_r * self.half_azimuth.sin * self.half_azimuth.cos
    }

    /// 2 cos `θ′`: the length of v/k.
    #[inline(always)]
    pub fn length(&self) -> f64 {
        hypotenuse(self.cos_sum, self.horizontal)
    }

    /// q (1 + tan² α) = 4 cos² `θ′`/q; `D` of (36) is this over 2 cos `θ_i`.
    pub fn facet_factor(&self) -> f64 {
        let length = self.length();
        length * (length / self.cos_sum)
    }

    /// D of (36); infinite at `θ_i` = 90°.
    pub fn d(&self) -> f64 {
        self.facet_factor() / (2.0 * self.cos_i)
    }

    /// tan α of (76), the slope of the facet that mirrors the source to the viewer.
    pub fn tan_alpha(&self) -> f64 {
        self.horizontal / self.cos_sum
    }

    /// α in radians, by the half vector instead of (60) (errata E33).
    pub fn alpha(&self) -> f64 {
        libm::atan2(self.horizontal, self.cos_sum)
    }

    /// sin and cos of `θ′`, the local angle of incidence (59).
    #[inline(always)]
    pub fn local_incidence(&self) -> SinCos {
        SinCos {
            sin: hypotenuse(
                self.half_difference.sin,
                self.sin_i.max(0.0).sqrt() * self.sin_r.sqrt() * self.half_azimuth.cos,
            ),
            cos: 0.5 * self.length(),
        }
    }

    /// `θ′` of (59) in radians.
    pub fn theta_local(&self) -> f64 {
        let SinCos { sin, cos } = self.local_incidence();
        libm::atan2(sin, cos)
    }

    /// Whether the viewer stands in the mirror direction, `θ_r` = `θ_i` and `φ_r` = 0.
    pub fn is_specular(&self) -> bool {
        self.horizontal == 0.0 && self.half_difference.sin == 0.0
    }
}
