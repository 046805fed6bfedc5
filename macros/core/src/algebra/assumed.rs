//! Random points at which the assumptions of a model hold: the parameters are chosen at random, then each assumed
//! equation is solved for a letter. Takes equations between parameters; gives points in exact arithmetic, or none
//! if the equations cannot be solved there.

use super::exact::{ATTEMPTS, Matrix, POINTS, Point, add, inverse, mix, mul, negate, root};
use crate::expr::shape::Structure;
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr, Letter};
use crate::work;

/// The largest number of coordinates of a letter for which an equation is solved.
const LARGEST: usize = 64;

/// The largest number of equations that are taken into account.
pub(crate) const MOST: usize = 24;

/// The point of an attempt, at which every equation `e = 0` holds. `None` if this attempt finds no such point. Each
/// attempt may solve an equation for another letter, so that an equation with several branches, such as `(a - b)*(a -
/// c) = 0`, is satisfied on each of them.
pub(crate) fn point<'a>(
    symbols: &'a Symbols,
    attempt: u64,
    equations: &[Expr],
) -> Option<Point<'a>> {
    start(Point::new(symbols, attempt), attempt, equations)
}

/// Like [`point`], with the given size for every named dimension.
pub(crate) fn point_of_size<'a>(
    symbols: &'a Symbols,
    attempt: u64,
    equations: &[Expr],
    size: usize,
) -> Option<Point<'a>> {
    let point = Point::new(symbols, attempt).sized(size);
    start(point, attempt, equations)
}

fn start<'a>(mut point: Point<'a>, attempt: u64, equations: &[Expr]) -> Option<Point<'a>> {
    let mut free: Vec<(Letter, Vec<Matrix>)> = Vec::new();
    let mut order: Vec<&Expr> = equations.iter().collect();
    // Equations with a single letter come first: equations between letters then take it as given. Among those, the ones
    // that look linear come first: they leave more of the letter free.
    order.sort_by_key(|e| (expr::letters(e).len(), occurrences(e)));
    for e in order {
        satisfy(&mut point, &mut free, e, attempt)?;
    }
    Some(point)
}

/// Whether a point that satisfies the assumptions can be found. Without one, the assumptions prove nothing.
pub(crate) fn reachable(symbols: &Symbols, equations: &[Expr]) -> bool {
    // Half of all numbers have a root, so with two quadratic equations one attempt in four succeeds.
    (0..ATTEMPTS / 4).any(|attempt| point(symbols, attempt, equations).is_some())
}

/// Whether the expression vanishes wherever the equations hold, tested at exact random points. `false` if no such
/// point is found.
pub(crate) fn vanishes(symbols: &Symbols, equations: &[Expr], e: &Expr) -> bool {
    let points = (0..ATTEMPTS).filter_map(|attempt| point(symbols, attempt, equations)?.value(e));
    let mut found = 0;
    for value in points.take(POINTS as usize) {
        if !value.vanishes() {
            return false;
        }
        found += 1;
    }
    found == POINTS
}

fn occurrences(e: &Expr) -> usize {
    match e.node() {
        expr::Node::Letter(_) => 1,
        _ => e.children().into_iter().map(occurrences).sum(),
    }
}

fn satisfy(
    point: &mut Point,
    free: &mut Vec<(Letter, Vec<Matrix>)>,
    e: &Expr,
    attempt: u64,
) -> Option<()> {
    if point.value(e)?.vanishes() {
        return Some(());
    }
    let letters = expr::letters(e);
    let turn = attempt as usize / 2;
    for k in 0..letters.len() {
        let l = letters[(k + turn) % letters.len()];
        let directions = match free.iter().find(|(x, _)| *x == l) {
            Some((_, d)) => d.clone(),
            None => directions(point, l)?,
        };
        let Some(left) = solve(point, e, l, &directions) else {
            continue;
        };
        free.retain(|(x, _)| !letters.contains(x));
        // The other letters of the equation must keep their values from now on.
        free.extend(letters.iter().map(|x| (*x, Vec::new())));
        free.retain(|(x, _)| *x != l);
        free.push((l, left));
        return Some(());
    }
    None
}

