//! The sensor as requests carry it: what it sees of the surface, and under what angle the surface sees it.

use crate::http::input::node::{Node, Object};
use crate::http::input::object::{WireObject, object};
use crate::http::input::reader::{Fields, Reader};
use crate::http::input::wire::{self, Schemas, Wire, mismatch, number};
use crate::http::problem::Code;
use crate::reflectance::bounds::{Bounds, RECEIVER_HALF_ANGLE};
use crate::reflectance::quantity::{Area, Length, OffAxis, Quantity, ReceiverHalfAngle};
use crate::reflectance::scene::{CameraSensor, Sensor};
use utoipa::openapi::schema::{ObjectBuilder, Schema, Type};
use utoipa::openapi::{OneOfBuilder, RefOr};

object! {
    /// A receiver of finite size, whatever it sees.
    ReceiverWire as "Receiver" {
        /// β, degrees: half the angle under which the surface sees the receiver. The answer in a direction is the mean over the
        /// cone of viewers around it, by projected solid angle, of what is above the horizon; the spike, taken as sharp, is read
        /// whole by a cone that holds the mirror direction. 0, as when absent or null: a point.
        receiver_half_angle_deg: HalfAngle,
    }
}

object! {
    /// What the sensor sees: the quantities of (47) and (35) themselves.
    PatchWire as "Patch" {
        /// (z/f)² dA_im cos γ of (43), square micrometres.
        footprint_um2: Area,
        /// X of (35), micrometres.
        patch_half_x_um: Length,
        /// Y of (35), micrometres.
        patch_half_y_um: Length,
        /// As of a receiver alone.
        receiver_half_angle_deg: Option<HalfAngle>,
    }
}

object! {
    /// A camera as in figure 10: its footprint follows by (43), A = footprint/cos θ_r and X = Y = √A/2.
    CameraWire as "Camera" {
        /// dA_im, square micrometres.
        pixel_area_um2: Area,
        /// z, micrometres.
        distance_um: Length,
        /// f, micrometres.
        focal_length_um: Length,
        /// d, micrometres: the diameter of the lens.
        aperture_um: Length,
        /// γ, degrees; 0 when absent or null.
        off_axis_deg: Option<OffAxis>,
        /// As of a receiver alone.
        receiver_half_angle_deg: Option<HalfAngle>,
    }
}

/// The field that all kinds of sensors have.
const RECEIVER: &str = "receiver_half_angle_deg";
/// The fields of a patch alone.
const PATCH: [&str; 3] = ["footprint_um2", "patch_half_x_um", "patch_half_y_um"];
/// The fields of a camera alone; the last one may be left out.
const CAMERA: [&str; 5] = ["pixel_area_um2", "distance_um", "focal_length_um", "aperture_um", "off_axis_deg"];

/// The half angle of a receiver; none is a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfAngle(Option<ReceiverHalfAngle>);

impl Wire for HalfAngle {
    const RANGE: Option<&'static Bounds> = Some(&RECEIVER_HALF_ANGLE);

    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        let expected = format!("0, or {RECEIVER_HALF_ANGLE}");
        let number = number(&node, reader, &expected)?;
        if number == 0.0 {
            return Some(Self(None));
        }
        let read = ReceiverHalfAngle::new(number).map(|half_angle| Self(Some(half_angle)));
        let detail = |_| format!("{} {number} is outside: expected {expected}", RECEIVER_HALF_ANGLE.name);
        read.map_err(detail).map_err(|detail| reader.error(Code::OutOfRange, detail)).ok()
    }

    fn schema() -> RefOr<Schema> {
        let number = ObjectBuilder::new().schema_type(Type::Number);
        number.minimum(Some(0.0)).maximum(Some(RECEIVER_HALF_ANGLE.max)).into()
    }
}

/// What is said of a sensor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SensorWire {
    /// What it sees, if that is given.
    pub(super) seen: Option<Sensor>,
    /// Its half angle, if it is not a point.
    pub(super) receiver: Option<ReceiverHalfAngle>,
}

impl SensorWire {
    /// Whether a spike can be evaluated for it.
    pub(super) const fn sees(self) -> bool {
        self.seen.is_some() || self.receiver.is_some()
    }
}

