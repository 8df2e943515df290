//! Runs of every ready system by every method, from random starts and with steps up to far too long ones: one that loses
//! its motion has a large estimate or ends by an error.
//!
//! The true motion is that of short Gauss steps. Runs are short: the sum of many small errors, or their growth in a
//! chaotic motion, shows in no estimate of one step.

use vi_erased::plan::{Method, PhasePoint, Plan};
use vi_report::entry::Entry;

/// Numbers between −1 and 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        #[allow(clippy::cast_precision_loss)] // 53 bits
        let unit = (self.0 >> 11) as f64 / (1_u64 << 53) as f64;
        2.0 * unit - 1.0
    }
}

/// Duration of a run, in default steps of its system.
const DURATION: u32 = 512;
/// Ratios of the steps to the default ones.
const RATIOS: [u32; 4] = [4, 16, 32, 64];
/// The relative error from which a motion is lost.
const LOST: f64 = 0.1;
/// The estimate from which a run says so.
const SAID: f64 = 1e-3;

/// Coordinates, momenta and H at a node.
struct Node {
    q: Vec<f64>,
    p: Vec<f64>,
    energy: f64,
}

/// The nodes after each of a number of steps; `None` if the run ends before.
fn nodes(entry: &Entry, plan: &Plan, steps: u32) -> Option<Vec<Node>> {
    let mut run = entry.system.begin(plan).ok()?;
    let mut nodes = vec![Node { q: run.q().to_vec(), p: run.p().to_vec(), energy: run.energy().ok()? }];
    for _ in 0..steps {
        run.advance().ok()?;
        nodes.push(Node { q: run.q().to_vec(), p: run.p().to_vec(), energy: run.energy().ok()? });
    }
    Some(nodes)
}

/// The geometric mean of Σ|p v| over nodes in steps of the length h; zero for a motion at rest.
fn usual_action(nodes: &[Node], h: f64) -> f64 {
    let action = |pair: &[Node]| {
        let moved = pair[1].q.iter().zip(&pair[0].q).map(|(after, before)| after - before);
        moved.zip(&pair[0].p).map(|(moved, p)| (moved * p / h).abs()).sum::<f64>()
    };
    let logarithms: Vec<f64> = nodes.windows(2).map(action).filter(|action| *action > 0.0).map(f64::ln).collect();
    #[allow(clippy::cast_precision_loss)] // some thousands
    let count = logarithms.len() as f64;
    if logarithms.is_empty() { 0.0 } else { (logarithms.iter().sum::<f64>() / count).exp() }
}

/// Counts over all runs.
#[derive(Debug, Default)]
struct Counts {
    runs: u32,
    lost: u32,
    ended: u32,
    /// Lost motions without a word.
    silent: Vec<String>,
    /// Large estimates of small errors.
    alarms: u32,
}

