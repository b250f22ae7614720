//! Maps over the (g, x) plane.

use super::style::{Area, Drawn, beside, boxes, colour, font, power_of_ten};
use crate::plane::{self, CELLS, FIRST, Grid, LAST};
use plotters::prelude::*;
use reflectance::reflectance::numeric::lobe_series::Method;
use std::error::Error;

/// Upper ends of the classes of error, powers of ten; beyond the last, nothing is left of the value.
const CLASSES: [i32; 8] = [-13, -11, -9, -7, -5, -3, -1, 0];
/// From dark blue to yellow in steps of lightness (matplotlib's viridis), then grey.
const SCALE: [RGBColor; 9] = [
    RGBColor(68, 1, 84),
    RGBColor(70, 50, 126),
    RGBColor(54, 92, 141),
    RGBColor(39, 127, 142),
    RGBColor(31, 161, 135),
    RGBColor(74, 193, 109),
    RGBColor(160, 218, 57),
    RGBColor(253, 231, 37),
    RGBColor(205, 205, 205),
];

/// The error of each named method, and of `auto`.
pub(crate) fn errors(map: &plane::Map) -> Result<String, Box<dyn Error>> {
    let auto = Some(1e-9);
    let panels = [
        (Method::Series, None, "series (its own bound)"),
        (Method::Uniform, None, "uniform"),
        (Method::Paper, None, "paper: the first 100 terms"),
        (Method::Smooth, None, "smooth (48)"),
        (Method::Rough, None, "rough (49)"),
        (Method::Auto, auto, "auto, tolerance 10⁻⁹"),
    ];
    picture((1220, 900), |root| {
        let (top, rest) = root.split_vertically(70);
        top.draw(&Text::new("Relative error of S(g, x), up to", (20, 24), beside(17)))?;
        let mut entries: Vec<_> =
            SCALE.into_iter().zip(CLASSES.map(|edge| power_of_ten(f64::from(edge)))).collect();
        entries.push((SCALE[8], "more than 1".to_owned()));
        boxes(&top, (310, 24), &entries, 88)?;
        for ((method, tolerance, title), area) in panels.into_iter().zip(rest.split_evenly((2, 3))) {
            let layer = map.layer(method, tolerance).ok_or("a panel without its layer")?;
            panel(&area, title, &layer.cells, |off| SCALE[class(off.error)])?;
        }
        Ok(())
    })
}

fn class(log_error: f64) -> usize {
    CLASSES.iter().position(|&edge| log_error <= f64::from(edge)).unwrap_or(CLASSES.len())
}

/// What `auto` takes.
pub(crate) fn choices(map: &plane::Map) -> Result<String, Box<dyn Error>> {
    let shown: Vec<_> = map.auto().filter(|(tolerance, _)| [1e-3, 1e-9, 1e-13].contains(tolerance)).collect();
    let taken = |method: Method| {
        let mut cells = shown.iter().flat_map(|(_, layer)| layer.cells.iter().flatten().flatten());
        cells.any(|off| off.method == method)
    };
    picture((1220, 490), |root| {
        let (top, rest) = root.split_vertically(70);
        top.draw(&Text::new("auto takes", (20, 24), beside(17)))?;
        let methods = Method::ALL.into_iter().filter(|&method| taken(method));
        let entries: Vec<_> = methods.map(|method| (colour(method), method.name().to_owned())).collect();
        boxes(&top, (140, 24), &entries, 130)?;
        for ((tolerance, layer), area) in shown.iter().zip(rest.split_evenly((1, 3))) {
            let title = format!("tolerance {}", power_of_ten(tolerance.log10()));
            panel(&area, &title, &layer.cells, |off| colour(off.method))?;
        }
        Ok(())
    })
}

/// An SVG of this size.
pub(super) fn picture(
    size: (u32, u32),
    draw: impl FnOnce(&Area<'_>) -> Drawn,
) -> Result<String, Box<dyn Error>> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE)?;
        draw(&root)?;
        root.present()?;
    }
    // Without it neighbours of one colour show a seam where the picture is scaled.
    Ok(text.replacen("<svg ", "<svg shape-rendering=\"crispEdges\" ", 1))
}

fn panel<T>(area: &Area<'_>, title: &str, cells: &Grid<T>, colour: impl Fn(&T) -> RGBColor) -> Drawn {
    let (first, last) = (f64::from(FIRST), f64::from(LAST));
    let mut chart = ChartBuilder::on(area)
        .caption(title, font(18))
        .margin(6)
        .margin_right(18)
        .x_label_area_size(46)
        .y_label_area_size(62)
        .build_cartesian_2d(first..last, first..last)?;
    let colours: Vec<Vec<Option<RGBColor>>> =
        cells.iter().map(|row| row.iter().map(|cell| cell.as_ref().map(&colour)).collect()).collect();
    let at = |cell: usize| first + (last - first) * cell as f64 / CELLS as f64;
    chart.draw_series(merged(&colours).into_iter().map(|(columns, rows, colour)| {
        Rectangle::new(
            [(at(columns.start), at(rows.start)), (at(columns.end), at(rows.end))],
            colour.filled(),
        )
    }))?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc("g")
        .y_desc("x")
        .x_labels(7)
        .y_labels(7)
        .x_label_formatter(&|v| power_of_ten(*v))
        .y_label_formatter(&|v| power_of_ten(*v))
        .label_style(font(14))
        .axis_desc_style(font(17))
        .draw()?;
    chart.draw_series([Rectangle::new([(first, first), (last, last)], BLACK.stroke_width(1))])?;
    chart.draw_series([Text::new("S < 10⁻³⁰⁰", (-3.4, 6.6), font(15))])?;
    Ok(())
}

type Block = (std::ops::Range<usize>, std::ops::Range<usize>, RGBColor);

/// Cells of one colour gathered into rectangles, which makes the file a tenth as long.
fn merged(colours: &[Vec<Option<RGBColor>>]) -> Vec<Block> {
    let mut left = colours.to_vec();
    let mut blocks = Vec::new();
    for row in 0..left.len() {
        for column in 0..left[row].len() {
            let Some(colour) = left[row][column] else { continue };
            let same = |cell: &Option<RGBColor>| *cell == Some(colour);
            let right = column + left[row][column..].iter().take_while(|cell| same(cell)).count();
            let below = left[row..].iter().take_while(|row| row[column..right].iter().all(same)).count();
            for row in &mut left[row..row + below] {
                row[column..right].fill(None);
            }
            blocks.push((column..right, row..row + below, colour));
        }
    }
    blocks
}

#[cfg(test)]
#[test]
fn merged_blocks_cover_each_cell_once() {
    let (a, b) = (Some(BLACK), Some(WHITE));
    let colours = [vec![a, a, b, None], vec![a, a, b, b], vec![a, b, b, b]];
    let mut again = vec![vec![None; 4]; 3];
    for (columns, rows, colour) in merged(&colours) {
        for row in &mut again[rows] {
            for cell in &mut row[columns.clone()] {
                assert_eq!(cell.replace(colour), None);
            }
        }
    }
    assert_eq!(again, colours);
}
