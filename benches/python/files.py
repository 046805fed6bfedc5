"""Steps of shipped models from their texts, as ratios to the compiled ones.

    python benches/python/files.py [--command clebsch] [--processes 8] [MODEL ...]

Each process runs a model twice, for few and for many steps. The difference of its user CPU times over the difference of the steps is
the time of a step, without start-up. Compiled runs and runs from text alternate.
"""

import argparse
import resource
import statistics
import subprocess
import tempfile
from pathlib import Path

# Models that are compiled into the command, each with a number of steps that takes about a second.
STEPS = {
    "free-body": 4_000_000,
    "heavy-top": 2_000_000,
    "kepler": 2_000_000,
    "charged-particle": 2_000_000,
    "cayley-klein": 1_000_000,
    "body-in-two-fields": 1_000_000,
    "kirchhoff-body": 300_000,
    "coupled-bodies": 300_000,
    "ellipsoid-spatial": 100_000,
    "body-n": 100_000,
    "mixed-four": 10_000,
}


def user_time(command: list[str]) -> float:
    """The user CPU time of a process in seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(command, capture_output=True, text=True)
    # 3: an invariant exceeded the bound of its case, which is meant for fewer steps.
    if done.returncode not in (0, 3):
        raise SystemExit(f"{' '.join(command)}\n{done.stderr}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def step_time(command: str, model: str, steps: int) -> float:
    """The time of a step in nanoseconds."""

    def run(count: int) -> float:
        options = ["--every", str(count), "--check", "none", "--stability-limit", "0"]
        return user_time([command, "run", model, "--steps", str(count), *options])

    few = steps // 20
    return (run(steps) - run(few)) / (steps - few) * 1e9


def written(command: str, model: str, folder: Path) -> Path:
    """Files with the text of a model and its first case."""
    shown = subprocess.run([command, "show", model], capture_output=True, text=True, check=True).stdout
    end = shown.index("\n}\n") + 3
    text = folder / f"{model}.clebsch"
    text.write_text(shown[:end].replace("pub model", "model"))
    text.with_suffix(".toml").write_text(shown[end:])
    return text


def processor() -> str:
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "unknown")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", default=list(STEPS))
    parser.add_argument("--command", default="clebsch")
    parser.add_argument("--processes", type=int, default=8)
    given = parser.parse_args()
    print(f"{processor()}, {given.processes} processes\n")
    print("| model | compiled, ns | from its text, ns | ratio | worst |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for model in given.models:
            text = str(written(given.command, model, Path(folder)))
            pairs = [[step_time(given.command, own, STEPS[model]) for own in (model, text)] for _ in range(given.processes)]
            compiled, from_text = (statistics.median(each) for each in zip(*pairs))
            ratios = [text / compiled for compiled, text in pairs]
            print(f"| {model} | {compiled:.0f} | {from_text:.0f} | {statistics.median(ratios):.2f} | {max(ratios):.2f} |", flush=True)


if __name__ == "__main__":
    main()
