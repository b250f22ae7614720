//! How a picture is drawn, as requests say it.

use super::style::TENTHS;
use crate::http::input::object::object;
use crate::http::input::wire::{Count, named};

/// Width and height of a picture, pixels: the least, the most, and what they are when nothing is said.
pub(crate) const LEAST_PIXELS: usize = 300;
pub(crate) const MOST_PIXELS: usize = 2400;
const DEFAULT_WIDTH: usize = 720;
const DEFAULT_HEIGHT: usize = 480;

/// Decades of a logarithmic axis.
pub(crate) const MOST_DECADES: usize = 100_000;
const DEFAULT_DECADES: usize = 12;

/// What the axes are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Form {
    Cartesian,
    Polar,
}

/// What is drawn of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Scale {
    Linear,
    Log10,
}

/// Which curves of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Shown {
    Total,
    Components,
    All,
}

/// Colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Theme {
    Light,
    Dark,
}

impl Form {
    const fn name(self) -> &'static str {
        match self {
            Self::Cartesian => "cartesian",
            Self::Polar => "polar",
        }
    }
}

impl Scale {
    const fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Log10 => "log10",
        }
    }
}

impl Shown {
    const fn name(self) -> &'static str {
        match self {
            Self::Total => "total",
            Self::Components => "components",
            Self::All => "all",
        }
    }
}

impl Shown {
    /// Where nothing is said, of so many curves.
    pub(crate) const fn natural(curves: usize) -> Self {
        if curves > 1 { Self::Total } else { Self::All }
    }
}

impl Theme {
    const fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Dark => "dark",
        }
    }
}

named! {
    Form, "a form of plot", [Form::Cartesian, Form::Polar];
    Scale, "a scale", [Scale::Linear, Scale::Log10];
    Shown, "a choice of curves", [Shown::Total, Shown::Components, Shown::All];
    Theme, "a theme", [Theme::Light, Theme::Dark];
}

object! {
    /// How a picture is drawn. Only answers as `image/svg+xml` and `image/png` read it. Where points lie closer than half a
    /// pixel, the first, the least, the largest and the last of them are drawn: no peak is lost.
    PlotWire as "Plot" {
        /// `cartesian`: the value over the swept angle; or `polar`: the value as the distance from the origin, the angle
        /// from the surface normal. When absent or null: as in the report for a figure, `cartesian` for a diagram.
        form: Option<Form>,
        /// `linear` (when absent or null) or `log10`, which is right also where values underflow.
        scale: Option<Scale>,
        /// Decades below the largest value that a `log10` axis shows at most; 12 when absent or null.
        decades: Option<Count<1, MOST_DECADES>>,
        /// `total`, `components`, or `all` of them. When absent or null: `all` where there is one curve, `total` where
        /// there are several.
        curves: Option<Shown>,
        /// `light` (when absent or null) or `dark`.
        theme: Option<Theme>,
        /// Width, pixels; 720 when absent or null.
        width_px: Option<Count<LEAST_PIXELS, MOST_PIXELS>>,
        /// Height, pixels; 480 when absent or null.
        height_px: Option<Count<LEAST_PIXELS, MOST_PIXELS>>,
    }
}

/// The same with every default in its place: equal where the pictures are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Options {
    pub(crate) form: Form,
    pub(crate) scale: Scale,
    pub(crate) decades: usize,
    pub(crate) shown: Option<Shown>,
    pub(crate) theme: Theme,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

/// The size in pixels at which letters have theirs: they grow and shrink with the picture, between these factors.
const NATURAL: (f64, f64) = (600.0, 400.0);
const FACTORS: (f64, f64) = (0.7, 2.0);

impl Options {
    /// Width and height in tenths of the unit in which letters and lines have their size.
    pub(super) fn units(&self) -> (u32, u32) {
        let (width, height) = (self.width as f64, self.height as f64);
        let factor = (width / NATURAL.0).min(height / NATURAL.1).clamp(FACTORS.0, FACTORS.1);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some ten thousand at most"
        )]
        let units = |pixels: f64| (TENTHS * pixels / factor).round() as u32;
        (units(width), units(height))
    }

    /// What was asked for; `form` is the natural one.
    pub(crate) fn of(wire: Option<&PlotWire>, form: Form) -> Self {
        let said = |of: fn(&PlotWire) -> Option<usize>| wire.and_then(of);
        let decades = said(|wire| wire.decades.map(|Count(decades)| decades));
        let width = said(|wire| wire.width_px.map(|Count(width)| width));
        let height = said(|wire| wire.height_px.map(|Count(height)| height));
        let scale = wire.and_then(|wire| wire.scale).unwrap_or(Scale::Linear);
        Self {
            form: wire.and_then(|wire| wire.form).unwrap_or(form),
            scale,
            // A linear axis has none.
            decades: if scale == Scale::Log10 { decades.unwrap_or(DEFAULT_DECADES) } else { 0 },
            shown: wire.and_then(|wire| wire.curves),
            theme: wire.and_then(|wire| wire.theme).unwrap_or(Theme::Light),
            width: width.unwrap_or(DEFAULT_WIDTH),
            height: height.unwrap_or(DEFAULT_HEIGHT),
        }
    }
}
