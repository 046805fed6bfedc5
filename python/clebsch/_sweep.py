"""A case at every point of a grid of values."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _clebsch
from ._errors import DataError, StepError
from ._progress import Progress

if TYPE_CHECKING:
    from ._model import Model


# An index of an array, and the sign of the value at that index.
_Entry = tuple[tuple[int, ...], float]


class _Axis:
    """One axis of the grid: the varied quantity and its values."""

    def __init__(self, name: str, values: Any, model: Model, numbers: Mapping[str, Any], kinds: Mapping[str, str]) -> None:
        self.name = name
        self.values: list[Any] = list(values)
        self.table: str | None
        self.key: str
        self.entries: list[_Entry]
        if name == "h":
            self.table, self.key, self.entries = None, "h", []
            return
        table, key = _placed(model, name)
        key, _, component = key.partition(".")
        self.table, self.key, self.entries = table, key, []
        if component:
            if key not in numbers[table]:
                known = ", ".join(numbers[table])
                raise DataError(f"vary: no {table} of the name {key!r} with components; there are {known}", "vary")
            self.whole = np.asarray(numbers[table][key])
            self.entries = _entries(name, component, self.whole.shape, kinds.get(key, ""))

    def put(self, value: Any, tables: dict[str, dict[str, Any]]) -> None:
        """Put a value into the tables of a case."""
        if self.table is None:
            return
        if not self.entries:
            tables[self.table][self.key] = value
            return
        whole = np.array(tables[self.table].get(self.key, self.whole), dtype=float)
        for entry, sign in self.entries:
            whole[entry] = sign * value
        tables[self.table][self.key] = whole

    def columns(self) -> dict[str, list[Any]]:
        """The values by the name of their columns: a vector has a column for each component."""
        shapes = {np.shape(value) for value in self.values if not isinstance(value, (str, Mapping))}
        if len(shapes) == 1 and (shape := shapes.pop()) and len(shape) == 1:
            return {f"{self.name}_{at + 1}": [value[at] for value in self.values] for at in range(shape[0])}
        return {self.name: self.values}


def _entries(name: str, component: str, shape: tuple[int, ...], kind: str) -> list[_Entry]:
    """The entries that a component names, with their signs: of a symmetric or skew matrix also the mirror image."""
    wrong = DataError(f"vary: {name!r} does not name a component of an array of shape {shape}; components count from 1", "vary")
    if len(shape) == 1:
        at = "xyz".find(component) if len(component) == 1 and shape[0] == 3 else -1
        if at < 0 and component.isdigit():
            at = int(component) - 1
        if not 0 <= at < shape[0]:
            raise wrong
        return [((at,), 1.0)]
    parts = component.split("_") if "_" in component else list(component)
    if len(shape) != 2 or len(parts) != 2 or not all(part.isdigit() for part in parts):
        raise wrong
    i, j = (int(part) - 1 for part in parts)
    if not (0 <= i < shape[0] and 0 <= j < shape[1]):
        raise wrong
    if kind in ("Rotation", "RigidMotion", "UnitQuaternion"):
        raise DataError(
            f"vary: {name!r} cannot be varied alone, because the matrix would not be a rotation; give whole rotations", "vary"
        )
    mirror = {"Symmetric": 1.0, "SecondMoments": 1.0, "Skew": -1.0}.get(kind)
    entries: list[_Entry] = [((i, j), 1.0)]
    if mirror is not None and i != j:
        entries.append(((j, i), mirror))
    return entries


def swept(
    model: Model,
    case: str | None,
    vary: dict[str, Sequence[Any]],
    h: float | Sequence[float] | None,
    workers: int | None,
    progress: bool,
    values: dict[str, Any],
) -> Any:
    """The table of a sweep."""
    if h is not None:
        if "h" in vary:
            raise DataError("h: given twice, by `h` and by `vary`; give one of them", "h")
        sizes = np.asarray(h, dtype=float)
        if sizes.ndim > 0:
            vary["h"] = sizes.tolist()
        else:
            values["h"] = float(sizes)
    if not vary:
        raise DataError("vary: give at least one name with its values, such as vary=dict(k=[1, 2])", "vary")
    if values.get("every") is not None:
        raise DataError("every: a sweep records only the end of each run; remove `every`", "every")
    values["every"] = 0
    for name, own in vary.items():
        if isinstance(own, (str, Mapping)) or not hasattr(own, "__len__") or len(own) == 0:
            raise DataError(f"vary: {name!r} needs a sequence of values, such as [0.1, 0.2]", "vary")
    running = _started(model, case, vary, values)
    numbers, fields = running.case(), running.fields()
    kinds = {field["name"]: field["kind"] for field in (*fields["parameters"], *fields["initial"])}
    axes = [_Axis(name, own, model, numbers, kinds) for name, own in vary.items()]
    points = list(itertools.product(*(range(len(axis.values)) for axis in axes)))
    cases: list[tuple[str, str]] = []
    options: dict[str, Any] = {}
    keep_time = values.get("steps") is None and values.get("until") is None and "h" in vary
    until = numbers["h"] * numbers["steps"] if keep_time else None
    for point in points:
        tables = {key: dict(values.get(key) or {}) for key in ("parameters", "initial")}
        there = {**values, **({"until": until} if until is not None else {})}
        for axis, at in zip(axes, point):
            axis.put(axis.values[at], tables)
            if axis.table is None:
                there["h"] = float(axis.values[at])
        there.update({key: table or None for key, table in tables.items()})
        file, text, options = model._compose(case, there)
        cases.append((file, text))
    bar = Progress(len(cases), "point", progress)
    try:
        ended = _clebsch.run_many(model._inner, cases, options, workers, bar.tell)
    finally:
        bar.close()
    return _table(axes, points, ended, running.columns(), fields["invariants"])


def _table_of(model: Model, key: str) -> str:
    """The table of a name: `parameters` or `initial`."""
    known = {*model._short("parameters"), *model.parameters}
    inertia = key[:1] == "I" and f"J{key[1:]}" in known
    return "parameters" if key in known or inertia else "initial"


def _started(model: Model, case: str | None, vary: Mapping[str, Any], values: dict[str, Any]) -> _clebsch.Running:
    """A run at the first point of the grid, or at the last if the first fails. It determines the columns of the table."""
    refused: StepError | None = None
    for at in (0, -1):
        own = dict(values)
        for name, varied in vary.items():
            if name == "h":
                own["h"] = float(list(varied)[at])
                continue
            table, key = _placed(model, name)
            if "." not in key:
                own[table] = {**(own.get(table) or {}), key: list(varied)[at]}
        try:
            return model._start(case, own, sampled=False)
        except StepError as why:
            refused = refused or why
    assert refused is not None
    raise refused


def _placed(model: Model, name: str) -> tuple[str, str]:
    """The table of a name, and the name in that table."""
    table, _, key = name.partition(".")
    if table in ("parameters", "initial") and key:
        return table, key
    return _table_of(model, table), name


def _table(axes: list[_Axis], points: list[tuple[int, ...]], ended: list[Any], names: list[str], invariants: list[str]) -> Any:
    """One row for each point."""
    observables = [name for name in names if not name.startswith("invariant_")]
    columns: dict[str, Any] = {}
    for number, axis in enumerate(axes):
        for name, values in axis.columns().items():
            # An initial value may have the name of an observable, whose final value is a column.
            name = f"{axis.table}.{name}" if name in observables else name
            columns[name] = np.array([values[point[number]] for point in points])
    count = len(points)
    status, why = np.empty(count, dtype=object), np.empty(count, dtype=object)
    steps, time = np.zeros(count, dtype=np.int64), np.full(count, np.nan)
    within = np.zeros(count, dtype=bool)
    drifts = {name: np.full(count, np.nan) for name in invariants}
    last = np.full((count, len(observables)), np.nan)
    for at, (own, text) in enumerate(ended):
        why[at] = text or ""
        if own is None:
            status[at] = "interrupted" if text == "interrupted" else "refused"
            continue
        status[at] = "interrupted" if text == "interrupted" else "stopped" if text else "complete"
        steps[at], _, time[at], samples = own.summary()
        within[at] = True
        for outcome in own.outcomes():
            drifts[outcome["name"]][at] = outcome["worst"]
            within[at] &= not outcome["exceeded"]
        _, _, row = own.sample(samples - 1)
        last[at] = row[: len(observables)]
    columns.update(status=status, why=why, steps=steps, time=time, within_bounds=within)
    columns.update({f"drift_{name}": own for name, own in drifts.items()})
    columns.update({name: last[:, at] for at, name in enumerate(observables)})
    try:
        import pandas as pd
    except ImportError:
        return columns
    return pd.DataFrame(columns)
