"""Rotations as matrices."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import DataError


def axis_angle(axis: ArrayLike, angle: float) -> NDArray[np.float64]:
    """The matrix of a rotation about an axis.

    Parameters
    ----------
    axis : array_like, shape (3,)
        The axis, of any positive length.
    angle : float
        The angle in radians, counterclockwise about the axis.

    Returns
    -------
    ndarray, shape (3, 3)
        The rotation, which maps vectors of the body frame to the space frame.

    Raises
    ------
    DataError
        The axis does not have three components, or its length is zero.

    Examples
    --------
    >>> import clebsch as cl
    >>> cl.axis_angle([0, 0, 1], 0.0)
    array([[1., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    n = np.asarray(axis, dtype=float)
    if n.shape != (3,):
        raise DataError(f"axis: expected three numbers, found an array of shape {n.shape}", "axis")
    length = math.sqrt(float(n @ n))
    if not (math.isfinite(length) and length > 0):
        raise DataError("axis: expected a vector of positive length; give a direction such as [0, 0, 1]", "axis")
    n = n / length
    hat = np.array([[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]])
    # 1 - cos without cancellation.
    half = math.sin(angle / 2)
    return np.eye(3) + math.sin(angle) * hat + 2 * half * half * (hat @ hat)
