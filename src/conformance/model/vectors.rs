//! GLSL's functions on whole vectors and matrices [GLSL 4.60, 5.4.2, 5.10, 8.5 to 8.7].

use super::number::{Num, ROUNDING, dot, sum};
use super::scalars::{converted, inversesqrt, sqrt};
use super::value::{GlslValue, Type, unknown};

/// Arguments of a function: each with its type.
pub type Arguments<'a> = &'a [(GlslValue, Type)];

pub fn dot_of(a: Arguments, _: Type) -> GlslValue {
    dot(&a[0].0, &a[1].0).into()
}

/// Squares of components must be floats of full precision.
fn length(v: &[Num]) -> Num {
    if v.iter().any(|x| x.value.abs() > 1e18) {
        return Num::UNKNOWN;
    }
    sqrt(dot(v, v))
}

pub fn length_of(a: Arguments, _: Type) -> GlslValue {
    length(&a[0].0).into()
}

fn difference(a: &[Num], b: &[Num]) -> GlslValue {
    a.iter().zip(b).map(|(a, b)| a.minus(*b)).collect()
}

pub fn distance(a: Arguments, _: Type) -> GlslValue {
    length(&difference(&a[0].0, &a[1].0)).into()
}

pub fn normalize(a: Arguments, _: Type) -> GlslValue {
    let scale = inversesqrt(dot(&a[0].0, &a[0].0));
    // A division by the length instead.
    a[0].0.iter().map(|x| x.times(scale)).map(|x| Num::off(x.value, x.error + 8.0 * ROUNDING * x.value.abs())).collect()
}

pub fn cross(a: Arguments, _: Type) -> GlslValue {
    let (a, b) = (&a[0].0, &a[1].0);
    let part = |i: usize, j: usize| sum(&[a[i].times(b[j]), a[j].times(b[i]).negative()]);
    [part(1, 2), part(2, 0), part(0, 1)].into_iter().collect()
}

pub fn reflect(a: Arguments, _: Type) -> GlslValue {
    let (incident, normal) = (&a[0].0, &a[1].0);
    let twice = dot(normal, incident).times(Num::exact(2.0));
    incident.iter().zip(normal.iter()).map(|(i, n)| sum(&[*i, twice.times(*n).negative()])).collect()
}

pub fn refract(a: Arguments, kind: Type) -> GlslValue {
    let (incident, normal, eta) = (&a[0].0, &a[1].0, a[2].0[0]);
    let along = dot(normal, incident);
    let one = Num::exact(1.0);
    let k = sum(&[one, eta.times(eta).times(sum(&[one, along.times(along).negative()])).negative()]);
    match k.below(Num::exact(0.0)) {
        Some(true) => GlslValue::filled(Num::exact(0.0), kind.rows),
        Some(false) => {
            let by = sum(&[eta.times(along), sqrt(k)]);
            incident.iter().zip(normal.iter()).map(|(i, n)| sum(&[eta.times(*i), by.times(*n).negative()])).collect()
        }
        None => unknown(kind),
    }
}

pub fn faceforward(a: Arguments, kind: Type) -> GlslValue {
    match dot(&a[2].0, &a[1].0).below(Num::exact(0.0)) {
        Some(true) => a[0].0.clone(),
        Some(false) => a[0].0.iter().map(|x| x.negative()).collect(),
        None => unknown(kind),
    }
}

fn column(m: &[Num], rows: usize, index: usize) -> &[Num] {
    &m[index * rows..(index + 1) * rows]
}

fn row(m: &[Num], rows: usize, index: usize) -> GlslValue {
    m.iter().skip(index).step_by(rows).copied().collect()
}

/// Products with a matrix on either side or on both.
pub fn product(a: Arguments, _: Type) -> GlslValue {
    let ((left, left_type), (right, right_type)) = (&a[0], &a[1]);
    if !left_type.is_matrix() {
        let columns = 0..right_type.columns;
        return columns.map(|index| dot(left, column(right, right_type.rows, index))).collect();
    }
    let rows = left_type.rows;
    let count = right_type.columns.max(1);
    let entry = |index: usize| dot(&row(left, rows, index % rows), column(right, right_type.rows, index / rows));
    (0..rows * count).map(entry).collect()
}

pub fn transpose(a: Arguments, _: Type) -> GlslValue {
    let (rows, columns) = (a[0].1.rows, a[0].1.columns);
    (0..rows * columns).map(|index| a[0].0[index % columns * rows + index / columns]).collect()
}

