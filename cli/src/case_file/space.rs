//! The domain of a fluid: the tables `[domain]` and `[labels]` of a case. Takes the tables; gives lengths,
//! walls and cells, or an error.

use super::location::File;
use super::scope::Scope;
use super::stated::Stated;
use crate::terminal::failure::Failure;
use clebsch::mesh::{Domain, Nodes, Setting, Wall};
use clebsch_core::syntax::ast::Extent;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The domain of a fluid, in one or two dimensions, with its grid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Space {
    /// Lengths along each direction.
    pub lengths: Vec<f64>,
    /// Whether each direction has walls.
    pub walls: Vec<bool>,
    /// Cells of the grid, if the model has a grid.
    pub cells: Option<Vec<usize>>,
}

impl Space {
    /// The number of dimensions of a fluid; `None` for other models.
    pub(crate) fn dimensions(stated: &Stated) -> Option<usize> {
        let own = stated.lattice.places()?;
        own.shape.components().filter(|n| *n <= 2)
    }

    /// The unit square or interval without walls, with a grid of eight cells along each direction.
    pub(crate) fn sample(stated: &Stated) -> Option<Space> {
        let d = Space::dimensions(stated)?;
        let has_grid = stated.lattice.grid().is_some();
        Some(Space {
            lengths: vec![1.0; d],
            walls: vec![false; d],
            cells: has_grid.then(|| vec![8; d]),
        })
    }

    /// The name of the lengths of a torus; `None` for a box.
    pub(crate) fn torus(stated: &Stated) -> Option<&str> {
        match &stated.lattice.places()?.domain {
            Some(Extent::Torus(lengths)) => Some(lengths.text.as_str()),
            _ => None,
        }
    }

    /// Reads the domain of a case; `None` if the model is not a fluid.
    pub(super) fn read(
        file: &File<'_>,
        top: &DeTable<'_>,
        stated: &Stated,
    ) -> Result<Option<Space>, Failure> {
        let Some(d) = Space::dimensions(stated) else {
            return Ok(None);
        };
        let torus = Space::torus(stated);
        let example = match (torus, d) {
            (Some(name), 1) => format!("[domain] with {name} = [1.0]"),
            (Some(name), _) => format!("[domain] with {name} = [1.0, 1.0]"),
            (None, 1) => "[domain] with lengths = [1.0] and walls = [\"solid\"]".to_owned(),
            (None, _) => "[domain] with lengths = [1.0, 1.0] and walls = [\"solid\", \"periodic\"]"
                .to_owned(),
        };
        let Some(table) = file.table(top, "domain")? else {
            let message = format!("missing table [domain] of the particles: for example {example}");
            return Err(file.wrong(None, &message));
        };
        let keys = ["lengths", torus.unwrap_or("lengths"), "walls", "kind"];
        for (key, _) in table {
            let asked = key.get_ref().as_ref();
            if !keys.contains(&asked) {
                let message = format!("unknown key `domain.{asked}`; write for example {example}");
                return Err(file.wrong(Some(&key.span()), &message));
            }
        }
        let stated_lengths = table.get(torus.unwrap_or("lengths"));
        let Some(value) = stated_lengths.or_else(|| table.get("lengths")) else {
            let message = format!("missing key `domain.lengths`: write for example {example}");
            return Err(file.wrong(None, &message));
        };
        let wrong = |value: &Spanned<DeValue<'_>>, key: &str, message: &str| {
            file.wrong(Some(&value.span()), &format!("domain.{key}: {message}"))
        };
        let scope = Scope::of(top);
        let lengths = listed(value.get_ref(), d, |v| {
            scope.read(v).ok().filter(|x| *x > 0.0)
        });
        let lengths = lengths.ok_or_else(|| {
            wrong(
                value,
                "lengths",
                &match d {
                    1 => "expected a list of one positive number".to_owned(),
                    _ => format!("expected {d} positive numbers, one for each direction"),
                },
            )
        })?;
        let walls = walls(table, d, torus.is_some(), &wrong, &example)?;
        Ok(Some(Space {
            lengths,
            walls,
            cells: cells(file, top, stated, d)?,
        }))
    }

    /// Length, area.
    pub(crate) fn measure(&self) -> f64 {
        self.lengths.iter().product()
    }

    /// The positions of nodes and their weights in the trapezoid rule.
    pub(crate) fn nodes(&self) -> Result<(Vec<Vec<f64>>, Vec<f64>), String> {
        let wall = |solid: bool| match solid {
            true => Wall::Solid,
            false => Wall::Periodic,
        };
        let cells = self.cells.clone().unwrap_or_default();
        match (&self.lengths[..], &self.walls[..], &cells[..]) {
            ([length], [solid], [n]) => of_nodes(Setting {
                domain: Domain {
                    lengths: [*length],
                    walls: [wall(*solid)],
                },
                grid: Some([*n]),
                particles: 0,
            }),
            ([width, height], [a, b], [n, m]) => of_nodes(Setting {
                domain: Domain {
                    lengths: [*width, *height],
                    walls: [wall(*a), wall(*b)],
                },
                grid: Some([*n, *m]),
                particles: 0,
            }),
            _ => Err("the model has no grid".to_owned()),
        }
    }

    /// How many nodes the grid has.
    pub(crate) fn count(&self) -> usize {
        let cells = self.cells.iter().flatten().zip(&self.walls);
        cells
            .map(|(n, wall)| n.saturating_add(usize::from(*wall)))
            .fold(1, usize::saturating_mul)
    }

    /// The numbers of the parameter that the model needs: the lengths of a torus, the lengths and walls of a box.
    pub(crate) fn numbers(&self, is_box: bool) -> Vec<f64> {
        let walls = self.walls.iter().map(|w| f64::from(u8::from(*w)));
        let lengths = self.lengths.iter().copied();
        match is_box {
            true => lengths.chain(walls).collect(),
            false => lengths.collect(),
        }
    }
}

