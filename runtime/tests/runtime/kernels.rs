//! Kernels evaluated as data, against the same operations on statically sized matrices: equal bits for every operation and shape,
//! on numbers of every kind. A recorded tape gives the same bits.

use super::common::Random;
use clebsch::emitted as e;
use clebsch::nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector6};
use clebsch::{Real, linalg};
use clebsch_program::{
    Arithmetic, Array, Dim, Kernel, Kind, Machine, Misfit, Number, Operation, Pair, Shape, Single,
    Tape, Unvalued, Value, evaluate,
};

/// Random operands per operation and shape.
const DRAWS: usize = 400;

/// The runtime's binary64 numbers.
struct Numbers;

impl Arithmetic for Numbers {
    type Number = f64;

    fn constant(&self, number: Number) -> f64 {
        match number {
            Number::Double(x) => x,
            Number::Ratio(num, den) => f64::from_ratio(num, den),
            Number::Pi => core::f64::consts::PI,
        }
    }

    fn add(&self, a: f64, b: f64) -> f64 {
        a + b
    }

    fn sub(&self, a: f64, b: f64) -> f64 {
        a - b
    }

    fn mul(&self, a: f64, b: f64) -> f64 {
        a * b
    }

    fn div(&self, a: f64, b: f64) -> f64 {
        a / b
    }

    fn neg(&self, a: f64) -> f64 {
        -a
    }

    fn function(&self, which: Single, a: f64) -> f64 {
        match which {
            Single::Sqrt => Real::sqrt(a),
            Single::Exp => Real::exp(a),
            Single::Log => Real::ln(a),
            Single::Sin => Real::sin(a),
            Single::Cos => Real::cos(a),
            Single::Sinh => Real::sinh(a),
            Single::Cosh => Real::cosh(a),
            Single::Tanh => Real::tanh(a),
            Single::Abs => Real::abs(a),
            Single::Sign => Real::sign(a),
            other => panic!("{other:?} does not take one number"),
        }
    }

    fn power(&self, a: f64, exponent: i32) -> f64 {
        Real::powi(a, exponent)
    }

    fn root(&self, a: f64, num: i64, den: i64) -> f64 {
        Real::powr(a, num, den)
    }

    fn inverse(&self, a: &Array<f64>) -> Option<Array<f64>> {
        let given = linalg::Dense::from_fn(a.rows(), a.cols(), |i, j| a.at(i, j));
        let found = given.small_inverse();
        Some(Array::from_fn(a.rows(), a.cols(), |i, j| {
            found.as_ref().map_or(f64::NAN, |found| found.at(i, j))
        }))
    }

    fn determinant(&self, a: &Array<f64>) -> Option<f64> {
        let given = linalg::Dense::from_fn(a.rows(), a.cols(), |i, j| a.at(i, j));
        Some(given.determinant())
    }
}

/// Numbers of every kind: ordinary ones of many sizes, zeros of both signs, subnormal, infinite and NaN.
struct Source(Random);

impl Source {
    fn number(&mut self) -> f64 {
        let (plain, bits) = (self.0.symmetric(), self.0.bits());
        match bits % 64 {
            0 => 0.0,
            1 => -0.0,
            2 => f64::from_bits(bits >> 12),
            3 => plain * 1e300,
            4 => f64::INFINITY,
            5 => f64::NAN,
            6..16 => plain * 1e-9,
            _ => plain,
        }
    }

    fn array(&mut self, rows: usize, cols: usize) -> Array<f64> {
        Array::from_fn(rows, cols, |_, _| self.number())
    }
}

fn matrix<const R: usize, const C: usize>(a: &Array<f64>) -> SMatrix<f64, R, C> {
    assert_eq!((a.rows(), a.cols()), (R, C));
    SMatrix::from_column_slice(a.columns())
}

fn kind(a: &Array<f64>) -> Kind {
    let dim = |n: usize| Dim::Fixed(u32::try_from(n).expect("small"));
    Kind::Array(Shape {
        rows: dim(a.rows()),
        cols: dim(a.cols()),
    })
}

/// One operation on inputs. The function takes trait objects and runtime sizes, so that the compiler instantiates it only once; so
/// do the functions below.
fn kernel(given: &[Array<f64>], make: &dyn Fn(&[Value]) -> Operation) -> Result<Kernel, Misfit> {
    let mut kernel = Kernel::new();
    let mut values = Vec::new();
    for (at, a) in given.iter().enumerate() {
        values.push(kernel.input(&format!("x{at}"), kind(a))?);
    }
    let value = kernel.push(make(&values))?;
    kernel.outputs.push(value);
    Ok(kernel)
}

fn same(found: f64, wanted: f64) -> bool {
    found.to_bits() == wanted.to_bits() || found.is_nan() && wanted.is_nan()
}

