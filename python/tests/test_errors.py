"""Wrong values, failed steps, and interrupts."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
from shared import top_values

import clebsch as cl

# A mass that falls to q = 0, where the potential ends.
FALL = "model Fall { field q: Real; lagrangian = (next(q) - q)^2/(2*h) - h*sqrt(q); }"


@pytest.mark.parametrize(
    ("change", "argument"),
    [
        (dict(h=-1), "h"),
        (dict(h="fast"), "h"),
        (dict(until=-5), "until"),
        (dict(until="noon"), "until"),
        (dict(every=-1), "every"),
        (dict(order=3), "order"),
        (dict(solver="none"), "solver"),
        (dict(judge="some"), "judge"),
        (dict(parameters=[1, 2]), "parameters"),
        (dict(parameters=dict(J=np.eye(2), chi=[0, 0, 1], z=[0, 0, 1])), "parameters.J"),
        (dict(parameters=dict(J=np.eye(3), chi=[0, np.nan, 1], z=[0, 0, 1])), "parameters.chi"),
        (dict(parameters=dict(J=np.eye(3), chi=object(), z=[0, 0, 1])), "parameters.chi"),
        (dict(parameters=dict(J=1j * np.eye(3), chi=[0, 0, 1], z=[0, 0, 1])), "parameters.J"),
        (dict(parameters=dict(J=np.eye(3), chi=[0, 0, 1])), "parameters.z"),
        (dict(parameters=dict(J=np.eye(3), chi=[0, 0, 1], z=[0, 0, 1], k=2)), "parameters.k"),
        (dict(initial=dict(R=2 * np.eye(3))), "initial.R"),
        (dict(initial=dict(R=[1, 0, 0], body_momentum=[0, 0, 1])), "initial.R"),
        (dict(initial=dict(R=np.eye(3), body_momentum=[0, 0])), "initial.body_momentum"),
        (dict(bounds=dict(enrgy=1)), "bounds.enrgy"),
    ],
)
def test_wrong_values_name_the_argument(top, change, argument):
    with pytest.raises(cl.DataError) as caught:
        top.run(**{**top_values(until=1), **change})
    assert caught.value.argument == argument
    assert "arguments" not in str(caught.value).split(":")[0]


def test_missing_values_are_named(top):
    with pytest.raises(cl.DataError, match="J, chi, z"):
        top.run(h=0.1, steps=1)
    with pytest.raises(cl.DataError, match="steps=N or until=T"):
        top.run(**top_values())
    with pytest.raises(cl.DataError, match="step size"):
        top.run(**{**top_values(), "h": None})


def test_a_first_step_that_fails(top):
    with pytest.raises(cl.StepError) as caught:
        top.run(**top_values(h=5.0, steps=3) | dict(h=5.0))
    error = caught.value
    assert (error.node, error.time, error.run) == (0, 0.0, None)
    assert error.hint.startswith("reduce the step size")


def test_a_step_that_fails_keeps_what_was_computed():
    with pytest.raises(cl.StepError) as caught:
        cl.Model(FALL).run(initial=dict(q=1.0), h=0.01, until=10)
    error = caught.value
    assert error.node > 10 and error.time == pytest.approx(error.node * 0.01)
    assert error.hint
    run = error.run
    assert not run.complete and run.node[-1] == error.node and np.isfinite(run["q"]).all()
    assert run.stopped == str(error)
    again = pickle.loads(pickle.dumps(error))
    assert (again.node, again.hint) == (error.node, error.hint)


def interrupt_after(seconds: float) -> None:
    # A process in the background of a script ignores the signal, and so would never end.
    signal.signal(signal.SIGINT, signal.default_int_handler)

    def later() -> None:
        time.sleep(seconds)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=later, daemon=True).start()


def test_ctrl_c_ends_a_run_and_returns_it(top):
    interrupt_after(0.3)
    run = top.run(**top_values(until=1e7, every=1000))
    assert run.stopped == "interrupted" and not run.complete
    assert 0 < run.steps < 1e9 and run.node[-1] == run.steps
    run.check()
    whole = top.run(**top_values(steps=int(run.node[5]), every=1000))
    np.testing.assert_array_equal(whole["R"], run["R"][:6])


def test_ctrl_c_ends_steps_by_hand(top):
    simulation = top.start(**top_values())
    interrupt_after(0.3)
    with pytest.raises(KeyboardInterrupt):
        simulation.step(10**9)
    node = simulation.node
    assert 0 < node < 10**9
    simulation.step()
    assert simulation.node == node + 1


def test_ctrl_c_ends_a_sweep_and_returns_it(top):
    values = top_values(until=1e6)
    values.pop("h")
    interrupt_after(0.5)
    table = top.sweep(vary={"chi.z": [0.5, 1.0, 1.5]}, h=[0.01], workers=2, **values)
    assert (table["status"] == "interrupted").all()
    assert table["steps"].iloc[0] > 0


def test_other_threads_go_on_while_a_run_computes(top):
    """The interpreter lock is released: a thread counts in the meantime."""
    counted, over = 0, False

    def count() -> None:
        nonlocal counted
        while not over:
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    begun = time.monotonic()
    top.run(**top_values(steps=300_000, every=0))
    took = time.monotonic() - begun
    over = True
    thread.join()
    assert counted > 50 * took


def test_two_threads_cannot_step_one_simulation(top):
    simulation = top.start(**top_values())
    failed = []

    def step() -> None:
        try:
            simulation.step(200_000)
        except RuntimeError as error:
            failed.append(str(error))

    threads = [threading.Thread(target=step) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert simulation.node + 200_000 * len(failed) in (200_000, 400_000) or failed
    assert all("another thread" in text for text in failed)


def test_nothing_is_printed(tmp_path):
    script = """
        import clebsch as cl
        cl.load("heavy-top").run(steps=2000)
        cl.load("toda-chain").run(steps=20)
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("", "")


def test_a_bar_is_shown_from_a_second_on(capsys, top, monkeypatch):
    pytest.importorskip("tqdm")
    import clebsch._progress as progress

    monkeypatch.setattr(progress, "_QUIET", 0.0)
    top.run(**top_values(steps=1_000_000, every=0))
    assert "step" in capsys.readouterr().err
    top.run(**top_values(steps=1_000_000, every=0), progress=False)
    assert capsys.readouterr().err == ""
