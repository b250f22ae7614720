//! Which components a request needs: those that all directions can do without, within the tolerance, are left out
//! before anything is computed.
//!
//! A component is left out only where its upper bound stays below a share of the others' lower bound in every
//! direction. The directions are bounded by regions, halved where a region as a whole decides nothing; a region in which the
//! component surely matters ends the search. What the search cannot afford to decide is computed: that is never wrong.

use super::directions::{Directions, Extents};
use super::envelope::{Envelopes, NOTHING};
use super::findings::Omitted;
use super::fresnel::Medium;
use super::numeric::lobe_series::Method;
use super::region::{Region, Span};
use super::scene::{Component, Components, Model, Scene};
use core::ops::Range;

/// What all omitted components together may add to the total, over the tolerance. The rest is for the lobe series.
const SHARE_OF_TOLERANCE: f64 = 0.25;
/// Regions that may be looked at: this many, and one for so many directions. A region costs about as much as a
/// direction's lobe.
const REGIONS: usize = 64;
const DIRECTIONS_PER_REGION: usize = 64;

/// What a request needs.
#[derive(Clone, Debug)]
pub(super) struct Requirement {
    /// The components to evaluate, in the model's order; at least one.
    pub(super) evaluated: Vec<Component>,
    /// The others of the model, if the caller named none.
    pub(super) omitted: Vec<Omitted>,
    /// What the omitted components add to the total at most, relative to the evaluated ones; without a spike that has no
    /// sensor, whose radiance is not known.
    pub(super) share: f64,
    /// What the directions span.
    pub(super) extents: Extents,
}

impl Requirement {
    /// Of a scene in these directions.
    pub(super) fn of(scene: &Scene, directions: &Directions) -> Self {
        let extents = directions.extents(0..directions.count());
        if scene.parameters().components != Components::Auto {
            return Self { evaluated: scene.evaluated().to_vec(), omitted: Vec::new(), share: 0.0, extents };
        }
        let mut omitted = Vec::new();
        let mut remaining = scene.evaluated().to_vec();
        for &component in scene.evaluated() {
            if let Some(reason) = nothing(scene, component)
                && remaining.len() > 1
            {
                remaining.retain(|&other| other != component);
                omitted.push(Omitted { component, bound: Some(0.0), reason });
            }
        }
        let mut share = 0.0;
        // The envelopes are those of points: of a cone's mean nothing is left out but what is 0.
        if remaining.len() > 1
            && scene.parameters().receiver.is_none()
            && let Some(found) = Search::new(scene, directions, &remaining).best()
        {
            for (component, bound) in found.bounds {
                remaining.retain(|&other| other != component);
                omitted.push(Omitted { component, bound: Some(bound), reason: negligible(scene, component) });
            }
            share = found.share;
        }
        if lacks_sensor(scene) {
            let bound = spike_share(scene, &extents);
            omitted.push(Omitted {
                component: Component::SpecularSpike,
                bound,
                reason: "the specular spike depends on the sensor's footprint and none was given: bound is its share e^-g \
                         of the reflected energy, not of the radiance",
            });
        }
        Self { evaluated: remaining, omitted, share, extents }
    }
}

/// Whether the model has a spike that cannot be evaluated for want of a sensor.
pub(super) fn lacks_sensor(scene: &Scene) -> bool {
    let p = scene.parameters();
    p.components == Components::Auto
        && p.model.components().contains(&Component::SpecularSpike)
        && !scene.evaluated().contains(&Component::SpecularSpike)
}

/// The largest e^{−g} over the directions, or above it: the spike's share of the reflected energy.
fn spike_share(scene: &Scene, extents: &Extents) -> Option<f64> {
    let roughness = scene.relative_roughness()?;
    let region = Region::new(extents, None);
    let root = 2.0 * core::f64::consts::PI * roughness.height * region.cos_sum.least;
    Some(libm::exp(-root * root))
}

