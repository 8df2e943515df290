use std::time::Instant;
use vi_expr::*;
#[test]
fn timing() {
    let mut pool = Pool::<String>::new();
    let half = Rational::new(1.into(), 2.into());
    let t = Instant::now();
    let x = pool.symbol("x".into());
    let mut e = x;
    for _ in 0..50000 {
        let s = pool.add(x, e);
        let h = pool.scale(s, &half);
        e = pool.call(Function::Sin, &[h]);
    }
    println!("build {:?} {}", t.elapsed(), pool.len());
    let t = Instant::now();
    let r = pool.reachable(&[e]);
    println!("reachable {:?} {}", t.elapsed(), r.len());
    let t = Instant::now();
    let _ = pool.derivative(e, &mut |p, _| p.one());
    println!("derivative {:?} {}", t.elapsed(), pool.len());
    let t = Instant::now();
    let _ = pool.expand(e);
    println!("expand {:?} {}", t.elapsed(), pool.len());
    let y = pool.symbol("y".into());
    let t = Instant::now();
    let _ = pool.substitute(e, &mut |_, _| Some(y));
    println!("substitute {:?} {}", t.elapsed(), pool.len());
    let t = Instant::now();
    let _ = pool.evaluate(e, &mut |_| 0.7);
    println!("evaluate {:?}", t.elapsed());
    let t = Instant::now();
    let _ = pool.render(e, &|s| s.clone());
    println!("render {:?}", t.elapsed());
}
/// Chain of n nonlinear springs under the midpoint rule; residual and Jacobian.
#[test]
fn chain() {
    for n in [8usize, 64, 200] {
        let mut pool = Pool::<String>::new();
        let t = Instant::now();
        let quarter = Rational::new(1.into(), 4.into());
        let half = Rational::new(1.into(), 2.into());
        let [h, m, k, a] = ["h", "m", "k", "a"].map(|s| pool.symbol(s.into()));
        let q: Vec<_> = (0..n).map(|i| pool.symbol(format!("q{i}"))).collect();
        let v: Vec<_> = (0..n).map(|i| pool.symbol(format!("v{i}"))).collect();
        let mut terms = vec![];
        for i in 0..n {
            let s = pool.mul(v[i], v[i]);
            let s = pool.mul(m, s);
            terms.push(pool.scale(s, &half));
            if i + 1 < n {
                let d = pool.sub(q[i + 1], q[i]);
                let d2 = pool.mul(d, d);
                let e = pool.mul(k, d2);
                let e = pool.scale(e, &-half.clone());
                terms.push(e);
                let d4 = pool.mul(d2, d2);
                let e = pool.mul(a, d4);
                let e = pool.scale(e, &-quarter.clone());
                terms.push(e);
            }
        }
        let l = pool.sum(&terms);
        println!("n {n}: build {:?} {}", t.elapsed(), pool.len());
        let t = Instant::now();
        let q0: Vec<_> = (0..n).map(|i| pool.symbol(format!("qa{i}"))).collect();
        let q1: Vec<_> = (0..n).map(|i| pool.symbol(format!("qb{i}"))).collect();
        let ld = pool.substitute(l, &mut |pool, s| {
            let (kind, i) = s.split_at(1);
            let Ok(i) = i.parse::<usize>() else { return None };
            if kind == "q" {
                let s = pool.add(q0[i], q1[i]);
                Some(pool.scale(s, &half))
            } else {
                let s = pool.sub(q1[i], q0[i]);
                Some(pool.div(s, h))
            }
        });
        let ld = pool.mul(h, ld);
        println!("substitute {:?} {}", t.elapsed(), pool.len());
        let t = Instant::now();
        let r: Vec<_> = (0..n)
            .map(|i| {
                let w = format!("qa{i}");
                pool.derivative(ld, &mut |p, s| if *s == w { p.one() } else { p.zero() })
            })
            .collect();
        println!("residual {:?} {}", t.elapsed(), pool.len());
        let t = Instant::now();
        for r in &r {
            for s in pool.symbols(*r) {
                if s.starts_with("qb") {
                    pool.derivative(*r, &mut |p, x| if *x == s { p.one() } else { p.zero() });
                }
            }
        }
        println!("jacobian {:?} {}", t.elapsed(), pool.len());
    }
}
#[test]
fn expansions() {
    for (name, n) in
        [("x+y", 1_000_000_000i64), ("sqrt", 1_000_000_000), ("xyzw", 60), ("half", 1_000_000_000), ("x+y", 50)]
    {
        let mut pool = Pool::<String>::new();
        let s: Vec<_> = ["x", "y", "z", "w"].iter().map(|s| pool.symbol((*s).into())).collect();
        let one = pool.one();
        let two = pool.integer(2);
        let half = Rational::new(1.into(), 2.into());
        let r2 = pool.power(two, &half);
        let b = match name {
            "x+y" => pool.sum(&s[..2]),
            "xyzw" => pool.sum(&s),
            "sqrt" => pool.add(one, r2),
            _ => {
                let a = pool.add(one, r2);
                pool.scale(a, &half)
            }
        };
        let e = pool.power(b, &Rational::from_integer(n.into()));
        let t = Instant::now();
        let r = pool.expand(e).is_ok();
        println!("expand {name}^{n}: {:?} {r}", t.elapsed());
    }
}
