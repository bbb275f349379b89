#!/bin/sh
# manual.sh PROGRAM FOLDER: manual pages of the program and of each of its commands, from their help, by help2man.
set -eu
program=$1 folder=$2
folder_of_program=$(dirname "$program")
PATH=$folder_of_program:$PATH   # pages say `frahm`, not where it was built
version=$(frahm --version | cut -d' ' -f2)
rm -rf "$folder"
mkdir -p "$folder"

page() {   # COMMAND NAME-OF-PAGE ONE-LINE
  help2man --no-info --no-discard-stderr --section=1 --manual="User Commands" --source="frahm $version" \
    --version-string="$version" --name="$3" --output="$folder/page" "$1"
  sed "s/^$1 \\\\-/$2 \\\\-/" "$folder/page" >"$folder/$2.1"   # `frahm run` has the page frahm-run
  rm "$folder/page"
  gzip -9n "$folder/$2.1"
}

# Under `Commands:` each line has a command and what it does.
frahm --help | awk '/^Commands:/ {on = 1; next} /^$/ {on = 0} on {name = $1; $1 = ""; print name $0}' >"$folder/commands"
while read -r command what; do page "frahm $command" "frahm-$command" "$what"; done <"$folder/commands"
rm "$folder/commands"
page frahm frahm "periodic responses of vibrating systems with dry friction"
