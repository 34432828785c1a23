# Set-up shared by the commands in this folder: one virtual environment with the native core built in place.
#
# `prepare EXTRA` makes `.venv` in the checkout when it is missing, installs what pyproject.toml asks for when that
# changed, and compiles the native core when its sources changed. Safe to run twice at once: the second waits. After an
# interruption the next run does again what was not finished.

ROOT=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
VENV=$ROOT/.venv

say() { printf 'pyemc: %s\n' "$*" >&2; }
give_up() { say "$*"; exit 1; }

undo() { :; } # what an interruption must take back
interrupted() {
    trap - INT TERM
    undo
    say "interrupted; the next start does this again"
    exit "$1"
}

# The newest Python that is new enough, or an explanation of what to install.
find_python() {
    local candidate
    for candidate in "${PYEMC_PYTHON:-}" python3.13 python3.12 python3.11 python3; do
        if [ -n "$candidate" ] && command -v "$candidate" >/dev/null &&
            "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            command -v "$candidate"
            return
        fi
    done
    give_up "Python 3.11 or newer is needed; install it with: sudo apt install python3 python3-venv python3-dev"
}

# What the compiler needs, named as Debian's packages.
check_build_tools() {
    local python=$1 missing=() include
    command -v "${CC:-cc}" >/dev/null || command -v gcc >/dev/null || missing+=(gcc)
    echo '#include <stdlib.h>' | "${CC:-cc}" -E -x c - >/dev/null 2>&1 || missing+=(libc6-dev)
    include=$("$python" -c 'import sysconfig; print(sysconfig.get_path("include"))')
    [ -f "$include/Python.h" ] || missing+=(python3-dev)
    "$python" -c 'import venv, ensurepip' 2>/dev/null || [ -x "$VENV/bin/pip" ] || missing+=(python3-venv)
    if [ ${#missing[@]} -gt 0 ]; then
        give_up "${missing[*]} missing; install with: sudo apt install ${missing[*]}"
    fi
}

stamp_of() { # the content of some files as one word
    cat -- "$@" | sha256sum | cut -c1-16
}

native_sources() {
    find "$ROOT"/nml "$ROOT"/hal "$ROOT"/rs274ngc "$ROOT"/emcmot \
        \( -name '*.pyx' -o -name '*.pxd' -o -name '*.h' \) ! -name '_messages.pxd' -type f | LC_ALL=C sort
    printf '%s\n' "$ROOT/setup.py" "$ROOT/nml/emc/emcmot.py"
}

install_requirements() {
    local extra=$1 stamp
    stamp=$VENV/.installed-$extra-$(stamp_of "$ROOT/pyproject.toml")
    [ -e "$stamp" ] && return
    say "installing what pyproject.toml asks for (${extra}) into $VENV"
    local requirements
    mapfile -t requirements < <("$VENV/bin/python" - "$ROOT/pyproject.toml" "$extra" <<'PYTHON'
import sys
import tomllib

with open(sys.argv[1], "rb") as file:
    project = tomllib.load(file)
extra = project["project"]["optional-dependencies"].get(sys.argv[2], [])
print(*project["build-system"]["requires"], *project["project"]["dependencies"], *extra, sep="\n")
PYTHON
    )
    "$VENV/bin/pip" install --quiet --disable-pip-version-check "${requirements[@]}" ||
        give_up "pip could not install the requirements; is the network there?"
    build_native
    (cd "$ROOT" && PYEMC_BUILD_ONLY=nothing \
        "$VENV/bin/pip" install --quiet --disable-pip-version-check --no-build-isolation --no-deps -e .) ||
        give_up "installing the project into $VENV failed"
    rm -f "$VENV"/.installed-"$extra"-*
    touch "$stamp"
}

build_native() {
    local files stamp log unfinished force=()
    mapfile -t files < <(native_sources)
    stamp=$VENV/.native-$(stamp_of "${files[@]}")
    [ -e "$stamp" ] && return
    log=$VENV/native-build.log
    unfinished=$VENV/.native-unfinished
    if [ -e "$unfinished" ]; then # half-written files of a build that was cut off look finished
        force=(--force)
        export CYTHON_FORCE_REGEN=1
    fi
    touch "$unfinished"
    say "compiling the native core; this takes a minute or two and is done once (log: $log)"
    if ! (cd "$ROOT" && PYEMC_BUILD_JOBS=$(nproc) "$VENV/bin/python" setup.py build_ext --inplace --parallel "$(nproc)" \
        "${force[@]}" >"$log" 2>&1); then
        rm -f "$unfinished"
        tail -n 20 "$log" >&2
        give_up "the native core does not compile; the whole log is in $log"
    fi
    rm -f "$VENV"/.native-*
    touch "$stamp"
    unset CYTHON_FORCE_REGEN
}

prepare() {
    local extra=$1 python lock
    trap 'interrupted 130' INT
    trap 'interrupted 143' TERM
    exec {lock}<"$ROOT"
    flock "$lock"
    if [ ! -x "$VENV/bin/python" ] || ! "$VENV/bin/python" -c '' 2>/dev/null; then
        python=$(find_python) || exit 1
        check_build_tools "$python"
        say "making the virtual environment $VENV with $("$python" --version)"
        undo() { rm -rf "$VENV"; }
        "$python" -m venv --clear "$VENV" ||
            give_up "no virtual environment could be made; install with: sudo apt install python3-venv"
        undo() { :; }
    fi
    check_build_tools "$VENV/bin/python"
    install_requirements "$extra"
    build_native
    exec {lock}<&-
    trap - INT TERM
}
