// Values at knots and of exact formulas are exact.
#![allow(clippy::float_cmp, clippy::items_after_statements)]

#[cfg(feature = "alloc")]
mod any;
mod scipy;

use super::*;
use crate::real::{Dual, Lane, Lanes, Rounded, Series};

/// Knots at unequal distances, and values. The last value of `CLOSED` is its first one.
const KNOTS: [f64; 8] = [-1.0, 0.5, 1.0, 2.75, 3.0, 4.5, 7.0, 7.5];
const VALUES: [f64; 8] = [0.25, -1.0, 3.0, 2.5, 2.0, 2.0, -4.0, 1.5];
const CLOSED: [f64; 8] = [0.25, -1.0, 3.0, 2.5, 2.0, 2.0, -4.0, 0.25];

static CUBIC: Table<8, 4> = Table::cubic(KNOTS, VALUES);
static MONOTONE: Table<8, 4> = Table::monotone(KNOTS, VALUES);
static QUINTIC: Table<8, 6> = Table::quintic(KNOTS, VALUES);
static LINEAR: Table<8, 2> = Table::linear(KNOTS, VALUES);
static RING: Table<8, 4> = Table::cubic(KNOTS, CLOSED).periodic();
static MONOTONE_RING: Table<8, 4> = Table::monotone(KNOTS, CLOSED).periodic();
static QUINTIC_RING: Table<8, 6> = Table::quintic(KNOTS, CLOSED).periodic();
static GRID: Grid<8, 5> = Grid::cubic(KNOTS, [0.0, 1.0, 1.5, 3.0, 3.25], GRID_VALUES);

const GRID_VALUES: [[f64; 5]; 8] = [
    [0.265_625, -0.578_125, -1.984_375, -1.0, 1.40625],
    [0.796_875, 1.28125, 2.328_125, 9.78125, 11.34375],
    [0.265_625, 1.109_375, 2.515_625, 1.53125, -0.875],
    [-0.90625, -0.53125, -2.78125, 7.390_625, 4.03125],
    [-0.71875, -0.578_125, -2.921_875, 2.984_375, -4.09375],
    [0.90625, -0.0625, 1.921_875, 8.140_625, 10.234_375],
    [-0.953_125, -0.296_875, -2.921_875, 6.578_125, -8.21875],
    [-0.953_125, -0.015_625, -3.125, -5.328_125, -8.203_125],
];

/// Value and derivatives up to the sixth, by power series.
fn series<const N: usize, const C: usize>(table: &Table<N, C>, x: f64) -> [f64; 7] {
    let value = table.at(Series::variable(x));
    core::array::from_fn(|order| value.derivative(order))
}

/// The largest difference, relative to the larger of 1 and the wanted number.
fn worst<'a>(found: impl IntoIterator<Item = &'a f64>, wanted: impl IntoIterator<Item = &'a f64>) -> f64 {
    let pairs = found.into_iter().zip(wanted);
    pairs
        .fold(0.0, |worst, (found, wanted)| crate::vector::worse((found - wanted).abs() / wanted.abs().max(1.0), worst))
}

/// Values of a polynomial with the coefficients 1, −1/2, 1/3, … up to a degree.
fn polynomial_of(degree: usize, x: f64) -> f64 {
    (0..=degree).rev().fold(0.0, |sum, k| sum * x + if k % 2 == 0 { 1.0 } else { -1.0 } / number(k + 1))
}

/// Knots between −1 and 1 at distances that differ by a factor of 5.
fn knots<const N: usize>() -> [f64; N] {
    let mut knots = core::array::from_fn(|i| number(i) + 0.4 * (number(i) * 2.3).sin());
    let (from, to) = (knots[0], knots[N - 1]);
    for knot in &mut knots {
        *knot = 2.0 * (*knot - from) / (to - from) - 1.0;
    }
    knots
}

