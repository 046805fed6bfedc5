"""Runs: values in, arrays out."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from shared import top_values

import clebsch as cl


def command(*arguments: str) -> None:
    """Run the command that the package includes."""
    done = subprocess.run([sys.executable, "-m", "clebsch", *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


CASES = """heavy-top:general kepler free-body toda-chain:two-solitons
    kirchhoff-rod circular-rod particle-mesh-1d spherical-pendulum""".split()


@pytest.mark.parametrize("case", CASES)
def test_arrays_are_those_of_the_command(case, tmp_path):
    """Names, order, shapes, types and bits are those of trajectory.npz."""
    folder = tmp_path / "out"
    command("run", case, "--steps", "4", "--every", "2", "--check", "none", "--stability-limit", "0", "--out", str(folder))
    name, _, own = case.partition(":")
    run = cl.load(name).run(own or None, steps=4, every=2)
    with np.load(folder / "trajectory.npz") as written:
        assert list(written) == run.keys()
        for key in written:
            found = run[key]
            assert found.shape == written[key].shape, key
            assert found.dtype.itemsize == 8
            assert found.tobytes() == written[key].tobytes(), key


def test_the_columns_of_a_table_are_those_of_the_command(tmp_path):
    folder = tmp_path / "out"
    command("run", "heavy-top", "--steps", "4", "--check", "none", "--out", str(folder))
    frame = cl.load("heavy-top").run(steps=4).to_pandas()
    assert (folder / "trajectory.csv").read_text().splitlines()[0].split(",") == [
        "node",
        "time",
        *frame.columns.drop("node"),
    ]


def test_the_example_of_the_readme(top):
    run = top.run(**top_values(until=100, every=10))
    assert run.t.shape == (1001,) and run.t[-1] == 100.0
    assert run["body_momentum"].shape == (1001, 3)
    assert run["R"].shape == (1001, 3, 3)
    assert run.energy.shape == (1001,)
    assert np.abs(run.drift["energy"]).max() < 1e-5
    assert run.check() is run and run.complete and run.steps == 10_000
    assert "R" in run and "energy" in run and "nothing" not in run
    assert "10000 steps" in repr(run)


def test_the_angular_velocity_becomes_the_momentum(top):
    """The inertia tr(J) - J is (2, 2, 1)."""
    run = top.run(**top_values(steps=1))
    np.testing.assert_allclose(run.initial["body_momentum"], [0.2, 0, 5], atol=1e-15)
    np.testing.assert_array_equal(run.parameters["J"], np.diag([0.5, 0.5, 1.5]))


def test_arrays_are_views(top):
    run = top.run(**top_values(steps=100))
    for name in ("R", "body_momentum", "invariant_energy"):
        assert np.shares_memory(run[name], run._rows), name
    chain = cl.load("toda-chain").run(steps=3)
    for name in ("q", "momentum_q"):
        assert np.shares_memory(chain[name], chain._rows), name
    rod = cl.load("kirchhoff-rod").run(steps=2)
    for name in ("Lambda", "phi"):
        assert np.shares_memory(rod[name], rod._rows), name


def test_sampling(oscillator):
    values = dict(parameters=dict(m=1, c=4), initial=dict(q=1), h=0.1)
    assert oscillator.run(**values, steps=7, every=3).node.tolist() == [0, 3, 6, 7]
    assert oscillator.run(**values, steps=7, every=0).node.tolist() == [0, 7]
    assert len(oscillator.run(**values, steps=100_000)) == 10_001
    assert oscillator.run(**values, until=0.74).steps == 7


def test_numbers_keep_their_bits(oscillator):
    for x in (0.1 + 0.2, 1e-300, np.nextafter(1.0, 2.0), np.float32(0.1), np.int64(3), 7):
        run = oscillator.run(parameters=dict(m=1, c=4), initial=dict(q=x), h=0.1, steps=1)
        assert run["q"][0] == float(x)


def test_values_in_many_forms(top):
    first = top.run(**top_values(steps=3))
    values = top_values(steps=3)
    values["parameters"]["J"] = dict(I=[2, 2, 1])
    values["initial"]["R"] = dict(axis=(1, 0, 0), angle="0.5 + 0.1")
    second = top.run(**values)
    np.testing.assert_allclose(first["G"], second["G"], atol=1e-14)
    half = 0.3
    values["initial"]["R"] = np.array([np.cos(half), np.sin(half), 0, 0])
    np.testing.assert_allclose(first["G"], top.run(**values)["G"], atol=1e-14)


def test_arrays_at_sites():
    model = cl.load("toda-chain")
    places = np.linspace(0, -1.5, 16)
    run = model.run(labels=dict(i=16), initial=dict(q=places, momentum_q=0), steps=1)
    np.testing.assert_array_equal(run["q"][0], places)
    rod = cl.load("kirchhoff-rod")
    start = rod.run(steps=1)["phi"][0]
    moved = rod.run(initial=dict(phi=np.vstack([[[0, 0, 0]], start])), steps=1)
    np.testing.assert_array_equal(moved["phi"][0], start)


def test_values_replace_those_of_a_case():
    model = cl.load("heavy-top")
    run = model.run("general", parameters=dict(gU=[0, 0, 0.25]), h=0.02, steps=5)
    np.testing.assert_array_equal(run.parameters["gU"], [0, 0, 0.25])
    assert run.h == 0.02
    with pytest.raises(cl.DataError, match="give one of them"):
        model.run(initial=dict(angular_velocity=[0, 0, 1]), steps=5)
    assert model.run(initial=dict(angular_velocity=[0, 0, 1], body_momentum=None), steps=5).steps == 5


def test_options():
    model = cl.load("free-body")
    second, fourth = (model.run(order=order, steps=50) for order in (2, 4))
    assert second["body_momentum"][-1].tobytes() != fourth["body_momentum"][-1].tobytes()
    assert model.run(order=4, compensated=True, steps=5).case["order"] == 4
    assert model.run(halve=True, steps=5).substeps[0] == 0


def test_steps_are_judged_by_the_action_as_stated(top):
    run = top.run(**top_values(steps=300), judge="sample")
    text, judged, holds = run.stated
    assert judged == 101 and holds and "101 steps checked" in text
    assert top.run(**top_values(steps=10), judge="all").stated[1] == 10
    assert top.run(**top_values(steps=10)).stated is None


def test_invariants_and_their_bounds(top):
    run = top.run(**top_values(until=10))
    energy = run.invariants["energy"]
    assert not energy.exact and energy.verdict == "no bound"
    assert energy.worst == pytest.approx(np.abs(run.drift["energy"]).max(), rel=1e-6)
    assert run.invariants["momentum_G"].bound == 1e-12
    with pytest.raises(cl.InvariantError, match="energy drifts") as caught:
        top.run(**top_values(until=10), bounds=dict(energy=1e-15)).check()
    assert caught.value.names == ("energy",) and caught.value.run.complete


def test_functions_of_samples(top):
    seen = []
    observe = {
        "casimir": lambda s: s["G"] @ s["body_momentum"],
        "pair": lambda s: s["G"][:2],
        "clock": lambda s: seen.append(s.node) or s.t,
        "weight": lambda s: s.parameters["chi"][2] + 0 * s.energy,
    }
    run = top.run(**top_values(steps=20, every=4), observe=observe)
    np.testing.assert_allclose(run["casimir"], run["invariant_momentum_G"], rtol=1e-14)
    np.testing.assert_array_equal(run["pair"], run["G"][:, :2])
    np.testing.assert_array_equal(run["clock"], run.t)
    assert seen == [0, 4, 8, 12, 16, 20] and run["weight"].tolist() == [1.0] * 6
    assert "pair_2" in run.to_pandas().columns
    with pytest.raises(cl.DataError, match="another name"):
        top.run(**top_values(steps=1), observe={"R": lambda s: 0})
    with pytest.raises(ZeroDivisionError):
        top.run(**top_values(steps=1), observe={"wrong": lambda s: 1 / 0})


def test_names_of_arrays_get_a_suggestion(top):
    with pytest.raises(KeyError, match="did you mean 'body_momentum'"):
        top.run(**top_values(steps=1))["body_momentun"]
