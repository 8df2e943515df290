//! Pictures of mechanisms beside charts, as SVG.
//!
//! In: lines in the coordinates of a mechanism, and curves over time. Out: the text of an SVG file. Pixels have one
//! decimal, so that the files are small.

use std::fmt::Write as _;

/// The size of a picture in pixels, and of its parts.
const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 340.0;
const MECHANISM: Frame = Frame { left: 15.0, top: 40.0, width: 360.0, height: 285.0 };
const CHARTS: Frame = Frame { left: 460.0, top: 40.0, width: 420.0, height: 250.0 };
/// Distance of charts above each other.
const GAP: f64 = 26.0;

/// Colours of curves that people with any colour vision tell apart (Okabe and Ito).
const COLOURS: [&str; 4] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"];

/// A rectangle.
#[derive(Clone, Copy)]
struct Frame {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

/// The style of a line of a mechanism.
#[derive(Clone, Copy)]
pub(crate) enum Style {
    /// A body; its opacity grows with time.
    Body(f64),
    /// A joint or a mass, a dot at each point; its opacity.
    Joint(f64),
    /// The path of a point.
    Path,
    /// A part that does not move.
    Ground,
}

/// A line of a mechanism.
pub(crate) struct Line {
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) style: Style,
}

/// Curves over time, with their names.
pub(crate) struct Chart {
    pub(crate) curves: Vec<(String, Vec<[f64; 2]>)>,
}

/// A mechanism and charts of its motion.
pub(crate) struct Picture {
    pub(crate) title: &'static str,
    pub(crate) lines: Vec<Line>,
    pub(crate) charts: Vec<Chart>,
}

/// The smallest rectangle with all points: its corners.
fn bounds<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> [[f64; 2]; 2] {
    let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    points.fold(none, |[low, high], point| {
        [[low[0].min(point[0]), low[1].min(point[1])], [high[0].max(point[0]), high[1].max(point[1])]]
    })
}

/// A map from the coordinates of a drawing to pixels.
struct Map {
    scale: [f64; 2],
    shift: [f64; 2],
}

impl Map {
    /// The map of a rectangle onto a frame; with the same scale of both axes if `is_true`.
    fn of([low, high]: [[f64; 2]; 2], frame: Frame, is_true: bool) -> Self {
        let size = [0, 1].map(|axis| (high[axis] - low[axis]).max(1e-9));
        let mut scale = [frame.width / size[0], frame.height / size[1]];
        if is_true {
            scale = [scale[0].min(scale[1]); 2];
        }
        let middle = [0, 1].map(|axis| f64::midpoint(low[axis], high[axis]));
        let centre = [frame.left + frame.width / 2.0, frame.top + frame.height / 2.0];
        Self { scale, shift: [centre[0] - scale[0] * middle[0], centre[1] + scale[1] * middle[1]] }
    }

    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.shift[0] + self.scale[0] * x, self.shift[1] - self.scale[1] * y]
    }

    /// The points of a polyline.
    fn line(&self, points: &[[f64; 2]]) -> String {
        let mut text = String::new();
        for point in points {
            let [x, y] = self.at(*point);
            let _ = write!(text, "{x:.1},{y:.1} ");
        }
        text.trim_end().to_owned()
    }
}

impl Picture {
    /// The picture as the text of a file.
    pub(crate) fn svg(&self) -> String {
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" \
             height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"none\">\n\
             <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>\n\
             <text x=\"15\" y=\"22\" font-size=\"14\" fill=\"#222222\">{}</text>\n",
            self.title
        );
        let map = Map::of(bounds(self.lines.iter().flat_map(|line| &line.points)), MECHANISM, true);
        for line in &self.lines {
            svg += &drawn(line, &map);
        }
        let count = f64::from(u8::try_from(self.charts.len()).unwrap_or(1));
        let height = (CHARTS.height - GAP * (count - 1.0)) / count;
        let mut top = CHARTS.top;
        for (index, chart) in self.charts.iter().enumerate() {
            let is_last = index + 1 == self.charts.len();
            svg += &chart.svg(Frame { top, height, ..CHARTS }, is_last);
            top += height + GAP;
        }
        svg + "</svg>\n"
    }
}