pub fn outer_product(a: Arguments, _: Type) -> GlslValue {
    a[1].0.iter().flat_map(|y| a[0].0.iter().map(|x| x.times(*y))).collect()
}

/// The matrix without a column and a row.
fn minor(m: &[Num], side: usize, column: usize, row: usize) -> GlslValue {
    let is_kept = |index: &usize| index / side != column && index % side != row;
    (0..side * side).filter(is_kept).map(|index| m[index]).collect()
}

/// Each product of entries has a few roundings, whatever their order.
fn determinant(m: &[Num], side: usize) -> Num {
    if side == 1 {
        return m[0];
    }
    let signed = |index: usize| {
        let product = m[index * side].times(determinant(&minor(m, side, index, 0), side - 1));
        if index % 2 == 1 { product.negative() } else { product }
    };
    let terms: Vec<Num> = (0..side).map(signed).collect();
    let sum = sum(&terms);
    let size = products(m, side);
    if sum.error == 0.0 { sum } else { Num::off(sum.value, sum.error + 4.0 * ROUNDING * size) }
}

/// Sum of magnitudes of the determinant's products.
fn products(m: &[Num], side: usize) -> f64 {
    if side == 1 {
        return m[0].value.abs();
    }
    (0..side).map(|index| m[index * side].value.abs() * products(&minor(m, side, index, 0), side - 1)).sum()
}

pub fn determinant_of(a: Arguments, _: Type) -> GlslValue {
    determinant(&a[0].0, a[0].1.rows).into()
}

/// Cofactors over the determinant.
pub fn inverse(a: Arguments, kind: Type) -> GlslValue {
    let (m, side) = (&a[0].0, kind.rows);
    let whole = determinant(m, side);
    let cofactor = |column: usize, row: usize| {
        let part = determinant(&minor(m, side, column, row), side - 1);
        if (column + row) % 2 == 1 { part.negative() } else { part }
    };
    (0..side * side).map(|index| cofactor(index % side, index / side).over(whole)).collect()
}

/// A constructor [GLSL 4.60, 5.4]: from scalars, vectors, or one matrix.
pub fn construct(a: Arguments, kind: Type) -> GlslValue {
    let whole = |(value, from): &(GlslValue, Type)| -> GlslValue {
        value.iter().map(|x| converted(*x, from.base, kind.base)).collect()
    };
    if kind.is_matrix() && a.len() == 1 {
        let (m, from) = (whole(&a[0]), a[0].1);
        let entry = |column: usize, row: usize| match from.is_matrix() {
            true if column < from.columns && row < from.rows => m[column * from.rows + row],
            false if column == row => m[0],
            _ => Num::exact(f64::from(u8::from(column == row))),
        };
        return (0..kind.scalars()).map(|index| entry(index / kind.rows, index % kind.rows)).collect();
    }
    if let [one] = a
        && one.0.len() == 1
    {
        return GlslValue::filled(whole(one)[0], kind.scalars());
    }
    let parts: Vec<GlslValue> = a.iter().map(whole).collect();
    parts.iter().flat_map(|part| part.iter()).copied().take(kind.scalars()).collect()
}

/// Tests for equality of all components, or of matrices.
pub fn equal(a: Arguments, _: Type) -> GlslValue {
    a[0].0.iter().zip(a[1].0.iter()).fold(Num::exact(1.0), |all, (a, b)| both(all, Num::boolean(a.equals(*b)))).into()
}

pub fn unequal(a: Arguments, kind: Type) -> GlslValue {
    equal(a, kind).iter().map(|equal| Num::boolean(equal.truth().map(|equal| !equal))).collect()
}

pub fn any(a: Arguments, _: Type) -> GlslValue {
    a[0].0.iter().fold(Num::exact(0.0), |all, x| either(all, *x)).into()
}

pub fn all(a: Arguments, _: Type) -> GlslValue {
    a[0].0.iter().fold(Num::exact(1.0), |all, x| both(all, *x)).into()
}

/// Not known if one side is not, whatever the other: a comparison with a NaN may be folded into its neighbour, as
/// `a < c || b < c` into `min(a, b) < c`, and what min makes of a NaN is open [GLSL 4.60, 4.7.1].
pub fn either(a: Num, b: Num) -> Num {
    Num::boolean(a.truth().zip(b.truth()).map(|(a, b)| a || b))
}

/// Not known if one side is not, as for `either`.
pub fn both(a: Num, b: Num) -> Num {
    Num::boolean(a.truth().zip(b.truth()).map(|(a, b)| a && b))
}
