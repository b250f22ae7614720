//! Tables one below the other as rows: each curve's fixed angle, the axis, φ_r, and the curve's columns.

use super::rows::{Cells, Head, Heading, Kind, RowFormat, Rows};
use crate::http::problem::Problem;
use crate::reflectance::evaluate::EvaluatedBy;
use crate::reflectance::table::{Curve, Table};
use std::borrow::Cow;

/// Tables of one kind. `labelled` adds a column that tells curves apart which differ by more than the fixed angle.
/// What another table has and this one has not is absent.
pub(crate) fn write(format: RowFormat, tables: &[Table], labelled: bool) -> Result<Vec<u8>, Problem> {
    let head = head(tables, labelled);
    let mut bytes = format.head(&head)?;
    for table in tables {
        for curve in &table.curves {
            rows(format, &head, table, curve, &mut bytes)?;
        }
    }
    bytes.append(&mut format.tail(&head)?);
    Ok(bytes)
}

fn curves(tables: &[Table]) -> impl Iterator<Item = &Curve> {
    tables.iter().flat_map(|table| &table.curves)
}

/// The columns of all tables, in the order in which they first appear.
fn head(tables: &[Table], labelled: bool) -> Head {
    let number = |name, unit| Heading { name, unit, kind: Kind::Number };
    let text = |name, longest: Option<usize>| {
        longest.map(|longest| Heading { name, unit: "", kind: Kind::Text { longest } })
    };
    let mut columns = Vec::new();
    if labelled {
        columns.extend(text("label", curves(tables).map(|curve| curve.label.chars().count()).max()));
    }
    if let Some(table) = tables.first() {
        columns.extend(table.fixed.map(|name| number(name, "degrees")));
        columns.push(number(table.axis.name, table.axis.unit));
        columns.extend(table.fixed.map(|_| number("phi_r_deg", "degrees")));
    }
    for column in curves(tables).flat_map(|curve| &curve.columns) {
        if columns.iter().all(|known| known.name != column.name) {
            columns.push(number(column.name, column.unit));
        }
    }
    let methods = curves(tables).filter_map(|curve| curve.method.as_ref()).flatten();
    columns.extend(text("method", methods.map(|method| method.name().len()).max()));
    let notes = tables.first().map(|table| ("quantity", table.quantity.to_owned()));
    Head {
        columns,
        rows: tables.iter().map(|table| table.curves.len() * table.axis.values.len()).sum(),
        notes: notes.into_iter().collect(),
    }
}

/// One curve.
fn rows(
    format: RowFormat,
    head: &Head,
    table: &Table,
    curve: &Curve,
    out: &mut Vec<u8>,
) -> Result<(), Problem> {
    let methods: Option<Vec<&'static str>> =
        curve.method.as_ref().map(|methods| methods.iter().copied().map(EvaluatedBy::name).collect());
    let cells = |heading: &Heading| match heading.name {
        "label" => Cells::Name(&curve.label),
        "method" => methods.as_deref().map_or(Cells::Absent, Cells::Names),
        name if name == table.axis.name => Cells::Numbers(Cow::Borrowed(&table.axis.values)),
        name if Some(name) == table.fixed => curve.at_deg.map_or(Cells::Absent, Cells::Number),
        "phi_r_deg" => Cells::Number(table.phi_r_deg),
        name => {
            let column = curve.columns.iter().find(|column| column.name == name);
            column.map_or(Cells::Absent, |column| Cells::Numbers(Cow::Borrowed(&column.values)))
        }
    };
    let columns = head.columns.iter().map(cells).collect();
    format.rows(head, Rows { count: table.axis.values.len(), columns }, out)
}
