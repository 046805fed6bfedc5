//! Parses the model and its statements, with one function for each keyword. A faulty statement is reported and
//! skipped up to its `;`, so that one run reports every mistake.

use super::ast::{Comparison, Expression, Model, Name, NodeRule, Size, SizedName, Statement};
use super::called;
use super::circle;
use super::expression::expression;
use super::formula;
use super::label;
use super::library;
use super::mesh;
use super::token::{Cursor, SIZES, Token};
use super::typeset::typeset;
use super::unknown;
use crate::diagnostic::{Diagnostic, Errors, Place, closest};

/// Parses a whole model.
pub fn model(c: &mut Cursor) -> Result<Model, Errors> {
    let docs = attributes(c)?;
    let public = visibility(c);
    c.word("model").map_err(|e| {
        e.help("start with `model NAME {`, or with `pub model NAME {` to export the model")
    })?;
    let name = c
        .name("the name of the model")
        .map_err(|e| e.help("write for example `model HeavyTop {`"))?;
    c.delimiter('{')?;
    let mut errors = Errors::new();
    let (mut statements, mut remarks) = (Vec::new(), Vec::new());
    while !c.take_delimiter('}') {
        if c.is_at_end() {
            errors.push(c.unexpected("`}`"));
            break;
        }
        if c.take_punct(';') {
            continue;
        }
        let start = c.position();
        match attributes(c).and_then(|docs| Ok((docs, statement(c)?))) {
            Ok((docs, stated)) => {
                remarks.push(docs);
                statements.push(stated);
            }
            Err(e) => {
                errors.push(e);
                // Directly after a block there is nothing to skip.
                if c.position() == start || !c.follows_block() {
                    skip_statement(c);
                }
            }
        }
    }
    if !c.is_at_end() {
        errors.push(c.unexpected("the end of the model").help(
            "a file or a `model! { ... }` contains one model: put the other model into its own",
        ));
    }
    errors.propagate()?;
    let stated = Model {
        docs,
        public,
        name,
        statements,
        remarks,
    };
    let stated = super::mesh::with_lengths(stated);
    called::written_out(stated).map(circle::named)
}

/// Parses documentation lines; other attributes are errors.
fn attributes(c: &mut Cursor) -> Result<Vec<String>, Diagnostic> {
    let mut docs = Vec::new();
    while c.is_punct('#') {
        let start = c.place();
        c.advance();
        c.delimiter('[')
            .map_err(|e| e.help("write a comment after `//`, documentation after `///`"))?;
        if !c.take_word("doc") {
            return Err(Diagnostic::new(
                start.to(c.place()),
                "only documentation (`/// ...`) may precede a model or a statement",
            )
            .help("put other attributes on the items of your own crate"));
        }
        c.punct('=')?;
        if let Some(Token::Literal(text)) = c.peek() {
            docs.push(unquoted(text));
            c.advance();
        }
        c.delimiter(']')?;
    }
    Ok(docs)
}

/// The text of a documentation string literal.
pub(super) fn unquoted(literal: &str) -> String {
    let body = literal.trim_start_matches('r').trim_matches('#');
    let body = body.strip_prefix('"').unwrap_or(body);
    let body = body.strip_suffix('"').unwrap_or(body);
    let body = body.replace(super::text::BACKSLASH, "\\");
    let mut out = String::new();
    let mut chars = body.chars();
    while let Some(ch) = chars.next() {
        if ch != '\\' || literal.starts_with('r') {
            out.push(ch);
            continue;
        }
        match chars.next() {
            Some('n') => out.push('\n'),
            Some('t') => out.push('\t'),
            Some(other) => out.push(other),
            None => {}
        }
    }
    out
}

fn visibility(c: &mut Cursor) -> bool {
    c.take_word("pub")
}

/// Skips to the end of a faulty statement.
fn skip_statement(c: &mut Cursor) {
    let mut depth = 0u32;
    while let Some(token) = c.peek() {
        match token {
            Token::Open(_) => depth += 1,
            Token::Close('}') if depth == 0 => return,
            Token::Close(_) => depth = depth.saturating_sub(1),
            Token::Punct(';', _) if depth == 0 => {
                c.advance();
                return;
            }
            Token::Name(_)
            | Token::Number(_)
            | Token::Glued(..)
            | Token::Literal(_)
            | Token::Punct(..) => {}
        }
        c.advance();
    }
}

