"""The pendulum and the outer solar system from texts by clebsch, and by heyoka: time to prepare, and time for equal errors.

    python benches/python/taylor.py [--rounds 7]

Both packages must be installed, clebsch from a release wheel. The time to prepare includes the derivation or the decomposition, the
compilation and a first short run; heyoka's own cache is cleared before. Each run is the best of the rounds.
"""

import argparse
import math
import time

import heyoka as hy
import numpy as np

import clebsch as cl

# Hairer, Lubich and Wanner, Geometric Numerical Integration, section I.2.4: masses in solar masses, astronomical units, days.
G = 2.95912208286e-4
MASSES = [1.00000597682, 0.000954786104043, 0.000285583733151, 0.0000437273164546, 0.0000517759138449, 1 / 1.3e8]
PLACES = [
    [0.0, 0.0, 0.0],
    [-3.5023653, -3.8169847, -1.5507963],
    [9.0755314, -3.0458353, -1.6483708],
    [8.3101420, -16.2901086, -7.2521278],
    [11.4707666, -25.7294829, -10.8169456],
    [-15.5387357, -25.2225594, -3.1902382],
]
VELOCITIES = [
    [0.0, 0.0, 0.0],
    [0.00565429, -0.00412490, -0.00190589],
    [0.00168318, 0.00483525, 0.00192462],
    [0.00354178, 0.00137102, 0.00055029],
    [0.00288930, 0.00114527, 0.00039677],
    [0.00276725, -0.00170702, -0.00136504],
]


class Pendulum:
    name, end, steps = "pendulum", 100.0, [200, 300, 450, 700, 1000, 1500, 2200, 3300, 5000, 7500]
    text = "model Pendulum { param g: Real; field x: Real; lagrangian = (next(x) - x)^2/(2*h) + h*g*cos(x); }"
    parameters, initial = {"g": 9.8}, {"x": 0.05, "velocity_x": 0.025}
    start = [0.05, 0.025]

    @staticmethod
    def system():
        x, v = hy.make_vars("x", "v")
        return [(x, v), (v, -9.8 * hy.sin(x))]

    @staticmethod
    def places(run):
        return np.array([run["x"][-1]])

    @staticmethod
    def of_state(state):
        return np.array(state[:1])


BODIES = range(len(MASSES))
KINETIC = [f"m{i}*dot(next(x{i}) - x{i}, next(x{i}) - x{i})/(2*h)" for i in BODIES]
POTENTIAL = [f"G*m{i}*m{j}/sqrt(dot(x{i} - x{j}, x{i} - x{j}))" for i in BODIES for j in BODIES if i < j]


class SolarSystem:
    name, end, steps = "outer solar system", 20000.0, [100, 150, 220, 330, 500, 750, 1100, 1700, 2500, 3800]
    text = "model Planets {{ param G: Real; {} {} lagrangian = {} + h*({}); }}".format(
        " ".join(f"param m{i}: Real;" for i in BODIES),
        " ".join(f"field x{i}: Vec<3>;" for i in BODIES),
        " + ".join(KINETIC),
        " + ".join(POTENTIAL),
    )
    parameters = {"G": G, **{f"m{i}": m for i, m in enumerate(MASSES)}}
    initial = {
        **{f"x{i}": x for i, x in enumerate(PLACES)},
        **{f"velocity_x{i}": v for i, v in enumerate(VELOCITIES)},
    }
    start = [c for x, v in zip(PLACES, VELOCITIES) for c in (*x, *v)]

    @staticmethod
    def system():
        return hy.model.nbody(len(MASSES), masses=MASSES, Gconst=G)

    @staticmethod
    def places(run):
        return np.array([run[f"x{i}"][-1] for i in BODIES]).ravel()

    @staticmethod
    def of_state(state):
        return np.array(state).reshape(-1, 6)[:, :3].ravel()


def best(call, rounds):
    """The least time of a call in seconds, and its result."""
    took = math.inf
    for _ in range(rounds):
        begun = time.perf_counter()
        found = call()
        took = min(took, time.perf_counter() - begun)
    return took, found


def heyoka_run(problem, tolerance):
    """A call that integrates to the end."""
    taylor = hy.taylor_adaptive(problem.system(), problem.start, tol=tolerance)

    def call():
        taylor.time = 0.0
        taylor.state[:] = problem.start
        taylor.propagate_until(problem.end)
        return problem.of_state(taylor.state)

    return call


def clebsch_run(model, problem, order, steps):
    """A call that takes this number of steps to the end."""
    settings = dict(parameters=problem.parameters, initial=problem.initial, h=problem.end / steps, steps=steps, order=order)
    return lambda: problem.places(model.run(**settings, every=steps, progress=False))


def prepared(problem):
    """The times to prepare in clebsch and in heyoka, in seconds."""

    def by_clebsch():
        model = cl.Model(problem.text)
        model.run(parameters=problem.parameters, initial=problem.initial, h=problem.end / 1000, steps=20, progress=False)

    def by_heyoka():
        hy.llvm_state.clear_memcache()
        hy.taylor_adaptive(problem.system(), problem.start, tol=1e-15).propagate_until(1e-3 * problem.end)

    return best(by_clebsch, 1)[0], best(by_heyoka, 1)[0]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--rounds", type=int, default=7)
    rounds = arguments.parse_args().rounds
    for problem in (Pendulum, SolarSystem):
        own, other = prepared(problem)
        print(f"{problem.name}: to prepare, clebsch {1e3 * own:.1f} ms, heyoka {1e3 * other:.1f} ms")
        exact = heyoka_run(problem, 1e-18)()
        model = cl.Model(problem.text)
        points = []
        for order in (2, 4, 8):
            for steps in problem.steps if order > 2 else [16 * n for n in problem.steps]:
                took, found = best(clebsch_run(model, problem, order, steps), rounds)
                points.append((abs(found - exact).max(), took, f"order {order}, {steps} steps"))
        others = []
        for digits in range(3, 17):
            took, found = best(heyoka_run(problem, 10.0**-digits), rounds)
            others.append((abs(found - exact).max(), took, f"tol 1e-{digits}"))
        print("| error | clebsch, us | | heyoka, us | | clebsch / heyoka |\n|---|---|---|---|---|---|")
        for digits in (2, 4, 6, 8, 10):
            wanted = 10.0**-digits
            fits = [min((p for p in all_points if p[0] <= wanted), key=lambda p: p[1], default=None) for all_points in (points, others)]
            if None in fits:
                continue
            (_, a, own), (_, b, other) = fits
            print(f"| 1e-{digits} | {1e6 * a:.0f} | {own} | {1e6 * b:.0f} | {other} | {a / b:.2f} |")


if __name__ == "__main__":
    main()
