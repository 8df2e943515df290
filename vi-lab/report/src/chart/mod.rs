//! Charts: named series in, an SVG figure and a CSV table of the same points out.
//!
//! In: a [`Chart`], whose series contain all computed values. Out: [`Chart::figure`], in which a series is thinned to
//! its resolution in pixels (`thin`); the CSV lists exactly the drawn points. A logarithmic axis is drawn as a linear
//! axis of log10 with custom labels, because the logarithmic axes of the library clamp silently below 1e-10. Prose and
//! file paths are handled elsewhere.

mod axis;
mod draw;
mod map;
mod palette;
mod sheet;
mod thin;
mod trace;

pub use axis::Axis;
pub use map::{Class, Map, boundary, middles};
pub use palette::Look;
pub use sheet::{Panel, Sheet};
use thin::Thinning;
pub use trace::{Sample, Trace};

/// A figure: axes and series.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Stem of the file names.
    pub name: &'static str,
    /// Line above the figure.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Whether a unit has the same length on both axes, as in a phase portrait.
    pub equal_aspect: bool,
    /// The series, back to front.
    pub series: Vec<Series>,
}

/// One curve or cloud of points.
#[derive(Clone, Debug)]
pub struct Series {
    /// Entry in the legend; `None` for background curves.
    pub label: Option<String>,
    /// Colour, stroke and marker.
    pub look: Look,
    /// The thinning of a long series.
    thinning: Thinning,
    /// The points in the units of the axes, before any logarithm.
    pub points: Vec<(f64, f64)>,
    /// Ordinates of the whisker ends of the points; empty without whiskers.
    whiskers: Vec<f64>,
}

/// A figure in its file formats.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Stem of the file names.
    pub name: &'static str,
    /// The figure.
    pub svg: String,
    /// The drawn points, `series,x,y`, with computed values.
    pub csv: String,
}

impl Chart {
    /// A figure with a horizontal and a vertical axis, in units of different lengths. `name` is the stem of its file names.
    pub fn new(name: &'static str, title: impl Into<String>, [x, y]: [Axis; 2], series: Vec<Series>) -> Self {
        Self { name, title: title.into(), x, y, equal_aspect: false, series }
    }
}

impl Series {
    /// A line through a function of the abscissa; thinned to its envelope.
    pub fn line(label: impl Into<String>, look: Look, points: Vec<(f64, f64)>) -> Self {
        Self { label: Some(label.into()), look, thinning: Thinning::Envelope, points, whiskers: Vec::new() }
    }

    /// Separate points.
    pub fn scatter(label: impl Into<String>, look: Look, points: Vec<(f64, f64)>) -> Self {
        Self { label: Some(label.into()), look, thinning: Thinning::Cells, points, whiskers: Vec::new() }
    }

    /// A curve in the plane.
    pub fn curve(label: impl Into<String>, look: Look, points: Vec<(f64, f64)>) -> Self {
        Self { label: Some(label.into()), look, thinning: Thinning::Curve, points, whiskers: Vec::new() }
    }

    /// A background curve without an entry in the legend.
    #[must_use]
    pub fn background(points: Vec<(f64, f64)>) -> Self {
        Self { label: None, look: Look::BACKGROUND, thinning: Thinning::Curve, points, whiskers: Vec::new() }
    }

    /// The same series with a whisker from each point to the given ordinate.
    #[must_use]
    pub fn with_whiskers(self, whiskers: Vec<f64>) -> Self {
        Self { whiskers, ..self }
    }

    /// The same series without an entry in the legend.
    #[must_use]
    pub fn unlabelled(self) -> Self {
        Self { label: None, ..self }
    }
}
