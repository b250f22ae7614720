//! Answers as rows: angles, then the columns of numbers, then methods. Nothing is kept of a stretch once it is written.

use super::columns::headings;
use super::output::{End, Output};
use super::work::{Curve, Model, Over, Subject, Work};
use crate::http::api::answer::{OmittedAnswer, WarningAnswer};
use crate::http::api::light::MediumAnswer;
use crate::http::compute::job::Job;
use crate::http::encode::rows::{Cells, Head, Heading, Kind, RowFormat, Rows};
use crate::http::problem::Problem;
use crate::reflectance::directions::AngleColumn;
use crate::reflectance::evaluate::EvaluatedBy;
use crate::reflectance::scene::Component;
use futures_util::{StreamExt as _, pin_mut};
use serde::Serialize;
use std::ops::Range;
use std::sync::Arc;

/// What is to be said of a curve before its values are known.
#[derive(Serialize)]
struct Note {
    #[serde(skip_serializing_if = "Option::is_none")]
    wavelength_um: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    medium: Option<MediumAnswer>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at_deg: Option<f64>,
    omitted: Vec<OmittedAnswer>,
    warnings: Vec<WarningAnswer>,
}

/// The first column of a spectrum.
const WAVELENGTH: &str = "wavelength_um";

/// The head of a table, and its curves made ready: which columns there are is known only when all are.
struct Table {
    format: RowFormat,
    head: Head,
    curves: Vec<Curve>,
}

/// A small answer, at once.
pub(super) fn whole(work: &Work, format: RowFormat) -> Result<Vec<u8>, Problem> {
    let curves = (0..work.curves()).map(|index| work.prepare(index, || false)).collect::<Result<_, _>>()?;
    let table = Table::new(work, format, curves)?;
    let mut bytes = format.head(&table.head)?;
    bytes.append(&mut table.rows(work, 0..work.curves(), &(0..work.points()), || false)?);
    bytes.append(&mut format.tail(&table.head)?);
    Ok(bytes)
}

/// A large answer, part by part.
pub(super) async fn stream(work: Arc<Work>, format: RowFormat, output: Output) -> Result<(), End> {
    let mut curves = Vec::with_capacity(work.curves());
    {
        let groups: Box<dyn Iterator<Item = Range<usize>> + Send> = match work.groups(Some(format)) {
            Some(groups) => Box::new(groups),
            None => Box::new((0..work.curves()).map(|index| index..index + 1)),
        };
        let prepared = output.run_all(groups.map(|curves| {
            let work = Arc::clone(&work);
            move |job: &Job| {
                curves.map(|index| work.prepare(index, || job.is_stopped())).collect::<Result<Vec<_>, _>>()
            }
        }));
        pin_mut!(prepared);
        while let Some(group) = prepared.next().await {
            curves.append(&mut group??);
        }
    }
    let of_all = Arc::clone(&work);
    let table = Arc::new(output.run(move |_| Table::new(&of_all, format, curves)).await??);
    output.send(format.head(&table.head)?).await?;
    let pieces: Box<dyn Iterator<Item = (Range<usize>, Range<usize>)> + Send> =
        if let Some(groups) = work.groups(Some(format)) {
            let points = work.points();
            Box::new(groups.map(move |curves| (curves, 0..points)))
        } else {
            let work = Arc::clone(&work);
            let of_curve = move |index| work.pieces(format).map(move |points| (index..index + 1, points));
            Box::new((0..table.curves.len()).flat_map(of_curve))
        };
    {
        let rows = output.run_all(pieces.map(|(curves, points)| {
            let (work, table) = (Arc::clone(&work), Arc::clone(&table));
            move |job: &Job| table.rows(&work, curves, &points, || job.is_stopped())
        }));
        pin_mut!(rows);
        while let Some(rows) = rows.next().await {
            output.send(rows??).await?;
        }
    }
    output.send(format.tail(&table.head)?).await
}

impl Table {
    fn new(work: &Work, format: RowFormat, curves: Vec<Curve>) -> Result<Self, Problem> {
        let angles = match &work.over {
            Over::Directions(_) => ["theta_i_deg", "theta_r_deg", "phi_r_deg"],
            Over::Sweep(sweep) => [sweep.axis().fixed_name(), sweep.axis().name(), "phi_r_deg"],
        };
        let evaluated =
            |component: &Component| curves.iter().any(|curve| curve.components().contains(component));
        let components: Vec<Component> = Component::ALL.into_iter().filter(evaluated).collect();
        let names = headings(&components, work.quantity(), work.output());
        let wavelength = work.spectrum().map(|_| (WAVELENGTH, "micrometres"));
        let mut columns: Vec<Heading> = wavelength
            .into_iter()
            .chain(angles.map(|name| (name, "degrees")).into_iter().filter(|_| work.has_angles))
            .chain(names)
            .map(|(name, unit)| Heading { name, unit, kind: Kind::Number })
            .collect();
        let text = |name, longest| Heading { name, unit: "", kind: Kind::Text { longest } };
        if work.output().per_direction {
            let longest = EvaluatedBy::ALL.iter().map(|method| method.name().len()).max().unwrap_or(0);
            columns.push(text("method", longest));
        }
        if let Subject::Linear { .. } = work.subject {
            columns.push(text("delta_on", "false".len()));
        }
        // The other formats have no place for them.
        let noted = if format == RowFormat::Arrow { curves.as_slice() } else { &[] };
        let notes = noted.iter().map(|curve| Note::of(work, curve)).collect::<Result<Vec<_>, _>>()?;
        let series = serde_json::to_string(&notes).map_err(|error| Problem::unwritten(&error))?;
        let notes = vec![("quantity", work.quantity().name().to_owned()), ("series", series)];
        Ok(Self { format, head: Head { columns, rows: work.rows(), notes }, curves })
    }

