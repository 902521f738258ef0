# Shared by the install tests. Arguments of each: source folder, build folder, the outside program as the build made it.
set -euo pipefail
export LC_ALL=C.UTF-8
source=$(realpath "$1") build=$(realpath "$2") inside=$3
cmake=${CMAKE:-cmake}

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT

# Runs a command where source and build folder are empty, as on a machine that never had them. Without the right to
# mount, it runs as it is: noBuildPaths still holds.
hidden() {
  if unshare -rm true 2>/dev/null; then
    unshare -rm bash -c 'mount -t tmpfs none "$1" && mount -t tmpfs none "$2" 2>/dev/null || [ ! -e "$2/CMakeCache.txt" ]
      [ -z "$(ls -A "$1")" ] || exit 99
      shift 2; exec "$@"' hidden "$source" "$build" "$@"
  else
    echo "note: no right to mount; source and build folder stay visible" >&2
    "$@"
  fi
}

# No file below a folder names the source or the build folder (debugging information aside).
noBuildPaths() { # FOLDER
  local file copy=$temporary/stripped found=0
  while IFS= read -r -d '' file; do
    strip --strip-debug -o "$copy" "$file" 2>/dev/null || cp "$file" "$copy"
    if grep -qaF -e "$source/" -e "$build/" "$copy"; then
      echo "names the source or the build folder: $file" >&2
      grep -aoE "[[:print:]]*($source|$build)/[[:print:]]*" "$copy" | head -n 3 >&2
      found=1
    fi
    rm -f "$copy"
  done < <(find "$1" -type f -print0)
  [ $found = 0 ] || fail "paths of the build in what is installed"
}

# The command works: version, doctor, a phantom, a run of three frames.
programWorks() { # SEROSA
  local work=$temporary/work
  mkdir "$work"
  (
    cd "$work"
    version=$(hidden "$1" --version)
    [[ $version =~ ^serosa\ [0-9]+\.[0-9]+\.[0-9]+$ ]] || fail "--version says: $version"
    hidden "$1" doctor >doctor.txt || fail "serosa doctor: $(tail -n 3 doctor.txt)"
    hidden "$1" phantom ball --faces 500 -o ball.ply >/dev/null
    printf '%s\n' 'schema = 1' 'duration = "0.05 s"' '[[organ]]' 'model = "ball.ply"' 'length_unit = "mm"' \
      'nodes = 200' '[output]' 'size = [64, 64]' >ball.toml
    hidden "$1" run ball.toml --out result >run.txt || fail "serosa run: $(cat run.txt)"
    for file in frame_000003.png contact_sheet.png summary.json report.html; do
      [ -s "result/$file" ] || fail "serosa run left no $file: $(ls result)"
    done
  ) || exit 1
  rm -r "$work"
}

# The outside project, copied away, links the package below a folder and finds what the build itself finds.
outsideProjectWorks() { # PREFIX
  local project=$temporary/outside
  mkdir "$project"
  cp "$source/tests/install/CMakeLists.txt" "$source/tests/install/main.cpp" "$project"
  "$cmake" -S "$project" -B "$project/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$1" \
    -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" >"$project/log" 2>&1 &&
    grep -q "^serosa_DIR:PATH=$1/" "$project/build/CMakeCache.txt" &&
    "$cmake" --build "$project/build" >>"$project/log" 2>&1 || fail "the outside project: $(tail -n 20 "$project/log")"
  said=$(hidden "$project/build/outside") || fail "the outside program: $said"
  [ "$said" = "$("$inside")" ] || fail "the outside program says '$said', the build's own '$("$inside")'"
  echo "outside program: $said"
  rm -r "$project"
}
