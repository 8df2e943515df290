//! The motion of each system, and how its bodies are drawn.
//!
//! In: the default parameters and the start of a ready system. Out: a [`Picture`]. Every node of a run is drawn in the
//! charts, a few in the mechanism.

use crate::svg::{Chart, Line, Picture, Style};
use vi_core::stepping::Convertible;
use vi_core::{Gauss, Starts, State, StepError};
use vi_systems::{
    AndrewsSqueezer, ChaplyginSleigh, DoubleRodPendulum, FourBar, HeavyTop, RodChain, RodPendulum, RollingBall,
    RollingDisk, SliderCrank,
};

/// A node of a motion.
struct Row<const N: usize> {
    t: f64,
    q: [f64; N],
    v: [f64; N],
    reaction: Vec<f64>,
    energy: f64,
}

/// The nodes of a run of steps of order 6.
fn motion<S, const N: usize>(system: S, start: ([f64; N], [f64; N]), h: f64, end: f64) -> Result<Vec<Row<N>>, StepError>
where
    S: Convertible<N>,
{
    let row = |state: State<N>| -> Result<Row<N>, StepError> {
        let reaction = state.reaction(&system)?.as_ref().to_vec();
        let v = state.velocity(&system)?.into();
        Ok(Row { t: state.t, q: state.q.into(), v, reaction, energy: state.energy(&system)? })
    };
    let mut run = system.at(0.0, start.0, start.1).integrate(Gauss::<3>, h)?;
    let mut rows = vec![row(run.state())?];
    while run.t() < end - h / 2.0 {
        rows.push(row(run.step()?)?);
    }
    Ok(rows)
}

/// A curve over time, of a function of the nodes.
fn curve<const N: usize>(rows: &[Row<N>], name: &str, of: impl Fn(&Row<N>) -> f64) -> (String, Vec<[f64; 2]>) {
    (name.to_owned(), rows.iter().map(|row| [row.t, of(row)]).collect())
}

/// The path of a point.
fn path<const N: usize>(rows: &[Row<N>], of: impl Fn(&Row<N>) -> [f64; 2]) -> Line {
    Line { points: rows.iter().map(of).collect(), style: Style::Path }
}

/// Bodies and joints at `count` instants of the first part of a motion; later ones are darker.
fn instants<const N: usize>(
    rows: &[Row<N>],
    (count, part): (usize, f64),
    bodies: impl Fn(&Row<N>) -> Vec<Vec<[f64; 2]>>,
    joints: impl Fn(&Row<N>) -> Vec<[f64; 2]>,
) -> Vec<Line> {
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small counts
    let index = |k: usize| ((rows.len() - 1) as f64 * part * k as f64 / (count.max(2) - 1) as f64).round() as usize;
    let mut lines = Vec::new();
    for k in 0..count {
        let row = &rows[if count == 1 { 0 } else { index(k) }];
        #[allow(clippy::cast_precision_loss)] // a small count
        let opacity = if k + 1 == count { 1.0 } else { 0.12 + 0.25 * k as f64 / count as f64 };
        lines.extend(bodies(row).into_iter().map(|points| Line { points, style: Style::Body(opacity) }));
        lines.push(Line { points: joints(row), style: Style::Joint(opacity) });
    }
    lines
}

fn ground(points: &[[f64; 2]]) -> Line {
    Line { points: points.to_vec(), style: Style::Ground }
}

/// All pictures, by the names of their files.
pub(crate) fn all() -> Result<Vec<(&'static str, Picture)>, StepError> {
    Ok(vec![
        ("rod-pendulum", rod_pendulum()?),
        ("double-rod-pendulum", double_rod_pendulum()?),
        ("rod-chain", rod_chain()?),
        ("four-bar", four_bar()?),
        ("slider-crank", slider_crank()?),
        ("andrews-squeezer", andrews_squeezer()?),
        ("heavy-top", heavy_top()?),
        ("chaplygin-sleigh", chaplygin_sleigh()?),
        ("rolling-disk", rolling_disk()?),
        ("rolling-ball", rolling_ball()?),
    ])
}

fn rod_pendulum() -> Result<Picture, StepError> {
    let system = RodPendulum::default();
    let rows = motion(system, system.start(), 0.01, 4.0)?;
    let mut lines = vec![ground(&[[-0.3, 0.0], [0.3, 0.0]]), path(&rows, |row| row.q)];
    lines.extend(instants(&rows, (7, 0.25), |row| vec![vec![[0.0, 0.0], row.q]], |row| vec![row.q]));
    let charts = vec![
        Chart { curves: vec![curve(&rows, "x", |row| row.q[0])] },
        Chart { curves: vec![curve(&rows, "tension of the rod", |row| -2.0 * row.reaction[0] * system.l)] },
    ];
    Ok(Picture { title: "rod-pendulum: the rod is a constraint", lines, charts })
}

