//! From a scene and directions to answers, one pass, no allocation per direction.
//! (interface; body follows)

use super::numeric::lobe_series::Method;
use super::quantity::{Azimuth, SourceZenith, ViewerZenith};
use super::scene::{Component, Scene};

/// Radiance L_r (2) or BRDF f_r = L_r/I_s (3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity { Radiance, Brdf }

/// One angle for all directions, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum Angles<A> { One(A), Each(Vec<A>) }

/// N directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Directions {
    theta_i: Angles<SourceZenith>,
    theta_r: Angles<ViewerZenith>,
    phi_r: Angles<Azimuth>,
    count: usize,
}

/// Why three sets of angles are not directions.
pub enum DirectionsError { Empty{angle: DirectionAngle}, UnequalLengths{ lengths: [(DirectionAngle, usize);3] }, TooMany{count: usize, most: usize, angle: DirectionAngle} }

/// What to add to the answer.
pub struct Output { pub log10: bool, pub per_direction: bool }

/// One component's values. NaN and infinities are explained by a diagnostic.
pub struct ComponentColumn { pub component: Component, pub values: Vec<f64>, pub log10: Option<Vec<f64>> }

pub struct Evaluation {
    pub total: Vec<f64>,
    pub log10_total: Option<Vec<f64>>,
    pub components: Vec<ComponentColumn>,
    pub relative_error_bound: Vec<f64>,
    /// directions evaluated by each method, in fixed order, zero counts left out
    pub methods: Vec<(EvaluatedBy, usize)>,
    pub method: Option<Vec<EvaluatedBy>>,
    pub roughness_g: Option<Vec<f64>>,
    pub omitted: Vec<Omitted>,
    pub warnings: Vec<Warning>,
    pub diagnostics: Vec<Diagnostic>,
}
pub struct Omitted { pub component: Component, pub bound: Option<f64>, pub reason: String }
pub struct Warning { pub code: WarningCode, pub detail: String, pub value: Option<f64>, pub indices: Vec<usize> /* ≤ 20 */, pub count: usize }
pub struct Diagnostic { pub index: usize, pub code: DiagnosticCode }  // DiagnosticCode::name(), ::detail()
