//! Figures 2.5 to 2.8 (free body), 2.11 (heavy top), 2.12 to 2.14 (coupled bodies): momenta compared with exact
//! ones or ode45, Casimirs, energy, spatial momentum. Takes the gallery; gives SVG.

use super::sheet::{
    Series, Subject, change, dashed, difference, line, magnitudes, norm, panel, sheet,
};
use crate::models::gallery::Gallery;
use crate::terminal::failure::Failure;
use clebsch::record::Record;

const ODE45: &str = "ode45";

/// Figure 2.5.
pub(super) fn symmetric(gallery: &Gallery) -> Result<String, Failure> {
    errors(
        gallery,
        "Figure 2.5: symmetric free body, I = (2, 2, 1)",
        "figure-2-5",
        "figure-2-7",
    )
}

/// Figure 2.6.
pub(super) fn asymmetric(gallery: &Gallery) -> Result<String, Failure> {
    errors(
        gallery,
        "Figure 2.6: asymmetric free body, I = (3.5, 2.5, 2)",
        "figure-2-6",
        "figure-2-8",
    )
}

/// Errors of the body momentum, and Casimirs of both representations.
fn errors(
    gallery: &Gallery,
    title: &str,
    case: &str,
    spatial_case: &str,
) -> Result<String, Failure> {
    let body = Subject::new(gallery, "free-body", case)?;
    let space = Subject::new(gallery, "free-body-spatial", spatial_case)?;
    let [own, exact, ode45] = [body.generated()?, body.reference()?, body.ode45()?];
    let spatial = space.generated()?;
    let count = own.times.len();
    let mu = |subject: &Subject<'_>, record| subject.components(record, "body_momentum");
    let truth = mu(&body, &exact);
    let error = |components: Vec<Series>| -> Vec<Series> {
        components
            .iter()
            .zip(&truth)
            .map(|(a, b)| difference(a, b))
            .collect()
    };
    let kinds = [
        error(mu(&space, &spatial)),
        error(mu(&body, &own)),
        error(mu(&body, &ode45)),
    ];
    let mut panels = Vec::new();
    for (index, name) in ["M₁", "M₂", "M₃"].iter().enumerate() {
        let of = |kind: &Vec<Series>| kind.get(index).cloned().unwrap_or_default();
        let [spatial, body, ode45] = &kinds;
        panels.push(panel(
            &format!("{name} − {name}*, M* the exact body momentum"),
            "",
            vec![
                line("body", 0, of(body)),
                dashed("spatial", 1, of(spatial)),
                line(ODE45, 2, of(ode45)),
            ],
        ));
    }
    let squared =
        |kind: &[Series]| -> Series { norm(kind).into_iter().map(|(t, x)| (t, x * x)).collect() };
    let [spatial_error, body_error, ode_error] = &kinds;
    panels.push(panel(
        "|M − M*|²",
        "",
        vec![
            line("body", 0, squared(body_error)),
            dashed("spatial", 1, squared(spatial_error)),
            line(ODE45, 2, squared(ode_error)),
        ],
    ));
    let traces = ["trace_J1", "trace_J2", "trace_J3"].map(|name| {
        let one = space.invariant(&spatial, name).into_iter().next();
        let mut change = change(&one.unwrap_or_default());
        change.truncate(count);
        change
    });
    let [first, second, third] = traces;
    panels.push(magnitudes(
        "Casimirs, change since time 0: |M|² in the body, traces of the powers of J in space",
        "",
        vec![
            line("|M|², body", 0, change(&squared(&mu(&body, &own)))),
            line("|M|², ode45", 2, change(&squared(&mu(&body, &ode45)))),
            line("tr J", 1, first),
            line("tr J²", 3, second),
            line("tr J³", 4, third),
        ],
    ));
    sheet(title, &body, "", panels)
}

/// Figure 2.7.
pub(super) fn symmetric_drift(gallery: &Gallery) -> Result<String, Failure> {
    drifts(gallery, "Figure 2.7: drift, I = (2, 2, 1)", "figure-2-7")
}

