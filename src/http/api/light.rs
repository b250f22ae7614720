//! The light of a scene, as requests carry it: at one wavelength or at several, with the material looked up at each.

use crate::http::input::medium::MediumWire;
use crate::http::input::object::object;
use crate::http::input::reader::{ElementErrors, Reader};
use crate::http::input::values::OneOrMany;
use crate::http::problem::{Code, FieldError, Problem};
use crate::reflectance::bounds::MAX_WAVELENGTHS;
use crate::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
use crate::reflectance::material::{Lookup, Material, Source};
use crate::reflectance::quantity::{Irradiance, Wavelength};
use serde::Serialize;
use utoipa::ToSchema;

/// The wavelengths of a request.
pub(crate) type Wavelengths = OneOrMany<Wavelength, MAX_WAVELENGTHS>;

object! {
    partial
    /// The light: a collimated beam.
    IlluminationWire as "Illumination" {
        /// λ in vacuum, micrometres: one number, or an array with an answer for each. Needed by the models that rest on
        /// the height statistics, and by materials.
        wavelength_um: Option<Wavelengths>,
        /// Of the beam on a plane normal to it, W m^-2 or W m^-2 nm^-1; the answer carries the same. 1 when
        /// absent or null.
        irradiance: Option<Irradiance>,
        /// Polarization with respect to the facet's plane of incidence; unpolarized when absent or null.
        polarization: Option<Polarization>,
    }
}

/// One wavelength of a spectrum.
#[derive(Clone, Copy, Debug, Hash)]
pub(crate) struct Line {
    pub(crate) wavelength: Wavelength,
    /// What a material was found to be there.
    pub(crate) lookup: Option<Lookup>,
}

/// At which wavelengths a scene is answered. The scene itself is that of the first.
#[derive(Clone, Debug, Hash)]
pub(crate) enum Light {
    /// At the one of the scene, if it has any.
    One(Option<Lookup>),
    /// At each of these, an answer for each.
    Spectrum(Vec<Line>),
}

impl Light {
    /// What was looked up, for a resource that answers one wavelength.
    pub(super) fn single(self) -> Result<Option<Lookup>, Problem> {
        match self {
            Self::One(lookup) => Ok(lookup),
            Self::Spectrum(_) => {
                let pointer = "/illumination/wavelength_um".to_owned();
                let detail = "an array: this resource answers one wavelength, expected a number".to_owned();
                Err(Problem::invalid(vec![FieldError { pointer, code: Code::WrongType, detail }]))
            }
        }
    }
}

impl Line {
    /// Looks a material up; what is wrong with the wavelength, where the source does not reach it.
    fn new(wavelength: Wavelength, medium: MediumWire) -> Result<Self, String> {
        let lookup = match medium {
            MediumWire::Given(_) => None,
            MediumWire::Material(material, source) => {
                let index = source.at(wavelength).ok_or_else(|| outside(material, source, wavelength))?;
                Some(Lookup { material, source, wavelength, index })
            }
        };
        Ok(Self { wavelength, lookup })
    }

    /// The index of its material.
    pub(crate) fn index(&self) -> Option<RefractiveIndex> {
        self.lookup.map(|lookup| lookup.index)
    }
}

/// What was looked up for a material.
#[derive(Serialize, ToSchema)]
#[schema(as = LookedUp)]
pub(crate) struct MediumAnswer {
    /// The material.
    #[schema(example = "Al")]
    material: &'static str,
    /// The publication.
    #[schema(example = "Rakic")]
    source: &'static str,
    /// n of n − ik.
    n: f64,
    /// k of n − ik.
    k: f64,
    /// False where the source has no k, which is taken as 0; absent where it has.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    k_tabulated: Option<bool>,
}

impl From<Lookup> for MediumAnswer {
    fn from(lookup: Lookup) -> Self {
        let RefractiveIndex { n, k } = lookup.index;
        let Lookup { material, source, .. } = lookup;
        let k_tabulated = (!source.has_k()).then_some(false);
        Self { material: material.name, source: source.id, n: n.get(), k: k.get(), k_tabulated }
    }
}