fn double_rod_pendulum() -> Result<Picture, StepError> {
    let system = DoubleRodPendulum::default();
    let rows = motion(system, system.start(), 0.01, 8.0)?;
    let ends = |row: &Row<4>| [[row.q[0], row.q[1]], [row.q[2], row.q[3]]];
    let mut lines = vec![ground(&[[-0.3, 0.0], [0.3, 0.0]]), path(&rows, |row| ends(row)[1])];
    let bodies = |row: &Row<4>| vec![vec![[0.0, 0.0], ends(row)[0], ends(row)[1]]];
    lines.extend(instants(&rows, (6, 0.12), bodies, |row| ends(row).to_vec()));
    let charts = vec![
        Chart { curves: vec![curve(&rows, "y1", |row| row.q[1]), curve(&rows, "y2", |row| row.q[3])] },
        Chart {
            curves: vec![
                curve(&rows, "tension above", |row| -2.0 * row.reaction[0] * system.l1),
                curve(&rows, "below", |row| -2.0 * row.reaction[1] * system.l2),
            ],
        },
    ];
    Ok(Picture { title: "double-rod-pendulum: two rods", lines, charts })
}

fn rod_chain() -> Result<Picture, StepError> {
    let system = RodChain::default();
    let rows = motion(system, system.start(), 0.005, 6.0)?;
    let joints = |row: &Row<20>| row.q.chunks_exact(2).map(|r| [r[0], r[1]]).collect::<Vec<_>>();
    let mut lines = vec![ground(&[[-1.5, 0.0], [1.5, 0.0]]), path(&rows, |row| [row.q[18], row.q[19]])];
    let chain = |row: &Row<20>| vec![[[0.0, 0.0]].into_iter().chain(joints(row)).collect()];
    lines.extend(instants(&rows, (6, 1.0), chain, joints));
    let start = rows[0].energy;
    let charts = vec![
        Chart { curves: vec![curve(&rows, "height of the end", |row| row.q[19])] },
        Chart { curves: vec![curve(&rows, "energy error in 1e−12", |row| (row.energy - start) * 1e12)] },
    ];
    Ok(Picture { title: "rod-chain: ten rods", lines, charts })
}

fn four_bar() -> Result<Picture, StepError> {
    let system = FourBar::default();
    let rows = motion(system, system.start(), 0.01, 5.0)?;
    let joints = |row: &Row<4>| vec![[row.q[0], row.q[1]], [row.q[2], row.q[3]]];
    let middle = |row: &Row<4>| [f64::midpoint(row.q[0], row.q[2]), f64::midpoint(row.q[1], row.q[3])];
    let mut lines = vec![ground(&[[-0.2, 0.0], [system.d + 0.2, 0.0]]), path(&rows, middle)];
    let bars = |row: &Row<4>| {
        let joints = joints(row);
        vec![vec![[0.0, 0.0], joints[0], joints[1], [system.d, 0.0]]]
    };
    lines.extend(instants(&rows, (5, 0.18), bars, joints));
    let rate = |row: &Row<4>| row.q[0] * row.v[1] - row.q[1] * row.v[0];
    let charts = vec![
        Chart { curves: vec![curve(&rows, "x1", |row| row.q[0]), curve(&rows, "x2", |row| row.q[2])] },
        Chart { curves: vec![curve(&rows, "rate of the crank", rate)] },
    ];
    Ok(Picture { title: "four-bar: a closed loop; the path of the middle of the coupler", lines, charts })
}

fn slider_crank() -> Result<Picture, StepError> {
    let system = SliderCrank::default();
    let rows = motion(system, system.start(), 0.01, 6.0)?;
    let pin = |row: &Row<3>| [system.r * row.q[0].cos(), system.r * row.q[0].sin()];
    let circle = (0..=64).map(|k| (f64::from(k) * std::f64::consts::TAU / 64.0).sin_cos());
    let circle: Vec<[f64; 2]> = circle.map(|(sin, cos)| [system.r * cos, system.r * sin]).collect();
    let middle = |row: &Row<3>| [f64::midpoint(pin(row)[0], row.q[2]), pin(row)[1] / 2.0];
    let mut lines = vec![ground(&circle), ground(&[[1.2, -0.25], [3.9, -0.25]]), path(&rows, middle)];
    let bodies = |row: &Row<3>| {
        let x = row.q[2];
        let slider = vec![[x - 0.3, -0.2], [x + 0.3, -0.2], [x + 0.3, 0.2], [x - 0.3, 0.2], [x - 0.3, -0.2]];
        vec![vec![[0.0, 0.0], pin(row), [x, 0.0]], slider]
    };
    lines.extend(instants(&rows, (4, 0.09), bodies, |row| vec![[0.0, 0.0], pin(row), [row.q[2], 0.0]]));
    let charts = vec![
        Chart { curves: vec![curve(&rows, "x", |row| row.q[2])] },
        Chart { curves: vec![curve(&rows, "rate of the crank", |row| row.v[0])] },
    ];
    Ok(Picture { title: "slider-crank: the path of the middle of the rod", lines, charts })
}