fn statement(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let keyword = c.name("a statement").map_err(|e| unknown::no_start(c, e))?;
    let parsed = match keyword.text.as_str() {
        "dim" => dim(c)?,
        "time" => time(c)?,
        "param" => param(c)?,
        "assume" => assume(c)?,
        "group" => group(c)?,
        "field" => field(c)?,
        "advected" => advected(c)?,
        "constraint" => constraint(c, &keyword)?,
        "let" => binding(c)?,
        "hold" => hold(c)?,
        "given" => given(c)?,
        "scale" => Statement::Scale(expression(c)?),
        "node" => node(c)?,
        "label" => label::label(c)?,
        "periodic" => Statement::Periodic(keyword.place),
        "end" => return label::end(c),
        "lagrangian" => {
            c.punct('=')?;
            Statement::Lagrangian(expression(c)?)
        }
        "grid" => Statement::Grid(c.name("the name of the grid")?),
        "mesh" => mesh::mesh(c)?,
        "linear" | "integrate" => {
            return Err(Diagnostic::new(
                keyword.place,
                format!(
                    "`{}` is not a statement: write kinetic terms with `next(X) - X`, and linear functionals as `mesh` \
                     statements",
                    keyword.text
                ),
            )
            .help("clebsch derives models with `label`, `grid`, `group`, `field`, `mesh`, `advected`, `constraint`, `hold` and \
                `lagrangian`"));
        }
        _ => return Err(unknown::statement(c, &keyword)),
    };
    c.punct(';')?;
    Ok(parsed)
}

fn dim(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let name = c.name("the name of a dimension")?;
    let example = "write for example `dim n in 3..=8;`";
    c.word("in").map_err(|e| e.help(example))?;
    let start = c.place();
    let from = c.whole_number().map_err(|e| e.help(example))?;
    for _ in 0..2 {
        c.punct('.').map_err(|e| e.help(example))?;
    }
    let closed = c.take_punct('=');
    let to = c.whole_number().map_err(|e| e.help(example))?;
    let written = start.to(c.last_place());
    let dots = if closed { "..=" } else { ".." };
    if from > to {
        let message = format!("the range {from}{dots}{to} runs backwards: it contains no size");
        return Err(
            Diagnostic::new(written, message).help(match to < 2 || from > 64 {
                true => example.to_owned(),
                false => format!(
                    "write the smaller size first: `dim {} in {to}..={from};`",
                    name.text
                ),
            }),
        );
    }
    if !closed {
        let message =
            "the range of a dimension includes its last size, so it is written with `..=`";
        return Err(Diagnostic::new(written, message)
            .help(format!("write `dim {} in {from}..={to};`", name.text)));
    }
    if from < 2 || to > 64 {
        return Err(Diagnostic::new(
            written,
            format!("a dimension ranges between 2 and 64, not {from}..={to}"),
        )
        .help(example));
    }
    Ok(Statement::Dim { name, from, to })
}

fn time(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let index = c.name("the name of the time index")?;
    c.word("step")?;
    let step = c.name("the name of the time step")?;
    Ok(Statement::Time { index, step })
}

pub(super) fn names(c: &mut Cursor) -> Result<Vec<Name>, Diagnostic> {
    let mut list = vec![c.name("a name")?];
    while c.take_punct(',') {
        list.push(c.name("a name")?);
    }
    Ok(list)
}

/// `Real`, `Vec<3>`, `SO<n>`, `Mat<3, 2>`.
pub(super) fn kindred(c: &mut Cursor) -> Result<SizedName, Diagnostic> {
    let name = c.name("a shape such as Real, Vec<3> or Sym<3>")?;
    let mut sizes = Vec::new();
    if c.take_punct('<') {
        loop {
            let place = c.place();
            sizes.push(match c.peek() {
                Some(Token::Number(_)) => Size::Number(c.whole_number()?, place),
                _ => Size::Name(c.name("a size")?),
            });
            if !c.take_punct(',') {
                break;
            }
        }
        c.punct('>')?;
    }
    let place = name.place.to(c.last_place());
    Ok(SizedName { name, sizes, place })
}

/// The `:` between names and their shape.
fn shape_follows(c: &mut Cursor) -> Result<(), Diagnostic> {
    c.punct(':').map_err(|e| match c.peek() {
        Some(Token::Name(_)) => {
            e.help("separate names by commas, and put `:` before their shape: `param a, b: Real;`")
        }
        _ => e,
    })
}

fn param(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let mut names = names(c)?;
    shape_follows(c)?;
    let shape = kindred(c)?;
    typeset(c, &mut names)?;
    let at = label::at(c)?;
    Ok(Statement::Param { names, shape, at })
}

