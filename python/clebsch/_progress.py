"""A progress bar, if tqdm is installed and the work takes longer than a second."""

from __future__ import annotations

import time

_QUIET = 1.0


class Progress:
    """A bar for ``total`` units of work, which appears after one second."""

    def __init__(self, total: int, unit: str, shown: bool) -> None:
        self.total = total
        self.unit = unit
        self.shown = shown
        self.begun = time.monotonic()
        self.bar = None

    def tell(self, done: int) -> None:
        """Show that ``done`` units are done."""
        if not self.shown:
            return
        if self.bar is None:
            if time.monotonic() - self.begun < _QUIET:
                return
            self.bar = _bar(self.total, self.unit)
            if self.bar is None:
                self.shown = False
                return
        self.bar.update(done - self.bar.n)

    def close(self) -> None:
        """Remove the bar."""
        if self.bar is not None:
            self.bar.close()
            self.bar = None


def _bar(total: int, unit: str):
    try:
        import warnings

        with warnings.catch_warnings():
            # Without ipywidgets, tqdm warns and draws a text bar.
            warnings.simplefilter("ignore")
            from tqdm.auto import tqdm

            return tqdm(total=total, unit=unit, unit_scale=True, leave=False)
    except ImportError:
        return None
