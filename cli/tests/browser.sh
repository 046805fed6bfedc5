#!/usr/bin/env bash
# The pages of runs in a browser without a window: each must have drawn its view, without an error.
# Takes CHROMIUM=path where it has another name; says so and ends well where there is none.
set -euo pipefail
cd "$(dirname "$0")/../.."
browser=${CHROMIUM:-$(command -v chromium chromium-browser google-chrome 2>/dev/null | head -1 || true)}
if [ -z "$browser" ]; then
  echo "no Chromium here (set CHROMIUM=/path/to/it): the pages of runs are not tested in a browser"
  exit 0
fi
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
# Not the cache of the user.
export CLEBSCH_CACHE=off
clebsch() { cargo clebsch "$@" >/dev/null; }
clebsch run heavy-top --case general --steps 500 --out "$out/top"
clebsch run kepler --steps 500 --out "$out/kepler"
clebsch run kirchhoff-body --steps 200 --out "$out/fluid-body"
for name in toda-chain geometrically-exact-rod; do
  clebsch run "models/lattices/$name.clebsch" --case "models/lattices/$name.toml" --steps 200 --out "$out/$name"
done
name=shallow-water-2d-regularised
clebsch run "models/fluids/$name.clebsch" --case "models/fluids/$name.toml" --steps 20 --out "$out/$name"
for page in "$out"/*/run.html; do
  dom=$("$browser" --headless --no-sandbox --disable-gpu --virtual-time-budget=2000 --dump-dom "file://$page" 2>/dev/null)
  run=$(basename "$(dirname "$page")")
  if ! grep -q 'data-drawn="1"' <<<"$dom"; then
    echo "$run: the page draws nothing"
    exit 1
  fi
  echo "$run: drawn"
done