#[test]
fn polynomials_are_reproduced() {
    fn check<const N: usize, const C: usize>(build: fn([f64; N], [f64; N]) -> Table<N, C>, degree: usize) {
        let knots = knots::<N>();
        let table = build(knots, knots.map(|x| polynomial_of(degree, x)));
        for k in 0..=200 {
            let x = -1.0 + 0.01 * f64::from(k);
            // Measured: 9e-16, and 2e-15 for quintics.
            let error = (table.at(x) - polynomial_of(degree, x)).abs();
            assert!(error <= if C == 4 { 9e-15 } else { 2e-14 }, "{N} points, degree {degree}, at {x}: {error:e}");
        }
    }
    check::<2, 2>(Table::linear, 1);
    check::<9, 2>(Table::linear, 1);
    check::<2, 4>(Table::cubic, 1);
    check::<3, 4>(Table::cubic, 2);
    check::<4, 4>(Table::cubic, 3);
    check::<5, 4>(Table::cubic, 3);
    check::<41, 4>(Table::cubic, 3);
    check::<2, 4>(Table::monotone, 1);
    check::<3, 4>(Table::monotone, 1);
    check::<2, 6>(Table::quintic, 1);
    check::<3, 6>(Table::quintic, 2);
    check::<4, 6>(Table::quintic, 3);
    check::<5, 6>(Table::quintic, 4);
    check::<6, 6>(Table::quintic, 5);
    check::<7, 6>(Table::quintic, 5);
    check::<8, 6>(Table::quintic, 5);
    check::<41, 6>(Table::quintic, 5);
}

#[test]
fn products_of_cubics_are_reproduced_on_a_grid() {
    let (x, y) = (knots::<7>(), knots::<4>());
    let of = |x: f64, y: f64| polynomial_of(3, x) * polynomial_of(3, 0.5 - y);
    let grid = Grid::cubic(x, y, x.map(|x| y.map(|y| of(x, y))));
    for (i, j) in (0..=40).flat_map(|i| (0..=40).map(move |j| (i, j))) {
        let (x, y) = (-1.0 + 0.05 * f64::from(i), -1.0 + 0.05 * f64::from(j));
        // Measured: 2e-15.
        assert!((grid.at(x, y) - of(x, y)).abs() <= 1e-14, "{x}, {y}");
    }
    let plane = Grid::linear([0.0, 1.0, 4.0], [0.0, 2.0], [[0.0, 2.0], [1.0, 5.0], [4.0, 14.0]]);
    for (x, y) in [(0.5, 1.0), (3.0, 0.5), (4.0, 2.0)] {
        assert_eq!(plane.jet_2([x, y]), (x + y * (1.0 + x), [1.0 + y, 1.0 + x], [[0.0, 1.0], [1.0, 0.0]]));
    }
}

#[test]
fn knots_have_their_values_exactly() {
    let tables = |k: usize| {
        let x = KNOTS[k];
        [
            [CUBIC.at(x), MONOTONE.at(x), QUINTIC.at(x), LINEAR.at(x)],
            [RING.at(x), MONOTONE_RING.at(x), QUINTIC_RING.at(x), 0.0],
        ]
    };
    for k in 0..8 {
        let [open, [a, b, c, _]] = tables(k);
        assert_eq!((open, [a, b, c]), ([VALUES[k]; 4], [CLOSED[k]; 3]), "{k}");
        for (j, y) in [0.0, 1.0, 1.5, 3.0, 3.25].into_iter().enumerate() {
            assert_eq!(GRID.at(KNOTS[k], y), GRID_VALUES[k][j], "{k}, {j}");
        }
    }
}

