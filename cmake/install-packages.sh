#!/usr/bin/env bash
# Installs the Debian packages of the named lists that are not there yet.
#   cmake/install-packages.sh build [test] [bench]
# Takes sudo only where it is not root. Does nothing, at once, where nothing is missing.
# HELIOGRAPH_SKIP_PACKAGES=1 leaves the system alone.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

fail() { printf 'heliograph: error: %s\n' "$*" >&2; exit 1; }
[ $# -gt 0 ] || fail "name the lists to install: build, test, bench"
[ -z "${HELIOGRAPH_SKIP_PACKAGES:-}" ] || exit 0

packages=()
for list in "$@"; do
    file="$here/packages-$list.txt"
    [ -f "$file" ] || fail "no package list '$list'; there are: build, test, bench"
    while read -r package; do packages+=("$package"); done < <(sed 's/#.*//; /^[[:space:]]*$/d' "$file")
done

command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
    fail "this is no Debian system; install the equivalents of cmake/packages-*.txt and set HELIOGRAPH_SKIP_PACKAGES=1"

missing=()
installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null | sed -n 's/^installed //p' || true)
for package in "${packages[@]}"; do
    grep -qxF "$package" <<<"$installed" || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

sudo=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || fail "these packages are missing and sudo is not there to install them: ${missing[*]}; install them as root"
    sudo=(sudo)
fi
printf 'Installing %d Debian packages: %s\n' "${#missing[@]}" "${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() { "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@" >"$log" 2>&1; }
apt update || { tail -n 5 "$log" >&2; fail "apt-get update failed; check the network and /etc/apt/sources.list"; }
apt install -y --no-install-recommends "${missing[@]}" ||
    { tail -n 15 "$log" >&2; fail "apt-get could not install: ${missing[*]}; Heliograph is made for Debian 12"; }
