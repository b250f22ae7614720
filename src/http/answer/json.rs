//! Answers as JSON: columns one after the other, the first of them while it is being evaluated.

use super::columns::{Stretch, headings};
use super::output::{End, Output};
use super::text::Text;
use super::work::{Curve, Over, Work};
use crate::http::api::light::MediumAnswer;
use crate::http::compute::job::Job;
use crate::http::problem::Problem;
use crate::reflectance::diagram::Sweep;
use crate::reflectance::evaluate::Tally;
use axum::body::Bytes;
use futures_util::{StreamExt as _, pin_mut};
use std::ops::Range;
use std::sync::Arc;

/// Bytes about as many as an answer has besides its numbers, and for each row.
const BESIDES: usize = 2048;
const A_ROW: usize = 80;

/// A small answer, at once.
pub(super) fn whole(work: &Work) -> Result<Vec<u8>, Problem> {
    let mut text = Text::with_capacity(BESIDES + A_ROW * work.rows());
    begin(work, &mut text)?;
    if let Over::Sweep(sweep) = &work.over {
        text.numbers(sweep.positions(), true);
        between(sweep, &mut text);
    }
    whole_curves(work, 0..work.curves(), &mut text, || false)?;
    end(work, &mut text);
    Ok(text.0)
}

/// Curves that are small, one after the other.
fn whole_curves(
    work: &Work,
    curves: Range<usize>,
    text: &mut Text,
    is_over: impl Fn() -> bool,
) -> Result<(), Problem> {
    for index in curves {
        if is_over() {
            break;
        }
        let curve = work.prepare(index, &is_over)?;
        let stretch = work.stretch(&curve, 0..work.points(), &is_over)?;
        begin_curve(&curve, index, text)?;
        let mut total = 0..0;
        for (column, (name, numbers)) in names(work, &curve).zip(&stretch.numbers).enumerate() {
            text.list(name, |text| {
                let begin = text.0.len();
                if column > 0 && stretch.is_total(column) {
                    text.repeat(total.clone());
                } else {
                    text.numbers(numbers, true);
                }
                if column == 0 {
                    total = begin..text.0.len();
                }
            });
        }
        if let Some(method) = &stretch.method {
            text.list("method", |text| text.methods(method, true));
        }
        if let Some(delta_on) = &stretch.delta_on {
            text.list("delta_on", |text| text.booleans(delta_on, true));
        }
        text.findings(&curve.model, work.warnings(&curve)?, stretch.tally)?;
        text.name("diagnostics");
        text.push("[");
        text.diagnostics(&stretch.diagnostics, true)?;
        text.push("]");
        end_curve(&curve, text);
    }
    Ok(())
}

/// A large answer, part by part.
pub(super) async fn stream(work: Arc<Work>, output: Output) -> Result<(), End> {
    let mut text = Text::default();
    begin(&work, &mut text)?;
    if let Over::Sweep(sweep) = &work.over {
        let positions = sweep.positions().to_vec();
        send_list(
            &output,
            &mut text,
            positions.chunks(AT_A_TIME).map(<[f64]>::to_vec),
            |text, numbers, first| {
                text.numbers(&numbers, first);
            },
        )
        .await?;
        between(sweep, &mut text);
    }
    if let Some(groups) = work.groups(None) {
        output.send(text.take()).await?;
        let texts = output.run_all(groups.map(|curves| {
            let work = Arc::clone(&work);
            move |job: &Job| {
                let mut text = Text::default();
                whole_curves(&work, curves, &mut text, || job.is_stopped())?;
                Ok::<_, Problem>(text)
            }
        }));
        pin_mut!(texts);
        while let Some(text) = texts.next().await {
            output.send(text??.0).await?;
        }
        end(&work, &mut text);
        return output.send(text.0).await;
    }
    for index in 0..work.curves() {
        let prepare = Arc::clone(&work);
        let curve = output.run(move |job| prepare.prepare(index, || job.is_stopped())).await??;
        begin_curve(&curve, index, &mut text)?;
        stream_curve(&work, &curve, &mut text, &output).await?;
        end_curve(&curve, &mut text);
    }
    end(&work, &mut text);
    output.send(text.0).await
}

/// Numbers of an axis that are written at a time.
const AT_A_TIME: usize = 16 << 10;

/// The text of a total is kept, in case that a component is the same, for so many rows.
const KEPT_ROWS: usize = 1 << 20;
/// Numbers that are written at a time: about a millisecond.
const NUMBERS: usize = 32 << 10;

