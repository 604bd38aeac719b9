# shellcheck shell=bash
# Sourced at the top of the tree by the scripts that install Debian packages, each of which has say() and fail().

listed_packages() {  # LIST...: files in scripts/, one package per line
  sed -e 's/ *#.*//' -e '/^$/d' "${@/#/scripts/}"
}

is_installed() { [[ $(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

# Reads apt's status lines (dlstatus:PACKAGE:PERCENT:TEXT while it downloads, then pmstatus:...) and
# prints the progress in steps of 10%.
show_progress() {
  local kind percent phase last=
  while IFS=: read -r kind _ percent _; do
    case $kind in dlstatus) phase=downloading ;; pmstatus) phase=installing ;; *) continue ;; esac
    phase="$phase, $((${percent%%.*} / 10 * 10))%"
    [[ $phase != "$last" ]] || continue
    last=$phase
    printf '   %s\n' "$phase"
  done
}

install_packages() {  # PACKAGE...: installs those that are missing
  local missing=() package as_root=(env)
  if ! command -v dpkg-query apt-get >/dev/null; then
    say "No apt here: counting on these being installed by other means: $*"
    return
  fi
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  ((${#missing[@]} > 0)) || return 0

  if ((EUID != 0)); then
    command -v sudo >/dev/null || fail "packages are missing, and installing them needs root or sudo; have them installed with: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  say "Installing with apt-get: ${missing[*]}"
  as_root+=(env DEBIAN_FRONTEND=noninteractive)
  "${as_root[@]}" apt-get -qq -o Acquire::Retries=3 update ||
    say "apt-get update had problems; trying to install anyway"
  # The status has its own descriptor, opened below sudo, because sudo closes inherited ones. If it
  # shared the output's descriptor, the packages' own scripts would find their output closed.
  "${as_root[@]}" sh -c 'exec apt-get "$@" 3>&1 >&2' sh -qq -y --no-install-recommends \
    -o Acquire::Retries=3 -o APT::Status-Fd=3 -o Dpkg::Use-Pty=0 install "${missing[@]}" \
    2>build/apt.log | show_progress || {
    cat build/apt.log >&2
    fail "apt-get could not install the packages (see above); run scripts/$(basename -- "$0") again once it can"
  }
}

install_listed() {  # LIST...
  local wanted
  mapfile -t wanted < <(listed_packages "$@")
  install_packages "${wanted[@]}"
}