/// Light, medium and wavelength as a scene has them, as far as they could be read.
pub(super) struct Lit {
    pub(super) light: Light,
    pub(super) wavelength: Option<Wavelength>,
    pub(super) medium: Medium,
}

impl Lit {
    /// The scene of this line.
    fn new(line: Line, medium: MediumWire, light: Light) -> Self {
        let medium = match (line.index(), medium) {
            (Some(index), _) => Medium::Index(index),
            (None, MediumWire::Given(medium)) => medium,
            (None, MediumWire::Material(..)) => Medium::PerfectConductor,
        };
        Self { light, wavelength: Some(line.wavelength), medium }
    }
}

/// Looks a material up at every wavelength. `None` among the arguments is what could not be read, a medium of `None` one
/// that is not given; nothing comes back where something is wrong.
#[expect(clippy::option_option, reason = "what a partial object holds of an optional field")]
pub(super) fn lit(
    wavelengths: Option<Option<&Wavelengths>>,
    medium: Option<Option<MediumWire>>,
    reader: &mut Reader,
) -> Option<Lit> {
    let medium = medium?.unwrap_or(MediumWire::Given(Medium::PerfectConductor));
    match (wavelengths?, medium) {
        (None, MediumWire::Given(medium)) => Some(Lit { light: Light::One(None), wavelength: None, medium }),
        (None, MediumWire::Material(material, _)) => {
            // A lobe or spike may need it too.
            let pointer = if reader.is_flat() { "/wavelength_um" } else { "/illumination/wavelength_um" };
            if !reader.has_noted(pointer) {
                let detail = format!("required: n and k of {} are looked up at it", material.name);
                at_wavelength(reader, |reader| reader.error(Code::Required, detail));
            }
            None
        }
        (Some(OneOrMany::One(wavelength)), medium) => {
            let line = Line::new(*wavelength, medium)
                .map_err(|detail| at_wavelength(reader, |reader| reader.error(Code::OutOfRange, detail)));
            line.ok().map(|line| Lit::new(line, medium, Light::One(line.lookup)))
        }
        (Some(OneOrMany::Many(wavelengths)), medium) => {
            let lines = spectrum(wavelengths, medium, reader)?;
            Some(Lit::new(*lines.first()?, medium, Light::Spectrum(lines)))
        }
    }
}

/// Every wavelength with what is looked up at it, if nothing is wrong with any.
fn spectrum(
    wavelengths: &[Option<Wavelength>],
    medium: MediumWire,
    reader: &mut Reader,
) -> Option<Vec<Line>> {
    let mut errors = ElementErrors::default();
    let lines: Vec<Line> = at_wavelength(reader, |reader| {
        let read = wavelengths.iter().enumerate().filter_map(|(position, wavelength)| {
            Line::new((*wavelength)?, medium)
                .map_err(|detail| errors.note(reader, position, Code::OutOfRange, || detail))
                .ok()
        });
        let lines = read.collect();
        errors.finish(reader);
        lines
    });
    (lines.len() == wavelengths.len()).then_some(lines)
}

fn at_wavelength<T>(reader: &mut Reader, read: impl FnOnce(&mut Reader) -> T) -> T {
    reader.within("illumination", |reader| reader.within("wavelength_um", read))
}

/// What is wrong with a wavelength that a source does not reach.
pub(super) fn outside(material: &Material, source: &Source, wavelength: Wavelength) -> String {
    let [least, largest] = source.range();
    let others: Vec<_> = material.sources_at(wavelength).map(|source| source.id).collect();
    let others = if others.is_empty() {
        "no other source reaches it".to_owned()
    } else {
        format!("sources that reach it: {}", others.join(", "))
    };
    format!(
        "wavelength {} is outside: {} by {} is known from {least} to {largest} micrometres; {others}",
        wavelength.get(),
        material.name,
        source.id,
    )
}