/// The pieces of the left and of the right meet with as many derivatives as the kind has, and no more.
#[test]
fn pieces_join_smoothly() {
    fn check<const C: usize>(name: &str, table: &Table<8, C>, smooth: usize, ends: bool) {
        let mut kinks = 0.0_f64;
        let inner = (1..7).map(|k| (KNOTS[k].next_down(), KNOTS[k]));
        // The seam is measured within the range: from its last point to its first.
        for (before, after) in inner.chain(ends.then_some((KNOTS[7].next_down(), KNOTS[0]))) {
            let (left, right) = (series(table, before), series(table, after));
            // Measured: 2e-13, for the fourth derivatives of the quintic splines.
            let error = worst(&left[..=smooth], &right[..=smooth]);
            assert!(error <= 2e-12, "{name} at {after}: {error:e}");
            kinks = kinks.max((left[smooth + 1] - right[smooth + 1]).abs());
        }
        assert!(kinks > 1.0, "{name}: {kinks}");
    }
    check("cubic", &CUBIC, 2, false);
    check("monotone", &MONOTONE, 1, false);
    check("quintic", &QUINTIC, 4, false);
    check("linear", &LINEAR, 0, false);
    check("periodic cubic", &RING, 2, true);
    check("periodic monotone", &MONOTONE_RING, 1, true);
    check("periodic quintic", &QUINTIC_RING, 4, true);
    // The first two inner knots of the cubic and the first three pieces of the quintic are no knots.
    let fifth = |x| series(&QUINTIC, x)[5];
    assert!(worst(&[fifth(0.0), fifth(2.0)], &[fifth(0.75); 2]) <= 1e-11);
}

#[test]
fn outside_of_its_range_a_table_does_as_it_is_told() {
    let jet = |table: &Table<8, 4>, x: f64| {
        let (value, [slope], [[second]]) = table.jet_2([x]);
        [value, slope, second]
    };
    for (x, end) in [(-3.0, -1.0), (9.5, 7.5)] {
        assert!(jet(&CUBIC, x).into_iter().all(f64::is_nan));
        let [value, slope, _] = jet(&CUBIC, end);
        assert_eq!(jet(&CUBIC.hold(), x), [value, 0.0, 0.0]);
        let line = [value + slope * (x - end), slope, 0.0];
        assert!(worst(&jet(&CUBIC.extend(), x), &line) <= 1e-15, "{x}");
        assert_eq!(CUBIC.undefined("drag(v)", [x]).map(|is| (is.argument, is.range)), Some((x, Some([-1.0, 7.5]))));
        assert!(CUBIC.hold().undefined("drag(v)", [x]).is_none() && RING.undefined("drag(v)", [x]).is_none());
    }
    assert!([-1.0, 3.0, 7.5, f64::NAN].into_iter().all(|x| CUBIC.undefined("drag(v)", [x]).is_none()));
    for table in [CUBIC, CUBIC.hold(), CUBIC.extend(), RING, MONOTONE] {
        assert!(table.at(f64::NAN).is_nan());
    }
    // Along each axis of a grid.
    let (edge, [_, slope]) = GRID.jet_1([2.0, 3.25]);
    assert_eq!(GRID.hold().jet_1([2.0, 9.0]).0, edge);
    assert!((GRID.extend().at(2.0, 4.25) - (edge + slope)).abs() <= 1e-13);
    let mixed = GRID.outside([Outside::Hold, Outside::Undefined]);
    assert!(
        mixed.at(9.0, 2.0) == GRID.at(7.5, 2.0) && mixed.at(2.0, 9.0_f64).is_nan() && GRID.at(9.0, 2.0_f64).is_nan()
    );
    assert_eq!(
        mixed.undefined("lift(a, m)", [9.0, 5.0]).map(|is| (is.argument, is.range)),
        Some((5.0, Some([0.0, 3.25])))
    );
    assert!(Table::cubic([0.0, 2.0, 1.0], [1.0; 3]).at(0.5_f64).is_nan());
}

#[test]
fn whole_periods_cost_no_digits() {
    const PERIOD: f64 = 0.1 + 0.2;
    let table = Table::cubic([0.0, 0.1, 0.15, PERIOD], [1.0, 3.0, -2.0, 1.0]).periodic();
    for turns in [-67e6, -1e6, -3.0, 5.0, 1e3, 1e6, 67e6] {
        for k in 0..100 {
            let x = PERIOD * (turns + 0.01 * f64::from(k));
            // The remainder is exact.
            let near = x.rem_euclid(PERIOD);
            let error = (table.at(x) - table.at(near)).abs();
            // Measured: 5e-15. A rounded product of turns and period would be off by 2e-9, with slopes of about 100.
            assert!(error <= 5e-14, "{x}: {error:e}");
        }
    }
}

