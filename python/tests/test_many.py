"""Sweeps and ensembles."""

from __future__ import annotations

import numpy as np
import pytest
from shared import top_values

import clebsch as cl


def without_h(**others):
    values = top_values(**others)
    values.pop("h")
    return values


def test_a_sweep_has_a_row_for_each_point(top):
    pd = pytest.importorskip("pandas")
    table = top.sweep(vary={"chi.z": [0.5, 1.0]}, h=[0.01, 0.02, 5.0], **without_h(until=1))
    assert isinstance(table, pd.DataFrame)
    assert table["chi.z"].tolist() == [0.5] * 3 + [1.0] * 3
    assert table["h"].tolist() == [0.01, 0.02, 5.0] * 2
    assert table["status"].tolist() == ["complete", "complete", "refused"] * 2
    assert table["steps"].tolist() == [100, 50, 0] * 2
    assert "reduce the step size" in table["why"][2]
    assert table["within_bounds"].tolist() == [True, True, False] * 2
    values = top_values(until=1, h=0.02)
    values["parameters"]["chi"] = [0, 0, 0.5]
    run = top.run(**values, every=0)
    row = table.iloc[1]
    assert row["drift_energy"] == run.invariants["energy"].worst
    assert [row[f"G_{at}"] for at in (1, 2, 3)] == run["G"][-1].tolist()


def test_no_result_depends_on_the_number_of_threads(top):
    tables = [top.sweep(vary={"chi.z": np.linspace(0, 1, 7)}, workers=workers, **top_values(until=1)) for workers in (1, 3, None)]
    for other in tables[1:]:
        assert tables[0].equals(other)


def test_whole_values_components_and_initial_values_are_varied(oscillator, top):
    values = dict(parameters=dict(m=1.0), initial=dict(q=1.0), steps=10)
    table = oscillator.sweep(vary=dict(c=[1.0, 4.0], q=[1.0, 2.0, 3.0]), h=0.1, **values)
    assert len(table) == 6 and table["c"].tolist() == [1.0] * 3 + [4.0] * 3
    assert table["initial.q"].tolist() == [1.0, 2.0, 3.0] * 2
    np.testing.assert_allclose(table["q"][1], 2 * table["q"][0], rtol=1e-14)
    whole = top.sweep(vary=dict(chi=[[0, 0, 0.5], [0, 0, 1.0]]), **top_values(until=0.1))
    assert whole["chi_3"].tolist() == [0.5, 1.0]
    mirrored = top.sweep(vary={"J.12": [0.0, 0.1]}, **top_values(until=0.1))
    assert mirrored["status"].tolist() == ["complete", "complete"]


def test_the_first_case_of_a_shipped_model_is_swept():
    table = cl.load("kepler").sweep(vary={"X.x": [0.9, 1.0]}, steps=10)
    assert table["status"].tolist() == ["complete"] * 2
    assert table["X.x"].tolist() == [0.9, 1.0]


def test_a_step_size_keeps_the_time():
    table = cl.load("heavy-top").sweep(h=[0.1, 0.05])
    assert table["time"].iloc[0] == pytest.approx(table["time"].iloc[1])


@pytest.mark.parametrize(
    ("vary", "text"),
    [
        ({}, "at least one name"),
        ({"chi.w": [1]}, "does not name a component"),
        ({"chi.4": [1]}, "does not name a component"),
        ({"R.12": [1]}, "would not be a rotation"),
        ({"nothing.x": [1]}, "nothing"),
        ({"nothing": [1]}, "nothing"),
        ({"chi": 3}, "sequence"),
        ({"chi": []}, "sequence"),
    ],
)
def test_wrong_names_and_values_of_a_sweep(top, vary, text):
    with pytest.raises(cl.DataError, match=text):
        top.sweep(vary=vary, **top_values(until=0.1))


def test_an_ensemble_has_the_bits_of_single_runs(top):
    speeds = np.random.default_rng(1).normal(size=(6, 3)) + [0, 0, 5]
    values = top_values(until=1, every=20)
    values["initial"] = dict(R=np.eye(3), angular_velocity=speeds)
    ensemble = top.ensemble(**values)
    assert len(ensemble) == 6 and ensemble["G"].shape == (6, 6, 3) and ensemble.energy.shape == (6, 6)
    for body, speed in enumerate(speeds):
        values["initial"]["angular_velocity"] = speed
        run = top.run(**values)
        np.testing.assert_array_equal(ensemble["R"][body], run["R"])
        assert ensemble.drift["energy"][body] == run.invariants["energy"].worst
    assert ensemble.check() is ensemble and "6 bodies" in repr(ensemble)


def test_arrays_with_a_value_for_each_body(top):
    values = top_values(steps=2)
    turns = np.array([cl.axis_angle([1, 0, 0], angle) for angle in (0.1, 0.2, 0.3)])
    values["parameters"]["chi"] = [[0, 0, x] for x in (1, 2, 3)]
    values["initial"] = dict(R=turns, body_momentum=[0, 0, 1])
    ensemble = top.ensemble(**values)
    # A rotation is made orthogonal to the last digit.
    np.testing.assert_allclose(ensemble["R"][:, 0], turns, atol=1e-15)
    assert [run.parameters["chi"][2] for run in ensemble.runs] == [1, 2, 3]
    quaternions = np.tile([1.0, 0, 0, 0], (3, 1))
    values["initial"] = dict(R=quaternions, body_momentum=[0, 0, 1])
    assert top.ensemble(**values)["R"].shape == (3, 3, 3, 3)


def test_dictionaries_for_each_body():
    model = cl.load("toda-chain")
    ensemble = model.ensemble(parameters=[dict(a=1.0), dict(a=2.0)], steps=4)
    assert ensemble["q"].shape == (2, 5, 32)
    with pytest.raises(cl.DataError, match="sequence of dictionaries"):
        model.ensemble(parameters=dict(a=[1.0, 2.0]), steps=4)


def test_wrong_ensembles(top):
    values = top_values(until=0.1)
    with pytest.raises(cl.DataError, match="no array has a value for each body"):
        top.ensemble(**values)
    values["initial"] = dict(R=np.eye(3), angular_velocity=np.zeros((2, 3)))
    values["parameters"]["chi"] = np.zeros((3, 3))
    with pytest.raises(cl.DataError, match="different numbers"):
        top.ensemble(**values)
    values["parameters"]["chi"] = [[0, 0, 1], [0, np.nan, 1]]
    with pytest.raises(cl.DataError, match="body 1: .*chi"):
        top.ensemble(**values)
    values["parameters"]["chi"] = [[0, 0, 1], [0, 0, 1]]
    with pytest.raises(cl.DataError, match="workers"):
        top.ensemble(**values, workers=0)
