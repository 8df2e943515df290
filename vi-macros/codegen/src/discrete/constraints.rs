//! The functions of the constraints.
//!
//! In: the constraints of a model, r = 1 … k, and multipliers λ. Out:
//!
//! ```text
//! g          A = g_q, a = g_t         holonomic
//! 0          A, a                     nonholonomic: the constraint is A v + a
//! ∂(A v + a)/∂q        ∂(A v + a)/∂t        Σ_r λ_r ∂A_r/∂q
//! ```

use crate::limits::bounded;
use crate::model::Model;
use crate::model::constraint::Rate;
use crate::model::slope;
use crate::symbol::{Symbol, Variable};
use vi_expr::{Expr, Pool, TooLarge};

/// Functions of the constraints; one entry or row for each constraint.
pub struct Constraints {
    /// g; zero for a nonholonomic constraint.
    pub values: Vec<Expr>,
    /// A.
    pub gradients: Vec<Vec<Expr>>,
    /// a.
    pub rates: Vec<Expr>,
    /// ∂(A v + a)/∂q.
    pub rates_dq: Vec<Vec<Expr>>,
    /// ∂(A v + a)/∂t.
    pub rates_dt: Vec<Expr>,
    /// Σ_r λ_r ∂A_r/∂q: one row for each column of A.
    pub reaction_dq: Vec<Vec<Expr>>,
}

/// Derives the functions of the constraints; `None` for a system without them.
pub(super) fn constraints(pool: &mut Pool<Symbol>, model: &Model) -> Result<Option<Constraints>, TooLarge> {
    let dimension = model.dimension();
    if model.constraints.is_empty() {
        return Ok(None);
    }
    let (count, zero) = (model.constraints.len(), pool.zero());
    let mut found = Constraints {
        values: Vec::with_capacity(count),
        gradients: Vec::with_capacity(count),
        rates: Vec::with_capacity(count),
        rates_dq: Vec::with_capacity(count),
        rates_dt: Vec::with_capacity(count),
        reaction_dq: Vec::with_capacity(dimension),
    };
    let mut reaction: Vec<Vec<Vec<Expr>>> = vec![vec![Vec::new(); dimension]; dimension];
    for (index, constraint) in model.constraints.iter().enumerate() {
        bounded(pool)?;
        let Rate { row, rest } = constraint.rate(pool, dimension);
        let multiplier = pool.symbol(Symbol::Multiplier(index));
        let mut terms = vec![rest];
        let nonzero: Vec<usize> = (0..dimension).filter(|place| !pool.is_zero(row[*place])).collect();
        for place in &nonzero {
            let velocity = pool.symbol(Symbol::Continuous(Variable::Velocity(*place)));
            terms.push(pool.mul(row[*place], velocity));
            // Skips derivatives that are known to be zero. In a long chain, most are.
            for symbol in pool.symbols(row[*place]) {
                let Symbol::Continuous(by @ Variable::Coordinate(column)) = symbol else { continue };
                let derivative = slope(pool, row[*place], by);
                let term = pool.mul(multiplier, derivative);
                reaction[*place][column].push(term);
            }
        }
        let rate = pool.sum(&terms);
        let mut rate_dq = vec![zero; dimension];
        for symbol in pool.symbols(rate) {
            if let Symbol::Continuous(by @ Variable::Coordinate(column)) = symbol {
                rate_dq[column] = slope(pool, rate, by);
            }
        }
        found.values.push(if constraint.is_holonomic { constraint.value } else { zero });
        found.gradients.push(row);
        found.rates.push(rest);
        found.rates_dq.push(rate_dq);
        found.rates_dt.push(slope(pool, rate, Variable::Time));
    }
    for row in reaction {
        bounded(pool)?;
        found.reaction_dq.push(row.iter().map(|terms| pool.sum(terms)).collect());
    }
    Ok(Some(found))
}

impl Constraints {
    /// The first constraint with a derivative that has no value in any state.
    pub(super) fn undefined(&self, pool: &Pool<Symbol>) -> Option<usize> {
        let of = |index: &usize| {
            let rows = [&self.gradients[*index], &self.rates_dq[*index]].into_iter().flatten();
            rows.chain([&self.rates[*index], &self.rates_dt[*index]]).any(|expr| pool.is_undefined(*expr))
        };
        (0..self.values.len()).find(of)
    }
}