impl Counts {
    /// Runs from one start by every method with every step.
    fn check(&mut self, entry: &Entry, start: &PhasePoint) {
        let accurate = Method::Gauss;
        let plan = |method: Method, h: f64| Plan::new(method, h, start.clone());
        let truth = |parts: u32| nodes(entry, &plan(accurate, entry.h / f64::from(parts)), DURATION * parts);
        let (Some(truth), Some(check)) = (truth(2), truth(1)) else { return };
        let range = |of: &dyn Fn(&Node) -> f64| {
            let values = || truth.iter().map(of);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        let ranges: Vec<f64> = (0..start.q.len()).map(|i| range(&|node| node.q[i])).collect();
        let longest = ranges.iter().copied().fold(0.0, f64::max);
        // H has no zero of its own: a motion whose H is almost zero is measured by its usual |p v|.
        let size = truth.iter().map(|node| node.energy.abs()).fold(range(&|node| node.energy), f64::max);
        let size = size.max(usual_action(&truth, entry.h / 2.0));
        // Relative errors of q and of H at a node. A coordinate that hardly moves has no scale.
        let off = |one: &Node, other: &Node| {
            let moved = (0..start.q.len()).filter(|i| ranges[*i] > 1e-3 * longest);
            let positions = moved.map(|i| (one.q[i] - other.q[i]).abs() / ranges[i]).fold(0.0, f64::max);
            positions.max((one.energy - other.energy).abs() / size)
        };
        if check.iter().enumerate().any(|(k, node)| off(node, &truth[2 * k]) > 1e-6) {
            return;
        }
        for method in Method::ALL.into_iter().filter(|method| entry.system.has(*method)) {
            for ratio in RATIOS {
                let h = entry.h * f64::from(ratio);
                let what = || format!("{}, {method:?}, h = {h}, {start:?}", entry.name);
                let Ok(mut run) = entry.system.begin(&plan(method, h)) else {
                    self.ended += 1;
                    continue;
                };
                run.monitor();
                let end = entry.h * f64::from(DURATION);
                let mut worst: f64 = 0.0;
                let mut steps = 0;
                let ended = loop {
                    if run.t() >= end * (1.0 - 1e-12) {
                        break false;
                    }
                    if run.advance_to(end).is_err() {
                        break true;
                    }
                    steps += 1;
                    // Energy-preserving and adaptive steps have nodes of their own.
                    let is_end = run.t() >= end * (1.0 - 1e-12);
                    let has_own = method.finds_length();
                    let place = if has_own { 2 * DURATION } else { (2 * ratio * steps).min(2 * DURATION) };
                    if is_end || !has_own {
                        let energy = run.energy().unwrap_or(f64::INFINITY);
                        worst = worst
                            .max(off(&Node { q: run.q().to_vec(), p: Vec::new(), energy }, &truth[place as usize]));
                    }
                };
                self.runs += 1;
                let estimate = run.largest_error().map_or(0.0, |found| found.estimate);
                if ended {
                    self.ended += 1;
                } else if worst > LOST {
                    self.lost += 1;
                    if estimate < SAID {
                        self.silent.push(format!("{}: off by {worst:.2e}, estimate {estimate:.2e}", what()));
                    }
                } else if estimate > SAID && estimate > 10.0 * worst {
                    self.alarms += 1;
                }
            }
        }
    }
}

/// Random starts of every system.
fn counts(starts: u32, seed: u64) -> Counts {
    let (mut counts, mut random) = (Counts::default(), Random(seed));
    for entry in vi_ready::systems() {
        for k in 0..starts {
            let mut start = PhasePoint { t: 0.0, q: entry.q.clone(), v: entry.v.clone() };
            if entry.system.has_constraints() {
                // A faster or slower motion from the same place is on the constraints, too.
                let factor = if k == 0 { 1.0 } else { 1.0 + 0.7 * random.next() };
                start.v.iter_mut().for_each(|v| *v *= factor);
            } else if k > 0 {
                start.q.iter_mut().for_each(|q| *q *= 1.0 + 0.5 * random.next());
                start.v.iter_mut().for_each(|v| *v = *v * (1.0 + 0.7 * random.next()) + 0.1 * random.next());
            }
            counts.check(&entry, &start);
        }
    }
    counts.silent.iter().for_each(|what| println!("{what}"));
    let Counts { runs, lost, ended, silent, alarms } = &counts;
    println!("{runs} runs: {lost} lost, {} of them silent, {ended} ended, {alarms} false alarms", silent.len());
    counts
}

#[test]
fn no_motion_is_lost_without_a_word() {
    let counts = counts(1, 1);
    assert!(counts.silent.is_empty(), "{:?}", counts.silent);
    assert!(counts.runs > 500 && counts.lost > 20, "{counts:?}");
    assert!(f64::from(counts.alarms) < 0.05 * f64::from(counts.runs), "{counts:?}");
}

#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn no_motion_of_many_is_lost_without_a_word() {
    for seed in [1, 20_261_129] {
        let counts = counts(12, seed);
        assert!(counts.silent.is_empty(), "{:?}", counts.silent);
        assert!(counts.lost > 300, "{counts:?}");
        assert!(f64::from(counts.alarms) < 0.05 * f64::from(counts.runs), "{counts:?}");
    }
}

