//! Tables at run time have the bits of those that are computed while compiling.

use super::{CLOSED, GRID_VALUES, KNOTS, VALUES};
use crate::function::Jets;
use crate::real::{Real, Rounded, Series};
use crate::table::{AnyTable, Grid, Interpolation, Outside, Table, Uniform};

/// Places within, at the ends of and beyond the range of all tables.
const PLACES: [f64; 9] = [-3.3, -1.0, -0.2, 0.5, 2.9, 3.0, 7.4, 7.5, 11.0];
const Y: [f64; 5] = [0.0, 1.0, 1.5, 3.0, 3.25];

/// Compares value and derivatives with those of the compiled table, in two types of numbers.
fn agrees(of: &AnyTable, compiled: &(impl Jets<f64, 1> + Jets<Rounded, 1>)) {
    let bits = |numbers: [f64; 4]| numbers.map(f64::to_bits);
    for x in PLACES {
        let (value, [slope], [[second]], [[[third]]]) = compiled.jet_3([x]);
        let found: [f64; 4] = core::array::from_fn(|order| of.derivative([order, 0], [x, 0.0], &[]));
        assert!(bits(found) == bits([value, slope, second, third]) || value.is_nan() && found[0].is_nan(), "{x}");
        let (value, [slope]) = compiled.jet_1([Rounded::exact(x)]);
        let found = [0, 1].map(|order| of.derivative([order, 0], [Rounded::exact(x), Rounded::exact(0.0)], &[]));
        assert!(found == [value, slope] || value.to_f64().is_nan() && found[0].to_f64().is_nan(), "{x}");
    }
}

#[test]
fn points_are_those_of_compiled_tables() {
    use Interpolation::{Cubic, Linear, Monotone, Quintic};
    let of = |values: &[f64], kind, outside| AnyTable::points(&KNOTS, values, kind, outside);
    agrees(&of(&VALUES, Linear, Outside::Undefined), &Table::linear(KNOTS, VALUES));
    agrees(&of(&CLOSED, Linear, Outside::Periodic), &Table::linear(KNOTS, CLOSED).periodic());
    agrees(&of(&VALUES, Cubic, Outside::Undefined), &Table::cubic(KNOTS, VALUES));
    agrees(&of(&VALUES, Cubic, Outside::Hold), &Table::cubic(KNOTS, VALUES).hold());
    agrees(&of(&CLOSED, Cubic, Outside::Periodic), &Table::cubic(KNOTS, CLOSED).periodic());
    agrees(&of(&VALUES, Monotone, Outside::Extend), &Table::monotone(KNOTS, VALUES).extend());
    agrees(&of(&CLOSED, Monotone, Outside::Periodic), &Table::monotone(KNOTS, CLOSED).periodic());
    agrees(&of(&VALUES, Quintic, Outside::Extend), &Table::quintic(KNOTS, VALUES).extend());
    agrees(&of(&CLOSED, Quintic, Outside::Periodic), &Table::quintic(KNOTS, CLOSED).periodic());
    // Few points have a polynomial of lower degree.
    agrees(
        &AnyTable::points(&[0.0, 3.0], &[1.0, 2.0], Cubic, Outside::Hold),
        &Table::cubic([0.0, 3.0], [1.0, 2.0]).hold(),
    );
    let (knots, values) = ([0.0, 1.0, 3.0], [1.0, 2.0, 0.5]);
    agrees(&AnyTable::points(&knots, &values, Cubic, Outside::Extend), &Table::cubic(knots, values).extend());
    agrees(&AnyTable::points(&knots, &values, Quintic, Outside::Extend), &Table::quintic(knots, values).extend());
    assert!(
        AnyTable::points(&[0.0, 0.0], &[1.0, 2.0], Cubic, Outside::Hold).derivative([0, 0], [0.0_f64; 2], &[]).is_nan()
    );
}

#[test]
fn grids_are_those_of_compiled_tables() {
    let of = |kind, outside| AnyTable::grid([&KNOTS, &Y], GRID_VALUES.as_flattened(), kind, outside);
    let cubic = Grid::cubic(KNOTS, Y, GRID_VALUES);
    for (table, compiled) in [
        (of(Interpolation::Cubic, Outside::Undefined), cubic),
        (of(Interpolation::Cubic, Outside::Extend), cubic.extend()),
        (of(Interpolation::Linear, Outside::Hold), Grid::linear(KNOTS, Y, GRID_VALUES).hold()),
    ] {
        for x in PLACES {
            for y in [-0.5, 0.0, 1.2, 1.5, 3.25, 4.0] {
                let (value, gradient, hessian, third) = compiled.jet_3([x, y]);
                let wanted = [value, gradient[0], gradient[1], hessian[0][1], hessian[1][1], third[0][1][1]];
                let orders = [[0, 0], [1, 0], [0, 1], [1, 1], [0, 2], [1, 2]];
                let found = orders.map(|orders| table.derivative(orders, [x, y], &[]));
                assert!(found.map(f64::to_bits) == wanted.map(f64::to_bits) || value.is_nan() && found[0].is_nan());
                assert_eq!(table.undefined("f(x, y)", [x, y]), compiled.undefined("f(x, y)", [x, y]));
            }
        }
    }
}

#[test]
fn tables_of_parameters_are_those_of_compiled_tables() {
    let values = [0.5, 1.5, -0.7, 2.0, 0.1];
    let of = |kind, outside| AnyTable::uniform([-1.0, 7.0], 5, kind, outside);
    for (table, compiled) in [
        (of(Interpolation::Cubic, Outside::Hold), Uniform::<5>::cubic(-1.0, 7.0).hold()),
        (of(Interpolation::Cubic, Outside::Periodic), Uniform::cubic(-1.0, 7.0).periodic()),
        (of(Interpolation::Linear, Outside::Extend), Uniform::linear(-1.0, 7.0).extend()),
        (of(Interpolation::Linear, Outside::Periodic), Uniform::linear(-1.0, 7.0).periodic()),
    ] {
        assert_eq!(table.parameters(), 5);
        for x in PLACES {
            let (value, [slope], [[second]]) = compiled.of(&values).jet_2([x]);
            let found = [0, 1, 2].map(|order| table.derivative([order, 0], [x, 0.0], &values));
            assert_eq!(found.map(f64::to_bits), [value, slope, second].map(f64::to_bits), "{x}");
            let in_series = values.map(Series::fixed);
            let along = table.derivative([0, 0], [Series::variable(x), Series::fixed(0.0)], &in_series);
            assert_eq!(
                along.derivative(1).to_bits(),
                compiled.of(&in_series).at(Series::variable(x)).derivative(1).to_bits()
            );
        }
    }
}
