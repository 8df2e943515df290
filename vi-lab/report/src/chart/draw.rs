//! Drawing: from a [`Chart`] to its SVG and CSV.
//!
//! The plot area has fixed margins, so that thinning knows the pixel of a coordinate.

use super::axis::Ruler;
use super::{Chart, Figure, Look, Series};
use core::fmt::Write as _;
use kuva::prelude::{
    Layout, LegendEntry, LegendPosition, LegendShape, LinePlot, LineStyle, Plot, ScatterPlot, SvgBackend, TickFormat,
    render_multiple,
};
use std::sync::Arc;

/// Margins of the plot area.
pub(super) const MARGINS: Margins = Margins { left: 88.0, right: 216.0, top: 44.0, bottom: 60.0 };
/// The default plot area.
const AREA: Area = Area { width: 596.0, height: 330.0 };

/// Margins around the plot area in pixels; the legend is on the right.
#[derive(Clone, Copy, Debug)]
pub(super) struct Margins {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
}

/// Size of the plot area in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub(super) width: f64,
    pub(super) height: f64,
}

/// The frame of a chart: its axes, its plot area, its margins.
struct Frame {
    x: Ruler,
    y: Ruler,
    area: Area,
    margins: Margins,
}

/// A series in drawn form: coordinates for the figure, values for the table.
struct Drawn<'a> {
    series: &'a Series,
    coordinates: Vec<(f64, f64)>,
    values: Vec<(f64, f64)>,
    /// Whisker of each point: its end in the figure and its value; empty without whiskers.
    whiskers: Vec<(f64, f64)>,
}

impl Chart {
    /// The chart as an SVG figure, and the drawn points as a CSV table.
    #[must_use]
    pub fn figure(&self) -> Figure {
        self.figure_over(None)
    }

    /// The chart as an SVG figure, drawn over a map. The entries of the map come first in the legend, and its cells
    /// hide the grid.
    pub(super) fn figure_over(&self, map: Option<Vec<LegendEntry>>) -> Figure {
        let (placed, [x, y]) = self.placed();
        let frame = Frame { area: self.area(&x, &y), x, y, margins: MARGINS };
        let drawn = frame.thinned(&placed);
        Figure { name: self.name, svg: self.svg(&drawn, &frame, map), csv: self.csv(&drawn) }
    }

    /// The chart as an SVG figure with a given plot area and margins. With equal aspect the shorter range is widened.
    pub(super) fn svg_in(&self, area: Area, margins: Margins) -> String {
        let (placed, [mut x, mut y]) = self.placed();
        if self.equal_aspect {
            let unit = (x.length() / area.width).max(y.length() / area.height);
            x = x.widened_to(unit * area.width);
            y = y.widened_to(unit * area.height);
        }
        let frame = Frame { x, y, area, margins };
        self.svg(&frame.thinned(&placed), &frame, None)
    }

    /// The points inside the axes, and the rulers around them.
    fn placed(&self) -> (Vec<Drawn<'_>>, [Ruler; 2]) {
        let placed: Vec<Drawn<'_>> = self.series.iter().map(|series| self.place(series)).collect();
        let points = || placed.iter().flat_map(|drawn| &drawn.coordinates);
        let ends = placed.iter().flat_map(|drawn| &drawn.whiskers);
        let x = self.x.ruler(points().map(|point| point.0));
        let y = self.y.ruler(points().map(|point| point.1).chain(ends.map(|end| end.0)));
        (placed, [x, y])
    }

