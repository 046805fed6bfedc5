#!/usr/bin/env bash
# The derivations of all shipped models as pages of an article: no error, and nothing more than a point too wide or too
# high. Says so and ends well where there is no pdflatex. A folder as first argument keeps what was set.
set -euo pipefail
cd "$(dirname "$0")/../.."
if ! command -v pdflatex >/dev/null; then
  echo "no pdflatex here: the derivations are not set in print"
  exit 0
fi
out=${1:-$(mktemp -d)}
mkdir -p "$out"
[ $# -gt 0 ] || trap 'rm -rf "$out"' EXIT
clebsch() { cargo clebsch "$@"; }
models=()
for folder in generated/*/; do
  models+=("$(basename "$folder")")
done
models+=(models/*/*.clebsch)
failed=0
for model in "${models[@]}"; do
  name=$(basename "$model" .clebsch)
  {
    printf '\\documentclass{article}\n\\usepackage{amsmath}\n\\begin{document}\n'
    clebsch derive "$model" --format latex 2>"$out/$name.err" || cat "$out/$name.err" >&2
    printf '\\begin{thebibliography}{1}\\bibitem{dixon2007} M. F. Dixon.\\end{thebibliography}\n\\end{document}\n'
  } >"$out/$name.tex"
  # References are known on the second run.
  for _ in 1 2; do
    (cd "$out" && pdflatex -interaction=nonstopmode "$name.tex" >"$name.out" 2>&1) || true
  done
  log="$out/$name.log"
  wrong=$(grep -A2 '^!' "$log" || true)
  unknown=$(grep 'LaTeX Warning: .* undefined' "$log" || true)
  wide=$(awk -F'[(p]' '/^Overfull/ && $2 + 0 > 1' "$log")
  if [ -n "$wrong$unknown$wide" ]; then
    printf '%s:\n%s\n' "$name" "$wrong$unknown$wide"
    failed=1
  else
    echo "$name: fits"
  fi
done
exit $failed