/// Directions in which a letter may change without losing its structure.
fn directions(point: &Point, l: Letter) -> Option<Vec<Matrix>> {
    let value = point.letter(l)?;
    let (rows, cols) = (value.rows, value.cols);
    let entries = |f: &dyn Fn(usize, usize) -> bool, mirror: Option<u64>| {
        let mut out = Vec::new();
        for i in 0..rows {
            for j in (0..cols).filter(|j| f(i, *j)) {
                let mut m = Matrix::zeros(rows, cols);
                m.data[i * cols + j] = 1;
                if let Some(sign) = mirror.filter(|_| i != j) {
                    m.data[j * cols + i] = sign;
                }
                out.push(m);
            }
        }
        out
    };
    match point.symbols().get(l.symbol).structure {
        Structure::General | Structure::Invertible => Some(entries(&|_, _| true, None)),
        Structure::Symmetric => Some(entries(&|i, j| i <= j, Some(1))),
        Structure::Skew => Some(entries(&|i, j| i < j, Some(negate(1)))),
        Structure::Diagonal => Some(entries(&|i, j| i == j, None)),
        Structure::Orthogonal | Structure::UnitQuaternion | Structure::RigidMotion => None,
    }
}

fn moved(base: &Matrix, directions: &[Matrix], by: &[u64]) -> Matrix {
    let pairs = directions.iter().zip(by);
    pairs.fold(base.clone(), |m, (d, t)| m.plus(&d.clone().scaled(*t)))
}

/// Changes the letter so that the equation holds; gives the directions that remain free.
fn solve(point: &mut Point, e: &Expr, l: Letter, directions: &[Matrix]) -> Option<Vec<Matrix>> {
    let base = point.letter(l)?;
    let at = |point: &Point, t: &[u64]| {
        let mut p = point.clone();
        p.set(l, moved(&base, directions, t));
        p.value(e)
    };
    let n = directions.len();
    if n > LARGEST {
        return None;
    }
    let unit = |i: usize, x: u64| {
        (0..n)
            .map(|j| if i == j { x } else { 0 })
            .collect::<Vec<_>>()
    };
    let here = at(point, &unit(n, 0))?;
    let minus = here.clone().scaled(negate(1));
    let columns: Vec<Matrix> = (0..n)
        .map(|i| Some(at(point, &unit(i, 1))?.plus(&minus)))
        .collect::<Option<_>>()?;
    let t: Vec<u64> = (0..n)
        .map(|i| mix(point.seed ^ mix(900 + i as u64)))
        .collect();
    let predicted = moved(&here, &columns, &t);
    if at(point, &t)? == predicted {
        let (particular, null) = affine(&columns, &minus)?;
        point.set(l, moved(&base, directions, &particular));
        let left = null
            .iter()
            .map(|v| moved(&base.clone().scaled(0), directions, v));
        return Some(left.collect());
    }
    if here.data.len() != 1 {
        return None;
    }
    // One scalar equation, quadratic along a line: e(s) = a s² + b s + c.
    let along = |s: u64| -> Option<u64> {
        let by: Vec<u64> = t.iter().map(|x| mul(*x, s)).collect();
        Some(at(point, &by)?.at(0, 0))
    };
    let (c, one, two, three) = (here.at(0, 0), along(1)?, along(2)?, along(3)?);
    let half = inverse(2)?;
    let difference = |x: u64, y: u64| add(x, negate(y));
    let a = mul(half, add(difference(two, add(one, one)), c));
    let b = difference(difference(one, c), a);
    if three != add(add(mul(9, a), mul(3, b)), c) || a == 0 {
        return None;
    }
    let discriminant = difference(mul(b, b), mul(4, mul(a, c)));
    let s = mul(difference(root(discriminant)?, b), inverse(add(a, a))?);
    let by: Vec<u64> = t.iter().map(|x| mul(*x, s)).collect();
    point.set(l, moved(&base, directions, &by));
    Some(Vec::new())
}

/// A solution of `Σ x_i columns_i = right` and a basis of the solutions for zero.
fn affine(columns: &[Matrix], right: &Matrix) -> Option<(Vec<u64>, Vec<Vec<u64>>)> {
    let (n, m) = (columns.len(), right.data.len());
    let mut rows: Vec<Vec<u64>> = (0..m)
        .map(|k| {
            let entries = columns.iter().map(|c| c.data[k]);
            entries.chain([right.data[k]]).collect()
        })
        .collect();
    let pivots = eliminate(&mut rows, n);
    // The row states 0 = 1.
    if rows.iter().skip(pivots.len()).any(|r| r[n] != 0) {
        return None;
    }
    let mut particular = vec![0; n];
    for (row, p) in rows.iter().zip(&pivots) {
        particular[*p] = row[n];
    }
    let open = (0..n).filter(|j| !pivots.contains(j));
    let null = open.map(|j| {
        let mut v = vec![0; n];
        v[j] = 1;
        for (row, p) in rows.iter().zip(&pivots) {
            v[*p] = negate(row[j]);
        }
        v
    });
    Some((particular, null.collect()))
}

