//! The report's diagrams as presets: the captions' parameters, their length unit taken as µm.
//!
//! Where a caption is silent (errata E28): θ = 10, 30, 45, 60°, X = Y = 10, footprint 400,
//! irradiance 1; and for Torrance-Sparrow c·a_f = 1, F = 1 and G = 1, as the text assumes. In 21d, which compares it
//! with the other model, c·a_f is that of facets that tile the mean plane (errata E31).

use super::diagram::{Division, Sweep, SweepAxis};
use super::evaluate::{Output, Quantity};
use super::figure_scenes::{beckmann_spizzichino, components_of_section_5, torrance_sparrow};
use super::fresnel::{Medium, RefractiveIndex};
use super::geometry::Geometry;
use super::numeric::lobe_series::Method;
use super::quantity::{
    Azimuth, FacetSlope, IndexK, IndexN, OutOfBounds, Quantity as _, SourceZenith, SpecularScale, SweepAngle,
    SweepStep, ViewerZenith,
};
use super::scene::{Component, Scene};
use super::shadowing::ShadowingFunction;
use super::table::{Column, Curve, Table};
use super::{degrees::SinCos, roughness};

/// One figure of the report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// "11a" … "24".
    pub id: &'static str,
    /// What the caption says it shows.
    pub title: &'static str,
    /// The parameters, and where they come from if not from the caption.
    pub parameters: &'static str,
    content: Content,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Content {
    /// σ_h, T, λ of a Beckmann-Spizzichino diagram over θ_r.
    Heights { sigma_h: f64, t: f64, lambda: f64, shows: Shows },
    /// σ_α of a Torrance-Sparrow diagram.
    Facets { sigma_alpha: f64, axis: SweepAxis },
    /// 21d: both models at the σ_h/T that (79) makes of σ_α.
    BothModels { sigma_alpha: f64 },
    /// F′ against the local angle of incidence.
    Fresnel,
    /// G against θ_r.
    Attenuation,
    /// The three components, polar in the report.
    Components { axis: SweepAxis },
}

/// Which part of a Beckmann-Spizzichino diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shows {
    /// Lobe and spike over θ_r.
    Total,
    /// The same, one curve magnified.
    Magnified,
    /// The lobe over θ_r.
    Lobe,
    /// The lobe by (47) and by (49) over θ_r.
    LobeAndRough,
    /// The lobe over θ_i.
    LobeOverSource,
}

const FIXED: [f64; 4] = [10.0, 30.0, 45.0, 60.0];

const fn heights(
    id: &'static str,
    title: &'static str,
    p: &'static str,
    v: [f64; 3],
    shows: Shows,
) -> Figure {
    let content = Content::Heights { sigma_h: v[0], t: v[1], lambda: v[2], shows };
    Figure { id, title, parameters: p, content }
}

const fn facets(id: &'static str, parameters: &'static str, sigma_alpha: f64, axis: SweepAxis) -> Figure {
    let title = match axis {
        SweepAxis::ThetaR => "Radiance predicted by the Torrance-Sparrow model",
        SweepAxis::ThetaI => "Torrance-Sparrow specular lobe over the source angle at fixed views",
    };
    Figure { id, title, parameters, content: Content::Facets { sigma_alpha, axis } }
}

const RATIO: &str = "Radiance predicted by the Beckmann-Spizzichino model, by σ_h/λ";
const SPIKE: &str = "Specular spike predicted by the Beckmann-Spizzichino model, by σ_h/T";
const LOBE: &str = "Specular lobe predicted by the Beckmann-Spizzichino model, by σ_h/T";
const SOURCE: &str = "Beckmann-Spizzichino specular lobe over the source angle at fixed views";

