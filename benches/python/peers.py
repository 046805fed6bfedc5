"""The free rigid body by heyoka, SciPy and PyElastica: processor time and end state for a range of settings.

Takes `--out FILE` and `--venv FOLDER`; gives JSON. Outside the folder's virtual environment it makes one, installs
requirements.txt there and runs itself in it. Exit code 3 with a message when that cannot be done.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import time
import venv

MOMENTS = (3.5, 2.5, 2.0)
MOMENTUM = (-0.5, 0.0, 1.0)
TIME = 100.0
ROUNDS = 15
# Nanoseconds of a block, far above the resolution of the clock.
BLOCK = 2_000_000
HERE = pathlib.Path(__file__).resolve().parent


def inside(folder, file=__file__):
    """Runs a file in the environment of `folder`, made if need be."""
    python = folder / "bin" / "python"
    try:
        if not python.exists():
            venv.create(folder, with_pip=True)
        command = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run(command + ["-r", str(HERE / "requirements.txt")], check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"no environment for heyoka, SciPy and PyElastica: {error}", file=sys.stderr)
        sys.exit(3)
    sys.exit(subprocess.run([str(python), str(file), *sys.argv[1:], "--ready"]).returncode)


def euler(w, x, y, z, a, b, c):
    """Rates of the quaternion (body to space) and the body momentum."""
    p, q, r = a / MOMENTS[0], b / MOMENTS[1], c / MOMENTS[2]
    return [
        (-x * p - y * q - z * r) / 2.0,
        (w * p + y * r - z * q) / 2.0,
        (w * q + z * p - x * r) / 2.0,
        (w * r + x * q - y * p) / 2.0,
        b * r - c * q,
        c * p - a * r,
        a * q - b * p,
    ]


START = [1.0, 0.0, 0.0, 0.0, *MOMENTUM]


def heyoka_scalar(tolerance):
    import heyoka

    names = heyoka.make_vars("w", "x", "y", "z", "a", "b", "c")
    system = list(zip(names, euler(*names)))
    integrator = heyoka.taylor_adaptive(system, START, tol=tolerance)

    def run():
        integrator.time = 0.0
        integrator.state[:] = START
        integrator.propagate_until(TIME)
        return [float(value) for value in integrator.state]

    return run


def heyoka_batch(tolerance):
    import heyoka
    import numpy

    lanes = heyoka.recommended_simd_size()
    names = heyoka.make_vars("w", "x", "y", "z", "a", "b", "c")
    system = list(zip(names, euler(*names)))
    first = numpy.repeat(numpy.array(START)[:, None], lanes, axis=1)
    integrator = heyoka.taylor_adaptive_batch(system, first.copy(), tol=tolerance)
    zero = numpy.zeros(lanes)

    def run():
        integrator.set_time(zero)
        integrator.state[:] = first
        integrator.propagate_until(TIME)
        return [float(value) for value in integrator.state[:, 0]]

    run.lanes = lanes
    return run


def scipy_method(name):
    def made(tolerance):
        from scipy.integrate import solve_ivp

        def rates(_, y):
            return euler(*y)

        def run():
            # Tighter relative tolerances are refused; the absolute one then decides.
            relative = max(tolerance, 3e-14)
            done = solve_ivp(rates, (0.0, TIME), START, method=name, rtol=relative, atol=tolerance)
            return [float(value) for value in done.y[:, -1]]

        return run

    return made


def elastica(steps):
    import elastica
    import numpy

    class Simulator(elastica.BaseSystemCollection):
        pass

    stepper = elastica.PositionVerlet()

    def run():
        simulator = Simulator()
        axis, normal = numpy.array([0.0, 0.0, 1.0]), numpy.array([1.0, 0.0, 0.0])
        body = elastica.Cylinder(numpy.zeros(3), axis, normal, 1.0, 1.0, 1.0)
        body.director_collection[..., 0] = numpy.eye(3)
        body.mass_second_moment_of_inertia[..., 0] = numpy.diag(MOMENTS)
        body.inv_mass_second_moment_of_inertia[..., 0] = numpy.diag([1.0 / i for i in MOMENTS])
        body.omega_collection[:, 0] = [m / i for m, i in zip(MOMENTUM, MOMENTS)]
        simulator.append(body)
        simulator.finalize()
        moment, step = numpy.float64(0.0), numpy.float64(TIME / steps)
        for _ in range(steps):
            moment = stepper.step(simulator, moment, step)
        # Rows are the body axes in space: the transpose of the attitude.
        rows = body.director_collection[..., 0]
        momentum = [float(i * w) for i, w in zip(MOMENTS, body.omega_collection[:, 0])]
        return quaternion(rows.T) + momentum

    return run


def quaternion(m):
    """Unit quaternion of a rotation matrix; its largest component first, so that nothing cancels."""
    squares = [
        1 + m[0][0] + m[1][1] + m[2][2],
        1 + m[0][0] - m[1][1] - m[2][2],
        1 - m[0][0] + m[1][1] - m[2][2],
        1 - m[0][0] - m[1][1] + m[2][2],
    ]
    products = {
        (0, 1): m[2][1] - m[1][2],
        (0, 2): m[0][2] - m[2][0],
        (0, 3): m[1][0] - m[0][1],
        (1, 2): m[0][1] + m[1][0],
        (1, 3): m[0][2] + m[2][0],
        (2, 3): m[1][2] + m[2][1],
    }
    best = max(range(4), key=lambda i: squares[i])
    twice = squares[best] ** 0.5
    return [
        float(twice / 2 if i == best else products[min(i, best), max(i, best)] / (2 * twice)) for i in range(4)
    ]


def settings():
    """Method, setting as text, and what makes the run."""
    decades = [10.0 ** (-n / 2) for n in range(8, 31)]
    for tolerance in decades[::2] + [2.220446049250313e-16]:
        yield "heyoka", f"{tolerance:.1e}", lambda t=tolerance: heyoka_scalar(t)
        yield "heyoka, batch", f"{tolerance:.1e}", lambda t=tolerance: heyoka_batch(t)
    for tolerance in decades[::4]:
        yield "SciPy DOP853", f"{tolerance:.1e}", lambda t=tolerance: scipy_method("DOP853")(t)
        yield "SciPy RK45", f"{tolerance:.1e}", lambda t=tolerance: scipy_method("RK45")(t)
    for steps in (1000, 4000, 16000):
        yield "PyElastica", f"{TIME / steps:g}", lambda n=steps: elastica(n)


def measure(run):
    """The end state, and microseconds of the processor for one trajectory: the median of blocks."""
    state = run()
    begin = time.thread_time_ns()
    run()
    once = max(time.thread_time_ns() - begin, 1)
    count = max(1, BLOCK // once)
    # Runs of a second and more need no repetition against the clock.
    rounds = 3 if once > 200_000_000 else ROUNDS
    times = []
    for _ in range(rounds):
        begin = time.thread_time_ns()
        for _ in range(count):
            run()
        times.append((time.thread_time_ns() - begin) / count)
    return state, statistics.median(times) / getattr(run, "lanes", 1) / 1e3


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--venv", type=pathlib.Path, required=True)
    parser.add_argument("--ready", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if not given.ready:
        inside(given.venv)
    from importlib.metadata import version

    points = []
    for method, setting, make in settings():
        state, micros = measure(make())
        print(f"{method}, {setting}: {micros:.1f} us", file=sys.stderr)
        points.append({"method": method, "setting": setting, "state": state, "micros": micros})
    import heyoka

    names = ["heyoka", "scipy", "pyelastica", "numpy"]
    result = {
        "moments": MOMENTS,
        "body_momentum": MOMENTUM,
        "time": TIME,
        "python": sys.version.split()[0],
        "versions": {name: version(name) for name in names},
        "lanes": heyoka.recommended_simd_size(),
        "points": points,
    }
    given.out.parent.mkdir(parents=True, exist_ok=True)
    given.out.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