    /// The same points of some curves, written; nothing where nobody waits for them.
    fn rows(
        &self,
        work: &Work,
        curves: Range<usize>,
        points: &Range<usize>,
        is_over: impl Fn() -> bool,
    ) -> Result<Vec<u8>, Problem> {
        let mut bytes = Vec::new();
        let mut joined: Option<Part> = None;
        for curve in &self.curves[curves] {
            let part = self.part(work, curve, points.clone(), &is_over)?;
            if is_over() {
                // It may have holes.
                return Ok(Vec::new());
            }
            joined = Some(match joined.take() {
                None => part,
                Some(before) if before.has_columns_of(&part) => before.joined(part),
                Some(before) => {
                    self.write(before, &mut bytes)?;
                    part
                }
            });
        }
        if let Some(last) = joined {
            self.write(last, &mut bytes)?;
        }
        Ok(bytes)
    }

    fn write(&self, part: Part, bytes: &mut Vec<u8>) -> Result<(), Problem> {
        let Part { count, mut columns } = part;
        let columns = columns.iter_mut().map(Column::cells).collect();
        self.format.rows(&self.head, Rows { count, columns }, bytes)
    }

    /// Some points of a curve.
    fn part(
        &self,
        work: &Work,
        curve: &Curve,
        points: Range<usize>,
        is_over: impl Fn() -> bool,
    ) -> Result<Part, Problem> {
        let mut stretch = work.stretch(curve, points.clone(), is_over)?;
        let names = headings(curve.components(), work.quantity(), work.output());
        let mut texts: Option<Vec<&'static str>> = match (&stretch.method, &stretch.delta_on) {
            (Some(methods), _) => Some(methods.iter().map(|method| method.name()).collect()),
            (None, Some(delta_on)) => {
                Some(delta_on.iter().map(|&is_on| if is_on { "true" } else { "false" }).collect())
            }
            (None, None) => None,
        };
        let mut columns: Vec<Column> = Vec::with_capacity(self.head.columns.len());
        columns.extend(curve.line.map(|line| Column::Number(line.wavelength.get())));
        if work.has_angles {
            columns.extend(work.angles(curve, points.clone()).into_iter().map(|angle| match angle {
                AngleColumn::One(angle) => Column::Number(angle),
                AngleColumn::Each(angles) => Column::Numbers(angles),
            }));
        }
        for heading in &self.head.columns[columns.len()..] {
            let place = names.iter().position(|(name, _)| *name == heading.name);
            columns.push(match (heading.kind, place) {
                // No two columns have one name.
                (Kind::Number, Some(place)) => Column::Numbers(std::mem::take(&mut stretch.numbers[place])),
                (Kind::Text { .. }, _) => texts.take().map_or(Column::Absent, Column::Names),
                (Kind::Number, None) => Column::Absent,
            });
        }
        Ok(Part { count: points.len(), columns })
    }
}

/// Some consecutive rows.
struct Part {
    count: usize,
    columns: Vec<Column>,
}

/// One column of them.
enum Column {
    Numbers(Vec<f64>),
    /// The same number in all.
    Number(f64),
    Names(Vec<&'static str>),
    /// Nothing in any.
    Absent,
}

impl Column {
    /// For writing; the numbers are given away.
    fn cells(&mut self) -> Cells<'_> {
        match self {
            Self::Numbers(numbers) => Cells::Numbers(std::mem::take(numbers).into()),
            Self::Number(number) => Cells::Number(*number),
            Self::Names(names) => Cells::Names(names),
            Self::Absent => Cells::Absent,
        }
    }

    /// As one number a row.
    fn numbers(self, count: usize) -> Vec<f64> {
        match self {
            Self::Numbers(numbers) => numbers,
            Self::Number(number) => vec![number; count],
            Self::Names(_) | Self::Absent => Vec::new(),
        }
    }
}

impl Part {
    /// Whether the same columns are absent.
    fn has_columns_of(&self, other: &Self) -> bool {
        let is_absent = |column: &Column| matches!(column, Column::Absent);
        self.columns.iter().map(is_absent).eq(other.columns.iter().map(is_absent))
    }

    /// With more rows of the same columns below.
    fn joined(self, below: Self) -> Self {
        let columns = self.columns.into_iter().zip(below.columns).map(|columns| match columns {
            (Column::Names(mut names), Column::Names(mut more)) => {
                names.append(&mut more);
                Column::Names(names)
            }
            (Column::Absent, _) => Column::Absent,
            (Column::Number(number), Column::Number(same)) if number.to_bits() == same.to_bits() => {
                Column::Number(number)
            }
            (numbers, more) => {
                let mut numbers = numbers.numbers(self.count);
                numbers.append(&mut more.numbers(below.count));
                Column::Numbers(numbers)
            }
        });
        Self { columns: columns.collect(), count: self.count + below.count }
    }
}

impl Note {
    fn of(work: &Work, curve: &Curve) -> Result<Self, Problem> {
        let omitted = match &curve.model {
            Model::Scene(prepared) => prepared.omitted(),
            Model::Linear { .. } => &[],
        };
        let lookup = curve.line.map_or(work.looked_up(), |line| line.lookup);
        Ok(Self {
            wavelength_um: curve.line.map(|line| line.wavelength.get()),
            medium: lookup.map(MediumAnswer::from),
            at_deg: curve.at_deg,
            omitted: omitted.iter().cloned().map(OmittedAnswer::from).collect(),
            warnings: work.warnings(curve)?.into_iter().map(WarningAnswer::from).collect(),
        })
    }
}
