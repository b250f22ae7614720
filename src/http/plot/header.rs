//! What stands above the axes: the title, the parameters, the legend.

use super::style::{Style, TENTHS, bold, ems, letters, placed, stroke};
use super::ticks::ValueAxis;
use super::{Area, Drawn, Plot, tenths};
use plotters::element::Text;
use plotters::style::TextStyle;
use plotters::style::text_anchor::{HPos, VPos};

/// Sizes of letters, pixels.
const TITLE: f64 = 15.0;
/// How much wider bold letters are.
const BOLD: f64 = 1.1;
const SMALL: f64 = 12.5;
const LEGEND: f64 = 13.0;
/// From one line to the next, in ems.
const LEADING: f64 = 1.38;
/// Left and right of everything, and above it, pixels.
const MARGIN: f64 = 16.0;
/// The sample of a line in the legend, and what is left free around it.
const SAMPLE: f64 = 26.0;
const GAP: f64 = 6.0;
const APART: f64 = 16.0;
/// Colours that a legend has at most; fewer where they take too much of the height.
const COLOURS: [usize; 4] = [12, 6, 4, 2];
/// Of more colours than that, so many at most.
const SAMPLES: usize = 6;
/// The share of the height that the legend may take.
const LEGEND_SHARE: f64 = 0.28;
/// The share of the height that may be taken.
const SHARE: f64 = 0.42;

/// Draws from the top down while there is room; returns where it ended, tenths of a pixel.
pub(super) fn draw(
    root: &Area,
    plot: &Plot,
    values: &ValueAxis,
    style: &Style,
) -> Result<i32, Box<dyn std::error::Error + Send + Sync>> {
    let (width, height) = root.dim_in_pixel();
    let [width, height] = [width, height].map(|tenths| f64::from(tenths) / TENTHS);
    let width = width - 2.0 * MARGIN;
    let mut pen = Pen { root, y: 12.0, limit: SHARE * height, kinds: plot.dashes.len() };
    pen.lines(&wrapped(&plot.title, width / (TITLE * BOLD)), TITLE, &bold(TITLE, style.text))?;
    pen.y += 2.0;
    let mut entries = Vec::new();
    let mut rows = Vec::new();
    for most in COLOURS {
        entries = legend(plot, most);
        rows = in_rows(&entries, width);
        if rows.len() as f64 * LEGEND * LEADING <= LEGEND_SHARE * height {
            break;
        }
    }
    // The legend is worth more than the last lines of parameters.
    let kept = rows.len() as f64 * LEGEND * LEADING;
    pen.limit -= kept;
    let said = [Some(plot.parameters.as_str()), values.note.as_deref()].into_iter().flatten();
    let said = said.filter(|text| !text.is_empty()).flat_map(|text| wrapped(text, width / SMALL));
    pen.lines(&said.collect::<Vec<_>>(), SMALL, &letters(SMALL, style.muted))?;
    pen.limit += kept;
    pen.y += 4.0;
    for row in rows {
        pen.row(&entries[row], style)?;
    }
    Ok(tenths(pen.y))
}

/// Where the next line goes, pixels, and where the last one may end.
struct Pen<'a, 'b> {
    root: &'a Area<'b>,
    y: f64,
    limit: f64,
    /// How many kinds of lines there are.
    kinds: usize,
}

impl Pen<'_, '_> {
    fn lines(&mut self, lines: &[String], size: f64, style: &TextStyle<'static>) -> Drawn {
        for (index, line) in lines.iter().enumerate() {
            let height = size * LEADING;
            if self.y + height > self.limit {
                break;
            }
            let is_cut = index + 1 < lines.len() && self.y + 2.0 * height > self.limit;
            let text = if is_cut { format!("{line} …") } else { line.clone() };
            self.root.draw(&Text::new(text, (tenths(MARGIN), tenths(self.y)), style.clone()))?;
            self.y += height;
        }
        Ok(())
    }

    fn row(&mut self, entries: &[Entry], style: &Style) -> Drawn {
        let text = placed(&letters(LEGEND, style.text), HPos::Left, VPos::Center);
        let middle = tenths(self.y + 0.5 * LEGEND * LEADING);
        let mut x = MARGIN;
        for entry in entries {
            if let Some((colour, dash)) = entry.line {
                let ends = [x, x + SAMPLE].map(|x| (tenths(x), middle)).to_vec();
                let line = match colour {
                    Some(colour) => style.line(colour, 0, 1),
                    None => style.sample(dash, self.kinds),
                };
                stroke(self.root, ends, line, dash)?;
                self.root.draw(&Text::new(
                    entry.text.clone(),
                    (tenths(x + SAMPLE + GAP), middle),
                    text.clone(),
                ))?;
            } else {
                self.root.draw(&Text::new(entry.text.clone(), (tenths(x), middle), text.clone()))?;
            }
            x += entry.width();
        }
        self.y += LEGEND * LEADING;
        Ok(())
    }
}

/// One entry of the legend.
struct Entry {
    text: String,
    /// Its colour, if it speaks of one, and its kind of line; a heading has none.
    line: Option<(Option<usize>, usize)>,
}

impl Entry {
    fn width(&self) -> f64 {
        let sample = if self.line.is_some() { SAMPLE + GAP } else { 0.0 };
        sample + ems(&self.text) * LEGEND + APART
    }
}

/// The legend: every colour, or some where there are more than so many, then every kind of line.
fn legend(plot: &Plot, most: usize) -> Vec<Entry> {
    let colours = plot.colours.len();
    let mut entries = Vec::new();
    let coloured = |index: usize| Entry { text: plot.colours[index].clone(), line: Some((Some(index), 0)) };
    if colours > most {
        let samples = most.min(SAMPLES);
        entries.push(Entry { text: format!("{colours} curves, among them"), line: None });
        entries.extend((0..samples).map(|part| coloured(part * (colours - 1) / (samples - 1))));
    } else {
        entries.extend((0..colours).map(coloured));
    }
    if plot.dashes.len() > 1 {
        entries.extend(
            plot.dashes
                .iter()
                .enumerate()
                .map(|(dash, text)| Entry { text: text.clone(), line: Some((None, dash)) }),
        );
    }
    entries
}

/// Which entries stand in which row.
fn in_rows(entries: &[Entry], width: f64) -> Vec<std::ops::Range<usize>> {
    let mut rows = Vec::new();
    let (mut first, mut taken) = (0, 0.0);
    for (index, entry) in entries.iter().enumerate() {
        if index > first && taken + entry.width() > width + APART {
            rows.push(first..index);
            (first, taken) = (index, 0.0);
        }
        taken += entry.width();
    }
    rows.push(first..entries.len());
    rows.retain(|row| !row.is_empty());
    rows
}

/// A text in lines of so many ems.
fn wrapped(text: &str, most: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let Some(line) = lines.last_mut() else { break };
        if line.is_empty() {
            line.push_str(word);
        } else if ems(line) + ems(" ") + ems(word) <= most {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}
