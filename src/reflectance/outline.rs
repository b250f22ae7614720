//! What of a scene is given: enough to check its parts against each other, also where some part could not be
//! understood, so that everything that is wrong is told at once.

use super::bounds::{self, Bounds};
use super::fresnel_average::FresnelAverage;
use super::quantity::{CorrelationLength, FacetSlope, RmsHeight};
use super::scene::{Component, Components, Model, SceneParameters};
use super::shadowing::Shadowing;

/// A parameter by the name the core knows it by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "each is a field of SceneParameters")]
pub enum Parameter {
    RmsHeight,
    CorrelationLength,
    FacetSlope,
    SpecularScale,
    Wavelength,
    Sensor,
}

/// Why parameters that are each in range do not make a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneError {
    /// A parameter that the model or a component needs is absent.
    Missing {
        /// Which.
        parameter: Parameter,
        /// What needs it.
        needed_by: &'static str,
        /// What could be given in its place.
        unless: Option<Parameter>,
    },
    /// The model has no such component.
    NotInModel {
        /// Position in the list of components.
        position: usize,
        /// Which component.
        component: Component,
        /// Of this model.
        model: Model,
    },
    /// A component is named twice.
    Repeated {
        /// Position in the list of components.
        position: usize,
        /// Which component.
        component: Component,
    },
    /// The list of components is empty.
    NoComponents,
    /// The facets are too steep, or not steep enough, for what is asked for.
    Slope {
        /// What says how steep they are: σ_α, or σ_h for σ_h/T.
        parameter: Parameter,
        /// What it is.
        value: f64,
        /// What it is for.
        needed_by: &'static str,
        /// What would be accepted.
        accepted: &'static Bounds,
    },
}

/// What says how steep the facets are and what depends on it; each none where it is not given or not known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slopes {
    /// σ_h
    pub rms_height: Option<RmsHeight>,
    /// T
    pub correlation_length: Option<CorrelationLength>,
    /// σ_α
    pub facet_slope: Option<FacetSlope>,
    /// How facets hide each other.
    pub shadowing: Option<Shadowing>,
    /// Over what F is averaged.
    pub fresnel_average: Option<FresnelAverage>,
}

impl Slopes {
    /// What is wrong with a lobe that has a σ_α of its own, or not.
    fn errors(&self, has_own: bool) -> Vec<SceneError> {
        let parameter = if has_own { Parameter::FacetSlope } else { Parameter::RmsHeight };
        let heights = self.rms_height.zip(self.correlation_length);
        let of_heights = heights.map(|(height, length)| height.get() / length.get());
        let of_angles = self.facet_slope.map(FacetSlope::get);
        let Some(value) = (if has_own { of_angles } else { of_heights }) else { return Vec::new() };
        // Any slope of heights is right for Smith's Λ.
        let smith = (has_own && self.shadowing.is_some_and(Shadowing::needs_slope))
            .then_some(("Smith's shadowing", &bounds::FACET_SLOPE_INVERTIBLE));
        let accepted = if has_own { &bounds::FACET_SLOPE_AVERAGED } else { &bounds::SLOPE_AVERAGED };
        let average = (self.fresnel_average == Some(FresnelAverage::SlopeAverage))
            .then_some(("the average of F over the slopes", accepted));
        let needs = smith.into_iter().chain(average);
        needs
            .filter(|(_, accepted)| !accepted.contains(value))
            .map(|(needed_by, accepted)| SceneError::Slope { parameter, value, needed_by, accepted })
            .collect()
    }
}

/// The components asked for, as far as they are known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Listed {
    /// Those that matter.
    Auto,
    /// These; None where an entry is not known.
    Named(Vec<Option<Component>>),
}

/// What is known of a scene. Nothing is concluded from a part that is not known.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The model, if known.
    pub model: Option<Model>,
    /// The components, if known.
    pub components: Option<Listed>,
    /// The parameters that are certainly not given.
    pub absent: Vec<Parameter>,
    /// How steep the facets are.
    pub slopes: Slopes,
}

