"""The columns of each array in the rows of a run, and the state at one sample."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from . import _clebsch

INVARIANT = "invariant_"


class Layout:
    """The columns of each array in the rows of a run."""

    def __init__(self, running: _clebsch.Running) -> None:
        self.arrays = {name: (shape, kind, numbers) for name, shape, kind, numbers in running.arrays()}

    def of_sites(self, name: str) -> bool:
        """Whether the first index of a value is a site."""
        shape, kind, numbers = self.arrays[name]
        return kind == "listed" or (
            kind == "blocks" and (numbers[3] > 1 or (len(shape) > 0 and numbers[2] < int(np.prod(shape))))
        )

    def array(self, name: str, rows: NDArray[np.float64]) -> NDArray[Any]:
        """The array of a name; a view on the rows if its columns are equally spaced."""
        shape, kind, numbers = self.arrays[name]
        whole = (len(rows), *shape)
        if kind == "sites":
            return numbers
        if kind == "listed":
            return rows[:, numbers].reshape(whole)
        start, step, size, count = numbers
        if count == 1:
            return rows[:, start : start + size].reshape(whole)
        along, across = rows.strides
        view = np.lib.stride_tricks.as_strided(
            rows[:, start:], shape=(len(rows), count, size), strides=(along, step * across, across)
        )
        return view.reshape(whole)


class Sample:
    """The state at one sample, for the functions of `observe`.

    ``s["q"]`` is the value of the quantity `q`, ``s.t`` the time, ``s.node`` the number of the node, ``s.energy`` the energy.
    ``s.parameters`` has the parameters by name.
    """

    __slots__ = ("_layout", "_row", "node", "parameters", "t")

    def __init__(self, layout: Layout, node: int, time: float, row: NDArray[np.float64], parameters: Mapping[str, Any]) -> None:
        self._layout = layout
        self._row = row.reshape(1, -1)
        self.node = node
        self.t = time
        self.parameters = parameters

    def __getitem__(self, name: str) -> Any:
        found = self._layout.array(known(self._layout.arrays, name), self._row)[0]
        return float(found) if np.ndim(found) == 0 else found

    def keys(self) -> list[str]:
        """The names of the quantities.

        Returns
        -------
        list of str
        """
        return [name for name in self._layout.arrays if name not in ("node", "time")]

    @property
    def energy(self) -> float:
        """float : The energy, kinetic plus potential."""
        return self[INVARIANT + "energy"]

    def __repr__(self) -> str:
        return f"<Sample at node {self.node}, t = {self.t}: {', '.join(self.keys())}>"


def known(arrays: Mapping[str, Any], name: str) -> str:
    """The full name of an array; an invariant may omit its prefix."""
    if name in arrays:
        return name
    if f"{INVARIANT}{name}" in arrays:
        return INVARIANT + name
    import difflib

    near = difflib.get_close_matches(name, arrays, 1)
    hint = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(arrays)}"
    raise KeyError(f"no array {name!r}; {hint}")


def dimensions(shape: tuple[int, ...], sited: bool) -> list[str]:
    names = []
    if sited and shape:
        names.append(f"site_{shape[0]}")
        shape = shape[1:]
    if len(shape) == 1:
        names.append(f"component_{shape[0]}")
    elif len(shape) == 2:
        names.extend([f"row_{shape[0]}", f"column_{shape[1]}"])
    else:
        names.extend(f"index{at}_{size}" for at, size in enumerate(shape))
    return names
