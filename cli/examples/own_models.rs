//! A command line of one's own: a model stated here, with its cases, under the commands of `clebsch`.

use clebsch_cli::gallery::{Case, Citations, Entry, Gallery};
use std::process::ExitCode;

clebsch::model! {
    /// Rigid body whose axis is drawn to a direction in space.
    pub model Compass {
        param J: Sym<3>;                     // second moments of mass
        param a: Vec<3>;                     // axis, body frame
        param b: Vec<3>;                     // direction and strength of the field, space frame
        group R: SO<3> velocity W;
        advected B: Vec<3> = R^T * b;        // field, body frame
        constraint next(R) = R * W;
        constraint next(B) = W^T * B;
        lagrangian = -tr(J*W)/h + h*dot(a, B);
    }
}

/// The models of this command line, each with its cases.
pub fn gallery() -> Gallery {
    let swinging = Case {
        name: "swinging".to_owned(),
        doc: "set going at an angle to the field".to_owned(),
        h: 0.05,
        steps: 2000,
        // In the order of the statement, matrices row by row.
        parameters: vec![
            vec![1.0, 0.0, 0.0, 0.0, 1.2, 0.0, 0.0, 0.0, 0.4],
            vec![0.0, 0.0, 1.0],
            vec![0.6, 0.0, 0.8],
        ],
        // The attitude and the body momentum at node 0.
        initial: vec![
            vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            vec![0.0, 0.1, 0.2],
        ],
        bounds: vec![("energy".to_owned(), 1e-2)],
    };
    Gallery {
        entries: vec![Entry {
            card: Compass::CARD,
            citations: Citations::NONE,
            cases: vec![swinging],
        }],
        ..Gallery::default()
    }
}

fn main() -> ExitCode {
    clebsch_cli::run_process_on(&gallery())
}
