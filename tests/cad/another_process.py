"""Builds models in a process with other hash seeds and addresses, forked from one with the kernel."""

import hashlib
import json
from pathlib import Path

from cad.regenerate import regenerate


def write_digests(asked: str, answer: str) -> None:
    """Write the hashes of the STEP files of the builds in one file to another one."""
    builds = json.loads(Path(asked).read_text())
    digests = [hashlib.sha256(regenerate(*build).step).hexdigest() for build in builds]
    Path(answer).write_text(json.dumps(digests))
