//! The sensor as the spike sees it, its lengths over the wavelength.

use super::beckmann_spizzichino::Patch;
use super::numeric::scaled::Scaled;
use super::radiometry::Camera;
use super::scene::Sensor;

/// What the sensor sees of the surface.
#[derive(Clone, Copy)]
pub(super) enum View {
    /// The same from everywhere.
    Patch(Patch),
    /// The patch follows for each θ_r.
    Camera {
        /// Its radiometry.
        optics: Camera,
        /// λ, in the unit of its lengths.
        wavelength: f64,
    },
}

impl View {
    pub(super) fn new(sensor: Sensor, wavelength: f64) -> Self {
        match sensor {
            Sensor::Patch { footprint, half_x, half_y } => Self::Patch(Patch {
                footprint: Scaled::new(footprint.get()) / Scaled::new(wavelength).squared(),
                half_x: half_x.get() / wavelength,
                half_y: half_y.get() / wavelength,
            }),
            Sensor::Camera(camera) => Self::Camera { optics: camera.optics(), wavelength },
        }
    }

    /// A camera's A = footprint/cos θ_r and X = Y = √A/2 (errata E18).
    pub(super) fn patch(self, cos_r: f64) -> Patch {
        match self {
            Self::Patch(patch) => patch,
            Self::Camera { optics, wavelength } => {
                let half = optics.half_side(cos_r) / wavelength;
                let footprint = optics.footprint() / Scaled::new(wavelength).squared();
                Patch { footprint, half_x: half, half_y: half }
            }
        }
    }
}