/// Checks that the operation gives these bits, evaluated directly and recorded as a tape.
fn gives(what: &str, given: &[Array<f64>], make: &dyn Fn(&[Value]) -> Operation, wanted: &[f64]) {
    let kernel = kernel(given, make).unwrap_or_else(|misfit| panic!("{what}: {misfit}"));
    kernel.verify().expect("it was verified line by line");
    let found = evaluate(&Numbers, &kernel, given, &[]).expect("inputs fit");
    let found = found[0].columns();
    let agree = found.len() == wanted.len() && found.iter().zip(wanted).all(|(f, w)| same(*f, *w));
    assert!(agree, "{what} of {given:?}: {found:?} for {wanted:?}");
    let numbers: Vec<f64> = given.iter().flat_map(|a| a.columns().to_vec()).collect();
    match Tape::of(&kernel, &[]) {
        Ok(tape) => {
            let machine = Machine::new(&tape, numbers.len());
            let mut frame = machine.frame::<1>();
            for (slot, x) in frame.inputs().iter_mut().zip(&numbers) {
                *slot = [*x];
            }
            assert!(machine.run(&mut frame), "{what} decides nothing");
            let found: Vec<f64> = machine.gives(&frame, 0).collect();
            let agree = found.iter().zip(wanted).all(|(f, w)| same(*f, *w));
            assert!(
                agree,
                "the tape of {what} of {given:?}: {found:?} for {wanted:?}"
            );
        }
        // Tapes do not contain pivoting.
        Err(e) => assert!(
            matches!(e, Unvalued::Operation("inverse_or_nan" | "determinant")),
            "{what}: {e}"
        ),
    }
}

/// Random operands of these shapes, and the expected result.
fn drawn(
    source: &mut Source,
    word: &str,
    shapes: &[(usize, usize)],
    make: &dyn Fn(&[Value]) -> Operation,
    wanted: &dyn Fn(&[Array<f64>]) -> Vec<f64>,
) {
    let what = format!("{word} of {shapes:?}");
    for _ in 0..DRAWS {
        let operand = |&(rows, cols): &(usize, usize)| source.array(rows, cols);
        let given: Vec<Array<f64>> = shapes.iter().map(operand).collect();
        gives(&what, &given, make, &wanted(&given));
    }
}

fn one<const R: usize, const C: usize, const P: usize, const Q: usize>(
    source: &mut Source,
    single: Single,
    f: fn(&SMatrix<f64, R, C>) -> SMatrix<f64, P, Q>,
) {
    let make = |v: &[Value]| Operation::One(single, v[0]);
    drawn(source, single.word(), &[(R, C)], &make, &|given| {
        f(&matrix(&given[0])).as_slice().to_vec()
    });
}

fn two<
    const R: usize,
    const C: usize,
    const S: usize,
    const D: usize,
    const P: usize,
    const Q: usize,
>(
    source: &mut Source,
    pair: Pair,
    f: fn(&SMatrix<f64, R, C>, &SMatrix<f64, S, D>) -> SMatrix<f64, P, Q>,
) {
    let make = |v: &[Value]| Operation::Two(pair, v[0], v[1]);
    drawn(source, pair.word(), &[(R, C), (S, D)], &make, &|given| {
        f(&matrix(&given[0]), &matrix(&given[1]))
            .as_slice()
            .to_vec()
    });
}

fn number(x: f64) -> SMatrix<f64, 1, 1> {
    SMatrix::repeat(x)
}