/// Duals differentiate the evaluation, jets the polynomial.
#[test]
fn jets_are_the_derivatives_by_duals() {
    type Third = Dual<Dual<Dual<f64>>>;
    let third = |x: f64| Third::variable(Dual::variable(Dual::variable(x)));
    let of_dual = |number: Third| {
        [number.value.value.value, number.slope.value.value, number.slope.slope.value, number.slope.slope.slope]
    };
    for k in 0..60 {
        let x = -0.9 + 0.14 * f64::from(k);
        for table in [CUBIC, CUBIC.extend(), MONOTONE.hold(), RING] {
            let (value, [slope], [[second]], [[[last]]]) = table.jet_3([x]);
            let found = [value, slope, second, last];
            let wanted = of_dual(table.at(third(x)));
            assert!(found.iter().zip(wanted).all(|(a, b)| a.is_nan() == b.is_nan()));
            // Measured: 3e-15.
            assert!(value.is_nan() || worst(&found, &wanted) <= 3e-14, "{x}: {found:?}, {wanted:?}");
        }
    }
    let [x, y] = [2.0, 1.3];
    let (_, gradient, hessian) = GRID.jet_2([x, y]);
    let along = |a: f64, b: f64| {
        let variable = |at, slope| Dual { value: Dual { value: at, slope }, slope: Dual { value: slope, slope: 0.0 } };
        GRID.at(variable(x, a), variable(y, b))
    };
    let (by_x, by_y, by_both) = (along(1.0, 0.0), along(0.0, 1.0), along(1.0, 1.0));
    let mixed = 0.5 * (by_both.slope.slope - by_x.slope.slope - by_y.slope.slope);
    let wanted = [by_x.slope.value, by_y.slope.value, by_x.slope.slope, by_y.slope.slope, mixed];
    assert!(worst(&[gradient[0], gradient[1], hessian[0][0], hessian[1][1], hessian[0][1]], &wanted) <= 1e-13);
}

#[test]
fn every_lane_finds_its_own_piece() {
    let x = [-0.75, 3.1, 8.0, f64::NAN, 100.0];
    for table in [CUBIC, RING, MONOTONE.hold(), CUBIC.extend()] {
        let Lanes(side_by_side) = table.at(Lanes::<5, true>(x));
        for (x, found) in x.into_iter().zip(side_by_side) {
            let alone = table.at(x);
            let of_lane = [table.at(Lane::<false>::new(x)).get(), table.at(Lane::<true>::new(x)).get()];
            // Fused operations round once less. Measured: 2e-16.
            for found in [found, of_lane[0], of_lane[1]] {
                assert!(
                    (found - alone).abs() <= 1e-14 * alone.abs().max(1.0) || found.is_nan() && alone.is_nan(),
                    "{x}"
                );
            }
            // The rounding of the argument, times the slope.
            #[allow(clippy::cast_possible_truncation)]
            let short = x as f32;
            let single = f64::from(table.at(short));
            assert!((single - table.at(f64::from(short))).abs() <= 1e-3 || alone.is_nan(), "{x}: {single}, {alone}");
        }
    }
    type Varied = Dual<Lanes<2, false>>;
    let Varied { slope: Lanes(slopes), .. } = CUBIC.at(Varied::variable(Lanes([0.75, 4.0])));
    assert!(worst(&slopes, &[0.75, 4.0].map(|x| CUBIC.jet_1([x]).1[0])) <= 1e-15);
}

