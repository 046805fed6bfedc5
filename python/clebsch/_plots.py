"""Plots and animations of runs with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ._run import Run

# More curves in one plot cannot be distinguished.
_MOST_CURVES = 9


def _chosen(run: Run, names: tuple[str, ...]) -> list[str]:
    if names:
        return list(names)
    found = []
    for name in run.keys():
        if name in ("time", "node") or name.startswith("invariant_"):
            continue
        values = run[name]
        if values.ndim and len(values) == len(run) and (values.ndim <= 2 or run._layout.of_sites(name)) and values.ndim <= 3:
            found.append(name)
    return found[:6] or [name for name in run.keys() if run[name].ndim == 3][:2]


def plot(run: Run, names: tuple[str, ...]):
    """Quantities and drifts against time."""
    import matplotlib.pyplot as plt

    chosen = _chosen(run, names)
    panels = len(chosen) + (1 if run.invariants else 0)
    figure, axes = plt.subplots(panels, 1, figsize=(7, 1.9 * panels + 0.6), squeeze=False, layout="constrained", sharex=True)
    for axis, name in zip(axes[:, 0], chosen):
        _draw(figure, axis, run, name)
    if run.invariants:
        axis = axes[-1, 0]
        _draw_drift(axis, run)
    axes[-1, 0].set_xlabel("time")
    figure.suptitle(f"{run.model.name}, h = {run.h:g}" + (", stopped" if run.stopped else ""), fontsize="medium")
    # A notebook shows the returned figure; closing it here keeps the notebook from showing it twice.
    plt.close(figure)
    return figure


def _draw(figure: Any, axis: Any, run: Run, name: str) -> None:
    values = run[name]
    axis.set_ylabel(name)
    sited = name in run._layout.arrays and run._layout.of_sites(name)
    if sited and values.ndim == 3:
        values = np.linalg.norm(values, axis=-1)
        axis.set_ylabel(f"|{name}|")
    if sited and values.ndim == 2 and values.shape[1] > _MOST_CURVES:
        image = axis.pcolormesh(run.t, np.arange(values.shape[1]), values.T, shading="nearest", rasterized=True)
        figure.colorbar(image, ax=axis, pad=0.01, label=axis.get_ylabel())
        axis.set_ylabel("site")
        return
    flat = values.reshape(len(values), -1)
    shown = flat[:, :_MOST_CURVES]
    labels = [""] if flat.shape[1] == 1 else [str(at + 1) for at in range(shown.shape[1])]
    for at, label in enumerate(labels):
        axis.plot(run.t, shown[:, at], lw=1, label=label)
    if len(labels) > 1:
        axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="x-small", frameon=False)


def _draw_drift(axis: Any, run: Run) -> None:
    smallest = np.finfo(float).eps / 4
    for name, drift in run.drift.items():
        size = np.abs(drift) if drift.ndim == 1 else np.abs(drift).max(axis=tuple(range(1, drift.ndim)))
        # A logarithmic axis cannot show a drift of zero.
        axis.semilogy(run.t[1:], np.maximum(size[1:], smallest), lw=0.8, label=name.replace("_", " "))
    axis.set_ylabel("drift / scale")
    axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="x-small", frameon=False)


def _moving(run: Run) -> str:
    """The quantity that an animation shows by default."""
    kinds = {field["name"]: field["kind"] for field in run._running.fields()["observables"]}
    candidates = [
        name for name in run.keys() if name not in ("time", "node") and not name.startswith(("invariant_", "sites_of_"))
    ]
    for name in candidates:
        if name in run._layout.arrays and run._layout.of_sites(name) and "momentum" not in name and run[name].ndim <= 3:
            return name
    for name in candidates:
        if kinds.get(name) == "Rotation" and run[name].shape[1:] == (3, 3):
            return name
    for name in candidates:
        if run[name].shape[1:] in ((2,), (3,)) and "momentum" not in name:
            return name
    return candidates[0]


def animate(run: Run, name: str | None, seconds: float):
    """An animation of one quantity."""
    import matplotlib.pyplot as plt
    from matplotlib.animation import FuncAnimation

    name = name or _moving(run)
    values = run[name]
    frames = min(len(run), max(2, int(25 * seconds)))
    at = np.unique(np.linspace(0, len(run) - 1, frames).astype(int))
    figure = plt.figure(figsize=(5, 4.2))
    sited = name in run._layout.arrays and run._layout.of_sites(name)
    show = _film(figure, run, name, values, sited)
    title = figure.suptitle("", fontsize="medium")

    def update(frame: int):
        k = at[frame]
        title.set_text(f"{run.model.name}, {name}, t = {run.t[k]:.3g}")
        show(k)
        return ()

    film = FuncAnimation(figure, update, frames=len(at), interval=1000 * seconds / len(at), blit=False)
    plt.close(figure)
    return film


def _limits(values: np.ndarray) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    gap = 0.05 * (high - low) or 0.5
    return low - gap, high + gap


def _equal(axis: Any, values: np.ndarray) -> None:
    """The same scale along every direction."""
    points = values.reshape(-1, values.shape[-1])
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    half = 0.55 * float((points.max(axis=0) - points.min(axis=0)).max()) or 0.5
    for letter, middle in zip("xyz", centre):
        getattr(axis, f"set_{letter}lim")(middle - half, middle + half)
    axis.set_aspect("equal")


def _film(figure: Any, run: Run, name: str, values: np.ndarray, sited: bool):
    """Draw the first frame. Returns a function that shows the sample with a given index."""
    flat = values.ndim == 1 or (sited and values.ndim == 2)
    if flat and sited:
        axis = figure.add_subplot()
        (line,) = axis.plot(values[0], ".-", ms=3, lw=1)
        axis.set_ylim(*_limits(values))
        axis.set_xlabel("site")
        axis.set_ylabel(name)
        return lambda k: line.set_ydata(values[k])
    if values.shape[1:] == (3, 3) and not sited:
        axis = figure.add_subplot(projection="3d")
        _equal(axis, np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]))
        lines = [axis.plot([], [], [], lw=2.5, label=f"axis {j + 1}")[0] for j in range(3)]
        (path,) = axis.plot([], [], [], lw=0.6, color="grey")
        axis.legend(fontsize="x-small", frameon=False)

        def turn(k: int) -> None:
            for j, line in enumerate(lines):
                end = values[k][:, j]
                line.set_data_3d([0, end[0]], [0, end[1]], [0, end[2]])
            trail = values[max(0, k - 400) : k + 1, :, 2]
            path.set_data_3d(*trail.T)

        return turn
    if values.shape[-1] in (2, 3) and values.ndim == (3 if sited else 2):
        space = values.shape[-1] == 3
        axis = figure.add_subplot(projection="3d") if space else figure.add_subplot()
        _equal(axis, values)
        many = sited and values.shape[1] > 200
        (line,) = axis.plot(*([[]] * values.shape[-1]), "." if many or not sited else ".-", ms=2 if many else 5, lw=1)
        (path,) = axis.plot(*([[]] * values.shape[-1]), lw=0.6, color="grey")

        def place(k: int) -> None:
            points = values[k] if sited else values[k : k + 1]
            trail = values[max(0, k - 2000) : k + 1] if not sited else values[:0, 0]
            for drawn, own in ((line, points), (path, trail)):
                drawn.set_data_3d(*own.T) if space else drawn.set_data(*own.T)

        return place
    axis = figure.add_subplot()
    rows = values.reshape(len(values), -1)
    axis.plot(run.t, rows, lw=1)
    line = axis.axvline(run.t[0], color="grey", lw=0.8)
    axis.set_xlabel("time")
    axis.set_ylabel(name)
    return lambda k: line.set_xdata([run.t[k], run.t[k]])
