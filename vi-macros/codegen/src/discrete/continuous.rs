//! The continuous functions of the system.
//!
//! In: L and f. Out, with the acceleration `a` and derivatives along the motion:
//!
//! ```text
//! momentum p = L_v          energy = v·L_v − L          mass M = L_vv
//! M a = L_q + f − L_vt − L_vq v        dp/dt = L_q + f        dE/dt = −L_t + f·v
//! D = a·(L_q + f) − v·d/dt(L_q) − d/dt(L_t)             step density
//! ∂L_v/∂q        ∂(L_q + f)/∂q        ∂(L_q + f)/∂v
//! g, ∂g/∂q, ∂g/∂t                                       time scale, dt = g dτ
//! ```

use super::fields::Fields;
use crate::limits::bounded;
use crate::model::{Model, Role, slope};
use crate::symbol::{Symbol, Variable};
use vi_expr::{Expr, Node, Pool, Rational, TooLarge};

/// Expressions in time, coordinates and velocities; the step density also contains accelerations.
pub struct Continuous {
    /// L.
    pub lagrangian: Expr,
    /// v·L_v − L.
    pub energy: Expr,
    /// L_v.
    pub momentum: Vec<Expr>,
    /// f.
    pub force: Vec<Expr>,
    /// M, row by row.
    pub mass: Vec<Vec<Expr>>,
    /// Whether L_v = M v exactly.
    pub momentum_is_mass_times_velocity: bool,
    /// M a.
    pub mass_times_acceleration: Vec<Expr>,
    /// L_q + f.
    pub applied_force: Vec<Expr>,
    /// dE/dt = −L_t + f·v.
    pub power: Expr,
    /// L is quadratic in the velocities: p = M v + p(v = 0).
    pub quadratic: bool,
    /// D.
    pub step_density: Expr,
    /// g and its derivatives, if the system has a time scale.
    pub time_scale: Option<TimeScale>,
    /// Expressions checked for finite values, parts before wholes: variables, parameters, calls, roots, quotients, L,
    /// f.
    pub watched: Vec<Expr>,
    /// Calls of Rust functions and tables in L, f and the time scale, with their arguments, inner calls first.
    pub calls: Vec<(Expr, Vec<Expr>)>,
    /// Neither L, f nor a constraint depends on the time.
    pub autonomous: bool,
    /// Whether the coordinate is absent from L, has no force and no reaction, per coordinate.
    pub cyclic: Vec<bool>,
}

/// Derivatives of L_v and L_q + f with respect to q and v, row by row. ∂L_v/∂v is M.
pub struct PointDerivatives {
    /// ∂L_v/∂q.
    pub momentum_dq: Vec<Vec<Expr>>,
    /// ∂(L_q + f)/∂q.
    pub force_dq: Vec<Vec<Expr>>,
    /// ∂(L_q + f)/∂v.
    pub force_dv: Vec<Vec<Expr>>,
}

/// The time scale of the transformation dt = g(t, q) dτ.
pub struct TimeScale {
    /// g.
    pub g: Expr,
    /// ∂g/∂q.
    pub g_dq: Vec<Expr>,
    /// ∂g/∂t.
    pub g_dt: Expr,
}

impl Continuous {
    /// A function other than L and f, and the variable for which its derivative has no value in any state.
    pub(super) fn undefined(&self, pool: &Pool<Symbol>) -> Option<(Expr, Variable)> {
        let TimeScale { g, g_dq, g_dt } = self.time_scale.as_ref()?;
        let by_coordinate = g_dq.iter().enumerate().map(|(index, slope)| (Variable::Coordinate(index), *slope));
        let mut slopes = by_coordinate.chain([(Variable::Time, *g_dt)]);
        slopes.find(|(_, slope)| pool.is_undefined(*slope)).map(|(by, _)| (*g, by))
    }
}

