#!/usr/bin/env bash
# Builds the wheel, installs it into an empty environment, and runs the tests of the package there.
# PROFILE is the profile of Cargo, `quick` by default; PYTHON the interpreter. `.ci/run` also gives CARGO_TOGETHER, see
# `cargo-together`, and CARGO_CONFIG, a setting of Cargo.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${PYTHON:-python3}" -m venv "$folder/venv"
bin=$folder/venv/bin
# Not the cache of the user.
export CLEBSCH_CACHE=$folder/cache
export PIP_DISABLE_PIP_VERSION_CHECK=1
"$bin/pip" install --quiet maturin
if [ -n "${CARGO_TOGETHER:-}" ]; then
  REAL_CARGO=$(command -v cargo)
  export CARGO_TOGETHER REAL_CARGO
  mkdir "$folder/together"
  ln -s "$PWD/tests/cargo-together" "$folder/together/cargo"
  PATH=$folder/together:$PATH
fi
# `maturin` finds the interpreter of its own environment.
PATH=$bin:$PATH maturin build --quiet --locked ${CARGO_CONFIG:+--config "$CARGO_CONFIG"} --profile "${PROFILE:-quick}" --out "$folder/wheels"
# First without what it does not need.
"$bin/pip" install --quiet "$folder"/wheels/clebsch-*.whl
cp -r tests "$folder/tests"
(
  # From another folder, so that the installed package is imported.
  cd "$folder"
  "$bin/python" -c 'import clebsch as cl; run = cl.load("kepler").run(steps=10); assert len(run["X"]) == 11; run.check()'
)
"$bin/pip" install --quiet "$(echo "$folder"/wheels/clebsch-*.whl)[test]" pytest-xdist
CLEBSCH_ROOT=$(cd .. && pwd)
export CLEBSCH_ROOT
cd "$folder"
"$bin/pytest" -q -n "$(nproc)" --dist worksteal -p no:cacheprovider "$folder/tests" "$@"
