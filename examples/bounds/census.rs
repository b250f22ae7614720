//! Every method's error and bound against the converged sum.

use crate::points::{Random, point};
use reflectance::reflectance::estimate::Estimate;
use reflectance::reflectance::numeric::dispatch::InstructionSet;
use reflectance::reflectance::numeric::lobe_series::lanes::{self, Batch, Choice, LANES, Lanes};
use reflectance::reflectance::numeric::lobe_series::patches::{self, Tier};
use reflectance::reflectance::numeric::lobe_series::{LobeSeries, Method, between, evaluate};
use reflectance::reflectance::numeric::scaled::Scaled;

/// Bounds above this say that a method does not serve.
const USEFUL: f64 = 0.5;
/// Errors below this are rounding.
const ROUNDING: f64 = 1e-14;
/// Bins of the histogram to an octave, and in all.
const BINS_AN_OCTAVE: f64 = 32.0;
const BINS: usize = 1280;

/// What was seen of one method.
#[derive(Clone)]
pub(crate) struct Seen {
    /// Its name.
    pub(crate) name: String,
    /// Points where it serves: bound ≤ 0.5 and an error that is more than rounding.
    pub(crate) useful: u64,
    /// Largest error over bound where it serves.
    pub(crate) largest_share: f64,
    /// Largest bound over error where it serves, and where that is.
    pub(crate) most_idle: (f64, f64, f64),
    /// Points where the error is above the bound or the conditions of S are missed.
    pub(crate) violations: u64,
    /// The first of them.
    pub(crate) examples: Vec<String>,
    histogram: Vec<u64>,
}

impl Seen {
    fn of(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            useful: 0,
            largest_share: 0.0,
            most_idle: (0.0, 0.0, 0.0),
            violations: 0,
            examples: Vec::new(),
            histogram: vec![0; BINS],
        }
    }

    fn violation(&mut self, g: f64, x: f64, what: &str) {
        self.violations += 1;
        if self.examples.len() < 5 {
            self.examples.push(format!("{} at g = {g:e}, x = {x:e}: {what}", self.name));
        }
    }

    fn ratio(&mut self, g: f64, x: f64, ratio: f64) {
        self.useful += 1;
        self.largest_share = self.largest_share.max(1.0 / ratio);
        if ratio > self.most_idle.0 {
            self.most_idle = (ratio, g, x);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 or more; saturates")]
        let bin = (ratio.log2().max(0.0) * BINS_AN_OCTAVE) as usize;
        self.histogram[bin.min(BINS - 1)] += 1;
    }

    /// Median of bound over error where the method serves.
    pub(crate) fn median(&self) -> f64 {
        let mut before = 0;
        for (bin, count) in self.histogram.iter().enumerate() {
            before += count;
            if 2 * before >= self.useful && before > 0 {
                return ((bin as f64 + 0.5) / BINS_AN_OCTAVE).exp2();
            }
        }
        f64::NAN
    }

    fn merge(&mut self, other: &Self) {
        self.useful += other.useful;
        self.largest_share = self.largest_share.max(other.largest_share);
        if other.most_idle.0 > self.most_idle.0 {
            self.most_idle = other.most_idle;
        }
        self.violations += other.violations;
        self.examples.extend(other.examples.iter().take(5).cloned());
        for (mine, others) in self.histogram.iter_mut().zip(&other.histogram) {
            *mine += others;
        }
    }
}

/// The methods, one point at a time and in batches, and the enclosure that needs no method.
pub(crate) struct Census {
    /// One entry a method.
    pub(crate) methods: Vec<(Method, Seen)>,
    /// One entry for each truncation that a batch can be asked for.
    pub(crate) tiers: Vec<(&'static Tier, Seen)>,
    /// [`between`], its ratio that of its ends.
    pub(crate) between: Seen,
}

impl Census {
    /// Of `count` points that `seed` draws.
    pub(crate) fn take(count: u64, seed: u64) -> Self {
        let methods = Method::ALL.into_iter().filter(|m| *m != Method::Series);
        let tiers = patches::ALL.into_iter();
        let mut census = Self {
            methods: methods.map(|m| (m, Seen::of(m.name()))).collect(),
            tiers: tiers.map(|t| (t, Seen::of(&format!("batch to {:.1e}", t.truncation)))).collect(),
            between: Seen::of("between"),
        };
        let mut random = Random::new(seed);
        let (mut g, mut x): (Lanes, Lanes) = ([0.0; LANES], [0.0; LANES]);
        for _ in 0..count.div_ceil(LANES as u64) {
            for (g, x) in g.iter_mut().zip(&mut x) {
                (*g, *x) = point(&mut random);
            }
            census.look_at_all(&g, &x);
        }
        census
    }

