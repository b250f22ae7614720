//! Requests of the right form with values of every kind: what random bytes would not reach.

use arbitrary::Arbitrary;
use serde_json::{Map, Value, json};

/// A number for a field whose range is known: mostly one that it takes.
#[derive(Arbitrary, Debug)]
pub enum Number {
    /// Within the range.
    Inside(u16),
    /// Within, and near its lower end.
    Low(u16),
    /// The lower end, the upper end, and what else is special between them.
    Special(u8),
    /// The first one again, so that what follows is rarer.
    InsideToo(u16),
    /// The same.
    LowToo(u16),
    /// Any bits.
    Bits(f64),
}

/// Where something changes: exact zeros, grazing, the ends of f64.
const SPECIAL: [f64; 12] = [
    0.0,
    -0.0,
    1.0,
    45.0,
    89.999_999_999_999_99,
    90.0,
    180.0,
    1e-300,
    5e-324,
    f64::EPSILON,
    0.1,
    63.639_610_306_789_28,
];

impl Number {
    /// The number for a field that takes those from `least` to `most`.
    fn value(&self, [least, most]: [f64; 2]) -> f64 {
        // Sizes go by their logarithm, angles and shares do not.
        let at = |share: f64| {
            if least > 0.0 { least * (most / least).powf(share) } else { least + (most - least) * share }
        };
        match *self {
            Self::Inside(share) | Self::InsideToo(share) => at(f64::from(share) / 65535.0),
            Self::Low(share) | Self::LowToo(share) => at((f64::from(share) / 65535.0).powi(4)),
            Self::Special(index) => {
                let inside = SPECIAL.iter().copied().filter(|value| (least..=most).contains(value));
                let all: Vec<_> = inside.chain([least, most]).collect();
                all[usize::from(index) % all.len()]
            }
            Self::Bits(value) if value.is_finite() => value,
            Self::Bits(_) => -1.0,
        }
    }
}

/// An angle: few of them are out of range, since a request may have many.
#[derive(Arbitrary, Debug)]
pub struct Angle(u16);

impl Angle {
    fn value(&self, least: f64) -> f64 {
        let special: [f64; 8] = [0.0, 90.0, -90.0, 89.999_999_999_999_99, 1e-300, 45.0, 30.0, 91.0];
        match usize::from(self.0) {
            index @ 0..4096 => special[index % special.len()].max(least),
            _ => least + (90.0 - least) * f64::from(self.0) / 65535.0,
        }
    }
}

/// A request for radiance.
#[derive(Arbitrary, Debug)]
pub struct Scene {
    model: u8,
    surface: [Option<Number>; 5],
    medium: Option<(Number, Number)>,
    shadowing: Option<u8>,
    wavelength: Option<Number>,
    irradiance: Option<Number>,
    polarization: Option<u8>,
    sensor: Option<[Number; 3]>,
    camera: Option<[Number; 5]>,
    theta_i: Vec<Angle>,
    theta_r: Vec<Angle>,
    phi_r: Option<Number>,
    components: Option<u8>,
    tolerance: Option<Number>,
    method: Option<u8>,
    log10: bool,
    per_direction: bool,
}

