//! The diagrams that a figure is made of, as links to `/v1/diagrams`: where a reader goes on from the report's parameters.

use crate::reflectance::diagram::{Division, Sweep};
use crate::reflectance::figures::{Figure, View};
use crate::reflectance::quantity::{
    CorrelationLength, FacetSlope, OutOfBounds, RmsHeight, SpecularScale, Wavelength,
};
use crate::reflectance::scene::{Components, Sensor};
use crate::reflectance::shadowing::Shadowing;
use std::fmt::{Display, Write as _};

/// The query of a link while it grows.
struct Query(String);

impl Query {
    fn add(&mut self, name: &str, value: impl Display) {
        // Writing to a string cannot fail.
        let _ = write!(self.0, "&{name}={value}");
    }

    fn add_if(&mut self, name: &str, value: Option<impl Display>) {
        if let Some(value) = value {
            self.add(name, value);
        }
    }
}

/// One link a panel; none for figures 18 and 19.
pub(super) fn links(figure: &Figure) -> Result<Vec<String>, OutOfBounds> {
    Ok(figure.views()?.iter().map(link).collect())
}

fn link(view: &View) -> String {
    let scene = view.scene.parameters();
    let mut query = Query(format!("/v1/diagrams?model={}", scene.model.name()));
    let surface = &scene.surface;
    query.add_if("rms_height_um", surface.rms_height.map(RmsHeight::get));
    query.add_if("correlation_length_um", surface.correlation_length.map(CorrelationLength::get));
    query.add_if("facet_slope_deg", surface.facet_slope.map(FacetSlope::get));
    query.add("diffuse_albedo", surface.diffuse_albedo.get());
    query.add_if("specular_scale", surface.specular_scale.map(SpecularScale::get));
    query.add_if("shadowing", surface.shadowing.map(Shadowing::name));
    query.add_if("wavelength_um", scene.illumination.wavelength.map(Wavelength::get));
    if let Some(Sensor::Patch { footprint, half_x, half_y }) = scene.sensor {
        query.add("footprint_um2", footprint.get());
        query.add("patch_half_x_um", half_x.get());
        query.add("patch_half_y_um", half_y.get());
    }
    if let Components::Named(named) = &scene.components {
        query.add("components", named.iter().map(|one| one.name()).collect::<Vec<_>>().join(","));
    }
    query.add("method", scene.accuracy.method.name());
    sweep(&mut query, &view.sweep);
    query.0
}

fn sweep(query: &mut Query, sweep: &Sweep) {
    let (from, to) = sweep.ends();
    query.add("sweep", sweep.axis().name());
    query.add("from_deg", from.get());
    query.add("to_deg", to.get());
    match sweep.division() {
        Division::Step(step) => query.add("step_deg", step.get()),
        Division::Points(points) => query.add("points", points),
    }
    query.add("at_deg", sweep.at().iter().map(f64::to_string).collect::<Vec<_>>().join(","));
}