impl Outline {
    pub(super) fn of(parameters: &SceneParameters) -> Self {
        let p = parameters;
        let absences = [
            (p.surface.rms_height.is_none(), Parameter::RmsHeight),
            (p.surface.correlation_length.is_none(), Parameter::CorrelationLength),
            (p.surface.facet_slope.is_none(), Parameter::FacetSlope),
            (p.surface.specular_scale.is_none(), Parameter::SpecularScale),
            (p.illumination.wavelength.is_none(), Parameter::Wavelength),
            // A receiver of finite size reads a sharp spike, of whatever patch.
            (p.sensor.is_none() && p.receiver.is_none(), Parameter::Sensor),
        ];
        Self {
            model: Some(p.model),
            components: Some(match &p.components {
                Components::Auto => Listed::Auto,
                Components::Named(named) => Listed::Named(named.iter().copied().map(Some).collect()),
            }),
            absent: absences.into_iter().filter_map(|(absent, which)| absent.then_some(which)).collect(),
            slopes: Slopes {
                rms_height: p.surface.rms_height,
                correlation_length: p.surface.correlation_length,
                facet_slope: p.surface.facet_slope,
                shadowing: p.surface.shadowing,
                fresnel_average: p.surface.fresnel_average,
            },
        }
    }

    /// All that is wrong.
    pub fn errors(&self) -> Vec<SceneError> {
        let mut errors = self.listing();
        if let (Some(model), Some(listed)) = (self.model, &self.components) {
            let evaluated = self.evaluated(model, listed);
            errors.extend(self.missing(model, &evaluated));
            if evaluated.contains(&Component::SpecularLobe) {
                let has_own = model != Model::BeckmannSpizzichino && !self.is_absent(Parameter::FacetSlope);
                errors.extend(self.slopes.errors(has_own));
            }
        }
        errors
    }

    fn is_absent(&self, parameter: Parameter) -> bool {
        self.absent.contains(&parameter)
    }

    /// The components that an evaluation answers, in the model's order.
    pub(super) fn evaluated(&self, model: Model, listed: &Listed) -> Vec<Component> {
        let asked_for = |component: Component| match listed {
            Listed::Auto => component != Component::SpecularSpike || !self.is_absent(Parameter::Sensor),
            Listed::Named(named) => named.contains(&Some(component)),
        };
        model.components().iter().copied().filter(|&component| asked_for(component)).collect()
    }

    /// What is wrong with the list of components itself.
    fn listing(&self) -> Vec<SceneError> {
        let Some(Listed::Named(named)) = &self.components else { return Vec::new() };
        if named.is_empty() {
            return vec![SceneError::NoComponents];
        }
        let mut errors = Vec::new();
        let mut seen = [false; Component::ALL.len()];
        for (position, component) in named.iter().enumerate() {
            let Some(component) = *component else { continue };
            let foreign = self.model.filter(|model| !model.components().contains(&component));
            if let Some(model) = foreign {
                errors.push(SceneError::NotInModel { position, component, model });
            } else if std::mem::replace(&mut seen[component.index()], true) {
                errors.push(SceneError::Repeated { position, component });
            }
        }
        errors
    }

    /// The parameters that the evaluated components need and that are not given.
    fn missing(&self, model: Model, evaluated: &[Component]) -> Vec<SceneError> {
        const HEIGHT_LOBE: (&str, Option<Parameter>) = ("the Beckmann-Spizzichino specular lobe", None);
        const SPIKE: (&str, Option<Parameter>) = ("the specular spike", None);
        const SHARED_LOBE: (&str, Option<Parameter>) =
            ("the unified model's specular lobe", Some(Parameter::SpecularScale));
        const SLOPE: (&str, Option<Parameter>) = ("the facet slope by (79)", Some(Parameter::FacetSlope));
        let lobe = evaluated.contains(&Component::SpecularLobe);
        let spike = evaluated.contains(&Component::SpecularSpike).then_some(SPIKE);
        let height_lobe = (lobe && model == Model::BeckmannSpizzichino).then_some(HEIGHT_LOBE);
        let slope = (lobe && height_lobe.is_none() && self.is_absent(Parameter::FacetSlope)).then_some(SLOPE);
        // Spike and lobe share the reflected energy by e^{-g} unless the caller scales the lobe.
        let shared_lobe = (lobe && model == Model::Unified && self.is_absent(Parameter::SpecularScale))
            .then_some(SHARED_LOBE);
        let needs = [
            (Parameter::RmsHeight, height_lobe.or(spike).or(shared_lobe).or(slope)),
            (Parameter::CorrelationLength, height_lobe.or(slope)),
            (Parameter::Wavelength, height_lobe.or(spike).or(shared_lobe)),
            (Parameter::Sensor, spike),
        ];
        needs
            .into_iter()
            .filter(|(parameter, _)| self.is_absent(*parameter))
            .filter_map(|(parameter, need)| {
                need.map(|(needed_by, unless)| SceneError::Missing { parameter, needed_by, unless })
            })
            .collect()
    }
}
