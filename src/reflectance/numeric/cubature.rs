//! Integrals over unit squares, cut where they need it: a Gauss-Kronrod rule of 15 points along each side (A. S. Kronrod,
//! *Nodes and weights of quadrature formulas*, 1965), whose 7 Gauss points tell the error of each side apart.
//!
//! Whoever calls maps its domain to squares on which the integrand is smooth and no feature of it is narrow. Then the
//! Gauss rule errs far more than Kronrod's, and their difference, twice which is the error stated, far exceeds the true one.

use super::EPSILON;
use std::collections::BinaryHeap;

/// Points along a side.
pub const NODES: usize = 15;

/// Kronrod's nodes on [0, 1] and their weights; the odd ones are Gauss's, with theirs, 0 at the others.
const RULE: [(f64, f64, f64); NODES] = rule();

/// The error stated is so many times as far as Gauss's rule is from Kronrod's.
const SAFETY: f64 = 2.0;

/// Of the nodes on [−1, 1], those that are not negative, the largest first.
const HALF: [(f64, f64, f64); 8] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
    (0.949_107_912_342_758_5, 0.063_092_092_629_978_56, 0.129_484_966_168_869_7),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_19, 0.0),
    (0.741_531_185_599_394_5, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9),
    (0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0),
    (0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
];

const fn rule() -> [(f64, f64, f64); NODES] {
    let mut rule = [(0.0, 0.0, 0.0); NODES];
    let mut i = 0;
    while i < HALF.len() {
        let (node, kronrod, gauss) = HALF[i];
        rule[i] = (0.5 * (1.0 - node), 0.5 * kronrod, 0.5 * gauss);
        rule[NODES - 1 - i] = (0.5 * (1.0 + node), 0.5 * kronrod, 0.5 * gauss);
        i += 1;
    }
    rule
}

/// The integrand at the points of a rule over one rectangle.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Positions along the first side.
    pub first: [f64; NODES],
    /// Positions along the second side.
    pub second: [f64; NODES],
    /// f at (`first[i]`, `second[j]`), by `[i][j]`.
    pub values: [[f64; NODES]; NODES],
    /// Bounds of the errors of the values.
    pub errors: [[f64; NODES]; NODES],
}

/// What came out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubature {
    /// The integral.
    pub value: f64,
    /// The error of the rule and of the sums, and what the errors of the values add up to.
    pub error: f64,
    /// Points at which the integrand was taken.
    pub evaluations: usize,
}

/// How good an integral is to be.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Relative to the value and what is beside it.
    pub tolerance: f64,
    /// What the integral is a part of, without it.
    pub beside: f64,
    /// Rectangles at most.
    pub most: usize,
    /// Whether the integrand has kinks inside of squares, where both rules may be off by the same: then each rectangle is halved
    /// along both sides at least once, and by what that changed the halves may be off as well.
    pub has_kinks: bool,
}

/// A rectangle and its share of the integral.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    square: usize,
    low: [f64; 2],
    high: [f64; 2],
    value: f64,
    /// Of the rule, along each side.
    errors: [f64; 2],
    /// Of the values.
    inherited: f64,
    /// Sides along which it has to be halved whatever the rule says.
    unsure: [bool; 2],
}

impl Rectangle {
    /// Nothing is known of its sides until it was halved along them.
    fn doubted(mut self, sides: [bool; 2]) -> Self {
        for (side, is_unsure) in sides.into_iter().enumerate() {
            if is_unsure {
                self.errors[side] = self.errors[side].max(self.value.abs());
                self.unsure[side] = true;
            }
        }
        self
    }

    fn error(&self) -> f64 {
        self.errors[0] + self.errors[1]
    }
}

impl Ord for Rectangle {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        self.error().total_cmp(&other.error())
    }
}

