"""Many bodies of one model, side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _clebsch
from ._errors import DataError
from ._progress import Progress
from ._run import Run

if TYPE_CHECKING:
    from ._model import Model


class Ensemble:
    """The runs of many bodies. `Model.ensemble` returns it.

    ``ensemble["q"]`` is the array of the quantity `q`: its first index is the body, its second index the sample. A body whose run
    ended early has NaN after its last sample.

    Attributes
    ----------
    runs : list of Run
        The run of each body.
    stopped : dict of int to str
        The bodies whose runs ended early, with the reason.
    """

    def __init__(self, runs: list[Run]) -> None:
        self.runs = runs
        self.stopped = {at: run.stopped for at, run in enumerate(runs) if run.stopped is not None}

    def __len__(self) -> int:
        """The number of bodies."""
        return len(self.runs)

    def keys(self) -> list[str]:
        """The names of all arrays.

        Returns
        -------
        list of str
        """
        return self.runs[0].keys()

    @property
    def t(self) -> NDArray[np.float64]:
        """ndarray, shape (samples,) : The time of each sample."""
        return max((run.t for run in self.runs), key=len)

    def __getitem__(self, name: str) -> NDArray[Any]:
        samples = len(self.t)
        first = self.runs[0][name]
        if not self.stopped:
            return np.stack([run[name] for run in self.runs])
        out = np.full((len(self.runs), samples, *first.shape[1:]), np.nan)
        for at, run in enumerate(self.runs):
            out[at, : len(run)] = run[name]
        return out

    @property
    def energy(self) -> NDArray[np.float64]:
        """ndarray, shape (bodies, samples) : The energy of each body."""
        return self["energy"]

    @property
    def drift(self) -> dict[str, NDArray[np.float64]]:
        """dict of str to ndarray : The largest drift of each invariant for each body, relative to its scale."""
        names = self.runs[0].invariants
        return {name: np.array([run.invariants[name].worst for run in self.runs]) for name in names}

    def check(self) -> Ensemble:
        """Compare the drift of every invariant of every body with its bound.

        Returns
        -------
        Ensemble
            The ensemble itself.

        Raises
        ------
        InvariantError
            An invariant exceeded its bound.
        """
        for run in self.runs:
            run.check()
        return self

    def __repr__(self) -> str:
        stopped = f", {len(self.stopped)} of them stopped" if self.stopped else ""
        return (
            f"<Ensemble of {len(self)} bodies of {self.runs[0].model.name}: {len(self.t)} samples to t = {self.t[-1]:g}{stopped}>"
        )


def ensembled(
    model: Model,
    case: str | None,
    parameters: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None,
    initial: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None,
    workers: int | None,
    progress: bool,
    values: dict[str, Any],
) -> Ensemble:
    """Run many bodies."""
    both = {"parameters": parameters, "initial": initial}
    bodies = {key: _bodies(key, own, model) for key, own in both.items() if own is not None}
    counts = {f"{key}.{name}" if name else key: count for key, (counted, _) in bodies.items() for name, count in counted.items()}
    different = sorted(set(counts.values()))
    if len(different) > 1:
        told = ", ".join(f"{name} has {count}" for name, count in counts.items())
        raise DataError(f"ensemble: the arrays have different numbers of bodies: {told}; give each the same number", "initial")
    if not different:
        raise DataError("ensemble: no array has a value for each body; give one with the body as its first index", "initial")
    cases: list[tuple[str, str]] = []
    options: dict[str, Any] = {}
    for at in range(different[0]):
        own = {key: body(at) for key, (_, body) in bodies.items()}
        file, text, options = model._compose(case, {**values, **own})
        cases.append((file, text))
    if not cases:
        raise DataError("ensemble: there are no bodies", "initial")
    bar = Progress(len(cases), "body", progress)
    try:
        ended = _clebsch.run_many(model._inner, cases, options, workers, bar.tell)
    finally:
        bar.close()
    runs = []
    for at, (running, why) in enumerate(ended):
        if running is None and why == "interrupted":
            raise KeyboardInterrupt
        if running is None:
            text = (why or "").removeprefix(f"{cases[at][0]}:")
            raise DataError(f"body {at}: {text.strip()}")
        runs.append(Run(model, running, {}, why))
    return Ensemble(runs)


def _bodies(key: str, own: Any, model: Model):
    """The number of bodies in each array that varies by body, by name, and a function that gives the values of one body."""
    if isinstance(own, Mapping):
        shapes = _shapes(model, key)
        counted = {}
        for name, value in own.items():
            if isinstance(value, (str, Mapping)) or value is None:
                continue
            array = np.asarray(value)
            if array.dtype == object or array.ndim == 0:
                continue
            if array.ndim > _depth(name, array.shape, shapes):
                counted[name] = len(array)

        def body(at: int) -> dict[str, Any]:
            return {name: np.asarray(value)[at] if name in counted else value for name, value in own.items()}

        return counted, body
    if isinstance(own, Sequence) and all(isinstance(each, Mapping) for each in own):
        return {"": len(own)}, lambda at: dict(own[at])
    raise DataError(f"{key}: expected a dictionary, or a sequence of dictionaries, one for each body", key)


def _shapes(model: Model, key: str) -> dict[str, tuple[tuple[int, ...], str]]:
    if model._inner.has_sites:
        raise DataError(
            "ensemble: the values of a chain have an index of sites; give a sequence of dictionaries, one for each body", key
        )
    fields = [*model.card["parameters"], *model.card["initial"]]
    return {field["name"]: (field["shape"], field["kind"]) for field in fields}


def _depth(name: str, shape: tuple[int, ...], shapes: Mapping[str, tuple[tuple[int, ...], str]]) -> int:
    """The number of indices of one body's value."""
    if name in shapes:
        own, kind = shapes[name]
        # Quaternions have one index, and a list of entries can give a diagonal matrix.
        if kind in ("Rotation", "UnitQuaternion") and shape[-1] == 4 and own != shape[-2:]:
            return 1
        if kind == "Diagonal" and shape[-2:] != own:
            return 1
        return len(own)
    if name.startswith(("angular_velocity", "spatial_angular_velocity")):
        return 1
    momentum = name.replace("velocity", "momentum", 1)
    if momentum in shapes:
        return len(shapes[momentum][0])
    # An inertia replaces second moments; the case reader rejects any other name.
    return len(shapes[f"J{name[1:]}"][0]) if f"J{name[1:]}" in shapes else 1