const MODELS: [&str; 4] = ["beckmann_spizzichino", "torrance_sparrow", "lambertian", "unified"];
const COMPONENTS: [&str; 3] = ["diffuse_lobe", "specular_lobe", "specular_spike"];
const METHODS: [&str; 6] = ["auto", "series", "paper", "uniform", "smooth", "rough"];
const SHADOWINGS: [&str; 4] = ["none", "v_groove", "smith", "smith_uncorrelated"];
const POLARIZATIONS: [&str; 3] = ["unpolarized", "parallel", "perpendicular"];
/// A field and the range that its numbers are mostly from.
type Field = (&'static str, [f64; 2]);

const SURFACE: [Field; 5] = [
    ("rms_height_um", [1e-9, 1e6]),
    ("correlation_length_um", [1e-6, 1e9]),
    ("facet_slope_deg", [1e-6, 60.0]),
    ("diffuse_albedo", [0.0, 1.0]),
    ("specular_scale", [0.0, 1e6]),
];
const MEDIUM: [Field; 2] = [("n", [0.05, 20.0]), ("k", [0.0, 20.0])];
const ILLUMINATION: [Field; 2] = [("wavelength_um", [1e-4, 1e3]), ("irradiance", [0.0, 1e6])];
const SENSOR: [Field; 3] =
    [("footprint_um2", [1e-3, 1e12]), ("patch_half_x_um", [1e-2, 1e6]), ("patch_half_y_um", [1e-2, 1e6])];
const CAMERA: [Field; 5] = [
    ("pixel_area_um2", [1e-2, 1e6]),
    ("distance_um", [1e2, 1e9]),
    ("focal_length_um", [1e2, 1e7]),
    ("aperture_um", [1.0, 1e6]),
    ("off_axis_deg", [0.0, 89.0]),
];
const AZIMUTH: [f64; 2] = [-360.0, 360.0];
const TOLERANCE: [f64; 2] = [1e-15, 0.1];

/// Directions at most.
const DIRECTIONS: usize = 8;

fn one_of(words: &[&'static str], index: u8) -> &'static str {
    words[usize::from(index) % words.len()]
}

/// The fields that have a number.
fn members<'a>(
    fields: &[Field],
    numbers: impl IntoIterator<Item = Option<&'a Number>>,
) -> Map<String, Value> {
    let pairs = fields.iter().zip(numbers);
    pairs
        .filter_map(|((name, range), number)| Some(((*name).to_owned(), number?.value(*range).into())))
        .collect()
}

/// One angle as a number, more as an array.
fn angles(angles: &[Angle], least: f64, count: usize) -> Value {
    match angles {
        [] => json!(30),
        [only] => only.value(least).into(),
        _ => angles.iter().take(count).map(|angle| angle.value(least)).collect(),
    }
}

impl Scene {
    /// The request in JSON, and how many directions it has if it is accepted.
    pub fn request(&self) -> (Value, usize) {
        let mut surface = members(&SURFACE, self.surface.iter().map(Option::as_ref));
        let medium = self.medium.as_ref().map(|(n, k)| members(&MEDIUM, [Some(n), Some(k)]));
        surface.extend(medium.map(|medium| ("medium".to_owned(), medium.into())));
        surface
            .extend(self.shadowing.map(|index| ("shadowing".to_owned(), one_of(&SHADOWINGS, index).into())));
        let mut illumination = members(&ILLUMINATION, [self.wavelength.as_ref(), self.irradiance.as_ref()]);
        let polarization = self.polarization.map(|index| one_of(&POLARIZATIONS, index));
        illumination.extend(polarization.map(|word| ("polarization".to_owned(), word.into())));

        // Arrays have one length.
        let longest = self.theta_i.len().max(self.theta_r.len()).min(DIRECTIONS);
        let both = self.theta_i.len().min(self.theta_r.len()).min(DIRECTIONS);
        let count = if both > 1 { both } else { longest };
        let mut geometry = Map::new();
        geometry.insert("theta_i_deg".to_owned(), angles(&self.theta_i, 0.0, count));
        geometry.insert("theta_r_deg".to_owned(), angles(&self.theta_r, -90.0, count));
        geometry
            .extend(self.phi_r.as_ref().map(|number| ("phi_r_deg".to_owned(), number.value(AZIMUTH).into())));

        let mut request = json!({
            "model": one_of(&MODELS, self.model),
            "surface": surface,
            "illumination": illumination,
            "geometry": geometry,
            "output": {"log10": self.log10, "per_direction": self.per_direction}
        });
        if let Some(bits) = self.components {
            let named = COMPONENTS.iter().enumerate().filter(|(index, _)| bits >> index & 1 == 1);
            request["components"] = named.map(|(_, name)| *name).collect();
        }
        if let Some(sensor) = &self.sensor {
            request["sensor"] = members(&SENSOR, sensor.iter().map(Some)).into();
        } else if let Some(camera) = &self.camera {
            request["sensor"] = members(&CAMERA, camera.iter().map(Some)).into();
        }
        let mut accuracy = Map::new();
        accuracy.extend(
            self.tolerance.as_ref().map(|t| ("relative_tolerance".to_owned(), t.value(TOLERANCE).into())),
        );
        accuracy.extend(self.method.map(|index| ("method".to_owned(), one_of(&METHODS, index).into())));
        request["accuracy"] = accuracy.into();
        (request, count.max(1))
    }
}
