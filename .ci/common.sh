# What .ci/run and .ci/nightly share; they source it. Bash.
#
# CRANKWRIGHT_CI_CACHE names a folder in which environments are kept, by the hash of what they contain. Without it
# each run makes a fresh one. PYTHON names the interpreter, python3 if not set.

set -euo pipefail
set -m # each background job gets a process group, so that it ends with all that it started

PYTHON=${PYTHON:-python3}
CACHE=${CRANKWRIGHT_CI_CACHE:-}
scratch=$(mktemp -d)
export CRANKWRIGHT_CI_RUN=$scratch
jobs_started=()
failed=()

say() { printf '\n== %s (%s s)\n' "$1" "$SECONDS"; }

# Start a command in the background with its output in a file: start NAME COMMAND…
start() {
    local name=$1
    shift
    "$@" >"$scratch/$name.log" 2>&1 &
    printf -v "pid_$name" %s $!
    jobs_started+=($!)
}

# Wait for what was started, show its output, and remember a failure: finish NAME
finish() {
    local name=$1 pid="pid_$1" status=0
    wait "${!pid}" || status=$?
    say "$name"
    cat "$scratch/$name.log"
    [ "$status" -eq 0 ] || failed+=("$name")
}

# Run a command with its output shown, remember a failure: check NAME COMMAND…
check() {
    local name=$1 status=0
    shift
    say "$name"
    "$@" & # in the background, so that a signal to this script is handled at once
    jobs_started+=($!)
    wait $! || status=$?
    [ "$status" -eq 0 ] || failed+=("$name")
}

stop() {
    local pid
    trap - EXIT
    for pid in "${jobs_started[@]}"; do
        kill -INT -- "-$pid" 2>/dev/null || true # pytest stops its servers
    done
    for _ in $(seq 100); do
        [ -n "$(jobs -rp)" ] || break
        sleep 0.2
    done
    for pid in "${jobs_started[@]}"; do
        kill -KILL -- "-$pid" 2>/dev/null || true
    done
    for _ in 1 2 3 4 5; do # servers of tests have groups of their own, and start others meanwhile
        for pid in $(marked); do
            kill -KILL "$pid" 2>/dev/null || true
        done
    done
    rm -rf "$scratch"
}

# The processes that this run started, directly or not: they inherited its mark.
marked() {
    local file
    for file in /proc/[0-9]*/environ; do
        if tr '\0' '\n' 2>/dev/null <"$file" | grep -qx "CRANKWRIGHT_CI_RUN=$scratch"; then
            file=${file#/proc/}
            echo "${file%/environ}"
        fi
    done
} 2>/dev/null

trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

# The hash of all that an environment contains.
fingerprint() {
    "$PYTHON" - <<'PY'
import hashlib, json, platform, sys, tomllib
project = tomllib.load(open("pyproject.toml", "rb"))["project"]
parts = [sys.version, platform.platform(), project["dependencies"], project["optional-dependencies"]]
print(hashlib.sha256(json.dumps(parts).encode() + open("constraints.txt", "rb").read()).hexdigest()[:16])
PY
}

# Make the environment of the README, and what builds the site, or take it from the cache; sets `environment`.
install() {
    environment=$scratch/environment
    if [ -n "$CACHE" ]; then
        mkdir -p "$CACHE"
        CACHE=$(cd "$CACHE" && pwd)
        export MYPY_CACHE_DIR=$CACHE/mypy
        local kept
        kept=$CACHE/environment-$(fingerprint)
        exec 9>"$kept.lock"
        if flock -n 9; then # held until this script ends: the environment refers to this checkout
            environment=$kept
            [ -e "$kept/complete" ] || rm -rf "$kept"
        else
            echo "another run uses the environment in the cache: this one makes its own"
        fi
    fi
    [ -e "$environment/complete" ] || "$PYTHON" -m venv "$environment"
    "$environment/bin/pip" install --quiet -c constraints.txt -e ".[test,docs]" 9>&-
    touch "$environment/complete"
}

# Chromium and pdftotext, for the tests of the pages; without them these skip, and say so. The whole Chromium
# draws a window that nobody sees, and takes twice the processor time: it is used where the other is not.
# nginx and Caddy, for the tests of the shipped files of proxies.
install_browser() {
    install_packages chromium-headless-shell chromium-headless-shell
    install_packages pdftotext poppler-utils
    install_packages nginx nginx-light
    install_packages caddy caddy
}

# Debian packages, unless a command is there already: COMMAND PACKAGE…
install_packages() {
    local command=$1 as_root=""
    shift
    command -v "$command" >/dev/null && return
    [ "$(id -u)" -eq 0 ] || as_root="sudo -n"
    { $as_root apt-get update -q && $as_root apt-get install -q -y --no-install-recommends "$@"; } >/dev/null 2>&1 ||
        echo "apt-get cannot install $*: the tests that need $command will skip"
}

# PostgreSQL, for the tests of a team; without it these skip, and say so. Its own service is not started.
install_postgresql() {
    ls -d /usr/lib/postgresql/*/bin/initdb >/dev/null 2>&1 && return
    local as_root=""
    [ "$(id -u)" -eq 0 ] || as_root="sudo -n"
    { $as_root mkdir -p /etc/postgresql-common/createcluster.d &&
        echo "create_main_cluster = false" | $as_root tee /etc/postgresql-common/createcluster.d/none.conf &&
        $as_root apt-get update -q && $as_root apt-get install -q -y --no-install-recommends postgresql; } \
        >/dev/null 2>&1 || echo "apt-get cannot install postgresql: without it the tests of a team will skip"
}

# The suites of storage, jobs and designs on PostgreSQL instead of SQLite.
on_postgresql() {
    local files
    mapfile -t files <.ci/postgresql.txt
    CRANKWRIGHT_TEST_DATABASE=postgresql "$environment/bin/pytest" -n 2 -rs "${files[@]}"
}

# All parts of a team together, and their kills: CRANKWRIGHT_TEST_TEAM_KILLS says how many. team FILE…
team() {
    CRANKWRIGHT_TEST_BUDGET=0 "$environment/bin/pytest" -m slow -rsP "$@"
}

lint() { "$environment/bin/ruff" check && "$environment/bin/ruff" format --check; }
scripts() { "$environment/bin/oxlint" --config tests/oxlint.json --deny-warnings app/web; }
types() { "$environment/bin/mypy"; }
contracts() { PATH="$environment/bin:$PATH" "$environment/bin/lint-imports"; }

# The documentation, with its notebooks executed: a warning, a dead link or a cell that fails is a failure.
site() {
    NO_MKDOCS_2_WARNING=1 nice "$environment/bin/mkdocs" build --strict --quiet --site-dir "$scratch/site"
}

start_checks() {
    start site site
    start lint lint
    start scripts scripts
    start types types
    start contracts contracts
}

finish_checks() {
    finish site
    finish lint
    finish scripts
    finish types
    finish contracts
}

# Say what failed, and end with that.
conclude() {
    say "done"
    [ ${#failed[@]} -eq 0 ] && exit 0
    printf 'failed: %s\n' "${failed[@]}"
    exit 1
}
