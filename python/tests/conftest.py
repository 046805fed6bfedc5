"""Models that several tests run, derived once."""

from __future__ import annotations

import pytest
from shared import OSCILLATOR, TOP

import clebsch as cl


@pytest.fixture(scope="session")
def top():
    return cl.Model(TOP)


@pytest.fixture(scope="session")
def oscillator():
    return cl.Model(OSCILLATOR)
