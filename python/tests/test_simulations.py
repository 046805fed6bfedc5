"""Simulations that are stepped by hand, saved and resumed."""

from __future__ import annotations

import numpy as np
import pytest
from shared import top_values

import clebsch as cl


def same(one: cl.Simulation, other: cl.Simulation) -> None:
    assert one.node == other.node and one.t == other.t
    assert one.state.keys() == other.state.keys()
    for name, value in one.state.items():
        assert np.asarray(value).tobytes() == np.asarray(other.state[name]).tobytes(), name


def test_steps_are_those_of_a_run(top):
    run = top.run(**top_values(steps=50))
    simulation = top.start(**top_values())
    assert (simulation.node, simulation.t) == (0, 0.0)
    for node in (1, 2, 30, 50):
        simulation.step(node - simulation.node)
        np.testing.assert_array_equal(simulation.state["R"], run["R"][node])
        np.testing.assert_array_equal(simulation["body_momentum"], run["body_momentum"][node])
        assert simulation.energy == run.energy[node]
    assert simulation.t == run.t[-1]
    assert set(simulation.invariants) == {"energy", "momentum_G", "G_squared"}
    assert simulation.case["h"] == 0.01
    assert "node 50" in repr(simulation)


@pytest.mark.parametrize("name", [None, "heavy-top", "toda-chain", "kirchhoff-rod", "particle-mesh-1d"])
def test_a_saved_simulation_goes_on_with_the_same_bits(top, tmp_path, name):
    model, values = (cl.load(name), {}) if name else (top, top_values())
    simulation = model.start(**values).step(7)
    path = tmp_path / "x.ckpt"
    simulation.save(path)
    simulation.step(5)
    again = cl.resume(path)
    assert again.node == 7 and again.model.source == model.source
    again.step(5)
    same(simulation, again)
    # A resumed simulation can be saved too, over the file that it came from.
    again.save(path)
    same(cl.resume(path), simulation)
    assert [own.name for own in tmp_path.iterdir()] == ["x.ckpt"]


def test_options_are_saved(tmp_path):
    model = cl.load("free-body")
    simulation = model.start(order=6).step(3)
    simulation.save(tmp_path / "x.ckpt")
    again = cl.resume(tmp_path / "x.ckpt")
    simulation.step(3)
    same(simulation, again.step(3))
    other = model.start(order=2).step(6)
    assert np.abs(other["body_momentum"] - again["body_momentum"]).max() > 0


def test_damaged_files_are_rejected(top, tmp_path):
    path = tmp_path / "x.ckpt"
    top.start(**top_values()).step(3).save(path)
    whole = path.read_bytes()
    for at in (len(whole) - 20, len(whole) - 60):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        with pytest.raises(cl.DataError, match="damaged"):
            cl.resume(path)
    path.write_bytes(whole[:-5])
    with pytest.raises(cl.DataError):
        cl.resume(path)
    path.write_bytes(b"something else")
    with pytest.raises(cl.DataError, match="not a saved simulation"):
        cl.resume(path)


def test_a_step_that_fails_leaves_the_state():
    model = cl.Model("model Fall { field q: Real; lagrangian = (next(q) - q)^2/(2*h) - h*sqrt(q); }")
    simulation = model.start(initial=dict(q=1.0), h=0.01)
    with pytest.raises(cl.StepError) as caught:
        simulation.step(100_000)
    assert simulation.node == caught.value.node > 10
    assert np.isfinite(simulation["q"])


def test_what_a_simulation_does_not_take(top):
    with pytest.raises(cl.DataError, match="no end") as caught:
        top.start(**top_values(steps=3))
    assert caught.value.argument == "steps"
    with pytest.raises(cl.DataError, match="arguments are") as caught:
        top.start(**top_values(speed=3))
    assert caught.value.argument == "speed"
    with pytest.raises(cl.DataError):
        top.start(**top_values()).step(-1)