type Placed = (Vec<Vec<f64>>, Vec<f64>);

fn of_nodes<const D: usize>(setting: Setting<D>) -> Result<Placed, String> {
    let nodes = Nodes::new(&setting).map_err(|e| e.to_string())?;
    let places = nodes.places().iter().map(|x| x.to_vec()).collect();
    Ok((places, nodes.weights()))
}

/// A list with `d` elements. In one dimension a single value may replace the list.
fn listed<V>(
    value: &DeValue<'_>,
    d: usize,
    one: impl Fn(&DeValue<'_>) -> Option<V>,
) -> Option<Vec<V>> {
    match value {
        DeValue::Array(list) if list.len() == d => list.iter().map(|v| one(v.get_ref())).collect(),
        DeValue::Array(_) => None,
        single if d == 1 => Some(vec![one(single)?]),
        _ => None,
    }
}

type Wrong<'a> = dyn Fn(&Spanned<DeValue<'_>>, &str, &str) -> Failure + 'a;

/// `walls = ["solid", "periodic"]`, or `kind = "torus"`, `"channel"`, `"basin"`.
fn walls(
    table: &DeTable<'_>,
    d: usize,
    is_torus: bool,
    wrong: &Wrong<'_>,
    example: &str,
) -> Result<Vec<bool>, Failure> {
    let found = match (table.get("walls"), table.get("kind")) {
        (Some(value), _) => {
            let walls = listed(value.get_ref(), d, |v| match v.as_str()? {
                "solid" => Some(true),
                "periodic" => Some(false),
                _ => None,
            });
            let message = format!("expected \"solid\" or \"periodic\" for each of {d} directions");
            Some((
                value,
                "walls",
                walls.ok_or_else(|| wrong(value, "walls", &message))?,
            ))
        }
        (None, Some(value)) => {
            let walls = match value.get_ref().as_str() {
                Some("torus") => vec![false; d],
                Some("basin") => vec![true; d],
                Some("channel") if d == 2 => vec![true, false],
                _ => {
                    let message = "expected \"torus\", \"basin\", or in two dimensions \"channel\", with walls across the \
                        first direction";
                    return Err(wrong(value, "kind", message));
                }
            };
            Some((value, "kind", walls))
        }
        (None, None) => None,
    };
    match found {
        Some((value, key, walls)) if is_torus && walls.contains(&true) => Err(wrong(
            value,
            key,
            "the model is declared on a torus, which has no walls",
        )),
        Some((.., walls)) => Ok(walls),
        None if is_torus => Ok(vec![false; d]),
        None => {
            let lengths = table.get("lengths");
            let message = format!("missing key `domain.walls`: write for example {example}");
            Err(match lengths {
                Some(value) => wrong(value, "walls", &message),
                None => Failure::Usage(message),
            })
        }
    }
}

/// `n = [32, 32]` of the table `[labels]`.
fn cells(
    file: &File<'_>,
    top: &DeTable<'_>,
    stated: &Stated,
    d: usize,
) -> Result<Option<Vec<usize>>, Failure> {
    let Some(grid) = stated.lattice.grid() else {
        return Ok(None);
    };
    let name = &grid.index.text;
    let example = if d == 1 { "32" } else { "[32, 32]" };
    let labels = file.table(top, "labels")?;
    let Some(value) = labels.and_then(|t| t.get(name.as_str())) else {
        let message = format!(
            "missing key `labels.{name}`, the cells of the grid along each direction: for example {name} = {example}"
        );
        return Err(file.wrong(None, &message));
    };
    let scope = Scope::of(top);
    let whole = |v: &DeValue<'_>| {
        let count = scope.whole(v).ok().flatten().filter(|n| *n > 0);
        count.and_then(|n| usize::try_from(n).ok())
    };
    match listed(value.get_ref(), d, whole) {
        Some(cells) => Ok(Some(cells)),
        None => Err(file.wrong(
            Some(&value.span()),
            &format!(
                "labels.{name}: expected whole numbers of cells, one for each direction: {example}"
            ),
        )),
    }
}