/// Figure 2.8.
pub(super) fn asymmetric_drift(gallery: &Gallery) -> Result<String, Failure> {
    drifts(
        gallery,
        "Figure 2.8: drift, I = (3.5, 2.5, 2)",
        "figure-2-8",
    )
}

/// Energy and spatial momentum of both representations over 10000 steps.
fn drifts(gallery: &Gallery, title: &str, case: &str) -> Result<String, Failure> {
    let body = Subject::new(gallery, "free-body", case)?;
    let space = Subject::new(gallery, "free-body-spatial", case)?;
    let runs = [
        (&body, body.generated()?),
        (&space, space.generated()?),
        (&body, body.ode45()?),
    ];
    let energy = runs.each_ref().map(|(subject, record)| {
        let energy = subject
            .invariant(record, "energy")
            .into_iter()
            .next()
            .unwrap_or_default();
        let first = energy.first().map_or(1.0, |point| point.1);
        change(&energy)
            .into_iter()
            .map(|(t, x)| (t, x / first))
            .collect()
    });
    let momentum = runs.each_ref().map(|(subject, record)| {
        // The product of attitude and body momentum depends on the attitude, unlike the stored constant.
        let r = subject.components(record, "Lambda");
        let mu = subject.components(record, "body_momentum");
        let turned: Vec<Series> = (0..3).map(|row| change(&product(&r, &mu, row))).collect();
        norm(&turned)
    });
    let lines = |values: [Series; 3]| {
        let [body, space, ode] = values;
        vec![
            line("body", 0, body),
            line("spatial", 1, space),
            line(ODE45, 2, ode),
        ]
    };
    let panels = vec![
        magnitudes("|E − E(0)| / E(0)", "", lines(energy)),
        magnitudes(
            "|m − m(0)|, m = Λ M with both from the method",
            "",
            lines(momentum),
        ),
    ];
    sheet(title, &body, "", panels)
}

/// Row `row` of a matrix, given by its nine components, times a vector.
fn product(matrix: &[Series], vector: &[Series], row: usize) -> Series {
    let at = |series: Option<&Series>, i: usize| {
        series
            .and_then(|s| s.get(i))
            .map_or(f64::NAN, |point| point.1)
    };
    let times = vector.first().map_or(&[][..], |first| first);
    let value = |i: usize| -> f64 {
        (0..3)
            .map(|k| at(matrix.get(3 * row + k), i) * at(vector.get(k), i))
            .sum()
    };
    times
        .iter()
        .enumerate()
        .map(|(i, (t, _))| (*t, value(i)))
        .collect()
}

/// Figure 2.11.
pub(super) fn heavy_top(gallery: &Gallery) -> Result<String, Failure> {
    let top = Subject::new(gallery, "heavy-top", "figure-2-11")?;
    let [own, ode45] = [top.generated()?, top.ode45()?];
    let of = |record, index| top.observable(record, "body_momentum", index);
    let both = |index| {
        vec![
            line("generated", 0, of(&own, index)),
            dashed(ODE45, 2, of(&ode45, index)),
        ]
    };
    let casimir = |record| {
        let one = top.invariant(record, "momentum_Gamma").into_iter().next();
        change(&one.unwrap_or_default())
    };
    let panels = vec![
        panel("M₁", "", both(0)),
        panel("M₂", "", both(1)),
        magnitudes(
            "|M₃ − M₃(0)|",
            "",
            vec![
                line("generated", 0, change(&of(&own, 2))),
                line(ODE45, 2, change(&of(&ode45, 2))),
            ],
        ),
        magnitudes(
            "|M·Γ − M(0)·Γ(0)|",
            "",
            vec![
                line("generated", 0, casimir(&own)),
                line(ODE45, 2, casimir(&ode45)),
            ],
        ),
    ];
    sheet("Figure 2.11: heavy top, I = (2, 2, 1)", &top, "", panels)
}