/// One curve: the total as it is evaluated; the other columns are kept until it is out.
async fn stream_curve(work: &Arc<Work>, curve: &Curve, text: &mut Text, output: &Output) -> Result<(), End> {
    let mut names = names(work, curve);
    text.name(names.next().unwrap_or_default());
    text.push("[");
    output.send(text.take()).await?;
    let mut kept: Vec<Stretch> = Vec::new();
    // The total's text, as long as the first component has the same.
    let mut repeated = (work.points() <= KEPT_ROWS).then(Vec::new);
    let mut tally = Tally::default();
    {
        let evaluated = output.run_all(work.pieces_of_a_column().map(|range| {
            let (work, curve) = (Arc::clone(work), curve.clone());
            move |job: &Job| {
                let first = range.start == 0;
                let mut stretch = work.stretch(&curve, range, || job.is_stopped())?;
                let mut text = Text::default();
                let is_alone = stretch.is_total(1);
                text.numbers(&std::mem::take(&mut stretch.numbers[0]), first);
                Ok::<_, Problem>((Bytes::from(text.0), stretch, is_alone))
            }
        }));
        pin_mut!(evaluated);
        while let Some(part) = evaluated.next().await {
            let (text, stretch, is_alone) = part??;
            tally.append(&stretch.tally);
            kept.push(stretch);
            if is_alone && let Some(texts) = &mut repeated {
                texts.push(text.clone());
            } else {
                repeated = None;
            }
            output.send(text).await?;
        }
    }
    text.push("]");
    for (column, name) in (1..).zip(names) {
        text.name(name);
        text.push("[");
        if let Some(texts) = repeated.take() {
            output.send(text.take()).await?;
            for text in texts {
                output.send(text).await?;
            }
        } else {
            let columns = kept.iter_mut().map(|stretch| std::mem::take(&mut stretch.numbers[column]));
            let write = |text: &mut Text, columns: Vec<Vec<f64>>, first| {
                for (place, numbers) in columns.iter().enumerate() {
                    text.numbers(numbers, first && place == 0);
                }
            };
            send_list(output, text, together(columns), write).await?;
        }
        text.push("]");
    }
    if kept.iter().all(|stretch| stretch.method.is_some()) {
        text.name("method");
        text.push("[");
        let columns = kept.iter_mut().filter_map(|stretch| stretch.method.take());
        send_list(output, text, columns, |text, methods, first| text.methods(&methods, first)).await?;
        text.push("]");
    }
    if kept.iter().all(|stretch| stretch.delta_on.is_some()) {
        text.name("delta_on");
        text.push("[");
        let columns = kept.iter_mut().filter_map(|stretch| stretch.delta_on.take());
        send_list(output, text, columns, |text, booleans, first| text.booleans(&booleans, first)).await?;
        text.push("]");
    }
    let of_curve = (Arc::clone(work), curve.clone());
    let warnings = output.run(move |_| of_curve.0.warnings(&of_curve.1)).await??;
    text.findings(&curve.model, warnings, tally)?;
    text.name("diagnostics");
    text.push("[");
    let mut first = true;
    for stretch in kept.into_iter().filter(|stretch| !stretch.diagnostics.is_empty()) {
        text.diagnostics(&stretch.diagnostics, first)?;
        first = false;
        output.send(text.take()).await?;
    }
    text.push("]");
    Ok(())
}

/// As many columns together as are written at a time.
fn together(mut columns: impl Iterator<Item = Vec<f64>>) -> impl Iterator<Item = Vec<Vec<f64>>> {
    std::iter::from_fn(move || {
        let mut numbers = 0;
        let mut group = Vec::new();
        while numbers < NUMBERS
            && let Some(column) = columns.next()
        {
            numbers += column.len();
            group.push(column);
        }
        (!group.is_empty()).then_some(group)
    })
}

/// Sends what is written so far and then a list, whose parts are written side by side.
async fn send_list<P: Send + 'static>(
    output: &Output,
    text: &mut Text,
    parts: impl Iterator<Item = P> + Send,
    write: impl Fn(&mut Text, P, bool) + Send + Sync + Copy + 'static,
) -> Result<(), End> {
    output.send(text.take()).await?;
    let texts = output.run_all(parts.enumerate().map(|(place, part)| {
        move |_: &Job| {
            let mut text = Text::default();
            write(&mut text, part, place == 0);
            text
        }
    }));
    pin_mut!(texts);
    while let Some(text) = texts.next().await {
        output.send(text?.0).await?;
    }
    Ok(())
}

fn names(work: &Work, curve: &Curve) -> impl Iterator<Item = &'static str> + use<> {
    headings(curve.components(), work.quantity(), work.output()).into_iter().map(|(name, _)| name)
}

fn begin(work: &Work, text: &mut Text) -> Result<(), Problem> {
    text.push("{\"quantity\":\"");
    text.push(work.quantity().name());
    text.push("\",\"unit\":\"");
    text.push(work.quantity().unit());
    text.push("\"");
    if let Some(lookup) = work.looked_up() {
        text.name("medium");
        text.value(&MediumAnswer::from(lookup))?;
    }
    match &work.over {
        Over::Directions(_) if work.spectrum().is_some() => text.push(",\"spectrum\":["),
        Over::Directions(_) => (),
        Over::Sweep(sweep) => {
            text.push(",\"axis\":{\"name\":\"");
            text.push(sweep.axis().name());
            text.push("\",\"unit\":\"degrees\",\"values\":[");
        }
    }
    Ok(())
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

/// One curve of several is an object of its own.
fn begin_curve(curve: &Curve, index: usize, text: &mut Text) -> Result<(), Problem> {
    if is_one_of_several(curve) {
        text.push(if index == 0 { "{" } else { ",{" });
    }
    if let Some(line) = curve.line {
        text.name("wavelength_um");
        text.numbers(&[line.wavelength.get()], true);
        if let Some(lookup) = line.lookup {
            text.name("medium");
            text.value(&MediumAnswer::from(lookup))?;
        }
    }
    if let Some(at) = curve.at_deg {
        text.name("at_deg");
        text.numbers(&[at], true);
    }
    Ok(())
}

const fn is_one_of_several(curve: &Curve) -> bool {
    curve.at_deg.is_some() || curve.line.is_some()
}

fn end_curve(curve: &Curve, text: &mut Text) {
    if is_one_of_several(curve) {
        text.push("}");
    }
}

fn end(work: &Work, text: &mut Text) {
    text.push(match work.over {
        Over::Directions(_) if work.spectrum().is_none() => "}",
        Over::Directions(_) | Over::Sweep(_) => "]}",
    });
}
