//! Curves on which a quantity vanishes, from its values at the points of a grid.
//!
//! In: values row by row. Out: the curves of the piecewise linear interpolation, in grid coordinates (column, row), by
//! marching squares; each closed or ending at the border. Squares with a value that is not finite hold no curve.

use std::collections::BTreeMap;

/// An edge of the grid by the index of its lower or left point, and whether it is upright.
type Edge = (usize, bool);

/// The curves on which `values` vanish; `columns` values to a row.
pub(super) fn zeros(values: &[f64], columns: usize) -> Vec<Vec<(f64, f64)>> {
    let mut neighbours: BTreeMap<Edge, Vec<Edge>> = BTreeMap::new();
    for (a, b) in segments(values, columns) {
        neighbours.entry(a).or_default().push(b);
        neighbours.entry(b).or_default().push(a);
    }
    let mut curves = Vec::new();
    // Open curves first, from their ends; the others are closed.
    let ends: Vec<Edge> = neighbours.iter().filter(|(_, others)| others.len() == 1).map(|(edge, _)| *edge).collect();
    let all: Vec<Edge> = neighbours.keys().copied().collect();
    for start in ends.into_iter().chain(all) {
        let mut curve = vec![start];
        let mut current = start;
        while let Some(next) = neighbours.get_mut(&current).and_then(Vec::pop) {
            if let Some(others) = neighbours.get_mut(&next)
                && let Some(index) = others.iter().position(|edge| *edge == current)
            {
                others.swap_remove(index);
            }
            curve.push(next);
            current = next;
        }
        if curve.len() > 1 {
            curves.push(curve.into_iter().filter_map(|edge| crossing(values, columns, edge)).collect());
        }
    }
    curves
}

/// In every square, the pairs of edges that a curve joins.
fn segments(values: &[f64], columns: usize) -> Vec<(Edge, Edge)> {
    let columns = columns.max(1);
    let mut segments = Vec::new();
    for lower_left in 0..values.len().saturating_sub(columns) {
        if lower_left % columns == columns - 1 {
            continue;
        }
        let corners = [lower_left, lower_left + 1, lower_left + columns + 1, lower_left + columns];
        let found: Option<Vec<f64>> = corners.iter().map(|&index| values.get(index).copied()).collect();
        let Some(found) = found.filter(|found| found.iter().all(|value| value.is_finite())) else { continue };
        let edges = [(lower_left, false), (lower_left + 1, true), (lower_left + columns, false), (lower_left, true)];
        let signs: Vec<bool> = found.iter().map(|value| *value < 0.0).collect();
        let next = signs.iter().cycle().skip(1);
        let crossed: Vec<Edge> =
            signs.iter().zip(next).zip(edges).filter(|((a, b), _)| a != b).map(|(_, edge)| edge).collect();
        // Two crossings are one segment; at a saddle the four are joined in order around the square.
        segments.extend(crossed.chunks_exact(2).filter_map(|pair| Some((*pair.first()?, *pair.last()?))));
    }
    segments
}

/// The point of an edge at which the quantity vanishes.
fn crossing(values: &[f64], columns: usize, (index, upright): Edge) -> Option<(f64, f64)> {
    let a = *values.get(index)?;
    let b = *values.get(index + if upright { columns } else { 1 })?;
    let part = a / (a - b);
    #[allow(clippy::cast_precision_loss)] // some hundred points
    let column = (index % columns) as f64;
    #[allow(clippy::cast_precision_loss)]
    let row = (index / columns) as f64;
    Some(if upright { (column, row + part) } else { (column + part, row) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        (0..=40)
            .flat_map(|row| (0..=60).map(move |column| (f64::from(column), f64::from(row))))
            .map(|(x, y)| f(x, y))
            .collect()
    }

    #[test]
    fn a_circle_is_one_closed_curve() {
        let curves = zeros(&grid(|x, y| (x - 30.3).hypot(y - 20.1) - 12.0), 61);
        assert_eq!(curves.len(), 1);
        let curve = &curves[0];
        assert_eq!(curve.first(), curve.last());
        let worst = curve.iter().map(|(x, y)| ((x - 30.3).hypot(y - 20.1) - 12.0).abs()).fold(0.0, f64::max);
        // Measured 0.0099: the interpolation is linear.
        assert!(worst < 0.01, "{worst}");
    }

    #[test]
    fn a_line_ends_at_the_border_and_gaps_stay_open() {
        let curves = zeros(&grid(|x, y| y - 0.5 * x - 3.2), 61);
        assert_eq!(curves.len(), 1);
        // Measured 4e-15.
        assert!(curves[0].iter().all(|(x, y)| (y - 0.5 * x - 3.2).abs() < 1e-14));
        assert!((curves[0].len()) > 60, "{}", curves[0].len());
        let broken = zeros(&grid(|x, y| if x > 20.0 && x < 25.0 { f64::NAN } else { y - 3.3 }), 61);
        assert_eq!(broken.len(), 2);
        assert!(zeros(&grid(|_, _| 1.0), 61).is_empty() && zeros(&[], 61).is_empty());
    }
}
