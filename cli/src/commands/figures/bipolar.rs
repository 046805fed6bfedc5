//! The data of figures 3.1 to 3.3 with the bipolar form of the thesis, `Q = Rᵀ D S`, for comparison with the
//! placement. Only the first steps are drawn: near equal stretches it takes long to prove that a step of the
//! bipolar form is principal.
//! Takes the gallery with both models; gives one sheet.

use super::elastic::{self, Course};
use super::sheet::{Series, Subject, change, dashed, line, panel, sheet};
use crate::models::gallery::{Case, Gallery};
use crate::terminal::failure::Failure;
use clebsch::nalgebra::{Matrix3, Vector3};

/// The model and its case.
pub(super) const TEXT: &str = include_str!("../../../../models/elastic/pseudo-rigid.clebsch");
pub(super) const CASE: &str = include_str!("../../../../models/elastic/pseudo-rigid.toml");
pub(super) const MODEL: &str = "pseudo-rigid";
const NAME: &str = "thesis-figure-3-1";

/// Steps that are drawn.
const STEPS: u64 = 500;

/// The quantities of the bipolar form that are drawn, at every node.
struct Bipolar {
    /// Stretches, each continued through points where stretches are equal.
    stretches: [Series; 3],
    /// Their product.
    volume: Series,
    /// Momenta of R and S along the axes of the stretches.
    momenta: [[Series; 3]; 2],
    /// Kinetic energy of the edge that starts at the node, and the stored one at the node.
    forward: Series,
}

impl Bipolar {
    /// # Errors
    /// Usage, failed: as for a run.
    fn new(body: &Subject<'_>) -> Result<Self, Failure> {
        let record = body.generated()?;
        let three = |name: &str| -> [Series; 3] {
            let mut all = body.components(&record, name).into_iter();
            core::array::from_fn(|_| all.next().unwrap_or_default())
        };
        let stretches = three("D");
        let places = stretches[0]
            .iter()
            .zip(&stretches[1])
            .zip(&stretches[2])
            .map(|((a, b), c)| Vector3::new(a.1, b.1, c.1));
        let places: Vec<Vector3<f64>> = places.collect();
        let turns = |name: &str| elastic::matrices(body, &record, name);
        let (axes, others) = (turns("R"), turns("S"));
        let mut forward = Vec::new();
        for (k, pair) in places.windows(2).enumerate() {
            let [d, next] = pair else { continue };
            let turn = |all: &[Matrix3<f64>]| all[k + 1] * all[k].transpose();
            let kinetic = kinetic([turn(&axes), turn(&others)], d, next) / body.case.h.powi(2);
            forward.push((record.times[k], kinetic + elastic::stored(body, d)));
        }
        Ok(Self {
            volume: (record.times.iter().copied())
                .zip(places.iter().map(Vector3::product))
                .collect(),
            stretches,
            momenta: ["spatial_momentum_R", "spatial_momentum_S"].map(three),
            forward,
        })
    }
}

/// The kinetic energy of a step of (3.55) times the squared step: the rotations at both ends of the stretches, their
/// initial values, and their changes.
fn kinetic([omega, w]: [Matrix3<f64>; 2], start: &Vector3<f64>, end: &Vector3<f64>) -> f64 {
    let d = Matrix3::from_diagonal(start);
    let [left, right] = [omega, w].map(|turn| turn - Matrix3::identity());
    let turns = -2.0 * ((left + right) * d * d).trace();
    let both =
        (left.transpose() * d * w.transpose() * d).trace() + (d * right.transpose() * d).trace();
    turns + both + 0.5 * (end - start).norm_squared()
}