    /// Adds what another has seen.
    pub(crate) fn merge(&mut self, other: &Self) {
        for ((_, mine), (_, others)) in self.methods.iter_mut().zip(&other.methods) {
            mine.merge(others);
        }
        for ((_, mine), (_, others)) in self.tiers.iter_mut().zip(&other.tiers) {
            mine.merge(others);
        }
        self.between.merge(&other.between);
    }

    /// All that was seen.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Seen> {
        let methods = self.methods.iter().map(|(_, seen)| seen);
        methods.chain(self.tiers.iter().map(|(_, seen)| seen)).chain([&self.between])
    }

    fn look_at_all(&mut self, g: &Lanes, x: &Lanes) {
        let series: Vec<_> = g.iter().zip(x).map(|(&g, &x)| evaluate(Method::Series, g, x)).collect();
        for ((&g, &x), series) in g.iter().zip(x).zip(&series) {
            self.look_at(g, x, series);
        }
        let mut batch = Batch::new();
        for (tier, seen) in &mut self.tiers {
            lanes::evaluate(InstructionSet::widest(), Choice::auto(tier), g, x, &mut batch);
            for (place, series) in series.iter().enumerate() {
                let Some(value) = batch.get(place) else { continue };
                let ratio = compare(seen, g[place], x[place], &value, series);
                // The closed forms are the named methods'.
                let own = !matches!(value.method, Method::Smooth | Method::Rough);
                if let Some(ratio) = ratio.filter(|_| own) {
                    seen.ratio(g[place], x[place], ratio);
                }
                if batch.truncation[place] > tier.truncation {
                    seen.violation(g[place], x[place], "more is left out than asked");
                }
            }
        }
    }

    fn look_at(&mut self, g: f64, x: f64, series: &LobeSeries) {
        for (method, seen) in &mut self.methods {
            let value = evaluate(*method, g, x);
            if let Some(ratio) = compare(seen, g, x, &value, series) {
                seen.ratio(g, x, ratio);
            }
        }
        let (low, high) = between(g, x);
        let Estimate { value, error, least } = series.estimate;
        if above(low, value + error) || above(least, high) {
            self.between.violation(g, x, "S is outside");
        }
        // Where the sum has digits, so have the two ends.
        if series.estimate.relative_error() < 1e-3 && !value.is_zero() {
            self.between.ratio(g, x, (high / low).to_f64());
        }
    }
}

/// Notes what is wrong; the ratio of bound to error where the method serves.
fn compare(seen: &mut Seen, g: f64, x: f64, value: &LobeSeries, series: &LobeSeries) -> Option<f64> {
    let (mine, exact) = (value.estimate, series.estimate);
    if mine.value.is_nan() || mine.error.is_nan() || mine.least.is_nan() {
        seen.violation(g, x, "not a number");
        return None;
    }
    let off = mine.value.distance(exact.value);
    if above(off, mine.error + exact.error) {
        seen.violation(g, x, "the error is above its bound");
    }
    if above(mine.least, exact.value + exact.error) {
        seen.violation(g, x, "S is below its least value");
    }
    // A method may know the conditions to a few per cent and 1.
    let misses = |mine: f64, series: f64| mine.is_nan() || 1.1 * mine + 1.0 < series;
    if misses(value.condition_g, series.condition_g) || misses(value.condition_x, series.condition_x) {
        seen.violation(g, x, "a condition is understated");
    }
    let (bound, error) = (mine.relative_error(), (off / exact.value).to_f64());
    let serves = bound <= USEFUL && error > ROUNDING.max(4.0 * exact.relative_error());
    serves.then(|| bound / error)
}

/// Whether `a` is above `b`.
fn above(a: Scaled, b: Scaled) -> bool {
    a.larger(b) != b
}
