//! Answers as rows: angles, then the columns of numbers, then methods. Nothing is kept of a stretch once it is written.

use super::columns::{Stretch, headings};
use super::output::{End, Output};
use super::work::{Curve, Over, Work};
use crate::http::api::answer::{OmittedAnswer, WarningAnswer};
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
    for index in 0..work.curves() {
        let count = table.curves[index].directions.count();
        bytes.append(&mut table.rows(work, index, 0..count, || false)?);
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
            move |_: &_| work.prepare(index)
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
        let count = table.curves[index].directions.count();
        work.pieces(count).map(move |range| {
            let (work, table) = (Arc::clone(&work), Arc::clone(&table));
            move |job: &crate::http::compute::job::Job| table.rows(&work, index, range, || job.is_stopped())
        })
    });
    let rows = output.run_all(pieces);
    pin_mut!(rows);
    while let Some(rows) = rows.next().await {
        output.send(rows??).await?;
    }
    output.send(format.tail(&table.head)?).await
}

impl Table {
    fn new(work: &Work, format: RowFormat, curves: Vec<Curve>) -> Result<Self, Problem> {
        let number = |name, unit| Heading { name, unit, kind: Kind::Number };
        let mut columns: Vec<Heading> = match &work.over {
            Over::Directions(_) => ["theta_i_deg", "theta_r_deg", "phi_r_deg"].map(angle).to_vec(),
            Over::Sweep(sweep) => {
                [sweep.axis().fixed_name(), sweep.axis().name(), "phi_r_deg"].map(angle).to_vec()
            }
        };
        let evaluated = |component: &Component| {
            curves.iter().any(|curve| curve.prepared.components().contains(component))
        };
        let components: Vec<Component> = Component::ALL.into_iter().filter(evaluated).collect();
        let names = headings(&components, work.quantity, work.output);
        columns.extend(names.into_iter().map(|(name, unit)| number(name, unit)));
        if work.output.per_direction {
            let longest = EvaluatedBy::ALL.iter().map(|method| method.name().len()).max().unwrap_or(0);
            columns.push(Heading { name: "method", unit: "", kind: Kind::Text { longest } });
        }
        let notes: Vec<Note> = curves
            .iter()
            .map(|curve| Note {
                at_deg: curve.at_deg,
                omitted: curve.prepared.omitted().iter().cloned().map(OmittedAnswer::from).collect(),
                warnings: curve.prepared.warnings().iter().cloned().map(WarningAnswer::from).collect(),
            })
            .collect();
        let series = serde_json::to_string(&notes).map_err(|error| Problem::unwritten(&error))?;
        let notes = vec![("quantity", work.quantity.name().to_owned()), ("series", series)];
        Ok(Self { format, head: Head { columns, rows: work.rows(), notes }, curves })
    }

    /// Some rows of a curve, written.
    fn rows(
        &self,
        work: &Work,
        index: usize,
        range: Range<usize>,
        is_over: impl Fn() -> bool,
    ) -> Result<Vec<u8>, Problem> {
        let curve = &self.curves[index];
        let stretch = curve.prepared.stretch(&curve.directions, range.clone(), &is_over);
        if is_over() {
            // Nobody waits for it, and it may have holes.
            return Ok(Vec::new());
        }
        let stretch = Stretch::from(stretch.into_parts());
        let names = headings(curve.prepared.components(), work.quantity, work.output);
        let angles = match &work.over {
            Over::Directions(directions) => directions.columns(range.clone()),
            Over::Sweep(sweep) => [
                AngleColumn::One(curve.at_deg.unwrap_or(f64::NAN)),
                AngleColumn::Each(sweep.positions()[range.clone()].to_vec()),
                AngleColumn::One(sweep.phi_r()),
            ],
        };
        let methods: Option<Vec<&'static str>> =
            stretch.method.map(|methods| methods.into_iter().map(EvaluatedBy::name).collect());
        let mut columns: Vec<Cells> = angles
            .iter()
            .map(|angle| match angle {
                AngleColumn::One(angle) => Cells::Number(*angle),
                AngleColumn::Each(angles) => Cells::Numbers(angles),
            })
            .collect();
        for heading in &self.head.columns[columns.len()..] {
            let place = names.iter().position(|(name, _)| *name == heading.name);
            columns.push(match (place, &methods) {
                (Some(place), _) => Cells::Numbers(&stretch.numbers[place]),
                (None, Some(methods)) if heading.name == "method" => Cells::Names(methods),
                (None, _) => Cells::Absent,
            });
        }
        let mut bytes = Vec::new();
        self.format.rows(&self.head, &Rows { count: range.len(), columns }, &mut bytes)?;
        Ok(bytes)
    }
}

fn angle(name: &'static str) -> Heading {
    Heading { name, unit: "degrees", kind: Kind::Number }
}
