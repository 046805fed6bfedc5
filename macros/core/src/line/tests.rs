//! Lines as programs: the shipped models and what is refused.

use super::{How, Line, Refused};
use crate::pipeline;

fn line(text: &str) -> Result<Line, Refused> {
    let model = pipeline::parse_source(text).map_err(Refused::Model)?;
    Line::of(&model)
}

fn shipped(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/lattices/");
    std::fs::read_to_string(format!("{folder}{name}.clebsch")).expect("a file")
}

#[test]
fn shipped_lattices_are_programs() {
    for (name, pulls, movers) in [
        ("toda-chain", 1, 1),
        ("sine-gordon", 1, 1),
        ("coupled-tops", 1, 1),
        ("elastic-rod", 2, 2),
    ] {
        let line = match line(&shipped(name)) {
            Ok(line) => line,
            Err(refused) => panic!("{name}: {refused:?}"),
        };
        assert_eq!(line.pulls.len(), pulls, "{name}");
        let names: Vec<&str> = line.totals.iter().map(|t| t.name.as_str()).collect();
        println!("{name}: {names:?}");
        let all: usize = line.lone.iter().map(|l| l.movers.len()).sum();
        assert_eq!(all, movers, "{name}");
    }
}

#[test]
fn velocities_of_neighbours_are_found_together() {
    let text = "model Chain { label i in 0..N; periodic; param m, k: Real; field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h) + (k/h)*(next(q) - q)*(next(next(q, i)) - next(q, i)); }";
    match line(text) {
        Ok(line) => {
            assert_eq!((line.ties.len(), line.pulls.len()), (1, 0));
            assert!(matches!(line.lone[0].movers[0].how, How::Newton { .. }));
        }
        Err(refused) => panic!("{refused:?}"),
    }
}

#[test]
fn velocities_of_sites_that_are_no_neighbours_are_refused() {
    let text = "model Chain { label i in 0..N; param m, k: Real; field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h)
            + (k/h)*(next(prev(q, i)) - prev(q, i))*(next(next(q, i)) - next(q, i)); }";
    let Err(Refused::Form(why)) = line(text) else {
        panic!("a program of velocities two sites apart");
    };
    assert!(why.contains("no neighbours"), "{why}");
}

#[test]
fn a_charge_at_a_site_is_one_system() {
    let text = "model Charges { label i in 0..N; param m, f, k: Real; field X: Vec<2> at nodes;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + (f/2)*dot(perp(X), next(X))
            - h*k*dot(next(X, i) - X, next(X, i) - X)/2; }";
    match line(text) {
        Ok(line) => assert!(matches!(line.lone[0].movers[0].how, How::System { .. })),
        Err(refused) => panic!("{refused:?}"),
    }
}