/// Against Horner's scheme with all errors (Higham, Accuracy and Stability, section 5.1): twice the digits.
#[test]
fn the_error_bound_holds_for_rounded_coefficients() {
    let two_product = |a: f64, b: f64| (a * b, a.mul_add(b, -(a * b)));
    let mut largest = 0.0_f64;
    for k in 0..2000 {
        let x = -0.999 + 0.00424 * f64::from(k);
        let segment = QUINTIC.axis.segment(x);
        let base = QUINTIC.axis.knots[segment.index];
        let u = x - base;
        let u_low = (x - (u + base)) + (base - ((u + base) - u));
        let (mut sum, mut low) = (0.0, 0.0);
        for c in QUINTIC.pieces[segment.index].into_iter().rev() {
            let (product, of_product) = two_product(sum, u);
            low = low * u + of_product + sum * u_low;
            let next = product + c;
            let of_c = next - product;
            low += (product - (next - of_c)) + (c - of_c);
            sum = next;
        }
        let rounded = QUINTIC.at(Rounded::exact(x));
        let error = ((rounded.to_f64() - sum) - low).abs();
        let bound = rounded.error() * 0.5 * f64::EPSILON;
        // Measured: 0.44.
        largest = largest.max(error / bound);
        assert!(error <= bound, "{x}: {error:e}, {bound:e}");
        // Half a rounding of each coefficient, as in `f32`, is in the bound too: at least that of the value.
        assert!(bound >= 0.5 * f64::EPSILON * sum.abs(), "{x}");
        assert_eq!(rounded.to_f64(), QUINTIC.at(x));
    }
    assert!(largest > 0.1, "{largest}");
}

#[test]
fn parameters_are_multiplied_by_cardinal_functions() {
    static LIFT: Uniform<6> = Uniform::cubic(-0.5, 2.0);
    let values = [0.25, -1.0, 3.0, 2.5, 2.0, -4.0];
    let fixed = Table::cubic([-0.5, 0.0, 0.5, 1.0, 1.5, 2.0], values);
    let straight = (Uniform::<6>::linear(-0.5, 2.0), Table::linear([-0.5, 0.0, 0.5, 1.0, 1.5, 2.0], values));
    let ring = Table::cubic([0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0], [0.25, -1.0, 3.0, 2.5, 2.0, -4.0, 0.25]).periodic();
    let uniform_ring = Uniform::<6>::cubic(0.0, 3.0).periodic();
    for k in -40..=90 {
        let x = 0.05 * f64::from(k);
        let compare = |found: (f64, [f64; 1], [[f64; 1]; 1]), wanted: (f64, [f64; 1], [[f64; 1]; 1])| {
            let flat = |(value, [slope], [[second]]): (f64, [f64; 1], [[f64; 1]; 1])| [value, slope, second];
            let (found, wanted) = (flat(found), flat(wanted));
            // Measured: 8e-15.
            assert!(
                worst(&found, &wanted) <= 1e-13 || found[0].is_nan() && wanted[0].is_nan(),
                "{x}: {found:?} {wanted:?}"
            );
        };
        compare(LIFT.of(&values).jet_2([x]), fixed.jet_2([x]));
        compare(LIFT.hold().of(&values).jet_2([x]), fixed.hold().jet_2([x]));
        compare(LIFT.extend().of(&values).jet_2([x]), fixed.extend().jet_2([x]));
        compare(straight.0.of(&values).jet_2([x]), straight.1.jet_2([x]));
        compare(uniform_ring.of(&values).jet_2([x]), ring.jet_2([x]));
        // The derivative by a value is the function whose values are 1 there and 0 elsewhere.
        for j in 0..6 {
            let one = core::array::from_fn(|i| if i == j { 1.0 } else { 0.0 });
            let varied = core::array::from_fn(|i| Dual { value: values[i], slope: one[i] });
            let (value, [slope]) = LIFT.of(&varied).jet_1([Dual::fixed(x)]);
            let (cardinal, [of_cardinal]) = LIFT.of(&one).jet_1([x]);
            assert!(
                cardinal.is_nan() && value.slope.is_nan()
                    || worst(&[value.slope, slope.slope], &[cardinal, of_cardinal]) <= 1e-15
            );
        }
    }
    // Independent of the construction: a cubic is its own spline.
    let cubic = Uniform::<6>::cubic(-1.0, 1.0);
    let knots: [f64; 6] = core::array::from_fn(|k| -1.0 + 0.4 * number(k));
    let found = cubic.of(&knots.map(|x| polynomial_of(3, x))).at(0.3);
    assert!((found - polynomial_of(3, 0.3)).abs() <= 1e-15);
}
