//! A function of the library has the arguments that it takes.

clebsch::model! {
    model Shell {
        param m: Real;
        given RF(Sym<3>): Real = clebsch::functions::carlson_rf_of_invariants;
        field y: Sym<3>;
        lagrangian = m*tr((next(y) - y)*(next(y) - y))/(2*h) - h*RF(y);
    }
}

fn main() {}
