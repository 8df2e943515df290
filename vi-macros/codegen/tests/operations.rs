//! How many operations the generated functions have, over two families: the numbers are pinned, so that a change of any
//! stage shows here. The chain grows with its length, the pendulum with the square of its links or a little more.

mod families;

use families::{LENGTHS, LINKS};
use vi_codegen::program::Program;
use vi_codegen::{discrete, model, program, syntax};

fn lowered(text: &str) -> Program {
    let tokens = text.parse().expect("tokens");
    let mut model = syntax::parse::system(tokens).and_then(model::check::model).expect("a right system");
    let system = discrete::system::system(&mut model).expect("a right rule");
    program::program(&mut model, &system).expect("a program")
}

/// Operations of the two functions that a step evaluates in every iteration, and of its end.
fn counts(program: &Program) -> [usize; 3] {
    ["momentum_equation", "extended_system", "increment"]
        .map(|name| program.function(name).expect("every function is there").operation_count())
}

#[test]
fn the_chain_grows_with_its_length() {
    let found = LENGTHS.map(|length| counts(&lowered(&families::chain(length))));
    // From eight masses on, each adds 73, 120 or 121, and 21 operations.
    let pinned = [
        [49, 111, 11],
        [124, 237, 37],
        [272, 480, 80],
        [564, 963, 164],
        [1148, 1927, 332],
        [2316, 3855, 668],
        [4652, 7711, 1340],
    ];
    assert_eq!(found, pinned);
}

#[test]
fn the_pendulum_grows_with_its_pairs() {
    let found = LINKS.map(|links| counts(&lowered(&families::pendulum(links))));
    let pinned = [
        [134, 244, 26],
        [289, 512, 54],
        [485, 838, 87],
        [731, 1240, 128],
        [1030, 1726, 177],
        [1379, 2288, 234],
        [1781, 2934, 299],
    ];
    assert_eq!(found, pinned);
}

#[test]
fn the_jacobian_of_the_chain_keeps_its_zeros() {
    for length in [1, 2, 5, 16] {
        let program = lowered(&families::chain(length));
        let equation = program.function("momentum_equation").expect("every function is there");
        // After the residual come the rows.
        let rows = &equation.results[1..];
        assert_eq!(rows.len(), length);
        for (i, row) in rows.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                let zero = equation.operations.as_constant(*entry) == Some(0.0);
                assert_eq!(zero, i.abs_diff(j) > 1, "row {i}, column {j} of {length}");
            }
        }
    }
}
