//! A quantity that an end prescribes is constant; all other quantities move. The chains have clocks, quantities that
//! fields and rotations advect, and terms of ends. They are compared with the discrete equations typed by hand and
//! with shorter chains between walls.

use super::{card, choice, observed, started};

const H: f64 = 0.05;
const STEPS: usize = 60;

/// The additions to a chain of beads on springs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Beside {
    /// Constant forces.
    Forces,
    /// These additions, and a quantity that a field advects.
    Carried,
    /// A clock at every node drives the chain, and so do its ends.
    Clock,
    /// Clocks of every kind, and quantities that fields advect at nodes and at segments.
    Everything,
}

impl Beside {
    fn has_clocks(self) -> bool {
        matches!(self, Beside::Clock | Beside::Everything)
    }

    fn carries(self) -> bool {
        matches!(self, Beside::Carried | Beside::Everything)
    }

    /// The statement of the chain.
    fn model(self) -> String {
        let mut declared = String::new();
        let mut terms = String::new();
        let mut add = |is: bool, own: &str, of: &str| {
            if is {
                declared.push_str(own);
                terms.push_str(of);
            }
        };
        add(
            self.carries(),
            "advected y: Real at nodes; constraint next(y) = y + (next(x) - x);",
            " - h*(e/2)*y^2",
        );
        add(!self.has_clocks(), "", " + h*f*x");
        add(
            self.has_clocks(),
            "advected τ: Real at nodes; constraint next(τ) = τ + h;",
            " + h*f*sin(w*τ)*x",
        );
        add(
            self == Beside::Everything,
            "advected φ, g: Real at nodes; constraint next(φ) = φ + h*τ; constraint next(g) = a*g;
             advected u: Vec<2> at nodes; constraint next(u) = u + h*E1;
             advected s: Real; constraint next(s) = s + h;
             advected σ, r: Real at segments; constraint next(σ) = σ + h;
             constraint next(r) = r + (next(next(x, i)) - next(x)) - (next(x, i) - x);
             param b: Real at segments; param a, l: Real;",
            " + h*f*sin(φ)*x + h*f*g*x + h*f*sin(u[1])*x + h*f*cos(s)*x
             - h*(b/2)*(1 + sin(w*σ))*(next(x, i) - x)^2 - h*(e/2)*r^2 + l*sin(w*τ)*(next(x) - x)",
        );
        let driven = |other: &str| {
            match self.has_clocks() {
            true => format!(
                "shaken {{ param A, K: Real; term -(h*K/2)*(x - A*sin(w*τ))^2; }}
                 pulling {{ x = given; param A, K: Real; term -(h*K/2)*({other} - x - A*sin(w*τ))^2; }}"
            ),
            false => String::new(),
        }
        };
        let (first, last) = (driven("next(x, i)"), driven("prev(x, i)"));
        format!(
            "model Chain {{
                label i in 0..N;
                periodic;
                param m, f: Real at nodes;
                param c, e, w: Real;
                field x: Real at nodes;
                {declared}
                lagrangian = m*(next(x) - x)^2/(2*h) - h*c*(next(x, i) - x)^2/2{terms};
                end i = 0 {{ free; pinned {{ x = given; }} load {{ param F: Real; term h*F*x; }} {first} }}
                end i = N {{ pinned {{ x = given; }} free; load {{ param F: Real; term h*F*x; }} {last} }}
            }}"
        )
    }
}

/// The numbers of a case, at a site if there is one.
fn value(name: &str, site: Option<usize>) -> f64 {
    let j = site.unwrap_or(0) as f64;
    match name {
        "m" => 1.0 + 0.1 * j,
        "f" => 0.5 - 0.03 * j,
        "b" => 0.3 + 0.02 * j,
        "c" => 0.8,
        "w" => 1.3,
        "a" => 0.99,
        "e" => 0.2,
        "l" => 0.15,
        "F" => 0.4 + 0.05 * j,
        "A" => 0.6 + 0.03 * j,
        "K" => 2.0 + 0.1 * j,
        "x" => 0.3 * (j + 0.4).sin(),
        "tau" => 0.1 * j,
        "phi" => 0.2 - 0.1 * j,
        "g" => 0.5 + 0.02 * j,
        "y" => 0.1 + 0.05 * j,
        "u" => 0.3 * j,
        "sigma" => 0.4 - 0.2 * j,
        "r" => 0.05 * j - 0.2,
        "s" => 0.7,
        "momentum" | "momentum_x" => 0.2 - 0.04 * j,
        other => panic!("{other} is not expected"),
    }
}

