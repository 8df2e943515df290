//! Pinned operation counts of the generated functions over two families, so that a change of any stage is visible. The
//! chain grows with its length, the pendulum slightly faster than the square of its links.

use crate::families;
use crate::families::{LENGTHS, LINKS};
use vi_codegen::program::{FunctionId, Operation, OperationId, Output, Program};
use vi_codegen::symbol::{Symbol, Variable};
use vi_codegen::syntax;
use vi_expr::Function;

fn lowered(text: &str) -> Program {
    let tokens = text.parse().expect("tokens");
    syntax::parse::system(tokens).and_then(|system| vi_codegen::derive(&system)).expect("a right system").own.program
}

/// Operations of the two functions that a step evaluates in every iteration, and of its residual function.
fn counts(program: &Program) -> [usize; 3] {
    [FunctionId::MomentumEquation, FunctionId::ExtendedSystem, FunctionId::MomentumResidual]
        .map(|id| program.function(id).expect("every function is there").operation_count())
}

#[test]
fn the_chain_grows_with_its_length() {
    let found = LENGTHS.map(|length| counts(&lowered(&families::chain(length))));
    // Each further mass adds 37, 66 and 46 operations.
    let pinned = [
        [25, 55, 33],
        [67, 131, 88],
        [140, 262, 178],
        [288, 525, 362],
        [584, 1049, 730],
        [1176, 2097, 1466],
        [2360, 4193, 2938],
    ];
    assert_eq!(found, pinned);
}

#[test]
fn a_longer_chain_has_the_same_loops() {
    let [short, long] = [16, 64].map(|length| {
        let program = lowered(&families::chain(length));
        let equation = program.function(FunctionId::MomentumEquation).expect("every function is there");
        let loops = equation.families().members;
        let inside: usize = loops.iter().map(Vec::len).sum();
        for members in &loops {
            let work = members.iter().all(|id| equation.operations.get(*id).is_work());
            assert!(work && members.len() > length / 2, "{} of {length}", members.len());
        }
        (loops.len(), inside, equation.operation_count() - inside)
    });
    // Equal numbers in and outside families: constants, and the ends.
    assert_eq!((short.0, short.2), (long.0, long.2));
    assert_eq!(long, (37, 2315, 45));
}

#[test]
fn the_pendulum_grows_with_its_pairs() {
    let found = LINKS.map(|links| counts(&lowered(&families::pendulum(links))));
    let pinned = [
        [70, 133, 73],
        [169, 306, 159],
        [291, 510, 266],
        [443, 760, 401],
        [629, 1066, 563],
        [846, 1421, 752],
        [1096, 1831, 968],
    ];
    assert_eq!(found, pinned);
}

#[test]
fn the_jacobian_of_the_chain_keeps_its_zeros() {
    for length in [1, 2, 5, 16] {
        let program = lowered(&families::chain(length));
        let equation = program.function(FunctionId::MomentumEquation).expect("every function is there");
        let rows = equation.results.matrix(Output::Jacobian);
        assert_eq!(rows.len(), length);
        for (i, row) in rows.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                let zero = equation.operations.as_constant(*entry) == Some(0.0);
                assert_eq!(zero, i.abs_diff(j) > 1, "row {i}, column {j} of {length}");
            }
        }
    }
}

/// Sines and cosines that a function calls.
fn sines(program: &Program, id: FunctionId) -> usize {
    let function = program.function(id).expect("every function is there");
    let called =
        |id: &OperationId| matches!(function.operations.get(*id), Operation::Call(Function::Sin | Function::Cos, _));
    function.needed().iter().filter(|id| called(id)).count()
}

#[test]
fn the_pendulum_takes_one_sine_and_cosine_a_link() {
    for links in LINKS {
        let program = lowered(&families::pendulum(links));
        for id in [
            FunctionId::MomentumEquation,
            FunctionId::ExtendedSystem,
            FunctionId::MomentumResidual,
            FunctionId::ExtendedResidual,
        ] {
            assert_eq!(sines(&program, id), 2 * links, "{id:?}, {links} links");
        }
    }
}

#[test]
fn sums_of_angles_take_the_signs_that_they_have() {
    let program = lowered(
        "pub struct System {
            coord a, b;
            let sines = sin(a + b) + 2 * sin(a - b) + 4 * sin(b - 2 * a) + 8 * sin(-a - b);
            L = dot(a)^2 / 2 + dot(b)^2 / 2 + sines + 16 * cos(a + b) + 32 * cos(a - b) + sin(a) + cos(b) + sin(2 * a);
            discretize midpoint;
        }",
    );
    let function = program.function(FunctionId::Lagrangian).expect("every function is there");
    let places = (0..100).map(|k| (0.07 * f64::from(k) - 3.0, (0.13 * f64::from(k)).rem_euclid(6.0) - 3.0));
    let error = places.map(|(a, b)| {
        let found = function.evaluate(&mut |symbol| match symbol {
            Symbol::Continuous(Variable::Coordinate(0)) => a,
            Symbol::Continuous(Variable::Coordinate(1)) => b,
            _ => 0.0,
        });
        let of_sums = (a + b).sin() + 2.0 * (a - b).sin() + 4.0 * (b - 2.0 * a).sin() + 8.0 * (-a - b).sin();
        let wanted = of_sums + 16.0 * (a + b).cos() + 32.0 * (a - b).cos() + a.sin() + b.cos() + (2.0 * a).sin();
        (found[0] - wanted).abs()
    });
    // Measured: 1.42e-14, for terms with a sum of up to 64.
    let error = error.fold(0.0, f64::max);
    assert!(error < 1.5e-14, "{error:e}");
    // Of a, of b, of 2a, each once.
    assert_eq!(sines(&program, FunctionId::Lagrangian), 6);
}
