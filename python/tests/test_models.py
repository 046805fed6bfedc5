"""Models as texts, their derivations, and the models that are shipped."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from shared import OSCILLATOR, ROOT, TOP, top_values

import clebsch as cl


def test_a_mistake_has_its_place_under_a_caret_and_a_way_out():
    with pytest.raises(cl.ModelError) as caught:
        cl.Model("model X {\n    param k Real;\n}", name="mine")
    error = caught.value
    assert (error.line, error.column) == (2, 13)
    line, caret = str(error).splitlines()[3:5]
    assert "param k Real;" in line and caret.index("^") == line.index("Real")
    assert "mine:2:13" in str(error)
    assert "param a, b: Real" in error.hint
    assert isinstance(error, ValueError)


def test_a_mistake_in_a_chain_has_its_place():
    text = (ROOT / "models/lattices/toda-chain.clebsch").read_text().replace("exp(-b*r)", "exp(-b*rr)")
    with pytest.raises(cl.ModelError) as caught:
        cl.Model(text)
    error = caught.value
    assert "rr" in text.splitlines()[error.line - 1][error.column - 1 :]


def test_a_wrong_equation_is_rejected_with_its_residual():
    with pytest.raises(cl.ModelError, match="not a group action"):
        cl.Model(TOP.replace("W^T*G", "W*G"))


@pytest.mark.parametrize(
    "text",
    ["", "model", "\0", "é" * 1000, "(" * 50_000, OSCILLATOR.replace("q^2", "(" * 50_000 + "q"), OSCILLATOR[:40], "x" * 10**6],
    ids=range(8),
)
def test_strange_texts_are_rejected(text):
    with pytest.raises(cl.ModelError):
        cl.Model(text)


def test_what_a_model_declares(top):
    assert top.name == "Top"
    assert top.parameters == ["J", "chi", "z"]
    assert top.initial == ["R", "body_momentum"]
    assert top.cases == {}
    assert top.card["orders"] == [2, 4, 6, 8]
    assert "parameters J, chi, z" in repr(top)
    assert top.warnings == ""


def test_derivations(top):
    derivation = top.derivation
    assert "Discrete Euler-Poincaré equations" in derivation.sections
    assert r"\begin{" in derivation.latex and r"\documentclass" in derivation.document
    assert derivation.markdown.startswith("# Top")
    assert "pub struct TopState" in derivation.rust
    assert derivation.certificate.startswith("17 identities proved")
    assert len(derivation.proof) > len(derivation.text)
    energy, momentum, square = derivation.invariants
    assert energy.startswith("energy: ") and "symplectic" in energy
    assert "Casimir" in momentum and "Casimir" in square
    with pytest.raises(KeyError, match="Certificate"):
        derivation.section("No such section")


def test_notebooks_show_equations_and_invariants(top):
    shown = top._repr_markdown_()
    assert "$$" in shown and "```math" not in shown and "$`" not in shown
    assert "Casimir" in shown
    assert len(shown) < len(top.derivation._repr_markdown_())


def test_the_derivation_of_a_chain():
    derivation = cl.load("toda-chain").derivation
    assert any("total momentum" in line for line in derivation.invariants)
    assert "identities proved by normal form" in derivation.certificate


def test_stability_limit(oscillator):
    """An oscillator of frequency 2 has the limit h = 2/2."""
    limit = oscillator.derivation.stability_limit(parameters=dict(m=1, c=4), initial=dict(q=1), h=0.9, steps=1)
    assert limit.step == pytest.approx(1.0, rel=1e-6)
    assert limit.frequency == pytest.approx(2.0, rel=1e-6)
    assert "ω" in limit.text


def test_the_list_of_models():
    all = cl.models()
    assert {own["family"] for own in all} == {"rigid", "particle", "elastic", "chain", "fluid"}
    assert "kirchhoff-rod" in cl.models("chain").names()
    assert "heavy-top" in repr(all) and "<table>" in all._repr_html_()
    with pytest.raises(cl.DataError, match="chain") as caught:
        cl.models("chains")
    assert caught.value.argument == "family"


def test_unknown_models_get_a_suggestion():
    with pytest.raises(cl.DataError, match="did you mean `heavy-top`"):
        cl.load("heavy-tob")


def test_model_files_bring_their_cases(tmp_path):
    path = tmp_path / "spring.clebsch"
    path.write_text(OSCILLATOR)
    (tmp_path / "spring.toml").write_text(
        'model = "Oscillator"\nname = "soft"\nh = "T/100"\nsteps = 100\n[parameters]\nm = 1\nc = 4\nT = 2.0\n[initial]\nq = 1\n'
    )
    with pytest.raises(cl.DataError, match="T"):
        cl.load(str(path)).run()
    (tmp_path / "spring.toml").write_text(
        'model = "Oscillator"\nname = "soft"\nh = "m/100"\nsteps = 100\n[parameters]\nm = 1\nc = 4\n[initial]\nq = 1\n'
    )
    model = cl.load(str(path))
    assert list(model.cases) == ["soft"]
    assert model.run().h == 0.01
    # The expression of the case follows the parameter.
    assert model.run(parameters=dict(m=2)).h == 0.02
    assert model.run(str(tmp_path / "spring.toml"), steps=3).steps == 3
    path.write_text(OSCILLATOR.replace("field q: Real;", "field q Real;"))
    with pytest.raises(cl.ModelError) as caught:
        cl.load(str(path))
    assert caught.value.line == 2


def test_cases_are_arguments_of_run():
    """A case of a chain, given as Python values, has the bits of the case by name."""
    for name, case in [("heavy-top", None), ("toda-chain", "two-solitons"), ("kirchhoff-rod", None)]:
        model = cl.load(name)
        by_name = model.run(case, steps=5)
        values = {key: value for key, value in model.case(case).items() if key not in ("model", "name", "doc", "steps")}
        again = cl.Model(model.source).run(steps=5, **values)
        for key in by_name:
            np.testing.assert_array_equal(by_name[key], again[key])


def test_models_are_sent_to_other_processes(top):
    assert pickle.loads(pickle.dumps(top)).source == top.source
    assert list(pickle.loads(pickle.dumps(cl.load("kepler"))).cases) == list(cl.load("kepler").cases)


def test_placeholder_values():
    case = cl.Model(TOP).case("sample")
    assert set(case["parameters"]) == {"J", "chi", "z"}


def test_names_of_other_alphabets():
    model = cl.Model(TOP.replace("chi", "χ").replace("R", "Λ"))
    values = top_values(steps=1)
    values["parameters"]["χ"] = values["parameters"].pop("chi")
    values["initial"]["Λ"] = values["initial"].pop("R")
    run = model.run(**values)
    assert run["Lambda"].shape == (2, 3, 3)