fn field(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let mut names = names(c)?;
    shape_follows(c)?;
    let shape = kindred(c)?;
    typeset(c, &mut names)?;
    let at = label::at(c)?;
    let offset = match c.take_word("offset") {
        true => Some(c.name("the name of the offset that the field gains once around a ring")?),
        false => None,
    };
    let domain = mesh::extent(c)?;
    let place = c.place();
    if c.take_word("velocity") {
        return Err(Diagnostic::new(
            place,
            "the velocity of a field has no name: it is the increment `next(X) - X`",
        )
        .help("remove `velocity ...`, and write the kinetic term with `next`, for example `m*dot(next(X) - X, next(X) - \
            X)/(2*h)`"));
    }
    Ok(Statement::Field {
        names,
        shape,
        at,
        offset,
        domain,
    })
}

fn assume(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let left = expression(c)?;
    let equal = |c: &mut Cursor| c.take_punct('=');
    let relation = if c.take_punct('>') {
        if equal(c) {
            Comparison::AtLeast
        } else {
            Comparison::Greater
        }
    } else if c.take_punct('<') {
        if equal(c) {
            Comparison::AtMost
        } else {
            Comparison::Less
        }
    } else if c.is_punct('=') {
        let start = c.place();
        c.advance();
        if let Some(sign) = ['>', '<'].into_iter().find(|sign| c.take_punct(*sign)) {
            let place = start.to(c.last_place());
            let message = format!("`={sign}` is not a comparison: the operator is `{sign}=`");
            return Err(Diagnostic::new(place, message).help(format!("write `{sign}=`")));
        }
        c.take_punct('=');
        Comparison::Equal
    } else {
        return Err(c
            .unexpected("`==`, `>`, `>=`, `<` or `<=`")
            .help("write for example `assume dot(z, z) == 1;`"));
    };
    let right = expression(c)?;
    if c.is_punct('<') || c.is_punct('>') {
        return Err(c.unexpected("`;`").help(
            "an assumption compares two expressions; split it: `assume 0 < m; assume m < 1;`",
        ));
    }
    let place = left.place.to(right.place);
    Ok(Statement::Assume {
        left,
        relation,
        right,
        place,
    })
}

fn group(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let mut name = c.name("the name of the configuration")?;
    c.punct(':')?;
    let group = kindred(c)?;
    typeset(c, std::slice::from_mut(&mut name))?;
    let at = label::at(c)?;
    let written = "write for example `group Λ: SO<3> velocity Ω;`";
    let opened = matches!(c.peek(), Some(Token::Open('(')));
    c.word("velocity").map_err(|e| match opened {
        true => e.help(SIZES).help(written),
        false => e.help(written),
    })?;
    let mut velocity = c.name("the name of the discrete velocity")?;
    typeset(c, std::slice::from_mut(&mut velocity))?;
    Ok(Statement::Group {
        name,
        group,
        at,
        velocity,
    })
}

fn advected(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let mut names = vec![c.name("the name of the advected quantity")?];
    while c.take_punct(',') {
        names.push(c.name("the name of an advected quantity")?);
    }
    c.punct(':')?;
    let shape = kindred(c)?;
    typeset(c, &mut names)?;
    let at = label::at(c)?;
    let place = c.place();
    let definition = if c.take_punct('=') {
        Some(expression(c)?)
    } else {
        None
    };
    if let ([first, .., last], Some(_)) = (names.as_slice(), &definition) {
        return Err(Diagnostic::new(
            place,
            "only one quantity can have a definition, and this statement declares several",
        )
        .help("write one statement for each quantity, such as `advected Γ: Vec<3> = Λ^T*z;`")
        .also(first.place.to(last.place), "declared in one statement here"));
    }
    Ok(Statement::Advected {
        names,
        shape,
        at,
        definition,
    })
}

fn constraint(c: &mut Cursor, keyword: &Name) -> Result<Statement, Diagnostic> {
    let remedy =
        "write `constraint next(Γ) = Ω^T * Γ;`: a constraint gives the quantity at the next node";
    c.word("next").map_err(|e| {
        e.help(remedy)
            .help("to constrain configurations, write `hold λ: dot(x, x) = L^2;`")
    })?;
    c.delimiter('(')?;
    let name = c.name("the quantity of the constraint")?;
    if c.is_punct(',') {
        return Err(c.unexpected("`)`").help(
            "a constraint advances a quantity in time; for a neighbour along a label, write for example `Λ^T*next(Λ, i)` in \
             the Lagrangian",
        ));
    }
    c.delimiter(')')?;
    c.punct('=')?;
    let value = expression(c)?;
    let place = keyword.place.to(value.place);
    Ok(Statement::Constraint { name, value, place })
}