/// Why a component is exactly 0 in every direction, if it is.
fn nothing(scene: &Scene, component: Component) -> Option<&'static str> {
    let surface = &scene.parameters().surface;
    let no_surface =
        matches!(surface.medium, Medium::Index(index) if index.n.get() == 1.0 && index.k.get() == 0.0);
    match component {
        Component::DiffuseLobe => {
            (surface.diffuse_albedo.get() == 0.0).then_some("diffuse_albedo is 0: there is no diffuse lobe")
        }
        _ if no_surface => Some("a medium of refractive index 1 has no surface that reflects"),
        Component::SpecularLobe if scene.parameters().model != Model::BeckmannSpizzichino => surface
            .specular_scale
            .is_some_and(|scale| scale.get() == 0.0)
            .then_some("specular_scale is 0: there are no facets"),
        _ => None,
    }
}

/// Why a component that is there does not matter.
fn negligible(scene: &Scene, component: Component) -> &'static str {
    match component {
        Component::DiffuseLobe => {
            "albedo/π cos θ_i is below a quarter of the tolerance of the specular components in every direction"
        }
        Component::SpecularSpike => {
            "e^{-g} sinc² of the patch is below a quarter of the tolerance of the lobes in every direction: the \
             surface is too rough for a spike, or the directions are too far from its mirror direction"
        }
        Component::SpecularLobe if scene.parameters().model == Model::BeckmannSpizzichino => {
            "the lobe of (47) is below a quarter of the tolerance of the spike in every direction: the surface is too \
             smooth to scatter on the area that the sensor sees"
        }
        Component::SpecularLobe => {
            "exp(-α²/2σ_α²) of the facets is below a quarter of the tolerance of the other components in every \
             direction"
        }
    }
}

/// The region of some directions.
pub(super) fn region(directions: &Directions, range: &Range<usize>) -> Region {
    let direction = (range.len() == 1).then(|| directions.geometry(range.start));
    Region::new(&directions.extents(range.clone()), direction)
}

/// Sets of components, one bit each.
type Set = usize;

/// The search for what can be left out.
struct Search<'a> {
    directions: &'a Directions,
    envelopes: Envelopes,
    components: &'a [Component],
    budget: f64,
    /// By set: whether it may still be left out, the largest share seen, and that of each component.
    open: [bool; 8],
    share: [f64; 8],
    shares: [[f64; 3]; 8],
    regions: usize,
}

/// What can be left out.
struct Found {
    bounds: Vec<(Component, f64)>,
    share: f64,
}

impl<'a> Search<'a> {
    fn new(scene: &Scene, directions: &'a Directions, components: &'a [Component]) -> Self {
        let p = scene.parameters();
        let all = (1 << components.len()) - 1;
        let mut open = [false; 8];
        for (set, open) in open.iter_mut().enumerate().take(all).skip(1) {
            // A method that was asked for by name is used.
            *open = p.accuracy.method == Method::Auto
                || p.model != Model::BeckmannSpizzichino
                || members(components, set).all(|(_, component)| component != Component::SpecularLobe);
        }
        Self {
            directions,
            envelopes: Envelopes::new(scene, components),
            components,
            budget: SHARE_OF_TOLERANCE * p.accuracy.relative_tolerance.get(),
            open,
            share: [0.0; 8],
            shares: [[0.0; 3]; 8],
            regions: REGIONS + directions.count() / DIRECTIONS_PER_REGION,
        }
    }