/// Reduces rows to echelon form over their first `n` columns; gives the columns of the pivots.
pub(crate) fn eliminate(rows: &mut [Vec<u64>], n: usize) -> Vec<usize> {
    let mut pivots = Vec::new();
    for c in 0..n {
        let start = pivots.len();
        let Some(p) = (start..rows.len()).find(|r| rows[*r][c] != 0) else {
            continue;
        };
        rows.swap(start, p);
        let Some(d) = inverse(rows[start][c]) else {
            continue;
        };
        for x in &mut rows[start] {
            *x = mul(*x, d);
        }
        let pivot = rows[start].clone();
        for (r, row) in rows.iter_mut().enumerate() {
            let f = negate(row[c]);
            if r != start && f != 0 {
                work::take(pivot.len());
                for (x, y) in row.iter_mut().zip(&pivot) {
                    *x = add(*x, mul(f, *y));
                }
            }
        }
        pivots.push(c);
    }
    pivots
}

/// The rank of a list of rows of one length.
pub(crate) fn rank(rows: &[Vec<u64>]) -> usize {
    let n = rows.first().map_or(0, Vec::len);
    eliminate(&mut rows.to_vec(), n).len()
}

/// Linearly independent rows, each reduced by the previous ones.
#[derive(Default)]
pub(crate) struct Independent {
    /// Each row with the column of its leading one.
    rows: Vec<(usize, Vec<u64>)>,
}

impl Independent {
    /// The number of rows.
    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    /// The row minus its projection on the known rows, scaled to a leading one. None if it depends on them.
    pub(crate) fn reduced(&self, row: &[u64]) -> Option<(usize, Vec<u64>)> {
        let mut rest = row.to_vec();
        for (column, known) in &self.rows {
            let f = negate(rest[*column]);
            if f != 0 {
                for (x, y) in rest.iter_mut().zip(known) {
                    *x = add(*x, mul(f, *y));
                }
            }
        }
        let column = rest.iter().position(|x| *x != 0)?;
        let scale = inverse(rest[column])?;
        let scaled = rest.iter().map(|x| mul(*x, scale));
        Some((column, scaled.collect()))
    }

    /// Adds a row returned by [`Independent::reduced`].
    pub(crate) fn push(&mut self, row: (usize, Vec<u64>)) {
        self.rows.push(row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Shift;
    use crate::expr::shape::{Dim, Shape};
    use crate::expr::symbol::Role;

    #[test]
    fn points_satisfy_what_is_assumed() {
        let mut s = Symbols::default();
        let three = Dim::Fixed(3);
        let j = s.add(
            "J",
            Shape::square(three),
            Structure::Symmetric,
            Role::Parameter,
        );
        let n = s.add(
            "n",
            Shape::vector(three),
            Structure::General,
            Role::Parameter,
        );
        let g = s.add(
            "g",
            Shape::vector(three),
            Structure::General,
            Role::Parameter,
        );
        let [jj, nn, gg] = [j, n, g].map(|x| expr::here(&s, x));
        let hat = expr::hat(nn.clone());
        let equations = [
            expr::sub(
                expr::mul(jj.clone(), hat.clone()),
                expr::mul(hat, jj.clone()),
            ),
            expr::cross(gg, nn.clone()),
            expr::sub(expr::dot(nn.clone(), nn), expr::integer(1)),
        ];
        let points: Vec<Point> = (0..ATTEMPTS)
            .filter_map(|a| point(&s, a, &equations))
            .collect();
        // Half of the numbers have a square root.
        assert!(points.len() > 20, "{}", points.len());
        for p in &points {
            for e in &equations {
                assert!(p.value(e).is_some_and(|v| v.vanishes()));
            }
            // J remains more general than a multiple of the identity.
            let at = Letter {
                symbol: j,
                shift: Shift::HERE,
            };
            let value = p.letter(at).map(|m| m.at(0, 1));
            assert!(value.is_some_and(|x| x != 0));
        }
    }

    #[test]
    fn every_branch_is_met() {
        let mut s = Symbols::default();
        let [a, b, c] = ["a", "b", "c"].map(|x| {
            let id = s.add(x, Shape::SCALAR, Structure::General, Role::Parameter);
            (id, expr::here(&s, id))
        });
        let branch = |x: &Expr, y: &Expr| expr::sub(x.clone(), y.clone());
        let (first, second) = (branch(&a.1, &b.1), branch(&a.1, &c.1));
        let equation = expr::mul(first.clone(), second.clone());
        let points = (0..20).filter_map(|t| point(&s, t, std::slice::from_ref(&equation)));
        let zero = |p: &Point, e: &Expr| p.value(e).is_some_and(|v| v.vanishes());
        let met: Vec<(bool, bool)> = points
            .map(|p| (zero(&p, &first), zero(&p, &second)))
            .collect();
        assert!(met.contains(&(true, false)) && met.contains(&(false, true)));
    }
}
