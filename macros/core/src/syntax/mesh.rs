//! Parses `mesh`, the declaration of a functional of all sites, and `on` after a field of positions. A smoother
//! without a length uses `alpha`.

use super::ast::{Extent, Model, Name, SizedName, Statement};
use super::label;
use super::statement::{kindred, path_goes_on};
use super::token::Cursor;
use crate::diagnostic::Diagnostic;

/// `A: Real at a = voronoi_area(X)`.
pub(super) fn mesh(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let remedy = "write a functional of all sites as `mesh A: Real at a = voronoi_area(X);`: its name, its sites, its function \
        and the arguments";
    let name = c
        .name("the name of the functional")
        .map_err(|e| e.help(remedy))?;
    c.punct(':').map_err(|e| e.help(remedy))?;
    let shape = kindred(c)?;
    let at = label::at(c)?;
    c.punct('=').map_err(|e| e.help(remedy))?;
    let mut path = c
        .name("the name or path of a function, such as `voronoi_area`")
        .map_err(|e| e.help(remedy))?;
    path_goes_on(c, &mut path)?;
    c.delimiter('(').map_err(|e| e.help(remedy))?;
    let what = "the name of a field, a functional or a parameter";
    let mut arguments = vec![c.name(what).map_err(|e| e.help(remedy))?];
    while c.take_punct(',') {
        arguments.push(c.name(what).map_err(|e| e.help(remedy))?);
    }
    c.delimiter(')')
        .map_err(|e| e.help("arguments are names: declare a parameter for an expression"))?;
    Ok(Statement::Mesh {
        name,
        shape,
        at,
        path,
        arguments,
    })
}

/// The length of a smoother that names none.
const LENGTH: &str = "alpha";

/// Adds the argument `alpha` to smoothers without a length. It is a parameter of the model, added unless the model
/// declares one.
pub(super) fn with_lengths(mut model: Model) -> Model {
    let mut asked = None;
    for s in &mut model.statements {
        if let Statement::Mesh {
            path, arguments, ..
        } = s
            && matches!(path.text.as_str(), "smooth" | "smooth_isotropic")
            && arguments.len() == 1
        {
            asked = Some(path.place);
            arguments.push(Name {
                text: LENGTH.to_owned(),
                place: path.place,
                typeset: None,
                is_copy: false,
            });
        }
    }
    let mut names = model.statements.iter().flat_map(Statement::declared);
    let known = names.any(|n| n.text == LENGTH);
    if let Some(place) = asked.filter(|_| !known) {
        let name = Name {
            text: LENGTH.to_owned(),
            place,
            typeset: None,
            is_copy: false,
        };
        let length = Statement::Param {
            names: vec![name],
            shape: SizedName::number(place),
            at: None,
        };
        model.statements.insert(0, length);
        let remark = " smoothing length of the depth".to_owned();
        model.remarks.insert(0, vec![remark]);
    }
    model
}

/// `on torus(L)`, `on box`, if it comes next.
pub(super) fn extent(c: &mut Cursor) -> Result<Option<Extent>, Diagnostic> {
    if !c.take_word("on") {
        return Ok(None);
    }
    let remedy = "write `on torus(L)`, where `L` is the vector of its side lengths, or `on box`, whose lengths and walls the \
        case gives";
    let place = c.place();
    if c.take_word("box") {
        return Ok(Some(Extent::Box(place)));
    }
    c.word("torus").map_err(|e| e.help(remedy))?;
    c.delimiter('(').map_err(|e| e.help(remedy))?;
    let lengths = c
        .name("the name of the side lengths of the torus")
        .map_err(|e| e.help(remedy))?;
    c.delimiter(')').map_err(|e| e.help(remedy))?;
    Ok(Some(Extent::Torus(lengths)))
}
