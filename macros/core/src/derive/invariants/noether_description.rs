//! Describes a Noether momentum: its name in tables and emitted code, and why it is conserved. Takes the
//! combination of motions; gives the text.

use super::Inputs;
use super::mixed::Component;
use super::motions::{Sort, Way};
use super::noether::{Term, configurations, is_whole};

/// A linear map of components of fields, as the proportions in which each moves.
fn map(terms: &[Term]) -> Vec<(Component, Component, i64)> {
    let entries = terms.iter().filter_map(|t| match t.motion.way {
        Way::Mixing { entry, by } => {
            let to = Component {
                configuration: t.motion.configuration,
                entry,
            };
            Some((to, by, t.times))
        }
        _ => None,
    });
    entries.collect()
}

/// Whether a linear map of components is a rotation, that is, skew.
fn is_turn(map: &[(Component, Component, i64)]) -> bool {
    let opposite = |(to, by, n): &(Component, Component, i64)| map.contains(&(*by, *to, -n));
    map.iter().all(opposite)
}

/// The name of the momentum of a linear map of components, from the components that it moves.
fn name_of_map(x: &Inputs, map: &[(Component, Component, i64)]) -> String {
    let mut moved: Vec<Component> = map.iter().flat_map(|(to, by, _)| [*to, *by]).collect();
    moved.sort_by_key(|c| (c.configuration, c.entry));
    moved.dedup();
    let labels = moved.iter().map(|c| {
        let field = &x.spec.configurations[c.configuration];
        let name = &x.letters.symbols.get(field.element).ascii;
        match field.group.shape().is_scalar() {
            true => format!("_{name}"),
            false => format!("_{name}{}", c.entry + 1),
        }
    });
    let stem = match is_turn(map) {
        true => "momentum_angular",
        false => "joint_momentum",
    };
    stem.to_owned() + &labels.collect::<String>()
}

/// A name: the kind of momentum, its bodies, and its component.
pub(super) fn name(x: &Inputs, terms: &[Term]) -> String {
    let s = &x.letters.symbols;
    let map = map(terms);
    if map.len() == terms.len() {
        return name_of_map(x, &map);
    }
    let ascii = |id| s.get(id).ascii.clone();
    let set = configurations(terms);
    let all = |f: &dyn Fn(Way) -> bool| terms.iter().all(|t| f(t.motion.way));
    let added = terms.iter().all(|t| t.times == 1);
    let one = terms.len() == 1;
    let whole = is_whole(x, terms);
    let of_body = |i: &usize| x.spec.configurations[*i].side.is_body();
    let own = set.first().map(of_body);
    let field = |i: &usize| x.spec.configurations[*i].group.is_additive();
    let fields = set.iter().all(field);
    let mut parts: Vec<String> = Vec::new();
    let stem = if all(&|w| matches!(w, Way::Space | Way::About(_))) && (one || added) {
        match (one, whole, own) {
            (true, ..) if fields => "momentum",
            (true, false, Some(false)) => "momentum",
            (true, ..) => "spatial_momentum",
            (false, ..) => "total_momentum",
        }
    } else if all(&|w| w == Way::Body) && (one || added) {
        match (one, whole, own) {
            (true, true, _) => "body_momentum_whole",
            (true, false, Some(true)) => "momentum",
            (true, false, _) => "body_momentum",
            (false, ..) => "total_body_momentum",
        }
    } else if all(&|w| w == Way::Spin) && (one || added) {
        if one { "spin" } else { "total_spin" }
    } else if all(&|w| w == Way::Shift) && (one || added) {
        "coordinate_momentum"
    } else {
        "joint_momentum"
    };
    let mut out = stem.to_owned();
    if set.len() < x.spec.configurations.len() {
        for i in &set {
            out += &format!("_{}", ascii(x.spec.configurations[*i].element));
        }
    }
    let rigid = |t: &Term| {
        x.spec.configurations[t.motion.configuration]
            .group
            .rigid()
            .is_some()
    };
    let linear_group = |t: &Term| {
        x.spec.configurations[t.motion.configuration]
            .group
            .is_linear()
    };
    let mut push = |part: String| {
        if !part.is_empty() && !parts.contains(&part) {
            parts.push(part);
        }
    };
    for t in terms {
        let mixed = terms.iter().any(|o| rigid(o) || linear_group(o));
        let shifted = fields || set.iter().any(field);
        match t.motion.sort {
            Sort::Linear if !fields => push("linear".to_owned()),
            Sort::Angular | Sort::Planes(_) if shifted => push("angular".to_owned()),
            Sort::Angular if mixed && t.motion.way != Way::Spin => push("angular".to_owned()),
            Sort::Planes(_) if linear_group(t) => push("planes".to_owned()),
            _ => {}
        }
        if let Way::About(p) = t.motion.way {
            push(format!("about_{}", ascii(p)));
        }
        push(t.reading.name.clone());
    }
    for part in parts {
        out += &format!("_{part}");
    }
    out
}

/// Why it is conserved.
pub(super) fn reason(x: &Inputs, terms: &[Term], strict: bool) -> String {
    let map = map(terms);
    let all = |f: &dyn Fn(Way) -> bool| terms.iter().all(|t| f(t.motion.way));
    let whole = is_whole(x, terms);
    let of_space = all(&|w| matches!(w, Way::Space | Way::About(_)));
    let set = configurations(terms);
    let group = set.first().map(|i| x.spec.configurations[*i].group);
    let entire = terms.iter().all(|t| t.reading.is_whole());
    let shifts = |t: &Term| {
        matches!(
            t.motion.sort,
            Sort::Linear | Sort::Shifts(_) | Sort::Entries(_)
        )
    };
    let turns = |t: &Term| matches!(t.motion.sort, Sort::Angular | Sort::Planes(_));
    let field = |i: &usize| x.spec.configurations[*i].group.is_additive();
    let mixes = !map.is_empty() && map.len() == terms.len();
    let under = match (of_space, whole || entire && set.iter().any(field), group) {
        _ if mixes && is_turn(&map) => "rotations that mix the fields",
        _ if mixes => "a linear map of the fields",
        (true, _, _) if set.iter().any(field) && terms.iter().all(shifts) => "translations",
        (true, true, Some(group)) => group.motions_words(),
        (true, true, None) => "rotations of space",
        (true, false, _) if terms.iter().all(turns) => "rotations about the axis in space",
        (true, false, _) if terms.iter().all(shifts) => "translations",
        (true, false, _) => "motions of space that fix the axis",
        _ if all(&|w| w == Way::Body) && whole => "motions of the body's own frame",
        _ if all(&|w| w == Way::Body) && terms.iter().all(turns) => {
            "rotations about the axis in the body"
        }
        _ if all(&|w| w == Way::Body) => "motions of the body's frame that fix the axis",
        _ if all(&|w| w == Way::Spin) => "turns of the body about its own origin",
        _ if all(&|w| w == Way::Shift) => "shifts of the matrix of the configuration",
        _ => "joint motions of space and bodies",
    };
    match strict {
        true => format!("Noether: the action is invariant under {under}"),
        false => format!("Noether: the action changes by a total difference under {under}"),
    }
}