/// Every figure that the report computes.
pub const FIGURES: [Figure; 38] = [
    heights("11a", RATIO, "σ_h = 0.001, T = 0.01, λ = 0.5", [0.001, 0.01, 0.5], Shows::Total),
    heights(
        "11b",
        "One curve of figure 11a, magnified",
        "σ_h = 0.001, T = 0.01, λ = 0.5; θ_i = 30° chosen here, the caption names none",
        [0.001, 0.01, 0.5],
        Shows::Magnified,
    ),
    heights("11c", RATIO, "σ_h = 0.001, T = 0.01, λ = 0.02", [0.001, 0.01, 0.02], Shows::Total),
    heights("11d", RATIO, "σ_h = 0.001, T = 0.01, λ = 0.01", [0.001, 0.01, 0.01], Shows::Total),
    heights("11e", RATIO, "σ_h = 0.001, T = 0.01, λ = 0.003", [0.001, 0.01, 0.003], Shows::Total),
    heights("11f", RATIO, "σ_h = 0.001, T = 0.01, λ = 0.002", [0.001, 0.01, 0.002], Shows::Total),
    heights("12a", SPIKE, "σ_h = 0.001, T = 0.05, λ = 0.5", [0.001, 0.05, 0.5], Shows::Total),
    heights("12b", SPIKE, "σ_h = 0.001, T = 0.02, λ = 0.5", [0.001, 0.02, 0.5], Shows::Total),
    heights("12c", SPIKE, "σ_h = 0.001, T = 0.01, λ = 0.5", [0.001, 0.01, 0.5], Shows::Total),
    heights("12d", SPIKE, "σ_h = 0.001, T = 0.006, λ = 0.5", [0.001, 0.006, 0.5], Shows::Total),
    heights(
        "13a",
        "Specular lobe by (47) and by the rough-surface form (49)",
        "σ_h = 0.001, T = 0.01, λ = 0.0001",
        [0.001, 0.01, 0.0001],
        Shows::LobeAndRough,
    ),
    heights("13b", LOBE, "σ_h = 0.001, T = 0.05, λ = 0.0001", [0.001, 0.05, 0.0001], Shows::Lobe),
    heights("13c", LOBE, "σ_h = 0.001, T = 0.015, λ = 0.0001", [0.001, 0.015, 0.0001], Shows::Lobe),
    heights(
        "13d",
        LOBE,
        "σ_h = 0.001, T = 0.01, λ = 0.0001 (the caption of 13a again)",
        [0.001, 0.01, 0.0001],
        Shows::Lobe,
    ),
    heights("13e", LOBE, "σ_h = 0.001, T = 0.007, λ = 0.0001", [0.001, 0.007, 0.0001], Shows::Lobe),
    heights("13f", LOBE, "σ_h = 0.001, T = 0.005, λ = 0.0001", [0.001, 0.005, 0.0001], Shows::Lobe),
    Figure {
        id: "18",
        title: "Fresnel reflectance F′ over the local angle of incidence",
        parameters: "n = 1.5, k = 0 and n = 1, k = 7: chosen here, the report shows a typical plot without numbers",
        content: Content::Fresnel,
    },
    Figure {
        id: "19",
        title: "Geometrical attenuation factor G over the viewing angle",
        parameters: "θ_i = 0, 30, 45, 60, 75°, φ_r = 0",
        content: Content::Attenuation,
    },
    facets("20a", "σ_α = 0.01°", 0.01, SweepAxis::ThetaR),
    facets("20b", "σ_α = 0.1°", 0.1, SweepAxis::ThetaR),
    facets("20c", "σ_α = 0.5°", 0.5, SweepAxis::ThetaR),
    facets("20d", "σ_α = 1°", 1.0, SweepAxis::ThetaR),
    facets("20e", "σ_α = 2°", 2.0, SweepAxis::ThetaR),
    facets("20f", "σ_α = 3°", 3.0, SweepAxis::ThetaR),
    facets("21a", "σ_α = 5°", 5.0, SweepAxis::ThetaR),
    facets("21b", "σ_α = 7°", 7.0, SweepAxis::ThetaR),
    facets("21c", "σ_α = 9°", 9.0, SweepAxis::ThetaR),
    Figure {
        id: "21d",
        title: "Radiance predicted by the Torrance-Sparrow and the Beckmann-Spizzichino model (49)",
        parameters: "σ_α = 13°, facets that tile the mean plane (errata E31); σ_h/T = 0.166 by (79) (errata E49), T = 0.01, λ = 0.0001 chosen here",
        content: Content::BothModels { sigma_alpha: 13.0 },
    },
    facets("21e", "σ_α = 15°", 15.0, SweepAxis::ThetaR),
    facets("21f", "σ_α = 17°", 17.0, SweepAxis::ThetaR),
    Figure {
        id: "22",
        title: "The three reflection components over the viewing angle",
        parameters: components_of_section_5::PARAMETERS,
        content: Content::Components { axis: SweepAxis::ThetaR },
    },
    heights(
        "23a",
        SOURCE,
        "σ_h = 0.0003, T = 0.01, λ = 0.001 (printed σ_h = 0.003, errata E41)",
        [0.0003, 0.01, 0.001],
        Shows::LobeOverSource,
    ),
    facets("23b", "σ_α = 2.428°", 2.428, SweepAxis::ThetaI),
    heights("23c", SOURCE, "σ_h = 0.001, T = 0.01, λ = 0.001", [0.001, 0.01, 0.001], Shows::LobeOverSource),
    facets("23d", "σ_α = 7.99°", 7.99, SweepAxis::ThetaI),
    heights("23e", SOURCE, "σ_h = 0.002, T = 0.01, λ = 0.001", [0.002, 0.01, 0.001], Shows::LobeOverSource),
    facets("23f", "σ_α = 15.416°", 15.416, SweepAxis::ThetaI),
    Figure {
        id: "24",
        title: "The three reflection components over the source angle",
        parameters: components_of_section_5::PARAMETERS,
        content: Content::Components { axis: SweepAxis::ThetaI },
    },
];