fn andrews_squeezer() -> Result<Picture, StepError> {
    let system = AndrewsSqueezer::default();
    let rows = motion(system, system.start(), 5e-5, 0.03)?;
    let AndrewsSqueezer { rr, d, sc, sd, zt, u, xa, ya, xb, yb, xc, yc, .. } = system;
    let crank = |row: &Row<7>| [rr * row.q[0].cos(), rr * row.q[0].sin()];
    let tip = |row: &Row<7>| {
        let (sin, cos) = (row.q[0] + row.q[1]).sin_cos();
        [crank(row)[0] - d * cos, crank(row)[1] - d * sin]
    };
    let bodies = |row: &Row<7>| {
        let [_, _, gamma, _, delta, _, epsilon] = row.q;
        let tip = tip(row);
        let hook = [xb + sd * gamma.cos() + sc * gamma.sin(), yb + sd * gamma.sin() - sc * gamma.cos()];
        let lower = [xa + zt * delta.cos(), ya + zt * delta.sin()];
        let upper = [xa + u * epsilon.sin(), ya - u * epsilon.cos()];
        vec![
            vec![[0.0, 0.0], crank(row), tip],
            vec![tip, [xb, yb], hook, tip],
            vec![[xa, ya], lower, tip],
            vec![[xa, ya], upper, tip],
            vec![hook, [xc, yc]],
        ]
    };
    let fixed = |_: &Row<7>| vec![[0.0, 0.0], [xa, ya], [xb, yb], [xc, yc]];
    let mut lines = vec![path(&rows, tip)];
    lines.extend(instants(&rows, (3, 0.18), bodies, fixed));
    let charts = vec![
        Chart {
            curves: vec![
                curve(&rows, "γ", |row| row.q[2]),
                curve(&rows, "φ", |row| row.q[3]),
                curve(&rows, "δ", |row| row.q[4]),
                curve(&rows, "ε", |row| row.q[6]),
            ],
        },
        Chart { curves: vec![curve(&rows, "angle of the crank β", |row| row.q[0])] },
    ];
    Ok(Picture { title: "andrews-squeezer: seven bodies, three loops", lines, charts })
}

