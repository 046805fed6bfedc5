"""The exceptions of the package."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._run import Run


class ClebschError(Exception):
    """The base class of the exceptions of the package."""


class ModelError(ClebschError, ValueError):
    """The text of a model is wrong. The message shows a caret under the source.

    Attributes
    ----------
    line, column : int or None
        The position of the first mistake, counted from 1.
    hint : str or None
        The correction.
    """

    def __init__(self, text: str, line: int | None = None, column: int | None = None, hint: str | None = None) -> None:
        super().__init__(text)
        self.line = line
        self.column = column
        self.hint = hint

    def __reduce__(self):
        return type(self), (str(self), self.line, self.column, self.hint)


class DataError(ClebschError, ValueError):
    """A parameter, an initial value or an option is wrong. The message names it.

    Attributes
    ----------
    argument : str or None
        The argument that is wrong, such as ``"initial.R"`` or ``"h"``.
    """

    def __init__(self, text: str, argument: str | None = None) -> None:
        super().__init__(text)
        self.argument = argument or _argument(text)

    def __reduce__(self):
        return type(self), (str(self), self.argument)


class StepError(ClebschError, RuntimeError):
    """A step failed.

    Attributes
    ----------
    node : int or None
        The last node that was reached.
    time : float or None
        The time at that node, in the unit of time of the model.
    hint : str or None
        The suggested remedy.
    run : Run or None
        The results up to that node. It is None if the first step failed.
    """

    def __init__(
        self,
        text: str,
        node: int | None = None,
        time: float | None = None,
        hint: str | None = None,
        run: Run | None = None,
    ) -> None:
        super().__init__(text)
        self.node = node
        self.time = time
        self.hint = hint or _hint(text)
        self.run = run

    def __reduce__(self):
        return type(self), (str(self), self.node, self.time, self.hint)


class InvariantError(ClebschError, RuntimeError):
    """An invariant of a run exceeded its bound, or a step does not solve the equations of the action as stated.

    Attributes
    ----------
    names : tuple of str
        The invariants that exceeded their bounds.
    run : Run
        The run.
    """

    def __init__(self, text: str, names: tuple[str, ...] = (), run: Run | None = None) -> None:
        super().__init__(text)
        self.names = names
        self.run = run

    def __reduce__(self):
        return type(self), (str(self), self.names)


_TABLES = ("parameters", "initial", "labels", "ends", "domain", "functions", "bounds")
_OPTIONS = ("h", "steps", "until", "every", "order", "solver", "compensated", "halve", "judge", "workers", "case")


def _argument(text: str) -> str | None:
    """The argument that a message names."""
    import re

    tables = "|".join(_TABLES)
    found = re.search(rf"\b({tables})\.\w+", text)
    if found:
        return found.group(0)
    found = re.search(rf"unknown key `(\w+)` in \[({tables})\]", text)
    if found:
        return f"{found.group(2)}.{found.group(1)}"
    found = re.search(rf"\[({tables})\]", text)
    if found:
        return found.group(1)
    options = "|".join(_OPTIONS)
    found = re.match(rf"(?:missing key `)?({options})\b", text)
    return found.group(1) if found else None


def _hint(text: str) -> str | None:
    """The suggestion in a message, which follows its last semicolon."""
    _, separator, hint = text.rpartition("; ")
    return hint if separator else None
