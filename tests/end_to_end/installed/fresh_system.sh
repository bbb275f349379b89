#!/usr/bin/env bash
# fresh_system.sh BUILD: makes the Debian packages of a build, installs them with their dependencies in a fresh Debian in
# a folder, and uses them there: program, manual, completion, the example of the libraries. Ends with 77 where no such
# system can be made.
set -euo pipefail
build=$1
here=$(cd "$(dirname "$0")" && pwd)
root=$(mktemp -d)
chmod 755 "$root"   # apt fetches as a user of its own
trap 'rm -rf "$root"' EXIT
not_available=77

(cd "$build" && cpack -G DEB >/dev/null && ls -- *.deb)
mmdebstrap --variant=apt --include=ca-certificates bookworm "$root" >"$build/fresh_system.log" 2>&1 || {
  tail -5 "$build/fresh_system.log" >&2
  echo "fresh_system: no fresh Debian could be made here" >&2
  exit $not_available
}
cp "$build"/*.deb "$root/"
cp -r "$here/example" "$root/example"

inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 bash -euc "$1"; }

inside 'apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends /frahm_*.deb >/dev/null'
inside 'cd /tmp && frahm --version && frahm verify | tail -1'
inside 'cd /tmp && frahm new sweep machine.toml && sed -i "s/value = 80,/value = 90,/" machine.toml && grep -q "value = 90," machine.toml &&
  frahm check machine.toml >/dev/null && frahm run machine.toml --progress none && frahm report machine.h5 && test -s machine.html'
inside 'cd /tmp && frahm explain spring | grep -q "N/m" && frahm schema | grep -q json-schema.org && zcat /usr/share/man/man1/frahm.1.gz | grep -q frahm'
inside 'test -f /usr/share/bash-completion/completions/frahm && test -f /usr/share/frahm/studies/rig/rig_atlas.toml'
echo "fresh_system: the program works"
inside 'DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends /libfrahm-dev_*.deb cmake make pkg-config >/dev/null'
inside 'cd /tmp && cmake -S /example -B peak >/dev/null && cmake --build peak >/dev/null &&
  peak/peak /usr/share/frahm/studies/classics/den_hartog.toml r=0.9,f=0.1'
echo "fresh_system: the libraries work"
if ls "$root"/python3-frahm_*.deb >/dev/null 2>&1; then
  inside 'DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends /python3-frahm_*.deb python3-xarray python3-h5netcdf >/dev/null'
  inside 'cd /tmp && python3 -c "
import frahm
study = frahm.Study.load(\"/usr/share/frahm/studies/classics/den_hartog.toml\")
print(study.point(r=0.9, f=0.1), study.run(\"python.h5\", progress=\"none\").open().sizes)
machine = frahm.Study.load(\"machine.toml\")
kept = frahm.open(\"machine.h5\")
print(machine.point(), kept.sizes)" && frahm report python.h5 && test -s python.html'
  echo "fresh_system: the Python package works"
fi
