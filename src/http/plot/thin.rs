//! Fewer points that make the same line.

/// A point of a curve; its value is not a number where the curve has a gap.
pub(crate) type Point = (f64, f64);

/// Points of all curves of one picture together.
const MOST_POINTS: usize = 200_000;
/// Points that are kept of each column.
const KEPT: usize = 4;
/// Columns of a curve at least, however many curves there are.
const LEAST_COLUMNS: usize = 16;

/// Columns into which an axis is divided.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns {
    from: f64,
    width: f64,
}

impl Columns {
    /// Half a pixel wide, or wider where many curves share a picture.
    pub(crate) fn new((from, to): (f64, f64), pixels: usize, curves: usize) -> Self {
        let most = MOST_POINTS / (KEPT * curves.max(1));
        let count = (2 * pixels).min(most).max(LEAST_COLUMNS);
        Self { from, width: (to - from) / count as f64 }
    }

    fn of(self, x: f64) -> f64 {
        if self.width > 0.0 { ((x - self.from) / self.width).floor() } else { 0.0 }
    }

    /// Keeps of each column the first point, the least, the largest and the last, in their order: no peak is lost, and
    /// the line covers the same pixels. A gap stays a gap.
    pub(crate) fn thin(self, points: impl Iterator<Item = Point>) -> Vec<Point> {
        let mut kept: Vec<Point> = Vec::new();
        let mut column: Vec<Point> = Vec::new();
        let mut place = f64::NAN;
        for point in points {
            if !point.1.is_finite() {
                keep(&mut column, &mut kept);
                if kept.last().is_some_and(|last| last.1.is_finite()) {
                    kept.push((point.0, f64::NAN));
                }
                continue;
            }
            let here = self.of(point.0);
            if here != place {
                keep(&mut column, &mut kept);
                place = here;
            }
            column.push(point);
        }
        keep(&mut column, &mut kept);
        kept
    }
}

/// Takes what a column keeps.
fn keep(column: &mut Vec<Point>, kept: &mut Vec<Point>) {
    if column.len() <= KEPT {
        kept.append(column);
        return;
    }
    let by_value = |a: &usize, b: &usize| column[*a].1.total_cmp(&column[*b].1);
    let least = (0..column.len()).min_by(by_value).unwrap_or_default();
    let largest = (0..column.len()).max_by(by_value).unwrap_or_default();
    let mut places = [0, least.min(largest), least.max(largest), column.len() - 1].to_vec();
    places.dedup();
    kept.extend(places.into_iter().map(|place| column[place]));
    column.clear();
}

/// The stretches of a curve without gaps, inside `least` and `largest`: a line that leaves them ends where it does.
pub(super) fn runs(points: impl Iterator<Item = Point>, (least, largest): (f64, f64)) -> Vec<Vec<Point>> {
    let mut runs = Vec::new();
    let mut run: Vec<Point> = Vec::new();
    let mut before: Option<Point> = None;
    let is_inside = |point: Point| (least..=largest).contains(&point.1);
    for point in points {
        if !point.1.is_finite() {
            runs.push(std::mem::take(&mut run));
            before = None;
            continue;
        }
        match before {
            None if is_inside(point) => run.push(point),
            None => {}
            Some(before) => {
                if let Some((from, to)) = clip(before, point, (least, largest)) {
                    if run.last() != Some(&from) {
                        runs.push(std::mem::replace(&mut run, vec![from]));
                    }
                    run.push(to);
                }
            }
        }
        before = Some(point);
    }
    runs.push(run);
    runs.retain(|run| !run.is_empty());
    runs
}

/// The part of a straight line between these values.
fn clip(from: Point, to: Point, (least, largest): (f64, f64)) -> Option<(Point, Point)> {
    let low = from.1.min(to.1);
    let high = from.1.max(to.1);
    if low > largest || high < least {
        return None;
    }
    let bounded = |point: Point| {
        let value = point.1.clamp(least, largest);
        if value == point.1 {
            return point;
        }
        let share = (value - from.1) / (to.1 - from.1);
        (from.0 + share * (to.0 - from.0), value)
    };
    Some((bounded(from), bounded(to)))
}

#[cfg(test)]
mod tests {
    use super::{Columns, Point, runs};

    fn line(points: &[f64]) -> impl Iterator<Item = Point> {
        points.iter().enumerate().map(|(x, &y)| (x as f64, y))
    }

    #[test]
    fn a_million_points_keep_every_extreme() {
        let columns = Columns::new((0.0, 1e6), 500, 1);
        let value = |i: i32| if i == 333_333 { 9.0 } else { f64::from(i % 7) };
        let kept = columns.thin((0..1_000_000).map(|i| (f64::from(i), value(i))));
        assert!(kept.len() <= 4 * 1000, "{}", kept.len());
        assert!(kept.contains(&(333_333.0, 9.0)));
        assert!(kept.is_sorted_by(|a, b| a.0 < b.0));
        for column in 0..1000 {
            let [from, to] = [column, column + 1].map(|edge| f64::from(edge) * 1000.0);
            let values: Vec<f64> = kept.iter().filter(|p| p.0 >= from && p.0 < to).map(|p| p.1).collect();
            assert!(values.contains(&0.0) && values.iter().any(|&value| value >= 6.0), "{column}");
        }
    }

    #[test]
    fn few_points_stay_as_they_are() {
        let columns = Columns::new((0.0, 3.0), 500, 1);
        let points = [(0.0, 1.0), (1.0, 2.0), (2.0, 0.5), (3.0, 1.0)];
        assert_eq!(columns.thin(points.into_iter()), points);
        // A sweep without length has one column.
        assert_eq!(Columns::new((5.0, 5.0), 500, 1).thin([(5.0, 2.0)].into_iter()), [(5.0, 2.0)]);
    }

    #[test]
    fn what_is_no_number_parts_a_line() {
        let points = [f64::NAN, 1.0, 2.0, f64::INFINITY, f64::NAN, 3.0, f64::NEG_INFINITY];
        let kept = Columns::new((0.0, 6.0), 500, 1).thin(line(&points));
        assert_eq!(kept.iter().filter(|point| point.1.is_nan()).count(), 2);
        let runs = runs(kept.into_iter(), (0.0, 9.0));
        assert_eq!(runs, [vec![(1.0, 1.0), (2.0, 2.0)], vec![(5.0, 3.0)]]);
    }

    #[test]
    fn a_line_ends_at_the_edge() {
        assert_eq!(
            runs(line(&[0.0, 4.0, 0.0]), (1.0, 2.0)),
            [vec![(0.25, 1.0), (0.5, 2.0)], vec![(1.5, 2.0), (1.75, 1.0)]]
        );
        assert!(runs(line(&[5.0, 6.0]), (1.0, 2.0)).is_empty());
        assert!(runs(line(&[]), (1.0, 2.0)).is_empty());
    }
}
