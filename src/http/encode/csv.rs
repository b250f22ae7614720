//! Tables as CSV: tidy, one row a point, units in the header.

use crate::http::problem::Problem;
use crate::reflectance::table::Table;
use csv::{Terminator, Writer, WriterBuilder};

/// Tables of one kind, one below the other. `labelled` adds a column that tells curves apart which differ by more
/// than the fixed angle. A value that is not a number is an empty field, as is one that another table has.
pub(crate) fn write(tables: &[Table], labelled: bool) -> Result<Vec<u8>, Problem> {
    rows(tables, labelled).map_err(|error| Problem::unwritten(&error))
}

fn rows(tables: &[Table], labelled: bool) -> Result<Vec<u8>, csv::Error> {
    let mut writer = WriterBuilder::new().terminator(Terminator::CRLF).from_writer(Vec::new());
    let columns = columns(tables);
    write_header(&mut writer, tables, &columns, labelled)?;
    let mut digits = Vec::with_capacity(32);
    for table in tables {
        for curve in &table.curves {
            let present: Vec<Option<&[f64]>> = columns
                .iter()
                .map(|(name, _)| curve.columns.iter().find(|c| c.name == *name).map(|c| c.values.as_slice()))
                .collect();
            for (row, &position) in table.axis.values.iter().enumerate() {
                if labelled {
                    writer.write_field(&curve.label)?;
                }
                if table.fixed.is_some() {
                    number(&mut writer, &mut digits, curve.at_deg)?;
                }
                number(&mut writer, &mut digits, Some(position))?;
                if table.fixed.is_some() {
                    number(&mut writer, &mut digits, Some(table.phi_r_deg))?;
                }
                for values in &present {
                    number(&mut writer, &mut digits, values.and_then(|values| values.get(row).copied()))?;
                }
                if let Some(method) = &curve.method {
                    writer.write_field(method.get(row).map_or("", |method| method.name()))?;
                }
                writer.write_record(None::<&[u8]>)?;
            }
        }
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// Name and unit of every column, in the order in which they first appear.
fn columns(tables: &[Table]) -> Vec<(&'static str, &'static str)> {
    let mut columns = Vec::new();
    for column in tables.iter().flat_map(|table| &table.curves).flat_map(|curve| &curve.columns) {
        if !columns.contains(&(column.name, column.unit)) {
            columns.push((column.name, column.unit));
        }
    }
    columns
}

fn write_header(
    writer: &mut Writer<Vec<u8>>,
    tables: &[Table],
    columns: &[(&str, &str)],
    labelled: bool,
) -> Result<(), csv::Error> {
    if labelled {
        writer.write_field("label")?;
    }
    if let Some(table) = tables.first() {
        if let Some(fixed) = table.fixed {
            writer.write_field(fixed)?;
        }
        writer.write_field(table.axis.name)?;
        if table.fixed.is_some() {
            writer.write_field("phi_r_deg")?;
        }
    }
    for (name, unit) in columns {
        let unit = unit.replace(' ', "_").replace('^', "");
        writer.write_field(if unit.is_empty() { (*name).to_owned() } else { format!("{name}_{unit}") })?;
    }
    if tables.iter().flat_map(|table| &table.curves).any(|curve| curve.method.is_some()) {
        writer.write_field("method")?;
    }
    writer.write_record(None::<&[u8]>)
}

/// The shortest digits that read back as the same number, as in JSON.
fn number(writer: &mut Writer<Vec<u8>>, digits: &mut Vec<u8>, value: Option<f64>) -> Result<(), csv::Error> {
    digits.clear();
    if let Some(value) = value.filter(|value| value.is_finite()) {
        serde_json::to_writer(&mut *digits, &value)
            .map_err(|error| csv::Error::from(std::io::Error::from(error)))?;
    }
    writer.write_field(&digits)
}