/// A line of a mechanism.
fn drawn(line: &Line, map: &Map) -> String {
    let stroke = |colour: &str, width: f64, opacity: f64| {
        format!(
            "<polyline points=\"{}\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-opacity=\"{opacity:.2}\" \
             stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n",
            map.line(&line.points)
        )
    };
    match line.style {
        Style::Body(opacity) => stroke("#333333", 3.0, opacity),
        Style::Path => stroke(COLOURS[1], 1.2, 0.8),
        Style::Ground => stroke("#999999", 1.5, 1.0),
        Style::Joint(opacity) => {
            let dot = |point: &[f64; 2]| {
                let [x, y] = map.at(*point);
                format!(
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{}\" fill-opacity=\"{opacity:.2}\"/>\n",
                    COLOURS[0]
                )
            };
            line.points.iter().map(dot).collect()
        }
    }
}

impl Chart {
    /// The chart in a frame; the last one names the axis of time.
    fn svg(&self, frame: Frame, is_last: bool) -> String {
        let Frame { left, top, width, height } = frame;
        let [mut low, mut high] = bounds(self.curves.iter().flat_map(|(_, points)| points));
        let margin = ((high[1] - low[1]) * 0.06).max(1e-9);
        (low[1], high[1]) = (low[1] - margin, high[1] + margin);
        let map = Map::of([low, high], frame, false);
        let mut svg = format!(
            "<rect x=\"{left}\" y=\"{top:.1}\" width=\"{width}\" height=\"{height:.1}\" stroke=\"#cccccc\"/>\n"
        );
        for value in ticks(low[1], high[1], 4.0) {
            let [_, y] = map.at([low[0], value]);
            let _ = write!(
                svg,
                "<line x1=\"{left}\" y1=\"{y:.1}\" x2=\"{}\" y2=\"{y:.1}\" stroke=\"#eeeeee\"/>\n\
                 <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#555555\">{}</text>\n",
                left + width,
                left - 6.0,
                y + 4.0,
                short(value)
            );
        }
        for value in ticks(low[0], high[0], 6.0) {
            let [x, y] = map.at([value, low[1]]);
            let label = if is_last { short(value) } else { String::new() };
            let _ = write!(
                svg,
                "<line x1=\"{x:.1}\" y1=\"{top:.1}\" x2=\"{x:.1}\" y2=\"{y:.1}\" stroke=\"#eeeeee\"/>\n\
                 <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#555555\">{label}</text>\n",
                y + 16.0
            );
        }
        if is_last {
            let _ = writeln!(
                svg,
                "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#222222\">time</text>",
                left + width / 2.0,
                top + height + 32.0
            );
        }
        let mut place = left + width;
        for ((name, points), colour) in self.curves.iter().zip(COLOURS).rev() {
            let _ = write!(
                svg,
                "<polyline points=\"{}\" stroke=\"{colour}\" stroke-width=\"1.6\" stroke-linejoin=\"round\"/>\n\
                 <text x=\"{place:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"{colour}\">{name}</text>\n",
                map.line(points),
                top - 6.0
            );
            place -= 7.0 * f64::from(u16::try_from(name.chars().count()).unwrap_or(0)) + 16.0;
        }
        svg
    }
}

/// About `count` round numbers of an interval.
fn ticks(low: f64, high: f64, count: f64) -> Vec<f64> {
    let rough = (high - low) / count;
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|of| of * power).find(|step| *step >= rough).unwrap_or(rough);
    let mut value = (low / step).ceil() * step;
    let mut ticks = Vec::new();
    while value <= high {
        ticks.push(value);
        value += step;
    }
    ticks
}

/// A number with four digits.
fn short(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded }).replace('-', "−")
}
