"""Runs have the bits of the command, for every shipped model and case."""

from __future__ import annotations

import platform
import sys

import pytest
from shared import ROOT

import clebsch as cl

LISTS = ROOT / "cli" / "tests" / "command" / "bits"

# The C library computes the sine and other functions, so the lists belong to one platform.
listed = pytest.mark.skipif(
    not (sys.platform == "linux" and platform.machine() == "x86_64"), reason="the lists are those of Linux on x86-64"
)


def written(x: float) -> str:
    """A number as the command writes it: the shortest digits, and an exponent without sign and zeros in front."""
    mantissa, separator, exponent = repr(float(x)).partition("e")
    return f"{mantissa}e{int(exponent)}" if separator else mantissa


def fnv(text: str) -> int:
    """Fowler, Noll and Vo's hash."""
    found = 0xCBF29CE484222325
    for byte in text.encode():
        found = (found ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return found


def row(run: cl.Run, at: int) -> str:
    """A line of trajectory.csv."""
    # A fluid has some ten thousand columns, for which pandas takes seconds.
    numbers = run._rows[at].tolist()
    return ",".join([str(run.node[at]), written(run.t[at]), *map(written, numbers)])


def hashes() -> dict[str, list[tuple[int, str]]]:
    """The hashes of the rows of each case, by node."""
    found: dict[str, list[tuple[int, str]]] = {}
    for path in sorted(LISTS.glob("*.txt")):
        for line in path.read_text().splitlines():
            case, node, value = line.split()
            found.setdefault(case, []).append((int(node), value))
    return found


HASHES = hashes() if LISTS.is_dir() else {}

# Chains and fluids end at this node: the others take thousands of steps in the same time.
SHORT = 10


def test_numbers_are_written_as_the_command_writes_them():
    for x, text in [
        (1.0, "1.0"),
        (1e-7, "1e-7"),
        (-2.5e20, "-2.5e20"),
        (1e15, "1000000000000000.0"),
        (0.1, "0.1"),
        (1e-5, "1e-5"),
    ]:
        assert written(x) == text


def test_every_shipped_case_is_listed():
    shipped = {f"{own['model']}:{case['name']}" for own in cl.models() for case in own["cases"]}
    assert shipped == set(HASHES)


@listed
@pytest.mark.parametrize("case", HASHES)
def test_bits(case):
    name, own = case.split(":")
    model = cl.load(name)
    last = max(node for node, _ in HASHES[case])
    if model._inner.has_sites:
        last = SHORT
    try:
        run = model.run(own, steps=last, every=1)
    except cl.StepError as stopped:
        run = stopped.run
    found = [(node, f"{fnv(row(run, node)):016x}") for node, _ in HASHES[case] if node <= last]
    assert found == [pair for pair in HASHES[case] if pair[0] <= last]
    assert len(found) >= 2
