"""State a mechanical or fluid model in a few lines, get its discrete equations, and run it.

The text of a model states a discrete Lagrangian, its configurations and its constraints. clebsch derives the discrete
equations of motion, proves them, and steps them with a variational integrator: momentum maps and Casimirs are conserved
to rounding, and the error of the energy stays bounded.

Examples
--------
>>> import clebsch as cl
>>> model = cl.Model('''model Oscillator {
...     param m, c: Real;
...     field q: Real;
...     lagrangian = m*(next(q) - q)^2/(2*h) - h*c*q^2/2;
... }''')
>>> run = model.run(parameters=dict(m=1, c=4), initial=dict(q=1), h=0.1, until=10)
>>> run["q"].shape
(101,)
>>> run.check().invariants["energy"].worst < 0.05
True

Contents
--------
Model, load, models
    A model of your own, a shipped model or a model file, and the list of shipped models.
Run, Simulation, resume
    The results of a run; a run step by step, which can be saved and resumed.
Ensemble
    Many bodies of one model.
axis_angle
    The matrix of a rotation.
ModelError, DataError, StepError, InvariantError
    The exceptions.
"""

from ._clebsch import __version__
from ._derivation import Derivation
from ._ensemble import Ensemble
from ._errors import ClebschError, DataError, InvariantError, ModelError, StepError
from ._gallery import load, models
from ._layout import Sample
from ._model import Model
from ._rotations import axis_angle
from ._run import Invariant, Run
from ._simulation import Simulation, resume

__all__ = [
    "ClebschError",
    "DataError",
    "Derivation",
    "Ensemble",
    "Invariant",
    "InvariantError",
    "Model",
    "ModelError",
    "Run",
    "Sample",
    "Simulation",
    "StepError",
    "__version__",
    "axis_angle",
    "load",
    "models",
    "resume",
]
