//! The palette of Okabe and Ito, distinguishable for colour-blind readers, with a stroke and a marker for each meaning.
//!
//! A method keeps its look in every figure. Source: Okabe and Ito, *Color universal design* (2008).

use kuva::prelude::MarkerShape;

/// The style of a series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Colour as hexadecimal RGB.
    pub colour: &'static str,
    /// Width of the line in pixels; zero draws none.
    pub width: f64,
    /// Lengths of dashes and gaps, in the figure and in the legend, whose sample is ten pixels long; `None` for a line
    /// without gaps.
    pub dashes: Option<[&'static str; 2]>,
    /// Marker at each point, with its radius in pixels.
    pub marker: Option<(MarkerShape, f64)>,
}

const DASHED: Option<[&str; 2]> = Some(["8 4", "4 2"]);
const DOTTED: Option<[&str; 2]> = Some(["2 4", "1.5 1.5"]);

impl Look {
    /// The energy-preserving integrator.
    pub const ENERGY: Self = Self::of("#D55E00", MarkerShape::Circle);
    /// The fixed-step integrator.
    pub const FIXED: Self = Self::of("#0072B2", MarkerShape::Square);
    /// Gauss methods of few stages, of many, and with adaptive steps.
    pub const GAUSS: [Self; 3] = [
        Self { dashes: DASHED, ..Self::of("#56B4E9", MarkerShape::Plus) },
        Self { width: 2.6, ..Self::of("#56B4E9", MarkerShape::Circle) },
        Self { dashes: DOTTED, ..Self::of("#56B4E9", MarkerShape::Diamond) },
    ];
    /// A method of another library.
    pub const RIVAL: Self = Self::of("#000000", MarkerShape::Cross);
    /// The exact solution, or a theoretical law.
    pub const EXACT: Self = Self { colour: "#333333", width: 1.4, dashes: DASHED, marker: None };
    /// Outline of [`Look::EXACT`] on a coloured background.
    pub const HALO: Self = Self { colour: "#FFFFFF", width: 4.0, dashes: None, marker: None };
    /// A published number.
    pub const PUBLISHED: Self = Self { colour: "#777777", width: 1.4, dashes: DOTTED, marker: None };
    /// Level sets and similar curves.
    pub const BACKGROUND: Self = Self { colour: "#C9CED6", width: 1.0, dashes: None, marker: None };
    /// Further series in order.
    pub const OTHERS: [Self; 4] = [
        Self::of("#009E73", MarkerShape::Triangle),
        Self::of("#CC79A7", MarkerShape::Diamond),
        Self::of("#E69F00", MarkerShape::TriangleDown),
        Self::of("#56B4E9", MarkerShape::Plus),
    ];

    const fn of(colour: &'static str, marker: MarkerShape) -> Self {
        Self { colour, width: 1.8, dashes: None, marker: Some((marker, 4.0)) }
    }

    /// The line alone.
    #[must_use]
    pub const fn line(self) -> Self {
        Self { marker: None, ..self }
    }

    /// The line alone, dashed.
    #[must_use]
    pub const fn dashed(self) -> Self {
        Self { marker: None, dashes: DASHED, ..self }
    }

    /// The line alone, dotted.
    #[must_use]
    pub const fn dotted(self) -> Self {
        Self { marker: None, dashes: DOTTED, ..self }
    }

    /// The markers alone, of the given radius.
    #[must_use]
    pub const fn dots(self, radius: f64) -> Self {
        let marker = match self.marker {
            Some((shape, _)) => Some((shape, radius)),
            None => Some((MarkerShape::Circle, radius)),
        };
        Self { width: 0.0, marker, ..self }
    }
}