impl Wire for SensorWire {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        let Node::Object(object) = node else {
            return reader.fail(
                Code::WrongType,
                mismatch(&node, &"an object that describes a patch, a camera or a receiver"),
            );
        };
        let mut fields = Fields::new(object);
        let accepted: Vec<&str> = match (fields.has_any(&PATCH), fields.has_any(&CAMERA)) {
            (true, _) => PatchWire::names(),
            (false, true) => CameraWire::names(),
            (false, false) => [&PATCH[..], &CameraWire::names()].concat(),
        };
        let sensor = take_sensor(&mut fields, reader);
        fields.finish(reader, || accepted);
        sensor
    }

    fn read_flat(_: &'static str, fields: &mut Fields, reader: &mut Reader) -> Option<Self> {
        take_sensor(fields, reader)
    }

    fn is_given(_: &'static str, fields: &Fields) -> bool {
        fields.has_any(&PATCH) || fields.has_any(&CAMERA) || fields.has_any(&[RECEIVER])
    }

    fn schema() -> RefOr<Schema> {
        let kinds = [PatchWire::reference(), CameraWire::reference(), ReceiverWire::reference()];
        kinds.into_iter().fold(OneOfBuilder::new(), OneOfBuilder::item).into()
    }

    fn collect(schemas: &mut Schemas) {
        PatchWire::gather(schemas);
        CameraWire::gather(schemas);
        ReceiverWire::gather(schemas);
    }

    fn parameters(_: &'static str, _: &str, _: bool) -> Vec<wire::Parameter> {
        let of_kinds =
            PatchWire::query_parameters(false).into_iter().chain(CameraWire::query_parameters(false));
        let mut parameters: Vec<_> = of_kinds.filter(|parameter| parameter.name != RECEIVER).collect();
        parameters.extend(ReceiverWire::query_parameters(false));
        parameters
    }
}

/// Whether the fields of an object describe a patch and nothing of a camera.
pub(super) fn describes_patch(object: &Object) -> bool {
    let has = |names: &[&str]| object.fields.iter().any(|(name, _)| names.contains(&name.as_str()));
    has(&PATCH) && !has(&CAMERA)
}

/// What a sensor needs, for messages.
pub(super) fn sensor_needs() -> String {
    let camera = CAMERA[..CAMERA.len() - 1].join(", ");
    format!("{} of a patch, {camera} of a camera, or {RECEIVER} of a receiver", PATCH.join(", "))
}

fn take_sensor(fields: &mut Fields, reader: &mut Reader) -> Option<SensorWire> {
    match (fields.given(&PATCH).first(), fields.has_any(&CAMERA)) {
        (None, false) if fields.has_any(&[RECEIVER]) => {
            let receiver = ReceiverWire::take(fields, reader)?.receiver_half_angle_deg.0;
            Some(SensorWire { seen: None, receiver })
        }
        (None, false) => reader.fail(Code::Required, format!("required: {}", sensor_needs())),
        (None, true) => take_camera(fields, reader),
        (Some(_), false) => {
            let patch = PatchWire::take(fields, reader)?;
            let seen = Sensor::Patch {
                footprint: patch.footprint_um2,
                half_x: patch.patch_half_x_um,
                half_y: patch.patch_half_y_um,
            };
            let receiver = patch.receiver_half_angle_deg.and_then(|half_angle| half_angle.0);
            Some(SensorWire { seen: Some(seen), receiver })
        }
        (Some(first), true) => {
            // Neither a patch nor a camera: what is missing of either cannot be said.
            fields.exclude(reader, &CAMERA, &format!("{first}, a field of a patch"));
            fields.take_named::<Option<Area>>(reader, "footprint_um2");
            fields.take_named::<Option<Area>>(reader, "pixel_area_um2");
            for name in
                ["patch_half_x_um", "patch_half_y_um", "distance_um", "focal_length_um", "aperture_um"]
            {
                fields.take_named::<Option<Length>>(reader, name);
            }
            fields.take_named::<Option<OffAxis>>(reader, "off_axis_deg");
            fields.take_named::<Option<HalfAngle>>(reader, RECEIVER);
            None
        }
    }
}

fn take_camera(fields: &mut Fields, reader: &mut Reader) -> Option<SensorWire> {
    let camera = CameraWire::take(fields, reader)?;
    let seen = Sensor::Camera(CameraSensor {
        pixel_area: camera.pixel_area_um2,
        distance: camera.distance_um,
        focal_length: camera.focal_length_um,
        aperture: camera.aperture_um,
        off_axis: camera.off_axis_deg.or_else(|| OffAxis::new(0.0).ok())?,
    });
    let receiver = camera.receiver_half_angle_deg.and_then(|half_angle| half_angle.0);
    Some(SensorWire { seen: Some(seen), receiver })
}