/// Operations on square matrices and vectors of one size, and with matrices of 1 to 6 columns.
macro_rules! of_size {
    ($source:ident, $($n:literal)*) => { $(
        one::<$n, $n, $n, $n>(&mut $source, Single::Neg, |a| -a);
        one::<$n, $n, $n, $n>(&mut $source, Single::Transpose, |a| a.transpose());
        one::<$n, $n, 1, 1>(&mut $source, Single::Trace, |a| number(a.trace()));
        one::<$n, $n, 1, 1>(&mut $source, Single::Determinant, |a| number(e::determinant(a)));
        one::<$n, $n, $n, $n>(&mut $source, Single::Inverse, |a| e::inverse_or_nan(a));
        one::<$n, $n, $n, $n>(&mut $source, Single::LessIdentity, |a| e::less_identity(a));
        one::<$n, $n, $n, $n>(&mut $source, Single::SymmetricPart, |a| e::symmetric_part(a));
        one::<$n, $n, $n, $n>(&mut $source, Single::SkewPart, |a| e::skew_part(a));
        one::<$n, $n, $n, $n>(&mut $source, Single::DiagonalPart, |a| e::diagonal_part(a));
        one::<$n, 1, $n, $n>(&mut $source, Single::Diagonal, |a| e::diagonal(a));
        one::<$n, $n, $n, 1>(&mut $source, Single::DiagonalOf, |a| e::diagonal_of(a));
        two::<$n, 1, $n, 1, 1, 1>(&mut $source, Pair::Dot, |a, b| number(a.dot(b)));
        two::<$n, $n, $n, $n, 1, 1>(&mut $source, Pair::Dot, |a, b| number(a.dot(b)));
        two::<$n, $n, 1, 1, $n, $n>(&mut $source, Pair::Mul, |a, b| a * b[0]);
        two::<$n, 1, 1, 1, $n, 1>(&mut $source, Pair::Div, |a, b| a / b[0]);
        two::<$n, $n, $n, $n, $n, $n>(&mut $source, Pair::Add, |a, b| a + b);
        two::<$n, $n, $n, $n, $n, $n>(&mut $source, Pair::Sub, |a, b| a - b);
        two::<$n, $n, $n, 2, $n, 2>(&mut $source, Pair::DiagonalTimes, e::diagonal_times);
        two::<2, $n, $n, $n, 2, $n>(&mut $source, Pair::TimesDiagonal, e::times_diagonal);
        of_size!(products $source, $n, 2 3 4 5 6);
    )* };
    (products $source:ident, $n:literal, $($k:literal)*) => { $(
        two::<$n, $k, $k, $n, $n, $n>(&mut $source, Pair::Mul, |a, b| a * b);
        two::<$n, $k, $k, 1, $n, 1>(&mut $source, Pair::Mul, |a, b| a * b);
        two::<$k, $n, $k, 3, $n, 3>(&mut $source, Pair::TransposedMul, |a, b| a.tr_mul(b));
        two::<$k, $n, $k, 1, $n, 1>(&mut $source, Pair::TransposedMul, |a, b| a.tr_mul(b));
    )* };
}

#[test]
fn operations_of_every_size_give_the_bits_of_static_matrices() {
    let mut source = Source(Random(1));
    of_size!(source, 2 3 4 5 6);
}

#[test]
fn operations_of_space_give_the_bits_of_static_matrices() {
    let mut source = Source(Random(2));
    let s = &mut source;
    one::<3, 1, 3, 3>(s, Single::Hat, e::hat);
    one::<3, 3, 3, 1>(s, Single::Vee, e::vee);
    one::<3, 3, 3, 1>(s, Single::AxialOfDifference, e::axial_of_difference);
    one::<3, 3, 3, 3>(s, Single::TraceComplement, e::trace_complement);
    one::<2, 2, 2, 2>(s, Single::Adjugate, e::adjugate);
    one::<3, 3, 3, 3>(s, Single::Adjugate, e::adjugate);
    one::<4, 4, 3, 3>(s, Single::MotionRotation, e::motion_rotation);
    one::<4, 4, 3, 1>(s, Single::MotionTranslation, e::motion_translation);
    one::<3, 3, 2, 2>(s, Single::MotionRotation, e::motion_rotation);
    one::<3, 3, 2, 1>(s, Single::MotionTranslation, e::motion_translation);
    one::<3, 1, 3, 3>(s, Single::Twist, |v: &Vector3<f64>| e::twist(v));
    one::<6, 1, 4, 4>(s, Single::Twist, |v: &Vector6<f64>| e::twist(v));
    one::<4, 4, 1, 1>(s, Single::QuaternionReal, |a| number(e::quaternion_real(a)));
    one::<4, 4, 3, 1>(s, Single::QuaternionImaginary, e::quaternion_imaginary);
    one::<4, 4, 3, 3>(s, Single::QuaternionRotation, e::quaternion_rotation);
    one::<3, 1, 4, 4>(s, Single::PureQuaternion, e::pure_quaternion);
    two::<3, 1, 3, 1, 3, 1>(s, Pair::Cross, |a, b| a.cross(b));
    two::<3, 1, 3, 3, 3, 3>(s, Pair::Crossed, |v, a: &Matrix3<f64>| e::crossed(v, a));
    two::<3, 3, 3, 1, 3, 3>(s, Pair::Crossing, |a: &Matrix3<f64>, v| e::crossing(a, v));
}

