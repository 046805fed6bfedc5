"""Models: their texts, their derivations, and their runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

from . import _clebsch
from ._advance import finished
from ._derivation import Derivation, brief, for_notebook
from ._layout import Sample
from ._run import Run

if TYPE_CHECKING:
    from ._ensemble import Ensemble
    from ._simulation import Simulation

Values = Mapping[str, Any]

_TABLES = ("labels", "domain", "ends", "functions", "parameters", "initial", "bounds")
_TOP = ("h", "steps")
_OPTIONS = ("until", "every", "order", "solver", "compensated", "halve", "judge")


class Model:
    """A mechanical or fluid model, stated by a discrete Lagrangian.

    Parameters
    ----------
    text : str
        The statement of the model, ``model Name { ... }``. The language reference is ``docs/language.md`` of the project.
    name : str, default "model"
        The name of the text in messages.

    Raises
    ------
    ModelError
        The text is wrong. The message marks the position in the source and says what to write instead.

    See Also
    --------
    load : A shipped model, or the model of a file.

    Notes
    -----
    Two models with the same text share one derivation. A notebook shows the typeset equations of a model, and its invariants
    with the reason why each is conserved.

    Examples
    --------
    >>> import clebsch as cl
    >>> top = cl.Model('''model Top {
    ...     param J: Sym<3>; param chi, z: Vec<3>;
    ...     group R: SO<3> velocity W; advected G: Vec<3> = R^T*z;
    ...     constraint next(R) = R*W; constraint next(G) = W^T*G;
    ...     lagrangian = -tr(J*W)/h - h*dot(chi, G);
    ... }''')
    >>> run = top.run(parameters=dict(J=[[.5, 0, 0], [0, .5, 0], [0, 0, 1.5]], chi=[0, 0, 1], z=[0, 0, 1]),
    ...               initial=dict(R=cl.axis_angle([1, 0, 0], 0.6), angular_velocity=[0.1, 0, 5]), h=0.01, until=1)
    >>> run["body_momentum"].shape
    (101, 3)
    """

    _inner: _clebsch.Model

    def __init__(self, text: str, name: str = "model") -> None:
        self._inner = _clebsch.Model.of_text(text, name)
        self._set_up()

    @classmethod
    def _of(cls, inner: _clebsch.Model) -> Model:
        own = cls.__new__(cls)
        own._inner = inner
        own._set_up()
        return own

    def _set_up(self) -> None:
        self._derivation: Derivation | None = None
        self._card: dict[str, Any] | None = None
        self._bases: dict[str | None, tuple[str, str]] = {}
        self._cases: list[tuple[str, str]] | None = None

    # Statement.

    @property
    def name(self) -> str:
        """str : The name that the text declares."""
        return self._inner.declared

    @property
    def source(self) -> str:
        """str : The text of the model."""
        return self._inner.source

    @property
    def doc(self) -> str:
        """str : The documentation comments of the text."""
        return self.card["doc"]

    @property
    def warnings(self) -> str:
        """str : Warnings on the text, each with a caret under the source. Empty if there are none."""
        return self._inner.warnings

    @property
    def derivation(self) -> Derivation:
        """Derivation : The discrete equations, their proof and the invariants."""
        if self._derivation is None:
            self._derivation = Derivation(self)
        return self._derivation

    @property
    def card(self) -> dict[str, Any]:
        """dict : Parameters, initial values, observables, invariants, solver and order of the model.

        For a chain or a fluid, they belong to the default number of sites.
        """
        if self._card is None:
            self._card = self._inner.card()
        return self._card

    @property
    def parameters(self) -> list[str]:
        """list of str : The names of the parameters."""
        return [field["name"] for field in self.card["parameters"]]

    @property
    def initial(self) -> list[str]:
        """list of str : The names of the initial values. A velocity may replace a momentum, see `run`."""
        return [field["name"] for field in self.card["initial"]]

    @property
    def cases(self) -> dict[str, str]:
        """dict : The names of the cases of a shipped model or a model file, the default case first, each with a description."""
        if self._cases is None:
            self._cases = self._inner.cases()
        return dict(self._cases)

    def case(self, name: str | None = None) -> dict[str, Any]:
        """The values of a case.

        Parameters
        ----------
        name : str, optional
            A name of `cases`, the path of a case file, or ``"sample"`` for placeholder values. The default is the first case.

        Returns
        -------
        dict
            Values by the keys of a case file: `h`, `steps`, `parameters`, `initial`, and for chains and fluids `labels`,
            `ends` and `domain`. `run` has an argument with the name of each key.

        Raises
        ------
        DataError
            There is no such case.
        """
        return self._inner.case(name)

    # Runs.

    def run(
        self,
        case: str | None = None,
        *,
        parameters: Values | None = None,
        initial: Values | None = None,
        h: float | None = None,
        steps: int | None = None,
        until: float | None = None,
        every: int | None = None,
        order: int | None = None,
        solver: str | None = None,
        compensated: bool = False,
        halve: bool = False,
        labels: Values | None = None,
        ends: Values | None = None,
        domain: Values | None = None,
        functions: Values | None = None,
        bounds: Values | None = None,
        observe: Mapping[str, Callable[[Sample], Any]] | None = None,
        judge: Literal["sample", "all"] | None = None,
        progress: bool = True,
    ) -> Run:
        """Run the model from an initial state.

        Parameters
        ----------
        case : str, optional
            A name of `cases` or the path of a case file. The values below override the values of the case. A shipped model uses
            its first case by default; your own model needs all values.
        parameters : dict, optional
            Parameters by name, in any consistent system of units. A number, a vector of shape (n,), a matrix of shape (n, m),
            or a text with an expression such as ``"2*pi/T"``. You may give the inertia instead of second moments `J`,
            ``dict(I=[1, 2, 3])``. At the sites of a chain: one value for all sites, an expression in the site's number,
            or an array whose first index is the site. None removes the value of the case.
        initial : dict, optional
            Configurations at node 0, with momenta or velocities. A rotation is a matrix of shape (3, 3) that maps the body
            frame to the space frame, a unit quaternion (w, x, y, z), or a dictionary such as
            ``dict(axis=[0, 0, 1], angle=1)``. Momenta have the names in `initial`. You may give velocities
            instead: ``velocity_x`` for a field `x`, and for a rotation ``angular_velocity`` in the body frame or
            ``spatial_angular_velocity`` in the space frame. If several bodies rotate, append the name of the body, as in
            ``angular_velocity_R``. A configuration without momentum and velocity starts at rest.
        h : float, optional
            The step size, in the unit of time of the model.
        steps : int, optional
            The number of steps.
        until : float, optional
            The final time, instead of `steps`. The run ends at the nearest node.
        every : int, optional
            The number of nodes between samples. By default at most 10,000 nodes are sampled; 0 samples only the start and the end.
        order : int, optional
            The order of accuracy of a step, one of ``card["orders"]``.
        solver : str, optional
            The solver of the implicit step, one of ``card["solvers"]``.
        compensated : bool, default False
            Add a constant rotation about the momentum to each step of order 4, 6 or 8 of a free body. The steps are then
            symplectic.
        halve : bool, default False
            Retry a failed step as 2, 4, ... substeps. The run is then not symplectic.
        labels : dict, optional
            The number of sites of each label of a chain or a fluid, as in ``dict(i=64)``.
        ends : dict, optional
            The end conditions of each label, as in ``dict(i=["clamped", "free"])`` or ``dict(i="periodic")``.
        domain : dict, optional
            The lengths of the domain of a fluid.
        functions : dict, optional
            Expressions of the functions that the text of the model leaves to the case.
        bounds : dict, optional
            The largest drift of each invariant, relative to its scale. `Run.check` compares with it.
        observe : dict, optional
            Functions of a `Sample`, evaluated at every sample during the run. Each returns a number or an array, and the run
            has an array with its name.
        judge : {'sample', 'all'}, optional
            Compare a sample of a hundred steps and the last step, or all steps, with the action as stated. This check is
            independent of the derivation. See `Run.stated`.
        progress : bool, default True
            Show a progress bar after one second, if tqdm is installed.

        Returns
        -------
        Run
            Arrays by name. If you interrupt the run (Ctrl-C), it ends at this node, and `Run.stopped` contains the reason.

        Raises
        ------
        DataError
            A value is wrong. The message names the argument.
        StepError
            A step failed. The attribute `run` contains the results before it.
        """
        running = self._start(
            case,
            dict(
                parameters=parameters, initial=initial, h=h, steps=steps, until=until, every=every, order=order,
                solver=solver, compensated=compensated, halve=halve, labels=labels, ends=ends, domain=domain,
                functions=functions, bounds=bounds, judge=judge,
            ),
        )  # fmt: skip
        return finished(self, running, observe, progress)

    def start(self, case: str | None = None, **values: Any) -> Simulation:
        """Start a simulation that you advance step by step.

        Parameters
        ----------
        case : str, optional
            A name of `cases` or the path of a case file.
        **values
            The parameters, initial values and options of `run`. A number of steps is not needed.

        Returns
        -------
        Simulation

        Raises
        ------
        DataError
            A value is wrong. The message names the argument.
        """
        from ._simulation import started

        return started(self, case, values)

    def sweep(
        self,
        case: str | None = None,
        *,
        vary: Mapping[str, Sequence[Any]] | None = None,
        h: float | Sequence[float] | None = None,
        workers: int | None = None,
        progress: bool = True,
        **values: Any,
    ) -> Any:
        """Run a case at every point of a grid of values, on all cores.

        Parameters
        ----------
        case : str, optional
            A name of `cases` or the path of a case file.
        vary : dict
            Parameters or initial values by name, each with a sequence of values. A name with a point is a component, as in
            ``"chi.z"`` or ``"J.11"``.
        h : float or sequence of float, optional
            The step size, or several step sizes, which add a direction to the grid.
        workers : int, optional
            The number of threads. The default is the number of cores. Results do not depend on it.
        progress : bool, default True
            Show a progress bar after one second, if tqdm is installed.
        **values
            The other values and options of `run`.

        Returns
        -------
        pandas.DataFrame
            One row for each point; the last name varies fastest. The columns are the values, `status` (``"complete"``,
            ``"stopped"``, ``"refused"``, or ``"interrupted"`` after Ctrl-C), `why`, `steps`, `time`, `within_bounds`, the drift of
            every invariant, and the observables at the end. If a varied initial value and an observable have the same name, the
            column of the initial value is ``initial.name``. A dictionary of arrays if pandas is not installed.

        Raises
        ------
        DataError
            A name or a value is wrong.
        """
        from ._sweep import swept

        return swept(self, case, dict(vary or {}), h, workers, progress, values)

    def ensemble(
        self,
        case: str | None = None,
        *,
        parameters: Values | Sequence[Values] | None = None,
        initial: Values | Sequence[Values] | None = None,
        workers: int | None = None,
        progress: bool = True,
        **values: Any,
    ) -> Ensemble:
        """Run many bodies of the model side by side, on all cores.

        Parameters
        ----------
        case : str, optional
            A name of `cases` or the path of a case file.
        parameters, initial : dict or sequence of dict, optional
            As for `run`. An array with one more index in front has a value for each body. A sequence has a dictionary
            for each body.
        workers : int, optional
            The number of threads. The default is the number of cores. Results do not depend on it.
        progress : bool, default True
            Show a progress bar after one second, if tqdm is installed.
        **values
            The other values and options of `run`, the same for all bodies.

        Returns
        -------
        Ensemble
            Arrays by name, whose first index is the body and whose second index is the sample.

        Raises
        ------
        DataError
            A value is wrong, or two arrays have different numbers of bodies. The message names the body.
        """
        from ._ensemble import ensembled

        return ensembled(self, case, parameters, initial, workers, progress, values)

    # Assembly of a case.

    def _base(self, case: str | None) -> tuple[str, str] | None:
        """The case to which values are added: its name in messages, and its text."""
        if case is None and not self.cases:
            return None
        # The file may have changed.
        if case is not None and case.endswith(".toml"):
            return self._inner.case_text(case)
        if case not in self._bases:
            self._bases[case] = self._inner.case_text(case)
        return self._bases[case]

    def _compose(self, case: str | None, values: Mapping[str, Any]) -> tuple[str, str, dict[str, Any]]:
        """The name of the case in messages, its text, and the options."""
        unknown = [key for key in values if key not in _TABLES and key not in _TOP and key not in _OPTIONS]
        if unknown:
            from ._errors import DataError

            known = ", ".join((*_TABLES, *_TOP, *_OPTIONS))
            raise DataError(f"{unknown[0]}: no such argument; the arguments are {known}", unknown[0])
        base = self._base(case)
        tables = {key: values[key] for key in _TOP if values.get(key) is not None}
        for key in _TABLES:
            own = values.get(key)
            if own is not None:
                tables[key] = _table(key, own)
        options = {key: values[key] for key in _OPTIONS if key in values}
        if base is None:
            return "arguments", self._inner.compose(None, tables), options
        file, text = base
        return file, self._inner.compose(text, tables) if tables else text, options

    def _start(self, case: str | None, values: Mapping[str, Any], sampled: bool = True) -> _clebsch.Running:
        file, text, options = self._compose(case, values)
        return self._inner.start(file, text, options, sampled)

    def __reduce__(self):
        if self.cases:
            from ._gallery import load

            return load, (self._inner.name,)
        return Model, (self.source, self._inner.name)

    # Display.

    def __repr__(self) -> str:
        parameters, initial = (", ".join(self._short(which)) for which in ("parameters", "initial"))
        cases = f"; cases {', '.join(self.cases)}" if self.cases else ""
        return f"<Model {self.name}: parameters {parameters}; initial {initial}{cases}>"

    def _short(self, which: str) -> list[str]:
        """The names of fields; a quantity at many sites occurs once."""
        names: list[str] = []
        for field in self.card[which]:
            stem, _, number = field["name"].rpartition("_")
            name = stem if self._inner.has_sites and number.isdigit() else field["name"]
            if name not in names:
                names.append(name)
        return names

    def _repr_markdown_(self) -> str:
        return brief(for_notebook(self.derivation.markdown))


def _table(key: str, own: Any) -> dict[str, Any]:
    from ._errors import DataError

    if not isinstance(own, Mapping):
        raise DataError(f"{key}: expected a dictionary of values by name, found {type(own).__name__}", key)
    for name in own:
        if not isinstance(name, str):
            raise DataError(f"{key}: expected names as keys, found {name!r}", key)
    return dict(own)
