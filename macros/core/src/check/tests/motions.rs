//! Errors about rigid motions and their parts: unsupported sizes, and parts of expressions that are not rigid
//! motions.

use crate::pipeline::derive_source;

fn refused(group: &str, lagrangian: &str) -> String {
    let text = format!(
        "model M {{ param u: Vec<2>; param K: Mat<3>; param Q: Mat<4>; group G: {group} velocity V; \
         constraint next(G) = G*V; lagrangian = {lagrangian}/h; }}"
    );
    match derive_source(&text) {
        Ok(_) => format!("derives: {text}"),
        Err(errors) => errors.to_string(),
    }
}

#[test]
fn sizes_that_the_table_has_not_are_told_with_those_it_has() {
    let all = "the groups are SO<n>, GL<n>, SU<2>, SE<2> and SE<3>";
    for group in ["SE<4>", "SE<1>", "SE<0>", "SE<33>"] {
        let said = refused(group, "tr(V)");
        let wanted = format!("this version does not support the group `{group}`");
        assert!(said.contains(&wanted), "{said}");
        let own = format!("clebsch supports `SE<2>` and `SE<3>` in this family; {all}");
        assert!(said.contains(&own), "{said}");
    }
    let said = refused("SU<3>", "tr(V)");
    assert!(
        said.contains("clebsch supports `SU<2>` in this family;"),
        "{said}"
    );
    let said = refused("SE<2, 2>", "tr(V)");
    assert!(said.contains("`SE` takes one size, 2 given"), "{said}");
    let said = refused("Group<2>", "tr(V)");
    assert!(said.contains(all), "{said}");
}

#[test]
fn parts_are_taken_of_motions_alone() {
    let both = "SU<2>, SE<2> or SE<3>";
    for (lagrangian, wanted) in [
        (
            "tr(rot(u))",
            format!("`rot` needs an element of {both}, and this is a vector of length 2"),
        ),
        (
            "dot(u, pos(u))",
            "`pos` needs an element of SE<2> or SE<3>, and this is a vector".to_owned(),
        ),
        (
            "tr(rot(K))",
            format!("`rot` needs an element of {both}, or products and inverses of elements"),
        ),
        (
            "tr(rot(V - Id))",
            format!("`rot` needs an element of {both}, or products"),
        ),
        (
            "re(V)",
            "`re` needs a 4 x 4 matrix, and this is a 3 x 3".to_owned(),
        ),
        (
            "tr(V*Q)",
            "a 3 x 3 matrix cannot be multiplied by a 4 x 4".to_owned(),
        ),
        ("dot(pos(V), K*u)", "cannot be multiplied".to_owned()),
    ] {
        let said = refused("SE<2>", lagrangian);
        assert!(said.contains(&wanted), "{lagrangian}: {said}");
    }
    // Blocks of planar motions have two rows.
    let said = refused("SE<2>", "rot(V)[1, 3]");
    assert!(
        said.contains("components are counted from 1 to 2"),
        "{said}"
    );
    assert!(refused("SE<2>", "dot(pos(V), rot(V^-1*G^-1*next(G))*u)").contains("derives"));
}