/// `hold λ: a = b;`
fn hold(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let remedy = "write `hold λ: dot(x, x) = L^2;`: the name of the multiplier, then the equation";
    let name = c
        .name("the name of the multiplier")
        .map_err(|e| e.help(remedy))?;
    c.punct(':').map_err(|e| e.help(remedy))?;
    let left = expression(c)?;
    if c.is_punct('<') || c.is_punct('>') {
        let message =
            "`hold` states an equation: inequalities, such as contact, are not supported yet";
        return Err(Diagnostic::new(c.place(), message).help(
            "to keep a distance d above 0, use a stiff spring: the term `-h*K*(d - abs(d))^2/8` is zero where d > 0",
        ));
    }
    c.punct('=').map_err(|e| e.help(remedy))?;
    c.take_punct('=');
    let right = expression(c)?;
    let place = left.place.to(right.place);
    Ok(Statement::Hold {
        name,
        left,
        right,
        place,
    })
}

/// `given f(Sym<3>): Real = clebsch::functions::carlson_rf;`
fn given(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let remedy = "give the path of the function, for example `given RF(Sym<3>): Real = clebsch::functions::carlson_rf;`";
    let name = c
        .name("the name of the function")
        .map_err(|e| e.help(remedy))?;
    c.delimiter('(').map_err(|e| e.help(remedy))?;
    let mut arguments = vec![kindred(c)?];
    while c.take_punct(',') {
        arguments.push(kindred(c)?);
    }
    c.delimiter(')')?;
    c.punct(':').map_err(|e| e.help(remedy))?;
    let value = kindred(c)?;
    c.punct('=').map_err(|e| e.help(remedy))?;
    let word = c.place();
    let by_case = c.take_word("case").then_some(word);
    let (texts, components) = formula::components(c)?.into_iter().unzip();
    let components: Vec<Expression> = components;
    let path = match (components.is_empty(), by_case) {
        // Its calls are replaced by its formula, so that a path is not needed.
        (false, _) => name.clone(),
        (true, Some(place)) => Name {
            text: crate::expr::BY_CASE.to_owned(),
            place,
            typeset: None,
            is_copy: false,
        },
        (true, None) => {
            let mut path = c.name("the path of the function").map_err(|e| {
                e.help(remedy).help(
                    "or give an expression in quotes, `\"A*cos(2*pi*x)\"`, where x, y, z are the components of the argument; \
                     or write `case`, and the case gives the expression",
                )
            })?;
            let last = path_goes_on(c, &mut path)?;
            library::known(&path, last, &arguments, &value)?;
            path
        }
    };
    Ok(Statement::Given {
        name,
        arguments,
        value,
        path,
        components,
        texts,
        by_case,
    })
}

/// Reads the rest of a Rust path, after its first name. Gives the place of the last name.
pub(super) fn path_goes_on(c: &mut Cursor, path: &mut Name) -> Result<Place, Diagnostic> {
    let mut last = path.place;
    while c.take_punct(':') {
        c.punct(':')?;
        let next = c.name("the next part of the path")?;
        path.text = format!("{}::{}", path.text, next.text);
        path.place = path.place.to(next.place);
        last = next.place;
    }
    Ok(last)
}

fn binding(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let name = c.name("a name")?;
    c.punct('=').map_err(|e| match c.peek() {
        Some(Token::Open('(')) => e.help(format!(
            "`let` takes no arguments: write `let {n} = k*q^2/2;`, or declare a function, `given {n}(Real): Real = \
             \"k*x^2/2\";`",
            n = name.text
        )),
        _ => e,
    })?;
    let value = expression(c)?;
    Ok(Statement::Let { name, value })
}

fn node(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let rule = c.name("`symmetric`, `incoming` or `outgoing`")?;
    let which = match rule.text.as_str() {
        "symmetric" => NodeRule::Symmetric,
        "incoming" => NodeRule::Incoming,
        "outgoing" => NodeRule::Outgoing,
        other => {
            let mut e = Diagnostic::new(
                rule.place,
                format!("`{other}` is not a rule for nodal terms"),
            );
            if let Some(word) = closest(other, ["symmetric", "incoming", "outgoing"]) {
                e = e.help(format!("did you mean `{word}`?"));
            }
            return Err(e.help(
                "`symmetric` (second order, the default), `incoming` or `outgoing` (one-sided)",
            ));
        }
    };
    Ok(Statement::Node(which, rule.place))
}