#[test]
fn rows_and_columns_are_those_of_static_matrices() {
    let mut source = Source(Random(3));
    let whole = Shape {
        rows: Dim::Fixed(5),
        cols: Dim::Fixed(2),
    };
    for _ in 0..DRAWS {
        let (a, b, c, d) = (
            source.array(5, 3),
            source.array(2, 3),
            source.array(3, 5),
            source.array(3, 2),
        );
        let taken = e::rows_from::<f64, 5, 2, 3>(&matrix(&a), 3);
        gives(
            "rows",
            std::slice::from_ref(&a),
            &|v| Operation::RowsFrom(v[0], whole, 3),
            taken.as_slice(),
        );
        let put = e::into_rows::<f64, 5, 2, 3>(&matrix(&b), 1);
        gives(
            "into rows",
            std::slice::from_ref(&b),
            &|v| Operation::IntoRows(v[0], whole, 1),
            put.as_slice(),
        );
        let taken = e::columns_from::<f64, 5, 2, 3>(&matrix(&c), 2);
        gives(
            "columns",
            std::slice::from_ref(&c),
            &|v| Operation::ColumnsFrom(v[0], whole, 2),
            taken.as_slice(),
        );
        let put = e::into_columns::<f64, 5, 2, 3>(&matrix(&d), 2);
        gives(
            "into columns",
            std::slice::from_ref(&d),
            &|v| Operation::IntoColumns(v[0], whole, 2),
            put.as_slice(),
        );
        let entry = [a.at(4, 2)];
        gives(
            "entry",
            std::slice::from_ref(&a),
            &|v| Operation::EntryAt(v[0], 4, 2),
            &entry,
        );
    }
    let unit = SVector::<f64, 3>::y();
    gives(
        "unit",
        &[],
        &|_| Operation::Unit(Dim::Fixed(3), 1),
        unit.as_slice(),
    );
    let inclusion = e::inclusion::<f64, 5, 2>(3);
    gives(
        "inclusion",
        &[],
        &|_| Operation::Inclusion(whole, 3),
        inclusion.as_slice(),
    );
}

type OfNumber = (Single, fn(f64) -> f64);

#[test]
fn functions_of_numbers_are_the_runtimes() {
    let mut source = Source(Random(4));
    let functions: [OfNumber; 10] = [
        (Single::Sqrt, Real::sqrt),
        (Single::Exp, Real::exp),
        (Single::Log, Real::ln),
        (Single::Sin, Real::sin),
        (Single::Cos, Real::cos),
        (Single::Sinh, Real::sinh),
        (Single::Cosh, Real::cosh),
        (Single::Tanh, Real::tanh),
        (Single::Abs, Real::abs),
        (Single::Sign, Real::sign),
    ];
    for (single, f) in functions {
        let make = |v: &[Value]| Operation::One(single, v[0]);
        drawn(&mut source, single.word(), &[(1, 1)], &make, &|given| {
            vec![f(given[0].at(0, 0))]
        });
    }
    for _ in 0..DRAWS {
        let x = source.number();
        let given = [Array::number(x)];
        for n in [-3, -1, 0, 2, 3, 5] {
            gives(
                "power",
                &given,
                &|v| Operation::Power(v[0], n),
                &[Real::powi(x, n)],
            );
        }
        for (num, den) in [(1, 2), (3, 2), (1, 3), (-5, 7), (4, 2)] {
            gives(
                "root",
                &given,
                &|v| Operation::Root(v[0], num, den),
                &[Real::powr(x, num, den)],
            );
        }
    }
}

#[test]
fn what_does_not_fit_is_no_line() {
    let three = Kind::Array(Shape::vector(Dim::Fixed(3)));
    let square = Kind::Array(Shape::square(Dim::Fixed(3)));
    let mut kernel = Kernel::new();
    let v = kernel.input("v", three).expect("an input");
    let a = kernel.input("A", square).expect("an input");
    assert_eq!(kernel.input("v", three), Ok(v));
    assert_eq!(
        kernel.input("v", square),
        Err(Misfit::Renamed("v".to_owned()))
    );
    let wrong = [
        Operation::One(Single::Hat, a),
        Operation::One(Single::Trace, v),
        Operation::One(Single::Sin, v),
        Operation::One(Single::Real, v),
        Operation::One(Single::Twist, a),
        Operation::Two(Pair::Add, v, a),
        Operation::Two(Pair::Mul, v, a),
        Operation::Two(Pair::Div, v, a),
        Operation::Two(Pair::Cross, a, v),
        Operation::Two(Pair::Dot, a, v),
        Operation::Two(Pair::Between, v, v),
        Operation::Power(v, 2),
        Operation::Input(2),
        Operation::IntoRows(v, Shape::square(Dim::Fixed(4)), 0),
    ];
    for operation in wrong {
        assert!(kernel.push(operation.clone()).is_err(), "{operation:?}");
    }
    assert_eq!(kernel.lines().len(), 2);
    // A value of a longer kernel comes after every line of `kernel`.
    let mut longer = kernel.clone();
    let product = longer
        .push(Operation::Two(Pair::Mul, a, v))
        .expect("it fits");
    let misfit = kernel.push(Operation::One(Single::Neg, product));
    assert_eq!(misfit, Err(Misfit::Later(product.line())));
    let text = "`+` does not take vector 3 and matrix 3 x 3";
    let misfit = kernel
        .push(Operation::Two(Pair::Add, v, a))
        .expect_err("shapes differ");
    assert_eq!(misfit.to_string(), text);
}
