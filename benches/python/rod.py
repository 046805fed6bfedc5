"""A free elastic rod by PyElastica: the path of its first end, and processor time.

Takes `--out FILE`, `--venv FOLDER` and `--segments N`; gives JSON. The environment is made as that of peers.py. Exit
code 3 with a message when that cannot be done.
"""

import argparse
import json
import pathlib
import statistics
import time

import peers

# A rod of length 1 in SI units, circular, straight along the third axis.
LENGTH, RADIUS, DENSITY, YOUNG, SHEAR = 1.0, 0.05, 1000.0, 1e6, 4e5
SPEED = 0.5
STEP, STEPS, EVERY = 1e-4, 10_000, 100
ROUNDS = 5


def rod(segments):
    import elastica
    import numpy

    class Simulator(elastica.BaseSystemCollection):
        pass

    simulator = Simulator()
    axis, normal = numpy.array([0.0, 0.0, 1.0]), numpy.array([1.0, 0.0, 0.0])
    made = elastica.CosseratRod.straight_rod(
        segments, numpy.zeros(3), axis, normal, LENGTH, RADIUS, DENSITY, youngs_modulus=YOUNG, shear_modulus=SHEAR
    )
    place = made.position_collection[2] / LENGTH
    # Bends the rod, at first without momentum.
    made.velocity_collection[0] = SPEED * ((place - 0.5) ** 2 * 12.0 - 1.0)
    simulator.append(made)
    simulator.finalize()
    stepper = elastica.PositionVerlet()
    moment, path = numpy.float64(0.0), [float(made.position_collection[0, 0])]
    start = time.process_time()
    for _ in range(STEPS // EVERY):
        for _ in range(EVERY):
            moment = stepper.step(simulator, moment, numpy.float64(STEP))
        path.append(float(made.position_collection[0, 0]))
    return path, (time.process_time() - start) / STEPS


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--out", required=True)
    options.add_argument("--venv", type=pathlib.Path, required=True)
    options.add_argument("--segments", type=int, default=50)
    options.add_argument("--ready", action="store_true")
    asked = options.parse_args()
    if not asked.ready:
        peers.inside(asked.venv, __file__)
    # The first one compiles.
    runs = [rod(asked.segments) for _ in range(ROUNDS + 1)][1:]
    told = {"path": runs[0][0], "seconds": statistics.median(seconds for _, seconds in runs)}
    pathlib.Path(asked.out).write_text(json.dumps(told))


if __name__ == "__main__":
    main()
