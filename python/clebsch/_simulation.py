"""A simulation that you can advance step by step, save and resume."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._errors import DataError, StepError
from ._layout import INVARIANT, Layout, known

if TYPE_CHECKING:
    from . import _clebsch
    from ._model import Model

_MAGIC = b"clebsch simulation 1\n"


class Simulation:
    """A model at a node in time. `Model.start` and `resume` return it.

    Attributes
    ----------
    model : Model
        The model.
    """

    def __init__(self, model: Model, running: _clebsch.Running, data: dict[str, Any]) -> None:
        self.model = model
        self._running = running
        self._data = data
        self._layout = Layout(running)
        self._numbers: dict[str, Any] | None = None

    def step(self, steps: int = 1) -> Simulation:
        """Take steps.

        Parameters
        ----------
        steps : int, default 1
            The number of steps.

        Returns
        -------
        Simulation
            The simulation itself.

        Raises
        ------
        StepError
            A step failed. The simulation stays at the node before it.
        KeyboardInterrupt
            You interrupted the steps. The simulation stays at the node that it reached.
        """
        if steps < 0:
            raise DataError(f"steps: expected at least 0, found {steps}", "steps")
        _, failed = self._running.step(steps)
        if failed is not None:
            node, time, text = failed
            raise StepError(text, node, time)
        return self

    @property
    def node(self) -> int:
        """int : The number of steps since the start."""
        return self._running.place()[0]

    @property
    def t(self) -> float:
        """float : The time, in the unit of time of the model."""
        return self._running.place()[1]

    @property
    def state(self) -> dict[str, NDArray[Any]]:
        """dict of str to ndarray : The observables by name, as in a `Run` without the index of the sample. They are copies."""
        return {name: value for name, value in self._values().items() if not name.startswith(INVARIANT)}

    @property
    def invariants(self) -> dict[str, NDArray[np.float64]]:
        """dict of str to ndarray : The values of the invariants by name."""
        values = self._values().items()
        return {name[len(INVARIANT) :]: value for name, value in values if name.startswith(INVARIANT)}

    @property
    def energy(self) -> float:
        """float : The energy, kinetic plus potential."""
        return float(self["energy"])

    @property
    def case(self) -> dict[str, Any]:
        """dict : The initial data: `h`, `order`, and `parameters` and `initial` with all values."""
        if self._numbers is None:
            self._numbers = self._running.case()
        return self._numbers

    def __getitem__(self, name: str) -> NDArray[Any]:
        row = self._running.row().reshape(1, -1)
        return self._layout.array(known(self._layout.arrays, name), row)[0]

    def _values(self) -> dict[str, NDArray[Any]]:
        row = self._running.row().reshape(1, -1)
        return {
            name: self._layout.array(name, row)[0]
            for name, (_, kind, _) in self._layout.arrays.items()
            if kind not in ("nodes", "times", "sites")
        }

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the simulation to a file, from which `resume` continues bit for bit.

        Parameters
        ----------
        path : path
            The file. An existing file is replaced once the new file is complete.

        Raises
        ------
        StepError
            The state of this model cannot be saved.
        """
        state = self._running.save()
        if state is None:
            raise StepError("the state of this model cannot be saved; run it without halve", *self._running.place())
        head = json.dumps(self._data).encode()
        path = os.fspath(path)
        beside = f"{path}.{os.getpid()}.unfinished"
        try:
            with open(beside, "wb") as file:
                file.write(_MAGIC)
                file.write(len(head).to_bytes(8, "little"))
                file.write(head)
                file.write(state)
                file.flush()
                os.fsync(file.fileno())
            os.replace(beside, path)
        finally:
            if os.path.exists(beside):
                os.remove(beside)

    def __repr__(self) -> str:
        return f"<Simulation of {self.model.name} at node {self.node}, t = {self.t:g}>"


def started(model: Model, case: str | None, values: dict[str, Any]) -> Simulation:
    """Start a simulation."""
    for key in ("steps", "until", "every", "judge"):
        if key in values:
            raise DataError(f"{key}: a simulation has no end and no samples; call step, or use Model.run", key)
    file, text, options = model._compose(case, {**values, "steps": 1})
    named = model._inner.name if model.cases else None
    data = {"model": named, "source": model.source, "file": file, "case": text, "options": options}
    return Simulation(model, model._inner.start(file, text, options, False), data)


def resume(path: str | os.PathLike[str]) -> Simulation:
    """Continue a saved simulation.

    Parameters
    ----------
    path : path
        A file that `Simulation.save` wrote.

    Returns
    -------
    Simulation
        Its steps equal the steps of a simulation that was never saved, bit for bit.

    Raises
    ------
    DataError
        The file is damaged, or another version of clebsch wrote it.
    """
    from ._gallery import load
    from ._model import Model

    name = os.fspath(path)
    with open(path, "rb") as file:
        whole = file.read()
    if not whole.startswith(_MAGIC):
        raise DataError(f"{name} is not a saved simulation; give a file that Simulation.save wrote", "path")
    rest = whole[len(_MAGIC) :]
    length = int.from_bytes(rest[:8], "little")
    try:
        data = json.loads(rest[8 : 8 + length])
        shipped, source = data["model"], data["source"]
    except (ValueError, KeyError, TypeError):
        raise DataError(f"{name} is damaged: its head cannot be read", "path") from None
    model = None
    if shipped is not None:
        try:
            model = load(shipped)
        except DataError:
            model = None
    if model is None or model.source != source:
        model = Model(source)
    running = model._inner.start(data["file"], data["case"], data["options"], False)
    try:
        running.restore(rest[8 + length :])
    except ValueError as why:
        raise DataError(f"{name} cannot be resumed: {why}", "path") from None
    return Simulation(model, running, data)
