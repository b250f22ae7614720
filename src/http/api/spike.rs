//! The shape of the spike in the linear models, as requests carry it.

use crate::http::input::node::Node;
use crate::http::input::object::{WireObject, object};
use crate::http::input::reader::Reader;
use crate::http::input::wire::{Schemas, Wire, is_given, mismatch, named};
use crate::http::problem::Code;
use crate::reflectance::linear_image::{Match, SpikeShape};
use crate::reflectance::quantity::{Length, SpikeWidth, Wavelength};
use utoipa::openapi::schema::{ObjectBuilder, Schema, Type};
use utoipa::openapi::{OneOfBuilder, RefOr};

/// The shapes by name.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ShapeName {
    Delta,
    Sinc2,
    Gaussian,
}

impl ShapeName {
    const ALL: [Self; 3] = [Self::Delta, Self::Sinc2, Self::Gaussian];

    const fn name(self) -> &'static str {
        match self {
            Self::Delta => "delta",
            Self::Sinc2 => "sinc2",
            Self::Gaussian => "gaussian",
        }
    }
}

named! {
    ShapeName, "a shape", ShapeName::ALL;
    Match, "a way to match", [Match::Curvature, Match::Energy];
}

object! {
    partial
    /// The spike's shape with what it needs.
    SpikeWire as "SpikeShape" {
        /// `delta`; `sinc2` with `patch_half_x_um`, `patch_half_y_um` and `wavelength_um`; or `gaussian` with
        /// `width_deg`, or with `patch_half_x_um` and `wavelength_um` for a width that matches the sinc².
        shape: ShapeName,
        /// σ_s, degrees.
        width_deg: Option<SpikeWidth>,
        /// X of (35), micrometres.
        patch_half_x_um: Option<Length>,
        /// Y of (35), micrometres.
        patch_half_y_um: Option<Length>,
        /// λ, micrometres.
        wavelength_um: Option<Wavelength>,
        /// What the Gaussian keeps of the sinc²: the `curvature` of its peak (when absent or null) or its `energy`.
        matching: Option<Match>,
    }
}

/// Where the field is not one of those that the shape takes.
const NOT_TAKEN: &str = "this shape does not take it";

impl SpikeWire {
    fn check(self, reader: &mut Reader) -> Option<SpikeShape> {
        let need = |given: bool, name: &'static str, reader: &mut Reader| {
            if !given {
                reader.within(name, |reader| reader.error(Code::Required, "required: this shape needs it"));
            }
        };
        let refuse = |given: bool, name: &'static str, reader: &mut Reader| {
            if given {
                reader.within(name, |reader| reader.error(Code::Inconsistent, NOT_TAKEN));
            }
        };
        let shape = self.shape?;
        let (x, y) = (is_given(&self.patch_half_x_um), is_given(&self.patch_half_y_um));
        let (width, wavelength) = (is_given(&self.width_deg), is_given(&self.wavelength_um));
        let by_patch = matches!(shape, ShapeName::Gaussian) && !width;
        if by_patch || matches!(shape, ShapeName::Sinc2) {
            need(x, "patch_half_x_um", reader);
            need(wavelength, "wavelength_um", reader);
        } else {
            refuse(x, "patch_half_x_um", reader);
            refuse(wavelength, "wavelength_um", reader);
        }
        match shape {
            ShapeName::Sinc2 => need(y, "patch_half_y_um", reader),
            ShapeName::Delta | ShapeName::Gaussian => refuse(y, "patch_half_y_um", reader),
        }
        if !matches!(shape, ShapeName::Gaussian) {
            refuse(width, "width_deg", reader);
        }
        if !by_patch {
            refuse(is_given(&self.matching), "matching", reader);
        }
        let (half_x, half_y) = (self.patch_half_x_um?, self.patch_half_y_um?);
        let (width, wavelength, matching) = (self.width_deg?, self.wavelength_um?, self.matching?);
        match shape {
            ShapeName::Delta => Some(SpikeShape::Delta),
            ShapeName::Sinc2 => {
                Some(SpikeShape::Sinc2 { half_x: half_x?, half_y: half_y?, wavelength: wavelength? })
            }
            ShapeName::Gaussian => match width {
                Some(width) => Some(SpikeShape::Gaussian(width)),
                None => Some(SpikeShape::GaussianOfPatch {
                    half_x: half_x?,
                    wavelength: wavelength?,
                    matching: matching.unwrap_or(Match::Curvature),
                }),
            },
        }
    }
}

impl Wire for SpikeShape {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        match node {
            Node::Text(text) if text == "delta" => Some(Self::Delta),
            Node::Object(_) => SpikeWire::read_object(node, reader)?.check(reader),
            other => reader.fail(Code::WrongType, mismatch(&other, &"\"delta\" or an object with a shape")),
        }
    }

    fn schema() -> RefOr<Schema> {
        let delta = ObjectBuilder::new().schema_type(Type::String).enum_values(Some(["delta"]));
        OneOfBuilder::new().item(delta).item(SpikeWire::reference()).into()
    }

    fn collect(schemas: &mut Schemas) {
        SpikeWire::gather(schemas);
    }
}
