#!/usr/bin/env bash
# The tests of what changed since the branch left main: files of tests, and the folders that mirror folders of code.
set -euo pipefail
start=$(git merge-base HEAD main)
{ git diff --name-only "$start"; git ls-files --others --exclude-standard; } |
  sed -nE 's,^cli/commands/,tests/cli/test_,; s,^(cli|benchmarks)/,tests/&,; s,^uplift/,tests/,; \,^tests/.*/,p' |
  while read -r path; do
    [[ $path == */test_* ]] || path=${path%/*}
    until [ -e "$path" ]; do path=${path%/*}; done
    [ "$path" = tests ] || echo "$path"
  done | sort -u