fn at(name: &str, site: usize) -> f64 {
    value(name, Some(site))
}

/// A chain by hand.
struct Hand {
    ends: Option<[&'static str; 2]>,
    beside: Beside,
    x: Vec<f64>,
    p: Vec<f64>,
    phi: Vec<f64>,
    g: Vec<f64>,
    t: f64,
}

impl Hand {
    fn new(n: usize, ends: Option<[&'static str; 2]>, beside: Beside) -> Hand {
        let nodes = n + usize::from(ends.is_some());
        let all = |name: &str| (0..nodes).map(|j| at(name, j)).collect();
        Hand {
            ends,
            beside,
            x: all("x"),
            p: all("momentum"),
            phi: all("phi"),
            g: all("g"),
            t: 0.0,
        }
    }

    fn is_given(&self, j: usize) -> bool {
        let given = |end: &str| ["pinned", "pulling"].contains(&end);
        let last = self.x.len() - 1;
        self.ends
            .is_some_and(|[a, b]| j == 0 && given(a) || j == last && given(b))
    }

    fn lean(&self, j: usize) -> f64 {
        match self.beside == Beside::Everything {
            true => value("l", None) * (value("w", None) * (at("tau", j) + self.t)).sin(),
            false => 0.0,
        }
    }

    fn forces(&self) -> Vec<f64> {
        let [c, e, w] = ["c", "e", "w"].map(|name| value(name, None));
        let (n, x) = (self.x.len(), &self.x);
        let tau = |j: usize| at("tau", j) + self.t;
        let mut out = vec![0.0; n];
        for j in 0..n {
            let drive = match self.beside {
                Beside::Forces | Beside::Carried => 1.0,
                Beside::Clock => (w * tau(j)).sin(),
                Beside::Everything => {
                    let own = (w * tau(j)).sin() + self.phi[j].sin() + self.g[j];
                    own + (at("u", j) + self.t).sin() + (value("s", None) + self.t).cos()
                }
            };
            out[j] += at("f", j) * drive;
            if self.beside.carries() {
                out[j] -= e * (at("y", j) + x[j] - at("x", j));
            }
        }
        let segments = if self.ends.is_some() { n - 1 } else { n };
        for j in 0..segments {
            let k = (j + 1) % n;
            let mut pull = c * (x[k] - x[j]);
            if self.beside == Beside::Everything {
                let stiffness = at("b", j) * (1.0 + (w * (at("sigma", j) + self.t)).sin());
                let stretch = at("r", j) + x[k] - x[j] - (at("x", k) - at("x", j));
                pull += stiffness * (x[k] - x[j]) + e * stretch;
            }
            out[j] += pull;
            out[k] -= pull;
        }
        for (last, end) in self.ends.iter().flatten().enumerate() {
            let (j, beside) = match last {
                0 => (0, 1),
                _ => (n - 1, n - 2),
            };
            let wave = at("A", j) * (w * tau(j)).sin();
            match *end {
                "load" => out[j] += at("F", j),
                "shaken" => out[j] -= at("K", j) * (x[j] - wave),
                "pulling" => out[beside] -= at("K", j) * (x[beside] - x[j] - wave),
                _ => {}
            }
        }
        out
    }

    fn step(&mut self) {
        let kick = |own: &mut Hand| {
            let forces = own.forces();
            for (p, f) in own.p.iter_mut().zip(forces) {
                *p += H / 2.0 * f;
            }
        };
        kick(self);
        for j in 0..self.x.len() {
            if !self.is_given(j) {
                self.x[j] += H * (self.p[j] - self.lean(j)) / at("m", j);
            }
            self.phi[j] += H * (at("tau", j) + self.t);
            self.g[j] *= value("a", None);
        }
        self.t += H;
        kick(self);
    }
}

/// Steps a chain and its hand-written equations, and compares all observables.
fn agrees(beside: Beside, n: usize, ends: Option<[&'static str; 2]>) {
    let card = card(&beside.model(), n, ends.is_none(), ends.unwrap_or_default());
    let mut hand = Hand::new(n, ends, beside);
    // The name of a single momentum omits its site.
    let alone = (0..hand.x.len()).find(|j| !hand.is_given(*j));
    let of = |name: &str, site: Option<usize>| match name {
        "momentum" => vec![value(name, alone)],
        "u" => vec![value("u", site), -0.5],
        _ => vec![value(name, site)],
    };
    let mut t = started(&card, &of, H);
    for step in 1..=STEPS {
        t.step().expect("steps");
        hand.step();
        let same = |name: &str, index: usize, wanted: f64| {
            if !card.observables.iter().any(|f| f.ascii == name) {
                return false;
            }
            let off = (observed(&*t, name)[index] - wanted).abs();
            // Rounding of numbers of order one over all steps; springs do not amplify it.
            assert!(
                off < 1e-12,
                "{name} is off by {off:e} after {step} steps: {beside:?} {n} {ends:?}"
            );
            true
        };
        for j in 0..hand.x.len() {
            let seen = same(&format!("x_{j}"), 0, hand.x[j]);
            assert!(seen != hand.is_given(j), "x_{j}: {beside:?} {n} {ends:?}");
            let clocks = [
                ("tau", at("tau", j) + hand.t),
                ("phi", hand.phi[j]),
                ("g", hand.g[j]),
                ("u", at("u", j) + hand.t),
                ("sigma", at("sigma", j) + hand.t),
            ];
            let own = match beside {
                Beside::Forces | Beside::Carried => &clocks[..0],
                Beside::Clock => &clocks[..1],
                Beside::Everything if ends.is_some() && j + 1 == hand.x.len() => &clocks[..4],
                Beside::Everything => &clocks,
            };
            for (name, wanted) in own {
                assert!(same(&format!("{name}_{j}"), 0, *wanted), "{name}_{j}");
            }
        }
    }
}

#[test]
fn what_an_end_prescribes_stands_still_and_nothing_else_does() {
    let names = ["free", "pinned", "load", "shaken", "pulling"];
    for (i, first) in names.into_iter().enumerate() {
        for by in [1, 3] {
            let ends = [first, names[(i + by) % names.len()]];
            agrees(Beside::Clock, 1 + (i + by) % 3, Some(ends));
        }
    }
    agrees(Beside::Clock, 12, Some(["pinned", "shaken"]));
    for (n, ends) in [
        (1, ["load", "pinned"]),
        (2, ["pulling", "free"]),
        (3, ["pinned", "shaken"]),
    ] {
        agrees(Beside::Everything, n, Some(ends));
    }
    agrees(Beside::Everything, 3, None);
}

#[test]
fn what_a_field_carries_goes_on_beside_an_end_that_holds_it() {
    for (ends, n) in [
        (["pinned", "free"], 1),
        (["pinned", "load"], 3),
        (["load", "pinned"], 12),
    ] {
        agrees(Beside::Carried, n, Some(ends));
    }
    for ends in [["pinned", "load"], ["load", "pinned"], ["pinned", "pinned"]] {
        agrees(Beside::Forces, 40, Some(ends));
    }
}

/// Loops over sites store only positions and momenta between steps, so longer chains are rejected for any end conditions.
#[test]
fn lines_that_loops_do_not_take_are_refused_with_the_reason() {
    for (beside, why) in [
        (Beside::Clock, "advances with the step by itself"),
        (Beside::Carried, "has a constraint but no definition"),
    ] {
        for ends in [["free", "free"], ["pinned", "free"], ["free", "pinned"]] {
            let source = beside.model();
            let choice = choice(&source, 40, false, ends);
            let refused = clebsch_interpret::card_on_lattice(&source, &choice);
            let told = refused.expect_err("is too long").to_string();
            assert!(told.contains(why), "{told}");
        }
    }
}
