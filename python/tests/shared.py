"""Models that several tests run, and the folder of the project."""

from __future__ import annotations

import os
import pathlib

import numpy as np

import clebsch as cl

# The script that tests the wheel copies the tests out of the project.
ROOT = pathlib.Path(os.environ.get("CLEBSCH_ROOT", pathlib.Path(__file__).resolve().parents[2]))

TOP = """
model Top { param J: Sym<3>; param chi, z: Vec<3>; group R: SO<3> velocity W; advected G: Vec<3> = R^T*z;
  constraint next(R) = R*W; constraint next(G) = W^T*G; lagrangian = -tr(J*W)/h - h*dot(chi, G); }"""

OSCILLATOR = """
model Oscillator { param m, c: Real; field q: Real; lagrangian = m*(next(q) - q)^2/(2*h) - h*c*q^2/2; }"""


def top_values(**others):
    """The values of a run of the top."""
    values = dict(
        parameters=dict(J=np.diag([0.5, 0.5, 1.5]), chi=[0, 0, 1], z=[0, 0, 1]),
        initial=dict(R=cl.axis_angle([1, 0, 0], 0.6), angular_velocity=[0.1, 0, 5]),
        h=0.01,
    )
    return {**values, **others}
