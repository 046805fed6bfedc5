"""The chapter of the book on Python: its code prints the text below it."""

from __future__ import annotations

import contextlib
import io
import re

import pytest
from shared import ROOT


def test_the_code_of_the_chapter_prints_what_it_says(tmp_path, monkeypatch):
    pytest.importorskip("pandas")
    monkeypatch.chdir(tmp_path)
    chapter = (ROOT / "docs" / "book" / "src" / "python.md").read_text()
    blocks = re.findall(r"```(python|text)\n(.*?)```", chapter, re.DOTALL)
    names: dict[str, object] = {}
    printed, checked = "", 0
    for kind, block in blocks:
        if kind == "text":
            assert printed == block, block
            checked += 1
            continue
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile(block, "python.md", "exec"), names)
        printed = out.getvalue()
    assert checked == 6
