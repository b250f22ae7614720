//! The hemisphere of viewers in the coordinates of the facets that mirror the source to them, mapped to unit squares.
//!
//! A facet has the slope angle α and the azimuth ψ, 0 where it leans towards the source. With dω_r = 4 cos θ′ dω and
//! dω = sin α dα dψ, the integral over ln tan α is one in which a lobe of any width is a bump of width 1: none is so narrow
//! that it could be missed. ψ is counted from where the mirrored light grazes the surface, again in steps that grow with
//! the distance from there, because near a grazing source cos θ′ changes by decades.
//!
//! The squares end where the integrand has a kink or a square root: where the circle of azimuths meets the horizon, where
//! G of (65) changes its branch, at the critical angle.

use crate::reflectance::degrees::SinCos;
use crate::reflectance::geometry::{FacetAngles, Geometry};
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Facets steeper than this have a solid angle below 1e-20 (a grazing source has no steepest one).
const STEEPEST: f64 = 1e20;
/// What a square covers of the logarithm of the distance from the horizon: a factor of 8.
const DECADE: f64 = 2.08;
/// The logarithm ends at this share of the circle, where cos³ θ′ leaves nothing of any lobe.
const NEAREST: f64 = 1e-12;
/// Steps of ln tan α at the lobe's width, and far from it.
const FINE: f64 = 1.0;
const COARSE: f64 = 4.0;

/// The slopes of a lobe, as tan α.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// About so wide it is.
    pub(super) width: f64,
    /// Nothing of what multiplies it changes within less, next to the level facets; 1 at most.
    pub(super) finest: f64,
    /// Nothing of it is beyond.
    pub(super) end: f64,
}

/// Where an integrand is not smooth.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Kinks {
    /// G of (65).
    pub(super) grooves: bool,
    /// cos of the critical angle, where F′ has a square root.
    pub(super) critical: Option<f64>,
}

impl Kinks {
    fn count(self) -> usize {
        3 * usize::from(self.grooves) + usize::from(self.critical.is_some())
    }
}

/// The facets that mirror one source to the viewers.
#[derive(Clone, Debug)]
pub(super) struct Hemisphere {
    source: SinCos,
    /// 90° − θ_i in radians.
    complement: f64,
    kinks: Kinks,
    squares: Vec<Square>,
}

/// A range of slopes and a range of azimuths.
#[derive(Clone, Copy, Debug)]
struct Square {
    slopes: Span,
    /// Which interval between two kinks.
    interval: usize,
    /// Which part of it, of how many.
    part: u32,
    parts: u32,
}

/// A range of tan α.
#[derive(Clone, Copy, Debug)]
struct Span {
    /// 0: the whole range is linear in tan α, otherwise in its logarithm.
    low: f64,
    high: f64,
    /// Which ends may have a square root.
    soft: [bool; 2],
    /// Whether the facets mirror the light upwards at every azimuth.
    is_full: bool,
}

/// Facets of one slope.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    /// Of α.
    pub(super) slope: SinCos,
    /// d ln tan α over the square's first side.
    stretch: f64,
    source: SinCos,
    /// The least cos θ′, and what times cos ψ it varies by.
    least: f64,
    amplitude: f64,
    /// cos θ_r at the least cos θ′.
    lowest: f64,
    /// Largest |ψ|.
    end: f64,
    end_sines: SinCos,
    azimuths: Interval,
    /// Beginning and length of the square's part of the interval.
    part: [f64; 2],
    /// Whether its ends may have a square root.
    soft: [bool; 2],
}

/// Azimuths between two kinks as `end` − |ψ|: evenly in ln(`scale` + distance from the first).
#[derive(Clone, Copy, Debug)]
struct Interval {
    low: f64,
    length: f64,
    scale: f64,
    /// ln(1 + `length`/`scale`)
    decades: f64,
}

/// One facet, and the one mirrored at the plane of incidence.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    /// d(ln tan α) dψ of both over the square: times sin² α cos α the solid angle of their normals.
    pub(super) measure: f64,
    /// cos θ′
    pub(super) cos_local: f64,
    /// cos θ_r of the viewer, above 0 but for rounding.
    pub(super) cos_r: f64,
    azimuth: SinCos,
}

