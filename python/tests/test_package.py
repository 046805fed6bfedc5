"""The package itself: its documentation, its types, its memory, and the included command."""

from __future__ import annotations

import doctest
import importlib
import inspect
import pathlib
import subprocess
import sys
import textwrap

import pytest
from shared import ROOT, TOP

import clebsch as cl

PUBLIC = [getattr(cl, name) for name in cl.__all__ if name != "__version__"]


@pytest.mark.parametrize("module", ["clebsch", "clebsch._model", "clebsch._gallery", "clebsch._rotations"])
def test_examples_of_the_documentation(module):
    done = doctest.testmod(importlib.import_module(module), optionflags=doctest.NORMALIZE_WHITESPACE)
    assert done.attempted > 0 and done.failed == 0


@pytest.mark.parametrize("own", PUBLIC, ids=lambda own: own.__name__)
def test_everything_public_is_documented(own):
    assert inspect.getdoc(own)
    if not inspect.isclass(own) or issubclass(own, BaseException) or issubclass(own, tuple):
        return
    for name, member in vars(own).items():
        if name.startswith("_") or inspect.ismemberdescriptor(member):
            continue
        text = inspect.getdoc(member)
        assert text, f"{own.__name__}.{name}"
        if inspect.isfunction(member):
            parameters = [p for p in inspect.signature(member).parameters if p != "self"]
            assert not parameters or "Parameters\n" in text, f"{own.__name__}.{name}"
            assert "Returns\n" in text or name == "save", f"{own.__name__}.{name}"


def test_types_are_declared():
    folder = pathlib.Path(cl.__file__).parent
    assert (folder / "py.typed").is_file()
    stub = (folder / "_clebsch.pyi").read_text()
    for own in (cl._clebsch.Model, cl._clebsch.Running):
        for name in vars(own):
            assert name.startswith("__") or f" {name}" in stub, name


def test_the_version_is_that_of_the_project():
    line = next(line for line in (ROOT / "Cargo.toml").read_text().splitlines() if line.startswith("version"))
    assert cl.__version__ == line.split('"')[1]


def script(text: str) -> str:
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(text)], capture_output=True, text=True, check=True)
    return done.stdout


def test_what_is_not_needed_is_not_imported():
    found = script("import sys, clebsch; print(*sys.modules)").split()
    assert "numpy" in found
    assert not {"pandas", "xarray", "matplotlib", "tqdm", "json.tool", "IPython"} & set(found)


@pytest.mark.skipif(sys.platform != "linux", reason="the size of a process is read as on Linux")
def test_results_take_at_most_twice_their_size():
    """The peak of the process above its start, as a ratio to the rows."""
    text = TOP.replace("\n", " ")
    ratio = script(f"""
        import clebsch as cl
        model = cl.Model('''{text}''')
        values = dict(parameters=dict(J=dict(I=[2, 2, 1]), chi=[0, 0, 1], z=[0, 0, 1]),
                      initial=dict(R=[1, 0, 0, 0], body_momentum=[0, 0, 1]), h=0.001, every=1)
        model.run(**values, steps=10)
        def peak():
            line = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))
            return 1024 * int(line.split()[1])
        before = peak()
        run = model.run(**values, steps=400_000)
        run["R"], run.energy, run.drift
        print((peak() - before) / (run._rows.nbytes + run.t.nbytes + run.node.nbytes))
    """)
    assert 0.8 < float(ratio) < 2


def test_the_command_is_carried():
    done = subprocess.run([sys.executable, "-m", "clebsch", "--version"], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == f"clebsch {cl.__version__}"
    wrong = subprocess.run([sys.executable, "-m", "clebsch", "run", "nothing"], capture_output=True, text=True, check=False)
    assert wrong.returncode == 2 and "no model `nothing`" in wrong.stderr


@pytest.mark.parametrize("page", ["README.md", "python/README.md"])
def test_programs_of_the_readme(page, capsys):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    blocks = (ROOT / page).read_text().split("```python\n")[1:]
    assert blocks
    for block in blocks:
        exec(compile(block.split("```")[0], page, "exec"), {})
    if page == "README.md":
        shape = capsys.readouterr().out.splitlines()[-1]
        assert shape.startswith("(1001,) ")


def test_rotations():
    import numpy as np

    turn = cl.axis_angle([0, 0, 2], np.pi / 2)
    np.testing.assert_allclose(turn @ [1, 0, 0], [0, 1, 0], atol=1e-15)
    n = np.array([1.0, -2.0, 0.5])
    turn = cl.axis_angle(n, 1.3)
    np.testing.assert_allclose(turn @ n, n, atol=1e-14)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(np.trace(turn), 1 + 2 * np.cos(1.3), atol=1e-14)
    for axis in ([0, 0, 0], [1, 2], [np.inf, 0, 0]):
        with pytest.raises(cl.DataError) as caught:
            cl.axis_angle(axis, 1)
        assert caught.value.argument == "axis"
