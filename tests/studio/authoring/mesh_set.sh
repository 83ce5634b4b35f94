#!/usr/bin/env bash
# mesh_set.sh FOLDER: meshes that nobody of the project made, in FOLDER: those of Debian's assimp-testmodels, and of the data in
# its libcgal-demo.
set -eu
mkdir -p "$1"
cd "$1"
[ -f .whole ] && exit 0
command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || { echo "skipped: not Debian"; exit 77; }
apt-get download assimp-testmodels libcgal-demo || { echo "skipped: Debian's archive is out of reach"; exit 77; }
for package in assimp-testmodels libcgal-demo; do dpkg-deb -x "$package"_*.deb "$package"; done
mkdir -p cgal
tar -xzf libcgal-demo/usr/share/doc/libcgal-dev/data.tar.gz -C cgal
rm -rf libcgal-demo ./*.deb
touch .whole
