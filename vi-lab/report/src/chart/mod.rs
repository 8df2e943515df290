//! Charts: named series in, one SVG figure and one CSV table of the same points out.
//!
//! In: a [`Chart`], whose series hold the values as computed, however many. Out: [`Chart::figure`], in which a series
//! is thinned to what its width in pixels can show (`thin`); the CSV lists exactly the points drawn.
//! A logarithmic axis is drawn as a linear axis of log10 with labels of its own, because the library's logarithmic
//! axes clamp in silence below 1e-10. Not done here: prose, and where files go.

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

/// One figure: axes and what is drawn between them.
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
    /// What is drawn, the first at the back.
    pub series: Vec<Series>,
}

/// One curve or cloud of points.
#[derive(Clone, Debug)]
pub struct Series {
    /// Entry in the legend; none for curves of the background.
    pub label: Option<String>,
    /// Colour, stroke and marker.
    pub look: Look,
    /// How a long series is thinned.
    thinning: Thinning,
    /// The points, in the units of the axes, before any logarithm.
    pub points: Vec<(f64, f64)>,
    /// Ordinates up to which a whisker goes from each point; empty where there are none.
    whiskers: Vec<f64>,
}

/// A figure as files hold it.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Stem of the file names.
    pub name: &'static str,
    /// The figure.
    pub svg: String,
    /// The points drawn, `series,x,y`, each as computed.
    pub csv: String,
}

impl Series {
    /// A line through a function of the abscissa: thinned to its envelope.
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

    /// A curve of the background, without an entry in the legend.
    #[must_use]
    pub fn background(points: Vec<(f64, f64)>) -> Self {
        Self { label: None, look: Look::BACKGROUND, thinning: Thinning::Curve, points, whiskers: Vec::new() }
    }

    /// The same series with a whisker at each point, up or down to the ordinate given for it.
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