impl PartialOrd for Rectangle {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Rectangle {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Rectangle {}

/// ∫∫ `f` over all of so many unit squares together.
///
/// `f` fills a [`Grid`] whose positions are set, of the square of this index; the integrand may not be negative. Halves the
/// rectangle with the largest error, along the side that errs more, until the errors add up to the tolerance, or to a tenth of
/// what the values and their sums bring along, or there are too many rectangles: then the error is what it is. None as soon as `is_over` says so.
pub fn integrate(
    squares: usize,
    goal: Goal,
    is_over: impl Fn() -> bool,
    mut f: impl FnMut(usize, &mut Grid),
) -> Option<Cubature> {
    let zero = [[0.0; NODES]; NODES];
    let mut grid = Grid { first: [0.0; NODES], second: [0.0; NODES], values: zero, errors: zero };
    let mut measure = |square, low, high| {
        place(&mut grid, low, high);
        f(square, &mut grid);
        weigh(&grid, square, low, high)
    };
    let mut rectangles = BinaryHeap::with_capacity(2 * squares);
    for square in 0..squares {
        if is_over() {
            return None;
        }
        rectangles.push(measure(square, [0.0; 2], [1.0; 2]).doubted([goal.has_kinks; 2]));
    }
    let mut evaluated = squares;
    loop {
        let Sums { value, error, inherited } = Sums::of(&rectangles);
        // Bounds jump where what they bound changes its form: the rule may take too few of them into account. Each rectangle
        // sums 30 terms, one after the other, and those sums are added up.
        let rest = 2.0 * inherited + EPSILON * (64.0 + rectangles.len() as f64) * value;
        let aim = (goal.tolerance * (value + goal.beside)).max(0.1 * rest);
        // Infinities and what is not a number cannot be refined.
        if error <= aim || rectangles.len() >= goal.most || !error.is_finite() {
            return Some(Cubature { value, error: error + rest, evaluations: evaluated * NODES * NODES });
        }
        // Those that have to be halved in any case, at once: sums are not formed for each.
        let share = aim / (2.0 * rectangles.len() as f64);
        let mut halve = Vec::new();
        while let Some(worst) = rectangles.peek().copied() {
            if !halve.is_empty() && worst.error() <= share.max(error / 16.0) {
                break;
            }
            halve.push(worst);
            rectangles.pop();
        }
        for whole in halve {
            if is_over() {
                return None;
            }
            let side = usize::from(whole.errors[1] > whole.errors[0]);
            let middle = 0.5 * (whole.low[side] + whole.high[side]);
            let (mut low, mut high) = (whole.low, whole.high);
            low[side] = middle;
            high[side] = middle;
            let mut halves = [measure(whole.square, whole.low, high), measure(whole.square, low, whole.high)];
            if goal.has_kinks {
                let change = (halves[0].value + halves[1].value - whole.value).abs();
                let mut unsure = whole.unsure;
                unsure[side] = false;
                for half in &mut halves {
                    half.errors[side] = half.errors[side].max(change);
                    if !whole.unsure[1 - side] {
                        half.errors[1 - side] = half.errors[1 - side].max(0.5 * whole.errors[1 - side]);
                    }
                    *half = half.doubted(unsure);
                }
            }
            rectangles.extend(halves);
            evaluated += 2;
        }
    }
}

/// Of all rectangles.
#[derive(Default)]
struct Sums {
    value: f64,
    error: f64,
    inherited: f64,
}

impl Sums {
    fn of(rectangles: &BinaryHeap<Rectangle>) -> Self {
        rectangles.iter().fold(Self::default(), |sums, rectangle| Self {
            value: sums.value + rectangle.value,
            error: sums.error + rectangle.error(),
            inherited: sums.inherited + rectangle.inherited,
        })
    }
}

fn place(grid: &mut Grid, low: [f64; 2], high: [f64; 2]) {
    for (i, (node, ..)) in RULE.into_iter().enumerate() {
        grid.first[i] = low[0] + (high[0] - low[0]) * node;
        grid.second[i] = low[1] + (high[1] - low[1]) * node;
    }
}

/// Kronrod's rule along both sides, and how far Gauss's is from it along each line of points: the sum of those distances
/// bounds the error, while the distance of their sums may cancel.
fn weigh(grid: &Grid, square: usize, low: [f64; 2], high: [f64; 2]) -> Rectangle {
    let area = (high[0] - low[0]) * (high[1] - low[1]);
    let (mut value, mut first, mut second, mut inherited) = (0.0, 0.0, 0.0, 0.0);
    // Kronrod's less Gauss's along the first side.
    let mut apart = [0.0; NODES];
    for (i, (_, kronrod, gauss)) in RULE.into_iter().enumerate() {
        let (mut row, mut row_apart, mut row_error) = (0.0, 0.0, 0.0);
        for (j, (_, along, along_gauss)) in RULE.into_iter().enumerate() {
            let value = grid.values[i][j];
            row += along * value;
            row_apart += (along - along_gauss) * value;
            row_error += along * grid.errors[i][j];
            apart[j] += (kronrod - gauss) * value;
        }
        value += kronrod * row;
        second += kronrod * row_apart.abs();
        inherited += kronrod * row_error;
    }
    for (apart, (_, kronrod, _)) in apart.into_iter().zip(RULE) {
        first += kronrod * apart.abs();
    }
    let errors = [SAFETY * first * area, SAFETY * second * area];
    Rectangle {
        square,
        low,
        high,
        value: value * area,
        errors,
        inherited: inherited * area,
        unsure: [false; 2],
    }
}

#[cfg(test)]
mod tests {
    use super::{Cubature, Goal, RULE, integrate};
    use crate::reflectance::numeric::EPSILON;

