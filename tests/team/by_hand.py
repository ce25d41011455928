"""The services of docs/deploy/compose.yaml without Docker: their commands and variables, by hand.

Every command runs as its container would, as far as Linux lets it without an engine: on a root file system
that is read-only, with the same folders in memory, the same variables, and no others of this program. What
differs: the image, the network, users and capabilities. Names of services are ports of loopback here. Where a
service mounts `/data` and `/tls`, which this machine may not have, `/mnt` and `/media` take their place.
"""

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from app.team.processes import ChildProgram

ROOT = Path(__file__).parents[2]
COMPOSE = ROOT / "docs" / "deploy" / "compose.yaml"
PLACES = {"/data": "/mnt", "/tls": "/media"}
SCRIPT = """
set -e
mount --make-rprivate /
mount --bind "$1" /media && mount -o remount,bind,ro /media
shift
exec 3<"$1" 4<"$2"
for folder in $3; do mount -t tmpfs tmpfs "$folder"; done
for kept in 3 4; do
    if [ ! -d "$1" ]; then mkdir -p "$1"; mount -c --bind "/proc/self/fd/$kept" "$1"; fi
    shift
done
shift
mount -o remount,bind,ro /
if touch /root/by_hand /var/by_hand 2>/dev/null; then echo "the root can be written" >&2; exit 99; fi
cd /
exec "$@"
"""
_VARIABLE = re.compile(r"\$\{([A-Z0-9_]+):\?\}")


@dataclass(frozen=True)
class Stack:
    """What the services of the file are given: passwords as `.env` has them, and where others listen."""

    tls: Path
    values: dict
    addresses: dict  # of other services: text in the file -> text here

    def services(self):
        yaml = pytest.importorskip("yaml", reason="PyYAML comes with the extra team")
        return yaml.safe_load(COMPOSE.read_text())["services"]

    def environment(self, name, **more):
        """The variables of a service."""
        variables = self.services()[name]["environment"]
        return {key: self._here(str(text)) for key, text in variables.items()} | more

    def command(self, name, arguments=None):
        """A service's command, or another one in its container, as `docker compose run` has it."""
        service = self.services()[name]
        assert service["read_only"] is True
        folders = " ".join(PLACES.get(folder, folder) for folder in service["tmpfs"])
        program, *rest = arguments or service["command"]
        assert program == "crankwright"
        words = [sys.executable, "-m", "app", *(PLACES.get(word, word) for word in rest)]
        kept = [str(ROOT), sys.prefix]  # program and environment, where a folder in memory would hide them
        return ["unshare", "-m", "sh", "-c", SCRIPT, "by_hand", str(self.tls), *kept, folders, *words]

    def run(self, name, *arguments, **more):
        """Run a command in a service's container, to its end."""
        return subprocess.run(
            self.command(name, ["crankwright", *arguments]),
            env=bare() | self.environment(name, **more),
            capture_output=True,
            text=True,
            check=False,
            timeout=300,
        )

    def start(self, name, log, *arguments, **more):
        """Start a service, with what stands for its place in the network behind its command."""
        return ChildProgram(
            name, [*self.command(name), *arguments], log, environment=self.environment(name, **more)
        )

    def _here(self, text):
        text = _VARIABLE.sub(lambda found: self.values[found[1]], text)
        for there, here in self.addresses.items():
            text = text.replace(there, here)
        for there, here in PLACES.items():
            text = text.replace(f"{there}/", f"{here}/")
        return text


def bare():
    """The environment of this process without settings of the program."""
    kept = {key: text for key, text in os.environ.items() if not key.startswith(("CRANKWRIGHT_", "AWS_"))}
    return kept | {"PYTHONPATH": str(ROOT)}


def require_namespaces():
    """Skip where this process may not mount anything, as only root may."""
    tried = subprocess.run(
        ["unshare", "-m", "mount", "-o", "remount,bind,ro", "/"], capture_output=True, check=False
    )
    if tried.returncode != 0:
        pytest.skip("to try a read-only root takes root's rights")