/// The figure of this id.
pub fn find(id: &str) -> Option<&'static Figure> {
    FIGURES.iter().find(|figure| figure.id == id)
}

/// One of several tables of a figure: a figure that compares models has one for each.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What it shows.
    pub label: &'static str,
    /// The scene behind it; none for figures 18 and 19.
    pub scene: Option<Scene>,
    /// The numbers.
    pub table: Table,
}

/// What a panel shows: a scene and a sweep through its directions.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// What it shows.
    pub label: &'static str,
    /// The scene.
    pub scene: Scene,
    /// The sweep.
    pub sweep: Sweep,
}

impl Figure {
    /// Whether the report draws it as a polar plot.
    pub const fn is_polar(&self) -> bool {
        matches!(self.content, Content::Components { .. })
    }

    /// The scenes behind the panels; none for figures 18 and 19, which plot a formula.
    pub fn views(&self) -> Result<Vec<View>, OutOfBounds> {
        let bs = "Beckmann-Spizzichino (47)";
        match self.content {
            Content::Heights { sigma_h, t, lambda, shows } => {
                let spike_too = [Component::SpecularLobe, Component::SpecularSpike];
                let scene = |components: &[Component], method| {
                    beckmann_spizzichino([sigma_h, t, lambda], components, method)
                };
                let lobe = || scene(&spike_too[..1], Method::Auto);
                match shows {
                    Shows::Total => Ok(vec![view(bs, scene(&spike_too, Method::Auto)?, over_view()?)]),
                    Shows::Magnified => {
                        let close = sweep(SweepAxis::ThetaR, (20.0, 40.0), 0.05, &[30.0])?;
                        Ok(vec![view(bs, scene(&spike_too, Method::Auto)?, close)])
                    }
                    Shows::Lobe => Ok(vec![view(bs, lobe()?, over_view()?)]),
                    Shows::LobeOverSource => Ok(vec![view(bs, lobe()?, over_source()?)]),
                    Shows::LobeAndRough => Ok(vec![
                        view(bs, lobe()?, over_view()?),
                        view(ROUGH, scene(&spike_too[..1], Method::Rough)?, over_view()?),
                    ]),
                }
            }
            Content::Facets { sigma_alpha, axis } => {
                let sweep = if axis == SweepAxis::ThetaR { over_view() } else { over_source() };
                let scene = torrance_sparrow(FacetSlope::new(sigma_alpha)?, Some(SpecularScale::new(1.0)?))?;
                Ok(vec![view(TS, scene, sweep?)])
            }
            Content::BothModels { sigma_alpha } => {
                let slope = FacetSlope::new(sigma_alpha)?;
                let radians = super::degrees::to_radians(sigma_alpha);
                // 13° is far inside the domain of the inverse.
                let ratio = roughness::height_to_length_ratio(radians).unwrap_or(f64::NAN);
                let rough = beckmann_spizzichino(
                    [0.01 * ratio, 0.01, 0.0001],
                    &[Component::SpecularLobe],
                    Method::Rough,
                )?;
                let facets = torrance_sparrow(slope, None)?;
                Ok(vec![view(TS, facets, over_view()?), view(ROUGH, rough, over_view()?)])
            }
            Content::Components { axis } => {
                let scene = components_of_section_5::scene()?;
                let sweep = sweep(axis, (-89.5, 89.5), 0.5, &[components_of_section_5::FIXED_ANGLE])?;
                Ok(vec![view("unified model of section 5.1", scene, sweep)])
            }
            Content::Fresnel | Content::Attenuation => Ok(Vec::new()),
        }
    }

