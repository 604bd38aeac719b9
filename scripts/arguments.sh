# shellcheck shell=bash
# Sourced by the scripts that measure sweeps, each of which has its own usage().
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

refuse() {  # WORD...: why the arguments are refused
  printf 'error: %s (see scripts/%s --help)\n' "$*" "$(basename -- "$0")" >&2
  exit 2
}

find_sweep() {  # SWEEP: sets `sweep` to a file, given by its path or as the name of a committed sweep
  local sweeps=$root/harness/measure/sweeps
  sweep=$sweeps/$1.json
  [[ -f $sweep ]] || sweep=$(realpath -m -- "$1")
  [[ -f $sweep && -r $sweep ]] || refuse "$sweep is not a file that can be read, and no sweep has that" \
    "name; the sweeps are: $(cd "$sweeps" && printf '%s ' *.json | sed 's/\.json//g')"
}
