#!/bin/sh
# Records every shipped session again: each script scenes/scripts/*-expert.json and *-clumsy.json in the scene that its
# first word names.
#   recordings/shipped/record.sh PROGRAM [FOLDER]      FOLDER: where to; beside this script if not given
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../..
program=$1
folder=${2:-$here}
mkdir -p "$folder"
for script in "$root"/scenes/scripts/*-expert.json "$root"/scenes/scripts/*-clumsy.json; do
  name=$(basename "$script" .json)
  "$program" record "$root/scenes/${name%%-*}.json" --script "$script" -o "$folder/$name.ctpm" --fast --overwrite
done
