"""The shipped models."""

from __future__ import annotations

import functools
import json

from . import _clebsch
from ._errors import DataError


class Models(list):
    """The shipped models, each a dictionary with `model`, `family`, `doc` and `cases`."""

    def names(self) -> list[str]:
        """The names that `load` takes.

        Returns
        -------
        list of str
        """
        return [own["model"] for own in self]

    def of(self, family: str) -> Models:
        """The models of one kind.

        Parameters
        ----------
        family : {'rigid', 'particle', 'elastic', 'chain', 'fluid'}

        Returns
        -------
        Models
        """
        return Models(own for own in self if own["family"] == family)

    def _rows(self) -> list[tuple[str, str, str, str]]:
        rows = []
        for own in self:
            cases = ", ".join(case["name"] for case in own["cases"])
            doc = " ".join(own["doc"].split("\n\n")[0].split())
            rows.append((own["model"], own["family"], cases, doc.split(". ")[0]))
        return rows

    def __repr__(self) -> str:
        rows = [("model", "family", "cases", "description"), *self._rows()]
        wide = [max(len(row[at]) for row in rows) for at in range(2)]
        return "\n".join(f"{m:{wide[0]}}  {f:{wide[1]}}  {d}  [{c}]" for m, f, c, d in rows)

    def _repr_html_(self) -> str:
        from html import escape

        body = "".join(
            "<tr>" + "".join(f"<td style='text-align:left'>{escape(x)}</td>" for x in row) + "</tr>" for row in self._rows()
        )
        head = "".join(f"<th style='text-align:left'>{x}</th>" for x in ("model", "family", "cases", "description"))
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


@functools.lru_cache(maxsize=1)
def _listed() -> str:
    return _clebsch.gallery()


def models(family: str | None = None) -> Models:
    """Everything that is shipped, by kind, with cases.

    Parameters
    ----------
    family : {'rigid', 'particle', 'elastic', 'chain', 'fluid'}, optional
        Only the models of this kind.

    Returns
    -------
    Models
        A list of dictionaries with the keys `model` (the name for `load`), `family`, `doc` and `cases`, a list of
        dictionaries with `name` and `doc`. Notebooks show it as a table.

    Raises
    ------
    DataError
        There is no such kind.

    Examples
    --------
    >>> import clebsch as cl
    >>> "heavy-top" in cl.models().names()
    True
    """
    all = Models(json.loads(_listed())["models"])
    if family is None:
        return all
    families = sorted({own["family"] for own in all})
    if family not in families:
        raise DataError(f"family: no models of the kind {family!r}; the kinds are {', '.join(families)}", "family")
    return all.of(family)


def load(name: str):
    """A shipped model, or the model of a file.

    Parameters
    ----------
    name : str
        A name of `models()`, such as ``"kirchhoff-rod"``, or the path of a model file, which ends in ``.clebsch``.

    Returns
    -------
    Model
        Its `cases` have parameters and initial values. `run` takes the first case by default.

    Raises
    ------
    DataError
        There is no such model or file.
    ModelError
        The text of the file is wrong.

    Examples
    --------
    >>> import clebsch as cl
    >>> run = cl.load("kepler").run(steps=100)
    >>> len(run.t)
    101
    """
    from ._model import Model

    return Model._of(_clebsch.Model.named(str(name)))
