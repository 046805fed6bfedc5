//! Functions that models call by path. The interpreter knows the runtime's functions. If a model calls another
//! function, it needs a build.

use crate::code::Native;
use crate::value::Value;
use clebsch::Real;
use clebsch::functions::{carlson_rf, carlson_rf_of_invariants as by_invariants};

/// The functions, with their arguments, as listed in messages.
pub const KNOWN: &str = "`clebsch::functions::carlson_rf` of a `Sym<3>` and \
    `clebsch::functions::carlson_rf_of_invariants` of three numbers";

/// A method of the function of invariants: each argument, the change and the seed are numbers.
macro_rules! of_invariants {
    ($method:ident($($x:ident),*)) => {
        |a, _| match a {
            [$(Value::Real($x)),*] => Some(Value::Real(by_invariants.$method($($x),*))),
            _ => None,
        }
    };
}

/// The function with this path and method, for this number of arguments.
pub fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    let method = name.strip_prefix("clebsch::functions::")?;
    match method.split_once("::")? {
        ("carlson_rf", method) => of_matrix(method, arguments),
        ("carlson_rf_of_invariants", method) => of_invariants(method, arguments),
        _ => None,
    }
}

fn of_matrix<T: Real>(method: &str, arguments: usize) -> Option<Native<T>> {
    let found: Native<T> = match (method, arguments) {
        ("value", 1) => |a, _| {
            let shape = a.first()?.dense()?;
            Some(Value::Real(carlson_rf.value(&shape.fixed::<3, 3>())))
        },
        ("along_1", 2) => |a, _| {
            let [shape, along] = a else { return None };
            let (shape, along) = (shape.dense()?, along.dense()?);
            let (shape, along) = (shape.fixed::<3, 3>(), along.fixed::<3, 3>());
            Some(Value::Real(carlson_rf.along_1(&shape, &along)))
        },
        ("pull_back_1", 2) => |a, _| match a {
            [shape, Value::Real(seed)] => {
                let shape = shape.dense()?.fixed::<3, 3>();
                Some(Value::Matrix(carlson_rf.pull_back_1(&shape, seed)))
            }
            _ => None,
        },
        ("pull_back_1_along_1", 3) => |a, _| match a {
            [shape, along, Value::Real(seed)] => {
                let (shape, along) = (shape.dense()?, along.dense()?);
                let (shape, along) = (shape.fixed::<3, 3>(), along.fixed::<3, 3>());
                Some(Value::Matrix(
                    carlson_rf.pull_back_1_along_1(&shape, &along, seed),
                ))
            }
            _ => None,
        },
        _ => return None,
    };
    Some(found)
}

fn of_invariants<T: Real>(method: &str, arguments: usize) -> Option<Native<T>> {
    let found: Native<T> = match (method, arguments) {
        ("value", 3) => of_invariants!(value(x, y, z)),
        ("along_1", 4) => of_invariants!(along_1(x, y, z, along)),
        ("along_2", 4) => of_invariants!(along_2(x, y, z, along)),
        ("along_3", 4) => of_invariants!(along_3(x, y, z, along)),
        ("pull_back_1", 4) => of_invariants!(pull_back_1(x, y, z, seed)),
        ("pull_back_2", 4) => of_invariants!(pull_back_2(x, y, z, seed)),
        ("pull_back_3", 4) => of_invariants!(pull_back_3(x, y, z, seed)),
        ("pull_back_1_along_1", 5) => of_invariants!(pull_back_1_along_1(x, y, z, along, seed)),
        ("pull_back_1_along_2", 5) => of_invariants!(pull_back_1_along_2(x, y, z, along, seed)),
        ("pull_back_1_along_3", 5) => of_invariants!(pull_back_1_along_3(x, y, z, along, seed)),
        ("pull_back_2_along_1", 5) => of_invariants!(pull_back_2_along_1(x, y, z, along, seed)),
        ("pull_back_2_along_2", 5) => of_invariants!(pull_back_2_along_2(x, y, z, along, seed)),
        ("pull_back_2_along_3", 5) => of_invariants!(pull_back_2_along_3(x, y, z, along, seed)),
        ("pull_back_3_along_1", 5) => of_invariants!(pull_back_3_along_1(x, y, z, along, seed)),
        ("pull_back_3_along_2", 5) => of_invariants!(pull_back_3_along_2(x, y, z, along, seed)),
        ("pull_back_3_along_3", 5) => of_invariants!(pull_back_3_along_3(x, y, z, along, seed)),
        _ => return None,
    };
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::native;
    use clebsch_core::syntax::library::FUNCTIONS;

    /// A model may call these functions, so the interpreter has to know them.
    #[test]
    fn every_function_of_the_library_runs() {
        for (name, arguments) in FUNCTIONS {
            let path = format!("clebsch::functions::{name}::value");
            assert!(native::<f64>(&path, arguments.len()).is_some(), "{path}");
        }
    }
}
