//! Answers as rows: angles, then the columns of numbers, then methods. Nothing is kept of a stretch once it is written.

use super::columns::headings;
use super::output::{End, Output};
use super::work::{Curve, Model, Over, Subject, Work};
use crate::http::api::answer::{OmittedAnswer, WarningAnswer};
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
    at_deg: Option<f64>,
    omitted: Vec<OmittedAnswer>,
    warnings: Vec<WarningAnswer>,
}

/// The head of a table, and its curves made ready: which columns there are is known only when all are.
struct Table {
    format: RowFormat,
    head: Head,
    curves: Vec<Curve>,
}

/// A small answer, at once.
pub(super) fn whole(work: &Work, format: RowFormat) -> Result<Vec<u8>, Problem> {
    let curves = (0..work.curves()).map(|index| work.prepare(index)).collect::<Result<_, _>>()?;
    let table = Table::new(work, format, curves)?;
    let mut bytes = format.head(&table.head)?;
    for curve in &table.curves {
        bytes.append(&mut table.rows(work, curve, 0..work.points(), || false)?);
    }
    bytes.append(&mut format.tail(&table.head)?);
    Ok(bytes)
}

/// A large answer, part by part.
pub(super) async fn stream(work: Arc<Work>, format: RowFormat, output: Output) -> Result<(), End> {
    let mut curves = Vec::with_capacity(work.curves());
    {
        let prepared = output.run_all((0..work.curves()).map(|index| {
            let work = Arc::clone(&work);
            move |_: &Job| work.prepare(index)
        }));
        pin_mut!(prepared);
        while let Some(curve) = prepared.next().await {
            curves.push(curve??);
        }
    }
    let table = Arc::new(Table::new(&work, format, curves)?);
    output.send(format.head(&table.head)?).await?;
    let pieces = (0..work.curves()).flat_map(|index| {
        let (work, table) = (Arc::clone(&work), Arc::clone(&table));
        work.pieces(format).map(move |range| {
            let (work, table) = (Arc::clone(&work), Arc::clone(&table));
            move |job: &Job| table.rows(&work, &table.curves[index], range, || job.is_stopped())
        })
    });
    {
        let rows = output.run_all(pieces);
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
        let mut columns: Vec<Heading> = angles
            .map(|name| (name, "degrees"))
            .into_iter()
            .filter(|_| work.has_angles)
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

    /// Some rows of a curve, written.
    fn rows(
        &self,
        work: &Work,
        curve: &Curve,
        range: Range<usize>,
        is_over: impl Fn() -> bool,
    ) -> Result<Vec<u8>, Problem> {
        let mut stretch = work.stretch(curve, range.clone(), &is_over)?;
        if is_over() {
            // Nobody waits for it, and it may have holes.
            return Ok(Vec::new());
        }
        let names = headings(curve.components(), work.quantity(), work.output());
        let texts: Option<Vec<&'static str>> = match (&stretch.method, &stretch.delta_on) {
            (Some(methods), _) => Some(methods.iter().map(|method| method.name()).collect()),
            (None, Some(delta_on)) => {
                Some(delta_on.iter().map(|&is_on| if is_on { "true" } else { "false" }).collect())
            }
            (None, None) => None,
        };
        let mut columns: Vec<Cells> = Vec::with_capacity(self.head.columns.len());
        if work.has_angles {
            columns.extend(work.angles(curve, range.clone()).into_iter().map(|angle| match angle {
                AngleColumn::One(angle) => Cells::Number(angle),
                AngleColumn::Each(angles) => Cells::Numbers(angles.into()),
            }));
        }
        for heading in &self.head.columns[columns.len()..] {
            let place = names.iter().position(|(name, _)| *name == heading.name);
            columns.push(match (heading.kind, place, &texts) {
                (Kind::Number, Some(place), _) => {
                    // No two columns have one name.
                    Cells::Numbers(std::mem::take(&mut stretch.numbers[place]).into())
                }
                (Kind::Text { .. }, _, Some(texts)) => Cells::Names(texts),
                _ => Cells::Absent,
            });
        }
        let mut bytes = Vec::new();
        self.format.rows(&self.head, Rows { count: range.len(), columns }, &mut bytes)?;
        Ok(bytes)
    }
}

impl Note {
    fn of(work: &Work, curve: &Curve) -> Result<Self, Problem> {
        let omitted = match &curve.model {
            Model::Scene(prepared) => prepared.omitted(),
            Model::Linear { .. } => &[],
        };
        Ok(Self {
            at_deg: curve.at_deg,
            omitted: omitted.iter().cloned().map(OmittedAnswer::from).collect(),
            warnings: work.warnings(curve)?.into_iter().map(WarningAnswer::from).collect(),
        })
    }
}
