"""The results of a run, as arrays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._errors import InvariantError
from ._layout import INVARIANT, Layout, dimensions, known

if TYPE_CHECKING:
    from . import _clebsch
    from ._model import Model


class Invariant(NamedTuple):
    """The outcome of an invariant along a run.

    Attributes
    ----------
    name, formula : str
        The name and the formula.
    exact : bool
        Whether it is conserved to rounding. Other invariants oscillate within a bound.
    scale : float
        The largest sum of the absolute values of its terms along the run.
    worst : float
        The largest drift at a sample, relative to the scale. It is absolute if the scale is zero.
    last : float
        The drift at the end, with its sign.
    bound : float or None
        The bound of the case.
    verdict : str
        The verdict of the command: ``"within bound"``, ``"EXCEEDED"`` or ``"no bound"``.
    """

    name: str
    formula: str
    exact: bool
    scale: float
    worst: float
    last: float
    bound: float | None
    verdict: str


class _Finished:
    """The answers of a `Running` after its last step, as plain values: the part that a pickled run contains."""

    _ASKED = ("arrays", "case", "columns", "fields", "halvings", "outcomes", "stated", "summary", "warnings")

    def __init__(self, running: _clebsch.Running | _Finished) -> None:
        self._answers = {name: getattr(running, name)() for name in self._ASKED}

    def __getattr__(self, name: str) -> Any:
        answers = self.__dict__.get("_answers", {})
        if name not in answers:
            raise AttributeError(name)
        return lambda: answers[name]


class Run:
    """The results of a run.

    ``run["q"]`` is the array of the quantity `q`: its first index is the sample, the other indices belong to the quantity. Names
    and shapes are the same as in ``trajectory.npz``, which the command writes: observables have their names, and invariants have
    the prefix ``invariant_``, which you may omit. Arrays are views of the same memory if possible. A run can be pickled.

    Attributes
    ----------
    t : ndarray of float, shape (samples,)
        The time of each sample, in the unit of time of the model.
    node : ndarray of int, shape (samples,)
        The number of steps before each sample.
    model : Model
        The model.
    steps : int
        The number of completed steps.
    stopped : str or None
        The reason if the run ended early. None if it is complete.
    warnings : list of str
        Warnings: a kinetic energy that is not positive definite, an invariant that was lost.
    """

    def __init__(self, model: Model, running: _clebsch.Running, observed: Mapping[str, list[Any]], stopped: str | None) -> None:
        self.model = model
        self._running = running
        nodes, self.t, self._rows = running.take()
        self.node = nodes.view(np.int64)
        self.stopped = stopped
        self.steps = running.summary()[0]
        self._known_layout: Layout | None = None
        self._known_case: dict[str, Any] | None = None
        self._known_outcomes: list[dict[str, Any]] | None = None
        self._observed = {name: np.asarray(values) for name, values in observed.items()}

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_running": _Finished(self._running)}

    # Arrays.

    @property
    def _layout(self) -> Layout:
        if self._known_layout is None:
            self._known_layout = Layout(self._running)
        return self._known_layout

    def keys(self) -> list[str]:
        """The names of all arrays.

        Returns
        -------
        list of str
        """
        return [*self._layout.arrays, *self._observed]

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __contains__(self, name: object) -> bool:
        return name in self.keys() or f"{INVARIANT}{name}" in self._layout.arrays

    def __len__(self) -> int:
        """The number of samples."""
        return len(self.t)

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name in self._observed:
            return self._observed[name]
        if name == "time":
            return self.t
        if name == "node":
            return self.node
        return self._layout.array(known(self._layout.arrays, name), self._rows)

    @property
    def energy(self) -> NDArray[np.float64]:
        """ndarray, shape (samples,) : The energy, kinetic plus potential, in the unit of energy of the model."""
        return self["energy"]

    @property
    def complete(self) -> bool:
        """bool : Whether all steps are complete."""
        return self.stopped is None

    # Numbers of the run.

    @property
    def case(self) -> dict[str, Any]:
        """dict : The numbers of the run: `h`, `steps`, `every`, `order`, and `parameters` and `initial` with all values."""
        if self._known_case is None:
            self._known_case = self._running.case()
        return self._known_case

    @property
    def h(self) -> float:
        """float : The step size."""
        return self.case["h"]

    @property
    def parameters(self) -> dict[str, Any]:
        """dict : The values of all parameters, as arrays."""
        return self.case["parameters"]

    @property
    def initial(self) -> dict[str, Any]:
        """dict : The initial values, including the momenta computed from velocities, as arrays."""
        return self.case["initial"]

    # Invariants.

    def _outcomes(self) -> list[dict[str, Any]]:
        if self._known_outcomes is None:
            self._known_outcomes = self._running.outcomes()
        return self._known_outcomes

    @property
    def invariants(self) -> dict[str, Invariant]:
        """dict of str to Invariant : The outcome of each invariant, as in the table of the command."""
        return {own["name"]: Invariant(**{key: own[key] for key in Invariant._fields}) for own in self._outcomes()}

    @property
    def drift(self) -> dict[str, NDArray[np.float64]]:
        """dict of str to ndarray : The drift of each invariant since the start, relative to its scale, at every sample.

        The shape is (samples,), or (samples, n) for an invariant of n components. If the scale of a component is zero, its drift
        is absolute.
        """
        found = {}
        for own in self._outcomes():
            values = self._layout.array(INVARIANT + own["name"], self._rows)
            scales = np.where(own["scales"] > 0, own["scales"], 1.0)
            found[own["name"]] = (values - values[:1]) / (scales if values.ndim > 1 else scales[0])
        return found

    @property
    def stated(self) -> tuple[str, int, bool | None] | None:
        """tuple or None : The result of the independent check against the action as stated.

        A sentence, the number of judged steps, and whether they passed. None if no step was judged.
        """
        return self._running.stated()

    @property
    def substeps(self) -> tuple[int, int] | None:
        """tuple of int or None : The number of subdivided steps, and the largest number of substeps. None without `halve`."""
        return self._running.halvings()

    @property
    def warnings(self) -> list[str]:
        """list of str : Warnings: a kinetic energy that is not positive definite, an invariant that was lost."""
        return self._running.warnings()

    def check(self) -> Run:
        """Compare the drift of every invariant with its bound.

        An invariant that is conserved to rounding has the bound 1e-12 if the case gives none.

        Returns
        -------
        Run
            The run itself.

        Raises
        ------
        InvariantError
            An invariant exceeded its bound, or a judged step does not solve the equations of the action as stated.
        """
        beyond = [own for own in self._outcomes() if own["exceeded"]]
        wrong = [
            f"{own['name']} drifts by {own['worst']:.3e}, more than its bound {own['bound']}"
            if own["bound"] is not None
            else f"{own['name']} is not a number"
            for own in beyond
        ]
        stated = self.stated
        if stated is not None and stated[2] is False:
            wrong.append(f"steps do not solve the equations of the action as stated: {stated[0]}")
        if wrong:
            text = "; ".join(wrong) + ". Reduce h, or give a larger bound by bounds={...}"
            raise InvariantError(text, tuple(own["name"] for own in beyond), self)
        return self

    # Other forms.

    def to_pandas(self):
        """The samples as a table.

        Returns
        -------
        pandas.DataFrame
            A row for each sample, with the time as index. The columns are those of ``trajectory.csv``: components count from 1,
            rows before columns.
        """
        import pandas as pd

        frame = pd.DataFrame(self._rows, columns=self._running.columns(), copy=False)
        frame.insert(0, "node", self.node)
        frame.index = pd.Index(self.t, name="time")
        extra = {}
        for name, values in self._observed.items():
            if values.ndim == 1:
                extra[name] = values
            else:
                flat = values.reshape(len(values), -1)
                extra.update({f"{name}_{at + 1}": flat[:, at] for at in range(flat.shape[1])})
        return frame.assign(**extra) if extra else frame

    def to_xarray(self):
        """The arrays with names for their indices.

        Returns
        -------
        xarray.Dataset
            Its dimensions are `time`, ``site_n`` for the n sites of a chain, ``component_n`` for vectors, and ``row_n`` and
            ``column_n`` for matrices. The attributes have the name of the model and the step size.
        """
        import xarray as xr

        arrays = {}
        for name in self.keys():
            if name in ("time", "node"):
                continue
            values = self[name]
            if name in self._layout.arrays and self._layout.arrays[name][1] == "sites":
                arrays[name] = ((f"site_{len(values)}",), values)
                continue
            sited = name in self._layout.arrays and self._layout.of_sites(name)
            arrays[name] = (("time", *dimensions(values.shape[1:], sited)), values)
        coordinates = {"time": self.t, "node": ("time", self.node)}
        attributes = {"model": self.model.name, "h": self.h, "stopped": self.stopped or ""}
        return xr.Dataset(arrays, coords=coordinates, attrs=attributes)

    # Pictures.

    def plot(self, *names: str):
        """Draw quantities and the drift of the invariants against time.

        Parameters
        ----------
        *names : str
            Names of arrays. By default the vectors and numbers that the model observes.

        Returns
        -------
        matplotlib.figure.Figure
        """
        from ._plots import plot

        return plot(self, names)

    def animate(self, name: str | None = None, seconds: float = 8.0):
        """Show the motion as an animation.

        Parameters
        ----------
        name : str, optional
            The quantity to show: a rotation as three axes, a position in the plane or in space as a point with its path, values
            at the sites of a chain as a line, the particles of a fluid as points. By default the first such quantity.
        seconds : float, default 8
            The length of the animation in seconds.

        Returns
        -------
        matplotlib.animation.FuncAnimation
            Notebooks can play it; its method `save` writes a file.
        """
        from ._plots import animate

        return animate(self, name, seconds)

    def __repr__(self) -> str:
        end = self.t[-1] if len(self.t) else 0.0
        lines = [f"<Run of {self.model.name}: {self.steps} steps of h = {self.h:g} to t = {end:g}, {len(self)} samples>"]
        for own in self.invariants.values():
            lines.append(f"  {own.name}: drift {own.worst:.2e}, {own.verdict}")
        if self.stopped:
            lines.append(f"  stopped: {self.stopped}")
        lines.extend(f"  warning: {text}" for text in self.warnings)
        return "\n".join(lines)