#[test]
fn an_escape_hides_no_lost_energy() {
    // The star leaves the galaxy to infinity in a finite time. Its positions are right to 1e-3, but an error of this part
    // of the kinetic energy is many times H.
    let entry = vi_ready::systems().into_iter().find(|entry| entry.name == "HenonHeiles").expect("a system");
    let start = |y: f64, v: [f64; 2]| PhasePoint { t: 0.0, q: vec![0.0, y], v: v.to_vec() };
    let slow = start(0.105_186_738_866_802_17, [0.831_446_071_906_629_9, 0.086_147_170_908_591_13]);
    let fast = start(0.134_088_314_820_700_6, [0.770_221_328_545_924_3, 0.043_183_866_065_059_73]);
    for (start, method, h) in [
        (&slow, Method::Splitting4, 0.32),
        (&slow, Method::Splitting6, 0.64),
        (&fast, Method::Suzuki4, 0.08),
        (&fast, Method::KahanLi6, 0.08),
        (&fast, Method::Gauss, 0.64),
        (&fast, Method::Gauss, 1.28),
    ] {
        let mut run = entry.system.begin(&Plan::new(method, h, start.clone())).expect("a start");
        run.monitor();
        let before = run.energy().expect("H");
        // H and the estimate when the motion was still near, and at the end.
        let [near, far] = [8.96, 10.24].map(|until| {
            while run.t() < until * (1.0 - 1e-12) {
                run.advance_to(until).expect("a step");
            }
            let off = ((run.energy().expect("H") - before) / before).abs();
            [off, run.largest_error().expect("measured steps").estimate]
        });
        println!("{method:?}, h = {h}: {near:?}, {far:?}");
        assert!(near.iter().all(|part| *part < SAID), "{method:?}, h = {h}: {near:?}");
        // Relative to H, or to the usual |p v|, which is larger.
        assert!(far[0] > LOST && far[1] > 0.3 * far[0] && far[1] <= far[0], "{method:?}, h = {h}: {far:?}");
    }
}

#[test]
fn a_swing_gives_the_energy_back() {
    // H of fixed steps is off in each swing, by a large part of what it is in the long rest between: it returns.
    let away = "coord x; L = dot(x)^2 / 2 + 1 - cos(x); discretize midpoint;";
    let duffing = "coord x; L = dot(x)^2 / 2 + x^2 / 2 - x^4 / 4; discretize midpoint;";
    let pair = "coord x; L = dot(x)^2 / 2 - 4 * (x^(-12) - x^(-6)); discretize midpoint;";
    for (text, [x, v], method, h, until) in [
        (away, [0.003, 0.0], Method::Fixed, 0.02, 40.0),
        (duffing, [0.01, 0.0], Method::Fixed, 0.05, 100.0),
        (duffing, [1e-5, 0.0], Method::Fixed, 0.05, 100.0),
        (duffing, [1e-5, 0.0], Method::Splitting4, 0.2, 100.0),
        (pair, [6.0, -0.1], Method::Fixed, 0.02, 90.0),
        (pair, [6.0, -0.03], Method::Fixed, 0.01, 300.0),
    ] {
        let system = vi_tape::System::parse(&format!("struct Swing {{ {text} }}")).expect("a system");
        let start = PhasePoint { t: 0.0, q: vec![x], v: vec![v] };
        let mut run = system.begin(&Plan::new(method, h, start)).expect("a start");
        run.monitor();
        let before = run.energy().expect("H");
        let mut most: f64 = 0.0;
        while run.t() < until * (1.0 - 1e-12) {
            run.advance_to(until).expect("a step");
            most = most.max((run.energy().expect("H") - before).abs());
        }
        let estimate = run.largest_error().expect("measured steps").estimate;
        println!("{text} from {x}: {estimate:e}, H off by up to {most:e} of {before:e}");
        // Measured: at most 2.6e-3.
        assert!(estimate < 1e-2, "{text} from {x}, {method:?}: {estimate:e}");
    }
}
