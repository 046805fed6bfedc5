//! Starts at which the action is NaN: the message names the site of the bad value and the part of the statement that
//! is not finite there, for expanded chains and for loops over sites.

use crate::common::Folder;
use crate::text_runs::run;

const FIELD: &str = "model E {
    label i in 0..N;
    param m, c: Real;
    field x: Real at nodes;
    lagrangian = m*(next(x)-x)^2/(2*h) - h*(c*exp(x)) - h*(next(x,i)-x)^2/2;
}";

fn refused(name: &str, model: &str, case: &str) -> String {
    let done = run(&Folder::new(name), model, case, "").exits(1);
    done.err
}

#[test]
fn the_site_of_a_value_without_an_action_is_named() {
    for (count, sites) in [(6, [0, 1, 5, 6]), (64, [0, 7, 40, 64])] {
        for site in sites {
            let values: Vec<&str> = (0..=count)
                .map(|i| if i == site { "800" } else { "0" })
                .collect();
            let case = format!(
                "model = \"e\"\nh = 0.01\nsteps = 10\n[labels]\ni = {count}\n[parameters]\nm = 1\nc = 1\n[initial]\n\
                 x = [{}]\nmomentum_x = 0\n",
                values.join(", ")
            );
            let err = refused(&format!("undefined-{count}-{site}"), FIELD, &case);
            let said = format!(
                "cannot take the first step: at i = {site}, `exp(x)` exceeds the largest double: `x` is 800; change the \
                 initial values or parameters at that point"
            );
            assert!(err.contains(&said), "{err}");
        }
    }
}

#[test]
fn a_link_without_length_is_named() {
    let model = "model Post {
        label i in 0..N;
        param m: Real at nodes;
        param c: Real;
        field x: Vec<2> at nodes;
        let d = next(x,i) - x;
        let r = sqrt(dot(d,d));
        lagrangian = m*dot(next(x)-x,next(x)-x)/(2*h) - h*c*(r - 1)^2/2;
    }";
    for (count, site) in [(4, 2), (64, 40)] {
        let places: Vec<String> = (0..=count)
            .map(|i| format!("[{}, 0]", if i > site { i - 1 } else { i }))
            .collect();
        let case = format!(
            "model = \"post\"\nh = 0.01\nsteps = 10\n[labels]\ni = {count}\n[parameters]\nm = 1\nc = 1\n[initial]\n\
             x = [{}]\nmomentum_x = [0, 0]\n",
            places.join(", ")
        );
        let err = refused(&format!("undefined-link-{count}"), model, &case);
        let said = format!(
            "at i = {site}, the length of `next(x, i) - x` is 0, where it has no derivative"
        );
        assert!(err.contains(&said), "{err}");
    }
}

#[test]
fn what_is_not_finite_is_named_without_sites_too() {
    let model = "model Root {
        param m: Real;
        field x: Vec<2>;
        lagrangian = m*dot(next(x)-x, next(x)-x)/(2*h) - h*(exp(x[1]) + (sqrt(dot(x, x)) - 1)^2);
    }";
    for (x, said) in [
        (
            "[0, 0]",
            "step: the length of `x` is 0, where it has no derivative",
        ),
        (
            "[800, 0]",
            "step: `exp(x[1])` exceeds the largest double: `x[1]` is 800",
        ),
    ] {
        let case = format!(
            "model = \"root\"\nh = 0.01\nsteps = 10\n[parameters]\nm = 1\n[initial]\nx = {x}\nmomentum = [0, 0]\n"
        );
        let err = refused("undefined-alone", model, &case);
        assert!(err.contains(said), "{err}");
    }
}