    /// The points of a series inside the axes.
    fn place<'a>(&self, series: &'a Series) -> Drawn<'a> {
        let both = |&(x, y): &(f64, f64)| Some((self.x.coordinate(x)?, self.y.coordinate(y)?));
        let mut drawn = Drawn { series, coordinates: Vec::new(), values: Vec::new(), whiskers: Vec::new() };
        for (index, point) in series.points.iter().enumerate() {
            let Some(coordinates) = both(point) else { continue };
            drawn.coordinates.push(coordinates);
            drawn.values.push(*point);
            // A whisker outside the axis has no length.
            let whisker = series.whiskers.get(index);
            drawn.whiskers.extend(whisker.map(|end| (self.y.coordinate(*end).unwrap_or(coordinates.1), *end)));
        }
        drawn
    }

    /// Size of the plot area, if both axes have ranges.
    pub(super) fn fixed_area(&self) -> Area {
        self.area(&self.x.ruler(core::iter::empty()), &self.y.ruler(core::iter::empty()))
    }

    /// Size of the plot area; with equal aspect, the largest within the default width and 1.5 times the default height.
    fn area(&self, x: &Ruler, y: &Ruler) -> Area {
        if !self.equal_aspect {
            return AREA;
        }
        let [width, height] = [x, y].map(Ruler::length);
        let scale = (AREA.width / width).min(1.5 * AREA.height / height);
        Area { width: scale * width, height: scale * height }
    }

    fn svg(&self, drawn: &[Drawn<'_>], place: &Frame, map: Option<Vec<LegendEntry>>) -> String {
        let Frame { x, y, area, margins } = place;
        let grid = map.is_none();
        let series = drawn.iter().filter_map(|drawn| legend_entry(drawn.series));
        let legend = map.into_iter().flatten().chain(series).collect();
        let label_x = x.clone();
        let label_y = y.clone();
        let units = (x.unit(), y.unit());
        let in_units = |ruler: &Ruler, unit: f64| (ruler.range.0 / unit, ruler.range.1 / unit);
        let [x_range, y_range] = [in_units(x, units.0), in_units(y, units.1)];
        let layout = Layout::new(x_range, y_range)
            .with_width(area.width + margins.left + margins.right)
            .with_height(area.height + margins.top + margins.bottom)
            .with_force_margins(margins.left, margins.right)
            .with_force_margins_y(margins.top, margins.bottom)
            .with_x_axis_min(x_range.0)
            .with_x_axis_max(x_range.1)
            .with_y_axis_min(y_range.0)
            .with_y_axis_max(y_range.1)
            .with_x_tick_step(x.step / units.0)
            .with_y_tick_step(y.step / units.1)
            .with_x_tick_format(TickFormat::Custom(Arc::new(move |value| label_x.tick_label(value * units.0))))
            .with_y_tick_format(TickFormat::Custom(Arc::new(move |value| label_y.tick_label(value * units.1))))
            .with_title(self.title.as_str())
            .with_x_label(self.x.label.as_str())
            .with_y_label(self.y.label.as_str())
            .with_title_size(16)
            .with_label_size(14)
            .with_tick_size(12)
            .with_body_size(12)
            .with_legend_position(LegendPosition::OutsideRightTop)
            .with_legend_entries(legend)
            .with_show_grid(grid)
            .with_legend_box(false);
        let mut plots: Vec<Plot> = drawn.iter().flat_map(|drawn| plots(drawn, units)).collect();
        if plots.is_empty() {
            // The library draws no axes without data.
            let ends = [(x_range.0, y_range.0), (x_range.1, y_range.1)];
            plots.push(Plot::Line(LinePlot::new().with_data(ends).with_color("none").with_stroke_width(0.0)));
        }
        let svg = SvgBackend::new().render_scene(&render_multiple(plots, layout));
        // Clip names are global on the page: two figures must not share one.
        svg.replace("kuva-clip-", &format!("{}-clip-", self.name))
    }

    fn csv(&self, drawn: &[Drawn<'_>]) -> String {
        let mut csv = format!("# {}: {}\n", self.name, self.title);
        let name = |(number, drawn): (usize, &Drawn<'_>)| {
            drawn.series.label.clone().unwrap_or_else(|| format!("background {number}"))
        };
        let named: Vec<(String, &Drawn<'_>)> = drawn.iter().enumerate().map(|of| (name(of), of.1)).collect();
        // Writing to a string cannot fail.
        for (name, drawn) in &named {
            let [shown, computed] = [drawn.values.len(), drawn.series.points.len()];
            let _ = writeln!(csv, "# {name}: {shown} of {computed} points, those that the figure shows");
        }
        let whiskers = drawn.iter().any(|drawn| !drawn.whiskers.is_empty());
        let third = if whiskers { ",whisker" } else { "" };
        let _ = writeln!(csv, "series,\"{}\",\"{}\"{third}", self.x.label, self.y.label);
        for (name, drawn) in named {
            for (index, (x, y)) in drawn.values.iter().enumerate() {
                let end = drawn.whiskers.get(index).map_or_else(String::new, |(_, end)| format!("{end:e}"));
                let third = if whiskers { format!(",{end}") } else { end };
                let _ = writeln!(csv, "\"{name}\",{x:e},{y:e}{third}");
            }
        }
        csv
    }
}

/// The entry of a labelled series: its marker, or its line.
fn legend_entry(series: &Series) -> Option<LegendEntry> {
    let label = series.label.clone()?;
    let Look { colour, dashes, marker, .. } = series.look;
    let shape = marker.map_or(LegendShape::Line, |(shape, _)| LegendShape::Marker(shape));
    let dasharray = dashes.map(|[_, sample]| sample.to_owned());
    Some(LegendEntry { label, color: colour.to_owned(), shape, dasharray })
}

impl Frame {
    /// The points of each series that the figure can resolve.
    fn thinned<'a>(&self, placed: &[Drawn<'a>]) -> Vec<Drawn<'a>> {
        let Self { x, y, area, .. } = self;
        let pixel = |ruler: &Ruler, length: f64, c: f64| (c - ruler.range.0) / ruler.length() * length;
        let one = |&Drawn { series, ref coordinates, ref values, ref whiskers }: &Drawn<'a>| {
            let pixels = coordinates.iter().map(|&(a, b)| (pixel(x, area.width, a), pixel(y, area.height, b)));
            let kept = series.thinning.keep(&pixels.collect::<Vec<_>>());
            let pick = |points: &[(f64, f64)]| kept.iter().filter_map(|&index| points.get(index).copied()).collect();
            Drawn { series, coordinates: pick(coordinates), values: pick(values), whiskers: pick(whiskers) }
        };
        placed.iter().map(one).collect()
    }
}

