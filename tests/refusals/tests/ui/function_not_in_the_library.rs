//! The library has few functions.

clebsch::model! {
    model Shell {
        param m: Real;
        given RG(Sym<3>): Real = clebsch::functions::carlson_rg;
        field y: Sym<3>;
        lagrangian = m*tr((next(y) - y)*(next(y) - y))/(2*h) - h*RG(y);
    }
}

fn main() {}
