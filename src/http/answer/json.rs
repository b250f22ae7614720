//! Answers as JSON: columns one after the other, the first of them while it is being evaluated.

use super::columns::{Stretch, headings};
use super::output::{End, Output};
use super::text::Text;
use super::work::{Curve, Over, Work};
use crate::http::problem::Problem;
use crate::reflectance::diagram::Sweep;
use crate::reflectance::evaluate::{EvaluatedBy, Tally};
use futures_util::{StreamExt as _, pin_mut};
use std::sync::Arc;

/// A small answer, at once.
pub(super) fn whole(work: &Work) -> Result<Vec<u8>, Problem> {
    let mut text = Text::with_capacity(2048 + 80 * work.rows());
    begin(work, &mut text);
    if let Over::Sweep(sweep) = &work.over {
        text.numbers(sweep.positions(), true);
        between(sweep, &mut text);
    }
    for index in 0..work.curves() {
        let curve = work.prepare(index)?;
        let stretch = curve.prepared.stretch(&curve.directions, 0..curve.directions.count(), || false);
        let stretch = Stretch::from(stretch.into_parts());
        begin_curve(&curve, index, &mut text);
        for ((name, _), numbers) in names(&curve).into_iter().zip(&stretch.numbers) {
            text.name(name);
            text.push("[");
            text.numbers(numbers, true);
            text.push("]");
        }
        if let Some(method) = &stretch.method {
            text.name("method");
            text.push("[");
            text.methods(method, true);
            text.push("]");
        }
        text.findings(&curve.prepared, stretch.tally)?;
        text.name("diagnostics");
        text.push("[");
        text.diagnostics(&stretch.diagnostics, true)?;
        text.push("]");
        end_curve(&curve, &mut text);
    }
    end(work, &mut text);
    Ok(text.0)
}

/// A large answer, part by part.
pub(super) async fn stream(work: Arc<Work>, output: Output) -> Result<(), End> {
    let mut text = Text::default();
    begin(&work, &mut text);
    if let Over::Sweep(sweep) = &work.over {
        let pieces = work.pieces(sweep.positions().len()).map(|range| {
            let sweep = Arc::clone(sweep);
            move |_: &_| {
                let mut text = Text::default();
                let first = range.start == 0;
                text.numbers(&sweep.positions()[range], first);
                text
            }
        });
        output.send(std::mem::take(&mut text.0)).await?;
        send_all(&output, pieces).await?;
        between(sweep, &mut text);
    }
    for index in 0..work.curves() {
        let prepare = Arc::clone(&work);
        let curve = output.run(move |_| prepare.prepare(index)).await??;
        begin_curve(&curve, index, &mut text);
        stream_curve(&work, curve, &mut text, &output).await?;
    }
    end(&work, &mut text);
    output.send(text.0).await
}

/// One curve: the total as it is evaluated; the other columns are kept until it is out.
async fn stream_curve(work: &Work, curve: Curve, text: &mut Text, output: &Output) -> Result<(), End> {
    let names = names(&curve);
    let mut names = names.into_iter().map(|(name, _)| name);
    text.name(names.next().unwrap_or_default());
    text.push("[");
    output.send(std::mem::take(&mut text.0)).await?;
    let mut kept: Vec<Stretch> = Vec::new();
    let mut tally = Tally::default();
    {
        let evaluated = output.run_all(work.pieces(curve.directions.count()).map(|range| {
            let curve = curve.clone();
            move |job: &crate::http::compute::job::Job| {
                let first = range.start == 0;
                let stretch = curve.prepared.stretch(&curve.directions, range, || job.is_stopped());
                let mut stretch = Stretch::from(stretch.into_parts());
                let mut text = Text::default();
                text.numbers(&std::mem::take(&mut stretch.numbers[0]), first);
                (text, stretch)
            }
        }));
        pin_mut!(evaluated);
        while let Some(part) = evaluated.next().await {
            let (text, stretch) = part?;
            tally.append(&stretch.tally);
            kept.push(stretch);
            output.send(text.0).await?;
        }
    }
    for (column, name) in (1..).zip(names) {
        text.push("]");
        text.name(name);
        text.push("[");
        output.send(std::mem::take(&mut text.0)).await?;
        let pieces = kept.iter_mut().enumerate().map(|(place, stretch)| {
            let numbers = std::mem::take(&mut stretch.numbers[column]);
            move |_: &_| {
                let mut text = Text::default();
                text.numbers(&numbers, place == 0);
                text
            }
        });
        send_all(output, pieces).await?;
    }
    text.push("]");
    if kept.first().is_some_and(|stretch| stretch.method.is_some()) {
        text.name("method");
        text.push("[");
        output.send(std::mem::take(&mut text.0)).await?;
        let pieces = kept.iter_mut().enumerate().map(|(place, stretch)| {
            let method: Vec<EvaluatedBy> = stretch.method.take().unwrap_or_default();
            move |_: &_| {
                let mut text = Text::default();
                text.methods(&method, place == 0);
                text
            }
        });
        send_all(output, pieces).await?;
        text.push("]");
    }
    text.findings(&curve.prepared, tally)?;
    text.name("diagnostics");
    text.push("[");
    let mut first = true;
    for stretch in kept {
        if !stretch.diagnostics.is_empty() {
            text.diagnostics(&stretch.diagnostics, first)?;
            first = false;
            output.send(std::mem::take(&mut text.0)).await?;
        }
    }
    text.push("]");
    end_curve(&curve, text);
    Ok(())
}

/// Makes texts side by side and sends them in order.
async fn send_all<W>(output: &Output, pieces: impl Iterator<Item = W> + Send) -> Result<(), End>
where
    W: FnOnce(&crate::http::compute::job::Job) -> Text + Send + 'static,
{
    let texts = output.run_all(pieces);
    pin_mut!(texts);
    while let Some(text) = texts.next().await {
        output.send(text?.0).await?;
    }
    Ok(())
}

fn names(curve: &Curve) -> Vec<(&'static str, &'static str)> {
    let prepared = &curve.prepared;
    headings(prepared.components(), prepared.quantity(), prepared.output())
}

fn begin(work: &Work, text: &mut Text) {
    text.push("{\"quantity\":\"");
    text.push(work.quantity.name());
    text.push("\",\"unit\":\"");
    text.push(work.quantity.unit());
    text.push("\"");
    if let Over::Sweep(sweep) = &work.over {
        text.push(",\"axis\":{\"name\":\"");
        text.push(sweep.axis().name());
        text.push("\",\"unit\":\"degrees\",\"values\":[");
    }
}

/// Between the axis and the curves.
fn between(sweep: &Sweep, text: &mut Text) {
    text.push("]},\"fixed\":{\"name\":\"");
    text.push(sweep.axis().fixed_name());
    text.push("\",\"unit\":\"degrees\"}");
    text.name("phi_r_deg");
    text.numbers(&[sweep.phi_r()], true);
    text.name("series");
    text.push("[");
}

fn begin_curve(curve: &Curve, index: usize, text: &mut Text) {
    if let Some(at) = curve.at_deg {
        text.push(if index == 0 { "{" } else { ",{" });
        text.name("at_deg");
        text.numbers(&[at], true);
    }
}

fn end_curve(curve: &Curve, text: &mut Text) {
    if curve.at_deg.is_some() {
        text.push("}");
    }
}

fn end(work: &Work, text: &mut Text) {
    text.push(match work.over {
        Over::Directions(_) => "}",
        Over::Sweep(_) => "]}",
    });
}