/// Derives the continuous functions.
pub(super) fn continuous(pool: &mut Pool<Symbol>, fields: &mut Fields, model: &Model) -> Result<Continuous, TooLarge> {
    let dimension = model.dimension();
    let coordinate = Variable::Coordinate;
    let velocity = Variable::Velocity;
    let zero = pool.zero();
    let momentum: Vec<Expr> = (0..dimension).map(|i| fields.lagrangian(pool, &[velocity(i)])).collect();
    let mut mass = Vec::with_capacity(dimension);
    let mut mass_times_acceleration = Vec::with_capacity(dimension);
    let mut density = Vec::new();
    let mut applied_force = Vec::with_capacity(dimension);
    let lt = fields.lagrangian(pool, &[Variable::Time]);
    let mut power = vec![pool.neg(lt)];
    for i in 0..dimension {
        bounded(pool)?;
        // Skips second derivatives that are known to be zero. In a long chain, most are.
        let by_velocity = fields.variables(pool, velocity(i));
        let mut row = vec![zero; dimension];
        for j in (0..dimension).filter(|j| by_velocity.contains(&velocity(*j))) {
            row[j] = fields.lagrangian(pool, &[velocity(i), velocity(j)]);
        }
        mass.push(row);
        let (lq, lvt) =
            (fields.lagrangian(pool, &[coordinate(i)]), fields.lagrangian(pool, &[velocity(i), Variable::Time]));
        let applied = pool.add(lq, model.forces[i]);
        applied_force.push(applied);
        let v = moving(pool, i);
        power.push(pool.mul(model.forces[i], v));
        let mut inertial = vec![lvt];
        let mut along = vec![fields.lagrangian(pool, &[coordinate(i), Variable::Time])];
        let by_coordinate = fields.variables(pool, coordinate(i));
        for j in 0..dimension {
            let (v, a) = (moving(pool, j), pool.symbol(Symbol::Acceleration(j)));
            if by_velocity.contains(&coordinate(j)) {
                let lvq = fields.lagrangian(pool, &[velocity(i), coordinate(j)]);
                inertial.push(pool.mul(lvq, v));
            }
            if by_coordinate.contains(&coordinate(j)) {
                let lqq = fields.lagrangian(pool, &[coordinate(i), coordinate(j)]);
                along.push(pool.mul(lqq, v));
            }
            if by_coordinate.contains(&velocity(j)) {
                let lqv = fields.lagrangian(pool, &[coordinate(i), velocity(j)]);
                along.push(pool.mul(lqv, a));
            }
        }
        let (inertial, along) = (pool.sum(&inertial), pool.sum(&along));
        mass_times_acceleration.push(pool.sub(applied, inertial));
        let (v, a) = (moving(pool, i), pool.symbol(Symbol::Acceleration(i)));
        let (ltq, ltv) = (
            fields.lagrangian(pool, &[Variable::Time, coordinate(i)]),
            fields.lagrangian(pool, &[Variable::Time, velocity(i)]),
        );
        for (sign, left, right) in [(1, a, applied), (-1, v, along), (-1, v, ltq), (-1, a, ltv)] {
            let product = pool.mul(left, right);
            density.push(if sign > 0 { product } else { pool.neg(product) });
        }
    }
    let ltt = fields.lagrangian(pool, &[Variable::Time, Variable::Time]);
    density.push(pool.neg(ltt));
    let quadratic = !mass.iter().flatten().any(|entry| pool.depends_on(*entry, &is_velocity));
    let momentum_is_mass_times_velocity = is_product(pool, &momentum, &mass, quadratic)?;
    Ok(Continuous {
        lagrangian: model.lagrangian,
        energy: energy(pool, model.lagrangian, dimension),
        cyclic: cyclic(pool, model),
        watched: watched(pool, model),
        calls: calls(pool, model),
        force: model.forces.clone(),
        quadratic,
        applied_force,
        power: pool.sum(&power),
        momentum,
        mass,
        momentum_is_mass_times_velocity,
        mass_times_acceleration,
        step_density: pool.sum(&density),
        time_scale: model.time_scale.map(|g| time_scale(pool, g, dimension)),
        autonomous: is_autonomous(pool, model),
    })
}

/// Derives ∂L_v/∂q, ∂(L_q + f)/∂q and ∂(L_q + f)/∂v.
pub(super) fn point_derivatives(
    pool: &mut Pool<Symbol>,
    fields: &mut Fields,
    dimension: usize,
) -> Result<PointDerivatives, TooLarge> {
    let zero = pool.zero();
    let none = vec![vec![zero; dimension]; dimension];
    let mut found = PointDerivatives { momentum_dq: none.clone(), force_dq: none.clone(), force_dv: none };
    for i in 0..dimension {
        bounded(pool)?;
        let (own_velocity, own_coordinate) = (Variable::Velocity(i), Variable::Coordinate(i));
        let of_momentum = fields.variables(pool, own_velocity);
        let of_slope = fields.variables(pool, own_coordinate);
        for j in 0..dimension {
            let (coordinate, velocity) = (Variable::Coordinate(j), Variable::Velocity(j));
            if of_momentum.contains(&coordinate) {
                found.momentum_dq[i][j] = fields.lagrangian(pool, &[own_velocity, coordinate]);
            }
            for (matrix, by) in [(&mut found.force_dq, coordinate), (&mut found.force_dv, velocity)] {
                let of_lagrangian =
                    if of_slope.contains(&by) { fields.lagrangian(pool, &[own_coordinate, by]) } else { zero };
                let of_force = fields.force(pool, i, by);
                matrix[i][j] = pool.add(of_lagrangian, of_force);
            }
        }
    }
    Ok(found)
}

fn time_scale(pool: &mut Pool<Symbol>, g: Expr, dimension: usize) -> TimeScale {
    let g_dq = (0..dimension).map(|index| slope(pool, g, Variable::Coordinate(index))).collect();
    TimeScale { g, g_dq, g_dt: slope(pool, g, Variable::Time) }
}