impl Hemisphere {
    /// Of a source.
    pub(super) fn new(source: SinCos, extent: &Extent, kinks: Kinks) -> Self {
        let complement = libm::atan2(source.cos, source.sin);
        let mut hemisphere = Self { source, complement, kinks, squares: Vec::new() };
        for slopes in hemisphere.spans(extent) {
            for interval in 0..=kinks.count() {
                let parts = hemisphere.parts(&slopes, interval);
                let of_part = |part| Square { slopes, interval, part, parts };
                hemisphere.squares.extend((0..parts).map(of_part));
            }
        }
        hemisphere
    }

    /// How many squares.
    pub(super) fn squares(&self) -> usize {
        self.squares.len()
    }

    /// Slopes at which the integral over the azimuths is not smooth, ascending, the last one the steepest there is.
    fn breaks(&self, end: f64) -> Vec<f64> {
        let complement = self.complement;
        let theta_i = FRAC_PI_2 - complement;
        let steepest = (1.0 / libm::tan(0.5 * complement)).min(STEEPEST);
        // The first slope whose light grazes the surface.
        let mut breaks = vec![libm::tan(0.5 * complement)];
        if self.kinks.grooves {
            // Where the branches of G meet each other, the plane of incidence, or the horizon.
            let angles =
                [complement / 3.0, (PI - complement) / 3.0, complement, theta_i, FRAC_PI_4, PI / 3.0];
            breaks.extend(angles.map(libm::tan));
            // The one of masking goes round the ring like 1/(60° − α), within the source's height of 60°.
            let mut before = 0.25;
            while before > complement / 3.0 {
                breaks.push(libm::tan(PI / 3.0 - before));
                before /= 6.0;
            }
        }
        if let Some(cos) = self.kinks.critical {
            let critical = libm::acos(cos);
            let angle_of = |cos: f64| libm::acos(cos.min(1.0));
            let source = self.source.cos;
            let mut angles =
                vec![(theta_i - critical).abs(), theta_i + critical, angle_of(0.5 * source / cos)];
            if self.kinks.grooves {
                // Where the critical angle meets the branches of G.
                let masked = 0.25 * (source + libm::hypot(source, 2.0 * cos)) / cos;
                angles.extend([0.5 * cos / source, source / cos, masked].map(angle_of));
            }
            breaks.extend(angles.into_iter().filter(|&angle| angle < FRAC_PI_2).map(libm::tan));
        }
        let last = steepest.min(end);
        breaks.retain(|&slope| slope > 1e-3 / STEEPEST && slope < last * (1.0 - 1e-9));
        breaks.push(last);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|next, before| *next < *before * (1.0 + 1e-9));
        breaks
    }

    fn spans(&self, &Extent { width, finest, end }: &Extent) -> Vec<Span> {
        let grazing = libm::tan(0.5 * self.complement);
        let focus = libm::log(width);
        let mut spans = Vec::new();
        let mut low = 0.0;
        let mut after_break = false;
        for high in self.breaks(end) {
            let is_full = high <= grazing * (1.0 + 1e-9);
            if low == 0.0 {
                let first = high.min(0.5 * width.min(finest));
                spans.push(Span { low, high: first, soft: [false, first == high], is_full });
                low = first;
                after_break = first == high;
            }
            while low < high {
                let (from, to) = (libm::log(low), libm::log(high));
                let step = (0.5 * (from - focus).abs()).clamp(FINE, COARSE);
                let next = if to - from < 1.5 * step { high } else { low * libm::exp(step) };
                spans.push(Span { low, high: next, soft: [after_break, next == high], is_full });
                low = next;
                after_break = next == high;
            }
        }
        spans
    }

    /// In how many parts an interval of azimuths is cut, so that each covers no more than [`DECADE`].
    fn parts(&self, slopes: &Span, interval: usize) -> u32 {
        let low = if slopes.low == 0.0 { 1e-3 * slopes.high } else { slopes.low };
        let most = [0.0, 0.25, 0.5, 0.75, 1.0]
            .map(|share| {
                let ring = self.ring_of(low * libm::pow(slopes.high / low, share), slopes.is_full);
                self.interval(&ring, interval).decades
            })
            .into_iter()
            .fold(0.0, f64::max);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 14")]
        let parts = (most / DECADE - 0.05).ceil() as u32;
        parts.max(1)
    }

    /// An interval between two kinks of a ring.
    fn interval(&self, ring: &Ring, interval: usize) -> Interval {
        let count = self.kinks.count();
        let mut kinks = self.kinks_of(ring);
        kinks[..count].sort_by(f64::total_cmp);
        let low = if interval == 0 { 0.0 } else { kinks[interval - 1] };
        let high = if interval == count { ring.end } else { kinks[interval] };
        // cos θ′ changes by a factor within this distance.
        let scale = (ring.least / ring.amplitude + low).max(NEAREST * ring.end);
        let decades = libm::log1p((high - low) / scale);
        Interval { low, length: high - low, scale, decades }
    }

    /// The facets at one position along the first side of a square.
    pub(super) fn ring(&self, square: usize, position: f64) -> Ring {
        let Square { slopes, interval, part, parts } = self.squares[square];
        let (rest, derivative) = eased(position, slopes.soft);
        let (slope, stretch) = if slopes.low == 0.0 {
            (slopes.high * rest, derivative / rest)
        } else {
            let length = libm::log(slopes.high / slopes.low);
            (slopes.low * libm::exp(length * rest), length * derivative)
        };
        let ring = self.ring_of(slope, slopes.is_full);
        let azimuths = self.interval(&ring, interval);
        let is_soft = self.kinks.critical.is_some();
        let soft = [
            is_soft && interval > 0 && part == 0,
            is_soft && interval < self.kinks.count() && part + 1 == parts,
        ];
        let share = 1.0 / f64::from(parts);
        Ring { stretch, azimuths, part: [share * f64::from(part), share], soft, ..ring }
    }

    fn ring_of(&self, slope: f64, is_full: bool) -> Ring {
        let source = self.source;
        let cos = 1.0 / libm::hypot(1.0, slope);
        let slope = SinCos { sin: if slope > 1e10 { 1.0 } else { slope * cos }, cos };
        let angle = libm::atan2(slope.sin, slope.cos);
        let (least, lowest, end, end_sines);
        if is_full {
            least = libm::sin(self.complement - angle);
            lowest = libm::sin(self.complement - 2.0 * angle).max(0.0);
            (end, end_sines) = (PI, SinCos { sin: 0.0, cos: -1.0 });
        } else {
            // cos ψ > −cot θ_i cot 2α, and 1 ± that in forms in which nothing cancels.
            least = 0.5 * source.cos / slope.cos;
            lowest = 0.0;
            // sin(2α ∓ 90° ± θ_i), of steep facets by what their slope lacks of 90°.
            let (above, below) = if slope.sin > slope.cos {
                let rest = libm::atan2(slope.cos, slope.sin);
                (2.0 * rest + self.complement, 2.0 * rest - self.complement)
            } else {
                (2.0 * angle - self.complement, 2.0 * angle + self.complement)
            };
            let (above, below) = (libm::sin(above).max(0.0), libm::sin(below).max(0.0));
            let half = SinCos { sin: below.sqrt(), cos: above.sqrt() };
            let whole = below + above;
            end = 2.0 * libm::atan2(half.sin, half.cos);
            end_sines = SinCos { sin: 2.0 * half.sin * half.cos / whole, cos: (above - below) / whole };
        }
        Ring {
            slope,
            stretch: 1.0,
            source,
            least,
            amplitude: source.sin * slope.sin,
            lowest,
            end,
            end_sines,
            azimuths: Interval { low: 0.0, length: end, scale: f64::INFINITY, decades: 0.0 },
            part: [0.0, 1.0],
            soft: [false; 2],
        }
    }

    /// Where on a ring the integrand has kinks, as `end` − |ψ|; `end` or 0 where a kink is not on the ring.
    fn kinks_of(&self, ring: &Ring) -> [f64; 4] {
        let SinCos { cos, .. } = ring.slope;
        let at = |cos_local: f64| {
            if ring.amplitude == 0.0 {
                return 0.0;
            }
            let azimuth = (cos_local - self.source.cos * cos) / ring.amplitude;
            (ring.end - libm::acos(azimuth.clamp(-1.0, 1.0))).clamp(0.0, ring.end)
        };
        let mut kinks = [ring.end; 4];
        let mut count = 0;
        if self.kinks.grooves {
            // With 2 cos α/cos θ′ = A: 1 = A cos θ_i, 1 = A cos θ_r, cos θ_i = cos θ_r.
            let steep = 4.0 * cos * cos - 1.0;
            let masked = if steep > 0.0 { at(2.0 * cos * self.source.cos / steep) } else { ring.end };
            kinks[..3].copy_from_slice(&[at(2.0 * cos * self.source.cos), masked, at(self.source.cos / cos)]);
            count = 3;
        }
        if let Some(critical) = self.kinks.critical {
            kinks[count] = at(critical);
        }
        kinks
    }
}

