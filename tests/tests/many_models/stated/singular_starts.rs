//! Initial states where a model is undefined. The error names the argument outside its domain and suggests no smaller step size.

use super::text_model::{Motion, TextModel, given};
use clebsch::card::OpenError;
use clebsch::nalgebra::Vector3;

/// Two bodies that attract each other.
const ATTRACTED: &str = "model Attracted {
    param m, k: Real;
    field X, Y: Vec<3>;
    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + m*dot(next(Y) - Y, next(Y) - Y)/(2*h)
        + h*k/sqrt(dot(X - Y, X - Y));
}";

/// A number in a logarithmic potential.
const LOGARITHMIC: &str = "model Logarithmic {
    param m: Real;
    field x: Real;
    lagrangian = m*(next(x) - x)^2/(2*h) + h*log(1 + x);
}";

type Started = Result<Motion, OpenError>;

fn attracted(apart: f64) -> Started {
    let place = Vector3::new(0.25, 0.5, 1.0);
    let given = given! {
        m: 1.0, k: 0.5, X: place, momentum_X: Vector3::x(), Y: place + Vector3::z() * apart,
        momentum_Y: Vector3::y(),
    };
    TextModel::read(ATTRACTED).start(0.01, &given)
}

fn logarithmic(x: f64) -> Started {
    let given = given! { m: 1.0, x: x, momentum: 0.1 };
    TextModel::read(LOGARITHMIC).start(0.01, &given)
}

#[test]
fn a_start_where_nothing_is_defined_is_refused_for_that() {
    let said = |found: Started| found.expect_err("refused").to_string();
    let met = said(attracted(0.0));
    for words in ["|X_k - Y_k|", "start where the model is defined"] {
        assert!(met.contains(words), "{met}");
    }
    assert!(!met.contains("step of"), "{met}");
    for x in [-1.0, -2.0] {
        let left = said(logarithmic(x));
        assert!(
            left.contains("x_k + 1") && left.contains("of log"),
            "{left}"
        );
    }
    assert!(attracted(1e-3).is_ok() && logarithmic(-0.5).is_ok());
}

/// A number whose potential contains the step size, which has a name.
const STEPPED: &str = "model Stepped {
    time k step tau;
    param m: Real;
    field x: Real;
    lagrangian = m*(next(x) - x)^2/(2*tau) + tau*log(1 + x + tau);
}";

#[test]
fn an_argument_that_holds_the_step_is_refused_by_its_value_at_that_step() {
    let given = given! { m: 1.0, x: -1.125, momentum: 0.1 };
    let start = |tau: f64| TextModel::read(STEPPED).start(tau, &given);
    // -1/16 with step size 1/16, and 1/16 with step size 3/16.
    let met = start(0.0625).expect_err("refused").to_string();
    assert!(met.contains("-0.0625"), "{met}");
    assert!(start(0.1875).is_ok());
}
