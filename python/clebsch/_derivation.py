"""The derivation of a model: its equations, their proof and their invariants."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from ._model import Model


class StabilityLimit(NamedTuple):
    """The stability limit of the step size, for small motions about an initial state at rest.

    Attributes
    ----------
    step : float or None
        The largest stable step size. None if it was not found or does not exist.
    frequency : float or None
        The angular frequency of the fastest small motion.
    text : str
        The result as a sentence.
    """

    step: float | None
    frequency: float | None
    text: str


class Derivation:
    """The discrete equations of a model in several forms.

    `Model.derivation` returns it. Each form is derived when it is first used.

    Attributes
    ----------
    text : str
        The derivation as plain text with numbered equations.
    latex : str
        The derivation as a section of a paper.
    markdown : str
        The derivation as Markdown, with formulas that GitHub typesets.
    rust : str
        The Rust code of the stepper.
    certificate : str
        The identities that were proved, each by a normal form.
    invariants : list of str
        The conserved quantities, each with its formula, how well it is conserved, and the reason.
    """

    def __init__(self, model: Model) -> None:
        self._model = model
        self._forms: dict[tuple[str, bool, bool], str] = {}

    def _form(self, format: str, explain: bool = False, standalone: bool = False) -> str:
        key = (format, explain, standalone)
        if key not in self._forms:
            self._forms[key] = self._model._inner.derivation(format, explain, standalone)
        return self._forms[key]

    @property
    def text(self) -> str:
        """str : The derivation as plain text with numbered equations."""
        return self._form("text")

    @property
    def latex(self) -> str:
        """str : The derivation as a section of a paper."""
        return self._form("latex")

    @property
    def document(self) -> str:
        """str : The derivation as a LaTeX document that compiles by itself."""
        return self._form("latex", standalone=True)

    @property
    def markdown(self) -> str:
        """str : The derivation as Markdown, with formulas that GitHub typesets."""
        return self._form("markdown")

    @property
    def rust(self) -> str:
        """str : The Rust code of the stepper."""
        return self._form("rust")

    @property
    def proof(self) -> str:
        """str : The derivation as plain text, followed by the proof step by step."""
        return self._form("text", explain=True)

    @property
    def certificate(self) -> str:
        """str : The identities that were proved, each by a normal form."""
        return self.section("Certificate")

    @property
    def invariants(self) -> list[str]:
        """list of str : The conserved quantities, each with its formula and the reason why it is conserved."""
        found: list[str] = []
        for line in self.section("Invariants").splitlines():
            if line.startswith("- "):
                found.append(line[2:])
            elif line.startswith("  ") and found and line.strip() and not line.lstrip().startswith("("):
                found[-1] += " " + line.strip()
        return found

    @property
    def sections(self) -> list[str]:
        """list of str : The titles of the sections."""
        return [title for title, _ in _sections(self.text)]

    def section(self, title: str) -> str:
        """One section as plain text.

        Parameters
        ----------
        title : str
            One of `sections`.

        Returns
        -------
        str

        Raises
        ------
        KeyError
            There is no such section.
        """
        for own, text in _sections(self.text):
            if own == title:
                return text
        raise KeyError(f"no section {title!r}; the sections are {', '.join(self.sections)}")

    def stability_limit(self, case: str | None = None, *, seconds: float = 1.0, **values: Any) -> StabilityLimit:
        """The largest stable step size for small motions about an initial state.

        Parameters
        ----------
        case : str, optional
            A case of the model.
        seconds : float, default 1
            The search ends after this time.
        **values
            The parameters, initial values and options of `Model.run`.

        Returns
        -------
        StabilityLimit
        """
        running = self._model._start(case, values, sampled=False)
        found = running.stability_limit(seconds)
        text = found["warning"] or found["told"] or "no limit below twice the step size of the case"
        return StabilityLimit(found["step"], found["frequency"], text)

    def __repr__(self) -> str:
        return f"<Derivation of {self._model.name}: {', '.join(self.sections)}>"

    def __str__(self) -> str:
        return self.text

    def _repr_markdown_(self) -> str:
        return for_notebook(self.markdown)

    def _repr_latex_(self) -> str | None:
        return None


def _sections(text: str) -> list[tuple[str, str]]:
    """The underlined titles, each with the text of its section."""
    lines = text.splitlines()
    heads = [
        at
        for at in range(len(lines) - 1)
        if lines[at].strip() and re.fullmatch(r"-{3,}", lines[at + 1]) and len(lines[at + 1]) >= len(lines[at]) - 2
    ]
    out = []
    for number, at in enumerate(heads):
        end = heads[number + 1] if number + 1 < len(heads) else len(lines)
        out.append((lines[at].strip(), "\n".join(lines[at + 2 : end]).strip("\n")))
    return out


def for_notebook(markdown: str) -> str:
    """Markdown with formulas between dollar signs, which notebooks typeset."""
    out = re.sub(r"```math\n(.*?)\n```", lambda m: f"$$\n{m.group(1)}\n$$", markdown, flags=re.DOTALL)
    return re.sub(r"\$`(.+?)`\$", lambda m: f"${m.group(1)}$", out)


# The sections that a notebook shows: equations and invariants.
_BRIEF = re.compile(r"Discrete (Lagrangian|Euler)|Equations of a site|Moser|Solution of a step|Invariants|Limit")


def brief(markdown: str) -> str:
    """The title and the sections on equations and invariants."""
    parts = re.split(r"(?m)^(?=## )", markdown)
    chosen = [part for part in parts[1:] if _BRIEF.match(part[3:])]
    return "".join([parts[0], *chosen])