/// The image of a body vector in space.
fn turned([a, b, c, d]: [f64; 4], [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [u, v, w] = [c * z - d * y + a * x, d * x - b * z + a * y, b * y - c * x + a * z];
    [x + 2.0 * (c * w - d * v), y + 2.0 * (d * u - b * w), z + 2.0 * (b * v - c * u)]
}

/// A point in space as seen from above at an angle: the horizontal axis x, the height z, and a part of the depth y.
fn seen([x, y, z]: [f64; 3]) -> [f64; 2] {
    [x + 0.35 * y, z + 0.25 * y]
}

/// A circle in space about a centre, through two orthogonal vectors.
fn circle(centre: [f64; 3], [one, two]: [[f64; 3]; 2]) -> Vec<[f64; 2]> {
    let angles = (0..=48).map(|k| (f64::from(k) * std::f64::consts::TAU / 48.0).sin_cos());
    angles.map(|(sin, cos)| seen([0, 1, 2].map(|i| centre[i] + one[i] * cos + two[i] * sin))).collect()
}

fn heavy_top() -> Result<Picture, StepError> {
    let system = HeavyTop::default();
    let rows = motion(system, system.start(), 0.0025, 2.0)?;
    let along = |row: &Row<4>, part: f64| turned(row.q, [0.0, 0.0, part]);
    let bodies = |row: &Row<4>| {
        let rim = [[0.22, 0.0, 0.0], [0.0, 0.22, 0.0]].map(|of| turned(row.q, of));
        let spoke = turned(row.q, [0.22, 0.0, 0.6]);
        vec![
            vec![[0.0, 0.0], seen(along(row, 1.0))],
            circle(along(row, 0.6), rim),
            vec![seen(along(row, 0.6)), seen(spoke)],
        ]
    };
    let mut lines = vec![ground(&[[-0.6, 0.0], [0.6, 0.0]]), path(&rows, |row| seen(along(row, 1.0)))];
    lines.extend(instants(&rows, (3, 0.2), bodies, |_| vec![[0.0, 0.0]]));
    let charts = vec![
        Chart { curves: vec![curve(&rows, "inclination of the axis", |row| along(row, 1.0)[2].acos())] },
        Chart {
            curves: vec![
                curve(&rows, "x of the axis", |row| along(row, 1.0)[0]),
                curve(&rows, "y", |row| along(row, 1.0)[1]),
            ],
        },
    ];
    Ok(Picture { title: "heavy-top: cusps of a top that is released", lines, charts })
}

fn chaplygin_sleigh() -> Result<Picture, StepError> {
    let system = ChaplyginSleigh::default();
    let rows = motion(system, system.start(), 0.01, 6.0)?;
    let bodies = |row: &Row<3>| {
        let [x, y, heading] = row.q;
        let (sin, cos) = heading.sin_cos();
        let at = |along: f64, across: f64| [x + along * cos - across * sin, y + along * sin + across * cos];
        vec![
            vec![at(-0.3, 0.0), at(0.3, 0.0)],
            vec![at(0.1, -0.45), at(1.2, -0.3), at(1.2, 0.3), at(0.1, 0.45), at(0.1, -0.45)],
        ]
    };
    let mut lines = vec![path(&rows, |row| [row.q[0], row.q[1]])];
    let mass = |row: &Row<3>| vec![[row.q[0] + system.a * row.q[2].cos(), row.q[1] + system.a * row.q[2].sin()]];
    lines.extend(instants(&rows, (7, 1.0), bodies, mass));
    let charts = vec![Chart {
        curves: vec![
            curve(&rows, "speed", |row| row.v[0] * row.q[2].cos() + row.v[1] * row.q[2].sin()),
            curve(&rows, "rate of turn", |row| row.v[2]),
        ],
    }];
    Ok(Picture { title: "chaplygin-sleigh: the path of the blade", lines, charts })
}

fn rolling_disk() -> Result<Picture, StepError> {
    let system = RollingDisk::default();
    let rows = motion(system, system.start(), 0.01, 6.0)?;
    let rim = |row: &Row<5>| {
        let [x, y, heading, tilt, _] = row.q;
        let up = [-tilt.cos() * heading.sin(), tilt.cos() * heading.cos(), tilt.sin()];
        let centre = [x + system.r * up[0], y + system.r * up[1], system.r * up[2]];
        let along = [heading.cos(), heading.sin(), 0.0].map(|of| of * system.r);
        vec![circle(centre, [along, up.map(|of| of * system.r)])]
    };
    let contact = |row: &Row<5>| seen([row.q[0], row.q[1], 0.0]);
    let mut lines = vec![path(&rows, contact)];
    lines.extend(instants(&rows, (7, 1.0), rim, |row| vec![contact(row)]));
    let charts = vec![
        Chart { curves: vec![curve(&rows, "inclination θ", |row| row.q[3])] },
        Chart {
            curves: vec![
                curve(&rows, "rolling rate ψ'", |row| row.v[4]),
                curve(&rows, "turning rate φ'", |row| row.v[2]),
            ],
        },
    ];
    Ok(Picture { title: "rolling-disk: the path of the point of contact", lines, charts })
}

fn rolling_ball() -> Result<Picture, StepError> {
    let system = RollingBall::default();
    let rows = motion(system, system.start(), 0.02, 12.0)?;
    let centre = |row: &Row<6>| [row.q[0], row.q[1], system.r];
    let bodies = |row: &Row<6>| {
        let [_, _, a, b, c, d] = row.q;
        let axes = [[system.r, 0.0, 0.0], [0.0, system.r, 0.0]].map(|of| turned([a, b, c, d], of));
        let outline = [[system.r, 0.0, 0.0], [0.0, 0.0, system.r]];
        vec![circle(centre(row), outline), circle(centre(row), axes)]
    };
    let table = circle([0.2, 0.0, 0.0], [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
    let mut lines = vec![ground(&table), path(&rows, |row| seen([row.q[0], row.q[1], 0.0]))];
    lines.extend(instants(&rows, (4, 0.65), bodies, |row| vec![seen([row.q[0], row.q[1], 0.0])]));
    let charts = vec![
        Chart { curves: vec![curve(&rows, "x", |row| row.q[0]), curve(&rows, "y", |row| row.q[1])] },
        Chart { curves: vec![curve(&rows, "energy: the table does work", |row| row.energy)] },
    ];
    Ok(Picture { title: "rolling-ball: a circle of period 7π/Ω on the turntable", lines, charts })
}
