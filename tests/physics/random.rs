//! Scenes and directions at random, the same in every run.

use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
use reflectance::reflectance::fresnel_average::FresnelAverage;
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::{
    Area, Azimuth, Fraction, IndexK, IndexN, Length, Quantity as InRange, SourceZenith, SpecularScale,
    ViewerZenith, Wavelength,
};
use reflectance::reflectance::scene::{
    Accuracy, CameraSensor, Components, Illumination, Model, Scene, SceneParameters, Sensor, Surface,
};
use reflectance::reflectance::shadowing::Shadowing;

/// A sequence of numbers that is the same in every run.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / 9007199254740992.0
    }

    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    fn power(&mut self, from: f64, to: f64) -> f64 {
        10f64.powf(self.between(from, to))
    }

    pub(crate) fn index(&mut self, count: usize) -> usize {
        self.unit();
        // The low bits of the state repeat soon; these do not.
        usize::try_from(self.0 >> 40).expect("24 bits") % count
    }
}

fn in_range<Q: InRange>(value: f64) -> Q {
    Q::new(value.clamp(Q::BOUNDS.min, Q::BOUNDS.max)).unwrap()
}

/// A scene as it may come: most of its lengths within some decades of the wavelength.
pub(crate) fn scene(random: &mut Random) -> SceneParameters {
    let models = [Model::BeckmannSpizzichino, Model::TorranceSparrow, Model::Unified];
    let wavelength = random.power(-1.0, 1.0);
    let height = wavelength * random.power(-5.0, 2.0);
    let length = if random.unit() < 0.8 { height * random.power(0.3, 4.0) } else { random.power(-3.0, 4.0) };
    let medium = match random.index(4) {
        0 => Medium::Index(RefractiveIndex {
            n: in_range(random.between(0.2, 3.0)),
            k: in_range(random.between(0.0, 5.0)),
        }),
        1 => Medium::Index(RefractiveIndex {
            n: in_range(random.between(1.0, 2.5)),
            k: IndexK::new(0.0).unwrap(),
        }),
        _ => Medium::PerfectConductor,
    };
    let medium = if random.index(40) == 0 {
        Medium::Index(RefractiveIndex { n: IndexN::new(1.0).unwrap(), k: IndexK::new(0.0).unwrap() })
    } else {
        medium
    };
    let area = random.power(-2.0, 8.0);
    let half: Length = in_range(0.5 * area.sqrt() * random.between(0.5, 2.0));
    let sensor = match random.index(8) {
        0 => None,
        1 | 2 => Some(Sensor::Camera(CameraSensor {
            pixel_area: in_range(random.power(0.0, 3.0)),
            distance: in_range(random.power(4.0, 7.0)),
            focal_length: in_range(random.power(3.0, 5.0)),
            aperture: in_range(1e4),
            off_axis: in_range(random.between(0.0, 60.0)),
        })),
        _ => Some(Sensor::Patch { footprint: Area::new(area).unwrap(), half_x: half, half_y: half }),
    };
    let albedo = if random.index(3) == 0 { 0.0 } else { random.power(-12.0, 0.0) };
    SceneParameters {
        model: models[random.index(3)],
        surface: Surface {
            rms_height: Some(in_range(height)),
            correlation_length: Some(in_range(length)),
            facet_slope: (random.index(3) == 0).then(|| in_range(random.power(-2.0, 1.5))),
            medium,
            diffuse_albedo: Fraction::new(albedo).unwrap(),
            specular_scale: (random.index(5) == 0)
                .then(|| SpecularScale::new(random.power(-6.0, 3.0)).unwrap()),
            shadowing: [None, Some(Shadowing::None), Some(Shadowing::VGroove), Some(Shadowing::Smith)]
                [random.index(4)],
            fresnel_average: [None, None, Some(FresnelAverage::MeanPlane)][random.index(3)],
        },
        illumination: Illumination {
            wavelength: Some(in_range(wavelength)),
            irradiance: in_range(random.power(-3.0, 3.0)),
            polarization: [
                Polarization::unpolarized(),
                Polarization::parallel(),
                Polarization::perpendicular(),
            ][random.index(3)],
        },
        sensor,
        receiver: None,
        components: Components::Auto,
        accuracy: Accuracy { relative_tolerance: in_range(random.power(-15.0, -1.0)), method: Method::Auto },
    }
}

/// One to 200 directions: anywhere, along sweeps, around a mirror direction, at grazing.
pub(crate) fn directions(random: &mut Random) -> Directions {
    let count = [1, 1, 2, 3, 7, 40, 200][random.index(7)];
    let grazing = |random: &mut Random| 90.0 - random.power(-14.0, 1.0);
    let fixed = if random.index(8) == 0 { grazing(random) } else { random.between(0.0, 90.0) };
    let width = random.power(-6.0, 1.5);
    let azimuth = if random.index(2) == 0 { 0.0 } else { random.between(-360.0, 360.0) };
    let (mut theta_i, mut theta_r, mut phi) = (Vec::new(), Vec::new(), Vec::new());
    let kind = random.index(5);
    for index in 0..count {
        let (i, r, p) = match kind {
            // Anywhere; mirror directions; a sweep about one; around it; grazing.
            0 => (random.between(0.0, 90.0), random.between(-90.0, 90.0), random.between(-360.0, 360.0)),
            1 => {
                let theta = random.between(0.0, 89.0);
                (theta, theta, 0.0)
            }
            2 => (fixed, fixed + width * (2.0 * (f64::from(index) + 0.5) / f64::from(count) - 1.0), azimuth),
            3 => (fixed, fixed + width * random.between(-1.0, 1.0), width * random.between(-1.0, 1.0)),
            _ => (
                [0.0, 90.0, fixed][random.index(3)],
                [90.0, -90.0, fixed, -fixed, 0.0][random.index(5)],
                azimuth,
            ),
        };
        theta_i.push(in_range::<SourceZenith>(i));
        theta_r.push(in_range::<ViewerZenith>(r));
        phi.push(in_range::<Azimuth>(p));
    }
    Directions::new(Angles::Each(theta_i), Angles::Each(theta_r), Angles::Each(phi)).unwrap()
}

/// Every component that can be, whether it matters or not.
pub(crate) fn whole(parameters: &SceneParameters) -> Scene {
    let all = parameters.model.components().iter().copied();
    let lacks = parameters.sensor.is_none();
    let named = all.filter(|component| !lacks || component.name() != "specular_spike").collect();
    Scene::new(SceneParameters { components: Components::Named(named), ..parameters.clone() }).unwrap()
}

/// Puts the surface's lengths anywhere between 1e-12 and 1e9 wavelengths.
pub(crate) fn extreme(parameters: &mut SceneParameters, random: &mut Random) {
    let wavelength = parameters.illumination.wavelength.map_or(1.0, Wavelength::get);
    parameters.surface.rms_height = Some(in_range(wavelength * random.power(-12.0, 9.0)));
    parameters.surface.correlation_length = Some(in_range(wavelength * random.power(-12.0, 9.0)));
}