/// Stretches, volume, momenta and the forward energy by both.
pub(super) fn beside(gallery: &Gallery) -> Result<String, Failure> {
    let shortened = |body: &Subject<'_>| Case {
        steps: STEPS,
        ..body.case.clone()
    };
    let placed = Subject::new(gallery, elastic::MODEL, elastic::NAME)?;
    let first = shortened(&placed);
    let direct = Course::new(&placed.with(&first))?;
    let body = Subject::new(gallery, MODEL, NAME)?;
    let longer = shortened(&body);
    let body = body.with(&longer);
    let polar = Bipolar::new(&body)?;
    let lines = |names: [&'static str; 3], all: [Series; 3]| {
        let named = names.into_iter().zip(all).enumerate();
        named
            .map(|(i, (name, series))| line(name, i, series))
            .collect()
    };
    let scaled = |series: &Series| -> Series {
        let h = body.case.h;
        change(series)
            .into_iter()
            .map(|(t, x)| (t, h * h * x))
            .collect()
    };
    let [m, n] = polar.momenta;
    let panels = vec![
        panel(
            "stretches of the bipolar form, which pass through one another",
            "",
            lines(["D₁", "D₂", "D₃"], polar.stretches),
        ),
        panel(
            "stretches of the placement, which avoid one another",
            "",
            lines(["largest", "middle", "smallest"], direct.stretches),
        ),
        panel(
            "det Q, the ratio of volumes",
            "",
            vec![
                line("bipolar form", 0, polar.volume),
                dashed("placement", 1, direct.volume),
            ],
        ),
        panel(
            "angular momentum along the axes of the stretches, bipolar form",
            "",
            lines(["M₁", "M₂", "M₃"], m),
        ),
        panel(
            "circulation along the axes of the stretches, bipolar form",
            "",
            lines(["N₁", "N₂", "N₃"], n),
        ),
        panel(
            "h² (E − E(0)), kinetic energy of the edge before the node",
            "",
            vec![
                line("bipolar form", 0, scaled(&polar.forward)),
                dashed("placement", 1, scaled(&direct.forward)),
            ],
        ),
    ];
    let title = "Figures 3.1 to 3.3: bipolar form and placement, the first steps";
    sheet(title, &body, "", panels)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If the stretches agree, rotating both ends at equal rates changes nothing. The error of (3.55) is the
    /// fourth power of the angle.
    #[test]
    fn kinetic_energy_of_a_step() {
        let one = Vector3::new(1.0, 1.0, 1.0);
        let axis: Vector3<f64> = Vector3::new(0.1, -0.2, 0.3);
        let turn = *clebsch::nalgebra::Rotation3::new(axis).matrix();
        let fourth = axis.norm_squared().powi(2);
        let left = kinetic([turn, turn], &one, &one) / fourth;
        assert!((left - 1.0).abs() < 0.05, "{left}");
        // |Q' - Q|²/2 for Q = D S, if only S rotates. (3.55) is then exact.
        let d = Vector3::new(1.1, 0.9, 1.4);
        let q = Matrix3::from_diagonal(&d);
        let moved = (q * turn - q).norm_squared() / 2.0;
        let found = kinetic([Matrix3::identity(), turn], &d, &d);
        assert!((found - moved).abs() < 1e-14, "{found} {moved}");
    }

    /// Both forms agree to first order in the step size. Their volumes differ by less than 1e-4 (3e-4 after 200
    /// steps), a thousandth of the amplitude. The changes of h² times the energy differ by less than 1e-5.
    #[test]
    fn both_forms_are_the_same_motion() {
        let gallery = elastic::with_files(&Gallery::default()).expect("are read");
        let of = |model: &str, name: &str| {
            let body = Subject::new(&gallery, model, name).expect("the case");
            let case = Case {
                steps: 40,
                ..body.case.clone()
            };
            (body, case)
        };
        let (body, case) = of(MODEL, NAME);
        let polar = Bipolar::new(&body.with(&case)).expect("runs");
        let (body, case) = of(elastic::MODEL, elastic::NAME);
        let direct = Course::new(&body.with(&case)).expect("runs");
        let far = |a: &Series, b: &Series| {
            assert_eq!(a.len(), b.len());
            let pairs = a.iter().zip(b);
            pairs.fold(0.0, |far: f64, (x, y)| far.max((x.1 - y.1).abs()))
        };
        let off = far(&polar.volume, &direct.volume);
        assert!(off < 1e-4, "{off:e}");
        let [a, b] = [&polar.forward, &direct.forward].map(change);
        let off = far(&a, &b) * case.h * case.h;
        assert!(off < 1e-5, "{off:e}");
        let swing = far(&a, &vec![(0.0, 0.0); a.len()]) * case.h * case.h;
        assert!(swing > 1e-3, "{swing:e}");
    }
}
