//! Fluids among the runs: the domain of their particles, and the field that colours them. Takes a card and a
//! plan.

use super::sites::AtSites;
use crate::case_file::space::Space;
use crate::case_file::stated::Stated;
use crate::plan::Plan;
use clebsch::card::Card;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::Source;
use clebsch_core::syntax::ast::Statement;

/// The field whose values colour the particles of a fluid.
pub(crate) struct Coloured<'a> {
    pub(crate) space: Space,
    /// The positions of its particles.
    pub(crate) places: &'a AtSites<'a>,
    /// Its functional, at the particles or at the nodes of a grid.
    pub(crate) shown: &'a AtSites<'a>,
    /// Its definition: `S = smooth(H, α)`.
    pub(crate) what: String,
}

impl<'a> Coloured<'a> {
    /// The functional of a fluid that is not the argument of another functional. `None` if the model is not a
    /// fluid.
    pub(crate) fn of(card: &Card, plan: &Plan, all: &'a [AtSites<'a>]) -> Option<Self> {
        let (space, stated) = space(card, plan)?;
        let own = ascii(&stated.lattice.places()?.name.text);
        let places = all.iter().find(|s| s.key == own)?;
        // If the depth is smoothed, the smoothed depth drives the fluid, not the depth from which it is
        // computed.
        let meshes = &stated.lattice.meshes;
        let taken = |at: usize| meshes.iter().any(|m| m.of == Source::Functional(at));
        let last = meshes.iter().enumerate().filter(|(at, _)| !taken(*at));
        let mut last = last.map(|(_, m)| m.name.text.as_str());
        let (name, shown) = last.find_map(|name| {
            let key = ascii(name);
            Some((name, all.iter().find(|s| s.key == key)?))
        })?;
        let made = stated.model.statements.iter().find_map(|s| match s {
            Statement::Mesh {
                name: own,
                path,
                arguments,
                ..
            } if own.text == name => {
                let arguments: Vec<&str> = arguments.iter().map(|a| a.text.as_str()).collect();
                Some(format!("{name} = {}({})", path.text, arguments.join(", ")))
            }
            _ => None,
        });
        Some(Coloured {
            space,
            places,
            shown,
            what: made.unwrap_or_else(|| name.to_owned()),
        })
    }
}

/// The domain of the particles of a run.
pub(crate) fn space(card: &Card, plan: &Plan) -> Option<(Space, Stated)> {
    let stated = Stated::read(card.source)?;
    let sample = Space::sample(&stated)?;
    let d = sample.lengths.len();
    let of = |key: &str| {
        let at = card.parameters.iter().position(|f| f.ascii == key)?;
        plan.case.parameters.get(at).cloned()
    };
    let torus = Space::torus(&stated).map(ascii);
    let own = of(torus.as_deref().unwrap_or("domain"))?;
    let grid = stated.lattice.grid();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let cells = grid.and_then(|l| of(&ascii(&l.index.text)));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let cells = cells.map(|n| n.iter().map(|x| *x as usize).collect());
    let walls = own.get(d..).unwrap_or_default().iter().map(|w| *w != 0.0);
    let mut walls: Vec<bool> = walls.collect();
    walls.resize(d, false);
    let lengths = own.get(..d)?.to_vec();
    let space = Space {
        lengths,
        walls,
        cells,
    };
    Some((space, stated))
}