/// Figure 2.12.
pub(super) fn coupled_momenta(gallery: &Gallery) -> Result<String, Failure> {
    let pair = Subject::new(gallery, "coupled-bodies", "figure-2-12")?;
    let own = pair.generated()?;
    let panels = (0..3).map(|index| {
        let of = |body: &str| pair.observable(&own, &format!("body_momentum_Lambda{body}"), index);
        panel(
            ["M₁", "M₂", "M₃"].get(index).copied().unwrap_or_default(),
            "",
            vec![line("body 1", 0, of("1")), line("body 2", 1, of("2"))],
        )
    });
    let title = "Figure 2.12: coupled bodies at right angles, each in its own axes";
    sheet(title, &pair, "", panels.collect())
}

/// Figure 2.13.
pub(super) fn coupled_difference(gallery: &Gallery) -> Result<String, Failure> {
    let pair = Subject::new(gallery, "coupled-bodies", "figure-2-13")?;
    let [own, ode45] = [pair.generated()?, pair.ode45()?];
    let mut panels: Vec<_> = Vec::new();
    for index in 0..3 {
        let of = |record| pair.observable(record, "body_momentum_Lambda1", index);
        let name = ["M₁", "M₂", "M₃"].get(index).copied().unwrap_or_default();
        panels.push(panel(
            &format!("{name} of body 1, generated minus ode45"),
            "",
            vec![line("", 0, difference(&of(&own), &of(&ode45)))],
        ));
    }
    // Equal bodies in equal states stay equal until rounding errors have grown, since the motion is unstable.
    let apart = |record: &Record| {
        let one = pair.components(record, "body_momentum_Lambda1");
        let two = pair.components(record, "body_momentum_Lambda2");
        norm(
            &one.iter()
                .zip(&two)
                .map(|(a, b)| difference(a, b))
                .collect::<Vec<_>>(),
        )
    };
    panels.push(magnitudes(
        "|M of body 1 − M of body 2|, zero by exchange symmetry",
        "",
        vec![
            line("generated", 0, apart(&own)),
            line(ODE45, 2, apart(&ode45)),
        ],
    ));
    let title = "Figure 2.13: coupled bodies, initially aligned";
    sheet(title, &pair, "", panels)
}

/// Figure 2.14.
pub(super) fn coupled_drift(gallery: &Gallery) -> Result<String, Failure> {
    let pair = Subject::new(gallery, "coupled-bodies", "figure-2-14")?;
    let records = [pair.generated()?, pair.ode45()?];
    let total = |record: &Record| {
        let spatial = |body: &str| {
            let r = pair.components(record, &format!("Lambda{body}"));
            let mu = pair.components(record, &format!("body_momentum_Lambda{body}"));
            [0, 1, 2].map(|row| product(&r, &mu, row))
        };
        let [one, two] = [spatial("1"), spatial("2")];
        let sum = |(a, b): (&Series, &Series)| -> Series {
            a.iter().zip(b).map(|(x, y)| (x.0, x.1 + y.1)).collect()
        };
        one.iter().zip(&two).map(sum).collect::<Vec<Series>>()
    };
    // |M₁ + R M₂|, in the axes of body 1, is the length of the total spatial momentum.
    let casimir = |record: &Record| {
        let squares: Series = norm(&total(record))
            .into_iter()
            .map(|(t, x)| (t, x * x))
            .collect();
        change(&squares)
    };
    let energy = |record: &Record| {
        let one = pair.invariant(record, "energy").into_iter().next();
        change(&one.unwrap_or_default())
    };
    let momentum = |record: &Record| norm(&total(record).iter().map(change).collect::<Vec<_>>());
    let [own, ode] = &records;
    let both = |of: &dyn Fn(&Record) -> Series| {
        vec![line("generated", 0, of(own)), line(ODE45, 2, of(ode))]
    };
    let panels = vec![
        magnitudes(
            "Casimir |M₁ + R M₂|², change since time 0",
            "",
            both(&casimir),
        ),
        magnitudes("|E − E(0)|", "", both(&energy)),
        magnitudes("|m − m(0)|, total spatial momentum", "", both(&momentum)),
    ];
    sheet(
        "Figure 2.14: drift of coupled bodies at right angles",
        &pair,
        "",
        panels,
    )
}
