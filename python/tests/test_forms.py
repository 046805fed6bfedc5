"""Tables, data sets, pictures and films."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from shared import top_values

import clebsch as cl


def test_tables(top):
    pytest.importorskip("pandas")
    run = top.run(**top_values(steps=10))
    frame = run.to_pandas()
    assert frame.index.name == "time" and frame["node"].tolist() == list(range(11))
    np.testing.assert_array_equal(frame[["G_1", "G_2", "G_3"]].to_numpy(), run["G"])
    np.testing.assert_array_equal(frame["R_12"], run["R"][:, 0, 1])


def test_data_sets(top):
    pytest.importorskip("xarray")
    data = top.run(**top_values(steps=10)).to_xarray()
    assert data["R"].dims == ("time", "row_3", "column_3") and data.attrs["model"] == "Top"
    assert float(data["invariant_energy"].sel(time=0.05)) > 0
    chain = cl.load("toda-chain").run(steps=3).to_xarray()
    assert chain["q"].dims == ("time", "site_32")
    rod = cl.load("kirchhoff-rod").run(steps=2).to_xarray()
    assert rod["Lambda"].dims == ("time", "site_40", "row_3", "column_3")
    assert rod["phi"].dims == ("time", "site_40", "component_3")
    assert rod["sites_of_phi"].dims == ("site_40",)


@pytest.mark.parametrize("name", ["heavy-top", "toda-chain"])
def test_pickled_runs(name):
    run = cl.load(name).run(steps=5, observe={"double_time": lambda s: 2 * s.t})
    again = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(run))))
    assert repr(again) == repr(run) and again.keys() == run.keys() and again.stated == run.stated
    for key in run.keys():
        np.testing.assert_array_equal(again[key], run[key])
    for key, values in run.initial.items():
        np.testing.assert_array_equal(again.initial[key], values)
    assert again.drift.keys() == run.drift.keys() and again.to_pandas().shape == run.to_pandas().shape


@pytest.mark.parametrize("name", ["heavy-top", "kepler", "toda-chain", "kirchhoff-rod", "particle-mesh-1d", "ellipsoid-spatial"])
def test_pictures_and_films(name, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    # Another test of this process may have left a figure open.
    before = plt.get_fignums()
    run = cl.load(name).run(steps=20)
    figure = run.plot()
    figure.savefig(tmp_path / "plot.png")
    assert len(figure.axes) >= 2
    film = run.animate(seconds=0.2)
    film.save(tmp_path / "film.gif", writer="pillow")
    assert (tmp_path / "film.gif").stat().st_size > 1000
    assert plt.get_fignums() == before


def test_pictures_of_chosen_quantities(top):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    run = top.run(**top_values(steps=20))
    figure = run.plot("G", "body_momentum")
    assert [axis.get_ylabel() for axis in figure.axes] == ["G", "body_momentum", "drift / scale"]
    with pytest.raises(KeyError):
        run.plot("nothing")