    /// Computes the figure.
    pub fn evaluate(&self, log10: bool) -> Result<Vec<Panel>, OutOfBounds> {
        match self.content {
            Content::Fresnel => {
                Ok(vec![Panel { label: "Fresnel (62), (63)", scene: None, table: fresnel()? }])
            }
            Content::Attenuation => {
                Ok(vec![Panel { label: "V-grooves (65)", scene: None, table: attenuation()? }])
            }
            _ => self.views()?.into_iter().map(|view| view.evaluate(log10)).collect(),
        }
    }
}

impl View {
    fn evaluate(self, log10: bool) -> Result<Panel, OutOfBounds> {
        let Self { label, scene, sweep } = self;
        let output = Output { log10, per_direction: false };
        let table = sweep.evaluate(&scene, Quantity::Radiance, output, label)?;
        Ok(Panel { label, scene: Some(scene), table })
    }
}

const TS: &str = "Torrance-Sparrow (70)";
const ROUGH: &str = "Beckmann-Spizzichino, rough (49)";

fn view(label: &'static str, scene: Scene, sweep: Sweep) -> View {
    View { label, scene, sweep }
}

fn over_view() -> Result<Sweep, OutOfBounds> {
    sweep(SweepAxis::ThetaR, (-89.5, 89.5), 0.5, &FIXED)
}

fn over_source() -> Result<Sweep, OutOfBounds> {
    sweep(SweepAxis::ThetaI, (-89.5, 89.5), 0.5, &FIXED)
}

fn sweep(axis: SweepAxis, ends: (f64, f64), step: f64, at: &[f64]) -> Result<Sweep, OutOfBounds> {
    let ends = (SweepAngle::new(ends.0)?, SweepAngle::new(ends.1)?);
    let division = Division::Step(SweepStep::new(step)?);
    Ok(Sweep::divided(axis, ends, division, at.to_vec(), Azimuth::new(0.0)?))
}

/// Figure 18: F′ of a dielectric and of a metal, parallel, perpendicular and unpolarized.
fn fresnel() -> Result<Table, OutOfBounds> {
    let axis: Vec<f64> = (0..=180).map(|i| 0.5 * f64::from(i)).collect();
    let mut curves = Vec::new();
    for (n, k) in [(1.5, 0.0), (1.0, 7.0)] {
        let medium = Medium::Index(RefractiveIndex { n: IndexN::new(n)?, k: IndexK::new(k)? });
        for (name, h) in [("parallel", 1.0), ("perpendicular", 0.0), ("unpolarized", 0.5)] {
            let values = axis
                .iter()
                .map(|&angle| {
                    let energies = medium.energies(SinCos::of_degrees(angle));
                    h * energies.parallel.value + (1.0 - h) * energies.perpendicular.value
                })
                .collect();
            let column = Column { name: "fresnel_reflectance", unit: "", values };
            curves.push(Curve::plain(format!("n = {n}, k = {k}, {name}"), None, column));
        }
    }
    Ok(Table {
        quantity: "fresnel_reflectance",
        unit: "",
        axis: Column { name: "local_incidence_deg", unit: "degrees", values: axis },
        fixed: None,
        phi_r_deg: 0.0,
        curves,
    })
}

/// Figure 19: G over θ_r.
fn attenuation() -> Result<Table, OutOfBounds> {
    let axis: Vec<f64> = (-180..=180).map(|i| 0.5 * f64::from(i)).collect();
    let mut curves = Vec::new();
    for theta_i in [0.0, 30.0, 45.0, 60.0, 75.0] {
        let mut values = Vec::with_capacity(axis.len());
        for &theta_r in &axis {
            let geometry =
                Geometry::new(SourceZenith::new(theta_i)?, ViewerZenith::new(theta_r)?, Azimuth::new(0.0)?);
            values.push(ShadowingFunction::VGroove.factor(&geometry));
        }
        let column = Column { name: "geometrical_attenuation", unit: "", values };
        curves.push(Curve::plain("V-grooves (65)".to_owned(), Some(theta_i), column));
    }
    Ok(Table {
        quantity: "geometrical_attenuation",
        unit: "",
        axis: Column { name: SweepAxis::ThetaR.name(), unit: "degrees", values: axis },
        fixed: Some(SweepAxis::ThetaR.fixed_name()),
        phi_r_deg: 0.0,
        curves,
    })
}