    /// The largest set that can be left out; of two as large, the one that costs more to evaluate.
    fn best(mut self) -> Option<Found> {
        let count = self.directions.count();
        // Single directions first: they decide most requests.
        if count > 8 {
            for index in [0, count / 2, count - 1] {
                self.decide(index..index + 1, self.open);
            }
        }
        self.decide(0..count, self.open);
        let cost = |set: Set| {
            members(self.components, set)
                .map(|(_, component)| match component {
                    Component::DiffuseLobe => 1,
                    Component::SpecularSpike => 2,
                    Component::SpecularLobe => 3,
                })
                .sum::<i32>()
        };
        let best = (1..8).filter(|&set| self.open[set]).max_by_key(|&set| (set.count_ones(), cost(set)))?;
        let bounds = members(self.components, best)
            .map(|(position, component)| (component, self.shares[best][position]))
            .collect();
        Some(Found { bounds, share: self.share[best] })
    }

    /// Decides the sets that are `asked` for over a range of directions.
    fn decide(&mut self, range: Range<usize>, asked: [bool; 8]) {
        let mut undecided: [bool; 8] = core::array::from_fn(|set| asked[set] && self.open[set]);
        if undecided == [false; 8] {
            return;
        }
        if self.regions == 0 {
            self.close(undecided);
            return;
        }
        self.regions -= 1;
        let region = region(self.directions, &range);
        let mut bounds = [NOTHING; 3];
        for (bound, &component) in bounds.iter_mut().zip(self.components) {
            *bound = self.envelopes.of(component, &region);
        }
        for (set, undecided) in undecided.iter_mut().enumerate() {
            *undecided = *undecided && !self.settles(set, &bounds);
        }
        if undecided == [false; 8] {
            return;
        }
        if range.len() == 1 {
            self.close(undecided);
            return;
        }
        let middle = range.start + range.len() / 2;
        self.decide(range.start..middle, undecided);
        self.decide(middle..range.end, undecided);
    }

    /// What is not known to be negligible is computed.
    fn close(&mut self, sets: [bool; 8]) {
        for (open, closed) in self.open.iter_mut().zip(sets) {
            *open &= !closed;
        }
    }

    /// Whether these bounds say that a set can be left out, or that it cannot.
    fn settles(&mut self, set: Set, bounds: &[Span; 3]) -> bool {
        let is_left = |position: usize| set & (1 << position) != 0;
        let kept = |bound: fn(&Span) -> f64| {
            (0..self.components.len())
                .filter(|&position| !is_left(position))
                .map(|position| bound(&bounds[position]))
                .fold(f64::NEG_INFINITY, f64::max)
        };
        // The largest alone is a lower bound of the sum; an upper one is at most three times the largest.
        let (least, most) = (kept(|span| span.least), kept(|span| span.most));
        if least == f64::NEG_INFINITY {
            return self.refuses(set, bounds, most);
        }
        let mut shares = [0.0; 3];
        for (position, share) in shares.iter_mut().enumerate().take(self.components.len()) {
            if is_left(position) {
                // Where both diverge the total does, with or without it.
                let logarithm = bounds[position].most - least;
                *share = if least == f64::INFINITY && bounds[position].least == f64::INFINITY {
                    0.0
                } else {
                    libm::exp(logarithm) * (1.0 + 1e-12)
                };
            }
        }
        let share: f64 = shares.iter().sum();
        if share <= self.budget {
            self.share[set] = self.share[set].max(share);
            for (largest, share) in self.shares[set].iter_mut().zip(shares) {
                *largest = largest.max(share);
            }
            return true;
        }
        self.refuses(set, bounds, most)
    }

    /// Whether the set surely matters in some direction; `most` bounds each of the others.
    fn refuses(&mut self, set: Set, bounds: &[Span; 3], most: f64) -> bool {
        let left = members(self.components, set)
            .map(|(position, _)| bounds[position].least)
            .fold(f64::NEG_INFINITY, f64::max);
        let matters = left - most > libm::log(3.0 * self.budget);
        self.open[set] &= !matters;
        matters
    }
}

/// The components of a set, with their positions.
fn members(components: &[Component], set: Set) -> impl Iterator<Item = (usize, Component)> + '_ {
    components.iter().copied().enumerate().filter(move |(position, _)| set & (1 << position) != 0)
}