fn watched(pool: &mut Pool<Symbol>, model: &Model) -> Vec<Expr> {
    let of_motion = model.expressions().filter(|(role, _)| *role != Role::TimeScale);
    let wholes: Vec<Expr> = of_motion.map(|(_, expr)| expr).collect();
    let one = Rational::from_integer(1.into());
    // Constant subexpressions may exceed the range of numbers.
    let is_part = |expr: &Expr| !pool.is_constant(*expr) || pool.as_number(*expr).is_some();
    let (parts, others): (Vec<Expr>, Vec<Expr>) =
        pool.reachable(&wholes).into_iter().filter(is_part).partition(|expr| {
            match pool.node(*expr) {
                Node::Symbol(_) | Node::Call(..) | Node::Opaque(..) => true,
                // A product of positive powers is finite if its factors are, short of overflow.
                Node::Product(product) => product.factors.iter().any(|(_, exponent)| *exponent < one),
                Node::Number(_) | Node::Pi | Node::Sum(_) | Node::Select(_) => false,
            }
        });
    let parts: Vec<Expr> = parts.into_iter().map(|part| pool.without_constants(part)).collect();
    parts.into_iter().chain(others.into_iter().filter(|expr| wholes.contains(expr) && !pool.is_zero(*expr))).collect()
}

fn calls(pool: &Pool<Symbol>, model: &Model) -> Vec<(Expr, Vec<Expr>)> {
    let wholes: Vec<Expr> = model.expressions().map(|(_, expr)| expr).collect();
    let nodes = pool.reachable(&wholes).into_iter();
    let call = |node| match pool.node(node) {
        Node::Opaque(function, arguments) => Some((node, arguments[..function.arity].to_vec())),
        _ => None,
    };
    nodes.filter_map(call).collect()
}

fn is_velocity(symbol: &Symbol) -> bool {
    matches!(symbol, Symbol::Continuous(Variable::Velocity(_)))
}

fn moving(pool: &mut Pool<Symbol>, index: usize) -> Expr {
    pool.symbol(Symbol::Continuous(Variable::Velocity(index)))
}

/// Whether `momentum = mass · v`. Without a velocity in the masses, their difference is the momentum at rest, so that
/// the product is not multiplied out.
fn is_product(
    pool: &mut Pool<Symbol>,
    momentum: &[Expr],
    mass: &[Vec<Expr>],
    is_quadratic: bool,
) -> Result<bool, TooLarge> {
    let zero = pool.zero();
    for (entry, row) in momentum.iter().zip(mass) {
        let rest = if is_quadratic {
            pool.substitute(*entry, &mut |_, symbol| is_velocity(symbol).then_some(zero))
        } else {
            let mut terms = vec![pool.neg(*entry)];
            for (index, factor) in row.iter().enumerate() {
                let v = moving(pool, index);
                terms.push(pool.mul(*factor, v));
            }
            pool.sum(&terms)
        };
        let rest = pool.expand(rest)?;
        if !pool.is_zero(rest) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The summands of an expression, in its order.
pub(crate) fn summands(pool: &mut Pool<Symbol>, expr: Expr) -> Vec<Expr> {
    let Node::Sum(sum) = pool.node(expr).clone() else { return vec![expr] };
    let mut terms: Vec<Expr> = sum.terms.iter().map(|(term, factor)| pool.scale(*term, factor)).collect();
    let constant = pool.number(sum.constant);
    terms.extend((!pool.is_zero(constant)).then_some(constant));
    terms
}

/// v·L_v − L, term by term. A term without velocities only changes its sign and keeps the form in which it was written.
pub(crate) fn energy(pool: &mut Pool<Symbol>, lagrangian: Expr, dimension: usize) -> Expr {
    let terms = summands(pool, lagrangian);
    let (moving_terms, still): (Vec<Expr>, Vec<Expr>) =
        terms.into_iter().partition(|term| pool.depends_on(*term, &is_velocity));
    let (kinetic, still) = (pool.sum(&moving_terms), pool.sum(&still));
    let mut parts = vec![pool.neg(kinetic)];
    for index in 0..dimension {
        let v = moving(pool, index);
        let momentum = slope(pool, kinetic, Variable::Velocity(index));
        parts.push(pool.mul(v, momentum));
    }
    let closed = pool.sum(&parts);
    // Expansion turns `m v² − m v²/2` into `m v²/2`. If it grows too long, the closed form is equally correct.
    let moving = pool.expand(closed).unwrap_or(closed);
    pool.sub(moving, still)
}

/// Whether neither L, f nor a constraint depends on time.
fn is_autonomous(pool: &Pool<Symbol>, model: &Model) -> bool {
    let time = |symbol: &Symbol| *symbol == Symbol::Continuous(Variable::Time);
    let mut of_motion = model.expressions().filter(|(role, _)| *role != Role::TimeScale);
    !of_motion.any(|(_, expr)| pool.depends_on(expr, &time))
}

fn cyclic(pool: &Pool<Symbol>, model: &Model) -> Vec<bool> {
    (0..model.dimension())
        .map(|index| {
            let itself = |symbol: &Symbol| *symbol == Symbol::Continuous(Variable::Coordinate(index));
            let reacts = model.constraints.iter().any(|constraint| constraint.acts_on(pool, index));
            !pool.depends_on(model.lagrangian, &itself) && pool.is_zero(model.forces[index]) && !reacts
        })
        .collect()
}