impl Ring {
    /// `end` − |ψ| at a position along the square's second side, and its derivative.
    fn beyond_end(&self, position: f64) -> (f64, f64) {
        let Interval { low, length, scale, decades } = self.azimuths;
        let (rest, derivative) = eased(position, self.soft);
        let (place, derivative) = (self.part[0] + self.part[1] * rest, self.part[1] * derivative);
        if decades < 1e-6 {
            return (low + length * place, length * derivative);
        }
        let grown = libm::expm1(decades * place);
        (low + scale * grown, scale * (1.0 + grown) * decades * derivative)
    }

    /// The facet at a position along the second side of the square.
    pub(super) fn facet(&self, position: f64) -> Facet {
        let (from_end, derivative) = self.beyond_end(position);
        let half = SinCos::of_radians(0.5 * from_end);
        let turned = SinCos { sin: 2.0 * half.sin * half.cos, cos: 1.0 - 2.0 * half.sin * half.sin };
        let SinCos { sin, cos } = self.end_sines;
        // cos ψ − cos `end` = 2 sin(`end` − δ/2) sin(δ/2) with δ = `end` − ψ
        let above = 2.0 * self.amplitude * (sin * half.cos - cos * half.sin) * half.sin;
        Facet {
            measure: 2.0 * self.stretch * derivative,
            cos_local: self.least + above,
            cos_r: self.lowest + 2.0 * self.slope.cos * above,
            azimuth: SinCos {
                sin: sin * turned.cos - cos * turned.sin,
                cos: cos * turned.cos + sin * turned.sin,
            },
        }
    }

    /// The local angle of incidence.
    pub(super) fn local_incidence(&self, facet: &Facet) -> SinCos {
        let SinCos { sin, cos } = self.slope;
        let along = self.source.sin * cos - self.source.cos * sin * facet.azimuth.cos;
        SinCos { sin: libm::hypot(along, sin * facet.azimuth.sin).min(1.0), cos: facet.cos_local.min(1.0) }
    }

    /// Source and viewer.
    pub(super) fn geometry(&self, facet: &Facet) -> Geometry {
        Geometry::of_facet(&FacetAngles {
            source: self.source,
            slope: self.slope,
            azimuth: facet.azimuth,
            cos_local: facet.cos_local,
            cos_r: facet.cos_r,
        })
    }
}

/// A map of [0, 1] to itself and its derivative, quadratic at the `soft` ends: a square root there becomes smooth.
fn eased(s: f64, soft: [bool; 2]) -> (f64, f64) {
    let rest = 1.0 - s;
    match soft {
        [false, false] => (s, 1.0),
        [true, false] => (s * s, 2.0 * s),
        [false, true] => (1.0 - rest * rest, 2.0 * rest),
        [true, true] => (s * s * (1.0 + 2.0 * rest), 6.0 * s * rest),
    }
}