    fn over_squares(tolerance: f64, f: impl Fn(usize, f64, f64) -> f64) -> Cubature {
        integrate(
            2,
            Goal { tolerance, beside: 0.0, most: 2000, has_kinks: false },
            || false,
            |square, grid| {
                for i in 0..super::NODES {
                    for j in 0..super::NODES {
                        grid.values[i][j] = f(square, grid.first[i], grid.second[j]);
                        grid.errors[i][j] = 1e-20;
                    }
                }
            },
        )
        .unwrap()
    }

    #[test]
    fn the_rules_are_exact_for_polynomials_up_to_their_degree() {
        for degree in 0..=22 {
            let (kronrod, gauss) = RULE.into_iter().fold((0.0, 0.0), |(kronrod, gauss), (x, k, g)| {
                (kronrod + k * libm::pow(x, f64::from(degree)), gauss + g * libm::pow(x, f64::from(degree)))
            });
            let exact = 1.0 / f64::from(degree + 1);
            // Fifteen weights and powers, each rounded.
            assert!((kronrod - exact).abs() < 32.0 * EPSILON, "{degree}: {kronrod}");
            assert_eq!((gauss - exact).abs() < 32.0 * EPSILON, degree <= 13, "{degree}: {gauss}");
        }
    }

    #[test]
    fn errors_hold_and_are_below_the_tolerance() {
        // ∫∫ e^{−30(x + 2y)} and, on the second square, 1/(1 + 100 (x − y)²).
        let exponential = |k: f64| (1.0 - libm::exp(-k)) / k;
        let ridge = |z: f64| {
            // ∫∫ 1/(1 + k²(x − y)²) = (2/k) atan k − ln(1 + k²)/k²
            2.0 / z * libm::atan(z) - libm::log1p(z * z) / (z * z)
        };
        let exact = exponential(30.0) * exponential(60.0) + ridge(10.0);
        for tolerance in [1e-2, 1e-6, 1e-10] {
            let got = over_squares(tolerance, |square, x, y| {
                if square == 0 {
                    libm::exp(-30.0 * (x + 2.0 * y))
                } else {
                    1.0 / (1.0 + 100.0 * (x - y) * (x - y))
                }
            });
            assert!(got.error <= 1.01 * tolerance * got.value, "{got:?}");
            assert!((got.value - exact).abs() <= got.error, "{tolerance}: {got:?} {exact}");
        }
    }

    #[test]
    fn a_jump_is_not_met_and_its_error_holds() {
        let got = over_squares(1e-10, |_, x, y| if x + y < 0.7 { 1.0 } else { 0.0 });
        assert!((got.value - 0.49).abs() <= got.error, "{got:?}");
        assert!(got.error < 1e-3 && got.error > 1e-10, "{got:?}");
    }

    #[test]
    fn a_kink_where_both_rules_are_off_by_the_same_is_doubted() {
        // |x − c|, the same along the other side: the rules agree at some c of any square, where neither is right. Where the
        // kink lies before the first point of a half, at 0.0043, no rule can tell: c keeps away from there.
        let worst = |has_kinks| {
            let off = |step: i32| {
                let c = 0.5 * f64::from(step) / 1000.0;
                let goal = Goal { tolerance: 1e-2, beside: 0.0, most: 2000, has_kinks };
                let fill = |_, grid: &mut super::Grid| {
                    for i in 0..super::NODES {
                        grid.values[i] = [(grid.first[i] - c).abs(); super::NODES];
                        grid.errors[i] = [0.0; super::NODES];
                    }
                };
                let got = integrate(1, goal, || false, fill).unwrap();
                let exact = 0.5 * (c * c + (1.0 - c) * (1.0 - c));
                (got.value - exact).abs() / got.error
            };
            (20..980).map(off).fold(0.0, f64::max)
        };
        // Measured: the largest error over its bound. Whoever has such kinks allows for that.
        let [trusted, doubted] = [false, true].map(worst);
        assert!((510.0..520.0).contains(&trusted) && (5.5..6.5).contains(&doubted), "{trusted} {doubted}");
    }

    #[test]
    fn nobody_waits_for_what_is_over() {
        assert!(
            integrate(
                1,
                Goal { tolerance: 1e-3, beside: 0.0, most: 10, has_kinks: false },
                || true,
                |_, _| {}
            )
            .is_none()
        );
    }
}