/// The library's plots for one series, in units of the axes: a line, markers, or both.
fn plots(drawn: &Drawn<'_>, units: (f64, f64)) -> Vec<Plot> {
    let Look { colour, width, dashes, marker } = drawn.series.look;
    let points = || drawn.coordinates.iter().map(|(x, y)| (x / units.0, y / units.1));
    let mut plots = Vec::new();
    if width > 0.0 {
        let line = LinePlot::new().with_data(points()).with_color(colour).with_stroke_width(width);
        let style = dashes.map_or(LineStyle::Solid, |[pattern, _]| LineStyle::Custom(pattern.to_owned()));
        plots.push(Plot::Line(line.with_line_style(style)));
    }
    if let Some((shape, radius)) = marker {
        let scatter = ScatterPlot::new().with_data(points()).with_color(colour).with_size(radius);
        // A whisker is the distance to its end, downwards or upwards.
        let ends = drawn.coordinates.iter().zip(&drawn.whiskers);
        let arms =
            ends.map(|(point, end)| ((point.1 - end.0).max(0.0) / units.1, (end.0 - point.1).max(0.0) / units.1));
        plots.push(Plot::Scatter(scatter.with_marker(shape).with_y_err_asymmetric(arms)));
    }
    plots
}

#[cfg(test)]
mod tests {
    use super::super::{Axis, Thinning};
    use super::*;

    fn chart(y: Axis, series: Vec<Series>) -> Chart {
        Chart::new("test", "test", [Axis::linear("x"), y], series)
    }

    /// Vertical positions of the circles of an SVG, in order.
    fn circles(svg: &str) -> Vec<f64> {
        svg.split("<circle ")
            .skip(1)
            .filter_map(|circle| circle.split("cy=\"").nth(1)?.split('"').next()?.parse().ok())
            .collect()
    }

    #[test]
    fn small_values_land_on_pixels_of_their_own() {
        let points = vec![(0.0, 1e-14), (1.0, 1e-12), (2.0, 1e-2)];
        let series = Series::scatter("points", Look::ENERGY.dots(3.0), points);
        let figure = chart(Axis::log10("y").over(1e-16, 1.0), vec![series]).figure();
        let heights = circles(&figure.svg);
        let a = heights[0];
        let b = heights[1];
        let c = heights[2];
        // Two decades of sixteen on an axis of 330 pixels are 41.25 pixels, ten are 206.25; the file rounds to 0.01.
        assert!((a - b - 41.25).abs() < 0.02 && (b - c - 206.25).abs() < 0.02, "{heights:?}");
    }

    #[test]
    fn ranges_far_from_one_are_drawn_as_those_near_it() {
        let heights = |unit: f64| {
            let points = [0.0, 1.0, 4.0].map(|value| (value, value * unit)).to_vec();
            let series = Series::scatter("points", Look::ENERGY.dots(3.0), points);
            let figure = chart(Axis::linear("y"), vec![series]).figure();
            (circles(&figure.svg), figure.svg)
        };
        let (near, _) = heights(1.0);
        for (unit, tick) in [(1e-20, "4·10⁻²⁰"), (1e25, "4·10²⁵")] {
            let (far, svg) = heights(unit);
            // The file rounds to 0.01.
            assert!(
                near.iter().zip(&far).all(|(one, other)| (one - other).abs() < 0.02),
                "{far:?} instead of {near:?}"
            );
            assert!(svg.contains(tick), "{svg}");
        }
    }

    #[test]
    fn values_that_are_not_positive_are_left_out_of_a_logarithmic_axis() {
        let points = vec![(0.0, 0.0), (1.0, 1e-12), (2.0, f64::NAN), (3.0, -1.0)];
        let figure = chart(Axis::log10("y"), vec![Series::line("a line", Look::FIXED.line(), points)]).figure();
        assert!(figure.csv.contains("# a line: 1 of 4 points"), "{}", figure.csv);
    }

    #[test]
    fn equal_aspect_draws_circles_as_circles() {
        let circle: Vec<(f64, f64)> =
            (0..=360).map(|i| f64::from(i).to_radians()).map(|a| (a.cos(), a.sin())).collect();
        let series = vec![Series { thinning: Thinning::Curve, ..Series::background(circle) }];
        let chart = Chart { equal_aspect: true, ..chart(Axis::linear("y"), series) };
        let x = chart.x.ruler([-1.0, 1.0].into_iter());
        let area = chart.area(&x, &x);
        assert!((area.width - area.height).abs() < 1e-12 && area.width > 100.0, "{area:?}");
    }
}
