"""Advances a run in short intervals, and updates the progress bar and calls the functions of `observe` in between."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ._errors import DataError, StepError
from ._layout import Layout, Sample
from ._progress import Progress
from ._run import Run

if TYPE_CHECKING:
    from . import _clebsch
    from ._model import Model

# Seconds of stepping between two updates of the bar and calls of the functions of `observe`.
_TURN = 0.1


def finished(
    model: Model,
    running: _clebsch.Running,
    observe: Mapping[str, Callable[[Sample], Any]] | None,
    progress: bool,
) -> Run:
    """Take all steps. Returns the run even if it is interrupted."""
    observed: dict[str, list[Any]] = {}
    watch: Callable[[], None] | None = None
    if observe:
        observed, watch = _watched(running, observe)
    bar: Progress | None = None
    stopped = None
    try:
        over, failed = running.advance(_TURN)
        if watch is not None:
            watch()
        if not over:
            bar = Progress(running.case()["steps"], "step", progress)
            while not over:
                over, failed = running.advance(_TURN)
                if watch is not None:
                    watch()
                bar.tell(running.summary()[0])
    except KeyboardInterrupt:
        failed = None
        running.end_here()
        stopped = "interrupted"
        if watch is not None:
            watch()
    finally:
        if bar is not None:
            bar.close()
    if failed is not None:
        node, time, text = failed
        run = Run(model, running, observed, text)
        raise StepError(text, node, time, run=run if run.steps > 0 else None)
    return Run(model, running, observed, stopped)


def _watched(
    running: _clebsch.Running, observe: Mapping[str, Callable[[Sample], Any]]
) -> tuple[dict[str, list[Any]], Callable[[], None]]:
    """The lists of function values at the samples, and a function that appends the values at new samples."""
    layout = Layout(running)
    for name, function in observe.items():
        if name in layout.arrays:
            raise DataError(f"observe: the run has an array {name!r} already; choose another name", "observe")
        if not callable(function):
            raise DataError(f"observe: {name!r} is not a function of a sample", "observe")
    parameters = running.case()["parameters"]
    lists: dict[str, list[Any]] = {name: [] for name in observe}
    seen = 0

    def watch() -> None:
        nonlocal seen
        samples = running.summary()[3]
        while seen < samples:
            node, time, row = running.sample(seen)
            sample = Sample(layout, node, time, row, parameters)
            # Evaluate all functions before appending, because an interrupted sample is evaluated again.
            values = [function(sample) for function in observe.values()]
            for own, value in zip(lists.values(), values):
                own.append(value)
            seen += 1

    return lists, watch
